"""The mistakes that are made with DH tables, each as the table that it makes of a right one."""

import math
import re
from collections.abc import Iterable, Iterator
from dataclasses import replace
from typing import Any, NamedTuple

from dh2urdf.comparison.cells import PARAMETERS
from dh2urdf.dh import DHConvention, DHRow, DHTable
from dh2urdf.exceptions import TableError

UNITS = (
    ("length", "mm for m", ("d", "a"), 1000.0),
    ("length", "m for mm", ("d", "a"), 1 / 1000.0),
    ("angle", "degrees for radians", ("theta", "alpha"), 180 / math.pi),
    ("angle", "radians for degrees", ("theta", "alpha"), math.pi / 180),
)
"""What is measured, the mistake, the cells that it multiplies, and by what."""

SWAPS = (("a", "d"), ("theta", "alpha"))


OPPOSITE = {"left out": "too many", "standard": "modified", "mm for m": "m for mm"}
OPPOSITE["degrees for radians"] = "radians for degrees"
OPPOSITE |= {after: before for before, after in OPPOSITE.items()}

_OPPOSITES = re.compile(r"\b(" + "|".join(OPPOSITE) + r")\b")


class Mistake(NamedTuple):
    """What was done to a table.

    Parameters
    ----------
    rows : tuple of int
        Rows that it was done to, fixed ones included, counted from 1; none for the whole table.
    kind : str
        ``sign of alpha``, ``a and d swapped``, ``theta left out``, ``mm for m``, ...
    text : str
        In words.
    """

    rows: tuple[int, ...]
    kind: str
    text: str

    def turned_round(self) -> "Mistake":
        """The mistake that takes back what this one does."""
        kind, text = (
            _OPPOSITES.sub(lambda m: OPPOSITE[m[0]], words) for words in (self.kind, self.text)
        )
        return Mistake(self.rows, kind, text)


def mistaken_rows(row: DHRow, i: int) -> Iterator[tuple[Mistake, DHRow]]:
    """What mistakes make of row i."""
    for kind, text, cells in _row_mistakes(row):
        try:
            made = replace(row, **cells)
        except TableError:
            continue
        if made != row:
            yield Mistake((i,), kind, f"row {i}: {text}"), made


def _row_mistakes(row: DHRow) -> Iterator[tuple[str, str, dict[str, Any]]]:
    """Kind, words, and the cells that are made of a row."""
    if row.origin is not None:
        return
    given = {key: getattr(row, key) for key in PARAMETERS}
    for key in reversed(PARAMETERS):
        yield f"sign of {key}", f"{key} has the other sign", {key: -given[key]}
    for one, other in SWAPS:
        kind = f"{one} and {other} swapped"
        yield kind, kind.replace("swapped", "are swapped"), {one: given[other], other: given[one]}
    for key in PARAMETERS:
        yield f"{key} left out", f"{key} is left out", {key: 0.0}
    for _, kind, keys, factor in UNITS:
        for chosen in (keys, keys[:1], keys[1:]):
            cells = {key: factor * given[key] for key in chosen if given[key]}
            yield kind, f"{kind} in {' and '.join(cells)}", cells
    if row.is_joint:
        yield "direction", "the joint moves the other way", {"sign": -row.sign}


def mistaken_tables(table: DHTable) -> Iterator[tuple[Mistake, DHTable]]:
    """What mistakes make of a table as a whole, or of the order of its rows."""
    other = next(kind for kind in DHConvention if kind is not table.convention)
    text = f"the {table.convention} table is read as {other}"
    yield Mistake((), "convention", text), replace(table, convention=other)
    for what, kind, keys, factor in UNITS:
        cells = ({key: factor * getattr(row, key) for key in keys} for row in table.rows)
        yield from _changed(table, Mistake((), kind, f"{what}s look like {kind}"), cells)
    for one, second in SWAPS:
        cells = ({one: getattr(r, second), second: getattr(r, one)} for r in table.rows)
        kind = f"{one} and {second} swapped"
        yield from _changed(table, Mistake((), kind, f"columns {one} and {second} swapped"), cells)
    for i in range(len(table.rows) - 1):
        k = i + 2
        rows = (*table.rows[:i], table.rows[k - 1], table.rows[i], *table.rows[k:])
        text = f"rows {k - 1} and {k} are swapped"
        yield Mistake((k - 1, k), "order of rows", text), replace(table, rows=rows)
    for i in range(len(table.rows)):
        rows = table.rows[:i] + table.rows[i + 1 :]
        if any(row.is_joint for row in rows):
            mistake = Mistake((i + 1,), "row left out", f"row {i + 1} is left out")
            yield mistake, replace(table, rows=rows)


def _changed(
    table: DHTable, mistake: Mistake, cells: Iterable[dict[str, Any]]
) -> Iterator[tuple[Mistake, DHTable]]:
    """The table with cells of two rows or more, where they can hold them."""
    try:
        rows = tuple(
            row if row.origin else replace(row, **made)
            for row, made in zip(table.rows, cells, strict=True)
        )
        if sum(made != row for made, row in zip(rows, table.rows, strict=True)) > 1:
            yield mistake, replace(table, rows=rows)
    except TableError:
        return
