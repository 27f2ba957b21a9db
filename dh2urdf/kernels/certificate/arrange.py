"""Solutions of one pose towards a seed: full turns, residuals, order."""

import math
from typing import Annotated

import numpy as np

from dh2urdf.kernels.certificate.certify import ACCEPT, CLUSTER, NO_JOINT, TWO_PI, make_up
from dh2urdf.kernels.newton import POSE, error_and_jacobian, make_damped, pose_residual
from dh2urdf.kernels.numbers import any_family, entry
from dh2urdf.kernels.shapes import (
    AnyChain,
    Configuration,
    Counts,
    Floats,
    Found,
    Joints,
    Outputs,
    Pose,
    Poses,
    Sizes,
    Solutions,
    Some,
    Values,
)

HALF = 3.14
"""Distance [rad] from a reference that is less than half a turn, rounding included."""


@entry()
def turn_to(joints: Joints, slack: float, reference: Annotated[Floats, "references", "n"], q: Some):
    """Bring each angle of q (k, n) into the turn nearest to the reference (k or 1, n), in place.

    A turn inside the limits goes before a nearer one outside; where no turn is inside, the
    nearest one is kept. What is beyond a limit by no more than ``slack`` [rad or m], the rounding
    of a full turn, is put onto it.
    """
    for k in range(q.shape[0]):
        turn_one(joints, slack, reference[min(k, len(reference) - 1)], q[k])


def turn_one(joints, slack, reference, q):
    """Bring each angle of q (n,) into the turn nearest to the reference (n,), in place.

    As :func:`turn_to`; returned is whether a nearer turn of one is outside by ``CLUSTER`` only.
    """
    beside = False
    for i in range(len(q)):
        lower, upper = joints[i, 1], joints[i, 2]
        if lower <= q[i] <= upper and abs(reference[i] - q[i]) < HALF:
            continue
        if joints[i, 0] == 0.0:
            value = q[i]
            wanted = np.rint((reference[i] - value) / TWO_PI)
            turns = wanted
            most = np.floor((upper + slack - value) / TWO_PI)
            least = np.ceil((lower - slack - value) / TWO_PI)
            if least <= most:
                turns = min(max(wanted, least), most)
                nearer = value + TWO_PI * (turns + min(max(wanted - turns, -1.0), 1.0))
                clipped = min(max(nearer, lower), upper)
                beside = beside or (turns != wanted and abs(nearer - clipped) <= CLUSTER)
            q[i] = value + TWO_PI * turns
        if q[i] > upper and q[i] - upper <= slack:
            q[i] = upper
        elif q[i] < lower and lower - q[i] <= slack:
            q[i] = lower
    return beside


def turn_by(joints, within_limits, slack, reference, q):
    """:func:`turn_one`; without the limits, the nearest turn of all."""
    if within_limits:
        return turn_one(joints, slack, reference, q)
    for i in range(len(q)):
        if joints[i, 0] == 0.0:
            q[i] += TWO_PI * np.rint((reference[i] - q[i]) / TWO_PI)
    return False


def turn_near(chain, within_limits, slack, task, T, seed, q, trial, damped):
    """Bring each angle of q (n,) into the turn nearest to a seed (n,), inside the limits or not.

    At a singular solution rounding may take a root over a bound that is a solution, too: then it
    is put there if the pose is reached, and the joints on no bound make up for it. ``trial`` (n,).
    """
    if not turn_by(chain[1], within_limits, slack, seed, q):
        return
    trial[:] = q
    turn_one(chain[1], CLUSTER, seed, trial)
    if put_on_bounds(chain, task, T, trial, damped) <= ACCEPT:
        q[:] = trial


def put_on_bounds(chain, task, T, q, damped):
    """Residual of q (n,), of which joints were put onto bounds; others make up for that."""
    residual = measure(chain, task, T, q, damped)
    if task == POSE and residual > ACCEPT:
        return make_up(chain, T, q, NO_JOINT, CLUSTER)
    return residual


@entry()
def turn_all(
    chain: AnyChain,
    within_limits: bool,
    slack: float,
    task: int,
    T: Pose,
    seed: Configuration,
    q: Some,
):
    """Bring each angle of solutions q (k, n) of a pose T (4, 4) into the turn nearest to a seed.

    ``slack`` is that of :func:`turn_to`.
    """
    trial, damped = np.empty(len(seed)), make_damped(len(seed))
    for k in range(q.shape[0]):
        turn_near(chain, within_limits, slack, task, T, seed, q[k], trial, damped)


@entry()
def settle_on_bounds(chain: AnyChain, task: int, T: Pose, q: Some, residual: Sizes):
    """Residuals (k,) of configurations q (k, n), of which joints were put onto their bounds.

    Those that miss the pose T (4, 4) are brought back by the joints that are on none, in place.
    """
    damped = make_damped(q.shape[1])
    for k in range(q.shape[0]):
        residual[k] = put_on_bounds(chain, task, T, q[k], damped)


def swap(rows, distance, a, b):
    """Exchange two rows."""
    q, residual, branch, free = rows
    for i in range(q.shape[1]):
        q[a, i], q[b, i] = q[b, i], q[a, i]
    residual[a], residual[b] = residual[b], residual[a]
    branch[a], branch[b] = branch[b], branch[a]
    free[a], free[b] = free[b], free[a]
    distance[a], distance[b] = distance[b], distance[a]


def measure(chain, task, T, q, damped):
    """Residual of a configuration q (n,) on the exact chain, of what a task asks for."""
    if task == POSE:
        return pose_residual(chain, T, q)
    return error_and_jacobian(chain, (task, T, 1.0), q, damped)


@entry()
def measure_all(
    chain: AnyChain, task: int, Ts: Poses, q: Solutions, count: Counts, residual: Values
):
    """Residuals (m, k) of configurations q (m, k, n), the first ``count[i]`` of each pose Ts[i]."""
    damped = make_damped(q.shape[2])
    for i in range(q.shape[0]):
        for k in range(count[i]):
            residual[i, k] = measure(chain, task, Ts[i], q[i, k], damped)


def distance2(q, seed):
    """Squared distance of two configurations."""
    total = 0.0
    for i in range(q.shape[0]):
        total += (q[i] - seed[i]) * (q[i] - seed[i])
    return total


@entry()
def measure_and_sort(
    chain: AnyChain, task: int, T: Pose, seed: Configuration, found: Found, distance: Sizes
):
    """Measure solutions of a pose T (4, 4), and sort them by ``distance`` from a seed (n,).

    In place; the task is one of :mod:`dh2urdf.kernels.newton.damped`.
    """
    damped = make_damped(found[0].shape[1])
    for k in range(found[0].shape[0]):
        _sort_in(chain, task, T, seed, found, distance, k, damped)


def _sort_in(chain, task, T, seed, found, distance, k, damped):
    """Measure row k and move it to its place among the rows before it."""
    q, residual, _, _ = found
    residual[k] = measure(chain, task, T, q[k], damped)
    distance[k] = math.sqrt(distance2(q[k], seed))
    while k > 0 and distance[k] < distance[k - 1]:
        swap(found, distance, k, k - 1)
        k -= 1


def arrange_near(
    chain: AnyChain,
    within_limits: bool,
    slack: float,
    task: int,
    Ts: Poses,
    seed: Configuration,
    outputs: Outputs,
    distance: Sizes,
):
    """Turn and sort the solutions of one pose, Ts (1, 4, 4), towards a seed (n,), in place.

    Returns whether all have the residual of a solution. ``slack`` is that of :func:`turn_to`.
    """
    q, residual, counts, branch, free = outputs
    damped, trial = make_damped(len(seed)), np.empty(len(seed))
    well = True
    for k in range(counts[0]):
        turn_near(chain, within_limits, slack, task, Ts[0], seed, q[0, k], trial, damped)
        _sort_in(
            chain, task, Ts[0], seed, (q[0], residual[0], branch[0], free[0]), distance, k, damped
        )
    for k in range(counts[0]):
        well = well and residual[0, k] <= ACCEPT
    return well


@entry()
def arrange_plain(
    chain: AnyChain,
    within_limits: bool,
    largest: Configuration,
    slack: float,
    task: int,
    Ts: Poses,
    seed: Configuration,
    outputs: Outputs,
    distance: Sizes,
):
    """Turn and sort the solutions of one pose, Ts (1, 4, 4), towards a seed (n,), in place.

    Returns whether all is well: the seed is no larger than ``largest`` (n,), no solution has free
    joints, and all have the residual of a solution. ``slack`` is that of :func:`turn_to`.
    """
    _, _, counts, _, free = outputs
    for i in range(len(seed)):
        if not abs(seed[i]) <= largest[i]:
            return False
    if any_family(counts, free):
        return False
    return arrange_near(chain, within_limits, slack, task, Ts, seed, outputs, distance)
