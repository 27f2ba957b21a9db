"""Common spherical-wrist arms, vectorised: axis 2 parallel to 3 or square to a slide 3.

The wrist is orthogonal. The same mathematics as the scalar kernels beside, for poses away from
singularities and rims; all others go to these. Solution ``k`` has shoulder ``k & 1``, elbow, or
sign of the slide, ``k >> 1 & 1``, wrist ``k >> 2``.

The other wrist, ``(q4 + pi, -q5, q6 + pi)``, changes signs that cancel in forward kinematics, so
that its residual is the same number.
"""

import math

import numpy as np

from dh2urdf.kernels.blocks import (
    BLOCK,
    CLEAR,
    COS,
    DIRTY,
    LANES,
    MERGED,
    MIRRORS,
    RESIDUAL,
    ROWS,
    SIN,
    VALID,
    VALUES,
    WORK,
    at,
    column,
    emit,
    load_poses,
    measure,
    planar_arm,
    turned_and_tilted,
)
from dh2urdf.kernels.numbers import entry, side_by_side, sincos
from dh2urdf.kernels.shapes import ClosedForm, Outputs, Poses
from dh2urdf.kernels.spherical_wrist.poses import make_scratch, solve_pose

JOINT_OF = np.array([0] * 2 + [1] * 4 + [2] * 4 + ([3] * 4 + [4] * 4 + [5] * 4) * 2)
ARM, OTHER = np.arange(8) & 3, 12 * (np.arange(8) >> 2)
IN_ORDER = np.arange(6)
ROW_OF = np.stack([ARM & 1, 2 + ARM, 6 + ARM, *(10 + 4 * j + ARM + OTHER for j in range(3))], 1)

PLANE = WORK
"""Per shoulder: x and y of the wrist centre in the arm's plane, the rotation seen from there."""

BEHIND = PLANE + 22
"""Per arm that slides: the rotation seen from behind joint 2."""

UNIT = 1.0
"""Added to the squared size of an arm that slides, whose other lengths may all be zero."""


def _resting(form):
    """The wrist centre behind a slide 3 at zero, in the axes of joint 2."""
    (s, c), x, y = sincos(form[2, 4]), form[2, 0], -form[2, 2] * form[3, 3]
    return c * x - s * y, s * x + c * y, form[2, 1] * form[3, 3]


def _shoulders(form, slack, n, S):
    """Joint 1, and the pose seen from the arm's plane, for both shoulders."""
    a1, ca1, sa1 = form[0, 0], form[0, 1], form[0, 2]
    lateral, least = form[2, 1] * form[3, 3] + form[1, 3] + form[2, 3], 0.0
    if form[2, 5] != 0.0:
        _, across, _ = _resting(form)
        lateral, least = form[1, 2] * across + form[1, 3], UNIT
    scale = a1 * a1 + form[1, 0] * form[1, 0] + form[2, 0] * form[2, 0] + form[3, 3] * form[3, 3]
    for shoulder in range(2):
        side = 1.0 - 2.0 * shoulder
        rows, valid = at(PLANE + 11 * shoulder), at(VALID + shoulder)
        cosine, sine = at(COS + shoulder), at(SIN + shoulder)
        for i in side_by_side(n):
            px, py, pz = S[BLOCK * 9 + i], S[BLOCK * 10 + i], S[BLOCK * 11 + i]
            y = (pz - ca1 * lateral) / sa1
            offset = ca1 * y - sa1 * lateral
            square = px * px + py * py
            reach2 = square - offset * offset
            size = scale + offset * offset + least
            reach = side * math.sqrt(max(reach2, 0.0))
            inverse = 1.0 / max(square, 1e-30)
            c, s = (px * reach + py * offset) * inverse, (py * reach - px * offset) * inverse
            S[cosine + i], S[sine + i] = c, s
            S[rows + i], S[rows + BLOCK + i] = reach - a1, y
            S[valid + i] = 1.0 if reach2 > 0.0 else 0.0
            dirty = -slack * size < reach2 < MERGED * size or square < MERGED * size
            S[BLOCK * DIRTY + i] += 1.0 if dirty else 0.0
        for j in range(3):
            for i in side_by_side(n):
                c, s = S[cosine + i], S[sine + i]
                r0, r1 = S[BLOCK * j + i], S[BLOCK * (3 + j) + i]
                r2 = S[BLOCK * (6 + j) + i]
                x, y = c * r0 + s * r1, c * r1 - s * r0
                S[rows + BLOCK * (2 + j) + i] = x
                S[rows + BLOCK * (5 + j) + i] = ca1 * y + sa1 * r2
                S[rows + BLOCK * (8 + j) + i] = ca1 * r2 - sa1 * y


def _elbows(form, slack, n, S):
    """Joints 2 and 3 of all four arms: planar RR (lecture notes 8.2)."""
    upper = form[1, 0]
    wx, wy = form[2, 0], -form[2, 2] * form[3, 3]
    fore = math.sqrt(wx * wx + wy * wy)
    lean_c, lean_s = wx / fore, wy / fore
    for arm in range(4):
        shoulder, elbow = arm & 1, arm >> 1
        rows, valid, result = at(PLANE + 11 * shoulder), at(VALID + shoulder), at(VALID + 4 + arm)
        cosine, sine = at(COS + arm), at(SIN + arm)
        side = -1.0 if (elbow == 0) == ((form[0, 2] > 0.0) == (shoulder == 0)) else 1.0
        for i in side_by_side(n):
            x, y = S[rows + i], S[rows + BLOCK + i]
            c2, s2, c3, s3, reached, dirty = planar_arm(upper, fore, side, x, y, slack)
            S[cosine + BLOCK * 2 + i], S[sine + BLOCK * 2 + i] = c2, s2
            S[cosine + BLOCK * 6 + i] = c3 * lean_c + s3 * lean_s
            S[sine + BLOCK * 6 + i] = s3 * lean_c - c3 * lean_s
            exists = S[valid + i]
            S[result + i] = exists if reached else 0.0
            S[BLOCK * DIRTY + i] += 1.0 if dirty else 0.0


def _slides(form, slack, n, S):
    """Joints 2 and 3 of all four arms, and the rotation behind joint 2.

    The centre is ``Rot(t2) (along, rise)``, where joint 3 changes the rise.
    """
    (s3, c3), (x, _, height), sa2 = sincos(form[2, 4]), _resting(form), form[1, 2]
    along = form[1, 0] + x
    for arm in range(4):
        shoulder, side = arm & 1, -1.0 if arm >> 1 == 0 else 1.0
        rows, valid, result = at(PLANE + 11 * shoulder), at(VALID + shoulder), at(VALID + 4 + arm)
        cosine, sine, value = at(COS + arm), at(SIN + arm), at(VALUES + 6 + arm)
        behind = at(BEHIND + 9 * arm)
        for i in side_by_side(n):
            x, y = S[rows + i], S[rows + BLOCK + i]
            square = x * x + y * y
            gap = square - along * along
            rise = side * math.sqrt(max(gap, 0.0))
            inverse = 1.0 / max(square, 1e-30)
            S[cosine + BLOCK * 2 + i] = (x * along + y * rise) * inverse
            S[sine + BLOCK * 2 + i] = (y * along - x * rise) * inverse
            S[cosine + BLOCK * 6 + i], S[sine + BLOCK * 6 + i] = c3, s3
            S[value + i] = -sa2 * rise - height
            exists, size = S[valid + i], square + UNIT
            S[result + i] = exists if gap > 0.0 else 0.0
            dirty = -slack * size < gap < MERGED * size
            S[BLOCK * DIRTY + i] += exists if dirty else 0.0
        for j in range(3):
            for i in side_by_side(n):
                c, s = S[cosine + BLOCK * 2 + i], S[sine + BLOCK * 2 + i]
                x, y = S[rows + BLOCK * (2 + j) + i], S[rows + BLOCK * (5 + j) + i]
                S[behind + BLOCK * j + i] = c * x + s * y
                S[behind + BLOCK * (3 + j) + i] = sa2 * S[rows + BLOCK * (8 + j) + i]
                S[behind + BLOCK * (6 + j) + i] = sa2 * (s * x - c * y)


def _wrists(form, n, S):
    """ZYZ angles of what is left of the rotation, for all four arms and both wrists."""
    ca3, sa3, sa4, sa5 = form[2, 1], form[2, 2], form[3, 2], form[4, 2]
    slides = form[2, 5] != 0.0
    for arm in range(4):
        rows = at(BEHIND + 9 * arm if slides else PLANE + 2 + 11 * (arm & 1))
        valid, cosine, sine = at(VALID + arm), at(COS + arm), at(SIN + arm)
        for i in side_by_side(n):
            c2, s2 = S[cosine + BLOCK * 2 + i], S[sine + BLOCK * 2 + i]
            c3, s3 = S[cosine + BLOCK * 6 + i], S[sine + BLOCK * 6 + i]
            c2, s2 = (1.0, 0.0) if slides else (c2, s2)
            c, s = c2 * c3 - s2 * s3, s2 * c3 + c2 * s3
            x = column(S, rows + i, BLOCK)
            y = column(S, rows + BLOCK * 3 + i, BLOCK)
            z = column(S, rows + BLOCK * 6 + i, BLOCK)
            (x0, x1, x2), (y0, y1, y2), (z0, z1, z2) = turned_and_tilted(c, s, ca3, sa3, x, y, z)
            s5 = math.sqrt(x2 * x2 + y2 * y2)
            c5 = -z2 * sa4 * sa5
            inverse = sa5 / max(s5, 1e-30)
            c4, s4 = x2 * inverse, y2 * inverse
            c6 = c5 * (c4 * x0 + s4 * y0) + s5 * sa4 * z0
            s6 = -c5 * (c4 * x1 + s4 * y1) - s5 * sa4 * z1
            S[cosine + BLOCK * 10 + i], S[sine + BLOCK * 10 + i] = c4, s4
            S[cosine + BLOCK * 14 + i], S[sine + BLOCK * 14 + i] = c5, s5
            S[cosine + BLOCK * 18 + i], S[sine + BLOCK * 18 + i] = c6, s6
            exists = S[valid + BLOCK * 4 + i]
            S[valid + i] = exists
            dirty = s5 < CLEAR and exists > 0.0
            S[BLOCK * DIRTY + i] += 1.0 if dirty else 0.0


@entry(n=6, solutions=8)
def solve_common_wrist(arm: ClosedForm, Ts: Poses, within_limits: bool, outputs: Outputs):
    """:func:`dh2urdf.kernels.spherical_wrist.poses.solve_wrist_arm` for the common geometry."""
    (_, joints), form, ends, slack = arm
    q, residual, count, branch, free = outputs
    m, S, table = Ts.shape[0], np.empty(ROWS * BLOCK), (JOINT_OF, ROW_OF, MIRRORS)
    slides, doubts = form[2, 5] != 0.0, 0
    for first in range(0, m, LANES):
        n = min(LANES, m - first)
        load_poses(ends, form[0, 3], Ts, first, n, S)
        _shoulders(form, slack, n, S)
        if slides:
            _slides(form, slack, n, S)
        else:
            _elbows(form, slack, n, S)
        _wrists(form, n, S)
        for k in range(4):
            measure(form, ends[2], n, S, k, k & 1, 2 + k, 6 + k, 10 + k, 14 + k, 18 + k)
        for i in range(at(4)):
            S[at(RESIDUAL + 4) + i] = S[at(RESIDUAL) + i]
        emit(form, joints, table, within_limits, IN_ORDER, not slides, first, n, S, outputs)
        for i in range(first, first + n):
            if count[i] < 0:
                out = q[i], residual[i], branch[i], free[i]
                scratch = make_scratch()
                count[i], doubt = solve_pose(arm, Ts[i], within_limits, out, scratch)
                # beside a slide at zero joint 2 hardly turns the tool
                if doubt and slides:
                    count[i] = -1 - count[i]
                    doubts += 1
    return doubts
