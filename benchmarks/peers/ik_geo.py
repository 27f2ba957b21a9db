"""ik-geo: the subproblem solvers of Elias and Wen, in Rust, one pose a call."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import ik_geo
import numpy as np
from numpy.typing import NDArray

from benchmarks.arms import Arm
from benchmarks.contestant import IKContestant, NotCoveredError
from benchmarks.peers.poe import product_form

__all__ = ["IkGeo"]

Array = NDArray[np.float64]

DECOMPOSITION = {
    "spherical wrist": ik_geo.Robot.spherical_two_parallel,
    "three parallel axes": ik_geo.Robot.three_parallel_two_intersecting,
}
"""The closed forms that fit the arms; the others are searches in one or two variables."""


class IkGeo(IKContestant):
    """``Robot.get_ik`` of the decomposition that fits; it reads rotations by columns."""

    name = "ik-geo"
    distribution = "ik-geo"

    def __init__(self, arm: Arm) -> None:
        if arm.family not in DECOMPOSITION:
            raise NotCoveredError("closed forms only; its searches lose most solutions")
        self.form = product_form(arm)
        self.robot = DECOMPOSITION[arm.family](self.form.axes, self.form.offsets)

    def encode(self, Ts: Array) -> Sequence[Any]:
        poses = self.form.without_tool_turn(Ts)
        return [(T[:3, :3].T.tolist(), T[:3, 3].tolist()) for T in poses]

    def solve(self, pose: Any) -> Any:
        return self.robot.get_ik(*pose)

    def array(self, answer: Any) -> Array:
        """Those not flagged as least squares."""
        return np.array([q for q, is_ls in answer if not is_ls])

    def configurations(self, answer: Any) -> Array:
        return self.array(answer).reshape(-1, 6)
