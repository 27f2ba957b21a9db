"""Many poses side by side: what the vectorised closed forms share.

A block holds up to ``LANES`` poses, one a lane. Quantities are rows of one flat array,
``S[BLOCK * row + lane]``, and every loop over the lanes is straight code without branches, which
the compiler turns into vector instructions. A lane where a root nearly merges, an axis nearly
lines up, a limit is nearly touched or a residual is not at rounding is marked as dirty, and its
pose is solved again by the careful scalar kernel: here is no code for edges.

Where four arms of a pose are lanes too, arm ``k`` of lane ``i`` is lane ``k n + i`` of a block of
``n`` poses: also the arms of one pose are worked out side by side.

Of the angles of an arm some are mirror images of others; only the others need an arctangent.
"""

import math

from dh2urdf.kernels.certificate import CLUSTER, TWO_PI
from dh2urdf.kernels.newton import POLISH
from dh2urdf.kernels.numbers import arctangent, side_by_side
from dh2urdf.kernels.rigid import dot, minus

LANES = 32
ARMS, POSES = 4, 16
BLOCK = 72
"""Poses of a block; where arms are lanes, arms of a pose and poses of a block; and numbers from row
to row: an odd number of cache lines, so that the rows of one pose do not all fall into the same
places of the cache."""

CLEAR = 1e-6
"""Sine of an angle from which a lane is clean."""

MERGED = CLEAR * CLEAR
"""Relative distance inside a rim from which a lane is clean; outside it, it is the slack that the
careful kernel allows."""

POSE, DIRTY, COS = 0, 12, 13
SIN = COS + 24
TURN = BLOCK * (SIN - COS)
VALUES = SIN + 24
INSIDE = VALUES + 48
VALID = INSIDE + 48
RESIDUAL = VALID + 8
WORK = RESIDUAL + 8
LEFT, UP = WORK, WORK + 1
ROWS = WORK + 64
"""Rows of a block: the pose (twelve), the dirt, cosines and sines of up to 24 angles, joint values
of up to eight solutions, joint by joint, whether these are inside their limits, and of each
solution whether it exists and its residual; the rest belongs to the family."""

ROUND = 1.5 * 2.0**52
"""Added to a number and taken away again, it rounds it to an integer."""

PER_TURN = 1.0 / TWO_PI

OWN, SAME, HALF_TURN, NEGATED = range(4)
"""How the values of a row are found: from a row's cosines and sines; they are those of another row,
half a turn from them, or the negatives."""


def at(k):
    """Where row k starts."""
    return BLOCK * k


def column(S, start, step):
    """Three entries of S, ``step`` apart."""
    return S[start], S[start + step], S[start + 2 * step]


def turned(c, s, x, y):
    """The axes x, y of a frame after ``Rot_z``, by cosine and sine."""
    (x0, x1, x2), (y0, y1, y2) = x, y
    x = c * x0 + s * y0, c * x1 + s * y1, c * x2 + s * y2
    return x, (c * y0 - s * x0, c * y1 - s * x1, c * y2 - s * x2)


def turned_and_tilted(c, s, ca, sa, x, y, z):
    """The axes x, y, z of a frame after ``Rot_z Rot_x(alpha)``, by cosines and sines."""
    x, (y0, y1, y2) = turned(c, s, x, y)
    z0, z1, z2 = z
    y = ca * y0 + sa * z0, ca * y1 + sa * z1, ca * y2 + sa * z2
    return x, y, (ca * z0 - sa * y0, ca * z1 - sa * y1, ca * z2 - sa * y2)


def stepped(p, a, x, d, z):
    """``p + a x + d z``."""
    return p[0] + a * x[0] + d * z[0], p[1] + a * x[1] + d * z[1], p[2] + a * x[2] + d * z[2]


def planar_arm(upper, fore, side, x, y, slack):
    """Both joints of a planar RR arm (lecture notes 8.2), the second with the sign ``side``.

    Returns c2, s2, c3, s3, whether (x, y) is within reach, and whether it is dirty: near a rim or
    near the first axis.
    """
    scale = 2.0 * upper * fore
    square = x * x + y * y
    outer = (upper + fore) * (upper + fore) - square
    inner = square - (upper - fore) * (upper - fore)
    product = outer * inner
    c3 = 0.5 * (inner - outer) / scale
    s3 = side * math.sqrt(max(product, 0.0)) / abs(scale)
    along, across = upper + fore * c3, fore * s3
    inverse = 1.0 / math.sqrt(max(square * (along * along + across * across), 1e-60))
    c2, s2 = (x * along + y * across) * inverse, (y * along - x * across) * inverse
    size = square + abs(scale)
    touching = -slack * size * size < product < MERGED * size * size
    return c2, s2, c3, s3, product > 0.0, touching or square < MERGED * size


def load_poses(ends, lift, Ts, first, n, S):
    """Frame 6 in frame 0 (moved up by ``lift``), ``base^-1 T tool^-1``, to the rows of the pose."""
    B, E = ends[0], ends[1]
    for i in side_by_side(n):
        T = Ts[first + i]
        for r in range(3):
            a, b, c, t = B[r, 0], B[r, 1], B[r, 2], B[r, 3]
            x = a * T[0, 0] + b * T[1, 0] + c * T[2, 0]
            y = a * T[0, 1] + b * T[1, 1] + c * T[2, 1]
            z = a * T[0, 2] + b * T[1, 2] + c * T[2, 2]
            p = a * T[0, 3] + b * T[1, 3] + c * T[2, 3] + t
            S[BLOCK * (3 * r) + i] = x * E[0, 0] + y * E[1, 0] + z * E[2, 0]
            S[BLOCK * (3 * r + 1) + i] = x * E[0, 1] + y * E[1, 1] + z * E[2, 1]
            S[BLOCK * (3 * r + 2) + i] = x * E[0, 2] + y * E[1, 2] + z * E[2, 2]
            S[BLOCK * (9 + r) + i] = p + x * E[0, 3] + y * E[1, 3] + z * E[2, 3]
        S[BLOCK * 11 + i] -= lift
        S[BLOCK * DIRTY + i] = 0.0


def share(first, last, n, S):
    """Give what n lanes have in some rows to as many lanes behind them."""
    for row in range(first, last):
        for i in side_by_side(n):
            S[BLOCK * row + n + i] = S[BLOCK * row + i]


def sides(n, S):
    """The arms of every lane: ``LEFT`` is 1 or -1 by turns, ``UP`` by pairs."""
    for arm in range(ARMS):
        lane, left, up = n * arm, 1.0 - 2.0 * (arm & 1), 1.0 - 2.0 * (arm >> 1)
        for i in side_by_side(n):
            S[BLOCK * LEFT + lane + i], S[BLOCK * UP + lane + i] = left, up


def measure(form, tool, n, S, solution, t1, t2, t3, t4, t5, t6):
    """Residual of one solution of every lane by forward kinematics, t1 ... t6 its angles' rows.

    The product of the Denavit-Hartenberg rows against the pose, carried to the tool by its
    offset; joint 3 may slide, by what is in the place of its value. The angle is that of
    ``|R - R_target|_F = 2 sqrt(2) sin(angle / 2)``.
    """
    a1, ca1, sa1 = form[0, 0], form[0, 1], form[0, 2]
    a2, ca2, sa2, d2 = form[1, 0], form[1, 1], form[1, 2], form[1, 3]
    a3, ca3, sa3, d3 = form[2, 0], form[2, 1], form[2, 2], form[2, 3]
    a4, ca4, sa4, d4 = form[3, 0], form[3, 1], form[3, 2], form[3, 3]
    a5, ca5, sa5, d5 = form[4, 0], form[4, 1], form[4, 2], form[4, 3]
    u, v, w = tool[0, 3], tool[1, 3], tool[2, 3]
    slides, value = form[2, 5] != 0.0, at(VALUES + t3)
    t1, t2, t3 = at(COS + t1), at(COS + t2), at(COS + t3)
    t4, t5, t6 = at(COS + t4), at(COS + t5), at(COS + t6)
    valid, result = at(VALID + solution), at(RESIDUAL + solution)
    for i in side_by_side(n):
        c, s = S[t1 + i], S[TURN + t1 + i]
        x, y, z = (c, s, 0.0), (-ca1 * s, ca1 * c, sa1), (sa1 * s, -sa1 * c, ca1)
        p = a1 * c + d2 * z[0], a1 * s + d2 * z[1], d2 * z[2]
        x, y, z = turned_and_tilted(S[t2 + i], S[TURN + t2 + i], ca2, sa2, x, y, z)
        slid = S[value + i]
        p = stepped(p, a2, x, slid if slides else d3, z)
        x, y, z = turned_and_tilted(S[t3 + i], S[TURN + t3 + i], ca3, sa3, x, y, z)
        p = stepped(p, a3, x, d4, z)
        x, y, z = turned_and_tilted(S[t4 + i], S[TURN + t4 + i], ca4, sa4, x, y, z)
        p = stepped(p, a4, x, d5, z)
        x, y, z = turned_and_tilted(S[t5 + i], S[TURN + t5 + i], ca5, sa5, x, y, z)
        e, f = turned(S[t6 + i], S[TURN + t6 + i], x, y)
        e, f = minus(e, column(S, i, BLOCK * 3)), minus(f, column(S, BLOCK + i, BLOCK * 3))
        g = minus(z, column(S, BLOCK * 2 + i, BLOCK * 3))
        p = minus(stepped(p, a5, x, w, g), column(S, BLOCK * 9 + i, BLOCK))
        p = stepped(p, u, e, v, f)
        turn = dot(e, e) + dot(f, f) + dot(g, g)
        error = math.sqrt(max(dot(p, p), 0.5 * turn))
        S[result + i] = error
        exists = S[valid + i] > 0.0
        rounding = error <= POLISH
        S[BLOCK * DIRTY + i] += 1.0 if exists and not rounding else 0.0


def _values(form, joints, angles, within_limits, arms, n, S):
    """Joint values of all angles, in the turn nearest to the middle of the limits, and slides."""
    for r in range(angles.shape[0]):
        j, source, kind, lanes = r % 6, angles[r, 0], angles[r, 1], n * angles[r, 2]
        sign, constant, lower, upper = form[j, 6], form[j, 4], joints[j, 1], joints[j, 2]
        middle, slides = _middle(lower, upper), form[j, 5] != 0.0
        sine, cosine = at(SIN + source), at(COS + source)
        target, other = at(VALUES + r), at(VALUES + source)
        if kind == SAME:
            for i in side_by_side(lanes):
                S[target + i] = S[other + i]
                S[at(INSIDE + r) + i] = S[at(INSIDE + source) + i]
            continue
        if slides:
            for i in side_by_side(lanes):
                S[target + i] = sign * (S[target + i] - form[j, 3])
        elif kind == HALF_TURN:
            for i in side_by_side(lanes):
                value = S[other + i]
                S[target + i] = value - math.copysign(math.pi, value - middle)
        elif kind == NEGATED:
            twice = 2.0 * sign * constant
            for i in side_by_side(lanes):
                S[target + i] = _turned_to(middle, -twice - S[other + i])
        else:
            for i in side_by_side(lanes):
                angle = arctangent(S[sine + i], S[cosine + i])
                S[target + i] = _turned_to(middle, sign * (angle - constant))
        if angles[r, 2] < arms:
            share(VALUES + r, VALUES + r + 1, lanes, S)
        flag = at(INSIDE + r)
        if not slides and not _limited(lower, upper):
            for i in side_by_side(arms * n):
                S[flag + i] = 1.0
        elif within_limits:
            for i in side_by_side(arms * n):
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


def emit(form, joints, angles, within_limits, place, named, first, n, S, out):
    """Write the solutions of all clean poses, joint j to column ``place[j]``; how many are clean.

    The others get a count of -1. A solution that does not exist is written over by the next one.
    ``angles`` (48, 12 or 5, 3), for each joint of each solution, or of each wrist of the four arms
    that are lanes: what row its values are found from, how, and in how many arms they differ.
    ``named``: branches have the number of their solution, else -1.
    """
    (q, residual, count, branch, free), clean = out, 0
    width = place.shape[0]
    sets = angles.shape[0] // width
    arms = min(8 // sets, ARMS)
    _values(form, joints, angles, within_limits, arms, n, S)
    for k in range(sets if within_limits else 0):
        valid, inside = at(VALID + k), at(INSIDE + 6 * k)
        for j in range(width):
            for i in side_by_side(arms * n):
                S[valid + i] *= S[inside + BLOCK * j + i]
    for arm in range(1, arms):
        for i in side_by_side(n):
            S[BLOCK * DIRTY + i] += S[BLOCK * DIRTY + n * arm + i]
    for i in side_by_side(n):
        found, row, solution = 0, first + i, 0
        for k in range(sets):
            for arm in range(arms):
                lane = n * arm + i
                values = at(VALUES + 6 * k) + lane
                for j in range(width):
                    q[row, found, place[j]] = S[values + BLOCK * j]
                residual[row, found] = S[BLOCK * (RESIDUAL + k) + lane]
                branch[row, found], free[row, found] = solution if named else -1, 0
                found += 1 if S[BLOCK * (VALID + k) + lane] > 0.0 else 0
                solution += 1
        rough = S[BLOCK * DIRTY + i] != 0.0
        count[row] = -1 if rough else found
        clean += 0 if rough else 1
    return clean
