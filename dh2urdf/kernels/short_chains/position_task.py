"""Certification where only the position of the tool counts: the task ``position``.

The counterpart of :mod:`dh2urdf.kernels.certificate.certify` with three equations instead of six;
the same thresholds and the same scratch.
"""

from __future__ import annotations

import math

import numpy as np

from dh2urdf.kernels.certificate import (
    ACCEPT,
    CLUSTER,
    HOPELESS,
    MAX_TURN,
    MOVES,
    NEAR,
    POLISH,
    SINGULAR,
    TWO_PI,
    WALK,
    damped_step,
    move,
    null_direction,
)
from dh2urdf.kernels.chain import joint_times_link, load_pose
from dh2urdf.kernels.numbers import inner_kernel

__all__ = ["finish_position", "position_residual"]

MAX_STEPS = 12
"""Newton steps before a candidate is given up; a sound one needs two or three."""


@inner_kernel
def position_residual(links, joints, T, q):
    """Distance [m] of the tool at q (n,) from the origin of T (4, 4)."""
    r = load_pose(links[0])
    for i in range(q.shape[0]):
        r = joint_times_link(r, joints[i, 0] != 0.0, q[i], links[i + 1])
    x, y, z = T[0, 3] - r[3], T[1, 3] - r[7], T[2, 3] - r[11]
    return math.sqrt(x * x + y * y + z * z)


@inner_kernel
def normal_equations(links, joints, T, q, work):
    """``J^T J`` to ``work[:, 8:]`` (lower triangle), ``J^T e`` to ``work[:, 6]``, three rows."""
    n = q.shape[0]
    r = load_pose(links[0])
    for i in range(n):
        work[i, 0], work[i, 1], work[i, 2] = r[3], r[7], r[11]
        work[i, 3], work[i, 4], work[i, 5] = r[2], r[6], r[10]
        r = joint_times_link(r, joints[i, 0] != 0.0, q[i], links[i + 1])
    ex, ey, ez = T[0, 3] - r[3], T[1, 3] - r[7], T[2, 3] - r[11]
    for i in range(n):
        zx, zy, zz = work[i, 3], work[i, 4], work[i, 5]
        if joints[i, 0] == 0.0:
            x, y, z = r[3] - work[i, 0], r[7] - work[i, 1], r[11] - work[i, 2]
            zx, zy, zz = zy * z - zz * y, zz * x - zx * z, zx * y - zy * x
        work[i, 0], work[i, 1], work[i, 2] = zx, zy, zz
        work[i, 6] = zx * ex + zy * ey + zz * ez
        for j in range(i + 1):
            work[i, 8 + j] = zx * work[j, 0] + zy * work[j, 1] + zz * work[j, 2]


@inner_kernel
def _polish(links, joints, T, q, work):
    """Newton's method, damped where it does not help; q (n,) in place, returns the residual."""
    residual = position_residual(links, joints, T, q)
    if residual > HOPELESS:
        return residual
    damping, failures = 1e-18, 0
    for _ in range(MAX_STEPS):
        if residual <= POLISH or failures > 3:
            break
        normal_equations(links, joints, T, q, work)
        longest = damped_step(work, damping)
        step = min(1.0, MAX_TURN / longest) if longest > 0.0 else 0.0
        for i in range(q.shape[0]):
            q[i] += step * work[i, 7]
        after = position_residual(links, joints, T, q)
        if after < 0.5 * residual:
            damping *= 0.01
        else:
            failures += 1
            damping = max(100.0 * damping, 1e-3 * residual)
        if after < residual:
            residual = after
        else:
            for i in range(q.shape[0]):
                q[i] -= step * work[i, 7]
    return residual


@inner_kernel
def _free_joints(links, joints, T, q, trial, work):
    """Bits of the joints that move along a family, see :mod:`.certificate.families`."""
    normal_equations(links, joints, T, q, work)
    mask = np.int64(0)
    if null_direction(work) > SINGULAR:
        return mask
    for i in range(q.shape[0]):
        trial[i] = q[i] + WALK * work[i, 6]
    if not _polish(links, joints, T, trial, work) <= ACCEPT:
        return mask
    away = 0.0
    for i in range(q.shape[0]):
        gap = abs(trial[i] - q[i])
        away += gap * gap
        if gap > MOVES:
            mask |= np.int64(1) << np.int64(i)
    return mask if away > 0.25 * WALK * WALK else np.int64(0)


@inner_kernel
def _one(links, joints, T, q, p, accuracy, middle):
    """Whether two solutions are one, see :mod:`dh2urdf.kernels.certificate.merging`."""
    largest = 0.0
    for i in range(q.shape[0]):
        gap = p[i] - q[i]
        if joints[i, 0] == 0.0:
            gap -= TWO_PI * math.floor(gap / TWO_PI + 0.5)
        largest = max(largest, abs(gap))
        middle[i] = q[i] + 0.5 * gap
    if largest > NEAR:
        return False
    return largest <= CLUSTER or position_residual(links, joints, T, middle) <= accuracy


@inner_kernel
def _into_limits(links, joints, T, q):
    """Turn q (n,) into its limits, overshoot of rounding onto the bound; whether that succeeds."""
    for i in range(q.shape[0]):
        lower, upper = joints[i, 1], joints[i, 2]
        if joints[i, 0] == 0.0:
            middle = 0.0
            if lower > -math.inf and upper < math.inf:
                middle = 0.5 * (lower + upper)
            elif lower > -math.inf:
                middle = lower + math.pi - CLUSTER
            elif upper < math.inf:
                middle = upper - math.pi + CLUSTER
            q[i] -= TWO_PI * math.floor((q[i] - middle) / TWO_PI + 0.5)
    for i in range(q.shape[0]):
        lower, upper = joints[i, 1], joints[i, 2]
        if q[i] < lower or q[i] > upper:
            if q[i] < lower - CLUSTER or q[i] > upper + CLUSTER:
                return False
            before = q[i]
            q[i] = min(max(q[i], lower), upper)
            if position_residual(links, joints, T, q) > ACCEPT:
                q[i] = before
                return False
    return True


@inner_kernel
def finish_position(links, joints, T, within_limits, q, residual, branch, free, count, trial, work):
    """Certify the candidates of one position in place; returns how many solutions are left.

    Parameters
    ----------
    links, joints, T, within_limits, q, residual, branch, free, count, work
        See :func:`dh2urdf.kernels.certificate.certify.finish_pose`; free masks are found here.
    trial : array, shape (n,), scratch
    """
    kept = np.int64(0)
    for k in range(count):
        residual[k] = _polish(links, joints, T, q[k], work)
        if not residual[k] <= ACCEPT:
            continue
        branch[k], free[k] = branch[k], 0
        twin = -1
        for j in range(kept):
            accuracy = max(POLISH, residual[j], residual[k])
            if _one(links, joints, T, q[j], q[k], accuracy, trial):
                twin = j
                break
        if twin < 0:
            move(q, residual, branch, free, k, kept)
            kept += 1
        elif residual[k] < residual[twin]:
            move(q, residual, branch, free, k, twin)
    solutions = np.int64(0)
    for k in range(kept):
        free[k] = _free_joints(links, joints, T, q[k], trial, work)
        inside = _into_limits(links, joints, T, q[k])
        if within_limits and not inside and free[k] == 0:
            continue
        residual[k] = position_residual(links, joints, T, q[k])
        if residual[k] <= ACCEPT:
            move(q, residual, branch, free, k, solutions)
            solutions += 1
    return solutions
