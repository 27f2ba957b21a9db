"""Along the self-motion of a redundant chain: the member nearest to a seed.

Solutions of one pose form curves (surfaces, with more joints to spare). On them the squared
distance ``|q - s|^2`` from a seed s is made smaller by steps along its gradient's projection,
``P (s - q)`` with ``P = 1 - J^+ J``, and each step is put back on the pose by Newton's method.
The length of a step follows Barzilai and Borwein (1988), which on a curve is the secant method.

A solution outside the limits is brought into them in the same way: each step is the one along the
curve that takes most off the joints' excess, in the sense of least squares.
"""

import math
from typing import Annotated

import numpy as np

from dh2urdf.kernels.certificate import ACCEPT, distance2, principal
from dh2urdf.kernels.newton import (
    STAYING,
    add_transposed,
    error_and_jacobian,
    make_damped,
    restore,
    solve_damped,
    substitute,
)
from dh2urdf.kernels.numbers import entry
from dh2urdf.kernels.shapes import AnyChain, Configuration, Floats, Goal, Integers, Sizes, Some

MOST_STEPS = 60
"""Steps along a self-motion; five to fifteen are usual."""

LONGEST = 0.25
"""Longest step of a joint [rad or m]: a curve is followed, not jumped across."""

ARRIVED = 1e-9
"""Projected distance [rad or m] at which a member is nearest; the distance itself is then known
to the square of this."""

INSIDE = 1e-9
"""How far inside a limit [rad or m] an excess is aimed at."""

HELD = 0.9 * ACCEPT
"""Residual of a member; that of a solution, less what another way of measuring makes of it."""

FEW_STEPS = 6
"""Steps of Newton's method from near a member; three are usual."""

SHORTEST = 1e-10
"""Part of a step below which there is no way on: a limit is in the way."""


def _project(chain, goal, q, seed, step, damped):
    """``P (seed - q)`` to step (n,); returns its length."""
    error_and_jacobian(chain, goal, q, damped)
    return _project_at(q, seed, step, damped)


def _project_at(q, seed, step, damped):
    """The same with the Jacobian at q in ``damped``."""
    J, work = damped
    step[:] = seed - q
    for a in range(6):
        work[a, 6] = 0.0
        for i in range(q.shape[0]):
            work[a, 6] += J[i, a] * step[i]
    solve_damped(damped, 0.0)
    add_transposed(damped, -1.0, step)
    return math.sqrt(dot(step, step))


def dot(v, w):
    """Scalar product."""
    total = 0.0
    for i in range(v.shape[0]):
        total += v[i] * w[i]
    return total


def way_to(joints, q, p, way):
    """``way = p - q`` (n,), angles in a half turn; its length."""
    for i in range(q.shape[0]):
        way[i] = p[i] - q[i] if joints[i, 0] != 0.0 else principal(p[i] - q[i])
    return math.sqrt(dot(way, way))


def largest(v):
    """Largest size of an entry."""
    size = 0.0
    for i in range(v.shape[0]):
        size = max(size, abs(v[i]))
    return size


def first_guess(guess, staying):
    """A direction that no family is at right angles to by its nature; joints of a mask stay."""
    some = 0
    for i in range(guess.shape[0]):
        guess[i] = 0.0
        if not staying >> i & 1:
            guess[i] = 1.0 + 0.1 * some
            some += 1


def settle(chain, goal, q, seed, length, scratch, damped):
    """Newton's method from near the member nearest to a seed, q (n,) in place; whether it arrives.

    A step goes back on the pose and along the self-motion, ``length`` times the projected distance
    at first and then as the secant method says; the last one only back on the pose.
    """
    work, step, last, move = damped[1], scratch[0], scratch[1], scratch[2]
    for k in range(FEW_STEPS):
        residual = error_and_jacobian(chain, goal, q, damped)
        ex, ey, ez = work[0, 6], work[1, 6], work[2, 6]
        eu, ev, ew = work[3, 6], work[4, 6], work[5, 6]
        size = _project_at(q, seed, step, damped)
        arrived = size <= ARRIVED and residual <= ARRIVED
        if k > 0 and not arrived:
            last -= step
            across, along = dot(move, move), dot(move, last)
            if not along > 0.1 * across:
                return False
            length = across / along
        if not length * size <= LONGEST:
            return False
        work[0, 6], work[1, 6], work[2, 6] = ex, ey, ez
        work[3, 6], work[4, 6], work[5, 6] = eu, ev, ew
        substitute(work)
        last[:] = step
        move[:] = 0.0 if arrived else length * step
        add_transposed(damped, 1.0, move)
        q += move
        if arrived:
            return True
    return False


def part_inside(joints, q, step, length):
    """Part of ``length`` that a straight step can go inside the limits."""
    part = length
    for i in range(q.shape[0]):
        way = part * step[i]
        if q[i] + way > joints[i, 2]:
            part = max(joints[i, 2] - q[i], 0.0) / step[i]
        elif q[i] + way < joints[i, 1]:
            part = min(joints[i, 1] - q[i], 0.0) / step[i]
    return part


def is_outside(joints, q):
    """Whether a joint is beyond its limits."""
    for i in range(q.shape[0]):
        if q[i] > joints[i, 2] or q[i] < joints[i, 1]:
            return True
    return False


def go_nearer(chain, goal, within_limits, least, held, q, seed, scratch, damped):
    """Move one solution q (n,) along its self-motion to where it is nearest to the seed.

    It stays where no step brings a part ``least`` of the distance. Residuals on the way are
    ``held`` at most; ``scratch`` (5, n).
    """
    step, trial, before, work = scratch[0], scratch[1], scratch[2], scratch[3]
    _, joints = chain
    gap2 = distance2(q, seed)
    length = 1.0
    for move in range(MOST_STEPS):
        size = _project(chain, goal, q, seed, step, damped)
        enough = least * math.sqrt(gap2)
        if not size > max(ARRIVED, enough):  # NaN where nothing can move
            break
        if move > 0:
            before -= step
            across, along = dot(scratch[4], scratch[4]), dot(scratch[4], before)
            length = across / along if along > 0.1 * across else 10.0
        before[:] = step
        length = min(length, LONGEST / largest(step))
        if within_limits:
            length = part_inside(joints, q, step, length)
        good = False
        while length * size > max(SHORTEST, enough) and not good:
            trial[:] = q + length * step
            good = restore(chain, goal, trial, work, damped) <= held
            good = good and distance2(trial, seed) < gap2
            good = good and not (within_limits and is_outside(joints, trial))
            length *= 0.5
        if not good:
            break
        scratch[4] = trial - q
        q[:] = trial
        gap2 = distance2(q, seed)


@entry()
def nearest_members(
    chain: AnyChain, goal: Goal, within_limits: bool, q: Some, seed: Configuration, residual: Sizes
):
    """Move solutions q (k, n) of one pose along their self-motions towards a seed (n,).

    In place, in the turns that they are in; their residuals (k,) go to ``residual``. With
    ``within_limits`` they stop at joint limits, and have to be inside.
    """
    n = q.shape[1]
    damped, scratch = make_damped(n), np.empty((5, n))
    for k in range(q.shape[0]):
        go_nearer(chain, goal, within_limits, 0.0, HELD, q[k], seed, scratch, damped)
        residual[k] = error_and_jacobian(chain, goal, q[k], damped)


def excess(joints, q, i):
    """How far joint i has to go to be inside its limits."""
    if q[i] > joints[i, 2]:
        return joints[i, 2] - INSIDE - q[i]
    if q[i] < joints[i, 1]:
        return joints[i, 1] + INSIDE - q[i]
    return 0.0


def tangent_near(chain, goal, q, guess, tangent, damped):
    """Unit vector along the self-motion of q, near the direction of a guess, (n,)."""
    guess += q
    size = _project(chain, goal, q, guess, tangent, damped)
    guess -= q
    tangent /= max(size, 1e-300)
    return size > 1e-6


def enter(chain, goal, q, scratch, damped):
    """Move one solution q (n,) along its curve into the limits; whether it arrives."""
    (_, joints), last = chain, math.inf
    tangent, guess, work, trial = scratch[0], scratch[1], scratch[2], scratch[3]
    first_guess(guess, goal[0] // STAYING)
    for _ in range(MOST_STEPS):
        along, across, total = 0.0, 0.0, 0.0
        if not tangent_near(chain, goal, q, guess, tangent, damped):
            break
        guess[:] = tangent
        for i in range(q.shape[0]):
            way = excess(joints, q, i)
            if way != 0.0:
                along += way * tangent[i]
                across += tangent[i] * tangent[i]
                total += way * way
        if total == 0.0:
            return True
        if total >= last or across < 1e-12 or abs(along) <= 1e-3 * math.sqrt(total * across):
            break
        last = total
        step = min(max(along / across, -LONGEST), LONGEST)
        trial[:] = q + step * tangent
        if not restore(chain, goal, trial, work, damped) <= ACCEPT:
            break
        q[:] = trial
    return False


def enter_limits(chain, goal, q, entered):
    """Move solutions q (k, n) along their curves into the limits; one joint to spare.

    They are in the turns nearest to their limits. Where ``entered`` (k,) says that one is not
    inside, its row means nothing.
    """
    n = q.shape[1]
    damped, scratch = make_damped(n), np.empty((4, n))
    for k in range(q.shape[0]):
        entered[k] = enter(chain, goal, q[k], scratch, damped)


@entry()
def walk_family(
    chain: AnyChain,
    goal: Goal,
    length: float,
    q: Configuration,
    members: Annotated[Floats, 2, "members", "n"],
    counts: Annotated[Integers, 2],
):
    """Members (2, k, n) of the family through q (n,), by walking away from it both ways.

    Steps have a ``length`` [rad or m]; how many were found each way goes to ``counts`` (2,).
    """
    n, staying = q.shape[0], goal[0] // STAYING
    damped, scratch = make_damped(n), np.empty((3, n))
    tangent, guess, work = scratch[0], scratch[1], scratch[2]
    for way in range(2):
        counts[way] = 0
        at, side = q, 1.0 - 2.0 * way
        first_guess(guess, staying)
        guess *= side
        for k in range(members.shape[1]):
            if not tangent_near(chain, goal, at, guess, tangent, damped):
                break
            guess[:] = tangent
            members[way, k] = at + length * tangent
            at = members[way, k]
            if not restore(chain, goal, at, work, damped) <= HELD:
                break
            counts[way] = k + 1
