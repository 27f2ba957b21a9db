"""The volume of what a point reaches: its section turned about axis 1, as far as joint 1 turns."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from dh2urdf.robot import Robot
from dh2urdf.transforms import Array
from dh2urdf.workspace.exact.boundary import SAME
from dh2urdf.workspace.exact.carried_point import carried_point
from dh2urdf.workspace.exact.extremes import bounds_of
from dh2urdf.workspace.exact.section import SLIVER, ReachSection, place_solver, reach_section

FIRST, LEVELS = 48, 5
"""Squares along a side of the section, and how often those are halved where the angle changes."""

ALIKE = 1e-2
"""Angles [rad] that differ by less within a square are as good as their mean."""


@dataclass(frozen=True)
class Volume:
    """A volume [m^3] and the most by which it may be off."""

    value: float
    bound: float


def reach_volume(
    robot: Robot, section: ReachSection | None = None, *, within_limits: bool = True
) -> Volume:
    """Volume of all places of the wrist point, see :func:`reach_section`.

    By Pappus's theorem where joint 1 turns all around. Where it does not, the angle by which a
    place of the section is turned is taken from the inverse kinematics, on squares that are halved
    where it changes; its bound is then that of a picture rather than of a formula.

    Parameters
    ----------
    robot : Robot
    section : ReachSection, optional
        Of the same robot within the same limits, where it is known already.
    within_limits : bool

    Raises
    ------
    ArgumentError
        As :func:`reach_section`.

    Examples
    --------
    >>> from dh2urdf import Robot
    >>> from dh2urdf.workspace import reach_volume
    >>> found = reach_volume(Robot.from_dh("puma560"), within_limits=False)
    >>> round(found.value, 4), found.bound < 1e-5
    (2.7024, True)
    """
    found = section or reach_section(robot, within_limits=within_limits)
    carried = carried_point(robot, "wrist")
    low, high = bounds_of(carried, found.within_limits)
    turned = _turned(found, carried.chain.size)
    width = float(high[0] - low[0])
    if width >= 2 * math.pi - 1e-9 or not found.rings:
        return turned
    places = np.concatenate([ring.through for ring in found.rings])
    solve = place_solver(carried, low, high)

    def missing(spots: Array) -> Array:
        """Angle [rad] by which places (k, 2) are not turned; 0 out of the section."""
        q = solve(spots).q[:, :, 0]
        start = np.sort(np.where(np.isnan(q), np.inf, np.mod(-q, 2 * math.pi)), axis=1)
        around = start[:, :1] + 2 * math.pi
        after = np.concatenate([start[:, 1:], around], axis=1)
        is_one = np.isfinite(start)
        gap = np.minimum(after, around) - np.where(is_one, start, 0.0)
        arcs = np.where(is_one, np.minimum(gap, width), 0.0).sum(axis=1)
        return np.where(is_one[:, 0], 2 * math.pi - arcs, 0.0)

    lost = _integrated(missing, places.min(axis=0), places.max(axis=0))
    return Volume(turned.value - lost.value, turned.bound + lost.bound)


def _turned(section: ReachSection, size: float) -> Volume:
    """The section turned all around: Pappus, chords halved once and carried on to arcs.

    ``V = pi integral of r^2 dz`` around the rings, exact on polygons.
    """
    total = bound = 0.0
    for ring in section.rings:
        corners, between = ring.points, ring.between
        after = np.roll(corners, -1, axis=0)
        coarse = _cone(corners, after)
        fine = _cone(corners, between) + _cone(between, after)
        total += float((fine + (fine - coarse) / 3).sum())
        bound += float(np.abs(fine - coarse).sum())
        gaps = np.linalg.norm(corners - np.roll(corners, 1, axis=0), axis=1)[list(ring.starts)]
        widest = 2 * math.pi * float(corners[:, 0].max() * size)
        bound += widest * (float(gaps.sum()) * SAME + SLIVER * size)
    return Volume(total, float(bound))


def _cone(start: Array, end: Array) -> Array:
    """Share of chords (k, 2) in the volume of their ring."""
    (r, z), (s, w) = start.T, end.T
    return np.asarray(math.pi / 3 * (r * r + r * s + s * s) * (w - z))


def _integrated(angle: Callable[[Array], Array], low: Array, high: Array) -> Volume:
    """The integral of radius times an angle over a box, and its bound.

    Each square has its four corners and its middle tried.
    """
    step = (high - low) / FIRST
    ij = np.stack(np.meshgrid(*[np.arange(FIRST)] * 2, indexing="ij"), axis=-1).reshape(-1, 2)
    origin = low + ij * step
    total = bound = 0.0
    for level in range(LEVELS + 1):
        corners = origin[:, None] + step * np.array([[0, 0], [1, 0], [0, 1], [1, 1], [0.5, 0.5]])
        values = angle(corners.reshape(-1, 2)).reshape(-1, 5)
        spread = values.max(axis=1) - values.min(axis=1)
        done = (spread < ALIKE) | (level == LEVELS)
        weight = (origin[:, 0] + step[0] / 2) * step[0] * step[1]
        total += float((weight * values.mean(axis=1))[done].sum())
        bound += float((weight * spread)[done].sum()) / (2 if level < LEVELS else 1)
        step = step / 2
        parts = origin[~done, None] + step * np.array([[0, 0], [1, 0], [0, 1], [1, 1]])
        origin = parts.reshape(-1, 2)
        if not len(origin):
            break
    return Volume(total, bound)
