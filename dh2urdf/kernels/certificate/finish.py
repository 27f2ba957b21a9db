"""From candidates to solutions: limits, free joints, one of each family."""

import numpy as np

from dh2urdf.kernels.certificate.certify import ANYWHERE, finish_pose, turn_inside
from dh2urdf.kernels.certificate.double_roots import merge_solutions
from dh2urdf.kernels.certificate.newton import work_array
from dh2urdf.kernels.certificate.singular_families import free_joints, one_of_each_family
from dh2urdf.kernels.numbers import inlined_kernel, kernel

ALL_MEMBERS = np.empty(0)
"""In the place of rest values: all members of a family stay."""


@inlined_kernel
def finish_families(links, joints, T, rest, within_limits, rows, count, trial, work):
    """Solutions of :func:`.certify.finish_pose` without limits, merged, with their free joints.

    ``rows`` are q, residual, branch, free. Of each family the member at the rest values (n,) stays.
    ``trial`` (2, n) is scratch.
    """
    q, residual, branch, free = rows
    count = merge_solutions(links, joints, T, q, residual, branch, free, count, trial, work)
    for k in range(count):
        free[k] = free_joints(links, joints, T, q[k], trial[0], work)
    if rest.shape[0] > 0:
        count = one_of_each_family(joints, rest, q, residual, branch, free, count)
    if within_limits:
        count = turn_inside(links, joints, T, within_limits, q, residual, branch, free, count)
    return count


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
    work, trial = work_array(n), np.empty((2, n))
    for i in range(Ts.shape[0]):
        for k in range(count[i]):
            residual[i, k], branch[i, k], free[i, k] = -1.0, -1, 0
        rows = q[i], residual[i], branch[i], free[i]
        found = finish_pose(links, joints, Ts[i], ANYWHERE, *rows, count[i], work)
        count[i] = finish_families(
            links, joints, Ts[i], ALL_MEMBERS, within_limits, rows, found, trial, work
        )
