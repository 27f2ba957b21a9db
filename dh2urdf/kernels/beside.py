"""Solutions beside solutions: where two singularities nearly meet, several lie close together.

Seeds from a nominal arm, and roots of a polynomial, lead to some of them only. From one of them
the others lie along the direction in which the pose hardly changes.
"""

from __future__ import annotations

import numpy as np

from dh2urdf.kernels.certify import (
    ACCEPT,
    CLUSTER,
    NO_JOINT,
    _normal_equations,
    polish,
    principal,
    same,
)
from dh2urdf.kernels.compiled import inner_kernel, kernel
from dh2urdf.kernels.families import null_direction, work_array

__all__ = ["search_beside"]

SINGULAR = 1e-11
"""Smallest eigenvalue of J^T J, relative to the trace, below which others are looked for."""

WAYS = (1e-3, 1e-2, 0.1, 0.3)
"""How far along that direction Newton's method starts [rad], either way."""


@inner_kernel
def _is_known(joints, q, count, p):
    """Whether p (n,) is one of the first rows of q (kmax, n)."""
    for k in range(count):
        if same(joints, q[k], p, CLUSTER, NO_JOINT):
            return True
    return False


@kernel
def search_beside(links, joints, rows, Ts, q, count):
    """Append to q (m, kmax, 6), in the given rows, what lies beside nearly singular solutions.

    ``links`` and ``joints`` as in :mod:`dh2urdf.kernels.certify`; six turning joints.
    """
    start, trial, work = np.empty(6), np.empty(6), work_array(6)
    for i in rows:
        for k in range(count[i]):
            _normal_equations(links, joints, Ts[i], q[i, k], work)
            if null_direction(work) > SINGULAR:
                continue
            for j in range(6):
                start[j] = work[j, 6]
            for way in WAYS:
                for side in (-way, way):
                    for j in range(6):
                        trial[j] = q[i, k, j] + side * start[j]
                    if not polish(links, joints, Ts[i], trial, work) <= ACCEPT:
                        continue
                    for j in range(6):
                        trial[j] = principal(trial[j])
                    if count[i] < q.shape[1] and not _is_known(joints, q[i], count[i], trial):
                        for j in range(6):
                            q[i, count[i], j] = trial[j]
                        count[i] += 1
