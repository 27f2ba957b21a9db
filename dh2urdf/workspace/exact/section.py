"""The section of all places of the wrist point, in radius and height about axis 1.

The place of three joints is a map of joints 2 and 3 to radius and height; its folds are where the
determinant of the position Jacobian is zero, and all else that can bound its image are the limits
(Kohli and Hsu, "The Jacobian analysis of workspaces of mechanical manipulators", Mech. Mach. Theory
22, 1987; Ceccarelli, "A formulation for the workspace boundary of general N-revolute manipulators",
Mech. Mach. Theory 31, 1996).
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dh2urdf.doors import finite_array, flag
from dh2urdf.exceptions import ArgumentError
from dh2urdf.ik.problem import IKBatch
from dh2urdf.ik.solve import InverseKinematics
from dh2urdf.robot import Robot
from dh2urdf.transforms import Array
from dh2urdf.workspace.exact.boundary import Curve, Reached, pieces_of, rings_of, without_doubles
from dh2urdf.workspace.exact.carried_point import CarriedPoint, carried_point
from dh2urdf.workspace.exact.extremes import bounds_of
from dh2urdf.workspace.exact.zero_curves import zero_curves

LINES = 721
"""Lines of the grid along each joint on which folds are found: half a degree apart."""

START = 0.1234567
"""Where a full turn begins [rad]: folds lie at round angles, and would run along the grid."""

SLIVER = 1e-8
"""Rings of a smaller area are thinner than what is told apart [sizes^2]."""

INSIDE = 1e-9
"""How far inside the limits the grid begins, for the same reason [ranges]."""


@dataclass(frozen=True, eq=False)
class Ring:
    """A closed curve that bounds the reach, which is on its left: outlines run counter-clockwise.

    Parameters
    ----------
    points : array, shape (k, 2)
        Radius and height of its corners [m], all on the boundary; the last leads to the first.
    between : array, shape (k, 2)
        A point of the boundary on the way from each corner to the next.
    kinds : tuple of k str
        What each corner is on: ``fold`` where the Jacobian is singular, ``axis`` 1, or the limit,
        ``joint_3 upper``.
    starts : tuple of int
        Corners at which a piece of another curve, or of the same one, begins.
    """

    points: Array
    between: Array
    kinds: tuple[str, ...]
    starts: tuple[int, ...] = (0,)

    @property
    def area(self) -> float:
        """Of the polygon of all points, negative for a void [m^2]."""
        r, z = self.through.T
        return float((r * np.roll(z, -1) - np.roll(r, -1) * z).sum() / 2)

    @property
    def through(self) -> Array:
        """Corners and the points between them, in turn, (2 k, 2)."""
        return np.stack([self.points, self.between], axis=1).reshape(-1, 2)


@dataclass(frozen=True, eq=False)
class ReachSection:
    """What a point reaches in a half plane through axis 1.

    Parameters
    ----------
    point : str
        ``wrist point`` or ``tip``.
    T_base_axis : array, shape (4, 4)
        Frame of radius and height: its z is axis 1, its origin the shoulder.
    rings : tuple of Ring
        Outlines and voids.
    within_limits : bool
    """

    point: str
    T_base_axis: Array
    rings: tuple[Ring, ...]
    within_limits: bool

    @property
    def voids(self) -> tuple[Ring, ...]:
        """Rings around what is not reached."""
        return tuple(ring for ring in self.rings if ring.area < 0.0)

    @property
    def area(self) -> float:
        """Of what is reached [m^2]."""
        return sum(ring.area for ring in self.rings)

    def holds(self, places: ArrayLike) -> NDArray[np.bool_]:
        """Whether places (..., 2) of radius and height [m] are reached, shape (...).

        By the polygons, whose chords are off the boundary by a millionth of the arm's size.
        """
        spots = finite_array(places, "places", "numbers of shape (..., 2)")
        if spots.ndim < 1 or spots.shape[-1] != 2:
            raise ArgumentError(f"places: expected shape (..., 2), got {spots.shape}")
        r, z = spots.reshape(-1, 2).T
        order = np.argsort(z)
        x, y = r[order], z[order]
        inside = np.zeros(len(x), np.bool_)
        for ring in self.rings:
            start, end = ring.through, np.roll(ring.through, -1, axis=0)
            first, last = (np.searchsorted(y, f(start[:, 1], end[:, 1])).tolist()
                           for f in (np.minimum, np.maximum))  # fmt: skip
            for k in np.flatnonzero(np.subtract(last, first)).tolist():
                (ax, ay), (bx, by), part = start[k], end[k], slice(first[k], last[k])
                inside[part] ^= x[part] < ax + (bx - ax) * (y[part] - ay) / (by - ay)
        out = np.empty(len(x), np.bool_)
        out[order] = inside
        return out.reshape(spots.shape[:-1])


def reach_section(robot: Robot, *, within_limits: bool = True) -> ReachSection:
    """The exact section of the wrist point's reach, outlines and voids.

    Radius is the distance from axis 1, height is along it from the shoulder. A place counts as
    reached if it is at some angle of joint 1, the limits of which only turn the section less far.

    Parameters
    ----------
    robot : Robot
        Three joints that place the tip, or five or six of which three place the wrist point
        (:func:`extreme_reach` says what that is); the first turns.
    within_limits : bool
        Keep the limits of joints that turn; those that slide always keep theirs.

    Raises
    ------
    ArgumentError
        The arm is of another kind; its point stays on a surface; a slide has no limits.

    Examples
    --------
    >>> from dh2urdf import Robot
    >>> from dh2urdf.workspace import reach_section
    >>> found = reach_section(Robot.from_dh("puma560"), within_limits=False)
    >>> found.point, len(found.rings), round(found.area, 4)
    ('wrist point', 1, 0.9463)
    """
    carried = carried_point(robot, "wrist")
    if carried.chain.n != 3 or carried.chain.prismatic[0]:
        raise ArgumentError(f"{robot.model.name}: a section needs a first joint that turns")
    low, high = bounds_of(carried, flag(within_limits, "within_limits"))
    size = carried.chain.size
    reached = _reached(carried, low, high)
    curves = _curves(carried, low, high)
    pieces = [piece for curve in curves for piece in pieces_of(curve, reached, size)]
    joined = rings_of(without_doubles(pieces, size), size)
    rings = []
    for ring in joined:
        points = np.concatenate([piece.image for piece in ring])
        gaps = [(p.image[-1] + q.image[:1]) / 2 for p, q in zip(ring, [*ring[1:], ring[0]],
                                                               strict=True)]  # fmt: skip
        inner = [p.curve.image(p.curve.middles(p.points)) for p in ring]
        between = np.concatenate([x for pair in zip(inner, gaps, strict=True) for x in pair])
        kinds = tuple(piece.curve.kind for piece in ring for _ in piece.image)
        counts = np.cumsum([len(piece.image) for piece in ring])
        rings.append(Ring(points, between, kinds, (0, *counts[:-1].tolist())))
    rings = [ring for ring in rings if abs(ring.area) > SLIVER * size**2]
    rings.sort(key=lambda ring: -ring.area)
    return ReachSection(carried.name, carried.T_base_axis, tuple(rings), within_limits)


def _same(places: Array) -> Array:
    return places


def place_solver(carried: CarriedPoint, low: Array, high: Array) -> Callable[[Array], IKBatch]:
    """The inverse kinematics of three joints at places (k, 2) of the section, joint 1 unlimited."""
    free = np.array([True, False, False])
    lower, upper = np.where(free, -np.inf, low), np.where(free, np.inf, high)
    chain = replace(carried.chain, lower=lower, upper=upper)
    solver = InverseKinematics(chain, None, lambda q: chain.fk(q[0])[None])
    asked = "position", None, True, None, False

    def solve(places: Array) -> IKBatch:
        T = np.tile(np.eye(4), (len(places), 1, 1))
        T[:, 0, 3], T[:, 2, 3] = places[:, 0], places[:, 1]
        return solver.solve_batch(T, asked, None, None, "raise", None)

    return solve


def _reached(carried: CarriedPoint, low: Array, high: Array) -> Reached:
    """Whether a place is reached, at some angle of joint 1."""
    solve = place_solver(carried, low, high)

    def reached(places: Array) -> NDArray[np.bool_]:
        out = places[:, 0] > 0.0
        if len(places):
            out &= solve(places).count > 0
        return np.asarray(out)

    return reached


def _curves(carried: CarriedPoint, low: Array, high: Array) -> list[Curve]:
    """Folds, limits and axis 1."""
    slides, size = carried.chain.prismatic[1:], carried.chain.size
    whole = ~slides & (high - low >= 2 * math.pi - 1e-9)[1:]
    ranges = [(START, START + 2 * math.pi) if free else (float(a), float(b))
              for free, a, b in zip(whole, low[1:], high[1:], strict=True)]  # fmt: skip

    def at(q: Array) -> Array:
        return np.column_stack([np.zeros(len(q)), q])

    def image(q: Array) -> Array:
        p = carried.places(at(q))
        return np.stack([np.hypot(p[:, 0], p[:, 1]), p[:, 2]], axis=1)

    def fold(q: Array) -> Array:
        return np.asarray(np.linalg.det(carried.jacobians(at(q))[0])) / size**2

    trial = np.random.default_rng(0).random((200, 2))
    a, b = np.array(ranges).T
    if np.abs(fold(a + trial * (b - a))).max() < 1e-9 * size:
        raise ArgumentError(f"the {carried.name} stays on a surface: it has no section")
    lines = [np.linspace(s + INSIDE * (t - s) * (not w), t - INSIDE * (t - s) * (not w), LINES)
             for (s, t), w in zip(ranges, whole, strict=True)]  # fmt: skip
    curves = [Curve("fold", line, image, fold) for line in zero_curves(fold, (lines[0], lines[1]))]
    for k in (0, 1):
        for end, word in enumerate(("lower", "upper") if not whole[k] else ()):
            points = np.column_stack([np.full(LINES, ranges[k][end])] * 2)
            points[:, 1 - k] = np.linspace(*ranges[1 - k], LINES)
            kind = f"{carried.chain.names[k + 1]} {word}"
            curves.append(Curve(kind, points, image))
    reach = carried.chain.length + sum(abs(v) for k in (0, 1) if slides[k] for v in ranges[k])
    height = np.linspace(1.01 * reach, -1.01 * reach, LINES)
    curves.append(Curve("axis", np.column_stack([np.zeros(LINES), height]), _same, is_axis=True))
    return curves
