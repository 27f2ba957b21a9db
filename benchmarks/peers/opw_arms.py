"""What the two libraries of ortho-parallel arms with a spherical wrist have in common."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import RigidTransform

from benchmarks.arms import Arm
from benchmarks.contestant import BatchContestant, NotCoveredError
from benchmarks.peers.opw_models import MODELS

__all__ = ["Array", "OpwArm"]

Array = NDArray[np.float64]


class OpwArm(BatchContestant):
    """``Robot.inverse`` for one pose; a class says its ``library`` and how many are solved."""

    library: Any

    def __init__(self, arm: Arm) -> None:
        if arm.key not in MODELS:
            raise NotCoveredError("no parameters for this arm")
        model = self.library.KinematicModel(**MODELS[arm.key])
        self.robot = self.library.Robot(model, degrees=False)

    def encode(self, Ts: Array) -> Sequence[Any]:
        return list(RigidTransform.from_matrix(Ts))

    def solve(self, pose: Any) -> Any:
        return self.robot.inverse(pose)

    def array(self, answer: Any) -> Array:
        return np.array(answer).reshape(-1, 6)

    def encode_batch(self, Ts: Array) -> Any:
        return RigidTransform.from_matrix(Ts)
