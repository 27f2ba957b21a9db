"""The best of three measures over the solutions of poses, of any robot.

Where values move joints together, the Jacobian is that of the values, J C.
"""

import numpy as np

from dh2urdf.ik.arm import IntArray, Task
from dh2urdf.kernels.measures import best_measures
from dh2urdf.robot import Robot
from dh2urdf.transforms import Array, product

WIDE = {Task.POSE: 6, Task.POSITION: 3, Task.POSITION_AXIS: 5}
"""Directions in which a task asks for something."""


def measure_best(
    robot: Robot, task: Task | str, q: Array, count: IntArray, best: Array, unit: float = 1.0
) -> None:
    """Measures of solutions q (m, k, n), the first ``count[i]`` of each pose, to ``best`` (3, m).

    The product of the singular values of the task's Jacobian, the smallest of them, with lengths
    in a unit [m], and the smallest distance of a value or a coupled joint from its limits; -inf
    without solutions.
    """
    asked = Task(task)
    if not robot.is_coupled:
        chain = robot.chain if unit == 1.0 else robot.chain.in_unit(robot.chain.unit * unit)
        scaled = q if unit == 1.0 else np.where(robot.chain.prismatic, q / unit, q)
        best_measures(chain.tables, asked.number, scaled, count, best)
        return
    best[:] = -np.inf
    pose, k = np.nonzero(np.arange(q.shape[1]) < count[:, None])
    if len(pose):
        for row, measure in zip(best, _measures(robot, asked, q[pose, k], unit), strict=True):
            np.maximum.at(row, pose, measure)


def _measures(robot: Robot, task: Task, q: Array, unit: float) -> tuple[Array, Array, Array]:
    """The three measures of configurations q (m, n) of a coupled arm, each (m,)."""
    J = robot.jacobian(q)
    J[:, :3] /= unit
    J[:, :, robot.slides] *= unit
    if task is Task.POSITION_AXIS:
        z = robot.fk(q)[:, :3, 2]
        J[:, 3:] -= z[:, :, None] * product(z[:, None], J[:, 3:])
    wide = WIDE[task]
    every = np.linalg.svd(J[:, :3] if wide == 3 else J, compute_uv=False)
    sigma: Array = np.asarray(every[:, : min(wide, robot.n)], float)
    whole: Array = sigma.prod(axis=1)
    return whole, sigma[:, -1], _room(robot, q)


def _room(robot: Robot, q: Array) -> Array:
    """Smallest distances (m,) of values q (m, n), and of joints that several move, from limits."""
    room = np.minimum(q - robot.lower, robot.upper - q).min(axis=1)
    joints, several = robot.chain_configuration(q), robot.moved_by_several()
    if several.any():
        low, high = robot.chain.lower[several], robot.chain.upper[several]
        at = joints[:, several]
        room = np.minimum(room, np.minimum(at - low, high - at).min(axis=1))
    out: Array = np.asarray(room, float)
    return out
