"""The browser view without a browser: geometry, server manners, edits, branches."""

import json
import logging
import math
import signal
import socket
import subprocess
import sys
import urllib.request
from types import SimpleNamespace

import numpy as np
import pinocchio as pin
import pytest

import dh2urdf
from dh2urdf import DHConvention, DHRow, DHTable, JointType, Robot, load_table
from dh2urdf.checks import locate
from dh2urdf.conversions.write.bodies import Body
from dh2urdf.drawing.arm import drawn_arm
from dh2urdf.drawing.readings import UNITS
from dh2urdf.drawing.surfaces import TableDrawing, body_surface
from dh2urdf.exceptions import ConfigurationError, ServerError
from dh2urdf.transforms import rot_x, rot_y, trans
from dh2urdf.viewer.arm_scene import quaternions
from dh2urdf.viewer.tabs.branches import answer, branch_table, initials
from dh2urdf.viewer.tabs.ik_tab import default_task, dragged_axes
from dh2urdf.viewer.tabs.redundancy import default_joint
from dh2urdf.viewer.tabs.table_tab import new_table
from dh2urdf.viewer.urdf_drawing import urdf_drawing

VISITOR = SimpleNamespace(client=SimpleNamespace(send_file_download=lambda *_, **__: None))


@pytest.fixture
def view():
    """A view of the planar arm, stopped after the test."""
    with Robot.from_dh("planar_rr").view(port=0) as shown:
        yield shown


def test_quaternions_are_those_of_pinocchio():
    """Up to their common sign, near half turns too."""
    rng = np.random.default_rng(0)
    R = [pin.SE3.Random().rotation for _ in range(50)]
    R += [np.diag(d) for d in ((1.0, 1, 1), (1.0, -1, -1), (-1.0, 1, -1), (-1.0, -1, 1))]
    R += [R[4] @ pin.exp3(1e-9 * rng.normal(size=3)) for _ in range(5)]
    ours = quaternions(np.stack(R))
    for q, matrix in zip(ours, R, strict=True):
        x, y, z, w = pin.Quaternion(matrix).coeffs()
        assert abs(q @ [w, x, y, z]) == pytest.approx(1.0, abs=1e-12)


@pytest.mark.parametrize(
    "body",
    [
        Body("sphere", (0.3,), trans(0.1, 0.2, 0.3), "link"),
        Body("cylinder", (0.2, 0.7), rot_x(0.5) @ trans(0.3, 0, 0), "link"),
        Body("box", (0.2, 0.5, 0.9), rot_y(1.0), "link"),
    ],
    ids=lambda body: body.shape,
)
def test_triangles_enclose_the_body(body):
    """Triangles face outwards: the volume they enclose is the body's, less what corners cut."""
    surface = body_surface(body, (0, 0, 0))
    a, b, c = (surface.vertices[surface.faces[:, k].astype(int)] for k in range(3))
    volume = np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6
    assert 0.97 * body.volume < volume <= body.volume * (1 + 1e-12)


def test_shrunk_solids_stay_inside():
    """A ghost's solids keep their middles and lose their share of size."""
    node = TableDrawing(drawn_arm(load_table("ur5e"))).nodes[2]
    whole, slim = node.slim(1.0), node.slim(0.9)
    assert len(whole.solids) > 2
    start = 0
    for end in whole.solids:
        one, small = whole.vertices[start:end], slim.vertices[start:end]
        np.testing.assert_allclose(one.mean(axis=0), small.mean(axis=0), atol=1e-12)
        np.testing.assert_allclose(np.ptp(small, axis=0), 0.9 * np.ptp(one, axis=0), atol=1e-12)
        start = end


def test_server_listens_on_loopback_and_is_silent(capfd):
    """Only 127.0.0.1 answers, and nothing is printed, not on stopping either."""
    with Robot.from_dh("planar_rr").view(port=0) as shown:
        port = int(shown.url.rpartition(":")[2])
        for host, open_there in (("127.0.0.1", True), ("127.0.0.2", False)):
            with socket.socket() as probe:
                assert (probe.connect_ex((host, port)) == 0) is open_there
    assert capfd.readouterr() == ("", "")


def test_wide_open_server_says_so(caplog):
    """Listening on every address is logged as a warning."""
    with (
        caplog.at_level(logging.WARNING, "dh2urdf"),
        Robot.from_dh("planar_rr").view(host="0.0.0.0", port=0),
    ):
        pass
    assert "other machines" in caplog.text


def test_busy_port_is_an_error_and_else_the_next_is_taken():
    """A port that was asked for is not silently another one; without asking, the next is."""
    robot = Robot.from_dh("planar_rr")
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        with pytest.raises(ServerError, match=f"port {port} is in use"):
            robot.view(port=port)
    with robot.view() as first, robot.view() as second:
        assert first.url != second.url


@pytest.mark.parametrize(
    ("options", "error", "words"),
    [
        ({"host": "192.0.2.1"}, ServerError, "not an address of this machine"),
        ({"host": "no such host"}, ServerError, "no such host"),
        ({"port": 70000}, ConfigurationError, "65535"),
    ],
)
def test_bad_address_is_named(options, error, words):
    """A host or port that cannot be listened on raises with its reason."""
    with pytest.raises(error, match=words):
        Robot.from_dh("planar_rr").view(**options)


def test_configuration_is_set_and_read(view):
    """The view's q moves sliders and read-out; a bad one raises and moves nothing."""
    view.q = [0.5, -0.25]
    assert view._joints.sliders[0].value == pytest.approx(math.degrees(0.5), abs=0.006)
    assert f"{view.robot.fk(view.q)[0, 3]:.6f}" in view._joints.readout.content
    with pytest.raises(ConfigurationError, match="joint_1, joint_2"):
        view.q = [1.0]
    np.testing.assert_array_equal(view.q, [0.5, -0.25])


def test_scene_stands_where_the_robot_does(view):
    """Nodes of the scene are at the link poses of the configuration set."""
    view.q = [0.7, 0.4]
    elbow = view._scene.frames[2]
    np.testing.assert_allclose(elbow.position, [math.cos(0.7), math.sin(0.7), 0.0], atol=1e-12)


def test_frames_are_drawn_where_the_table_puts_them(view):
    """The DH frames appear once asked for, at the frames of the table, and follow the arm."""
    assert view._frames.roots == []
    view._options.frames.value = True
    view._switch_frames()
    for q in ([0.0, 0.0], [0.7, 0.4]):
        view.q = q
        expected = view.robot.table.frames(np.array(q))[:, :3, 3]
        places = [root.position for root in view._frames.roots]
        np.testing.assert_allclose(places, expected, atol=1e-12)


def test_names_of_axes_that_coincide_share_a_label():
    """At a straight wrist x4, x5 and x6 have one label; where they part, each name shows once."""
    with Robot.from_dh("puma560").view([0.3, 0.4, -0.2, 0.0, 0.0, 0.0], port=0) as shown:
        shown._options.frames.value = True
        shown._switch_frames()
        assert shown._scene.translucent
        for q5, names in ((0.0, {"z₅, z₆", "x₄, x₅, x₆"}), (1.2, {"z₅, z₆", "x₄", "x₅, x₆"})):
            shown.q = [0.3, 0.4, -0.2, 0.0, q5, 0.0]
            texts = {label.text for label in shown._frames.labels if label.visible}
            assert names <= texts
            written = ", ".join(texts).split(", ")
            assert sorted(written) == sorted(f"{a}{i}" for a in "xz" for i in "₀₁₂₃₄₅₆")


def test_arm_in_a_singular_family_stands_at_its_line():
    """Any member of the family marks its line; a target turned away from the arm marks none."""
    robot = Robot.from_dh("puma560")
    q = np.array([0.3, 0.4, -0.2, 0.5, 0.0, 0.1])
    options = {"task": "pose", "within": False, "locked": None}
    found = answer(robot, robot.fk(q), q, **options)
    assert found.free[found.current] == (3, 5)
    turned = answer(robot, robot.fk(q + np.array([0, 0, 0, 0, 0, 0.3])), q, **options)
    assert turned.current == -1


@pytest.mark.parametrize("name", ["planar_rr", "ur5e", "gantry_wrist"])
def test_floor_lies_under_the_base(name):
    """No body of the base reaches through the floor, and the floor is not above the origin."""
    with Robot.from_dh(name).view(port=0) as shown:
        floor = shown._server.scene._handle_from_node_name["/floor"].position[2]
        bodies = np.concatenate([s.vertices for s in shown._scene.drawing.nodes[0].surfaces])
        assert floor == pytest.approx(min(0.0, bodies[:, 2].min()), abs=1e-12)


def choose(view, row):
    """Choose a row as a visitor does."""
    view._table.choose(row)
    view._table._refresh()


def test_row_edit_rebuilds_the_arm(view):
    """Type, expressions and limits typed into the cells are in the new robot."""
    choose(view, 2)
    cells = view._table.cells
    cells["joint_type"].value = "prismatic"
    typed = {"d": "100mm", "a": "0", "alpha": "pi/2", "lower": "0", "upper": "0.5"}
    for key, text in typed.items():
        cells[key].value = text
    view._table._try(view._table._with_row_cells)
    row = view.robot.table.joints[1]
    assert row.joint_type is JointType.PRISMATIC
    assert (row.d, row.a, row.alpha, row.lower, row.upper) == (0.1, 0.0, math.pi / 2, 0.0, 0.5)
    assert len(view._joints.sliders) == 2
    assert view._joints.sliders[1].max == pytest.approx(0.5)


def test_rows_are_added_and_removed(view):
    """A row more and two rows less: the last one cannot go."""
    choose(view, 1)
    view._table.rows.value = "Add below"
    view._table._try(view._table._with_rows)
    assert view.robot.table.joint_names == ("joint_1", "joint_3", "joint_2")
    for left in (2, 1, 1):
        choose(view, 1)
        view._table.rows.value = "Remove"
        view._table._try(view._table._with_rows)
        assert view.robot.n == left
    assert "at least one" in view._table.note.content


@pytest.mark.parametrize(
    ("key", "text"), [("a", "1 apple"), ("alpha", "1/0"), ("d", "5deg"), ("lower", "400")]
)
def test_malformed_cell_changes_nothing(view, key, text):
    """The robot stays the same object and the note is an alert."""
    before = view.robot
    choose(view, 1)
    view._table.cells[key].value = text
    view._table._try(view._table._with_row_cells)
    assert view.robot is before
    assert 'role="alert"' in view._table.note.content
    assert "Nothing was changed" in view._table.note.content


def test_whole_table_is_edited_as_text(view):
    """Text of another table makes another arm; broken text names line and column."""
    text = view._table.text.value
    assert "planar_rr" in text
    view._table.text.value = text.replace("0.7", "1.5")
    view._table._try(view._table._with_text)
    assert view.robot.table.joints[1].a == 1.5
    before = view.robot
    view._table.text.value = text.replace("convention: standard", "convention: mine")
    view._table._try(view._table._with_text)
    assert view.robot is before
    assert "table:" in view._table.note.content


def test_joints_that_stay_keep_their_value(view):
    """After an edit the arm stands where it stood."""
    view.q = [0.5, -0.25]
    choose(view, 1)
    view._table.cells["a"].value = "2"
    view._table._try(view._table._with_row_cells)
    np.testing.assert_allclose(view.q, [0.5, -0.25])


def test_saved_urdf_is_verified(view):
    """What is sent is a URDF of the table shown, and the note tells the difference measured."""
    sent = {}
    client = SimpleNamespace(send_file_download=lambda n, c, **_: sent.update({n: c}))
    view._table._save_urdf(SimpleNamespace(client=client))
    view._table._save_table(SimpleNamespace(client=client))
    assert set(sent) == {"planar_rr.urdf", "planar_rr.yaml"}
    assert pin.buildModelFromXML(sent["planar_rr.urdf"].decode()).nq == 2


def test_explained_row_makes_the_arm_translucent(view):
    """The row's words are in the panel, the bodies see-through, until none is chosen."""
    choose(view, 1)
    view._explain(1)
    assert view._scene.translucent
    assert "Case 2" in view._table.words.content
    view._explain(0)
    assert not view._scene.translucent


@pytest.fixture
def aimed():
    """A view of an arm of six with its target switched on, stopped after the test."""
    q = np.radians([20.0, -105, 83, -51, -71, 22])
    with Robot.from_dh("ur5e").view(q, port=0) as shown:
        shown._ik.active.value = True
        yield shown


def test_target_moves_arm_and_ghosts(aimed):
    """A solved target: the arm goes to the nearest solution, the others are ghosts, all exact."""
    q, T, drawn = aimed.q, aimed.robot.fk(aimed.q), aimed._ik.ghosts
    T[:3, 3] += [0.02, -0.01, 0.015]
    aimed._ik.solve(T, follow=True)
    np.testing.assert_allclose(aimed.robot.fk(aimed.q), T, atol=1e-9)
    assert np.abs(aimed.q - q).max() < 0.2
    found = aimed._ik.answer
    assert len(found.q) == 8
    scales = drawn.handles[0].batched_scales
    assert np.count_nonzero(scales) == 7
    assert scales[found.current] == 0
    poses = drawn.drawing.poses(found.q[3])
    last = drawn.handles[drawn.moving.index(len(poses) - 1)]
    np.testing.assert_allclose(last.batched_positions[3], poses[-1, :3, 3], atol=1e-6)


def test_target_out_of_reach_is_said_and_the_arm_stays(aimed):
    """No solution: an alert, no ghosts, the configuration unchanged."""
    q, T = aimed.q, aimed.robot.fk(aimed.q)
    T[:3, 3] = [3.0, 0.0, 0.0]
    aimed._ik.solve(T, follow=True)
    assert "Out of reach" in aimed._ik.status.content
    assert aimed._ik.ghosts.handles[0].batched_scales.sum() == 0
    np.testing.assert_array_equal(aimed.q, q)


def test_answer_blames_the_limits_where_they_stand_in_the_way():
    """Solutions that exist outside the limits are counted in the words."""
    table = load_table("ur5e")
    rows = tuple(DHRow(**{**vars(row), "lower": -0.1, "upper": 0.1}) for row in table.rows)
    robot = Robot.from_dh(DHTable(rows, DHConvention.STANDARD, "narrow"))
    T = robot.fk(np.array([1.0, -1.0, 1.0, 0.5, 0.7, 0.2]))
    found = answer(robot, T, np.zeros(6), task="pose", within=True, locked=None)
    assert found.words == "Not within the joint limits: all 8 solutions lie outside them."


def test_singular_joints_are_named_and_underlined():
    """At a straight wrist the two joints that are free are in the words and in the table."""
    robot = Robot.from_dh("puma560")
    q = np.array([0.3, 0.4, -0.2, 0.5, 0.0, 0.1])
    found = answer(robot, robot.fk(q), q, task="pose", within=False, locked=None)
    assert "Singular: joint_4, joint_6" in found.words
    assert "underline" in branch_table(found, robot, UNITS)


@pytest.mark.parametrize(
    ("name", "task", "axes"),
    [
        ("planar_rr", "position", (True, True, False)),
        ("planar_rrr", "pose", (True, True, False)),
        ("omron_cobra600", "pose", (True, True, True)),
        ("xarm5", "position+axis", (True, True, True)),
        ("ur5e", "pose", (True, True, True)),
    ],
)
def test_target_asks_what_the_arm_can_do(name, task, axes):
    """A planar arm's target stays in its plane; fewer joints are asked for less than a pose."""
    robot = Robot.from_dh(name)
    assert default_task(robot) == task
    assert dragged_axes(robot) == axes


def test_branch_initials():
    """Words become their distinguishing letters."""
    assert initials("shoulder left, elbow down, wrist no flip") == "L D N"
    assert initials("") == ""


@pytest.mark.parametrize(("name", "joint"), [("kuka_iiwa14", 2), ("franka_fr3", 6)])
def test_held_joint_leaves_a_closed_form(name, joint):
    """An arm with a spherical wrist holds its third joint, the Panda its last."""
    assert default_joint(Robot.from_dh(name)) == joint


def test_urdf_visuals_stand_on_their_links(tmp_path):
    """Boxes, cylinders and spheres of a URDF are drawn at the links Pinocchio places."""
    path = tmp_path / "arm.urdf"
    dh2urdf.write_urdf(load_table("stanford"), path)
    robot = Robot.from_urdf(path, tip="tool0")
    drawing, notes = urdf_drawing(robot)
    assert notes == []
    q = robot.random_configuration(3)
    names = [node.name for node in drawing.nodes]
    expected = drawn_arm(load_table("stanford")).link_poses(q)
    for i in range(1, robot.n + 1):
        pose = drawing.poses(q)[names.index(f"link_{i}")]
        np.testing.assert_allclose(pose, expected[i], atol=1e-12)


def test_meshes_are_found_beside_the_urdf_and_missing_ones_named(tmp_path, monkeypatch):
    """package:// resolves to a folder above the file or on the path; what is not there is said."""
    monkeypatch.delenv("ROS_PACKAGE_PATH", raising=False)
    folder = tmp_path / "arm_description"
    (folder / "meshes").mkdir(parents=True)
    (folder / "urdf").mkdir()
    triangle = "solid t\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
    (folder / "meshes" / "link.stl").write_text(triangle + "endloop\nendfacet\nendsolid t\n")
    mesh = "<visual><geometry><mesh filename='{}' scale='2 2 2'/></geometry></visual>"
    text = (
        "<robot name='m'><link name='a'>{}</link><link name='b'>{}</link>"
        "<joint name='j' type='revolute'><parent link='a'/><child link='b'/>"
        "<axis xyz='0 0 1'/><limit lower='-1' upper='1' effort='1' velocity='1'/></joint></robot>"
    )
    there = mesh.format("package://arm_description/meshes/link.stl")
    gone = mesh.format("package://arm_description/meshes/gone.stl")
    urdf = folder / "urdf" / "arm.urdf"
    urdf.write_text(text.format(there, gone))
    assert locate("package://arm_description/meshes/link.stl", urdf).name == "link.stl"
    drawing, notes = urdf_drawing(Robot.from_urdf(urdf))
    assert [node.name for node in drawing.nodes] == ["a"]
    assert drawing.nodes[0].surfaces[0].vertices.max() == 2.0
    assert "gone.stl" in notes[0]


def test_notebook_gets_a_frame(view):
    """In a notebook the view is an iframe at its address."""
    assert f'src="{view.url}"' in view._repr_html_()


def test_verb_prints_the_address_and_ends_on_interrupt():
    """`dh2urdf view` serves the page, and Ctrl-C ends it with status 130 and the port free."""
    command = [sys.executable, "-m", "dh2urdf", "view", "planar_rr", "--port", "0", "--no-open"]
    done = subprocess.Popen(
        [*command, "--json"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    try:
        lines = [done.stdout.readline()]
        while lines[-1].strip() != "}":
            lines.append(done.stdout.readline())
        address = json.loads("".join(lines))["url"]
        with urllib.request.urlopen(address) as page:
            assert page.status == 200
        done.send_signal(signal.SIGINT)
        assert done.wait(120) == 130
    finally:
        done.kill()
        done.communicate()
    with socket.socket() as probe:
        assert probe.connect_ex(("127.0.0.1", int(address.rpartition(":")[2]))) != 0


def test_verb_builds_a_table_from_scratch():
    """Without a table the view starts from one joint."""
    assert new_table().n == 1
    assert Robot.from_dh(new_table()).n == 1
