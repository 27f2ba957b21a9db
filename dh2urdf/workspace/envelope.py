"""The boundary of all that an arm reaches, as a surface that is open in a quarter.

Reach is decided on a grid by inverse kinematics, the surface lies between points of which one is
reached and one is not.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dh2urdf.exceptions import ArgumentError
from dh2urdf.robot import Robot
from dh2urdf.transforms import Array
from dh2urdf.workspace.maps import Held, shares_at
from dh2urdf.workspace.refine import Progress
from dh2urdf.workspace.section import PLANES, Section, reach_ball, turns_in_plane
from dh2urdf.workspace.surface_nets import Flags, Index, edge_ends, surface_net
from dh2urdf.workspace.task import common_axis, orientations, solved, task_of

AROUND = 55
"""Half planes from one side of the open quarter to the other."""

ROUND, SOLID = (61, 121), (25, 37)
"""Points along the radius and the height where one half plane is as good as any, and elsewhere."""

SIDES = 10_000
"""Orientations of which one has to be reached."""

SOLVED = (600, 150)
"""Of those, solved at each place at most, and by an arm without a closed form or with a joint to
spare."""

FIRST = 12
"""Orientations tried first: most places are reached in one of them."""

HALVINGS = 4
"""How often the way between two points is halved to find the edge."""


@dataclass(frozen=True, eq=False)
class Envelope:
    """Corners (v, 3) [m], quadrilaterals (f, 4) of them, and which of these close the cut (f,)."""

    corners: Array
    quads: NDArray[np.int64]
    is_cut: Flags


def envelope(
    robot: Robot,
    open_towards: float,
    *,
    within_limits: bool = True,
    held: Held | None = None,
    progress: Progress | None = None,
) -> Envelope:
    """The envelope of an arm, a quarter of it left out towards an azimuth [rad] of the base.

    Raises
    ------
    NoSolverError
    ArgumentError
        The arm stays in a plane.
    """
    axis, flat = common_axis(robot)
    if flat and axis is not None:
        raise ArgumentError(f"{robot.model.name} moves in a plane: it has no envelope")
    centre, radius = reach_ball(robot)
    middle = Section(PLANES["xz"], float(centre[1]), np.array([centre[0]]), np.zeros(1))
    same = turns_in_plane(robot, middle, within_limits)
    nr, nz = ROUND if same else SOLID
    r = np.linspace(0.0, 1.04 * radius, nr)
    z = centre[2] + np.linspace(-1.04 * radius, 1.04 * radius, nz)
    quarter, end = math.pi / 4, 2 * math.pi - math.pi / 4
    phi = open_towards + np.linspace(quarter, end, AROUND if same else 2 * AROUND // 3)
    turns = _turns(robot, within_limits)
    tell = progress or (lambda *_: None)

    def reached(places: Array) -> Flags:
        """Places (m, 3) of azimuth, radius and height."""
        points = _points(places, centre)
        first = shares_at(robot, points, turns[:FIRST], within_limits, held) > 0.0
        left = np.flatnonzero(~first)
        if len(turns) > FIRST:
            rest = shares_at(robot, points[left], turns[FIRST:], within_limits, held, tell)
            first[left] = rest > 0.0
        return first

    angles = phi[:1] if same else phi
    grid = np.stack(np.meshgrid(angles, r, z, indexing="ij"), axis=-1)
    inside = reached(grid.reshape(-1, 3)).reshape(grid.shape[:3])
    nodes = _padded(phi, phi[[0, -1]]), _padded(r, np.array([0.0, r[-1]])), _padded(z, z[[0, -1]])
    whole = np.pad(np.repeat(inside, len(phi), axis=0) if same else inside, 1)

    def halved(low: Array, high: Array, low_inside: Flags) -> Array:
        if not same:
            return _halved(low, high, low_inside, reached)
        a, b = (np.c_[np.full(len(x), phi[0]), x[:, 1:]] for x in (low, high))
        return np.asarray(np.c_[low[:, 0], _halved(a, b, low_inside, reached)[:, 1:]])

    places, quads, is_cut = _net(whole, nodes, halved)
    return Envelope(_points(places, centre), quads, is_cut)


def _turns(robot: Robot, within_limits: bool) -> Array:
    """Orientations to try, those tried first spread over all of them."""
    task = task_of(robot)
    count, most = SIDES, SOLVED[0 if robot.n <= 6 and robot.solver.kmax <= 8 else 1]
    while solved(robot, task, count, within_limits=within_limits) > most:
        count //= 2
    turns = orientations(robot, task, count, within_limits=within_limits)
    order = np.argsort(np.arange(len(turns)) * 0.618034 % 1.0)
    return np.asarray(turns[order])


def _padded(values: Array, ends: Array) -> Array:
    return np.concatenate([ends[:1], values, ends[1:]])


def _points(places: Array, centre: Array) -> Array:
    """Points in base of azimuths, radii and heights (m, 3)."""
    phi, r, z = places.T
    return np.stack([centre[0] + r * np.cos(phi), centre[1] + r * np.sin(phi), z], axis=1)


def _net(
    inside: Flags, nodes: tuple[Array, ...], halved: Callable[[Array, Array, Flags], Array]
) -> tuple[Array, NDArray[np.int64], Flags]:
    """Corners (v, 3) in the grid's coordinates, quadrilaterals (f, 4), and which close the cut.

    ``halved`` finds where the edge is between two points.
    """
    last, cuts = inside.shape[0] - 2, list[Flags]()

    def crossing(axis: int, index: Index, from_inside: Flags) -> tuple[Array, Array]:
        low, high = edge_ends(nodes, axis, index)
        cut = (axis == 0) & np.isin(index[:, 0], (0, last))
        cuts.append(cut)
        spots, inner = (low + high) / 2, ~cut
        spots[inner] = halved(low[inner], high[inner], from_inside[inner])
        return spots, np.where(cut, 1e-6, 1.0)  # the rim of the cut stays on the boundary

    corners, quads = surface_net(inside, crossing)
    return corners, quads, np.concatenate(cuts)


def _halved(low: Array, high: Array, low_inside: Flags, reached: Callable[[Array], Flags]) -> Array:
    """Where the edge lies between places (m, 3) of which one is reached, shape (m, 3)."""
    ends = np.c_[low, high, low_inside]
    edges, back = np.unique(ends, axis=0, return_inverse=True)
    is_in = edges[:, 6:] > 0.0
    within, without = (np.where(is_in == k, edges[:, :3], edges[:, 3:6]) for k in (True, False))
    for _ in range(HALVINGS):
        middle = (within + without) / 2
        has = reached(middle)[:, None]
        within, without = np.where(has, middle, within), np.where(has, without, middle)
    return np.asarray(((within + without) / 2)[back.ravel()])
