"""Hostile edits in the browser view: the arm is rebuilt, or one message is in the page."""

import atexit
from functools import cache
from types import SimpleNamespace

import numpy as np
from hostile import hostile
from hypothesis import strategies as st

from dh2urdf import Robot
from dh2urdf.transforms import trans
from dh2urdf.viewer.tabs.table_tab import new_table

SENT = []
CLIENT = SimpleNamespace(send_file_download=lambda name, data, **_: SENT.append((name, data)))
EVENT = SimpleNamespace(client=CLIENT)
TEXTS = """
0 1 -1 90 -90 45 0.5 pi/2 400mm 90deg 1e-9 1e-300 1e9 -1e9 1e10 1e42 -1e42 1e62 1e308 1e400
1e9999999 nan inf -inf 9**9**9 (((( q1 theta_1 1_0 ٣ 1,5 x 1/0 sqrt(-1) 0x1F 1e5 57.3e5 1e-320
360 7200
"""
CELLS = st.one_of(st.sampled_from([*TEXTS.split(), "", " ", "\ud800", "\0"]), st.text(max_size=5))
KEYS = ("theta", "d", "a", "alpha", "lower", "upper")
EDITS = st.one_of(
    st.tuples(st.sampled_from(KEYS), CELLS),
    st.tuples(st.just("both"), st.tuples(CELLS, CELLS)),
    st.tuples(st.just("joint_type"), st.sampled_from(["revolute", "prismatic"])),
    st.tuples(st.just("sign"), st.sampled_from(["+1", "-1"])),
    st.tuples(st.just("rows"), st.sampled_from(["Add below", "Remove"])),
    st.tuples(st.just("row"), st.integers(0, 4)),
    st.tuples(st.just("text"), st.tuples(CELLS, CELLS)),
    st.tuples(st.just("slide"), st.floats()),
    st.tuples(st.sampled_from(["save", "frames", "solve"]), st.booleans()),
)


@cache
def shown():
    """One view for all edits, stopped at the end."""
    view = Robot.from_dh(new_table()).view(port=0)
    atexit.register(view.stop)
    return view


def press(view, key, value):
    """Make one edit as a visitor would."""
    tab = view._table
    if key in ("row", "rows", "joint_type", "sign", "both", *KEYS) and not tab.row:
        tab.choose(1)
        view._explain(1)
    if key == "row":
        tab.choose(min(value, tab.table.n))
        view._explain(tab.row)
    elif key == "rows":
        tab.rows.value = value
        tab._try(tab._with_rows)
    elif key == "text":
        old, new = value
        tab.text.value = tab.text.value.replace(old or "0", new, 1)[:2_000_000]
        tab._try(tab._with_text)
    elif key == "slide":
        slider = view._joints.sliders[0]
        view._joints._slid(SimpleNamespace(client=CLIENT, target=SimpleNamespace(value=value)), 0)
        assert slider.min <= slider.value <= slider.max
    elif key == "save":
        tab._save_urdf(EVENT)
        tab._save_table(EVENT)
    elif key == "frames":
        view._options.frames.value = value
        view._switch_frames()
    elif key == "solve":
        view._ik.solve(view.robot.fk(view.q) @ trans(0.1 * value, 0, 0), follow=True)
    else:
        pairs = zip(("lower", "upper"), value, strict=True) if key == "both" else [(key, value)]
        for name, text in pairs:
            tab.cells[name].value = text
        tab._try(tab._with_row_cells)


@hostile(edits=st.lists(EDITS, min_size=1, max_size=5))
def test_hostile_edits_rebuild_the_arm_or_say_what_is_wrong(edits):
    """No exception and no warning; the arm shown is always a whole one."""
    view = shown()
    if view.robot.n > 6:
        view._edited(new_table())
    for key, value in edits:
        before = view.robot
        press(view, key, value)
        note = view._table.note.content
        assert view.robot is before or 'role="alert"' not in note
        assert np.isfinite(view.robot.fk(view.q)).all()
        assert len(view._joints.sliders) == view.robot.n == len(view.q)
        assert view.robot.table == view._table.table
