"""frankik: the Franka arms at a given last joint, in C++ (He and Liu 2021)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import frankik
import numpy as np
from numpy.typing import NDArray

from benchmarks.arms import Arm
from benchmarks.contestant import IKContestant, NotCoveredError

__all__ = ["Frankik"]

Array = NDArray[np.float64]


class Frankik(IKContestant):
    """``ik_full``: up to four configurations within the arm's limits, NaN where there is none."""

    name = "frankik"
    distribution = "frankik"
    keeps_limits = True

    def __init__(self, arm: Arm) -> None:
        if arm.key != "franka_fer" or not arm.held:
            raise NotCoveredError("Franka arms only")
        self.q7 = arm.held[1]
        self.q_start = np.array(frankik.FrankaKinematics("panda").q_home)

    def encode(self, Ts: Array) -> Sequence[Any]:
        return list(Ts)

    def solve(self, pose: Array) -> Any:
        return frankik.ik_full(pose, self.q_start, self.q7)

    def array(self, answer: Any) -> Array:
        q: Array = answer[~np.isnan(answer[:, 0])]
        return q
