"""Every threshold of the solvers, each with its unit and its reason."""

from __future__ import annotations

__all__ = ["ACCEPT", "FAMILY_RANK", "FAMILY_STEP", "LIMIT_SLACK", "PATH_JUMP"]

ACCEPT = 1e-9
"""Residual [m and rad] of a solution; the same number as in ``kernels/certify.py``."""

LIMIT_SLACK = 1e-12
"""Excess over a joint limit [rad or m] that is rounding of a full turn, clipped away."""

FAMILY_RANK = 1e-6
"""Singular value of the Jacobian of the free joints, relative to the largest, that counts as
zero. A family's representative satisfies the equations to 1e-9, its tangent to the root."""

FAMILY_STEP = 0.1
"""Joint motion [rad or m] between samples along a singular family: a circle in 63 steps."""

PATH_JUMP = 0.5
"""Motion of a joint [rad or m] between neighbouring poses of a path that counts as a break,
when the caller gives no other: some 30 degrees."""
