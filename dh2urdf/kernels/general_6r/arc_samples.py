"""Bernstein coefficients of a trigonometric polynomial of degree 8 that is known by samples.

On an arc around q_0, ``(1 + t^2)^8 f`` with ``t = tan((q - q_0) / 2)`` is a polynomial of degree
16. Its coefficients come from 24 samples: all around the circle, for 24 arcs at once, or on one
window, for roots that lie where f is small against its largest value. Degree 8 needs only 17
samples; what the other seven contradict is the samples' own rounding noise, measured.
"""

import math

import numpy as np

from dh2urdf.kernels.numbers import LANES, atan2, side_by_side, sincos

DEGREE = 8
TERMS = 2 * DEGREE + 1
HARMONICS = 23
ARC = 2.0 * math.pi / LANES
ARC_TAN = sincos(0.25 * ARC)[0] / sincos(0.25 * ARC)[1]

BINOMIAL = np.array([float(math.comb(2 * DEGREE, i)) for i in range(TERMS)])

CIRCLE_ANGLE = 2.0 * np.pi * np.arange(LANES) / LANES
CIRCLE_SIN, CIRCLE_COS = np.array([sincos(x) for x in CIRCLE_ANGLE.tolist()]).T.copy()
_TURNS = np.outer(np.arange(1, DEGREE + 1), np.arange(LANES)) % LANES
COSINES, SINES = CIRCLE_COS[_TURNS], CIRCLE_SIN[_TURNS]
NODE = np.array([sincos(math.pi * (k + 0.5) / LANES)[1] for k in range(LANES)])


def _circle_table():
    """Weights of the 24 samples in a_0, a_1, b_1, ... b_11."""
    rows = [np.full(LANES, 0.5)]
    for m in range(1, 12):
        turns = m * np.arange(LANES) % LANES
        rows += [CIRCLE_COS[turns], CIRCLE_SIN[turns]]
    return np.ascontiguousarray(np.array(rows).T * (2.0 / LANES))


def _arc_table():
    """Bernstein coefficients (17, 17) on one arc of 1, cos q, sin q, cos 2q, ...

    From ``(1 + t^2)^8 exp(i m q) = (1 + i t)^(8 + m) (1 - i t)^(8 - m)``, each factor linear.
    """
    columns = []
    for m in range(DEGREE + 1):
        real, imaginary = np.ones(1), np.zeros(1)
        for factor in range(2 * DEGREE):
            t = ARC_TAN if factor < DEGREE + m else -ARC_TAN
            (a, b), (c, d) = _beside(real), _beside(imaginary)
            real, imaginary = a + b + t * (c - d), c + d - t * (a - b)
        columns += [real / BINOMIAL] if m == 0 else [real / BINOMIAL, imaginary / BINOMIAL]
    return np.ascontiguousarray(np.array(columns).T)


def _beside(rows):
    """Coefficients of a polynomial as they are and shifted by one, for a linear factor.

    Neither powers nor convolutions of arrays: their bits depend on the processor.
    """
    nothing = np.zeros_like(rows[:1])
    return np.concatenate([rows, nothing]), np.concatenate([nothing, rows])


def _window_table():
    """Weights (24, 24) of samples at the nodes: 17 Bernstein coefficients, 7 contradictions."""
    x, basis = 0.5 * (1.0 + NODE), np.ones((1, LANES))
    for _ in range(2 * DEGREE):
        low, high = _beside(basis)
        basis = (1.0 - x) * low + x * high
    # Q R by reflections, beside Q' itself; then R^-1 times its first rows
    both = np.hstack([basis.T, np.eye(LANES)])
    for k in range(TERMS):
        v = np.where(np.arange(LANES) < k, 0.0, both[:, k])[:, None]
        v[k] += math.copysign(math.sqrt(float((v * v).sum(axis=0)[0])), v[k, 0])
        both -= v * ((v * both).sum(axis=0) * (2.0 / (v * v).sum(axis=0)))
    for k in reversed(range(TERMS)):
        both[k] /= both[k, k]
        both[:k] -= both[:k, k, None] * both[k]
    return np.ascontiguousarray(both[:, TERMS:].T)


CIRCLE_TABLE = _circle_table()
ARC_TABLE = _arc_table()
WINDOW_TABLE = _window_table()


def _transform(samples, table, series):
    """``series = samples @ table``."""
    for m in range(table.shape[1]):
        series[m] = 0.0
    for k in range(table.shape[0]):
        f = samples[k]
        for m in range(table.shape[1]):
            series[m] += f * table[k, m]


def _largest(series, first, last):
    """Largest size of some coefficients."""
    largest = 0.0
    for m in range(first, last):
        largest = max(largest, abs(series[m]))
    return largest


def circle_arcs(samples, series, turned, arcs):
    """Bernstein coefficients of f on 24 arcs from samples (24,) around the circle.

    Column k of ``arcs``, its first 17 rows: those on the arc centred at ``k * ARC``. Returns the
    largest Fourier coefficient that should vanish (the noise) and the largest of all. ``series``
    (24,) and ``turned`` (17, 24) are scratch.
    """
    _transform(samples, CIRCLE_TABLE, series)
    turned[0] = series[0]
    for m in range(1, DEGREE + 1):
        a, b = series[2 * m - 1], series[2 * m]
        for k in side_by_side(LANES):
            c, s = COSINES[m - 1, k], SINES[m - 1, k]
            turned[2 * m - 1, k] = a * c + b * s
            turned[2 * m, k] = b * c - a * s
    for i in range(TERMS):
        for k in side_by_side(LANES):
            total = 0.0
            for m in range(TERMS):
                total += ARC_TABLE[i, m] * turned[m, k]
            arcs[i, k] = total
    for k in side_by_side(LANES):
        arcs[0, k] = arcs[TERMS - 1, (k + LANES - 1) % LANES]
    return _largest(series, TERMS, HARMONICS), _largest(series, 0, TERMS)


def window_nodes(centre, half_tan, hidden):
    """Cosines and sines, (2, 24), of the places at which a window is sampled."""
    for k in side_by_side(LANES):
        q = centre + 2.0 * atan2(half_tan * NODE[k], 1.0)
        hidden[0, k], hidden[1, k] = sincos(q)[1], sincos(q)[0]


def window_arc(samples, half_tan, series, arcs):
    """Bernstein coefficients of f on one window from its 24 samples, to the first column of arcs.

    Returns the largest contradiction among the samples: the noise. ``samples`` is overwritten,
    ``series`` (24,) scratch.
    """
    for k in side_by_side(LANES):
        t = half_tan * NODE[k]
        square = (1.0 + t * t) * (1.0 + t * t)
        samples[k] *= square * square * (square * square)
    _transform(samples, WINDOW_TABLE, series)
    for i in range(TERMS):
        arcs[i, 0] = series[i]
    return _largest(series, TERMS, LANES)
