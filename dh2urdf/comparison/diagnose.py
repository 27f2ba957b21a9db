"""Where two arms differ: the cells of their tables, and the mistakes that such cells read as.

Tables of the same rows are compared cell by cell. Where frames were chosen otherwise cells say
little; then every mistake is made on one table in turn, and the one is told after which the arms
are the same. Where none is, frames are assigned to both alike, and what differs less is told.
What is told is all: with it put right the arms are the same up to base, tool, zeros, directions.
"""

import math
from collections.abc import Iterable, Iterator
from dataclasses import replace
from functools import reduce

import numpy as np

from dh2urdf.chain import SerialChain
from dh2urdf.comparison.alignment import axes_that_agree
from dh2urdf.comparison.arms import Arm
from dh2urdf.comparison.cells import Cell, Difference, differing, measured, rows_alike, with_cell
from dh2urdf.comparison.mistakes import Mistake, mistaken_rows, mistaken_tables
from dh2urdf.comparison.relate import holds
from dh2urdf.conversions.assign import chain_to_dh, to_convention
from dh2urdf.conversions.write import dh_to_chain
from dh2urdf.dh import DHTable, JointType

SLACK = 1e-6
"""Slack [rad, arm's sizes] of axes that agree."""

Diagnosis = tuple[tuple[Mistake, ...], tuple[Difference, ...]]


def diagnose(a: Arm, b: Arm, tolerance: float, *, same: bool) -> Diagnosis:
    """Mistakes that B reads as of A, and the cells that differ; ``same`` up to base, zeros, ..."""
    mine, cells = a.table, list[Cell]()
    if a.written and b.written:
        whole = _whole(mine, b.table, tolerance)
        if whole is not None:
            cells = differing(mine, b.table, tolerance) or []
            return (whole,), measured(mine, cells) or _other_kinds(a.chain, b.chain)
        theirs = to_convention(b.table, mine.convention)
        cells = differing(mine, theirs, tolerance) or []
        rewritten = b.table.convention is not mine.convention
        as_written = (
            _of_rows(mine, theirs, cells, tolerance),
            measured(mine, cells, rewritten=rewritten),
        )
        if len({cell.row for cell in cells}) == 1:
            return as_written
    if same:
        return (), ()
    hidden = _hidden(a, b, tolerance)
    told = hidden or ((), _assigned(a, b, tolerance))
    shape, told_shape = (_shape(mine, found) for found in (cells, told[1]))
    few = 2 * len({cell.row for cell in cells}) <= len(mine.rows)
    if cells and (few or shape == told_shape):
        return as_written[0] or told[0], as_written[1]
    fewer = len(told[1]) < len(cells) and all(one.rewritten for one in told[1])
    return as_written if cells and not hidden and not fewer else told


def _shape(table: DHTable, found: Iterable[Cell | Difference]) -> set[tuple[int | None, str]]:
    """Rows and quantities, without those that a base, a tool, a zero or a direction may do."""
    slides = {i for i, row in enumerate(table.rows, 1) if row.joint_type is JointType.PRISMATIC}
    free = {"theta", "sign", "base", "tool"}
    return {
        (one.row, one.quantity)
        for one in found
        if one.quantity not in free and not (one.quantity == "d" and one.row in slides)
    }


def _whole(a: DHTable, b: DHTable, tolerance: float) -> Mistake | None:
    """The mistake that makes all of A all of B, if it is one of the table as a whole."""
    if differing(a, b, tolerance) == []:
        return None
    for mistake, made in mistaken_tables(a):
        if differing(made, b, tolerance) == []:
            return mistake
    for mistake, made in mistaken_tables(b):
        if len(b.rows) > len(a.rows) and differing(a, made, tolerance) == []:
            return mistake.turned_round()
    return None


def _of_rows(a: DHTable, b: DHTable, cells: list[Cell], tolerance: float) -> tuple[Mistake, ...]:
    """A mistake for each row that differs; none where not all are explained so."""
    out = []
    for i in sorted({cell.row or 0 for cell in cells}):
        if i == 0:
            return ()
        row, other = a.rows[i - 1], b.rows[i - 1]
        fits = (m for m, made in mistaken_rows(row, i) if rows_alike(made, other, tolerance))
        mistake = next(fits, None)
        if mistake is None:
            return ()
        out.append(mistake)
    return tuple(out)


def _hidden(a: Arm, b: Arm, tolerance: float) -> Diagnosis | None:
    """The mistakes after which the arms are the same; the cells of the first."""
    turned = b.written and not a.written
    known, other = (b, a) if turned else (a, b)
    found = [
        (mistake, made)
        for mistake, made in _likely_mistakes(known, other.chain)
        if holds(dh_to_chain(made), other.chain, tolerance)
    ]
    if not found:
        return None
    mistakes = tuple(m.turned_round() if turned else m for m, _ in found)
    cells = differing(known.table, found[0][1], 0.0) or []
    if turned:
        cells = [cell._replace(a=cell.b, b=cell.a) for cell in cells]
    table = found[0][1] if turned else known.table
    rewritten = a.written and b.written
    told = measured(table, cells, rewritten=rewritten) or _other_kinds(a.chain, b.chain)
    return mistakes, told


def _likely_mistakes(known: Arm, other: SerialChain) -> Iterator[tuple[Mistake, DHTable]]:
    """Mistakes of the table as a whole, and of the rows where its axes cease to agree.

    A mistake in one row leaves the axes before it as they are to each other, and those behind it.
    """
    yield from mistaken_tables(known.table)
    before = axes_that_agree(known.chain, other, SLACK)
    behind = axes_that_agree(known.chain.reversed(), other.reversed(), SLACK)
    if other.n != known.chain.n or before + behind < other.n - 2:
        return
    rows, joint = known.table.rows, 0
    for i, row in enumerate(rows, 1):
        joint += row.is_joint
        for mistake, made in mistaken_rows(row, i) if abs(joint - before) <= 2 else ():
            yield mistake, replace(known.table, rows=(*rows[: i - 1], made, *rows[i:]))


def _other_kinds(a: SerialChain, b: SerialChain) -> tuple[Difference, ...]:
    """The kinds of the joints, where they differ: ``RRP``."""
    here, there = ("".join("P" if s else "R" for s in arm.prismatic) for arm in (a, b))
    return (Difference(None, "joints", here, there),) if here != there else ()


def _assigned(a: Arm, b: Arm, tolerance: float) -> tuple[Difference, ...]:
    """What differs when frames are assigned to both arms alike, a row a joint."""
    if not np.array_equal(a.chain.prismatic, b.chain.prismatic):
        return _other_kinds(a.chain, b.chain)
    tables = [chain_to_dh(arm.chain, a.table.convention).table for arm in (a, b)]
    first, second = (replace(table, rows=table.joints) for table in tables)
    for directed in (True, False):
        pairs = list(_in_same_frames(first, second, directed=directed))
        cells = [cell for cell in pairs if abs(cell.a - cell.b) > tolerance]
        if cells and holds(dh_to_chain(reduce(with_cell, pairs, first)), b.chain, tolerance):
            break
    if cells:
        return measured(first, cells, rewritten=True)
    k = axes_that_agree(a.chain, b.chain, tolerance)
    return (Difference(k + 1, "axis", None, None),) if k < a.chain.n else ()


def _in_same_frames(first: DHTable, second: DHTable, *, directed: bool) -> Iterator[Cell]:
    """The numbers that make an arm's shape; ``directed`` as if only frames made their signs.

    Else also theta of joints that slide: with it they are all, whatever the frames.
    """
    for i, (r, s) in enumerate(zip(first.rows, second.rows, strict=True), 1):
        turns = r.joint_type is JointType.REVOLUTE
        for key in ("a", "alpha", *(("d",) if turns else () if directed else ("theta",))):
            x, y = getattr(r, key), getattr(s, key)
            yield Cell(i, key, x, _directed(key, x, y) if directed else y)


def _directed(key: str, x: float, y: float) -> float:
    """The value in B for axes that point as those of A do: signs are a choice of frames."""
    size = abs(y)
    if key == "alpha" and (abs(x) > math.pi / 2) != (size > math.pi / 2):
        size = math.pi - size
    return math.copysign(size, x)
