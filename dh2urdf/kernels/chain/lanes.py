"""Forward kinematics of a block of configurations, side by side.

A block has up to ``BLOCK`` configurations, one a lane. The pose of a lane is twelve entries of one
flat array, entry e of lane i at ``S[BLOCK * e + i]``.
"""

import math

from dh2urdf.kernels.numbers import few_turns, side_by_side, sincos

BLOCK = 64
COS, SIN, ROWS = 12, 13, 14
"""Rows of S beyond the pose, and their number."""


def _start(link, n, S):
    """All lanes at a link's pose."""
    for r in range(3):
        for c in range(4):
            value = link[r, c]
            for i in side_by_side(n):
                S[BLOCK * (4 * r + c) + i] = value


def _turn_and_step(link, n, S):
    """``T Rot_z(q) link`` in all lanes."""
    a00, a01, a02, a03 = link[0, 0], link[0, 1], link[0, 2], link[0, 3]
    a10, a11, a12, a13 = link[1, 0], link[1, 1], link[1, 2], link[1, 3]
    a20, a21, a22, a23 = link[2, 0], link[2, 1], link[2, 2], link[2, 3]
    for i in side_by_side(n):
        c, s = S[BLOCK * COS + i], S[BLOCK * SIN + i]
        for r in range(3):
            u, v = S[BLOCK * 4 * r + i], S[BLOCK * (4 * r + 1) + i]
            z, p = S[BLOCK * (4 * r + 2) + i], S[BLOCK * (4 * r + 3) + i]
            x, y = u * c + v * s, v * c - u * s
            S[BLOCK * 4 * r + i] = x * a00 + y * a10 + z * a20
            S[BLOCK * (4 * r + 1) + i] = x * a01 + y * a11 + z * a21
            S[BLOCK * (4 * r + 2) + i] = x * a02 + y * a12 + z * a22
            S[BLOCK * (4 * r + 3) + i] = x * a03 + y * a13 + z * a23 + p


def _slide(n, S):
    """``T Trans_z(q)`` in all lanes, q where its cosine is to be: as of no turn."""
    for i in side_by_side(n):
        for r in range(3):
            S[BLOCK * (4 * r + 3) + i] += S[BLOCK * (4 * r + 2) + i] * S[BLOCK * COS + i]
        S[BLOCK * COS + i], S[BLOCK * SIN + i] = 1.0, 0.0


def lanes_fk(links, prismatic, q, first, n, T, S):
    """``T_base_tool`` of n configurations of q (m, joints) from the first on, to T (m, 4, 4).

    S is room for ROWS * BLOCK numbers. Returns whether all x of the tip are finite.
    """
    _start(links[0], n, S)
    for j in range(q.shape[1]):
        if prismatic[j]:
            for i in range(n):
                S[BLOCK * COS + i] = q[first + i, j]
            _slide(n, S)
        else:
            for i in range(n):
                S[BLOCK * COS + i] = few_turns(q[first + i, j])
            for i in side_by_side(n):
                S[BLOCK * SIN + i], S[BLOCK * COS + i] = sincos(S[BLOCK * COS + i])
        _turn_and_step(links[j + 1], n, S)
    finite = True
    for i in range(n):
        k = first + i
        for r in range(3):
            for c in range(4):
                T[k, r, c] = S[BLOCK * (4 * r + c) + i]
        T[k, 3, 0], T[k, 3, 1], T[k, 3, 2], T[k, 3, 3] = 0.0, 0.0, 0.0, 1.0
        finite &= math.isfinite(T[k, 0, 3])
    return finite
