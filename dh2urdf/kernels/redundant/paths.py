"""Joint paths of a chain with one joint to spare: the next states, and the way made shorter.

A path is made shorter while every pose is kept. At each pose the solution q_i may move along its
self-motion, by x_i along its unit tangent t_i. Of the length ``sum |q_i - q_(i-1)|`` as a function
of the x the Hessian, but for the curvature of the self-motions, is positive and tridiagonal, as
each x is in two steps only: a Newton step costs a few operations a pose. Limits, and a region of
trust, bound each x; which bounds hold is found by the primal-dual active set method (Hintermueller,
Ito and Kunisch 2002).
"""

import math
from typing import Annotated

import numpy as np

from dh2urdf.kernels.certificate import NO_JOINT, distance2, turn_to
from dh2urdf.kernels.newton import POSE, make_damped, restore
from dh2urdf.kernels.numbers import entry
from dh2urdf.kernels.redundant.self_motion import (
    HELD,
    LONGEST,
    dot,
    enter_limits,
    excess,
    first_guess,
    largest,
    part_inside,
    tangent_near,
)
from dh2urdf.kernels.shapes import Chain, Configurations, Flags, Floats, Goal, Integers, Poses

ROUNDS = 100
"""Newton steps; five to thirty are usual."""

ENOUGH = 1e-7
"""Relative gain of a Newton step at which the path is as short as it gets."""

KINK = 1e-7
"""Length [rad or m] below which a step counts as smooth: that of a repeated pose is zero."""

LEAST = 1e-6
"""Added to the Hessian [1/rad], so that it is positive on straight self-motions too."""

NEAREST = 1e-6
"""Radius [rad or m] of the region of trust at which a path is left as it is."""

PASSES = 30
"""Rounds in which bounds are set and lifted; two or three are usual."""

RETURNS = 10
"""Trials to move one pose without leaving its limits."""


def step_length(a, b, jump, penalty):
    """Length of the step from a to b (n,); over a jump [rad or m] of a joint a penalty is added."""
    longest = 0.0
    for i in range(a.shape[0]):
        longest = max(longest, abs(b[i] - a[i]))
    return math.sqrt(distance2(a, b)) + (penalty if longest > jump else 0.0)


@entry()
def onward(
    chain: Chain,
    goal: Goal,
    jump: float,
    penalty: float,
    q: Annotated[Floats, "states", "n"],
    cost: Annotated[Floats, "states"],
    solutions: Annotated[Floats, "ways", "n"],
    q_out: Annotated[Floats, "ends", "n"],
    cost_out: Annotated[Floats, "ends"],
    parent: Annotated[Integers, "ends"],
    room: Annotated[Flags, 2, "states"],
):
    """Ways on from the states q (f, n) of one pose to the next pose.

    First each state follows the arm by the shortest step, and into the limits if it has left
    them; then come the solutions (s, n) of the pose, each by its cheapest way. Out come the states
    of the pose, q_out (f + s, n), their cost, infinite where there is no way, and their parent.
    """
    _, joints = chain
    reached, inside, f, n = room[0], room[1], q.shape[0], q.shape[1]
    damped, work, trial = make_damped(n), np.empty(n), np.empty((1, n))
    q_out[:f] = q
    for k in range(f):
        reached[k] = restore(chain, goal, q_out[k], work, damped) <= HELD
    enter_limits(chain, goal, q_out[:f], inside)
    for k in range(f):
        cost_out[k], parent[k] = math.inf, k
        if reached[k] and inside[k]:
            cost_out[k] = cost[k] + step_length(q[k], q_out[k], jump, penalty)
    for k in range(f, q_out.shape[0]):
        cost_out[k] = math.inf
        for i in range(f):
            if cost[i] >= cost_out[k]:
                continue
            trial[0] = solutions[k - f]
            turn_to(joints, 0.0, q[i : i + 1], trial)
            whole = cost[i] + step_length(q[i], trial[0], jump, penalty)
            if whole < cost_out[k]:
                cost_out[k], parent[k], q_out[k] = whole, i, trial[0]


def _length(start, q, jump, penalty):
    """Length of the path q (m, n) from the start (0 or 1, n), with a penalty for each jump."""
    total = 0.0
    if start.shape[0] > 0:
        total = step_length(start[0], q[0], math.inf, 0.0)
    for i in range(1, q.shape[0]):
        total += step_length(q[i - 1], q[i], jump, penalty)
    return total


def _add_step(a, b, ta, tb, g, diagonal, beside, i):
    """Add the step from a (row i - 1) to b (row i) to gradient and Hessian."""
    length = math.sqrt(KINK * KINK + distance2(a, b))
    along_a, along_b, across = 0.0, 0.0, dot(ta, tb)
    for j in range(a.shape[0]):
        along_a += (b[j] - a[j]) * ta[j] / length
        along_b += (b[j] - a[j]) * tb[j] / length
    if i > 0:
        g[i - 1] -= along_a
        diagonal[i - 1] += (1.0 - along_a * along_a) / length
        beside[i] = (along_a * along_b - across) / length
    g[i] += along_b
    diagonal[i] += (1.0 - along_b * along_b) / length


def _solve(g, diagonal, beside, x, bound, pivot):
    """Newton step x (m,); where a bound is finite x is there."""
    m = g.shape[0]
    for i in range(m):
        if not math.isinf(bound[i]):
            x[i], pivot[i] = bound[i], math.inf
            continue
        x[i], pivot[i] = -g[i], diagonal[i]
        if i > 0:
            pivot[i] -= beside[i] * beside[i] / pivot[i - 1]
            x[i] -= beside[i] * (x[i - 1] if math.isinf(pivot[i - 1]) else x[i - 1] / pivot[i - 1])
    for i in range(m - 1, -1, -1):
        if math.isinf(bound[i]):
            x[i] = (x[i] - (beside[i + 1] * x[i + 1] if i + 1 < m else 0.0)) / pivot[i]


def _newton(g, diagonal, beside, low, high, radius, x, bound, pivot):
    """Newton step x (m,) between bounds: beyond one x is set to it, pushed off it is let go."""
    m = g.shape[0]
    bound[:] = math.inf
    for _ in range(PASSES):
        _solve(g, diagonal, beside, x, bound, pivot)
        settled = True
        for i in range(m):
            least, most = max(low[i], -radius), min(high[i], radius)
            if math.isinf(bound[i]):
                if not least <= x[i] <= most:
                    bound[i] = least if x[i] < least else most
                    settled = False
                continue
            slope = g[i] + diagonal[i] * x[i]
            slope += beside[i] * x[i - 1] if i > 0 else 0.0
            slope += beside[i + 1] * x[i + 1] if i + 1 < m else 0.0
            if least < most and slope * (1.0 if bound[i] == most else -1.0) > 0.0:
                bound[i] = math.inf
                settled = False
        if settled:
            break
    for i in range(m):
        x[i] = min(max(x[i], low[i], -radius), high[i], radius)


def _move(chain, Ts, unit, q, tangent, x, trial, work, damped):
    """Move each pose's q by x along its self-motion, less where a limit is in the way."""
    _, joints = chain
    for i in range(q.shape[0]):
        way, worst = x[i], math.inf
        for _ in range(RETURNS):
            trial[i] = q[i] + way * tangent[i]
            if restore(chain, (POSE, Ts[i], unit), trial[i], work, damped) > HELD:
                way, worst = 0.5 * way, math.inf
                continue
            worst, change = 0.0, 0.0
            for j in range(q.shape[1]):
                out = excess(joints, trial[i], j)
                if abs(out) > worst:
                    worst, change = abs(out), out / tangent[i, j]
            if worst == 0.0:
                break
            way = way + change if abs(change) < 0.5 * abs(way) else 0.5 * way
        if worst > 0.0:
            trial[i] = q[i]


@entry()
def shorten(
    chain: Chain,
    Ts: Poses,
    unit: float,
    start: Annotated[Floats, "starts", "n"],
    jump: float,
    penalty: float,
    q: Configurations,
    room: Annotated[Floats, 2, "poses", "n"],
    scratch: Annotated[Floats, 8, "poses"],
):
    """Shorten a path q (m, n) through poses Ts (m, 4, 4), in place; returns its length.

    The step from ``start`` (0 or 1, n) counts too. ``unit`` is the size of the arm [m];
    ``room`` and ``scratch`` are room.
    """
    (_, joints), m, n = chain, q.shape[0], q.shape[1]
    tangent, trial = room[0], room[1]
    damped, guess, work, none = make_damped(n), np.empty(n), np.empty(n), np.zeros(n)
    tangent[:m] = 0.0
    g, diagonal, beside, low = scratch[0], scratch[1], scratch[2], scratch[3]
    high, x, bound, pivot = scratch[4], scratch[5], scratch[6], scratch[7]
    length, radius = _length(start, q, jump, penalty), LONGEST
    for _ in range(ROUNDS):
        g[:] = 0.0
        diagonal[:] = LEAST
        beside[:] = 0.0
        for i in range(m):
            first_guess(guess, NO_JOINT)
            guess[:] = tangent[i] + 1e-3 * guess
            goal = POSE, Ts[i], unit
            if not tangent_near(chain, goal, q[i], guess, tangent[i], damped):
                tangent[i] = 0.0
            high[i] = part_inside(joints, q[i], tangent[i], LONGEST)
            low[i] = part_inside(joints, q[i], tangent[i], -LONGEST)
            if i > 0:
                _add_step(q[i - 1], q[i], tangent[i - 1], tangent[i], g, diagonal, beside, i)
            elif start.shape[0] > 0:
                _add_step(start[0], q[0], none, tangent[0], g, diagonal, beside, 0)
        shorter = length
        while radius > NEAREST:
            _newton(g, diagonal, beside, low, high, radius, x, bound, pivot)
            _move(chain, Ts, unit, q, tangent, x, trial, work, damped)
            shorter = _length(start, trial, jump, penalty)
            if shorter < length:
                break
            radius = 0.5 * min(radius, largest(x))
        if not shorter < length:
            break
        q[:] = trial
        gain, length = length - shorter, shorter
        if gain < ENOUGH * length and largest(x) < radius:
            break
        radius = min(2.0 * radius, LONGEST)
    return length
