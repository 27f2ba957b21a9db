"""Values that move joints together, ``x = matrix @ q + offset``: turns of the joints by values.

A turn of a joint is a way of several values, which is no turn of theirs where the matrix is not
whole. Of the turns that are listed, the one is chosen that puts the values inside their limits and
nearest to a goal.
"""

import math

import numpy as np

from dh2urdf.kernels.certificate.arrange import distance2, measure, swap, turn_one
from dh2urdf.kernels.certificate.certify import ACCEPT, TWO_PI, move
from dh2urdf.kernels.newton import make_damped
from dh2urdf.kernels.numbers import any_family, entry
from dh2urdf.kernels.shapes import (
    AnyChain,
    Configuration,
    Flagged,
    Outputs,
    Poses,
    References,
    Sizes,
    Some,
    Together,
)

OUTSIDE = 1e12
"""Squared distance [rad or m] by which a value outside the limits is farther than any inside."""


def joints_of(together, q, x):
    """Joints x (n,) at values q (n,)."""
    for j in range(len(q)):
        x[j] = together[2][j]
        for i in range(len(q)):
            x[j] += together[0][j, i] * q[i]


def turn_values(together, slack, goal, x, q, near):
    """Values q (n,) of joints x (n,), in the turns nearest to a goal (n,); whether inside limits.

    The joints are put where the values say. ``near`` (n,) is scratch.
    """
    _, inverse, offset, loose, ends, turns, ways = together
    for i in range(len(q)):
        q[i] = 0.0
        for j in range(len(q)):
            q[i] += inverse[i, j] * (x[j] - offset[j])
    turn_one(loose, slack, goal, q)
    _go_near(together, goal, x, q, near)
    best, least, inside = 0, -1.0, False
    for p in range(turns.shape[0]):
        cost, within = 0.0, True
        for i in range(len(q)):
            if ends[i, 0] != 0.0:
                value, joint = q[i] + ways[p, i], x[i] + TWO_PI * turns[p, i]
                within = within and ends[i, 1] - slack <= value and value <= ends[i, 2] + slack
                within = within and ends[i, 3] <= joint and joint <= ends[i, 4]
                cost += (value - goal[i]) * (value - goal[i])
        if not within:
            cost += OUTSIDE
        if p == 0 or cost < least:
            best, least, inside = p, cost, within
    for i in range(len(q)):
        if ends[i, 0] != 0.0:
            q[i] += ways[best, i]
            if q[i] > ends[i, 2] and q[i] - ends[i, 2] <= slack:
                q[i] = ends[i, 2]
            elif q[i] < ends[i, 1] and ends[i, 1] - q[i] <= slack:
                q[i] = ends[i, 1]
        else:
            inside = inside and loose[i, 1] - slack <= q[i] and q[i] <= loose[i, 2] + slack
    joints_of(together, q, x)
    return inside


def _go_near(together, goal, x, q, near):
    """Turn joints x (n,) that move together until their values q (n,) are about a goal (n,)."""
    matrix, inverse, offset, _, ends, _, _ = together
    for i in range(len(q)):
        near[i] = q[i] if ends[i, 6] != 0.0 else min(max(goal[i], ends[i, 1]), ends[i, 2])
    for j in range(len(q)):
        if ends[j, 5] != 0.0:
            at = offset[j]
            for i in range(len(q)):
                if ends[i, 0] != 0.0:
                    at += matrix[j, i] * near[i]
            angle = TWO_PI * np.rint((at - x[j]) / TWO_PI)
            if angle != 0.0:
                x[j] += angle
                for i in range(len(q)):
                    q[i] += inverse[i, j] * angle


@entry()
def turn_together(
    together: Together, slack: float, references: References, joints: Some, inside: Flagged
):
    """Put the values of joints (k, n) in their place, in the turns nearest to references.

    These are (k or 1, n). Which are inside the limits goes to ``inside`` (k,).
    """
    x, near = np.empty(joints.shape[1]), np.empty(joints.shape[1])
    for k in range(joints.shape[0]):
        for i in range(joints.shape[1]):
            x[i] = joints[k, i]
        goal = references[min(k, len(references) - 1)]
        inside[k] = turn_values(together, slack, goal, x, joints[k], near)


@entry()
def values_of_batch(
    chain: AnyChain,
    together: Together,
    slack: float,
    task: int,
    within_limits: bool,
    goal: Configuration,
    Ts: Poses,
    outputs: Outputs,
):
    """Put the values of solutions in place of their joints; with limits those inside stay.

    Poses with a solution of free joints are left as they are. Returns True.
    """
    q, residual, counts, branch, free = outputs
    n = q.shape[2]
    x, near, damped = np.empty(n), np.empty(n), make_damped(n)
    for m in range(q.shape[0]):
        families = False
        for k in range(counts[m]):
            families = families or free[m, k] != 0
        if families:
            continue
        kept = 0
        for k in range(counts[m]):
            for i in range(n):
                x[i] = q[m, k, i]
            inside = turn_values(together, slack, goal, x, q[m, k], near)
            if inside or not within_limits:
                move(q[m], residual[m], branch[m], free[m], k, kept)
                residual[m, kept] = measure(chain, task, Ts[m], x, damped)
                kept += 1
        counts[m] = kept
    return True


@entry()
def arrange_together(
    chain: AnyChain,
    together: Together,
    largest: Configuration,
    slack: float,
    task: int,
    Ts: Poses,
    seed: Configuration,
    outputs: Outputs,
    distance: Sizes,
):
    """Turn and sort the values of one pose's solutions towards a seed (n,), in place.

    Returns whether all is well, as :func:`arrange_plain` does.
    """
    q, residual, counts, branch, free = outputs
    n = q.shape[2]
    for i in range(n):
        if not abs(seed[i]) <= largest[i]:
            return False
    if any_family(counts, free):
        return False
    x, near, damped = np.empty(n), np.empty(n), make_damped(n)
    well = True
    for k in range(counts[0]):
        joints_of(together, q[0, k], x)
        turn_values(together, slack, seed, x, q[0, k], near)
        residual[0, k] = measure(chain, task, Ts[0], x, damped)
        well = well and residual[0, k] <= ACCEPT
        distance[k] = math.sqrt(distance2(q[0, k], seed))
        at = k
        while at > 0 and distance[at] < distance[at - 1]:
            swap((q[0], residual[0], branch[0], free[0]), distance, at, at - 1)
            at -= 1
    return well
