"""Configurations exactly at limits: where a family only touches them, and beside a double root.

The cross slide's first two joints are at their upper ends, 1.5 m and 0.4 m.
"""

import math

import numpy as np
import pytest
from ik_referee import gaps

import dh2urdf

H = math.pi / 2

CORNER = np.array([1.5, 0.4, H, H, H, math.pi])
"""A member of a family of joints 1, 2, 3 and 6, which has no other one inside the limits."""


@pytest.fixture(scope="module")
def robot():
    return dh2urdf.Robot.from_dh("cross_slide_arm")


@pytest.mark.parametrize("locked", [{}, *({i: CORNER[i]} for i in range(6))])
@pytest.mark.parametrize("seeded", [False, True])
def test_the_one_member_of_a_family_at_a_corner_of_the_limits_is_found(robot, locked, seeded):
    """The curve of solutions comes to the limits there, and is outside to either side."""
    T = robot.fk(CORNER)
    found = robot.ik(T, seed=CORNER if seeded else None, locked=locked or None)
    assert gaps(robot.chain, found.q, CORNER).min() < 1e-9
    assert robot.why_unreachable(T) == ""


@pytest.mark.parametrize("away", [1e-6, 1e-3])
def test_a_family_that_ends_before_the_limits_has_no_member_in_them(robot, away):
    """The corner a little farther in, the curve passes it by outside."""
    T = robot.fk(CORNER + away * np.array([1, 1, 0, 0, 0, 0]))
    assert len(robot.ik(T)) == 0
    assert len(robot.ik(T, within_limits=False)) == 1
    assert "all 1 solutions are outside the joint limits" in robot.why_unreachable(T)


def test_why_a_pose_is_not_reached_looks_at_all_members_of_a_family(robot):
    """One of them is inside the limits, whichever represents the family."""
    T = robot.fk([1.4, 0.3, H, H, H, math.pi])
    assert len(robot.ik(T)) == 1
    assert robot.why_unreachable(T) == ""


@pytest.mark.parametrize("joint", range(6))
def test_a_double_root_on_two_limits_is_found_with_any_joint_held(robot, joint):
    """Off by a nanometre there, which the pose hardly tells, it is put onto them by all joints."""
    q = np.array([1.5, 0.4, H, 0.0, 0.0, 0.0])
    found = robot.ik(robot.fk(q), locked={joint: q[joint]})
    assert gaps(robot.chain, found.q, q).min() < 1e-7
    assert (found.q <= robot.upper).all()
