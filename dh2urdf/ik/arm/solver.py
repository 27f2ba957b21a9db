"""What an inverse-kinematics solver is, and the table that picks one for a chain.

Each family of arms has one class with the same five members. ``obstacle`` says, without
computing anything per pose, what keeps the family from covering a chain; ``solve_batch`` fills
the caller's arrays in one jitted call that holds no interpreter lock.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from importlib import import_module
from typing import ClassVar, Protocol

from dh2urdf.chain import SerialChain, settled_state
from dh2urdf.exceptions import NoSolverError
from dh2urdf.ik.arm.outputs import Outputs
from dh2urdf.transforms import Array

__all__ = [
    "SOLVERS",
    "BatchKernel",
    "Solver",
    "SolverBase",
    "SolverRow",
    "Task",
    "select_solver",
]


BatchKernel = Callable[..., None]
"""A jitted function: constants, poses, ``within_limits``, then the five output arrays."""


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


@dataclass(frozen=True)
class SolverRow:
    """One row of :data:`SOLVERS`: a family, what it needs, and where its class is."""

    name: str
    needs: str
    module: str
    cls: str

    def load(self) -> type[SolverBase]:
        """Import the class, when it is first wanted."""
        family: type[SolverBase] = getattr(import_module(self.module), self.cls)
        return family


class SolverBase:
    """What all families share: the exact chain as kernel arrays, and the explanation.

    Parameters
    ----------
    chain : SerialChain
    task : Task
    others : tuple of (str, str)
        Names of the better solvers and what kept them from this chain.
    """

    name: ClassVar[str] = ""
    kmax: int = 0
    __getstate__ = settled_state

    def __init__(
        self,
        chain: SerialChain,
        task: Task = Task.POSE,
        others: tuple[tuple[str, str], ...] = (),
    ) -> None:
        self.chain, self.task, self.others = chain, task, others
        self.links, self.joints = chain.tables

    @classmethod
    def obstacle(cls, chain: SerialChain, task: Task = Task.POSE) -> str | None:
        """Say what keeps the family from covering the chain for the task; None: it covers it."""
        raise NotImplementedError

    def solve_batch(self, Ts: Array, within_limits: bool, out: Outputs) -> None:
        """Solve poses Ts (m, 4, 4) into the caller's arrays, see :class:`Solver`."""
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


SOLVERS: tuple[SolverRow, ...] = (
    SolverRow(
        "spherical wrist",
        "six joints, the last three revolute with axes through one point",
        "dh2urdf.ik.families.spherical_wrist",
        "SphericalWrist",
    ),
    SolverRow(
        "three parallel axes",
        "six revolute joints, axes 1, 2, 3 or 2, 3, 4 parallel",
        "dh2urdf.ik.families.three_parallel",
        "ThreeParallel",
    ),
    SolverRow(
        "spherical shoulder",
        "six joints, the first three revolute with axes through one point",
        "dh2urdf.ik.families.reversed_chain",
        "SphericalShoulder",
    ),
    SolverRow(
        "three parallel axes, from the tool",
        "six revolute joints, axes 3, 4, 5 or 4, 5, 6 parallel",
        "dh2urdf.ik.families.reversed_chain",
        "ThreeParallelReversed",
    ),
    SolverRow(
        "planar arm",
        "two or three revolute joints with parallel axes",
        "dh2urdf.ik.families.planar",
        "PlanarArm",
    ),
    SolverRow(
        "three slides",
        "three sliding joints and two or three turning ones",
        "dh2urdf.ik.families.three_slides",
        "ThreeSlides",
    ),
    SolverRow(
        "short chain",
        "one to five joints of any kind, each of which moves the tool",
        "dh2urdf.ik.families.short",
        "ShortChain",
    ),
    SolverRow(
        "position arm",
        "task position: one to three joints of any kind, each of which moves the tool's origin",
        "dh2urdf.ik.families.short_position",
        "ShortPosition",
    ),
    SolverRow(
        "tool axis",
        "task position+axis: a virtual joint about the tool's z makes a chain that is covered",
        "dh2urdf.ik.families.tool_axis",
        "ToolAxis",
    ),
    SolverRow(
        "nearly a family",
        "six revolute joints, rounded or calibrated: nearly one of the first four rows",
        "dh2urdf.ik.families.near_family",
        "NearFamily",
    ),
    SolverRow(
        "general 6R",
        "six revolute joints, any axes",
        "dh2urdf.ik.families.general_6r",
        "General6R",
    ),
    SolverRow(
        "swept joint",
        "seven joints, one of which can be held so that a row above covers the others",
        "dh2urdf.ik.redundant.swept",
        "SweptJoint",
    ),
    SolverRow(
        "joints to spare",
        "one or two joints that can move while the task stays satisfied; they are held",
        "dh2urdf.ik.redundant.redundancy",
        "RedundantChain",
    ),
)
"""Families, best first; a chain gets the first that has no obstacle."""


def select_solver(chain: SerialChain, task: Task | str = Task.POSE) -> Solver:
    """Build the best solver that covers the chain for the task.

    Raises
    ------
    NoSolverError
        No family covers it; the message lists each with what stood in its way.
    """
    from dh2urdf.ik.problem.searched import SearchedSolver, hardly_moves

    task = Task(task)
    others: list[tuple[str, str]] = []
    for row in SOLVERS:
        family = row.load()
        obstacle = family.obstacle(chain, task)
        if obstacle is None:
            solver = family(chain, task, tuple(others))
            return SearchedSolver(solver) if hardly_moves(chain, task) else solver
        others.append((row.name, obstacle))
    listing = "\n".join(
        f"  {row.name} ({row.needs}): {obstacle}"
        for row, (_, obstacle) in zip(SOLVERS, others, strict=True)
    )
    raise NoSolverError(
        f"no solver finds all solutions for task {task.value!r} of this {chain.n}-joint chain; "
        f"ik_numeric finds some. The classes that exist, and what keeps them from it:\n{listing}"
    )
