"""A grid of points in a plane of the base, wide enough for the arm."""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from dh2urdf.bounds import LENGTH, POINTS
from dh2urdf.doors import choice, instance, integer, number
from dh2urdf.robot import Robot
from dh2urdf.transforms import Array
from dh2urdf.workspace.task import common_axis


class Plane(NamedTuple):
    """A coordinate plane of the base: its name, its two directions, its normal."""

    name: str
    u: int
    v: int

    @property
    def normal(self) -> int:
        """Index of the axis across the plane."""
        return 3 - self.u - self.v


PLANES = {"xz": Plane("xz", 0, 2), "yz": Plane("yz", 1, 2), "xy": Plane("xy", 0, 1)}
"""Planes in which sections are taken."""


@dataclass(frozen=True, eq=False)
class Section:
    """A grid in a plane of the base.

    Parameters
    ----------
    plane : Plane
    at : float
        Where along the normal [m].
    u, v : array
        Coordinates of the columns and rows [m].
    """

    plane: Plane
    at: float
    u: Array
    v: Array

    @property
    def points(self) -> Array:
        """All points, shape (len(v), len(u), 3)."""
        out = np.empty((len(self.v), len(self.u), 3))
        out[..., self.plane.normal] = self.at
        out[..., self.plane.u] = self.u[None, :]
        out[..., self.plane.v] = self.v[:, None]
        return out

    def at_places(self, spots: Array) -> Array:
        """Points in base (m, 3) of places (m, 2) in the plane [m]."""
        out = np.full((len(spots), 3), self.at)
        out[:, [self.plane.u, self.plane.v]] = spots
        return out

    @property
    def name(self) -> str:
        """``y = 0``, ``z = 0.2 m``."""
        return f"{'xyz'[self.plane.normal]} = {self.at:g}{' m' if self.at else ''}"


def section(robot: Robot, plane: str = "", at: float | None = None, count: int = 121) -> Section:
    """A section through the arm's reach: across parallel joint axes, else the xz plane.

    Parameters
    ----------
    robot : Robot
    plane : {"xz", "yz", "xy"}, optional
    at : float, optional
        Height of the plane along its normal [m]; 0, or where the tip of a planar or SCARA arm
        is with its joints in the middle.
    count : int
        Points along the longer side.
    """
    if type(plane) is not str or plane:
        choice(plane, "plane", PLANES)
    count = integer(count, "points along a side", *POINTS)
    at = None if at is None else number(at, "at", -LENGTH, LENGTH)
    if not plane:
        axis, flat = common_axis(robot)
        across = axis is not None and (flat or robot.n == 4)
        plane = ("yz", "xz", "xy")[axis] if across and axis is not None else "xz"
        if at is None and across:
            at = round(float(robot.fk(_middle(robot))[PLANES[plane].normal, 3]), 6)
    chosen = PLANES[plane]
    centre, radius = reach_ball(robot)
    u, v = centre[chosen.u], centre[chosen.v]
    line = np.linspace(-1.04 * radius, 1.04 * radius, count)
    return Section(chosen, float(at or 0.0), u + line, v + line)


def _middle(robot: Robot) -> Array:
    """The configuration halfway between finite limits, zero elsewhere."""
    bounded = np.isfinite(robot.lower) & np.isfinite(robot.upper)
    q = np.zeros(robot.n)
    q[bounded] = (robot.lower[bounded] + robot.upper[bounded]) / 2
    return q


STRAIGHT = 1e-3
"""Tilt [rad] and distance [sizes] of axis 1 from a plane below which no picture shows them."""


def turns_in_plane(robot: Robot, grid: Section, within_limits: bool) -> bool:
    """Tell whether joint 1 turns all around an axis through the middle of a section, upright in it.

    Then the arm reaches the same on both sides of it.
    """
    chain = robot.chain
    axis, centre = chain.axes[0], reach_ball(robot)[0]
    in_plane = abs(float(axis[grid.plane.v])) > 1.0 - STRAIGHT**2 / 2
    through = abs(float(centre[grid.plane.normal]) - grid.at) < STRAIGHT * chain.size
    first = robot.moved_alone(0)
    if first is None or chain.prismatic[0]:
        return False
    width = float(robot.upper[first] - robot.lower[first])
    return in_plane and through and (not within_limits or width >= 2 * math.pi - 1e-9)


def reach_ball(robot: Robot) -> tuple[Array, float]:
    """A ball that holds every place of the tip: its centre on axis 1 [m], its radius [m].

    Each joint moves the rest of the arm about or along its axis; the centre is the point of
    axis 1 nearest to the second axis and the radius sums the steps between the joints.
    """
    chain = instance(robot, "robot", Robot).chain
    feet = _feet(robot)
    radius = sum(map(math.dist, feet, [*feet[1:], chain.tool[:3, 3]]))
    return feet[0], max(radius + _travel(robot), 1e-3)


def last_axis_ball(robot: Robot) -> tuple[Array, Array, float]:
    """A ball that holds every place of a point that is fixed to the tip, on the last axis.

    Joints whose axes meet there do not move it.

    Returns
    -------
    point, centre : array, shape (3,)
        In the tip's frame and in base [m].
    radius : float
        [m].
    """
    chain, feet = instance(robot, "robot", Robot).chain, _feet(robot)
    last, k = feet[-1], chain.n - 1
    while k > 0 and np.linalg.norm(np.cross(chain.axes[k], last - chain.points[k])) < 1e-9:
        k -= 1
    radius = sum(map(math.dist, feet[:k], feet[1 : k + 1])) + math.dist(feet[k], last)
    point = chain.tool[:3, :3].T @ (last - chain.tool[:3, 3])
    return point, feet[0], radius + _travel(robot)


def _feet(robot: Robot) -> list[Array]:
    """The point of axis 1 nearest to the second axis, and of each axis that nearest to the last.

    Each is fixed to the links on both sides of its joint, at q = 0 in base [m].
    """
    chain = robot.chain
    points, axes = chain.points, chain.axes
    feet = [points[0]]
    if chain.n > 1:
        feet = [points[0] + axes[0] * float(axes[0] @ (points[1] - points[0]))]
    for point, z in zip(points[1:], axes[1:], strict=True):
        feet.append(point + z * float(z @ (feet[-1] - point)))
    return feet


def _travel(robot: Robot) -> float:
    """How far sliding joints can move the tip [m]; without limits as far as the arm is long."""
    chain, (low, high) = robot.chain, robot.joint_ranges()
    far = np.maximum(np.abs(low), np.abs(high))[chain.prismatic]
    return float(np.where(np.isfinite(far), far, chain.size).sum())


def caption(robot: Robot, what: str, *, within_limits: bool, tried: str = "") -> str:
    """One sentence: what is shown of the robot, frames, limits, collisions, what was tried."""
    limits = "joint limits kept" if within_limits else "joint limits ignored"
    return (
        f"{what} of {robot.model.name}; {robot.tip} in {robot.base}; {limits}; "
        f"{tried}{'; ' if tried else ''}"
        "self-collision not checked."
    )
