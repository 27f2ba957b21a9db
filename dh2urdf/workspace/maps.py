"""Maps over a section: how many branches, and from how many sides."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from dh2urdf.bounds import ORIENTATIONS, SAMPLES
from dh2urdf.doors import finite_array, flag, instance, integer
from dh2urdf.ik.redundant import SweptJoint, sample_values
from dh2urdf.robot import Robot
from dh2urdf.transforms import Array, pose
from dh2urdf.workspace.refine import Index, Progress, refined
from dh2urdf.workspace.section import Section, last_axis_ball, reach_ball, turns_in_plane
from dh2urdf.workspace.task import orientations, task_of

CHUNK = 60_000
"""Poses solved at a time: some 100 MB of solutions."""

HELD = 24
"""Values at which the joint to spare of an arm of seven is held."""

SMOOTH = 0.02
"""Share of orientations by which a place may be off what its neighbours foretell."""

Held = dict[int, Array]


def branch_counts(
    robot: Robot,
    grid: Section,
    R: Array,
    *,
    within_limits: bool = True,
    progress: Progress | None = None,
) -> NDArray[np.int64]:
    """Number of solutions at each point of a section with the tip turned to R (3, 3).

    Worked out where it changes from point to point, and filled in between.

    Raises
    ------
    NoSolverError
    """
    turn = finite_array(R, "R", "numbers of shape (3, 3)", shape=(3, 3))
    points = _checked(grid, progress).points

    def values_at(rows: Index, columns: Index, tell: Progress) -> Array:
        return counts_at(robot, points[rows, columns], turn, within_limits, tell).astype(float)

    counts = refined(values_at, points.shape[:2], progress=progress)
    return counts.round().astype(np.int64)


def counts_at(
    robot: Robot,
    points: Array,
    R: Array,
    within_limits: bool = True,
    progress: Progress | None = None,
) -> NDArray[np.int64]:
    """Number of solutions at points (m, 3) with the tip turned to R (3, 3), shape (m,)."""
    task = task_of(robot).name
    counts = np.zeros(len(points), np.int64)
    near = _within_reach(robot, points)
    for start in range(0, len(near), CHUNK):
        part = near[start : start + CHUNK]
        tell = _part_of(progress, start, len(part), len(near))
        Ts = pose(R, points[part])
        batch = robot.ik_batch(Ts, within_limits=within_limits, task=task, progress=tell)
        counts[part] = batch.count
    return counts


def dexterity(
    robot: Robot,
    grid: Section,
    count: int = 200,
    *,
    within_limits: bool = True,
    held: Held | None = None,
    progress: Progress | None = None,
) -> Array:
    """Share of orientations in which each point of a section is reached, 0 to 1.

    Worked out where it changes from point to point, and filled in between.

    Parameters
    ----------
    robot : Robot
    grid : Section
    count : int
        Orientations tried at least, evenly spread.
    within_limits : bool
    held : mapping of int to array, optional
        For an arm with a joint to spare: values at which that joint is held; a pose counts as
        reached when it is at one of them.

    Raises
    ------
    NoSolverError
    """
    within_limits = flag(within_limits, "within_limits")
    turns = orientations(
        robot, task_of(robot), integer(count, "count", 1, ORIENTATIONS), within_limits=within_limits
    )
    points = _checked(grid, progress).points
    mirrored = task_of(robot).sides == "rotations" and turns_in_plane(robot, grid, within_limits)

    def values_at(rows: Index, columns: Index, tell: Progress) -> Array:
        if mirrored:  # joint 1 turns the arm over to the other side of its axis
            columns = np.maximum(columns, points.shape[1] - 1 - columns)
        spots, back = np.unique(np.stack([rows, columns]), axis=1, return_inverse=True)
        reached = shares_at(robot, points[tuple(spots)], turns, within_limits, held, tell)
        return np.asarray(reached[back.ravel()])

    return refined(values_at, points.shape[:2], tolerance=SMOOTH, progress=progress)


def shares_at(
    robot: Robot,
    points: Array,
    turns: Array,
    within_limits: bool = True,
    held: Held | None = None,
    progress: Progress | None = None,
) -> Array:
    """Share of the orientations ``turns`` (k, 3, 3) in which points (m, 3) are reached, (m,)."""
    task, tries = task_of(robot).name, _tries(held)
    shares, near = np.zeros(len(points)), _within_reach(robot, points)
    step = max(1, CHUNK // len(turns))
    for start in range(0, len(near), step):
        part = near[start : start + step]
        Ts = pose(turns, points[part, None]).reshape(-1, 4, 4)
        hit, away = np.zeros(len(Ts), np.bool_), np.zeros(len(Ts), np.bool_)
        if task == "pose":
            away = _out_of_reach(robot, Ts)
        for k, locked in enumerate(tries):
            left = np.flatnonzero(~hit & ~away)
            tell = _part_of(progress, start, len(part), len(near), k, len(tries))
            found = robot.ik_batch(
                Ts[left], within_limits=within_limits, task=task, locked=locked, progress=tell
            )
            hit[left] = found.count > 0
        shares[part] = hit.reshape(len(part), -1).mean(axis=1)
    return shares


def _part_of(
    progress: Progress | None, start: int, part: int, whole: int, k: int = 0, parts: int = 1
) -> Progress | None:
    """Progress of the k-th work on some points, as that of all points."""
    if progress is None:
        return None
    tell: Progress = progress

    def told(done: int, total: int) -> None:
        tell(start + int(part * (k + done / total) / parts), whole)

    return told


def _tries(held: Held | None) -> list[dict[int | str, float] | None]:
    """The ways of holding the joint to spare, one after the other."""
    if held is None:
        return [None]
    rows = instance(held, "held", dict).items()
    values = ((k, finite_array(vs, "held", "numbers").flat) for k, vs in rows)
    return [{k: v} for k, vs in values for v in vs] or [None]


def _within_reach(robot: Robot, points: Array) -> Index:
    """Indices of the points (m, 3) that the arm's lengths do not rule out."""
    centre, radius = reach_ball(robot)
    return np.flatnonzero(np.linalg.norm(points - centre, axis=1) <= radius * (1.0 + 1e-9))


def _out_of_reach(robot: Robot, Ts: Array) -> NDArray[np.bool_]:
    """Which poses (m, 4, 4) would put the last axis where the arm's lengths do not reach."""
    point, centre, radius = last_axis_ball(robot)
    ways = Ts[:, :3, :3] @ point + Ts[:, :3, 3] - centre
    away: NDArray[np.bool_] = np.linalg.norm(ways, axis=1) > radius * (1.0 + 1e-9)
    return away


def _checked(grid: Section, progress: Progress | None) -> Section:
    if progress is not None:
        instance(progress, "progress", Callable)
    checked: Section = instance(grid, "grid", Section)
    return checked


def held_values(
    robot: Robot, count: int = HELD, *, within_limits: bool = True
) -> dict[int, Array] | None:
    """The joint to spare of an arm of seven, and values over its range; None without one."""
    solver = instance(robot, "robot", Robot).solver
    count = integer(count, "count", 1, SAMPLES)
    if not isinstance(solver, SweptJoint):
        return None
    inside, value = flag(within_limits, "within_limits"), robot.moved_alone(solver.joint)
    if value is None:  # no value holds it
        return None
    return {value: sample_values(robot.chain, solver.joint, count, inside)}
