"""Faults of a robot description: a warning off the way, mended where the reading is obvious."""

import math
import re

import numpy as np
import pinocchio as pin
import pytest

from dh2urdf import Robot, extract_dh
from dh2urdf.exceptions import Dh2UrdfError, UrdfError

ARM = """<robot name="arm">
<link name="base"/>
<link name="upper"/>
<link name="fore"/>
<link name="tool0"/>
<link name="finger"/>
<link name="camera"/>
<joint name="shoulder" type="revolute">
<parent link="base"/><child link="upper"/><origin xyz="0 0 0.4" rpy="0.1 0 0"/><axis xyz="0 0 1"/>
<limit lower="-2" upper="2" effort="10" velocity="3"/></joint>
<joint name="elbow" type="revolute">
<parent link="upper"/><child link="fore"/><origin xyz="0.3 0 0"/><axis xyz="0 1 0"/>
<limit lower="-1" upper="2" effort="10" velocity="3"/></joint>
<joint name="flange" type="fixed"><parent link="fore"/><child link="tool0"/>
<origin xyz="0 0 0.2"/></joint>
<joint name="grip" type="prismatic">
<parent link="tool0"/><child link="finger"/><origin xyz="0 0.1 0"/><axis xyz="1 0 0"/>
<limit lower="0" upper="0.02" effort="10" velocity="3"/></joint>
<joint name="mount" type="fixed"><parent link="upper"/><child link="camera"/></joint>
</robot>
"""

SHOULDER = '<limit lower="-2" upper="2" effort="10" velocity="3"/>'
GRIP = '<limit lower="0" upper="0.02" effort="10" velocity="3"/>'
GRIP_AXIS = '<origin xyz="0 0.1 0"/><axis xyz="1 0 0"/>'
ELBOW = 'name="elbow" type="revolute"'
UPPER = '<link name="upper"/>'
INERTIAL = '<link name="upper"><inertial><mass value="1"/>{}</inertial></link>'

OFF = {
    "reversed": (GRIP, GRIP.replace("0.02", "-0.0135"), r':18: <limit> of <joint name="grip">'),
    "no limit": (GRIP, "", r':16: <joint name="grip">: no <limit>'),
    "a bad limit": (GRIP, GRIP.replace('"0.02"', '"wide"'), r":18: .*upper=\"wide\" is not a num"),
    "a zero axis": (GRIP_AXIS, '<axis xyz="0 0 0"/>', r":17: <axis> .*zero axis; held still"),
    "no axis xyz": (GRIP_AXIS, "<axis/>", r":17: <axis> .*has no xyz; held still"),
    "a bad origin": (GRIP_AXIS, '<origin xyz="0 up 0"/>', r":17: <origin> .*3 numbers; held still"),
    "NaN": (GRIP_AXIS, '<origin rpy="0 nan 0"/>', r":17: .* is not finite; held still"),
    "1e308": (GRIP_AXIS, '<origin rpy="0 1e308 0"/>', r":17: .* lies beyond 1e\+05; held still"),
    "a type": ('type="prismatic"', 'type="slider"', r':16: .*type="slider" is not one of'),
    "no type": (' type="prismatic"', "", r':16: .*type="" is not one of'),
    "no name": ('name="grip"', "", r":16: <joint>.*has no name"),
    "a name twice": ('name="grip"', 'name="mount"', r":1[69]: <joint name=\"mount\".*second joint"),
    "no child": ('<child link="camera"/>', "", r':19: <joint name="mount">: has no <child'),
    "no parent": ('<parent link="upper"/><child link="camera"/>', "", ":19: .*has no <parent"),
    "a lost link": ("</robot>", '<link name="lost"/></robot>', r":20: .*a second root; left out"),
    "a link twice": ("</robot>", '<link name="camera"/></robot>', ":20: .*second link of this"),
    "no link name": ("</robot>", "<link/></robot>", ":20: <link>: has no name; left out"),
    "an unknown link": ('child link="camera"', 'child link="cam"', ":19: .*no link is named 'cam'"),
    "two parents": (
        "</robot>",
        '<joint name="x" type="fixed"><parent link="base"/><child link="camera"/></joint></robot>',
        r":20: <joint name=\"x\">: link 'camera' hangs on joint 'mount' already",
    ),
    "a loop": (
        "</robot>",
        '<link name="p"/><link name="q"/><joint name="pq" type="fixed"><parent link="p"/>'
        '<child link="q"/></joint><joint name="qp" type="fixed"><parent link="q"/>'
        '<child link="p"/></joint></robot>',
        r":20: <link name=\"p\">: hangs on 'q'; left out",
    ),
    "a mimic of nothing": (GRIP, GRIP + '<mimic joint="gone"/>', r":18: <mimic> .*no joint 'gone'"),
    "a mimic of itself": (GRIP, GRIP + '<mimic joint="grip"/>', r":18: <mimic> .*no joint 'grip'"),
    "a mimic by words": (
        *(GRIP, f'{GRIP}<mimic joint="elbow" multiplier="two"/>'),
        r':18: <mimic> .*multiplier="two" is not a number',
    ),
}

ON = {
    "no limit": (SHOULDER, "", r':8: <joint name="shoulder">: no <limit>; read as unlimited'),
    "no bounds": (SHOULDER, '<limit effort="1" velocity="1"/>', ":10: <limit> .*no lower and no"),
    "no effort": (SHOULDER, '<limit lower="-2" upper="2" velocity="3"/>', ":10: .*has no effort"),
    "no velocity": (SHOULDER, '<limit lower="-2" upper="2" effort="3"/>', ":10: .*has no velocity"),
    "effort -1": (SHOULDER, SHOULDER.replace("10", "-1"), r':10: .*effort="-1.0" is negative'),
    "effort max": (SHOULDER, SHOULDER.replace("10", "max"), r':10: .*effort="max" is not a number'),
    "infinite": (SHOULDER, SHOULDER.replace('"2"', '"inf"'), r':10: .*upper="inf" lies beyond'),
    "1e9": (SHOULDER, SHOULDER.replace('"2"', '"1e9"'), r':10: .*upper="1e9" lies beyond 1e\+05'),
    "floating": (
        '<link name="base"/>',
        '<link name="base"/><link name="world"/><joint name="free" type="floating">'
        '<parent link="world"/><child link="base"/><origin xyz="0 0 1"/></joint>',
        r':2: <joint name="free">: a floating joint before the arm; held at rest',
    ),
    "planar": (
        '<link name="base"/>',
        '<link name="base"/><link name="world"/><joint name="free" type="planar">'
        '<parent link="world"/><child link="base"/></joint>',
        ":2: .*a planar joint before the arm",
    ),
    "a mass": (UPPER, INERTIAL.replace("1", "-1"), ":3: <inertial> .*mass of -1.0"),
    "an inertia": (
        UPPER,
        INERTIAL.format('<inertia ixx="a" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>'),
        r':3: <inertia> of <link name="upper">: ixx="a" is not a number; <inertial> left out',
    ),
    "an inertial's origin": (
        UPPER,
        INERTIAL.format('<origin xyz="nan 0 0"/>'),
        r':3: <origin> .*xyz="nan 0 0" is not finite; <inertial> left out',
    ),
    "damping": (
        SHOULDER,
        f'{SHOULDER}<dynamics damping="-3"/>',
        ':10: <dynamics> .*damping="-3.0"',
    ),
    "a mimic": (SHOULDER, SHOULDER + '<mimic joint="gone"/>', ":10: <mimic> .*no joint 'gone'"),
}


def write(written, old, new):
    assert ARM.count(old) >= 1
    return written("arm.urdf", ARM.replace(old, new, 1))


def sound(written):
    return Robot.from_urdf(written("sound.urdf", ARM), "base", "tool0")


def test_a_sound_file_has_no_warnings(written, tmp_path):
    """Nothing to mend, nothing said, strictly or not."""
    assert sound(written).warnings == ()
    assert Robot.from_urdf(tmp_path / "sound.urdf", strict=True).n == 3


@pytest.mark.parametrize("ends", [("base", "tool0"), (None, "tool0")])
@pytest.mark.parametrize("fault", OFF)
def test_a_fault_off_the_way_is_a_warning(fault, ends, written):
    """The arm is the same, the fault is named by element and line, and strict refuses it."""
    old, new, message = OFF[fault]
    path = write(written, old, new)
    robot = Robot.from_urdf(path, *ends)
    q = np.array([0.7, -0.4])
    np.testing.assert_array_equal(robot.fk(q), sound(written).fk(q))
    text = "\n".join(robot.warnings)

    assert re.search(message, text), text
    assert all("arm.urdf:" in line for line in robot.warnings)
    found = extract_dh(path, *ends)
    assert set(robot.warnings) <= set(found.warnings)
    with pytest.raises(UrdfError, match=message):
        Robot.from_urdf(path, *ends, strict=True)


@pytest.mark.parametrize("fault", ON)
def test_an_obvious_reading_on_the_way_is_mended_and_said(fault, written):
    """The arm is built as the file means it; strict refuses."""
    old, new, message = ON[fault]
    path = write(written, old, new)
    robot = Robot.from_urdf(path, tip="tool0")

    assert re.search(message, "\n".join(robot.warnings)), robot.warnings
    q = np.array([0.7, -0.4])
    expected = sound(written).fk(q)
    if fault == "floating":
        expected[2, 3] += 1.0
    np.testing.assert_allclose(robot.fk(q), expected, rtol=0, atol=1e-15)
    np.testing.assert_allclose(robot.fk(q[None])[0], expected, rtol=0, atol=1e-15)
    extract_dh(path, tip="tool0")
    with pytest.raises(UrdfError, match=message):
        Robot.from_urdf(path, tip="tool0", strict=True)


def test_missing_limits_are_none(written):
    """Without <limit> a joint turns as far as it likes; the others keep theirs."""
    robot = Robot.from_urdf(write(written, SHOULDER, ""), tip="tool0")
    np.testing.assert_array_equal(robot.lower, [-math.inf, -1])
    np.testing.assert_array_equal(robot.upper, [math.inf, 2])


FATAL = {
    "a zero axis": ('<axis xyz="0 1 0"/>', '<axis xyz="0 0 0"/>', ":12: <axis> .*a zero axis"),
    "an origin": ('xyz="0.3 0 0"', 'xyz="0.3 0"', r":12: <origin> .*is not 3 numbers"),
    "a type": (ELBOW, ELBOW.replace("revolute", "hinge"), ":11: .*is not one of"),
    "crossed": (SHOULDER, SHOULDER.replace('"-2"', '"3"'), ":10: .*lower 3.0 lies above upper 2.0"),
    "a name twice": ('name="elbow"', 'name="shoulder"', ":11: .*second joint of this name"),
    "a broken way": ('<parent link="upper"/><child link="fore"/>', "", ":11: .*has no <parent"),
    "a free elbow": (ELBOW, ELBOW.replace("revolute", "floating"), ":11: .*floating joint between"),
    "an unknown link": ('"upper"/><child', '"uper"/><child', ":12: .*no link is named 'uper'"),
}


@pytest.mark.parametrize("ends", [("base", "tool0"), (None, "tool0"), (None, None)])
@pytest.mark.parametrize("fault", FATAL)
def test_what_has_no_obvious_reading_on_the_way_is_refused(fault, ends, written):
    """One line that names the element; never another arm than the file's."""
    if fault == "a free elbow" and ends == (None, None):
        ends = (None, "finger")  # unless asked for, no chain goes over such a joint
    old, new, message = FATAL[fault]
    with pytest.raises(UrdfError, match=message) as caught:
        Robot.from_urdf(write(written, old, new), *ends)
    assert "\n" not in str(caught.value)


def test_an_arm_in_two_pieces_is_never_half_an_arm(written):
    """Where base and tip are not both given, a joint that hangs nowhere may be on the way."""
    path = write(written, '<child link="fore"/>', '<child link="for"/>')
    for ends in ((None, None), ("base", None), (None, "finger"), ("base", "finger")):
        with pytest.raises(UrdfError, match="no link is named 'for'"):
            Robot.from_urdf(path, *ends)
    robot = Robot.from_urdf(path, "base", "camera")
    assert robot.joint_names == ("shoulder",)


def test_ends_in_two_trees_are_told(written):
    """Base and tip that do not hang together are one message."""
    path = write(written, "</robot>", '<link name="lost"/></robot>')
    with pytest.raises(UrdfError, match=r"'base' and 'lost' do not hang together"):
        Robot.from_urdf(path, "base", "lost")


def test_a_mimic_whose_limits_exclude_its_leaders(written):
    """The follower's limits count for nothing, which is said; FK and IK work."""
    follower = SHOULDER.replace('"-2" upper="2"', '"-1.5" upper="-1"')
    text = ARM.replace(SHOULDER, SHOULDER.replace("-2", "0.5"), 1)
    old = '<limit lower="-1" upper="2" effort="10" velocity="3"/>'
    path = written("arm.urdf", text.replace(old, follower + '<mimic joint="shoulder"/>'))
    robot = Robot.from_urdf(path, tip="tool0")
    assert (robot.n, robot.lower[0], robot.upper[0]) == (1, 0.5, 2.0)
    assert any("'elbow': its limits exclude those of 'shoulder'" in w for w in robot.warnings)
    assert robot.fk([0.7]).shape == (4, 4)
    with pytest.raises(Dh2UrdfError, match="exclude"):
        Robot.from_urdf(path, tip="tool0", strict=True)


@pytest.mark.parametrize("fault", [*OFF, *ON])
def test_check_fix_writes_what_was_mended(fault, written, tmp_path, run):
    """The written file is the same arm, and has nothing to mend, even strictly."""
    old, new, message = {**OFF, **ON}[fault]
    path, out = write(written, old, new), tmp_path / "out.urdf"
    status, said, _ = run("check", path, "--fix", out, "--tip", "tool0")
    assert status == 0
    assert re.search(message, said)
    robot = Robot.from_urdf(out, tip="tool0", strict=True)
    assert robot.warnings == ()
    q = np.array([0.7, -0.4])
    np.testing.assert_array_equal(robot.fk(q), Robot.from_urdf(path, tip="tool0").fk(q))
    assert pin.buildModelFromUrdf(str(out)).existBodyName("tool0")


def test_check_fix_spares_others_files(written, tmp_path, run, refused):
    """A file that is not ours stays, unless forced; one that was mended is written over."""
    old, new, _ = OFF["reversed"]
    path, out = write(written, old, new), tmp_path / "out.urdf"
    out.write_text("<robot/>")
    argv = ["check", path, "--tip", "tool0", "--fix", out]
    assert "--force" in refused(*argv)
    for extra in ["--force"], []:
        assert run(*argv, *extra)[0] == 0
    assert 'lower="-0.0135" upper="0"' in out.read_text()


def test_check_fix_refuses_what_has_no_obvious_reading(written, tmp_path, refused):
    """A zero axis of the arm is nobody's to guess: status 2 and no file."""
    old, new, message = FATAL["a zero axis"]
    path, out = write(written, old, new), tmp_path / "out.urdf"
    for flags in ([], ["--force"]):
        assert re.search(message, refused("check", path, "--fix", out, *flags))
        assert not out.exists()
