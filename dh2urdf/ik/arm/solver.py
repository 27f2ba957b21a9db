"""What an inverse-kinematics solver is, and the arrays that it fills.

Each family of arms has one class with the same five members. ``obstacle`` says, without
computing anything per pose, what keeps the family from covering a chain; ``solve_batch`` fills
the caller's arrays in one call of a kernel.
"""

from collections.abc import Callable, Sequence
from functools import cached_property
from importlib import import_module
from typing import Any, ClassVar, Protocol

import numpy as np
from numpy.typing import NDArray

from dh2urdf.chain import SerialChain, settled_state
from dh2urdf.engine import Step
from dh2urdf.ik.arm.shared_tolerances import NOMINAL
from dh2urdf.ik.arm.task import Task, spare_joints
from dh2urdf.kernels.shapes import Outputs
from dh2urdf.transforms import Array

IntArray = NDArray[np.int64]

BatchKernel = Callable[..., int | None]
"""A kernel: what it knows of the arm, poses, ``within_limits``, where the solutions go. A closed
form returns how many poses are in doubt."""


BRANCH_WORDS = (
    ("shoulder left", "shoulder right"),
    ("elbow up", "elbow down"),
    ("wrist no flip", "wrist flip"),
)
"""Names of the bits of a branch code, value 0 first."""


Others = tuple[tuple[str, str], ...]
"""Names of the better solvers, and what kept them from a chain."""


BranchWords = Sequence[tuple[str, str] | None]

ASKED = dict(zip(Task, ("the full pose", "the position", "position and axis"), strict=True))
"""Tasks in words."""


def branch_words_of(solver: object) -> BranchWords:
    """Names of the bits of a solver's branch codes; None for a bit without meaning."""
    words: BranchWords = getattr(solver, "branch_words", BRANCH_WORDS)
    return words


def imported(where: str) -> Any:
    """What a ``module:name`` stands for."""
    module, _, name = where.partition(":")
    return getattr(import_module(module), name)


class Room:
    """Memory of one pose and its solutions in one piece, of which a copy is an answer.

    The pose (16), the number of solutions, kmax configurations, residuals, codes of branches, masks
    of free joints.
    """

    def __init__(self, kmax: int, n: int) -> None:
        self.memory = np.zeros(17 + kmax * (n + 3))
        self.Ts, rest = self.memory[:16].reshape(1, 4, 4), self.memory[17:]
        residual, *codes = rest[kmax * n :].reshape(3, 1, kmax)
        branch, free = (code.view(np.int64) for code in codes)
        count, q = self.memory[16:17].view(np.int64), rest[: kmax * n].reshape(1, kmax, n)
        self.out = Outputs(q, residual, count, branch, free)


class Solver(Protocol):
    """All solutions of many poses of one chain."""

    @property
    def name(self) -> str:
        """Short name of the family: ``spherical wrist``, ``general 6R``, ..."""

    chain: SerialChain
    """The exact chain that every solution is certified on."""

    kmax: int
    """Most solutions that a pose can have."""

    def explain(self) -> str:
        """Name the class, its axes and subproblems, and why better solvers did not apply."""

    def solve_batch(self, Ts: Array, within_limits: bool, out: Outputs) -> None:
        """Solve poses Ts (m, 4, 4), C-contiguous, in one call.

        Parameters
        ----------
        Ts : array, shape (m, 4, 4)
        within_limits : bool
            Leave out what no full turn brings into the limits.
        out : Outputs
            Bits of the branch: 0 shoulder (0 left, 1 right), 1 elbow (0 up, 1 down), 2 wrist (0 no
            flip, 1 flip).
        """


NONE: IntArray = np.empty(0, np.int64)
"""No rows of a batch."""


class SolverBase:
    """What all families share: the exact chain as kernel arrays, and the explanation.

    Parameters
    ----------
    chain : SerialChain
    task : Task
    others : tuple of (str, str)
        As :data:`Others`.
    """

    name: str = ""
    needs: ClassVar[str]
    """The arms that the family is for."""
    solves: ClassVar[Task] = Task.POSE
    if_spare: ClassVar[str] = "some joints can move while the tool stays"
    """Why joints to spare are in the way; empty where they are not."""
    kmax: int = 0
    moved: str = ""
    """Joints that are not at a value of their own, in words."""
    kernel: BatchKernel
    """The kernel that solves poses, where there is one."""
    __getstate__ = settled_state

    def __init__(self, chain: SerialChain, task: Task = Task.POSE, others: Others = ()) -> None:
        self.chain, self.task, self.others = chain, task, others
        self.links, self.joints = chain.tables

    @classmethod
    def obstacle(
        cls, chain: SerialChain, task: Task = Task.POSE, tolerance: float = NOMINAL
    ) -> str | None:
        """Say what keeps the family from covering the chain for the task; None: it covers it.

        ``tolerance`` is the angle [rad] and length relative to ``chain.size`` that is snapped.
        """
        if task is not cls.solves:
            return f"it solves for {ASKED[cls.solves]}, not for {task.value}"
        misfit = cls.misfit(chain, tolerance)
        spare = misfit is None and cls.if_spare and spare_joints(chain, task)
        return cls.if_spare if spare else misfit

    @classmethod
    def misfit(cls, chain: SerialChain, tolerance: float) -> str | None:
        """Say what of the chain is not as the family needs it; None: nothing."""

    def solve_batch(self, Ts: Array, within_limits: bool, out: Outputs) -> None:
        """Solve poses Ts (m, 4, 4) into the caller's arrays, see :class:`Solver`."""
        if self.kernel(self.constants, Ts, within_limits, out):
            self.look_wider(Ts, np.flatnonzero(out.counts < 0), within_limits, out)

    def look_wider(self, Ts: Array, rows: IntArray, within_limits: bool, out: Outputs) -> None:
        """Solve poses Ts[rows], of which the kernel doubts that its solutions are all."""
        raise NotImplementedError

    def before_search(self, Ts: Array) -> tuple[Outputs, Outputs]:
        """Solutions of poses Ts (m, 4, 4), limits aside, that a search adds to; its candidates.

        Where the solver would search by itself, these are what it has before.
        """
        known = Outputs.of(len(Ts), self.kmax, self.chain.n)
        self.solve_batch(Ts, False, known)
        return known, known

    def steps(self, Ts: Array, within_limits: bool, out: Outputs) -> tuple[Step, ...]:
        """Kernels that solve poses, see :func:`dh2urdf.engine.at_once`; none where Python helps."""
        if type(self).solve_batch is not SolverBase.solve_batch:
            return ()
        return ((self.kernel, (self.constants, Ts, within_limits, out), False),)

    def all_steps(self, Ts: Array, within_limits: bool, out: Outputs) -> tuple[Step, ...]:
        """Kernels that solve poses, those in doubt, too, where there are such kernels.

        A count is negative, then, where that is not so.
        """
        return self.steps(Ts, within_limits, out)

    @cached_property
    def constants(self) -> tuple[Any, ...]:
        """First arguments of the kernel: what it knows of the arm."""
        raise NotImplementedError

    def details(self) -> str:
        """Name the axes and the subproblems, in one sentence or a few."""
        raise NotImplementedError

    def explain(self) -> str:
        """Name the class, its axes and subproblems, and why better solvers did not apply."""
        lines = [f"{self.name}: {self.details()}", *([self.moved] if self.moved else [])]
        lines += [f"not {name}: {reason}" for name, reason in self.others]
        return "\n".join(lines)

    def __str__(self) -> str:
        return self.name


class HeldSolver:
    """All solutions of many poses of a chain, each pose with its own values of the held joints."""

    name: str
    kmax: int
    __getstate__ = settled_state

    def __init__(self, chain: SerialChain, held: tuple[int, ...]) -> None:
        self.chain, self.held = chain, held

    def details(self) -> str:
        """Say how the joints that move are solved for."""
        raise NotImplementedError

    def solve_held(self, Ts: Array, values: Array, within_limits: bool, out: Outputs) -> None:
        """Solve poses Ts (m, 4, 4), each with its held values (m, h) [rad] or [m].

        Outputs as in :class:`Solver`, with all joints of the chain.
        """
        raise NotImplementedError

    def solve_plainly(
        self, Ts: Array, values: Array, within_limits: bool, out: Outputs
    ) -> IntArray:
        """The same; of which poses, by index, a solver made for the value says more."""
        self.solve_held(Ts, values, within_limits, out)
        return NONE

    def steps(
        self, Ts: Array, values: Array, within_limits: bool, out: Outputs
    ) -> tuple[Step, ...]:
        """Kernels that solve poses with one held joint at values (m,), see :class:`SolverBase`."""
        return ()

    def all_steps(
        self, Ts: Array, values: Array, within_limits: bool, out: Outputs
    ) -> tuple[Step, ...]:
        """The same with what is done of poses in doubt, see :class:`SolverBase`."""
        return self.steps(Ts, values, within_limits, out)

    def clear_about(self, value: float) -> tuple[float, float]:
        """Between which values of the one held joint `steps` are right, about one at which it is.

        An interval that is empty says that they are not.
        """
        return -np.inf, np.inf

    @property
    def quick(self) -> bool:
        """Whether many values take little time, and `sweep` tells its solutions' branches."""
        return False

    def sweep(self, T: Array, values: Array, out: Outputs) -> Step:
        """What solves a pose (4, 4) at or near values (m,) of the one held joint, limits or not.

        Solutions of one branch in neighbouring rows are on one curve; -1 says nothing. There may
        be more rows than values.
        """
        return self._solve_rows, (T, values, out), False

    def _solve_rows(self, T: Array, values: Array, out: Outputs) -> None:
        """Solve a pose (4, 4) at values (m,), into the first rows."""
        Ts = np.repeat(T[None], len(values), axis=0)
        found = out.rows(slice(len(values)))
        self.solve_held(Ts, np.ascontiguousarray(values[:, None]), False, found)
        out.branch[:] = -1

    def explain(self) -> str:
        """Name the held joints and say how the others are solved for."""
        names = ", ".join(self.chain.names[i] for i in self.held)
        return f"held, at any value: {names}\n{self.details()}"

    def __str__(self) -> str:
        return self.name
