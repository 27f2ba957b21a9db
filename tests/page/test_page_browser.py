"""The page from disk in a real headless Chromium without a network; pictures in artifacts/."""

from functools import partial

import numpy as np
import pinocchio as pin
import pytest
from browser import ARTIFACTS, chromium
from coupled_arms import COUPLED, driven_palletiser

from dh2urdf import DHRow, DHTable, JointType, Robot
from dh2urdf.drawing.arm import drawn_arm
from dh2urdf.page import save_page
from dh2urdf.transforms import matrix_to_rpy

pytestmark = [
    pytest.mark.browser,
    pytest.mark.skipif(chromium() is None, reason="no Chromium: apt-get install chromium"),
]

START = np.radians([20.0, -105.0, 83.0, -51.0, -71.0, 22.0])


@pytest.fixture
def opened(browser, tmp_path):
    """The page of an arm, opened from disk; it asks for nothing and meets no error."""
    asked, errors = [], []
    context = browser.new_context(viewport={"width": 1280, "height": 800}, accept_downloads=True)
    context.set_offline(True)

    def open_page(robot, q=None):
        path = save_page(robot, tmp_path / "arm.html", q)
        page = context.new_page()
        page.on("request", lambda request: asked.append(request.url))
        page.on("pageerror", lambda error: errors.append(str(error)))
        page.on("console", lambda said: errors.append(said.text) if said.type == "error" else None)
        page.goto(path.as_uri())
        return page

    yield open_page
    context.close()
    assert [url for url in asked if not url.startswith(("file:", "data:"))] == []
    assert errors == []


def picture(page, name):
    """Keep a picture among the artefacts."""
    ARTIFACTS.mkdir(exist_ok=True)
    page.screenshot(path=ARTIFACTS / f"{name}.png")


def inked(page, canvas):
    """How many pixels of a canvas are not white or empty."""
    return page.evaluate(
        """id => { const c = document.getElementById(id), d = document.createElement('canvas');
        d.width = c.width; d.height = c.height; const x = d.getContext('2d'); x.drawImage(c, 0, 0);
        const v = x.getImageData(0, 0, d.width, d.height).data; let n = 0;
        for (let k = 0; k < v.length; k += 4)
          n += v[k + 3] > 0 && Math.min(v[k], v[k + 1], v[k + 2]) < 220; return n; }""",
        canvas,
    )


def mixed_table(convention):
    """Both kinds of joints, turned signs, fixed steps, a base and a tool."""
    step = DHTable.from_array([[0.1, 0.2, 0.3, 0.4]], convention=convention).rows[0]
    fixed = DHRow(joint_type=JointType.FIXED, theta=step.theta, d=step.d, a=0.1, alpha=0.7)
    rows = (
        fixed,
        DHRow(theta=0.3, d=0.2, a=0.1, alpha=1.1, sign=-1),
        DHRow(joint_type=JointType.PRISMATIC, theta=0.4, d=0.2, a=-0.3, alpha=-0.6),
        fixed,
        DHRow(d=-0.1, a=0.4, alpha=2.0),
    )
    return DHTable(rows, convention, "mixed")


MADE = {name: partial(mixed_table, name) for name in ("standard", "modified")} | COUPLED


@pytest.mark.parametrize("name", ["ur5e", "franka_fer", "stanford", *MADE])
def test_kinematics_of_the_page_are_the_robots(opened, name):
    """FK, frames, rpy and quaternions of the script against the robot and Pinocchio, to 1e-9."""
    robot = Robot.from_dh(MADE[name]() if name in MADE else name)
    page = opened(robot)
    Q = np.stack([robot.random_configuration(k) for k in range(40)])
    T = np.array(page.evaluate("Q => Q.map(fk)", Q.tolist())).reshape(-1, 4, 4)
    np.testing.assert_allclose(T, robot.fk(Q), atol=1e-9)
    frames = np.array(page.evaluate("Q => Q.map(frames)", Q.tolist()))
    frames = frames.reshape(len(Q), -1, 4, 4)
    np.testing.assert_allclose(frames, robot.frames(Q), atol=1e-9)
    flat = T.reshape(-1, 16).tolist()
    angles = np.array(page.evaluate("Ts => Ts.map(rpy)", flat))
    np.testing.assert_allclose(angles, [matrix_to_rpy(one) for one in T], atol=1e-9)
    for quaternion, one in zip(page.evaluate("Ts => Ts.map(quaternion)", flat), T, strict=True):
        R = pin.Quaternion(np.array(quaternion)).toRotationMatrix()
        np.testing.assert_allclose(R, one[:3, :3], atol=1e-9)


def test_bars_of_the_page_stand_where_those_of_pictures_do(opened):
    """Each bar of a parallelogram begins at the same point; a slider a value, a row a joint."""
    robot = Robot.from_dh(driven_palletiser())
    page = opened(robot, [0.2, 0.4, 0.3, 0.1])
    picture(page, "page-palletiser")
    assert page.locator(".joint").count() == 4
    assert page.locator(".joint-row").count() == 6
    arm = drawn_arm(robot.table)
    for seed in range(5):
        q = robot.random_configuration(seed)
        poses = page.evaluate(
            "q => arm.nodes.filter(n => n.bar).map(n => barPose(n.bar, frames(q)))", q.tolist()
        )
        places = robot.table.frames(robot.chain_configuration(q))
        expected = [bar.pose(places) for bar in arm.bars]
        np.testing.assert_allclose(np.reshape(poses, (-1, 4, 4)), expected, atol=1e-12)


def test_sliders_move_the_arm_within_its_limits(opened):
    """A slider and its field move one joint; what lies beyond a limit stops there."""
    robot = Robot.from_dh("ur5e")
    page = opened(robot, START)
    picture(page, "page-ur5e")
    assert page.title() == "ur5e: 6 joints, standard DH"
    before = page.evaluate("bodies.toDataURL()")
    page.get_by_role("slider", name="elbow_joint").focus()
    page.get_by_role("slider", name="elbow_joint").fill("40")
    q = START.copy()
    q[2] = np.radians(40)
    np.testing.assert_allclose(page.evaluate("state.q"), q, atol=1e-6)
    assert page.evaluate("bodies.toDataURL()") != before
    field = page.locator(".joint input[type=number]").nth(2)
    field.fill("9999")
    field.press("Tab")
    assert page.evaluate("state.q[2]") == pytest.approx(robot.upper[2])
    shown = page.locator("#pose tr").first.inner_text().replace("−", "-").split()[2:]
    tip = robot.fk(np.array(page.evaluate("state.q")))[:3, 3]
    np.testing.assert_allclose([float(v) for v in shown], tip, atol=1e-6)


def test_units_are_chosen_once(opened):
    """Sliders, pose and table follow, values and headings; the arm stays."""
    page = opened(Robot.from_dh("stanford"))
    q = page.evaluate("state.q")
    page.locator("#units").select_option("mm, rad")
    text = page.locator("aside").inner_text()
    assert "[mm]" in text
    assert "[m]" not in text
    assert "[°]" not in text
    assert page.evaluate("state.q") == q


@pytest.mark.parametrize(
    ("name", "order"),
    [
        ("ur5e", ["turn about z₁ by θ₂", "along z₁ by d₂", "along x₂ by a₂", "about x₂ by α₂"]),
        ("franka_fer", ["about x₁ by α₁", "along x₁ by a₁", "about z₂ by θ₂", "along z₂ by d₂"]),
    ],
)
def test_lesson_steps_through_the_motions(opened, name, order):
    """Next and previous walk the motions of each row; the last matrix is the row's."""
    robot = Robot.from_dh(name)
    q = np.clip(0.1 + 0.2 * np.arange(robot.n), robot.lower, robot.upper)
    page = opened(robot, q)
    following = page.get_by_role("button", name="Next")
    for _ in range(6):
        following.click()
    said = page.locator("#lesson p").first
    assert said.inner_text() == "Row 2: it starts in frame 1."
    for k, words in enumerate(order, 1):
        following.click()
        assert f"Row 2, motion {k} of 4:" in said.inner_text()
        assert words in said.inner_text()
        picture(page, f"page-{name}-lesson-{k}")
    assert "Frame 2 is reached." in said.inner_text()
    cells = page.locator("#lesson table td").all_inner_texts()
    shown = np.array([float(c.replace("−", "-")) for c in cells]).reshape(4, 4)
    np.testing.assert_allclose(shown, robot.table.transforms(q)[1], atol=6e-5)
    page.get_by_role("button", name="Previous").click()
    assert "motion 3 of 4" in said.inner_text()
    page.keyboard.press("ArrowLeft")
    assert "motion 2 of 4" in said.inner_text()
    page.get_by_role("button", name="Whole arm").click()
    assert page.get_by_role("button", name="Previous").is_disabled()


def test_picture_is_saved(opened, tmp_path):
    """The picture has the size of what is seen, the bodies and the marks over them."""
    page = opened(Robot.from_dh("puma560"))
    assert inked(page, "bodies") > 5000
    assert inked(page, "marks") > 1000
    with page.expect_download() as download:
        page.get_by_role("button", name="Save picture").click()
    saved = tmp_path / "saved.png"
    download.value.save_as(saved)
    assert download.value.suggested_filename == "puma560.png"
    assert saved.read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"
    size = [int.from_bytes(saved.read_bytes()[k : k + 4], "big") for k in (16, 20)]
    assert size == [880, 800]


def test_dragging_turns_the_arm_and_narrow_pages_fold(opened):
    """The eye follows the mouse, a double click brings the whole arm back; phones see all."""
    page = opened(Robot.from_dh("planar_rr"))
    azimuth = page.evaluate("eye.azimuth")
    page.mouse.move(400, 300)
    page.mouse.down()
    page.mouse.move(500, 300)
    page.mouse.up()
    assert page.evaluate("eye.azimuth") == pytest.approx(azimuth - 0.8)
    page.mouse.wheel(0, -300)
    scale = page.evaluate("eye.scale")
    page.mouse.dblclick(400, 300)
    assert page.evaluate("eye.scale") < scale
    page.set_viewport_size({"width": 420, "height": 800})
    assert page.locator("main").bounding_box()["width"] == 420
    tip = "project(origin(fk(state.q))).slice(0, 2)"
    for _ in range(50):  # the page's policy forbids what wait_for_function does
        if page.evaluate(f"{tip}[0] > 0 && {tip}[0] < 420"):
            break
        page.wait_for_timeout(100)
    assert page.evaluate(f"{tip}[0] > 0 && {tip}[0] < 420")
    picture(page, "page-narrow")


def test_frames_that_stand_far_away_are_drawn_on_the_arm(opened):
    """Nearly parallel axes: the frames are in the picture, whole arm and lesson, and it is said."""
    far = (DHRow(a=0.4, d=100.0, alpha=1e-3), DHRow(a=0.3, d=-100.0))
    page = opened(Robot.from_dh(DHTable((DHRow(d=0.3, alpha=np.pi / 2), *far), "standard", "far")))
    places = np.array(
        page.evaluate(
            """frames(state.q).map((T, i) =>
            project(add(origin(T), column(T, 2), arm.shifts[i])).slice(0, 2))"""
        )
    )
    assert ((places > 0) & (places < [880, 800])).all()
    for _ in range(8):
        page.get_by_role("button", name="Next").click()
    assert "on the arm, moved along z" in page.locator("#lesson").inner_text()
    assert inked(page, "marks") > 200
    picture(page, "page-far-frames")
