"""Along a valley: all solutions of a pose that lie where one motion hardly moves the tool.

Where a Jacobian has one small singular value, solutions lie on a curve along which five of the six
errors vanish and the last is small: the curve is walked, both ways, and where the error has a
least size Newton's method decides. Rounded angles make such curves of singular families, of which
a few points are left; equations that are solved one after the other lose these to rounding.
"""

import math
from typing import Annotated

import numpy as np

from dh2urdf.kernels.certificate.certify import is_known, principal, same
from dh2urdf.kernels.certificate.directions import add_step, look
from dh2urdf.kernels.newton import POSE, make_damped, pose_residual
from dh2urdf.kernels.numbers import entry
from dh2urdf.kernels.shapes import AnyChain, Counts, Floats, Poses, Solutions

WEAK = 1e-4
"""Singular value, relative to the largest, of a valley's direction."""

STEEP = 0.1
"""The same, where a valley ends."""

ROUGH = 1e-2
"""Error [rad, or in sizes of the arm] at which a seed is beside no valley."""

ON_IT = 1e-12
"""Error across a valley at which a point is on it."""

STEP, MOST_STEPS = 0.1, 160
"""Step along a valley [rad, or in sizes of the arm], and how many each way."""

MOST_POINTS = 8 * MOST_STEPS
"""Points of valleys of a pose that are remembered."""

HALVINGS, NEWTON = 40, 12
"""Most steps by which a least error is brought to its place, and of Newton's method then."""

SHARP = 1e-12
"""Residual [m and rad] of a solution."""

LEFT = 1e-11
"""Error at which a family has been left, along which nothing is to be looked for."""


def _settle(chain, goal, q, room):
    """Bring q across onto the valley: the error left, its smallest and largest singular value.

    The error is infinite where there is no valley.
    """
    left, weak, largest = math.inf, 0, 1.0
    for _ in range(8):
        weak, largest = look(chain, goal, q, room)
        floor = max(WEAK * largest, room[2][weak])
        longest, taken, left = add_step(chain, goal[2], q, room, floor, STEP)
        if taken <= ON_IT or not longest < math.inf:
            break
    if not taken <= 1e3 * ON_IT:
        return math.inf, weak, largest
    return left, weak, largest


def _ahead(room, weak, largest, way):
    """Turn the direction ``way`` (n,) into the valley's, at the point that was last looked at."""
    V, sigma, n = room[1], room[2], way.shape[0]
    along = room[3]
    along[:] = 0.0
    size = 0.0
    for k in range(n):
        if k == weak or sigma[k] <= WEAK * largest:
            part = 0.0
            for i in range(n):
                part += V[k, i] * way[i]
            along += part * V[k]
            size += part * part
    if size < 1e-6:
        return False
    way[:] = along / math.sqrt(size)
    return True


def _go(goal, joints, q, way, length, target):
    """``target = q + length way``, slides in sizes of the arm."""
    for i in range(q.shape[0]):
        target[i] = q[i] + length * way[i] * (goal[2] if joints[i, 0] != 0.0 else 1.0)


def _emit(chain, goal, q, room, found, count):
    """Newton's method from q (n,), by all directions; append a new solution; the new count."""
    _, joints = chain
    best, kept = math.inf, room[4][0]
    for _ in range(NEWTON):
        residual = pose_residual(chain, goal[1], q)
        if residual < best:
            best = residual
            kept[:] = q
        if residual <= 1e-14:
            break
        _, largest = look(chain, goal, q, room)
        add_step(chain, goal[2], q, room, 1e-13 * largest, 0.5 * STEP)
    if not best <= SHARP or count >= found.shape[0]:
        return count
    for i in range(q.shape[0]):
        kept[i] = kept[i] if joints[i, 0] != 0.0 else principal(kept[i])
    if is_known(joints, found, count, kept):
        return count
    found[count] = kept
    return count + 1


def _least(chain, goal, q, way, room, trial, middle):
    """Move q (n,) along the valley, by halved steps, to where the error is least nearby."""
    joints, step = chain[1], STEP
    middle[:] = q
    best, _, _ = _settle(chain, goal, middle, room)
    for _ in range(HALVINGS):
        step *= 0.5
        for side in range(2):
            _go(goal, joints, middle, way, step if side == 0 else -step, trial)
            left, _, _ = _settle(chain, goal, trial, room)
            if left < best:
                best = left
                middle[:] = trial
        if best <= ON_IT or step < 1e-9:
            break
    q[:] = middle


def _walk(chain, goal, start, side, room, trail, passed, found, count):
    """Walk from a point of a valley one way; the new numbers of points passed and of solutions."""
    joints, points = chain[1], room[4]
    q, trial, way, before, least = points[1], points[2], points[3], points[4], points[5]
    q[:] = start
    left, weak, largest = _settle(chain, goal, q, room)
    if room[2][weak] > WEAK * largest or not left <= ROUGH:
        return passed, count
    way[:] = side * room[1][weak]
    away, falling = left > LEFT, False
    for k in range(MOST_STEPS):
        before[:] = q
        last = left
        _go(goal, joints, before, way, STEP, q)
        left, weak, largest = _settle(chain, goal, q, room)
        ahead = left <= ROUGH and _ahead(room, weak, largest, way)
        away = away or (left > LEFT and left < math.inf)
        if away and left >= last and (falling or k == 0):
            least[:] = before
            _least(chain, goal, least, way, room, trial, points[6])
            count = _emit(chain, goal, least, room, found, count)
            away = last > LEFT
        falling = left < last
        if not ahead or room[2][weak] > STEEP * largest:
            break
        if passed < trail.shape[0]:
            trail[passed] = q
            passed += 1
        if k > 3 and same(joints, q, start, 0.6 * STEP, 0):
            break
    return passed, count


def follow_valleys(chain, goal, seeds, many, trail, q, count):
    """Append to q (K, n) the solutions that valleys lead to; the new count.

    The valleys are those beside the first ``many`` seeds (s, n). ``trail`` (``MOST_POINTS``, n) is
    scratch.
    """
    joints, n, passed = chain[1], q.shape[1], 0
    room = make_damped(n), np.empty((n, n)), np.empty(n), np.empty(n), np.empty((7, n))
    start = np.empty(n)
    for s in range(many):
        start[:] = seeds[s]
        known = False
        for k in range(passed):
            known = known or same(joints, trail[k], start, 0.6 * STEP, 0)
        if known:
            continue
        left, weak, largest = _settle(chain, goal, start, room)
        if not left <= ROUGH or room[2][weak] > WEAK * largest:
            continue
        room[4][1] = start
        count = _emit(chain, goal, room[4][1], room, q, count)
        for side in range(2):
            way = 1.0 - 2.0 * side
            passed, count = _walk(chain, goal, start, way, room, trail, passed, q, count)
    return count


@entry()
def search_valleys(
    chain: AnyChain,
    unit: float,
    Ts: Poses,
    seeds: Annotated[Floats, "poses", "seeds", "n"],
    many: Counts,
    q: Solutions,
    count: Counts,
):
    """Append to q (m, K, n) the solutions of poses Ts (m, 4, 4) that valleys lead to.

    The valleys are those beside the first ``many[i]`` seeds (m, s, n) of a pose.
    """
    trail = np.empty((MOST_POINTS, q.shape[2]))
    for i in range(Ts.shape[0]):
        goal = POSE, Ts[i], unit
        count[i] = follow_valleys(chain, goal, seeds[i], many[i], trail, q[i], count[i])
