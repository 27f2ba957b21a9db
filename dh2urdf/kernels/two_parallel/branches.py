"""From a value of joint 1 to seeds for all joints: four branches, three ways to close each.

A branch is a side for each of the unit vectors m and w. They give joints 4 and 5; joints 2 and 3
follow by the direction of axis 6, which they turn in their plane, or by the planar arm:

- as a rule the direction gives their sum, and the planar arm reaches for the right branch only;
- axis 6 is (nearly) parallel to 2 and 3: it has no direction there, but both elbows reach;
- axis 5 is (nearly) parallel to 2 and 3: only the sum of joints 2, 3 and 5 (or a difference) is
  known, from the direction; both elbows reach for where axis 5 has to be.
"""

import math

from dh2urdf.kernels.numbers import LANES, side_by_side
from dh2urdf.kernels.rigid import dot, minus
from dh2urdf.kernels.two_parallel.polynomial import cross, seen_from, vector

Z = (0.0, 0.0, 1.0)

MOST = 20
"""Most seeds at one value of joint 1, where they are made widely."""

FIT, GAP, SEEDS = 12, 13, 14
"""Rows of a branch below six cosines and six sines: how badly it fits, and the square of a sine,
which may be negative; the number of rows."""

TOGETHER = LANES
"""Values of joint 1 that are looked at together, a multiple of eight."""

BEYOND = 1e-6
WIDELY_BEYOND = 0.1
"""By how much the square of a sine may be negative."""

MISFIT = 1e-3
WIDE_MISFIT = 0.3
"""By how much the planar arm may fail to reach, squares in parts of those of its links: a wrong
branch fails by about one."""

PARALLEL = 0.1
"""Square of the sine between an axis and axes 2 and 3 below which these count as nearly parallel,
where seeds are made widely."""


def _directions(a, b, x, y):
    """Unit vectors v with ``v.a = x, v.b = y``: ``middle +- way``, and the square that way has.

    As a part of 1; where it is negative, ``way`` is zero.
    """
    aa, ab, bb = dot(a, a), dot(a, b), dot(b, b)
    square = aa * bb - ab * ab
    f, g = (x * bb - y * ab) / square, (y * aa - x * ab) / square
    gap = 1.0 - f * x - g * y
    n, h = cross(a, b), math.sqrt(max(gap, 0.0) / square)
    middle = f * a[0] + g * b[0], f * a[1] + g * b[1], f * a[2] + g * b[2]
    return middle, (h * n[0], h * n[1], h * n[2]), gap


def _beside(middle, way, side):
    """One of two directions."""
    return middle[0] + side * way[0], middle[1] + side * way[1], middle[2] + side * way[2]


def _turn(axis, v, w):
    """Cosine and sine of the angle about a unit axis that turns v to w."""
    x, y = dot(v, w) - dot(v, axis) * dot(w, axis), dot(axis, cross(v, w))
    size = math.sqrt(x * x + y * y)
    none = 1.0 if size < 1e-150 else 0.0
    return (x + none) / (size + none), y / (size + none)


def _turned(axis, c, s, v):
    """A vector turned about a unit axis."""
    n, d = cross(axis, v), (1.0 - c) * dot(axis, v)
    return (
        c * v[0] + s * n[0] + d * axis[0],
        c * v[1] + s * n[1] + d * axis[1],
        c * v[2] + s * n[2] + d * axis[2],
    )


def _plus(v, w):
    """Sum."""
    return v[0] + w[0], v[1] + w[1], v[2] + w[2]


def _minus_angle(a, b):
    """Cosine and sine of the difference of two angles."""
    return a[0] * b[0] + a[1] * b[1], a[1] * b[0] - a[0] * b[1]


def _others(form, seen, one, turns):
    """Joint 3, joint 6: from joint 1 and joint 2, joints 2 and 3, joint 4, joint 5."""
    _, axes, _, _, _, _ = form
    two, both, four, five = turns
    v = _turned(Z, both[0], -both[1], seen_from(seen, 6, one[0], one[1]))
    v = _turned(vector(axes[3]), four[0], -four[1], v)
    v = _turned(vector(axes[4]), five[0], -five[1], v)
    return _minus_angle(both, two), _turn(vector(axes[5]), vector(axes[6]), v)


def _put(form, i, c, s, lane, arm):
    """Write cosine and sine of axis i of a seed."""
    _, _, _, joints, signs, _ = form
    at = joints[i] * LANES + lane
    arm["cosines"][at], arm["sines"][at] = c, signs[i] * s


def _store(form, seen, one, turns, lane, arm):
    """Write a seed."""
    (two, _, four, five), (three, six) = turns, _others(form, seen, one, turns)
    _put(form, 0, one[0], one[1], lane, arm)
    _put(form, 1, two[0], two[1], lane, arm)
    _put(form, 2, three[0], three[1], lane, arm)
    _put(form, 3, four[0], four[1], lane, arm)
    _put(form, 4, five[0], five[1], lane, arm)
    _put(form, 5, six[0], six[1], lane, arm)


def _elbow(r2, u, v, side):
    """Joint 2 and the sum of joints 2 and 3 of a planar arm r2, v that reaches u, one elbow.

    Before them whether it does, more or less.
    """
    upper, fore = r2[0] * r2[0] + r2[1] * r2[1], v[0] * v[0] + v[1] * v[1]
    product = math.sqrt(upper * fore) + 1e-300
    c = 0.5 * (u[0] * u[0] + u[1] * u[1] - upper - fore) / product
    reaches = abs(c) < 1.0 + WIDELY_BEYOND
    c = min(max(c, -1.0), 1.0)
    s, ratio = side * math.sqrt(1.0 - c * c), fore / product
    x, y = ratio * (c * r2[0] - s * r2[1]), ratio * (s * r2[0] + c * r2[1])
    two = _turn(Z, (r2[0] + x, r2[1] + y, 0.0), u)
    return reaches, two, _turn(Z, v, _turned(Z, two[0], two[1], (x, y, 0.0)))


def _reach(form, seen, one, m, w):
    """By the direction of axis 6: joint 2, joints 2 and 3, joint 4, joint 5.

    Before them how badly the planar arm reaches, squares in parts of those of its links.
    """
    _, axes, steps, _, _, _ = form
    h4, h5, h6 = vector(axes[3]), vector(axes[4]), vector(axes[5])
    r2, r3, r4, r5 = vector(steps[2]), vector(steps[3]), vector(steps[4]), vector(steps[5])
    u, l6 = seen_from(seen, 0, one[0], one[1]), seen_from(seen, 3, one[0], one[1])
    four, five = _turn(h4, m, Z), _turn(h5, w, m)
    l4 = _turned(h4, four[0], four[1], _turned(h5, five[0], five[1], h6))
    far = _turned(h4, four[0], four[1], _plus(r4, _turned(h5, five[0], five[1], r5)))
    v, both = _plus(r3, far), _turn(Z, l4, l6)
    rest = minus(u, _turned(Z, both[0], both[1], v))
    square = dot(r2, r2)
    misfit = abs(rest[0] * rest[0] + rest[1] * rest[1] - square)
    size = square + v[0] * v[0] + v[1] * v[1]
    return misfit / size, (_turn(Z, r2, rest), both, four, five)


def _lay(form, seen, hidden, k, seeds):
    """Complete lane k of a branch, of which its first six rows have m and w."""
    one = hidden[0, k], hidden[1, k]
    m, w = (seeds[0, k], seeds[1, k], seeds[2, k]), (seeds[3, k], seeds[4, k], seeds[5, k])
    misfit, turns = _reach(form, seen, one, m, w)
    (two, _, four, five), (three, six) = turns, _others(form, seen, one, turns)
    seeds[0, k], seeds[6, k] = one
    seeds[1, k], seeds[7, k] = two
    seeds[2, k], seeds[8, k] = three
    seeds[3, k], seeds[9, k] = four
    seeds[4, k], seeds[10, k] = five
    seeds[5, k], seeds[11, k] = six
    seeds[FIT, k] = misfit


def lay_branch(form, seen, hidden, n, sides, seeds):
    """One branch at n values of joint 1, cosines and sines ``hidden`` (2, 24), to seeds (14, n).

    Cosines and sines of the six axes, how badly the planar arm reaches, and a square that should
    not be negative.
    """
    _, axes, steps, _, _, _ = form
    h4, h5, h6 = vector(axes[3]), vector(axes[4]), vector(axes[5])
    r4, r5, height = vector(steps[4]), vector(steps[5]), steps[3, 2]
    first, second = sides
    if dot(r4, r4) == 0.0:
        for k in side_by_side(n):
            u = seen_from(seen, 0, hidden[0, k], hidden[1, k])
            l6 = seen_from(seen, 3, hidden[0, k], hidden[1, k])
            middle, way, gap = _directions(h6, r5, l6[2], u[2] - height)
            w = _beside(middle, way, first)
            at, across, rest = _directions(h4, h5, h4[2], dot(w, h5))
            seeds[0, k], seeds[1, k], seeds[2, k] = _beside(at, across, second)
            seeds[3, k], seeds[4, k], seeds[5, k] = w
            seeds[GAP, k] = min(gap, rest)
    else:
        for k in side_by_side(n):
            u = seen_from(seen, 0, hidden[0, k], hidden[1, k])
            l6 = seen_from(seen, 3, hidden[0, k], hidden[1, k])
            middle, way, gap = _directions(h4, r4, h4[2], u[2] - height)
            m = _beside(middle, way, first)
            at, across, rest = _directions(h5, h6, dot(m, h5), l6[2])
            seeds[0, k], seeds[1, k], seeds[2, k] = m
            seeds[3, k], seeds[4, k], seeds[5, k] = _beside(at, across, second)
            seeds[GAP, k] = min(gap, rest)
    for k in side_by_side(n):
        _lay(form, seen, hidden, k, seeds)


def take_seed(form, seeds, k, wide, lane, arm):
    """Append lane k of a branch, if it fits; the number of seeds."""
    if not seeds[FIT, k] < (WIDE_MISFIT if wide else MISFIT):
        return lane
    if not seeds[GAP, k] >= (-WIDELY_BEYOND if wide else -BEYOND):
        return lane
    for i in range(6):
        _put(form, i, seeds[i, k], seeds[6 + i, k], lane, arm)
    return lane + 1


def take_elbows(form, seen, seeds, k, lane, arm):
    """Append both elbows of lane k, where axis 6 or 5 is nearly parallel to 2 and 3."""
    _, axes, steps, _, _, _ = form
    h4, h5, h6 = vector(axes[3]), vector(axes[4]), vector(axes[5])
    r2, r3, r4, r5 = vector(steps[2]), vector(steps[3]), vector(steps[4]), vector(steps[5])
    one, four = (seeds[0, k], seeds[6, k]), (seeds[3, k], seeds[9, k])
    five = seeds[4, k], seeds[10, k]
    u, l6 = seen_from(seen, 0, one[0], one[1]), seen_from(seen, 3, one[0], one[1])
    if not seeds[GAP, k] >= -WIDELY_BEYOND:
        return lane
    if l6[0] * l6[0] + l6[1] * l6[1] < PARALLEL:
        far = _turned(h4, four[0], four[1], _plus(r4, _turned(h5, five[0], five[1], r5)))
        for i in range(2):
            reaches, two, both = _elbow(r2, u, _plus(r3, far), 1.0 - 2.0 * i)
            if reaches:
                _store(form, seen, one, (two, both, four, five), lane, arm)
                lane += 1
    axis5 = _turned(h4, four[0], four[1], h5)
    if axis5[0] * axis5[0] + axis5[1] * axis5[1] < PARALLEL:
        psi = _turn(Z, _turned(h4, four[0], four[1], h6), l6)
        last = _turned(Z, psi[0], psi[1], _turned(h4, four[0], four[1], r5))
        near, side = _plus(r3, _turned(h4, four[0], four[1], r4)), math.copysign(1.0, axis5[2])
        for i in range(2):
            reaches, two, both = _elbow(r2, minus(u, last), near, 1.0 - 2.0 * i)
            if reaches:
                c, s = _minus_angle(psi, both)
                _store(form, seen, one, (two, both, four, (c, side * s)), lane, arm)
                lane += 1
    return lane
