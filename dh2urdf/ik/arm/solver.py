"""What an inverse-kinematics solver is.

Each family of arms has one class with the same five members. ``obstacle`` says, without
computing anything per pose, what keeps the family from covering a chain; ``solve_batch`` fills
the caller's arrays in one jitted call that holds no interpreter lock.
"""

from collections.abc import Callable, Sequence
from enum import StrEnum
from functools import cached_property
from importlib import import_module
from typing import Any, ClassVar, Protocol

from dh2urdf.chain import SerialChain, settled_state
from dh2urdf.ik.arm.outputs import Outputs
from dh2urdf.transforms import Array

BatchKernel = Callable[..., None]
"""A jitted function: constants, poses, ``within_limits``, then the five output arrays."""


BRANCH_WORDS = (
    ("shoulder left", "shoulder right"),
    ("elbow up", "elbow down"),
    ("wrist no flip", "wrist flip"),
)
"""Names of the bits of a branch code, value 0 first."""


Others = tuple[tuple[str, str], ...]
"""Names of the better solvers, and what kept them from a chain."""


BranchWords = Sequence[tuple[str, str] | None]


def branch_words_of(solver: object) -> BranchWords:
    """Names of the bits of a solver's branch codes; None for a bit without meaning."""
    words: BranchWords = getattr(solver, "branch_words", BRANCH_WORDS)
    return words


def imported(where: str) -> Any:
    """What a ``module:name`` stands for."""
    module, _, name = where.partition(":")
    return getattr(import_module(module), name)


class Task(StrEnum):
    """What of the target pose has to be reached."""

    POSE = "pose"
    POSITION = "position"
    POSITION_AXIS = "position+axis"

    @property
    def number(self) -> int:
        """The task's number in the kernels."""
        return list(Task).index(self)


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
        """Solve poses Ts (m, 4, 4), C-contiguous, in one call without the interpreter lock.

        Parameters
        ----------
        Ts : array, shape (m, 4, 4)
        within_limits : bool
            Leave out what no full turn brings into the limits.
        out : Outputs
            Bits of the branch: 0 shoulder (0 left, 1 right), 1 elbow (0 up, 1 down), 2 wrist (0 no
            flip, 1 flip).
        """


class SolverBase:
    """What all families share: the exact chain as kernel arrays, and the explanation.

    Parameters
    ----------
    chain : SerialChain
    task : Task
    others : tuple of (str, str)
        As :data:`Others`.
    """

    name: ClassVar[str] = ""
    kmax: int = 0
    where: ClassVar[str]
    """Module and name of the kernel, where there is one."""
    __getstate__ = settled_state

    def __init__(self, chain: SerialChain, task: Task = Task.POSE, others: Others = ()) -> None:
        self.chain, self.task, self.others = chain, task, others
        self.links, self.joints = chain.tables

    @classmethod
    def obstacle(cls, chain: SerialChain, task: Task = Task.POSE) -> str | None:
        """Say what keeps the family from covering the chain for the task; None: it covers it."""
        raise NotImplementedError

    def solve_batch(self, Ts: Array, within_limits: bool, out: Outputs) -> None:
        """Solve poses Ts (m, 4, 4) into the caller's arrays, see :class:`Solver`."""
        self.kernel(*self.constants, Ts, within_limits, *out)

    @cached_property
    def kernel(self) -> BatchKernel:
        """The jitted function that solves poses, imported when it is first needed."""
        kernel: BatchKernel = imported(self.where)
        return kernel

    @cached_property
    def constants(self) -> tuple[Any, ...]:
        """First arguments of the kernel: what it knows of the arm."""
        raise NotImplementedError

    def details(self) -> str:
        """Name the axes and the subproblems, in one sentence or a few."""
        raise NotImplementedError

    def explain(self) -> str:
        """Name the class, its axes and subproblems, and why better solvers did not apply."""
        lines = [f"{self.name}: {self.details()}"]
        lines += [f"not {name}: {reason}" for name, reason in self.others]
        return "\n".join(lines)

    def __str__(self) -> str:
        return self.name
