"""The entry: a pose of an arm, explained along one of the solutions that ``ik`` gave."""

import math
import textwrap
from dataclasses import replace

import numpy as np

from dh2urdf.ik.arm import Task
from dh2urdf.lessons.case import Case, Question
from dh2urdf.lessons.controller import controllers_values
from dh2urdf.lessons.ends import taken_off
from dh2urdf.lessons.marks import elbow_side, joint_mark
from dh2urdf.lessons.notation import measured, vector_shown
from dh2urdf.lessons.steps import Equation, IKExplanation, Step
from dh2urdf.lessons.way import Way
from dh2urdf.lessons.wording import WIDTH
from dh2urdf.transforms import Array, pose_error

LIMIT = 1e-9
"""Excess over a joint's limit [rad or m] that is rounding."""


def explain_pose(question: Question) -> IKExplanation:
    """The worked solution of a pose, see :meth:`dh2urdf.Robot.explain_ik`."""
    case = Case(question)
    index, branch = None, ""
    if len(question.q):
        index, branch = question.numbers[question.index], question.branches[question.index]
    steps, q = [*case.notes], None
    if case.lesson is None:
        lines = (textwrap.fill(line, WIDTH) for line in question.details.split("\n"))
        steps.append(Step("The solver", "\n".join(lines)))
    else:
        steps.append(taken_off(case.arm, case.T, case.pose(), case.task is Task.POSITION))
        way = case.chosen()
        steps += [_named(_drawn(step, case, way), branch, case.joints) for step in way.steps]
        steps = [_leaning(_in_base(step, case.base), case, way, branch) for step in steps]
        if not way.stopped:
            q, check = _placed(case, way)
            steps.append(check)
            if question.values is not None:
                q, step = controllers_values(question, q)
                steps.append(step)
    if len(question.q):
        steps.append(_branches(question, led=case.lesson is not None))
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
    name = _choice(step, branch)
    words = f"{step.words} `ik` calls this choice: {name}." if name else step.words
    return replace(step, words=words, joint=None if joint == -1 else joint)


def _choice(step: Step, branch: str) -> str:
    """What ``ik`` calls the choice of a step; empty where there is none, or no name."""
    return next((w for w in branch.split(", ") if step.choice and w.startswith(step.choice)), "")


def _leaning(step: Step, case: Case, way: Way, branch: str) -> Step:
    """A step with a word where the elbow called up is the lower one, or that called down upper."""
    name = _choice(step, branch)
    if step.choice != "elbow" or not name or 0 not in way.variables:
        return step
    axis = (case.base @ case.arm.base @ case.arm.frames(way.first(1))[1])[:3, 2]
    side = elbow_side(step.marks, axis)
    if side == {"elbow up": "upper", "elbow down": "lower"}[name] or not side:
        return step
    return replace(
        step,
        words=f"{step.words} The name is that of an arm that leans forward; as this one leans, "
        f"the elbow is the {side} of the two.",
    )


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
    chain = case.question.chain
    excess = np.maximum(chain.lower - q, q - chain.upper)
    outside = [
        f"{chain.names[i]} by {measured(float(excess[i]), 'm' if chain.prismatic[i] else 'rad')}"
        for i in np.flatnonzero(excess > LIMIT)
    ]
    if outside:
        turn += f" It is outside the limits of {' and '.join(outside)}."
    what = "the point" if case.task is Task.POSITION else "the pose"
    return Step(
        "The check",
        f"q = {vector_shown(q)}. Put into H_{n}^0 = H_1^0 ... H_{n}^{n - 1}, between base and "
        f"tool, these values give {what} asked for, to {miss:.1e} (metres and radians).{turn}",
        (Equation("o", "FK(q)", {}, T[:3, 3], "m"),),
    )


def _branches(question: Question, *, led: bool) -> Step:
    """All solutions, their names, which are outside the limits; ``led``: steps lead to one."""
    chain, count, lines = question.chain, len(question.q), []
    excess = np.maximum(chain.lower - question.q, question.q - chain.upper)
    outside, given = excess.max(axis=1) > LIMIT, question.q
    if question.values is not None:
        given, own = question.values.q, question.values.coupling
        outside |= np.maximum(own.lower - given, given - own.upper).max(axis=1) > LIMIT
    for k, (q, branch) in enumerate(zip(given, question.branches, strict=True)):
        named = [branch] if branch else []
        named += ["outside the limits"] if outside[k] else []
        mark = "  <- this one" if k == question.index and count > 1 and led else ""
        numbered = f"{question.numbers[k] + 1}: {vector_shown(q)}  {', '.join(named)}"
        lines.append(f"{numbered.rstrip()}{mark}")
    apart = given - given[question.index]
    turned = int((np.abs(apart - math.tau * np.round(apart / math.tau)).max(axis=1) < LIMIT).sum())
    ways = "other choices on the way" + (", or whole turns," if turned > 1 else "")
    held = " with what is held" if question.held else ""
    limits = (
        ", those outside the joint limits counted" if outside.any() else " within the joint limits"
    )
    words = f"`ik` finds {count} solution{'s' if count > 1 else ''}{held}{limits}"
    if led and count > 1:
        words += f"; the steps above lead to the one marked, {ways} to the others."
    else:
        words += ", the one that the steps above lead to." if led else "."
    return Step("All solutions", f"{words}\n\n" + "\n".join(lines))
