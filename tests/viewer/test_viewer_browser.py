"""The browser view in a real headless Chromium; screenshots land in artifacts/."""

import math
import socket
import urllib.request

import numpy as np
import pinocchio as pin
import pytest
from browser import Visitor, chromium, still, wait_for

import dh2urdf
from dh2urdf import DHTable, Robot

pytestmark = [
    pytest.mark.browser,
    pytest.mark.skipif(chromium() is None, reason="no Chromium: apt-get install chromium"),
]

START = np.radians([20.0, -105.0, 83.0, -51.0, -71.0, 22.0])


def test_page_comes_up_and_a_slider_moves_the_arm(shown):
    """A slider dragged in the page moves that joint of the arm and no other."""
    view, visitor = shown(Robot.from_dh("ur5e"), START)
    visitor.screenshot("view-joints")
    thumb = visitor.page.get_by_role("slider").first.bounding_box()
    x, y = thumb["x"] + thumb["width"] / 2, thumb["y"] + thumb["height"] / 2
    visitor.drag((x, y), (x + 40, y))
    wait_for(lambda: abs(view.q[0] - START[0]) > 0.3)
    np.testing.assert_allclose(view.q[1:], START[1:], atol=1e-12)
    readout = f"{view.robot.fk(view.q)[0, 3]:.6f}".rstrip("0").replace("-", "−")
    visitor.page.get_by_text(readout).wait_for()


def test_row_is_explained_with_values_and_case(shown):
    """Row 4 of a UR shows its case, its matrix and a translucent arm; none puts it away."""
    view, visitor = shown(Robot.from_dh("ur5e"), START)
    visitor.tab("DH table")
    visitor.choose("Explain row", "4")
    visitor.page.get_by_text("z₃ and z₄ intersect").wait_for()
    visitor.page.get_by_text(f"{math.cos(START[3]):.4f}").first.wait_for()
    wait_for(lambda: view._scene.translucent)
    visitor.screenshot("view-explain-row")
    visitor.choose("Explain row", "none")
    wait_for(lambda: not view._scene.translucent)


def test_target_is_dragged_and_branches_follow(shown):
    """The gizmo pulled along its z axis moves the tip there, all eight branches listed."""
    view, visitor = shown(Robot.from_dh("ur5e"), START, sharpness=0.4)
    visitor.tab("IK")
    visitor.field("Target").click(force=True)
    visitor.page.get_by_text("8 solutions.").wait_for()
    T = view.robot.fk(START)
    size = 0.22 * view.robot.chain.size
    grip = T[:3, 3] + 0.35 * size * T[:3, 2]
    visitor.drag(visitor.pixel(grip), visitor.pixel(grip + 0.12 * T[:3, 2]))
    wait_for(lambda: np.abs(view.q - START).max() > 0.0)
    still(lambda: view.q)
    moved = view.robot.fk(view.q)[:3, 3] - T[:3, 3]
    assert 0.05 < moved @ T[:3, 2] < 0.25
    np.testing.assert_allclose(moved - (moved @ T[:3, 2]) * T[:3, 2], 0.0, atol=2e-3)
    np.testing.assert_allclose(view.robot.fk(view.q)[:3, :3], T[:3, :3], atol=1e-6)
    found = view._ik.answer
    np.testing.assert_allclose(
        view.robot.fk(found.q), np.broadcast_to(view._ik._T, (len(found.q), 4, 4)), atol=1e-8
    )


def test_line_of_the_branch_table_moves_the_arm(shown):
    """A click on a solution's line takes the arm there; the tip stays where it is."""
    view, visitor = shown(Robot.from_dh("ur5e"), START)
    visitor.tab("IK")
    visitor.field("Target").click(force=True)
    visitor.page.get_by_text("8 solutions.").wait_for()
    visitor.screenshot("view-branches")
    T = view.robot.fk(view.q)
    line = visitor.page.locator("[data-ik=branches] tbody tr").nth(4)
    line.click()
    wait_for(lambda: np.abs(view.q - START).max() > 0.5)
    np.testing.assert_allclose(view.q, view._ik.answer.q[4], atol=1e-12)
    np.testing.assert_allclose(view.robot.fk(view.q), T, atol=1e-9)


def test_edited_cell_rebuilds_the_arm_and_the_urdf_is_saved(shown, tmp_path):
    """A length typed into the table is in the arm and in the URDF that the page hands out."""
    view, visitor = shown(Robot.from_dh("planar_rr"))
    visitor.tab("DH table")
    visitor.choose("Explain row", "2")
    visitor.page.get_by_text("Edit the row").click()
    visitor.fill("a₂ [m]", "1.25*2", view._table.cells["a"])
    visitor.button("Apply to the row").click()
    visitor.page.get_by_text("The arm was rebuilt").wait_for()
    np.testing.assert_allclose(view.robot.fk([0.0, 0.0])[0, 3], 3.5)
    visitor.screenshot("view-edited-table")
    with visitor.page.expect_download() as download:
        visitor.button("Save the URDF").click()
    saved = tmp_path / "saved.urdf"
    download.value.save_as(saved)
    model = pin.buildModelFromUrdf(str(saved))
    data = model.createData()
    pin.framesForwardKinematics(model, data, np.zeros(2))
    tip = data.oMf[model.getFrameId("tool0")].translation
    np.testing.assert_allclose(tip, [3.5, 0.0, 0.0], atol=1e-12)
    visitor.page.get_by_role("status").filter(has_text="largest difference").wait_for()


def test_malformed_edit_says_so_and_changes_nothing(shown):
    """A cell that is no length leaves the arm as it was and names the cell in the page."""
    view, visitor = shown(Robot.from_dh("planar_rr"))
    before = view.robot
    visitor.tab("DH table")
    visitor.choose("Explain row", "1")
    visitor.page.get_by_text("Edit the row").click()
    visitor.fill("a₁ [m]", "one metre", view._table.cells["a"])
    visitor.button("Apply to the row").click()
    alert = visitor.page.get_by_role("alert").filter(has_text="Nothing was changed")
    alert.wait_for()
    assert "a₁" in alert.inner_text()
    assert "'one metre'" in alert.inner_text()
    assert view.robot is before
    visitor.screenshot("view-malformed-edit")


def test_text_in_a_name_is_shown_not_run(shown):
    """HTML in a table's joint names is text in the page."""
    evil = "<img src=x onerror=document.title='owned'>"
    row = dh2urdf.DHRow(a=1.0, name=evil)
    _, visitor = shown(Robot.from_dh(DHTable((row,), "standard", "odd")))
    visitor.tab("DH table")
    visitor.choose("Explain row", "1")
    visitor.tab("IK")
    assert visitor.page.title() != "owned"


def test_second_visitor_sees_and_moves_the_same_arm(shown, browser):
    """What one page does, the other shows, both ways."""
    view, first = shown(Robot.from_dh("planar_rr"), [0.1, 0.2], width=600, height=420)
    second = Visitor(browser, view, width=600, height=420)
    try:
        second.button("Zero").click()
        wait_for(lambda: np.abs(view.q).max() == 0.0)
        first.page.get_by_text("1.7", exact=True).first.wait_for()
        view.q = [math.pi / 2, 0.0]
        for visitor in (first, second):
            wait_for(lambda v=visitor: "90" in v.values())
    finally:
        second.close()


def test_stopped_server_lets_its_port_go(shown):
    """After stop nobody listens, and the page says that it lost the connection."""
    view, visitor = shown(Robot.from_dh("planar_rr"))
    with urllib.request.urlopen(view.url) as page:
        assert page.status == 200
    view.stop()
    port = int(view.url.rpartition(":")[2])
    with socket.socket() as probe:
        assert probe.connect_ex(("127.0.0.1", port)) != 0
    visitor.page.locator(".mantine-Loader-root:visible").wait_for()
    visitor.screenshot("view-stopped")


def test_seven_joints_move_through_their_self_motion(shown):
    """The slider of the held joint moves the arm and leaves the tip where it is."""
    robot = Robot.from_dh("franka_fr3")
    q = np.array([0.1, -0.4, 0.2, -2.0, 0.3, 1.8, 0.5])
    view, visitor = shown(robot, q)
    T = robot.fk(q)
    visitor.tab("IK")
    held = view._ik.redundancy.index
    value = math.degrees(q[held]) + 15.0
    box = visitor.field("Value [°]")
    box.fill(f"{value:.1f}")
    box.press("Enter")
    wait_for(lambda: abs(view.q[held] - math.radians(value)) < 2e-3, 60)
    np.testing.assert_allclose(view.robot.fk(view.q), T, atol=1e-8)
    visitor.screenshot("view-self-motion")
