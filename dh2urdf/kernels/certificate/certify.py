"""Certification: candidates of one pose become solutions, each with the residual of the chain.

Every solver ends here. A candidate is kept when the exact chain reaches the pose within
``ACCEPT``; Newton's method repairs what rounding, noise or an approximate root left over.

``rows`` are the candidates or solutions of one pose: configurations q (kmax, n), residuals, branch
codes and masks of free joints, (kmax,) each.
"""

import math

import numpy as np

from dh2urdf.kernels.certificate.directions import add_step, look_at_some
from dh2urdf.kernels.newton import POLISH, make_damped, polish, pose_residual
from dh2urdf.kernels.shapes import DULL

ACCEPT = 1e-9
"""Largest residual of a solution [m and rad]."""

ROUNDING = 1e-15
"""Residual [m and rad] that is the pose's own rounding, for an arm of about a metre."""

NO_JOINT = 0
"""The mask of no joint."""

EVERY_JOINT = (1 << 30) - 1
"""The mask of all joints."""

CLUSTER = 1e-6
"""Joint distance [rad or m] at which two solutions are one."""

TWO_PI = 2.0 * math.pi

FAR = 4.0 * math.pi
"""Angle [rad] beyond which full turns round a value by more than the chain rounds a pose."""

WEAK, BACK = 1e-10, 3
"""Singular value, relative to the largest, of a direction in which joints do not make up for others
that were put on their bounds, or in line; Newton's steps for that."""

OVER = 1e-3
"""How far [rad or m] rounding takes the root of a solution over a bound at most: three that meet
are known to the cube root of it, four to the fourth."""

EXACT = 40.0 * ROUNDING
"""Residual [m and rad] of one that was put on a bound from farther than ``CLUSTER``, or in line."""


def principal(angle):
    """Bring an angle into [-pi, pi]."""
    if -math.pi <= angle <= math.pi:
        return angle + 0.0
    return angle - TWO_PI * np.floor(angle / TWO_PI + 0.5)


def same(joints, q, p, reach, free):
    """Whether two configurations differ by at most ``reach`` a joint, up to full turns.

    The joints in the mask ``free`` may differ by any amount.
    """
    for i in range(q.shape[0]):
        gap = q[i] - p[i] if joints[i, 0] != 0.0 else principal(q[i] - p[i])
        if abs(gap) > reach and not (free >> i) & 1:
            return False
    return True


def is_known(joints, q, count, p):
    """Whether p (n,) is one of the first rows of q (kmax, n)."""
    for k in range(count):
        if same(joints, q[k], p, CLUSTER, NO_JOINT):
            return True
    return False


def bring_back(chain, T, q, mask, most, room):
    """Newton's method by the joints of a mask, q (n,) in place, where others were put somewhere.

    By steps of at most so much. At a nearly double root joints make up for what was taken off.
    """
    for _ in range(BACK):
        _, largest = look_at_some(chain, T, q, mask, room)
        add_step(chain, 1.0, q, room, WEAK * largest, most)


def make_up(chain, T, q, free, most):
    """:func:`bring_back` by the joints of q (n,) that are on no bound; the residual then.

    Within the limits.
    """
    (_, joints), n, mask = chain, q.shape[0], 0
    room = make_damped(n), np.empty((n, n)), np.empty(n), np.empty(n)
    for i in range(n):
        mask |= (1 if joints[i, 1] < q[i] < joints[i, 2] else 0) << i
    bring_back(chain, T, q, mask, most, room)
    _onto_bounds(joints, q, free)
    return pose_residual(chain, T, q)


def _onto_bounds(joints, q, free):
    """Put what of q (n,) is outside its bounds onto them, but joints that are free."""
    for i in range(q.shape[0]):
        if not (free >> i) & 1:
            q[i] = min(max(q[i], joints[i, 1]), joints[i, 2])


def _into_limits(chain, T, within_limits, q, residual, free):
    """Turn q (n,) by 2 pi nearest to the middle of its limits; the residual there, or infinity.

    A joint that overshoots its bound by less than ``CLUSTER`` is put on the bound if the pose is
    still reached there: at a double root (straight elbow, bound 0) rounding takes the root over.
    One that overshoots by up to ``OVER`` is put there if that is as exact: more solutions meet.
    Nothing is put on a bound where the limits do not count. A free joint may be outside: another
    member of its family may not. Returned, too, is whether a joint was put on a bound.
    """
    _, joints = chain
    over, moved, far = 0.0, False, False
    for i in range(q.shape[0]):
        lower, upper = joints[i, 1], joints[i, 2]
        bounded = lower > -math.inf and upper < math.inf
        if joints[i, 0] == 0.0:
            if bounded:
                q[i] -= TWO_PI * np.floor((q[i] - 0.5 * (lower + upper)) / TWO_PI + 0.5)
            elif lower > -math.inf:
                q[i] += TWO_PI * np.ceil((lower - CLUSTER - q[i]) / TWO_PI)
            elif upper < math.inf:
                q[i] -= TWO_PI * np.ceil((q[i] - upper - CLUSTER) / TWO_PI)
            far = far or abs(q[i]) > FAR
        if within_limits and (q[i] < lower or q[i] > upper) and not (free >> i) & 1:
            over, moved = max(over, lower - q[i], q[i] - upper), True
    if over > OVER:
        return math.inf, False
    if not moved and not far:
        return residual, False
    if moved:
        _onto_bounds(joints, q, free)
    residual = pose_residual(chain, T, q)
    if over > CLUSTER:
        residual = make_up(chain, T, q, free, OVER)
        return residual if residual <= EXACT else math.inf, True
    return make_up(chain, T, q, free, CLUSTER) if moved and residual > ACCEPT else residual, moved


def move(q, residual, branch, free, source, target):
    """Copy one of the rows over another."""
    for i in range(q.shape[1]):
        q[target, i] = q[source, i]
    residual[target], branch[target], free[target] = residual[source], branch[source], free[source]


def copy_rows(source, count, target):
    """Copy rows; returns how many. If not all fit, the last by ``DULL`` are left out."""
    (q, residual, branch, free), room = source, target[0].shape[0]
    while count > room:
        worst, most = 0, 0.0
        for k in range(count):
            dull = DULL if free[k] != 0 else residual[k] if residual[k] > DULL else 0.0
            if dull >= most:
                worst, most = k, dull
        count -= 1
        for k in range(worst, count):
            move(q, residual, branch, free, k + 1, k)
    for k in range(count):
        target[0][k] = q[k]
        target[1][k], target[2][k], target[3][k] = residual[k], branch[k], free[k]
    return count


def certify_pose(chain, T, q, residual, branch, free, count, work):
    """Certify the candidates of one pose in place; how many solutions are left, in any turn.

    They are the first ``count`` rows; their residual is what the caller measured on the exact
    chain, or a negative number: not yet. ``work``: a `work_array`.

    Two solutions are one if no joint differs by more than ``CLUSTER`` or the square root of
    their residual: on the rim of the workspace two branches meet as a square root. The one with
    the smaller residual stays, or the first if it reaches the pose to rounding.
    """
    _, joints = chain
    kept = 0
    for k in range(count):
        if residual[k] < 0.0 or residual[k] > POLISH:
            residual[k] = polish(chain, T, q[k], work)
        if not residual[k] <= ACCEPT:
            continue
        for i in range(q.shape[1]):
            q[kept, i] = q[k, i] if joints[i, 0] != 0.0 else principal(q[k, i])
        residual[kept], branch[kept], free[kept] = residual[k], branch[k], free[k]
        twin = -1
        for j in range(kept):
            reach = max(CLUSTER, math.sqrt(max(residual[j], residual[kept])))
            if same(joints, q[j], q[kept], reach, NO_JOINT):
                twin = j
                break
        if twin < 0:
            kept += 1
        elif residual[kept] < residual[twin] and residual[twin] > ROUNDING:
            move(q, residual, branch, free, kept, twin)
    return kept


def finish_pose(chain, T, within_limits, q, residual, branch, free, count, work):
    """Certify the candidates of one pose (:func:`certify_pose`), and turn them near their limits.

    ``within_limits`` drops what no full turn brings into the limits; a free joint may be outside,
    for another member of its family may not.
    """
    kept = certify_pose(chain, T, q, residual, branch, free, count, work)
    return turn_inside(chain, T, within_limits, q, residual, branch, free, kept)


def turn_inside(chain, T, within_limits, q, residual, branch, free, count):
    """Turn solutions by full turns, near or into their limits; how many are left."""
    solutions = 0
    for k in range(count):
        residual[k], moved = _into_limits(chain, T, within_limits, q[k], residual[k], free[k])
        if residual[k] <= ACCEPT and not (moved and is_known(chain[1], q, solutions, q[k])):
            move(q, residual, branch, free, k, solutions)
            solutions += 1
    return solutions
