"""Equations of closed forms whose two roots may be one.

Each is clamped at its rim: a square root of a number that rounding made negative is 0, and the
residual of the chain decides later whether the merged root is a solution.
"""

import math

MERGE = 1e-14
"""Relative distance from its rim at which an equation has one root instead of two, which would be
1e-7 apart: the middle misses by rounding. Not so with a negative slack."""


def root_of_gap(gap, size, slack):
    """Square root of a gap that vanishes where two roots merge; -1.0 beyond the rim.

    The gap [size] may be negative by ``|slack|``. Where ``slack`` is positive, it is 0 up to
    ``MERGE``, so that rounding does not part two roots; where it is negative, they stay apart.
    """
    if gap <= (MERGE * size if slack > 0.0 else 0.0):
        return -1.0 if -gap > abs(slack) * size else 0.0
    return math.sqrt(gap)


def linear_trig(a, b, d, slack):
    """Solve ``a cos(x) + b sin(x) = d``: the core of subproblems 3 and 4.

    ``slack``: relative excess of ``|d|`` over the amplitude that is clamped, see
    :func:`root_of_gap`. Returns the count (1 where both roots merge, -1 where the amplitude is 0
    and x is free), and cosine and sine of both roots, of the first one twice where there is one.
    """
    square = a * a + b * b
    if square < 1e-300:
        return -1, 1.0, 0.0, 1.0, 0.0
    amplitude = math.sqrt(square)
    root = root_of_gap(amplitude - abs(d), amplitude, slack)
    if root < 0.0:
        return 0, 1.0, 0.0, 1.0, 0.0
    if root == 0.0:
        side = math.copysign(1.0, d) / amplitude
        return 1, side * a, side * b, side * a, side * b
    root *= math.sqrt(amplitude + abs(d))
    c1, s1 = (a * d - b * root) / square, (b * d + a * root) / square
    return 2, c1, s1, (a * d + b * root) / square, (b * d - a * root) / square


def elbow_angle(upper, fore, square, slack):
    """Cosine and sine of the elbow of a planar RR arm (lecture notes 8.2).

    ``square = upper^2 + fore^2 + 2 upper fore cos``. The sine, not negative, comes from the
    product of the distances to the outer and the inner rim, which keeps all digits near both.
    Returns the count (1 on a rim, where the elbow is straight or folded; 0 beyond it) before them.
    """
    outer = (upper + fore) * (upper + fore) - square
    inner = square - (upper - fore) * (upper - fore)
    scale = 2.0 * upper * fore
    size = square + scale
    outer_root, inner_root = root_of_gap(outer, size, slack), root_of_gap(inner, size, slack)
    if min(outer_root, inner_root) < 0.0:
        return 0, 1.0, 0.0
    if outer_root == 0.0:
        return 1, 1.0, 0.0
    if inner_root == 0.0:
        return 1, -1.0, 0.0
    return 2, 0.5 * (inner - outer) / scale, outer_root * inner_root / scale
