"""Solutions that cannot be told apart at the accuracy of a residual become one."""

import math

import numpy as np

from dh2urdf.kernels.certificate.certify import ROUNDING, TWO_PI, move
from dh2urdf.kernels.certificate.newton import (
    POLISH,
    damped_step,
    normal_equations,
    polish,
    pose_residual,
)
from dh2urdf.kernels.numbers import inlined_kernel, inner_kernel

NEAR = 0.01
"""Joint distance [rad or m] below which two solutions may be one."""

FLAT = 40.0 * ROUNDING
"""Residual [m and rad] of the middle between two exact solutions that are one. Between elbows that
are 2e-6 rad apart, and two, it is 1e-13; where six branches meet, and are one, up to 2e-14."""

ACROSS = 1e-10
"""Damping of the step by which such a middle is brought back across the way, not along it."""


@inlined_kernel
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
            gap -= TWO_PI * math.floor(gap / TWO_PI + 0.5)
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


@inner_kernel
def merge_solutions(links, joints, T, q, residual, branch, free, count, scratch, work):
    """Keep one of each group of solutions that are one, the best; the new count.

    Arguments as for :func:`.certify.finish_pose`; ``scratch`` (2, n).
    """
    kept = np.int64(0)
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
