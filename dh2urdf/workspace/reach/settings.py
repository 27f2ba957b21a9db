"""What a map is of: its grid, its orientations, what is asked at each pose."""

import math
from dataclasses import dataclass, replace
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from dh2urdf.bounds import HALVINGS, LENGTH, VOXELS
from dh2urdf.doors import finite_array, flag, instance, integer, number
from dh2urdf.exceptions import ArgumentError
from dh2urdf.robot import Robot
from dh2urdf.transforms import Array
from dh2urdf.workspace.reach.orientations import tried
from dh2urdf.workspace.section import reach_ball
from dh2urdf.workspace.task import common_axis

BLOCK_POSES = 500_000
"""Poses of a block, about: a tenth of a second's work for each core, and what is lost of it."""

SIDES = (4, 8, 16, 32)
"""Voxels along the side of a block."""

WHOLE = 1e-6
"""Part of a voxel by which a region may miss a whole number of them."""

Block = tuple[int, int, int]


class Grid(NamedTuple):
    """Voxels of one size: the corner of the first [m], their side [m], how many along x, y, z."""

    low: tuple[float, float, float]
    step: float
    shape: tuple[int, int, int]

    def centres(self, axis: int, part: slice = slice(None)) -> Array:
        """Centres of the voxels along an axis [m]."""
        k = np.arange(self.shape[axis])[part]
        return np.asarray(self.low[axis] + (k + 0.5) * self.step)

    def points(self, part: tuple[slice, ...]) -> Array:
        """Centres of the voxels of a part (m, 3), z the fastest."""
        lines = [self.centres(axis, part[axis]) for axis in range(3)]
        return np.stack(np.meshgrid(*lines, indexing="ij"), axis=-1).reshape(-1, 3)


@dataclass(frozen=True, eq=False)
class MapSettings:
    """All on which the values of a map depend, besides the arm.

    Attributes
    ----------
    grid : Grid
    turns : array, shape (k, spins, 3, 3)
        Orientations of the tip in base; one is reached when one of its spins is.
    task : str
        As of :meth:`dh2urdf.Robot.ik`.
    within_limits : bool
    each : bool
        Whether values are kept of each orientation, too.
    side : int
        Voxels along the side of a block.
    refine, level : int
        How often voxels may be halved, and how often those of this grid are.
    """

    grid: Grid
    turns: Array
    task: str
    within_limits: bool
    each: bool
    side: int
    refine: int = 0
    level: int = 0

    @property
    def counts(self) -> tuple[int, int, int]:
        """Blocks along x, y, z."""
        nx, ny, nz = (-(-n // self.side) for n in self.grid.shape)
        return nx, ny, nz

    def halved(self) -> "MapSettings":
        """Those of the next level: each voxel of the grid is two along each axis."""
        low, step, (nx, ny, nz) = self.grid
        grid = Grid(low, step / 2, (2 * nx, 2 * ny, 2 * nz))
        return replace(self, grid=grid, level=self.level + 1)

    def blocks(self) -> list[Block]:
        """Indices of all blocks."""
        nx, ny, nz = map(range, self.counts)
        return list(product(nx, ny, nz))

    def part(self, block: Block) -> tuple[slice, ...]:
        """Where the voxels of a block are in the grid."""
        side, shape = self.side, self.grid.shape
        return tuple(
            slice(b * side, min((b + 1) * side, n)) for b, n in zip(block, shape, strict=True)
        )


def settings_of(
    robot: Robot,
    step: float,
    orientations: object,
    region: ArrayLike | None,
    within_limits: bool,
    each: bool,
    refine: int,
) -> MapSettings:
    """Settings of arguments that are checked here."""
    task, turns = tried(instance(robot, "robot", Robot), orientations)
    inside = flag(within_limits, "within_limits")
    grid = _grid(robot, number(step, "step", 1e-6, LENGTH, unit="m"), region, inside)
    even = (BLOCK_POSES / (turns.shape[0] * turns.shape[1])) ** (1 / 3)
    side = min(SIDES, key=lambda s: abs(math.log(s / even)))
    kept = flag(each, "each")
    levels = integer(refine, "refine", 0, HALVINGS)
    if levels and kept:
        raise ArgumentError("each: values of each orientation are kept of voxels of one size only")
    if levels and common_axis(robot)[1]:
        raise ArgumentError(
            "refine: a planar arm reaches nothing beside its plane, where halves of voxels would "
            "be; expected 0, and a smaller step"
        )
    return MapSettings(grid, turns, task.name, inside, kept, side, levels)


def bounded(robot: Robot, within_limits: bool) -> bool:
    """Whether no joint slides farther than the arm's lengths take into account."""
    ends = np.stack(robot.joint_ranges())[:, robot.chain.prismatic]
    return not ends.size or (within_limits and bool(np.isfinite(ends).all()))


def _endless(robot: Robot) -> str:
    """Names of the joints that slide without limits; where all have some, of all that slide."""
    slides, (low, high) = robot.chain.prismatic, robot.joint_ranges()
    endless = slides & ~(np.isfinite(low) & np.isfinite(high))
    which = endless if endless.any() else slides
    return ", ".join(name for name, one in zip(robot.chain.names, which, strict=True) if one)


def _grid(robot: Robot, step: float, region: ArrayLike | None, within_limits: bool) -> Grid:
    """Voxels that fill a region (3, 2) [m], or hold all that the arm reaches."""
    if region is not None:
        ends = finite_array(region, "region", "three pairs of numbers", shape=(3, 2))
        for name, (low_end, high_end) in zip("xyz", ends.tolist(), strict=True):
            if not low_end < high_end:
                raise ArgumentError(
                    f"region: each pair begins with the lower end, got {name} from {low_end:g} to "
                    f"{high_end:g}"
                )
        low, counts = ends[:, 0], np.ceil((ends[:, 1] - ends[:, 0]) / step - WHOLE)
    else:
        if not bounded(robot, within_limits):
            raise ArgumentError(
                f"region: {_endless(robot)} slides without an end; say from where to where along "
                "x, y, z is mapped"
            )
        centre, radius = reach_ball(robot)
        half = np.full(3, np.ceil(radius / step - WHOLE))
        low, counts = centre - half * step, 2 * half
        axis, flat = common_axis(robot)
        if flat and axis is not None:
            height = float(robot.chain.tool[axis, 3])
            low[axis], counts[axis] = height - step / 2, 1
    total = float(counts.prod())
    if total > VOXELS:
        raise ArgumentError(f"step: {total:.3g} voxels of {step:g} m; at most {VOXELS} are mapped")
    shape = tuple(int(c) for c in np.maximum(counts, 1))
    return Grid(tuple(low.tolist()), step, shape)  # type: ignore[arg-type]
