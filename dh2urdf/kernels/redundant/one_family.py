"""Which solutions are on one family: a walk along it arrives at them.

Straight towards a solution, for a family may have more than one dimension, or from the point that
is nearest of a walk both ways.
"""

from typing import Annotated

import numpy as np

from dh2urdf.kernels.certificate import move
from dh2urdf.kernels.newton import STAYING, make_damped
from dh2urdf.kernels.numbers import entry
from dh2urdf.kernels.redundant.self_motion import go_nearer, largest, walk_family, way_to
from dh2urdf.kernels.shapes import AnyChain, Configuration, Flags, Floats, Goal, Some

ARRIVED = 1e-5
"""Joint distance [rad or m] at which a walk has arrived: its points are on the family to 1e-9."""

STUCK = 1e-3
"""Part of the distance that is left: with steps that bring less a walk does not arrive."""

BESIDE = 2.0
"""Distance of a solution from the points of a walk along its family, in steps of it."""

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
