"""From starts on curves of solutions to the members that are nearest to a seed."""

from typing import Annotated, NamedTuple

import numpy as np

from dh2urdf.kernels.certificate import distance2
from dh2urdf.kernels.newton import make_damped
from dh2urdf.kernels.numbers import entry
from dh2urdf.kernels.redundant.self_motion import enter, go_nearer
from dh2urdf.kernels.shapes import Chain, Configuration, Floats, Goal, Integers, Some

ALIKE = 1e-4
"""Joint distance [rad or m] at which two starts on a curve are one."""

SAME = 1e-5
"""Joint distance [rad or m] at which two nearest members are one."""


class Starts(NamedTuple):
    """Configurations inside and outside the limits, ascending by a measure; how many."""

    inner: Annotated[Floats, "starts", "n"]
    distance: Annotated[Floats, "starts"]
    outer: Annotated[Floats, "starts", "n"]
    measure: Annotated[Floats, "starts"]
    counts: Annotated[Integers, 2]

    @classmethod
    def of(cls, most: int, n: int) -> "Starts":
        """Room for so many starts of n joints."""
        room, sizes = np.empty((2, most, n)), np.empty((2, most))
        return cls(room[0], sizes[0], room[1], sizes[1], np.zeros(2, np.int64))


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
    inner, distance, outer, _, counts = starts
    n = seed.shape[0]
    damped, scratch = make_damped(n), np.empty((4, n))
    for k in range(counts[1]):
        if enter(chain, goal, outer[k], scratch, damped):
            near = distance2(outer[k], seed)
            counts[0] = keep(inner, distance, counts[0], outer[k], near)


@entry()
def nearest_of(
    chain: Chain,
    goal: Goal,
    within_limits: bool,
    seed: Configuration,
    starts: Starts,
    beside: Annotated[Floats, "more", "n"],
    members: Some,
):
    """The members (k, n) nearest to a seed that starts lead to, ascending; returns how many.

    ``beside`` are further starts; a member that only they lead to is one of its own.
    """
    inner, counts = starts[0], starts[4]
    n, found = seed.shape[0], 0
    damped, scratch, q = make_damped(n), np.empty((5, n)), np.empty(n)
    for k in range(counts[0] + beside.shape[0]):
        q[:] = inner[k] if k < counts[0] else beside[k - counts[0]]
        go_nearer(chain, goal, within_limits, q, seed, scratch, damped)
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
    return found


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
