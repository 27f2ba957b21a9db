"""What `place` is asked, checked: the job, the box in which bases are tried."""

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from dh2urdf.bounds import JOB_POSES, LENGTH
from dh2urdf.doors import choice, finite_array, flag, instance, number
from dh2urdf.exceptions import ArgumentError, NoSolverError
from dh2urdf.poses import check_pose
from dh2urdf.robot import Robot
from dh2urdf.transforms import Array, pose, rpy_to_matrix
from dh2urdf.workspace.placing.job import Job
from dh2urdf.workspace.section import reach_ball

TASKS = ("pose", "position", "position+axis")

RANGES = ("region, x", "region, y", "height", "yaw")
"""What messages call the ranges of a base."""

Told = Callable[[str, int, int], None]
"""Called with what is done, how much of it, and the total."""


def job_of(
    robot: Robot, Ts: ArrayLike, mount: ArrayLike | None, task: str, within_limits: bool
) -> Job:
    """Checked arguments."""
    arm: Robot = instance(robot, "robot", Robot)
    choice(task, "task", TASKS)
    T = finite_array(Ts, "Ts", "poses of shape (m, 4, 4)")
    if T.ndim != 3 or T.shape[1:] != (4, 4) or not 1 <= len(T) <= JOB_POSES:
        raise ArgumentError(
            f"Ts: expected 1 to {JOB_POSES} poses of shape (m, 4, 4), got {T.shape}"
        )
    check_pose(T, what="Ts")
    T_foot_base = np.eye(4)
    if mount is not None:
        angles = finite_array(mount, "mount", "three angles", shape=(3,))
        T_foot_base = pose(rpy_to_matrix(angles.tolist()), np.zeros(3))
    _check_solver(arm, task)
    return Job(arm, T, T_foot_base, task, flag(within_limits, "within_limits"))


def _check_solver(robot: Robot, task: str) -> None:
    """Raise where no solver finds all solutions for a task, in a line."""
    lacking = []
    for each in (task, *TASKS):
        try:
            robot.solver_for(task=each)
        except NoSolverError:
            lacking.append(each)
        if not lacking:
            return
    has = " and ".join(each for each in TASKS if each not in lacking)
    instead = f"it has one for {has}" if has else "it has none for any task"
    raise NoSolverError(
        f"{robot.model.name}: no solver finds all solutions for task {task!r}; {instead}"
    )


def told_of(progress: Told | None) -> Told:
    """The caller's function, or one that does nothing."""
    if progress is None:
        return lambda *_: None
    told: Told = instance(progress, "progress", Callable)
    return told


def box_of(
    job: Job,
    region: ArrayLike | None,
    height: float | tuple[float, float],
    yaw: float | tuple[float, float] | None,
) -> Array:
    """Lower and upper ends (4, 2) of x, y, z [m] and yaw [rad]."""
    out = np.empty((4, 2))
    if region is None:
        out[:2] = sides(job)
    else:
        out[:2] = finite_array(region, "region", "numbers of shape (2, 2)", shape=(2, 2))
    out[2] = _ends(height, "height", LENGTH)
    out[3] = (-math.pi, math.pi) if yaw is None else _ends(yaw, "yaw", 2 * math.pi)
    for name, (low, high) in zip(RANGES, out.tolist(), strict=True):
        if max(-low, high) > LENGTH:
            raise ArgumentError(f"{name}: at most {LENGTH:g} m, got {low:g} and {high:g}")
        if low > high:
            raise ArgumentError(f"{name}: lower end first, got {low:g} and {high:g}")
    if out[3, 1] - out[3, 0] > 2 * math.pi + 1e-9:
        raise ArgumentError(
            f"yaw: a range of one turn at most, got {out[3, 0]:g} and {out[3, 1]:g} rad"
        )
    return out


def sides(job: Job) -> Array:
    """Ends (2, 2) of x and y [m] between which all poses are in reach; some, if not all can be."""
    centre, radius = reach_ball(job.robot)
    far = radius + float(np.linalg.norm((job.T_foot_base[:3, :3] @ centre)[:2]))
    points = job.T_world_tool[:, :2, 3]
    low, high = points.min(axis=0) - far, points.max(axis=0) + far
    common = np.stack([high - 2 * far, low + 2 * far], axis=1)
    apart = bool((common[:, 0] > common[:, 1]).any())
    return np.stack([low, high], axis=1) if apart else common


def _ends(value: object, what: str, most: float) -> tuple[float, float]:
    """A range of one number, or of two."""
    if isinstance(value, tuple | list | np.ndarray) and np.shape(value)[:1] == (2,):
        low, high = (number(v, what, -most, most) for v in value)
        return low, high
    single = number(value, what, -most, most)
    return single, single
