"""Which solutions are on one family: a walk along it arrives at them.

Straight towards a solution, for a family may have more than one dimension, or from the point that
is nearest of a walk both ways.
"""

from typing import Annotated

import numpy as np

from dh2urdf.kernels.certificate import CLUSTER, is_singular, move, same
from dh2urdf.kernels.newton import POSE, STAYING, make_damped, normal_equations, work_array
from dh2urdf.kernels.numbers import entry
from dh2urdf.kernels.redundant.self_motion import go_nearer, largest, walk_family, way_to
from dh2urdf.kernels.shapes import AnyChain, Configuration, Flags, Floats, Goal, Some

ARRIVED = 1e-5
"""Joint distance [rad or m] at which a walk has arrived: its points are on the family to 1e-9."""

STUCK = 1e-3
"""Part of the distance that is left: with steps that bring less a walk does not arrive."""

BESIDE = 2.0
"""Distance of a solution from the points of a walk along its family, in steps of it."""

LENGTH, MOST_STEPS = 0.25, 12
"""Step of a walk along a family [rad or m], and how many each way: a turn in all."""

SHARP = 1e-11
"""Residual [m and rad] of a member of a family beside which a point of a valley is none."""

ALIKE = 1e-14
"""Residuals [m and rad] below which one member of a family is as good as another."""

WELL = 1e-10
"""Residual [m and rad] on the way between solutions of one family: walked in another way, it is
accepted, too. Between two that are side by side along a valley it is more."""


def _arrives(chain, goal, held, start, other, rows, damped):
    """Whether going nearer to a configuration (n,), along the family from a member, ends there."""
    scratch, at, way, seed = rows[:5], rows[5], rows[6], rows[7]
    way_to(chain[1], start, other, way)
    at[:] = start
    seed[:] = start + way
    go_nearer(chain, goal, False, STUCK, held, at, seed, scratch, damped)
    way[:] = seed - at
    return largest(way) <= ARRIVED


def members_among(chain, goal, length, held, q, others, trials, found, walk):
    """Which of some solutions (k, n) are on the family of a member q (n,), by its free joints.

    Asked are those that ``found`` (k,) says, where the answers are, too; the other joints stay as
    they are in q. Ways straight from q are tried until so many ``trials`` have failed; then come
    those from a walk, which has steps of a ``length`` [rad or m], at most as many each way as there
    is room for. Towards a solution residuals are ``held`` at most.
    """
    n, failed, walked, staying = q.shape[0], 0, False, goal[0] // STAYING
    damped, rows, counts = make_damped(n), np.empty((9, n)), np.zeros(2, np.int64)
    other = rows[8]
    for k in range(others.shape[0]):
        if not found[k]:
            continue
        for i in range(n):
            other[i] = q[i] if staying >> i & 1 else others[k, i]
        found[k] = failed < trials and _arrives(chain, goal, held, q, other, rows, damped)
        if found[k]:
            continue
        failed += 1
        if not walked:
            walk_family(chain, goal, length, q, walk, counts)
            walked = True
        way_to(chain[1], q, other, rows[6])
        side, nearest, best = 0, -1, min(largest(rows[6]), BESIDE * length)
        for way in range(2):
            for i in range(counts[way]):
                way_to(chain[1], walk[way, i], other, rows[6])
                far = largest(rows[6])
                if far < best:
                    side, nearest, best = way, i, far
        if best < BESIDE * length:
            start = q if nearest < 0 else walk[side, nearest]
            found[k] = _arrives(chain, goal, held, start, other, rows, damped)


@entry()
def on_one_family(
    chain: AnyChain,
    goal: Goal,
    length: float,
    held: float,
    q: Configuration,
    others: Some,
    trials: int,
    found: Annotated[Flags, "solutions"],
    walk: Annotated[Floats, 2, "members", "n"],
):
    """Which solutions (k, n) are on the family of a member q (n,), to ``found`` (k,).

    Arguments as those of :func:`members_among`.
    """
    for k in range(others.shape[0]):
        found[k] = True
    members_among(chain, goal, length, held, q, others, trials, found, walk)


def _ask_isolated(chain, T, rows, k, count, asked, work):
    """Note isolated solutions, singular ones, that may be on the family of row k; if there are."""
    (q, _, _, free), some = rows, False
    for j in range(asked.shape[0]):
        asked[j] = False
        if j < count and free[j] == 0 and same(chain[1], q[k], q[j], CLUSTER, free[k]):
            normal_equations(chain, T, q[j], work)
            asked[j] = is_singular(work)
            some = some or asked[j]
    return some


def _walk_to(chain, T, unit, q, mask, k, asked, walk):
    """Keep those of the rows asked for that a walk from row k by the joints of a mask comes to."""
    goal = POSE + STAYING * ((1 << q.shape[1]) - 1 - mask), T, unit
    members_among(chain, goal, LENGTH, WELL, q[k], q, 0, asked, walk)


def _drop(rows, k, count, gone):
    """Drop solutions that are gone, the sharpest of which stands for row k; how many are left.

    And where row k is then.
    """
    (q, residual, branch, free), kept, place = rows, 0, k
    for j in range(count):
        if not gone[j]:
            place = kept if j == k else place
            move(q, residual, branch, free, j, kept)
            kept += 1
        elif max(residual[j], ALIKE) < residual[place]:
            q[place], residual[place] = q[j], residual[j]
    return kept, place


def take_in_isolated(chain, T, unit, rows, count):
    """Drop isolated solutions of a pose that a walk along a family comes to; how many are left.

    Beside an arm that moves freely a few of its solutions are exact, and a walk of one of them does
    not see that the others are on its way.
    """
    (q, residual, _, free), k, work = rows, 0, work_array(rows[0].shape[1])
    asked = np.empty(rows[0].shape[0], np.bool_)
    walk = np.empty((2, MOST_STEPS, rows[0].shape[1]))
    while k < count:
        sharp = residual[k] <= SHARP
        if sharp and free[k] != 0 and _ask_isolated(chain, T, rows, k, count, asked, work):
            _walk_to(chain, T, unit, q, free[k], k, asked, walk)
            count, k = _drop(rows, k, count, asked)
        k += 1
    return count


def keep_one_of_each(chain, goal, q, residual, branch, free, count):
    """Keep the first of solutions of a pose that go straight to one another; how many.

    Of families by all joints: by some, two may be on either side of one that is missed between.
    """
    n, kept, every = q.shape[1], 0, (1 << q.shape[1]) - 1
    damped, rows = make_damped(n), np.empty((8, n))
    for k in range(count):
        again = False
        for j in range(kept):
            if free[k] == every and free[j] == every and not again:
                again = _arrives(chain, goal, WELL, q[j], q[k], rows, damped)
        if not again:
            move(q, residual, branch, free, k, kept)
            kept += 1
    return kept
