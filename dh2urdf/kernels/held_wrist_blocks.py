"""Seven joints, one held, vectorised: axes 1 and 2 meet, the wrist is orthogonal.

The same mathematics as :mod:`dh2urdf.kernels.held_wrist` where axes 1 and 2 of the oriented arm
meet: :mod:`~dh2urdf.kernels.held_wrist_arms` finds joints 3, 1 and 2 one after the other,
:mod:`~dh2urdf.kernels.held_wrist_wrists` the rest. Poses near singularities and rims go to the
scalar kernel. Solution ``k`` has joint 1 ``k & 1``, joint 3 ``k >> 1 & 1``, wrist ``k >> 2``.
"""

from __future__ import annotations

import numpy as np

from dh2urdf.kernels.block_values import MIRRORS, settle
from dh2urdf.kernels.blocks import (
    BLOCK,
    DIRTY,
    MASK,
    RESIDUAL,
    ROWS,
    VALID,
    VALUES,
)
from dh2urdf.kernels.compiled import block_kernel, inner_kernel, kernel
from dh2urdf.kernels.held_wrist import HELD, LINK, REVERSED, make_scratch, solve_held_pose
from dh2urdf.kernels.held_wrist_arms import place_elbows, place_shoulders
from dh2urdf.kernels.held_wrist_load import all_equal, load_block, prepare_block
from dh2urdf.kernels.held_wrist_wrists import finish_arm

__all__ = ["solve_held_blocks"]

JOINT_OF = np.array([2] * 2 + [0] * 4 + [1] * 4 + ([3] * 4 + [4] * 4 + [5] * 4) * 2)
ROW_OF = np.array(
    [
        [
            2 + (k & 3),
            6 + (k & 3),
            k >> 1 & 1,
            *(10 + (k & 3) + 4 * j + 12 * (k >> 2) for j in range(3)),
        ]
        for k in range(8)
    ]
)


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
    """Write the solutions of all clean lanes in the chain's order; returns how many are clean.

    The others get a count of -1. A solution that does not exist is written over by the next one.
    """
    clean = 0
    p0, p1, p2, p3, p4, p5 = place[0], place[1], place[2], place[3], place[4], place[5]
    for i in range(n):
        found, row = 0, first + i
        for k in range(8):
            q[row, found, p0] = S[(BLOCK * (VALUES + ROW_OF[k, 0]) & MASK) + i]
            q[row, found, p1] = S[(BLOCK * (VALUES + ROW_OF[k, 1]) & MASK) + i]
            q[row, found, p2] = S[(BLOCK * (VALUES + ROW_OF[k, 2]) & MASK) + i]
            q[row, found, p3] = S[(BLOCK * (VALUES + ROW_OF[k, 3]) & MASK) + i]
            q[row, found, p4] = S[(BLOCK * (VALUES + ROW_OF[k, 4]) & MASK) + i]
            q[row, found, p5] = S[(BLOCK * (VALUES + ROW_OF[k, 5]) & MASK) + i]
            q[row, found, held] = values[row]
            residual[row, found] = S[BLOCK * (RESIDUAL + k) + i]
            branch[row, k], free[row, k] = -1, 0
            found += 1 if S[BLOCK * (VALID + k) + i] > 0.0 else 0
        rough = S[BLOCK * DIRTY + i] != 0.0
        count[row] = -1 if rough else found
        clean += 0 if rough else 1
    return clean


@inner_kernel
def _solve_careful(frames, which, form, joints, slack, values, Ts, within_limits, first, n, out):
    """Solve those poses of a block that are not clean one by one."""
    q, residual, count, branch, free = out
    scratch = make_scratch()
    for i in range(first, first + n):
        if count[i] >= 0:
            continue
        count[i] = solve_held_pose(
            frames,
            which,
            form,
            joints,
            slack,
            values[i],
            Ts[i],
            within_limits,
            q[i],
            residual[i],
            branch[i],
            free[i],
            scratch,
        )


@kernel
def solve_held_blocks(
    frames, which, form, joints, slack, values, Ts, within_limits, q, residual, count, branch, free
):
    """:func:`dh2urdf.kernels.held_wrist.solve_held_wrist` for axes 1 and 2 that meet."""
    S, m = np.empty(ROWS * BLOCK), Ts.shape[0]
    if m == 0:
        return
    same, seen_from_tool = all_equal(values), which[REVERSED] != 0
    oriented_joints = joints[::-1].copy() if seen_from_tool else joints.copy()
    S0, S2, place = frames[LINK], frames[LINK + 2], _places(which)
    prepare_block(frames, which, values, S)
    for first in range(0, m, BLOCK):
        n = min(BLOCK, m - first)
        load_block(frames, which, values, Ts, same, first, n, S)
        place_elbows(S2, form[3, 3], slack, n, S)
        place_shoulders(S0, slack, n, S)
        for arm in range(4):
            finish_arm(form, S0, seen_from_tool, arm, n, S)
        settle(form, oriented_joints, (JOINT_OF, ROW_OF, MIRRORS), within_limits, n, S)
        out = q, residual, count, branch, free
        if _write(which[HELD], place, values, first, n, S, *out) < n:
            _solve_careful(
                frames, which, form, joints, slack, values, Ts, within_limits, first, n, out
            )
