"""A family is named where a walk along it stays on the pose, and where there is none, none is."""

import numpy as np
import pytest
from dh_arm import arm_of
from self_motions import LENGTHS, is_family
from structured import shipped_tables, structured_configurations

import dh2urdf

CLOSED = ("spherical wrist", "spherical shoulder", "three parallel axes")
ALL = np.ones(6, bool)

IN_LINE = (0.0, 1e-12, 1e-10, 1e-7, 1e-6)
"""Angles [rad] between axes 4 and 6."""


@pytest.mark.parametrize("name", ["ur5", "ur5e", "ur10", "ur10e"])
def test_an_upright_arm_of_parallel_axes_is_isolated(name):
    """Axes 2, 3, 4 and 6 are parallel there, but the stretched arm holds all of them."""
    robot = dh2urdf.Robot.from_dh(name)
    q = np.radians([0.0, -90.0, 0.0, -90.0, 0.0, 0.0])
    found = robot.ik(robot.fk(q), within_limits=False)
    assert found.free_joints == ((),) * len(found)
    assert np.abs(found.q - q).max(axis=1).min() < 1e-6


@pytest.mark.parametrize("angle", IN_LINE)
def test_a_wrist_is_a_family_as_far_as_a_turn_is_accepted(angle):
    """Axes 4 and 6 turn together while the angle between them, times the turn, is below 1e-9."""
    robot = dh2urdf.Robot.from_dh("puma560")
    q = np.array([0.3, -0.8, 0.5, 1.1, angle, -0.4])
    found = robot.ik(robot.fk(q), within_limits=False)
    here = np.abs(found.q[:, :3] - q[:3]).max(axis=1) < 1e-6
    named = {free for free, near in zip(found.free_joints, here, strict=True) if near}
    assert named == ({(3, 5)} if 2.0 * np.pi * angle <= 1e-9 else {()})


def test_a_walk_by_the_named_joints_stays_on_the_pose_and_none_by_others_is_left_out():
    """At structured poses, a tenth of the walk is judged by the tests' own."""
    for table in shipped_tables():
        robot = dh2urdf.Robot.from_dh(table)
        if str(robot.solver) not in CLOSED or len(table.rows) != 6:
            continue
        arm = arm_of(table)
        for q in structured_configurations(arm, 8, 11):
            T = robot.fk(q)
            found = robot.ik(T, within_limits=False)
            for p, free in zip(found.q, found.free_joints, strict=True):
                bits = np.isin(np.arange(6), free)
                if free:
                    assert is_family(arm, p, T, bits), (table.name, q)
                else:
                    assert not is_family(arm, p, T, ALL, 1e-12, LENGTHS[:1]), (table.name, q)
