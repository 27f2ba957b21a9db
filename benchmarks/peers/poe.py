"""Axes and offsets at q = 0, the form that several peers take."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from benchmarks import referee
from benchmarks.arms import Arm

__all__ = ["ProductForm", "product_form"]

Array = NDArray[np.float64]

MEET = 1e-9
"""Distance [m] up to which two axes are said to meet."""


@dataclass(frozen=True)
class ProductForm:
    """``T = Trans(P_0) Rot(H_0, q_0) ... Rot(H_{n-1}, q_{n-1}) Trans(P_n) R_tool``.

    ``axes`` H (n, 3), ``offsets`` P (n + 1, 3) [m], ``R_tool`` (3, 3): tool at q = 0.
    """

    axes: Array
    offsets: Array
    R_tool: Array

    def without_tool_turn(self, Ts: Array) -> Array:
        """Poses (m, 4, 4) for a peer whose tool at q = 0 has the base's orientation."""
        out = Ts.copy()
        out[:, :3, :3] = Ts[:, :3, :3] @ self.R_tool.T
        return out


def product_form(arm: Arm) -> ProductForm:
    """Axes and offsets of an arm, points of the last joints put where their axes meet."""
    axes, points, tool = referee.zero_frames(arm.table)
    last = arm.n - 1
    common = _meeting(axes[last - 1], points[last - 1], axes[last], points[last])
    if common is not None:
        points[last - 1] = points[last] = common
        if np.linalg.norm(np.cross(axes[last - 2], common - points[last - 2])) < MEET:
            points[last - 2] = common
    steps = np.diff(np.vstack([np.zeros(3), points, tool[:3, 3]]), axis=0)
    return ProductForm(axes, steps, tool[:3, :3])


def _meeting(u: Array, p: Array, v: Array, q: Array) -> Array | None:
    """Point where the lines p + s u and q + t v meet; None where they do not."""
    normal = np.cross(u, v)
    if np.linalg.norm(normal) < 1e-9 or abs((q - p) @ normal) > MEET:
        return None
    s = np.linalg.lstsq(np.column_stack([u, -v]), q - p, rcond=None)[0][0]
    meeting: Array = p + s * u
    return meeting
