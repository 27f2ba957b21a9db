"""From starts on curves of solutions to the members that are nearest to a seed."""

import math
from typing import Annotated, NamedTuple

import numpy as np

from dh2urdf.kernels.certificate import ACCEPT, Coupled, distance2, find_solutions, turn_by
from dh2urdf.kernels.newton import make_damped, pose_residual
from dh2urdf.kernels.numbers import entry
from dh2urdf.kernels.redundant.self_motion import HELD, enter, go_nearer
from dh2urdf.kernels.shapes import Chain, Configuration, Floats, Goal, Integers, Outputs, Some

ALIKE = 1e-4
"""Joint distance [rad or m] at which two starts on a curve are one."""

SAME = 1e-5
"""Joint distance [rad or m] at which two nearest members are one."""


INNER, OUTER, BESIDE, MEMBERS = range(4)


class Starts(NamedTuple):
    """Configurations inside and outside the limits, ascending by a measure; one beside a seed.

    ``counts`` are how many, and how many members they lead to.
    """

    inner: Annotated[Floats, "starts", "n"]
    distance: Annotated[Floats, "starts"]
    outer: Annotated[Floats, "starts", "n"]
    measure: Annotated[Floats, "starts"]
    beside: Annotated[Floats, 1, "n"]
    counts: Annotated[Integers, 4]

    @classmethod
    def of(cls, most: int, n: int) -> "Starts":
        """Room for so many starts of n joints."""
        room, sizes = np.empty((2, most, n)), np.empty((2, most))
        return cls(room[0], sizes[0], room[1], sizes[1], np.empty((1, n)), np.zeros(4, np.int64))


def keep(starts, measure, count, q, size):
    """Put q (n,) among the starts (k, n), ascending by their measure; how many there are then."""
    most = starts.shape[0]
    if count == most and not size < measure[most - 1]:
        return count
    for k in range(count):
        if is_alike(starts[k], q, ALIKE):
            return count
    place = min(count, most - 1)
    while place > 0 and size < measure[place - 1]:
        starts[place], measure[place] = starts[place - 1], measure[place - 1]
        place -= 1
    starts[place], measure[place] = q, size
    return min(count + 1, most)


def is_alike(q, p, most):
    """Whether no joint of q (n,) is farther from p (n,) than that."""
    for i in range(q.shape[0]):
        if not abs(q[i] - p[i]) <= most:
            return False
    return True


@entry()
def enter_all(chain: Chain, goal: Goal, seed: Configuration, starts: Starts):
    """Follow what is outside the limits into them; what arrives is a start like others."""
    inner, distance, outer, _, _, counts = starts
    n = seed.shape[0]
    damped, scratch = make_damped(n), np.empty((4, n))
    for k in range(counts[OUTER]):
        if enter(chain, goal, outer[k], scratch, damped):
            near = distance2(outer[k], seed)
            counts[INNER] = keep(inner, distance, counts[INNER], outer[k], near)


@entry()
def start_beside(arm: Coupled, goal: Goal, seed: Configuration, starts: Starts):
    """Note the solution that Newton's method leads to from a seed (n,), if it leads to one.

    A curve of solutions that is short, or close to another one, may have none of the values at
    which joints are held.
    """
    bounds, beside, counts, n = arm[3], starts[4], starts[5], seed.shape[0]
    start, residual = np.empty((1, n)), np.empty(1)
    for i in range(n):
        start[0, i] = min(max(seed[i], bounds[i, 1]), bounds[i, 2])
    found, _ = find_solutions(arm, goal, start, beside, residual)
    counts[BESIDE] = found


@entry()
def nearest_of(
    chain: Chain,
    goal: Goal,
    within_limits: bool,
    seed: Configuration,
    starts: Starts,
    members: Annotated[Floats, "members", "n"],
):
    """The members (k, n) nearest to a seed (n,) that starts lead to, ascending.

    Their number goes to the counts of the starts.
    """
    inner, beside, counts = starts[0], starts[4], starts[5]
    n, found = seed.shape[0], 0
    damped, scratch, q = make_damped(n), np.empty((5, n)), np.empty(n)
    for k in range(counts[INNER] + counts[BESIDE]):
        if k < counts[INNER]:
            q[:] = inner[k]
        else:
            q[:] = beside[k - counts[INNER]]
        go_nearer(chain, goal, within_limits, 0.0, HELD, q, seed, scratch, damped)
        known = False
        for i in range(found):
            known = known or is_alike(members[i], q, SAME)
        if known or found == members.shape[0]:
            continue
        place, size = found, distance2(q, seed)
        while place > 0 and size < distance2(members[place - 1], seed):
            members[place] = members[place - 1]
            place -= 1
        members[place] = q
        found += 1
    counts[MEMBERS] = found


class Samples(NamedTuple):
    """Solutions of one pose at values of a joint, as `Outputs`."""

    q: Annotated[Floats, 1, "samples", "n"]
    residual: Annotated[Floats, 1, "samples"]
    counts: Annotated[Integers, 1]
    branch: Annotated[Integers, 1, "samples"]
    free: Annotated[Integers, 1, "samples"]


@entry()
def arrange_members(
    chain: Chain,
    Ts: Annotated[Floats, "poses", 4, 4],
    within_limits: bool,
    largest: Configuration,
    slack: float,
    seed: Configuration,
    starts: Starts,
    members: Annotated[Floats, "members", "n"],
    found: Samples,
    outputs: Outputs,
    distance: Annotated[Floats, "solutions"],
    order: Annotated[Integers, "solutions"],
):
    """Members of one pose and what was found, turned to a seed (n,) and sorted by distance.

    Returns whether the seed is no larger than ``largest`` (n,). ``slack`` is that of
    :func:`turn_to`; what was found is turned in place.
    """
    (some, _, known, branch, free), count = found, starts[5][MEMBERS]
    q, residual, counts, branches, masks = outputs
    for i in range(seed.shape[0]):
        if not abs(seed[i]) <= largest[i]:
            return False
    for k in range(count + known[0]):
        if k < count:
            size = math.sqrt(distance2(members[k], seed))
        else:
            turn_by(chain[1], within_limits, slack, seed, some[0, k - count])
            size = math.sqrt(distance2(some[0, k - count], seed))
        place = k
        while place > 0 and size < distance[place - 1]:
            distance[place], order[place] = distance[place - 1], order[place - 1]
            place -= 1
        distance[place], order[place] = size, k
    kept = 0
    for k in range(count + known[0]):
        row = order[k] - count
        if row < 0:
            q[0, kept], branches[0, kept], masks[0, kept] = members[order[k]], -1, 0
        else:
            q[0, kept] = some[0, row]
            branches[0, kept], masks[0, kept] = branch[0, row], free[0, row]
        residual[0, kept] = pose_residual(chain, Ts[0], q[0, kept])
        kept += 1 if residual[0, kept] <= ACCEPT else 0
    counts[0] = kept
    return True


@entry()
def spread(apart: float, q: Some):
    """Leave out configurations (k, n) of which no joint is farther than that from an earlier one.

    In place; returns how many are left.
    """
    kept = 0
    for k in range(q.shape[0]):
        known = False
        for i in range(kept):
            known = known or is_alike(q[i], q[k], apart)
        if not known:
            q[kept] = q[k]
            kept += 1
    return kept
