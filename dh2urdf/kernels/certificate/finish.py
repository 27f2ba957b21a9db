"""From candidates to solutions: double roots, families, limits, and back from the reversed chain.

Solutions that cannot be told apart at the accuracy of a residual become one.
"""

import numpy as np

from dh2urdf.kernels.certificate.certify import (
    ANYWHERE,
    ROUNDING,
    TWO_PI,
    finish_pose,
    move,
    turn_inside,
)
from dh2urdf.kernels.certificate.newton import (
    POLISH,
    damped_step,
    normal_equations,
    polish,
    pose_residual,
    work_array,
)
from dh2urdf.kernels.certificate.singular_families import free_joints, one_of_each_family
from dh2urdf.kernels.chain import inverse_pose, store_pose
from dh2urdf.kernels.numbers import Joints, Links, Outputs, Poses, entry

NEAR = 0.01
"""Joint distance [rad or m] below which two solutions may be one."""

FLAT = 40.0 * ROUNDING
"""Residual [m and rad] of the middle between two exact solutions that are one. Between elbows that
are 2e-6 rad apart, and two, it is 1e-13; where six branches meet, and are one, up to 2e-14."""

ACROSS = 1e-10
"""Damping of the step by which such a middle is brought back across the way, not along it."""


def _one(links, joints, T, q, p, accuracy, middle, start, work):
    """Whether q and p are near, and the pose is reached as well half way between them.

    Where branches meet, on the rim of the workspace, a residual leaves the joints undetermined by
    its square root or worse, and the way from one to the other is flat. Where that way is curved
    the middle has to be polished; between two separate solutions it then runs off to one of them.
    """
    longest = 0.0
    for i in range(q.shape[0]):
        gap = p[i] - q[i]
        if joints[i, 0] == 0.0:
            gap -= TWO_PI * np.floor(gap / TWO_PI + 0.5)
        if abs(gap) > NEAR:
            return False
        middle[i] = q[i] + 0.5 * gap
        start[i] = middle[i]
        longest = max(longest, abs(gap))
    rough = pose_residual(links, joints, T, middle)
    normal_equations(links, joints, T, middle, work)
    damped_step(work, ACROSS)
    for i in range(q.shape[0]):
        middle[i] += work[i, 7]
    if pose_residual(links, joints, T, middle) <= accuracy:
        return True
    if rough <= POLISH:
        return False
    if not polish(links, joints, T, middle, work) <= accuracy:
        return False
    for i in range(q.shape[0]):
        if abs(middle[i] - start[i]) > 0.25 * longest:
            return False
    return True


def merge_solutions(links, joints, T, q, residual, branch, free, count, scratch, work):
    """Keep one of each group of solutions that are one, the best; the new count.

    Arguments as for :func:`.certify.finish_pose`; ``scratch`` (2, n).
    """
    kept = 0
    for k in range(count):
        twin = -1
        for j in range(kept):
            accuracy = max(FLAT, residual[j], residual[k])
            if _one(links, joints, T, q[j], q[k], accuracy, scratch[0], scratch[1], work):
                twin = j
                break
        if twin < 0:
            move(q, residual, branch, free, k, kept)
            kept += 1
        elif residual[k] < residual[twin]:
            move(q, residual, branch, free, k, twin)
    return kept


def merge_families(links, joints, T, rows, count, trial, work):
    """Solutions of :func:`.certify.finish_pose` without limits, merged, with their free joints.

    ``rows`` are q, residual, branch, free. ``trial`` (2, n) is scratch.
    """
    q, residual, branch, free = rows
    count = merge_solutions(links, joints, T, q, residual, branch, free, count, trial, work)
    for k in range(count):
        free[k] = free_joints(links, joints, T, q[k], trial[0], work)
    return count


def finish_families(links, joints, T, rest, within_limits, rows, count, trial, work):
    """The same of each family's member at the rest values (n,), brought into the limits."""
    q, residual, branch, free = rows
    count = merge_families(links, joints, T, rows, count, trial, work)
    count = one_of_each_family(joints, rest, q, residual, branch, free, count)
    if within_limits:
        count = turn_inside(links, joints, T, within_limits, q, residual, branch, free, count)
    return count


@entry()
def finish_batch(links: Links, joints: Joints, Ts: Poses, within_limits: bool, outputs: Outputs):
    """Certify candidates q (m, kmax, n), the first ``count[i]`` of pose Ts[i], in place.

    The other arrays as in :class:`dh2urdf.ik.arm.solver.Solver`; branches become -1.
    """
    q, residual, count, branch, free = outputs
    n = q.shape[2]
    work, trial = work_array(n), np.empty((2, n))
    for i in range(Ts.shape[0]):
        for k in range(count[i]):
            residual[i, k], branch[i, k], free[i, k] = -1.0, -1, 0
        rows = q[i], residual[i], branch[i], free[i]
        found = finish_pose(links, joints, Ts[i], ANYWHERE, *rows, count[i], work)
        count[i] = merge_families(links, joints, Ts[i], rows, found, trial, work)
        if within_limits:
            count[i] = turn_inside(links, joints, Ts[i], within_limits, *rows, count[i])


def invert_pose(T, out):
    """``out = T^-1`` for a rigid pose (4, 4)."""
    store_pose(inverse_pose(T), out)


@entry()
def invert_poses(Ts: Poses, out: Poses):
    """``out[i] = Ts[i]^-1`` for rigid poses (m, 4, 4)."""
    for i in range(Ts.shape[0]):
        invert_pose(Ts[i], out[i])


def reverse_joints(q, free):
    """Reverse the joints of a configuration q (n,) in place; the mask of its free ones, too."""
    n, mask = q.shape[0], 0
    for j in range(n // 2):
        q[j], q[n - 1 - j] = q[n - 1 - j], q[j]
    for j in range(n):
        mask |= (free >> j & 1) << (n - 1 - j)
    return mask


@entry()
def turn_back(links: Links, joints: Joints, Ts: Poses, within_limits: bool, outputs: Outputs):
    """Reverse the joints of solutions q (m, kmax, n), and certify them on the chain, in place.

    The reversed chain measures its position error at the other end.
    """
    q, residual, count, branch, free = outputs
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
