"""EAIK: closed forms by subproblems, in C++, with a batch call on threads."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from eaik.IK_Homogeneous import HomogeneousRobot
from numpy.typing import NDArray

from benchmarks import referee
from benchmarks.arms import Arm
from benchmarks.contestant import BatchContestant, NotCoveredError

__all__ = ["Eaik"]

Array = NDArray[np.float64]


class Eaik(BatchContestant):
    """``HomogeneousRobot`` from frames at q = 0; ``IK`` and ``IK_batched``."""

    name = "EAIK"
    distribution = "eaik"

    def __init__(self, arm: Arm) -> None:
        axes, points, tool = referee.zero_frames(arm.table)
        frames = np.stack([*(_frame(z, p) for z, p in zip(axes, points, strict=True)), tool])
        self.robot = HomogeneousRobot(frames, fixed_axes=[arm.held] if arm.held else None)
        if not self.robot.hasKnownDecomposition():
            raise NotCoveredError(self.robot.getKinematicFamily())
        self.n, self.held = arm.n, arm.held

    def solve(self, pose: Array) -> Any:
        return self.robot.IK(pose)

    def array(self, answer: Any) -> Array:
        """Those not flagged as least squares: a quarter of the UR5's poses have some that are."""
        q: Array = answer.Q[~answer.is_LS]
        return q

    def configurations(self, answer: Any) -> Array:
        """The same, the held joint put in its place."""
        q = self.array(answer) if len(answer.Q) else np.empty((0, self.n))
        if self.held and q.shape[1] == self.n - 1:
            q = np.insert(q, self.held[0], self.held[1], axis=1)
        return q.reshape(-1, self.n)

    def solve_batch(self, poses: Array, threads: int) -> Any:
        return self.robot.IK_batched(poses, num_worker_threads=threads)

    def batch_configurations(self, answer: Any) -> Sequence[Array]:
        return [self.configurations(one) for one in answer]


def _frame(z: Array, p: Array) -> Array:
    """Any frame at p whose z axis is z."""
    x = np.cross(np.eye(3)[np.argmin(np.abs(z))], z)
    x /= np.linalg.norm(x)
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = np.column_stack([x, np.cross(z, x), z]), p
    return T
