"""Voxels halved where the share of orientations changes fast, the others as they were."""

from itertools import product

import numpy as np
from numpy.typing import NDArray

from dh2urdf.robot import Robot
from dh2urdf.workspace.reach.block import Values, values_at
from dh2urdf.workspace.reach.settings import Block, MapSettings

FAST = 0.1
"""Difference of the shares of two neighbours from which on both are halved."""


def around(settings: MapSettings, block: Block) -> tuple[slice, ...]:
    """The part of the coarser grid that holds a block of the finer one, and one voxel more."""
    half = [n // 2 for n in settings.grid.shape]
    return tuple(
        slice(max(p.start // 2 - 1, 0), min(p.stop // 2 + 1, n))
        for p, n in zip(settings.part(block), half, strict=True)
    )


def refined_block(robot: Robot, settings: MapSettings, block: Block, coarse: Values) -> Values:
    """The variables of a block: worked out in the halves of some voxels, taken over in the rest.

    Parameters
    ----------
    robot : Robot
    settings : MapSettings
        Those of the finer grid, each voxel of the coarser one two along each axis.
    block : tuple of int
    coarse : mapping
        Variables of the coarser grid in :func:`around` of the block.
    """
    part = settings.part(block)
    inner = tuple(
        slice(p.start // 2 - a.start, p.stop // 2 - a.start)
        for p, a in zip(part, around(settings, block), strict=True)
    )
    values = {name: _doubled(v[inner]) for name, v in coarse.items() if v.ndim == 3}
    if "level" not in values:
        values["level"] = np.zeros(values["share"].shape, np.float32)
    halved = _doubled(_steep(coarse["share"])[inner])
    points = settings.grid.points(part)[halved.ravel()]
    for name, new in values_at(robot, settings, points).items():
        values[name][halved] = new
    values["level"][halved] = settings.level
    return values


def _doubled(values: NDArray[np.generic]) -> NDArray[np.generic]:
    """Each value twice along each axis."""
    for axis in range(3):
        values = np.repeat(values, 2, axis)
    return values


def _steep(share: NDArray[np.generic]) -> NDArray[np.bool_]:
    """Voxels of which one of the 26 neighbours has another share by `FAST`."""
    wide = np.pad(share.astype(np.float64), 1, mode="edge")
    out = np.zeros(share.shape, np.bool_)
    nx, ny, nz = share.shape
    for i, j, k in product(range(3), repeat=3):
        out |= np.abs(wide[i : i + nx, j : j + ny, k : k + nz] - wide[1:-1, 1:-1, 1:-1]) > FAST
    return out
