"""From candidates to solutions: double roots, families, limits, and the reversed chain."""

import math

import numpy as np

from dh2urdf.kernels.certificate.certify import (
    CLUSTER,
    EVERY_JOINT,
    NO_JOINT,
    ROUNDING,
    TWO_PI,
    finish_pose,
    move,
    same,
    turn_inside,
)
from dh2urdf.kernels.certificate.walk import LENGTHS, free_of
from dh2urdf.kernels.newton import (
    POLISH,
    damped_step,
    factor,
    normal_equations,
    polish,
    pose_residual,
    substitute,
    work_array,
)
from dh2urdf.kernels.numbers import entry
from dh2urdf.kernels.shapes import AnyChain, Outputs, Poses

NEAR = 0.01
"""Joint distance [rad or m] below which two solutions may be one."""

FLAT = 40.0 * ROUNDING
"""Residual [m and rad] of the middle between two exact solutions that are one. Between elbows that
are 2e-6 rad apart, and two, it is 1e-13; where six branches meet, and are one, up to 2e-14."""

ACROSS = 1e-10
"""Damping of the step by which such a middle is brought back across the way, not along it."""

ASIDE = 0.05
"""How far that may move the middle, in parts of the distance between the two: a way bends by less,
and to a third solution it is farther."""

ALIKE = 1e-4
"""Distance [rad or m] of joints that are not free between members of one family; they hardly move
along it."""

SINGULAR = 1e-10
"""Smallest eigenvalue of J^T J, relative to the trace, at which a walk is tried."""

SURE = 10.0
"""How many times that a bound from below has to be, for the eigenvalue itself not to be looked for:
rounding makes 1e-6 of it."""


def null_direction(work):
    """Eigenvector of the smallest eigenvalue of ``work[:, 8:]`` (lower triangle), by iteration.

    Inverse iteration on a Cholesky factor with a shift of 1e-14; the vector is written to
    ``work[:, 6]``. Returns the eigenvalue relative to the trace.
    """
    n, trace = work.shape[0], _factor_shifted(work)
    if trace <= 0.0:
        for i in range(n):
            work[i, 6] = 1.0 / math.sqrt(n)
        return 0.0
    return _least_eigenvalue(work, trace)


def is_singular(work):
    """Whether :func:`null_direction` of ``work[:, 8:]`` is at most ``SINGULAR``.

    Of most regular solutions the determinant says so, which is in the factor: the other eigenvalues
    are at most the (n - 1)-th part of the trace, in the mean.
    """
    n, trace = work.shape[0], _factor_shifted(work)
    if trace <= 0.0:
        return True
    inverse, bound = 1.0 / trace, 1.0
    for i in range(n):
        bound *= work[i, 8 + i] * work[i, 8 + i] * inverse * (n - 1 if i > 0 else 1)
    return not bound > SURE * SINGULAR and not _least_eigenvalue(work, trace) > SINGULAR


def _factor_shifted(work):
    """Cholesky factor of ``work[:, 8:]``, in place, with a shift of 1e-14; its trace."""
    trace = 0.0
    for i in range(work.shape[0]):
        trace += work[i, 8 + i]
    if not trace <= 0.0:
        factor(work, 1e-14 * trace)
    return trace


def _least_eigenvalue(work, trace):
    """That of which the factor is in ``work[:, 8:]``, over the trace; see `null_direction`."""
    n = work.shape[0]
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


def free_joints(chain, T, q, mask, alone, work):
    """Bits of the joints that move along a family of solutions through q (n,); 0: isolated.

    Those in the mask are tried first, where singularities meet; ``alone`` as in :func:`.free_of`.
    A regular solution costs little.
    """
    normal_equations(chain, T, q, work)
    return _free_where_singular(chain, T, q, mask, alone) if is_singular(work) else 0


def _free_where_singular(chain, T, q, mask, alone):
    """The same of a singular solution."""
    moving = free_of(chain, T, q, LENGTHS[0], mask, alone)
    if moving == 0 and mask != EVERY_JOINT:
        moving = free_of(chain, T, q, LENGTHS[0], EVERY_JOINT, alone)
        for k in range(1, len(LENGTHS)):
            moving = moving if moving != 0 else free_of(chain, T, q, LENGTHS[k], mask, alone)
    return moving


def name_families(chain, T, rows, count, suspected, work):
    """Name the families of solutions whose masks say, or all of which are suspected, to be so."""
    q, _, _, free = rows
    for k in range(count):
        if free[k] != 0 or suspected:
            mask = free[k] if free[k] != 0 else EVERY_JOINT
            free[k] = free_joints(chain, T, q[k], mask, True, work)


@entry()
def name_batch(chain: AnyChain, Ts: Poses, outputs: Outputs):
    """Name the families of solutions q (m, kmax, n) of poses Ts (m, 4, 4) anew, in place."""
    q, residual, count, branch, free = outputs
    work = work_array(q.shape[2])
    for i in range(Ts.shape[0]):
        rows = q[i], residual[i], branch[i], free[i]
        name_families(chain, Ts[i], rows, count[i], True, work)


def one_of_each_family(joints, rest, q, residual, branch, free, count):
    """Keep one representative of each singular family; the new count.

    Solutions with the same free joints, and the others alike, are taken for one family. The one
    whose first free joint is at rest stays; without one, the first.
    """
    kept = 0
    for k in range(count):
        keep = True
        for j in range(count):
            if j == k or free[k] == 0 or free[j] != free[k]:
                continue
            if not same(joints, q[j], q[k], ALIKE, free[k]):
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


def _one(chain, T, q, p, accuracy, middle, start, work):
    """Whether q and p are near, and the pose is reached as well half way between them.

    Where branches meet, on the rim of the workspace, a residual leaves the joints undetermined by
    its square root or worse, and the way from one to the other is flat. Where that way is curved
    the middle has to be polished; between two separate solutions it then runs off to one of them.
    """
    (_, joints), longest = chain, 0.0
    for i in range(q.shape[0]):
        gap = p[i] - q[i]
        if joints[i, 0] == 0.0:
            gap -= TWO_PI * np.floor(gap / TWO_PI + 0.5)
        if abs(gap) > NEAR:
            return False
        middle[i] = q[i] + 0.5 * gap
        start[i] = middle[i]
        longest = max(longest, abs(gap))
    rough = pose_residual(chain, T, middle)
    normal_equations(chain, T, middle, work)
    damped_step(work, ACROSS)
    for i in range(q.shape[0]):
        middle[i] += work[i, 7]
    if pose_residual(chain, T, middle) <= accuracy:
        return True
    if rough <= POLISH:
        return False
    if not polish(chain, T, middle, work) <= accuracy:
        return False
    if _is_aside(middle, start, ASIDE * longest):  # at a third solution, if that is regular
        normal_equations(chain, T, middle, work)
        if not is_singular(work):
            return False
    return not _is_aside(middle, start, 0.25 * longest)


def side_by_side(chain, T, q, count, work):
    """Whether two of the solutions q (kmax, n) are near and singular: a third may be between."""
    for k in range(count):
        for j in range(k):
            if same(chain[1], q[j], q[k], NEAR, NO_JOINT):
                normal_equations(chain, T, q[k], work)
                if is_singular(work):
                    return True
    return False


def _is_aside(middle, start, most):
    """Whether a joint of the middle has moved by more than ``most``."""
    for i in range(start.shape[0]):
        if abs(middle[i] - start[i]) > most:
            return True
    return False


def merge_solutions(chain, T, q, residual, branch, free, count, trial, work):
    """Keep one of each group of solutions that are one, the best; the new count."""
    kept = 0
    for k in range(count):
        twin = -1
        for j in range(kept):
            accuracy = max(FLAT, residual[j], residual[k])
            if _one(chain, T, q[j], q[k], accuracy, trial[0], trial[1], work):
                twin = j
                break
        if twin < 0:
            move(q, residual, branch, free, k, kept)
            kept += 1
        elif residual[k] < residual[twin]:
            move(q, residual, branch, free, k, twin)
    return kept


def merge_families(chain, T, rows, count, trial, work):
    """Solutions of :func:`.certify.finish_pose` without limits, merged, with their free joints.

    How many, and whether one that is isolated is singular. ``trial`` (2, n) is scratch.
    """
    q, _, _, free = rows
    count, lonely = merge_solutions(chain, T, *rows, count, trial, work), False
    for k in range(count):
        normal_equations(chain, T, q[k], work)
        singular = is_singular(work)
        free[k] = _free_where_singular(chain, T, q[k], EVERY_JOINT, True) if singular else 0
        lonely = lonely or (singular and free[k] == 0)
    return count, lonely


def finish_all(chain, T, within_limits, rows, count, trial, work):
    """Certify candidates, merge what is one, and find the free joints; how many are left."""
    _, residual, branch, free = rows
    for k in range(count):
        residual[k], branch[k], free[k] = -1.0, -1, 0
    count = finish_pose(chain, T, False, *rows, count, work)
    count, _ = merge_families(chain, T, rows, count, trial, work)
    return turn_inside(chain, T, True, *rows, count) if within_limits else count


def finish_families(chain, T, rest, within_limits, rows, count, trial, work):
    """Merge solutions and keep of each family the member at the rest values (n,), in the limits.

    How many, and whether one that is isolated is singular.
    """
    count, lonely = merge_families(chain, T, rows, count, trial, work)
    count = one_of_each_family(chain[1], rest, *rows, count)
    if within_limits:
        count = turn_inside(chain, T, True, *rows, count)
    return count, lonely


@entry()
def finish_batch(chain: AnyChain, Ts: Poses, within_limits: bool, outputs: Outputs):
    """Certify candidates q (m, kmax, n), the first ``count[i]`` of pose Ts[i], in place.

    The other arrays as in :class:`dh2urdf.ik.arm.solver.Solver`; branches become -1. Poses of which
    the count is negative are left to others.
    """
    q, residual, count, branch, free = outputs
    n = q.shape[2]
    work, trial = work_array(n), np.empty((2, n))
    for i in range(Ts.shape[0]):
        if count[i] < 0:
            continue
        rows = q[i], residual[i], branch[i], free[i]
        count[i] = finish_all(chain, Ts[i], within_limits, rows, count[i], trial, work)


def reverse_joints(q, free):
    """Reverse the joints of a configuration q (n,) in place; the mask of its free ones, too."""
    n, mask = q.shape[0], 0
    for j in range(n // 2):
        q[j], q[n - 1 - j] = q[n - 1 - j], q[j]
    for j in range(n):
        mask |= (free >> j & 1) << (n - 1 - j)
    return mask


@entry()
def turn_back(chain: AnyChain, Ts: Poses, within_limits: bool, outputs: Outputs):
    """Reverse the joints of solutions q (m, kmax, n), and certify them on the chain, in place.

    The reversed chain measures its position error at the other end.
    """
    q, residual, count, branch, free = outputs
    work = work_array(q.shape[2])
    for i in range(Ts.shape[0]):
        for k in range(count[i]):
            free[i, k] = reverse_joints(q[i, k], free[i, k])
            residual[i, k], branch[i, k] = -1.0, -1
        rows = q[i], residual[i], branch[i], free[i]
        count[i] = finish_pose(chain, Ts[i], within_limits, *rows, count[i], work)
