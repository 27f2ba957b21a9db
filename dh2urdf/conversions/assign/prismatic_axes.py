"""Where to put the axis of a sliding joint, which has a direction and no place.

Any line of the joint's direction serves: moving it changes the constants of the table and not
the arm. Lines through what is already there are tried, and the table with the fewest non-zero
lengths wins. The usual advice (Paul: through the frame that follows, so that a = 0) is among
them and wins ties.
"""

import math
from collections.abc import Callable, Iterator, Sequence

import numpy as np

from dh2urdf import transforms as tf
from dh2urdf.conversions.assign.axis_pairs import PARALLEL
from dh2urdf.transforms import Array

SWEEPS = 2
"""Times that all sliding joints are placed in turn, since neighbours depend on each other."""

ASIDE = 10.0
"""A sliding joint is drawn at most this many arm's lengths from the joint that follows it."""

Lengths = Callable[[Array], Sequence[float]]


def place_prismatic_axes(
    links: Array, prismatic: Sequence[bool], lengths: Lengths, size: float
) -> Array:
    """Move the axes of sliding joints to where the table becomes simplest.

    Links, shape (n + 1, 4, 4), in and out; ``lengths`` gives all lengths [m] of the table that
    given links lead to, ``size`` is the length of the arm [m].
    """
    sliding = [i for i, slides in enumerate(prismatic) if slides]
    if not sliding:
        return links
    best_cost = _cost(lengths(links), size)
    for _ in range(SWEEPS):
        before = best_cost
        for i in reversed(sliding):
            for x, y in _candidates(links, i):
                if math.hypot(x - links[i + 1][0, 3], y - links[i + 1][1, 3]) > ASIDE * size:
                    continue
                trial = shifted(links, i, x, y)
                cost = _cost(lengths(trial), size)
                if cost < best_cost:
                    links, best_cost = trial, cost
        if best_cost == before:
            break
    return links


def shifted(links: Array, i: int, x: float, y: float) -> Array:
    """The same arm with the frame of sliding joint i (from 0) moved by (x, y) in its plane."""
    out = links.copy()
    out[i] = out[i] @ tf.trans(x, y, 0)
    out[i + 1] = tf.trans(-x, -y, 0) @ out[i + 1]
    return out


def _cost(lengths: Sequence[float], size: float) -> tuple[int, float]:
    """Non-zero lengths first, then their sum, told apart to a millionth of the arm."""
    magnitudes = np.abs(lengths)
    count = int(np.count_nonzero(magnitudes > 1e-9 * size))
    return count, round(float(magnitudes.sum()) / size, 6)


def _candidates(links: Array, i: int) -> Iterator[tuple[float, float]]:
    """Points (x, y) of joint i's own plane to put its axis through, most usual first.

    Seen along the joint, the neighbouring axes are lines or points: the next axis and its own
    origin, the axis before, where the two cross, and the foot from one on the other.
    """
    (p, u), (r, v) = _seen(links[i + 1]), _seen(tf.inverse(links[i]))
    yield p[0], p[1]
    if u is not None:
        yield _foot(r, p, u)
        yield _foot(np.zeros(2), p, u)
    if u is not None and v is not None:
        det = float(u[0] * v[1] - u[1] * v[0])
        if abs(det) > 1e-6:  # where the two cross
            t = float((r - p)[0] * v[1] - (r - p)[1] * v[0]) / det
            yield float(p[0] + t * u[0]), float(p[1] + t * u[1])
    if v is not None:
        yield _foot(p, r, v)
        yield _foot(np.zeros(2), r, v)
    yield r[0], r[1]


def _seen(L: Array) -> tuple[Array, Array | None]:
    """A neighbouring axis seen along z: a point on it and its direction, None for end on."""
    along = L[:2, 2]
    norm = float(np.linalg.norm(along))
    return L[:2, 3], along / norm if norm > PARALLEL else None


def _foot(point: Array, origin: Array, direction: Array) -> tuple[float, float]:
    foot = origin + direction * float(direction @ (point - origin))
    return float(foot[0]), float(foot[1])
