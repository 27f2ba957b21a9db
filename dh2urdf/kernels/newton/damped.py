"""Damped least squares for chains of any number of joints (Nakamura & Hanafusa 1986).

``dq = J^T (J J^T + damping)^-1 e`` is the shortest of the steps that do the same, so that what
a redundant chain can do while its tool stays is left alone. Position and turn count alike when
positions are divided by a length of the arm's size.
"""

import math

import numpy as np

from dh2urdf.kernels.chain import jacobian_rows
from dh2urdf.kernels.newton.steps import (
    damped_step,
    residual_of,
    turn_between,
    way_between,
    work_array,
)

RESTORED = 1e-13
"""Residual [m and rad] at which a configuration is back on the target, some 100 roundings."""

MOST_STEPS = 10
"""Newton steps before a configuration is given up; after a short step two or three do."""

FLOOR = 1e-14
"""Damping relative to the trace of ``J J^T``: keeps the Cholesky factor real, no more."""

STILL = 1e-28
"""Trace of ``J J^T`` that is rounding: no joint moves what is asked for."""

POSE, POSITION, POSITION_AXIS = 0, 1, 2
"""Tasks: the whole pose, its position, its position and the direction of the tool's z axis."""

STAYING = 4
"""Added to a task as many times as a mask of joints says, these stay and move nothing."""


def make_damped(n):
    """Scratch for n joints: Jacobian (n, 6), and `work_array` of six for error and solution."""
    return np.empty((n, 6)), work_array(6)


def error_and_jacobian(chain, goal, q, damped):
    """Residual of q (n,) at a `Goal` [m and rad]; its error and the Jacobian go to ``damped``.

    The error is (position / unit, rotation vector as long as the sine of its angle) from the
    tool to the target in base axes; beyond 90 degrees the vector is scaled up to length 1.
    """
    (J, work), (asked, T, unit) = damped, goal
    task, held = asked % STAYING, asked // STAYING
    r = jacobian_rows(chain, q, J)
    if held != 0:
        for i in range(q.shape[0]):
            if held >> i & 1:
                J[i] = 0.0
    x, y, z = way_between(r, T)
    work[0, 6], work[1, 6], work[2, 6] = x / unit, y / unit, z / unit
    for i in range(q.shape[0]):
        J[i, 0], J[i, 1], J[i, 2] = J[i, 0] / unit, J[i, 1] / unit, J[i, 2] / unit
    position = math.sqrt(x * x + y * y + z * z)
    if task == POSITION:
        for i in range(q.shape[0]):
            J[i, 3], J[i, 4], J[i, 5] = 0.0, 0.0, 0.0
        work[3, 6], work[4, 6], work[5, 6] = 0.0, 0.0, 0.0
        return position
    zx, zy, zz = r[2], r[6], r[10]
    if task == POSE:
        work[3, 6], work[4, 6], work[5, 6], trace = turn_between(r, T)
        beyond = trace < 1.0
    else:
        for i in range(q.shape[0]):
            along = zx * J[i, 3] + zy * J[i, 4] + zz * J[i, 5]
            J[i, 3] -= along * zx
            J[i, 4] -= along * zy
            J[i, 5] -= along * zz
        work[3, 6] = zy * T[2, 2] - zz * T[1, 2]
        work[4, 6] = zz * T[0, 2] - zx * T[2, 2]
        work[5, 6] = zx * T[1, 2] - zy * T[0, 2]
        beyond = zx * T[0, 2] + zy * T[1, 2] + zz * T[2, 2] < 0.0
    turn = math.sqrt(work[3, 6] * work[3, 6] + work[4, 6] * work[4, 6] + work[5, 6] * work[5, 6])
    if beyond:
        size = max(turn, 1e-6)
        work[3, 6], work[4, 6], work[5, 6] = work[3, 6] / size, work[4, 6] / size, work[5, 6] / size
        turn = math.pi
    return residual_of(r, T) if task == POSE else max(position, turn)


def solve_damped(damped, damping):
    """``y = (J J^T + damping)^-1 e``, e and y in ``damped``."""
    J, work = damped
    trace = 0.0
    for a in range(6):
        for b in range(a + 1):
            total = 0.0
            for i in range(J.shape[0]):
                total += J[i, a] * J[i, b]
            work[a, 8 + b] = total
        trace += work[a, 8 + a]
    # where nothing moves what is asked for, J is rounding, and so is what it does
    damped_step(work, damping + FLOOR * trace if trace > STILL else 1.0)


def add_transposed(damped, factor, dq):
    """``dq += factor J^T y``."""
    J, work = damped
    for i in range(dq.shape[0]):
        total = 0.0
        for a in range(6):
            total += J[i, a] * work[a, 7]
        dq[i] += factor * total


def restore(chain, goal, q, dq, damped):
    """Newton's method by shortest steps, q (n,) in place; returns the residual.

    Stops when the residual is rounding, or no longer falls. ``dq`` (n,) is scratch.
    """
    residual = error_and_jacobian(chain, goal, q, damped)
    for _ in range(MOST_STEPS):
        if residual <= RESTORED:
            break
        solve_damped(damped, 0.0)
        dq[:] = 0.0
        add_transposed(damped, 1.0, dq)
        q += dq
        after = error_and_jacobian(chain, goal, q, damped)
        if not after < residual:
            q -= dq
            break
        residual = after
    return residual
