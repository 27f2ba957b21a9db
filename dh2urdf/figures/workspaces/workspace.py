"""Pictures of what an arm reaches, chosen by its kind."""

from collections.abc import Callable
from functools import partial

from numpy.typing import ArrayLike

from dh2urdf import workspace as reach
from dh2urdf.bounds import LENGTH, ORIENTATIONS, POINTS
from dh2urdf.doors import finite_array, integer, number
from dh2urdf.exceptions import ArgumentError, UnreachedError
from dh2urdf.figures.style import Picture
from dh2urdf.figures.workspaces.planar_workspace import planar_picture
from dh2urdf.figures.workspaces.section_workspace import section_picture
from dh2urdf.robot import Robot
from dh2urdf.transforms import Array, rpy_to_matrix

FINE, COARSE = 221, 75
"""Points along a side of the map of branches and of the map of orientations."""

TRIED = 150
"""Orientations tried at each point."""


def workspace_figure(
    robot: Robot,
    *,
    plane: str = "",
    at: float | None = None,
    rpy: ArrayLike | None = None,
    points: int | None = None,
    orientations: int | None = None,
    within_limits: bool = True,
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
        Points along a side of the map of branches; the other map has a third of them.
    orientations : int
        Orientations tried at each point, 150.
    within_limits : bool
    progress : callable, optional
        Called with what is computed, the number of poses done, and their total.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    NoSolverError, ArgumentError
    UnreachedError
        The section misses everything that the arm reaches.
    """
    if at is not None:
        number(at, "at", -LENGTH, LENGTH, unit="m")
    if points is not None:
        integer(points, "points", *POINTS)
    if orientations is not None:
        integer(orientations, "orientations", 1, ORIENTATIONS)
    task = reach.task_of(robot)
    if orientations is not None and task.sides == "none":
        raise ArgumentError(f"orientations: they change nothing for {robot.model.name}")
    flat = reach.planar_arm(robot)
    if flat is not None and not plane and rpy is at is points is None:
        return planar_picture(robot, flat, within_limits=within_limits)

    R = _orientation(robot, task, rpy)
    counts = shares = None
    told = [partial(progress, what) if progress else None for what in ("branches", "orientations")]
    held = reach.held_values(robot, within_limits=within_limits) if robot.n > 6 else None
    if robot.n <= 6:
        grid = reach.section(robot, plane, at, points or FINE)
        count = reach.branch_counts(robot, grid, R, within_limits=within_limits, progress=told[0])
        counts = grid, count
    if task.sides != "none":
        grid = reach.section(robot, plane, at, max(9, round(points / 3)) if points else COARSE)
        tries = orientations or TRIED
        share = reach.dexterity(
            robot, grid, tries, within_limits=within_limits, held=held, progress=told[1]
        )
        shares = grid, share, tries
    if not any(panel[1].any() for panel in (counts, shares) if panel):
        name = f"{robot.tip} of {robot.model.name}"
        raise UnreachedError(f"the section {grid.name} misses everything that {name} reaches")
    tried = [f"{robot.joint_names[k]} held at {len(v)} values" for k, v in (held or {}).items()]
    return section_picture(
        robot, counts, shares, R, within_limits=within_limits, tried=", ".join(tried)
    )


def _orientation(robot: Robot, task: reach.Task, rpy: ArrayLike | None) -> Array:
    """The orientation in which branches are counted, as asked or the task's own, shape (3, 3)."""
    if rpy is None:
        return reach.default_orientation(robot, task)
    if robot.n > 6 or task.name == "position":
        raise ArgumentError(f"rpy: it changes nothing for {robot.model.name}")
    return rpy_to_matrix(finite_array(rpy, "rpy", "three angles", shape=(3,)).tolist())
