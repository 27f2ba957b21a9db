"""robotics-toolbox-python: one solution of any arm, by damped Newton steps in C."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from roboticstoolbox import ET, ETS

from benchmarks.arms import Arm
from benchmarks.contestant import IKContestant, NotCoveredError
from dh2urdf import DHConvention

__all__ = ["ToolboxSearch", "elementary_transforms"]

Array = NDArray[np.float64]

TOLERANCE = 1e-17
"""Half the squared residual at which it stops: its own 1e-6 allows a millimetre."""


def elementary_transforms(arm: Arm) -> Any:
    """The table as a sequence of elementary transforms, what the toolbox evaluates fastest."""
    parts = [ET.SE3(arm.table.base.matrix)]
    for row in arm.rows:
        joint = [ET.Rz(flip=row.sign < 0), ET.Rz(row.theta), ET.tz(row.d)]
        across = [ET.tx(row.a), ET.Rx(row.alpha)]
        standard = arm.table.convention is DHConvention.STANDARD
        parts += joint + across if standard else across + joint
    return ETS([*parts, ET.SE3(arm.table.tool.matrix)])


class ToolboxSearch(IKContestant):
    """``ETS.ik_LM`` from random starts, without limits."""

    name = "roboticstoolbox search"
    distribution = "roboticstoolbox-python"
    searches = True

    def __init__(self, arm: Arm) -> None:
        if arm.held:
            raise NotCoveredError("takes no held joint")
        self.ets, self.n = elementary_transforms(arm), arm.n

    def solve(self, pose: Array) -> Any:
        return self.ets.ik_LM(pose, tol=TOLERANCE, joint_limits=False)

    def array(self, answer: Any) -> Array:
        q: Array = np.atleast_2d(answer.q)
        return q if answer.success else q[:0]
