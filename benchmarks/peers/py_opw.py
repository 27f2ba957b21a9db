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
from benchmarks.peers.opw_models import MODELS

__all__ = ["PyOpw"]

Array = NDArray[np.float64]


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
