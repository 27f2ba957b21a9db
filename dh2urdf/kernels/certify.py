"""Certification: candidates of one pose become solutions, each with the residual of the chain.

Every solver ends here. A candidate is kept when the exact chain reaches the pose within
``ACCEPT``; Newton's method repairs what rounding, noise or an approximate root left over.

A chain is given as ``links`` (n + 1, 4, 4) and ``joints`` (n, 3), one row a joint: 1.0 where it
slides and 0.0 where it turns, lower bound, upper bound (infinite where there is none).
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from dh2urdf.kernels.chain import _joint_times_link, _load
from dh2urdf.kernels.compiled import helper_kernel, inner_kernel

__all__ = ["ACCEPT", "ANYWHERE", "CLUSTER", "NO_JOINT", "ROUNDING", "copy_rows", "finish_pose"]
__all__ += ["move", "new_work", "polish", "pose_residual", "principal", "residual_of", "same"]

ACCEPT = 1e-9
"""Largest residual of a solution [m and rad]."""

POLISH = 1e-13
"""Residual [m and rad] below which a candidate is left as it is; some 100 roundings."""

ROUNDING = 1e-15
"""Residual [m and rad] that is the pose's own rounding, for an arm of about a metre."""

NO_JOINT = 0
"""The mask of no joint."""

CLUSTER = 1e-6
"""Joint distance [rad or m] at which two solutions are one."""

HOPELESS = 0.3
"""Residual [m and rad] of a candidate that Newton is not asked to repair."""

PLAIN_STEPS = 12
"""Plain Newton steps; a sound candidate needs two or three, one where singularities meet goes
uphill first and then halves its way back."""

DAMPED_FAILURES = 4
"""Damped steps that may fail to halve the residual before a candidate is given up."""

TINY_DAMPING = 1e-18
"""Damping that only keeps rounding from dividing by zero."""

MAX_TURN = 0.3
"""Longest Newton step of one joint [rad or m]."""

VALLEY = 1e3
"""The same in square roots of the residual: where two branches meet, a root is off by about one,
and what is asked for beyond is noise along a direction in which the pose hardly changes."""

ANYWHERE = np.bool_(False)
"""No limits: as the literal False, `finish_pose` would be compiled once more for its type."""

TWO_PI = 2.0 * math.pi


def new_work(n: int) -> NDArray[np.float64]:
    """Scratch of :func:`finish_pose` for n joints: one array for a whole batch."""
    return np.empty((n, n + 8))


@helper_kernel
def residual_of(r, T):
    """Residual of a pose r (twelve scalars) against a target T (4, 4).

    The larger of the position error [m] and the angle between the orientations [rad],
    ``|sum_i r_i x t_i| / 2 = sin(angle)`` over the columns of the rotations; pi where the angle is
    over 90 degrees. Stretching T (six-digit input) does not enter to first order.
    """
    x, y, z = T[0, 3] - r[3], T[1, 3] - r[7], T[2, 3] - r[11]
    ex, ey, ez, cosine = _turn_between(r, T)
    if cosine <= 1.0:
        return math.pi
    return math.sqrt(max(x * x + y * y + z * z, ex * ex + ey * ey + ez * ez))


@helper_kernel
def _turn_between(r, T):
    """Rotation vector (sine long) from r to T in base axes, and ``trace(r^T T)``."""
    ex = r[4] * T[2, 0] - r[8] * T[1, 0] + r[5] * T[2, 1] - r[9] * T[1, 1]
    ey = r[8] * T[0, 0] - r[0] * T[2, 0] + r[9] * T[0, 1] - r[1] * T[2, 1]
    ez = r[0] * T[1, 0] - r[4] * T[0, 0] + r[1] * T[1, 1] - r[5] * T[0, 1]
    ex += r[6] * T[2, 2] - r[10] * T[1, 2]
    ey += r[10] * T[0, 2] - r[2] * T[2, 2]
    ez += r[2] * T[1, 2] - r[6] * T[0, 2]
    trace = r[0] * T[0, 0] + r[4] * T[1, 0] + r[8] * T[2, 0]
    trace += r[1] * T[0, 1] + r[5] * T[1, 1] + r[9] * T[2, 1]
    trace += r[2] * T[0, 2] + r[6] * T[1, 2] + r[10] * T[2, 2]
    return 0.5 * ex, 0.5 * ey, 0.5 * ez, trace


@inner_kernel
def pose_residual(links, joints, T, q):
    """Residual of one configuration q (n,) on the exact chain against T (4, 4)."""
    r = _load(links[0])
    for i in range(q.shape[0]):
        r = _joint_times_link(r, joints[i, 0] != 0.0, q[i], links[i + 1])
    return residual_of(r, T)


@inner_kernel
def _normal_equations(links, joints, T, q, work):
    """``J^T J`` and ``J^T e`` at q, the error e = (position, rotation vector) to T.

    J is the geometric Jacobian at the tip in base axes (Spong, eqs. 4.57 to 4.60). Written to
    ``work[:, 8:]`` (lower triangle) and ``work[:, 6]``.
    """
    n = q.shape[0]
    r = _load(links[0])
    for i in range(n):
        work[i, 0], work[i, 1], work[i, 2] = r[3], r[7], r[11]
        work[i, 3], work[i, 4], work[i, 5] = r[2], r[6], r[10]
        r = _joint_times_link(r, joints[i, 0] != 0.0, q[i], links[i + 1])
    ex, ey, ez, _ = _turn_between(r, T)
    px, py, pz = T[0, 3] - r[3], T[1, 3] - r[7], T[2, 3] - r[11]
    for i in range(n):
        zx, zy, zz = work[i, 3], work[i, 4], work[i, 5]
        if joints[i, 0] != 0.0:
            work[i, 0], work[i, 1], work[i, 2] = zx, zy, zz
            work[i, 3], work[i, 4], work[i, 5] = 0.0, 0.0, 0.0
        else:
            x, y, z = r[3] - work[i, 0], r[7] - work[i, 1], r[11] - work[i, 2]
            work[i, 0] = zy * z - zz * y
            work[i, 1] = zz * x - zx * z
            work[i, 2] = zx * y - zy * x
        work[i, 6] = (
            work[i, 0] * px
            + work[i, 1] * py
            + work[i, 2] * pz
            + work[i, 3] * ex
            + work[i, 4] * ey
            + work[i, 5] * ez
        )
        for j in range(i + 1):
            total = 0.0
            for k in range(6):
                total += work[i, k] * work[j, k]
            work[i, 8 + j] = total


@inner_kernel
def _damped_step(work, damping):
    """Solve ``(J^T J + damping) dq = J^T e`` by Cholesky, dq in ``work[:, 7]``; longest entry.

    Factors in place over the Jacobian and the triangle, so the equations are built anew for
    every step. Pivots that rounding made non-positive are raised to the damping.
    """
    n = work.shape[0]
    for i in range(n):
        total = work[i, 6]
        for j in range(i):
            part = work[i, 8 + j]
            for k in range(j):
                part -= work[i, 8 + k] * work[j, 8 + k]
            part /= work[j, 8 + j]
            work[i, 8 + j] = part
            total -= part * work[j, 7]
        pivot = work[i, 8 + i] + damping
        for k in range(i):
            pivot -= work[i, 8 + k] * work[i, 8 + k]
        pivot = math.sqrt(max(pivot, damping))
        work[i, 8 + i] = pivot
        work[i, 7] = total / pivot
    longest = 0.0
    for i in range(n - 1, -1, -1):
        total = work[i, 7]
        for k in range(i + 1, n):
            total -= work[k, 8 + i] * work[k, 7]
        total /= work[i, 8 + i]
        work[i, 7] = total
        longest = max(longest, abs(total))
    return longest


@inner_kernel
def polish(links, joints, T, q, work):
    """Newton's method on the exact chain, q (n,) in place; returns the residual.

    First plain steps, which near a singularity may go uphill once before they converge; where
    they do not, Levenberg's damped steps from the best point, each of which must go downhill.
    """
    n = q.shape[0]
    residual = pose_residual(links, joints, T, q)
    if residual <= POLISH or not residual <= HOPELESS:
        return residual
    best, kept = residual, np.empty(n)
    for i in range(n):
        kept[i] = q[i]
    for _ in range(PLAIN_STEPS):
        _normal_equations(links, joints, T, q, work)
        _move_along(q, work, _damped_step(work, TINY_DAMPING), residual)
        residual = pose_residual(links, joints, T, q)
        if residual < best:
            best = residual
            for i in range(n):
                kept[i] = q[i]
        if residual <= POLISH or not residual <= HOPELESS:
            break
    damping, failures = 1e-3 * best, 0
    for i in range(n):
        q[i] = kept[i]
    while best > POLISH and failures < DAMPED_FAILURES and damping > TINY_DAMPING:
        _normal_equations(links, joints, T, q, work)
        _move_along(q, work, _damped_step(work, damping), best)
        residual = pose_residual(links, joints, T, q)
        damping = 0.01 * damping if residual < 0.5 * best else 100.0 * damping
        failures += 1 if residual > 0.5 * best else 0
        if residual < best:
            best = residual
            for i in range(n):
                kept[i] = q[i]
        else:
            for i in range(n):
                q[i] = kept[i]
    return best


@inner_kernel
def _move_along(q, work, longest, residual):
    """Add the step in ``work[:, 7]`` to q, shortened to ``MAX_TURN`` and ``VALLEY``."""
    most = min(MAX_TURN, VALLEY * math.sqrt(residual))
    scale = min(1.0, most / longest) if longest > 0.0 else 0.0
    for i in range(q.shape[0]):
        q[i] += scale * work[i, 7]


@helper_kernel
def principal(angle):
    """Bring an angle into [-pi, pi]."""
    if -math.pi <= angle <= math.pi:
        return angle + 0.0
    return angle - TWO_PI * math.floor(angle / TWO_PI + 0.5)


@inner_kernel
def same(joints, q, p, reach, free):
    """Whether two configurations with principal angles differ by at most ``reach`` a joint.

    The joints in the mask ``free`` may differ by any amount.
    """
    for i in range(q.shape[0]):
        gap = abs(q[i] - p[i])
        if (free >> i) & 1:
            continue
        if gap > reach and (joints[i, 0] != 0.0 or gap < TWO_PI - reach):
            return False
    return True


@inner_kernel
def _into_limits(links, joints, T, within_limits, q, residual, free):
    """Turn q (n,) by 2 pi nearest to the middle of its limits; the residual, or -1.0 if outside.

    A joint that overshoots its bound by less than ``CLUSTER`` is put on the bound if the pose is
    still reached there: at a double root (straight elbow, bound 0) rounding takes the root over.
    Nothing is put on a bound where the limits do not count. A free joint may be outside: another
    member of its family may not.
    """
    inside, moved = True, False
    for i in range(q.shape[0]):
        lower, upper = joints[i, 1], joints[i, 2]
        bounded = lower > -math.inf and upper < math.inf
        if joints[i, 0] == 0.0:
            if bounded:
                q[i] -= TWO_PI * math.floor((q[i] - 0.5 * (lower + upper)) / TWO_PI + 0.5)
            elif lower > -math.inf:
                q[i] += TWO_PI * math.ceil((lower - CLUSTER - q[i]) / TWO_PI)
            elif upper < math.inf:
                q[i] -= TWO_PI * math.ceil((q[i] - upper - CLUSTER) / TWO_PI)
        if (q[i] < lower or q[i] > upper) and not (free >> i) & 1:
            if q[i] < lower - CLUSTER or q[i] > upper + CLUSTER:
                inside = False
            else:
                moved = True
    if not inside:
        return -1.0
    if not moved or not within_limits:
        return residual
    for i in range(q.shape[0]):
        if not (free >> i) & 1:
            q[i] = min(max(q[i], joints[i, 1]), joints[i, 2])
    residual = pose_residual(links, joints, T, q)
    return residual if residual <= ACCEPT else -1.0


@inner_kernel
def move(q, residual, branch, free, source, target):
    """Copy one row of the candidates over another."""
    for i in range(q.shape[1]):
        q[target, i] = q[source, i]
    residual[target], branch[target], free[target] = residual[source], branch[source], free[source]


@inner_kernel
def copy_rows(source, count, target):
    """Copy the first rows (q, residual, branch, free) that fit; returns how many."""
    count = min(count, target[0].shape[0])
    for k in range(count):
        for i in range(source[0].shape[1]):
            target[0][k, i] = source[0][k, i]
        target[1][k], target[2][k], target[3][k] = source[1][k], source[2][k], source[3][k]
    return count


@inner_kernel
def finish_pose(links, joints, T, within_limits, q, residual, branch, free, count, work):
    """Certify the candidates of one pose in place; returns how many solutions are left.

    Parameters
    ----------
    links : array, shape (n + 1, 4, 4)
    joints : array, shape (n, 3)
        Sliding, lower, upper.
    T : array, shape (4, 4)
        Target ``T_base_tool``.
    within_limits : bool
        Drop what no full turn brings into the limits; a free joint may be outside, for another
        member of its family may not.
    q : array, shape (kmax, n)
        Candidates in the first ``count`` rows, any turn.
    residual : array, shape (kmax,)
        Residuals that the caller measured on the exact chain, or negative: not yet.
    branch, free : int64 array, shape (kmax,)
        Branch code and mask of free joints; moved along with their candidate.
    count : int
    work : array
        From :func:`new_work`.

    Notes
    -----
    Two solutions are one if no joint differs by more than ``CLUSTER`` or the square root of
    their residual: on the rim of the workspace two branches meet as a square root. The one with
    the smaller residual stays, or the first if it reaches the pose to rounding.
    """
    n = q.shape[1]
    kept = np.int64(0)
    for k in range(count):
        if residual[k] < 0.0 or residual[k] > POLISH:
            residual[k] = polish(links, joints, T, q[k], work)
        if not residual[k] <= ACCEPT:
            continue
        for i in range(n):
            q[kept, i] = q[k, i] if joints[i, 0] != 0.0 else principal(q[k, i])
        residual[kept], branch[kept], free[kept] = residual[k], branch[k], free[k]
        twin = -1
        for j in range(kept):
            reach = max(CLUSTER, math.sqrt(max(residual[j], residual[kept])))
            if same(joints, q[j], q[kept], reach, NO_JOINT):
                twin = j
                break
        if twin < 0:
            kept += 1
        elif residual[kept] < residual[twin] and residual[twin] > ROUNDING:
            move(q, residual, branch, free, kept, twin)
    solutions = np.int64(0)
    for k in range(kept):
        certified = _into_limits(links, joints, T, within_limits, q[k], residual[k], free[k])
        if certified < 0.0 and within_limits:
            continue
        if certified >= 0.0:
            residual[k] = certified
        move(q, residual, branch, free, k, solutions)
        solutions += 1
    return solutions
