"""Seven joints, one held, vectorised: axes 1 and 2 meet, the wrist is orthogonal.

The same mathematics as :mod:`dh2urdf.kernels.redundant.held_wrist` where axes 1 and 2 of the
oriented arm meet, step by step in :mod:`~dh2urdf.kernels.redundant.held_wrist_arms`. Poses near
singularities and rims go to the scalar kernel. Solution ``k`` has joint 1 ``k & 1``, joint 3
``k >> 1 & 1``, wrist ``k >> 2``.
"""

import numpy as np

from dh2urdf.kernels.numbers import inner_kernel, kernel
from dh2urdf.kernels.redundant.held_wrist import HELD, LINK, REVERSED, solve_rough
from dh2urdf.kernels.redundant.held_wrist_arms import finish_arm, place_elbows, place_shoulders
from dh2urdf.kernels.redundant.held_wrist_load import load_block
from dh2urdf.kernels.spherical_wrist import BLOCK, MIRRORS, ROWS, emit

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


@kernel
def solve_held_blocks(
    frames, which, form, joints, slack, values, Ts, within_limits, q, residual, count, branch, free
):
    """:func:`dh2urdf.kernels.redundant.held_wrist.solve_held_wrist` for axes 1 and 2 that meet."""
    S, m = np.empty(ROWS * BLOCK), Ts.shape[0]
    constants, out = (frames, which, form, joints, slack), (q, residual, count, branch, free)
    seen_from_tool, place, table = which[REVERSED] != 0, _places(which), (JOINT_OF, ROW_OF, MIRRORS)
    oriented = joints[::-1].copy() if seen_from_tool else joints.copy()
    S0, S2 = frames[LINK], frames[LINK + 2]
    for first in range(0, m, BLOCK):
        n = min(BLOCK, m - first)
        load_block(frames, which, values, Ts, first, n, S)
        place_elbows(S2, form[3, 3], slack, n, S)
        place_shoulders(S0, slack, n, S)
        for arm in range(4):
            finish_arm(form, S0, seen_from_tool, arm, n, S)
        clean = emit(form, oriented, table, within_limits, place, False, first, n, S, out)
        for i in range(first, first + n):
            q[i, :, which[HELD]] = values[i]
        if clean < n:
            solve_rough(constants, values, Ts, within_limits, first, first + n, out)
