"""The wrist of an arm with one joint held, vectorised: its angles, and the residual of the whole.

With ``A = Z1 S0 Z2 S1 Z3 S2`` of one of the four arms, the wrist's ZYZ angles are those of
``A^T R``, and forward kinematics goes on from A. The other wrist, ``(q4 + pi, -q5, q6 + pi)``,
changes signs that cancel: its forward kinematics are the same numbers, and so is its residual.
"""

from __future__ import annotations

import math

from dh2urdf.kernels.certificate import POLISH
from dh2urdf.kernels.numbers import block_kernel
from dh2urdf.kernels.redundant.held_wrist_arms import FORE, FREE_ROW, T1, T2, T4
from dh2urdf.kernels.redundant.held_wrist_load import LEVER
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
        x0, x1, x2 = column(S, ARM + i, BLOCK)
        y0, y1, y2 = column(S, ARM + BLOCK * 3 + i, BLOCK)
        z0, z1, z2 = column(S, ARM + BLOCK * 6 + i, BLOCK)
        c, s = S[WRIST + i], S[WRIST + BLOCK * 3 + i]
        x0, y0, z0 = c * x0 + s * y0, sa4 * z0, sa4 * (s * x0 - c * y0)
        x1, y1, z1 = c * x1 + s * y1, sa4 * z1, sa4 * (s * x1 - c * y1)
        x2, y2, z2 = c * x2 + s * y2, sa4 * z2, sa4 * (s * x2 - c * y2)
        c, s = S[WRIST + BLOCK + i], S[WRIST + BLOCK * 4 + i]
        x0, y0, z0 = c * x0 + s * y0, sa5 * z0, sa5 * (s * x0 - c * y0)
        x1, y1, z1 = c * x1 + s * y1, sa5 * z1, sa5 * (s * x1 - c * y1)
        x2, y2, z2 = c * x2 + s * y2, sa5 * z2, sa5 * (s * x2 - c * y2)
        c, s = S[WRIST + BLOCK * 2 + i], S[WRIST + BLOCK * 5 + i]
        x0, y0 = c * x0 + s * y0, c * y0 - s * x0
        x1, y1 = c * x1 + s * y1, c * y1 - s * x1
        x2, y2 = c * x2 + s * y2, c * y2 - s * x2
        f0, f1, f2 = x0 - S[i], x1 - S[BLOCK * 3 + i], x2 - S[BLOCK * 6 + i]
        g0, g1, g2 = y0 - S[BLOCK + i], y1 - S[BLOCK * 4 + i], y2 - S[BLOCK * 7 + i]
        h0, h1, h2 = z0 - S[BLOCK * 2 + i], z1 - S[BLOCK * 5 + i], z2 - S[BLOCK * 8 + i]
        p0, p1, p2 = S[BLOCK * 9 + i], S[BLOCK * 10 + i], S[BLOCK * 11 + i]
        e0, e1 = S[ARM + BLOCK * 9 + i] - p0, S[ARM + BLOCK * 10 + i] - p1
        e2 = S[ARM + BLOCK * 11 + i] - p2
        a, b, d = S[BLOCK * LEVER + i], S[BLOCK * (LEVER + 1) + i], S[BLOCK * (LEVER + 2) + i]
        if seen_from_tool:
            a, b, d = a - p0, b - p1, d - p2
            e0, e1, e2 = (
                f0 * a + f1 * b + f2 * d - x0 * e0 - x1 * e1 - x2 * e2,
                g0 * a + g1 * b + g2 * d - y0 * e0 - y1 * e1 - y2 * e2,
                h0 * a + h1 * b + h2 * d - z0 * e0 - z1 * e1 - z2 * e2,
            )
        else:
            e0, e1, e2 = (
                e0 + f0 * a + g0 * b + h0 * d,
                e1 + f1 * a + g1 * b + h1 * d,
                e2 + f2 * a + g2 * b + h2 * d,
            )
        turn = f0 * f0 + f1 * f1 + f2 * f2 + g0 * g0 + g1 * g1 + g2 * g2
        turn += h0 * h0 + h1 * h1 + h2 * h2
        S[WRIST + BLOCK * 6 + i] = math.sqrt(max(e0 * e0 + e1 * e1 + e2 * e2, 0.5 * turn))
