"""Joints that follow others in a file follow them in the table that is extracted."""

import mujoco
import numpy as np
import pytest
from coupled_arms import COUPLED, painter, palletiser

from dh2urdf import Mimic, Robot, extract_dh, urdf_text, write_mjcf

GRIP = """<robot name="grip">
  <link name="root"/><link name="arm"/><link name="hand"/><link name="side"/>
  <joint name="shoulder" type="revolute"><parent link="root"/><child link="arm"/>
    <axis xyz="0 0 1"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
  <joint name="elbow" type="revolute"><parent link="arm"/><child link="hand"/>
    <origin xyz="0.5 0 0"/><axis xyz="0 0 1"/><limit lower="-2" upper="2" effort="1" velocity="1"/>
    {elbow}</joint>
  <joint name="other" type="revolute"><parent link="arm"/><child link="side"/>
    <axis xyz="1 0 0"/><limit lower="-2" upper="2" effort="1" velocity="1"/>{other}</joint>
</robot>
"""


def mimics(table):
    """What each joint of a table follows."""
    return [row.mimic for row in table.joints]


def maps(table):
    """How the values move the joints."""
    return table.joint_map.matrix.tolist(), table.joint_map.offset.tolist()


@pytest.mark.parametrize("embedded", [True, False])
@pytest.mark.parametrize("name", COUPLED)
def test_a_written_file_gives_its_table_back(name, embedded):
    """The table itself where it is carried; else one in which the same joints follow the same."""
    table = COUPLED[name]()
    found = extract_dh(urdf_text(table), embedded=embedded)
    assert mimics(found.table) == mimics(table)
    if embedded:
        assert found.table == table
    assert found.warnings == ()


@pytest.mark.parametrize("table", [palletiser(), painter()])
def test_robots_of_table_and_file_take_the_same_values(table, written):
    """The robot of a table that was extracted, of the file and of the first table are one."""
    path = written("arm.urdf", urdf_text(table))
    robots = [Robot.from_dh(table), Robot.from_urdf(path, "base_link", "tool0")]
    robots.append(Robot.from_dh(extract_dh(path, embedded=False).table))
    q = np.random.default_rng(0).uniform(-1, 1, (20, robots[0].n))
    poses = [robot.fk(q) for robot in robots]
    assert max(np.abs(T - poses[0]).max() for T in poses) < 1e-12


def test_explained_steps_name_what_a_joint_follows():
    """In the step of the frame that it moves."""
    steps = extract_dh(urdf_text(painter()), embedded=False).steps
    (step,) = [step for step in steps if "follows" in step.text]
    assert step.frame == 6
    assert "joint 6 follows joint_5 with multiplier -1" in step.text


def test_a_leader_off_the_chain_is_told():
    """It has no row, so its follower moves on its own; the message names both."""
    text = GRIP.format(elbow='<mimic joint="other"/>', other="")
    found = extract_dh(text, "root", "hand")
    assert mimics(found.table) == [None, None]
    (warning,) = [w for w in found.warnings if "'other'" in w]
    assert "elbow" in warning
    assert "not on the chain" in warning


def test_a_leader_that_follows_a_joint_of_the_chain_is_passed_over():
    """elbow = 2 other + 0.1 with other = -0.5 shoulder + 0.2: minus the shoulder plus 0.5."""
    elbow = '<mimic joint="other" multiplier="2" offset="0.1"/>'
    other = '<mimic joint="shoulder" multiplier="-0.5" offset="0.2"/>'
    found = extract_dh(GRIP.format(elbow=elbow, other=other), "root", "hand")
    assert mimics(found.table) == [None, Mimic("shoulder", -1.0, 0.5)]


def test_flipped_joints_follow_as_before():
    """q of the source stays q of the table, whichever way its axis z points."""
    text = GRIP.format(elbow='<mimic joint="shoulder" multiplier="-0.5" offset="0.2"/>', other="")
    found = extract_dh(text, "root", "hand", flip=["elbow"])
    assert found.table.joints[1].sign == -1
    assert found.table.joints[1].mimic == Mimic("shoulder", -0.5, 0.2)


def test_a_carried_table_that_follows_otherwise_is_not_taken():
    """Who edits a <mimic> of a written file gets what stands there."""
    text = urdf_text(painter()).replace('multiplier="-1.0"', 'multiplier="-2.0"')
    found = extract_dh(text)
    assert found.table.joints[5].mimic == Mimic("joint_5", -2.0)
    assert "follow otherwise" in found.warnings[0]


@pytest.mark.parametrize("table", [palletiser(), painter()])
def test_an_mjcf_says_who_follows_and_is_read_back(table, tmp_path):
    """As an equality, which simulation keeps; the table comes back."""
    path = write_mjcf(table, tmp_path / "arm.xml").path
    model = mujoco.MjModel.from_xml_path(str(path))
    assert model.neq == sum(row.mimic is not None for row in table.joints)
    found = extract_dh(path, embedded=False)
    assert mimics(found.table) == mimics(table)
    robot, own = Robot.from_urdf(path, tip="tool0"), Robot.from_dh(table)
    q = np.random.default_rng(0).uniform(-1, 1, own.n)
    assert np.abs(robot.fk(q) - own.fk(q)).max() < 1e-12


MJCF = """<mujoco><compiler angle="radian"/><worldbody><body name="a">
<joint name="one" axis="0 0 1"/><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
<body name="b" pos="1 0 0">
<joint name="two" axis="0 0 1" ref="0.3"/><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
<site name="tip" pos="1 0 0"/></body></body></worldbody><equality>{}</equality></mujoco>"""


def test_references_of_an_equality_are_in_the_offset(written):
    """MuJoCo counts from qpos0: two - 0.3 = 0.1 - 2 one, so two = -2 one + 0.4."""
    line = '<joint joint1="two" joint2="one" polycoef="0.1 -2 0 0 0"/>'
    table = extract_dh(written("arm.xml", MJCF.format(line)), tip="tip").table
    found = table.joints[1].mimic
    assert (found.joint, found.multiplier) == ("one", -2.0)
    assert abs(found.offset - 0.4) < 1e-15


@pytest.mark.parametrize(
    ("lines", "why"),
    [
        ('<joint joint1="two" joint2="one" polycoef="0 1 0.5 0 0"/>', "no straight line"),
        ('<joint joint1="one" joint2="two"/><joint joint1="two" joint2="one"/>', "in a circle"),
    ],
)
def test_equalities_that_are_not_followed_are_told(lines, why, written):
    """Curves, and joints that follow each other."""
    found = extract_dh(written("arm.xml", MJCF.format(lines)), tip="tip")
    assert any("two" in warning and why in warning for warning in found.warnings)


def test_equalities_that_are_off_or_fix_a_value_are_none(written):
    """An inactive one, and one without a second joint, move nothing along."""
    lines = '<joint joint1="two" joint2="one" active="false"/><joint joint1="one"/>'
    found = extract_dh(written("arm.xml", MJCF.format(lines)), tip="tip")
    assert mimics(found.table) == [None, None]
