"""The orientations in which every voxel of a map is tried."""

import math

import numpy as np
from numpy.typing import ArrayLike

from dh2urdf.bounds import ORIENTATIONS
from dh2urdf.conversions.write import frame_along
from dh2urdf.doors import finite_array, integer, number
from dh2urdf.exceptions import ArgumentError
from dh2urdf.poses import check_pose
from dh2urdf.robot import Robot
from dh2urdf.transforms import Array, pose, rot_z
from dh2urdf.workspace.task import Task, task_of, uniform_rotations

EXPECTED = "a whole number, or rotations of shape (k, 3, 3) or (k, spins, 3, 3)"


def tried(robot: Robot, given: object) -> tuple[Task, Array]:
    """The task of an arm, and rotations (k, spins, 3, 3) of the tip in base.

    For a number of an arm that turns its tip all around: so many rotations evenly spread over
    SO(3) (:func:`uniform_rotations`); for a planar arm or a SCARA: so many turns about its axis;
    for fewer joints its one task at any orientation.
    """
    task = task_of(robot)
    if isinstance(given, int | np.integer):
        return task, _uniform(robot, task, integer(given, "orientations", 1, ORIENTATIONS))[:, None]
    if task.name == "position":
        raise ArgumentError(
            f"orientations: {robot.model.name} is mapped by position only, a number is expected"
        )
    turns = finite_array(given, "orientations", EXPECTED, shape=(..., 3, 3))
    turns = turns[:, None] if turns.ndim == 3 else turns
    if turns.ndim != 4 or not 1 <= turns.shape[0] * turns.shape[1] <= ORIENTATIONS:
        raise ArgumentError(
            f"orientations: expected {EXPECTED}, at most {ORIENTATIONS} of them, got {turns.shape}"
        )
    check_pose(pose(turns), what="orientations")
    return task, np.ascontiguousarray(turns)


def _uniform(robot: Robot, task: Task, count: int) -> Array:
    at_zero = robot.chain.tool[:3, :3]
    if task.sides == "rotations":
        return uniform_rotations(count)
    if task.sides == "turns":
        axis = np.zeros(3)
        axis[task.axis] = 1.0
        A = frame_along(axis)
        angles = np.linspace(-np.pi, np.pi, count, endpoint=False)
        return np.stack([A @ rot_z(float(t))[:3, :3] @ A.T @ at_zero for t in angles])
    return at_zero[None]


def cone(
    count: int,
    *,
    towards: ArrayLike = (0.0, 0.0, -1.0),
    within: float = math.pi / 6,
    spins: int = 8,
) -> Array:
    """Rotations whose z stands within an angle of a direction, each in so many turns about that z.

    Directions along a Fibonacci spiral, evenly spread over the cap; as ``orientations`` of
    :func:`reach_map`, a direction counts as reached when it is in one of its turns.

    Parameters
    ----------
    count : int
        Directions of the tip's z.
    towards : array_like, shape (3,)
        Middle of the cone in base.
    within : float
        Largest angle between z and it [rad].
    spins : int
        Turns about z, evenly spread over one; 1 for the one in which the tip's x is as near as
        can be to that of the first.

    Returns
    -------
    array, shape (count, spins, 3, 3)

    Examples
    --------
    >>> from dh2urdf.workspace import cone
    >>> down = cone(100)
    >>> down.shape, bool(down[..., 2, 2].max() < -0.866)
    ((100, 8, 3, 3), True)
    """
    n = integer(count, "count", 1, ORIENTATIONS)
    m = integer(spins, "spins", 1, ORIENTATIONS)
    middle = finite_array(towards, "towards", "three numbers", shape=(3,))
    size = float(np.linalg.norm(middle))
    if not size > 0.0:
        raise ArgumentError("towards: expected a direction, got zeros")
    top = 1.0 - math.cos(number(within, "within", 0.0, math.pi, unit="rad"))
    k = np.arange(n) + 0.5
    z, turn = 1.0 - top * k / n, k * math.pi * (3.0 - math.sqrt(5.0))
    r = np.sqrt(np.maximum(1.0 - z * z, 0.0))
    ways = np.stack([r * np.cos(turn), r * np.sin(turn), z], axis=1) @ frame_along(middle / size).T
    about = np.stack([rot_z(float(t))[:3, :3] for t in 2 * np.pi * np.arange(m) / m])
    return np.stack([frame_along(way) for way in ways])[:, None] @ about
