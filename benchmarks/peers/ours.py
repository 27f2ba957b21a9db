"""dh2urdf, through its public names only."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.arms import Arm
from benchmarks.contestant import BatchContestant, NotCoveredError
from dh2urdf import Robot
from dh2urdf.exceptions import NoSolverError

__all__ = ["OURS", "Ours"]

Array = NDArray[np.float64]

OURS = "dh2urdf"


class Ours(BatchContestant):
    """``Robot.ik`` and ``Robot.ik_batch`` without limits, as the peers answer."""

    name = OURS
    distribution = "dh2urdf"

    def __init__(self, arm: Arm) -> None:
        self.robot, self.locked = Robot.from_dh(arm.table), arm.locked
        try:
            self.solve(self.robot.fk(np.full(arm.n, 0.5)))
        except NoSolverError as error:
            raise NotCoveredError(str(error).splitlines()[0]) from error

    def solve(self, pose: Array) -> Any:
        return self.robot.ik(pose, within_limits=False, locked=self.locked)

    def array(self, answer: Any) -> Array:
        q: Array = answer.q
        return q

    def solve_batch(self, poses: Array, threads: int) -> Any:
        return self.robot.ik_batch(poses, within_limits=False, locked=self.locked, threads=threads)

    def batch_configurations(self, answer: Any) -> Sequence[Array]:
        return [q[:k] for q, k in zip(answer.q, answer.count, strict=True)]
