"""Edges of a map of whole numbers, finer than its grid: halved where two points differ."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dh2urdf.transforms import Array

Counts = NDArray[np.int64]

Rings = list[Array]
"""Rings (m, 2) of one polygon [m]: its outline, then its holes."""

Regions = dict[int, list[Rings]]
"""Polygons where there are at least so many."""


def regions(
    u: Array, v: Array, counts: Counts, counts_at: Callable[[Array], Counts], halvings: int
) -> Regions:
    """Where there are at least so many, for each number that occurs but zero.

    Parameters
    ----------
    u, v : array
        Coordinates of the grid's columns and rows [m].
    counts : array, shape (len(v), len(u))
    counts_at : callable
        Counts (m,) at any places (m, 2).
    halvings : int
        An edge between two points is known to one part in 2 ** halvings of their distance.
    """
    numbers = [int(n) for n in np.unique(counts) if n > 0]
    fields = ((n, (counts >= n).astype(float)) for n in numbers)
    polygons = [(n, rings) for n, field in fields for rings in above(u, v, field, 0.5)]
    if not polygons:
        return {}
    rings = [ring for _, polygon in polygons for ring in polygon]
    owner = np.repeat([n for n, polygon in polygons for _ in polygon], [len(r) for r in rings])
    exact = _halved(u, v, counts, np.concatenate(rings), owner, counts_at, halvings)
    parts = iter(np.split(exact, np.cumsum([len(r) for r in rings])[:-1]))
    out: Regions = {number: [] for number in numbers}
    for number, polygon in polygons:
        out[number].append([next(parts) for _ in polygon])
    return out


def above(u: Array, v: Array, values: Array, level: float) -> list[Rings]:
    """Polygons [m] in which values on a grid (len(v), len(u)) are above a level."""
    from contourpy import contour_generator

    lines: Any = contour_generator(u, v, values, fill_type="OuterOffset")
    found = zip(*lines.filled(level, np.inf), strict=True)
    return [np.split(points, offsets[1:-1].astype(int)) for points, offsets in found]


def _halved(
    u: Array,
    v: Array,
    counts: Counts,
    places: Array,
    owner: Counts,
    counts_at: Callable[[Array], Counts],
    halvings: int,
) -> Array:
    """Places (m, 2) halfway between two points of the grid, brought to where ``owner`` begins."""
    column, row = (
        np.interp(p, x, np.arange(len(x))) for p, x in zip(places.T, (u, v), strict=True)
    )
    a = np.stack([np.floor(row + 1e-6), np.floor(column + 1e-6)]).astype(int)
    b = np.stack([np.ceil(row - 1e-6), np.ceil(column - 1e-6)]).astype(int)
    low, high = (np.stack([u[k[1]], v[k[0]]], axis=1) for k in (a, b))
    inside = (counts[tuple(a)] >= owner)[:, None]
    within, without = np.where(inside, low, high), np.where(inside, high, low)
    between = (a != b).any(axis=0)
    for _ in range(halvings):
        middle = (within + without) / 2
        spots, back = np.unique(middle[between], axis=0, return_inverse=True)
        has = np.zeros(len(places), np.bool_)
        has[between] = counts_at(spots)[back.ravel()] >= owner[between]
        within, without = (
            np.where(has[:, None] == s, middle, w) for s, w in ((True, within), (False, without))
        )
    return np.asarray((within + without) / 2)
