"""A sequence of poses as a joint path."""

import math
from functools import cache

import numpy as np
import pytest
from margins import assert_margin

import dh2urdf
from dh2urdf.exceptions import ConfigurationError


@cache
def robot_of(name):
    return dh2urdf.Robot.from_dh(name)


def line(start, end, count):
    return np.linspace(0, 1, count)[:, None] * (np.array(end) - start) + start


def errors(robot, path, Ts):
    return np.abs([robot.fk(q) for q in path.q] - Ts)


@pytest.mark.parametrize("name", ["denso_vs6556", "ur5", "planar_rrr"])
def test_a_joint_line_is_followed(name):
    """From its start, the path through the poses of a joint line is that line."""
    robot = robot_of(name)
    start = np.array([0.2, -1.1, 0.6, 0.4, 0.7, 0.3][: robot.n])
    q = line(start, start + 0.5, 300)
    Ts = robot.fk(q)
    path = robot.ik_path(Ts, start=start)
    assert path.continuous
    assert_margin(np.abs(path.q - q), 1e-9)
    assert path.motion == pytest.approx(np.linalg.norm(q[-1] - q[0]))


def test_the_path_turns_beyond_half_a_turn():
    """A joint that turns through pi goes on into the next turn of its range."""
    robot = robot_of("ur5")
    q = line(np.array([0.2, -1.1, 0.6, 0.4, 0.7, 2.5]), [0.2, -1.1, 0.6, 0.4, 0.7, 5.0], 300)
    path = robot.ik_path(robot.fk(q), start=q[0])
    assert path.continuous
    assert_margin(np.abs(path.q - q), 1e-9)


def test_without_a_start_the_least_motion_is_chosen():
    """No branch of the poses moves less than the path that is returned."""
    robot = robot_of("denso_vs6556")
    start = np.array([0.2, -1.1, 0.6, 0.4, 0.7, 0.3])
    Ts = robot.fk(line(start, start + np.array([0.5, 0.3, -0.2, 0.4, 0.1, 0.2]), 15))
    best = robot.ik_path(Ts)
    assert best.continuous
    assert_margin(errors(robot, best, Ts), 1e-9)
    for first in robot.ik(Ts[0]):
        other = robot.ik_path(Ts, start=first)
        if other.continuous and np.abs(other.q[0] - first).max() < 1e-9:
            assert best.motion <= other.motion + 1e-9


def test_a_singular_family_is_entered_where_the_path_comes_from():
    """Through a wrist in line, joints 4 and 6 keep the values that the neighbours have."""
    robot = robot_of("denso_vs6556")
    start = np.array([0.2, -1.1, 0.6, 0.9, -0.4, 0.3])
    q = line(start, [0.2, -1.1, 0.6, 0.9, 0.4, 0.3], 21)
    assert abs(q[10, 4]) < 1e-12
    path = robot.ik_path(robot.fk(q), start=start)
    assert path.continuous
    assert_margin(np.abs(path.q - q), 1e-7)


def test_of_equal_ways_the_one_near_the_middle_of_the_limits_is_taken():
    """Without a start, no joint begins a turn away from where it could."""
    robot = robot_of("ur5")
    path = robot.ik_path(
        robot.fk(line([3.0, -1.0, 1.0, -0.5, 0.5, 0.0], [2.5, -1.5, 1, 0, 1, 1], 9))
    )
    assert path.continuous
    middle = 0.5 * (robot.lower + robot.upper)
    assert np.abs(path.q[0] - middle).max() <= math.pi + 1e-9


def test_a_break_is_named():
    """Where no branch goes on, the path says between which poses and which joint jumps."""
    robot = robot_of("planar_rrr")
    a = robot.fk(line([0.2, 0.8, 0.3], [0.3, 0.9, 0.3], 5))
    b = robot.fk(line([2.2, 0.8, 0.3], [2.3, 0.9, 0.3], 5))
    path = robot.ik_path(np.concatenate([a, b]))
    assert path.breaks == (5,)
    assert not path.continuous
    assert "break between poses 4 and 5: joint_" in str(path)
    assert_margin(errors(robot, path, np.concatenate([a, b])), 1e-9)


def test_unreachable_poses_are_left_out_and_named():
    """A pose out of reach is NaN and named; the path goes on behind it."""
    robot = robot_of("denso_vs6556")
    start = np.array([0.2, -1.1, 0.6, 0.4, 0.7, 0.3])
    Ts = robot.fk(line(start, start + 0.2, 9))
    Ts[4, 0, 3] = 50.0
    path = robot.ik_path(Ts, start=start)
    assert path.unreachable == (4,)
    assert np.isnan(path.q[4]).all()
    assert np.isfinite(np.delete(path.q, 4, axis=0)).all()
    assert "pose 4 is out of reach" in str(path)


def test_a_smaller_jump_is_a_break_when_asked():
    """max_jump sets what counts as a break; it must be positive."""
    robot = robot_of("planar_rrr")
    Ts = robot.fk(line([0.2, 0.8, 0.3], [0.6, 1.2, 0.5], 3))
    assert robot.ik_path(Ts).continuous
    assert robot.ik_path(Ts, max_jump=0.01).breaks == (1, 2)
    with pytest.raises(ConfigurationError, match="max_jump: expected a number from"):
        robot.ik_path(Ts, max_jump=-1.0)


def test_a_line_in_space_through_all_of_the_workspace():
    """200 poses on a straight line: every pose reached, steps no longer than twice the mean."""
    robot = robot_of("denso_vs6556")
    T = robot.fk([0.0, -1.2, 0.9, 0.0, 0.9, 0.0])
    Ts = np.repeat(T[None], 200, axis=0)
    Ts[:, 1, 3] = np.linspace(-0.15, 0.15, 200)
    path = robot.ik_path(Ts)
    assert path.continuous
    steps = np.linalg.norm(np.diff(path.q, axis=0), axis=1)
    assert steps.max() < 2 * steps.mean()
    assert math.isfinite(path.motion)
