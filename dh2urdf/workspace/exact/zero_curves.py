"""Curves on which a function of two joints is zero, by the edges of a grid that they cross."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from dh2urdf.transforms import Array

Function = Callable[[Array], Array]
"""Values (k,) at places (k, 2)."""

HALVINGS = 60
"""Of an edge of the grid, down to the last bit."""

NEWTON = 6
"""Steps from the middle of a chord to the curve."""

STEP = 1e-6
"""Of the slopes of those steps [rad or m]."""


def zero_curves(value: Function, axes: tuple[Array, Array]) -> list[Array]:
    """Curves (m, 2) on which a function is zero, their points exact to rounding.

    Parameters
    ----------
    value : callable
    axes : two arrays
        Grid along each coordinate. A loop that lies between its lines is missed.
    """
    x, y = axes
    grid = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1)
    positive = value(grid.reshape(-1, 2)).reshape(grid.shape[:2]) >= 0.0
    number = np.full((2, len(x), len(y)), -1)
    crossed = (positive[1:] != positive[:-1], positive[:, 1:] != positive[:, :-1])
    ends, total = list[tuple[Array, Array, NDArray[np.bool_]]](), 0
    for k, changed in enumerate(crossed):
        rows, columns = np.nonzero(changed)
        number[k, rows, columns] = total + np.arange(len(rows))
        total += len(rows)
        after = grid[rows + (k == 0), columns + (k == 1)]
        ends.append((grid[rows, columns], after, positive[rows, columns]))
    low, high, sign = (np.concatenate(parts) for parts in zip(*ends, strict=True))
    points = _halved(value, low, high, sign)
    middle = (grid[:-1, :-1] + grid[1:, 1:]) / 2
    return [points[line] for line in _lines(_pairs(number, positive, middle, value))]


def settled(value: Function, a: Array, b: Array, share: Array | float = 0.5) -> Array:
    """Points of a curve between points a and b of it, each (k, 2).

    ``share`` says how far from a to b; the chord's point is moved to the curve.
    """
    start = spot = along(a, b, share)
    most = np.linalg.norm(b - a, axis=1, keepdims=True) / 2
    for _ in range(NEWTON):
        steps = [value(spot + h) - value(spot - h) for h in STEP * np.eye(2)]
        slope = np.stack(steps, axis=1) / (2 * STEP)
        square = np.maximum((slope * slope).sum(axis=1, keepdims=True), 1e-300)
        spot = spot - value(spot)[:, None] * slope / square
        far = np.linalg.norm(spot - start, axis=1, keepdims=True)
        spot = start + (spot - start) * np.minimum(1.0, most / np.maximum(far, 1e-300))
    return spot


def along(a: Array, b: Array, share: Array | float) -> Array:
    """Points of the chords from a to b (k, 2), a share of the way."""
    return np.asarray(a + np.broadcast_to(share, len(a))[:, None] * (b - a))


def _halved(value: Function, low: Array, high: Array, sign: NDArray[np.bool_]) -> Array:
    """Where the sign changes between places (k, 2)."""
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        same = ((value(middle) >= 0.0) == sign)[:, None]
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    return np.asarray((low + high) / 2)


def _pairs(
    number: NDArray[np.int64], positive: NDArray[np.bool_], middle: Array, value: Function
) -> list[tuple[int, int]]:
    """Crossings that a cell of the grid joins; of four in a cell, those on the same side."""
    around = np.stack([number[0, :-1, :-1], number[1, 1:, :-1],
                       number[0, :-1, 1:], number[1, :-1, :-1]], axis=-1)  # fmt: skip
    crossed = (around >= 0).sum(axis=-1)
    two = around[crossed == 2]
    pairs = [(row[row >= 0][0], row[row >= 0][1]) for row in two]
    cells = np.argwhere(crossed == 4)
    if len(cells):
        inner = value(middle[tuple(cells.T)]) >= 0.0
        same = inner == positive[:-1, :-1][tuple(cells.T)]
        for (a, b, c, d), joined in zip(around[crossed == 4], same, strict=True):
            pairs += [(a, b), (c, d)] if joined else [(a, d), (b, c)]
    return [(int(a), int(b)) for a, b in pairs]


def _lines(pairs: list[tuple[int, int]]) -> list[list[int]]:
    """Chains of crossings; the first stands at the end again where one is closed."""
    near: dict[int, list[int]] = {}
    for a, b in pairs:
        near.setdefault(a, []).append(b)
        near.setdefault(b, []).append(a)
    lines, left = [], set(near)
    for start in sorted(near, key=lambda k: (len(near[k]), k)):
        if start not in left:
            continue
        line, here = [start], start
        left.discard(start)
        while ahead := [k for k in near[here] if k in left]:
            here = ahead[0]
            left.discard(here)
            line.append(here)
        if len(line) > 2 and start in near[here] and len(near[start]) == 2:
            line.append(start)
        lines.append(line)
    return lines
