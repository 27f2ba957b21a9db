"""A row of a DH table as a lesson: the motions from frame i - 1 to frame i, one by one."""

from collections.abc import Sequence
from dataclasses import replace
from functools import reduce
from itertools import accumulate
from typing import NamedTuple

import numpy as np

from dh2urdf.conversions.write import grouped_rows
from dh2urdf.dh import DHConvention, DHTable
from dh2urdf.dh.motions import dh_factors
from dh2urdf.dh_io import Units
from dh2urdf.drawing.row import DHRowPicture, length_index, subscript, values
from dh2urdf.transforms import Array


class Motion(NamedTuple):
    """One motion of a row: its quantity, what it does, its factor in the product, its matrix."""

    key: str
    words: str
    factor: str
    T: Array


def motions(table: DHTable, i: int, q: float = 0.0) -> list[Motion]:
    """The motions of row i (from 1), its joint at q [rad or m]; their product is T_{i-1,i}.

    Standard: theta, d, a, alpha; modified: alpha, a, theta, d. Fixed steps after the row are one
    motion more, with the key ``step``.
    """
    row, fixed = grouped_rows(table)[1][i - 1]
    rot_z, trans_z, trans_x, rot_x = dh_factors(*row.variables(q), row.a, row.alpha)
    standard, j = table.convention is DHConvention.STANDARD, length_index(table, i)
    z, x = subscript("z", i - 1 if standard else i), subscript("x", i if standard else i - 1)
    theta, d, a, alpha = (subscript(s, k) for s, k in (("θ", i), ("d", i), ("a", j), ("α", j)))
    about_z = [
        Motion("theta", f"turn about {z} by {theta}", f"Rot_z({theta})", rot_z),
        Motion("d", f"move along {z} by {d}", f"Trans_z({d})", trans_z),
    ]
    along = Motion("a", f"move along {x} by {a}", f"Trans_x({a})", trans_x)
    about_x = Motion("alpha", f"turn about {x} by {alpha}", f"Rot_x({alpha})", rot_x)
    order = [*about_z, along, about_x] if standard else [about_x, along, *about_z]
    if fixed:
        T = reduce(np.matmul, [step.transform(0.0, table.convention) for step in fixed])
        order.append(Motion("step", "take the fixed step of the table", "T_fixed", T))
    return order


def staged(picture: DHRowPicture, steps: Sequence[Motion], count: int) -> DHRowPicture:
    """The picture of a row with the first ``count`` of its motions made.

    Both later frames are where these lead, and an arc lies where its own motion begins.
    """
    poses = list(accumulate((m.T for m in steps), np.matmul, initial=picture.T_prev))
    before = {motion.key: T for motion, T in zip(steps, poses, strict=False)}
    theta, alpha = (
        replace(arc, centre=before[arc.key][:3, 3]) for arc in (picture.theta, picture.alpha)
    )
    T = poses[count]
    return replace(picture, T_reached=T, T_next=T, theta=theta, alpha=alpha)


def lesson_words(
    table: DHTable, picture: DHRowPicture, steps: Sequence[Motion], count: int, units: Units
) -> str:
    """Which motion of how many was made last, about what and by how much."""
    i = picture.i
    if not count:
        return f"Row {i}: it starts in frame {i - 1}."
    motion = steps[count - 1]
    value = values(table, picture, units).get(motion.key, "").partition(" = ")[2]
    said = f"Row {i}, motion {count} of {len(steps)}: {motion.words}{f' = {value}' * bool(value)}."
    return said + (f" Frame {i} is reached." if count == len(steps) else "")


def walked(table: DHTable, row: int, step: int | None, way: int) -> tuple[int, int | None]:
    """Row and motions made after one step on (``way`` 1) or back (-1) through the whole table.

    Row 0 is before the lesson; a row with all of its motions at once has the step None, from
    where the way on leads to its first motion.
    """
    count = [0, *(len(motions(table, i)) for i in range(1, table.n + 1))]
    if not row:
        return (1, 0) if way > 0 else (0, None)
    if step is None:
        return (row, 0 if way > 0 else count[row] - 1)
    if 0 <= step + way <= count[row]:
        return row, step + way
    if 1 <= row + way <= table.n:
        return row + way, 0 if way > 0 else count[row - 1]
    return row, step
