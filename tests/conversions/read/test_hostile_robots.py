"""Hostile robot descriptions at every door: an answer, or one message in time."""

import os
import re
from itertools import pairwise
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest
from example_robots import placed
from hostile import hostile, outcome
from hypothesis import strategies as st

import dh2urdf
from dh2urdf import Robot, extract_dh
from dh2urdf.bounds import JOINTS, LINKS
from dh2urdf.checks import check_urdf
from dh2urdf.conversions.read.apart import check_expression
from dh2urdf.exceptions import Dh2UrdfError, UrdfError
from tests.fuzz.shapes import URDFS, values


def test_attributes_that_an_element_does_not_have_mean_nothing(tmp_path):
    """A limit with an ``xyz`` that is no number is built like one without."""
    text = dh2urdf.urdf_text("planar_rr").replace("<limit ", '<limit xyz="prismatic" ')
    (tmp_path / "arm.urdf").write_text(text)
    q = [0.3, -0.4]
    T = Robot.from_urdf(tmp_path / "arm.urdf").fk(q)
    np.testing.assert_allclose(T, dh2urdf.load_table("planar_rr").fk(q), atol=1e-14)


@hostile(text=st.one_of(st.text(max_size=200), URDFS.map(bytes.decode)))
def test_any_text_is_an_arm_or_refused(text):
    """``extract_dh`` takes a text of a URDF, or a path."""
    outcome(extract_dh, text)


@hostile(source=values, tool=st.one_of(st.none(), values), types=values, names=values)
def test_any_typed_axes_are_an_arm_or_refused(source, tool, types, names):
    """The same from Python."""
    outcome(extract_dh, source, tool=tool, joint_types=types, names=names)
    outcome(extract_dh, [[0, 0, 1, 0, 0, 0.0]], tool=tool)
    outcome(extract_dh, [[0, 0, 1, 0, 0, 0.0]], joint_types=types, names=names)


AXES_SLIPS = {
    "aliases": "a: &a [1,1,1,1,1,1,1,1,1,1]\n"
    + "".join(f"{c}: &{c} [{','.join(['*' + p] * 10)}]\n" for p, c in pairwise("abcdefgh"))
    + "axes: *h\n",
    "depth": "axes: " + "[" * 3000,
    "400 digits": f"screws: [[0, 0, {'1' * 400}, 0, 0, 0]]",
    "a stacked tool": "screws: [[0, 0, 1, 0, 0, 0]]\n"
    "tool: [[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]], [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]]",
    "names in a list": "screws: [[0, 0, 1, 0, 0, 0]]\nnames: [[1]]",
    "a name twice": "screws: [[0,0,1,0,0,0],[0,0,1,0,0,1]]\nnames: [a, a]",
    "61 joints": "screws: [" + ",".join(["[0,0,1,0,0,0]"] * 61) + "]",
    "a tiny axis": "screws: [[0, 0, 1.0e-200, 0, 0, 0]]",
    "a tag": "axes: !!python/object/apply:os.system [ls]",
    "control": "axes: \x07",
}


@pytest.mark.parametrize("slip", AXES_SLIPS)
def test_an_axes_file_beyond_its_bounds_is_one_message(slip, written):
    """Aliases, depth, digits, shapes and counts."""
    path = written("axes.yaml", AXES_SLIPS[slip])
    assert isinstance(outcome(extract_dh, path), UrdfError)


def test_a_name_that_is_null_is_none(written):
    """``name: null`` is no name, and ``type: null`` no type."""
    text = "axes:\n- {axis: [0, 0, 1], name: null, type: null}\n- {axis: [0, 1, 0]}\n"
    path = written("axes.yaml", text)
    assert extract_dh(path).table.joint_names == ("joint_1", "joint_2")


def test_a_file_of_axes_may_name_the_robot(tmp_path):
    """``name`` is that of the table, null leaves the file's, anything but a text is refused."""
    path = tmp_path / "arm.yaml"
    for name, expected in (("foo", "foo"), ('"a b"', "a b"), ("null", "arm"), ("[x]", None)):
        path.write_text(f"name: {name}\naxes: [{{axis: [0, 0, 1]}}, {{axis: [0, 1, 0]}}]\n")
        found = outcome(extract_dh, path)
        assert isinstance(found, UrdfError) if expected is None else found.table.name == expected


def chain_text(links, joints):
    """A chain of links, some first joints of which move."""
    parts = ["<robot name='r'>"] + [f"<link name='l{i}'/>" for i in range(links)]
    for i in range(links - 1):
        kind = "revolute" if i < joints else "fixed"
        parts.append(
            f"<joint name='j{i}' type='{kind}'><parent link='l{i}'/><child link='l{i + 1}'/>"
            f"<origin xyz='0.01 0 0.02' rpy='0.3 0.2 0'/><axis xyz='0 {i % 2} 1'/>"
            "<limit lower='-1' upper='1' effort='1' velocity='1'/></joint>"
        )
    return "".join(parts) + "</robot>"


def test_a_chain_at_the_bound_is_built(tmp_path):
    """As many links and joints as are allowed, in seconds, and right."""
    path = tmp_path / "long.urdf"
    text = chain_text(LINKS, JOINTS)
    path.write_text(text)
    robot = outcome(Robot.from_urdf, path)
    assert (robot.n, robot.tip) == (JOINTS, f"l{LINKS - 1}")
    model = pin.buildModelFromXML(text)
    q = np.linspace(-1, 1, JOINTS)
    (expected,) = placed(model, dict(zip(robot.joint_names, q, strict=True)), robot.tip)
    np.testing.assert_allclose(robot.fk(q), expected.homogeneous, rtol=0, atol=1e-10)
    assert outcome(extract_dh, path).max_error <= 1e-10
    outcome(check_urdf, path)
    path.write_text(chain_text(LINKS, LINKS - 1))
    massless = [f for f in outcome(check_urdf, path) if f.rule == "massless"]
    assert len(massless) == LINKS - 1


@pytest.mark.parametrize("links", [LINKS + 1, 5000, 30_000])
def test_more_links_than_are_allowed_are_refused_at_once(links, written):
    """Before anything is built, at every door, however many there are."""
    path = written("long.urdf", chain_text(links, 6))
    for door in (Robot.from_urdf, extract_dh, check_urdf):
        error = outcome(door, path)
        assert isinstance(error, UrdfError)
        assert re.search(rf"{links} links; up to {LINKS}|larger than \d+ kB", str(error))


def test_more_joints_than_are_allowed_are_refused(written):
    """For URDF, models and axes."""
    text = chain_text(JOINTS + 2, JOINTS + 1)
    path = written("long.urdf", text)
    sources = [path, pin.buildModelFromXML(text), [[0, 0, 1, 0, 0, 0]] * (JOINTS + 1)]
    for source in sources:
        error = outcome(extract_dh, source)
        assert re.search(rf"{JOINTS + 1} joints.* up to {JOINTS}", str(error))
    assert isinstance(outcome(Robot.from_urdf, path), UrdfError)


def test_far_slides_between_tilted_axes_agree_with_pinocchio(tmp_path):
    """A prismatic joint of 1,000 km is no disagreement: rounding grows with q."""
    path = tmp_path / "slide.urdf"
    for upper in ("1e3", "1e6", "1e9"):
        path.write_text(
            chain_text(5, 4)
            .replace("'1' effort", f"'{upper}' effort")
            .replace("name='j1' type='revolute'", "name='j1' type='prismatic'")
            .replace("type='revolute'", "type='continuous'")
        )
        robot = Robot.from_urdf(path)
        assert robot.upper[1] == float(upper)


EXPRESSIONS = [
    "().__class__.__base__.__subclasses__()",
    "(lambda: ().__class__)()",
    "[x.__class__ for x in [1]]",
    "(x for x in [1]).gi_frame.f_back.f_globals",
    "__import__('os').system('true')",
    "[__import__ for i in [1]][0]('os')",
    "'{0.__class__}'.format(1)",
    "xacro.load_yaml.__globals__",
    "math._x",
    "python.vars(xacro)",
    "(y for y in []).gi_code",
]


@pytest.mark.parametrize("expression", EXPRESSIONS)
def test_expressions_of_a_xacro_cannot_leave_arithmetic(expression):
    """No names that lead from a value to the interpreter, in lambdas and comprehensions either."""
    with pytest.raises(UrdfError, match="not allowed in an expression"):
        check_expression(expression)


def xacro_file(written, z, extra=""):
    text = chain_text(2, 1).replace("<robot ", "<robot xmlns:xacro='http://ros.org/wiki/xacro' ")
    text = text.replace("0.01 0 0.02", z).replace("<link", extra + "<link", 1)
    return written("arm.XACRO", text)


def test_a_xacro_computes(written):
    """Properties, functions and $(eval) work as ever; the suffix is known in capitals too."""
    path = xacro_file(
        written,
        "${sum([0.1*k for k in [1,2]]) if False else h*2} $(eval 1+1) ${sin(pi/6)}",
        "<xacro:property name='h' value='0.25'/>",
    )
    assert Robot.from_urdf(path).fk([0.0])[:3, 3] == pytest.approx([0.5, 2.0, 0.5])
    assert all(finding.rule != "xacro" for finding in check_urdf(path))


@pytest.mark.parametrize(
    ("z", "extra"),
    [
        ("0 0 ${9**9**9}", ""),
        ("0 0 ${'a'*10**11}", ""),
        ("0 0 ${open('PWNED','w')}", ""),
        ("0 0 $(eval open('PWNED','w'))", ""),
        ("0 0 $(eval [open][0])", ""),
        ("0 0 1", "<xacro:include filename='PIPE'/>"),
        ("0 0 1", "<xacro:macro name='m'><xacro:m/></xacro:macro><xacro:m/>"),
    ],
)
def test_a_xacro_without_end_or_bound_is_stopped(z, extra, written, tmp_path, monkeypatch):
    """Endless powers, memory, pipes and recursion: one message in time, and nothing run."""
    monkeypatch.setattr("dh2urdf.conversions.read.apart.APART_SECONDS", 3)
    os.mkfifo(tmp_path / "pipe")
    pwned = tmp_path / "pwned"
    names = {"PWNED": str(pwned), "PIPE": str(tmp_path / "pipe")}
    for name, path in names.items():
        z, extra = z.replace(name, path), extra.replace(name, path)
    z = z.replace("'", "&quot;")
    said = outcome(Robot.from_urdf, xacro_file(written, z, extra))
    assert isinstance(said, UrdfError)
    assert ("more than 900 MB of memory when evaluating" in str(said)) == ("10**11" in z)
    assert not pwned.exists()


INERTIAL = "<inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/>"
MJCF = (
    f"<mujoco><worldbody><body name='a'>{INERTIAL}<joint name='j' type='hinge' axis='0 0 1'/>"
    f"<body name='b' pos='0 0 1'>{INERTIAL}<joint name='k' type='slide' axis='1 0 0'/></body>"
    "</body></worldbody></mujoco>"
)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("axis='0 0 1'", "axis='nan 0 1'"),
        ("axis='0 0 1'", "axis='1e308 0 0'"),
        ("axis='0 0 1'", "axis='0 0 0'"),
        ("pos='0 0 1'", "pos='nan 0 1'"),
        ("pos='0 0 1'", "pos='1e300 0 1'"),
        ("axis='1 0 0'", "axis='1 0 0' ref='nan'"),
        ("type='hinge'", "type='ball'"),
        ("<worldbody>", "<asset><mesh file='gone.stl'/></asset><worldbody>"),
        ("<worldbody>", "<worldbody><replicate count='100000000'><body/></replicate>"),
        ("<body name='b'", "<body name='a'"),
        ("</mujoco>", "<include file='x.xml'/></mujoco>"),
    ],
)
def test_a_hostile_mjcf_is_refused_in_time(old, new, written, tmp_path, monkeypatch):
    """MuJoCo and Pinocchio read it in a process of their own; nothing is left behind."""
    monkeypatch.chdir(tmp_path)
    seconds = 3 if "replicate" in new else 8
    monkeypatch.setattr("dh2urdf.conversions.read.apart.APART_SECONDS", seconds)
    path = written("x.xml", MJCF.replace(old, new, 1))
    for door in (Robot.from_urdf, extract_dh)[: 1 if "replicate" in new else 2]:
        result = outcome(door, path)
        assert isinstance(result, Dh2UrdfError) or new == "type='ball'"
    assert [p.name for p in tmp_path.iterdir()] == ["x.xml"]


def test_limits_of_an_mjcf_beyond_the_bounds_are_none(written):
    """A range of 1e7 degrees bounds nothing."""
    wide = MJCF.replace("axis='0 0 1'", "axis='0 0 1' range='-1e8 1e8' limited='true'")
    path = written("x.xml", wide)
    robot = Robot.from_urdf(path)
    assert (robot.lower[0], robot.upper[0]) == (-np.inf, np.inf)
    assert extract_dh(path).table.rows[0].lower is None


@pytest.mark.parametrize(
    "spoil",
    [
        lambda m: setattr(m.jointPlacements[1], "translation", np.array([np.nan, 0, 0])),
        lambda m: setattr(m.jointPlacements[2], "translation", np.array([1e300, 0, 0])),
        lambda m: m.lowerPositionLimit.__setitem__(0, np.nan),
        lambda m: m.upperPositionLimit.__setitem__(0, 1e300),
        lambda m: m.effortLimit.__setitem__(0, np.nan),
    ],
)
def test_a_model_with_numbers_that_are_none(spoil):
    """A model of Pinocchio may hold anything."""
    model = pin.buildModelFromXML(chain_text(4, 3))
    spoil(model)
    outcome(extract_dh, model)


def test_nothing_of_urdfdom_reaches_stderr(tmp_path, capfd):
    """Whatever is wrong with a file is said in our words alone."""
    path = tmp_path / "arm.urdf"
    for old, new in [
        ("effort='1'", ""),
        ("<axis xyz='0 0 1'/>", "<axis xyz='0 0 nan'/>"),
        ("<link name='l0'/>", "<link name='l0'><visual/><collision/></link>"),
        ("<link name='l0'/>", "<link name='l0'><visual><material name='m'/></visual></link>"),
        ("<limit", "<mimic joint='q'/><safety_controller/><dynamics/><limit"),
    ]:
        path.write_text(chain_text(4, 3).replace(old, new))
        outcome(Robot.from_urdf, path)
        outcome(extract_dh, path)
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("end", [5, ["l1"], b"l1", "\ud800", "\0", "", "x" * 10**5, True, 1.5])
def test_ends_that_are_no_links_are_one_message(end, written):
    """Of a file, a text and a model; by base and by tip."""
    path = written("arm.urdf", chain_text(4, 3))
    for source in (path, path.read_text(), pin.buildModelFromXML(chain_text(4, 3))):
        for ends in ((end, None), (None, end)):
            if end == "" and not isinstance(source, (str, Path)):
                continue  # a model's own default
            assert isinstance(outcome(extract_dh, source, *ends), Dh2UrdfError)
    assert isinstance(outcome(Robot.from_urdf, path, None, end), Dh2UrdfError)


@pytest.mark.parametrize(
    "source", [5, None, b"arm.urdf", 1.5, ["arm.urdf"], MJCF, "<mujoco/>", "<"]
)
def test_what_is_no_path_is_one_message(source):
    """Numbers, nothing, bytes, lists, and an MJCF as text."""
    for door in (Robot.from_urdf, extract_dh, check_urdf):
        assert isinstance(outcome(door, source), Dh2UrdfError)


def test_a_text_of_a_urdf_is_a_robot():
    """It has no source to draw meshes from."""
    robot = Robot.from_urdf(chain_text(4, 3))
    assert (robot.n, robot.source) == (3, None)
