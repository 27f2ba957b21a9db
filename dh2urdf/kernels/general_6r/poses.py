"""All real solutions of any arm of six revolute joints.

Elimination after Raghavan & Roth (1993): cut the loop that arm and target form, eliminate five
joints, and find the sixth as the roots of a trigonometric polynomial of degree 8, whose values
are determinants. Each root gives a seed for Newton's method on the exact chain; what is returned
carries the residual of that chain, tool included.

An elimination can fail for an arm (parallel axes make the determinant vanish) or lose precision
for a pose. So the arm's record holds several, best first; a pose for which one leaves doubt is
looked at again, first with new samples where the polynomial is small, then with the next one.
"""

from typing import Annotated, Any, TypeAlias

import numpy as np

from dh2urdf.kernels.certificate import finish_all, turn_inside
from dh2urdf.kernels.general_6r.arm import ARM_6R
from dh2urdf.kernels.general_6r.elimination import eliminate, prepare
from dh2urdf.kernels.general_6r.follow import SINGULAR, accounted, follow, how_many_below
from dh2urdf.kernels.general_6r.roots import find_roots, nudge, place_target
from dh2urdf.kernels.newton import POLISH, pose_residual, work_array
from dh2urdf.kernels.numbers import entry
from dh2urdf.kernels.shapes import Chain, Counts, Outputs, Poses, Solutions, Values

Arms: TypeAlias = Annotated[Any, ARM_6R, "arm_6r", 1]

COARSE = 1e-2
"""Error of a seed, lengths in parts of the arm's size, above which another elimination is asked:
roots so inexact may stand for more than one each."""

CROWDED = 1e-3
"""Determinant of a solution's Jacobian below which roots of several may run together: none is
taken for the last before every root is accounted for."""

NUDGE = 1e-3
"""Size of a nudge: tangent of half its angle, and shift in parts of the arm's size."""

ATTEMPTS = 3
"""Rounds of all eliminations, from the second one on for a pose nearby."""

CROWDED_ATTEMPTS = 7
"""The same where solutions are close together yet apart: each round may lead to others."""


DEEP = 5
"""Spans of doubt from which on roots may meet that look apart: on random poses one in a thousand
has so many."""


def _solve_pose(T, out_q, out_residual, arm):
    """All solutions of one pose; their number, and 1 where doubt is left that all are found."""
    spans, first, trials, kept = arm["spans"], arm["first"], arm["trials"], arm["kept"]
    place_target(T, arm)
    found, doubt, meeting = 0, 1, False
    first[0] = 1.0
    for trial in range(CROWDED_ATTEMPTS * trials):
        if trial == ATTEMPTS * trials and (
            how_many_below(kept, found, CROWDED) == 0 or how_many_below(kept, found, SINGULAR) > 0
        ):
            break
        e = trial % trials
        if e == 0 and trial > 0:
            # where solutions crowd, each attempt takes it further
            nudge(arm["chain"][5], NUDGE if trial == trials else -1.7 * NUDGE)
        eliminate(e, arm)
        before, retried, seeded = found, 0, 0.0
        count = find_roots(arm)
        if count < 0:
            continue
        meeting = meeting or how_many_below(arm["slopes"], count, -1.0) > 0
        meeting = meeting or spans[0, 0] >= DEEP
        exact = how_many_below(arm["slopes"], count, 0.0)
        # a double root has no slope
        simple = count - how_many_below(arm["slopes"], count, 1e-300)
        if count > 0:
            found, retried, seeded = follow(e, count, found, out_q, out_residual, arm)
            if trial == 0:
                first[0], first[1] = seeded, spans[0, 0]
        whole = retried + exact == 0 or (trial < trials and accounted(e, count, found, out_q, arm))
        apart = before > 0 and trial >= trials and how_many_below(kept, found, CROWDED) == 0
        clear = spans[1, 0] == 0.0 and (whole or apart)
        sure = seeded < COARSE if before == 0 else found == before
        fits = found % 2 == 0 and found >= simple and found + trial > 0
        if clear and sure and fits and how_many_below(kept, found, SINGULAR) == 0:
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
    if arm["ready"] == 0:
        prepare(arm)
        arm["ready"] = 1
    for m in range(Ts.shape[0]):
        count[m], doubt[m] = _solve_pose(Ts[m], q[m], residual[m], arm)


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
    if arm["ready"] == 0:
        prepare(arm)
        arm["ready"] = 1
    for m in range(Ts.shape[0]):
        rows = q[m], residual[m], branch[m], free[m]
        found, doubt = _solve_pose(Ts[m], q[m], residual[m], arm)
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
