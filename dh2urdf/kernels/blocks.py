"""Many poses side by side: what the vectorised closed forms share.

A block holds up to ``BLOCK`` poses, one a lane. Quantities are rows of one flat array,
``S[BLOCK * row + lane]``, and every loop over the lanes is straight code without branches, which
the compiler turns into vector instructions. A lane where a root nearly merges, an axis nearly
lines up, a limit is nearly touched or a residual is not at rounding is marked as dirty, and its
pose is solved again by the careful scalar kernel: here is no code for edges.
"""

from __future__ import annotations

import math

from dh2urdf.kernels.compiled import block_kernel
from dh2urdf.kernels.polish import POLISH

__all__ = [
    "BLOCK",
    "CLEAR",
    "COS",
    "DIRTY",
    "INSIDE",
    "MASK",
    "MERGED",
    "POSE",
    "RESIDUAL",
    "ROWS",
    "SIN",
    "TURN",
    "VALID",
    "VALUES",
]
__all__ += ["WORK", "copy_residual", "load_poses", "measure"]

BLOCK = 32
CLEAR = 1e-6
"""Sine of an angle from which a lane is clean."""

MERGED = CLEAR * CLEAR
"""Relative distance inside a rim from which a lane is clean; outside it, it is the slack that the
careful kernel allows."""

MASK = 0xFFFFF
"""Changes no offset, and tells the compiler that it is not negative (a negative one would count
from the end, which forbids vector code)."""

POSE, DIRTY, COS = 0, 12, 13
SIN = COS + 40
TURN = BLOCK * (SIN - COS)
VALUES = SIN + 40
INSIDE = VALUES + 40
VALID = INSIDE + 40
RESIDUAL = VALID + 8
WORK = RESIDUAL + 8
ROWS = WORK + 64
"""Rows of a block: the pose (twelve), the dirt, cosines and sines of up to 40 angles, their
joint values, whether these are inside their limits, and for eight solutions whether they exist
and their residual; the rest belongs to the family."""


@block_kernel
def load_poses(ends, lift, Ts, first, n, S):
    """Frame 6 in frame 0 (moved up by ``lift``), ``base^-1 T tool^-1``, to the rows of the pose."""
    B, E = ends[0], ends[1]
    for i in range(n):
        T = Ts[first + i]
        for r in range(3):
            a, b, c, t = B[r, 0], B[r, 1], B[r, 2], B[r, 3]
            x = a * T[0, 0] + b * T[1, 0] + c * T[2, 0]
            y = a * T[0, 1] + b * T[1, 1] + c * T[2, 1]
            z = a * T[0, 2] + b * T[1, 2] + c * T[2, 2]
            p = a * T[0, 3] + b * T[1, 3] + c * T[2, 3] + t
            S[BLOCK * (3 * r) + i] = x * E[0, 0] + y * E[1, 0] + z * E[2, 0]
            S[BLOCK * (3 * r + 1) + i] = x * E[0, 1] + y * E[1, 1] + z * E[2, 1]
            S[BLOCK * (3 * r + 2) + i] = x * E[0, 2] + y * E[1, 2] + z * E[2, 2]
            S[BLOCK * (9 + r) + i] = p + x * E[0, 3] + y * E[1, 3] + z * E[2, 3]
        S[BLOCK * 11 + i] -= lift
        S[BLOCK * DIRTY + i] = 0.0


@block_kernel
def measure(form, tool, n, S, solution, t1, t2, t3, t4, t5, t6):
    """Residual of one solution of every lane by forward kinematics, t1 ... t6 its angles' rows.

    The product of the Denavit-Hartenberg rows against the pose, carried to the tool by its
    offset. The angle is that of ``|R - R_target|_F = 2 sqrt(2) sin(angle / 2)``.
    """
    a1, ca1, sa1 = form[0, 0], form[0, 1], form[0, 2]
    a2, ca2, sa2, d2 = form[1, 0], form[1, 1], form[1, 2], form[1, 3]
    a3, ca3, sa3, d3 = form[2, 0], form[2, 1], form[2, 2], form[2, 3]
    a4, ca4, sa4, d4 = form[3, 0], form[3, 1], form[3, 2], form[3, 3]
    a5, ca5, sa5, d5 = form[4, 0], form[4, 1], form[4, 2], form[4, 3]
    u, v, w = tool[0, 3], tool[1, 3], tool[2, 3]
    t1, t2, t3 = BLOCK * (COS + t1) & MASK, BLOCK * (COS + t2) & MASK, BLOCK * (COS + t3) & MASK
    t4, t5, t6 = BLOCK * (COS + t4) & MASK, BLOCK * (COS + t5) & MASK, BLOCK * (COS + t6) & MASK
    valid, result = BLOCK * (VALID + solution) & MASK, BLOCK * (RESIDUAL + solution) & MASK
    for i in range(n):
        c, s = S[t1 + i], S[TURN + t1 + i]
        x0, x1, x2 = c, s, 0.0
        y0, y1, y2 = -ca1 * s, ca1 * c, sa1
        z0, z1, z2 = sa1 * s, -sa1 * c, ca1
        p0, p1, p2 = a1 * c + d2 * z0, a1 * s + d2 * z1, d2 * z2
        c, s = S[t2 + i], S[TURN + t2 + i]
        x0, x1, x2, y0, y1, y2 = (
            c * x0 + s * y0,
            c * x1 + s * y1,
            c * x2 + s * y2,
            c * y0 - s * x0,
            c * y1 - s * x1,
            c * y2 - s * x2,
        )
        y0, y1, y2, z0, z1, z2 = (
            ca2 * y0 + sa2 * z0,
            ca2 * y1 + sa2 * z1,
            ca2 * y2 + sa2 * z2,
            ca2 * z0 - sa2 * y0,
            ca2 * z1 - sa2 * y1,
            ca2 * z2 - sa2 * y2,
        )
        p0, p1, p2 = p0 + a2 * x0 + d3 * z0, p1 + a2 * x1 + d3 * z1, p2 + a2 * x2 + d3 * z2
        c, s = S[t3 + i], S[TURN + t3 + i]
        x0, x1, x2, y0, y1, y2 = (
            c * x0 + s * y0,
            c * x1 + s * y1,
            c * x2 + s * y2,
            c * y0 - s * x0,
            c * y1 - s * x1,
            c * y2 - s * x2,
        )
        y0, y1, y2, z0, z1, z2 = (
            ca3 * y0 + sa3 * z0,
            ca3 * y1 + sa3 * z1,
            ca3 * y2 + sa3 * z2,
            ca3 * z0 - sa3 * y0,
            ca3 * z1 - sa3 * y1,
            ca3 * z2 - sa3 * y2,
        )
        p0, p1, p2 = p0 + a3 * x0 + d4 * z0, p1 + a3 * x1 + d4 * z1, p2 + a3 * x2 + d4 * z2
        c, s = S[t4 + i], S[TURN + t4 + i]
        x0, x1, x2, y0, y1, y2 = (
            c * x0 + s * y0,
            c * x1 + s * y1,
            c * x2 + s * y2,
            c * y0 - s * x0,
            c * y1 - s * x1,
            c * y2 - s * x2,
        )
        y0, y1, y2, z0, z1, z2 = (
            ca4 * y0 + sa4 * z0,
            ca4 * y1 + sa4 * z1,
            ca4 * y2 + sa4 * z2,
            ca4 * z0 - sa4 * y0,
            ca4 * z1 - sa4 * y1,
            ca4 * z2 - sa4 * y2,
        )
        p0, p1, p2 = p0 + a4 * x0 + d5 * z0, p1 + a4 * x1 + d5 * z1, p2 + a4 * x2 + d5 * z2
        c, s = S[t5 + i], S[TURN + t5 + i]
        x0, x1, x2, y0, y1, y2 = (
            c * x0 + s * y0,
            c * x1 + s * y1,
            c * x2 + s * y2,
            c * y0 - s * x0,
            c * y1 - s * x1,
            c * y2 - s * x2,
        )
        y0, y1, y2, z0, z1, z2 = (
            ca5 * y0 + sa5 * z0,
            ca5 * y1 + sa5 * z1,
            ca5 * y2 + sa5 * z2,
            ca5 * z0 - sa5 * y0,
            ca5 * z1 - sa5 * y1,
            ca5 * z2 - sa5 * y2,
        )
        p0, p1, p2 = p0 + a5 * x0, p1 + a5 * x1, p2 + a5 * x2
        c, s = S[t6 + i], S[TURN + t6 + i]
        x0, x1, x2, y0, y1, y2 = (
            c * x0 + s * y0,
            c * x1 + s * y1,
            c * x2 + s * y2,
            c * y0 - s * x0,
            c * y1 - s * x1,
            c * y2 - s * x2,
        )
        x0, x1, x2 = x0 - S[i], x1 - S[BLOCK * 3 + i], x2 - S[BLOCK * 6 + i]
        y0, y1, y2 = y0 - S[BLOCK + i], y1 - S[BLOCK * 4 + i], y2 - S[BLOCK * 7 + i]
        z0, z1, z2 = z0 - S[BLOCK * 2 + i], z1 - S[BLOCK * 5 + i], z2 - S[BLOCK * 8 + i]
        p0 += u * x0 + v * y0 + w * z0 - S[BLOCK * 9 + i]
        p1 += u * x1 + v * y1 + w * z1 - S[BLOCK * 10 + i]
        p2 += u * x2 + v * y2 + w * z2 - S[BLOCK * 11 + i]
        turn = x0 * x0 + x1 * x1 + x2 * x2 + y0 * y0 + y1 * y1 + y2 * y2
        turn += z0 * z0 + z1 * z1 + z2 * z2
        error = math.sqrt(max(p0 * p0 + p1 * p1 + p2 * p2, 0.5 * turn))
        S[result + i] = error
        exists = S[valid + i] > 0.0
        rounding = error <= POLISH
        S[BLOCK * DIRTY + i] += 1.0 if exists and not rounding else 0.0


@block_kernel
def copy_residual(source, target, n, S):
    """Another solution has the same residual."""
    source, target = BLOCK * (RESIDUAL + source) & MASK, BLOCK * (RESIDUAL + target) & MASK
    for i in range(n):
        S[target + i] = S[source + i]
