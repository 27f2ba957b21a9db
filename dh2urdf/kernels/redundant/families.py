"""Singular families whose representative is outside the limits: the member inside, if there is one.

Where joints are free, solutions form a curve (seldom a surface) in joint space. The representative
is moved along it towards the middle of the limits, by the joints that are free, also from where one
of these is a full turn to either side. If that ends outside, the curve is walked both ways, and the
members inside that are nearest to the middle are moved on. If none is inside, it may touch the
limits at a corner.
"""

import math

import numpy as np

from dh2urdf.kernels.certificate import TWO_PI, distance2, measure, move, turn_one
from dh2urdf.kernels.newton import STAYING, make_damped, restore
from dh2urdf.kernels.numbers import any_family, entry
from dh2urdf.kernels.redundant.self_motion import (
    ARRIVED,
    HELD,
    first_guess,
    go_nearer,
    tangent_near,
)
from dh2urdf.kernels.shapes import AnyChain, Configuration, Outputs, Poses

STEP, MOST_STEPS = 0.1, 200
"""Step of a walk [rad or m], and how many each way."""

STARTS = 8
"""Members inside the limits, nearest to the middle first, that are moved on towards it."""

SECANTS, TOUCHING = 12, 1e-6
"""Steps to where a joint turns back along a curve; how far inside its bound [rad or m] it does so
where the curve touches that: others are far enough apart for Newton's method on the bound."""


def _is_inside(joints, slack, q):
    """Whether a configuration q (n,) keeps all limits."""
    for i in range(q.shape[0]):
        if not joints[i, 1] - slack <= q[i] <= joints[i, 2] + slack:
            return False
    return True


def _excess(joints, q, i):
    """How far joint i of q (n,) is beyond its limits; negative inside."""
    return max(joints[i, 1] - q[i], q[i] - joints[i, 2])


def _farthest(joints, q):
    """The joint of q (n,) that is farthest beyond its limits."""
    far = 0
    for i in range(1, q.shape[0]):
        far = i if _excess(joints, q, i) > _excess(joints, q, far) else far
    return far


def _turn_back(chain, goal, far, q, room):
    """Go along a curve to where one joint turns back, q (n,) in place, by the secant method."""
    (_, _, rows, damped) = room
    tangent, guess, scratch, trial = rows[0], rows[1], rows[2], rows[3]
    first_guess(guess, goal[0] // STAYING)
    step, before = 0.1 * STEP, 0.0
    for k in range(SECANTS):
        if not tangent_near(chain, goal, q, guess, tangent, damped):
            return
        guess[:] = tangent
        change = tangent[far] - before
        if k > 0:
            step = -step * tangent[far] / change if change != 0.0 else 0.0
            step = min(max(step, -STEP), STEP)
        if abs(step) <= ARRIVED:
            return
        before = tangent[far]
        trial[:] = q + step * tangent
        if not restore(chain, goal, trial, scratch, damped) <= HELD:
            return
        q[:] = trial


def _touch(chain, goal, mask, slack, q, room):
    """Go along a curve to where it comes to the limits, and no farther, q (n,) in place.

    Whether it does. The joint that is farthest outside goes to where it turns back, or is put on
    its bound, and the others of the mask bring q back onto the curve; then the next one, if that is
    outside there.
    """
    (_, joints), (_, _, rows, damped) = chain, room
    (task, T, unit), start = goal, rows[4]
    for _ in range(q.shape[0]):
        far = _farthest(joints, q)
        if not mask >> far & 1:
            return False
        start[:] = q
        _turn_back(chain, goal, far, q, room)
        over = _excess(joints, q, far)
        if over < -TOUCHING or over > slack:
            q[:] = start
            q[far] = min(max(q[far], joints[far, 1]), joints[far, 2])
            held = task + STAYING * (1 << far), T, unit
            if not restore(chain, held, q, rows[0], damped) <= HELD:
                return False
        q[far] = min(max(q[far], joints[far, 1]), joints[far, 2])
        if _is_inside(joints, slack, q):
            return True
    return False


def _keep_nearest(starts, sizes, count, q, size):
    """Put q (n,) among the starts (k, n), ascending by their sizes; how many there are then."""
    most = starts.shape[0]
    if count == most and not size < sizes[most - 1]:
        return count
    place = min(count, most - 1)
    while place > 0 and size < sizes[place - 1]:
        starts[place], sizes[place] = starts[place - 1], sizes[place - 1]
        place -= 1
    starts[place], sizes[place] = q, size
    return min(count + 1, most)


def _walk_inside(chain, goal, mask, slack, centre, q, room):
    """Walk both ways from q (n,), and keep the nearest members inside the limits; how many.

    If there are none, the first of them is the one that is least outside.
    """
    starts, sizes, rows, damped = room
    at, tangent, guess, scratch, member = rows[0], rows[1], rows[2], rows[3], rows[4]
    starts[0] = q
    count, least = 0, math.inf
    for way in range(2):
        at[:] = q
        some = 0
        for i in range(q.shape[0]):
            guess[i] = 0.0
            if mask >> i & 1:
                guess[i] = (1.0 - 2.0 * way) * (1.0 + 0.1 * some)
                some += 1
        for _ in range(MOST_STEPS):
            if not tangent_near(chain, goal, at, guess, tangent, damped):
                break
            guess[:] = tangent
            at += STEP * tangent
            if not restore(chain, goal, at, scratch, damped) <= HELD:
                break
            member[:] = at
            turn_one(chain[1], slack, centre, member)
            if _is_inside(chain[1], slack, member):
                size = math.sqrt(distance2(member, centre))
                count = _keep_nearest(starts, sizes, count, member, size)
                continue
            far = _excess(chain[1], member, _farthest(chain[1], member))
            if count == 0 and far < least:
                least = far
                starts[0] = member
    return count


def _enter(chain, goal, mask, slack, centre, q, room):
    """Move q (n,) by the joints of a mask to the member inside the limits nearest to the centre.

    Whether there is one. The centre (n,) is moved to q by the other joints.
    """
    starts, _, rows, damped = room
    joints, best, n = chain[1], math.inf, q.shape[0]
    trial, start, scratch = rows[5], rows[6], rows[:5]
    turn_one(joints, slack, centre, q)
    for i in range(n):
        centre[i] = centre[i] if mask >> i & 1 else q[i]
    start[:] = q
    for trials in range(2 * n + 1):  # each joint a turn down, then none, then each a turn up
        turned = trials if trials <= n else 2 * n - trials
        if turned < n and (not mask >> turned & 1 or joints[turned, 0] != 0.0):
            continue
        trial[:] = start
        if turned < n:
            trial[turned] += TWO_PI if trials > n else -TWO_PI
        go_nearer(chain, goal, False, 0.0, HELD, trial, centre, scratch, damped)
        size = distance2(trial, centre)
        if _is_inside(joints, slack, trial) and size < best:
            best = size
            q[:] = trial
    if best < math.inf:
        return True
    count = _walk_inside(chain, goal, mask, slack, centre, start, room)
    if count == 0 and _touch(chain, goal, mask, slack, starts[0], room):
        count = 1
    for k in range(count):
        go_nearer(chain, goal, True, 0.0, HELD, starts[k], centre, scratch, damped)
        size = distance2(starts[k], centre)
        if size < best:
            best = size
            q[:] = starts[k]
    return best < math.inf


@entry()
def families_inside(
    chain: AnyChain,
    slack: float,
    task: int,
    unit: float,
    middle: Configuration,
    Ts: Poses,
    outputs: Outputs,
):
    """Bring solutions with free joints that are outside the limits into them, or leave them out.

    Of poses Ts (m, 4, 4), in place, to the members of their families nearest to the ``middle`` (n,)
    of the limits. Where a pose has a solution with free joints, all residuals are measured anew.
    ``unit`` is the size of the arm [m], ``slack`` that of :func:`.turn_to`.
    """
    (_, joints), (q, residual, counts, branch, free), n = chain, outputs, middle.shape[0]
    if not any_family(counts, free):
        return
    damped, centre = make_damped(n), np.empty(n)
    room = np.empty((STARTS, n)), np.empty(STARTS), np.empty((7, n)), damped
    every = (1 << n) - 1
    for i in range(Ts.shape[0]):
        singular = False
        for k in range(counts[i]):
            singular = singular or free[i, k] != 0
        kept = 0
        for k in range(counts[i] if singular else 0):
            mask = free[i, k]
            if mask != 0 and not _is_inside(joints, slack, q[i, k]):
                centre[:] = middle
                goal = task + STAYING * (every - mask), Ts[i], unit
                if not _enter(chain, goal, mask, slack, centre, q[i, k], room):
                    continue
            move(q[i], residual[i], branch[i], free[i], k, kept)
            residual[i, kept] = measure(chain, task, Ts[i], q[i, kept], damped)
            kept += 1
        counts[i] = kept if singular else counts[i]
