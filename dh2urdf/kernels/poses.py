"""Check of target poses, cheap enough for every call."""

from __future__ import annotations

from numba import njit

__all__ = ["first_bad_pose", "pad_solutions"]

ORTHONORMAL = 1e-6
"""Largest entry of ``R^T R - 1`` of a rotation typed with six digits."""

LAST_ROW = 1e-12
"""Largest deviation of the last row from 0 0 0 1."""


@njit(cache=True, nogil=True)
def _rigid(T):
    """Whether T (4, 4) is finite, right-handed and orthonormal within the tolerances.

    Every comparison is written so that NaN fails it.
    """
    for j in range(3):
        for k in range(j + 1):
            gram = T[0, j] * T[0, k] + T[1, j] * T[1, k] + T[2, j] * T[2, k]
            if not abs(gram - (1.0 if j == k else 0.0)) <= ORTHONORMAL:
                return False
        if not (abs(T[j, 3]) < 1e300 and abs(T[3, j]) <= LAST_ROW):
            return False
    cx = T[1, 0] * T[2, 1] - T[2, 0] * T[1, 1]
    cy = T[2, 0] * T[0, 1] - T[0, 0] * T[2, 1]
    cz = T[0, 0] * T[1, 1] - T[1, 0] * T[0, 1]
    determinant = cx * T[0, 2] + cy * T[1, 2] + cz * T[2, 2]
    return determinant > 0.0 and abs(T[3, 3] - 1.0) <= LAST_ROW


@njit(cache=True, nogil=True)
def first_bad_pose(Ts):
    """Index of the first of the poses Ts (m, 4, 4) that is not in SE(3), or -1."""
    for i in range(Ts.shape[0]):
        if not _rigid(Ts[i]):
            return i
    return -1


@njit(cache=True, nogil=True)
def pad_solutions(q, residual, count, branch, free, nothing):
    """Write ``nothing`` (NaN), branch -1 and no free joints after the last solution of a pose.

    Returns whether any solution has free joints.
    """
    singular = False
    for i in range(q.shape[0]):
        for k in range(count[i]):
            singular = singular or free[i, k] != 0
        for k in range(count[i], q.shape[1]):
            residual[i, k], branch[i, k], free[i, k] = nothing, -1, 0
            for j in range(q.shape[2]):
                q[i, k, j] = nothing
    return singular
