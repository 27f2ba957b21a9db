"""What an arm reaches: the planar arm's annulus and surface, sections through a spatial arm.

Reach is decided by inverse kinematics at every point of a grid, never by the density of random
configurations, which says where an arm lingers, not what it reaches.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dh2urdf.conversions.bodies import frame_along
from dh2urdf.exceptions import ConfigurationError
from dh2urdf.robot import Robot
from dh2urdf.transforms import Array, inverse, rot_z

__all__ = [
    "PLANES",
    "PlanarArm",
    "Plane",
    "Section",
    "Task",
    "branch_counts",
    "caption",
    "dexterity",
    "planar_arm",
    "section",
    "task_of",
    "uniform_rotations",
]

Progress = Callable[[int, int], None]
"""Called with the number of poses done and their total."""

PARALLEL = 1e-9
"""Sine of the angle between two axes up to which an arm counts as planar here."""

CHUNK = 60_000
"""Poses solved at a time: some 100 MB of solutions."""


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


@dataclass(frozen=True)
class PlanarArm:
    """Two parallel revolute joints in series.

    Parameters
    ----------
    l1, l2 : float
        From axis 1 to axis 2, from there to the tip [m].
    T_base_plane : array, shape (4, 4)
        Origin on axis 1, z along it.
    offset : tuple of 3 floats
        Directions at q = 0 in the plane [rad]: of link 1, of link 2, of the tip's x axis.
    lower, upper : array, shape (2,)
    """

    l1: float
    l2: float
    T_base_plane: Array
    offset: tuple[float, float, float]
    lower: Array
    upper: Array

    def forward(self, t1: Array, t2: Array) -> tuple[Array, Array]:
        """Place of the tip in the plane [m] for angles t1 of link 1 and t2 between the links.

        Lecture notes, section 1.1: ``x = l1 c1 + l2 c12``, ``y = l1 s1 + l2 s12``.
        """
        x = self.l1 * np.cos(t1) + self.l2 * np.cos(t1 + t2)
        y = self.l1 * np.sin(t1) + self.l2 * np.sin(t1 + t2)
        return x, y

    def elbow(self, x: Array, y: Array) -> Array:
        """Angle between the links at a place, in [0, pi], NaN out of reach.

        Lecture notes, section 8.2, by the half angle: near 0 and pi the cosine loses digits.
        """
        r = np.hypot(x, y)
        over = (self.l1 + self.l2) ** 2 - r * r
        under = r * r - (self.l1 - self.l2) ** 2
        with np.errstate(invalid="ignore"):
            return 2.0 * np.arctan2(np.sqrt(over), np.sqrt(under))

    def shoulder(self, x: Array, y: Array, t2: Array) -> Array:
        """Angle of link 1 at a place for an angle t2 between the links."""
        return np.arctan2(y, x) - np.arctan2(self.l2 * np.sin(t2), self.l1 + self.l2 * np.cos(t2))

    def inside(self, t1: Array, t2: Array) -> NDArray[np.bool_]:
        """True where both joints keep their limits, full turns allowed."""
        first, between, _ = self.offset
        ok = np.ones(np.broadcast(t1, t2).shape, np.bool_)
        for k, q in enumerate((t1 - first, t2 - between)):
            if np.isfinite([self.lower[k], self.upper[k]]).all():
                turned = np.remainder(q - self.lower[k] + 1e-9, 2 * np.pi) - 1e-9
                ok &= turned <= self.upper[k] - self.lower[k] + 1e-9
        return ok


def planar_arm(robot: Robot) -> PlanarArm | None:
    """The robot as a planar RR arm; None where it is another."""
    chain = robot.chain
    if chain.n != 2 or robot.n != 2 or chain.prismatic.any():
        return None
    z = chain.axes
    if abs(float(z[0] @ z[1])) < 1.0 - PARALLEL:
        return None
    T_plane_base = inverse(chain.joint_frames[0])
    elbow = (T_plane_base @ np.array([*chain.points[1], 1.0]))[:2]
    tool = T_plane_base @ chain.tool
    second = tool[:2, 3] - elbow
    l1, l2 = float(np.hypot(*elbow)), float(np.hypot(*second))
    if min(l1, l2) < 1e-9 or float(z[0] @ z[1]) < 0:
        return None
    first = math.atan2(elbow[1], elbow[0])
    between = math.atan2(second[1], second[0]) - first
    turn = math.atan2(tool[1, 0], tool[0, 0])
    return PlanarArm(
        l1, l2, chain.joint_frames[0], (first, between, turn), robot.lower, robot.upper
    )


class Task(NamedTuple):
    """What is asked of an arm at a point, and from how many sides.

    ``name`` is that of :meth:`Robot.ik`; ``sides`` says which orientations are tried:
    ``rotations`` all around, ``turns`` about one axis of the base, or ``none`` but one.
    """

    name: str
    sides: str
    axis: int


def task_of(robot: Robot) -> Task:
    """What an arm of this kind can be asked: a pose as far as its joints allow.

    Parallel revolute axes (planar arms of three joints, SCARA) keep the tool's turn about
    them; five joints reach a point and the direction of the tool's z, fewer a point. Five do
    not reach directions all around: those are not counted.
    """
    axis, flat = common_axis(robot)
    if axis is not None and (robot.n == 4 or (robot.n == 3 and flat)):
        return Task("pose", "turns", axis)
    if robot.n >= 6:
        return Task("pose", "rotations", 2)
    if robot.n == 5:
        return Task("pose" if _rolls_about_tool(robot) else "position+axis", "none", 2)
    return Task("position", "none", 2)


def _rolls_about_tool(robot: Robot) -> bool:
    """Tell whether the last joint turns about the tool's z, so that it only rolls the tool."""
    T_joint_tool = robot.chain.links[-1]
    off = np.abs([*T_joint_tool[:2, 3] / robot.chain.size, *T_joint_tool[:2, 2]])
    return bool((off < 1e-9).all()) and not robot.chain.prismatic[-1]


def common_axis(robot: Robot) -> tuple[int | None, bool]:
    """The base axis along which all revolute joints turn, and whether the arm stays in a plane.

    None where they turn about different directions, or about none of the base's axes.
    """
    chain = robot.chain
    turning, sliding = chain.axes[~chain.prismatic], chain.axes[chain.prismatic]
    if not len(turning):
        return None, False
    axis = int(np.argmax(np.abs(turning[0])))
    if not (np.abs(turning[:, axis]) > 1.0 - PARALLEL).all():
        return None, False
    return axis, bool((np.abs(sliding[:, axis]) < PARALLEL).all())


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
    if plane and plane not in PLANES:
        raise ConfigurationError(f"plane: {plane!r}; allowed: {', '.join(PLANES)}")
    if count < 2:
        raise ConfigurationError(f"points along a side: at least 2, not {count}")
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


def reach_ball(robot: Robot) -> tuple[Array, float]:
    """A ball that holds every place of the tip: its centre on axis 1 [m], its radius [m].

    Each joint moves the rest of the arm about or along its axis; the centre is the point of
    axis 1 nearest to the second axis and the radius sums the steps between the joints.
    """
    chain = robot.chain
    points = chain.points
    centre = points[0]
    if chain.n > 1:
        z = chain.axes[0]
        centre = points[0] + z * float(z @ (points[1] - points[0]))
    radius, last = 0.0, centre
    far = np.maximum(np.abs(chain.lower), np.abs(chain.upper))
    for k in range(1, chain.n):
        z = chain.axes[k]
        foot = points[k] + z * float(z @ (last - points[k]))
        radius, last = radius + math.dist(foot, last), foot
    radius += math.dist(chain.tool[:3, 3], last)
    travel = [f if np.isfinite(f) else chain.size for f in far[chain.prismatic]]
    return centre, max(radius + float(sum(travel)), 1e-3)


def uniform_rotations(count: int) -> Array:
    """Rotations spread evenly over SO(3), shape (count, 3, 3).

    Super-Fibonacci spirals (Alexa, "Super-Fibonacci spirals: fast, low-discrepancy sampling of
    SO(3)", CVPR 2022, algorithm 1).
    """
    s = np.arange(count) + 0.5
    t, d = s / count, 2 * np.pi * s
    r, big = np.sqrt(t), np.sqrt(1 - t)
    alpha, beta = d / math.sqrt(2.0), d / 1.533751168755204288118041
    x, y, z, w = r * np.sin(alpha), r * np.cos(alpha), big * np.sin(beta), big * np.cos(beta)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), -1, 0)


def orientations(robot: Robot, task: Task, count: int) -> Array:
    """Orientations of the tip to try at each point, shape (m, 3, 3)."""
    at_zero = robot.chain.tool[:3, :3]
    if task.sides == "rotations":
        return uniform_rotations(count)
    if task.sides == "turns":
        axis = np.zeros(3)
        axis[task.axis] = 1.0
        A = frame_along(axis)
        turns = np.linspace(-np.pi, np.pi, count, endpoint=False)
        return np.stack([A @ rot_z(float(t))[:3, :3] @ A.T @ at_zero for t in turns])
    return at_zero[None]


def default_orientation(robot: Robot, task: Task) -> Array:
    """Orientation in which branches are counted: the tool pointing down, or as at q = 0."""
    if task.sides == "rotations" or robot.n == 5:
        return np.diag([1.0, -1.0, -1.0])
    return robot.chain.tool[:3, :3]


def branch_counts(
    robot: Robot,
    grid: Section,
    R: Array,
    *,
    within_limits: bool = True,
    progress: Progress | None = None,
) -> NDArray[np.int64]:
    """Number of solutions at each point of a section with the tip turned to R (3, 3).

    Raises
    ------
    NoSolverError
    """
    Ts = np.tile(np.eye(4), (grid.points[..., 0].size, 1, 1))
    Ts[:, :3, :3], Ts[:, :3, 3] = R, grid.points.reshape(-1, 3)
    task = task_of(robot)
    counts = [
        robot.ik_batch(part, within_limits=within_limits, task=task.name).count
        for part in _parts(Ts, progress)
    ]
    return np.concatenate(counts).reshape(len(grid.v), len(grid.u))


def dexterity(
    robot: Robot,
    grid: Section,
    count: int = 200,
    *,
    within_limits: bool = True,
    held: dict[int, Array] | None = None,
    progress: Progress | None = None,
) -> Array:
    """Share of orientations in which each point of a section is reached, 0 to 1.

    Parameters
    ----------
    robot : Robot
    grid : Section
    count : int
        Orientations tried, evenly spread.
    within_limits : bool
    held : mapping of int to array, optional
        For an arm with a joint to spare: values at which that joint is held; a pose counts as
        reached when it is at one of them.

    Raises
    ------
    NoSolverError
    """
    task = task_of(robot)
    turns = orientations(robot, task, count)
    points = grid.points.reshape(-1, 3)
    Ts = np.tile(np.eye(4), (len(points), len(turns), 1, 1))
    Ts[..., :3, :3], Ts[..., :3, 3] = turns, points[:, None]
    flat = Ts.reshape(-1, 4, 4)
    tries: list[dict[int | str, float] | None] = [None]
    if held:
        tries = [{k: float(v)} for k, values in held.items() for v in values]
    reached = []
    for part in _parts(flat, progress):
        hit = np.zeros(len(part), np.bool_)
        for locked in tries:
            left = np.flatnonzero(~hit)
            found = robot.ik_batch(
                part[left], within_limits=within_limits, task=task.name, locked=locked
            )
            hit[left] = found.count > 0
        reached.append(hit)
    share: Array = np.concatenate(reached).reshape(len(points), len(turns)).mean(axis=1)
    return share.reshape(len(grid.v), len(grid.u))


def _parts(Ts: Array, progress: Progress | None) -> Iterator[Array]:
    """Poses in chunks, telling how far it has come."""
    for start in range(0, len(Ts), CHUNK):
        yield Ts[start : start + CHUNK]
        if progress:
            progress(min(start + CHUNK, len(Ts)), len(Ts))


def caption(robot: Robot, what: str, *, within_limits: bool) -> str:
    """One sentence: what is shown of the robot, frames, limits, collisions."""
    limits = "joint limits kept" if within_limits else "joint limits ignored"
    return (
        f"{what} of {robot.model.name}; {robot.tip} in {robot.base}; {limits}; "
        "self-collision not checked."
    )
