"""The UR family, vectorised: axes 2, 3, 4 parallel, the last three square to one another.

The same mathematics as :mod:`dh2urdf.kernels.parallel_axes.poses`, for poses away from
singularities and rims; all others go to the scalar kernel. Solution ``k`` has shoulder ``k & 1``,
elbow ``k >> 1 & 1``, wrist ``k >> 2``.
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
    ROWS,
    SAME,
    SIN,
    TURN,
    UP,
    VALID,
    WORK,
    at,
    column,
    emit,
    load_poses,
    measure,
    planar_arm,
    share,
    sides,
)
from dh2urdf.kernels.counts import how_many
from dh2urdf.kernels.numbers import entry, side_by_side
from dh2urdf.kernels.parallel_axes.pairs import pairs_of_meeting
from dh2urdf.kernels.parallel_axes.poses import finish_pairs, make_scratch
from dh2urdf.kernels.rigid import dot
from dh2urdf.kernels.shapes import ClosedForm, Outputs, Poses
from dh2urdf.kernels.spherical_wrist import tool_to_wrist

IN_ORDER = np.arange(6)
ANGLES = np.array([(r, OWN, 4 if 0 < r % 6 < 4 else 2) for r in range(12)])
ANGLES[[6, 10, 11]] = (0, SAME, 4), (4, NEGATED, 4), (5, HALF_TURN, 4)
"""The other wrist has ``-q5`` and ``q6 + pi``."""

PLANE = WORK + 2
"""Where the planar arm has to reach, and its heading; four rows."""


def _shoulders(form, slack, n, S):
    """Joint 1 from the offset of the arm's plane, joint 5 from the slope of axis 6, both wrists."""
    ca1, sa1, sa4, sa5 = form[0, 1], form[0, 2], form[3, 2], form[4, 2]
    constant, side = form[1, 3] + form[2, 3] + form[3, 3], 1.0 if sa1 < 0.0 else -1.0
    for i in side_by_side(2 * n):
        px, py, pz = S[BLOCK * 9 + i], S[BLOCK * 10 + i], S[BLOCK * 11 + i]
        a, b, d = -sa1 * py, sa1 * px, constant - ca1 * pz
        square = a * a + b * b
        gap = square - d * d
        t = side * S[BLOCK * LEFT + i] * math.sqrt(max(gap, 0.0))
        inverse = 1.0 / max(square, 1e-30)
        c, s = (a * d - b * t) * inverse, (b * d + a * t) * inverse
        exists = 1.0 if gap > 0.0 else 0.0
        k = sa1 * s, -sa1 * c, ca1
        rx, ry = dot(k, column(S, i, BLOCK * 3)), dot(k, column(S, BLOCK + i, BLOCK * 3))
        rz = dot(k, column(S, BLOCK * 2 + i, BLOCK * 3))
        s5 = math.sqrt(rx * rx + ry * ry)
        c5 = -rz * sa4 * sa5
        inverse = sa4 / max(s5, 1e-30)
        c6, s6 = rx * inverse, -ry * inverse
        S[BLOCK * COS + i], S[BLOCK * SIN + i] = c, s
        S[BLOCK * (COS + 4) + i], S[BLOCK * (SIN + 4) + i] = c5, s5
        S[BLOCK * (COS + 5) + i], S[BLOCK * (SIN + 5) + i] = c6, s6
        S[BLOCK * (COS + 10) + i], S[BLOCK * (SIN + 10) + i] = c5, -s5
        S[BLOCK * (COS + 11) + i], S[BLOCK * (SIN + 11) + i] = -c6, -s6
        S[BLOCK * VALID + i], S[BLOCK * (VALID + 1) + i] = exists, exists
        size = square + d * d
        dirty = -slack * size < gap < MERGED * size or (s5 < CLEAR and exists > 0.0)
        S[BLOCK * DIRTY + i] += 1.0 if dirty else 0.0


def _planes(form, wrist, n, S):
    """Where the planar arm has to reach and how it points, for both shoulders."""
    a1, ca1, sa1 = form[0, 0], form[0, 1], form[0, 2]
    a4, sa5, d5 = form[3, 0], form[4, 2], form[4, 3]
    t5, t6, rows = at(COS + 4 + 6 * wrist), at(COS + 5 + 6 * wrist), at(PLANE)
    for i in side_by_side(n):
        c1, s1 = S[BLOCK * COS + i], S[BLOCK * SIN + i]
        c5, s5, c6, s6 = S[t5 + i], S[TURN + t5 + i], S[t6 + i], S[TURN + t6 + i]
        x, y, z = c5 * a4, sa5 * d5, sa5 * s5 * a4
        lever, slope = (c6 * x + s6 * y, c6 * y - s6 * x, z), (c6 * c5, -s6 * c5, sa5 * s5)
        r0, r1 = column(S, i, BLOCK), column(S, BLOCK * 3 + i, BLOCK)
        r2 = column(S, BLOCK * 6 + i, BLOCK)
        p0, h0 = S[BLOCK * 9 + i] - dot(r0, lever), dot(r0, slope)
        p1, h1 = S[BLOCK * 10 + i] - dot(r1, lever), dot(r1, slope)
        p2, h2 = S[BLOCK * 11 + i] - dot(r2, lever), dot(r2, slope)
        S[rows + i] = c1 * p0 + s1 * p1 - a1
        S[rows + BLOCK + i] = ca1 * (c1 * p1 - s1 * p0) + sa1 * p2
        S[rows + BLOCK * 2 + i] = c1 * h0 + s1 * h1
        S[rows + BLOCK * 3 + i] = ca1 * (c1 * h1 - s1 * h0) + sa1 * h2


def elbows(form, slack, wrist, n, S):
    """Joints 2, 3 and 4 of all four arms: planar RRR (lecture notes 8.2)."""
    upper, fore, side = form[1, 0], form[2, 0], -1.0 if form[0, 2] > 0.0 else 1.0
    rows, valid, cosine, sine = (
        at(PLANE),
        at(VALID + wrist),
        at(COS + 6 * wrist),
        at(SIN + 6 * wrist),
    )
    for i in side_by_side(n):
        x, y = S[rows + i], S[rows + BLOCK + i]
        hx, hy = S[rows + BLOCK * 2 + i], S[rows + BLOCK * 3 + i]
        bend = side * S[BLOCK * LEFT + i] * S[BLOCK * UP + i]
        c2, s2, c3, s3, reached, dirty = planar_arm(upper, fore, bend, x, y, slack)
        c, s = c2 * c3 - s2 * s3, s2 * c3 + c2 * s3
        S[cosine + BLOCK + i], S[sine + BLOCK + i] = c2, s2
        S[cosine + BLOCK * 2 + i], S[sine + BLOCK * 2 + i] = c3, s3
        S[cosine + BLOCK * 3 + i] = hx * c + hy * s
        S[sine + BLOCK * 3 + i] = hy * c - hx * s
        exists = S[valid + i]
        S[BLOCK * DIRTY + i] += exists if dirty else 0.0
        S[valid + i] = exists if reached else 0.0


def _solve_block(arm, Ts, within_limits, first, n, outputs):
    """Poses Ts[first : first + n]; the count of one that is not clean is -1."""
    (_, joints), form, ends, slack = arm
    arms, S = ARMS * n, np.empty(ROWS * BLOCK)
    load_poses(ends, form[0, 3], Ts, first, n, S)
    sides(n, S)
    share(POSE, COS, n, S)
    _shoulders(form, slack, n, S)
    share(POSE, COS + 1, 2 * n, S)
    share(SIN, SIN + 1, 2 * n, S)
    for wrist in range(2):
        share(COS + 6 * wrist + 4, COS + 6 * wrist + 6, 2 * n, S)
        share(SIN + 6 * wrist + 4, SIN + 6 * wrist + 6, 2 * n, S)
    share(VALID, VALID + 2, 2 * n, S)
    for wrist in range(2):
        _planes(form, wrist, arms, S)
        elbows(form, slack, wrist, arms, S)
        r = 6 * wrist
        measure(form, ends[2], arms, S, wrist, 0, r + 1, r + 2, r + 3, r + 4, r + 5)
    emit(form, joints, ANGLES, within_limits, IN_ORDER, True, first, n, S, outputs)


def _solve_rest(arm, Ts, within_limits, first, n, outputs):
    """Those of them that are not clean, one by one."""
    (_, form, ends, slack), (q, residual, count, branch, free) = arm, outputs
    for i in range(first, first + n):
        if count[i] < 0:
            scratch = make_scratch()
            tool_to_wrist(ends, Ts[i], scratch[0])
            pairs = pairs_of_meeting(form, scratch[0], slack, scratch[1])
            out = q[i], residual[i], branch[i], free[i]
            count[i] = how_many(finish_pairs(arm, 1, pairs, Ts[i], within_limits, out, scratch))


@entry(n=6, solutions=8)
def solve_common_parallel(arm: ClosedForm, Ts: Poses, within_limits: bool, outputs: Outputs):
    """:func:`dh2urdf.kernels.parallel_axes.poses.solve_three_parallel` for the common geometry."""
    for first in range(0, Ts.shape[0], POSES):
        n = min(POSES, Ts.shape[0] - first)
        _solve_block(arm, Ts, within_limits, first, n, outputs)
        _solve_rest(arm, Ts, within_limits, first, n, outputs)
    return 0
