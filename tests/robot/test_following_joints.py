"""Robots of URDFs with followers, from end to end: a hollow wrist and palletisers."""

import numpy as np
import pytest

from dh2urdf import Robot
from dh2urdf.exceptions import NoSolverError

HOLLOW = (
    ("0 0 0", "0 0 0", "0 0 1", ""),
    ("0.3 0 0.66", "0 0 0", "0 1 0", ""),
    ("0 0 1.2", "0 0 0", "0 1 0", ""),
    ("1.339 0 0.186", "0 0 0", "1 0 0", ""),
    ("0.0693 0 0", "0 0.6109 0", "1 0 0", ""),
    ("0.106246 0 0.074394", "0 -1.2217 0", "1 0 0", "j5 -1"),
    ("0.0672 0 -0.047", "0 0.6109 0", "1 0 0", ""),
)

LEVEL = (
    ("0 0 0.131305", "0 0 0", "0 0 1", ""),
    ("0 0 0", "0 0 0", "0 1 0", ""),
    ("0 0 0.135", "0 0 0", "0 1 0", ""),
    ("0.147 0 0", "0 0 0", "0 1 0", "j2 -1"),
    ("0 0 0", "0 0 0", "0 1 0", "j3 -1"),
    ("0.06 0 0", "0 0 0", "0 0 1", ""),
)


def urdf(joints, tool="0 0 0", limit=6.0, kinds=None):
    """A chain of joints: origin, its angles, axis, what it follows and by how much."""
    parts, parent = ['<robot name="arm"><link name="base"/>'], "base"
    for i, (xyz, rpy, axis, follows) in enumerate(joints, 1):
        kind = "revolute" if kinds is None or kinds[i - 1] == "R" else "prismatic"
        leader, _, by = follows.partition(" ")
        mimic = f'<mimic joint="{leader}" multiplier="{by}"/>' if follows else ""
        parts.append(
            f'<link name="l{i}"/><joint name="j{i}" type="{kind}"><parent link="{parent}"/>'
            f'<child link="l{i}"/><origin xyz="{xyz}" rpy="{rpy}"/><axis xyz="{axis}"/>{mimic}'
            f'<limit lower="{-limit}" upper="{limit}" effort="1" velocity="1"/></joint>'
        )
        parent = f"l{i}"
    parts.append(
        f'<link name="tool"/><joint name="jt" type="fixed"><parent link="{parent}"/>'
        f'<child link="tool"/><origin rpy="{tool}"/></joint></robot>'
    )
    return "".join(parts)


@pytest.fixture(scope="module")
def painter():
    return Robot.from_urdf(urdf(HOLLOW, tool=f"0 {np.pi / 2!r} 0"))


@pytest.fixture(scope="module")
def palletiser():
    return Robot.from_urdf(urdf(LEVEL))


Q = (0.2, 0.3, -0.4, 0.5, 1.1, -0.6)


def test_the_hollow_wrist_has_its_four_solutions(painter):
    found = painter.ik(painter.fk(Q))
    assert len(found) >= 4
    for q in (
        Q,
        (0.199966, 0.300006, -0.400041, -1.710576, -1.10001, 1.610546),
        (0.210752, 1.493646, -2.54213, 0.027263, 1.998357, -0.691838),
    ):
        assert np.abs(found.q - q).max(axis=1).min() < 2e-5
    assert found.residual.max() < 1e-10
    assert np.abs(painter.fk(found.q) - painter.fk(Q)).max() < 1e-9


def test_the_solver_says_what_follows(painter):
    assert str(painter.solver) == "followers"
    assert "j5 turns axes 5 and 6, by 1 and -1" in painter.solver.explain()
    assert "degree 16" in painter.solver.explain()


def test_a_seed_comes_first_and_turns_are_listed(painter):
    T = painter.fk(Q)
    assert np.allclose(painter.ik(T, seed=Q).q[0], Q, atol=1e-9)
    assert len(painter.ik(T, turns="all")) > len(painter.ik(T))


def test_a_batch_and_a_path_of_the_hollow_wrist(painter):
    q = np.linspace(Q, np.array(Q) + 0.3, 12)
    Ts = painter.fk(q)
    batch = painter.ik_batch(Ts)
    for i in range(len(q)):
        assert np.abs(batch.q[i, : batch.count[i]] - q[i]).max(axis=1).min() < 1e-7
    path = painter.ik_path(Ts, start=Q)
    assert path.continuous
    assert np.abs(path.q - q).max() < 1e-6


def test_out_of_reach_is_said_of_a_hollow_wrist(painter):
    T = painter.fk(Q)
    T[0, 3] += 5.0
    assert len(painter.ik(T)) == 0
    assert "outside the reach of the tool" in painter.why_unreachable(T)


def test_a_palletiser_keeps_its_tool_level(palletiser):
    q = (0.3, 0.5, 0.2, 0.4)
    T = palletiser.fk(q)
    assert np.allclose(T[:3, 3], (0.226562108, 0.070083873, 0.155078646), atol=1e-9)
    found = palletiser.ik(T)
    assert np.abs(found.q - q).max(axis=1).min() < 1e-9
    assert found.residual.max() < 1e-12


def test_a_tilted_target_says_why_there_is_none(palletiser):
    T = palletiser.fk((0.3, 0.5, 0.2, 0.4))
    c, s = np.cos(0.2), np.sin(0.2)
    T[:3, :3] = T[:3, :3] @ [[1, 0, 0], [0, c, -s], [0, s, c]]
    assert len(palletiser.ik(T)) == 0
    assert palletiser.why_unreachable(T).endswith("not with this orientation; the closest found is "
                                                  "11.5 deg away")  # fmt: skip


def check(robot, q):
    """Configurations are among the solutions of their poses."""
    batch = robot.ik_batch(robot.fk(q), within_limits=False)
    for i in range(len(q)):
        gap = batch.q[i, : batch.count[i]] - q[i]
        gap = np.abs(np.remainder(gap + np.pi, 2 * np.pi) - np.pi)
        assert gap.max(axis=1).min() < 1e-6
        assert batch.residual[i, : batch.count[i]].max() < 1e-10


def test_random_poses_of_a_palletiser(palletiser):
    check(palletiser, np.random.default_rng(0).uniform(-2, 2, (200, 4)))


SCARA = (
    ("0 0 0.4", "0 0 0", "0 0 1", ""),
    ("0.3 0 0", "0 0 0", "0 0 1", ""),
    ("0.25 0 0", "0 0 0", "0 0 1", "j2 -1"),
    ("0.05 0 0", "0 0 0", "0 0 -1", ""),
)

FIVE = (
    ("0 0 0.4", "0 0 0", "0 0 1", ""),
    ("0.1 0.2 0", "0.3 0.2 0", "0 1 0", ""),
    ("0.3 0 0.1", "0 0.5 0", "0 1 0", ""),
    ("0.25 0 0", "0.2 0 1", "1 0 0", "j2 0.5"),
    ("0.05 0.1 0", "0 1 0.4", "0 0 1", ""),
    ("0.05 0 0.1", "1 0 0", "0 1 0", ""),
)


def test_a_scara_whose_third_axis_undoes_the_second():
    check(Robot.from_urdf(urdf(SCARA)), np.random.default_rng(1).uniform(-2, 2, (50, 3)))


def test_five_values_that_move_six_joints():
    robot = Robot.from_urdf(urdf(FIVE))
    assert robot.n == 5
    q = np.random.default_rng(2).uniform(-1.5, 1.5, (50, 5))
    batch = robot.ik_batch(robot.fk(q), within_limits=False)
    for i in range(len(q)):
        assert np.abs(batch.q[i, : batch.count[i]] - q[i]).max(axis=1).min() < 1e-6


def test_a_follower_by_half_counts_both_turns():
    joints = [*HOLLOW[:5], (*HOLLOW[5][:3], "j5 0.5"), HOLLOW[6]]
    robot = Robot.from_urdf(urdf(joints, limit=6.28))
    q = np.array([0.2, 0.3, -0.4, 0.5, 4.0, -0.6])
    found = robot.ik(robot.fk(q))
    assert np.abs(found.q - q).max(axis=1).min() < 1e-7
    assert found.residual.max() < 1e-10


def test_a_multiplier_that_is_no_ratio_is_refused_by_name():
    joints = [*HOLLOW[:5], (*HOLLOW[5][:3], "j5 0.718281828"), HOLLOW[6]]
    robot = Robot.from_urdf(urdf(joints))
    with pytest.raises(NoSolverError, match=r"j5 turns 0\.718281828 times.*ik_numeric"):
        robot.ik(robot.fk(Q))


@pytest.mark.parametrize("joint", ["j1", "j3", "j5", "j7"])
def test_a_value_of_a_hollow_wrist_is_held(painter, joint):
    k = painter.joint_names.index(joint)
    found = painter.ik(painter.fk(Q), locked={joint: Q[k]})
    assert np.abs(found.q - Q).max(axis=1).min() < 1e-7
    assert np.allclose(found.q[:, k], Q[k], atol=0)


def test_a_value_of_a_palletiser_is_held(palletiser):
    q = np.array((0.3, 0.5, 0.2, 0.4))
    found = palletiser.ik(palletiser.fk(q), locked={0: 0.3})
    assert np.abs(found.q - q).max(axis=1).min() < 1e-7


def test_a_position_alone_asks_for_three_joints_of_a_painter_to_be_held(painter):
    """Three of its six values are to spare; a palletiser's one is held by itself."""
    with pytest.raises(NoSolverError, match=r"^.*chain: 3 joints to spare; hold some \(locked="):
        painter.ik(np.eye(4), task="position")
