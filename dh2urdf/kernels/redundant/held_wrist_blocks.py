"""Seven joints, one held, vectorised: axes 1 and 2 meet, the wrist is orthogonal.

The same mathematics as :mod:`dh2urdf.kernels.redundant.held_wrist` where axes 1 and 2 of the
oriented arm meet. Poses near singularities and rims go to the scalar kernel. Solution ``k`` has
joint 1 ``k & 1``, joint 3 ``k >> 1 & 1``, wrist ``k >> 2``.

With ``w`` the wrist centre behind joint 3 and p its place, both seen from where axes 1 and 2 meet,

    |S1 Z3 w| = |p|,     z . (S1 Z3 w) = z . (S0^-1 Z1^-1 p),     Z2 (S1 Z3 w) = S0^-1 Z1^-1 p

are a subproblem 3 in joint 3, a subproblem 4 in joint 1 and a subproblem 1 in joint 2. Poses near
a rim are marked as dirty.

With ``A = Z1 S0 Z2 S1 Z3 S2`` of one of the four arms, the wrist's ZYZ angles are those of
``A^T R``, and forward kinematics goes on from A. The other wrist, ``(q4 + pi, -q5, q6 + pi)``,
changes signs that cancel: its forward kinematics are the same numbers, and so is its residual.
"""

import math

import numpy as np

from dh2urdf.kernels.blocks import (
    BLOCK,
    CLEAR,
    COS,
    DIRTY,
    HALF_TURN,
    LANES,
    MERGED,
    NEGATED,
    OWN,
    RESIDUAL,
    ROWS,
    SAME,
    TURN,
    VALID,
    at,
    column,
    emit,
    turned,
)
from dh2urdf.kernels.newton import POLISH
from dh2urdf.kernels.numbers import entry, side_by_side
from dh2urdf.kernels.redundant.held_wrist import HELD, LINK, REVERSED, HeldForm, solve_rough
from dh2urdf.kernels.redundant.held_wrist_load import (
    LEVER,
    LOADED,
    UPPER,
    all_equal,
    load_block,
    pose_axes,
    prepare_block,
)
from dh2urdf.kernels.rigid import dot, minus
from dh2urdf.kernels.shapes import Held, Outputs, Poses

K, ARM = np.arange(8), np.arange(8) & 3
ROW_OF = np.stack([2 + ARM, 6 + ARM, K >> 1 & 1, 10 + ARM, 14 + ARM, 18 + ARM], 1)

ANGLES = np.array([(row, OWN, 1) for row in ROW_OF.ravel()])
ANGLES[[8, 20]] = (2, SAME, 1), (14, SAME, 1)
ANGLES[24:] = [
    (r % 24, SAME if r % 6 < 3 else NEGATED if r % 6 == 4 else HALF_TURN, 1) for r in range(24, 48)
]
"""Arms 0 and 1 have one joint 3, arms 2 and 3 the other; the other wrist of all four is
``(q4 + pi, -q5, q6 + pi)``."""

T3, T1, T2, T4 = COS, COS + 2, COS + 6, COS + 10
"""Cosines of joint 3 (two elbows), of joints 1, 2, 4, 5 and 6 (one an arm)."""

FORE = LOADED
"""Columns of the rotation ``S1 Z3 S2`` and the point ``S1 Z3 w``, twelve rows for each elbow."""

REACHED = FORE + 24
"""How far inside their rim the elbows are, relative; negative where there are none. `VALID` of an
arm is the same of its elbow and its shoulder."""

ARM = BLOCK * (REACHED + 1)
"""Where the arm at hand starts: columns of the rotation of A and its position (twelve rows)."""

WRIST = ARM + BLOCK * 12
"""Its wrist: cosines, then sines of joints 4, 5 and 6, and the residual. Rows that depend on the
arm would need more checks of what overlaps in one loop than the compiler makes vector code for."""


def place_elbows(S2, reach, slack, n, S):
    """Joint 3 from the distance of the wrist centre, both values, and what it carries."""
    wx, wy = S2[0, 2] * reach + S2[0, 3], S2[1, 2] * reach + S2[1, 3]
    wz = S2[2, 2] * reach + S2[2, 3]
    ww = wx * wx + wy * wy + wz * wz
    M = at(UPPER)
    for i in side_by_side(n):
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
        S[BLOCK * REACHED + i] = gap / max(size, 1e-300)
        dirty = -slack * size < gap < MERGED * size or square < MERGED * size
        S[BLOCK * DIRTY + i] += 1.0 if dirty else 0.0
    for elbow in range(2):
        for j in range(4):
            x, y, z = (S2[0, j], S2[1, j], S2[2, j]) if j < 3 else (wx, wy, wz)
            _carry(x, y, z, 1.0 if j == 3 else 0.0, elbow, 12 * elbow + 3 * j, n, S)


def _carry(wx, wy, wz, moves, elbow, row, n, S):
    """``S1 Z3 w`` to three rows from ``FORE + row`` on, for a direction w, or a point: it moves."""
    turn, target, M = at(T3 + elbow), at(FORE + row), at(UPPER)
    for i in side_by_side(n):
        c, s = S[turn + i], S[TURN + turn + i]
        v, t = (c * wx - s * wy, s * wx + c * wy, wz), column(S, M + BLOCK * 9 + i, BLOCK)
        S[target + i] = dot(column(S, M + i, BLOCK), v) + moves * t[0]
        S[target + BLOCK + i] = dot(column(S, M + BLOCK * 3 + i, BLOCK), v) + moves * t[1]
        S[target + BLOCK * 2 + i] = dot(column(S, M + BLOCK * 6 + i, BLOCK), v) + moves * t[2]


def place_shoulders(S0, slack, n, S):
    """Joints 1 and 2 of all four arms from the height and the direction of the wrist centre.

    Over axis 2 both directions are equally long, up to rounding that a step of Newton's method
    for the inverse square root takes away.
    """
    gx, gy, gz = S0[0, 2], S0[1, 2], S0[2, 2]
    xx, xy, xz = S0[0, 0], S0[1, 0], S0[2, 0]
    yx, yy, yz = S0[0, 1], S0[1, 1], S0[2, 1]
    for elbow in range(2):
        e, point = BLOCK * 2 * elbow, at(FORE + 12 * elbow + 9)
        for i in side_by_side(n):
            px, py, pz = column(S, BLOCK * 9 + i, BLOCK)
            ux, uy, uz = column(S, point + i, BLOCK)
            a, b, d = gx * px + gy * py, gx * py - gy * px, uz - gz * pz
            square, around, size = a * a + b * b, ux * ux + uy * uy, px * px + py * py + pz * pz
            gap = square - d * d
            reached, margin = S[BLOCK * REACHED + i], gap / max(size, 1e-300)
            margin = min(reached, margin) if reached > 0.0 else reached
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
                S[arm + BLOCK * VALID], S[arm + BLOCK * (VALID + 4)] = margin, margin
                root = -root
            touching = -slack * size < gap < MERGED * size
            dirty = touching or square < MERGED * size or around < MERGED * size
            S[BLOCK * DIRTY + i] += 1.0 if dirty else 0.0


def finish_arm(form, S0, seen_from_tool, arm, n, S):
    """Joints 4, 5 and 6 of one arm of every lane, and the residual of both its solutions."""
    _reach(S0, arm, n, S)
    _wrist(form[3, 2], form[4, 2], n, S)
    _measure(form[3, 2], form[4, 2], seen_from_tool, n, S)
    for j in range(6):
        source, place = WRIST + BLOCK * j, T4 + 4 * (j % 3) + arm
        target = BLOCK * place + (TURN if j > 2 else 0)
        for i in side_by_side(n):
            S[target + i] = S[source + i]
    valid, result = at(VALID + arm), at(RESIDUAL + arm)
    for i in side_by_side(n):
        error, exists = S[WRIST + BLOCK * 6 + i], S[valid + i] > 0.0
        careful = S[WRIST + BLOCK * 4 + i] < CLEAR or not error <= POLISH
        S[BLOCK * DIRTY + i] += 1.0 if exists and careful else 0.0
        S[result + i], S[result + BLOCK * 4 + i] = error, error


def _reach(S0, arm, n, S):
    """``A = Z1 S0 Z2 S1 Z3 S2`` of one arm of every lane."""
    u00, u10, u20, u01, u11, u21 = S0[0, 0], S0[1, 0], S0[2, 0], S0[0, 1], S0[1, 1], S0[2, 1]
    u02, u12, u22 = S0[0, 2], S0[1, 2], S0[2, 2]
    t1, t2 = at(T1 + arm), at(T2 + arm)
    for j in range(4):
        fore, target = at(FORE + 12 * (arm >> 1) + 3 * j), ARM + BLOCK * 3 * j
        for i in side_by_side(n):
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


def _wrist(sa4, sa5, n, S):
    """ZYZ angles of ``A^T R`` with a positive sine of joint 5."""
    for i in side_by_side(n):
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


def _measure(sa4, sa5, seen_from_tool, n, S):
    """Residual of every lane by forward kinematics of the oriented arm.

    The position error is that of the user's tool: with R, p of frame 6 in frame 0 and the lever
    h, of ``p + R h``, or of ``R^T (h - p)`` where the arm is seen from the tool. The angle is that
    of ``|R - R_target|_F = 2 sqrt(2) sin(angle / 2)``.
    """
    for i in side_by_side(n):
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


def _turned_upright(c, s, sa, x, y, z):
    """The axes x, y, z of a frame after ``Rot_z Rot_x(alpha)`` with a right angle alpha."""
    x, (y0, y1, y2) = turned(c, s, x, y)
    return x, (sa * z[0], sa * z[1], sa * z[2]), (-sa * y0, -sa * y1, -sa * y2)


def prepare(arm, values, oriented, place, S):
    """What all blocks have in common: limits and columns of the oriented joints, rows of S.

    Returns whether all held values are the same.
    """
    frames, which, _, joints, _ = arm
    for j in range(6):
        moving = 5 - j if which[REVERSED] != 0 else j
        place[j] = moving if moving < which[HELD] else moving + 1
        oriented[j] = joints[moving]
    prepare_block(frames, which, values, S)
    return all_equal(values)


def place_block(arm, values, Ts, same, slack, first, n, S):
    """All eight solutions of n poses from the first one on, and their residuals."""
    frames, which, form, _, _ = arm
    S0, S2, seen_from_tool = frames[LINK], frames[LINK + 2], which[REVERSED] != 0
    load_block(frames, which, values, Ts, same, seen_from_tool, first, n, S)
    place_elbows(S2, form[3, 3], slack, n, S)
    place_shoulders(S0, slack, n, S)
    for k in range(4):
        finish_arm(form, S0, seen_from_tool, k, n, S)


@entry(n=7, solutions=8)
def solve_held_blocks(
    arm: HeldForm, values: Held, Ts: Poses, within_limits: bool, outputs: Outputs
):
    """:func:`dh2urdf.kernels.redundant.held_wrist.solve_held_wrist` for axes 1 and 2 that meet."""
    q, S, m, held = outputs[0], np.empty(ROWS * BLOCK), Ts.shape[0], arm[1][HELD]
    doubts = 0
    if m == 0:
        return doubts
    oriented, place = np.empty((6, 3)), np.empty(6, np.int64)
    same = prepare(arm, values, oriented, place, S)
    for first in range(0, m, LANES):
        n = min(LANES, m - first)
        place_block(arm, values, Ts, same, arm[4], first, n, S)
        clean = emit(arm[2], oriented, ANGLES, within_limits, place, False, first, n, S, outputs)
        for i in range(first, first + n):
            for k in range(8):
                q[i, k, held] = values[i]
        if clean < n:
            doubts += solve_rough(arm, values, Ts, within_limits, first, first + n, outputs)
    return doubts
