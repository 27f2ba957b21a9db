"""What the panel says: one unit in all tabs, noise as zero, letters explained, faults marked."""

import math
import re
from decimal import Decimal

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from dh2urdf import DHConvention, DHRow, DHTable, JointType, Robot
from dh2urdf.dh_io import Kind, Units, parse_cell
from dh2urdf.drawing.readings import TINY, measured, reading
from dh2urdf.viewer.options import UNITS
from dh2urdf.viewer.tabs import html
from dh2urdf.viewer.tabs.branches import branch_letters

KINDS = st.sampled_from([Kind.LENGTH, Kind.ANGLE])
CHOSEN = st.sampled_from(list(UNITS.values()))
VALUES = st.one_of(st.floats(-10, 10), st.sampled_from([6.1e-17, -1e-12, math.pi / 2, 0.1333]))


@given(VALUES, KINDS, CHOSEN)
def test_readings_keep_every_digit_on_hover(value, kind, units):
    """The exact text reads back as the same float, and what is shown is near it, or noise."""
    read = reading(value, kind, units)
    assert parse_cell(read.exact.replace("−", "-"), kind, units) == value
    shown = parse_cell(read.text.replace("−", "-"), kind, units)
    assert abs(shown - value) <= max(TINY, 1e-5)
    assert len(read.text) <= 11
    if abs(value) < TINY:
        assert read.text == "0"
        assert read.is_noise == (value != 0)


def test_typed_numbers_are_shown_as_typed():
    """0.15005 m stays, 90 degrees are 90, and an angle's sign stands close to it."""
    assert reading(0.15005, Kind.LENGTH).text == "0.15005"
    assert measured(math.pi / 2, Kind.ANGLE) == "90°"
    assert measured(-0.1333, Kind.LENGTH, Units("mm", "rad")) == "−133.3 mm"


def test_noise_is_zero_with_the_exact_number_on_hover():
    """cos(pi/2) in a matrix is a faint 0 that tells 6.1e−17; an exact zero tells nothing."""
    T = np.diag([math.cos(math.pi / 2), 1.0, 1.0, 1.0])
    cells = re.findall(r"<td[^>]*>(.*?)</td>", html.matrix(T, "T", UNITS["m, °"]))
    assert 'title="6.123233995736766e−17"' in cells[0]
    assert ">0</span>" in cells[0]
    assert "title" not in cells[1]


@pytest.fixture
def view():
    """An arm with both kinds of joints, a base, a tool and a fixed step."""
    rows = (
        DHRow(d=0.3, alpha=math.pi / 2, name="turn"),
        DHRow(joint_type=JointType.PRISMATIC, d=0.25, a=1e-17, name="slide", lower=0, upper=0.5),
    )
    table = DHTable(rows, DHConvention.MODIFIED, "mixed")
    with Robot.from_dh(table).view([0.5, 0.1], port=0) as shown:
        yield shown


def test_units_are_chosen_once_for_all_tabs(view):
    """In millimetres and radians every label says so, and every number follows."""
    view._table.choose(2)
    view._explain(2)
    view._options.choice.value = "mm, rad"
    view._switch_units()
    labels = [slider.label for slider in view._joints.sliders]
    assert labels == ["turn [rad]", "slide [mm]"]
    assert view._joints.sliders[0].value == pytest.approx(0.5, abs=1e-4)
    assert view._joints.sliders[1].value == pytest.approx(100.0)
    assert view._table.cells["d"].value == "250"
    assert view._table.cells["upper"].label == "upper [mm]"
    assert view._table.cells["alpha"].label == "α₁ [rad]"
    assert "units: {length: mm, angle: rad}" in view._table.text.value
    assert "d₂ = q₂ + 250 mm" in view._table.words.content
    for text in (view._table.shown.content, view._joints.readout.content):
        assert "[m]" not in text
        assert "°" not in text
    view._table._try(view._table._with_row_cells)
    assert view.robot.table.joints[1].d == 0.25
    np.testing.assert_array_equal(view.q, [0.5, 0.1])


def test_numbers_typed_in_other_units_mean_these_units(view):
    """120 typed as d in millimetres is 0.12 m in the arm."""
    view._table.choose(2)
    view._options.choice.value = "mm, °"
    view._switch_units()
    view._table.cells["d"].value = "120"
    view._table._try(view._table._with_row_cells)
    assert view.robot.table.joints[1].d == float(Decimal("0.12"))


def test_arm_and_convention_are_named(view):
    """The page's title and the panel's heading name the arm, a rebuilt one too."""
    assert "mixed: 2 joints, modified DH" in view._titled.content
    view._edited(DHTable((DHRow(a=1.0),), "standard", "other"))
    assert "other: 1 joint, standard DH" in view._titled.content


def test_letters_of_the_branches_are_explained():
    """Each initial of the column is a bold letter of its word, only those that occur."""
    branch = ("shoulder left, wrist no flip", "shoulder right, wrist no flip")
    assert branch_letters(branch) == ["shoulder <b>L</b>eft <b>R</b>ight", "wrist <b>N</b>o flip"]
    assert branch_letters(("", "")) == []


def test_explained_row_draws_its_frames_once():
    """The set of all frames leaves out those of the row and those that stand in them."""
    with Robot.from_dh("puma560").view([0.3, 0.4, -0.2, 0.6, 0.7, 0.0], port=0) as shown:
        shown._options.frames.value = True
        shown._table.choose(5)
        shown._explain(5)
        seen = [root.visible for root in shown._frames.roots]
        assert seen == [True, True, True, True, False, False, False]
        written = ", ".join(label.text for label in shown._frames.labels if label.visible)
        assert sorted(written.split(", ")) == sorted(f"{a}{i}" for a in "xz" for i in "₀₁₂₃")
        shown._table.choose(0)
        shown._explain(0)
        assert all(root.visible for root in shown._frames.roots)


def test_fault_in_the_text_is_pointed_at(view):
    """The note quotes the line with its caret in one font, and the field's caret goes there."""
    tab = view._table
    tab.text.value = re.sub(r"d:\s+0.3", "d: nought", tab.text.value)
    tab._try(tab._with_text)
    line, column = map(int, re.search(r"table:(\d+):(\d+):", tab.note.content).groups())
    assert tab.text.value.split("\n")[line - 1][column - 1 :].startswith("nought")
    assert f"&quot;line&quot;: {line}, &quot;column&quot;: {column}" in tab.note.content
    assert 'white-space:pre">' in tab.note.content


def test_quoted_lines_begin_near_their_caret():
    """A fault far to the right of a long line is in sight in the narrow panel."""
    text = f"table:5:60: wrong\n    5 | {'x' * 60}apple, a: 0\n      | {' ' * 60}^\n  hint: no"
    head, line, caret, hint = html.narrowed(text).split("\n")
    assert line.index("apple") == caret.index("^") < 40
    assert (head, hint) == ("table:5:60: wrong", "  hint: no")
    assert html.narrowed("plain | text\n  no caret") == "plain | text\n  no caret"
