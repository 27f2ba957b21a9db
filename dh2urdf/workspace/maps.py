"""Maps over a section: how many branches, and from how many sides."""

from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import NDArray

from dh2urdf.bounds import ORIENTATIONS, SAMPLES
from dh2urdf.doors import finite_array, flag, instance, integer
from dh2urdf.ik.redundant import SweptJoint, sample_values
from dh2urdf.robot import Robot
from dh2urdf.transforms import Array, pose
from dh2urdf.workspace.section import Section
from dh2urdf.workspace.task import orientations, task_of

Progress = Callable[[int, int], None]
"""Called with the number of poses done and their total."""

CHUNK = 60_000
"""Poses solved at a time: some 100 MB of solutions."""

HELD = 24
"""Values at which the joint to spare of an arm of seven is held."""


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
    task = task_of(robot)
    turn = finite_array(R, "R", "numbers of shape (3, 3)", shape=(3, 3))
    counts = [
        robot.ik_batch(part, within_limits=within_limits, task=task.name).count
        for part in _parts(grid, turn[None], progress)
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
    turns = orientations(robot, task, integer(count, "count", 1, ORIENTATIONS))
    tries: list[dict[int | str, float] | None] = [None]
    if held is not None:
        rows = instance(held, "held", dict).items()
        tries = [
            {k: v} for k, vs in rows for v in finite_array(vs, "held", "numbers").flat
        ] or tries
    reached = []
    for part in _parts(grid, turns, progress):
        hit = np.zeros(len(part), np.bool_)
        for locked in tries:
            left = np.flatnonzero(~hit)
            found = robot.ik_batch(
                part[left], within_limits=within_limits, task=task.name, locked=locked
            )
            hit[left] = found.count > 0
        reached.append(hit.reshape(-1, len(turns)).mean(axis=1))
    share: Array = np.concatenate(reached)
    return share.reshape(len(grid.v), len(grid.u))


def held_values(
    robot: Robot, count: int = HELD, *, within_limits: bool = True
) -> dict[int, Array] | None:
    """The joint to spare of an arm of seven, and values over its range; None without one."""
    solver = instance(robot, "robot", Robot).solver
    count = integer(count, "count", 1, SAMPLES)
    if not isinstance(solver, SweptJoint):
        return None
    inside = flag(within_limits, "within_limits")
    values = sample_values(robot.chain, solver.joint, count, inside)
    return {solver.joint: values}


def _parts(grid: Section, turns: Array, progress: Progress | None) -> Iterator[Array]:
    """Poses in chunks, each point turned in all ways (k, 3, 3), telling how far it has come."""
    if progress is not None:
        instance(progress, "progress", Callable)
    points, each = instance(grid, "grid", Section).points.reshape(-1, 3), len(turns)
    step = max(1, CHUNK // each)
    for start in range(0, len(points), step):
        part = points[start : start + step, None]
        yield pose(turns, part).reshape(-1, 4, 4)
        if progress is not None:
            progress((start + len(part)) * each, len(points) * each)
