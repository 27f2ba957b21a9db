"""Joints outside three parallel axes: pairs of values, without the three.

The height of the pose over the plane in which the three turn, and the slope of axis 6, are two
equations in two of the other joints, see :mod:`dh2urdf.kernels.parallel_axes.poses`. Each pair is a
row of ``pair`` (8, 5): cosine and sine of the first unknown, of t5, and whether t5 is free.
"""

import math

import numpy as np

from dh2urdf.kernels.numbers import add_square, circle_pair, hypot, linear_trig, sincos, trig_roots
from dh2urdf.kernels.parallel_axes.plane import levels
from dh2urdf.kernels.spherical_wrist import FREE

EPSILON = 1e-15
"""Rounding of the equation for t4, near whose double root t4 is off by this over the distance from
the root, and so is what t5 follows from."""

STRAIGHT = 1e-12
"""Cosine that an angle between axes 4 and 6 may lack to 1 where t5 puts them in line."""

NEARLY_IN_LINE = 1e-4
"""Angle [rad] between axis 6 and the common normal below which the two equations for joints 1 and 5
are solved as what is left of them: rounding moves their roots by 1e-16 over that angle."""

NEWTON_STEPS = 5

BLURRED = 1e-9
"""Angle [rad] by which two roots in line may miss being one and still be tried as such."""

PARTED = 1e-6
"""Difference of cosines and sines up to which a root is one that is known more exactly."""

LEANING = 1e-4
"""Sine of the angle between axis 5 and the axes 1, 2, 3 below which t5 is nearly free: rounding of
t4 may have moved it anywhere."""


VOID = 1e-4
"""Coefficients [m, or sines] of an equation for the outer joints below which it says little."""


def pairs_of_meeting(form, D, slack, pair):
    """Joint 1 where axes 2, 3, 4 are parallel and 5 meets 6: subproblem 4.

    With k the common direction turned by joint 1, ``k . p`` is the offset of the arm's plane.
    Returns the number of solutions, negative where joint 1 is free.
    """
    ca1, sa1 = form[0, 1], form[0, 2]
    px, py, pz = D[0, 3], D[1, 3], D[2, 3] - form[0, 3]
    offset = form[1, 3] + form[2, 3] + form[3, 3] + form[3, 1] * form[4, 3] - ca1 * pz
    count, c1, s1, c2, s2 = linear_trig(-sa1 * py, sa1 * px, offset, slack)
    free = px * px + py * py <= FREE * FREE and abs(offset) <= FREE
    if free:
        count, (s1, c1) = 1, sincos(form[0, 4])
    for k in range(count):
        pair[k, 0], pair[k, 1] = (c1, s1) if k == 0 else (c2, s2)
        pair[k, 2], pair[k, 3] = 1.0, 0.0
    return -count if free else count


def _pairs_behind_one(form, D, slack, pair):
    """Joints 1 and 5 where axes 2, 3, 4 are parallel; the number of pairs.

    With k the common direction turned by joint 1: ``k . p`` is the offset of the arm's plane and
    ``k . z6`` the slope of axis 6, ``cos alpha4 cos alpha5 - sin alpha4 sin alpha5 cos t5``.
    """
    ca1, sa1, ca4, sa4 = form[0, 1], form[0, 2], form[3, 1], form[3, 2]
    a5, ca5, sa5 = form[4, 0], form[4, 1], form[4, 2]
    px, py, pz = D[0, 3], D[1, 3], D[2, 3] - form[0, 3]
    offset = form[1, 3] + form[2, 3] + form[3, 3] + ca4 * form[4, 3] - ca1 * pz
    M, N, d, found = np.empty((2, 2)), np.zeros((2, 2)), np.empty(2), np.empty((4, 4))
    M[0, 0], M[0, 1], N[0, 0] = -sa1 * D[1, 2], sa1 * D[0, 2], sa4 * sa5
    d[0] = ca4 * ca5 - ca1 * D[2, 2]
    M[1, 0], M[1, 1], N[1, 1] = -sa1 * py, sa1 * px, -sa4 * a5
    d[1] = offset
    count = max(circle_pair(M, N, d, slack, np.empty((3, 5)), found), 0)
    pairs = _pairs_in_line(form, D, offset, 1.0, pair, 0)
    pairs = _pairs_in_line(form, D, offset, -1.0, pair, pairs)
    in_line = pairs
    for k in range(count):
        apart = math.inf
        for j in range(in_line):
            gap = 0.0
            for e in range(4):
                gap = max(gap, abs(found[k, e] - pair[j, e]))
            apart = min(apart, gap)
        if apart > PARTED and pairs < pair.shape[0]:
            pair[pairs, :4] = found[k]
            pairs += 1
    return pairs


def _pairs_in_line(form, D, offset, c5, pair, pairs):
    """Append pairs where axis 6 is nearly along the common normal, t5 near 0 or pi; the new count.

    There both equations of :func:`_pairs_behind_one` have a double root, which rounding parts by
    its root. With x and y small turns of joint 1, from where k is nearest to +-z6, and of joint 5,
    what is left of them is ``|v|^2 + sin(alpha1)^2 x^2 = B y^2`` and ``F + M x = N y``, where v
    is k less +-z6 at x = 0: all of it small, and known to as many digits as it has.
    """
    ca1, sa1, sa4, sa5 = form[0, 1], form[0, 2], form[3, 2], form[4, 2]
    sign = form[3, 1] * form[4, 1] - sa4 * sa5 * c5
    across = hypot(D[0, 2], D[1, 2])
    if abs(abs(sign) - 1.0) > STRAIGHT or across == 0.0:
        return pairs
    sign = 1.0 if sign > 0.0 else -1.0
    toward = sign if sa1 > 0.0 else -sign
    c1, s1 = -toward * D[1, 2] / across, toward * D[0, 2] / across
    vx, vy, vz = sa1 * s1 - sign * D[0, 2], -sa1 * c1 - sign * D[1, 2], ca1 - sign * D[2, 2]
    square = vx * vx + vy * vy + vz * vz
    px, py = D[0, 3], D[1, 3]
    F = sa1 * (px * s1 - py * c1) - offset
    M, N = sa1 * (px * c1 + py * s1), sa4 * form[4, 0] * c5
    B, size = -sign * c5 * sa4 * sa5, max(abs(M), abs(N))
    if max(math.sqrt(square) * size, abs(F)) >= NEARLY_IN_LINE * size:
        return pairs
    a = sa1 * sa1 * N * N - B * M * M
    if abs(M) >= abs(N):
        b, c = -sa1 * sa1 * N * F, sa1 * sa1 * F * F + M * M * square
    else:
        b, c = -B * F * M, N * N * square - B * F * F
    square = (b * b - a * c) / (size * size)
    root = size * math.sqrt(max(square, 0.0)) if square > -BLURRED * BLURRED else -1.0
    start = vx, vy, vz, c1, s1
    for k in range(0 if root < 0.0 or a == 0.0 else (1 if root == 0.0 else 2)):
        r = (-b + (root if k == 0 else -root)) / a
        x, y = ((N * r - F) / M, r) if abs(M) >= abs(N) else (r, (F + M * r) / N)
        x, y = _settle_in_line(start, sa1, px, py, F, B, N, x, y)
        (sx, cx), (sy, cy) = sincos(x), sincos(y)
        pair[pairs, 0], pair[pairs, 1] = c1 * cx - s1 * sx, s1 * cx + c1 * sx
        pair[pairs, 2], pair[pairs, 3] = c5 * cy, c5 * sy
        pairs += 1
    return pairs


def _settle_in_line(start, sa1, px, py, F, B, N, x, y):
    """Newton's method on the equations of :func:`_pairs_in_line`, higher powers included."""
    vx, vy, vz, c1, s1 = start
    for _ in range(NEWTON_STEPS):
        sx, h = sincos(x)[0], sincos(0.5 * x)[0]
        dc, ds = -s1 * sx - 2.0 * c1 * h * h, c1 * sx - 2.0 * s1 * h * h
        (sy, cy), g = sincos(y), sincos(0.5 * y)[0]
        ux, uy = vx + sa1 * ds, vy - sa1 * dc
        f1 = 0.5 * (ux * ux + uy * uy + vz * vz) - 2.0 * B * g * g
        f2 = F + sa1 * (px * ds - py * dc) - N * sy
        f1x, f1y = sa1 * (ux * (c1 + dc) + uy * (s1 + ds)), -B * sy
        f2x, f2y = sa1 * (px * (c1 + dc) + py * (s1 + ds)), -N * cy
        det = f1x * f2y - f1y * f2x
        if det == 0.0:
            break
        step_x, step_y = (f1y * f2 - f1 * f2y) / det, (f1 * f2x - f1x * f2) / det
        if max(abs(step_x), abs(step_y)) > max(abs(x), abs(y)):
            break
        x, y = x + step_x, y + step_y
    return x, y


def _add_leaning(c4, s4, pair, pairs):
    """Append a t4 at which t5 is nearly free, once for both roots beside it; the new count."""
    for j in range(pairs):
        if pair[j, 4] != 0.0 and (pair[j, 0] > 0.0) == (c4 > 0.0):
            return pairs
    pair[pairs, 0], pair[pairs, 1], pair[pairs, 4] = c4, s4, 1.0
    return pairs + 1


def _pairs_before_four(form, D, slack, pair):
    """Joints 4 and 5 where axes 1, 2, 3 are parallel; the number of pairs.

    With f the common direction seen after joint 4: ``a5 (f_x c5 + f_y s5) = n1`` is the height
    of the pose, ``sin alpha5 (f_x s5 - f_y c5) = n2`` the slope of axis 6; n1, n2 and f_z are
    linear in the cosine and sine of t4, and ``(n1 / a5)^2 + (n2 / sin alpha5)^2 + f_z^2 = 1``.
    """
    ca3, sa3, ca4, sa4 = form[2, 1], form[2, 2], form[3, 1], form[3, 2]
    a5, sa5 = form[4, 0], form[4, 2]
    rise, slope = np.empty(3), np.empty(3)
    levels(form, D, rise, slope)
    series, cosines, sines = np.zeros(5), np.empty(4), np.empty(4)
    if a5 == 0.0 or sa5 == 0.0:
        row = rise if a5 == 0.0 else slope
        count, c1, s1, c2, s2 = linear_trig(row[1], row[2], -row[0], slack)
        cosines[0], sines[0], cosines[1], sines[1] = c1, s1, c2, s2
    else:
        _fourth(form, rise, slope, series)
        count = trig_roots(series, 2, cosines, sines)
    pairs = 0
    for k in range(count):
        c4, s4 = cosines[k], sines[k]
        fx, fy = sa3 * s4, sa3 * ca4 * c4 + ca3 * sa4
        if fx * fx + fy * fy <= LEANING * LEANING:
            pairs = _add_leaning(c4, s4, pair, pairs)
            continue
        n1, n2 = rise[0] + rise[1] * c4 + rise[2] * s4, slope[0] + slope[1] * c4
        loose = abs(slack) + EPSILON / max(fx * fx + fy * fy, 1e-300)
        if a5 == 0.0:
            found, c1, s1, c2, s2 = linear_trig(-sa5 * fy, sa5 * fx, n2, loose)
        elif sa5 == 0.0:
            found, c1, s1, c2, s2 = linear_trig(a5 * fx, a5 * fy, n1, loose)
        else:
            n1, n2, square = n1 / a5, n2 / sa5, fx * fx + fy * fy
            near = abs(n1 * n1 + n2 * n2 - square) <= loose * (n1 * n1 + n2 * n2 + square)
            found = 1 if near else 0
            c1, s1, c2, s2 = fx * n1 - fy * n2, fy * n1 + fx * n2, 1.0, 0.0
        for j in range(found):
            c5, s5 = (c1, s1) if j == 0 else (c2, s2)
            r = hypot(c5, s5)
            pair[pairs, 0], pair[pairs, 1], pair[pairs, 4] = c4, s4, 0.0
            pair[pairs, 2], pair[pairs, 3] = (c5 / r, s5 / r) if r > 0.0 else (1.0, 0.0)
            pairs += 1
    return pairs


def _fourth(form, rise, slope, series):
    """The equation for t4 of :func:`_pairs_before_four`, as :func:`trig_roots` takes it."""
    a5, sa5 = form[4, 0], form[4, 2]
    add_square(series, 1.0 / (a5 * a5), rise[0], rise[1], rise[2])
    add_square(series, 1.0 / (sa5 * sa5), slope[0], slope[1], slope[2])
    add_square(series, 1.0, form[2, 1] * form[3, 1], -form[2, 2] * form[3, 2], 0.0)
    series[0] -= 1.0


def says_little(form, first, pairs, D, pair):
    """Whether an equation for the outer joints is void, nearly: it fixes none of its unknowns."""
    for k in range(abs(pairs) if first == 0 else 0):
        if pair[k, 4] != 0.0:
            return True
    a5, sa5 = form[4, 0], form[4, 2]
    if first == 0:
        if a5 == 0.0 or sa5 == 0.0:
            return False
        rise, slope, series, most = np.empty(3), np.empty(3), np.zeros(5), 0.0
        levels(form, D, rise, slope)
        _fourth(form, rise, slope, series)
        for k in range(5):
            most = max(most, abs(series[k]))
        return most <= VOID
    slope1 = abs(form[0, 2]) * hypot(D[0, 2], D[1, 2])
    rise1 = abs(form[0, 2]) * hypot(D[0, 3], D[1, 3])
    if a5 == 0.0:
        return rise1 <= VOID
    slope5, rise5 = abs(form[3, 2] * sa5), abs(form[3, 2] * a5)
    return max(slope1, rise1) <= VOID or slope1 + slope5 <= VOID or rise1 + rise5 <= VOID


def outer_pairs(form, first, D, slack, pair):
    """Pairs of outer joints of one pose D (3, 4); their number, negative where joint 1 is free."""
    if first == 0:
        return _pairs_before_four(form, D, slack, pair)
    if form[4, 0] == 0.0:
        return pairs_of_meeting(form, D, slack, pair)
    return _pairs_behind_one(form, D, slack, pair)
