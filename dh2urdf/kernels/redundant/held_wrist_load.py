"""What a block of poses starts from where seven joints have one held: targets, S1 and levers.

The kernel of :mod:`dh2urdf.kernels.redundant.held_wrist_blocks` takes the target of the oriented
arm, the link S1 and the point whose position error counts from the lanes, since they may all depend
on the held value. With E0, E7 the outer links of the oriented chain and V the held joint, the
target is

    base^-1 T' tool^-1,     base^-1 V^-1 E0^-1 T' tool^-1,     base^-1 T' E7^-1 V^-1 tool^-1

where a joint between the ends is held, the first one, the last one; ``T' = T``, or ``T^-1`` where
the arm is seen from the tool. S1 and the lever are sums of ``cos v``, ``sin v`` and of the slide,
with factors that belong to the arm.
"""

from dh2urdf.kernels.blocks import BLOCK, LANES, WORK, at, column, load_poses
from dh2urdf.kernels.numbers import few_turns, side_by_side, sincos
from dh2urdf.kernels.redundant.held_wrist import ENDS, FACTORS, ORIENTED, SIDES, SLIDES, VARIES
from dh2urdf.kernels.rigid import dot

UPPER, LEVER = WORK, WORK + 12
"""S1 (twelve, rotation first); the point whose position error counts (three)."""

HELD_COS, HELD_SIN, HELD_SLIDE = LEVER + 3, LEVER + 4, LEVER + 5
"""Cosine, sine and slide of the held joint."""

LOADED = LEVER + 6
"""First row that is free for what is worked out from these."""


def all_equal(values):
    """Whether all poses have the same held value."""
    for i in range(1, values.shape[0]):
        if values[i] != values[0]:
            return False
    return True


def prepare_block(frames, which, values, S):
    """Rows of S that all blocks have in common as long as the held value is that of the first."""
    slides, value = which[SLIDES] != 0, values[0]
    sine, cosine = sincos(few_turns(value))
    for i in side_by_side(LANES):
        S[BLOCK * HELD_COS + i] = 1.0 if slides else cosine
        S[BLOCK * HELD_SIN + i] = 0.0 if slides else sine
        S[BLOCK * HELD_SLIDE + i] = value if slides else 0.0
    _links_and_levers(frames, LANES, S)


def load_block(frames, which, values, Ts, same, seen_from_tool, first, n, S):
    """Target, S1 and lever of each pose, one a lane; ``same``: all have the first one's value."""
    if not same:
        _held_joint(which[SLIDES] != 0, values, first, n, S)
        _links_and_levers(frames, n, S)
    last = which[ORIENTED] == 6
    load_poses(frames[SIDES:], 0.0, Ts, first, n, S)
    if seen_from_tool != last:
        _invert(n, S)
    if which[VARIES] < 0:
        _turn(frames[ENDS + 2] if last else frames[ENDS], -1.0 if last else 1.0, n, S)
    if last:
        _invert(n, S)


def _held_joint(slides, values, first, n, S):
    """Cosine, sine and slide of the held joint of every lane."""
    if slides:
        for i in side_by_side(n):
            S[BLOCK * HELD_SLIDE + i] = values[first + i]
        return
    for i in range(n):
        S[BLOCK * HELD_COS + i] = few_turns(values[first + i])
    for i in side_by_side(n):
        S[BLOCK * HELD_SIN + i], S[BLOCK * HELD_COS + i] = sincos(S[BLOCK * HELD_COS + i])


def _links_and_levers(frames, n, S):
    """S1 and lever of every lane: ``a cos v + b sin v + d slide + t`` in each of their rows."""
    for k in range(15):
        factors, row = frames[FACTORS + k // 4, k % 4], at(UPPER + k)
        a, b, d, t = factors[0], factors[1], factors[2], factors[3]
        for i in side_by_side(n):
            turned = a * S[BLOCK * HELD_COS + i] + b * S[BLOCK * HELD_SIN + i]
            S[row + i] = turned + (d * S[BLOCK * HELD_SLIDE + i] + t)


def pose_axes(S, i):
    """Axes x, y, z of the pose of lane i."""
    x, y = column(S, i, BLOCK * 3), column(S, BLOCK + i, BLOCK * 3)
    return x, y, column(S, BLOCK * 2 + i, BLOCK * 3)


def _invert(n, S):
    """The pose of every lane turned into its inverse."""
    for i in side_by_side(n):
        x, y, z = pose_axes(S, i)
        p = column(S, BLOCK * 9 + i, BLOCK)
        S[BLOCK + i], S[BLOCK * 2 + i], S[BLOCK * 5 + i] = x[1], x[2], y[2]
        S[BLOCK * 3 + i], S[BLOCK * 6 + i], S[BLOCK * 7 + i] = y[0], z[0], z[1]
        S[BLOCK * 9 + i], S[BLOCK * 10 + i] = -dot(x, p), -dot(y, p)
        S[BLOCK * 11 + i] = -dot(z, p)


def _turn(G, way, n, S):
    """``G V^-1`` before the pose of every lane; ``G V`` where ``way`` is -1."""
    g00, g01, g02, g03 = G[0, 0], G[0, 1], G[0, 2], G[0, 3]
    g10, g11, g12, g13 = G[1, 0], G[1, 1], G[1, 2], G[1, 3]
    g20, g21, g22, g23 = G[2, 0], G[2, 1], G[2, 2], G[2, 3]
    for j in range(4):
        start, step = (BLOCK * 9, BLOCK) if j == 3 else (BLOCK * j, BLOCK * 3)
        moves = 1.0 if j == 3 else 0.0
        for i in side_by_side(n):
            c, s = S[BLOCK * HELD_COS + i], way * S[BLOCK * HELD_SIN + i]
            x, y, z = S[start + i], S[start + step + i], S[start + 2 * step + i]
            x, y, z = c * x + s * y, c * y - s * x, z - moves * way * S[BLOCK * HELD_SLIDE + i]
            S[start + i] = g00 * x + g01 * y + g02 * z + moves * g03
            S[start + step + i] = g10 * x + g11 * y + g12 * z + moves * g13
            S[start + 2 * step + i] = g20 * x + g21 * y + g22 * z + moves * g23
