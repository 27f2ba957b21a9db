"""py-opw-kinematics: ortho-parallel arms with a spherical wrist, in Rust."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import py_opw_kinematics

from benchmarks.peers.opw_arms import Array, OpwArm

__all__ = ["PyOpw"]


class PyOpw(OpwArm):
    """``Robot.inverse`` for one pose, ``Robot.reach`` for many."""

    name = "py-opw"
    distribution = "py-opw-kinematics"
    library = py_opw_kinematics

    def solve_batch(self, poses: Any, threads: int) -> Any:
        return self.robot.reach(poses, threads=threads)

    def batch_configurations(self, answer: Any) -> Sequence[Array]:
        return [q[~np.isnan(q[:, 0])] for q in answer.joints]
