"""From the configurations at one pose of a path to those at the next."""

from __future__ import annotations

import math

import numpy as np

from dh2urdf.kernels.certify import TWO_PI
from dh2urdf.kernels.compiled import inner_kernel, kernel
from dh2urdf.kernels.damped import POSE, make_damped, restore
from dh2urdf.kernels.self_motion import HELD, enter_limits

__all__ = ["onward", "step_length"]


@inner_kernel
def step_length(a, b, jump, penalty):
    """Length of the step from a to b (n,), with the penalty where a joint moves over ``jump``."""
    total, largest = 0.0, 0.0
    for i in range(a.shape[0]):
        total += (b[i] - a[i]) * (b[i] - a[i])
        largest = max(largest, abs(b[i] - a[i]))
    return math.sqrt(total) + (penalty if largest > jump else 0.0)


@inner_kernel
def _cheapest(joints, jump, penalty, q, cost, target, trial, out):
    """The cheapest way from states q (f, n) to a solution, in the best turn, which goes to out.

    Returns
    -------
    float, int
        Cost and index of the state.
    """
    n = target.shape[0]
    best, parent = math.inf, -1
    for f in range(q.shape[0]):
        gap, square = best - cost[f], 0.0
        for j in range(n):
            trial[j] = target[j]
            if joints[j, 0] == 0.0:
                most = math.floor((joints[j, 2] - target[j]) / TWO_PI)
                least = math.ceil((joints[j, 1] - target[j]) / TWO_PI)
                turns = np.rint((q[f, j] - target[j]) / TWO_PI)
                trial[j] += TWO_PI * min(max(turns, least), most)
            square += (trial[j] - q[f, j]) ** 2
            if gap <= 0.0 or square >= gap * gap:
                break
        else:
            whole = cost[f] + step_length(q[f], trial, jump, penalty)
            if whole < best:
                best, parent = whole, f
                out[:] = trial
    return best, parent


@kernel
def onward(links, joints, T, unit, jump, penalty, q, cost, solutions, q_out, cost_out, parent):
    """Ways on from the states q (f, n) of one pose to the next pose T (4, 4).

    First each state follows the arm by the shortest step, and into the limits if it has left
    them; then come the solutions (s, n) of the pose, each by its cheapest way.

    Parameters
    ----------
    links, joints, unit
        As for :func:`dh2urdf.kernels.self_motion.nearest_members`.
    jump, penalty : float
        What a step costs beyond its length in which a joint moves by more than ``jump``.
    cost : array, shape (f,)
        Of the states.
    q_out, cost_out, parent : arrays, shapes (f + s, n), (f + s,) and (f + s,), out
        States of the pose, their cost, infinite where there is no way, and where they come from.
    """
    f, n = q.shape
    damped, work = make_damped(n), np.empty(n)
    inside = np.empty(f, np.bool_)
    q_out[:f] = q
    for k in range(f):
        inside[k] = restore(links, joints, POSE, T, unit, q_out[k], work, damped) <= HELD
        cost_out[k] = math.inf if not inside[k] else 0.0
    enter_limits(links, joints, T, unit, q_out[:f], inside)
    for k in range(f):
        parent[k] = k
        if inside[k]:
            cost_out[k] += cost[k] + step_length(q[k], q_out[k], jump, penalty)
        else:
            cost_out[k] = math.inf
    for k in range(solutions.shape[0]):
        cost_out[f + k], parent[f + k] = _cheapest(
            joints, jump, penalty, q, cost, solutions[k], work, q_out[f + k]
        )
