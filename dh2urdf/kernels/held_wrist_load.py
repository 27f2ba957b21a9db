"""What a block of poses starts from where seven joints have one held: targets, S1 and levers.

The kernel of :mod:`dh2urdf.kernels.held_wrist_blocks` takes the target of the oriented arm, the
link S1 and the point whose position error counts from the lanes, since they may all depend on the
held value.
"""

from __future__ import annotations

import math

from dh2urdf.kernels.blocks import BLOCK, DIRTY, MASK, WORK, load_poses
from dh2urdf.kernels.chain import _joint_times_link, _load, _store, _times_link
from dh2urdf.kernels.compiled import block_kernel, inner_kernel
from dh2urdf.kernels.held_joint import held_pose
from dh2urdf.kernels.held_wrist import (
    AFTER,
    BEFORE,
    ENDS,
    LINK,
    ORIENTED,
    ORIENTED_LINKS,
    REVERSED,
    SLIDES,
    VARIES,
    oriented_pose,
)
from dh2urdf.kernels.reverse import invert_pose

__all__ = ["LEVER", "UPPER", "load_block"]

UPPER, LEVER = WORK, WORK + 12
"""S1 (twelve, rotation first); the point whose position error counts (three)."""


@inner_kernel
def _lever(frames, which, value, out):
    """Point in frame 6, or in frame 0 of a reversed arm, where the user's tool origin is."""
    slides, k, reversed_ = which[SLIDES] != 0, which[ORIENTED], which[REVERSED] != 0
    x, y, z = 0.0, 0.0, 0.0
    if reversed_ and k == 0:
        end = frames[ORIENTED_LINKS]
        c, s, slide = (1.0, 0.0, value) if slides else (math.cos(value), math.sin(value), 0.0)
        tx, ty, tz = end[0, 3], end[1, 3], end[2, 3]
        x = -(end[0, 0] * tx + end[1, 0] * ty + end[2, 0] * tz)
        y = -(end[0, 1] * tx + end[1, 1] * ty + end[2, 1] * tz)
        z = -(end[0, 2] * tx + end[1, 2] * ty + end[2, 2] * tz) - slide
        x, y = c * x + s * y, c * y - s * x
    elif not reversed_ and k == 6:
        end = frames[ORIENTED_LINKS + 7]
        c, s, slide = (1.0, 0.0, value) if slides else (math.cos(value), math.sin(value), 0.0)
        x, y = c * end[0, 3] - s * end[1, 3], s * end[0, 3] + c * end[1, 3]
        z = end[2, 3] + slide
    E = frames[ENDS] if reversed_ else frames[ENDS + 2]
    for i in range(3):
        out[i] = E[i, 0] * x + E[i, 1] * y + E[i, 2] * z + E[i, 3]


@inner_kernel
def load_block(frames, which, values, Ts, first, n, scratch, lever, S):
    """Target, S1 and lever of each pose, one a lane."""
    same = True
    for i in range(first + 1, first + n):
        same = same and values[i] == values[first]
    if same:
        _load_equal(frames, which, values[first], Ts, first, n, scratch, lever, S)
    else:
        _load_unequal(frames, which, values, Ts, first, n, scratch, lever, S)


@inner_kernel
def _load_equal(frames, which, value, Ts, first, n, scratch, lever, S):
    """All lanes have one held value: ``D = L T R`` with constants that are found once.

    L and R are the inverses of base and tool with an end that moves with the held joint; seen
    from the tool, ``D = L T^-1 R = (R^-1 T L^-1)^-1``.
    """
    identity, end, ends = scratch[0][0], scratch[0][1], scratch[11]
    slides, k, base, tool = which[SLIDES] != 0, which[ORIENTED], frames[ENDS], frames[ENDS + 1]
    for r in range(4):
        for j in range(4):
            identity[r, j] = 1.0 if r == j else 0.0
            end[r, j] = identity[r, j]
    if k == 0 or k == 6:
        held_pose(frames[ORIENTED_LINKS : ORIENTED_LINKS + 8], slides, k, value, identity, end)
    _store(_times_link(_load(base), end) if k == 0 else _load(base), ends[0])
    _store(_times_link(_load(end), tool) if k == 6 else _load(tool), ends[1])
    if which[REVERSED] != 0:
        invert_pose(ends[1], end)
        invert_pose(ends[0], ends[1])
        _store(_load(end), ends[0])
    link = frames[LINK + 1]
    if which[VARIES] == 1:
        _store(_joint_times_link(_load(frames[BEFORE]), slides, value, frames[AFTER]), end)
        link = end
    _lever(frames, which, value, lever)
    load_poses(ends, 0.0, Ts, first, n, S)
    if which[REVERSED] != 0:
        _invert_lanes(n, S)
    for r in range(3):
        for j in range(3):
            _fill_row(UPPER + 3 * r + j, link[r, j], n, S)
        _fill_row(UPPER + 9 + r, link[r, 3], n, S)
        _fill_row(LEVER + r, lever[r], n, S)


@block_kernel
def _fill_row(row, value, n, S):
    """One value for every lane of a row."""
    start = BLOCK * row & MASK
    for i in range(n):
        S[start + i] = value


@block_kernel
def _invert_lanes(n, S):
    """The pose of every lane turned into its inverse."""
    for i in range(n):
        x0, x1, x2 = S[i], S[BLOCK * 3 + i], S[BLOCK * 6 + i]
        y0, y1, y2 = S[BLOCK + i], S[BLOCK * 4 + i], S[BLOCK * 7 + i]
        z0, z1, z2 = S[BLOCK * 2 + i], S[BLOCK * 5 + i], S[BLOCK * 8 + i]
        p0, p1, p2 = S[BLOCK * 9 + i], S[BLOCK * 10 + i], S[BLOCK * 11 + i]
        S[BLOCK + i], S[BLOCK * 2 + i], S[BLOCK * 5 + i] = x1, x2, y2
        S[BLOCK * 3 + i], S[BLOCK * 6 + i], S[BLOCK * 7 + i] = y0, z0, z1
        S[BLOCK * 9 + i] = -(x0 * p0 + x1 * p1 + x2 * p2)
        S[BLOCK * 10 + i] = -(y0 * p0 + y1 * p1 + y2 * p2)
        S[BLOCK * 11 + i] = -(z0 * p0 + z1 * p1 + z2 * p2)


@inner_kernel
def _load_unequal(frames, which, values, Ts, first, n, scratch, lever, S):
    """Each lane has its own held value: pose by pose."""
    D, link = scratch[1], scratch[2][1]
    for i in range(n):
        oriented_pose(frames, which, values[first + i], Ts[first + i], scratch)
        _lever(frames, which, values[first + i], lever)
        for r in range(3):
            for j in range(3):
                S[BLOCK * (3 * r + j) + i] = D[r, j]
                S[BLOCK * (UPPER + 3 * r + j) + i] = link[r, j]
            S[BLOCK * (9 + r) + i] = D[r, 3]
            S[BLOCK * (UPPER + 9 + r) + i] = link[r, 3]
            S[BLOCK * (LEVER + r) + i] = lever[r]
        S[BLOCK * DIRTY + i] = 0.0
