"""py-ikgeo-kinematics: IK-Geo in Rust with one- and two-variable searches for other arms."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from py_ikgeo_kinematics import KinematicModel, Robot
from scipy.spatial.transform import RigidTransform

from benchmarks.arms import Arm
from benchmarks.contestant import BatchContestant, NotCoveredError
from benchmarks.peers.poe import product_form

__all__ = ["PyIkgeo"]

Array = NDArray[np.float64]


class PyIkgeo(BatchContestant):
    """``Robot.inverse`` for one pose, ``Robot.reach`` for many."""

    name = "py-ikgeo"
    distribution = "py-ikgeo-kinematics"

    def __init__(self, arm: Arm) -> None:
        if arm.n != 6:
            raise NotCoveredError("six joints only")
        self.form = product_form(arm)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            model = KinematicModel(self.form.axes.T, self.form.offsets.T)
            self.robot = Robot(model, degrees=False)

    def encode(self, Ts: Array) -> Sequence[Any]:
        poses = self.form.without_tool_turn(Ts)
        return [RigidTransform.from_matrix(T) for T in poses]

    def solve(self, pose: Any) -> Any:
        return self.robot.inverse(pose)

    def array(self, answer: Any) -> Array:
        return np.array(answer).reshape(-1, 6)

    def encode_batch(self, Ts: Array) -> Any:
        return RigidTransform.from_matrix(self.form.without_tool_turn(Ts))

    def solve_batch(self, poses: Any, threads: int) -> Any:
        return self.robot.reach(poses, threads=threads)

    def batch_configurations(self, answer: Any) -> Sequence[Array]:
        return [q[:k] for q, k in zip(answer.joints, answer.n_solutions, strict=True)]
