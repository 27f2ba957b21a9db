"""Real roots of a trigonometric polynomial of degree 8, by its Bernstein coefficients on arcs.

These change sign at least as often as it has roots there, and by an even number more (Descartes):
none means no root, one means one. Arcs with more changes are halved until they are decided, so no
root is overlooked.
"""

import math

from dh2urdf.kernels.general_6r.arc_samples import BINOMIAL, TERMS
from dh2urdf.kernels.numbers import LANES, atan2

STACK = 40
"""Rows that the halving needs at most."""

NARROW = 0.06
"""Length [rad] of an arc on which a pair of roots is looked for at an extremum of f."""

NARROWEST = 2e-4
"""Length [rad] of an arc below which such a pair counts as a double root."""

NEAR_DOUBLE = 0.02
"""Imaginary part [rad] below which a complex pair of roots is reported as a double one."""

MEETING = 30.0
"""An extremum of f at which it is below this many times the noise is where roots meet."""

CURVED = 1e4
"""An arc that is bent by less than this many times the noise may be flat: more than two meet."""

SHALLOW = 0.03
"""An arc whose smallest coefficient is below this part of its largest may hold such a pair."""

STEEP = 1.5
"""Growth from the first coefficient to the second where f has its roots beyond the end."""

FLAT = 1e4
"""An arc on which f is below this many times the noise is in doubt."""

CLEAR = 1e3
"""An arc without a root on which f comes below this many times the noise is in doubt."""

BLIND = 30.0
"""An arc with an end where f is below this many times the noise is in doubt."""

UNSURE = 1e-6
"""A root whose place is uncertain by more than this [rad] is in doubt."""

SPANS = 31
"""Spans of doubt that are remembered."""


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


def _value_and_slope(row, x):
    """f and f' at x in [0, 1] of a row of Bernstein coefficients, by Horner's rule.

    In ``t = x / (1 - x)``, or its inverse in the other half: ``f = (1 - x)^16 p(t)``.
    """
    left = x <= 0.5
    y = 1.0 - x if left else x
    t = (1.0 - y) / y
    value, slope = row[TERMS - 1] if left else row[0], 0.0
    for i in range(1, TERMS):
        k = TERMS - 1 - i if left else i
        slope = slope * t + value
        value = value * t + BINOMIAL[k] * row[k]
    y2 = y * y
    y4 = y2 * y2
    y14 = y4 * y4 * y4 * y2
    slope = y14 * (slope - 16.0 * y * value)
    return y14 * y2 * value, slope if left else -slope


def _bracketed_root(row, low, high, x, rising, tolerance):
    """The root between low and high, Newton from x kept in the bracket, and f' there."""
    df = 0.0
    for _ in range(60):
        f, df = _value_and_slope(row, x)
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


def _may_hold_pair(row, changes, place, shallow, sure, length):
    """Whether to look for a pair of roots at an extremum.

    Not where it is sure that f falls towards an end: its roots are beyond.
    """
    if changes != 0:
        return changes == 2 and length < NARROW
    if sure and place == 0.0 and abs(row[1]) > STEEP * abs(row[0]):
        return False
    if sure and place == 1.0 and abs(row[TERMS - 2]) > STEEP * abs(row[TERMS - 1]):
        return False
    return shallow


def _halve(stack, top):
    """De Casteljau at the middle: row ``top`` keeps the right half, ``top + 1`` gets the left."""
    for i in range(TERMS):
        stack[top + 1, i] = stack[top, 0]
        for j in range(TERMS - 1 - i):
            stack[top, j] = 0.5 * (stack[top, j] + stack[top, j + 1])
    middle = 0.5 * (stack[top, 17] + stack[top, 18])
    stack[top + 1, 17], stack[top + 1, 18] = stack[top, 17], middle
    stack[top, 17] = middle


def _angle(centre, row, x):
    """The angle at x in [0, 1] of a row."""
    return centre + 2.0 * atan2(row[17] + x * (row[18] - row[17]), 1.0)


def _doubt(spans, row, centre):
    """Widen the last span of doubt to a row, or begin one."""
    n = int(spans[0, 0])
    low, high = _angle(centre, row, 0.0), _angle(centre, row, 1.0)
    if n > 0 and low <= spans[1, n] + 1e-9 and high >= spans[0, n] - 1e-9:
        spans[0, n], spans[1, n] = min(low, spans[0, n]), max(high, spans[1, n])
    elif n < SPANS:
        n += 1
        spans[0, 0], spans[0, n], spans[1, n] = n, low, high


def _pair(row, x, f, ddf, rising, length):
    """The two roots beside an extremum at x that lies across the axis, with f' there."""
    h = math.sqrt(abs(2.0 * f / ddf))
    fine = 1e-8 / length
    a, da = _bracketed_root(row, 0.0, x, max(x - h, 0.0), rising, fine)
    b, db = _bracketed_root(row, x, 1.0, min(x + h, 1.0), not rising, fine)
    return a, da, b, db


def _add(roots, slopes, count, angle, slope):
    """Append a root; their number."""
    roots[count], slopes[count] = angle, slope
    return count + 1


def _beside_extremum(here, noise, length, roots, slopes, count):
    """Append the roots at an extremum, two beside it or a double one; whether in doubt."""
    centre, row, x, f, ddf = here
    positive, near = row[0] > 0.0, NEAR_DOUBLE / length
    if (f > 0.0) != positive:
        a, da, b, db = _pair(row, x, f, ddf, not positive, length)
        da, db = abs(da) / length, abs(db) / length
        count = _add(roots, slopes, count, _angle(centre, row, a), da + 1e-300)
        count = _add(roots, slopes, count, _angle(centre, row, b), db + 1e-300)
        return count, min(da, db) * UNSURE < noise
    if 2.0 * abs(f) < near * near * abs(ddf) + noise:
        slope = -1.0 if abs(f) < MEETING * noise else 0.0
        slope = -2.0 if abs(ddf) < CURVED * noise else slope
        count = _add(roots, slopes, count, _angle(centre, row, x), slope)
    return count, False


def roots_on_arc(stack, centre, half_tan, noise, scratch, spans, count, roots, slopes):
    """Append the real roots on one arc; their number.

    The first row of ``stack`` has the arc's Bernstein coefficients, and is overwritten; ``centre``
    is its middle [rad], ``half_tan`` the tangent of a quarter of its length, ``noise`` the size of
    f that may be zero. ``spans[0, 0]`` spans of doubt are widened or appended, each from
    ``spans[0, i]`` to ``spans[1, i]`` [rad]: there f is so small, or a root so uncertain, that it
    should be sampled anew. ``roots`` and ``slopes`` (24,), of which ``count`` are there already,
    get angles [rad] and |f'|; the slope is 0 where a complex pair is close to the real axis,
    -1 where two roots meet within the noise, -2 where more of them do.
    """
    stack[0, 17], stack[0, 18] = -half_tan, half_tan
    top = 0
    while top >= 0 and count < LANES - 1:
        row = stack[top]
        changes, crossing, place, smallest, largest = _shape(row)
        length = 2.0 * (row[18] - row[17])
        end = min(abs(row[0]), abs(row[TERMS - 1]))
        doubt = largest < FLAT * noise or end < BLIND * noise
        doubt = doubt or (changes == 0 and smallest < CLEAR * noise)
        decided = changes < 2
        if changes == 1:
            fine = 1e-8 / length
            x, df = _bracketed_root(row, 0.0, 1.0, crossing, row[0] <= 0.0, fine)
            slope = abs(df) / length + 1e-300
            count = _add(roots, slopes, count, _angle(centre, row, x), slope)
            doubt = doubt or slope * UNSURE < noise
        elif _may_hold_pair(
            row, changes, place, smallest < SHALLOW * largest, smallest > CLEAR * noise, length
        ):
            x, f, df, ddf = _extremum(row, place if changes == 0 else 0.5, scratch)
            positive = row[0] > 0.0
            if abs(df) < 1e-4 * abs(ddf) and positive == (ddf > 0.0):
                pair = (f > 0.0) != positive
                decided = pair or changes == 0 or length < NARROWEST
                if decided:
                    count, unsure = _beside_extremum(
                        (centre, row, x, f, ddf), noise, length, roots, slopes, count
                    )
                    doubt = doubt or unsure
        if doubt:
            _doubt(spans, row, centre)
        if not decided and (length < 1e-12 or top + 2 > STACK):
            count = _add(roots, slopes, count, _angle(centre, row, 0.5), -2.0)
            decided = True
        if decided:
            top -= 1
        else:
            _halve(stack, top)
            top += 1
    return count
