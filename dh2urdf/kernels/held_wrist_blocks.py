"""Seven joints, one held, vectorised: axes 1 and 2 meet, the wrist is orthogonal.

The same mathematics as :mod:`dh2urdf.kernels.held_wrist` where axes 1 and 2 of the oriented arm
meet: the distance of the wrist centre from their point gives joint 3 (subproblem 3), its height
over axis 2 joint 1 (subproblem 4), then joint 2 (subproblem 1) and the wrist's ZYZ angles. Poses
near singularities and rims go to the scalar kernel. Solution ``k`` has joint 1 ``k & 1``, joint 3
``k >> 1 & 1``, wrist ``k >> 2``.
"""

from __future__ import annotations

import math

import numpy as np

from dh2urdf.kernels.blocks import (
    BLOCK,
    CLEAR,
    COS,
    DIRTY,
    MASK,
    MERGED,
    RESIDUAL,
    ROWS,
    SIN,
    TURN,
    VALID,
    VALUES,
    settle,
)
from dh2urdf.kernels.certify import POLISH
from dh2urdf.kernels.compiled import block_kernel, inner_kernel, kernel
from dh2urdf.kernels.held_wrist import (
    HELD,
    LINK,
    REVERSED,
    make_scratch,
    solve_held_pose,
)
from dh2urdf.kernels.held_wrist_load import LEVER, UPPER, load_block

__all__ = ["solve_held_blocks"]

JOINT_OF = np.array([2] * 2 + [0] * 4 + [1] * 4 + [3] * 8 + [4] * 8 + [5] * 8)
ROW_OF = np.array(
    [[2 + (k & 3), 6 + (k & 3), k >> 1 & 1, 10 + k, 18 + k, 26 + k] for k in range(8)]
)

POINT = LEVER + 3
"""S1 Z3 w for both values of joint 3 (six)."""


@block_kernel
def _elbows(S2, reach, slack, n, S):
    """Joint 3 from the distance of the wrist centre, both values, and ``S1 Z3 w``."""
    wx, wy = S2[0, 2] * reach + S2[0, 3], S2[1, 2] * reach + S2[1, 3]
    wz = S2[2, 2] * reach + S2[2, 3]
    ww = wx * wx + wy * wy + wz * wz
    M = BLOCK * UPPER & MASK
    for elbow in range(2):
        side = 1.0 - 2.0 * elbow
        cosine, sine = BLOCK * (COS + elbow) & MASK, BLOCK * (SIN + elbow) & MASK
        point, valid = BLOCK * (POINT + 3 * elbow) & MASK, BLOCK * (VALID + elbow) & MASK
        for i in range(n):
            px, py, pz = S[BLOCK * 9 + i], S[BLOCK * 10 + i], S[BLOCK * 11 + i]
            m00, m01, m02 = S[M + i], S[M + BLOCK + i], S[M + BLOCK * 2 + i]
            m10, m11, m12 = S[M + BLOCK * 3 + i], S[M + BLOCK * 4 + i], S[M + BLOCK * 5 + i]
            m20, m21, m22 = S[M + BLOCK * 6 + i], S[M + BLOCK * 7 + i], S[M + BLOCK * 8 + i]
            tx, ty, tz = S[M + BLOCK * 9 + i], S[M + BLOCK * 10 + i], S[M + BLOCK * 11 + i]
            nx, ny = m00 * tx + m10 * ty + m20 * tz, m01 * tx + m11 * ty + m21 * tz
            nz = m02 * tx + m12 * ty + m22 * tz
            tt, pp = tx * tx + ty * ty + tz * tz, px * px + py * py + pz * pz
            a, b = -2.0 * (nx * wx + ny * wy), 2.0 * (nx * wy - ny * wx)
            d = ww + tt + 2.0 * nz * wz - pp
            square, size = a * a + b * b, (ww + tt + pp) * (ww + tt + pp)
            gap = square - d * d
            root = side * math.sqrt(max(gap, 0.0))
            inverse = 1.0 / max(square, 1e-30)
            c, s = (a * d - b * root) * inverse, (b * d + a * root) * inverse
            S[cosine + i], S[sine + i] = c, s
            x, y = c * wx - s * wy, s * wx + c * wy
            S[point + i] = m00 * x + m01 * y + m02 * wz + tx
            S[point + BLOCK + i] = m10 * x + m11 * y + m12 * wz + ty
            S[point + BLOCK * 2 + i] = m20 * x + m21 * y + m22 * wz + tz
            S[valid + i] = 1.0 if gap > 0.0 else 0.0
            dirty = -slack * size < gap < MERGED * size or square < MERGED * size
            S[BLOCK * DIRTY + i] += 1.0 if dirty else 0.0


@block_kernel
def _shoulders(S0, slack, n, S):
    """Joints 1 and 2 of all four arms from the height and the direction of the wrist centre."""
    gx, gy, gz = S0[0, 2], S0[1, 2], S0[2, 2]
    xx, xy, xz = S0[0, 0], S0[1, 0], S0[2, 0]
    yx, yy, yz = S0[0, 1], S0[1, 1], S0[2, 1]
    for arm in range(4):
        side, elbow = 1.0 - 2.0 * (arm & 1), arm >> 1
        cosine, sine = BLOCK * (COS + 2 + arm) & MASK, BLOCK * (SIN + 2 + arm) & MASK
        point, valid = BLOCK * (POINT + 3 * elbow) & MASK, BLOCK * (VALID + elbow) & MASK
        result = BLOCK * (VALID + 4 + arm) & MASK
        for i in range(n):
            px, py, pz = S[BLOCK * 9 + i], S[BLOCK * 10 + i], S[BLOCK * 11 + i]
            ux, uy, uz = S[point + i], S[point + BLOCK + i], S[point + BLOCK * 2 + i]
            a, b, d = gx * px + gy * py, gx * py - gy * px, uz - gz * pz
            square, size = a * a + b * b, px * px + py * py + pz * pz
            gap = square - d * d
            root = side * math.sqrt(max(gap, 0.0))
            inverse = 1.0 / max(square, 1e-30)
            c, s = (a * d - b * root) * inverse, (b * d + a * root) * inverse
            S[cosine + i], S[sine + i] = c, s
            x, y = c * px + s * py, c * py - s * px
            vx, vy = xx * x + xy * y + xz * pz, yx * x + yy * y + yz * pz
            across, along = ux * vy - uy * vx, ux * vx + uy * vy
            around = ux * ux + uy * uy
            inverse = 1.0 / math.sqrt(max(across * across + along * along, 1e-60))
            S[cosine + BLOCK * 4 + i], S[sine + BLOCK * 4 + i] = along * inverse, across * inverse
            S[result + i] = S[valid + i] if gap > 0.0 else 0.0
            touching = -slack * size < gap < MERGED * size
            dirty = touching or square < MERGED * size or around < MERGED * size
            S[BLOCK * DIRTY + i] += 1.0 if dirty else 0.0


@block_kernel
def _rest_of_rotation(S0, S2, n, S, arm, j, out):
    """Column j of the orientation that is left to the wrist, to three rows from ``out`` on."""
    u00, u10, u20, u01, u11, u21 = S0[0, 0], S0[1, 0], S0[2, 0], S0[0, 1], S0[1, 1], S0[2, 1]
    u02, u12, u22 = S0[0, 2], S0[1, 2], S0[2, 2]
    v00, v10, v20, v01, v11, v21 = S2[0, 0], S2[1, 0], S2[2, 0], S2[0, 1], S2[1, 1], S2[2, 1]
    v02, v12, v22 = S2[0, 2], S2[1, 2], S2[2, 2]
    t1, t2 = BLOCK * (COS + 2 + arm) & MASK, BLOCK * (COS + 6 + arm) & MASK
    t3, column = BLOCK * (COS + (arm >> 1)) & MASK, BLOCK * j & MASK
    M, target = BLOCK * UPPER & MASK, BLOCK * out & MASK
    for i in range(n):
        x, y, z = S[column + i], S[column + BLOCK * 3 + i], S[column + BLOCK * 6 + i]
        c, s = S[t1 + i], S[TURN + t1 + i]
        x, y = c * x + s * y, c * y - s * x
        x, y, z = (
            u00 * x + u10 * y + u20 * z,
            u01 * x + u11 * y + u21 * z,
            (u02 * x + u12 * y + u22 * z),
        )
        c, s = S[t2 + i], S[TURN + t2 + i]
        x, y = c * x + s * y, c * y - s * x
        a = S[M + i] * x + S[M + BLOCK * 3 + i] * y + S[M + BLOCK * 6 + i] * z
        b = S[M + BLOCK + i] * x + S[M + BLOCK * 4 + i] * y + S[M + BLOCK * 7 + i] * z
        z = S[M + BLOCK * 2 + i] * x + S[M + BLOCK * 5 + i] * y + S[M + BLOCK * 8 + i] * z
        c, s = S[t3 + i], S[TURN + t3 + i]
        x, y = c * a + s * b, c * b - s * a
        S[target + i] = v00 * x + v10 * y + v20 * z
        S[target + BLOCK + i] = v01 * x + v11 * y + v21 * z
        S[target + BLOCK * 2 + i] = v02 * x + v12 * y + v22 * z


@block_kernel
def _wrists(form, S0, S2, n, S):
    """ZYZ angles of what is left of the rotation, for all four arms and both wrists."""
    sa4, sa5 = form[3, 2], form[4, 2]
    X = BLOCK * (POINT + 6) & MASK
    for arm in range(4):
        for j in range(3):
            _rest_of_rotation(S0, S2, n, S, arm, j, POINT + 6 + 3 * j)
        valid = BLOCK * (VALID + arm) & MASK
        cosine, sine = BLOCK * (COS + 10 + arm) & MASK, BLOCK * (SIN + 10 + arm) & MASK
        for i in range(n):
            x0, y0, z0 = S[X + i], S[X + BLOCK + i], S[X + BLOCK * 2 + i]
            x1, y1, z1 = S[X + BLOCK * 3 + i], S[X + BLOCK * 4 + i], S[X + BLOCK * 5 + i]
            x2, y2, z2 = S[X + BLOCK * 6 + i], S[X + BLOCK * 7 + i], S[X + BLOCK * 8 + i]
            s5 = math.sqrt(x2 * x2 + y2 * y2)
            c5 = -z2 * sa4 * sa5
            inverse = sa5 / max(s5, 1e-30)
            c4, s4 = x2 * inverse, y2 * inverse
            c6 = c5 * (c4 * x0 + s4 * y0) + s5 * sa4 * z0
            s6 = -c5 * (c4 * x1 + s4 * y1) - s5 * sa4 * z1
            S[cosine + i], S[sine + i] = c4, s4
            S[cosine + BLOCK * 8 + i], S[sine + BLOCK * 8 + i] = c5, s5
            S[cosine + BLOCK * 16 + i], S[sine + BLOCK * 16 + i] = c6, s6
            S[cosine + BLOCK * 4 + i], S[sine + BLOCK * 4 + i] = -c4, -s4
            S[cosine + BLOCK * 12 + i], S[sine + BLOCK * 12 + i] = c5, -s5
            S[cosine + BLOCK * 20 + i], S[sine + BLOCK * 20 + i] = -c6, -s6
            exists = S[valid + BLOCK * 4 + i]
            S[valid + i] = exists
            dirty = s5 < CLEAR and exists > 0.0
            S[BLOCK * DIRTY + i] += 1.0 if dirty else 0.0


@block_kernel
def _measure(form, S0, S2, seen_from_tool, n, S, solution):
    """Residual of one solution of every lane by forward kinematics of the oriented arm.

    The position error is that of the user's tool: with R, p of frame 6 in frame 0 and the lever
    h, of ``p + R h``, or of ``R^T (h - p)`` where the arm is seen from the tool. The angle is that
    of ``|R - R_target|_F = 2 sqrt(2) sin(angle / 2)``.
    """
    u00, u10, u20, u01, u11, u21 = S0[0, 0], S0[1, 0], S0[2, 0], S0[0, 1], S0[1, 1], S0[2, 1]
    u02, u12, u22 = S0[0, 2], S0[1, 2], S0[2, 2]
    v00, v10, v20, v01, v11, v21 = S2[0, 0], S2[1, 0], S2[2, 0], S2[0, 1], S2[1, 1], S2[2, 1]
    v02, v12, v22, v03, v13, v23 = S2[0, 2], S2[1, 2], S2[2, 2], S2[0, 3], S2[1, 3], S2[2, 3]
    d4, sa4, sa5 = form[3, 3], form[3, 2], form[4, 2]
    t1, t2 = BLOCK * (COS + 2 + (solution & 3)) & MASK, BLOCK * (COS + 6 + (solution & 3)) & MASK
    t3, t4 = BLOCK * (COS + (solution >> 1 & 1)) & MASK, BLOCK * (COS + 10 + solution) & MASK
    t5, t6 = BLOCK * (COS + 18 + solution) & MASK, BLOCK * (COS + 26 + solution) & MASK
    M, H = BLOCK * UPPER & MASK, BLOCK * LEVER & MASK
    valid, result = BLOCK * (VALID + solution) & MASK, BLOCK * (RESIDUAL + solution) & MASK
    for i in range(n):
        c, s = S[t1 + i], S[TURN + t1 + i]
        x0, x1, x2 = c * u00 - s * u10, s * u00 + c * u10, u20
        y0, y1, y2 = c * u01 - s * u11, s * u01 + c * u11, u21
        z0, z1, z2 = c * u02 - s * u12, s * u02 + c * u12, u22
        c, s = S[t2 + i], S[TURN + t2 + i]
        x0, y0 = c * x0 + s * y0, c * y0 - s * x0
        x1, y1 = c * x1 + s * y1, c * y1 - s * x1
        x2, y2 = c * x2 + s * y2, c * y2 - s * x2
        a, b, d = S[M + BLOCK * 9 + i], S[M + BLOCK * 10 + i], S[M + BLOCK * 11 + i]
        p0, p1, p2 = x0 * a + y0 * b + z0 * d, x1 * a + y1 * b + z1 * d, x2 * a + y2 * b + z2 * d
        m00, m01, m02 = S[M + i], S[M + BLOCK + i], S[M + BLOCK * 2 + i]
        m10, m11, m12 = S[M + BLOCK * 3 + i], S[M + BLOCK * 4 + i], S[M + BLOCK * 5 + i]
        m20, m21, m22 = S[M + BLOCK * 6 + i], S[M + BLOCK * 7 + i], S[M + BLOCK * 8 + i]
        x0, y0, z0 = (
            x0 * m00 + y0 * m10 + z0 * m20,
            x0 * m01 + y0 * m11 + z0 * m21,
            x0 * m02 + y0 * m12 + z0 * m22,
        )
        x1, y1, z1 = (
            x1 * m00 + y1 * m10 + z1 * m20,
            x1 * m01 + y1 * m11 + z1 * m21,
            x1 * m02 + y1 * m12 + z1 * m22,
        )
        x2, y2, z2 = (
            x2 * m00 + y2 * m10 + z2 * m20,
            x2 * m01 + y2 * m11 + z2 * m21,
            x2 * m02 + y2 * m12 + z2 * m22,
        )
        c, s = S[t3 + i], S[TURN + t3 + i]
        x0, y0 = c * x0 + s * y0, c * y0 - s * x0
        x1, y1 = c * x1 + s * y1, c * y1 - s * x1
        x2, y2 = c * x2 + s * y2, c * y2 - s * x2
        p0 += x0 * v03 + y0 * v13 + z0 * v23
        p1 += x1 * v03 + y1 * v13 + z1 * v23
        p2 += x2 * v03 + y2 * v13 + z2 * v23
        x0, y0, z0 = (
            x0 * v00 + y0 * v10 + z0 * v20,
            x0 * v01 + y0 * v11 + z0 * v21,
            x0 * v02 + y0 * v12 + z0 * v22,
        )
        x1, y1, z1 = (
            x1 * v00 + y1 * v10 + z1 * v20,
            x1 * v01 + y1 * v11 + z1 * v21,
            x1 * v02 + y1 * v12 + z1 * v22,
        )
        x2, y2, z2 = (
            x2 * v00 + y2 * v10 + z2 * v20,
            x2 * v01 + y2 * v11 + z2 * v21,
            x2 * v02 + y2 * v12 + z2 * v22,
        )
        p0, p1, p2 = p0 + d4 * z0, p1 + d4 * z1, p2 + d4 * z2
        c, s = S[t4 + i], S[TURN + t4 + i]
        x0, y0, z0 = c * x0 + s * y0, sa4 * z0, -sa4 * (c * y0 - s * x0)
        x1, y1, z1 = c * x1 + s * y1, sa4 * z1, -sa4 * (c * y1 - s * x1)
        x2, y2, z2 = c * x2 + s * y2, sa4 * z2, -sa4 * (c * y2 - s * x2)
        c, s = S[t5 + i], S[TURN + t5 + i]
        x0, y0, z0 = c * x0 + s * y0, sa5 * z0, -sa5 * (c * y0 - s * x0)
        x1, y1, z1 = c * x1 + s * y1, sa5 * z1, -sa5 * (c * y1 - s * x1)
        x2, y2, z2 = c * x2 + s * y2, sa5 * z2, -sa5 * (c * y2 - s * x2)
        c, s = S[t6 + i], S[TURN + t6 + i]
        x0, y0 = c * x0 + s * y0, c * y0 - s * x0
        x1, y1 = c * x1 + s * y1, c * y1 - s * x1
        x2, y2 = c * x2 + s * y2, c * y2 - s * x2
        a, b, d = S[H + i], S[H + BLOCK + i], S[H + BLOCK * 2 + i]
        f0, f1, f2 = x0 - S[i], x1 - S[BLOCK * 3 + i], x2 - S[BLOCK * 6 + i]
        g0, g1, g2 = y0 - S[BLOCK + i], y1 - S[BLOCK * 4 + i], y2 - S[BLOCK * 7 + i]
        h0, h1, h2 = z0 - S[BLOCK * 2 + i], z1 - S[BLOCK * 5 + i], z2 - S[BLOCK * 8 + i]
        e0, e1, e2 = p0 - S[BLOCK * 9 + i], p1 - S[BLOCK * 10 + i], p2 - S[BLOCK * 11 + i]
        if seen_from_tool:
            a, b, d = a - S[BLOCK * 9 + i], b - S[BLOCK * 10 + i], d - S[BLOCK * 11 + i]
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
        error = math.sqrt(max(e0 * e0 + e1 * e1 + e2 * e2, 0.5 * turn))
        S[result + i] = error
        rounding = error <= POLISH
        S[BLOCK * DIRTY + i] += 1.0 if S[valid + i] > 0.0 and not rounding else 0.0


@inner_kernel
def _places(which):
    """Where in the chain the oriented arm's six joints are."""
    place = np.empty(6, np.int64)
    for j in range(6):
        moving = 5 - j if which[REVERSED] != 0 else j
        place[j] = moving if moving < which[HELD] else moving + 1
    return place


@block_kernel
def _write(held, place, values, first, n, S, q, residual, count, branch, free):
    """Write the solutions of all clean lanes in the chain's order; the others get -1."""
    for i in range(n):
        if S[BLOCK * DIRTY + i] != 0.0:
            count[first + i] = -1
            continue
        found = 0
        for k in range(8):
            if S[BLOCK * (VALID + k) + i] > 0.0:
                for j in range(6):
                    q[first + i, found, place[j]] = S[BLOCK * (VALUES + ROW_OF[k, j]) + i]
                q[first + i, found, held] = values[first + i]
                residual[first + i, found] = S[BLOCK * (RESIDUAL + k) + i]
                branch[first + i, found], free[first + i, found] = -1, 0
                found += 1
        count[first + i] = found


@kernel
def solve_held_blocks(
    frames, which, form, joints, slack, values, Ts, within_limits, q, residual, count, branch, free
):
    """:func:`dh2urdf.kernels.held_wrist.solve_held_wrist` for axes 1 and 2 that meet."""
    scratch, lever, S = make_scratch(), np.empty(3), np.empty(ROWS * BLOCK)
    seen_from_tool = which[REVERSED] != 0
    oriented_joints = joints[::-1].copy() if seen_from_tool else joints.copy()
    S0, S2, place = frames[LINK], frames[LINK + 2], _places(which)
    m = Ts.shape[0]
    for first in range(0, m, BLOCK):
        n = min(BLOCK, m - first)
        load_block(frames, which, values, Ts, first, n, scratch, lever, S)
        _elbows(S2, form[3, 3], slack, n, S)
        _shoulders(S0, slack, n, S)
        _wrists(form, S0, S2, n, S)
        for k in range(8):
            _measure(form, S0, S2, seen_from_tool, n, S, k)
        settle(form, oriented_joints, (JOINT_OF, ROW_OF), within_limits, n, S)
        out = q, residual, count, branch, free
        _write(which[HELD], place, values, first, n, S, *out)
        for i in range(first, first + n):
            if count[i] >= 0:
                continue
            pose_out = q[i], residual[i], branch[i], free[i]
            count[i] = solve_held_pose(
                frames,
                which,
                form,
                joints,
                slack,
                values[i],
                Ts[i],
                within_limits,
                *pose_out,
                scratch,
            )
