"""Where curves of solutions come nearest to a seed: from values of a joint, then exactly.

From one value of a held joint to the next, solutions of one branch lie on one curve, unless a joint
jumps. Where that is nearest to the seed, or least outside the limits, is between the neighbours of
a value at which it is nearer than at both, or just beyond the last value that it reaches. Between
three values the curve is close to a parabola.
"""

import math
from typing import Annotated

import numpy as np

from dh2urdf.kernels.certificate import TWO_PI, distance2, principal, turn_by
from dh2urdf.kernels.newton import make_damped
from dh2urdf.kernels.numbers import entry
from dh2urdf.kernels.redundant.nearest import Starts, is_alike, keep
from dh2urdf.kernels.redundant.self_motion import enter, is_outside, settle
from dh2urdf.kernels.redundant.sweeps import step_between
from dh2urdf.kernels.shapes import Chain, Configuration, Goal, Integers, Outputs

MOST_STARTS = 16
"""Places from which curves are followed towards a seed, and as many into the limits, the nearest
ones; each is the nearest of its part of a curve."""

JUMP = 0.5
"""Motion of a joint [rad or m] between two values above which they are not taken for one curve."""

FAR = 1.5
"""Excess over a limit [rad or m] from which a solution is not followed inwards."""

ASIDE, BEYOND = 2.0, 6.0
"""By how many steps from value to value an excess may fall between two values, and beyond the last
value of a curve: there and back on the other branch, on a parabola, it is less than five."""


@entry()
def find_starts(
    chain: Chain,
    goal: Goal,
    slack: float,
    within_limits: bool,
    seed: Configuration,
    ends: Annotated[Integers, "sweeps"],
    outputs: Outputs,
    starts: Starts,
):
    """Where solutions at the values of some sweeps come near to a seed (n,), to ``starts``.

    Those of a sweep are the rows from one of the ``ends`` to the next; where that is negative, its
    values are no whole turn. They are turned to the seed in place; a branch of -1 is on no curve
    that is known. ``slack``: excess over a limit [rad or m] that is rounding of a full turn.
    """
    (_, joints), (q, size, count, _, _) = chain, outputs
    inner, distance, outer, measure, _, counts = starts
    most, n, first, found = q.shape[1], q.shape[2], 0, 0
    trial, room = np.empty(n), (np.empty((5, n)), make_damped(n))
    rows, sizes = np.empty((MOST_STARTS, 3), np.int64), np.empty(MOST_STARTS)
    for i in range(q.shape[0]):
        for k in range(count[i]):
            turn_by(joints, within_limits, slack, seed, q[i, k])
            size[i, k] = _size(joints, slack, within_limits, q[i, k], seed)
    counts[0], counts[1] = 0, 0
    for sweep in range(ends.shape[0]):
        last = abs(ends[sweep]) - 1
        for i in range(first, last + 1):
            before, after = i - 1, i + 1
            if i == first:
                before = last if ends[sweep] > 0 else -1
            if i == last:
                after = first if ends[sweep] > 0 else -1
            for k in range(count[i]):
                here = i * most + k
                left = _linked(joints, outputs, here, before)
                right = _linked(joints, outputs, here, after)
                if not (_is_least(size, here, left) and _is_least(size, here, right)):
                    continue
                if size[i, k] < 0.0:
                    found = _note(rows, sizes, found, here, left, right, size[i, k])
                elif size[i, k] <= _most_excess(joints, q, here, left, right):
                    trial[:] = q[i, k]
                    far = _distance_inside(joints, trial, seed)
                    counts[1] = keep(outer, measure, counts[1], trial, far)
                    if _to_least_excess(joints, trial):
                        far = _distance_inside(joints, trial, seed)
                        counts[1] = keep(outer, measure, counts[1], trial, far)
        first = last + 1
    for k in range(found):
        here = rows[k, 0]
        trial[:] = q[here // most, here % most]
        _towards(chain, goal, within_limits, seed, outputs, rows[k], trial, room)
        counts[0] = keep(inner, distance, counts[0], trial, distance2(trial, seed))


def _note(rows, sizes, count, here, left, right, size):
    """Put a row and its neighbours among the rows (k, 3), ascending by size; how many then."""
    most = sizes.shape[0]
    if count == most and not size < sizes[most - 1]:
        return count
    place = min(count, most - 1)
    while place > 0 and size < sizes[place - 1]:
        rows[place], sizes[place] = rows[place - 1], sizes[place - 1]
        place -= 1
    rows[place, 0], rows[place, 1], rows[place, 2], sizes[place] = here, left, right, size
    return min(count + 1, most)


def _size(joints, slack, within_limits, q, seed):
    """By what solutions on a curve are compared: less for a nearer one, below 0 inside limits."""
    out = 0.0
    for i in range(q.shape[0] if within_limits else 0):
        out = max(out, _excess(joints, q, i))
    return -1.0 / (1.0 + distance2(q, seed)) if out <= slack else out


def _row_of(branch, count, code):
    """The row of a branch among the solutions at a value; -1: it has none."""
    for k in range(count):
        if branch[k] == code:
            return k
    return -1


def _linked(joints, outputs, here, j):
    """What is next on the curve towards value j; -1: it is not known.

    ``here`` and what is returned count rows of all values. Where the branch has ended it is a row
    of the same value: two branches meet at a rim.
    """
    q, size, count, branch, _ = outputs
    most = q.shape[1]
    i, k = here // most, here % most
    if j < 0 or branch[i, k] < 0 or (count[j] > 0 and branch[j, 0] < 0):
        return -1
    row = _row_of(branch[j], count[j], branch[i, k])
    if row >= 0:
        return j * most + row if _is_near(joints, size, q, i, k, j, row) else -1
    partner, least = -1, JUMP
    for r in range(count[i]):
        if r != k and branch[i, r] >= 0 and _row_of(branch[j], count[j], branch[i, r]) < 0:
            step = step_between(joints, q[i, k], q[i, r])
            if step < least and _is_near(joints, size, q, i, k, i, r):
                partner, least = i * most + r, step
    return partner


def _is_near(joints, size, q, i, k, j, r):
    """Whether no joint jumps between two rows; a full turn is none outside the limits.

    Inside, distances are those of the turn.
    """
    if size[i, k] < 0.0 and size[j, r] < 0.0:
        return is_alike(q[i, k], q[j, r], JUMP)
    return step_between(joints, q[i, k], q[j, r]) <= JUMP


def _is_least(size, here, other):
    """Whether a row is less than another one, if there is one; of two that are equal the first."""
    most = size.shape[1]
    mine = size[here // most, here % most]
    if other < 0:
        return True
    its = size[other // most, other % most]
    return mine < its or (mine == its and here < other)


def _towards(chain, goal, within_limits, seed, outputs, rows, q, room):
    """Bring q (n,), a solution inside the limits, to the member nearest to the seed, if it can.

    ``rows``: its own, and those of its neighbours on the curve. The member is between them, or
    where one that is outside has come into the limits.
    """
    (_, joints), (whole, size, _, _, _) = chain, outputs
    (scratch, damped), most, left, right = room, size.shape[1], rows[1], rows[2]
    trial, before = scratch[4], distance2(q, seed)
    fits, i, k = False, left // most, left % most
    j, r = right // most, right % most
    if left >= 0 and right >= 0 and size[i, k] < 0.0 and size[j, r] < 0.0:
        length = _go_between(joints, whole[i, k], q, whole[j, r], seed, trial)
        fits = settle(chain, goal, trial, seed, length, scratch, damped)
    elif within_limits:
        for side in range(2):
            other = left if side == 0 else right
            if fits or other < 0 or size[other // most, other % most] < 0.0:
                continue
            for m in range(q.shape[0]):
                trial[m] = q[m] + _way(joints, m, q[m], whole[other // most, other % most, m])
            if distance2(trial, seed) < before:
                fits = enter(chain, goal, trial, scratch, damped)
    fits = fits and not (within_limits and is_outside(joints, trial))
    if fits and distance2(trial, seed) <= before:
        q[:] = trial


def _go_between(joints, a, b, c, seed, q):
    """Where the parabola through a, b and c, configurations (n,), is nearest to the seed, to q.

    Its parameter is the length of the chords. Returns by how much more than the projected distance
    the way is to there, see :func:`settle`.
    """
    left, here, right, back, on = 0.0, distance2(b, seed), 0.0, 0.0, 0.0
    for i in range(b.shape[0]):
        before, after = _way(joints, i, b[i], a[i]), _way(joints, i, b[i], c[i])
        gap = b[i] - seed[i]
        left += (gap + before) * (gap + before)
        right += (gap + after) * (gap + after)
        back += before * before
        on += after * after
    back, on = max(math.sqrt(back), 1e-12), max(math.sqrt(on), 1e-12)
    slope_left, slope_right = (left - here) / back, (right - here) / on
    bend = max((slope_left + slope_right) / (back + on), 0.05)
    t = 0.5 * ((slope_left * on - slope_right * back) / (back + on)) / bend
    t = min(max(t, -back), on)
    for i in range(b.shape[0]):
        before, after = _way(joints, i, b[i], a[i]) / back, _way(joints, i, b[i], c[i]) / on
        curve = (before + after) / (back + on)
        q[i] = b[i] + t * (after - curve * on + curve * t)
    return 1.0 / bend


def _way(joints, i, a, b):
    """The way of joint i from a to b, without full turns."""
    return b - a if joints[i, 0] != 0.0 else principal(b - a)


def _most_excess(joints, q, here, left, right):
    """Largest excess over limits of a row from which its curve may get inside between values."""
    most, step = q.shape[1], 0.0
    for side in range(2):
        other = left if side == 0 else right
        if other >= 0:
            a, b = q[here // most, here % most], q[other // most, other % most]
            step = max(step, step_between(joints, a, b))
    if left >= 0 and right >= 0:
        return min(ASIDE * step, FAR)
    return min(BEYOND * step, FAR) if left >= 0 or right >= 0 else FAR


def _excess(joints, q, i):
    """By how much joint i is outside its limits, in the turn in which it is least."""
    out = max(q[i] - joints[i, 2], joints[i, 1] - q[i])
    if out <= 0.0 or joints[i, 0] != 0.0:
        return max(out, 0.0)
    other = q[i] - TWO_PI if q[i] > joints[i, 2] else q[i] + TWO_PI
    return min(out, max(other - joints[i, 2], joints[i, 1] - other, 0.0))


def _to_least_excess(joints, q):
    """Bring each joint of q (n,) into the turn of least excess; whether one was in another."""
    turned = False
    for i in range(q.shape[0]):
        out = max(q[i] - joints[i, 2], joints[i, 1] - q[i])
        if out > 0.0 and _excess(joints, q, i) < out:
            q[i] += -TWO_PI if q[i] > joints[i, 2] else TWO_PI
            turned = True
    return turned


def _distance_inside(joints, q, seed):
    """How far q (n,) is from the limits, and from the seed when it is there."""
    out, square = 0.0, 0.0
    for i in range(q.shape[0]):
        inside = min(max(q[i], joints[i, 1]), joints[i, 2])
        out = max(out, abs(q[i] - inside))
        square += (inside - seed[i]) * (inside - seed[i])
    return math.sqrt(square) + 2.0 * out
