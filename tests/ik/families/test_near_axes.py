"""Axes that miss a coordinate axis by a hair, and joints named like links."""

import math

import numpy as np
import pinocchio as pin
import pytest
from example_robots import fk_between, placed
from hypothesis import given, settings
from hypothesis import strategies as st
from margins import assert_margin

from dh2urdf import Robot, extract_dh

DIRECTIONS = [sign * row for row in np.eye(3) for sign in (1.0, -1.0)]
TILTS = [0.0, 1e-16, 1e-14, 9.99e-13, 1e-12, 1.001e-12, 1e-11, 1.7e-9, 1e-8, 1e-6, 1e-4]


def words(values):
    return " ".join(map(repr, np.asarray(values, float).tolist()))


def arm_text(joints):
    """A chain of ``(type, axis, xyz, rpy)``; links l0, l1, ..."""
    links = "".join(f'<link name="l{i}"/>' for i in range(len(joints) + 1))
    parts = [
        f'<joint name="j{i}" type="{kind}"><parent link="l{i}"/><child link="l{i + 1}"/>'
        f'<origin xyz="{words(xyz)}" rpy="{words(rpy)}"/><axis xyz="{words(axis)}"/>'
        '<limit lower="-2" upper="2" effort="1" velocity="1"/></joint>'
        for i, (kind, axis, xyz, rpy) in enumerate(joints)
    ]
    return f'<robot name="r">{links}{"".join(parts)}</robot>'


def pinocchio_fk(text, joints, q, tip):
    by_name = {f"j{i}": value for i, value in enumerate(q)}
    (T_base_tip,) = placed(pin.buildModelFromXML(text), by_name, tip)
    return T_base_tip.homogeneous


def turn(axis, angle):
    """Rodrigues' formula."""
    x, y, z = np.asarray(axis, float) / np.linalg.norm(axis)
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    T = np.eye(4)
    T[:3, :3] += math.sin(angle) * K + 2 * math.sin(angle / 2) ** 2 * (K @ K)
    return T


def file_fk(joints, q):
    """The product that the file's numbers mean, with no snapping of anything."""
    T = np.eye(4)
    for (kind, axis, xyz, (r, p, y)), value in zip(joints, q, strict=True):
        step = turn([0, 0, 1], y) @ turn([0, 1, 0], p) @ turn([1, 0, 0], r)
        step[:3, 3] = xyz
        move = turn(axis, value) if kind != "prismatic" else np.eye(4)
        if kind == "prismatic":
            move[:3, 3] = np.asarray(axis) / np.linalg.norm(axis) * value
        T = T @ step @ move
    return T


def agree(joints, q, tmp_path, within=1e-13):
    """FK of a robot, single and in a batch, and of an extracted table are Pinocchio's."""
    text, tip = arm_text(joints), f"l{len(joints)}"
    path = tmp_path / "arm.urdf"
    path.write_text(text)
    robot = Robot.from_urdf(path, "l0", tip)
    truth = pinocchio_fk(text, joints, q, tip)
    placed = [robot.fk(q), robot.fk(np.stack([q, q]))[1]]
    tables = [extract_dh(path, "l0", tip, name).table for name in ("standard", "modified")]
    placed += [table.fk(q) for table in tables]
    # A table takes axes within 1e-14 (axis_pairs.PARALLEL) for parallel: off by that a metre.
    assert_margin(np.abs(np.array(placed) - truth), within, 5)
    # Pinocchio takes x, y and z for what misses them by 1e-12: nobody else's FK shows more.
    assert_margin(np.abs(file_fk(joints, q) - truth), 1e-11, 1)


@pytest.mark.parametrize("kind", ["revolute", "continuous", "prismatic"])
@pytest.mark.parametrize("direction", range(6))
def test_an_axis_that_misses_a_coordinate_axis_is_pinocchios(kind, direction, tmp_path):
    """At every tilt, built and the same FK within 1e-13."""
    axis = DIRECTIONS[direction]
    for tilt in TILTS:
        tilted = axis + tilt * np.roll([0.0, 0.6, -0.8], int(np.argmax(np.abs(axis))))
        joints = [
            ("revolute", [0, 0, 1.0], [0, 0, 0.4], [0, 0, 0]),
            (kind, tilted, [0.3, 0.1, 0.2], [0.3, -0.7, 1.1]),
            ("revolute", [0, 1.0, 0], [0.5, 0, 0.1], [0, 0, 0]),
        ]
        agree(joints, np.array([0.3, 1.2, -0.7]), tmp_path)


tilted_axes = st.builds(
    lambda k, exponent, phi: (
        DIRECTIONS[k] + 10.0**exponent * np.roll([0, math.cos(phi), math.sin(phi)], k // 2)
    ),
    st.integers(0, 5),
    st.floats(-16, -4),
    st.floats(0, 6.28),
)
some_joints = st.tuples(
    st.sampled_from(["revolute", "continuous", "prismatic"]),
    tilted_axes,
    st.lists(st.sampled_from([0, 0.1, -0.3, 0.5]), min_size=3, max_size=3),
    st.lists(st.sampled_from([0, math.pi / 2, -math.pi / 2, math.pi, 0.3]), min_size=3, max_size=3),
)


@settings(max_examples=40)
@given(joints=st.lists(some_joints, min_size=1, max_size=6), seed=st.integers(0, 999))
def test_arms_of_nearly_parallel_axes_are_pinocchios(joints, seed, tmp_path_factory):
    """Chains whose axes are all off by 1e-16 to 1e-4, in any frames."""
    q = np.random.default_rng(seed).uniform(-2, 2, len(joints))
    agree(joints, q, tmp_path_factory.mktemp("arm"), within=2e-13)


SAME = """<robot name="r"><link name="a"/><link name="b"/><link name="c"/><link name="d"/>
<joint name="b" type="revolute"><parent link="a"/><child link="b"/><origin xyz="0 0 .2"/>
<axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
<joint name="a" type="revolute"><parent link="b"/><child link="c"/><origin xyz="0 .3 .2"/>
<axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
<joint name="c" type="revolute"><parent link="c"/><child link="d"/><origin xyz=".1 0 .2"/>
<axis xyz="1 0 0"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>"""


@pytest.mark.parametrize(
    ("base", "tip"), [(None, None), ("a", "c"), ("b", "d"), ("c", "a"), ("b", "c"), (None, "b")]
)
def test_a_joint_and_a_link_may_have_one_name(base, tip, written):
    """Base and tip are links, whatever joints are called."""
    path = written("same.urdf", SAME)
    robot = Robot.from_urdf(path, base, tip)
    q = np.linspace(0.2, 0.9, robot.n)
    by_name = dict(zip(robot.joint_names, q, strict=True))
    expected = fk_between(pin.buildModelFromXML(SAME), base or "a", tip or "d", by_name)
    assert_margin(np.abs(robot.fk(q) - expected), 1e-14)
    assert_margin(np.abs(robot.fk(q[None])[0] - expected), 1e-14)
    assert_margin(extract_dh(path, base, tip).max_error, 1e-14)
    assert {f.name for f in robot.model.frames} >= {"a", "b", "c", "d"}


def test_the_joints_of_a_urdf_may_be_called_like_the_world_of_pinocchio(tmp_path):
    """Its joint 0 is ``universe``; the arm's own of that name is another, with its own limits."""
    path = tmp_path / "universe.urdf"
    path.write_text(SAME.replace('joint name="b"', 'joint name="universe"'))
    found = extract_dh(path)
    assert_margin(found.max_error, 1e-14)
    assert [row.lower for row in found.table.joints] == [-1.0] * 3


def test_a_body_and_a_joint_of_an_mjcf_may_have_one_name(tmp_path):
    """The same in MuJoCo's format."""
    path = tmp_path / "same.xml"
    path.write_text(
        '<mujoco><worldbody><body name="a"><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>'
        '<joint name="a" type="hinge" axis="0 0 1"/><body name="c" pos=".1 0 .2">'
        '<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>'
        '<joint name="b" type="hinge" axis="1 0 0"/><body name="b" pos="0 .2 .3">'
        '<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>'
        '<joint name="c" type="hinge" axis="0 1 0"/></body></body></body></worldbody></mujoco>'
    )
    robot = Robot.from_urdf(path, tip="c")
    assert robot.joint_names == ("a", "b")
    expected = turn([0, 0, 1], 0.4) @ np.array(
        [[1, 0, 0, 0.1], [0, 1, 0, 0], [0, 0, 1, 0.2], [0, 0, 0, 1]]
    )
    assert_margin(np.abs(robot.fk([0.4, 0.7]) - expected @ turn([1, 0, 0], 0.7)), 1e-14)
