"""Paths of arms with seven joints: the least joint motion, against a search on a dense grid."""

from functools import cache

import numpy as np
import pinocchio as pin
import pytest
from example_robots import example
from hypothesis import given, settings
from hypothesis import strategies as st
from path_referee import least_motion, length_of

import dh2urdf

ARMS = ["franka_fer", "franka_fr3", "kuka_iiwa7", "kuka_iiwa14", "xarm7", "kinova_gen3"]
TIAGO = example("tiago_no_hand.urdf")
PANDA = np.array([0.3, -0.5, 0.2, -2.0, 0.1, 1.6, 0.7])
MARGIN = 1.002
"""Motion that a path may have, per motion of the dense search: a fifth of what is promised."""


@cache
def robot_of(name):
    if name == "tiago":
        return dh2urdf.Robot.from_urdf(TIAGO, base="torso_lift_link", tip="arm_7_link")
    return dh2urdf.Robot.from_dh(name)


def line(robot, q, count, way=(0.0, 0.2, 0.0)):
    """Poses from that of q on a straight line, the orientation kept."""
    Ts = np.repeat(robot.fk(q)[None], count, axis=0)
    Ts[:, :3, 3] += np.linspace(0.0, 1.0, count)[:, None] * way
    return Ts


def arc(robot, q, count, u, v, angle):
    """Poses from that of q half round a circle of 15 cm, turning about its axis by an angle."""
    Ts = np.repeat(robot.fk(q)[None], count, axis=0)
    part = np.linspace(0.0, 1.0, count)
    x, y = np.cos(np.pi * part) - 1.0, np.sin(np.pi * part)
    Ts[:, :3, 3] += 0.15 * (x[:, None] * u + y[:, None] * v)
    turns = np.array([pin.exp3(angle * s * np.cross(u, v)) for s in part])
    Ts[:, :3, :3] = turns @ Ts[:, :3, :3]
    return Ts


def drawn(robot, seed, count):
    """A configuration, and a line or an arc of poses that begins there and is in reach."""
    rng = np.random.default_rng(seed)
    while True:
        q = rng.uniform(0.8 * np.maximum(robot.lower, -3), 0.8 * np.minimum(robot.upper, 3))
        u, v = np.linalg.qr(rng.normal(size=(3, 2)))[0].T
        angle = 0.8 * (seed % 3 - 1)

        def poses(count, q=q, u=u, v=v, angle=angle):
            if seed % 2:
                return arc(robot, q, count, u, v, angle)
            return line(robot, q, count, 0.3 * u)

        if robot.ik_batch(poses(60)).count.min() > 0:
            return q, poses(count)


def check(robot, path, Ts, within_limits=True):
    """Every pose is reached, as Pinocchio measures, inside the limits, and no joint jumps."""
    assert path.continuous, str(path)
    found = np.array([robot.fk(q) for q in path.q])
    assert np.linalg.norm(found[:, :3, 3] - Ts[:, :3, 3], axis=1).max() <= 1e-9
    assert np.abs(found[:, :3, :3] - Ts[:, :3, :3]).max() <= 1e-9
    assert np.abs(np.diff(path.q, axis=0)).max(initial=0.0) <= path.max_jump
    if within_limits:
        assert np.all((path.q >= robot.lower) & (path.q <= robot.upper))


def check_least(robot, Ts, start, values):
    """The path is as short as the shortest one on a dense grid."""
    path = robot.ik_path(Ts, start=start)
    check(robot, path, Ts)
    least, _ = least_motion(robot, Ts, start, values)
    assert length_of(path.q, start) <= MARGIN * least


def test_a_line_of_the_panda_takes_no_more_than_it_must():
    """A line of 20 cm: what any joint held takes is more, and a dense search finds no less."""
    robot = robot_of("franka_fer")
    Ts = line(robot, PANDA, 50)
    path = robot.ik_path(Ts, start=PANDA)
    check(robot, path, Ts)
    held = [robot.ik_path(Ts, start=PANDA, locked={i: PANDA[i]}) for i in range(7)]
    assert path.motion < min(p.motion for p in held if p.continuous)
    assert path.motion <= MARGIN * least_motion(robot, Ts, PANDA)[0]


@pytest.mark.parametrize("name", ["franka_fer", "franka_fr3", "xarm7", "tiago"])
@pytest.mark.parametrize("seed", [0, 1])
@pytest.mark.parametrize("begun", [True, False])
def test_no_path_on_a_dense_grid_is_shorter(name, seed, begun):
    """On lines and arcs, from a configuration and from any, the motion is the least."""
    robot = robot_of(name)
    q, Ts = drawn(robot, seed, 20)
    check_least(robot, Ts, q if begun else None, 90)


@pytest.mark.exhaustive
@pytest.mark.parametrize("name", [*ARMS, "tiago"])
@pytest.mark.parametrize("seed", range(10))
@pytest.mark.parametrize("begun", [True, False])
def test_no_path_on_a_very_dense_grid_is_shorter(name, seed, begun):
    """On ten lines and arcs of each arm the motion is the least."""
    robot = robot_of(name)
    q, Ts = drawn(robot, seed, 40)
    check_least(robot, Ts, q if begun else None, 360)


@pytest.mark.parametrize("name", ARMS)
def test_steps_shrink_with_the_path(name):
    """With twice and four times as many poses, steps are a half and a quarter, the motion equal."""
    robot = robot_of(name)
    q, _ = drawn(robot, 2, 5)
    paths = [robot.ik_path(drawn(robot, 2, m)[1], start=q) for m in (51, 101, 201)]
    longest = [np.linalg.norm(np.diff(p.q, axis=0), axis=1).max() for p in paths]
    assert longest[1] == pytest.approx(longest[0] / 2, rel=0.1)
    assert longest[2] == pytest.approx(longest[0] / 4, rel=0.1)
    assert paths[2].motion == pytest.approx(paths[0].motion, rel=2e-3)


@settings(max_examples=40)
@given(name=st.sampled_from(ARMS), seed=st.integers(0, 10**6), count=st.integers(2, 60))
def test_a_path_is_no_longer_than_one_that_is_known(name, seed, count):
    """Through the poses of a line in joint space it moves no more than that line."""
    robot, rng = robot_of(name), np.random.default_rng(seed)
    low, high = np.maximum(robot.lower, -3), np.minimum(robot.upper, 3)
    ends = rng.uniform(low, high, (2, robot.n))
    ends[1] = ends[0] + 0.3 * (ends[1] - ends[0])
    known = np.linspace(*ends, count)
    if np.abs(np.diff(known, axis=0)).max() > 0.4:
        return
    Ts = robot.fk(known)
    path = robot.ik_path(Ts, start=ends[0])
    check(robot, path, Ts)
    assert length_of(path.q, ends[0]) <= length_of(known, ends[0]) * (1 + 1e-6)
    free = robot.ik_path(Ts)
    check(robot, free, Ts)
    assert free.motion <= MARGIN * path.motion


def test_poses_out_of_reach_are_passed_over():
    """The path goes on behind them by the least motion, and names them."""
    robot = robot_of("franka_fer")
    Ts = line(robot, PANDA, 30)
    whole = robot.ik_path(Ts, start=PANDA)
    Ts[10:13, 0, 3] = 5.0
    path = robot.ik_path(Ts, start=PANDA)
    assert path.unreachable == (10, 11, 12)
    assert not path.breaks
    assert path.motion <= whole.motion
    assert path.motion == pytest.approx(whole.motion, rel=1e-3)
    nowhere = robot.ik_path(Ts[10:13], start=PANDA)
    assert nowhere.unreachable == (0, 1, 2)
    assert np.isnan(nowhere.q).all()


def test_a_repeated_pose_is_a_rest():
    """Where the tool stays the joints do; one pose alone leaves the start where it is."""
    robot = robot_of("kuka_iiwa14")
    q = np.array([0.3, 0.5, 0.2, -1.3, 0.1, 0.9, 0.4])
    Ts = line(robot, q, 20)
    plain = robot.ik_path(Ts, start=q)
    path = robot.ik_path(np.concatenate([Ts[:10], Ts[9:10], Ts[9:10], Ts[10:]]), start=q)
    assert np.abs(np.diff(path.q[9:12], axis=0)).max() < 1e-4
    assert path.motion == pytest.approx(plain.motion, rel=1e-5)
    rest = robot.ik_path(np.repeat(Ts[:1], 12, axis=0), start=q)
    assert np.abs(rest.q - q).max() < 1e-5
    assert np.abs(robot.ik_path(Ts[:1], start=q).q - q).max() < 1e-6


def test_a_break_is_one_and_both_parts_are_short():
    """Two lines far apart: one break, and each part moves as little as alone."""
    robot = robot_of("franka_fer")
    a = line(robot, PANDA, 20)
    b = line(robot, [-1.5, 0.5, -0.2, -1.0, 2.0, 1.0, 0.0], 20)
    path = robot.ik_path(np.concatenate([a, b]), start=PANDA)
    assert path.breaks == (20,)
    steps = np.linalg.norm(np.diff(path.q, axis=0), axis=1)
    assert np.delete(steps, 19).max() < 0.15
    least = length_of(robot.ik_path(a, start=PANDA).q, PANDA) + robot.ik_path(b).motion
    assert path.motion >= 0.998 * least


def test_without_limits_the_way_is_not_longer():
    """What holds within the limits holds without them."""
    robot = robot_of("franka_fer")
    Ts = line(robot, PANDA, 30)
    bounded = robot.ik_path(Ts, start=PANDA)
    free = robot.ik_path(Ts, start=PANDA, within_limits=False)
    check(robot, free, Ts, within_limits=False)
    assert free.motion <= bounded.motion + 1e-9


def test_a_path_through_a_wrist_in_line_goes_on():
    """Where two axes meet in one line the path passes, no longer than a line in joint space."""
    robot = robot_of("kuka_iiwa14")
    ends = np.array([[0.2, 0.5, 0.1, -0.8, 0.3, -0.4, 0.1], [0.2, 0.5, 0.1, -0.8, 0.3, 0.4, 0.1]])
    known = np.linspace(*ends, 41)
    Ts = robot.fk(known)
    path = robot.ik_path(Ts, start=ends[0])
    check(robot, path, Ts)
    assert path.motion <= length_of(known, None) + 1e-6


def test_a_held_joint_stays():
    """With one of seven joints locked the path is that of the other six."""
    robot = robot_of("franka_fer")
    Ts = line(robot, PANDA, 20)
    path = robot.ik_path(Ts, start=PANDA, locked={0: PANDA[0]})
    assert np.all(path.q[:, 0] == PANDA[0])
    assert path.motion >= robot.ik_path(Ts, start=PANDA).motion
