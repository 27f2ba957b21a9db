"""Figures: geometry against independent constructions, labels, files, the extra that is missing."""

import math
import subprocess
import sys
import xml.etree.ElementTree as ET
from itertools import combinations

import numpy as np
import pytest
from example_robots import placed
from matplotlib.font_manager import FontProperties
from matplotlib.path import Path
from matplotlib.textpath import TextPath

import dh2urdf
from dh2urdf import Robot, load_table
from dh2urdf.conversions.write.bodies import Body
from dh2urdf.drawing.arm import drawn_arm, table_of
from dh2urdf.drawing.row import row_picture, row_words
from dh2urdf.exceptions import ConfigurationError, OutputError, OutputExistsError
from dh2urdf.figures import branch_ghosts, dh_marks, figure, picture_bytes, save_picture
from dh2urdf.figures.canvas import text_box
from dh2urdf.figures.projection import View
from dh2urdf.figures.solids.ghosts import group_ghosts
from dh2urdf.figures.solids.occlusion import front_depth, occlusion
from dh2urdf.figures.solids.solids import Part, arm_parts, convex_hull
from dh2urdf.figures.style import RC, mpl
from dh2urdf.transforms import rot_x, rot_y, rot_z, trans

ARMS = ("puma560", "ur5e", "stanford", "planar_rr", "franka_fr3", "fanuc_crx10ia", "gantry_wrist")


@pytest.mark.parametrize(("azimuth", "elevation"), [(-60, 22), (35, -10), (-90, 90)])
def test_view_turns_the_world_and_drops_depth(azimuth, elevation):
    """The picture is the world turned by -azimuth about z, then tipped by the elevation."""
    view = View(azimuth, elevation)
    R = rot_y(math.radians(elevation))[:3, :3] @ rot_z(-math.radians(azimuth))[:3, :3]
    points = np.random.default_rng(0).normal(size=(20, 3))
    turned = points @ R.T
    np.testing.assert_allclose(view.depth(points), turned[:, 0], atol=1e-12)
    np.testing.assert_allclose(view.flat(points), turned[:, 1:], atol=1e-12)


@pytest.mark.parametrize(
    "body",
    [
        Body("sphere", (0.4,), np.eye(4), "link"),
        Body("cylinder", (0.3, 0.9), np.eye(4), "link"),
        Body("box", (0.5, 0.8, 0.3), np.eye(4), "link"),
    ],
    ids=lambda body: body.shape,
)
def test_front_of_a_solid_is_its_nearest_point_on_the_ray(body):
    """Marching along a ray from the eye enters the solid where the closed form says."""
    rng = np.random.default_rng(1)
    T = trans(0.1, -0.2, 0.3) @ rot_x(0.7) @ rot_y(-0.4)
    view = View(-50.0, 25.0)
    rays = view.flat(T[:3, 3]) + rng.uniform(-0.5, 0.5, (60, 2))
    fronts = front_depth(body, T, view, rays)
    steps = np.linspace(1.5, -1.5, 6001)
    for ray, front in zip(rays, fronts, strict=True):
        line = ray @ view.axes[:2] + steps[:, None] * view.axes[2]
        inside = _inside(body, (line - T[:3, 3]) @ T[:3, :3])
        if inside.any():
            assert front == pytest.approx(steps[np.argmax(inside)], abs=1e-3)
        else:
            assert front == -np.inf or _chord(body, T, view, ray) < 2e-3
    assert np.isfinite(fronts).sum() > 15


def _inside(body, points):
    if body.shape == "sphere":
        return np.linalg.norm(points, axis=-1) <= body.size[0]
    if body.shape == "cylinder":
        radius, length = body.size
        return (np.hypot(points[..., 0], points[..., 1]) <= radius) & (
            np.abs(points[..., 2]) <= length / 2
        )
    return (np.abs(points) <= np.array(body.size) / 2).all(axis=-1)


def _chord(body, T, view, ray):
    steps = np.linspace(1.5, -1.5, 300_001)
    line = ray @ view.axes[:2] + steps[:, None] * view.axes[2]
    return _inside(body, (line - T[:3, 3]) @ T[:3, :3]).sum() * 1e-5


def test_hidden_parts_are_painted_first():
    """Of three boxes in a row towards the eye, the farthest is painted first."""
    view = View(0.0, 0.0)
    box = Body("box", (0.2, 1.0, 1.0), np.eye(4), "joint")
    parts = [Part("joint", [(box, trans(x, 0.0, 0.0))]) for x in (0.5, -1.0, 2.0)]
    seen = occlusion(parts, view)
    assert seen.order == [1, 0, 2]
    assert seen.again == []


@pytest.mark.parametrize("name", ["puma560", "ur5e", "franka_fr3", "stanford", "gantry_wrist"])
def test_what_is_painted_last_is_what_is_nearest(name):
    """Along random rays, the part painted last is the one that a ray from the eye meets first."""
    robot = Robot.from_dh(name)
    arm = drawn_arm(robot.table)
    rng = np.random.default_rng(7)
    for view in (View(-60.0, 22.0), View(40.0, 35.0)):
        parts = arm_parts(arm.bodies, arm.link_poses(robot.random_configuration(rng)))
        seen = occlusion(parts, view)
        outlines = np.concatenate([f[0].polygon for part in parts for f in part.faces(view)])
        rays = rng.uniform(outlines.min(axis=0), outlines.max(axis=0), (4000, 2))
        depths = ([front_depth(body, T, view, rays) for body, T in p.solids] for p in parts)
        fronts = np.stack([np.max(depth, axis=0) for depth in depths])
        hit = np.isfinite(fronts).any(axis=0)
        painted = np.full(len(rays), -1)
        for k in seen.order:
            painted[np.isfinite(fronts[k])] = k
        for k, rings in seen.again:
            inside = sum(Path(ring).contains_points(rays).astype(int) for ring in rings) % 2 == 1
            painted[inside & np.isfinite(fronts[k])] = k
        wrong = painted[hit] != np.argmax(fronts, axis=0)[hit]
        assert hit.sum() > 100
        assert wrong.mean() < 0.01


def test_hull_holds_all_points_and_turns_left():
    """No point lies outside the hull, and its corners go round counter-clockwise."""
    points = np.random.default_rng(2).normal(size=(300, 2))
    hull = convex_hull(points)
    edges = np.roll(hull, -1, axis=0) - hull
    for corner, edge in zip(hull, edges, strict=True):
        way = points - corner
        assert (edge[0] * way[:, 1] - edge[1] * way[:, 0] >= -1e-12).all()


@pytest.mark.parametrize("name", dh2urdf.list_tables())
def test_bodies_stand_where_the_urdf_puts_its_links(name):
    """Poses of the drawn links are those of the URDF's links, placed by Pinocchio."""
    robot = Robot.from_dh(name)
    arm = drawn_arm(robot.table)
    q = robot.chain_configuration(robot.random_configuration(3))
    names = ["base_link", *(f"link_{i}" for i in range(1, robot.table.n + 1))]
    links = placed(robot.model, dict(zip(robot.table.joint_names, q, strict=True)), *names)
    for T, link in zip(arm.link_poses(q)[: robot.table.n + 1], links, strict=True):
        np.testing.assert_allclose(T, link.homogeneous, atol=1e-12 * max(1, arm.size))


@pytest.mark.parametrize("name", ["ur5e", "franka_fr3", "stanford", "fanuc_crx10ia", "puma560"])
def test_row_leads_from_frame_to_frame(name):
    """The measures join the frames' origins; the arcs turn x into x and z into z."""
    robot = Robot.from_dh(name)
    arm = drawn_arm(robot.table)
    q = robot.random_configuration(4)
    frames = robot.table.frames(q)
    modified = robot.table.convention == "modified"
    for i in range(1, robot.n + 1):
        picture = row_picture(arm, q, i)
        first, second = (picture.a, picture.d) if modified else (picture.d, picture.a)
        np.testing.assert_allclose(first.segment[0], frames[i - 1][:3, 3], atol=1e-12)
        np.testing.assert_allclose(second.segment[0], first.segment[1], atol=1e-12)
        np.testing.assert_allclose(second.segment[1], frames[i][:3, 3], atol=1e-12)
        for arc, start, end in (
            (picture.theta, frames[i - 1][:3, 0], frames[i][:3, 0]),
            (picture.alpha, frames[i - 1][:3, 2], frames[i][:3, 2]),
        ):
            points = (arc.points(0.5) - arc.centre) / 0.5
            np.testing.assert_allclose(points[0], start, atol=1e-12)
            np.testing.assert_allclose(points[-1], end, atol=1e-12)


@pytest.mark.parametrize(
    ("name", "row", "words"),
    [
        ("ur5e", 1, "Case 3: z₀ and z₁ intersect"),
        ("ur5e", 2, "Case 2: z₁ and z₂ are parallel, 0.425 m apart"),
        ("denso_vs6556", 1, "Case 1: z₀ and z₁ are skew"),
        ("ur5e", 6, "Last frame: free (step 4)"),
        ("franka_fr3", 1, "First frame: free"),
        ("gantry_wrist", 3, "one line"),
        ("fanuc_crx10ia", 2, "The joint moves θ₂ = q₂ − 90°"),
        ("rpr_by_inspection", 3, "A fixed step leads from there to frame 3"),
    ],
)
def test_row_says_its_case(name, row, words):
    """Each case of step 3 is named where it is known to be."""
    arm = drawn_arm(load_table(name))
    picture = row_picture(arm, np.full(arm.table.n, 0.3), row)
    assert words in row_words(arm.table, picture)


@pytest.fixture
def searched(monkeypatch):
    """Labels, their centres and the bounds of each figure that is drawn."""
    kept = []
    search = dh_marks.place_labels

    def place(labels, lines, bounds):
        centres = search(labels, lines, bounds)
        kept.append((labels, centres, bounds))
        return centres

    monkeypatch.setattr(dh_marks, "place_labels", place)
    return kept


@pytest.mark.parametrize("name", ["ur5", "kuka_iiwa14", "franka_fer", "planar_rrr"])
def test_labels_stand_beside_what_they_name(name, searched):
    """At crowded wrists too, a name is nearer to its own arrow or length than to another's.

    Those that run along one another, as a_3 and a_4 of a Panda, may have their names together.
    """
    figure(Robot.from_dh(name))
    labels, centres, _ = searched.pop()
    for label, centre in zip(labels, centres, strict=True):
        own = label.gap(centre[None], label.marks)
        assert own < 20.0
        for other in labels:
            along = np.linalg.norm(other.marks[:, None] - label.marks, axis=2).min() < 4.0
            if other is not label and other.colour == label.colour and not along:
                spare = label.gap(centre[None], other.marks) - own
                assert spare > 1.0, f"{label.text} stands beside {other.text}"


@pytest.mark.parametrize("name", ARMS)
def test_labels_stay_apart_and_on_the_sheet(name, searched):
    """No two labels overlap, at zero and at a random configuration."""
    robot = Robot.from_dh(name)
    for q in (None, robot.random_configuration(5)):
        figure(robot, q)
        labels, centres, bounds = searched.pop()
        assert len(labels) >= robot.n
        half = np.stack([label.size for label in labels]) / 2
        assert (centres - half >= bounds[0] - 1e-9).all()
        assert (centres + half <= bounds[1] + 1e-9).all()
        for i, j in combinations(range(len(labels)), 2):
            apart = np.abs(centres[i] - centres[j]) >= half[i] + half[j]
            assert apart.any(), f"{labels[i].text} covers {labels[j].text}"


TEXTS = (
    r"$\theta_{12}$",
    "$x_{1},\\,z_{2}$",
    "$-q_{3}$ + 90°",
    "0.089159",
    "Puma 560, |DH|",
    "Ωéß&@",
)


@pytest.mark.parametrize("weight", ["normal", "bold"])
@pytest.mark.parametrize("text", TEXTS)
def test_box_of_a_text_is_that_of_its_curves(text, weight):
    """Matplotlib's search along every curve of the glyphs finds the same box; blanks have none."""
    with mpl.rc_context(RC):
        font = FontProperties(family=RC["font.sans-serif"], weight=weight)
        box = TextPath((0, 0), text, size=14.0, prop=font).get_extents()
        np.testing.assert_array_equal(text_box(text, 14.0, weight), box.bounds)
        assert text_box(" ", 14.0, weight) == (0.0, 0.0, 0.0, 0.0)


def test_svg_keeps_text_and_pdf_and_png_are_whole():
    """The same figure in three formats; letters of the SVG are text, not outlines."""
    picture = figure(Robot.from_dh("puma560"), np.radians([30, 40, -30, 25, 45, 20]))
    svg = ET.fromstring(picture_bytes(picture, "svg"))
    texts = "".join("".join(t.itertext()) for t in svg.iter("{http://www.w3.org/2000/svg}text"))
    assert "0.67183" in texts
    assert "−90°" in texts
    assert picture_bytes(picture, "pdf").startswith(b"%PDF")
    png = picture_bytes(picture, "png", dpi=100)
    width, height = (int.from_bytes(png[k : k + 4], "big") for k in (16, 20))
    np.testing.assert_allclose([width, height], 100 * picture.get_size_inches(), atol=1.0)


@pytest.mark.parametrize("format", ["png", "svg", "pdf"])
def test_figures_are_the_same_bytes_each_time(format):
    """Two figures of one arm are equal byte for byte."""
    robot = Robot.from_dh("planar_rr")
    one, two = (picture_bytes(figure(robot, [0.3, 0.4]), format, dpi=60) for _ in range(2))
    assert one == two


def test_schematic_ghosts_and_bare_arm_are_drawn():
    """Every option gives a picture that differs from the plain one."""
    robot = Robot.from_dh("stanford")
    q = robot.random_configuration(1)
    plain = picture_bytes(figure(robot, q), "png", dpi=50)
    for options in (
        {"style": "schematic"},
        {"ghosts": [robot.random_configuration(2)], "ghost_names": ["other"]},
        {"frames": False},
        {"table": False},
        {"view": (20, 30)},
    ):
        assert picture_bytes(robot.figure(q, **options), "png", dpi=50) != plain


@pytest.mark.parametrize(
    ("name", "filled"), [("planar_rr", 0.25), ("planar_rrr", 0.2), ("omron_cobra600", 0.4)]
)
def test_flat_arms_have_little_white_around(name, filled):
    """The arm alone covers a good part of a sheet that is no higher than it needs."""
    picture = figure(Robot.from_dh(name), table=False)
    corners = np.concatenate([p.get_xy() for p in picture.axes[0].patches if hasattr(p, "get_xy")])
    sheet = 72.0 * picture.get_size_inches()
    assert (corners >= 0.0).all()
    assert (corners <= sheet).all()
    assert np.prod(np.ptp(corners, axis=0)) > filled * np.prod(sheet)
    assert np.prod(sheet) < (0.45 if name.startswith("planar") else 0.9) * 470 * 420


@pytest.mark.parametrize("task", [None, "position"])
def test_both_elbows_of_the_first_lecture_are_drawn_with_their_angles(task):
    """Two links at a bent pose: the other elbow is the mirror image, and the angles are written."""
    robot = Robot.from_dh("planar_rr")
    q, ghosts, names = branch_ghosts(robot, task=task)
    assert len(ghosts) == len(names) == 2
    np.testing.assert_allclose(ghosts[0], q, atol=1e-9)
    np.testing.assert_allclose(robot.fk(ghosts[1])[:3, 3], robot.fk(q)[:3, 3], atol=1e-9)
    assert ghosts[1][1] == pytest.approx(-q[1])
    texts = [t.get_text() for t in figure(robot, q, ghosts=ghosts, ghost_names=names).axes[0].texts]
    for each in ghosts:
        for i, angle in enumerate(np.degrees(each), 1):
            shown = f"{angle:.1f}".removesuffix(".0").replace("-", "\N{MINUS SIGN}")
            assert rf"$\theta_{{{i}}}$ = {shown}°" in texts
    assert "as drawn: elbow down" in texts
    assert any(text.startswith("elbow up: ") for text in texts)


@pytest.mark.parametrize(
    ("name", "count"), [("planar_rrr", 1), ("omron_cobra600", 1), ("xarm5", 3), ("gantry", 0)]
)
def test_arms_of_few_joints_have_their_ghosts(name, count):
    """As many others reach the pose as the arm has; each is drawn or looks like another one."""
    robot = Robot.from_dh(name)
    q, ghosts, _ = branch_ghosts(robot)
    assert len(ghosts) == count + 1
    drawn = group_ghosts(drawn_arm(robot.table), q, ghosts, [])
    assert sum(ghost.is_drawn for ghost in drawn) <= count
    for each in ghosts:
        np.testing.assert_allclose(robot.fk(each)[:3, 3], robot.fk(q)[:3, 3], atol=1e-9)


def test_branches_that_look_alike_share_a_colour():
    """Eight branches of a Puma are three ghosts and the arm: its wrist shows no difference."""
    robot = Robot.from_dh("puma560")
    q = np.radians([30, 40, -30, 25, 45, 20])
    found = robot.ik(robot.fk(q), seed=q, within_limits=False)
    ghosts = group_ghosts(drawn_arm(robot.table), q, list(found.q[1:]), found.branch[1:])
    assert [ghost.is_drawn for ghost in ghosts] == [False, True, True, True]
    assert len({ghost.colour for ghost in ghosts}) == 4
    assert ghosts[0].name.startswith("as drawn: shoulder")
    assert all("wrist" in ghost.name and " or " in ghost.name for ghost in ghosts[1:])


def test_urdf_is_drawn_by_the_table_found_for_it(tmp_path):
    """The table drawn for a URDF has the robot's forward kinematics."""
    path = tmp_path / "arm.urdf"
    dh2urdf.write_urdf(load_table("ur5e"), path)
    robot = Robot.from_urdf(path, tip="tool0")
    q = robot.random_configuration(6)
    np.testing.assert_allclose(table_of(robot).fk(q), robot.fk(q), atol=1e-9)
    assert picture_bytes(robot.figure(q), "png", dpi=40)


@pytest.mark.parametrize("q", [[0.1], [0.1, math.nan], [[0.1, 0.2]], 3.0, ["a", "b"]])
def test_bad_configuration_is_named(q):
    """A q of the wrong shape, with NaN or of words raises with the joints' names."""
    with pytest.raises(ConfigurationError, match="joint_1, joint_2"):
        figure(Robot.from_dh("planar_rr"), q)


def test_foreign_file_and_unknown_format_are_refused(tmp_path):
    """A picture that is not ours stays; ours is replaced; .gif is no format."""
    picture = figure(Robot.from_dh("planar_rr"))
    foreign = tmp_path / "photo.png"
    foreign.write_bytes(b"\x89PNG not ours")
    with pytest.raises(OutputExistsError, match="--force"):
        save_picture(picture, foreign, force=False)
    assert foreign.read_bytes() == b"\x89PNG not ours"
    own = tmp_path / "own.png"
    for _ in range(2):
        save_picture(picture, own, dpi=40, force=False)
    with pytest.raises(OutputError, match=r"\.png, \.svg, \.pdf"):
        save_picture(picture, tmp_path / "f.gif")


@pytest.mark.parametrize(
    ("verb", "module", "extra"),
    [
        (["figure", "planar_rr", "-o", "f.png"], "matplotlib", "plot"),
        (["workspace", "planar_rr", "-o", "f.png"], "matplotlib", "plot"),
        (["view", "planar_rr", "--no-open"], "viser", "viewer"),
    ],
)
def test_missing_extra_is_one_line(verb, module, extra, tmp_path):
    """Without the extra: status 2 and one line that says what to install."""
    code = f"import sys; sys.modules[{module!r}] = None; from dh2urdf.cli import main; main({verb})"
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert done.returncode == 2
    assert len(done.stderr.strip().splitlines()) == 1
    assert f"pip install 'dh2urdf[{extra}]'" in done.stderr
    assert list(tmp_path.iterdir()) == []
