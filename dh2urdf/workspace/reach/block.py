"""The voxels of one block, worked out: the unit of work, of a task and of a file."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dh2urdf.robot import Robot
from dh2urdf.transforms import Array
from dh2urdf.workspace.reach.measured import MEASURES, measure
from dh2urdf.workspace.reach.settings import Block, MapSettings, bounded
from dh2urdf.workspace.section import last_axis_ball, reach_ball

PIECE = 4096
"""Poses solved at a time: their solutions stay in the processor's cache."""

FAR = 1.0 + 1e-6
"""Part of the arm's lengths from which on a pose is left aside, safe from rounding."""

Values = dict[str, NDArray[np.generic]]


class _Found(NamedTuple):
    """Of all poses (m,) of a block, how many solutions there are, and their measures (3, m)."""

    ways: NDArray[np.uint16]
    best: Array


def block_values(robot: Robot, settings: MapSettings, block: Block) -> Values:
    """The variables of a map in one block, each (x, y, z), those of each orientation one more."""
    part = settings.part(block)
    shape = tuple(p.stop - p.start for p in part)
    flat = values_at(robot, settings, settings.grid.points(part))
    return {name: v.reshape(*shape, *v.shape[1:]) for name, v in flat.items()}


def values_at(robot: Robot, settings: MapSettings, points: Array) -> Values:
    """The variables of a map at points (m, 3), each (m,), those of each orientation (m, k)."""
    ways, best = _best_spins(_solved(robot, settings, points), settings)
    values: Values = {
        "share": (ways > 0).mean(axis=1, dtype=np.float64),
        "solutions_mean": ways.mean(axis=1, dtype=np.float64),
        "solutions_max": ways.max(axis=1),
    }
    values |= dict(zip(MEASURES, best.max(axis=2), strict=True))
    if settings.each:
        values["solutions_each"] = ways
        values |= {f"{name}_each": each for name, each in zip(MEASURES, best, strict=True)}
    return {name: _kept(v) for name, v in values.items()}


def _best_spins(found: _Found, settings: MapSettings) -> _Found:
    """Of each orientation (voxels, k) the spin with the most, and that with the best."""
    k, spins = settings.turns.shape[:2]
    ways, best = found.ways.reshape(-1, k, spins), found.best.reshape(3, -1, k, spins)
    if spins == 1:
        return _Found(ways[..., 0], best[..., 0])
    return _Found(ways.max(axis=2), best.max(axis=3))


def _kept(values: NDArray[np.generic]) -> NDArray[np.generic]:
    """Numbers as a map keeps them, a measure NaN where nothing is reached."""
    return np.where(values == -np.inf, np.nan, values).astype(np.float32)


def _solved(robot: Robot, settings: MapSettings, points: Array) -> _Found:
    """Solve all poses of points (m, 3), those that the arm's lengths rule out left aside."""
    turns = settings.turns.reshape(-1, 3, 3)
    total = len(points) * len(turns)
    found = _Found(np.zeros(total, np.uint16), np.full((3, total), -np.inf))
    near = _near(robot, settings, points, turns)
    Ts, room, earlier = np.tile(np.eye(4), (PIECE, 1, 1)), np.empty((3, PIECE)), None
    for start in range(0, len(near), PIECE):
        some = near[start : start + PIECE]
        place, turn = np.divmod(some, len(turns))
        m = len(some)
        Ts[:m, :3, :3], Ts[:m, :3, 3] = turns[turn], points[place]
        answer = robot.ik_batch(
            Ts[:m],
            within_limits=settings.within_limits,
            task=settings.task,
            threads=1,
            out=earlier if m == PIECE else None,
        )
        earlier = answer
        best = room if m == PIECE else np.empty((3, m))
        measure(robot, settings.task, answer, best)
        found.ways[some], found.best[:, some] = answer.count, best
    return found


def _near(robot: Robot, settings: MapSettings, points: Array, turns: Array) -> NDArray[np.intp]:
    """Indices, of the poses of points (m, 3) in turns (k, 3, 3), of those within the lengths.

    The tip is within a ball, and where its orientation is kept the last axis, too:
    ``|p + R w - c| <= r``.
    """
    if not bounded(robot, settings.within_limits):
        return np.arange(len(points) * len(turns))
    centre, radius = reach_ball(robot)
    inside = np.square(points - centre).sum(axis=1) <= (radius * FAR) ** 2
    if settings.task != "pose":
        return np.flatnonzero(np.repeat(inside, len(turns)))
    w, centre, radius = last_axis_ball(robot)
    p, v = points[inside] - centre, (turns * w).sum(axis=2)
    limit = (radius * FAR) ** 2 - np.square(p).sum(axis=1) - np.square(w).sum()
    far = 2.0 * p[:, :1] * v[:, 0]
    for e in (1, 2):
        far += 2.0 * p[:, e : e + 1] * v[:, e]
    row, turn = np.nonzero(far <= limit[:, None])
    return np.asarray(np.flatnonzero(inside)[row] * len(turns) + turn)
