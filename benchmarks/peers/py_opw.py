"""py-opw-kinematics: ortho-parallel arms with a spherical wrist, in Rust."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from py_opw_kinematics import KinematicModel, Robot
from scipy.spatial.transform import RigidTransform

from benchmarks.arms import Arm
from benchmarks.contestant import BatchContestant, NotCoveredError

__all__ = ["PyOpw"]

Array = NDArray[np.float64]

HALF_PI = np.pi / 2
MODELS = {
    "kuka_kr6_r700": {
        "a1": 0.025,
        "a2": -0.035,
        "c1": 0.4,
        "c2": 0.315,
        "c3": 0.365,
        "c4": 0.08,
        "offsets": (0.0, -HALF_PI, 0.0, 0.0, 0.0, 0.0),
        "flip_axes": (True, False, False, True, False, True),
    }
}
"""Its parameters for the arms here; same base, tool and joints as the arm's."""


class PyOpw(BatchContestant):
    """``Robot.inverse`` for one pose, ``Robot.reach`` for many."""

    name = "py-opw"
    distribution = "py-opw-kinematics"

    def __init__(self, arm: Arm) -> None:
        if arm.key not in MODELS:
            raise NotCoveredError("no parameters for this arm")
        self.robot = Robot(KinematicModel(**MODELS[arm.key]), degrees=False)

    def encode(self, Ts: Array) -> Sequence[Any]:
        return list(RigidTransform.from_matrix(Ts))

    def solve(self, pose: Any) -> Any:
        return self.robot.inverse(pose)

    def array(self, answer: Any) -> Array:
        return np.array(answer).reshape(-1, 6)

    def encode_batch(self, Ts: Array) -> Any:
        return RigidTransform.from_matrix(Ts)

    def solve_batch(self, poses: Any, threads: int) -> Any:
        return self.robot.reach(poses, threads=threads)

    def batch_configurations(self, answer: Any) -> Sequence[Array]:
        return [q[~np.isnan(q[:, 0])] for q in answer.joints]
