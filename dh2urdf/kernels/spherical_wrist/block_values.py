"""Many poses side by side: from cosines and sines to the solutions that a family hands over.

Layout and lanes are those of :mod:`dh2urdf.kernels.spherical_wrist.block_arithmetic`. Of the angles
of an arm some are mirror images of others; only the others need an arctangent.
"""

import math

import numpy as np

from dh2urdf.kernels.certificate import CLUSTER, TWO_PI
from dh2urdf.kernels.numbers import arctangent, side_by_side
from dh2urdf.kernels.spherical_wrist.block_arithmetic import (
    BLOCK,
    COS,
    DIRTY,
    INSIDE,
    RESIDUAL,
    SIN,
    VALID,
    VALUES,
    at,
)

ROUND = 1.5 * 2.0**52
"""Added to a number and taken away again, it rounds it to an integer."""

PER_TURN = 1.0 / TWO_PI

OWN, HALF_TURN, NEGATED = range(3)
"""How the angle of a row is found: from its cosine and sine; half a turn from that of another row;
the negative of another."""

MIRRORS = np.array(
    [(r, OWN) for r in range(22)]
    + [(r, HALF_TURN if r < 14 or r >= 18 else NEGATED) for r in range(10, 22)]
)
"""Of 34 angles of which 10 to 21 are the wrist's, joint by joint, the rest the other wrist's:
``(q4 + pi, -q5, q6 + pi)``."""


def _values(form, joints, table, within_limits, n, S):
    """Joint values of all angles, in the turn nearest to the middle of the limits."""
    joint_of, _, mirror_of = table
    for r in range(joint_of.shape[0]):
        j, source, kind = joint_of[r], mirror_of[r, 0], mirror_of[r, 1]
        sign, constant, lower, upper = form[j, 6], form[j, 4], joints[j, 1], joints[j, 2]
        middle = _middle(lower, upper)
        sine, cosine = at(SIN + source), at(COS + source)
        target, other = at(VALUES + r), at(VALUES + source)
        if kind == HALF_TURN:
            for i in side_by_side(n):
                value = S[other + i]
                S[target + i] = value - math.copysign(math.pi, value - middle)
        elif kind == NEGATED:
            twice = 2.0 * sign * constant
            for i in side_by_side(n):
                S[target + i] = _turned_to(middle, -twice - S[other + i])
        else:
            for i in side_by_side(n):
                angle = arctangent(S[sine + i], S[cosine + i])
                S[target + i] = _turned_to(middle, sign * (angle - constant))
        flag = at(INSIDE + r)
        if not _limited(lower, upper):
            for i in side_by_side(n):
                S[flag + i] = 1.0
        elif within_limits:
            for i in side_by_side(n):
                room = min(S[target + i] - lower, upper - S[target + i])
                S[flag + i] = 1.0 if room >= 0.0 else 0.0
                touching = abs(room) < CLUSTER
                S[BLOCK * DIRTY + i] += 1.0 if touching else 0.0


def _turned_to(middle, value):
    """The value in the turn nearest to ``middle``."""
    turns = (value - middle) * PER_TURN
    return value - TWO_PI * ((turns + ROUND) - ROUND)


def _middle(lower, upper):
    """Where the values of a joint lie around."""
    return 0.5 * (lower + upper) if upper - lower < math.inf else 0.0


def _limited(lower, upper):
    """Whether the limits leave out a part of the turn around their middle."""
    middle = _middle(lower, upper)
    return lower > middle - math.pi or upper < middle + math.pi


def _settle(form, joints, table, within_limits, n, S):
    """Joint values of all lanes, and which solutions there are with these."""
    row_of = table[1]
    _values(form, joints, table, within_limits, n, S)
    if not within_limits:
        return
    for k in range(8):
        valid, row = at(VALID + k), row_of[k]
        a, b, c = at(INSIDE + row[0]), at(INSIDE + row[1]), at(INSIDE + row[2])
        d, e, f = at(INSIDE + row[3]), at(INSIDE + row[4]), at(INSIDE + row[5])
        for i in side_by_side(n):
            S[valid + i] *= S[a + i] * S[b + i] * S[c + i] * S[d + i] * S[e + i] * S[f + i]


def emit(form, joints, table, within_limits, place, named, first, n, S, out):
    """Write the solutions of all clean lanes, joint j to column ``place[j]``; how many are clean.

    The others get a count of -1. A solution that does not exist is written over by the next one.
    ``table`` (rows,), (8, 6), (rows, 2): joint of each angle; row of each solution's angle of each
    joint; row whose angle it is or mirrors, and how. ``named``: branches have the number of their
    solution, else -1.
    """
    _settle(form, joints, table, within_limits, n, S)
    return _write(place, table[1], named, first, n, S, out)


def _write(place, row_of, named, first, n, S, out):
    """The second half of :func:`emit`."""
    q, residual, count, branch, free = out
    clean = 0
    for i in side_by_side(n):
        found, row = 0, first + i
        for k in range(8):
            for j in range(6):
                q[row, found, place[j]] = S[at(VALUES + row_of[k, j]) + i]
            residual[row, found] = S[BLOCK * (RESIDUAL + k) + i]
            branch[row, found], free[row, found] = k if named else -1, 0
            found += 1 if S[BLOCK * (VALID + k) + i] > 0.0 else 0
        rough = S[BLOCK * DIRTY + i] != 0.0
        count[row] = -1 if rough else found
        clean += 0 if rough else 1
    return clean
