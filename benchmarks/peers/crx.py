"""crx-kinematics: the FANUC CRX arms, in Rust."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from crx_kinematics import Crx
from numpy.typing import NDArray

from benchmarks import referee
from benchmarks.arms import Arm
from benchmarks.contestant import IKContestant, NotCoveredError

__all__ = ["CrxKinematics"]

Array = NDArray[np.float64]


class CrxKinematics(IKContestant):
    """``Crx.ik``: controller degrees (J3 against the horizontal), millimetres."""

    name = "crx-kinematics"
    distribution = "crx-kinematics"

    def __init__(self, arm: Arm) -> None:
        if arm.key != "fanuc_crx10ia":
            raise NotCoveredError("FANUC CRX only")
        self.robot = Crx.crx10ia()
        self.T_world_base, self.T_tool_flange = np.eye(4), np.eye(4)
        zero = self.metres(np.asarray(self.robot.fk(np.zeros(6))))
        T_base_tool = referee.fk(arm.table, np.zeros((1, 6)))[0]
        self.T_world_base[2, 3] = -0.245
        self.T_tool_flange = np.linalg.inv(self.T_world_base @ T_base_tool) @ zero

    @staticmethod
    def metres(T: Array) -> Array:
        """The pose (4, 4) in metres."""
        out = np.array(T, float)
        out[:3, 3] /= 1000.0
        return out

    def encode(self, Ts: Array) -> Sequence[Any]:
        poses = self.T_world_base @ Ts @ self.T_tool_flange
        poses[:, :3, 3] *= 1000.0
        return list(np.ascontiguousarray(poses))

    def solve(self, pose: Array) -> Any:
        return self.robot.ik(pose)

    def array(self, answer: Any) -> Array:
        return np.asarray(answer)

    def configurations(self, answer: Any) -> Array:
        q = np.radians(np.asarray(answer))
        q[:, 2] += q[:, 1]
        return q
