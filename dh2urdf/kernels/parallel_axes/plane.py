"""An arm with three parallel axes, seen from the plane in which they turn.

Where axis 5 is in line, or nearly, with the parallel axes 1, 2, 3, rounding leaves more than one
pair of t4 and t5. With t4 off by e from where axis 5 is parallel to the three (``c4 = +-1``,
``k = sin(alpha3) c4``), height and slope of the pose (:mod:`dh2urdf.kernels.parallel_axes.pairs`)
become

    a5 k e cos(t5) = rise(e),    sin(alpha5) k e sin(t5) = slope(e).

They fix e badly where its root is double, and t5 worse, by the quotient; at e = 0 not at all. What
is left of t5 are arcs, on which the planar arm has to reach: each gives a pair of values.
"""

import math

import numpy as np

from dh2urdf.kernels.certificate import TWO_PI
from dh2urdf.kernels.numbers import asin, atan2, hypot, sincos
from dh2urdf.kernels.rigid import turned, turned_back
from dh2urdf.kernels.spherical_wrist import NICE

TRIALS = 64
"""Values at which t5 is tried, none of them a right angle, where other singularities may be."""

HALVINGS = 40
"""Steps that narrow the neighbourhood of a trial to some 1e-7."""

STEPS = 3
"""Values of e tried on either side of its root."""

MOST_ARCS = 8

ETA = 1e-15
"""What rounding does to height and slope, for an arm of about a metre."""


def seen_from_plane(form, first, c1, s1, x, y, z):
    """A vector of frame 0 in the frame of the parallel axes, which joint 1 turns or not."""
    if first == 0:
        return x, y, z
    x, y = c1 * x + s1 * y, c1 * y - s1 * x
    ca, sa = form[0, 1], form[0, 2]
    return x, ca * y + sa * z, ca * z - sa * y


def _to_frame_six(form, last, cs, x, z, origin):
    """The vector (x, 0, z) of the frame after the last parallel axis, seen in frame 6.

    ``origin`` 1.0: and on to frame 6's origin; 0.0: a direction.
    """
    y = 0.0
    for i in range(last + 1, 6):
        ca, sa = form[i - 1, 1], form[i - 1, 2]
        y, z = ca * y + sa * z, ca * z - sa * y
        c, s = cs[i, 0], cs[i, 1]
        x, y = c * x + s * y, c * y - s * x
        x += origin * form[i, 0]
        z += origin * form[i, 3]
    return x, y, z


def seen_arm(form, first, D, cs, origin):
    """The way from the last parallel axis to frame 6 (1.0), or that link's direction (0.0).

    Seen in the plane of the parallel axes.
    """
    x = form[first + 2, 0] if origin != 0.0 else 1.0
    x, y, z = _to_frame_six(form, first + 2, cs, x, 0.0, origin)
    u, v, w = turned(D, (x, y, z))
    return seen_from_plane(form, first, cs[0, 0], cs[0, 1], u, v, w)


def common_axis(form, first, D, cs):
    """The direction k of the parallel axes, seen in frame 6: ``k^T R``."""
    kx, ky, kz = 0.0, 0.0, 1.0
    if first == 1:
        kx, ky, kz = form[0, 2] * cs[0, 1], -form[0, 2] * cs[0, 0], form[0, 1]
    return turned_back(D, (kx, ky, kz))


def last_joint(form, first, D, cs):
    """Cosine and sine of t6 into cs: subproblem 1; the sine of axis 6 to the parallel axes.

    It turns their direction as it is before joint 6 to where the pose has it.
    """
    rx, ry, _ = common_axis(form, first, D, cs)
    cs[5, 0], cs[5, 1] = 1.0, 0.0
    x, y, _ = _to_frame_six(form, first + 2, cs, 0.0, 1.0, 0.0)
    in_line = hypot(rx, ry)
    c6, s6 = x * rx + y * ry, y * rx - x * ry
    r = hypot(c6, s6)
    if in_line <= NICE or r == 0.0:
        cs[5, 1], cs[5, 0] = sincos(form[5, 4])
    else:
        cs[5, 0], cs[5, 1] = c6 / r, s6 / r
    return in_line


def levels(form, D, rise, slope):
    """Height and slope of the pose D (3, 4) less those of the arm, linear in (1, c4, s4)."""
    ca3, sa3, a4, ca4, sa4 = form[2, 1], form[2, 2], form[3, 0], form[3, 1], form[3, 2]
    ca5, d5 = form[4, 1], form[4, 3]
    height = D[2, 3] - form[0, 3] - form[1, 3] - form[2, 3] - ca3 * form[3, 3]
    z0, z1 = ca3 * ca4, -sa3 * sa4
    rise[0], rise[1], rise[2] = height - d5 * z0, -d5 * z1, -sa3 * a4
    slope[0], slope[1], slope[2] = D[2, 2] - ca5 * z0, -ca5 * z1, 0.0


def _level(row, c4, e):
    """A row of :func:`levels` at an offset e from ``c4 = +-1``, without cancellation."""
    half = sincos(0.5 * e)[0]
    return row[0] + row[1] * c4 - 2.0 * row[1] * c4 * half * half + row[2] * c4 * sincos(e)[0]


def _common_direction(form, c4, e):
    """What the common direction of axes 1, 2, 3 has across axis 5, seen after joint 4."""
    k, half = form[2, 2] * c4, sincos(0.5 * e)[0]
    return k * sincos(e)[0], -2.0 * k * form[3, 1] * half * half


def _offset(lean, c5, s5):
    """The e that goes with t5, and whether height and slope are those of the pose to rounding."""
    form, _, _, rise, slope, c4, nominal = lean
    k, e = form[2, 2] * c4, nominal
    a, b = form[4, 0] * k * c5 - rise[2] * c4, form[4, 2] * k * s5
    square = a * a + b * b
    known = square > 1e-6 * k * k * (form[4, 0] * form[4, 0] + form[4, 2] * form[4, 2])
    for _ in range(3 if known else 1):
        fx, fy = _common_direction(form, c4, e)
        high = _level(rise, c4, e) - form[4, 0] * (fx * c5 + fy * s5)
        steep = _level(slope, c4, e) - form[4, 2] * (fx * s5 - fy * c5)
        if known:
            e += (a * high + b * steep) / square
    eta = ETA * max(1.0, abs(rise[0]) + abs(rise[1]))
    return e, abs(high) <= eta and abs(steep) <= eta


def _beyond(lean, e, c5, s5):
    """Set t4 and t5 in cs; how far the planar arm is from reaching, not positive if it does."""
    form, D, cs, _, _, c4, _ = lean
    s4 = sincos(e)[0]
    cs[3, 0], cs[3, 1] = c4 * math.sqrt((1.0 - s4) * (1.0 + s4)), c4 * s4
    cs[4, 0], cs[4, 1] = c5, s5
    last_joint(form, 0, D, cs)
    x, y, _ = seen_arm(form, 0, D, cs, 1.0)
    length = hypot(D[0, 3] - x, D[1, 3] - y)
    return max(abs(form[0, 0] - form[1, 0]) - length, length - form[0, 0] - form[1, 0])


def _keep(cs, pairs, count):
    """Append the t4 and t5 in cs; the new count."""
    if count < pairs.shape[0]:
        pairs[count, 0], pairs[count, 1] = cs[3, 0], cs[3, 1]
        pairs[count, 2], pairs[count, 3] = cs[4, 0], cs[4, 1]
        count += 1
    return count


def _try(lean, t5):
    """Set t4 and t5 in cs; how far the planar arm is from reaching, infinite if t4 does not fit."""
    s5, c5 = sincos(t5)
    e, fits = _offset(lean, c5, s5)
    beyond = _beyond(lean, e, c5, s5)
    return beyond if fits else math.inf


def _dip(lean, t5):
    """Where between the neighbours of a trial t5 the planar arm is nearest to reaching."""
    low, high = t5 - TWO_PI / TRIALS, t5 + TWO_PI / TRIALS
    for _ in range(HALVINGS):
        third = (high - low) / 3.0
        first = _try(lean, low + third)
        if first <= _try(lean, high - third):
            high -= third
        else:
            low += third
    return 0.5 * (low + high)


def _wide_arcs(lean, beyond, pairs):
    """The middle of every arc of t5 that is found by trying; how many. ``beyond`` (TRIALS,)."""
    start = 0
    for j in range(TRIALS):
        beyond[j] = _try(lean, TWO_PI * (j + 0.5) / TRIALS)
        if not beyond[j] <= 0.0:
            start = j + 1
    count, run = 0, 0
    for j in range(start, start + TRIALS + 1):
        here = beyond[j % TRIALS]
        if j < start + TRIALS and here <= 0.0:
            run += 1
            continue
        if run > 0:
            middle = j - run // 2 - 1
            _try(lean, TWO_PI * (middle + 0.5) / TRIALS)
            count = _keep(lean[2], pairs, count)
        run = 0
        around = min(beyond[(j - 1) % TRIALS], beyond[(j + 1) % TRIALS])
        lowest = j < start + TRIALS and 0.0 < here <= around and here < math.inf
        if lowest and _try(lean, _dip(lean, TWO_PI * (j + 0.5) / TRIALS)) <= 0.0:
            count = _keep(lean[2], pairs, count)
    return count


def _fifth(lean, e, side):
    """Cosine and sine of the t5 that goes with e, on either side; (0, 0) if there is none."""
    form, _, _, rise, slope, c4, _ = lean
    fx, fy = _common_direction(form, c4, e)
    f = math.copysign(hypot(fx, fy), fx)
    if f == 0.0:
        return 0.0, 0.0
    a, b = form[4, 0] * f, form[4, 2] * f
    c, s = _level(rise, c4, e), _level(slope, c4, e)
    if a != 0.0 and b != 0.0:
        c, s = c / a, s / b
        r = hypot(c, s) if side > 0.0 else 0.0
        c, s = (c / r, s / r) if r > 0.0 else (0.0, 0.0)
    else:
        known = s / b if a == 0.0 else c / a
        if not abs(known) <= 1.0:
            return 0.0, 0.0
        other = side * math.sqrt((1.0 - known) * (1.0 + known))
        c, s = (other, known) if a == 0.0 else (known, other)
    return (c * fx - s * fy) / f, (s * fx + c * fy) / f


def _narrow_arcs(lean, beyond, pairs, count):
    """Append arcs between the trials, met by trying e near its root; the new count."""
    form, _, cs, rise, slope, c4, nominal = lean
    row = rise if form[4, 0] == 0.0 else slope
    steep = abs(row[2] * c4 - row[1] * c4 * nominal)
    width = min(ETA / max(steep, 1e-300), abs(nominal)) / STEPS
    double = abs(row[2]) <= abs(row[1] * nominal)
    for branch in range(4 if double else 2):
        sign, side = 1.0 - (branch & 2), 1.0 - 2.0 * (branch & 1)
        for j in range(2 * STEPS + 1):
            step = width * ((j + 1) // 2)
            e = sign * (nominal + (step if j & 1 else -step))
            c5, s5 = _fifth(lean, e, side)
            if c5 == 0.0 and s5 == 0.0:
                continue
            if _beyond(lean, e, c5, s5) <= 0.0:
                turn = atan2(s5, c5) / TWO_PI - 0.5 / TRIALS
                below = int((turn - np.floor(turn)) * TRIALS) % TRIALS
                if not beyond[below] <= 0.0 and not beyond[(below + 1) % TRIALS] <= 0.0:
                    count = _keep(cs, pairs, count)
                break
    return count


def pairs_of_leaning(form, D, cs, c4, s4, pairs):
    """Values of t4 and t5 about a root (c4, s4) near which axis 5 is in line with 1, 2, 3.

    One for every arc: ``pairs`` (MOST_ARCS, 4) gets cosine and sine of t4 and t5. Where the planar
    arm reaches nowhere, the one that it misses least, since rounding may have put it there.
    Returns how many.
    """
    rise, slope, beyond = np.empty(3), np.empty(3), np.empty(TRIALS)
    levels(form, D, rise, slope)
    nominal = asin(s4) if c4 > 0.0 else asin(-s4)
    lean = form, D, cs, rise, slope, 1.0 if c4 > 0.0 else -1.0, nominal
    count = _wide_arcs(lean, beyond, pairs)
    count = _narrow_arcs(lean, beyond, pairs, count)
    if count > 0:
        return count
    best = 0
    for j in range(TRIALS):
        best = j if beyond[j] < beyond[best] else best
    _try(lean, _dip(lean, TWO_PI * (best + 0.5) / TRIALS))
    return _keep(cs, pairs, 0)
