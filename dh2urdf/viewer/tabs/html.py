"""Small pieces of HTML for the panel; everything that is not ours is escaped."""

import re
from collections.abc import Sequence
from functools import reduce
from html import escape

import numpy as np

from dh2urdf.dh import DHConvention, DHRow, DHTable, JointType
from dh2urdf.dh.row import Origin
from dh2urdf.dh.variables import moved_by, plus
from dh2urdf.dh_io import Kind, Units
from dh2urdf.drawing.colours import QUANTITY
from dh2urdf.drawing.lesson import Motion
from dh2urdf.drawing.readings import DIGITS, Reading, reading, sign_of
from dh2urdf.transforms import Array, matrix_to_rpy
from dh2urdf.viewer.arm_scene import quaternions

STYLE = "font-size:12px;line-height:1.5;padding:2px 12px 6px;overflow-x:auto;"
CELL = "text-align:right;padding:1px 7px;white-space:nowrap;"
NUMBERS = "font-variant-numeric:tabular-nums;"
FAINT = "#b0b0b0"
MARKED = "background:#e6eef7;font-weight:600;"
KINDS_OF = {"theta": Kind.ANGLE, "d": Kind.LENGTH, "a": Kind.LENGTH, "alpha": Kind.ANGLE}
SYMBOLS = {"theta": "θ", "d": "d", "a": "a", "alpha": "α"}
QUOTED = re.compile(r"\s*\d* \| ")
"""Lines of a message that quote a file, or stand with a caret under one."""

CARET = re.compile(r"(?m)^(\s*\d+ \| .*\n)(\s*\| (?P<before> *)\^)")

BEFORE = 22
"""Characters that are shown before the place of a fault."""

CODE = "font-family:ui-monospace,'DejaVu Sans Mono',monospace;white-space:pre"
NOTES = {"info": ("#46505f", ""), "good": ("#1c7c45", "✓ "), "bad": ("#b3261e", "✗ ")}


def message(text: str, kind: str = "info") -> str:
    """A note in the panel: plain, good or bad; lines are kept."""
    colour, mark = NOTES[kind]
    role = "alert" if kind == "bad" else "status"
    lines = [
        f'<span style="{CODE}">{escape(line)}\n</span>'
        if QUOTED.match(line)
        else f"{escape(line)}\n"
        for line in narrowed(text).split("\n")
    ]
    style = f"{STYLE}color:{colour};white-space:pre-wrap"
    return f'<div role="{role}" style="{style}">{mark}{"".join(lines)}</div>'


def narrowed(text: str) -> str:
    """A message whose quoted lines begin near the place their caret points at."""
    return CARET.sub(lambda found: "".join(_cut(line, found) for line in found.groups()[:2]), text)


def _cut(line: str, found: re.Match[str]) -> str:
    head, mark, quoted = line.partition("| ")
    return f"{head}{mark}{quoted[max(0, len(found['before']) - BEFORE) :]}"


def number(read: Reading, text: str = "") -> str:
    """A number whose digits that are not shown appear on hover; zeros are faint.

    ``text`` is shown instead, such as the number behind a variable.
    """
    hover = f' title="{read.exact}"' if read.exact != read.text else ""
    line = "border-bottom:1px dotted #888;" if read.is_noise else ""
    faint = f"color:{FAINT};" if (text or read.text) == "0" else ""
    style = f' style="{faint}{line}"' if faint or line else ""
    return f"<span{hover}{style}>{escape(text or read.text)}</span>"


def pose(T: Array, what: str, units: Units) -> str:
    """A pose: xyz, rpy and the quaternion with w last."""
    w, x, y, z = quaternions(T[:3, :3])
    rows = (
        ("xyz", Kind.LENGTH, T[:3, 3]),
        ("rpy", Kind.ANGLE, matrix_to_rpy(T)),
        ("quaternion xyzw", Kind.NUMBER, (x, y, z, w)),
    )
    body = ""
    for name, kind, values in rows:
        digits = 6 if kind is Kind.NUMBER else DIGITS[units.of(kind)]
        readings = [reading(v, kind, units, digits) for v in values]
        sign = sign_of(units, kind)
        head = f"{name} [{sign}]" if sign else name
        cells = "".join(f'<td style="{CELL}{NUMBERS}">{number(r)}</td>' for r in readings)
        body += f'<tr><td style="{CELL}text-align:left;color:#6b7280">{head}</td>{cells}</tr>'
    return f'<div style="{STYLE}"><b>{escape(what)}</b><table>{body}</table></div>'


def matrix(T: Array, name: str, units: Units) -> str:
    """A (4, 4) matrix, four digits after the point, lengths in their unit."""
    body = ""
    for i, row in enumerate(T.tolist()):
        kinds = [Kind.NUMBER] * 3 + [Kind.LENGTH if i < 3 else Kind.NUMBER]
        digits = [4 if units.of(kind) != "mm" else 2 for kind in kinds]
        readings = map(reading, row, kinds, [units] * 4, digits)
        body += "<tr>" + "".join(f'<td style="{CELL}{NUMBERS}">{number(r)}</td>' for r in readings)
        body += "</tr>"
    border = "border-left:1.5px solid #888;border-right:1.5px solid #888;border-radius:4px"
    unit = f' <span style="color:#6b7280">(lengths in {units.length})</span>'
    return f'<div style="{STYLE}"><b>{name}</b> ={unit}<table style="{border}">{body}</table></div>'


def lesson(said: str, i: int, steps: Sequence[Motion], count: int, units: Units) -> str:
    """What motion was made, the product that it belongs to, and the matrix so far."""
    styles = ["font-weight:700" if k < count else f"color:{FAINT}" for k in range(len(steps))]
    factors = [
        f'<span style="{style}">{escape(motion.factor)}</span>'
        for motion, style in zip(steps, styles, strict=True)
    ]
    T = reduce(np.matmul, [motion.T for motion in steps[:count]], np.eye(4))
    pair = f"T<sub>{i - 1},{i}</sub>"
    product = f'<div style="{STYLE}">{pair} = {" · ".join(factors)}</div>'
    return message(said) + product + matrix(T, pair if count == len(steps) else "so far", units)


def table(dh: DHTable, row: int, units: Units) -> str:
    """The DH table, quantities in their colours, row ``row`` marked, 0 for none."""
    modified = dh.convention is DHConvention.MODIFIED
    head = f'<th style="{CELL}">i</th>'
    for key, kind in KINDS_OF.items():
        index = "i−1" if modified and key[0] == "a" else "i"
        name = f"{SYMBOLS[key]}<sub>{index}</sub> [{sign_of(units, kind)}]"
        head += f'<th style="{CELL}color:{QUANTITY[key]}">{name}</th>'
    body, joint = "", 0
    for given in dh.rows:
        joint += given.is_joint
        marked = MARKED if given.is_joint and joint == row else ""
        body += f'<tr style="{marked}">{_cells(dh, given, joint, units)}</tr>'
    return (
        f'<div style="{STYLE}"><table style="border-collapse:collapse" data-dh="table">'
        f'<thead><tr style="border-bottom:1px solid #999">{head}</tr></thead>'
        f"<tbody>{body}</tbody></table></div>"
    )


def _cells(dh: DHTable, row: DHRow, i: int, units: Units) -> str:
    """Cells of one row; a step that DH motions cannot make is said in words."""
    first = f'<td style="{CELL}">{i if row.is_joint else "fixed"}</td>'
    if row.origin is not None:
        return f'{first}<td colspan="4" style="{CELL}">{_step(row.origin, units)}</td>'
    moved, variable, constant = "", "", 0.0
    if row.is_joint:
        moved = "d" if row.joint_type is JointType.PRISMATIC else "theta"
        variable, constant = moved_by(dh.joint_map, i - 1, row.sign)
    cells = first
    for key, kind in KINDS_OF.items():
        read = reading(getattr(row, key) + constant * (key == moved), kind, units)
        text = plus(variable, read.text) if key == moved else ""
        cells += f'<td style="{CELL}{NUMBERS}color:{QUANTITY[key]}">{number(read, text)}</td>'
    return cells


def _step(origin: Origin, units: Units) -> str:
    """A fixed step in words, in the units chosen."""
    parts = []
    for name, kind, values in (("xyz", Kind.LENGTH, origin.xyz), ("rpy", Kind.ANGLE, origin.rpy)):
        numbers = ", ".join(number(reading(v, kind, units)) for v in values)
        parts.append(f"{name} ({numbers}) {sign_of(units, kind)}")
    return ", ".join(parts if any(origin.rpy) else parts[:1])
