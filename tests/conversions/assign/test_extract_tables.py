"""Tables whose parameters are published come back, and every table comes back as the same arm."""

import math

import numpy as np
import pytest
from axes import BOTH, pose
from dh_product import dh_frames, difference, rows
from example_robots import PANDA, ROBOTS
from hypothesis import given, settings
from strategies import tables

from dh2urdf import extract_dh, list_tables, load_table, urdf_text
from dh2urdf.conversions.write.urdf_elements import UrdfOptions

HALF = math.pi / 2
STRIPPED = UrdfOptions(embed_table=False, balance_inertia=False)

PUBLISHED = {
    # Universal Robots, "DH parameters for calculations of kinematics and dynamics"
    "ur5": "0 .089159 0 h; 0 0 -.425 0; 0 0 -.39225 0; 0 .10915 0 h; 0 .09465 0 -h; 0 .0823 0 0",
    "ur10": "0 .1273 0 h; 0 0 -.612 0; 0 0 -.5723 0; 0 .163941 0 h; 0 .1157 0 -h; 0 .0922 0 0",
    # Franka Robotics, "Denavit-Hartenberg parameters" (Craig's convention), rows 1 to 7
    "panda": "0 .333 0 0; 0 0 0 -h; 0 .316 0 h; 0 0 .0825 h; 0 .384 -.0825 -h; 0 0 0 h; 0 0 .088 h",
    # Corke, Robotics Toolbox for MATLAB, mdl_puma560 and mdl_stanford
    "puma560": "0 .6718 0 h; 0 0 .4318 0; 0 .15005 .0203 -h; 0 .4318 0 h; 0 0 0 -h; 0 0 0 0",
    "stanford": "0 .412 0 -h; 0 .154 0 h; -h 0 0 0; 0 0 0 -h; 0 0 0 h; 0 .263 0 0",
    # DENSO HSR065: arms of 375 and 275 mm
    "scara": "0 .2 .375 0; 0 0 .275 0; 0 0 0 0; 0 0 0 0",
}
PUBLISHED = {name: rows(text) for name, text in PUBLISHED.items()}
"""theta at q = 0, d, a, alpha."""


def parameters(table):
    return [(row.theta, row.d, row.a, row.alpha) for row in table.joints]


def assert_published(found, name, error):
    """The table is the published one, and nothing is left for base and tool."""
    table = found.table
    assert np.array(parameters(table)) == pytest.approx(np.array(PUBLISHED[name]), abs=error)
    assert (table.base.is_identity, table.tool.is_identity) == (True, True)


def axes_of(text):
    """Directions and points of axes, six numbers each."""
    return [[row[:3], row[3:]] for row in rows(text)]


PUMA_AXES = axes_of(
    "0 0 1 0 0 0; 0 -1 0 0 0 .6718; 0 -1 0 .4318 0 .6718; 0 0 1 .4521 -.15005 .6718;"
    "0 -1 0 .4521 -.15005 1.1036; 0 0 1 .4521 -.15005 1.1036"
)
# The third axis of the Stanford arm slides: its point says nothing.
STANFORD_AXES = axes_of(
    "0 0 1 0 0 0; 0 1 0 0 0 .412; 0 0 1 .3 -.2 0; 0 0 1 0 .154 .412; 1 0 0 0 .154 .412;"
    "0 0 1 0 .154 .412"
)
SCARA_AXES = axes_of("0 0 1 0 0 .2; 0 0 1 .375 0 .2; 0 0 1 .6 .1 .2; 0 0 1 .65 0 .2")


@pytest.mark.parametrize(
    ("name", "axes", "types", "tool"),
    [
        ("puma560", PUMA_AXES, "RRRRRR", pose((0, 0, 1), 0, (0.4521, -0.15005, 1.1036))),
        ("stanford", STANFORD_AXES, "RRPRRR", pose((0, 0, 1), -HALF, (0, 0.154, 0.675))),
        ("scara", SCARA_AXES, "RRPR", pose((0, 0, 1), 0, (0.65, 0, 0.2))),
    ],
)
def test_published_tables_from_axes_typed_by_hand(name, axes, types, tool):
    """Axes drawn from the geometry of a textbook arm give the published table, sign for sign."""
    assert_published(extract_dh(axes, joint_types=types, tool=tool), name, 1e-15)


@pytest.mark.parametrize("name", ["ur5", "ur10"])
def test_universal_robots_tables_come_back(name):
    """The makers' table comes back, signs and zeros included, from base to tool0."""
    path = ROBOTS / f"ur_description/urdf/{name}_robot.urdf"
    assert_published(extract_dh(path, "base", "tool0", snap=1e-10), name, 1e-15)
    exact = extract_dh(path, "base", "tool0").table
    assert np.array(parameters(exact)) == pytest.approx(np.array(PUBLISHED[name]), abs=1e-11)


def test_the_panda_table_comes_back():
    """Franka's seven rows come back, the flange 0.107 m further as the tool."""
    found = extract_dh(PANDA, "panda_link0", "panda_link8", convention="modified")
    assert parameters(found.table) == [tuple(map(float, row)) for row in PUBLISHED["panda"]]
    assert found.table.base.is_identity
    assert found.table.tool.xyz == (0.0, 0.0, 0.107)
    assert found.table.tool.rpy == (0.0, 0.0, 0.0)


OTHER_CHOICES = {
    "doosan_m1013": "the maker puts the offset of parallel axes 2 and 3 into d_2, not d_3",
    "staubli_tx2_60": "the maker puts the offset of parallel axes 2 and 3 into d_2, not d_3",
    "puma560_modified": "the source splits the offset of parallel axes 2 and 3 between d_2, d_3",
    "gantry": "theta_1 is a half turn in the table, in the base here",
    "gantry_wrist": "theta_1 is a half turn in the table, in the base here",
    "kinova_gen3": "the maker keeps alpha positive by a half turn in every theta",
    "kinova_jaco2": "theta_5 is a half turn there, the sign of alpha_4 here",
    "unitree_z1": "theta_2 is a half turn there, the sign of a_2 here",
    "kuka_kr16_2": "the maker has a_3 negative at theta_3 = -90 deg",
    "kuka_kr5_arc": "the turn about the last axis is in the tool there, in theta_6 here",
    "rpr_by_inspection": "its fixed row is what frame assignment does without",
}
"""Tables that settle a free choice another way, and which."""


@pytest.mark.parametrize("name", list_tables())
def test_shipped_tables_come_back(name):
    """Table -> URDF without the table -> the same table, where frame assignment is unique."""
    table = load_table(name)
    flip = [row.name or f"joint_{i}" for i, row in enumerate(table.joints, 1) if row.sign < 0]
    text = urdf_text(table, STRIPPED)
    assert "<dh2urdf" not in text
    found = extract_dh(text, convention=table.convention, flip=flip)
    assert found.table.joint_names == table.joint_names
    for q in np.random.default_rng(3).uniform(-3, 3, (8, table.n)):
        # The file holds rpy angles: a turn and back again, two roundings a joint.
        error = difference(dh_frames(found.table, q)[-1], dh_frames(table, q)[-1])
        assert error <= 1e-14 * max(1.0, table.length) * table.n
    same = np.allclose(
        [(*np.sin(p[::3]), *np.cos(p[::3]), *p[1:3]) for p in parameters(found.table)],
        [(*np.sin(p[::3]), *np.cos(p[::3]), *p[1:3]) for p in parameters(table)],
        rtol=0,
        atol=1e-12,
    )
    same = same and len(found.table.rows) == len(table.rows)
    assert same == (name not in OTHER_CHOICES)


@BOTH
@settings(max_examples=60)
@given(table=tables(max_joints=7))
def test_table_to_urdf_to_table(convention, table):
    """Any table, written and read back without the embedded copy, is the same arm."""
    found = extract_dh(urdf_text(table, STRIPPED), "base_link", "tool0", convention)
    for q in np.random.default_rng(5).uniform(-3, 3, (3, table.n)):
        assert difference(dh_frames(found.table, q)[-1], dh_frames(table, q)[-1]) <= 1e-10


def test_limits_and_drives_come_back():
    """Limits, speeds, efforts and inertial parameters survive the way through a URDF."""
    table = load_table("puma560")
    again = extract_dh(urdf_text(table, STRIPPED)).table
    for old, new in zip(table.joints, again.joints, strict=True):
        assert (new.lower, new.upper) == (old.lower, old.upper)
        if old.inertia is not None:  # the writer estimates what a table does not say
            assert new.mass == pytest.approx(old.mass, rel=1e-14)
            assert new.com == pytest.approx(old.com, abs=1e-14)
            assert new.inertia == pytest.approx(old.inertia, abs=1e-14)


def test_a_written_file_goes_back_to_its_table():
    """The table that a file carries is returned whole, and only while it fits the joints."""
    table = load_table("denso_vs6556")
    text = urdf_text(table)
    found = extract_dh(text)
    assert found.table == table
    assert found.max_error <= 1e-14
    assert extract_dh(text, convention="modified").table.convention == "modified"
    anew = extract_dh(text, embedded=False)
    assert anew.steps
    assert anew.table.source.startswith("extracted by dh2urdf")


def test_an_edited_file_is_assigned_anew():
    """An embedded table that no longer fits its joints is not believed."""
    text = urdf_text(load_table("planar_rr")).replace('xyz="1.0 0.0 0.0"', 'xyz="1.5 0.0 0.0"')
    assert 'xyz="1.5 0.0 0.0"' in text
    found = extract_dh(text)
    assert found.table.source.startswith("extracted by dh2urdf")
    assert any("carries differs from its joints" in warning for warning in found.warnings)
