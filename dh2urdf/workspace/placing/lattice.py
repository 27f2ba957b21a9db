"""The bases that are tried: a lattice of places, heights and yaws, then finer ones at the best."""

import math
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dh2urdf.transforms import Array
from dh2urdf.workspace.placing.job import Job
from dh2urdf.workspace.refine import Progress
from dh2urdf.workspace.section import reach_ball

STEPS_TO_REACH, MOST_STEPS = 12, 60
"""Places in a row out to the arm's reach, and at most in a row."""

YAWS = 24
"""Turns of the base tried at each place: 15 degrees apart."""

AT_ONCE = 64
"""Poses of a job that all bases are asked for before those that miss any are left aside."""

BEAM = (192, 96, 48, 24, 12, 12, 12, 12, 12, 12)
"""Bases about which each finer lattice is laid, half as wide as the one before."""

SOUGHT, ASKED, SEEKING = 384, 100_000, 6
"""Such bases while none reaches all poses, how many poses a lattice asks for then, about, and the
number of lattices in which that is sought: down to a quarter of a degree."""


@dataclass(frozen=True, eq=False)
class BaseMap:
    """What bases are worth for a job, over a lattice of places: the inverse map of the arm.

    Parameters
    ----------
    x, y : array
        Coordinates of columns and rows in the world [m].
    margin : array, shape (len(y), len(x))
        Largest margin of a base at that place, over its heights and yaws; 0 where none of them
        reaches all poses.
    reached : array, shape (len(y), len(x))
        Largest share of the poses reached from there.
    z, yaw : array, shape (len(y), len(x))
        Height [m] and turn [rad] of that base.
    """

    x: Array
    y: Array
    margin: Array
    reached: Array
    z: Array
    yaw: Array


class Lattice(NamedTuple):
    """Values along x, y, z and yaw, and the steps between them; a step of 0 stays."""

    axes: tuple[Array, Array, Array, Array]
    steps: Array

    def bases(self) -> Array:
        """All of them, rows of (x, y, z, yaw), x and y outermost."""
        grid = np.meshgrid(*self.axes, indexing="ij")
        return np.stack([part.ravel() for part in grid], axis=1)


def lattice_of(job: Job, region: Array) -> Lattice:
    """The first lattice over a region (4, 2) of x, y, z [m] and yaw [rad]."""
    radius, axes, steps = reach_ball(job.robot)[1], [], []
    for k, (low, high) in enumerate(region.tolist()):
        wide = high - low
        if k == 3:
            count = max(1, math.ceil(wide / (2 * math.pi / YAWS) - 1e-9))
            whole = wide >= 2 * math.pi - 1e-9
            values = low + np.arange(count + (not whole)) * (wide / count)
        else:
            count = min(math.ceil(wide / (radius / STEPS_TO_REACH) - 1e-9), MOST_STEPS)
            values = np.linspace(low, high, count + 1)
        values = values if wide > 0.0 else np.array([low])
        axes.append(values)
        steps.append(float(values[1] - values[0]) if len(values) > 1 else 0.0)
    return Lattice((axes[0], axes[1], axes[2], axes[3]), np.array(steps))


def missed(job: Job, bases: Array, tell: Progress) -> NDArray[np.int64]:
    """How many poses bases (k, 4) miss; where some reach all, of the others how many at least."""
    order = _spread(job.T_world_tool[:, :3, 3])
    out, seen = np.zeros(len(bases), np.int64), np.zeros(len(bases), np.int64)

    def count(asked: NDArray[np.intp], until: int, at_once: int) -> None:
        """Ask these bases, all of which have seen as many poses, for those up to some number."""
        before = seen[asked[0]]
        some = order[before:until]
        parts = _some_at_a_time(asked, at_once)
        for k, rows in enumerate(parts):
            share = len(some) / len(order) / len(parts)
            told = partial(_tell_part, tell, before / len(order) + k * share, share)
            hit = job.reached(bases[np.repeat(rows, len(some))], np.tile(some, len(rows)), told)
            out[rows] += (~hit).reshape(len(rows), -1).sum(axis=1)
            seen[rows] = until

    left = np.arange(len(bases))
    for start in range(0, len(order), AT_ONCE):
        count(left, min(start + AT_ONCE, len(order)), AT_ONCE)
        left = left[out[left] == 0]
        if not len(left):
            break
    if not len(left):
        for until in np.unique(seen[seen < len(order)]).tolist():
            count(np.flatnonzero(seen == until), len(order), len(order))
    return out


def _tell_part(tell: Progress, done: float, part: float, now: int, total: int) -> None:
    """Progress of a part of the whole, in thousandths."""
    tell(int(1000 * (done + part * now / total)), 1000)


def worth(job: Job, bases: Array, tell: Progress) -> tuple[NDArray[np.int64], Array]:
    """Poses missed and margin, each (k,), of bases (k, 4); the margin is 0 where any is missed."""
    count = missed(job, bases, tell)
    margin = np.zeros(len(bases))
    good = np.flatnonzero(count == 0)
    done = 0
    for part in _some_at_a_time(good, len(job)):
        which = np.tile(np.arange(len(job)), len(part))
        each, _ = job.margins(bases[np.repeat(part, len(job))], which, lambda *_: None)
        margin[part] = each.reshape(len(part), -1).min(axis=1)
        done += len(part)
        tell(done, len(good))
    return count, margin


def map_of(
    lattice: Lattice, bases: Array, count: NDArray[np.int64], margin: Array, m: int
) -> BaseMap:
    """The best base at each place of a lattice."""
    nx, ny = len(lattice.axes[0]), len(lattice.axes[1])
    rank = (m - count) + np.minimum(margin, 1.0) / 2
    best = rank.reshape(nx * ny, -1).argmax(axis=1) + np.arange(nx * ny) * (len(bases) // (nx * ny))
    fields = margin[best], 1.0 - count[best] / m, bases[best, 2], bases[best, 3]
    margin_, reached, z, yaw = (field.reshape(nx, ny).T.copy() for field in fields)
    return BaseMap(lattice.axes[0], lattice.axes[1], margin_, reached, z, yaw)


def finer(
    job: Job,
    lattice: Lattice,
    bases: Array,
    count: NDArray[np.int64],
    margin: Array,
    region: Array,
    tell: Progress,
) -> tuple[Array, int]:
    """The best base (4,) of ever finer lattices about the best ones, and how many were tried.

    Of bases that miss as many poses a mix is taken, from all over the region.
    """
    steps, tried, rng = lattice.steps, len(bases), np.random.default_rng(0)
    sides = [[-1, 0, 1] if step else [0] for step in steps]
    moves = np.stack(np.meshgrid(*sides, indexing="ij"), -1).reshape(-1, 4)
    for level, least in enumerate(BEAM):
        sought = min(SOUGHT, ASKED // (len(moves) * len(job))) if level < SEEKING else 0
        width = max(least, sought) if count.all() else least
        order = np.lexsort((rng.permutation(len(bases)), -margin, count))[:width]
        steps = steps / 2
        new = (bases[order, None] + moves * steps).reshape(-1, 4)
        new = np.clip(new, region[:, 0], region[:, 1])
        new = np.unique(np.concatenate([bases[order], new.round(12)]), axis=0)
        count, margin = worth(job, new, lambda *_: None)
        bases, tried = new, tried + len(new)
        tell(level + 1, len(BEAM))
    best = np.lexsort((-margin, count))[0]
    return bases[best], tried


def _spread(points: Array) -> NDArray[np.intp]:
    """Indices of points (m, 3), those far from all before them first."""
    m = len(points)
    if m <= AT_ONCE:
        return np.arange(m)
    gap = np.linalg.norm(points - points.mean(axis=0), axis=1)
    order = [int(gap.argmax())]
    gap = np.linalg.norm(points - points[order[0]], axis=1)
    for _ in range(AT_ONCE - 1):
        order.append(int(gap.argmax()))
        gap = np.minimum(gap, np.linalg.norm(points - points[order[-1]], axis=1))
    rest = np.setdiff1d(np.arange(m), order)
    return np.concatenate([np.unique(order), rest]).astype(np.intp)


def _some_at_a_time(rows: NDArray[np.intp], m: int) -> list[NDArray[np.intp]]:
    """Rows, so many at a time that they have some 100,000 poses."""
    step = max(1, 100_000 // m)
    return [rows[start : start + step] for start in range(0, len(rows), step)]
