"""A map of reach in a real headless Chromium; the screenshot lands in artifacts/."""

import pytest
from browser import ARTIFACTS, wait_for

from dh2urdf import Robot
from dh2urdf.workspace import reach_map

pytest.importorskip("xarray")
pytestmark = pytest.mark.browser


def test_the_reach_is_seen_around_the_arm(shown):
    """The panel has the folder, and the picture changes where the surface is opened."""
    robot = Robot.from_dh("puma560")
    view, visitor = shown(robot, [0.3, 0.6, -0.4, 0.0, 0.5, 0.0])
    view.show_reach(reach_map(robot, step=0.1, orientations=30))
    half = picture(visitor, "view-reach")
    visitor.page.get_by_label("Half of it").click(force=True)
    wait_for(lambda: not view._reach.half.value)
    assert picture(visitor, "view-reach-whole") != half


def picture(visitor, name):
    """The page once the folder is there and it stands still."""
    visitor.page.get_by_text("Half of it").wait_for()
    visitor.screenshot(name)
    return (ARTIFACTS / f"{name}.png").read_bytes()
