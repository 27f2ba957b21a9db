"""A function of a grid's points, worked out where it changes and filled in between."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from dh2urdf.transforms import Array

Flags = NDArray[np.bool_]
Index = NDArray[np.intp]

Progress = Callable[[int, int], None]
"""Called with the number of steps done and their total."""

FEWEST = 20
"""Points along a side of the grid that refinement starts from."""

STEPS = 1_000
"""Steps in which the progress of a grid is told."""


def refined(
    values_at: Callable[[Index, Index, Progress], Array],
    shape: tuple[int, int],
    *,
    tolerance: float = 0.0,
    progress: Progress | None = None,
) -> Array:
    """Values on a grid (rows, columns): of every eighth point, then twice as many a side each time.

    A cell is divided where its corners are not alike, and so are the cells around it: one is zero
    and another is not, or one is further than ``tolerance`` from what the grid before foretold
    there; without a tolerance, where they differ at all. Elsewhere values are linear between.

    Parameters
    ----------
    values_at : callable
        Values (m,) at rows (m,) and columns (m,) of the grid; it tells how far it has come.
    """
    stride = next(s for s in (8, 4, 2, 1) if s == 1 or min(shape) > FEWEST * s)
    rows, columns = (_every(stride, n) for n in shape)
    levels = stride.bit_length()
    told = [_part(progress, k, levels) for k in range(levels)]
    r, c = (x.ravel() for x in np.meshgrid(rows, columns, indexing="ij"))
    values = values_at(r, c, told[0]).reshape(len(rows), len(columns))
    busy = np.ones(values.shape, np.bool_)
    for level in range(1, levels):
        stride //= 2
        finer = tuple(_every(stride, n) for n in shape)
        guess = _spread(values.astype(float), (rows, columns), finer)
        near = _spread(busy.astype(float), (rows, columns), finer) > 0.0
        is_new = ~np.outer(np.isin(finer[0], rows), np.isin(finer[1], columns))
        rows, columns = finer
        i, j = np.nonzero(near & is_new)
        values = guess.copy()
        values[i, j] = values_at(rows[i], columns[j], told[level])
        off = np.abs(values - guess) > tolerance
        busy = _grown(off | _mixed(values if tolerance == 0.0 else values > 0.0))
    if progress is not None:
        progress(STEPS, STEPS)
    return values


def _every(stride: int, count: int) -> Index:
    """Indices of every so manieth point, and of the last."""
    return np.union1d(np.arange(0, count, stride), count - 1).astype(np.intp)


def _spread(values: Array, from_: tuple[Index, Index], to: tuple[Index, ...]) -> Array:
    """Bilinear values of a grid at the rows and columns of a finer one."""
    across = np.stack([np.interp(to[1], from_[1], row) for row in values])
    return np.stack([np.interp(to[0], from_[0], column) for column in across.T], axis=1)


def _mixed(values: Array | Flags) -> Flags:
    """Points with a neighbour of another value."""
    wide = np.pad(values, 1, mode="edge")
    rows, columns = wide.shape
    around = [wide[i : i + rows - 2, j : j + columns - 2] for i in range(3) for j in range(3)]
    return np.asarray(np.any([values != near for near in around], axis=0))


def _grown(flags: Flags) -> Flags:
    """Flags and their eight neighbours."""
    wide = np.pad(flags, 1)
    rows = wide[:-2] | wide[1:-1] | wide[2:]
    return rows[:, :-2] | rows[:, 1:-1] | rows[:, 2:]


def _part(progress: Progress | None, k: int, parts: int) -> Progress:
    """Progress of part k of so many, told as progress of the whole."""

    def tell(done: int, total: int) -> None:
        if progress is not None and total:
            progress(int(STEPS * (k + done / total) / parts), STEPS)

    return tell
