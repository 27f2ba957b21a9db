"""The surface between points of a grid that are inside and points that are not.

Surface nets: a corner a cell, the mean of where its edges cross (Gibson, "Constrained elastic
surface nets", 1998).
"""

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from dh2urdf.transforms import Array

Flags = NDArray[np.bool_]
Index = NDArray[np.intp]

Crossing = Callable[[int, Index, Flags], tuple[Array, Array]]
"""Of edges along an axis from grid points (k, 3), whose first end is inside or not (k,): where the
surface crosses them (k, 3), and what that weighs in the mean (k,)."""


def surface_net(inside: Flags, crossing: Crossing) -> tuple[Array, NDArray[np.int64]]:
    """Corners (v, 3) and quadrilaterals (f, 4) of them, counter-clockwise seen from outside.

    Those of each axis follow one another, in the order in which ``crossing`` is asked.
    """
    cells = np.array(inside.shape) - 1
    total, count = np.zeros((int(cells.prod()), 3)), np.zeros(int(cells.prod()))
    quads = []
    for axis in range(3):
        ends = [np.take(inside, np.arange(cells[axis]) + k, axis) for k in (0, 1)]
        index = np.argwhere(ends[0] != ends[1])
        from_inside = ends[0][tuple(index.T)]
        spots, weight = crossing(axis, index, from_inside)
        ring = []
        for back in ((0, 0), (1, 0), (1, 1), (0, 1)):
            cell = index.copy()
            cell[:, [(axis + 1) % 3, (axis + 2) % 3]] -= back
            ring.append(np.ravel_multi_index(tuple(cell.T), tuple(cells)))
            np.add.at(total, ring[-1], weight[:, None] * spots)
            np.add.at(count, ring[-1], weight)
        quad = np.stack(ring, axis=1)
        quads.append(np.where(from_inside[:, None], quad, quad[:, ::-1]))
    used, renamed = np.unique(np.concatenate(quads), return_inverse=True)
    return total[used] / count[used, None], renamed.reshape(-1, 4)


def edge_ends(nodes: Sequence[Array], axis: int, index: Index) -> tuple[Array, Array]:
    """First and last ends (k, 3) of edges along an axis, in coordinates of the grid's lines."""
    after = index + (np.arange(3) == axis)
    low, high = (
        np.stack([nodes[k][ends[:, k]] for k in range(3)], axis=1) for ends in (index, after)
    )
    return low, high
