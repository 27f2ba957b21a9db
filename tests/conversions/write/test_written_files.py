"""Files that are written: over what, under which name, with which limits and how many digits."""

import math
import os

import numpy as np
import pinocchio as pin
import pytest
from example_robots import placed
from hostile import outcome
from hypothesis import given
from hypothesis import strategies as st
from lxml import etree
from strategies import tables

import dh2urdf
from dh2urdf import DHRow, DHTable, JointType, UrdfOptions
from dh2urdf.conversions.write.urdf_elements import urdf_text_and_warnings
from dh2urdf.conversions.write.urdf_file import verified_urdf
from dh2urdf.conversions.write.verify import verify_urdf_text
from dh2urdf.exceptions import (
    ArgumentError,
    Dh2UrdfError,
    NameNotFoundError,
    OutputError,
    OutputExistsError,
    VerificationError,
)
from dh2urdf.symbolic import symbolic_product


def limits_of(text):
    """Lower and upper of the moving joints as Pinocchio reads them."""
    model = pin.buildModelFromXML(text)
    return model.lowerPositionLimit, model.upperPositionLimit


BOUND = st.none() | st.floats(-1e4, 1e4) | st.sampled_from([1.5, -400 * math.pi / 180, 1e5, -1e5])


@given(
    bounds=st.tuples(BOUND, BOUND).filter(lambda b: None in b or b[0] <= b[1]),
    kind=st.sampled_from([JointType.REVOLUTE, JointType.PRISMATIC]),
    a=st.sampled_from([0.0, 0.3]),
)
def test_a_made_up_limit_lies_beyond_the_given_one(bounds, kind, a):
    """Whatever bound is missing, the written range is a range, and holds the given bound."""
    table = DHTable((DHRow(a=a, joint_type=kind, lower=bounds[0], upper=bounds[1]),), "standard")
    options = UrdfOptions()
    text, warnings = urdf_text_and_warnings(table, options)
    (low,), (high,) = limits_of(text)
    assert bounds[0] in (None, low)
    assert bounds[1] in (None, high)
    assert low <= high
    if None in bounds and set(bounds) & {1e5, -1e5} == set():
        assert low < high
        assert f"{(low if bounds[0] is None else high):.6g}" in warnings[0] or "+-" in warnings[0]
    verify_urdf_text(text, table)
    robot = dh2urdf.Robot.from_dh(table)
    q = robot.random_configuration(0)
    assert robot.lower <= q <= robot.upper


def test_a_limit_that_was_written_wrong_leaves_no_file():
    """The check after writing reads the limits too: turned round, moved, or left empty."""
    table = DHTable((DHRow(a=1.0, lower=-1.0, upper=2.0),), "standard")
    text = dh2urdf.urdf_text(table)
    verify_urdf_text(text, table)
    for wrong in ('lower="2.0" upper="-1.0"', 'lower="-1.0" upper="1.999"'):
        with pytest.raises(VerificationError, match="joint_1 has the limits"):
            verify_urdf_text(text.replace('lower="-1.0" upper="2.0"', wrong), table)


@pytest.mark.parametrize("digits", [0, 1])
def test_a_rounded_file_of_no_use_is_not_written(digits, tmp_path, run):
    """Digits that put the tip of a UR5 off by decimetres are refused, and no file is left."""
    path = tmp_path / "ur5.urdf"
    with pytest.raises(VerificationError, match="give more digits"):
        dh2urdf.write_urdf("ur5", path, options=UrdfOptions(digits=digits))
    status, _, err = run("convert", "ur5", "-o", path, "--digits", digits)
    assert status != 0
    assert "give more digits" in err
    assert not path.exists()


@given(table=tables(max_joints=4), digits=st.integers(0, 9))
def test_a_rounded_file_is_within_a_hundredth_of_the_arm(table, digits):
    """What is written with few digits is measured anew: a hundredth of the arm, or no file."""
    got = outcome(verified_urdf, table, UrdfOptions(digits=digits))
    if isinstance(got, VerificationError):
        assert digits < 5 or table.length < 0.01 or "has the limits" in str(got)
        return
    text = got[0]
    model = pin.buildModelFromXML(text)
    (T_base_tool,) = placed(model, {}, "tool0")
    slides = np.array([row.joint_type == "prismatic" for row in table.joints])
    travel = np.maximum(np.abs(model.lowerPositionLimit), np.abs(model.upperPositionLimit))
    size = table.length + math.hypot(*table.base.xyz) + travel[slides].sum() or 1.0
    off = T_base_tool.translation - table.fk(np.zeros(table.n))[:3, 3]
    assert np.linalg.norm(off) <= 0.05 * size


def test_exact_numbers_need_no_digits(tmp_path):
    """An arm of whole metres and no angles is written with no decimals at all."""
    table = DHTable((DHRow(a=1.0, lower=-3.0, upper=3.0), DHRow(a=2.0)), "standard")
    report = dh2urdf.write_urdf(table, tmp_path / "rr.urdf", options=UrdfOptions(digits=0))
    assert report.max_error < 1e-12


def test_an_arm_of_millions_of_metres_is_written(tmp_path):
    """The difference that is allowed grows with the arm, as floats do."""
    rows = tuple(DHRow(0.1, 1e6, 2e6, 0.3) for _ in range(6))
    report = dh2urdf.write_urdf(DHTable(rows, "standard"), tmp_path / "far.urdf")
    assert report.max_error < 1e-9 * 6 * 3e6


@pytest.mark.parametrize(
    ("options", "says"),
    [
        ({"digits": 1.5}, "digits: expected a whole number from 0 to 17"),
        ({"digits": -1}, "digits"),
        ({"digits": 10**30}, "digits"),
        ({"digits": True}, "digits"),
        ({"density": math.nan}, "density: expected a number from 0.001 to"),
        ({"density": "x"}, "density"),
        ({"dh_frames": 1}, "dh_frames: expected True or False, got 1"),
        ({"embed_table": None}, "embed_table"),
    ],
)
def test_an_option_of_the_file_is_of_its_kind(options, says):
    """Options of the wrong kind or beyond their bounds are refused by name."""
    with pytest.raises(ArgumentError, match=says):
        UrdfOptions(**options)


@pytest.mark.parametrize("embed", [True, False])
def test_a_file_of_ours_is_written_over(embed, tmp_path):
    """With or without its table a file is known to its writer; somebody else's is not."""
    path, options = tmp_path / "arm.urdf", UrdfOptions(embed_table=embed)
    dh2urdf.write_urdf("ur5", path, options=options)
    dh2urdf.write_urdf("puma560", path, options=options)
    assert etree.parse(path).getroot().get("name") == "puma560"
    theirs = "<robot name='theirs'><link name='a'/></robot>"
    path.write_text(theirs)
    with pytest.raises(OutputExistsError, match="force"):
        dh2urdf.write_urdf("ur5", path, options=options)
    assert path.read_text() == theirs
    dh2urdf.write_urdf("ur5", path, options=options, force=True)


@pytest.mark.parametrize(
    ("name", "told"),
    [
        *[(name, ".urdf, .xml, .mjcf, .yaml") for name in ("arm.txt", "arm", "arm.urdf.bak")],
        ("arm.png", "dh2urdf figure"),
    ],
)
def test_convert_refuses_a_suffix_that_it_does_not_write(name, told, tmp_path, refused):
    """Another suffix is refused with those there are, before anything is written."""
    assert told in refused("convert", "ur5", "-o", name)
    assert not (tmp_path / name).exists()


@pytest.mark.parametrize("names", [["ur5"], ["ur5", "puma560"]])
def test_convert_makes_its_folder(names, tmp_path, run):
    """``--out-dir new`` is made for one table as for two."""
    folder = tmp_path / "new" / "deep"
    assert run("convert", *names, "--out-dir", folder)[0] == 0
    assert sorted(path.stem for path in folder.iterdir()) == sorted(names)


CALLS = {
    "urdf_text": dh2urdf.urdf_text,
    "to_convention": lambda table: dh2urdf.to_convention(table, "modified"),
    "from_dh": dh2urdf.Robot.from_dh,
    "write_urdf": lambda table: dh2urdf.write_urdf(table, os.devnull),
    "save_table": lambda table: dh2urdf.save_table(table, os.devnull, format="yaml"),
    "verified_urdf": verified_urdf,
    "symbolic_product": symbolic_product,
}


@pytest.mark.parametrize("call", list(CALLS))
def test_what_takes_a_table_takes_a_name_or_a_path(call, tmp_path):
    """Every function of a table takes the name of one that ships, a path, and nothing else."""
    pytest.importorskip("sympy")
    path = tmp_path / "arm.toml"
    table = dh2urdf.load_table("planar_rr")
    dh2urdf.save_table(table, path)
    answers = [CALLS[call](given) for given in (table, "planar_rr", path, str(path))]
    if call in ("urdf_text", "to_convention", "verified_urdf", "symbolic_product"):
        assert all(answer == answers[0] for answer in answers)
    for odd in (1, None, [0, 1], 1j, object(), table.rows):
        with pytest.raises(ArgumentError, match="table: expected a DHTable, a path or the name"):
            CALLS[call](odd)
    for missing in ("ur55", "a\0b", "\ud800", "x" * 400):
        with pytest.raises(NameNotFoundError, match="neither a file nor a table that ships"):
            CALLS[call](missing)


@pytest.mark.parametrize("path", [1, None, [], object(), 1.5])
def test_what_is_no_path_is_refused(path):
    """A number in place of a path is told; a file descriptor is not written to."""
    for call in (dh2urdf.save_table, dh2urdf.write_urdf):
        with pytest.raises(ArgumentError, match="path: expected a path, got "):
            call("ur5", path)


@pytest.mark.parametrize("name", ["x" * 300 + ".urdf", "a\0b.urdf", "\ud800.urdf"])
def test_a_name_that_no_file_can_have_is_refused(name, tmp_path):
    """Names over 255 bytes, with NUL or half a character end in one message."""
    for call in (dh2urdf.write_urdf, dh2urdf.save_table):
        target = str(tmp_path / name)
        if call is dh2urdf.save_table:
            target = target.replace(".urdf", ".yaml")
        with pytest.raises(OutputError, match="cannot write"):
            call("ur5", target)
    with pytest.raises(Dh2UrdfError):
        dh2urdf.load_table(str(tmp_path / name))
