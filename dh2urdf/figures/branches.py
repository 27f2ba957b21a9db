"""The other configurations of a pose, as ghosts; their joint angles where the arm is planar."""

import math
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from dh2urdf.drawing.arm import zero_configuration
from dh2urdf.drawing.row import row_picture
from dh2urdf.figures.dh_marks import DHMarks
from dh2urdf.grids import number
from dh2urdf.robot import Robot
from dh2urdf.transforms import Array
from dh2urdf.workspace import task_of

BENT = (30.0, 60.0)
"""Angles [deg] of the joints in turn where q = 0 has one solution only and no q is asked for."""

RADIUS, WIDER = 0.55, 0.3
"""Radius of an angle's arc against the length of an axis, and by how much each ghost's is wider."""


def branch_ghosts(
    robot: Robot, q: ArrayLike | None = None, task: str | None = None
) -> tuple[Array, list[Array], list[str]]:
    """A configuration and all that reach the same pose, itself first, with their names.

    Parameters
    ----------
    robot : Robot
    q : array_like, shape (n,), optional
        Zero, or where that has one solution only, a bent one.
    task : {"pose", "position", "position+axis"}, optional
        What of the pose they have in common; by default as much as arms of its kind can reach.

    Raises
    ------
    NoSolverError, ConfigurationError
    """
    asked = task or task_of(robot).name
    config = zero_configuration(robot, q)
    found = robot.ik(robot.fk(config), seed=config, within_limits=False, task=asked)
    if q is None and len(found) < 2:
        bent = np.clip(np.radians(np.resize(BENT, robot.n)), robot.lower, robot.upper)
        bent = np.where(robot.slides, config, bent)
        other = robot.ik(robot.fk(bent), seed=bent, within_limits=False, task=asked)
        if len(other) > 1:
            config, found = bent, other
    names = [name or f"solution {k}" for k, name in enumerate(found.branch, 1)]
    return config, list(found.q), names


def draw_angles(marks: DHMarks, q: Array, colour: str, rank: int) -> None:
    """Arcs from x to x of each revolute joint of a planar arm at q, with their values.

    ``rank`` is 0 for the arm itself and counts its ghosts.
    """
    radius = (RADIUS + WIDER * rank) * marks.length
    for i in range(1, marks.arm.table.n + 1):
        arc = row_picture(marks.arm, q, i).theta
        angle = math.remainder(arc.value, 2 * math.pi)
        if marks.arm.chain.prismatic[i - 1] or abs(angle) < 1e-6:
            continue
        points = marks.canvas.at(replace(arc, value=angle).points(radius))
        drawn = marks.frames[i - 1]
        if np.abs(np.stack([arc.centre, arc.start]) - drawn[:3, [3, 0]].T).max() > 1e-6:
            start = np.stack([arc.centre, arc.centre + 1.3 * radius * arc.start])
            marks.canvas.line(marks.canvas.at(start), colour, 0.9, dashes=(4.0, 2.5))
        text = rf"$\theta_{{{i}}}$ = {number(round(math.degrees(angle), 1))}°"
        marks.angle(points, text, colour)
