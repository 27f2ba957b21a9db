"""Solutions beside solutions: where two singularities nearly meet, several lie close together.

Seeds from a nominal arm, and roots of a polynomial, lead to some of them only. From one of them
the others lie along the direction in which the pose hardly changes.
"""

import math

import numpy as np

from dh2urdf.kernels.certificate import is_known, null_direction, principal
from dh2urdf.kernels.newton import (
    MAX_TURN,
    POLISH,
    POSE,
    error_and_jacobian,
    make_damped,
    normal_equations,
    pose_residual,
    work_array,
)
from dh2urdf.kernels.numbers import entry
from dh2urdf.kernels.shapes import Chain, Counts, Poses, Solutions

SINGULAR = 1e-11
"""Smallest eigenvalue of J^T J, relative to the trace, below which others are looked for."""

WAYS = (-1e-3, 1e-3, -1e-2, 1e-2, -0.1, 0.1, -0.3, 0.3)
"""How far along that direction Newton's method starts [rad], either way."""

STEPS = 15
"""Newton steps; where they have not converged, there is nothing."""


def _solve(A, step):
    """Solve six equations, the rows of A (6, 7), by elimination with pivots; the longest entry.

    Not by the normal equations, which lose directions in which the pose changes by 1e-9 or less.
    """
    for c in range(6):
        best = c
        for r in range(c + 1, 6):
            best = r if abs(A[r, c]) > abs(A[best, c]) else best
        for k in range(c, 7):
            A[c, k], A[best, k] = A[best, k], A[c, k]
        if A[c, c] == 0.0:
            return math.inf
        for r in range(6):
            factor = A[r, c] / A[c, c] if r != c else 0.0
            A[r] -= factor * A[c]
    longest = 0.0
    for c in range(6):
        step[c] = A[c, 6] / A[c, c]
        longest = max(longest, abs(step[c]))
    return longest


def _converges(chain, T, q, A, step, damped):
    """Newton's method from q (6,) in place, downhill or not; whether it ends at a solution."""
    for _ in range(STEPS):
        error_and_jacobian(chain, (POSE, T, 1.0), q, damped)
        for r in range(6):
            A[r, 6] = damped[1][r, 6]
            for j in range(6):
                A[r, j] = damped[0][j, r]
        longest = _solve(A, step)
        if not longest < math.inf:
            return False
        scale = min(1.0, MAX_TURN / max(longest, MAX_TURN))
        q += step * scale
    for j in range(6):
        q[j] = principal(q[j])
    return pose_residual(chain, T, q) <= POLISH


@entry(n=6)
def search_beside(chain: Chain, Ts: Poses, q: Solutions, count: Counts):
    """Append to q (m, kmax, 6) what lies beside nearly singular solutions of poses Ts (m, 4, 4)."""
    _, joints = chain
    start, trial, work = np.empty(6), np.empty(6), work_array(6)
    A, step, damped = np.empty((6, 7)), np.empty(6), make_damped(6)
    for i in range(Ts.shape[0]):
        for k in range(count[i]):
            normal_equations(chain, Ts[i], q[i, k], work)
            if null_direction(work) > SINGULAR:
                continue
            for j in range(6):
                start[j] = work[j, 6]
            for w in range(len(WAYS)):
                trial[:] = q[i, k] + WAYS[w] * start
                if not _converges(chain, Ts[i], trial, A, step, damped):
                    continue
                if count[i] < q.shape[1] and not is_known(joints, q[i], count[i], trial):
                    q[i, count[i]] = trial
                    count[i] += 1
