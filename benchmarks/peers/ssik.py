"""ssik: prebuilt arms with a C++ backend, and any arm from its axes."""

from __future__ import annotations

from collections.abc import Sequence
from importlib import import_module
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks import referee
from benchmarks.arms import Arm
from benchmarks.contestant import IKContestant, NotCoveredError
from benchmarks.peers.poe import product_form

__all__ = ["SsikAxes", "SsikPrebuilt", "prebuilt_module"]

Array = NDArray[np.float64]

PREBUILT = {
    "puma560": "unimation.puma560_ik",
    "ur5": "universal_robots.ur5_ik",
    "fanuc_crx10ia": "fanuc.crx10ia_ik",
    "jaco2_urdf": "kinova.jaco2_ik",
    "xarm6_urdf": "ufactory.xarm6_ik",
    "franka_fer": "franka.panda_ik",
    "kuka_iiwa14": "kuka.iiwa14_ik",
}
BASE = {"puma560": np.array([0, 0, -26.45 * 0.0254])}
"""Where the arm's base is in the prebuilt one's [m]: the latter starts at the shoulder."""
TURN = {"ur5": np.pi}
"""Turn of joint 1 [rad]: the prebuilt one's base is the URDF's, turned from the controller's."""


def prebuilt_module(arm: Arm) -> Any:
    """The module of a prebuilt arm."""
    return import_module(f"ssik.prebuilt.{PREBUILT[arm.key]}")


class SsikPrebuilt(IKContestant):
    """``ssik.prebuilt.<arm>.solve`` without limits, native backend."""

    name = "ssik prebuilt"
    distribution = "ssik"

    def __init__(self, arm: Arm) -> None:
        if arm.key not in PREBUILT:
            raise NotCoveredError("not among its prebuilt arms")
        if arm.held:
            raise NotCoveredError("samples the redundancy, takes no held joint")
        self.module = prebuilt_module(arm)
        self.turn = np.zeros(arm.n)
        self.turn[0] = TURN.get(arm.key, 0.0)
        self.T_own_base, T_tool = np.eye(4), np.eye(4)
        self.T_own_base[:3, 3] = BASE.get(arm.key, 0.0)
        zero = np.asarray(self.module.fk(-self.turn))
        T_tool = referee.fk(arm.table, np.zeros((1, arm.n)))[0]
        self.T_tool_own = np.linalg.inv(self.T_own_base @ T_tool) @ zero

    def encode(self, Ts: Array) -> Sequence[Any]:
        return list(np.ascontiguousarray(self.T_own_base @ Ts @ self.T_tool_own))

    def solve(self, pose: Array) -> Any:
        return self.module.solve(pose, respect_limits=False)

    def array(self, answer: Any) -> Array:
        return np.array([s.q for s in answer])

    def configurations(self, answer: Any) -> Array:
        return self.array(answer).reshape(-1, len(self.turn)) + self.turn


class SsikAxes(IKContestant):
    """``Manipulator.from_axes``, what ssik offers for an arm that is not prebuilt."""

    name = "ssik from_axes"
    distribution = "ssik"

    def __init__(self, arm: Arm) -> None:
        if arm.held:
            raise NotCoveredError("samples the redundancy, takes no held joint")
        if arm.family not in ("spherical wrist", "three parallel axes"):
            raise NotCoveredError("minutes of symbolic algebra before the first answer")
        from ssik import Manipulator

        self.form = product_form(arm)
        self.arm = Manipulator.from_axes(self.form.axes, self.form.offsets)

    def encode(self, Ts: Array) -> Sequence[Any]:
        return list(np.ascontiguousarray(self.form.without_tool_turn(Ts)))

    def solve(self, pose: Array) -> Any:
        return self.arm.solve(pose)

    def array(self, answer: Any) -> Array:
        return np.array([s.q for s in answer])
