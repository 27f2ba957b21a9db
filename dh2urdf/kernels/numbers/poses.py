"""Check of target poses, cheap enough for every call."""

from dh2urdf.kernels.numbers.engine import entry
from dh2urdf.kernels.numbers.shapes import Codes, Counts, Poses, Solutions, Values

ORTHONORMAL = 1e-6
"""Largest entry of ``R^T R - 1`` of a rotation typed with six digits."""

LAST_ROW = 1e-12
"""Largest deviation of the last row from 0 0 0 1."""

FINITE = 1e300
"""Bound of a coordinate [m]."""

BLOCK = 64
"""Poses that are looked at together."""


def _count_rigid(Ts, first, last):
    """How many of these poses are finite, right-handed and orthonormal within the tolerances.

    Straight code without a branch, for vector instructions; NaN fails every comparison.
    """
    count = 0
    for i in range(first, last):
        x0, x1, x2 = Ts[i, 0, 0], Ts[i, 1, 0], Ts[i, 2, 0]
        y0, y1, y2 = Ts[i, 0, 1], Ts[i, 1, 1], Ts[i, 2, 1]
        z0, z1, z2 = Ts[i, 0, 2], Ts[i, 1, 2], Ts[i, 2, 2]
        p0, p1, p2 = abs(Ts[i, 0, 3]), abs(Ts[i, 1, 3]), abs(Ts[i, 2, 3])
        r0, r1, r2, r3 = Ts[i, 3, 0], Ts[i, 3, 1], Ts[i, 3, 2], Ts[i, 3, 3] - 1.0
        xx, yy = abs(x0 * x0 + x1 * x1 + x2 * x2 - 1.0), abs(y0 * y0 + y1 * y1 + y2 * y2 - 1.0)
        zz, xy = abs(z0 * z0 + z1 * z1 + z2 * z2 - 1.0), abs(x0 * y0 + x1 * y1 + x2 * y2)
        xz, yz = abs(x0 * z0 + x1 * z1 + x2 * z2), abs(y0 * z0 + y1 * z1 + y2 * z2)
        determinant = (x1 * y2 - x2 * y1) * z0 + (x2 * y0 - x0 * y2) * z1 + (x0 * y1 - x1 * y0) * z2
        rigid = (xx <= ORTHONORMAL) & (yy <= ORTHONORMAL) & (zz <= ORTHONORMAL)
        rigid &= (xy <= ORTHONORMAL) & (xz <= ORTHONORMAL) & (yz <= ORTHONORMAL)
        rigid &= (determinant > 0.0) & (p0 < FINITE) & (p1 < FINITE) & (p2 < FINITE)
        rigid &= (abs(r0) <= LAST_ROW) & (abs(r1) <= LAST_ROW)
        rigid &= (abs(r2) <= LAST_ROW) & (abs(r3) <= LAST_ROW)
        count += 1 if rigid else 0
    return count


@entry
def first_bad_pose(Ts: Poses):
    """Index of the first of the poses Ts (m, 4, 4) that is not in SE(3), or -1."""
    m = Ts.shape[0]
    for first in range(0, m, BLOCK):
        last = min(first + BLOCK, m)
        if _count_rigid(Ts, first, last) == last - first:
            continue
        for i in range(first, last):
            if _count_rigid(Ts, i, i + 1) == 0:
                return i
    return -1


@entry
def pad_solutions(
    q: Solutions, residual: Values, count: Counts, branch: Codes, free: Codes, nothing: float
):
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
