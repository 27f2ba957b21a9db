"""IKDH: any 6R arm by the method of Husty and Pfurner, in C++."""

from __future__ import annotations

from typing import Any

import ikdh
import numpy as np
from numpy.typing import NDArray

from benchmarks.arms import Arm
from benchmarks.contestant import IKContestant, NotCoveredError
from dh2urdf import DHConvention

__all__ = ["Ikdh"]

Array = NDArray[np.float64]


class Ikdh(IKContestant):
    """``Solver.solve``: degrees; the standard table as it is, without base, tool and signs."""

    name = "ikdh"
    distribution = "ikdh"

    def __init__(self, arm: Arm) -> None:
        table = arm.table
        if arm.n != 6 or table.convention is not DHConvention.STANDARD:
            raise NotCoveredError("six joints in a standard table only")
        rows = table.rows
        dh = ikdh.DHTable(*([getattr(r, k) for r in rows] for k in ("a", "d", "alpha", "theta")))
        self.sign = np.array([r.sign for r in rows])
        self.T_zero_base = np.linalg.inv(table.base.matrix)
        self.T_tool_last = np.linalg.inv(table.tool.matrix)
        self.solver = ikdh.Solver(dh, ikdh.JointLimits([(-180.0, 180.0)] * 6))

    def encode(self, Ts: Array) -> list[Array]:
        return list(np.ascontiguousarray(self.T_zero_base @ Ts @ self.T_tool_last))

    def solve(self, pose: Array) -> Any:
        return self.solver.solve(pose)

    def array(self, answer: Any) -> Array:
        return np.array(answer).reshape(-1, 6)

    def configurations(self, answer: Any) -> Array:
        return self.sign * np.radians(self.array(answer))
