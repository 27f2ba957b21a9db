"""All real solutions of any arm of six revolute joints.

Elimination after Raghavan & Roth (1993): cut the loop that arm and target form, eliminate five
joints, and find the sixth as the roots of a trigonometric polynomial of degree 8, whose values
are determinants. Each root gives a seed for Newton's method on the exact chain; what is returned
carries the residual of that chain, tool included.

The arm's record holds several eliminations, best first; a pose for which one leaves doubt is
looked at again, first with new samples where the polynomial is small, then with the next one.
"""

from typing import Annotated, Any, TypeAlias

import numpy as np

from dh2urdf.kernels.certificate import finish_all, turn_inside
from dh2urdf.kernels.general_6r.arm import ARM_6R
from dh2urdf.kernels.general_6r.elimination import eliminate, prepare
from dh2urdf.kernels.general_6r.follow import follow
from dh2urdf.kernels.general_6r.listing import how_many_below
from dh2urdf.kernels.general_6r.roots import find_roots, place_target
from dh2urdf.kernels.general_6r.trials import (
    CROWDED,
    CROWDED_ATTEMPTS,
    begin_trial,
    is_last,
    roots_meet,
)
from dh2urdf.kernels.newton import POLISH, pose_residual, work_array
from dh2urdf.kernels.numbers import entry
from dh2urdf.kernels.shapes import Chain, Counts, Outputs, Poses, Solutions, Values

Arms: TypeAlias = Annotated[Any, ARM_6R, "arm_6r", 1]


def make_ready(arm):
    """Prepare the eliminations of a record, once."""
    if arm["ready"] == 0:
        prepare(arm)
        arm["ready"] = 1


def solve_pose(T, out_q, out_residual, arm):
    """All solutions of one pose; their number, and 1 where doubt is left that all are found."""
    trials, first, found, doubt, meeting = arm["trials"], arm["first"], 0, 1, False
    place_target(T, arm)
    first[0] = 1.0
    for trial in range(CROWDED_ATTEMPTS * trials):
        if not begin_trial(trial, found, arm["chain"][5], arm):
            break
        e, before, retried, seeded = trial % trials, found, 0, 0.0
        eliminate(e, arm)
        count = find_roots(arm)
        if count < 0:
            continue
        meeting = meeting or roots_meet(count, arm)
        if count > 0:
            found, retried, seeded = follow(e, count, found, out_q, out_residual, arm)
            if trial == 0:
                first[0], first[1] = seeded, arm["spans"][0, 0]
        if is_last(trial, count, (before, found, retried), seeded, arm):
            doubt = 1 if trial >= trials or meeting else 0
            break
    return found, doubt


@entry(n=6, solutions=16)
def solve_general_6r(
    arms: Arms, Ts: Poses, q: Solutions, residual: Values, count: Counts, doubt: Counts
):
    """All solutions of poses Ts (m, 4, 4), by the record ``arms`` (1,) of an arm.

    Angles in (-pi, pi] go to q (m, 16, 6), the larger of position error [m] and orientation error
    [rad] to ``residual``; ``doubt`` (m,) is 1 where there may be more. The record is not to be
    shared between threads.
    """
    arm = arms[0]
    make_ready(arm)
    for m in range(Ts.shape[0]):
        count[m], doubt[m] = solve_pose(Ts[m], q[m], residual[m], arm)


def _measure(chain, T, found, rows):
    """Residuals of isolated solutions of one pose on the exact chain; the largest."""
    (q, residual, branch, free), worst = rows, 0.0
    for k in range(found):
        residual[k], branch[k], free[k] = pose_residual(chain, T, q[k]), -1, 0
        worst = max(worst, residual[k])
    return worst


@entry(n=6, solutions=16)
def finish_general_6r(chain: Chain, arms: Arms, Ts: Poses, within_limits: bool, outputs: Outputs):
    """Certified solutions of poses Ts (m, 4, 4), by the record ``arms`` (1,) of the chain.

    Those of a pose that are all regular are neither united nor members of a family. A count is
    -1 minus that of the candidates where there may be more; returned is how many are so.
    """
    q, residual, count, branch, free = outputs
    arm, doubts, work, trial = arms[0], 0, work_array(6), np.empty((2, 6))
    make_ready(arm)
    for m in range(Ts.shape[0]):
        rows = q[m], residual[m], branch[m], free[m]
        found, doubt = solve_pose(Ts[m], q[m], residual[m], arm)
        if doubt == 1:
            found, doubts = -1 - found, doubts + 1
        else:
            apart = how_many_below(arm["kept"], found, CROWDED) == 0
            if apart and _measure(chain, Ts[m], found, rows) <= POLISH:
                found = turn_inside(chain, Ts[m], within_limits, *rows, found)
            else:
                found = finish_all(chain, Ts[m], within_limits, rows, found, trial, work)
        count[m] = found
    return doubts
