"""How good solutions are: manipulability, smallest singular value, distance from the limits.

Solutions are worked on in blocks, one a lane. The task's Jacobian is brought to an upper bidiagonal
matrix B by reflections from both sides (Golub and Kahan, "Calculating the singular values and
pseudo-inverse of a matrix", 1965), so that the product of its diagonal is that of the singular
values; the smallest eigenvalue of ``B^T B`` is the limit of Laguerre's steps from zero, which never
pass it.
"""

import math
from typing import Annotated, TypeAlias

import numpy as np

from dh2urdf.kernels.chain import BLOCK, COS, ROWS, move_lanes, start_lanes
from dh2urdf.kernels.numbers import entry, few_turns, side_by_side
from dh2urdf.kernels.shapes import Chain, Counts, Floats, Solutions

POSITION, POSITION_AXIS = 1, 2
"""Numbers of tasks other than the pose, as of `newton.damped`."""

TINY = 1e-300
"""Keeps the reflection of a vector of zeros from 0 / 0, and a step from a place beyond the root."""

FLOOR = 1e-60
"""Least pivot of ``B^T B`` [m^2]: that of a singular value of 1e-30."""

STEPS = 24
"""Laguerre's steps at most; five are usual."""

SETTLED = 1e-5
"""Part of the eigenvalue below which a step is the last: the next would be its cube."""

X, GOING, PIVOT, FIRST, SECOND, SUM, SQUARES, SCRATCH = range(8)
"""Rows of W; the first four serve the reflections, too."""

MARGIN = ROWS
"""Row of S in which the distance from the limits is; the joints' axes and points come after it."""

Best: TypeAlias = Annotated[Floats, 3, "poses"]


@entry()
def best_measures(chain: Chain, task: int, q: Solutions, count: Counts, best: Best):
    """Of each pose, the largest of three measures over its solutions, to best (3, m).

    Those are the product of the singular values of the task's Jacobian, the smallest of them, and
    the smallest distance of a joint from its limits; -inf where there is no solution.
    """
    links, joints = chain
    n, lanes = joints.shape[0], 0
    wide = 3 if task == POSITION else 5 if task == POSITION_AXIS else 6
    rows, columns = max(n, wide), min(n, wide)
    S, W = np.empty((ROWS + 1 + 6 * n) * BLOCK), np.empty(SCRATCH * BLOCK)
    M = np.empty((n + 7) * 6 * BLOCK)
    pose, solution = np.empty(BLOCK, np.int64), np.empty(BLOCK, np.int64)
    for i in range(q.shape[0]):
        best[0, i], best[1, i], best[2, i] = -math.inf, -math.inf, -math.inf
        for k in range(count[i]):
            pose[lanes], solution[lanes] = i, k
            lanes += 1
            if lanes == BLOCK:
                _axes(links, joints, q, pose, solution, lanes, S)
                _jacobian(joints, wide, rows == n, lanes, S, M)
                _best(rows, columns, pose, lanes, S, M, W, best)
                lanes = 0
    if lanes > 0:
        _axes(links, joints, q, pose, solution, lanes, S)
        _jacobian(joints, wide, rows == n, lanes, S, M)
        _best(rows, columns, pose, lanes, S, M, W, best)


def _axes(links, joints, q, pose, solution, n, S):
    """Each joint's axis and a point of it, from row MARGIN + 1 on, and the distance from limits."""
    start_lanes(links[0], n, S)
    for i in side_by_side(n):
        S[BLOCK * MARGIN + i] = math.inf
    for j in range(joints.shape[0]):
        to, slides = BLOCK * (MARGIN + 1 + 6 * j), joints[j, 0] != 0.0
        for r in range(3):
            for i in side_by_side(n):
                S[to + BLOCK * r + i] = S[BLOCK * (4 * r + 2) + i]
                S[to + BLOCK * (3 + r) + i] = S[BLOCK * (4 * r + 3) + i]
        lower, upper = joints[j, 1], joints[j, 2]
        for i in range(n):
            value = q[pose[i], solution[i], j]
            room = min(value - lower, upper - value)
            S[BLOCK * MARGIN + i] = min(S[BLOCK * MARGIN + i], room)
            S[BLOCK * COS + i] = value if slides else few_turns(value)
        move_lanes(slides, links[j + 1], n, S)


def _jacobian(joints, wide, upright, n, S, M):
    """Rows of the task's Jacobian to M, joint by joint, or their columns where it is upright.

    ``(z x (p_tip - p), z)`` of a joint that turns, ``(z, 0)`` of one that slides; of the turning
    part the two components across the tool's z where ``wide`` is 5.
    """
    count = joints.shape[0]
    across, along = (1, wide) if upright else (count, 1)
    for j in range(count):
        at = BLOCK * (MARGIN + 1 + 6 * j)
        slides, to, step = joints[j, 0] != 0.0, BLOCK * along * j, BLOCK * across
        for i in side_by_side(n):
            zx, zy, zz = S[at + i], S[at + BLOCK + i], S[at + BLOCK * 2 + i]
            x = S[BLOCK * 3 + i] - S[at + BLOCK * 3 + i]
            y = S[BLOCK * 7 + i] - S[at + BLOCK * 4 + i]
            z = S[BLOCK * 11 + i] - S[at + BLOCK * 5 + i]
            M[to + i] = zx if slides else zy * z - zz * y
            M[to + step + i] = zy if slides else zz * x - zx * z
            M[to + step * 2 + i] = zz if slides else zx * y - zy * x
        turn = 0.0 if slides else 1.0
        if wide == 6:
            for r in range(3):
                for i in side_by_side(n):
                    M[to + step * (3 + r) + i] = turn * S[at + BLOCK * r + i]
        elif wide == 5:
            for r in range(2):
                for i in side_by_side(n):
                    zx, zy, zz = S[at + i], S[at + BLOCK + i], S[at + BLOCK * 2 + i]
                    part = zx * S[BLOCK * r + i] + zy * S[BLOCK * (4 + r) + i]
                    part += zz * S[BLOCK * (8 + r) + i]
                    M[to + step * (3 + r) + i] = turn * part


def _best(rows, columns, pose, n, S, M, W, best):
    """Take the measures of n lanes into the best ones of their poses."""
    for k in range(columns):
        if k < rows - 1:
            _reflect(columns * k + k, columns, rows - k, 1, columns - k, n, M, W)
        if k < columns - 2:
            _reflect(columns * k + k + 1, 1, columns - k - 1, columns, rows - k, n, M, W)
    _smallest_eigenvalue(columns, n, M, W)
    for i in range(n):
        product = 1.0
        for k in range(columns):
            product *= abs(M[BLOCK * (columns * k + k) + i])
        p = pose[i]
        best[0, p] = max(best[0, p], product)
        best[1, p] = max(best[1, p], math.sqrt(W[BLOCK * X + i]))
        best[2, p] = max(best[2, p], S[BLOCK * MARGIN + i])


def _reflect(start, along, length, across, vectors, n, M, W):
    """Reflect the first of some vectors onto its first entry, and the others with it.

    ``H = 1 + beta v v^T``; entry t of vector u is at ``start + along t + across u`` of M.
    """
    first = BLOCK * start
    for i in side_by_side(n):
        W[i] = 0.0
    for t in range(length):
        a = first + BLOCK * along * t
        for i in side_by_side(n):
            W[i] += M[a + i] * M[a + i]
    for i in side_by_side(n):
        square, head = W[i], M[first + i]
        value = -math.copysign(math.sqrt(square), head)
        W[BLOCK + i] = value
        W[BLOCK * 2 + i] = -1.0 / (square - value * head + TINY)
        M[first + i] = head - value
    for u in range(1, vectors):
        for i in side_by_side(n):
            W[BLOCK * 3 + i] = 0.0
        for t in range(length):
            a, b = first + BLOCK * along * t, first + BLOCK * (along * t + across * u)
            for i in side_by_side(n):
                W[BLOCK * 3 + i] += M[a + i] * M[b + i]
        for i in side_by_side(n):
            W[BLOCK * 3 + i] *= W[BLOCK * 2 + i]
        for t in range(length):
            a, b = first + BLOCK * along * t, first + BLOCK * (along * t + across * u)
            for i in side_by_side(n):
                M[b + i] += W[BLOCK * 3 + i] * M[a + i]
    for i in side_by_side(n):
        M[first + i] = W[BLOCK + i]


def _smallest_eigenvalue(m, n, M, W):
    """Of ``B^T B`` in all lanes, B of m columns with its two diagonals in M, to row X of W.

    Pivots of ``B^T B - x`` are ``s_k + d_k^2`` with ``s_1 = -x``, ``s_{k+1} = e_k^2 s_k / (s_k +
    d_k^2) - x`` (Fernando and Parlett, "Accurate singular values and differential qd algorithms",
    1994); of the logarithm of their product the first two derivatives by x make a step.
    """
    for i in side_by_side(n):
        W[BLOCK * X + i], W[BLOCK * GOING + i] = 0.0, 1.0
    for _ in range(STEPS):
        for i in side_by_side(n):
            W[BLOCK * PIVOT + i], W[BLOCK * FIRST + i] = -W[BLOCK * X + i], -1.0
            W[BLOCK * SECOND + i], W[BLOCK * SUM + i], W[BLOCK * SQUARES + i] = 0.0, 0.0, 0.0
        for k in range(m):
            d, e = BLOCK * (m * k + k), BLOCK * (m * k + min(k + 1, m - 1))
            for i in side_by_side(n):
                s, ds, dds = W[BLOCK * PIVOT + i], W[BLOCK * FIRST + i], W[BLOCK * SECOND + i]
                square, beside = M[d + i] * M[d + i], M[e + i] * M[e + i]
                pivot = s + square
                r = 1.0 / (pivot if abs(pivot) > FLOOR else FLOOR)
                u = ds * r
                W[BLOCK * SUM + i] -= u
                W[BLOCK * SQUARES + i] += u * u - dds * r
                W[BLOCK * PIVOT + i] = beside * (s * r) - W[BLOCK * X + i]
                slope = beside * (square * r) * r
                W[BLOCK * FIRST + i] = slope * ds - 1.0
                W[BLOCK * SECOND + i] = slope * (dds - 2.0 * ds * u)
        for i in side_by_side(n):
            total, x = W[BLOCK * SUM + i], W[BLOCK * X + i]
            spread = (m - 1.0) * (m * W[BLOCK * SQUARES + i] - total * total)
            step = m / (max(total, TINY) + math.sqrt(max(spread, 0.0)))
            below = total > 0.0 and W[BLOCK * GOING + i] > 0.0
            ahead = step if below else 0.0
            W[BLOCK * X + i] = x + ahead
            W[BLOCK * GOING + i] = 1.0 if ahead > SETTLED * x else 0.0
        going = False
        for i in range(n):
            going = going or W[BLOCK * GOING + i] > 0.0
        if not going:
            break
