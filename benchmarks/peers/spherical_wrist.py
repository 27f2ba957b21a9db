"""spherical-wrist: ortho-parallel arms with a spherical wrist, in Rust, one pose or many."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any

import spherical_wrist

from benchmarks.peers.opw_arms import Array, OpwArm

__all__ = ["SphericalWristRust"]

os.environ.setdefault("RAYON_NUM_THREADS", "2")  # read when its threads start, and never again


class SphericalWristRust(OpwArm):
    """``Robot.inverse`` for one pose, ``Robot.inverse_multiple`` for many, on its own threads."""

    name = "spherical-wrist"
    distribution = "spherical-wrist"
    threads = (2,)
    library = spherical_wrist

    def solve_batch(self, poses: Any, threads: int) -> Any:
        return self.robot.inverse_multiple(poses)

    def batch_configurations(self, answer: Any) -> Sequence[Array]:
        return [self.array(one) for one in answer]
