"""The DH table beside the arm."""

import math
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from dh2urdf.dh import DHConvention, DHRow, DHTable, JointType
from dh2urdf.dh.print import degrees, step
from dh2urdf.dh.variables import moved_by, plus
from dh2urdf.drawing.colours import QUANTITY
from dh2urdf.figures.canvas import Canvas, text_size
from dh2urdf.figures.style import FAINT, INK, MUTED, plain
from dh2urdf.grids import number
from dh2urdf.transforms import Array

SIZE = 10.5
ROW = 25.0
GAP = 16.0
WIDEST = 9
"""Characters of a number from which it is rounded in the picture, with a note."""

KEYS = ("i", "theta", "d", "a", "alpha")


class Cell(NamedTuple):
    """Text of a cell and its colour."""

    text: str
    colour: str = INK


class DHPanel:
    """Cells of the table, measured, and drawn where the figure has room for them."""

    def __init__(
        self, table: DHTable, notes: list[str], key: list[tuple[str, str]] | None = None
    ) -> None:
        self.table, self.key = table, key or []
        self.rounded = False
        numbers = np.cumsum([row.is_joint for row in table.rows]).tolist()
        self.rows = [self._row(row, i) for row, i in zip(table.rows, numbers, strict=True)]
        j = "{i-1}" if table.convention is DHConvention.MODIFIED else "i"
        m = r"\,/\,\mathrm{m}"
        signs = ("$i$", r"$\theta_i$", f"$d_i{m}$", f"$a_{j}{m}$", rf"$\alpha_{j}$")
        colours = (QUANTITY.get(key, INK) for key in KEYS)
        self.header = list(map(Cell, signs, colours))
        self.title = f"{plain(table.name)}, {table.convention} DH"
        ends = {"frame 0 in base": table.base, "tool in the last frame": table.tool}
        notes = [f"{k}: {step(T)}" for k, T in ends.items() if not T.is_identity] + notes
        if self.rounded:
            notes.append("Long values are rounded to six digits here.")
        self.widths = [
            GAP + max(text_size(cell.text, SIZE)[0] for cell in column)
            for column in zip(self.header, *(r for r in self.rows if len(r) > 1), strict=True)
        ]
        self.notes = [line for note in notes for line in wrapped(note, self.width, SIZE - 2)]

    @property
    def width(self) -> float:
        """Width of the panel [pt]."""
        title = text_size(self.title, SIZE + 1, "bold")[0]
        names = [20.0 + text_size(name, SIZE - 2)[0] for _, name in self.key]
        return float(max(sum(self.widths), title, 230.0, *names))

    @property
    def height(self) -> float:
        """Height of the panel [pt]."""
        below = 14.0 * (len(self.notes) + len(self.key)) + (10.0 if self.key else 0.0)
        return 28.0 + ROW * (len(self.rows) + 1) + 14.0 + below

    def draw(self, canvas: Canvas, left: float, top: float) -> None:
        """Draw the panel below and right of a corner [pt]."""
        right = left + self.width
        canvas.text((left, top - 8), self.title, SIZE + 1, ha="left", weight="bold")
        y = top - 28.0
        _rule(canvas, left, right, y, 1.3)
        self._line(canvas, self.header, left, right, y - ROW / 2)
        _rule(canvas, left, right, y - ROW, 0.7)
        for k, row in enumerate(self.rows, 1):
            self._line(canvas, row, left, right, y - ROW * (k + 0.5))
        y -= ROW * (len(self.rows) + 1)
        _rule(canvas, left, right, y, 1.3)
        for k, note in enumerate(self.notes):
            canvas.text((left, y - 14.0 * (k + 1)), note, SIZE - 2, MUTED, ha="left")
        draw_key(canvas, left, y - 14.0 * len(self.notes) - 24.0, self.key)

    def _line(self, canvas: Canvas, row: list[Cell], left: float, right: float, y: float) -> None:
        if len(row) == 1:
            canvas.text((left, y), row[0].text, SIZE - 1, row[0].colour, ha="left")
            return
        spare = (right - left - sum(self.widths)) / len(KEYS)
        x = left
        for k, (cell, width) in enumerate(zip(row, self.widths, strict=True)):
            x += width + spare
            if k == 0:
                canvas.text((left + 8, y), cell.text, SIZE, cell.colour)
            else:
                size = SIZE + 1.5 if row is self.header else SIZE
                canvas.text((x - 4, y), cell.text, size, cell.colour, ha="right")

    def _row(self, row: DHRow, i: int) -> list[Cell]:
        if row.origin is not None:
            return [Cell(f"fixed step: {step(row.origin)}", MUTED)]
        slides, variable, constant = row.joint_type is JointType.PRISMATIC, "", 0.0
        if row.is_joint:
            joints = self.table.joint_map
            variable, constant = moved_by(joints, i - 1, row.sign, "q_{{{}}}".format, "-")
        theta = self._degrees(row.theta + (0.0 if slides else constant))
        d = self._number(row.d + (constant if slides else 0.0))
        if slides:
            d = plus(f"${variable}$", d)
        elif row.is_joint:
            theta = plus(f"${variable}$", theta if theta != "0°" else "0")
        a, alpha = self._number(row.a), self._degrees(row.alpha)
        cells = [Cell(str(i) if row.is_joint else "fixed")]
        for key, text in zip(KEYS[1:], (theta, d, a, alpha), strict=True):
            cells.append(Cell(text, FAINT if text in {"0", "0°"} else QUANTITY[key]))
        return cells

    def _degrees(self, angle: float) -> str:
        return f"{self._number(math.degrees(angle), degrees(angle))}°"

    def _number(self, value: float, text: str = "") -> str:
        """As it would be printed; if that is wide, six digits, at most seven decimals."""
        text = text or number(value)
        if len(text) > WIDEST:
            self.rounded, text = True, number(round(float(f"{value:.6g}"), 7) + 0.0)
        return text


def draw_key(canvas: Canvas, left: float, top: float, key: list[tuple[str, str]]) -> None:
    """Draw a column of (colour, name) below a height, each with a square in its colour."""
    for k, (colour, name) in enumerate(key):
        y = top - 14.0 * k
        corners = np.array([[0, -4], [8, -4], [8, 4], [0, 4]], float)
        canvas.polygon(corners + np.array([left, y]), colour)
        canvas.text((left + 14.0, y), name, SIZE - 2, ha="left")


def joint_values(q: Array, slides: Iterable[bool]) -> str:
    """``q = (30°, 40°, 250 mm)``."""
    cells = [
        f"{number(round(v * 1000, 3))} mm" if s else f"{number(round(math.degrees(v), 3))}°"
        for v, s in zip(q.tolist(), slides, strict=True)
    ]
    return f"$q$ = ({', '.join(cells)})"


def moved_sentence(shifts: Array) -> list[str]:
    """What was done to frames far from the arm, each moved by so much along its z [m]."""
    far = [
        f"{i} by {number(float(f'{s:.4g}'))}\N{NO-BREAK SPACE}m"
        for i, s in enumerate(shifts.tolist())
        if s
    ]
    if not far:
        return []
    return [
        f"Frames drawn on the arm, moved along their nearly parallel axes z: {', '.join(far)} "
        "(marked x\N{PRIME}, z\N{PRIME}; lengths measured out there are broken lines)."
    ]


def wrapped(text: str, width: float, size: float) -> list[str]:
    """A sentence cut into lines no wider than so many points."""
    lines, line = [], ""
    for word in text.split(" "):
        longer = f"{line} {word}".strip()
        if line and text_size(longer, size)[0] > width:
            lines.append(line)
            line = word
        else:
            line = longer
    return [*lines, line]


def _rule(canvas: Canvas, left: float, right: float, y: float, width: float) -> None:
    canvas.line(np.array([[left, y], [right, y]]), INK, width, solid_capstyle="butt")
