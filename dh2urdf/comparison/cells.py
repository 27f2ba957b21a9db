"""Two tables cell by cell: which differ, and what each does to the tool."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from dh2urdf.comparison.relation import CONFIGURATIONS, poses
from dh2urdf.conversions.chains import configurations
from dh2urdf.conversions.write import dh_to_chain
from dh2urdf.dh import DHConvention, DHRow, DHTable, Origin
from dh2urdf.dh.print import step
from dh2urdf.exceptions import TableError
from dh2urdf.grids import number
from dh2urdf.transforms import Array, pose_error, rotation_angle

Value = float | str | Origin | None

ANGLES = ("theta", "alpha")
PARAMETERS = ("theta", "d", "a", "alpha")


class Cell(NamedTuple):
    """A cell of two tables; row None for what is said of a table as a whole."""

    row: int | None
    quantity: str
    a: Any
    b: Any


@dataclass(frozen=True)
class Difference:
    """Something that the arms do not share.

    Parameters
    ----------
    row : int or None
        Row of the table, fixed ones included, counted from 1; None for the table as a whole.
    quantity : str
        ``theta``, ``d``, ``a``, ``alpha``, ``sign``, ``type``, ``step`` (of a fixed row),
        ``base``, ``tool``, ``convention``, ``joints``, or ``axis`` where no cell can be named;
        ``mimic``, ``multiplier``, ``offset`` or ``coupling`` of a joint that values move otherwise.
    a, b : float, str or Origin
        What it is in A and in B, in [rad] and [m].
    tool_error, tool_turn : float
        How far [m] and by how much [rad] it takes the tool of A away at q = 0.
    largest_error, largest_turn : float
        The most that it does over all configurations that were looked at.
    rewritten : bool
        True of values of both tables in the same frames, which need not stand in either file.
    """

    row: int | None
    quantity: str
    a: Value
    b: Value
    tool_error: float = 0.0
    tool_turn: float = 0.0
    largest_error: float = 0.0
    largest_turn: float = 0.0
    rewritten: bool = False

    def __str__(self) -> str:
        where = f"row {self.row}: " if self.row else ""
        if self.quantity == "axis":
            return f"{where}the axes before it agree; from this one on they lie otherwise"
        first, second = _shown(self.quantity, self.a, self.b)
        text = f"{where}{self.quantity} {first} in A, {second} in B"
        text += " (both rewritten in the same frames)" if self.rewritten else ""
        effect = _effect(self.tool_error, self.tool_turn)
        if effect:
            return f"{text}; the tool is {effect} off at q = 0"
        effect = _effect(self.largest_error, self.largest_turn)
        return f"{text}; the tool is up to {effect} off, not at q = 0" if effect else text


def _shown(quantity: str, a: Value, b: Value) -> tuple[str, str]:
    """Two values, with as many digits as tell them apart."""
    if isinstance(a, Origin) and isinstance(b, Origin):
        return tuple("none" if o.is_identity else step(o) for o in (a, b))  # type: ignore[return-value]
    if not (isinstance(a, float) and isinstance(b, float)):
        return str(a), str(b)
    for digits in range(6, 18):
        if quantity in ANGLES:
            short = [number(float(f"{math.degrees(v):.{digits}g}")) + "°" for v in (a, b)]
        else:
            unit = "" if quantity == "sign" else " m"
            short = [number(float(f"{v:.{digits}g}")) + unit for v in (a, b)]
        if short[0] != short[1]:
            break
    return short[0], short[1]


def _effect(distance: float, angle: float) -> str:
    far = f"{number(float(f'{distance:.3g}'))} m" if distance > 1e-12 else ""
    turned = f"{number(float(f'{math.degrees(angle):.3g}'))}°" if angle > 1e-12 else ""
    return " and ".join(filter(None, (far, turned)))


def differing(a: DHTable, b: DHTable, tolerance: float) -> list[Cell] | None:
    """Cells that differ by more than a tolerance [rad and m]; None of tables of other rows."""
    if len(a.rows) != len(b.rows):
        return None
    whole = [("convention", str(a.convention), str(b.convention)), ("base", a.base, b.base)]
    cells = [Cell(None, *triple) for triple in (*whole, ("tool", a.tool, b.tool))]
    for i, (r, s) in enumerate(zip(a.rows, b.rows, strict=True), 1):
        if (r.origin is None) != (s.origin is None):
            return None
        cells += _row_cells(r, s, i)
    return [cell for cell in cells if not _alike(cell, tolerance)]


def rows_alike(r: DHRow, s: DHRow, tolerance: float) -> bool:
    """True of rows that move the arm alike."""
    return (r.origin is None) == (s.origin is None) and all(
        _alike(cell, tolerance) for cell in _row_cells(r, s, 0)
    )


def _row_cells(r: DHRow, s: DHRow, i: int) -> list[Cell]:
    """The cells of row i of both tables."""
    if r.origin is not None:
        return [Cell(i, "step", r.origin, s.origin)]
    cells = [Cell(i, "type", str(r.joint_type), str(s.joint_type))]
    cells += [Cell(i, key, getattr(r, key), getattr(s, key)) for key in PARAMETERS]
    return [*cells, Cell(i, "sign", float(r.sign), float(s.sign))]


def _alike(cell: Cell, tolerance: float) -> bool:
    _, quantity, a, b = cell
    if isinstance(a, Origin):
        return a == b or pose_error(a.matrix, b.matrix) <= tolerance
    if isinstance(a, str):
        return bool(a == b)
    off = math.remainder(a - b, 2 * math.pi) if quantity in ANGLES else a - b
    return bool(abs(off) <= tolerance)


def with_cell(table: DHTable, cell: Cell) -> DHTable:
    """Table A with a cell as it is in B."""
    if cell.quantity == "convention":
        return replace(table, convention=DHConvention(cell.b))
    if cell.row is None:
        return replace(table, **{cell.quantity: cell.b})
    key = {"step": "origin", "type": "joint_type"}.get(cell.quantity, cell.quantity)
    made: dict[str, Any] = {key: cell.b}
    rows = list(table.rows)
    rows[cell.row - 1] = replace(rows[cell.row - 1], **made)
    return replace(table, rows=tuple(rows))


def measured(
    table: DHTable, cells: Sequence[Cell], *, rewritten: bool = False
) -> tuple[Difference, ...]:
    """Each cell with what it does to the tool of table A, all others as they are."""
    chain = dh_to_chain(table)
    qs = configurations(chain, CONFIGURATIONS, chain.size)
    truth = poses(chain, qs)
    found = (_measured(table, cell, qs, truth) for cell in cells)
    return tuple(replace(one, rewritten=rewritten) for one in found)


def _measured(table: DHTable, cell: Cell, qs: Array, truth: Array) -> Difference:
    try:
        other = with_cell(table, cell)
        made = poses(dh_to_chain(other), qs)
    except TableError:
        return Difference(*cell)
    if other.n != table.n:
        return Difference(*cell)
    far = np.linalg.norm(made[:, :3, 3] - truth[:, :3, 3], axis=-1)
    turned = rotation_angle(np.swapaxes(truth[:, :3, :3], -1, -2) @ made[:, :3, :3])
    return Difference(*cell, float(far[0]), float(turned[0]), float(far.max()), float(turned.max()))
