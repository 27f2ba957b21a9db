"""Robots over Pinocchio models: FK, frames, Jacobians, limits, trees, odd joints."""

import pickle

import numpy as np
import pinocchio as pin
import pytest
from dh_product import dh_frames, difference
from example_robots import example, fk_between
from hypothesis import given, settings
from hypothesis import strategies as st
from strategies import tables

import dh2urdf
from dh2urdf import Robot
from dh2urdf.exceptions import ConfigurationError, NameNotFoundError, UrdfError


def reference(robot, path, q_by_name):
    """T_base_tip by Pinocchio's own full model, joints set by name, the rest neutral."""
    return fk_between(pin.buildModelFromUrdf(path), robot.base, robot.tip, q_by_name)


@settings(max_examples=150)
@given(tables(), st.integers(0, 2**32 - 1))
def test_fk_and_frames_equal_the_dh_product(table, seed):
    """fk and frames of one q and of stacks equal the DH product; kernel equals Pinocchio."""
    robot = Robot.from_dh(table)
    q = np.random.default_rng(seed).uniform(-2, 2, (2, 3, robot.n))
    T, frames = robot.fk(q), robot.frames(q)
    assert T.shape == (2, 3, 4, 4)
    assert frames.shape == (2, 3, robot.n + 1, 4, 4)
    size = max(1.0, table.length + 2 * robot.n)
    for index in np.ndindex(2, 3):
        expected = dh_frames(table, q[index])
        assert difference(frames[index], expected[:-1]) < 1e-13 * size
        assert difference(robot.fk(q[index]), expected[-1]) < 1e-13 * size
        assert difference(T[index], robot.fk(q[index])) < 1e-13 * size


@settings(max_examples=100)
@given(tables(max_joints=7), st.integers(0, 2**32 - 1))
def test_jacobian_is_the_derivative_of_fk(table, seed):
    """Columns equal central differences of FK: linear over angular, in base axes at the tip."""
    robot = Robot.from_dh(table)
    q = np.random.default_rng(seed).uniform(-2, 2, robot.n)
    J = robot.jacobian(q)
    assert difference(robot.jacobian(q[None])[0], J) < 1e-12
    h = 1e-6
    R = robot.fk(q)[:3, :3]
    for i in range(robot.n):
        step = np.eye(robot.n)[i] * h
        dT = (robot.fk(q + step) - robot.fk(q - step)) / (2 * h)
        W = dT[:3, :3] @ R.T
        assert difference(J[:3, i], dT[:3, 3]) < 1e-8
        assert difference(J[3:, i], [W[2, 1], W[0, 2], W[1, 0]]) < 1e-8


@pytest.mark.parametrize(
    ("file", "base", "tip"),
    [
        ("ur5_robot.urdf", None, None),
        ("ur5_robot.urdf", "shoulder_link", "wrist_2_link"),
        ("panda.urdf", "panda_link0", "panda_link8"),
        ("panda.urdf", "panda_leftfinger", "panda_link3"),
        ("kinova.urdf", None, "j2s6s200_end_effector"),
        ("xarm7.urdf", None, "link_eef"),
        ("talos_reduced.urdf", "arm_left_7_link", "arm_right_7_link"),
        ("talos_reduced.urdf", "base_link", "head_2_link"),
    ],
)
def test_chains_anywhere_in_a_tree_equal_pinocchio(file, base, tip):
    """fk, kernel and jacobian of a chain through a tree equal Pinocchio's full model."""
    path = example(file)
    robot = Robot.from_urdf(path, base, tip)
    rng = np.random.default_rng(0)
    for _ in range(5):
        q = robot.random_configuration(rng)
        expected = reference(robot, path, dict(zip(robot.joint_names, q, strict=True)))
        assert difference(robot.fk(q), expected) < 1e-13
        assert difference(robot.fk(q[None])[0], expected) < 1e-13
        assert difference(robot.chain.fk(q), expected) < 1e-13
        assert difference(robot.jacobian(q), robot.jacobian(q[None])[0]) < 1e-13


def test_joint_frames_of_a_urdf_are_pinocchios():
    """frames(q) of a URDF robot: the base, then each joint as Pinocchio places it."""
    robot = Robot.from_urdf(example("panda.urdf"), "panda_link0", "panda_link8")
    q = robot.random_configuration(3)
    data = robot.model.createData()
    pin.forwardKinematics(robot.model, data, q)
    expected = [np.eye(4), *(data.oMi[i].homogeneous for i in range(1, 8))]
    assert difference(robot.frames(q), expected) < 1e-14


def test_continuous_joints_are_one_number_each():
    """A Kinova's endless joints take one angle, are unbounded, and Pinocchio gets its pairs."""
    robot = Robot.from_urdf(example("kinova.urdf"), tip="j2s6s200_end_effector")
    assert robot.n == 6
    assert robot.model.nq > 6
    assert np.isinf(robot.lower[0])
    q = np.linspace(-3, 3, 6)
    pair = robot.model_configuration(q)
    assert pair.shape == (robot.model.nq,)
    assert pair[:2] == pytest.approx([np.cos(q[0]), np.sin(q[0])])


MIMIC = """<robot name="m">
  <link name="a"/><link name="b"/><link name="c"/><link name="d"/>
  <joint name="j1" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>
    <origin xyz="0.1 0 0"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
  <joint name="j2" type="revolute"><parent link="b"/><child link="c"/><axis xyz="0 1 0"/>
    <origin xyz="0.2 0 0"/><limit lower="-0.5" upper="3" effort="1" velocity="1"/>
    <mimic joint="j1" multiplier="-2" offset="0.3"/></joint>
  <joint name="j3" type="prismatic"><parent link="c"/><child link="d"/><axis xyz="1 0 0"/>
    <origin xyz="0.3 0 0"/><limit lower="0" upper="0.1" effort="1" velocity="1"/></joint>
</robot>"""


def test_mimicking_joint_follows_its_leader(written):
    """q has no entry for a mimicking joint; FK, Jacobian and limits take it along."""
    path = written("mimic.urdf", MIMIC)
    robot = Robot.from_urdf(path)
    assert robot.joint_names == ("j1", "j3")
    assert robot.upper[0] == pytest.approx(0.4)
    assert robot.lower[0] == pytest.approx(-1.0)
    q = np.array([0.25, 0.07])
    expected = reference(robot, str(path), {"j1": 0.25, "j2": -2 * 0.25 + 0.3, "j3": 0.07})
    assert difference(robot.fk(q), expected) < 1e-15
    h = 1e-6
    for i in range(2):
        step = np.eye(2)[i] * h
        dp = (robot.fk(q + step) - robot.fk(q - step))[:3, 3] / (2 * h)
        assert difference(robot.jacobian(q)[:3, i], dp) < 1e-9


def test_robot_pickles():
    """A copy through pickle gives the same FK."""
    robot = Robot.from_dh("ur5e")
    copy = pickle.loads(pickle.dumps(robot))
    q = robot.random_configuration(1)
    assert difference(copy.fk(q), robot.fk(q)) == 0
    assert repr(copy) == repr(robot)


def test_limits_names_and_model_are_at_hand():
    """Limits are the table's, names its joints', the model Pinocchio's."""
    robot = Robot.from_dh("franka_fer")
    assert robot.n == 7
    assert robot.joint_names[0] == "fer_joint1"
    assert (robot.lower[3], robot.upper[3]) == (-3.0718, -0.0698)
    assert isinstance(robot.model, pin.Model)
    assert (robot.base, robot.tip) == ("base_link", "tool0")


def test_bad_requests_are_explained():
    """Wrong shape, unknown frame, no joint between, ambiguous tips, unreadable file."""
    robot = Robot.from_dh("ur5")
    with pytest.raises(ConfigurationError, match=r"6 values \(joint_1|6 values"):
        robot.fk([0, 0, 0])
    with pytest.raises(ConfigurationError, match="got shape"):
        robot.fk(0.0)
    path = example("panda.urdf")
    with pytest.raises(NameNotFoundError, match="did you mean 'panda_link8'"):
        Robot.from_urdf(path, "panda_link0", "panda_link9")
    with pytest.raises(UrdfError, match="no joint moves between"):
        Robot.from_urdf(path, "panda_link7", "panda_link8")
    with pytest.raises(UrdfError, match="choose the tip, one of"):
        Robot.from_urdf(example("talos_reduced.urdf"))
    with pytest.raises(UrdfError, match="there is no such file"):
        Robot.from_urdf("missing.urdf")


def test_empty_stacks_are_fine():
    """No configuration in, no pose out."""
    robot = Robot.from_dh("planar_rr")
    assert robot.fk(np.empty((0, 2))).shape == (0, 4, 4)
    assert robot.jacobian(np.empty((0, 2))).shape == (0, 6, 2)


def test_shipped_tables_load_by_name():
    """Every name of list_tables makes a robot; 35 and more ship."""
    names = dh2urdf.list_tables()
    assert len(names) >= 35
    for name in names:
        robot = Robot.from_dh(name)
        q = robot.random_configuration(0)
        joints = robot.chain_configuration(q)
        assert difference(robot.fk(q), dh_frames(robot.table, joints)[-1]) < 1e-13


@pytest.mark.parametrize("name", ["puma560", "stanford", "franka_fer"])
@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_one_bad_number_of_a_stack_is_named(name, bad):
    """Whatever the joint is and wherever in the stack it stands, fk gives its index."""
    robot = Robot.from_dh(name)
    for k in range(robot.n):
        q = np.random.default_rng(k).uniform(-1.0, 1.0, (100, robot.n))
        q[37 + k, k] = bad
        with pytest.raises(ConfigurationError, match=rf"q\[{37 + k}, {k}\]: expected finite"):
            robot.fk(q)
