"""Check of target poses, cheap enough for every call."""

import math

from dh2urdf.engine import entry
from dh2urdf.kernels.shapes import Codes, Counts, Outputs, Pose, Poses

ORTHONORMAL = 1e-6
"""Largest entry of ``R^T R - 1`` of a rotation typed with six digits."""

LAST_ROW = 1e-12
"""Largest deviation of the last row from 0 0 0 1."""

BLOCK = 64
"""Poses that are looked at together."""


def _rigid(T):
    """Whether a pose (4, 4) is finite, right-handed and orthonormal within the tolerances.

    Straight code without a branch, for vector instructions; NaN fails every comparison.
    """
    x0, x1, x2 = T[0, 0], T[1, 0], T[2, 0]
    y0, y1, y2 = T[0, 1], T[1, 1], T[2, 1]
    z0, z1, z2 = T[0, 2], T[1, 2], T[2, 2]
    p0, p1, p2 = abs(T[0, 3]), abs(T[1, 3]), abs(T[2, 3])
    r0, r1, r2, r3 = T[3, 0], T[3, 1], T[3, 2], T[3, 3] - 1.0
    xx, yy = abs(x0 * x0 + x1 * x1 + x2 * x2 - 1.0), abs(y0 * y0 + y1 * y1 + y2 * y2 - 1.0)
    zz, xy = abs(z0 * z0 + z1 * z1 + z2 * z2 - 1.0), abs(x0 * y0 + x1 * y1 + x2 * y2)
    xz, yz = abs(x0 * z0 + x1 * z1 + x2 * z2), abs(y0 * z0 + y1 * z1 + y2 * z2)
    determinant = (x1 * y2 - x2 * y1) * z0 + (x2 * y0 - x0 * y2) * z1 + (x0 * y1 - x1 * y0) * z2
    rigid = (xx <= ORTHONORMAL) & (yy <= ORTHONORMAL) & (zz <= ORTHONORMAL)
    rigid &= (xy <= ORTHONORMAL) & (xz <= ORTHONORMAL) & (yz <= ORTHONORMAL)
    rigid &= (determinant > 0.0) & (p0 < math.inf) & (p1 < math.inf) & (p2 < math.inf)
    rigid &= (abs(r0) <= LAST_ROW) & (abs(r1) <= LAST_ROW)
    return rigid & (abs(r2) <= LAST_ROW) & (abs(r3) <= LAST_ROW)


def _count_rigid(Ts, first, last):
    """How many of these poses are rigid."""
    count = 0
    for i in range(first, last):
        count += 1 if _rigid(Ts[i]) else 0
    return count


@entry()
def is_pose(T: Pose):
    """Whether T (4, 4) is in SE(3)."""
    return _rigid(T)


@entry()
def any_family(counts: Counts, free: Codes):
    """Whether a solution of the poses has free joints."""
    for i in range(counts.shape[0]):
        for k in range(counts[i]):
            if free[i, k]:
                return True
    return False


@entry()
def first_bad_pose(Ts: Poses):
    """Index of the first of the poses Ts (m, 4, 4) that is not in SE(3), or -1."""
    m = Ts.shape[0]
    for first in range(0, m, BLOCK):
        last = min(first + BLOCK, m)
        if _count_rigid(Ts, first, last) == last - first:
            continue
        for i in range(first, last):
            if not _rigid(Ts[i]):
                return i
    return -1


@entry()
def pad_solutions(outputs: Outputs, nothing: float):
    """Write ``nothing`` (NaN), branch -1 and no free joints after the last solution of a pose.

    Returns whether any solution has free joints.
    """
    q, residual, count, branch, free = outputs
    singular = False
    for i in range(q.shape[0]):
        for k in range(count[i]):
            singular = singular or free[i, k] != 0
        for k in range(count[i], q.shape[1]):
            residual[i, k], branch[i, k], free[i, k] = nothing, -1, 0
            q[i, k] = nothing
    return singular
