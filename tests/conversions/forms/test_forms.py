"""OPW parameters, screw axes and KDL segments: written, read back, and read by others."""

import json
import math
import random

import modern_robotics
import numpy as np
import py_opw_kinematics
import pytest
from dh_product import rigid
from hypothesis import given
from hypothesis import strategies as st
from py_opw_kinematics import KinematicModel
from scipy.spatial.transform import RigidTransform, Rotation

from dh2urdf import Robot, SerialChain, list_tables, load_table
from dh2urdf.chain.ortho_parallel import LETTERS, OrthoParallel
from dh2urdf.dh_io import parse_table
from dh2urdf.exceptions import (
    ArgumentError,
    NotOrthoParallelError,
    TableError,
    TableFileError,
    UrdfError,
)

ARMS = {name: Robot.from_dh(name) for name in list_tables()}
FORMS = ("opw", "screws", "kdl")
OPW = {
    *("abb_irb120", "abb_irb140", "abb_irb140_modified", "denso_vs060", "denso_vs6556"),
    *("doosan_m1013", "fanuc_lrmate200id", "kinova_jaco2_spherical", "kuka_kr16_2", "kuka_kr5_arc"),
    *("ar4", "kuka_kr6_r700", "lite6", "mecademic_meca500", "niryo_one", "piper", "puma560"),
    *("puma560_modified", "staubli_tx2_60", "uf850", "vx300s", "wx250s", "yaskawa_gp7"),
}
LENGTHS = st.floats(0.05, 2.0)
OFFSETS = st.floats(-0.5, 0.5)
ANGLES = st.floats(-math.pi, math.pi)
SEEDS = st.integers(0, 2**32 - 1)


def draws(arm, k=10):
    return np.stack([arm.random_configuration(i) for i in range(k)])


def content(name, form):
    return json.loads(ARMS[name].to_form(form, "json"))


def read(given, name="x"):
    return Robot.from_dh(parse_table(json.dumps(given), "json", f"{name}.json").table)


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("name", ARMS)
def test_every_form_of_every_arm_reads_back(name, form):
    """The same FK, joints, limits and name, from YAML and JSON; OPW of arms of that shape.

    A form has no place for joints that follow, and says so.
    """
    arm = ARMS[name]
    if arm.is_coupled:
        with pytest.raises(UrdfError, match="follow"):
            arm.to_form(form)
        return
    if form == "opw" and name not in OPW:
        with pytest.raises(NotOrthoParallelError):
            arm.to_form(form)
        return
    for format in ("yaml", "json"):
        table = parse_table(arm.to_form(form, format), format, f"a.{format}").table
        assert table.name == name
        assert table.joint_names == arm.joint_names
        again = Robot.from_dh(table)
        np.testing.assert_array_equal([again.lower, again.upper], [arm.lower, arm.upper])
        np.testing.assert_allclose(again.fk(draws(arm)), arm.fk(draws(arm)), atol=2e-15, rtol=0)


@pytest.mark.parametrize("name", sorted(OPW))
def test_py_opw_kinematics_has_the_same_arm(name):
    """Its FK of our parameters is ours, and its solutions are among ours."""
    arm, p = ARMS[name], ARMS[name].opw_parameters()
    assert (p.base == np.eye(4)).all()
    assert (p.tool == np.eye(4)).all()
    model = KinematicModel(
        **{key: getattr(p, key) for key in LETTERS},
        offsets=p.offsets,
        flip_axes=tuple(sign < 0 for sign in p.signs),
    )
    theirs = py_opw_kinematics.Robot(model, degrees=False)
    for q in draws(arm, 4):
        T = arm.fk(q)
        np.testing.assert_allclose(theirs.forward(tuple(q)).as_matrix(), T, atol=1e-14)
        np.testing.assert_allclose(p.fk(q), T, atol=3e-15)
        ours = arm.ik(T, within_limits=False).q
        for found in theirs.inverse(RigidTransform.from_matrix(T)):
            assert np.abs(np.exp(1j * ours) - np.exp(1j * np.array(found))).max(axis=1).min() < 1e-7


def test_robots_are_made_of_numbers():
    """OPW parameters of a KR 6 R700 as opw_kinematics' examples have them; screws of any arm."""
    quarter, shipped = math.pi / 2, ARMS["kuka_kr6_r700"]
    lengths = {"a1": 0.025, "a2": -0.035, "b": 0, "c1": 0.4, "c2": 0.315, "c3": 0.365, "c4": 0.08}
    signs = np.array([-1, 1, 1, -1, 1, -1])
    arm = Robot.from_opw(**lengths, offsets=(0, -quarter, 0, 0, 0, 0), signs=signs, name="kr6")
    np.testing.assert_allclose(arm.fk(draws(shipped)), shipped.fk(draws(shipped)), atol=1e-15)
    assert (arm.table.name, arm.joint_names[0]) == ("kr6", "joint_1")
    for name in ("xarm7", "stanford"):
        again = Robot.from_screws(*ARMS[name].screw_axes(), names=ARMS[name].joint_names)
        q = draws(ARMS[name])
        np.testing.assert_allclose(again.fk(q), ARMS[name].fk(q), atol=2e-15)
        assert again.joint_names == ARMS[name].joint_names
    with pytest.raises(TableError, match="expected 1 or -1 for each joint"):
        Robot.from_opw(**lengths, signs=signs * 0.5)
    with pytest.raises(ArgumentError, match="a1: expected a number"):
        Robot.from_opw(**lengths | {"a1": "x"})
    with pytest.raises(UrdfError, match="joint axes of shape"):
        Robot.from_screws(np.zeros((6, 5)), np.eye(4))


@pytest.mark.parametrize("name", ["puma560", "ur5", "stanford", "kuka_iiwa14", "omron_cobra600"])
def test_modern_robotics_has_the_same_arm(name):
    """FKinSpace(M, Slist, q) is the pose."""
    S, M = ARMS[name].screw_axes()
    for q in draws(ARMS[name]):
        T = modern_robotics.FKinSpace(M, S.T, q)
        np.testing.assert_allclose(T, ARMS[name].fk(q), atol=1e-14)


def kdl_pose(segment, q):
    """A segment's tip in its root, by KDL's definition."""
    joint, tip = segment["joint"], segment["f_tip"]
    axis, origin = np.array(joint["axis"]), np.eye(4)
    origin[:3, 3] = joint["origin"]
    move = np.eye(4)
    if joint["type"] == "RotAxis":
        move[:3, :3] = Rotation.from_rotvec(q * axis).as_matrix()
    else:
        move[:3, 3] = q * axis
    return origin @ move @ np.linalg.inv(origin) @ rigid(tip["xyz"], tip["rpy"])


@pytest.mark.parametrize("name", ["puma560", "ur5", "stanford", "kuka_kr6_r700", "rpr_new_frame"])
def test_segments_are_those_of_kdl(name):
    """The product of the segments, as KDL multiplies them, is the pose."""
    segments = content(name, "kdl")["segments"]
    for q in draws(ARMS[name]):
        T = np.eye(4)
        for segment, value in zip(segments, q, strict=True):
            T = T @ kdl_pose(segment, value)
        np.testing.assert_allclose(T, ARMS[name].fk(q), atol=1e-14)


def test_segments_that_others_write_are_read():
    """Fixed segments, axes by letter, an origin beside the root, texts with units."""
    given = {
        "segments": [
            {"f_tip": {"xyz": [0, 0, "300mm"]}},
            {"joint": {"type": "RotY", "origin": [0.1, 0, 0]}, "f_tip": {"xyz": [0.5, 0, 0]}},
            {"joint": {"type": "TransAxis", "axis": [0, 0, -2], "name": "slide", "upper": 0.4}},
            {"joint": {"type": "RotAxis", "axis": [0, 3, 4]}, "f_tip": {"rpy": ["90deg", 0, 0]}},
        ]
    }
    arm, q = read(given), np.array([0.3, 0.2, -0.4])
    steps = [(0.3, [0, 1, 0]), (-0.4, [0, 0.6, 0.8])]
    turn, last = (np.block([[Rotation.from_rotvec(a * np.array(v)).as_matrix(), np.zeros((3, 1))],
                            [np.zeros((1, 3)), 1]]) for a, v in steps)  # fmt: skip
    T = rigid([0.1, 0, 0.3], [0, 0, 0]) @ turn @ rigid([0.4, 0, -0.2], [0, 0, 0]) @ last
    np.testing.assert_allclose(arm.fk(q), T @ rigid([0, 0, 0], [math.pi / 2, 0, 0]), atol=1e-15)
    assert arm.joint_names == ("joint_1", "slide", "joint_3")
    assert (arm.upper[1], arm.lower[1]) == (0.4, -math.inf)


def test_parameters_of_ros_industrial_are_read(run, tmp_path):
    """A file as its packages have them: degrees, no names, no limits; every verb takes it."""
    text = """
# FANUC LR Mate 200iD
opw_kinematics_geometric_parameters: {a1: 0.050, a2: -0.035, b: 0, c1: 330mm, c2: 0.33,
  c3: 0.335, c4: 0.08}
opw_kinematics_joint_offsets: [0.0, 0.0, deg(-90.0), 0.0, 0.0, deg(180.0)]
opw_kinematics_joint_sign_corrections: [1, 1, -1, -1, -1, -1]
"""
    (tmp_path / "lrmate.yaml").write_text(text)
    arm, shipped = Robot.from_dh(tmp_path / "lrmate.yaml"), ARMS["fanuc_lrmate200id"]
    np.testing.assert_allclose(arm.fk(draws(shipped)), shipped.fk(draws(shipped)), atol=1e-15)
    assert arm.table.name == "lrmate"
    assert [row.sign for row in arm.table.rows] == [1, 1, -1, -1, -1, -1]
    status, out, _ = run("ik", "lrmate.yaml", "--xyz", "0.4", "0", "0.3", "--rpy", "0", "pi", "0")
    assert (status, len(out.splitlines())) == (0, 10)
    p = arm.opw_parameters()
    assert [getattr(p, key) for key in LETTERS] == pytest.approx(
        [0.05, -0.035, 0, 0.33, 0.33, 0.335, 0.08], abs=1e-15
    )


@given(
    st.tuples(OFFSETS, OFFSETS, OFFSETS, LENGTHS, LENGTHS, LENGTHS, LENGTHS),
    st.tuples(*[ANGLES] * 6),
    st.tuples(*[st.sampled_from([1, -1])] * 6),
    SEEDS,
)
def test_parameters_are_found_wherever_zero_is(lengths, offsets, signs, seed):
    """Any zero pose and directions of the joints, any base and tool: the same arm."""
    rng = np.random.default_rng(seed)
    base, tool = (rigid(rng.uniform(-1, 1, 3), rng.uniform(-3, 3, 3)) for _ in range(2))
    made = OrthoParallel(*lengths, offsets=offsets, signs=signs, base=base, tool=tool)
    none = np.full(6, math.inf)
    chain = made.chain(tuple("abcdef"), -none, none)
    found = OrthoParallel.of_chain(chain)
    assert abs(found.c2 - made.c2) < 1e-12
    assert abs(abs(found.a1) - abs(made.a1)) < 1e-12
    for q in rng.uniform(-3, 3, (3, 6)):
        np.testing.assert_allclose(made.fk(q), chain.fk(q), atol=3e-14)
        np.testing.assert_allclose(found.fk(q), chain.fk(q), atol=3e-14)


@pytest.mark.parametrize(
    ("link", "step", "message"),
    [
        (1, ([0, 0, 0], [1e-3, 0, 0]), "axes 1 and 2 are not at right angles (0.001 rad off)"),
        (2, ([0, 0, 0], [1e-3, 0, 0]), "axes 2 and 3 are not parallel (0.001 rad off)"),
        (5, ([2e-3, 0, 0], [0, 0, 0]), "axes 4, 5 and 6 do not meet in one point (0.002 m off)"),
    ],
)
def test_the_condition_that_fails_is_named_with_its_size(link, step, message):
    """A link of the Puma moved or tilted a little."""
    chain = ARMS["puma560"].chain
    links = chain.links.copy()
    links[link] = links[link] @ rigid(*step)
    bent = SerialChain(links, chain.joint_types, chain.names, chain.lower, chain.upper)
    with pytest.raises(NotOrthoParallelError) as caught:
        OrthoParallel.of_chain(bent)
    assert message in str(caught.value)


def test_an_arm_of_another_shape_says_so_once(refused):
    """A UR and a seven-axis arm: exit 2, the conditions that fail, nothing on stdout."""
    err = refused("extract", "ur5e", "--format", "opw")
    assert err == (
        "dh2urdf: ur5e: opw: no ortho-parallel arm with a spherical wrist: axes 3 and 4 are not at "
        "right angles (1.57 rad off); axes 4, 5 and 6 do not meet in one point (0.0997 m off)\n"
    )
    assert "its joints are RRRRRRR, not RRRRRR" in refused(
        "extract", "franka_fer", "--format", "opw"
    )


@pytest.mark.parametrize("form", FORMS)
def test_extract_writes_forms_of_urdfs_and_tables(run, tmp_path, form):
    """Of a shipped table, then of a URDF; --json tells of the table that it reads back as."""
    status, out, err = run("extract", "kuka_kr6_r700", "--format", form, "-o", "arm.yaml")
    assert (status, out) == (0, "")
    assert f"{form}: base_link to tool0, read back with a largest FK difference of " in err
    assert load_table("arm.yaml").joint_names == load_table("kuka_kr6_r700").joint_names
    assert run("convert", "arm.yaml", "-o", "arm.urdf")[0] == 0
    status, out, _ = run("extract", "arm.urdf", "--format", form, "-o", "arm.json", "--json")
    told = json.loads(out)
    assert (status, told["configurations"], len(told["table"]["joints"])) == (0, 64, 6)
    assert told["max_error"] < 1e-14
    told = json.loads(run("extract", "arm.urdf", "--format", form, "--json")[1])
    assert parse_table(told["text"], "yaml", "kuka_kr6_r700.yaml") == parse_table(
        (tmp_path / "arm.json").read_text(), "json", "kuka_kr6_r700.json"
    )
    again = load_table("arm.json")
    q = draws(ARMS["kuka_kr6_r700"])
    np.testing.assert_allclose(Robot.from_dh(again).fk(q), ARMS["kuka_kr6_r700"].fk(q), atol=1e-14)
    (tmp_path / "mine.yaml").write_text("mine: 1\n")
    assert run("extract", "puma560", "--format", form, "-o", "mine.yaml")[0] == 2
    assert run("extract", "puma560", "--format", form, "-o", "arm.yaml")[0] == 0


FAULTS = [
    ("opw", {"opw_kinematics_geometric_parameters": {"a1": 0}}, "a2: expected a number"),
    ("opw", {"opw_kinematics_joint_sign_corrections": [1, 1, 1, 1, 1, 0]}, "1 or -1"),
    ("opw", {"opw_kinematics_joint_offsets": [0, 0, "deg(x)", 0, 0, 0]}, "offsets[3]: 'deg(x)': "),
    ("opw", {"opw_kinematics_joint_offsets": [0, 0]}, "expected 6 numbers"),
    ("opw", {"parameters": 1}, "'parameters' is not known; allowed: "),
    ("opw", {"joint_names": ["a"]}, "joint_names: expected 6 texts"),
    ("opw", {"tool": {"x": 1}}, "tool: 'x' is not known; allowed: xyz, rpy"),
    ("opw", {"lower": [0, 0]}, "lower: expected 6 numbers"),
    ("screws", {"screws": [[0, 0, 1]]}, "screws: joint axes of shape"),
    ("screws", {"upper": [1]}, "screws: upper: 1 for 6 joints"),
    ("kdl", {"segments": []}, "segments: expected up to 120"),
    ("kdl", {"segments": [{"joint": {"type": "Ball"}}]}, "segments[1].joint.type: expected"),
    ("kdl", {"segments": [{"f_tip": {}}]}, "segments: none of the joints moves"),
    ("kdl", {"segments": [{"tip": {}}]}, "segments[1]: 'tip' is not known"),
    ("kdl", {"segments": [{"joint": {"type": "RotAxis", "axis": [0, 0, 0]}}]}, "a zero axis"),
]


@pytest.mark.parametrize(("form", "change", "message"), FAULTS)
def test_files_with_faults_are_refused(form, change, message):
    """One message with the file, the key and what is allowed."""
    with pytest.raises(TableFileError) as caught:
        read(content("puma560", form) | change, "f")
    assert str(caught.value).startswith("f.json: ")
    assert message in str(caught.value)


JUNK = (None, True, "x", "", -1, 0, 1e308, 1e12, [], {}, [1, 2], {"a": 1}, "deg(1e9)", "pi/0", [[]])


def spots(node, path=()):
    """Paths to all values of a document."""
    if not isinstance(node, (dict, list)):
        return [path]
    below = node.items() if isinstance(node, dict) else enumerate(node)
    return [path, *(p for key, value in below for p in spots(value, (*path, key)))]


@given(st.sampled_from(FORMS), SEEDS)
def test_mutated_files_are_read_or_refused(form, seed):
    """Values replaced or left out anywhere: a table, or a TableFileError with the file's name."""
    rng, given = random.Random(seed), content("puma560", form)
    for _ in range(rng.randint(1, 3)):
        *way, last = rng.choice([path for path in spots(given) if path])
        node = given
        for key in way:
            node = node[key]
        if rng.random() < 0.2:
            del node[last]
        else:
            node[last] = rng.choice(JUNK)
    try:
        table = parse_table(json.dumps(given), "json", "f.json").table
    except TableFileError as error:
        unnamed = [problem for problem in error.problems if not problem.startswith("f.json")]
    else:
        unnamed = [] if np.isfinite(table.fk([0.1] * table.n)).all() else [table]
    assert unnamed == []


def test_options_of_tables_say_nothing_beside_a_form(refused):
    """Convention, snap and such, and suffixes of other files."""
    err = refused("extract", "puma560", "--format", "kdl", "--convention", "modified")
    assert "--format kdl stands alone: --convention does nothing beside it" in err
    assert "kdl is written as .yaml or .json" in refused(
        "extract", "puma560", "--format", "kdl", "-o", "a.csv"
    )


MIMIC = """<robot name="r"><link name="a"/><link name="b"/><link name="c"/>
<joint name="j" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>
<limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
<joint name="k" type="revolute"><parent link="b"/><child link="c"/><axis xyz="0 0 1"/>
<origin xyz="1 0 0"/><mimic joint="j"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
</robot>"""


def test_joints_that_follow_others_cannot_be_said():
    """A mimic joint: a message, no chain of as many joints."""
    arm = Robot.from_urdf(MIMIC)
    for ask in (arm.opw_parameters, arm.screw_axes, lambda: arm.to_form("kdl")):
        with pytest.raises(UrdfError, match="joints that follow others"):
            ask()
