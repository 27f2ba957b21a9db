"""All configurations of a chain of one to five joints that reach a pose.

Candidates come from the closed loop (:mod:`dh2urdf.kernels.short_chains.loop`), solutions from the
exact chain; of a singular family the one stays whose first free joint is at rest.
"""

from typing import Annotated, NamedTuple

import numpy as np

from dh2urdf.kernels.certificate import (
    NO_JOINT,
    copy_rows,
    finish_families,
    finish_pose,
    is_known,
    null_direction,
    same,
    turn_inside,
)
from dh2urdf.kernels.newton import normal_equations, polish, work_array
from dh2urdf.kernels.numbers import atan2, dual_conjugate, dual_of_pose, entry, sincos, trig_roots
from dh2urdf.kernels.rigid import joint_times_link, load_pose, store_pose
from dh2urdf.kernels.shapes import Chain, Floats, Integers, Outputs, Pose, Poses
from dh2urdf.kernels.short_chains.candidates import add_candidates
from dh2urdf.kernels.short_chains.loop import (
    SAMPLES,
    Loop,
    determinant_series,
    factor,
    loop_columns,
    loop_matrix,
    null_basis,
    vanishes,
)

FEW = 48
"""Room for the candidates of a pose."""

FUZZY = 1e-4
"""Pivot, relative to the first, below which a direction may belong to the null space: double
roots of the determinant are known to the square root of rounding."""

CLOSE = 1e-3
"""Distance of roots x [rad] that are one; if they are more than its null vectors, solutions may be
hidden. Arms whose poses have two null vectors at each root have roots that are double."""

FOLDED = 1e-11
"""Smallest eigenvalue of J^T J, relative to the trace, of an isolated solution beside which there
may be another one, as of a folded elbow: seeds of both may lead Newton's method to one of them."""

BESIDE, FARTHER, WAYS = 4e-4, 2.5, 8
"""How far along that direction Newton's method starts [rad or m], the nearest and by which factor
the next, and how many, by turns either way."""

ENDED, NEARBY = 1e-12, 0.05
"""Residual [m and rad] of a solution that it leads to, and how far that may be."""

ZERO = 1e-11
"""Determinant, relative to unit columns, that vanishes for every x within rounding."""


@entry()
def close_loop(ends: Annotated[Floats, 2, 4, 4], T: Pose, unit: float, pose: Pose, loop: Loop):
    """Write the last link of the loop, ``(L_0^-1 T L_n^-1)^-1``, to the last row of loop."""
    r = joint_times_link(load_pose(ends[0]), False, 0.0, T)
    store_pose(joint_times_link(r, False, 0.0, ends[1]), pose)
    last = loop[loop.shape[0] - 1]
    dual_of_pose(pose, unit, last)
    dual_conjugate(last, last)


def _from_matrix(columns, cut, x, scratch, order, q, count):
    """Append the candidates of the matrix at x, for each nullity that it may have.

    Returned are the rows of q in use and the largest nullity that was tried.
    """
    shape, used, joints, rest, unit = cut
    M, basis = scratch[0:8], scratch[8:14]
    size = loop_matrix(columns, used, x[0], x[1], M)
    factor(M, size, order)
    for i in range(size):
        order[i] = used[order[i]]
    tried = 0
    for nullity in range(1, min(4, size)):
        if abs(M[size - nullity, size - nullity]) > FUZZY * abs(M[0, 0]):
            break
        null_basis(M, size, order, nullity, basis)
        count = add_candidates(basis, nullity, shape, joints, x, rest, unit, q, count)
        tried = nullity
    return count, tried


def _close_ones(roots, found, k):
    """How many of the roots x, cosines and sines in rows 1 and 2, nearly coincide with number k."""
    close = 0
    for j in range(found):
        c, s = roots[1, k] - roots[1, j], roots[2, k] - roots[2, j]
        close += 1 if c * c + s * s < CLOSE * CLOSE else 0
    return close


def _candidates(loop, cut, scratch, order, roots, q, count):
    """Append all candidates that one cut of the loop gives.

    Returned are the rows of q in use, and a doubt: the pose is singular for this cut, or nearly,
    and another one may see more.
    """
    shape, used, joints, rest, unit = cut
    columns = scratch[17:29]
    loop_columns(loop, joints, shape, columns)
    x = shape[2]
    if x < 0:
        count, nullity = _from_matrix(columns, cut, (1.0, 0.0), scratch, order, q, count)
        return count, nullity > shape[7]
    series = roots[0]
    determinant_series(columns, used, scratch[0:8], order, series)
    doubt = vanishes(series, ZERO)
    if doubt:
        y = 2.0 * atan2(0.5 * rest[x] / unit, 1.0) if joints[x, 0] != 0.0 else rest[x]
        roots[2, 0], roots[1, 0] = sincos(y)
        found = 1
    else:
        found = trig_roots(series, 2, roots[1], roots[2])
    for k in range(found):
        v, u = sincos(0.5 * atan2(roots[2, k], roots[1, k]))
        count, nullity = _from_matrix(columns, cut, (u, v), scratch, order, q, count)
        doubt = doubt or nullity > shape[7] or _close_ones(roots, found, k) > max(nullity, 1)
    return count, doubt


def _add_beside(chain, T, rows, count, trial, work):
    """Append what lies beside isolated solutions that are nearly singular; the new count."""
    (q, residual, branch, free), (_, joints), known = rows, chain, count
    for k in range(known):
        normal_equations(chain, T, q[k], work)
        if free[k] != 0 or null_direction(work) > FOLDED:
            continue
        way = BESIDE
        for w in range(WAYS):
            for j in range(q.shape[1]):
                trial[1, j] = work[j, 6]
                trial[0, j] = q[k, j] + way * work[j, 6]
            ends = polish(chain, T, trial[0], work) <= ENDED
            for j in range(q.shape[1]):
                work[j, 6] = trial[1, j]
            way = -way if w % 2 == 0 else -FARTHER * way
            if not (ends and same(joints, q[k], trial[0], NEARBY, NO_JOINT)):
                continue
            if count < q.shape[0] and not is_known(joints, q, count, trial[0]):
                q[count] = trial[0]
                residual[count], branch[count], free[count] = -1.0, -1, 0
                count += 1
    return count


class ShortChain(NamedTuple):
    """Up to five joints, and how the loop that they close with the pose is cut."""

    chain: Chain
    ends: Annotated[Floats, 2, 4, 4]
    loop: Loop
    plan: Annotated[Integers, "cuts", 2, 8]
    rest_unit: Annotated[Floats, "n + 1"]


@entry(solutions=8)
def solve_short_chains(arm: ShortChain, Ts: Poses, within_limits: bool, outputs: Outputs):
    """Solve poses Ts (m, 4, 4) of a chain of n <= 5 joints.

    ``ends`` (2, 4, 4) are the inverses of the first and the last link, ``loop`` (n, 8) the dual
    quaternions of the links between the joints and a row for the last. ``plan`` (s, 2, 8) has the
    cuts of the loop, best first: its shape, see ``add_candidates``, and the nullity to expect; the
    slots that it has, -1 after the last. ``rest_unit`` (n + 1,): rest values, then the length of
    one dual unit [m].

    The count of a pose that is singular for every cut is -1 minus that of its solutions; returned
    is how many are.
    """
    chain, ends, loop, plan, rest_unit = arm
    _, joints = chain
    q, residual, count, branch, free = outputs
    n = joints.shape[0]
    work = work_array(n)
    closed, scratch, roots = np.empty((n, 8)), np.empty((29, 8)), np.empty((3, SAMPLES))
    closed[:] = loop
    pose, trial = np.empty((4, 4)), np.empty((2, n))
    order = np.empty(8, np.int64)
    many = np.empty((FEW, n)), np.empty(FEW), np.empty(FEW, np.int64), np.empty(FEW, np.int64)
    rest, unit = rest_unit[:n], rest_unit[n]
    doubts = 0
    for i in range(Ts.shape[0]):
        T = Ts[i]
        close_loop(ends, T, unit, pose, closed)
        found, doubt = 0, False
        for s in range(plan.shape[0]):
            before, cut = found, (plan[s, 0], plan[s, 1], joints, rest, unit)
            found, doubt = _candidates(closed, cut, scratch, order, roots, many[0], found)
            for k in range(before, found):
                many[1][k], many[2][k], many[3][k] = -1.0, -1, 0
            found = finish_pose(chain, T, False, *many, found, work)
            if not doubt:
                break
        found, lonely = finish_families(chain, T, rest, False, many, found, trial, work)
        more = _add_beside(chain, T, many, found, trial, work) if lonely else found
        if more > found:
            found = finish_pose(chain, T, False, *many, more, work)
            found, _ = finish_families(chain, T, rest, False, many, found, trial, work)
        if within_limits:
            found = turn_inside(chain, T, True, *many, found)
        count[i] = copy_rows(many, found, (q[i], residual[i], branch[i], free[i]))
        if doubt:
            count[i] = -1 - count[i]
            doubts += 1
    return doubts
