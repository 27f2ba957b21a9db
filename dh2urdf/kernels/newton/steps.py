"""Newton's method on the exact chain, and the residual that it works on.

A target T is a pose (4, 4), or a point (3,) for the tool's origin: then only the position counts.
"""

import math

import numpy as np

from dh2urdf.kernels.chain import chain_pose, jacobian_rows

POLISH = 1e-13
"""Residual [m and rad] below which a candidate is left as it is; some 100 roundings."""

HOPELESS = 0.3
"""Residual [m and rad] of a candidate that Newton is not asked to repair."""

PLAIN_STEPS = 5
"""Plain Newton steps; a sound candidate needs two or three."""

DAMPED_FAILURES = 4
"""Damped steps that may fail to halve the residual before a candidate is given up."""

TINY_DAMPING = 1e-18
"""Damping that only keeps rounding from dividing by zero."""

MAX_TURN = 0.3
"""Longest Newton step of one joint [rad or m]."""

VALLEY = 1e3
"""The same in square roots of the residual: where two branches meet, a root is off by about one,
and what is asked for beyond is noise along a direction in which the pose hardly changes."""


def work_array(n):
    """Scratch of a chain of n joints: Jacobian, right side, solution, triangle."""
    return np.empty((n, n + 8))


def residual_of(r, T):
    """Residual of a pose r (twelve scalars) against a target T.

    The larger of the position error [m] and the angle between the orientations [rad],
    ``|sum_i r_i x t_i| / 2 = sin(angle)`` over the columns of the rotations; pi where the angle is
    over 90 degrees. Stretching T (six-digit input) does not enter to first order.
    """
    x, y, z = way_between(r, T)
    if T.ndim == 1:
        return math.sqrt(x * x + y * y + z * z)
    ex, ey, ez, cosine = turn_between(r, T)
    if cosine <= 1.0:
        return math.pi
    return math.sqrt(max(x * x + y * y + z * z, ex * ex + ey * ey + ez * ez))


def way_between(r, T):
    """Way from the origin of r to that of T."""
    if T.ndim == 1:
        return T[0] - r[3], T[1] - r[7], T[2] - r[11]
    return T[0, 3] - r[3], T[1, 3] - r[7], T[2, 3] - r[11]


def turn_between(r, T):
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


def pose_residual(chain, T, q):
    """Residual of one configuration q (n,) on the exact chain against T."""
    return residual_of(chain_pose(chain, q), T)


def normal_equations(chain, T, q, work):
    """``J^T J`` and ``J^T e`` at q, the error e = (position, rotation vector) to T.

    J as of :func:`jacobian_rows`. Written to ``work[:, 8:]`` (lower triangle) and ``work[:, 6]``.
    """
    r = jacobian_rows(chain, q, work)
    px, py, pz = way_between(r, T)
    ex, ey, ez = 0.0, 0.0, 0.0
    if T.ndim == 2:
        ex, ey, ez, _ = turn_between(r, T)
    for i in range(q.shape[0]):
        linear = work[i, 0] * px + work[i, 1] * py + work[i, 2] * pz
        work[i, 6] = linear + work[i, 3] * ex + work[i, 4] * ey + work[i, 5] * ez
        for j in range(i + 1):
            total = 0.0
            for k in range(6 if T.ndim == 2 else 3):
                total += work[i, k] * work[j, k]
            work[i, 8 + j] = total


def factor(work, damping):
    """Cholesky factor of ``work[:, 8:] + damping``, in place over the lower triangle.

    Pivots that rounding made non-positive are raised to the damping.
    """
    for i in range(work.shape[0]):
        for j in range(i + 1):
            part = work[i, 8 + j] + (damping if i == j else 0.0)
            for k in range(j):
                part -= work[i, 8 + k] * work[j, 8 + k]
            if i == j:
                work[i, 8 + i] = math.sqrt(max(part, damping))
            else:
                work[i, 8 + j] = part / work[j, 8 + j]


def substitute(work):
    """Solve for the right side ``work[:, 6]`` by the factor, into ``work[:, 7]``; longest entry."""
    n = work.shape[0]
    for i in range(n):
        total = work[i, 6]
        for j in range(i):
            total -= work[i, 8 + j] * work[j, 7]
        work[i, 7] = total / work[i, 8 + i]
    longest = 0.0
    for i in range(n - 1, -1, -1):
        total = work[i, 7]
        for k in range(i + 1, n):
            total -= work[k, 8 + i] * work[k, 7]
        work[i, 7] = total / work[i, 8 + i]
        longest = max(longest, abs(work[i, 7]))
    return longest


def damped_step(work, damping):
    """Solve ``(J^T J + damping) dq = J^T e``, dq in ``work[:, 7]``; longest entry.

    The triangle is factored in place, so the equations are built anew for every step.
    """
    factor(work, damping)
    return substitute(work)


def polish(chain, T, q, work):
    """Newton's method on the exact chain, q (n,) in place; returns the residual.

    First plain steps, which near a singularity may go uphill once before they converge; where
    they do not, Levenberg's damped steps from the best point, each of which must go downhill.
    """
    residual = pose_residual(chain, T, q)
    if residual <= POLISH or not residual <= HOPELESS:
        return residual
    best, kept = residual, np.empty(q.shape[0])
    kept[:] = q
    for _ in range(PLAIN_STEPS):
        normal_equations(chain, T, q, work)
        _move_along(q, work, damped_step(work, TINY_DAMPING), residual)
        residual = pose_residual(chain, T, q)
        if residual < best:
            best = residual
            kept[:] = q
        if residual <= POLISH or not residual <= HOPELESS:
            break
    damping, failures = 1e-3 * best, 0
    q[:] = kept
    while best > POLISH and failures < DAMPED_FAILURES and damping > TINY_DAMPING:
        normal_equations(chain, T, q, work)
        _move_along(q, work, damped_step(work, damping), best)
        residual = pose_residual(chain, T, q)
        damping = 0.01 * damping if residual < 0.5 * best else 100.0 * damping
        failures += 1 if residual > 0.5 * best else 0
        if residual < best:
            best = residual
            kept[:] = q
        else:
            q[:] = kept
    return best


def _move_along(q, work, longest, residual):
    """Add the step in ``work[:, 7]`` to q, shortened to ``MAX_TURN`` and ``VALLEY``."""
    most = min(MAX_TURN, VALLEY * math.sqrt(residual))
    scale = min(1.0, most / longest) if longest > 0.0 else 0.0
    for i in range(q.shape[0]):
        q[i] += scale * work[i, 7]
