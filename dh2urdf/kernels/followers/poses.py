"""All real solutions of an arm of which one value moves two joints or more, and five the others.

Eliminate four of the free joints as for six turning ones (Raghavan & Roth 1993); the leader's turn
is a root of a trigonometric polynomial, whose degree says how many joints it moves, by how much,
and where they are: 16 for a hollow wrist. Each root gives a seed for Newton's method on the exact
chain, whose Jacobian is that of the values.
"""

from typing import Annotated, Any

import numpy as np

from dh2urdf.kernels.certificate import finish_all, turn_inside
from dh2urdf.kernels.followers.arm import FOLLOWERS_16, FOLLOWERS_48
from dh2urdf.kernels.followers.elimination import eliminate
from dh2urdf.kernels.followers.follow import follow
from dh2urdf.kernels.followers.roots import find_roots, place_target
from dh2urdf.kernels.general_6r import (
    CROWDED,
    CROWDED_ATTEMPTS,
    begin_trial,
    how_many_below,
    is_last,
    roots_meet,
)
from dh2urdf.kernels.newton import POLISH, work_array
from dh2urdf.kernels.numbers import entry
from dh2urdf.kernels.shapes import AnyChain, Outputs, Poses

Arms16 = Annotated[Any, FOLLOWERS_16, "followers_16", 1]
Arms48 = Annotated[Any, FOLLOWERS_48, "followers_48", 1]


def _solve_pose(chain, T, q, residual, arm, work):
    """All solutions of one pose; their number, and 1 where doubt is left that all are found."""
    trials, first, found, doubt, meeting = arm["trials"], arm["first"], 0, 1, False
    place_target(T, arm)
    first[0] = 1.0
    for trial in range(CROWDED_ATTEMPTS * trials):
        if not begin_trial(trial, found, arm["chain"][arm["motions"] - 1], arm):
            break
        e, before, retried, seeded = trial % trials, found, 0, 0.0
        eliminate(e, arm)
        count = find_roots(e, arm)
        if count < 0:
            continue
        meeting = meeting or roots_meet(count, arm)
        if count > 0:
            found, retried, seeded = follow(e, count, found, chain, T, q, residual, arm, work)
            if trial == 0:
                first[0], first[1] = seeded, arm["spans"][0, 0]
        if is_last(trial, count, (before, found, retried), seeded, arm):
            doubt = 1 if trial >= trials or meeting else 0
            break
    return found, doubt


def _try(chain, arm, Ts, outputs):
    """Candidates of poses, see :func:`try_followers_16`."""
    q, residual, count, branch, _ = outputs
    work = work_array(6)
    for m in range(Ts.shape[0]):
        count[m], branch[m, 0] = _solve_pose(chain, Ts[m], q[m], residual[m], arm, work)


def _finish(chain, arm, Ts, within_limits, outputs):
    """Certified solutions of poses, see :func:`finish_followers_16`."""
    q, residual, count, branch, free = outputs
    doubts, work, trial = 0, work_array(6), np.empty((2, 6))
    for m in range(Ts.shape[0]):
        rows = q[m], residual[m], branch[m], free[m]
        found, doubt = _solve_pose(chain, Ts[m], q[m], residual[m], arm, work)
        if doubt == 1:
            found, doubts = -1 - found, doubts + 1
        else:
            worst = 0.0
            for k in range(found):
                branch[m, k], free[m, k] = -1, 0
                worst = max(worst, residual[m, k])
            if how_many_below(arm["kept"], found, CROWDED) == 0 and worst <= POLISH:
                found = turn_inside(chain, Ts[m], within_limits, *rows, found)
            else:
                found = finish_all(chain, Ts[m], within_limits, rows, found, trial, work)
        count[m] = found
    return doubts


@entry(n=6, solutions=32)
def try_followers_16(chain: AnyChain, arms: Arms16, Ts: Poses, outputs: Outputs):
    """Candidates of poses Ts (m, 4, 4) by the record (1,) of an arm, limits or not.

    The first branch of each pose is 1 where there may be more. The record is not to be shared
    between threads.
    """
    arm = arms[0]
    _try(chain, arm, Ts, outputs)


@entry(n=6, solutions=96)
def try_followers_48(chain: AnyChain, arms: Arms48, Ts: Poses, outputs: Outputs):
    """As :func:`try_followers_16`, for a polynomial of degree 48 or less."""
    arm = arms[0]
    _try(chain, arm, Ts, outputs)


@entry(n=6, solutions=32)
def finish_followers_16(
    chain: AnyChain, arms: Arms16, Ts: Poses, within_limits: bool, outputs: Outputs
):
    """Certified solutions of poses Ts (m, 4, 4), by the record ``arms`` (1,) of the chain.

    A count is -1 minus that of the candidates where there may be more; returned is how many are so.
    """
    arm = arms[0]
    return _finish(chain, arm, Ts, within_limits, outputs)


@entry(n=6, solutions=96)
def finish_followers_48(
    chain: AnyChain, arms: Arms48, Ts: Poses, within_limits: bool, outputs: Outputs
):
    """As :func:`finish_followers_16`, for a polynomial of degree 48 or less."""
    arm = arms[0]
    return _finish(chain, arm, Ts, within_limits, outputs)
