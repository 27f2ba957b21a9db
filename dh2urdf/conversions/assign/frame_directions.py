"""Which way each x axis points: the one choice that frame assignment leaves between equals.

Along a common normal x points away from the axis before it. Where two axes intersect it may
point either way, and a choice made at one joint is felt at the next, so the choices are made
together: of all combinations the one with the fewest non-zero theta at q = 0, then the
smallest ones, then zeros as early as can be. Two states a pair make that a shortest path.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

from dh2urdf import transforms as tf
from dh2urdf.conversions.assign.axis_pairs import AxisPair, Normal, flipped, wrap
from dh2urdf.conversions.assign.frame_ends import End

HALF_TURN = 1e-3
"""Angle [rad] that a theta may be off 0 or a half turn and still count as one.

Wide enough for angles written with three digits; a choice is made by it, no number changed.
"""

Cost = tuple[int, int, tuple[int, ...]]
Ends = Callable[[float], tuple[End, ...]]


class Directions(NamedTuple):
    """Choices up to one axis: every theta [rad], the factorisations as turned, what is left.

    ``phi`` is the turn left over about the axis [rad]; ``open`` means that its theta will be 0,
    whatever comes.
    """

    theta: tuple[float, ...]
    normals: tuple[Normal, ...]
    phi: float | None
    open: bool


def choose_directions(
    phi: float | None,
    pairs: Sequence[AxisPair],
    normals: Sequence[Normal],
    ends: Ends,
    prismatic: Sequence[bool],
    strict: bool,
) -> tuple[Directions, End]:
    """Turn the factorisations of all pairs so that the table gets simplest.

    ``phi`` is the turn about axis 1 that the base leaves [rad], None where frame 0 is free to
    turn; ``ends`` gives the choices of frame n for a turn left over about the last axis;
    ``strict`` keeps x away from the axis before it even where that costs theta a half turn.
    """
    paths = [Directions((), (), phi, phi is None)]
    for i, (pair, normal) in enumerate(zip(pairs, normals, strict=True)):
        slide_first = prismatic[i] and not prismatic[i + 1]
        steps = [
            _step(path, turned, pair.any_direction and slide_first)
            for path in paths
            for turned in _ways(path, pair, normal, strict)
        ]
        paths = _best_by_end(steps)
    complete = [(_settle(path, end.phi1), end) for path in paths for end in ends(path.phi or 0.0)]
    return min(complete, key=_cost_with_end)


def _cost_with_end(choice: tuple[Directions, End]) -> Cost:
    """What a complete choice costs: turns that the tool is left with count as theta do."""
    leftover = sum(abs(angle) > HALF_TURN for angle in tf.matrix_to_rpy(choice[1].tool))
    return _cost(choice[0].theta, leftover)


def _ways(path: Directions, pair: AxisPair, normal: Normal, strict: bool) -> Iterator[Normal]:
    """The directions of x that one pair allows after the choices before it."""
    if pair.any_direction:
        swing = -(path.phi or 0.0) - normal.phi1
        yield _swung(normal, swing, pair.opposed)
        return
    other = flipped(normal)
    if normal.a == 0:
        yield from (normal, other) if normal.alpha > 0 else (other, normal)
        return
    away, back = (normal, other) if normal.a > 0 else (other, normal)
    half = not path.open and abs(wrap((path.phi or 0.0) + away.phi1)) > math.pi - HALF_TURN
    yield back if half and not strict else away


def _step(path: Directions, normal: Normal, leave_open: bool) -> Directions:
    """Extend a path by one pair."""
    settled = _settle(path, normal.phi1)
    return settled._replace(normals=(*settled.normals, normal), phi=normal.phi2, open=leave_open)


def _settle(path: Directions, phi1: float) -> Directions:
    """Add the theta of the axis that the path ended on."""
    normals, theta = path.normals, path.theta
    value = wrap((path.phi or 0.0) + phi1)
    if path.open and normals:
        opposed = abs(normals[-1].alpha) > 1.0
        swing = -value if opposed else value
        normals = (*normals[:-1], _swung(normals[-1], swing, opposed))
        theta = (*theta[:-1], wrap(theta[-1] + swing))
    settled = 0.0 if path.open and normals else value
    return Directions((*theta, settled), normals, path.phi, path.open)


def _swung(normal: Normal, swing: float, opposed: bool) -> Normal:
    """x turned by ``swing`` about an axis that the next one shares."""
    back = swing if opposed else -swing
    return normal._replace(phi1=normal.phi1 + swing, phi2=normal.phi2 + back)


def _best_by_end(paths: Sequence[Directions]) -> list[Directions]:
    """Of the paths that leave the same turn, the cheapest."""
    best: list[Directions] = []
    for path in paths:
        for k, other in enumerate(best):
            turn = wrap((path.phi or 0.0) - (other.phi or 0.0))
            if path.open == other.open and abs(turn) < HALF_TURN:
                if _cost(path.theta) < _cost(other.theta):
                    best[k] = path
                break
        else:
            best.append(path)
    return best


def _cost(theta: Sequence[float], leftover: int = 0) -> Cost:
    """What a choice costs: how many theta are not 0, how large, how early."""
    steps = tuple(round(abs(value) / HALF_TURN) for value in theta)
    return sum(step > 0 for step in steps) + leftover, sum(steps), steps
