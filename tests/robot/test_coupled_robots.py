"""Robots of tables whose joints follow others: q is what the controller shows."""

import pickle

import numpy as np
import pinocchio as pin
import pytest
from dh_product import dh_frames, difference
from hypothesis import given, settings
from hypothesis import strategies as st
from strategies import coupled_tables, moved_joints

from dh2urdf import DHRow, DHTable, Mimic, Robot, urdf_text
from dh2urdf.exceptions import NoSolverError

SEEDS = st.integers(0, 2**32 - 1)


@settings(max_examples=100, deadline=None)
@given(coupled_tables(), SEEDS)
def test_fk_and_frames_are_the_dh_product_where_the_joints_are(table, seed):
    """Of one q and of stacks; the joints move as mimic and couplings say word by word."""
    robot = Robot.from_dh(table)
    q = np.random.default_rng(seed).uniform(-2, 2, (2, 3, robot.n))
    T, frames, joints = robot.fk(q), robot.frames(q), robot.chain_configuration(q)
    assert frames.shape == (2, 3, table.n + 1, 4, 4)
    size = max(1.0, table.length) + np.abs(joints).sum()
    for index in np.ndindex(2, 3):
        moved = moved_joints(table, q[index])
        assert difference(joints[index], moved) < 1e-12 * size
        expected = dh_frames(table, moved)
        assert difference(frames[index], expected[:-1]) < 1e-13 * size
        assert difference(T[index], expected[-1]) < 1e-13 * size
        assert difference(robot.fk(q[index]), expected[-1]) < 1e-13 * size


@settings(max_examples=100, deadline=None)
@given(coupled_tables(), SEEDS)
def test_the_written_urdf_in_pinocchio_goes_where_the_robot_goes(table, seed):
    """The file has the joints themselves: they take what ``model_configuration`` says."""
    robot = Robot.from_dh(table)
    q = np.random.default_rng(seed).uniform(-2, 2, robot.n)
    model = pin.buildModelFromXML(urdf_text(table))
    data = model.createData()
    pin.framesForwardKinematics(model, data, robot.model_configuration(q))
    T = data.oMf[model.getFrameId("tool0")].homogeneous
    size = max(1.0, table.length) + np.abs(robot.chain_configuration(q)).sum()
    assert difference(T, robot.fk(q)) < 1e-13 * size


@settings(max_examples=100, deadline=None)
@given(coupled_tables(), SEEDS)
def test_the_jacobian_is_the_derivative_by_q(table, seed):
    """Columns belong to values of q, with all that each of them moves."""
    robot = Robot.from_dh(table)
    q = np.random.default_rng(seed).uniform(-2, 2, robot.n)
    J, h = robot.jacobian(q), 1e-6
    assert J.shape == (6, robot.n)
    R = robot.fk(q)[:3, :3]
    for i, step in enumerate(np.eye(robot.n) * h):
        dT = (robot.fk(q + step) - robot.fk(q - step)) / (2 * h)
        W = dT[:3, :3] @ R.T
        assert difference(J[:3, i], dT[:3, 3]) < 1e-6
        assert difference(J[3:, i], [W[2, 1], W[0, 2], W[1, 0]]) < 1e-6


def test_a_fanuc_pendant_shows_another_third_angle():
    """J2 = 31.3242 and J3 = -33.342 deg of a robot whose J3 counts from the level."""
    rows = [DHRow(a=0.1) for _ in range(6)]
    robot = Robot.from_dh(DHTable(tuple(rows), "standard", couplings={"joint_3": {"joint_2": 1.0}}))
    shown = np.radians([0.0, 31.3242, -33.342, 0.0, 0.0, 0.0])
    assert abs(np.degrees(robot.chain_configuration(shown)[2]) + 2.017) < 1e-3


def test_limits_of_followers_bound_the_value_that_moves_them():
    """A follower at -2 q + 0.3 within -1.7 to 0.5 leaves q from -0.1 to 1."""
    follower = DHRow(a=0.5, mimic=Mimic("joint_1", -2.0, 0.3), lower=-1.7, upper=0.5)
    robot = Robot.from_dh(DHTable((DHRow(a=1.0, lower=-1.0, upper=2.0), follower), "standard"))
    assert np.abs(robot.lower - [-0.1]).max() < 1e-15
    assert np.abs(robot.upper - [1.0]).max() < 1e-15
    assert robot.joint_names == ("joint_1",)


def test_limits_of_a_follower_that_leave_nothing_are_told_and_left_out():
    """As of a URDF's mimic joints."""
    follower = DHRow(a=0.5, mimic=Mimic("joint_1"), lower=3.0, upper=4.0)
    robot = Robot.from_dh(DHTable((DHRow(a=1.0, lower=-1.0, upper=2.0), follower), "standard"))
    assert robot.upper.tolist() == [2.0]
    assert robot.warnings == (
        "joint 'joint_2': its limits exclude those of 'joint_1', which it follows: they leave it "
        "171.887 to 229.183 deg, its own -57.2958 to 114.592 deg; left out",
    )


def test_a_coupled_robot_survives_pickling():
    """With names, limits and what q moves."""
    table = DHTable(
        (DHRow(a=0.5), DHRow(a=0.4), DHRow(a=0.1, mimic=Mimic("joint_1"))),
        "standard",
        couplings={"joint_2": {"joint_1": 0.5}},
    )
    robot = Robot.from_dh(table)
    again = pickle.loads(pickle.dumps(robot))
    assert again.joint_names == robot.joint_names
    assert np.array_equal(again.fk([0.3, 0.4]), robot.fk([0.3, 0.4]))


def test_a_slide_that_follows_a_turn_is_refused_in_its_units():
    """By ik; what there is instead is named."""
    rows = [DHRow(a=0.2, alpha=0.5 * k, name=f"j{k}") for k in range(1, 7)]
    slide = DHRow(joint_type="prismatic", mimic=Mimic("j3", 0.8e-3 * 180 / np.pi))
    robot = Robot.from_dh(DHTable((*rows[:3], slide, *rows[3:]), "standard"))
    with pytest.raises(NoSolverError, match=r"slide .* j3, .* moves 0.8 mm .* degree.* ik_numeric"):
        robot.ik(np.eye(4))
