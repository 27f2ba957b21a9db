"""What a URDF and an MJCF say of joints that follow others or are coupled."""

import math
import re

import numpy as np
import pinocchio as pin
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from strategies import coupled_tables

from dh2urdf import (
    DHRow,
    DHTable,
    Mimic,
    Robot,
    UrdfOptions,
    extract_dh,
    to_convention,
    urdf_text,
    write_urdf,
)
from dh2urdf.conversions.write import verified_urdf
from dh2urdf.convert import table_of_description


def follower(**mimic):
    """Joint 2 follows joint 1, which goes from -1 to 2."""
    rows = (DHRow(a=1.0, lower=-1.0, upper=2.0), DHRow(a=0.5, mimic=Mimic("joint_1", **mimic)))
    return DHTable(rows, "standard", name="arm")


COUPLED = DHTable(
    (
        DHRow(a=1.0, lower=-1.0, upper=2.0),
        DHRow(a=0.5, lower=-0.5, upper=0.5, serial_upper=2.0),
        DHRow(a=0.3, lower=-1, upper=1),
    ),
    "standard",
    couplings={"joint_2": {"joint_1": 1.0}},
)


def limits_of(text, name):
    """Lower and upper limit of a joint of a URDF."""
    part = text.split(f'<joint name="{name}"')[1]
    return tuple(float(re.search(rf'{key}="([^"]+)"', part)[1]) for key in ("lower", "upper"))


def test_a_follower_is_a_mimic_with_all_digits():
    """Joint, multiplier and offset, in radians."""
    text = urdf_text(follower(multiplier=-0.1, offset=math.pi / 3), UrdfOptions(digits=3))
    assert f'<mimic joint="joint_1" multiplier="-0.1" offset="{math.pi / 3!r}"/>' in text


def test_a_follower_without_limits_goes_as_far_as_it_is_led():
    """-2 times -1 to 2, plus a half; the one that leads keeps its own, and nobody is warned."""
    text, _, warnings = verified_urdf(follower(multiplier=-2.0, offset=0.5))
    assert limits_of(text, "joint_2") == (-3.5, 2.5)
    assert limits_of(text, "joint_1") == (-1.0, 2.0)
    assert not warnings


def test_a_coupled_joint_is_written_by_itself_and_says_so():
    """Its limits are the range that results, a comment and a warning tell it."""
    text, error, warnings = verified_urdf(COUPLED)
    assert error < 1e-9
    assert limits_of(text, "joint_2") == (-1.5, 2.0)
    assert "<mimic joint" not in text
    [said] = warnings
    assert said.startswith("joint_2 is at its value plus joint_1, which no <mimic> can say")
    assert "joint_2 is at its value plus joint_1" in "".join(re.findall("<!--(.*?)-->", text))


def test_names_with_dashes_are_no_end_of_the_comment():
    """Two dashes end none."""
    rows = tuple(DHRow(a=0.5, name=name) for name in ("a--b", "c---d"))
    table = DHTable(rows, "standard", couplings={"c---d": {"a--b": 0.5}})
    assert verified_urdf(table)[1] < 1e-9


@settings(max_examples=60, deadline=None)
@given(coupled_tables(), st.integers(0, 2**32 - 1))
def test_the_written_file_is_the_same_robot(table, seed):
    """Followers are read from <mimic>; the table that the file carries is the whole of it."""
    text, error, _ = verified_urdf(table)
    assert error < 1e-9 * max(1.0, table.length + 10)
    assert table_of_description(text).table == table
    if table.couplings:
        return
    read, robot = Robot.from_urdf(text), Robot.from_dh(table)
    q = np.random.default_rng(seed).uniform(-1, 1, robot.n)
    assert read.joint_names == robot.joint_names
    assert np.abs(read.fk(q) - robot.fk(q)).max() < 1e-12 * max(1.0, table.length + 10)


def test_a_written_file_reports_what_no_mimic_can_say(tmp_path):
    """As convert prints it."""
    report = write_urdf(COUPLED, tmp_path / "arm.urdf")
    assert any("which no <mimic> can say" in warning for warning in report.warnings)


@pytest.mark.parametrize("table", [COUPLED, follower(multiplier=2.0)])
def test_a_table_of_the_other_convention_moves_its_joints_as_well(table):
    """Frames change, what joints follow does not."""
    other = to_convention(table, "modified")
    a, b = Robot.from_dh(table), Robot.from_dh(other)
    q = np.random.default_rng(0).uniform(-1, 1, (5, a.n))
    assert other.couplings == table.couplings
    assert np.abs(a.fk(q) - b.fk(q)).max() < 1e-12


def test_a_follower_of_a_follower_is_written_as_one_of_what_leads_both():
    """Pinocchio and yourdfpy take no other; the embedded table keeps what it says."""
    rows = (
        DHRow(a=1.0, lower=-1.0, upper=2.0),
        DHRow(a=0.5, mimic=Mimic("joint_1", -2.0, 0.1)),
        DHRow(a=0.3, mimic=Mimic("joint_2", -0.5, 0.2)),
    )
    table = DHTable(rows, "standard", name="arm")
    text = verified_urdf(table)[0]
    assert text.count('<mimic joint="joint_1"') == 2
    model = pin.buildModelFromXML(text, mimic=True)
    data = model.createData()
    pin.framesForwardKinematics(model, data, np.array([0.3]))
    T = data.oMf[model.getFrameId("tool0")].homogeneous
    assert np.abs(T - Robot.from_dh(table).fk([0.3])).max() < 1e-12
    found = extract_dh(text)
    assert found.table == table
    assert not found.warnings
