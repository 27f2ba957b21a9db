"""Worked solutions: every value is the kernel's, every formula gives its value."""

import itertools
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


NO_CLOSED_FORM = {
    "abb_gofa5",
    "fanuc_crx10ia",
    "fanuc_crx10ia_l",
    "kinova_jaco2",
    "niryo_ned2",
    "xarm6",
}

ARMS = tuple(name for name in dh2urdf.list_tables() if name not in NO_CLOSED_FORM)

KINDS = tuple("".join(kinds) for kinds in itertools.product("RP", repeat=3))


def regular_poses(robot, count, rng):
    """Poses of random configurations that are away from singular ones."""
    while count:
        q = np.where(robot.slides, 0.5, 3.0) * rng.uniform(-1.0, 1.0, robot.n)
        J = robot.jacobian(q)
        J[:3] /= robot.chain.size
        if np.linalg.svd(J, compute_uv=False)[-1] > REGULAR:
            count -= 1
            yield robot.fk(q)


def assert_agrees(robot, T, one, rounding=ROUNDING):
    """The kernel's solutions are the derivation's; the steps of one end in its values."""
    found = robot.ik(T, within_limits=False)
    case = Case(question_of(robot, found))
    ways = [case.values(way) for way in case.ways() if not way.stopped]
    kernel = case.question.q[:, case.joints]
    assert len(ways) == len(kernel), (robot.table.name, T)
    for p in kernel:
        assert min(case.apart(q, p) for q in ways) <= rounding, (robot.table.name, T, p)
    told = robot.explain_ik(found, one % len(found))
    q = found.q[one % len(found)]
    assert np.abs(told.q - q).max() <= rounding
    for step in told.steps:
        if step.joint is not None:
            gap = step.value - q[step.joint]
            gap -= 0.0 if robot.slides[step.joint] else math.tau * round(gap / math.tau)
            assert abs(gap) <= rounding, (robot.table.name, step.title, T)
        for equation in step.equations:
            if is_plain(equation):
                assert off(equation) <= 1e-9, (robot.table.name, step.title, equation.name)


@pytest.mark.parametrize("name", ARMS)
def test_values_of_the_steps_are_the_kernels(name):
    """All solutions of 4 random poses, to 1e-12, and each formula gives the value beside it."""
    robot = dh2urdf.Robot.from_dh(name)
    for k, T in enumerate(regular_poses(robot, 4, np.random.default_rng(5))):
        assert_agrees(robot, T, k)


def wrist_arm(kinds, rng):
    """A table with a spherical wrist, right-angled or skew, behind three joints of any kind."""
    rows = rng.uniform(-0.5, 0.5, (6, 4)) * [2.0, 1.0, 1.0, 4.0]
    rows[3:5, 2] = rows[4, 1] = 0.0
    rows[3:5, 3] = rng.uniform(0.6, 2.4, 2) if rng.integers(2) else (0.5 * np.pi, -0.5 * np.pi)
    return dh2urdf.DHTable.from_array(rows, "standard", joint_types=kinds + "RRR", name=kinds)


@pytest.mark.parametrize("kinds", KINDS)
def test_any_three_joints_place_the_wrist_as_the_kernels_do(kinds):
    """Random arms, turning and sliding, with right-angled and skew wrists."""
    rng = np.random.default_rng(7)
    for _ in range(3):
        robot = dh2urdf.Robot.from_dh(wrist_arm(kinds, rng))
        for k, T in enumerate(regular_poses(robot, 2, rng)):
            assert_agrees(robot, T, k, 1e-10)


def test_arms_without_a_derivation_are_those_without_a_closed_form():
    """A table that ships and is in a closed family has its steps; no other one claims to."""
    for name in ("xarm6", "ur5", "px150", "cylindrical"):
        robot = dh2urdf.Robot.from_dh(name)
        found = robot.ik(robot.fk(np.full(robot.n, 0.3)), within_limits=False)
        lesson = Case(question_of(robot, found)).lesson
        assert (lesson is None) == (name in NO_CLOSED_FORM)


@pytest.mark.exhaustive
@pytest.mark.parametrize("name", ARMS)
def test_values_of_the_steps_are_the_kernels_for_a_thousand_poses(name):
    """All solutions of 1,000 random poses, to 1e-12."""
    robot = dh2urdf.Robot.from_dh(name)
    for k, T in enumerate(regular_poses(robot, 1000, np.random.default_rng(6))):
        assert_agrees(robot, T, k)
