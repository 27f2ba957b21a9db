"""The entry: a pose of an arm, explained along one of the solutions that ``ik`` gave."""

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from dh2urdf.chain import SerialChain
from dh2urdf.dh import DHConvention, DHTable
from dh2urdf.ik.arm import Task, hold, select_solver
from dh2urdf.ik.families import with_tool_joint
from dh2urdf.lessons.arm import Arm, Row, arm_of, without_ends
from dh2urdf.lessons.elimination import fits as fits_six_turns
from dh2urdf.lessons.elimination import general_6r
from dh2urdf.lessons.ends import letters, taken_off
from dh2urdf.lessons.few_joints import is_polar, moves_point, place_and_compare, place_only, polar
from dh2urdf.lessons.marks import joint_mark
from dh2urdf.lessons.notation import shown, vector_shown
from dh2urdf.lessons.planar import planar, planar_place
from dh2urdf.lessons.spherical_wrist import spherical_wrist
from dh2urdf.lessons.steps import Equation, IKExplanation, Step
from dh2urdf.lessons.three_parallel import fits as fits_three_parallel
from dh2urdf.lessons.three_parallel import three_parallel
from dh2urdf.lessons.three_slides import three_slides
from dh2urdf.lessons.two_parallel import fits as fits_two_parallel
from dh2urdf.lessons.two_parallel import two_parallel
from dh2urdf.lessons.way import Asked, Way
from dh2urdf.transforms import Array, inverse, pose_error

Lesson = Callable[[Asked], Iterator[Way]]

LESSONS: dict[tuple[str, Task], Lesson] = {
    ("spherical wrist", Task.POSE): spherical_wrist,
    ("three parallel axes", Task.POSE): three_parallel,
    ("planar arm", Task.POSE): planar,
    ("planar arm", Task.POSITION): planar_place,
}
"""The derivation of a family, by the name of its solver and the task."""

SHORT: list[tuple[Callable[[tuple[Row, ...]], bool], Lesson]] = [
    (fits_three_parallel, three_parallel),
    (is_polar, polar),
    (moves_point, place_and_compare),
]
"""Derivations of arms of up to five joints, which one solver covers, by what their rows are."""

ELIMINATED = frozenset({"two parallel axes", "nearly two parallel axes", "general 6R"})
"""Solvers without a closed form."""

REVERSED = {
    "spherical shoulder": "spherical wrist",
    "three parallel axes, from the tool": "three parallel axes",
}
"""Families that are another one, seen from the tool."""


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


def lesson_of(arm: Arm, solver: str, task: Task) -> Lesson | None:
    """The derivation for an arm that a solver covers; None: there is none here."""
    if solver == "short chain":
        return next((lesson for fits, lesson in SHORT if fits(arm.rows)), None)
    if solver == "three slides":
        return three_slides
    if solver == "position arm":
        return place_only if moves_point(arm.rows) else None
    if task is Task.POSE and solver in ELIMINATED:
        lessons = (fits_two_parallel, two_parallel), (fits_six_turns, general_6r)
        return next((lesson for fits, lesson in lessons if fits(arm.rows)), None)
    lesson = LESSONS.get((solver, task))
    return None if lesson is three_parallel and not fits_three_parallel(arm.rows) else lesson


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
        if guide is None or not whole:
            return max(whole or found, key=lambda way: len(way.steps))
        return min(whole, key=lambda way: self.apart(self.values(way), guide))


def explain_pose(question: Question) -> IKExplanation:
    """The worked solution of a pose, see :meth:`dh2urdf.Robot.explain_ik`."""
    case = Case(question)
    index, branch = None, ""
    if len(question.q):
        index, branch = question.numbers[question.index], question.branches[question.index]
    steps, q = [*case.notes], None
    if case.lesson is None:
        steps.append(Step("The solver", question.details))
    else:
        steps.append(taken_off(case.arm, case.T, case.pose(), case.task is Task.POSITION))
        way = case.chosen()
        steps += [_named(_drawn(step, case, way), branch, case.joints) for step in way.steps]
        steps = [_in_base(step, case.base) for step in steps]
        if not way.stopped:
            q, check = _placed(case, way)
            steps.append(check)
    if len(question.q) > 1:
        steps.append(_branches(question))
    return IKExplanation(question.name, question.solver, question.T, tuple(steps), q, index, branch)


def _drawn(step: Step, case: Case, way: Way) -> Step:
    """A step with its joint's arc or slide, once the joints before it are known, too."""
    known = [way.variables.get(i) for i in range(case.arm.n)]
    if step.joint is None or any(v is None for v in known[: step.joint + 1]):
        return step
    values = [float(v or 0.0) for v in known]
    return replace(step, marks=(*step.marks, joint_mark(case.arm, values, step.joint)))


def _in_base(step: Step, base: Array) -> Step:
    """A step whose marks are seen from the arm's own base."""
    return replace(step, marks=tuple(mark.seen_from(base) for mark in step.marks))


def _named(step: Step, branch: str, joints: list[int]) -> Step:
    """A step with the arm's own joint, and its choice by the name that ``ik`` prints."""
    joint = None if step.joint is None else joints[step.joint]
    name = next((w for w in branch.split(", ") if step.choice and w.startswith(step.choice)), "")
    words = f"{step.words} `ik` calls this choice: {name}." if name else step.words
    return replace(step, words=words, joint=None if joint == -1 else joint)


def _placed(case: Case, way: Way) -> tuple[Array, Step]:
    """The configuration of the arm, each angle in the turn in which ``ik`` gives it; the check."""
    found, guide, question = case.values(way), case.guide, case.question
    miss = pose_error(case.arm.fk(found), case.T)
    if case.task is Task.POSITION:
        miss = math.dist(case.arm.fk(found)[:3, 3], case.T[:3, 3])
    n = question.chain.n
    q = np.array([question.held.get(i, 0.0) for i in range(n)])
    turned = False
    for k, joint in enumerate(case.joints):
        if joint < 0:
            continue
        q[joint] = found[k]
        if guide is not None and not case.chain.prismatic[k]:
            turns = round((guide[k] - found[k]) / math.tau)
            q[joint] += math.tau * turns
            turned |= bool(turns) and abs(guide[k]) > math.pi + 1e-9
    return q, _check(case, q, miss, turned)


def _check(case: Case, q: Array, miss: float, turned: bool) -> Step:
    """Forward kinematics of what was found."""
    n, T = case.arm.n, case.question.T
    turn = " Angles are in the turn that the joint's limits ask for." if turned else ""
    what = "the point" if case.task is Task.POSITION else "the pose"
    return Step(
        "The check",
        f"q = {vector_shown(q)}. Put into H_{n}^0 = H_1^0 ... H_{n}^{n - 1}, between base and "
        f"tool, these values give {what} asked for, to {miss:.1e} (metres and radians).{turn}",
        (Equation("o", "FK(q)", {}, T[:3, 3], "m"),),
    )


def _held(question: Question, joints: list[int]) -> Step:
    """Which joints are held; what the others are called."""
    names, held = question.chain.names, question.held
    parts = (f"{names[i]} at {shown(v)}" for i, v in held.items())
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


def _branches(question: Question) -> Step:
    """All solutions, and what each is called."""
    lines = []
    for k, (q, branch) in enumerate(zip(question.q, question.branches, strict=True)):
        mark = "  <- this one" if k == question.index else ""
        lines.append(f"{question.numbers[k] + 1}: {vector_shown(q)}  {branch}{mark}".rstrip())
    words = (
        "What `ik` finds, one for each choice on the way; the steps above lead to the one marked."
    )
    return Step("All solutions", f"{words}\n\n" + "\n".join(lines))
