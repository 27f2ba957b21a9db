"""From the configurations at one pose of a path to those at the next."""

from __future__ import annotations

import math

import numpy as np

from dh2urdf.kernels.certificate import POSE, make_damped, restore, turn_to
from dh2urdf.kernels.numbers import inner_kernel, kernel
from dh2urdf.kernels.redundant.self_motion import HELD, distance2, enter_limits

__all__ = ["onward", "step_length"]


@inner_kernel
def step_length(a, b, jump, penalty):
    """Length of the step from a to b (n,), with the penalty where a joint moves over ``jump``."""
    largest = 0.0
    for i in range(a.shape[0]):
        largest = max(largest, abs(b[i] - a[i]))
    return math.sqrt(distance2(a, b)) + (penalty if largest > jump else 0.0)


@kernel
def onward(links, joints, T, unit, jump, penalty, q, cost, solutions, q_out, cost_out, parent):
    """Ways on from the states q (f, n) of one pose to the next pose T (4, 4).

    First each state follows the arm by the shortest step, and into the limits if it has left
    them; then come the solutions (s, n) of the pose, each by its cheapest way.

    ``links``, ``joints``, ``unit`` are as for
    :func:`dh2urdf.kernels.redundant.self_motion.nearest_members`; a step over ``jump`` costs
    ``penalty`` more. Out come the states of the pose, q_out (f + s, n), their cost, infinite where
    there is no way, and their parent.
    """
    f, n = q.shape
    damped, work, trial = make_damped(n), np.empty(n), np.empty((1, n))
    reached, inside = np.empty(f, np.bool_), np.empty(f, np.bool_)
    q_out[:f] = q
    for k in range(f):
        reached[k] = restore(links, joints, POSE, T, unit, q_out[k], work, damped) <= HELD
    enter_limits(links, joints, T, unit, q_out[:f], inside)
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
