"""Pictures of what an arm reaches, chosen by its kind."""

import math
from collections.abc import Callable
from functools import partial

import numpy as np
from numpy.typing import ArrayLike

from dh2urdf import workspace as reach
from dh2urdf.bounds import LENGTH, ORIENTATIONS, POINTS
from dh2urdf.doors import finite_array, flag, integer, number
from dh2urdf.exceptions import ArgumentError, UnreachedError
from dh2urdf.figures.style import Picture
from dh2urdf.figures.workspaces.edges import Counts, above, regions
from dh2urdf.figures.workspaces.envelope_workspace import EYE, envelope_picture
from dh2urdf.figures.workspaces.planar_workspace import planar_picture
from dh2urdf.figures.workspaces.section_workspace import Branches, Shares, section_picture
from dh2urdf.robot import Robot
from dh2urdf.transforms import Array, rpy_to_matrix
from dh2urdf.workspace import Section

FINE, COARSE, COARSEST = 161, 81, 49
"""Points along a side of a map; where each point has orientations by the thousand; and where the
arm has no closed form, or a joint to spare."""

TRIED = (2_000, 5_000)
"""Orientations tried at each point, and where that takes no time."""

TURNED = 360
"""Turns tried at each point of a planar or SCARA arm, a degree apart."""

QUICK = 400
"""Poses at a point up to which they take no time with a closed form."""

CLOSED = 8
"""Most solutions of an arm with a closed form."""

HALVINGS = (6, 1)
"""How often the way between two points is halved to find the edge of a number of branches, and
for an arm without a closed form."""

HALVINGS_OF_SHARES = (3, 2)
"""The same for the edge of what is reached at all, where that takes no time."""

SEEN = 0.01
"""Elsewhere the share at which that edge is drawn, between the points of the grid."""


def workspace_figure(
    robot: Robot,
    *,
    plane: str = "",
    at: float | None = None,
    rpy: ArrayLike | None = None,
    points: int | None = None,
    orientations: int | None = None,
    within_limits: bool = True,
    envelope: bool = False,
    progress: Callable[[str, int, int], None] | None = None,
) -> Picture:
    """Draw what an arm reaches.

    A planar RR arm: the surface of its poses and its annulus. Any other: a section with the
    number of branches and the share of orientations reached.

    Parameters
    ----------
    robot : Robot
    plane : {"xz", "yz", "xy"}, optional
        Plane of the section; that of a planar arm, else xz.
    at : float, optional
        Where the plane stands along its normal [m].
    rpy : array_like, shape (3,), optional
        Orientation in which branches are counted [rad]; the tool pointing down.
    points : int, optional
        Points along a side of the maps, worked out where the maps change; 161, or less where a
        point takes long.
    orientations : int
        Orientations tried at each point at least; 2000, or 5000 where that takes no time.
    within_limits : bool
    envelope : bool
        Draw the boundary of all that is reached, in the round, instead.
    progress : callable, optional
        Called with what is computed, the number of poses done, and their total.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    NoSolverError, ArgumentError
    UnreachedError
        The section misses everything that the arm reaches, or meets a planar arm in a line.
    """
    if at is not None:
        number(at, "at", -LENGTH, LENGTH, unit="m")
    if points is not None:
        integer(points, "points", *POINTS)
    if orientations is not None:
        integer(orientations, "orientations", 1, ORIENTATIONS)
    if flag(envelope, "envelope"):
        _alone(plane=plane or None, at=at, rpy=rpy, points=points, orientations=orientations)
        return _envelope(robot, within_limits, progress)
    task = reach.task_of(robot)
    if orientations is not None and task.sides == "none":
        raise ArgumentError(f"orientations: they change nothing for {robot.model.name}")
    flat = reach.planar_arm(robot)
    if flat is not None and not plane and rpy is at is points is None:
        return planar_picture(robot, flat, within_limits=within_limits)

    _check_plane(robot, plane)
    R = _orientation(robot, task, rpy)
    counts, shares, tried = _panels(
        robot,
        partial(reach.section, robot, plane, at),
        R,
        points,
        orientations,
        within_limits,
        progress,
    )
    return section_picture(robot, counts, shares, R, within_limits=within_limits, tried=tried)


def _panels(
    robot: Robot,
    grid: Callable[[int], Section],
    R: Array,
    points: int | None,
    orientations: int | None,
    within_limits: bool,
    progress: Callable[[str, int, int], None] | None,
) -> tuple[Branches | None, Shares | None, str]:
    """Branches and shares of a section, and what they were tried with."""
    mapped, off = reach.mapped_robot(robot)
    told = [partial(progress, what) if progress else None for what in ("branches", "orientations")]
    counts = shares = None
    if robot.n <= 6:
        counts = _branches(
            mapped,
            grid(points or (FINE if _is_quick(mapped) else COARSEST)),
            R,
            within_limits,
            told[0],
        )
    held = reach.held_values(robot, within_limits=within_limits) if robot.n > 6 else None
    if reach.task_of(robot).sides != "none":
        shares = _shares(mapped, grid, points, orientations, within_limits, held, told[1])
    if not any(panel[1].any() for panel in (counts, shares) if panel):
        name = f"{robot.tip} of {robot.model.name}"
        raise UnreachedError(f"the section {grid(2).name} misses everything that {name} reaches")
    tried = [f"{robot.joint_names[k]} held at {len(v)} values" for k, v in (held or {}).items()]
    if off:
        tried.append(f"mapped on its nominal arm, up to {1000 * off:.2g} mm off")
    return counts, shares, "; ".join(tried)


def _alone(**options: object) -> None:
    """Refuse what says nothing beside an envelope."""
    for name, value in options.items():
        if value is not None:
            raise ArgumentError(f"{name}: it changes nothing beside envelope")


def _envelope(
    robot: Robot, within_limits: bool, progress: Callable[[str, int, int], None] | None
) -> Picture:
    """The boundary of all that is reached."""
    mapped, off = reach.mapped_robot(robot)
    held = reach.held_values(robot, within_limits=within_limits) if robot.n > 6 else None
    told = partial(progress, "envelope") if progress else None
    towards = math.radians(EYE.azimuth)
    found = reach.envelope(mapped, towards, within_limits=within_limits, held=held, progress=told)
    if not len(found.quads):
        raise UnreachedError(f"no place is reached by {robot.tip} of {robot.model.name}")
    tried = ["" if not off else f"mapped on its nominal arm, up to {1000 * off:.2g} mm off"]
    return envelope_picture(robot, found, within_limits=within_limits, tried=tried[0])


def _check_plane(robot: Robot, plane: str) -> None:
    """Refuse a plane that a planar arm can meet in a line only."""
    axis, flat = reach.common_axis(robot)
    if plane in reach.PLANES and flat and axis is not None and reach.PLANES[plane].normal != axis:
        own = next(name for name, each in reach.PLANES.items() if each.normal == axis)
        raise UnreachedError(
            f"{robot.model.name} moves in a plane {own}: the plane {plane} meets it in a line only"
        )


def _is_quick(robot: Robot, poses: int = 1) -> bool:
    """Tell whether so many poses at each point of a map take no time."""
    return robot.n <= 6 and poses <= QUICK and robot.solver.kmax <= CLOSED


def _branches(
    robot: Robot, grid: Section, R: Array, within_limits: bool, progress: reach.Progress | None
) -> Branches:
    """The map of branches, and its regions with their edges found between the points."""
    counts = reach.branch_counts(robot, grid, R, within_limits=within_limits, progress=progress)

    def counts_at(spots: Array) -> Counts:
        return reach.counts_at(robot, grid.at_places(spots), R, within_limits, progress)

    halvings = HALVINGS[0 if _is_quick(robot) else 1]
    return Branches(grid, counts, regions(grid.u, grid.v, counts, counts_at, halvings))


def _sides(robot: Robot, task: reach.Task, within_limits: bool) -> int:
    """Orientations tried where none are asked for."""
    if task.sides == "turns":
        return TURNED
    poses = reach.solved(robot, task, TRIED[1], within_limits=within_limits)
    return TRIED[1 if _is_quick(robot, poses) else 0]


def _shares(
    robot: Robot,
    grid: Callable[[int], Section],
    points: int | None,
    orientations: int | None,
    within_limits: bool,
    held: dict[int, Array] | None,
    progress: reach.Progress | None,
) -> Shares:
    """The map of orientations, and the region in which any is reached."""
    task, limits = reach.task_of(robot), {"within_limits": within_limits}
    sides = orientations or _sides(robot, task, within_limits)
    each = reach.solved(robot, task, sides, **limits)
    side = FINE if _is_quick(robot, each) else COARSE if _is_quick(robot) else COARSEST
    section = grid(points or side)
    share = reach.dexterity(robot, section, sides, held=held, progress=progress, **limits)
    turns = reach.orientations(robot, task, sides, **limits)

    def reached_at(spots: Array) -> Counts:
        places = section.at_places(spots)
        found = reach.shares_at(robot, places, turns, within_limits, held, progress)
        return (found > 0.0).astype(np.int64)

    sharp = each <= QUICK
    if sharp:
        any_, halvings = (share > 0.0).astype(np.int64), HALVINGS_OF_SHARES[side < FINE]
        edge = regions(section.u, section.v, any_, reached_at, halvings).get(1, [])
    else:
        edge = above(section.u, section.v, share, SEEN)
    return Shares(section, share, edge, sharp, each * math.ceil(sides / each))


def _orientation(robot: Robot, task: reach.Task, rpy: ArrayLike | None) -> Array:
    """The orientation in which branches are counted, as asked or the task's own, shape (3, 3)."""
    if rpy is None:
        return reach.default_orientation(robot, task)
    if robot.n > 6 or task.name == "position":
        raise ArgumentError(f"rpy: it changes nothing for {robot.model.name}")
    return rpy_to_matrix(finite_array(rpy, "rpy", "three angles", shape=(3,)).tolist())
