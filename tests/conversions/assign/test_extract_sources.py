"""What a table can be extracted from, and what is said of sources that are broken."""

import math

import mujoco
import numpy as np
import pinocchio as pin
import pytest
from axes import BOTH, pose
from dh_product import dh_frames, difference
from example_robots import ANYMAL, PANDA, TIAGO, UR5, fk_between, placed

from dh2urdf import extract_dh, load_table, urdf_text
from dh2urdf.conversions.write.urdf_elements import UrdfOptions
from dh2urdf.exceptions import NameNotFoundError, PoseError, UrdfError

STILL = "no joint moves between 'wrist_3_link' and 'tool0'"

URDF = """<robot name="small">
  <link name="root"/>
  <link name="arm"><inertial><mass value="2"/><origin xyz="0.1 0.2 0.3" rpy="0.1 0.2 0.3"/>
    <inertia ixx="0.03" ixy="1e-3" ixz="2e-3" iyy="0.04" iyz="3e-3" izz="0.05"/></inertial></link>
  <link name="hand"><inertial><mass value="1"/><origin xyz="0 0.1 0"/>
    <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial></link>
  <joint name="shoulder" type="revolute">
    <parent link="root"/><child link="arm"/>
    <origin xyz="0 0 0.4" rpy="0 0 0.2"/><axis xyz="0 0 1"/>
    <limit lower="-2" upper="1" effort="9" velocity="3"/>
    <dynamics damping="0.5" friction="0.2"/>
  </joint>
  <joint name="elbow" type="prismatic">
    <parent link="arm"/><child link="hand"/>
    <origin xyz="0.3 0 0.1" rpy="0.3 1.0 0"/><axis xyz="0 1 0"/>
    <limit lower="-0.1" upper="0.2" effort="8" velocity="1"/>
  </joint>
</robot>
"""

HAND = 'link="hand"/>'
BROKEN = {
    "not XML": ("<robot", "<<robot", r":1: not XML"),
    "cut off": ("</robot>", "", r"not XML"),
    "a list": (URDF, "joint: 1", r":1: not XML"),
    "another root": (URDF, URDF.replace("robot", "world"), r":1: root element is <world>"),
    "an entity": (
        '<robot name="small">',
        '<!DOCTYPE r [<!ENTITY e SYSTEM "file:///etc/passwd">]>\n<robot name="small">&e;',
        r":1: <!DOCTYPE>: document types and entities",
    ),
    "a loop": (HAND, 'link="root"/>', r':\d+: <joint name="shoulder">: closes a loop'),
    "two parents": (
        "</robot>",
        '<joint name="third" type="fixed"><parent link="root"/><child link="hand"/></joint>'
        "</robot>",
        r':18: <joint name="third">: link \'hand\' hangs on joint \'elbow\' already',
    ),
    "NaN in an origin": (
        *('xyz="0 0 0.4"', 'xyz="0 0 nan"'),
        r':9: <origin> of <joint name="shoulder">: xyz="0 0 nan" is not finite',
    ),
    "a zero axis": (
        *('<axis xyz="0 0 1"/>', '<axis xyz="0 0 0"/>'),
        r':9: <axis> of <joint name="shoulder">: xyz="0 0 0" is a zero axis',
    ),
    "an axis without numbers": ('axis xyz="0 0 1"', "axis", r":9: <axis> .*has no xyz"),
    "an endless axis": ('axis xyz="0 0 1"', 'axis xyz="0 0 1e20"', r":9: <axis> .*no direction"),
    "an origin in the stars": ('"0 0 0.4"', '"0 0 1e20"', r":9: <origin> .*farther than 1e\+09 m"),
    "two numbers": ('rpy="0 0 0.2"', 'rpy="0 0"', r':9: <origin> .* rpy="0 0" is not 3 numbers'),
    "words": ('xyz="0 0 0.4"', 'xyz="0 0 up"', r"is not 3 numbers"),
    "xacro": ('xyz="0 0 0.4"', 'xyz="0 0 ${h}"', r"this is xacro, not URDF"),
    "an unknown type": ('type="prismatic"', 'type="sliding"', r':13: .* type="sliding" is not one'),
    "a planar joint": ("prismatic", "planar", r':13: <joint name="elbow">: a planar joint between'),
    "an unknown link": (
        *('<parent link="arm"/>', '<parent link="leg"/>'),
        r":14: <parent> of <joint name=\"elbow\">: no link is named 'leg'",
    ),
    "no child": ('<child link="hand"/>', "", r':13: <joint name="elbow">: has no <child link'),
    "a joint of one link": (HAND, 'link="arm"/>', r"joins link 'arm' to itself"),
    "a name twice": ('name="elbow"', 'name="shoulder"', r":13: .*second joint of this name"),
    "crossed limits": ('lower="-2"', 'lower="2"', r":10: <limit> .* lower 2.0 lies above upper"),
    "no joints": (URDF[URDF.index("  <joint") : URDF.index("</robot>")], "", r"no joints"),
}


@pytest.mark.parametrize("fault", BROKEN)
def test_a_broken_urdf_is_named_by_element_and_line(fault, written):
    """One message says which element on which line is wrong and why."""
    old, new, message = BROKEN[fault]
    assert URDF.count(old) >= 1
    path = written("broken.urdf", URDF.replace(old, new, 1))
    with pytest.raises(UrdfError, match=message) as caught:
        extract_dh(path, "root", "hand")
    assert "broken.urdf" in str(caught.value)
    assert "\n" not in str(caught.value)


def test_missing_meshes_do_not_matter():
    """Kinematics needs no meshes."""
    with_mesh = URDF.replace(
        '<link name="root"/>',
        '<link name="root"><visual><geometry><mesh filename="package://no/such.stl"/></geometry>'
        "</visual></link>",
    )
    assert extract_dh(with_mesh).table == extract_dh(URDF).table


def test_entities_are_not_read(written):
    """A million laughs end in a message at once."""
    bomb = '<!DOCTYPE r [<!ENTITY a "ha">' + "".join(
        f'<!ENTITY {chr(98 + k)} "{("&" + chr(97 + k) + ";") * 10}">' for k in range(12)
    )
    path = written("bomb.urdf", bomb + ']><robot name="&m;"/>')
    with pytest.raises(UrdfError):
        extract_dh(path)


@BOTH
@pytest.mark.parametrize(
    ("base", "tip"), [("hand", "root"), ("arm", "hand"), ("hand", "arm"), ("root", "hand")]
)
def test_a_chain_runs_either_way(convention, base, tip):
    """With the base below the tip the axes turn round and q stays the file's."""
    found = extract_dh(URDF, base, tip, convention)
    model = pin.buildModelFromXML(URDF)
    for q in np.random.default_rng(2).uniform(-2, 2, (5, found.table.n)):
        truth = fk_between(model, base, tip, dict(zip(found.table.joint_names, q, strict=True)))
        assert difference(dh_frames(found.table, q)[-1], truth) <= 1e-14
    assert all(row.sign == 1 for row in found.table.joints)
    bounds = {"shoulder": (-2, 1), "elbow": (-0.1, 0.2)}
    for row in found.table.joints:
        assert (row.lower, row.upper) == bounds[row.name]


def test_from_foot_to_foot():
    """Two legs are one chain: up from one foot, down to the other."""
    found = extract_dh(ANYMAL, "LF_FOOT", "RH_FOOT")
    assert found.table.joint_names == (
        *("LF_KFE", "LF_HFE", "LF_HAA"),
        *("RH_HAA", "RH_HFE", "RH_KFE"),
    )
    assert found.max_error <= 1e-13


def test_the_longest_chain_is_chosen_and_named():
    """Without names the root and the far end; a hand's fingers are no arm's tip."""
    assert (extract_dh(UR5).base, extract_dh(UR5).tip) == ("world", "tool0")
    assert extract_dh(PANDA).tip == "panda_hand"
    assert "panda_link0 to panda_hand" in str(extract_dh(PANDA))


@pytest.mark.parametrize(
    ("source", "ends", "error", "message"),
    [
        ("gone.urdf", {}, UrdfError, r"gone\.urdf: there is no such file"),
        ("/", {}, UrdfError, "folder"),
        (ANYMAL, {}, UrdfError, "4 chains of 3 joints; choose the tip, one of: LF_FOOT"),
        (UR5, {"tip": "tool"}, NameNotFoundError, "no link named 'tool'; .* did you mean 'tool0'"),
        (UR5, {"base": "wrist_3_link", "tip": "tool0"}, UrdfError, STILL),
        (UR5, {"flip": ["wrist"]}, NameNotFoundError, "flip: no joint named 'wrist'"),
        ([2.0 * np.eye(4)], {}, PoseError, "joint frames"),
    ],
)
def test_a_chain_that_is_not_there_is_told(source, ends, error, message):
    """No file, several chains, unknown names and no pose: one message, with what there is."""
    with pytest.raises(error, match=message):
        extract_dh(source, **ends)


def test_continuous_joints_are_plain_angles():
    """A continuous joint is a revolute row without limits."""
    text = URDF.replace('type="revolute"', 'type="continuous"')
    found = extract_dh(text)
    assert (found.table.rows[0].lower, found.table.rows[0].upper) == (None, None)
    assert found.table.rows[0].joint_type == "revolute"
    assert found.max_error <= 1e-14


def test_limits_that_are_missing_or_infinite_are_none():
    """No <limit>, or an infinite one, is no limit, and the first is worth a warning."""
    without = URDF.replace('<limit lower="-2" upper="1" effort="9" velocity="3"/>', "")
    found = extract_dh(without)
    assert (found.table.rows[0].lower, found.table.rows[0].upper) == (None, None)
    assert any("no <limit>" in warning for warning in found.warnings)
    infinite = URDF.replace('lower="-2" upper="1"', 'lower="-inf" upper="inf"')
    assert extract_dh(infinite).table.rows[0].upper is None


def test_drives_are_carried():
    """Velocity, effort, damping and friction of each joint are in its row."""
    row = extract_dh(URDF).table.rows[0]
    assert (row.velocity, row.effort, row.damping, row.friction) == (3.0, 9.0, 0.5, 0.2)


@BOTH
@pytest.mark.parametrize(
    ("path", "base", "tip"),
    [
        (UR5, "world", "ee_link"),
        (PANDA, "panda_link0", "panda_hand"),
        (TIAGO, "base_footprint", "hand_palm_link"),
        (ANYMAL, "base", "LF_FOOT"),
    ],
)
def test_inertial_parameters_move_with_the_frames(convention, path, base, tip):
    """Joint torques of the table's own URDF equal those of the file with its other joints held."""
    found = extract_dh(path, base, tip, convention)
    names = found.table.joint_names
    whole = pin.buildModelFromUrdf(str(path))
    others = [i for i in range(1, whole.njoints) if whole.names[i] not in names]
    source = pin.buildReducedModel(whole, others, pin.neutral(whole))
    made = pin.buildModelFromXML(
        urdf_text(found.table, UrdfOptions(balance_inertia=False, embed_table=False))
    )
    order = [source.joints[source.getJointId(name)].idx_v for name in names]
    made_order = [made.joints[made.getJointId(name)].idx_v for name in names]
    rng = np.random.default_rng(4)
    for _ in range(5):
        values = rng.uniform(-1, 1, (3, len(names)))
        torques = []
        for model, places in ((source, order), (made, made_order)):
            state = np.zeros((3, len(names)))
            state[:, places] = values
            torques.append(pin.rnea(model, model.createData(), *state)[places])
        assert torques[1] == pytest.approx(torques[0], abs=1e-9)


@BOTH
def test_inertial_parameters_of_a_chain_turned_round(convention):
    """Standing on its hand, the arm moves the bodies that it stood on before."""
    found = extract_dh(URDF, "hand", "root", convention)
    assert [row.mass for row in found.table.joints] == [2.0, None]
    frames = dh_frames(found.table, (0.05, 0.7))
    com = (frames[1] @ [*found.table.joints[0].com, 1.0])[:3]
    q = {"shoulder": 0.7, "elbow": 0.05}
    hand, arm = placed(pin.buildModelFromXML(URDF), q, "hand", "arm")
    assert com == pytest.approx(hand.actInv(arm).act(np.array([0.1, 0.2, 0.3])), abs=1e-14)
    six = found.table.joints[0].inertia
    tensor = np.array([six[:3], [six[1], *six[3:5]], [six[2], *six[4:]]])
    given = np.array([[0.03, 0.001, 0.002], [0.001, 0.04, 0.003], [0.002, 0.003, 0.05]])
    turn = hand.rotation.T @ arm.rotation @ pin.rpy.rpyToMatrix(0.1, 0.2, 0.3)
    turned = frames[1][:3, :3] @ tensor @ frames[1][:3, :3].T
    assert turned == pytest.approx(turn @ given @ turn.T, abs=1e-15)


@BOTH
def test_a_pinocchio_model(convention):
    """A model gives the table that its file gives, inertial parameters included."""
    model = pin.buildModelFromUrdf(str(PANDA))
    found = extract_dh(model, "panda_link0", "panda_hand", convention)
    direct = extract_dh(PANDA, "panda_link0", "panda_hand", convention)
    for a, b in zip(found.table.joints, direct.table.joints, strict=True):
        for key in ("theta", "d", "a", "alpha", "lower", "upper", "velocity", "effort", "mass"):
            assert getattr(a, key) == pytest.approx(getattr(b, key), abs=1e-12), key
        assert a.com == pytest.approx(b.com, abs=1e-12)
        assert a.inertia == pytest.approx(b.inertia, abs=1e-12)
    assert found.max_error <= 1e-13


def test_a_model_upside_down():
    """From the hand of a model to its root, bodies and all."""
    model = pin.buildModelFromXML(URDF)
    found = extract_dh(model, "hand", "root")
    assert found.max_error <= 1e-14
    assert [row.mass for row in found.table.joints] == [2.0, None]
    assert found.table.joints[0].com == pytest.approx(
        extract_dh(URDF, "hand", "root").table.joints[0].com, abs=1e-14
    )


MJCF = """<mujoco model="bench"><compiler angle="degree" eulerseq="xyz"/>
<default><default class="c"><joint axis="0 1 0" range="-90 90" damping="2"/></default></default>
<worldbody><body name="b1" pos="0 0 .3" euler="0 10 20">
  <joint name="j1" type="hinge" axis="0 0 1" pos="0.1 0 0.05" ref="30" range="-170 170"/>
  <geom type="capsule" size=".05 .1"/>
  <body name="b2" pos="0.3 0 0.1" quat="0.9 0.1 0.2 0.3">
    <joint name="j2" class="c"/>
    <joint name="j3" type="slide" axis="1 0 1" pos="0 0 .2" range="0 1" ref="0.2"/>
    <geom type="sphere" size=".05"/>
    <body name="b3" pos="0 0 .2"><joint name="j4" axis="1 0 0"/><geom type="sphere" size=".05"/>
      <site name="tcp" pos="0.1 0.2 .3" euler="0 90 0"/></body>
</body></body></worldbody></mujoco>
"""


@BOTH
def test_an_mjcf(convention, written):
    """Offsets, references and several joints a body come out as MuJoCo itself places them."""
    path = written("bench.xml", MJCF)
    found = extract_dh(path, "world", "tcp", convention)
    assert found.table.joint_names == ("j1", "j2", "j3", "j4")
    assert found.max_error <= 1e-14
    assert found.table.joints[0].lower == pytest.approx(math.radians(-170))
    model = mujoco.MjModel.from_xml_string(MJCF)
    data = mujoco.MjData(model)
    for q in np.random.default_rng(6).uniform(-1, 1, (5, 4)):
        data.qpos[:] = q
        mujoco.mj_kinematics(model, data)
        truth = pin.SE3(data.site("tcp").xmat.reshape(3, 3), data.site("tcp").xpos).homogeneous
        assert difference(dh_frames(found.table, q)[-1], truth) <= 1e-14


def test_a_broken_mjcf(written):
    """MuJoCo's own complaint, in one message."""
    path = written("broken.xml", MJCF.replace('type="slide"', 'type="sliding"'))
    with pytest.raises(UrdfError, match="mjcf: "):
        extract_dh(path)


def test_a_xacro(written):
    """A xacro file is expanded first."""
    text = URDF.replace(
        '<robot name="small">',
        '<robot name="small" xmlns:xacro="http://www.ros.org/wiki/xacro">'
        '<xacro:property name="h" value="0.4"/>',
    )
    path = written("small.xacro", text.replace('xyz="0 0 0.4"', 'xyz="0 0 ${h}"'))
    assert extract_dh(path).table.rows == extract_dh(URDF).table.rows


@BOTH
def test_screws_points_and_frames_agree(convention):
    """The same arm typed as screw axes, as directions with points, and as frames."""
    axes = [([0, 0, 1], [0, 0, 0]), ([0, 1, 0], [0, 0, 0.3]), ([0, 1, 0], [0.4, 0, 0.3])]
    tool = pose((0, 0, 1), 0.2, (0.7, 0.1, 0.3))
    screws = [[*axis, *np.cross(point, axis)] for axis, point in axes]
    frames = [pose((1, 0, 0), 0 if k == 0 else -math.pi / 2, p) for k, (_, p) in enumerate(axes)]
    found = [extract_dh(kind, convention=convention, tool=tool) for kind in (screws, axes, frames)]
    for other in found[1:]:
        for a, b in zip(found[0].table.joints, other.table.joints, strict=True):
            assert (a.a, a.d) == pytest.approx((b.a, b.d), abs=1e-14)
    q = (0.3, -0.7, 1.1)
    truth = np.eye(4)
    for screw, value in zip(screws, q, strict=True):
        motion = pin.Motion(np.array(screw[3:]) * value, np.array(screw[:3]) * value)
        truth = truth @ pin.exp6(motion).homogeneous
    for each in found:
        assert difference(dh_frames(each.table, q)[-1], truth @ tool) <= 1e-14


@pytest.mark.parametrize(
    ("source", "options", "message"),
    [
        ([[0, 0, 1, 0, 0]], {}, r"shape \(1, 5\): allowed are"),
        ([], {}, "allowed are"),
        ("abc", {}, "abc: there is no such file"),
        ([["a"] * 6], {}, "expected numbers"),
        ([[0, 0, 1, 0, 0, math.nan]], {}, "joint 1: NaN"),
        ([[0, 0, 1, 0, 0, 0], [0, 0, 1e200, 0, 0, 0]], {}, "joint 2: NaN"),
        ([[0, 0, 0, 0, 0, 0]], {}, "joint 1: a zero axis"),
        ([[0, 0, 0.9e-9, 0, 0, 0]], {}, "joint 1: a zero axis"),
        ([[[0, 0.9e-9, 0], [0, 0, 0]]], {}, "joint 1: a zero axis"),
        ([[0, 0, 1, 0, 0, 1]], {}, "joint 1: a screw of pitch 1 "),
        ([[[0, 0, 1], [0, 0, 0]]], {"joint_types": "RR"}, "joint_types: 2 for 1 joints"),
        ([[[0, 0, 1], [0, 0, 0]]], {"joint_types": "X"}, "joint_types: 'X' is not R, P"),
        ([[0, 0, 1, 0, 0, 0]], {"names": ["a", "b"]}, "names: 2 for 1 joints"),
        ([[0, 0, 1, 0, 0, 0]], {"tip": "x"}, "base and tip: typed axes"),
        (UR5, {"tool": np.eye(4)}, "tool: only for joint axes typed by hand"),
        (UR5, {"snap": 3.0}, "snap: expected a number from 0 to 0.1 rad and m, got 3.0"),
    ],
)
def test_axes_that_make_no_arm(source, options, message):
    """Each slip of the pen is one message."""
    with pytest.raises(UrdfError, match=message):
        extract_dh(source, **options)


def test_an_axis_of_a_nanometre_is_one():
    """Screws and axes that are a little longer than what counts as zero are as long ones."""
    one = extract_dh([[[0, 1, 0], [0, 0, 0.3]]]).table
    for short in ([[[0, 1.1e-9, 0], [0, 0, 0.3]]], [[0, 1.1e-9, 0, -0.33e-9, 0, 0]]):
        found = extract_dh(short).table
        assert difference(dh_frames(found, [0.7])[-1], dh_frames(one, [0.7])[-1]) <= 1e-15


def test_every_shipped_file_is_read_as_it_was_written():
    """The link frames of our own files are no obstacle to reading them."""
    found = extract_dh(urdf_text(load_table("stanford")), embedded=False)
    assert (found.base, found.tip) == ("base_link", "tool0")


HOMEWORK = """
axes:
  - {axis: [0, 0, 1], point: [0, 0, 0], name: waist}
  - {axis: [0, 1, 0], point: [0, 0, 0.3]}
  - {axis: [1, 0, 0], type: prismatic}
tool: {xyz: [0.5, 0, 0.3], rpy: [0, 0, 0.5]}
"""


def test_homework_in_a_file(written):
    """Axes typed into YAML are the same as axes typed into Python."""
    path = written("homework.yaml", HOMEWORK)
    found = extract_dh(path)
    axes = [[[0, 0, 1], [0, 0, 0]], [[0, 1, 0], [0, 0, 0.3]], [[1, 0, 0], [0, 0, 0]]]
    tool = pose((0, 0, 1), 0.5, (0.5, 0, 0.3))
    typed = extract_dh(axes, joint_types="RRP", tool=tool, names=["waist", "joint_2", "joint_3"])
    assert found.table.rows == typed.table.rows
    assert found.table.name == "homework"
    screws = '{"screws": [[0,0,1,0,0,0],[0,1,0,-0.3,0,0],[0,0,0,1,0,0]], "tool": null}'
    assert extract_dh(written("screws.json", screws)).table.n == 3


def test_a_typed_axis_without_a_point_goes_through_the_origin(written):
    """The same table as with the origin typed as its point."""
    text = "axes: [{axis: [0, 0, 1]}, {axis: [0, 1, 0]}]\ntool: {xyz: [0.5, 0.2, 0.3]}\n"
    whole = text.replace("]}", "], point: [0, 0, 0]}", 2)
    left_out, typed = (extract_dh(written(f"{len(x)}.yaml", x)).table for x in (text, whole))
    assert left_out.rows == typed.rows


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("axes:", "axles:", "needs one of the lists axes, screws, frames"),
        ("axes:", "axes: [", r"homework.yaml:\d+"),
        (HOMEWORK, "convention: standard", "a DH table"),
        (HOMEWORK, "- 1", "expected keys"),
        ("tool:", "tol:", "'tol' is not known"),
        ("xyz:", "position:", "tool: 'position' is not known"),
        ("point: [0, 0, 0.3]", "at: [0, 0, 0.3]", "joint 2: 'at' is not known"),
        ("axis: [0, 1, 0]", "axis: [0, 1]", "expected numbers"),
        ("prismatic", "helical", "joint_types: 'helical'"),
    ],
)
def test_slips_in_homework(old, new, message, written):
    """A file of axes that cannot be meant is one message that names the key."""
    path = written("homework.yaml", HOMEWORK.replace(old, new))
    with pytest.raises(UrdfError, match=message) as caught:
        extract_dh(path)
    assert "homework.yaml" in str(caught.value)
