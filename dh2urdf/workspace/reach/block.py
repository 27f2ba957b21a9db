"""The voxels of one block, worked out: the unit of work, of a task and of a file."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dh2urdf.robot import Robot
from dh2urdf.transforms import Array
from dh2urdf.workspace.reach.measured import Measures, measure
from dh2urdf.workspace.reach.settings import Block, MapSettings
from dh2urdf.workspace.section import reach_ball

PIECE = 4096
"""Poses solved at a time: their solutions stay in the processor's cache."""

Values = dict[str, NDArray[np.generic]]


class _Found(NamedTuple):
    """Of all poses of a block, how many solutions there are and how good they are."""

    ways: NDArray[np.int64]
    best: Measures


def block_values(robot: Robot, settings: MapSettings, block: Block) -> Values:
    """The variables of a map in one block, each (x, y, z), those of each orientation one more."""
    part = settings.part(block)
    shape = tuple(p.stop - p.start for p in part)
    points = settings.grid.points(part)
    k, spins = settings.turns.shape[:2]
    found = _solved(robot, settings, points)
    count = found.ways.reshape(-1, k, spins).max(axis=2)
    best = [values.reshape(-1, k, spins).max(axis=2) for values in found.best]
    reached = count > 0
    values: Values = {
        "share": reached.mean(axis=1, dtype=np.float64),
        "solutions_mean": count.mean(axis=1, dtype=np.float64),
        "solutions_max": count.max(axis=1).astype(np.uint16),
    }
    values |= {name: b.max(axis=1) for name, b in zip(Measures._fields, best, strict=True)}
    if settings.each:
        values["solutions_each"] = count.astype(np.uint16)
        values |= {f"{name}_each": b for name, b in zip(Measures._fields, best, strict=True)}
    return {name: _kept(v).reshape(*shape, *v.shape[1:]) for name, v in values.items()}


def _kept(values: NDArray[np.generic]) -> NDArray[np.generic]:
    """Numbers as a map keeps them, NaN where nothing is reached."""
    if values.dtype.kind == "u":
        return values
    return np.where(values == -np.inf, np.nan, values).astype(np.float32)


def _solved(robot: Robot, settings: MapSettings, points: Array) -> _Found:
    """Solve all poses of points (m, 3), those that the arm's lengths rule out left aside."""
    turns = settings.turns.reshape(-1, 3, 3)
    total = len(points) * len(turns)
    found = _Found(np.zeros(total, np.int64), Measures.of(total))
    near = _near(robot, points, turns)
    Ts, earlier = np.tile(np.eye(4), (PIECE, 1, 1)), None
    for start in range(0, len(near), PIECE):
        some = near[start : start + PIECE]
        place, turn = np.divmod(some, len(turns))
        poses = Ts[: len(some)]
        poses[:, :3, :3], poses[:, :3, 3] = turns[turn], points[place]
        answer = robot.ik_batch(
            poses,
            within_limits=settings.within_limits,
            task=settings.task,
            threads=1,
            out=earlier if len(some) == PIECE else None,
        )
        earlier = answer
        found.ways[some] = answer.count
        measure(robot, settings.task, answer.q, answer.count, found.best, some)
    return found


def _near(robot: Robot, points: Array, turns: Array) -> NDArray[np.intp]:
    """Indices, of the poses of points (m, 3) in turns (k, 3, 3), of those within the lengths."""
    centre, radius = reach_ball(robot)
    inside = np.linalg.norm(points - centre, axis=1) <= radius * (1.0 + 1e-9)
    return np.flatnonzero(np.repeat(inside, len(turns)))
