"""Laying the joint axes of one arm on those of another, one after the other.

Two arms are the same up to base, tool, zeros and directions of joints if, and only if, the screw
axes of the second, at some configuration and with some of them turned round, are those of the
first moved as one body. The axes are placed in order. Each finds what `freedom` has left: a twist
and a distance that must be there already, and an angle and a slide that place it. Axes that could
point either way are followed both ways.
"""

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from dh2urdf.chain import SerialChain
from dh2urdf.comparison.freedom import Axes, Freedom
from dh2urdf.comparison.relation import NOTHING, Relation
from dh2urdf.transforms import Array, pose, product, rotation

WAYS = 64
"""Ways that are followed at once: axes that may point either way leave two or four."""

ALONG = 1e-6
"""Sine of the angle to an axis at which a slide is along it and closes no gap across it."""


class _Way(NamedTuple):
    """B placed so far: its base and the pose of what is behind the last joint, both in A's base."""

    base: Array
    behind: Array
    directions: tuple[int, ...]
    offsets: tuple[float, ...]


def aligned(a: SerialChain, b: SerialChain, slack: float) -> list[Relation]:
    """Relations that lay every axis of B on its axis of A, up to a slack; likely ones.

    ``slack`` is an angle [rad] and a length in sizes of the arm; the tool follows from q = 0. What
    is found has yet to be measured: only the axes were looked at, one by one.
    """
    ways = list(_layers(a, b, slack))
    return [
        Relation(way.base, np.eye(4), np.array(way.directions, float), np.array(way.offsets))
        for way in (ways[-1] if len(ways) == a.n else ())
    ]


def axes_that_agree(a: SerialChain, b: SerialChain, slack: float) -> int:
    """How many of the first axes of two arms can be laid on each other."""
    return sum(1 for _ in _layers(a, b, slack))


def _layers(a: SerialChain, b: SerialChain, slack: float) -> Iterator[list[_Way]]:
    """The ways to place axis 1, axes 1 and 2, ..., as long as there are any."""
    here, there = Axes(a, slack), Axes(b, slack)
    ways = [_first(here, there, sign) for sign in (1, -1)]
    for k in range(min(a.n, b.n)):
        if here.prismatic[k] != there.prismatic[k]:
            return
        if k > 0:
            before = here.freedom(k)
            placed = [
                new
                for way in ways
                for sign in (1, -1)
                for new in _place(way, here, there, before, k, sign)
            ]
            distinct = dict[bytes, _Way]()
            for way in sorted(placed, key=_told):
                distinct.setdefault(_key(way, here, here.freedom(k + 1)), way)
            ways = list(distinct.values())[:WAYS]
        if not ways:
            return
        yield ways


def _told(way: _Way) -> int:
    """How many joints something has to be said of."""
    return sum(s < 0 or abs(x) > NOTHING for s, x in zip(way.directions, way.offsets, strict=True))


def _first(a: Axes, b: Axes, sign: int) -> _Way:
    """B moved so that its first axis lies on A's, by no more than it takes."""
    target = sign * a.u[0]
    R = _shortest_turn(b.u[0], target)
    off = a.p[0] - R @ b.p[0]
    shift = np.zeros(3) if a.prismatic[0] else off - a.u[0] * (a.u[0] @ off)
    base = pose(R, shift)
    zeros = (0.0,) * len(a.u)
    return _Way(base, base, (sign, *(1,) * (len(a.u) - 1)), zeros)


def _shortest_turn(u: Array, target: Array) -> Array:
    """Rotation (3, 3) of the least angle that takes one direction to another."""
    axis = np.cross(u, target)
    sine, cosine = float(np.linalg.norm(axis)), float(u @ target)
    if sine > 1e-12:
        return rotation(axis / sine, math.atan2(sine, cosine))
    if cosine > 0:
        return np.eye(3)
    across = np.cross(u, np.eye(3)[np.argmin(np.abs(u))])
    return rotation(across / np.linalg.norm(across), math.pi)


def _place(way: _Way, a: Axes, b: Axes, freedom: Freedom, k: int, sign: int) -> Iterator[_Way]:
    """The way with axis k placed and pointing one way; nothing where it does not fit."""
    R, t = way.behind[:3, :3], way.behind[:3, 3]
    u, p, target = R @ b.u[k], R @ b.p[k] + t, sign * a.u[k]
    angle = _turn(freedom, u, p, a, k, sign)
    moved = way
    if angle and freedom.turn is not None:
        axis, point, joint = freedom.turn
        Q = rotation(axis, angle)
        moved = _moved(moved, pose(Q, point - Q @ point), joint, angle)
        u, p = Q @ u, Q @ (p - point) + point
    if math.atan2(float(np.linalg.norm(np.cross(u, target))), float(u @ target)) > a.slack:
        return
    if not a.prismatic[k]:
        off = a.p[k] - p
        steps = _slides(freedom, off - a.u[k] * (a.u[k] @ off), a.u[k], a.length)
        if steps is None:
            return
        for (direction, joint), step in zip(freedom.slides, steps, strict=True):
            if step:
                moved = _moved(moved, pose(np.eye(3), step * direction), joint, step)
    directions = (*moved.directions[:k], sign, *moved.directions[k + 1 :])
    yield moved._replace(directions=directions)


def _moved(way: _Way, motion: Array, joint: int | None, value: float) -> _Way:
    """What is behind moved, by a joint or with the whole arm."""
    behind = product(motion, way.behind)
    if joint is None:
        return way._replace(base=product(motion, way.base), behind=behind)
    offsets = list(way.offsets)
    offsets[joint] += way.directions[joint] * value
    return way._replace(behind=behind, offsets=tuple(offsets))


def _turn(freedom: Freedom, u: Array, p: Array, a: Axes, k: int, sign: int) -> float:
    """Angle [rad] about the free axis that takes a line to axis k of A, as far as it can."""
    if freedom.turn is None:
        return 0.0
    axis, point, _ = freedom.turn
    flat = [v - axis * (axis @ v) for v in (u, sign * a.u[k])]
    if min(np.linalg.norm(v) for v in flat) <= a.slack:
        if a.prismatic[k] or any(abs(v @ axis) < 0.5 for v, _ in freedom.slides):
            return 0.0
        flat = [v - axis * (axis @ v) for v in (p - point, a.p[k] - point)]
        if min(np.linalg.norm(v) for v in flat) <= a.length:
            return 0.0
    return math.atan2(float(axis @ np.cross(flat[0], flat[1])), float(flat[0] @ flat[1]))


def _slides(freedom: Freedom, off: Array, axis: Array, length: float) -> Array | None:
    """Steps [m] of the free slides that close a gap across an axis; None where none do.

    Joints close it where they can, the base where they cannot.
    """
    steps = np.zeros(len(freedom.slides))
    if np.linalg.norm(off) <= length and not freedom.slides:
        return steps
    across = np.array([v - axis * (axis @ v) for v, _ in freedom.slides]).reshape(-1, 3)
    across[np.linalg.norm(across, axis=1) <= ALONG] = 0.0
    joints = np.array([joint is not None for _, joint in freedom.slides], dtype=bool)
    for use in (joints, np.ones_like(joints)):
        if use.any():
            steps[use] = np.linalg.lstsq(across[use].T, off, rcond=1e-6)[0]
        if np.linalg.norm(off - steps @ across) <= length:
            return steps
    return None


def _key(way: _Way, a: Axes, freedom: Freedom) -> bytes:
    """The same for ways between which what is free makes no difference to the axes to come."""
    R, t = way.behind[:3, :3], way.behind[:3, 3]
    axis, point = (a.u[-1], a.p[-1]) if freedom.turn is None else freedom.turn[:2]
    off = point - t
    if freedom.slides:
        span = np.linalg.svd(np.array([v for v, _ in freedom.slides]))
        free = span[2][: (span[1] > 1e-6).sum()]
        off = off - free.T @ (free @ off)
    seen = R if freedom.turn is None else R.T @ axis
    key = np.concatenate([np.ravel(seen), R.T @ off / a.size])
    return np.round(key / (10 * a.slack)).astype(np.int64).tobytes()
