"""The panel in a real headless Chromium: names, units, faults marked; pictures in artifacts/."""

import re

import numpy as np
import pytest
from browser import chromium, wait_for

from dh2urdf import Robot
from dh2urdf.transforms import trans

pytestmark = [
    pytest.mark.browser,
    pytest.mark.skipif(chromium() is None, reason="no Chromium: apt-get install chromium"),
]

START = np.radians([20.0, -105.0, 83.0, -51.0, -71.0, 22.0])


def test_page_says_which_arm_in_one_unit(shown):
    """Title and heading name arm and convention; units chosen once are in every tab."""
    _, visitor = shown(Robot.from_dh("ur5e"), START)
    assert visitor.page.title() == "ur5e: 6 joints, standard DH · dh2urdf"
    visitor.page.get_by_text("ur5e: 6 joints, standard DH", exact=True).wait_for()
    visitor.choose("Units", "mm, rad")
    visitor.page.get_by_text("elbow_joint [rad]").wait_for()
    visitor.tab("DH table")
    visitor.page.get_by_text("162.5", exact=True).wait_for()
    visitor.tab("IK")
    visitor.field("Target").click(force=True)
    visitor.page.get_by_text("q in rad · shoulder Left Right · elbow Up Down").wait_for()
    visitor.screenshot("view-millimetres-radians")


def test_row_is_explained_over_all_frames(shown):
    """With all frames shown a row draws its own once; noise is a zero that tells on hover."""
    view, visitor = shown(Robot.from_dh("ur5e"), START)
    visitor.field("DH frames").click(force=True)
    wait_for(lambda: view._frames.roots)
    visitor.tab("DH table")
    visitor.choose("Explain row", "4")
    noise = visitor.page.locator("span[title*='e−17']").first
    noise.wait_for()
    assert noise.inner_text() == "0"
    wait_for(lambda: [root.visible for root in view._frames.roots][3:5] == [False, False])
    visitor.screenshot("view-explain-row-frames")


def test_fault_in_the_text_takes_the_caret(shown):
    """The field is tall, and after a fault its selection is the word that is wrong."""
    view, visitor = shown(Robot.from_dh("ur5e"), START)
    visitor.tab("DH table")
    visitor.page.get_by_text("Edit the whole table").click()
    field = visitor.page.locator("textarea:visible")
    text = view._table.text.value
    field.fill(re.sub(r"0\.1333", "apple", text))
    wait_for(lambda: "apple" in view._table.text.value)
    visitor.button("Rebuild the arm").click()
    visitor.page.get_by_role("alert").filter(has_text="Nothing was changed").wait_for()
    selected = "e => e.value.slice(e.selectionStart, e.selectionEnd)"
    wait_for(lambda: field.evaluate(selected) == "apple")
    assert field.evaluate("e => e === document.activeElement")
    assert field.evaluate("e => e.scrollLeft") > 100
    assert field.bounding_box()["height"] >= 300
    visitor.screenshot("view-fault-in-text")


def test_target_is_typed_and_copied(shown):
    """A pose pasted into the field moves the arm; what is copied out is where it stands."""
    robot = Robot.from_dh("ur5e")
    view, visitor = shown(robot, START)
    visitor.context.grant_permissions(["clipboard-read", "clipboard-write"])
    T = robot.fk(START) @ trans(0.0, 0.04, -0.03)
    visitor.tab("IK")
    visitor.page.get_by_text("Target as text").click()
    visitor.choose("Written as", "4 × 4")
    text = str(T.tolist())
    visitor.page.locator("textarea:visible").fill(text)
    wait_for(lambda: view._ik.field.field.value == text)
    visitor.button("Set the target").click()
    wait_for(lambda: np.abs(view.q - START).max() > 0.0)
    np.testing.assert_allclose(view.robot.fk(view.q), T, atol=1e-8)
    visitor.screenshot("view-target-as-text")
    visitor.button("Copy").click()
    visitor.button("Copied").wait_for()
    copied = visitor.page.evaluate("navigator.clipboard.readText()")
    back = np.array([float(v) for v in copied.split()]).reshape(4, 4)
    np.testing.assert_allclose(back, T, atol=2e-8)


def test_lesson_goes_motion_by_motion(shown):
    """Next shows one motion more, in the scene and in words with the matrix so far."""
    view, visitor = shown(Robot.from_dh("ur5e"), START)
    visitor.tab("DH table")
    visitor.choose("Explain row", "4")
    for k in range(4):
        visitor.button("Next ›").click()
        wait_for(lambda k=k: view._table.step == k)
        visitor.frames(2)
        visitor.screenshot(f"view-lesson-{k}")
    visitor.page.get_by_text("motion 3 of 4: move along x₄ by a₄ = 0 m").wait_for()
    visitor.page.get_by_text("so far").wait_for()


def test_picture_and_page_are_saved(shown, tmp_path):
    """The scene as a PNG of its size, and the page of the arm as it stands."""
    view, visitor = shown(Robot.from_dh("planar_rr"), [0.5, 0.25], width=800, height=500)
    with visitor.page.expect_download() as download:
        visitor.button("Picture").click()
    download.value.save_as(tmp_path / "arm.png")
    head = (tmp_path / "arm.png").read_bytes()[:24]
    assert head[:8] == b"\x89PNG\r\n\x1a\n"
    camera = next(iter(view._server.get_clients().values())).camera
    assert int.from_bytes(head[16:20], "big") == camera.image_width
    with visitor.page.expect_download() as download:
        visitor.button("Page").click()
    assert download.value.suggested_filename == "planar_rr.html"
    download.value.save_as(tmp_path / "arm.html")
    assert '"start": [0.5, 0.25]' in (tmp_path / "arm.html").read_text(encoding="utf-8")
