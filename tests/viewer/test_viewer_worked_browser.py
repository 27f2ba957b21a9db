"""The worked solution in a real headless Chromium; pictures in artifacts/."""

import numpy as np
import pytest
from browser import chromium, wait_for

from dh2urdf import Robot

pytestmark = [
    pytest.mark.browser,
    pytest.mark.skipif(chromium() is None, reason="no Chromium: apt-get install chromium"),
]

START = np.array([0.4, -0.9, 0.5, 0.3, -0.6, 0.2])


def test_solution_is_walked_step_by_step(shown):
    """Next goes through the steps; a step chosen says its numbers and draws its triangle."""
    view, visitor = shown(Robot.from_dh("denso_vs6556"), START)
    visitor.tab("Worked solution")
    visitor.page.get_by_text("Choose a step, or Next").wait_for()
    for k in range(1, 4):
        visitor.button("Next ›").click()
        wait_for(lambda k=k: view._worked.step == k)
    visitor.page.get_by_text("o_c = o - d_6 R e_3").wait_for()
    visitor.choose("Step", "6. theta_3: the elbow")
    visitor.page.get_by_text("bends either way").wait_for()
    wait_for(lambda: {m.label for m in view._step_scene.marks} == {"a_2", "l_3", "r_c", "theta_3"})
    visitor.frames(3)
    visitor.screenshot("view-worked-elbow")
    visitor.choose("Step", "4. theta_1: which way the arm faces")
    wait_for(lambda: "theta_1" in {m.label for m in view._step_scene.marks})
    visitor.frames(3)
    visitor.screenshot("view-worked-theta-1")
    visitor.choose("Step", "8. What is left of the orientation")
    wait_for(lambda: {m.kind for m in view._step_scene.marks} == {"frame"})
    visitor.frames(3)
    visitor.screenshot("view-worked-wrist")
    visitor.choose("Step", "none")
    wait_for(lambda: view._step_scene.marks == ())
