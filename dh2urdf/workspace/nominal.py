"""The arm that a calibrated one was meant to be, on which maps are made faster."""

import math
from typing import NamedTuple

import numpy as np

from dh2urdf.conversions.assign import chain_to_dh
from dh2urdf.conversions.write import dh_to_chain
from dh2urdf.dh import DHConvention, DHRow, DHTable, Origin
from dh2urdf.exceptions import Dh2UrdfError
from dh2urdf.ik.arm import NEAR, AxisLines, DHForm
from dh2urdf.ik.families import NearFamily
from dh2urdf.robot import Robot

ALLOWED = 0.002
"""How far [sizes] the nominal arm's tip may be from the calibrated one's: a pixel of a map."""


class Mapped(NamedTuple):
    """The robot on which a map is made, and how far its tip is from that of the robot asked [m]."""

    robot: Robot
    off: float


def mapped_robot(robot: Robot) -> Mapped:
    """The nominal arm of a calibrated one, the robot itself where it has a closed form or none.

    Axes that nearly meet or are nearly parallel are made so, as many as the tip allows.
    """
    if robot.n != 6 or robot.is_coupled or not isinstance(robot.solver, NearFamily):
        return Mapped(robot, 0.0)
    near = dh_to_chain(chain_to_dh(robot.chain).table)
    Q = np.random.default_rng(0).uniform(-3.0, 3.0, (64, robot.n))
    for tolerance in reversed(NEAR):
        form = DHForm(AxisLines(near, tolerance))
        try:
            nominal = Robot.from_dh(_table(robot, form))
        except Dh2UrdfError:
            continue
        gap = np.abs(nominal.fk(Q) - robot.fk(Q))[:, :3, 3].max()
        if not isinstance(nominal.solver, NearFamily) and gap < ALLOWED * robot.chain.size:
            return Mapped(nominal, float(gap))
    return Mapped(robot, 0.0)


def _table(robot: Robot, form: DHForm) -> DHTable:
    """Snapped lines as a table with the robot's names and limits."""
    free = ~np.isfinite(robot.upper - robot.lower)
    rows = [
        DHRow(
            *(theta, d, a, _right(math.atan2(sa, ca), form.lines.tolerance)),
            sign=int(sign),
            name=robot.joint_names[k],
            lower=None if free[k] else float(robot.lower[k]),
            upper=None if free[k] else float(robot.upper[k]),
        )
        for k, (a, ca, sa, d, theta, _, sign) in enumerate(form.rows.tolist())
    ]
    tool = form.tool.copy()
    if float(np.hypot(*tool[:2, 3])) < ALLOWED * robot.chain.size:
        tool[:2, 3] = 0.0
    ends = Origin.from_matrix(form.frames[0]), Origin.from_matrix(tool)
    return DHTable(tuple(rows), DHConvention.STANDARD, robot.model.name, *ends)


def _right(angle: float, tolerance: float) -> float:
    """An angle [rad], whole right angles where it nearly is."""
    right = round(angle / (math.pi / 2)) * math.pi / 2
    return right if abs(angle - right) <= tolerance else angle
