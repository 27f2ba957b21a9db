"""From the candidates of a batch to its solutions: limits, free joints, one of each family."""

from __future__ import annotations

import numpy as np

from dh2urdf.kernels.certificate.certify import ANYWHERE, finish_pose
from dh2urdf.kernels.certificate.families import free_joints
from dh2urdf.kernels.certificate.merging import merge_solutions
from dh2urdf.kernels.numbers import kernel

__all__ = ["finish_batch"]


@kernel
def finish_batch(links, joints, Ts, within_limits, q, residual, count, branch, free):
    """Certify candidates q (m, kmax, n), the first ``count[i]`` of pose i, in place.

    Parameters
    ----------
    links, joints
        The exact chain, see :mod:`dh2urdf.kernels.certificate.certify`.
    Ts : array, shape (m, 4, 4)
    within_limits : bool
    q, residual, count, branch, free
        As in :class:`dh2urdf.ik.arm.solver.Solver`; branches become -1.
    """
    n = q.shape[2]
    work, trial = np.empty((n, n + 8)), np.empty((2, n))
    for i in range(Ts.shape[0]):
        found, rows = count[i], (q[i], residual[i], branch[i], free[i])
        for k in range(found):
            residual[i, k], branch[i, k], free[i, k] = -1.0, -1, 0
        found = finish_pose(links, joints, Ts[i], ANYWHERE, *rows, found, work)
        found = merge_solutions(links, joints, Ts[i], *rows, found, trial, work)
        for k in range(found):
            free[i, k] = free_joints(links, joints, Ts[i], q[i, k], trial[0], work)
        if within_limits:
            found = finish_pose(links, joints, Ts[i], within_limits, *rows, found, work)
        count[i] = found
