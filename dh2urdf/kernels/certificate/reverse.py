"""From the solutions of a reversed chain to those of the chain itself."""

from dh2urdf.kernels.certificate.certify import finish_pose
from dh2urdf.kernels.certificate.newton import work_array
from dh2urdf.kernels.numbers import inner_kernel, kernel


@inner_kernel
def invert_pose(T, out):
    """``out = T^-1`` for a rigid pose (4, 4)."""
    for j in range(3):
        total = 0.0
        for k in range(3):
            out[j, k] = T[k, j]
            total -= T[k, j] * T[k, 3]
        out[j, 3] = total
        out[3, j] = 0.0
    out[3, 3] = 1.0


@kernel
def invert_poses(Ts, out):
    """``out[i] = Ts[i]^-1`` for rigid poses (m, 4, 4)."""
    for i in range(Ts.shape[0]):
        invert_pose(Ts[i], out[i])


@inner_kernel
def reverse_joints(q, free):
    """Reverse the joints of a configuration q (n,) in place; the mask of its free ones, too."""
    n, mask = q.shape[0], 0
    for j in range(n // 2):
        q[j], q[n - 1 - j] = q[n - 1 - j], q[j]
    for j in range(n):
        mask |= (free >> j & 1) << (n - 1 - j)
    return mask


@kernel
def turn_back(links, joints, Ts, within_limits, q, residual, count, branch, free):
    """Reverse the joints of solutions q (m, kmax, n), and certify them on the chain, in place.

    The reversed chain measures its position error at the other end.
    """
    n = q.shape[2]
    work = work_array(n)
    for i in range(Ts.shape[0]):
        found = count[i]
        for k in range(found):
            free[i, k] = reverse_joints(q[i, k], free[i, k])
            residual[i, k] = -1.0
        count[i] = finish_pose(
            links, joints, Ts[i], within_limits, q[i], residual[i], branch[i], free[i], found, work
        )
