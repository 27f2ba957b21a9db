"""Bernstein coefficients of a trigonometric polynomial that is known by samples.

On an arc around q_0, ``(1 + t^2)^d f`` with ``t = tan((q - q_0) / 2)`` is a polynomial of degree
2 d where f has degree d. Its coefficients come from 2 d + 8 samples: all around the circle, for as
many arcs at once, or on one window, for roots that lie where f is small against its largest value.
Degree d needs only 2 d + 1; what the other seven contradict is the samples' own rounding noise,
measured. Which degree is seen from the arrays' lengths, when kernels are translated.
"""

import math
from functools import cache

import numpy as np

from dh2urdf.kernels.numbers import LANES, atan2, side_by_side, sincos
from dh2urdf.kernels.shapes import Floats

DEGREE = 8
"""Degree of the polynomial of six turning joints; those of joints with followers are higher."""

TERMS = 2 * DEGREE + 1
ARC = 2.0 * math.pi / LANES
"""Length [rad] of an arc of degree 8."""


EPSILON = 2.0**-52
"""Rounding of a coefficient's terms, in parts of them."""


def lanes_of(degree):
    """Samples on the circle, and arcs, of a polynomial of a degree."""
    return 2 * degree + 8


def _arc_tan(lanes):
    """Tangent of a quarter of the length of an arc."""
    sine, cosine = sincos(0.25 * (2.0 * math.pi / lanes))
    return sine / cosine


def _binomial(degree):
    return np.array([float(math.comb(2 * degree, i)) for i in range(2 * degree + 1)])


def _circle(lanes):
    """Cosines and sines of the samples' places, (2, lanes)."""
    angles = 2.0 * np.pi * np.arange(lanes) / lanes
    sine, cosine = np.array([sincos(x) for x in angles.tolist()]).T.copy()
    return np.stack([cosine, sine])


def _turns(degree):
    """Cosines and sines of multiples of the arcs' centres, (2, degree, lanes)."""
    lanes = lanes_of(degree)
    return _circle(lanes)[:, np.outer(np.arange(1, degree + 1), np.arange(lanes)) % lanes]


def _nodes(lanes):
    return np.array([sincos(math.pi * (k + 0.5) / lanes)[1] for k in range(lanes)])


def _circle_table(lanes):
    """Weights of the samples in a_0, a_1, b_1, ... up to half as many harmonics."""
    rows = [np.full(lanes, 0.5)]
    for m in range(1, lanes // 2):
        rows += list(_circle(lanes)[:, m * np.arange(lanes) % lanes])
    return np.ascontiguousarray(np.array(rows).T * (2.0 / lanes))


def _arc_table(degree):
    """Bernstein coefficients on one arc of 1, cos q, sin q, cos 2q, ..., square.

    From ``(1 + t^2)^d exp(i m q) = (1 + i t)^(d + m) (1 - i t)^(d - m)``, each factor linear.
    """
    columns, binomial, half_tan = [], _binomial(degree), _arc_tan(lanes_of(degree))
    for m in range(degree + 1):
        real, imaginary = np.ones(1), np.zeros(1)
        for factor in range(2 * degree):
            t = half_tan if factor < degree + m else -half_tan
            (a, b), (c, d) = _beside(real), _beside(imaginary)
            real, imaginary = a + b + t * (c - d), c + d - t * (a - b)
        columns += [real / binomial] if m == 0 else [real / binomial, imaginary / binomial]
    return np.ascontiguousarray(np.array(columns).T)


def _beside(rows):
    """Coefficients of a polynomial as they are and shifted by one, for a linear factor.

    Neither powers nor convolutions of arrays: their bits depend on the processor.
    """
    nothing = np.zeros_like(rows[:1])
    return np.concatenate([rows, nothing]), np.concatenate([nothing, rows])


def _window_table(degree):
    """Weights of samples at the nodes, square: Bernstein coefficients, then 7 contradictions.

    They grow as ``4^d``, and the rounding with them: for degree 8 alone.
    """
    lanes, terms = lanes_of(degree), 2 * degree + 1
    x, basis = 0.5 * (1.0 + _nodes(lanes)), np.ones((1, lanes))
    for _ in range(2 * degree):
        low, high = _beside(basis)
        basis = (1.0 - x) * low + x * high
    # Q R by reflections, beside Q' itself; then R^-1 times its first rows
    both = np.hstack([basis.T, np.eye(lanes)])
    for k in range(terms):
        v = np.where(np.arange(lanes) < k, 0.0, both[:, k])[:, None]
        v[k] += math.copysign(math.sqrt(float((v * v).sum(axis=0)[0])), v[k, 0])
        both -= v * ((v * both).sum(axis=0) * (2.0 / (v * v).sum(axis=0)))
    for k in reversed(range(terms)):
        both[k] /= both[k, k]
        both[:k] -= both[:k, k, None] * both[k]
    return np.ascontiguousarray(both[:, terms:].T)


def _chebyshev_table(degree):
    """Weights of samples at the nodes in the coefficients of T_0, T_1, ..., square."""
    lanes = lanes_of(degree)
    turns = np.outer(2 * np.arange(lanes) + 1, np.arange(lanes)) % (4 * lanes)
    cosines = np.array([sincos(2.0 * math.pi * k / (4 * lanes))[1] for k in range(4 * lanes)])
    table = cosines[turns] * (2.0 / lanes)
    table[:, 0] *= 0.5
    return table


def _bernstein(degree):
    """Bernstein coefficients on [-1, 1] of Chebyshev's T_0, T_1, ..., square; and the largest ones.

    In whole numbers: what ``u^i v^(2d - i)`` is taken times, where ``x = u - v`` and ``u + v = 1``.
    """
    terms, before, now = 2 * degree + 1, [1], [-1, 1]
    rows = []
    for j in range(terms):
        row = before
        for _ in range(terms - 1 - j):
            row = _times(row, 1, 1)
        rows.append([a / math.comb(terms - 1, i) for i, a in enumerate(row)])
        square = _times(_times(before, 1, 1), 1, 1)
        more = [2 * a - b for a, b in zip(_times(now, -1, 1), square, strict=True)]
        before, now = now, more
    table = np.array(rows)
    return table, np.abs(table).max(axis=1)


def _times(row, a, b):
    """Coefficients of a polynomial in u and v times ``a v + b u``."""
    return [a * low + b * high for low, high in zip([*row, 0], [0, *row], strict=True)]


CIRCLE_8, TURNS_8 = _circle_table(LANES), _turns(DEGREE)
ARC_8, WINDOW_8 = _arc_table(DEGREE), _window_table(DEGREE)
NODES_8, PLACES_8 = _nodes(LANES), _circle(LANES)
TAN_8, BINOMIAL_8 = _arc_tan(LANES), _binomial(DEGREE)


@cache
def tables_of(degree: int) -> dict[str, Floats]:
    """What a record of another degree has in place of these tables, by names."""
    lanes, (bernstein, growth) = lanes_of(degree), _bernstein(degree)
    return {
        "circle": _circle_table(lanes),
        "turning": _turns(degree),
        "arc_table": _arc_table(degree),
        "window": _chebyshev_table(degree),
        "bernstein": bernstein,
        "growth": growth,
        "nodes": _nodes(lanes),
        "places": _circle(lanes),
        "binomial": _binomial(degree),
        "half_tan": np.array(_arc_tan(lanes)),
    }


def table_shapes(degree: int) -> dict[str, tuple[int, ...]]:
    """Shapes of :func:`tables_of` without their numbers, which would delay each start."""
    lanes, terms = lanes_of(degree), 2 * degree + 1
    return {
        "circle": (lanes, lanes - 1),
        "turning": (2, degree, lanes),
        "arc_table": (terms, terms),
        "window": (lanes, lanes),
        "bernstein": (terms, terms),
        "growth": (terms,),
        "nodes": (lanes,),
        "places": (2, lanes),
        "binomial": (terms,),
        "half_tan": (),
    }


def arc_tan(arm):
    """Tangent of a quarter of the length of an arc."""
    return TAN_8 if len(arm["turned"]) == TERMS else arm["half_tan"]


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


def circle_arcs(arm):
    """Bernstein coefficients of f on arcs from as many samples around the circle.

    Column k of ``arcs``, its first rows: those on the arc centred at that of sample k. Returns the
    largest Fourier coefficient that should vanish (the noise) and the largest of all. ``series``,
    as long as the samples, ``determinant``, and ``turned``, a row a coefficient, are scratch.
    """
    samples, series, turned = arm["determinant"], arm["series"], arm["turned"]
    if len(turned) == TERMS:
        _circle_arcs(samples, CIRCLE_8, TURNS_8, ARC_8, series, turned, arm["arcs"])
    else:
        turning, table = arm["turning"], arm["arc_table"]
        _circle_arcs(samples, arm["circle"], turning, table, series, turned, arm["arcs"])
    terms = len(turned)
    return _largest(series, terms, len(series) - 1), _largest(series, 0, terms)


def _circle_arcs(samples, circle, turns, table, series, turned, arcs):
    """The same by the tables of a degree."""
    terms, lanes = len(turned), turned.shape[1]
    _transform(samples, circle, series)
    turned[0] = series[0]
    for m in range(1, terms // 2 + 1):
        a, b = series[2 * m - 1], series[2 * m]
        for k in side_by_side(lanes):
            c, s = turns[0, m - 1, k], turns[1, m - 1, k]
            turned[2 * m - 1, k] = a * c + b * s
            turned[2 * m, k] = b * c - a * s
    for i in range(terms):
        for k in side_by_side(lanes):
            total = 0.0
            for m in range(terms):
                total += table[i, m] * turned[m, k]
            arcs[i, k] = total
    for k in side_by_side(lanes):
        arcs[0, k] = arcs[terms - 1, (k + lanes - 1) % lanes]


def circle_places(start, arm):
    """Cosines and sines of the circle's samples, from a start [rad] on, to ``hidden``."""
    if len(arm["turned"]) == TERMS:
        _circle_places(start, PLACES_8, arm["hidden"])
    else:
        _circle_places(start, arm["places"], arm["hidden"])


def _circle_places(start, places, hidden):
    sine, cosine = sincos(start)
    for i in side_by_side(hidden.shape[1]):
        hidden[0, i] = places[0, i] * cosine - places[1, i] * sine
        hidden[1, i] = places[1, i] * cosine + places[0, i] * sine


def window_nodes(centre, half_tan, arm):
    """Cosines and sines of the places at which a window is sampled, to ``hidden``."""
    if len(arm["turned"]) == TERMS:
        _window_nodes(centre, half_tan, NODES_8, arm["hidden"])
    else:
        _window_nodes(centre, half_tan, arm["nodes"], arm["hidden"])


def _window_nodes(centre, half_tan, nodes, hidden):
    for k in side_by_side(hidden.shape[1]):
        q = centre + 2.0 * atan2(half_tan * nodes[k], 1.0)
        hidden[0, k], hidden[1, k] = sincos(q)[1], sincos(q)[0]


def window_arc(half_tan, arm):
    """Bernstein coefficients of f on one window from its samples, to the first column of arcs.

    Returns the noise: the largest contradiction among the samples, ``determinant``, or more where
    the coefficients are rounded by more. They are overwritten, ``series`` is scratch.
    """
    samples, series, turned = arm["determinant"], arm["series"], arm["turned"]
    if len(turned) == TERMS:
        _window_series(samples, half_tan, NODES_8, WINDOW_8, series, turned)
        rounding = 0.0
    else:
        _window_series(samples, half_tan, arm["nodes"], arm["window"], series, turned)
        rounding = _to_bernstein(samples, arm["bernstein"], arm["growth"], series, turned)
    for i in range(len(turned)):
        arm["arcs"][i, 0] = series[i]
    return max(_largest(series, len(turned), len(series)), rounding)


def _window_series(samples, half_tan, nodes, table, series, turned):
    """Coefficients of ``(1 + t^2)^d f`` as a polynomial of t, and seven that should vanish."""
    for k in side_by_side(len(samples)):
        t = half_tan * nodes[k]
        square = (1.0 + t * t) * (1.0 + t * t)
        eighth = square * square * (square * square)
        for _ in range(len(turned) // 16):
            samples[k] *= eighth
    _transform(samples, table, series)


def _to_bernstein(row, table, growth, series, turned):
    """From Chebyshev's coefficients those of Bernstein, in their place; by how much they are off.

    High ones grow by far, and with them what they are rounded by: noise is left out.
    """
    terms, rounding = len(turned), 0.0
    noise = _largest(series, terms, len(series))
    for i in range(terms):
        row[i] = 0.0
    for j in range(terms):
        c = series[j]
        if abs(c) > noise:
            rounding += abs(c) * growth[j]
            for i in range(terms):
                row[i] += c * table[j, i]
    for i in range(terms):
        series[i] = row[i]
    return EPSILON * rounding
