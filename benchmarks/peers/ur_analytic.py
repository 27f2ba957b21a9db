"""ur-analytic-ik: the Universal Robots arms, in C++."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.arms import Arm
from benchmarks.contestant import IKContestant, NotCoveredError

__all__ = ["UrAnalytic"]

Array = NDArray[np.float64]


class UrAnalytic(IKContestant):
    """``ur5.inverse_kinematics``, same frames and joints as the maker's table."""

    name = "ur-analytic-ik"
    distribution = "ur-analytic-ik"

    def __init__(self, arm: Arm) -> None:
        if arm.key != "ur5":
            raise NotCoveredError("Universal Robots only")
        from ur_analytic_ik import ur5

        self.ur5 = ur5

    def solve(self, pose: Array) -> Any:
        return self.ur5.inverse_kinematics(pose)

    def array(self, answer: Any) -> Array:
        return np.array(answer).reshape(-1, 6)
