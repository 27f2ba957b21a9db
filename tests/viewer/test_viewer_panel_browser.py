"""The panel in a real headless Chromium: names, units, faults marked; pictures in artifacts/."""

import re

import numpy as np
import pytest
from browser import chromium, wait_for

from dh2urdf import Robot

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
