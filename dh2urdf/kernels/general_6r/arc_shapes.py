"""Arcs side by side: what the Bernstein coefficients of f on each say, how to cut them, extrema.

An arc is a column: its coefficients, seventeen for degree 8, then the tangents of half the angles
of its ends, seen from a centre [rad].
"""

import math

from dh2urdf.kernels.numbers import side_by_side

LEFT, RIGHT, CENTRE, CUT, ROWS = range(5)
"""Rows of an arc below its coefficients, the last one where to cut it, and how many rows."""

CHANGES, FIRST, PLACE, SMALLEST, LARGEST, DIP, DEPTH, DOUBT, PAIR, OPEN, SHAPES = range(11)
"""What is said of an arc: sign changes, where the first one is, where the smallest coefficient is,
its size, the largest one's; where the one of the other sign than the first one's is that is the
largest, and minus its size; whether f is in doubt, whether a pair of roots may be at an extremum
without a sign change, whether more is to be done at all."""

STEEP = 1.5
"""Growth from the first coefficient to the second where f has its roots beyond the end."""

FLAT = 1e4
"""An arc on which f is below this many times the noise is in doubt."""

CLEAR = 1e3
"""An arc without a root on which f comes below this many times the noise is in doubt."""

BLIND = 30.0
"""An arc with an end where f is below this many times the noise is in doubt."""


def shape(arcs, n, noise, shallow, shapes):
    """Look at n arcs, a column each, to as many columns of shapes.

    ``noise`` is the size of f that may be zero; an arc whose smallest coefficient is below the part
    ``shallow`` of its largest may hold a pair, unless it is sure that f falls towards an end, for
    then its roots are beyond.
    """
    lanes, terms = (n + 7) // 8 * 8, len(arcs) - ROWS
    last = terms - 1
    for k in side_by_side(lanes):
        shapes[CHANGES, k], shapes[FIRST, k], shapes[PLACE, k] = 0.0, 0.0, 0.0
        shapes[SMALLEST, k], shapes[LARGEST, k] = abs(arcs[0, k]), abs(arcs[0, k])
        shapes[DIP, k], shapes[DEPTH, k] = 0.0, abs(arcs[0, k])
    for i in range(1, terms):
        at = float(i)
        for k in side_by_side(lanes):
            size, least, changes = abs(arcs[i, k]), shapes[SMALLEST, k], shapes[CHANGES, k]
            height, depth = math.copysign(size, arcs[i, k] * arcs[0, k]), shapes[DEPTH, k]
            turn = 1.0 if (arcs[i, k] > 0.0) != (arcs[i - 1, k] > 0.0) else 0.0
            shapes[FIRST, k] = at if turn > changes else shapes[FIRST, k]
            shapes[CHANGES, k] = changes + turn
            shapes[PLACE, k] = at if size < least else shapes[PLACE, k]
            shapes[SMALLEST, k] = min(least, size)
            shapes[LARGEST, k] = max(shapes[LARGEST, k], size)
            shapes[DIP, k] = at if height < depth else shapes[DIP, k]
            shapes[DEPTH, k] = min(depth, height)
    for k in side_by_side(lanes):
        left, right, place = abs(arcs[0, k]), abs(arcs[last, k]), shapes[PLACE, k]
        smallest, largest = shapes[SMALLEST, k], shapes[LARGEST, k]
        none = shapes[CHANGES, k] == 0.0
        doubt = largest < FLAT * noise or min(left, right) < BLIND * noise
        doubt = doubt or (none and smallest < CLEAR * noise)
        beyond = place == 0.0 and abs(arcs[1, k]) > STEEP * left
        beyond = beyond or (place == float(last) and abs(arcs[last - 1, k]) > STEEP * right)
        pair = smallest < shallow * largest and not (beyond and smallest > CLEAR * noise)
        shapes[DOUBT, k], shapes[PAIR, k] = (1.0 if doubt else 0.0), (1.0 if pair else 0.0)
        shapes[OPEN, k] = 0.0 if none and not doubt and not pair else 1.0


def cut(parts, m, arcs):
    """Cut m arcs, half as many as fit, by de Casteljau's scheme: 2 m arcs, left ones first.

    Where to cut is the last row of ``parts``, in [0, 1]; they are overwritten.
    """
    lanes, terms = (m + 7) // 8 * 8, len(arcs) - ROWS
    for i in range(terms):
        for k in side_by_side(lanes):
            arcs[i, k] = parts[0, k]
        for j in range(terms - 1 - i):
            for k in side_by_side(lanes):
                x = parts[terms + CUT, k]
                parts[j, k] = (1.0 - x) * parts[j, k] + x * parts[j + 1, k]
    for k in side_by_side(lanes):
        x = parts[terms + CUT, k]
        middle = (1.0 - x) * parts[terms + LEFT, k] + x * parts[terms + RIGHT, k]
        arcs[terms + LEFT, k], arcs[terms + RIGHT, k] = parts[terms + LEFT, k], middle
        arcs[terms + CENTRE, k] = parts[terms + CENTRE, k]
        parts[terms + LEFT, k] = middle
    for i in range(terms + CUT):
        for k in side_by_side(m):
            arcs[i, m + k] = parts[i, k]


def _evaluate(row, x, scratch):
    """f, f' and f'' at x in [0, 1] of a row of Bernstein coefficients (de Casteljau)."""
    y, terms = 1.0 - x, len(row)
    for i in range(terms - 1):
        scratch[i] = y * row[i] + x * row[i + 1]
    for n in range(terms - 2, 2, -1):
        for i in range(n):
            scratch[i] = y * scratch[i] + x * scratch[i + 1]
    a, b, c = scratch[0], scratch[1], scratch[2]
    p, q = y * a + x * b, y * b + x * c
    degree = terms - 1
    second = float(degree * (degree - 1))
    return y * p + x * q, float(degree) * (q - p), second * (a - 2.0 * b + c)


def extremum(row, x, scratch):
    """The place in [0, 1] where f' vanishes, Newton from x, with f, f', f'' there."""
    f, df, ddf = _evaluate(row, x, scratch)
    for _ in range(6):
        step = -df / ddf if ddf != 0.0 else 0.0
        x = min(max(x + step, 0.0), 1.0)
        f, df, ddf = _evaluate(row, x, scratch)
        if abs(step) < 1e-6:
            break
    return x, f, df, ddf
