"""Roots that are enclosed each by an interval, side by side: Newton's method kept inside."""

import math

from dh2urdf.kernels.general_6r.arc_samples import BINOMIAL_8
from dh2urdf.kernels.numbers import side_by_side

X, LOW, HIGH, RISING, FINE, SLOPE, GOING, BRACKETS = range(8)
"""Rows of brackets: place in [0, 1], bounds, whether f rises, precision of the place, f' there,
whether the place is to be improved."""

MOST_STEPS = 60


def place_bracket(arm, k, bounds, rising, fine, at):
    """Enclose a root of arc k: ``bounds`` are low, first guess, high; as column ``at``."""
    arcs, scaled, brackets = arm["arcs"], arm["scaled"], arm["brackets"]
    for i in range(len(scaled)):
        binomial = BINOMIAL_8[i] if len(scaled) == len(BINOMIAL_8) else arm["binomial"][i]
        scaled[i, at] = binomial * arcs[i, k]
    brackets[LOW, at], brackets[X, at], brackets[HIGH, at] = bounds
    brackets[RISING, at], brackets[FINE, at] = (1.0 if rising else 0.0), fine
    brackets[SLOPE, at], brackets[GOING, at] = 0.0, 1.0


def narrow_brackets(scaled, n, brackets):
    """Improve n places until each is precise, and leave f' there.

    By Horner's rule in ``t = x / (1 - x)``, or its inverse in the other half: ``f = (1 - x)^2d
    p(t)``, ``scaled`` (2 d + 1, lanes) the coefficients of p.
    """
    lanes, terms = (n + 7) // 8 * 8, len(scaled)
    for k in range(n, lanes):
        brackets[GOING, k] = 0.0
    for _ in range(MOST_STEPS):
        for k in side_by_side(lanes):
            x, low, high = brackets[X, k], brackets[LOW, k], brackets[HIGH, k]
            left = x <= 0.5
            y = 1.0 - x if left else x
            t = (1.0 - y) / y
            value, slope = scaled[terms - 1, k] if left else scaled[0, k], 0.0
            for i in range(1, terms):
                slope = slope * t + value
                value = value * t + (scaled[terms - 1 - i, k] if left else scaled[i, k])
            y2 = y * y
            y4 = y2 * y2
            power = y4 * y4 * y4 * y2
            for _ in range(terms // 16 - 1):
                power *= y4 * y4 * (y4 * y4)
            slope = power * (slope - float(terms - 1) * y * value)
            f, df = power * y2 * value, slope if left else -slope
            above = (f > 0.0) == (brackets[RISING, k] > 0.0)
            low, high = low if above else x, x if above else high
            step = -f / df if df != 0.0 else math.inf
            step = step if low < x + step < high else 0.5 * (low + high) - x
            going = brackets[GOING, k] > 0.0
            brackets[X, k] = x + step if going else x
            brackets[LOW, k], brackets[HIGH, k] = low, high
            brackets[SLOPE, k] = df if going else brackets[SLOPE, k]
            brackets[GOING, k] = 0.0 if abs(step) < brackets[FINE, k] else brackets[GOING, k]
        open_ones = 0
        for k in range(n):
            open_ones += 1 if brackets[GOING, k] > 0.0 else 0
        if open_ones == 0:
            break
