"""Where slides put a wrist centre: the slide eliminated, or linear equations.

As in :mod:`dh2urdf.kernels.spherical_wrist.position_any`, whose columns (k, C, S) these take.
"""

import math

import numpy as np

from dh2urdf.kernels.numbers import add_square, hypot, linear_trig, root_of_gap, sincos, trig_roots
from dh2urdf.kernels.rigid import dot, minus

OBLIQUE = 1e-9
"""Cosine between a slide and a neighbouring axis up to which they count as square."""

NEARLY = 1e-4
"""Cosine between a slide and a neighbouring axis up to which they are nearly square: angles that
were written with four decimals."""

APART, CLOSER = 30.0, 8
"""How much longer than its change with the slide the way from a rim is, where a slide is nearly
square and has its equation to itself; and how often that is solved, each time some digits better.
Elimination of the slide would lose the square of the cosine."""


def about_z(v, c, s):
    """``Rot_z v``."""
    return c * v[0] - s * v[1], s * v[0] + c * v[1], v[2]


def point_at(columns, c, s):
    """``k + c C + s S``."""
    k, C, S = columns
    return k[0] + c * C[0] + s * S[0], k[1] + c * C[1] + s * S[1], k[2] + c * C[2] + s * S[2]


def turn_and_slide(turn, slide, flat, free, nice, slack, pairs):
    """One turns, one slides: the slide eliminated, rows (c, s, t, rough).

    ``flat``: joint 2 slides; ``free``: the turning joint is free, and put to ``nice``.
    ``rough`` is 1 where roots of a slide that is nearly square say no more than about where.
    """
    (k, C, S), (m, E, _) = turn, slide
    rows, cosines, sines, series, rough = 0, np.empty(4), np.empty(4), np.zeros(5), 0.0
    rise, steep, fall, slope = (k[2] - m[2], C[2], S[2], E[2])
    if flat:
        rise = E[0] * (k[1] - m[1]) - E[1] * (k[0] - m[0])
        steep, fall, slope = E[0] * C[1] - E[1] * C[0], E[0] * S[1] - E[1] * S[0], 0.0
    oblique, along = abs(slope) > OBLIQUE, dot(m, E)
    size = dot(m, m) + dot(k, k) + dot(C, C)
    length = 2.0 * dot(m, m) - size
    if oblique and not free:
        lines = (rise, steep, fall, slope), (length, dot(k, C), dot(k, S), along, size)
        rows = _nearly_square(*lines, slack, pairs)
        if rows >= 0:
            return rows
        rows, rough = 0, 1.0 if abs(slope) < NEARLY else 0.0
    if oblique:
        rise, steep, fall = rise / slope, steep / slope, fall / slope
    if free:
        count, (sines[0], cosines[0]) = 1, sincos(nice)
    elif oblique:
        series[0] = length + 2.0 * along * rise
        series[1], series[2] = 2.0 * (along * steep - dot(k, C)), 2.0 * (along * fall - dot(k, S))
        add_square(series, 1.0, rise, steep, fall)
        count = trig_roots(series, 2, cosines, sines)
    else:
        count, c, s, e, f = linear_trig(steep, fall, -rise, slack)
        cosines[0], sines[0], cosines[1], sines[1] = c, s, e, f
    for j in range(count):
        c, s = cosines[j], sines[j]
        found, t, other = 1, rise + c * steep + s * fall, 0.0
        if flat:
            x, y, _ = point_at(turn, c, s)
            t = ((x - m[0]) * E[0] + (y - m[1]) * E[1]) / (E[0] * E[0] + E[1] * E[1])
        elif not oblique:
            rest = length - 2.0 * (c * dot(k, C) + s * dot(k, S))
            root = root_of_gap(along * along - rest, size, slack)
            found = 0 if root < 0.0 else (1 if root == 0.0 and slack > 0.0 else 2)
            t, other = root - along, -root - along
        for i in range(found):
            pairs[rows, 0], pairs[rows, 1], pairs[rows, 3] = c, s, rough
            pairs[rows, 2] = t if i == 0 else other
            rows += 1
    return rows


def _nearly_square(line, circle, slack, pairs):
    """The slide is nearly square to axis 2: ``rise + c steep + s fall = t slope``, one equation.

    The other, of lengths, is quadratic in t, ``t^2 + 2 along t + length - 2 (c kC + s kS) = 0``,
    of which c and s change little with t. -1 where they change more, near a rim.
    """
    (rise, steep, fall, slope), (length, kC, kS, along, size) = line, circle
    rows, least = 0, APART * abs(slope) * math.sqrt(size) * hypot(steep, fall)
    for j in range(4):
        t, root, c, s = -along, 0.0, 1.0, 0.0
        for _ in range(CLOSER):
            count, c, s, e, f = linear_trig(steep, fall, t * slope - rise, slack)
            c, s = (c, s) if j < 2 else (e, f)
            rim = fall * c - steep * s
            if count != 2 or rim * rim < least:
                return -1
            tilt = (s * kC - c * kS) * slope / rim
            rest = length - 2.0 * (c * kC + s * kS) - 2.0 * tilt * t
            root = root_of_gap((along + tilt) * (along + tilt) - rest, size, slack)
            t = (max(root, 0.0) if j % 2 == 0 else -max(root, 0.0)) - along - tilt
        if root > 0.0 or (root == 0.0 and (slack < 0.0 or j % 2 == 0)):
            pairs[rows, 0], pairs[rows, 1], pairs[rows, 2], pairs[rows, 3] = c, s, t, 0.0
            rows += 1
    return rows


def two_slides(form, Y, V, slack, pairs):
    """Joints 1 and 3 slide: linear equations, or a subproblem 4 in the angle of joint 2.

    That is what is left of y = v across slide 1 when d3 is eliminated.
    """
    (k, C, _), (m, E, _) = Y, V
    if form[1, 5] != 0.0:
        x, y, det = m[0] - k[0], m[1] - k[1], C[1] * E[0] - C[0] * E[1]
        pairs[0, 0], pairs[0, 1] = (y * E[0] - x * E[1]) / det, 0.0
        pairs[0, 2], pairs[0, 3] = (C[0] * y - C[1] * x) / det, 0.0
        return 1
    ca1, sa1, ca2, sa2 = form[0, 1], form[0, 2], form[1, 1], form[1, 2]
    gx, gy, x, y = k[0], ca1 * k[1] - sa1 * k[2] + sa1 * m[2], m[0], m[1]
    a, b = sa1 * ca2 * x - ca1 * sa2 * gx, -sa2 * gy - sa1 * ca2 * y
    count, c, s, e, f = linear_trig(a, b, sa1 * ca2 * gx - ca1 * sa2 * x, slack)
    rows = 0
    for j in range(count):
        c, s = (c, s) if j == 0 else (e, f)
        fx, fy = s * sa2, -ca1 * c * sa2 - sa1 * ca2
        square = fx * fx + fy * fy
        if square <= 0.0:
            continue
        hx, hy = gx - c * x + s * y, gy - ca1 * (s * x + c * y)
        t = (hx * fx + hy * fy) / square
        u = about_z(point_at(V, t, 0.0), c, s)
        pairs[rows, 0] = dot(C, minus(u, k))
        pairs[rows, 1], pairs[rows, 2], pairs[rows, 3] = 0.0, t, 0.0
        rows += 1
    return rows
