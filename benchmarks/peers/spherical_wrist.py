"""spherical-wrist: ortho-parallel arms with a spherical wrist, in Rust, one pose or many."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import RigidTransform
from spherical_wrist import KinematicModel, Robot

from benchmarks.arms import Arm
from benchmarks.contestant import BatchContestant, NotCoveredError
from benchmarks.peers.opw_models import MODELS

__all__ = ["SphericalWristRust"]

os.environ.setdefault("RAYON_NUM_THREADS", "2")  # read when its threads start, and never again

Array = NDArray[np.float64]


class SphericalWristRust(BatchContestant):
    """``Robot.inverse`` for one pose, ``Robot.inverse_multiple`` for many, on its own threads."""

    name = "spherical-wrist"
    distribution = "spherical-wrist"
    threads = (2,)

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
        return self.robot.inverse_multiple(poses)

    def batch_configurations(self, answer: Any) -> Sequence[Array]:
        return [self.array(one) for one in answer]
