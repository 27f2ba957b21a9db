"""Singular families: which joints can move while the tool stays."""

import math

import numpy as np

from dh2urdf.kernels.certificate.certify import ACCEPT, CLUSTER, TWO_PI, move
from dh2urdf.kernels.certificate.newton import (
    damped_step,
    factor,
    normal_equations,
    polish,
    substitute,
)

SINGULAR = 1e-10
"""Smallest eigenvalue of J^T J, relative to the trace, at which a walk is tried."""

WALK = 0.05
"""Length of the trial walk [rad or m]."""

STEADY, STEADY_STEPS = 1e-6, 6
"""Damping and number of the first steps back to the family: across it and not along, for beside a
family the Jacobian has its rank, and a plain step may go anywhere."""

MOVES = 1e-5
"""Motion [rad or m] of a joint over the walk that makes it free."""


def null_direction(work):
    """Eigenvector of the smallest eigenvalue of ``work[:, 8:]`` (lower triangle), by iteration.

    Inverse iteration on a Cholesky factor with a shift of 1e-14; the vector is written to
    ``work[:, 6]``. Returns the eigenvalue relative to the trace.
    """
    n = work.shape[0]
    trace = 0.0
    for i in range(n):
        trace += work[i, 8 + i]
    if trace <= 0.0:
        for i in range(n):
            work[i, 6] = 1.0 / math.sqrt(n)
        return 0.0
    factor(work, 1e-14 * trace)
    for i in range(n):
        work[i, 6] = 1.0 + 0.3 * i
    size = 1.0
    for _ in range(3):
        substitute(work)
        size = 0.0
        for i in range(n):
            size += work[i, 7] * work[i, 7]
        size = math.sqrt(size)
        for i in range(n):
            work[i, 6] = work[i, 7] / size
    return 1.0 / (size * trace)


def free_joints(links, joints, T, q, trial, work):
    """Bits of the joints that move along a family of solutions through q (n,); 0: isolated.

    Where the Jacobian loses rank, a step is taken along its null direction and polished on the
    exact chain. At a double root Newton comes back to q; on a family it stays away. ``trial`` (n,)
    is scratch.
    """
    n = q.shape[0]
    normal_equations(links, joints, T, q, work)
    if null_direction(work) > SINGULAR:
        return 0
    for i in range(n):
        trial[i] = q[i] + WALK * work[i, 6]
    for _ in range(STEADY_STEPS):
        normal_equations(links, joints, T, trial, work)
        damped_step(work, STEADY)
        for i in range(n):
            trial[i] += work[i, 7]
    if not polish(links, joints, T, trial, work) <= ACCEPT:
        return 0
    away = 0.0
    mask = 0
    for i in range(n):
        gap = abs(trial[i] - q[i])
        away += gap * gap
        if gap > MOVES:
            mask |= 1 << i
    return mask if away > 0.25 * WALK * WALK else 0


def one_of_each_family(joints, rest, q, residual, branch, free, count):
    """Keep one representative of each singular family; the new count.

    Solutions with the same free joints are taken for one family. The one whose first free joint
    is at rest stays; without one, the first.
    """
    kept = 0
    for k in range(count):
        keep = True
        for j in range(count):
            if j == k or free[k] == 0 or free[j] != free[k]:
                continue
            mine = _at_rest(joints, rest, q[k], free[k])
            other = _at_rest(joints, rest, q[j], free[k])
            if (other and not mine) or (not other and not mine and j < k):
                keep = False
        if keep:
            move(q, residual, branch, free, k, kept)
            kept += 1
    return kept


def _at_rest(joints, rest, q, mask):
    """Whether the first joint of a mask is at its rest value, up to full turns."""
    first = 0
    while not mask >> first & 1:
        first += 1
    gap = q[first] - rest[first]
    if joints[first, 0] == 0.0:
        gap -= TWO_PI * np.floor(gap / TWO_PI + 0.5)
    return abs(gap) <= CLUSTER
