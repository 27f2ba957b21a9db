"""What an arm of a kind can be asked to reach, and in which orientations."""

import math
from typing import NamedTuple

import numpy as np

from dh2urdf.bounds import ORIENTATIONS
from dh2urdf.conversions.write import frame_along
from dh2urdf.doors import instance, integer
from dh2urdf.robot import Robot
from dh2urdf.transforms import Array, quaternion_to_matrix, rot_z

PARALLEL = 1e-9
"""Sine of the angle between two axes up to which an arm counts as planar here."""


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
    alone = robot.moved_alone(robot.chain.n - 1) is not None
    return bool((off < 1e-9).all()) and not robot.chain.prismatic[-1] and alone


def common_axis(robot: Robot) -> tuple[int | None, bool]:
    """The base axis along which all revolute joints turn, and whether the arm stays in a plane.

    None where they turn about different directions, or about none of the base's axes.
    """
    chain = instance(robot, "robot", Robot).chain
    turning, sliding = chain.axes[~chain.prismatic], chain.axes[chain.prismatic]
    if not len(turning):
        return None, False
    axis = int(np.argmax(np.abs(turning[0])))
    if not (np.abs(turning[:, axis]) > 1.0 - PARALLEL).all():
        return None, False
    return axis, bool((np.abs(sliding[:, axis]) < PARALLEL).all())


def uniform_rotations(count: int) -> Array:
    """Rotations spread evenly over SO(3), shape (count, 3, 3).

    Super-Fibonacci spirals (Alexa, "Super-Fibonacci spirals: fast, low-discrepancy sampling of
    SO(3)", CVPR 2022, algorithm 1).
    """
    s = np.arange(integer(count, "count", 1, ORIENTATIONS)) + 0.5
    t, d = s / count, 2 * np.pi * s
    r, big = np.sqrt(t), np.sqrt(1 - t)
    alpha, beta = d / math.sqrt(2.0), d / 1.533751168755204288118041
    x, y, z, w = r * np.sin(alpha), r * np.cos(alpha), big * np.sin(beta), big * np.cos(beta)
    return quaternion_to_matrix(np.stack([x, y, z, w], axis=-1))


def rolls_about(robot: Robot, within_limits: bool) -> Array | None:
    """The axis in the tip's frame about which the last joint turns the tip on the spot, (3,).

    Where it turns all around, a place is reached in all or none of those orientations. None where
    it does not.
    """
    T_joint_tip = robot.chain.links[-1]
    off = float(np.hypot(*T_joint_tip[:2, 3]))
    last = robot.moved_alone(robot.chain.n - 1)
    if last is None or robot.chain.prismatic[-1] or off > 1e-9 * robot.chain.size:
        return None
    if within_limits and float(robot.upper[last] - robot.lower[last]) < 2 * math.pi - 1e-9:
        return None
    return np.asarray(T_joint_tip[2, :3])


def directions(count: int) -> Array:
    """Unit vectors spread evenly over the sphere (count, 3), along a Fibonacci spiral."""
    k = np.arange(count) + 0.5
    z, turn = 1.0 - 2.0 * k / count, k * math.pi * (3.0 - math.sqrt(5.0))
    r = np.sqrt(1.0 - z * z)
    return np.stack([r * np.cos(turn), r * np.sin(turn), z], axis=1)


def solved(robot: Robot, task: Task, count: int, *, within_limits: bool = True) -> int:
    """How many of so many orientations have to be solved, see :func:`orientations`."""
    rolls = task.sides == "rotations" and rolls_about(robot, within_limits) is not None
    return _pointing(count) if rolls else count


def _pointing(count: int) -> int:
    """Directions among so many rotations, the others being turns about them."""
    return math.ceil(math.pow(count, 2 / 3))


def orientations(robot: Robot, task: Task, count: int, *, within_limits: bool = True) -> Array:
    """Orientations of the tip to try at each point, shape (m, 3, 3).

    One for each direction where the last joint turns the tip about it: the others of that
    direction are reached just when it is.
    """
    at_zero = robot.chain.tool[:3, :3]
    if task.sides == "rotations":
        axis = rolls_about(robot, within_limits)
        if axis is None:
            return uniform_rotations(count)
        pointing = directions(_pointing(count))
        return np.stack([frame_along(way) for way in pointing]) @ frame_along(axis).T
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
