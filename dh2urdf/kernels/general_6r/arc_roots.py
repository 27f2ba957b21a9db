"""Real roots of a trigonometric polynomial, by its Bernstein coefficients on arcs.

These change sign at least as often as it has roots there, and by an even number more (Descartes):
none means no root, one means one. Arcs with more changes are halved until they are decided, so no
root is overlooked.
"""

import math

from dh2urdf.kernels.general_6r.arc_shapes import (
    CENTRE,
    CHANGES,
    CUT,
    DIP,
    DOUBT,
    FIRST,
    FLAT,
    LARGEST,
    LEFT,
    OPEN,
    PAIR,
    PLACE,
    RIGHT,
    ROWS,
    SMALLEST,
    cut,
    extremum,
    shape,
)
from dh2urdf.kernels.general_6r.brackets import SLOPE, X, narrow_brackets, place_bracket
from dh2urdf.kernels.numbers import atan2

NARROWEST = 2e-4
"""Length [rad] of an arc below which a pair at an extremum of f counts as a double root."""

NEAR_DOUBLE = 0.02
"""Imaginary part [rad] below which a complex pair of roots is reported as a double one."""

MEETING = 30.0
"""An extremum of f at which it is below this many times the noise is where roots meet."""

CURVED = 1e4
"""An arc that is bent by less than this many times the noise may be flat: more than two meet."""

UNSURE = 1e-6
"""A root whose place is uncertain by more than this [rad] is in doubt."""

DEEPEST = 1e-6
"""Part of its largest coefficient to which f falls on an arc, without a sign change or a bend that
Newton's method finds, where four roots or more may have run together."""

SIXTEEN = 17
"""Terms of degree 8, whose sixteen roots are as many as solutions and seldom so close."""

SPANS = 31
"""Spans of doubt that are remembered."""

WAITING = 40
"""Arcs that can wait to be halved."""

KEY, MIDDLE, LOW, HIGH, UNCERTAIN, ROOT, AT, SIZE, FACTS = range(9)
"""What is found of an arc: its place among the others, centre, tangents of the ends, whether in
doubt, the bracket of a root (-1: none), or the place of a double root and its slope (1: none)."""

FOUND = 64
"""Most such facts."""


def _note(arm, k, doubt, root, x, slope):
    """Remember what is found of arc k, sorted by places."""
    facts, order, arcs = arm["facts"], arm["order"], arm["arcs"]
    most, terms = len(facts), len(arcs) - ROWS
    n = order[most]
    if n == most:
        arm["fresh"][1, 0] = 1.0
        return
    centre, left = arcs[terms + CENTRE, k], arcs[terms + LEFT, k]
    facts[n, KEY], facts[n, MIDDLE] = 2.0 * centre + left, centre
    facts[n, LOW], facts[n, HIGH], facts[n, UNCERTAIN] = left, arcs[terms + RIGHT, k], doubt
    facts[n, ROOT], facts[n, AT], facts[n, SIZE] = root, x, slope
    place = n
    while place > 0 and facts[order[place - 1], KEY] > facts[n, KEY]:
        order[place] = order[place - 1]
        place -= 1
    order[place] = n
    order[most] = n + 1


def _pair(arm, k, roots, x, f, ddf):
    """Enclose the two roots of arc k beside an extremum that lies across the axis; their number."""
    arcs, most = arm["arcs"], arm["brackets"].shape[1] - 1
    h, positive, terms = math.sqrt(abs(2.0 * f / ddf)), arcs[0, k] > 0.0, len(arcs) - ROWS
    fine = 1e-8 / (2.0 * (arcs[terms + RIGHT, k] - arcs[terms + LEFT, k]))
    bounds = 0.0, max(x - h, 0.0), x
    place_bracket(arm, k, bounds, not positive, fine, roots)
    _note(arm, k, arm["shapes"][DOUBT, k], float(roots), 0.0, 1.0)
    if roots + 1 < most:
        bounds = x, min(x + h, 1.0), 1.0
        place_bracket(arm, k, bounds, positive, fine, roots + 1)
        _note(arm, k, 0.0, float(roots + 1), 0.0, 1.0)
        return roots + 2
    return roots + 1


def _at_extremum(arm, k, roots, noise):
    """Look for a pair of roots of arc k, or a double one, at an extremum of f.

    Their number, and whether this decides the arc.
    """
    arcs, shapes, row = arm["arcs"], arm["shapes"], arm["row"]
    terms, changes = len(row), shapes[CHANGES, k]
    length = 2.0 * (arcs[terms + RIGHT, k] - arcs[terms + LEFT, k])
    for i in range(terms):
        row[i] = arcs[i, k]
    start = shapes[PLACE, k] / (terms - 1) if changes == 0.0 else 0.5
    x, f, df, ddf = extremum(row, start, arm["casteljau"])
    positive = row[0] > 0.0
    if not abs(df) < 1e-4 * abs(ddf) or positive != (ddf > 0.0):
        deep = shapes[SMALLEST, k] < DEEPEST * shapes[LARGEST, k]
        if terms > SIXTEEN and changes == 0.0 and deep:
            _note(arm, k, 0.0, -1.0, start, -2.0)
        return roots, changes == 0.0
    if (f > 0.0) != positive:
        return _pair(arm, k, roots, x, f, ddf), True
    near = NEAR_DOUBLE / length
    if changes != 0.0 and not length < NARROWEST:
        return roots, False
    if 2.0 * abs(f) < near * near * abs(ddf) + noise:
        slope = -1.0 if abs(f) < MEETING * noise else 0.0
        slope = -2.0 if abs(ddf) < CURVED * noise else slope
        _note(arm, k, 0.0, -1.0, x, slope)
    return roots, True


def _enclose(arm, k, roots):
    """Enclose the root of an arc with one."""
    arcs, shapes, terms = arm["arcs"], arm["shapes"], len(arm["row"])
    i = int(shapes[FIRST, k])
    a, b = arcs[i - 1, k], arcs[i, k]
    guess = (i - 1 + a / (a - b)) / (terms - 1)
    length, rising = 2.0 * (arcs[terms + RIGHT, k] - arcs[terms + LEFT, k]), arcs[0, k] <= 0.0
    fine = 1e-8 / length
    bounds = 0.0, guess, 1.0
    place_bracket(arm, k, bounds, rising, fine, roots)
    _note(arm, k, shapes[DOUBT, k], float(roots), 0.0, 1.0)


def _decide(arm, k, roots, pairs, noise):
    """Enclose the roots of arc k, if it is plain where they are; their number, and whether so."""
    arcs, shapes, terms = arm["arcs"], arm["shapes"], len(arm["row"])
    changes, before, decided = shapes[CHANGES, k], roots, shapes[CHANGES, k] == 0.0
    length = 2.0 * (arcs[terms + RIGHT, k] - arcs[terms + LEFT, k])
    if changes == 1.0:
        _enclose(arm, k, roots)
        return roots + 1, True
    if shapes[PAIR, k] > 0.0 if decided else changes == 2.0 and length < pairs[0]:
        roots, decided = _at_extremum(arm, k, roots, noise)
    whole = decided or terms == SIXTEEN or shapes[LARGEST, k] < FLAT * noise
    if shapes[DOUBT, k] > 0.0 and roots == before and whole:  # else its parts are looked at
        _note(arm, k, 1.0, -1.0, 0.0, 1.0)
    if not decided and length < 1e-12:
        _note(arm, k, 0.0, -1.0, 0.5, -2.0)
        decided = True
    dips = changes == 2.0 and 0.0 < shapes[DIP, k] < terms - 1.0
    arcs[terms + CUT, k] = shapes[DIP, k] / (terms - 1) if dips and pairs[2] > 0.0 else 0.5
    return roots, decided


def _isolate(n, noise, pairs, arm):
    """Enclose the roots on n arcs; their number."""
    arcs, parts, waiting, shapes = arm["arcs"], arm["parts"], arm["waiting"], arm["shapes"]
    roots, waits, rows, half = 0, 0, len(arcs), arcs.shape[1] // 2
    most = arm["brackets"].shape[1] - 1
    while n > 0:
        shape(arcs, n, noise, pairs[1], shapes)
        m = 0
        for k in range(n):
            if shapes[OPEN, k] == 0.0 or roots >= most:
                continue
            roots, decided = _decide(arm, k, roots, pairs, noise)
            if decided:
                continue
            if m < half:
                for i in range(rows):
                    parts[i, m] = arcs[i, k]
                m += 1
            elif waits < len(waiting):
                for i in range(rows):
                    waiting[waits, i] = arcs[i, k]
                waits += 1
            else:
                arm["fresh"][1, 0] = 1.0
        if m == 0 and waits > 0:
            m = min(waits, half)
            waits -= m
            for k in range(m):
                for i in range(rows):
                    parts[i, k] = waiting[waits + k, i]
        cut(parts, m, arcs)
        n = 2 * m
    return roots


def _angle(centre, left, right, x):
    """The angle at x in [0, 1] of an arc."""
    return centre + 2.0 * atan2(left + x * (right - left), 1.0)


def _doubt(spans, centre, left, right):
    """Widen the last span of doubt to an arc, or begin one."""
    n = int(spans[0, 0])
    low, high = _angle(centre, left, right, 0.0), _angle(centre, left, right, 1.0)
    if n > 0 and low <= spans[1, n] + 1e-9 and high >= spans[0, n] - 1e-9:
        spans[0, n], spans[1, n] = min(low, spans[0, n]), max(high, spans[1, n])
    elif n < SPANS:
        n += 1
        spans[0, 0], spans[0, n], spans[1, n] = n, low, high


def roots_on_arcs(n, noise, pairs, count, arm):
    """Append the real roots on n arcs; their number.

    ``arcs`` of the record has them, and is overwritten; ``noise`` is the size of f that may be
    zero. Pairs are looked for at an extremum of f on arcs shorter than ``pairs[0]`` [rad], and on
    arcs without sign changes whose smallest coefficient is below the part ``pairs[1]`` of the
    largest; longer arcs with two are cut where the coefficients dip if ``pairs[2]`` is 1, else in
    the middle. Spans of doubt ``fresh`` are widened or appended, their number ``fresh[0, 0]``, each
    from ``fresh[0, i]`` to ``fresh[1, i]`` [rad]: there f is so small, or a root so uncertain, that
    it should be sampled anew. ``roots`` and ``slopes``, of which ``count`` are there already, get
    angles [rad] and |f'|; the slope is 0 where a complex pair is close to the real axis, -1 where
    two roots meet within the noise, -2 where more of them do.
    """
    facts, order, brackets, spans = arm["facts"], arm["order"], arm["brackets"], arm["fresh"]
    roots, slopes = arm["roots"], arm["slopes"]
    order[len(facts)] = 0
    narrow_brackets(arm["scaled"], _isolate(n, noise, pairs, arm), brackets)
    for place in range(order[len(facts)]):
        i = order[place]
        centre, left, right = facts[i, MIDDLE], facts[i, LOW], facts[i, HIGH]
        x, slope, doubt = facts[i, AT], facts[i, SIZE], facts[i, UNCERTAIN] > 0.0
        if facts[i, ROOT] >= 0.0:
            bracket = int(facts[i, ROOT])
            x, slope = brackets[X, bracket], abs(brackets[SLOPE, bracket]) / (2.0 * (right - left))
            slope += 1e-300
            doubt = doubt or slope * UNSURE < noise
        if (facts[i, ROOT] >= 0.0 or slope <= 0.0) and count < len(roots) - 1:
            roots[count], slopes[count] = _angle(centre, left, right, x), slope
            count += 1
        if doubt:
            _doubt(spans, centre, left, right)
    return count
