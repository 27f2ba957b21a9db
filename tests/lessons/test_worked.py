"""Worked solutions: every value is the kernel's, every formula gives its value."""

import math

import numpy as np
import pytest
from formulas import is_plain, off

import dh2urdf
from dh2urdf.lessons.worked import Case
from dh2urdf.robot.explained import question_of

ROUNDING = 1e-12
"""What the value of a step may differ from the kernel's by [rad or m]."""

REGULAR = 1e-3
"""Smallest singular value of the Jacobian, lengths in sizes of the arm, of poses that are compared:
beside a singular one both sides have rounding over this."""


def robots():
    """Arms that ship whose solver has a lesson."""
    for name in dh2urdf.list_tables():
        robot = dh2urdf.Robot.from_dh(name)
        question = question_of(
            robot, robot.ik(robot.fk(np.full(robot.n, 0.3)), within_limits=False)
        )
        if Case(question).lesson is not None:
            yield name


ARMS = tuple(robots())


def regular_poses(robot, count, rng):
    """Poses of random configurations that are away from singular ones."""
    while count:
        q = np.where(robot.slides, 0.5, 3.0) * rng.uniform(-1.0, 1.0, robot.n)
        J = robot.jacobian(q)
        J[:3] /= robot.chain.size
        if np.linalg.svd(J, compute_uv=False)[-1] > REGULAR:
            count -= 1
            yield robot.fk(q)


def assert_agrees(robot, T, one):
    """The kernel's solutions are the derivation's; the steps of one end in its values."""
    found = robot.ik(T, within_limits=False)
    case = Case(question_of(robot, found))
    ways = [case.values(way) for way in case.ways() if not way.stopped]
    kernel = found.q[:, case.joints] if len(found) else np.empty((0, robot.n))
    if case.question.held:
        kernel = case.question.q[:, case.joints]
    assert len(ways) == len(kernel), (robot.table.name, T)
    for p in kernel:
        assert min(case.apart(q, p) for q in ways) <= ROUNDING, (robot.table.name, T, p)
    told = robot.explain_ik(found, one % len(found))
    q = found.q[one % len(found)]
    assert np.abs(told.q - q).max() <= ROUNDING
    for step in told.steps:
        if step.joint is not None:
            gap = step.value - q[step.joint]
            gap -= 0.0 if robot.slides[step.joint] else math.tau * round(gap / math.tau)
            assert abs(gap) <= ROUNDING, (robot.table.name, step.title, T)
        for equation in step.equations:
            if is_plain(equation):
                assert off(equation) <= 1e-9, (robot.table.name, step.title, equation.name)


@pytest.mark.parametrize("name", ARMS)
def test_values_of_the_steps_are_the_kernels(name):
    """All solutions of 10 random poses, to 1e-12, and each formula gives the value beside it."""
    robot = dh2urdf.Robot.from_dh(name)
    for k, T in enumerate(regular_poses(robot, 10, np.random.default_rng(5))):
        assert_agrees(robot, T, k)


@pytest.mark.exhaustive
@pytest.mark.parametrize("name", ARMS)
def test_values_of_the_steps_are_the_kernels_for_a_thousand_poses(name):
    """All solutions of 1,000 random poses, to 1e-12."""
    robot = dh2urdf.Robot.from_dh(name)
    for k, T in enumerate(regular_poses(robot, 1000, np.random.default_rng(6))):
        assert_agrees(robot, T, k)
