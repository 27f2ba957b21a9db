"""From a value of joint 1 to seeds for all joints: four branches, three ways to close each.

A branch is a side for each of the unit vectors m and w. They give joints 4 and 5; joints 2 and 3
follow by the direction of axis 6, which they turn in their plane, or by the planar arm:

- as a rule the direction gives their sum, and the planar arm reaches for the right branch only;
- axis 6 is (nearly) parallel to 2 and 3: it has no direction there, but both elbows reach;
- axis 5 is (nearly) parallel to 2 and 3: only the sum of joints 2, 3 and 5 (or a difference) is
  known, from the direction; both elbows reach for where axis 5 has to be.
"""

import math

from dh2urdf.kernels.numbers import LANES
from dh2urdf.kernels.rigid import dot, minus
from dh2urdf.kernels.two_parallel.polynomial import cross, seen_from, vector

Z = (0.0, 0.0, 1.0)

MOST = 20
"""Most seeds at one value of joint 1."""

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
    return (1.0, 0.0) if size < 1e-150 else (x / size, y / size)


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


def _store(form, seen, turns, lane, arm):
    """Write a seed: cosines and sines of joint 1, joint 2, joints 2 and 3, joint 4, joint 5."""
    _, axes, _, joints, signs, _ = form
    one, two, both, four, five = turns
    h6, across = vector(axes[5]), vector(axes[6])
    v = _turned(Z, both[0], -both[1], seen_from(seen, 6, one[0], one[1]))
    v = _turned(vector(axes[3]), four[0], -four[1], v)
    v = _turned(vector(axes[4]), five[0], -five[1], v)
    three, six = _minus_angle(both, two), _turn(h6, across, v)
    for i in range(6):
        c, s = one
        if i == 1:
            c, s = two
        elif i == 2:
            c, s = three
        elif i == 3:
            c, s = four
        elif i == 4:
            c, s = five
        elif i == 5:
            c, s = six
        at = joints[i] * LANES + lane
        arm["cosines"][at], arm["sines"][at] = c, signs[i] * s


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


def _close(form, seen, one, m, w, wide, lane, arm):
    """Append the seeds of the branch m, w at a value of joint 1; their number."""
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
    if misfit < size * (WIDE_MISFIT if wide else MISFIT):
        _store(form, seen, (one, _turn(Z, r2, rest), both, four, five), lane, arm)
        lane += 1
    if wide and l6[0] * l6[0] + l6[1] * l6[1] < PARALLEL:
        for k in range(2):
            reaches, two, both = _elbow(r2, u, v, 1.0 - 2.0 * k)
            if reaches:
                _store(form, seen, (one, two, both, four, five), lane, arm)
                lane += 1
    axis5 = _turned(h4, four[0], four[1], h5)
    if wide and axis5[0] * axis5[0] + axis5[1] * axis5[1] < PARALLEL:
        psi = _turn(Z, _turned(h4, four[0], four[1], h6), l6)
        last = _turned(Z, psi[0], psi[1], _turned(h4, four[0], four[1], r5))
        near, side = _plus(r3, _turned(h4, four[0], four[1], r4)), math.copysign(1.0, axis5[2])
        for k in range(2):
            reaches, two, both = _elbow(r2, minus(u, last), near, 1.0 - 2.0 * k)
            if reaches:
                c, s = _minus_angle(psi, both)
                _store(form, seen, (one, two, both, four, (c, side * s)), lane, arm)
                lane += 1
    return lane


def add_branches(form, seen, one, wide, lane, arm):
    """Append to the lanes the seeds at a value of joint 1, cosine and sine ``one``.

    Where ``wide``, also those that fit badly or belong to special positions. Their number.
    """
    _, axes, steps, _, _, _ = form
    h4, h5, h6 = vector(axes[3]), vector(axes[4]), vector(axes[5])
    r4, r5 = vector(steps[4]), vector(steps[5])
    u, l6 = seen_from(seen, 0, one[0], one[1]), seen_from(seen, 3, one[0], one[1])
    c1, c2, least = l6[2], u[2] - steps[3, 2], -WIDELY_BEYOND if wide else -BEYOND
    first = dot(r4, r4) == 0.0
    if first:
        middle, way, gap = _directions(h6, r5, c1, c2)
    else:
        middle, way, gap = _directions(h4, r4, h4[2], c2)
    if gap < least:
        return lane
    for i in range(2):
        v = _beside(middle, way, 1.0 - 2.0 * i)
        if first:
            at, across, gap = _directions(h4, h5, h4[2], dot(v, h5))
        else:
            at, across, gap = _directions(h5, h6, dot(v, h5), c1)
        if gap < least:
            continue
        for j in range(2):
            w = _beside(at, across, 1.0 - 2.0 * j)
            if first:
                lane = _close(form, seen, one, w, v, wide, lane, arm)
            else:
                lane = _close(form, seen, one, v, w, wide, lane, arm)
    return lane
