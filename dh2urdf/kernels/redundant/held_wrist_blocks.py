"""Seven joints, one held, vectorised: axes 1 and 2 meet, the wrist is orthogonal.

The same mathematics as :mod:`dh2urdf.kernels.redundant.held_wrist` where axes 1 and 2 of the
oriented arm meet, step by step in :mod:`~dh2urdf.kernels.redundant.held_wrist_arms`. Poses near
singularities and rims go to the scalar kernel. Solution ``k`` has joint 1 ``k & 1``, joint 3
``k >> 1 & 1``, wrist ``k >> 2``.
"""

from typing import Annotated, NamedTuple

import numpy as np

from dh2urdf.kernels.blocks import BLOCK, MIRRORS, ROWS, emit
from dh2urdf.kernels.numbers import entry
from dh2urdf.kernels.redundant.held_wrist import HELD, LINK, REVERSED, Held, HeldForm, solve_rough
from dh2urdf.kernels.redundant.held_wrist_arms import finish_arm, place_elbows, place_shoulders
from dh2urdf.kernels.redundant.held_wrist_load import all_equal, load_block, prepare_block
from dh2urdf.kernels.shapes import Floats, Integers, Outputs, Poses

JOINT_OF = np.array([2] * 2 + [0] * 4 + [1] * 4 + ([3] * 4 + [4] * 4 + [5] * 4) * 2)
K, ARM, OTHER = np.arange(8), np.arange(8) & 3, 12 * (np.arange(8) >> 2)
ROW_OF = np.stack([2 + ARM, 6 + ARM, K >> 1 & 1, *(10 + 4 * j + ARM + OTHER for j in range(3))], 1)


@entry(n=7, solutions=8)
def solve_held_blocks(
    arm: HeldForm, values: Held, Ts: Poses, within_limits: bool, outputs: Outputs
):
    """:func:`dh2urdf.kernels.redundant.held_wrist.solve_held_wrist` for axes 1 and 2 that meet."""
    frames, which, form, joints, slack = arm
    q, S, m = outputs[0], np.empty(ROWS * BLOCK), Ts.shape[0]
    if m == 0:
        return
    same, seen_from_tool = all_equal(values), which[REVERSED] != 0
    table = JOINT_OF, ROW_OF, MIRRORS
    oriented, place = np.empty((6, 3)), np.empty(6, np.int64)
    for j in range(6):
        moving = 5 - j if seen_from_tool else j
        place[j] = moving if moving < which[HELD] else moving + 1
        oriented[j] = joints[moving]
    S0, S2 = frames[LINK], frames[LINK + 2]
    prepare_block(frames, which, values, S)
    for first in range(0, m, BLOCK):
        n = min(BLOCK, m - first)
        load_block(frames, which, values, Ts, same, first, n, S)
        place_elbows(S2, form[3, 3], slack, n, S)
        place_shoulders(S0, slack, n, S)
        for k in range(4):
            finish_arm(form, S0, seen_from_tool, k, n, S)
        clean = emit(form, oriented, table, within_limits, place, False, first, n, S, outputs)
        for i in range(first, first + n):
            for k in range(8):
                q[i, k, which[HELD]] = values[i]
        if clean < n:
            solve_rough(arm, values, Ts, within_limits, first, first + n, outputs)


class Samples(NamedTuple):
    """Outputs of a solver for every sample of some poses."""

    q: Annotated[Floats, "samples_in", "some", "n"]
    residual: Annotated[Floats, "samples_in", "some"]
    counts: Annotated[Integers, "samples_in"]
    branch: Annotated[Integers, "samples_in", "some"]
    free: Annotated[Integers, "samples_in", "some"]


@entry()
def gather_samples(found: Samples, first: int, last: int, samples: int, outputs: Outputs):
    """Join the solutions of the samples of a pose, rows in the order of the values.

    ``found`` are the five arrays of a solver for (last - first) samples poses; the others are
    the caller's, with room for all, see :class:`dh2urdf.ik.arm.solver.Solver`.
    """
    q, residual, count, branch, free = outputs
    some_q, some_residual, some_count, some_branch, some_free = found
    for i in range(first, last):
        total = 0
        for k in range(samples):
            row = (i - first) * samples + k
            for r in range(some_count[row]):
                for j in range(q.shape[2]):
                    q[i, total, j] = some_q[row, r, j]
                residual[i, total] = some_residual[row, r]
                branch[i, total], free[i, total] = some_branch[row, r], some_free[row, r]
                total += 1
        count[i] = total
