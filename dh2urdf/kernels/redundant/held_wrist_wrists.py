"""The wrist of an arm with one joint held, vectorised: its angles, and the residual of the whole.

With ``A = Z1 S0 Z2 S1 Z3 S2`` of one of the four arms, the wrist's ZYZ angles are those of
``A^T R``, and forward kinematics goes on from A. The other wrist, ``(q4 + pi, -q5, q6 + pi)``,
changes signs that cancel: its forward kinematics are the same numbers, and so is its residual.
"""

from __future__ import annotations

import math

from dh2urdf.kernels.certificate import POLISH
from dh2urdf.kernels.numbers import block_kernel, lane_kernel
from dh2urdf.kernels.redundant.held_wrist_arms import FORE, FREE_ROW, T1, T2, T4
from dh2urdf.kernels.redundant.held_wrist_load import LEVER, pose_axes
from dh2urdf.kernels.spherical_wrist import (
    BLOCK,
    CLEAR,
    DIRTY,
    MASK,
    RESIDUAL,
    TURN,
    VALID,
    at,
    column,
    dot,
    minus,
    turned,
)

__all__ = ["finish_arm"]

ARM = BLOCK * FREE_ROW
"""Where the arm at hand starts: columns of the rotation of A and its position (twelve rows)."""

WRIST = ARM + BLOCK * 12
"""Its wrist: cosines, then sines of joints 4, 5 and 6, and the residual. Rows that depend on the
arm would need more checks of what overlaps in one loop than the compiler makes vector code for."""


@block_kernel
def finish_arm(form, S0, seen_from_tool, arm, n, S):
    """Joints 4, 5 and 6 of one arm of every lane, and the residual of both its solutions."""
    _reach(S0, arm, n, S)
    _wrist(form[3, 2], form[4, 2], n, S)
    _measure(form[3, 2], form[4, 2], seen_from_tool, n, S)
    for j in range(6):
        source, place = WRIST + BLOCK * j & MASK, T4 + 4 * (j % 3) + arm
        target = BLOCK * place + (TURN if j > 2 else 0) & MASK
        for i in range(n):
            S[target + i] = S[source + i]
    valid, result = at(VALID + arm), at(RESIDUAL + arm)
    for i in range(n):
        error, exists = S[WRIST + BLOCK * 6 + i], S[valid + i] > 0.0
        careful = S[WRIST + BLOCK * 4 + i] < CLEAR or not error <= POLISH
        S[BLOCK * DIRTY + i] += 1.0 if exists and careful else 0.0
        S[result + i], S[result + BLOCK * 4 + i] = error, error


@block_kernel
def _reach(S0, arm, n, S):
    """``A = Z1 S0 Z2 S1 Z3 S2`` of one arm of every lane."""
    u00, u10, u20, u01, u11, u21 = S0[0, 0], S0[1, 0], S0[2, 0], S0[0, 1], S0[1, 1], S0[2, 1]
    u02, u12, u22 = S0[0, 2], S0[1, 2], S0[2, 2]
    t1, t2 = at(T1 + arm), at(T2 + arm)
    for j in range(4):
        fore, target = at(FORE + 12 * (arm >> 1) + 3 * j), ARM + BLOCK * 3 * j & MASK
        for i in range(n):
            x, y, z = S[fore + i], S[fore + BLOCK + i], S[fore + BLOCK * 2 + i]
            c, s = S[t2 + i], S[t2 + TURN + i]
            x, y = c * x - s * y, s * x + c * y
            x, y, z = (
                u00 * x + u01 * y + u02 * z,
                u10 * x + u11 * y + u12 * z,
                u20 * x + u21 * y + u22 * z,
            )
            c, s = S[t1 + i], S[t1 + TURN + i]
            S[target + i], S[target + BLOCK + i] = c * x - s * y, s * x + c * y
            S[target + BLOCK * 2 + i] = z


@block_kernel
def _wrist(sa4, sa5, n, S):
    """ZYZ angles of ``A^T R`` with a positive sine of joint 5."""
    for i in range(n):
        u, v = column(S, ARM + i, BLOCK), column(S, ARM + BLOCK * 3 + i, BLOCK)
        w, z6 = column(S, ARM + BLOCK * 6 + i, BLOCK), column(S, BLOCK * 2 + i, BLOCK * 3)
        x, y, z = dot(u, z6), dot(v, z6), dot(w, z6)
        s5, c5 = math.sqrt(x * x + y * y), -sa4 * sa5 * z
        inverse = sa5 / max(s5, 1e-30)
        c4, s4 = x * inverse, y * inverse
        a, b, d = c5 * c4, c5 * s4, s5 * sa4
        x = a * u[0] + b * v[0] + d * w[0]
        y = a * u[1] + b * v[1] + d * w[1]
        z = a * u[2] + b * v[2] + d * w[2]
        S[WRIST + i], S[WRIST + BLOCK * 3 + i] = c4, s4
        S[WRIST + BLOCK + i], S[WRIST + BLOCK * 4 + i] = c5, s5
        S[WRIST + BLOCK * 2 + i] = dot((x, y, z), column(S, i, BLOCK * 3))
        S[WRIST + BLOCK * 5 + i] = -dot((x, y, z), column(S, BLOCK + i, BLOCK * 3))


@block_kernel
def _measure(sa4, sa5, seen_from_tool, n, S):
    """Residual of every lane by forward kinematics of the oriented arm.

    The position error is that of the user's tool: with R, p of frame 6 in frame 0 and the lever
    h, of ``p + R h``, or of ``R^T (h - p)`` where the arm is seen from the tool. The angle is that
    of ``|R - R_target|_F = 2 sqrt(2) sin(angle / 2)``.
    """
    for i in range(n):
        x, y = column(S, ARM + i, BLOCK), column(S, ARM + BLOCK * 3 + i, BLOCK)
        z = column(S, ARM + BLOCK * 6 + i, BLOCK)
        x, y, z = _turned_upright(S[WRIST + i], S[WRIST + BLOCK * 3 + i], sa4, x, y, z)
        x, y, z = _turned_upright(S[WRIST + BLOCK + i], S[WRIST + BLOCK * 4 + i], sa5, x, y, z)
        x, y = turned(S[WRIST + BLOCK * 2 + i], S[WRIST + BLOCK * 5 + i], x, y)
        x6, y6, z6 = pose_axes(S, i)
        f, g, h = minus(x, x6), minus(y, y6), minus(z, z6)
        p, lever = column(S, BLOCK * 9 + i, BLOCK), column(S, BLOCK * LEVER + i, BLOCK)
        e = minus(column(S, ARM + BLOCK * 9 + i, BLOCK), p)
        if seen_from_tool:
            lever = minus(lever, p)
            e = dot(f, lever) - dot(x, e), dot(g, lever) - dot(y, e), dot(h, lever) - dot(z, e)
        else:
            a, b, d = lever
            e = (
                e[0] + f[0] * a + g[0] * b + h[0] * d,
                e[1] + f[1] * a + g[1] * b + h[1] * d,
                e[2] + f[2] * a + g[2] * b + h[2] * d,
            )
        turn = dot(f, f) + dot(g, g) + dot(h, h)
        S[WRIST + BLOCK * 6 + i] = math.sqrt(max(dot(e, e), 0.5 * turn))


@lane_kernel
def _turned_upright(c, s, sa, x, y, z):
    """The axes x, y, z of a frame after ``Rot_z Rot_x(alpha)`` with a right angle alpha."""
    x, (y0, y1, y2) = turned(c, s, x, y)
    return x, (sa * z[0], sa * z[1], sa * z[2]), (-sa * y0, -sa * y1, -sa * y2)
