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
    ARMS,
    BLOCK,
    CLEAR,
    COS,
    DIRTY,
    HALF_TURN,
    LEFT,
    MERGED,
    NEGATED,
    OWN,
    POSE,
    POSES,
    RESIDUAL,
    ROWS,
    SAME,
    SIN,
    UP,
    VALID,
    VALUES,
    WORK,
    at,
    column,
    emit,
    load_poses,
    measure,
    planar_arm,
    share,
    sides,
    turned_and_tilted,
)
from dh2urdf.kernels.counts import how_many
from dh2urdf.kernels.numbers import entry, side_by_side, sincos
from dh2urdf.kernels.shapes import ClosedForm, Outputs, Poses
from dh2urdf.kernels.spherical_wrist.poses import make_scratch, solve_pose

IN_ORDER = np.arange(6)
ANGLES = np.array([(r, OWN, 2 if r == 0 else 4) for r in range(12)])
ANGLES[6:] = [(r, (SAME, SAME, SAME, HALF_TURN, NEGATED, HALF_TURN)[r], 4) for r in range(6)]

PLANE = WORK + 2
"""The wrist centre in the arm's plane, x and y, and the rotation seen from there."""

UNIT = 1.0
"""Added to the squared size of an arm that slides, whose other lengths may all be zero."""

MEETING = 1e-6
"""Length [m] of a slide from where it is singular, times the sine of the angle between axes 4 and
6, from which a lane is clean."""


def _resting(form):
    """The wrist centre behind a slide 3 at zero, in the axes of joint 2."""
    (s, c), x, y = sincos(form[2, 4]), form[2, 0], -form[2, 2] * form[3, 3]
    return c * x - s * y, s * x + c * y, form[2, 1] * form[3, 3]


def _shoulders(form, slack, n, S):
    """Joint 1, and the pose seen from the arm's plane, for both shoulders, then both elbows."""
    a1, ca1, sa1 = form[0, 0], form[0, 1], form[0, 2]
    lateral, least = form[2, 1] * form[3, 3] + form[1, 3] + form[2, 3], 0.0
    if form[2, 5] != 0.0:
        _, across, _ = _resting(form)
        lateral, least = form[1, 2] * across + form[1, 3], UNIT
    scale = a1 * a1 + form[1, 0] * form[1, 0] + form[2, 0] * form[2, 0] + form[3, 3] * form[3, 3]
    for i in side_by_side(n):
        px, py, pz = S[BLOCK * 9 + i], S[BLOCK * 10 + i], S[BLOCK * 11 + i]
        y = (pz - ca1 * lateral) / sa1
        offset = ca1 * y - sa1 * lateral
        square = px * px + py * py
        reach2 = square - offset * offset
        size = scale + offset * offset + least
        reach = S[BLOCK * LEFT + i] * math.sqrt(max(reach2, 0.0))
        inverse = 1.0 / max(square, 1e-30)
        c, s = (px * reach + py * offset) * inverse, (py * reach - px * offset) * inverse
        S[BLOCK * COS + i], S[BLOCK * SIN + i] = c, s
        S[BLOCK * PLANE + i], S[BLOCK * (PLANE + 1) + i] = reach - a1, y
        S[BLOCK * VALID + i] = 1.0 if reach2 > 0.0 else 0.0
        dirty = -slack * size < reach2 < MERGED * size or square < MERGED * size
        S[BLOCK * DIRTY + i] += 1.0 if dirty else 0.0
    for j in range(3):
        target = at(PLANE + 2 + j)
        for i in side_by_side(n):
            c, s = S[BLOCK * COS + i], S[BLOCK * SIN + i]
            r0, r1, r2 = column(S, BLOCK * j + i, BLOCK * 3)
            x, y = c * r0 + s * r1, c * r1 - s * r0
            S[target + i] = x
            S[target + BLOCK * 3 + i] = ca1 * y + sa1 * r2
            S[target + BLOCK * 6 + i] = ca1 * r2 - sa1 * y
    share(POSE, COS + 1, n, S)
    share(SIN, SIN + 1, n, S)
    share(VALID, VALID + 1, n, S)
    share(PLANE, PLANE + 11, n, S)


def _elbows(form, slack, n, S):
    """Joints 2 and 3: planar RR (lecture notes 8.2)."""
    upper, side = form[1, 0], -1.0 if form[0, 2] > 0.0 else 1.0
    wx, wy = form[2, 0], -form[2, 2] * form[3, 3]
    fore = math.sqrt(wx * wx + wy * wy)
    lean_c, lean_s = wx / fore, wy / fore
    for i in side_by_side(n):
        x, y = S[BLOCK * PLANE + i], S[BLOCK * (PLANE + 1) + i]
        bend = side * S[BLOCK * LEFT + i] * S[BLOCK * UP + i]
        c2, s2, c3, s3, reached, dirty = planar_arm(upper, fore, bend, x, y, slack)
        S[BLOCK * (COS + 1) + i], S[BLOCK * (SIN + 1) + i] = c2, s2
        S[BLOCK * (COS + 2) + i] = c3 * lean_c + s3 * lean_s
        S[BLOCK * (SIN + 2) + i] = s3 * lean_c - c3 * lean_s
        exists = S[BLOCK * VALID + i]
        S[BLOCK * VALID + i] = exists if reached else 0.0
        S[BLOCK * DIRTY + i] += 1.0 if dirty else 0.0


def _slides(form, slack, n, S):
    """Joints 2 and 3, and the rotation behind joint 2.

    The centre is ``Rot(t2) (along, rise)``, where joint 3 changes the rise.
    """
    (s3, c3), (x, _, height), sa2 = sincos(form[2, 4]), _resting(form), form[1, 2]
    along = form[1, 0] + x
    for i in side_by_side(n):
        x, y = S[BLOCK * PLANE + i], S[BLOCK * (PLANE + 1) + i]
        square = x * x + y * y
        gap = square - along * along
        rise = -S[BLOCK * UP + i] * math.sqrt(max(gap, 0.0))
        inverse = 1.0 / max(square, 1e-30)
        S[BLOCK * (COS + 1) + i] = (x * along + y * rise) * inverse
        S[BLOCK * (SIN + 1) + i] = (y * along - x * rise) * inverse
        S[BLOCK * (COS + 2) + i], S[BLOCK * (SIN + 2) + i] = c3, s3
        S[BLOCK * (VALUES + 2) + i] = -sa2 * rise - height
        exists, size = S[BLOCK * VALID + i], square + UNIT
        S[BLOCK * VALID + i] = exists if gap > 0.0 else 0.0
        dirty = -slack * size < gap < MERGED * size
        S[BLOCK * DIRTY + i] += exists if dirty else 0.0
    for j in range(3):
        rows = at(PLANE + 2 + j)
        for i in side_by_side(n):
            c, s = S[BLOCK * (COS + 1) + i], S[BLOCK * (SIN + 1) + i]
            x, y, z = column(S, rows + i, BLOCK * 3)
            S[rows + i], S[rows + BLOCK * 3 + i] = c * x + s * y, sa2 * z
            S[rows + BLOCK * 6 + i] = sa2 * (s * x - c * y)


def _wrists(form, n, S):
    """ZYZ angles of what is left of the rotation; the sine of joint 5 is positive."""
    ca3, sa3, sa4, sa5 = form[2, 1], form[2, 2], form[3, 2], form[4, 2]
    slides, rows = form[2, 5] != 0.0, at(PLANE + 2)
    for i in side_by_side(n):
        c2, s2 = S[BLOCK * (COS + 1) + i], S[BLOCK * (SIN + 1) + i]
        c3, s3 = S[BLOCK * (COS + 2) + i], S[BLOCK * (SIN + 2) + i]
        c2, s2 = (1.0, 0.0) if slides else (c2, s2)
        c, s = c2 * c3 - s2 * s3, s2 * c3 + c2 * s3
        x, y = column(S, rows + i, BLOCK), column(S, rows + BLOCK * 3 + i, BLOCK)
        z = column(S, rows + BLOCK * 6 + i, BLOCK)
        (x0, x1, x2), (y0, y1, y2), (z0, z1, z2) = turned_and_tilted(c, s, ca3, sa3, x, y, z)
        s5 = math.sqrt(x2 * x2 + y2 * y2)
        c5 = -z2 * sa4 * sa5
        inverse = sa5 / max(s5, 1e-30)
        c4, s4 = x2 * inverse, y2 * inverse
        c6 = c5 * (c4 * x0 + s4 * y0) + s5 * sa4 * z0
        s6 = -c5 * (c4 * x1 + s4 * y1) - s5 * sa4 * z1
        S[BLOCK * (COS + 3) + i], S[BLOCK * (SIN + 3) + i] = c4, s4
        S[BLOCK * (COS + 4) + i], S[BLOCK * (SIN + 4) + i] = c5, s5
        S[BLOCK * (COS + 5) + i], S[BLOCK * (SIN + 5) + i] = c6, s6
        exists = S[BLOCK * VALID + i]
        S[BLOCK * (VALID + 1) + i] = exists
        dirty = s5 < CLEAR and exists > 0.0
        S[BLOCK * DIRTY + i] += 1.0 if dirty else 0.0


def _where_singularities_meet(form, n, S):
    """Not clean are slides next to where joint 2 hardly turns the tool, beside an aligned wrist."""
    _, _, height = _resting(form)
    for i in side_by_side(n):
        rise = S[BLOCK * (VALUES + 2) + i] + height
        dirty = abs(rise) * S[BLOCK * (SIN + 4) + i] < MEETING
        S[BLOCK * DIRTY + i] += S[BLOCK * VALID + i] if dirty else 0.0


def _solve_block(arm, Ts, within_limits, first, n, outputs):
    """Poses Ts[first : first + n]; the count of one that is not clean is -1."""
    (_, joints), form, ends, slack = arm
    arms, S = ARMS * n, np.empty(ROWS * BLOCK)
    load_poses(ends, form[0, 3], Ts, first, n, S)
    sides(n, S)
    share(POSE, COS, n, S)
    _shoulders(form, slack, 2 * n, S)
    if form[2, 5] != 0.0:
        _slides(form, slack, arms, S)
    else:
        _elbows(form, slack, arms, S)
    _wrists(form, arms, S)
    if form[2, 5] != 0.0:
        _where_singularities_meet(form, arms, S)
    measure(form, ends[2], arms, S, 0, 0, 1, 2, 3, 4, 5)
    for i in side_by_side(arms):
        S[BLOCK * (RESIDUAL + 1) + i] = S[BLOCK * RESIDUAL + i]
    named = form[2, 5] == 0.0
    emit(form, joints, ANGLES, within_limits, IN_ORDER, named, first, n, S, outputs)


def _solve_rest(arm, Ts, within_limits, first, n, outputs):
    """Those of them that are not clean, one by one; how many are in doubt."""
    (q, residual, count, branch, free), doubts = outputs, 0
    slides = arm[1][2, 5] != 0.0
    for i in range(first, first + n):
        if count[i] < 0:
            out = q[i], residual[i], branch[i], free[i]
            scratch = make_scratch()
            count[i] = solve_pose(arm, Ts[i], within_limits, out, scratch)
            # beside a slide at zero joint 2 hardly turns the tool
            if count[i] < 0 and slides:
                doubts += 1
            else:
                count[i] = how_many(count[i])
    return doubts


@entry(n=6, solutions=8)
def solve_common_wrist(arm: ClosedForm, Ts: Poses, within_limits: bool, outputs: Outputs):
    """:func:`dh2urdf.kernels.spherical_wrist.poses.solve_wrist_arm` for the common geometry."""
    doubts = 0
    for first in range(0, Ts.shape[0], POSES):
        n = min(POSES, Ts.shape[0] - first)
        _solve_block(arm, Ts, within_limits, first, n, outputs)
        doubts += _solve_rest(arm, Ts, within_limits, first, n, outputs)
    return doubts
