"""Parallelograms beside the links that they move, drawn where a coupling keeps a direction.

Turning a joint turns all that comes after it, but where others take it back: the forearm of a
palletiser keeps its direction while the upper arm moves, the flange stays level. Rods do that, each
a parallelogram with the link beside it: ``crank`` and opposite side keep the direction of the link
that is kept, the rod that of the link that moves.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from dh2urdf.conversions.write import Body, frame_along
from dh2urdf.dh import DHConvention, DHTable, JointType
from dh2urdf.transforms import Array, pose

PARALLEL = 1e-9
"""Sine of the angle between axes that one parallelogram may join, and rounding of turns that
cancel."""

APART = 1e-9
"""Distance of axes [m] that are one."""

CRANK = 0.3
"""Length of a crank over that of the shortest link beside it."""

THIN = 0.3
"""Radius of a bar over that of the thinnest drum on the way."""

TOWARD = np.array([0.80, -1.0, 0.62])
"""Side on which the first parallelogram stands: where the eye is at first."""

BAD_ANGLE = 0.35
"""Sine of the least angle between a crank that goes on along the next link and its rod."""


@dataclass(frozen=True, eq=False)
class Bar:
    """A bar of a parallelogram.

    Parameters
    ----------
    turn, at, keep : int
        DH frames: it is turned as ``turn``, and begins at ``point`` of ``at``, moved by ``shift``
        of ``keep``.
    point, shift : array, shape (3,)
    along : array, shape (3,)
        From where it begins to where it ends, in the axes of ``turn``; so are ``bodies``.
    """

    turn: int
    at: int
    point: Array
    keep: int
    shift: Array
    along: Array
    bodies: list[Body]

    def pose(self, frames: Array) -> Array:
        """``T_base_bar`` of DH frames (n + 1, 4, 4) in base."""
        place = frames[self.at][:3, :3] @ self.point + frames[self.at][:3, 3]
        return pose(frames[self.turn][:3, :3], place + frames[self.keep][:3, :3] @ self.shift)


@dataclass(frozen=True, eq=False)
class _Place:
    """An axis and the joints on it, from 1: its first and last, a point of it in base at zero."""

    first: int
    last: int
    point: Array


def linkage_bars(table: DHTable, bodies: Sequence[Sequence[Body]]) -> list[Bar]:
    """The bars of all parallelograms of a table, beside its drawn bodies."""
    if table.joint_map is None:
        return []
    frames = table.frames(np.zeros(table.n))
    on = 1 if table.convention is DHConvention.STANDARD else 0
    axes = frames[1 - on : len(frames) - on]  # of joint i in place i - 1
    out, side = list[Bar](), 1.0
    for run in _runs(table, axes):
        for kept, places, after in sorted(_kept(table, axes, run), key=lambda k: -len(k[1])):
            out += _bars(frames, axes[run[0] - 1][:3, 2], side, kept, places, after, bodies)
            side = -side
    return out


def _runs(table: DHTable, axes: Array) -> Iterator[list[int]]:
    """Joints, from 1, that turn about parallel axes one after another."""
    run: list[int] = []
    for i, row in enumerate(table.joints, 1):
        turns = row.joint_type is JointType.REVOLUTE
        cross = np.cross(axes[i - 1][:3, 2], axes[run[-1] - 1][:3, 2]) if run else np.zeros(3)
        if not turns or float(np.linalg.norm(cross)) > PARALLEL:
            yield run
            run = []
        run = [*run, i] if turns else run
    yield run


def _kept(
    table: DHTable, axes: Array, run: list[int]
) -> Iterator[tuple[int, list[_Place], Array | None]]:
    """Of a run: each joint after which some values no longer turn.

    With it the axes from the first joint that these move, and the way to the next axis, if any.
    """
    if len(run) < 2 or table.joint_map is None:
        return
    z = axes[run[0] - 1][:3, 2]
    signs = [table.joints[i - 1].sign * np.sign(axes[i - 1][:3, 2] @ z) for i in run]
    turned = np.cumsum(table.joint_map.matrix[[i - 1 for i in run]] * np.c_[signs], axis=0)
    moved = np.maximum.accumulate(np.abs(turned), axis=0) > PARALLEL
    still = moved & (np.abs(turned) <= PARALLEL)
    places = _places(axes, run)
    for number, place in enumerate(places):
        on_it = range(run.index(place.first), run.index(place.last) + 1)
        k = max(on_it, key=lambda k: (still[k].sum(), k))
        values = np.flatnonzero(still[k])
        if not len(values):
            continue
        first = run[int(np.argmax(moved[:, values].any(axis=1)))]
        passed = [p for p in places[: number + 1] if p.last >= first]
        after = places[number + 1].point - place.point if number + 1 < len(places) else None
        if len(passed) > 1:
            yield run[k], passed, after


def _places(axes: Array, run: list[int]) -> list[_Place]:
    """The different axes of a run, their points in one plane across them."""
    out: list[_Place] = []
    z, level = axes[run[0] - 1][:3, 2], axes[run[0] - 1][:3, 3]
    for i in run:
        point = axes[i - 1][:3, 3]
        point = point - z * float(z @ (point - level))
        if out and float(np.linalg.norm(point - out[-1].point)) <= APART:
            out[-1] = _Place(out[-1].first, i, out[-1].point)
        else:
            out.append(_Place(i, i, point))
    return out


def _bars(
    frames: Array,
    z: Array,
    side: float,
    kept: int,
    places: list[_Place],
    after: Array | None,
    bodies: Sequence[Sequence[Body]],
) -> Iterator[Bar]:
    """Cranks at every axis and rods from each to the next, beside the drums of their joints."""
    drums = [b for p in places for b in bodies[p.first] if b.material == "joint"]
    width = max((b.size[-1] for b in drums), default=0.0) / 2
    radius = THIN * min((b.size[0] for b in drums), default=0.01)
    side *= 1.0 if float(z @ TOWARD) >= 0 else -1.0
    beside = side * (width + 1.5 * radius) * z
    legs = [b.point - a.point for a, b in pairwise(places)]
    crank = CRANK * min(map(np.linalg.norm, legs)) * _crank(z, legs, after)
    for place in places:
        yield _bar(frames, kept, place, beside, crank, kept, np.zeros(3), radius)
    outside = beside + side * 2.2 * radius * z
    for leg, place in zip(legs, places, strict=False):
        yield _bar(frames, place.last, place, outside, leg, kept, crank, radius)


def _bar(
    frames: Array,
    turn: int,
    place: _Place,
    beside: Array,
    along: Array,
    keep: int,
    shift: Array,
    radius: float,
) -> Bar:
    """A bar of vectors that are in base with all joints at zero."""
    at, own = frames[place.first], frames[turn][:3, :3].T @ along
    point = at[:3, :3].T @ (place.point + beside - at[:3, 3])
    length = float(np.linalg.norm(along))
    rod = Body("cylinder", (radius, length), pose(frame_along(own / length), own / 2), "bar")
    ends = [Body("sphere", (1.3 * radius,), pose(np.eye(3), p), "bar") for p in (0 * own, own)]
    knobs = ends if turn == keep else []
    moved = frames[keep][:3, :3].T @ shift
    return Bar(turn, place.first, point, keep, moved, own, [rod, *knobs])


def _crank(z: Array, legs: list[Array], after: Array | None) -> Array:
    """Direction of the cranks: back along the link that is kept, or well across all rods."""
    ways = [leg / np.linalg.norm(leg) for leg in legs]

    def across(u: Array) -> float:
        return min(float(np.linalg.norm(np.cross(u, way))) for way in ways)

    if after is not None:
        back = -after / np.linalg.norm(after)
        if across(back) >= BAD_ANGLE:
            return np.asarray(back)
    x, y = frame_along(z)[:, 0], frame_along(z)[:, 1]
    around = [np.cos(t) * x + np.sin(t) * y for t in np.linspace(0, 2 * np.pi, 16, endpoint=False)]
    return max(around, key=lambda u: across(u) + 0.1 * float(u[2]) - 0.05 * float(u @ ways[-1]))
