"""Real roots of a trigonometric polynomial of degree 8 that is known by samples.

On an arc around q_0, ``(1 + t^2)^8 f`` with ``t = tan((q - q_0) / 2)`` is a polynomial of degree
16. Its Bernstein coefficients change sign at least as often as it has roots there, and by an even
number more (Descartes): none means no root, one means one. Arcs with more changes are halved
until they are decided, so no root is overlooked.

The coefficients come from 24 samples: all around the circle, for 24 arcs at once, or on one
window, for roots that lie where f is small against its largest value. Degree 8 needs only 17
samples; what the other seven contradict is the samples' own rounding noise, measured.
"""

from __future__ import annotations

import math

import numpy as np

from dh2urdf.kernels.numbers import LANES, inlined, vector_kernel

__all__ = [
    "ARC",
    "ARC_TAN",
    "CIRCLE_COS",
    "CIRCLE_SIN",
    "SPANS",
    "STACK",
    "TERMS",
    "circle_arcs",
    "roots_on_arc",
    "window_arc",
    "window_nodes",
]

DEGREE = 8
TERMS = 2 * DEGREE + 1
HARMONICS = 23
ARC = 2.0 * math.pi / LANES
ARC_TAN = math.tan(0.25 * ARC)
STACK = 40
"""Rows that the halving needs at most."""

NARROW = 0.06
"""Length [rad] of an arc on which a pair of roots is looked for at an extremum of f."""

NARROWEST = 2e-4
"""Length [rad] of an arc below which such a pair counts as a double root."""

NEAR_DOUBLE = 0.02
"""Imaginary part [rad] below which a complex pair of roots is reported as a double one."""

SHALLOW = 0.03
"""An arc whose smallest coefficient is below this part of its largest may hold such a pair."""

FLAT = 1e4
"""An arc on which f is below this many times the noise is in doubt."""

CLEAR = 1e3
"""An arc without a root on which f comes below this many times the noise is in doubt."""

UNSURE = 1e-6
"""A root whose place is uncertain by more than this [rad] is in doubt."""

SPANS = 31
"""Spans of doubt that are remembered."""

CIRCLE_ANGLE = 2.0 * np.pi * np.arange(LANES) / LANES
CIRCLE_COS = np.cos(CIRCLE_ANGLE)
CIRCLE_SIN = np.sin(CIRCLE_ANGLE)
NODE = np.cos(np.pi * (np.arange(LANES) + 0.5) / LANES)


def _circle_table():
    """Weights of the 24 samples in a_0, a_1, b_1, ... b_11."""
    rows = [np.full(LANES, 0.5)]
    for m in range(1, 12):
        rows += [np.cos(m * CIRCLE_ANGLE), np.sin(m * CIRCLE_ANGLE)]
    return np.ascontiguousarray(np.array(rows).T * (2.0 / LANES))


def _arc_table():
    """Bernstein coefficients (17, 17) on one arc of 1, cos q, sin q, cos 2q, ...

    From ``(1 + t^2)^8 exp(i m q) = (1 + i t)^(8 + m) (1 - i t)^(8 - m)``, each factor linear.
    """
    low, high = complex(1.0, -ARC_TAN), complex(1.0, ARC_TAN)
    binomial = np.array([math.comb(2 * DEGREE, i) for i in range(TERMS)])
    columns = []
    for m in range(DEGREE + 1):
        product = np.ones(1, dtype=complex)
        for factor in range(2 * DEGREE):
            pair = [low, high] if factor < DEGREE + m else [high, low]
            product = np.convolve(product, pair)
        product = product / binomial
        columns += [product.real] if m == 0 else [product.real, product.imag]
    return np.ascontiguousarray(np.array(columns).T)


def _window_table():
    """Weights (24, 24) of samples at the nodes: 17 Bernstein coefficients, 7 contradictions."""
    x = 0.5 * (1.0 + NODE)
    basis = np.array([math.comb(16, i) * x**i * (1.0 - x) ** (16 - i) for i in range(TERMS)]).T
    u, s, vt = np.linalg.svd(basis)
    rows = np.vstack([vt.T @ (u[:, :TERMS] / s).T, u[:, TERMS:].T])
    return np.ascontiguousarray(rows.T)


CIRCLE_TABLE = _circle_table()
ARC_TABLE = _arc_table()
WINDOW_TABLE = _window_table()


@inlined
def circle_arcs(samples, series, turned, arcs):
    """Bernstein coefficients of f on 24 arcs from 24 samples around the circle.

    Parameters
    ----------
    samples : (24,)
    series : (24,), scratch
    turned : (17, 24), scratch
    arcs : (24, 24), out
        Column k: the 17 coefficients on the arc centred at ``k * ARC``.

    Returns
    -------
    float, float
        The largest Fourier coefficient that should vanish (the noise) and the largest of all.
    """
    for m in range(HARMONICS):
        series[m] = 0.0
    for k in range(LANES):
        f = samples[k]
        for m in range(HARMONICS):
            series[m] += f * CIRCLE_TABLE[k, m]
    largest, noise = 0.0, 0.0
    for m in range(TERMS):
        largest = max(largest, abs(series[m]))
    for m in range(TERMS, HARMONICS):
        noise = max(noise, abs(series[m]))
    for k in range(LANES):
        turned[0, k] = series[0]
    for m in range(1, DEGREE + 1):
        a, b = series[2 * m - 1], series[2 * m]
        for k in range(LANES):
            c, s = CIRCLE_COS[(m * k) % LANES], CIRCLE_SIN[(m * k) % LANES]
            turned[2 * m - 1, k] = a * c + b * s
            turned[2 * m, k] = b * c - a * s
    for i in range(TERMS):
        for k in range(LANES):
            arcs[i, k] = 0.0
        for m in range(TERMS):
            w = ARC_TABLE[i, m]
            for k in range(LANES):
                arcs[i, k] += w * turned[m, k]
    for k in range(LANES):
        arcs[0, k] = arcs[TERMS - 1, (k + LANES - 1) % LANES]
    return noise, largest


@inlined
def window_nodes(centre, half_tan, hidden):
    """Cosines and sines, (2, 24), of the places at which a window is sampled."""
    for k in range(LANES):
        q = centre + 2.0 * math.atan(half_tan * NODE[k])
        hidden[0, k], hidden[1, k] = math.cos(q), math.sin(q)


@inlined
def window_arc(samples, half_tan, series, arcs):
    """Bernstein coefficients of f on one window from its 24 samples, to the first column of arcs.

    ``series`` (24,) is scratch.

    Returns
    -------
    float
        The largest contradiction among the samples: the noise.
    """
    for m in range(LANES):
        series[m] = 0.0
    for k in range(LANES):
        t = half_tan * NODE[k]
        weight = 1.0 + t * t
        weight *= weight
        weight *= weight
        f = samples[k] * weight * weight
        for m in range(LANES):
            series[m] += f * WINDOW_TABLE[k, m]
    for i in range(TERMS):
        arcs[i, 0] = series[i]
    noise = 0.0
    for m in range(TERMS, LANES):
        noise = max(noise, abs(series[m]))
    return noise


@vector_kernel
def _evaluate(row, x, scratch):
    """f, f' and f'' at x in [0, 1] of a row of Bernstein coefficients (de Casteljau)."""
    y = 1.0 - x
    for i in range(TERMS - 1):
        scratch[i] = y * row[i] + x * row[i + 1]
    for n in range(TERMS - 2, 2, -1):
        for i in range(n):
            scratch[i] = y * scratch[i] + x * scratch[i + 1]
    a, b, c = scratch[0], scratch[1], scratch[2]
    p, q = y * a + x * b, y * b + x * c
    return y * p + x * q, 16.0 * (q - p), 240.0 * (a - 2.0 * b + c)


@vector_kernel
def _bracketed_root(row, low, high, x, rising, tolerance, scratch):
    """The root between low and high, Newton from x kept in the bracket, and f' there."""
    df = 0.0
    for _ in range(60):
        f, df, _ = _evaluate(row, x, scratch)
        if (f > 0.0) == rising:
            high = x
        else:
            low = x
        step = -f / df if df != 0.0 else math.inf
        if not low < x + step < high:
            step = 0.5 * (low + high) - x
        x += step
        if abs(step) < tolerance:
            break
    return x, df


@vector_kernel
def _extremum(row, x, scratch):
    """The place in [0, 1] where f' vanishes, Newton from x, with f, f', f'' there."""
    f, df, ddf = _evaluate(row, x, scratch)
    for _ in range(6):
        step = -df / ddf if ddf != 0.0 else 0.0
        x = min(max(x + step, 0.0), 1.0)
        f, df, ddf = _evaluate(row, x, scratch)
        if abs(step) < 1e-6:
            break
    return x, f, df, ddf


@vector_kernel
def _shape(row):
    """Sign changes, first crossing, place of the smallest size, that size and the largest."""
    positive = row[0] > 0.0
    changes, crossing, place = 0, 0.5, 0
    smallest, largest = abs(row[0]), abs(row[0])
    for i in range(1, TERMS):
        value = row[i]
        if (value > 0.0) != positive:
            positive = not positive
            if changes == 0:
                crossing = (i - 1 + row[i - 1] / (row[i - 1] - value)) / (TERMS - 1)
            changes += 1
        size = abs(value)
        largest = max(largest, size)
        if size < smallest:
            smallest, place = size, i
    return changes, crossing, place / (TERMS - 1), smallest, largest


@vector_kernel
def _halve(stack, top):
    """De Casteljau at the middle: row ``top`` keeps the right half, ``top + 1`` gets the left."""
    for i in range(TERMS):
        stack[top + 1, i] = stack[top, 0]
        for j in range(TERMS - 1 - i):
            stack[top, j] = 0.5 * (stack[top, j] + stack[top, j + 1])
    middle = 0.5 * (stack[top, 17] + stack[top, 18])
    stack[top + 1, 17], stack[top + 1, 18] = stack[top, 17], middle
    stack[top, 17] = middle


@vector_kernel
def _angle(centre, row, x):
    """The angle at x in [0, 1] of a row."""
    return centre + 2.0 * math.atan(row[17] + x * (row[18] - row[17]))


@vector_kernel
def _doubt(spans, row, centre):
    """Widen the last span of doubt to a row, or begin one."""
    n = int(spans[0, 0])
    low, high = _angle(centre, row, 0.0), _angle(centre, row, 1.0)
    if n > 0 and low <= spans[1, n] + 1e-9 and high >= spans[0, n] - 1e-9:
        spans[0, n], spans[1, n] = min(low, spans[0, n]), max(high, spans[1, n])
    elif n < SPANS:
        n += 1
        spans[0, 0], spans[0, n], spans[1, n] = n, low, high


@vector_kernel
def _pair(row, x, f, ddf, rising, length, scratch):
    """The two roots beside an extremum at x that lies across the axis, with f' there."""
    h = math.sqrt(abs(2.0 * f / ddf))
    fine = 1e-8 / length
    a, da = _bracketed_root(row, 0.0, x, max(x - h, 0.0), rising, fine, scratch)
    b, db = _bracketed_root(row, x, 1.0, min(x + h, 1.0), not rising, fine, scratch)
    return a, da, b, db


@inlined
def roots_on_arc(stack, centre, half_tan, noise, scratch, spans, count, roots, slopes):
    """Append the real roots on one arc.

    Parameters
    ----------
    stack : (STACK, 19)
        The arc's Bernstein coefficients in the first row; overwritten.
    centre, half_tan : float
        The arc: angle of its middle [rad] and tangent of a quarter of its length.
    noise : float
        Size below which f cannot be told from zero.
    scratch : (24,)
    spans : (2, SPANS + 1), in and out
        ``spans[0, 0]`` spans of doubt, each from ``spans[0, i]`` to ``spans[1, i]`` [rad]: there f
        is so small, or a root so uncertain, that it should be sampled anew.
    count : int
        Number of roots so far.
    roots, slopes : (24,), out
        Angles [rad] and |f'| there; the slope is 0 where two roots (nearly) fall together or a
        complex pair is close to the real axis.

    Returns
    -------
    int
        Number of roots written.
    """
    stack[0, 17], stack[0, 18] = -half_tan, half_tan
    top = np.int64(0)
    while top >= 0 and count < LANES - 1:
        row = stack[top]
        changes, crossing, place, smallest, largest = _shape(row)
        length = 2.0 * (row[18] - row[17])
        if largest < FLAT * noise or (changes == 0 and smallest < CLEAR * noise):
            _doubt(spans, row, centre)
        if changes == 1:
            fine = 1e-8 / length
            x, df = _bracketed_root(row, 0.0, 1.0, crossing, row[0] <= 0.0, fine, scratch)
            roots[count], slopes[count] = _angle(centre, row, x), abs(df) / length + 1e-300
            if slopes[count] * UNSURE < noise:
                _doubt(spans, row, centre)
            count += 1
            top -= 1
            continue
        if (changes == 0 and smallest < SHALLOW * largest) or (changes == 2 and length < NARROW):
            x, f, df, ddf = _extremum(row, place if changes == 0 else 0.5, scratch)
            positive = row[0] > 0.0
            if abs(df) < 1e-4 * abs(ddf) and positive == (ddf > 0.0):
                near = NEAR_DOUBLE / length
                if (f > 0.0) != positive:
                    a, da, b, db = _pair(row, x, f, ddf, not positive, length, scratch)
                    roots[count], slopes[count] = _angle(centre, row, a), abs(da) / length + 1e-300
                    count += 1
                    roots[count], slopes[count] = _angle(centre, row, b), abs(db) / length + 1e-300
                    count += 1
                    if min(abs(da), abs(db)) * UNSURE < noise * length:
                        _doubt(spans, row, centre)
                    top -= 1
                    continue
                if changes == 0 or length < NARROWEST:
                    if 2.0 * abs(f) < near * near * abs(ddf) + noise:
                        roots[count], slopes[count] = _angle(centre, row, x), 0.0
                        count += 1
                    top -= 1
                    continue
        if changes == 0:
            top -= 1
            continue
        if length < 1e-12 or top + 2 > STACK:
            roots[count], slopes[count] = _angle(centre, row, 0.5), 0.0
            count += 1
            top -= 1
            continue
        _halve(stack, top)
        top += 1
    return count
