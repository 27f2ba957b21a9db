"""The position of the wrist where seven joints have one held, vectorised: joints 3, 1 and 2.

With ``w`` the wrist centre behind joint 3 and p its place, both seen from where axes 1 and 2 meet,

    |S1 Z3 w| = |p|,     z . (S1 Z3 w) = z . (S0^-1 Z1^-1 p),     Z2 (S1 Z3 w) = S0^-1 Z1^-1 p

are a subproblem 3 in joint 3, a subproblem 4 in joint 1 and a subproblem 1 in joint 2. Poses near
a rim are marked as dirty.
"""

from __future__ import annotations

import math

from dh2urdf.kernels.numbers import block_kernel
from dh2urdf.kernels.redundant.held_wrist_load import LOADED, UPPER
from dh2urdf.kernels.spherical_wrist import (
    BLOCK,
    COS,
    DIRTY,
    MASK,
    MERGED,
    TURN,
    VALID,
    at,
    column,
    dot,
)

__all__ = ["FORE", "FREE_ROW", "T1", "T2", "T4", "place_elbows", "place_shoulders"]

T3, T1, T2, T4 = COS, COS + 2, COS + 6, COS + 10
"""Cosines of joint 3 (two elbows), of joints 1, 2, 4, 5 and 6 (one an arm)."""

FORE = LOADED
"""Columns of the rotation ``S1 Z3 S2`` and the point ``S1 Z3 w``, twelve rows for each elbow."""

REACHED = FORE + 24
"""Whether there are elbows."""

FREE_ROW = REACHED + 1
"""First row that is free for what is worked out from the arms."""


@block_kernel
def place_elbows(S2, reach, slack, n, S):
    """Joint 3 from the distance of the wrist centre, both values, and what it carries."""
    wx, wy = S2[0, 2] * reach + S2[0, 3], S2[1, 2] * reach + S2[1, 3]
    wz = S2[2, 2] * reach + S2[2, 3]
    ww = wx * wx + wy * wy + wz * wz
    M = at(UPPER)
    for i in range(n):
        p, t = column(S, BLOCK * 9 + i, BLOCK), column(S, M + BLOCK * 9 + i, BLOCK)
        nx, ny = dot(column(S, M + i, BLOCK * 3), t), dot(column(S, M + BLOCK + i, BLOCK * 3), t)
        nz, tt, pp = dot(column(S, M + BLOCK * 2 + i, BLOCK * 3), t), dot(t, t), dot(p, p)
        a, b = -2.0 * (nx * wx + ny * wy), 2.0 * (nx * wy - ny * wx)
        d = ww + tt + 2.0 * nz * wz - pp
        square, size = a * a + b * b, (ww + tt + pp) * (ww + tt + pp)
        gap = square - d * d
        root = math.sqrt(max(gap, 0.0))
        inverse = 1.0 / max(square, 1e-30)
        c, s, dc, ds = a * d * inverse, b * d * inverse, b * root * inverse, a * root * inverse
        S[BLOCK * T3 + i], S[TURN + BLOCK * T3 + i] = c - dc, s + ds
        S[BLOCK * (T3 + 1) + i], S[TURN + BLOCK * (T3 + 1) + i] = c + dc, s - ds
        S[BLOCK * REACHED + i] = 1.0 if gap > 0.0 else 0.0
        dirty = -slack * size < gap < MERGED * size or square < MERGED * size
        S[BLOCK * DIRTY + i] += 1.0 if dirty else 0.0
    for elbow in range(2):
        for j in range(4):
            x, y, z = (S2[0, j], S2[1, j], S2[2, j]) if j < 3 else (wx, wy, wz)
            _carry(x, y, z, 1.0 if j == 3 else 0.0, elbow, 12 * elbow + 3 * j, n, S)


@block_kernel
def _carry(wx, wy, wz, moves, elbow, row, n, S):
    """``S1 Z3 w`` to three rows from ``FORE + row`` on, for a direction w, or a point: it moves."""
    turn, target, M = at(T3 + elbow), at(FORE + row), at(UPPER)
    for i in range(n):
        c, s = S[turn + i], S[TURN + turn + i]
        v, t = (c * wx - s * wy, s * wx + c * wy, wz), column(S, M + BLOCK * 9 + i, BLOCK)
        S[target + i] = dot(column(S, M + i, BLOCK), v) + moves * t[0]
        S[target + BLOCK + i] = dot(column(S, M + BLOCK * 3 + i, BLOCK), v) + moves * t[1]
        S[target + BLOCK * 2 + i] = dot(column(S, M + BLOCK * 6 + i, BLOCK), v) + moves * t[2]


@block_kernel
def place_shoulders(S0, slack, n, S):
    """Joints 1 and 2 of all four arms from the height and the direction of the wrist centre.

    Over axis 2 both directions are equally long, up to rounding that a step of Newton's method
    for the inverse square root takes away.
    """
    gx, gy, gz = S0[0, 2], S0[1, 2], S0[2, 2]
    xx, xy, xz = S0[0, 0], S0[1, 0], S0[2, 0]
    yx, yy, yz = S0[0, 1], S0[1, 1], S0[2, 1]
    for elbow in range(2):
        e, point = BLOCK * 2 * elbow & MASK, at(FORE + 12 * elbow + 9)
        for i in range(n):
            px, py, pz = column(S, BLOCK * 9 + i, BLOCK)
            ux, uy, uz = column(S, point + i, BLOCK)
            a, b, d = gx * px + gy * py, gx * py - gy * px, uz - gz * pz
            square, around, size = a * a + b * b, ux * ux + uy * uy, px * px + py * py + pz * pz
            gap = square - d * d
            root = math.sqrt(max(gap, 0.0))
            both = 1.0 / (max(square, 1e-30) * max(around, 1e-30))
            per_square, per_around = around * both, square * both
            for side in range(2):
                arm = e + BLOCK * side + i
                c, s = (a * d - b * root) * per_square, (b * d + a * root) * per_square
                x, y = c * px + s * py, c * py - s * px
                vx, vy = xx * x + xy * y + xz * pz, yx * x + yy * y + yz * pz
                across, along = ux * vy - uy * vx, ux * vx + uy * vy
                ratio = (across * across + along * along) * per_around * per_around
                inverse = per_around * (1.5 - 0.5 * ratio)
                S[arm + BLOCK * T1], S[arm + BLOCK * T1 + TURN] = c, s
                S[arm + BLOCK * T2], S[arm + BLOCK * T2 + TURN] = along * inverse, across * inverse
                exists = S[BLOCK * REACHED + i] if gap > 0.0 else 0.0
                S[arm + BLOCK * VALID], S[arm + BLOCK * (VALID + 4)] = exists, exists
                root = -root
            touching = -slack * size < gap < MERGED * size
            dirty = touching or square < MERGED * size or around < MERGED * size
            S[BLOCK * DIRTY + i] += 1.0 if dirty else 0.0
