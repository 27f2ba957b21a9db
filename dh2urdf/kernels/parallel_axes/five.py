"""Five turning joints, axes 2, 3, 4 parallel, vectorised: most small arms for learning.

The wrist centre, on axis 5, is as far along the common direction k of the three as the links say:
that is an equation for joint 1 alone, of two roots. Those at which axis 5 has its angle with k are
solutions; joint 5 follows by subproblem 1, the three by a planar arm (lecture notes 8.2).

Such an arm reaches few poses, and a given one may be off by what a residual may be. So a lane is
dirty from farther away of a rim than where six joints move, and where it fits, but not quite.
"""

import math
from typing import NamedTuple

import numpy as np

from dh2urdf.kernels.blocks import (
    ARMS,
    BLOCK,
    COS,
    DIRTY,
    LEFT,
    OWN,
    POSE,
    POSES,
    ROWS,
    SIN,
    VALID,
    at,
    column,
    emit,
    load_poses,
    measure,
    share,
    sides,
)
from dh2urdf.kernels.numbers import entry, side_by_side
from dh2urdf.kernels.parallel_axes.blocks import PLANE, elbows
from dh2urdf.kernels.rigid import dot
from dh2urdf.kernels.shapes import ClosedForm, Outputs, Poses
from dh2urdf.kernels.short_chains import ShortChain, solve_short_chains

IN_ORDER = np.arange(5)
ANGLES = np.array([(r, OWN, 4 if 0 < r < 4 else 2) for r in range(5)])

RIM = 1e-5
"""Relative distance from a rim, on either side, up to which a lane is dirty: there what a residual
may be, 1e-9, turns a joint by less than 1e-6 rad."""

MISFIT = 1e-8
"""Difference [rad] of the angle between axis 5 and k, and of the offset [m] that joint 1 would have
to take for it, above which a root is none: ten times what a residual may be."""


def _shoulders(form, n, S):
    """Joint 1 from the offset of the arm's plane, joint 5 from how axis 4 lies in the pose."""
    ca1, sa1, ca4, sa4 = form[0, 1], form[0, 2], form[3, 1], form[3, 2]
    reach = form[1, 0] + form[2, 0]
    constant, close = form[1, 3] + form[2, 3] + form[3, 3], RIM * reach * reach
    for i in side_by_side(2 * n):
        px, py, pz = S[BLOCK * 9 + i], S[BLOCK * 10 + i], S[BLOCK * 11 + i]
        a, b, d = -sa1 * py, sa1 * px, constant - ca1 * pz
        square = a * a + b * b
        gap = square - d * d
        root = math.sqrt(max(gap, 0.0))
        t = S[BLOCK * LEFT + i] * root
        inverse = 1.0 / max(square, 1e-30)
        c, s = (a * d - b * t) * inverse, (b * d + a * t) * inverse
        k = sa1 * s, -sa1 * c, ca1
        rx, ry = dot(k, column(S, i, BLOCK * 3)), dot(k, column(S, BLOCK + i, BLOCK * 3))
        rz = dot(k, column(S, BLOCK * 2 + i, BLOCK * 3))
        inverse = math.copysign(1.0, sa4) / math.sqrt(max(rx * rx + ry * ry, 1e-30))
        S[BLOCK * COS + i], S[BLOCK * SIN + i] = c, s
        S[BLOCK * (COS + 4) + i], S[BLOCK * (SIN + 4) + i] = ry * inverse, rx * inverse
        S[BLOCK * (COS + 5) + i], S[BLOCK * (SIN + 5) + i] = 1.0, 0.0
        fits = abs(rz - ca4) * root < MISFIT * (1.0 + root)
        S[BLOCK * VALID + i] = 1.0 if gap > 0.0 and fits else 0.0
        dirty = abs(gap) <= RIM * (square + d * d) or square <= close
        S[BLOCK * DIRTY + i] += 1.0 if dirty else 0.0


def _planes(form, n, S):
    """Where the planar arm has to reach and how it points, for both shoulders."""
    a1, ca1, sa1, a4, rows = form[0, 0], form[0, 1], form[0, 2], form[3, 0], at(PLANE)
    for i in side_by_side(n):
        c1, s1 = S[BLOCK * COS + i], S[BLOCK * SIN + i]
        along = S[BLOCK * (COS + 4) + i], -S[BLOCK * (SIN + 4) + i], 0.0
        h0 = dot(column(S, i, BLOCK), along)
        h1 = dot(column(S, BLOCK * 3 + i, BLOCK), along)
        h2 = dot(column(S, BLOCK * 6 + i, BLOCK), along)
        p0, p1 = S[BLOCK * 9 + i] - a4 * h0, S[BLOCK * 10 + i] - a4 * h1
        p2 = S[BLOCK * 11 + i] - a4 * h2
        S[rows + i] = c1 * p0 + s1 * p1 - a1
        S[rows + BLOCK + i] = ca1 * (c1 * p1 - s1 * p0) + sa1 * p2
        S[rows + BLOCK * 2 + i] = c1 * h0 + s1 * h1
        S[rows + BLOCK * 3 + i] = ca1 * (c1 * h1 - s1 * h0) + sa1 * h2


def _near_rims(form, n, S):
    """Mark where the elbow is nearly straight or folded, or axis 4 nearly on axis 2."""
    rows, reach = at(PLANE), form[1, 0] + form[2, 0]
    close = RIM * reach * reach
    for i in side_by_side(n):
        x, y, s3 = S[rows + i], S[rows + BLOCK + i], S[BLOCK * (SIN + 2) + i]
        near = x * x + y * y < close or s3 * s3 < RIM
        S[BLOCK * DIRTY + i] += S[BLOCK * VALID + i] if near else 0.0


def solve_five_parallel(arm: ClosedForm, Ts: Poses, within_limits: bool, outputs: Outputs):
    """Poses Ts (m, 4, 4) of five joints, axes 2, 3, 4 parallel, in lanes; count -1: in doubt.

    The last row of ``form`` is that of joint 5 alone. Returned is how many poses are in doubt.
    """
    (_, joints), form, ends, _ = arm
    m, S, doubts = Ts.shape[0], np.empty(ROWS * BLOCK), 0
    for first in range(0, m, POSES):
        n = min(POSES, m - first)
        arms = ARMS * n
        load_poses(ends, form[0, 3], Ts, first, n, S)
        sides(n, S)
        share(POSE, COS, n, S)
        _shoulders(form, n, S)
        _planes(form, 2 * n, S)
        share(POSE, COS + 1, 2 * n, S)
        share(COS + 4, COS + 6, 2 * n, S)
        share(SIN, SIN + 1, 2 * n, S)
        share(SIN + 4, SIN + 6, 2 * n, S)
        share(VALID, VALID + 1, 2 * n, S)
        share(PLANE, PLANE + 4, 2 * n, S)
        elbows(form, RIM, 0, arms, S)
        _near_rims(form, arms, S)
        measure(form, ends[2], arms, S, 0, 0, 1, 2, 3, 4, 5)
        doubts += n - emit(
            form, joints, ANGLES, within_limits, IN_ORDER, False, first, n, S, outputs
        )
    return doubts


class FiveJoints(NamedTuple):
    """What the lanes know of five joints, and what the closed loop knows."""

    lanes: ClosedForm
    loop: ShortChain


@entry(n=5, solutions=8)
def solve_five_joints(arm: FiveJoints, Ts: Poses, within_limits: bool, outputs: Outputs):
    """Poses Ts (m, 4, 4) in lanes, those in doubt by the loop; how many are still in doubt."""
    (lanes, loop), (q, residual, count, branch, free), doubts = arm, outputs, 0
    if solve_five_parallel(lanes, Ts, within_limits, outputs) == 0:
        return 0
    for i in range(Ts.shape[0]):
        if count[i] < 0:
            one = q[i : i + 1], residual[i : i + 1], count[i : i + 1]
            codes = branch[i : i + 1], free[i : i + 1]
            doubts += solve_short_chains(loop, Ts[i : i + 1], within_limits, (*one, *codes))
    return doubts
