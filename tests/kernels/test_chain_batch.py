"""Forward kinematics of many configurations: side by side, and one by one, the same poses."""

import numpy as np
import pytest
from dh_product import dh_frames, difference

from dh2urdf import Robot, list_tables, load_table
from dh2urdf.kernels.chain import BLOCK, chain_fk_batch

COUNTS = (0, 1, BLOCK - 1, BLOCK, BLOCK + 1, 3 * BLOCK)


@pytest.mark.parametrize("name", list_tables())
def test_whole_blocks_have_the_poses_of_the_dh_product(name):
    """Every pose of two blocks and a rest equals the DH product to 1e-13 of the arm's size."""
    table = load_table(name)
    robot = Robot.from_dh(table)
    q = np.random.default_rng(0).uniform(-7, 7, (2 * BLOCK + 3, robot.n))
    expected = [dh_frames(table, one)[-1] for one in robot.chain_configuration(q)]
    assert difference(robot.fk(q), expected) < 1e-13 * max(1.0, np.abs(expected).max())


@pytest.mark.parametrize("count", COUNTS)
def test_every_count_of_configurations_is_placed(count):
    """No pose is left out, whatever does not fill a block."""
    robot = Robot.from_dh("kuka_iiwa14")
    q = np.random.default_rng(1).uniform(-3, 3, (count, 7))
    T = robot.fk(q)
    assert T.shape == (count, 4, 4)
    for one, pose in zip(q, T, strict=True):
        assert difference(pose, robot.fk(one)) < 1e-14


def test_strided_configurations_are_placed():
    """A slice, a transposed array and one with more axes give the poses of their rows."""
    robot = Robot.from_dh("ur5")
    q = np.random.default_rng(2).uniform(-3, 3, (2 * BLOCK, 6))
    T = robot.fk(q)
    assert difference(robot.fk(np.asfortranarray(q)), T) == 0.0
    assert difference(robot.fk(np.repeat(q, 2, axis=0)[::2]), T) == 0.0
    assert difference(robot.fk(q.reshape(8, -1, 6)), T.reshape(8, -1, 4, 4)) == 0.0


def test_far_turned_joints_are_placed():
    """Angles of many thousand turns have the pose of the libm's cosine and sine."""
    table = load_table("puma560")
    robot = Robot.from_dh(table)
    q = np.random.default_rng(3).uniform(-1e7, 1e7, (BLOCK, 6))
    assert difference(robot.fk(q), [dh_frames(table, one)[-1] for one in q]) < 1e-13


def test_not_a_number_stays_in_its_own_pose():
    """One configuration that is no number leaves the others of its block alone."""
    robot = Robot.from_dh("puma560")
    q = np.random.default_rng(4).uniform(-3, 3, (BLOCK, 6))
    T, spoiled = robot.fk(q), np.empty((BLOCK, 4, 4))
    q[5, 2] = np.nan
    chain_fk_batch(robot.chain.links, robot.chain.prismatic, q, spoiled)
    assert np.isnan(spoiled[5]).any()
    rest = np.arange(BLOCK) != 5
    assert difference(spoiled[rest], T[rest]) < 1e-14
