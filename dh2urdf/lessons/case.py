"""A question brought to a family that has a derivation here: which, and whose joints."""

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field

import numpy as np

from dh2urdf.chain import Coupling, SerialChain
from dh2urdf.dh import DHConvention, DHTable
from dh2urdf.ik.arm import Task, hold, select_solver
from dh2urdf.ik.families import with_tool_joint
from dh2urdf.lessons.arm import Arm, Row, arm_of, without_ends
from dh2urdf.lessons.closed_loop import closed_loop
from dh2urdf.lessons.closed_loop import fits as fits_closed_loop
from dh2urdf.lessons.elimination import fits as fits_six_turns
from dh2urdf.lessons.elimination import general_6r
from dh2urdf.lessons.ends import letters
from dh2urdf.lessons.few_joints import is_polar, moves_point, place_and_compare, place_only, polar
from dh2urdf.lessons.notation import measured
from dh2urdf.lessons.one_joint import is_one, one_joint
from dh2urdf.lessons.parallel_first import first_parallel
from dh2urdf.lessons.parallel_first import fits as fits_first_parallel
from dh2urdf.lessons.planar import planar, planar_place
from dh2urdf.lessons.spherical_wrist import spherical_wrist
from dh2urdf.lessons.steps import Step
from dh2urdf.lessons.three_parallel import fits as fits_three_parallel
from dh2urdf.lessons.three_parallel import three_parallel
from dh2urdf.lessons.three_slides import three_slides
from dh2urdf.lessons.two_parallel import fits as fits_two_parallel
from dh2urdf.lessons.two_parallel import two_parallel
from dh2urdf.lessons.way import Asked, Way
from dh2urdf.transforms import Array, inverse

Lesson = Callable[[Asked], Iterator[Way]]

LESSONS: dict[tuple[str, Task], Lesson] = {
    ("spherical wrist", Task.POSE): spherical_wrist,
    ("planar arm", Task.POSE): planar,
    ("planar arm", Task.POSITION): planar_place,
}
"""The derivation of a family, by the name of its solver and the task."""

SHORT: list[tuple[Callable[[tuple[Row, ...]], bool], Lesson]] = [
    (fits_three_parallel, three_parallel),
    (is_polar, polar),
    (moves_point, place_and_compare),
    (fits_closed_loop, closed_loop),
]
"""Derivations of arms of up to five joints, which one solver covers, by what their rows are."""

PARALLEL: list[tuple[Callable[[tuple[Row, ...]], bool], Lesson]] = [
    (fits_three_parallel, three_parallel),
    (fits_first_parallel, first_parallel),
]
"""Derivations of arms with three neighbouring parallel axes."""

ELIMINATED = frozenset({"two parallel axes", "nearly two parallel axes", "general 6R"})
"""Solvers without a closed form."""

ALIKE = " The other choices on the way end without a solution, too."
"""What is said where none of several ways has one."""

REVERSED = {
    "spherical shoulder": "spherical wrist",
    "three parallel axes, from the tool": "three parallel axes",
}
"""Families that are another one, seen from the tool."""


@dataclass(frozen=True, eq=False)
class Values:
    """What ``ik`` gives, where that is not the joints: ``joints = coupling.joints(q)``.

    Parameters
    ----------
    coupling : Coupling
    q : array, shape (k, values)
        The solutions, as those of the question.
    """

    coupling: Coupling
    q: Array


@dataclass(frozen=True, eq=False)
class Question:
    """What is explained: a pose of an arm, the solutions that ``ik`` gave, and which of them.

    Parameters
    ----------
    name : str
        What the arm is called.
    chain : SerialChain
    table : DHTable or None
        The user's own table.
    solver : str
        Name of the solver.
    T : array, shape (4, 4)
    q : array, shape (k, n)
        Solutions.
    branches : tuple of k str
        What each is called.
    numbers : tuple of k int
        The place of each in the answer of ``ik``.
    index : int
        Which of them is explained; of no meaning where there is none.
    task : Task
    details : str
        What the solver says of itself, for families without a derivation here.
    values : Values or None
        What ``ik`` gives, where it is not the joints.
    held : mapping of int to float
        Joints that are held, and where.
    """

    name: str
    chain: SerialChain
    table: DHTable | None
    solver: str
    T: Array
    q: Array
    branches: tuple[str, ...]
    numbers: tuple[int, ...]
    index: int = 0
    task: Task = Task.POSE
    details: str = ""
    held: Mapping[int, float] = field(default_factory=dict)
    values: Values | None = None


def lesson_of(arm: Arm, solver: str, task: Task) -> Lesson | None:
    """The derivation for an arm that a solver covers; None: there is none here."""
    if solver == "short chain":
        return next((lesson for fits, lesson in SHORT if fits(arm.rows)), None)
    if solver == "three slides":
        return three_slides
    if solver == "position arm":
        lessons = (moves_point, place_only), (is_one, one_joint)
        return next((lesson for fits, lesson in lessons if fits(arm.rows)), None)
    if task is Task.POSE and solver in ELIMINATED:
        lessons = (fits_two_parallel, two_parallel), (fits_six_turns, general_6r)
        return next((lesson for fits, lesson in lessons if fits(arm.rows)), None)
    if solver == "three parallel axes":
        return next((lesson for fits, lesson in PARALLEL if fits(arm.rows)), None)
    return LESSONS.get((solver, task))


class Case:
    """A question brought to a family that has a lesson: joints held, the tool's turn, turned round.

    ``joints`` are the arm's joints, in the order of the lesson's; -1 for a virtual one.
    """

    def __init__(self, question: Question) -> None:
        self.question, self.chain = question, question.chain
        self.T, self.solver, self.task = question.T, question.solver, question.task
        self.joints, self.notes = list(range(self.chain.n)), list[Step]()
        self.base = np.eye(4)
        """The base of the lesson's chain in the arm's: the tool, where it is turned round."""
        table = question.table
        if question.held:
            self.chain, table = hold(self.chain, question.held), None
            self.joints = [i for i in self.joints if i not in question.held]
            self.solver = select_solver(self.chain, self.task).name
            self.notes.append(_held(question, self.joints))
        if self.solver == "tool axis":
            self.chain, table = with_tool_joint(self.chain), None
            self.joints, self.task = [*self.joints, -1], Task.POSE
            self.solver = select_solver(self.chain, self.task).name
            self.notes.append(_about_the_tool(self.chain.n))
        if self.solver in REVERSED:
            self.base = self.T
            self.chain, table, self.T = self.chain.reversed(), None, inverse(self.T)
            self.joints, self.solver = self.joints[::-1], REVERSED[self.solver]
            self.notes.append(_turned_round(self.chain.n))
        self.arm = arm_of(self.chain, table)
        self.lesson = lesson_of(self.arm, self.solver, self.task)
        if self.lesson is not None:
            modified = table is not None and table.convention is DHConvention.MODIFIED
            self.notes += letters(self.arm, modified)

    @property
    def guide(self) -> Array | None:
        """The solution that is explained, in the lesson's joints; 0 for a virtual one."""
        if not len(self.question.q):
            return None
        q = np.append(self.question.q[self.question.index], 0.0)
        return q[self.joints]

    def ways(self) -> list[Way]:
        """All ways through the derivation, those that end without a solution too."""
        assert self.lesson is not None
        return list(self.lesson(Asked(self.arm, self.pose(), self.guide)))

    def pose(self) -> Array:
        """What is asked of the rows: the pose between base and tool, (4, 4)."""
        if self.task is Task.POSITION:
            H: Array = inverse(self.arm.base) @ self.T
            return H
        return without_ends(self.arm, self.T)

    def values(self, way: Way) -> Array:
        """The configuration of the lesson's joints that a way leads to, angles in (-pi, pi]."""
        arm = self.arm
        return np.array([arm.joint_value(i, way.variables[i]) for i in range(arm.n)])

    def apart(self, q: Array, p: Array) -> float:
        """Largest difference of a joint that the arm has, turns on the circle."""
        gap = q - p
        turned = np.remainder(gap + math.pi, 2.0 * math.pi) - math.pi
        real = np.array(self.joints) >= 0
        return float(np.abs(np.where(self.chain.prismatic, gap, turned))[real].max())

    def chosen(self) -> Way:
        """The way that leads to the solution; without one the way that got farthest."""
        found, guide = self.ways(), self.guide
        whole = [way for way in found if not way.stopped]
        if not whole:
            farthest = max(found, key=lambda way: len(way.steps))
            return farthest.saying(ALIKE) if len(found) > 1 else farthest
        if guide is None:
            return whole[0]
        return min(whole, key=lambda way: self.apart(self.values(way), guide))


def _held(question: Question, joints: list[int]) -> Step:
    """Which joints are held; what the others are called."""
    names, held = question.chain.names, question.held
    units = {i: "m" if question.chain.prismatic[i] else "rad" for i in held}
    parts = (f"{names[i]} at {measured(v, units[i])}" for i, v in held.items())
    left = (f"{k} is {names[i]}" for k, i in enumerate(joints, 1))
    return Step(
        "What is held",
        f"The arm has joints to spare, so some are held: {', '.join(parts)}. They are then part of "
        f"a link, and an arm of {len(joints)} joints remains, numbered anew: {', '.join(left)}.",
    )


def _about_the_tool(n: int) -> Step:
    """The virtual joint of the task position+axis."""
    return Step(
        "A joint more",
        "Only the tool's place and z axis are asked for; it may turn about z. So put a joint "
        f"there, number {n}: the arm with it has to reach the full pose, and its angle is "
        "forgotten in the end.",
    )


def _turned_round(n: int) -> Step:
    """The arm seen from its tool."""
    return Step(
        "Turned round",
        "Seen from the tool the arm is of a family that is known: the base becomes its tool. So "
        "solve T^(-1) for the joints in reverse order; their values are the same. Joint 1 below is "
        f"the arm's last, joint {n} its first.",
    )
