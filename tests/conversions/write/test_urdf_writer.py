"""The written URDF equals the DH product, frame by frame, for any table."""

import math

import pinocchio as pin
import pytest
from dh_product import dh_frames, difference
from example_robots import placed
from hypothesis import given, settings
from lxml import etree
from strategies import FACTORY, tables

import dh2urdf
from dh2urdf.bounds import ANGLE
from dh2urdf.conversions.write.urdf_elements import urdf_text_and_warnings
from dh2urdf.conversions.write.verify import random_configurations
from dh2urdf.dh_io import parse_table
from dh2urdf.dh_io.xml import embedded_table
from dh2urdf.exceptions import TableError


def pinocchio_frames(text, table, q):
    """Frames dh_0 ... dh_n and tool0 of a URDF text, by Pinocchio, joints found by name."""
    by_name = dict(zip(table.joint_names, q, strict=True))
    names = [*(f"dh_{i}" for i in range(table.n + 1)), "tool0"]
    return [T.homogeneous for T in placed(pin.buildModelFromXML(text), by_name, *names)]


def largest_difference(table, count=2, seed=1):
    """Largest entry over frames and configurations, over the table's length where above 1 m."""
    text = dh2urdf.urdf_text(table)
    worst = 0.0
    for q in random_configurations(table, count, seed):
        worst = max(worst, difference(pinocchio_frames(text, table, q), dh_frames(table, q)))
    lengths = sum(abs(v) for row in table.rows for v in (row.a, row.d))
    lengths += sum(math.hypot(*row.origin.xyz) for row in table.rows if row.origin)
    travel = sum(
        abs(v or 0) for r in table.joints if r.joint_type == "prismatic" for v in (r.upper,)
    )
    lengths += math.hypot(*table.base.xyz) + math.hypot(*table.tool.xyz) + travel
    return worst / max(1.0, lengths)


@settings(max_examples=1500)
@given(tables())
def test_written_frames_equal_the_dh_product(table):
    """Every dh_i frame and tool0, placed by Pinocchio, equals the DH product to 1e-12."""
    assert largest_difference(table) <= 1e-12


@pytest.mark.exhaustive
@settings(max_examples=20000)
@given(tables())
def test_written_frames_equal_the_dh_product_of_many_tables(table):
    """The same over 20,000 tables."""
    assert largest_difference(table) <= 1e-12


@settings(max_examples=200)
@given(tables())
def test_embedded_table_comes_back_identical(table):
    """The table in the <dh2urdf> element equals the one written, to the last bit."""
    root = etree.fromstring(dh2urdf.urdf_text(table).encode())
    assert parse_table(root.findtext("dh2urdf"), "json").table == table


def test_factory_calibrated_arm_survives():
    """Offsets of 439 m and -446 m come back with the tip placed to 1e-12 of them."""
    assert largest_difference(FACTORY, count=20) <= 1e-12


def test_file_is_written_whole_and_read_back(tmp_path):
    """write_urdf reports the proof, and load_table reads the table from the file."""
    table = dh2urdf.load_table("denso_vs6556")
    report = dh2urdf.write_urdf(table, tmp_path / "denso.urdf")
    assert report.path == tmp_path / "denso.urdf"
    assert report.max_error < 1e-12
    assert embedded_table(report.path) == table
    assert dh2urdf.load_table(report.path) == table


def test_negative_sign_turns_the_axis():
    """A row with sign -1 is written as axis 0 0 -1, its limits stay those of q."""
    table = dh2urdf.DHTable((dh2urdf.DHRow(a=1.0, sign=-1, lower=-0.5, upper=1.0),), "standard")
    root = etree.fromstring(dh2urdf.urdf_text(table).encode())
    joint = root.find("joint[@type='revolute']")
    assert joint.find("axis").get("xyz") == "0 0 -1"
    assert (joint.find("limit").get("lower"), joint.find("limit").get("upper")) == ("-0.5", "1.0")


def test_no_joint_is_continuous_and_no_number_is_odd():
    """Every joint has limits, no number reads -0.0, inf or nan."""
    for name in dh2urdf.list_tables():
        root = etree.fromstring(dh2urdf.urdf_text(dh2urdf.load_table(name)).encode())
        for joint in root.iterfind("joint"):
            assert joint.get("type") in {"revolute", "prismatic", "fixed"}
            if joint.get("type") != "fixed":
                limit = joint.find("limit")
                assert {"lower", "upper", "effort", "velocity"} <= set(limit.keys())
        for element in root.iter():
            words = " ".join(v for k, v in element.attrib.items() if k != "name").split()
            assert not {"-0.0", "inf", "-inf", "nan"} & set(words)


def test_missing_limits_are_named():
    """A table without limits says which joints got which limits."""
    table = dh2urdf.DHTable(
        (dh2urdf.DHRow(a=0.5), dh2urdf.DHRow(joint_type="prismatic", d=0.25)), "standard"
    )
    far = "as far as the table's lengths sum to"
    assert urdf_text_and_warnings(table, dh2urdf.UrdfOptions())[1] == (
        "joint_1: no limits in the table; written as +-2 pi rad",
        f"joint_2: no limits in the table; written as +-0.75 m, {far}",
    )


def test_options_are_honoured():
    """No DH frames, rounding and collision bodies are written when asked for."""
    table = dh2urdf.load_table("ur5")
    bare = dh2urdf.urdf_text(table, dh2urdf.UrdfOptions(dh_frames=False, embed_table=False))
    assert "dh_0" not in bare
    assert "dh2urdf" not in bare
    rounded = etree.fromstring(dh2urdf.urdf_text(table, dh2urdf.UrdfOptions(digits=5)).encode())
    xyz = rounded.find("joint[@name='dh_1_fixed']/origin").get("xyz").split()
    assert all(len(v.partition(".")[2]) <= 5 for v in xyz)
    assert "<collision>" in dh2urdf.urdf_text(table, dh2urdf.UrdfOptions(collision=True))


def test_a_missing_bound_is_named():
    """A table that gives one bound of two is told which was made up."""
    for bound, words in (
        ({"upper": 1.0}, "(lower): no limits in the table; written as +-2 pi rad"),
        (
            {"lower": ANGLE},
            "(upper): no limits in the table; written as 100000 rad, beyond the one that is given",
        ),
    ):
        table = dh2urdf.DHTable((dh2urdf.DHRow(a=0.5, **bound),), "standard")
        _, warnings = urdf_text_and_warnings(table, dh2urdf.UrdfOptions())
        assert warnings == (f"joint_1 {words}",)


@pytest.mark.parametrize("name", ["ur5", "gantry", "puma560"])
def test_rounded_files_differ_by_what_rounding_explains(name, tmp_path):
    """A file rounded to 3, 5 or 9 decimals is written, and its error says what that cost."""
    table = dh2urdf.load_table(name)
    for digits in (3, 5, 9):
        options = dh2urdf.UrdfOptions(digits=digits)
        report = dh2urdf.write_urdf(table, tmp_path / "rounded.urdf", options=options)
        assert 10.0 ** -(digits + 2) < report.max_error < 2.0 * 10.0**-digits


def test_names_that_xml_forbids_are_an_error():
    """A control character in a name, or a name of the file's own joints, is refused."""
    for bad in ("a\x00b", "tool0_fixed"):
        table = dh2urdf.DHTable((dh2urdf.DHRow(a=1.0, name=bad),), "standard")
        with pytest.raises(TableError, match="name"):
            dh2urdf.urdf_text(table)
