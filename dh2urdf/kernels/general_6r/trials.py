"""When no more eliminations are tried at a pose, whose solutions are listed so far.

An elimination can fail for an arm (parallel axes make the determinant vanish) or lose precision
for a pose; so there are several, best first, and then rounds of all of them for poses nearby.
"""

from dh2urdf.kernels.general_6r.listing import SINGULAR, accounted, how_many_below
from dh2urdf.kernels.general_6r.roots import nudge

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


def begin_trial(trial, found, target, arm):
    """Take the target (3, 4) further if all eliminations have been tried at it; False: enough."""
    trials, kept = arm["trials"], arm["kept"]
    if trial == ATTEMPTS * trials and (
        how_many_below(kept, found, CROWDED) == 0 or how_many_below(kept, found, SINGULAR) > 0
    ):
        return False
    if trial > 0 and trial % trials == 0:
        # where solutions crowd, each attempt takes it further
        nudge(target, NUDGE if trial == trials else -1.7 * NUDGE)
    return True


def roots_meet(count, arm):
    """Whether some of the roots may stand for more than they seem to."""
    return how_many_below(arm["slopes"], count, -1.0) > 0 or arm["spans"][0, 0] >= DEEP


def is_last(trial, count, solutions, seeded, arm):
    """Whether all solutions are found as far as a trial with ``count`` roots can tell.

    ``solutions`` are how many were listed before it, how many are now, and how many roots had to
    be tried again; ``seeded`` is the largest error of the seeds.
    """
    (before, found, retried), trials, kept = solutions, arm["trials"], arm["kept"]
    exact = how_many_below(arm["slopes"], count, 0.0)
    # a double root has no slope
    simple = count - how_many_below(arm["slopes"], count, 1e-300)
    whole = retried + exact == 0 or (trial < trials and accounted(count, found, arm))
    apart = before > 0 and trial >= trials and how_many_below(kept, found, CROWDED) == 0
    clear = arm["spans"][1, 0] == 0.0 and (whole or apart)
    sure = seeded < COARSE if before == 0 else found == before
    # without any solution, not even a span of doubt is left to look into
    none = trial > 0 and arm["spans"][0, 0] == 0.0
    fits = found % 2 == 0 and found >= simple and (found > 0 or none)
    return clear and sure and fits and how_many_below(kept, found, SINGULAR) == 0
