"""Solutions as they are found: a list without doubles, and whether every root has its own."""

import math

import numpy as np

from dh2urdf.kernels.certificate import TWO_PI

SAME = 1e-6
"""Solutions closer than this [rad] are one."""

SHARP = 1e-13
"""Residual above which a solution has not converged: it lies beside a double one."""

VALLEY = 100.0
"""Distance [rad] to the double solution, in square roots of such a residual."""

SINGULAR = 1e-6
"""Determinant of the Jacobian, in parts of size cubed, below which a solution is singular."""

MEMBERS = 8
"""Most singular solutions kept."""

AT_ROOT = 1e-4
"""Angle [rad] between a root and the hidden joint's value at a solution of it: double roots are
known to 1e-8 at best, to the root of that where four solutions nearly meet."""


def _closer(q, other, close, slides, size):
    """Whether all six joints of two configurations differ by less, slides in sizes of the arm."""
    for i in range(6):
        d = abs(q[i] - other[i])
        if (min(d, TWO_PI - d) if slides[i] == 0 else d / size) >= close:
            return False
    return True


def list_solution(found, out_q, out_residual, residual, determinant, arm):
    """List the configuration in ``q`` of the record, of such a residual, unless it is known.

    ``determinant``: of its Jacobian, in parts of the size cubed. Of a family of solutions only some
    members are kept, to leave room for the isolated ones. Returns the number of solutions, and the
    index of this one; -1 if there is no room.
    """
    size, q, kept, slides = arm["size"], arm["q"], arm["kept"], arm["slides"]
    place, singular, members = found, -1, 0
    for f in range(found):
        loose = max(residual, out_residual[f])
        close = SAME if loose < SHARP else VALLEY * math.sqrt(loose)
        if _closer(q, out_q[f], close, slides, size):
            place = f
            break
        if kept[f] < SINGULAR:
            singular = f
            members += 1
    if place == found:
        if determinant < SINGULAR and members >= MEMBERS:
            return found, singular
        if found == out_q.shape[0]:
            if singular < 0:
                return found, -1
            place = singular
    elif residual >= out_residual[place]:
        return found, place
    out_residual[place], kept[place] = residual, determinant
    out_q[place] = q
    return max(found, place + 1), place


def at_root(root, value):
    """Whether the hidden joint's value at a solution is a root."""
    gap = (value - root) / TWO_PI
    return abs(gap - np.floor(gap + 0.5)) < AT_ROOT / TWO_PI


def accounted(count, found, arm):
    """Whether every root has as many solutions with its value as it has multiplicity.

    The hidden joint's values at the solutions are in ``hidden_values`` of the record. Roots that
    did not have to be tried again do. A complex pair next to the real axis counts as a double root
    only where it has a solution.
    """
    roots, slopes, values = arm["roots"], arm["slopes"], arm["hidden_values"]
    for r in range(count):
        here, there = 0, 0
        for t in range(count):
            if abs(roots[t] - roots[r]) < AT_ROOT:
                here += 1 if slopes[t] > 0.0 else 2
        for f in range(found):
            there += 1 if at_root(roots[r], values[f]) else 0
        if there < here and (there > 0 or slopes[r] != 0.0):
            return False
    return True


def how_many_below(values, count, least):
    """How many of the first values are below the least."""
    below = 0
    for k in range(count):
        below += 1 if values[k] < least else 0
    return below
