"""Poses in doubt: Newton's method on the exact chain from many starts, and beside what is found.

Where solutions meet or move freely, a polynomial says little of them, and seeds from it lead to
some of them only. There Levenberg's steps go to what is near, and plain steps along valleys: those
are solved by elimination with pivots, which keeps directions in which the pose hardly changes.
"""

import math

import numpy as np

from dh2urdf.kernels.certificate import CLUSTER, NO_JOINT, approach, null_direction, principal, same
from dh2urdf.kernels.newton import (
    MAX_TURN,
    POLISH,
    POSE,
    error_and_jacobian,
    make_damped,
    normal_equations,
    pose_residual,
    work_array,
)

SINGULAR = 1e-11
"""Smallest eigenvalue of J^T J, relative to the trace, below which others are looked for."""

NEAREST, FARTHER, WAYS = 4e-4, 2.5, 16
"""How far along that direction Newton's method starts [rad], the nearest and by which factor the
next, and how many, by turns either way. Of three solutions side by side it comes to the one in the
middle from within 0.45 of where the others are."""

STEPS, MORE = 15, 25
"""Newton steps; and how many more at a double root, to which each goes half of the way."""

HALVED, ENDED = 1e-6, 1e-12
"""Residual [m and rad] at which more are taken, and of a solution after the last of them."""

DAMPED = 50
"""Levenberg's steps from a start; most that lead anywhere take ten to twenty."""

STUCK = 12
"""Such steps without a better residual after which a start is given up."""

DONE = 1e-15
"""Residual [m and rad] at which nothing is left to gain."""

VALLEY, LATE = 1e-3, 16
"""Apart by this much [rad or m] points of valleys are new, where four solutions meet they come to
rest 1e-4 to either side; and most starts that are asked for one."""

SHARP, BESIDE = 4e-15, 100.0
"""Residual [m and rad] above which a solution may be beside a double one, and how far beside
[rad], in square roots of it."""

ALMOST = 1e-10
"""Residual [m and rad] at which no plain steps are needed."""

FEW = 24
"""Starts after which a pose is given up that none of them came near to."""

HARDLY, PATIENCE = 1e-5, 8
"""Residual [m and rad] to which starts came without a solution, as an arm that hardly moves in some
directions does, and then how many times as many steps they may take."""

NEAR = 0.05
"""Residual [m and rad] from which on plain steps are tried."""


def make_room():
    """Scratch for a search: four configurations, six equations, least squares, a `work_array`."""
    return (
        np.empty(6),
        np.empty(6),
        np.empty(6),
        np.empty(6),
        np.empty((6, 7)),
        make_damped(6),
        work_array(6),
    )


def _solve(A, step):
    """Solve six equations, the rows of A (6, 7), by elimination with pivots; the longest entry.

    Not by the normal equations, which lose directions in which the pose changes by 1e-9 or less.
    """
    for c in range(6):
        best = c
        for r in range(c + 1, 6):
            best = r if abs(A[r, c]) > abs(A[best, c]) else best
        for k in range(c, 7):
            A[c, k], A[best, k] = A[best, k], A[c, k]
        if A[c, c] == 0.0:
            return math.inf
        for r in range(6):
            factor = A[r, c] / A[c, c] if r != c else 0.0
            A[r] -= factor * A[c]
    longest = 0.0
    for c in range(6):
        if A[c, c] == 0.0:  # what was left of an entry, times next to infinity, took the pivot
            return math.inf
        step[c] = A[c, 6] / A[c, c]
        longest = max(longest, abs(step[c]))
    return longest


def _converges(chain, T, q, ended, A, step, damped):
    """Newton's method from q (6,) in place, downhill or not; whether it ends at a solution.

    ``ended`` is the largest residual of one.
    """
    _, joints = chain
    for k in range(STEPS + MORE):
        residual = error_and_jacobian(chain, (POSE, T, 1.0), q, damped)
        if k >= STEPS and (residual <= POLISH or residual > HALVED):
            break
        for r in range(6):
            A[r, 6] = damped[1][r, 6]
            for j in range(6):
                A[r, j] = damped[0][j, r]
        longest = _solve(A, step)
        if not longest < math.inf:
            return False
        scale = min(1.0, MAX_TURN / max(longest, MAX_TURN))
        q += step * scale
    for j in range(6):
        q[j] = q[j] if joints[j, 0] != 0.0 else principal(q[j])
    return pose_residual(chain, T, q) <= ended


def _is_new(chain, T, q, count, p, reach):
    """Whether p (6,) is none of the first rows of q (kmax, 6), at the accuracy of its residual.

    ``reach`` is the least that joints of another one are off.
    """
    _, joints = chain
    residual = pose_residual(chain, T, p)
    if residual > SHARP:
        reach = max(reach, BESIDE * math.sqrt(residual))
    for k in range(count):
        if same(joints, q[k], p, reach, NO_JOINT):
            return False
    return True


def _add_if_new(chain, T, q, count, trial, A, step, damped):
    """Append what Newton's method leads to from trial (6,), if it is new; the new count."""
    if not _converges(chain, T, trial, ENDED, A, step, damped):
        return count
    if count < q.shape[0] and _is_new(chain, T, q, count, trial, CLUSTER):
        q[count] = trial
        return count + 1
    return count


def search_beside(chain, T, q, count, room):
    """Append to q (kmax, 6) what lies beside nearly singular ones of so many; the new count."""
    trial, _, _, step, A, damped, work = room
    known = count
    for k in range(known):
        normal_equations(chain, T, q[k], work)
        if null_direction(work) > SINGULAR:
            continue
        way = NEAREST
        for w in range(WAYS):
            for j in range(6):
                trial[j] = q[k, j] + way * work[j, 6]
            count = _add_if_new(chain, T, q, count, trial, A, step, damped)
            way = -way if w % 2 == 0 else -FARTHER * way
    return count


def _try_starts(chain, goal, starts, patience, q, count, room):
    """Append to q (kmax, 6) what starts (s, 6) lead to; the new count, the least residual seen.

    Plain steps may go to and fro where the pose changes by less than rounding along a valley, by
    so much that they bend off it. Levenberg's go back across, to a point of the valley: from such
    starts at last.
    """
    (trial, best, dq, step, A, damped, _), least = room, math.inf
    most = patience * DAMPED, patience * STUCK, POLISH, DONE
    ended = ENDED if patience == 1 else ALMOST
    late, waiting, first = np.empty(LATE, np.int64), 0, starts.shape[0]
    for k in range(first + LATE):
        again = k >= first
        if (again and k - first >= waiting) or (k == FEW and least > NEAR and count == 0):
            break
        s = late[k - first] if again else k
        trial[:] = starts[s]
        residual = approach(chain, goal, most, trial, best, dq, damped)
        least = min(least, residual)
        found = residual <= ALMOST
        if not found and residual <= NEAR:
            found = _converges(chain, goal[1], trial, ended, A, step, damped)
            hovers = not found and pose_residual(chain, goal[1], trial) <= HALVED
            if hovers and again:
                found = approach(chain, goal, most, trial, best, dq, damped) <= ended
            elif hovers and waiting < LATE:
                late[waiting] = s
                waiting += 1
        reach = VALLEY if again else CLUSTER
        if found and count < q.shape[0] and _is_new(chain, goal[1], q, count, trial, reach):
            q[count] = trial
            count += 1
    return count, least


def search_from(chain, goal, starts, q, count, room):
    """Append to q (kmax, 6) what Newton's method finds from starts (s, 6); the new count."""
    count, least = _try_starts(chain, goal, starts, 1, q, count, room)
    if count == 0 and least <= HARDLY:
        count, _ = _try_starts(chain, goal, starts, PATIENCE, q, count, room)
    return count
