"""Edits of a visitor in the browser view."""

import atexit
from functools import cache
from pathlib import Path
from types import SimpleNamespace

import numpy as np

from dh2urdf import Robot
from dh2urdf.transforms import trans
from dh2urdf.viewer.tabs.table_tab import new_table
from tests.fuzz.door import Door
from tests.fuzz.guard import unwatched

CLIENT = SimpleNamespace(send_file_download=lambda name, data, **_: None)
CELLS = ("theta", "d", "a", "alpha", "lower", "upper")
SEEDS = """
theta pi/2
a 400mm
alpha -90
d 0.1;rows Add below
joint_type prismatic;upper 400mm
sign -1;lower -1
row 1;rows Remove
text 0.5=1
slide 0.3;save 1
frames 1;solve 1
"""


@cache
def _shown():
    """One view for all edits, stopped at the end."""
    with unwatched():
        view = Robot.from_dh(new_table()).view(port=0)
    atexit.register(view.stop)
    return view


def press(view, key: str, value: str) -> None:
    """Make one edit as a visitor would; a word that names none is none."""
    tab = view._table
    if key in ("row", "rows", "joint_type", "sign", *CELLS) and not tab.row:
        tab.choose(1)
        view._explain(1)
    if key in CELLS:
        tab.cells[key].value = value
        tab._try(tab._with_row_cells)
    elif key in ("joint_type", "sign") and value in ("revolute", "prismatic", "+1", "-1"):
        if value in tab.cells[key].options:
            tab.cells[key].value = value
            tab._try(tab._with_row_cells)
    elif key == "row" and value.isdecimal() and value.isascii():
        tab.choose(min(int(value[:6]), tab.table.n))
        view._explain(tab.row)
    elif key == "rows" and value in ("Add below", "Remove"):
        tab.rows.value = value
        tab._try(tab._with_rows)
    elif key == "text":
        old, _, new = value.partition("=")
        tab.text.value = tab.text.value.replace(old or "0", new, 1)[:2_000_000]
        tab._try(tab._with_text)
    elif key == "slide" and (number := _number(value)) is not None:
        slider = view._joints.sliders[0]
        event = SimpleNamespace(client=CLIENT, target=SimpleNamespace(value=number))
        view._joints._slid(event, 0)
        assert slider.min <= slider.value <= slider.max
    elif key == "save":
        tab._save_urdf(SimpleNamespace(client=CLIENT))
        tab._save_table(SimpleNamespace(client=CLIENT))
    elif key == "frames":
        view._options.frames.value = value == "1"
        view._switch_frames()
    elif key == "solve":
        step = 0.1 * (value == "1")
        view._ik.solve(view.robot.fk(view.q) @ trans(step, 0, 0), follow=True)


def _number(text: str) -> float | None:
    try:
        return float(text)
    except ValueError:
        return None


def edit(data: bytes, _: Path) -> None:
    """Each edit rebuilds the arm or says what is wrong; the arm shown is always a whole one."""
    view = _shown()
    if view.robot.n > 6:
        view._edited(new_table())
    for line in data.decode("utf-8", "surrogateescape").split(";")[:5]:
        key, _, value = line.strip().partition(" ")
        before = view.robot
        press(view, key, value)
        note = view._table.note.content
        assert view.robot is before or 'role="alert"' not in note
        assert np.isfinite(view.robot.fk(view.q)).all()
        assert len(view._joints.sliders) == view.robot.n == len(view.q)
        assert view.robot.table == view._table.table


DOORS = [
    Door("edits", edit, ("edits",), tuple(line.encode() for line in SEEDS.strip().split("\n")))
]
