"""All curves of solutions of a chain with one joint to spare: found from many starts, told apart.

Each curve is walked once, and what a start leads to is compared with the points of these walks: by
a step along the curve from the nearest ones, which ends at the configuration or beside it.
"""

import math
from typing import Annotated

import numpy as np

from dh2urdf.kernels.certificate import ACCEPT, NO_JOINT, add_step, look
from dh2urdf.kernels.newton import error_and_jacobian, make_damped, restore
from dh2urdf.kernels.numbers import entry
from dh2urdf.kernels.redundant.self_motion import HELD, dot, first_guess, tangent_near, way_to
from dh2urdf.kernels.shapes import AnyChain, Counts, Floats, Poses, Solutions
from dh2urdf.kernels.short_chains import come_near

STEP, MOST_STEPS = 0.15, 500
"""Step along a curve [rad or m], and how many each way."""

SHORTER = (1.0, 0.1, 0.01)
"""Parts of it by which a walk is tried: where an arm can hardly move, its curves are short."""

POINTS = 4096
"""Most points of all walks of a pose."""

SAME, MOST_FEET = 1e-3, 6
"""Distance [rad or m] of a configuration that is on a curve, and most steps to find its foot."""

NEAR = 0.02
"""Residual [m and rad] of what comes near a pose."""

DONE, DULL = 1e-15, 1e-13
"""Residual [m and rad] at which nothing is left to gain, and from which on something is."""

LAST_STEPS, NOTHING = 40, 1e-12
"""Newton's steps to a solution in a valley, where they halve the distance, and the singular value,
relative to the largest, of a direction in which they have nothing to say."""

FEW = 16
"""Starts after which a pose is given up that nothing came near to."""

AWAY = 8.0
"""How far a slide is followed, in sizes of the arm."""


def _is_on(chain, goal, trail, passed, q, scratch, damped):
    """Whether q (n,) is on a curve of which points are known."""
    joints, way, tangent, at, work = chain[1], scratch[0], scratch[1], scratch[2], scratch[3]
    for k in range(passed):
        far = way_to(joints, trail[k], q, way)
        if far > STEP:
            continue
        at[:] = trail[k]
        for _ in range(MOST_FEET):
            if far <= SAME:
                return True
            if not tangent_near(chain, goal, at, way, tangent, damped):
                break
            at += dot(way, tangent) * tangent
            if not restore(chain, goal, at, work, damped) <= ACCEPT:
                break
            before = far
            far = way_to(joints, at, q, way)
            if far > 0.5 * before:
                break
    return False


def _out_of_valley(chain, goal, q, room):
    """Newton's method from q (n,) in place, by all directions; the residual."""
    for _ in range(LAST_STEPS):
        if error_and_jacobian(chain, goal, q, room[0]) <= DONE:
            break
        _, largest = look(chain, goal, q, room)
        add_step(chain, goal[2], q, room, NOTHING * largest, STEP)
    return error_and_jacobian(chain, goal, q, room[0])


def _sharpen(chain, goal, q, room, trial):
    """Bring q (n,) nearer to a solution, if that is a double root all along; the residual."""
    residual = error_and_jacobian(chain, goal, q, room[0])
    if residual <= DULL:
        return residual
    trial[:] = q
    after = _out_of_valley(chain, goal, trial, room)
    if not after < residual:
        return residual
    q[:] = trial
    return after


def _walk(chain, goal, start, trail, passed, scratch, damped):
    """Add the points of the curve through a solution (n,) to the trail; how many there are then."""
    if passed >= trail.shape[0]:
        return passed
    trail[passed] = start
    passed += 1
    for part in range(len(SHORTER)):
        after = _walk_by(chain, goal, start, SHORTER[part] * STEP, trail, passed, scratch, damped)
        if after > passed:
            return after
    return passed


def _walk_by(chain, goal, start, step, trail, passed, scratch, damped):
    """The same by steps of a length, without the start."""
    joints, n = chain[1], start.shape[0]
    guess, tangent, at, work = scratch[0], scratch[1], scratch[2], scratch[3]
    closed = False
    for side in range(2):
        if closed:
            break
        at[:] = start
        first_guess(guess, NO_JOINT)
        for i in range(n):
            guess[i] *= 1.0 - 2.0 * side
        for k in range(MOST_STEPS):
            if passed >= trail.shape[0]:
                break
            if not tangent_near(chain, goal, at, guess, tangent, damped):
                break
            guess[:] = tangent
            at += step * tangent
            if not restore(chain, goal, at, work, damped) <= HELD:
                break
            trail[passed] = at
            passed += 1
            away = way_to(joints, start, at, work)
            closed = k > 3 and away <= 0.6 * step
            if closed or away > AWAY * max(goal[2], 1.0):
                break
    return passed


@entry()
def add_curves(
    chain: AnyChain,
    task: int,
    unit: float,
    patience: int,
    Ts: Poses,
    starts: Annotated[Floats, "starts", "n"],
    q: Solutions,
    count: Counts,
    least: Annotated[Floats, "poses"],
):
    """Append to q (m, K, n) a member of each curve of solutions of poses Ts (m, 4, 4) without one.

    The first ``count[i]`` are known. ``unit`` is the size of the arm [m]; how near the starts
    (s, n) come to a pose, in ``patience`` times as many steps as usual, goes to ``least`` (m,).
    """
    n = starts.shape[1]
    damped, scratch, trail = make_damped(n), np.empty((4, n)), np.empty((POINTS, n))
    trial, best, dq = np.empty(n), np.empty(n), np.empty(n)
    room = damped, np.empty((n, n)), np.empty(n), np.empty(n)
    for i in range(Ts.shape[0]):
        goal, passed, least[i] = (task, Ts[i], unit), 0, 0.0 if count[i] > 0 else math.inf
        for k in range(count[i]):
            _sharpen(chain, goal, q[i, k], room, trial)
            trial[:] = q[i, k]
            if not _is_on(chain, goal, trail, passed, trial, scratch, damped):
                passed = _walk(chain, goal, q[i, k], trail, passed, scratch, damped)
        for s in range(starts.shape[0]):
            if count[i] >= q.shape[1] or (s == FEW and least[i] > NEAR):
                break
            trial[:] = starts[s]
            residual = come_near(chain, goal, patience, trial, best, dq, damped)
            least[i] = min(least[i], residual)
            if DULL < residual <= NEAR:
                residual = _sharpen(chain, goal, trial, room, best)
            if not residual <= ACCEPT:
                continue
            if not restore(chain, goal, trial, dq, damped) <= HELD:
                continue
            if _is_on(chain, goal, trail, passed, trial, scratch, damped):
                continue
            q[i, count[i]] = trial
            passed = _walk(chain, goal, q[i, count[i]], trail, passed, scratch, damped)
            count[i] += 1
