"""Equations in the cosine and sine of one angle, and of two, against what defines them."""

import math

import numpy as np
import pytest
from margins import assert_margin

from dh2urdf.kernels.numbers import circles, trig

SLACK = 1e-9


def linear_trig(a, b, d):
    return trig.linear_trig(a, b, d, SLACK)


def circle_pair(M, N, d, out):
    return circles.circle_pair(M, N, d, SLACK, np.empty((3, 5)), out)


def draws(seed):
    """Random generators; every third draw is to be made degenerate by the test."""
    for i in range(300):
        yield np.random.default_rng((seed, i)), i % 3 == 0


def angle(rng, special):
    return rng.choice([0.0, math.pi / 2, math.pi, -math.pi / 2]) if special else rng.uniform(-3, 3)


def off(found, expected):
    """How far the nearest of some angles, or rows of angles, is from those expected."""
    rows = np.abs(np.sin((np.array(found) - np.array(expected)) / 2))
    return rows.reshape(len(found), -1).max(axis=1).min()


def test_linear_equation_in_cosine_and_sine():
    """Both roots satisfy ``a cos + b sin = d``; where they merge, the root is not lost."""
    away, error = [], []
    for rng, special in draws(4):
        a, b = rng.normal(size=2)
        x = math.atan2(b, a) if special else rng.uniform(-3, 3)
        d = a * math.cos(x) + b * math.sin(x)
        count, c1, s1, c2, s2 = linear_trig(a, b, d)
        assert count >= 1
        away.append(off([math.atan2(s1, c1), math.atan2(s2, c2)], x))
        error += [a * c1 + b * s1 - d, a * c2 + b * s2 - d]
    assert_margin(away, 1e-6)
    assert_margin(np.abs(error), 1e-13)


def test_beyond_the_amplitude_there_is_no_root():
    """A level 1e-6 beyond the amplitude is not reached, one 1e-12 beyond is; without one, free."""
    assert linear_trig(1.0, 0.0, 1 + 1e-6)[0] == 0
    assert linear_trig(1.0, 0.0, 1 + 1e-12)[0] == 1
    assert linear_trig(0.0, 0.0, 0.0)[0] == -1


@pytest.mark.parametrize("case", ["general", "one angle first", "separate", "parallel"])
def test_two_equations_in_two_angles(case):
    """The generating angles are among the solutions, and all satisfy both equations."""
    away, error = [], []
    for rng, special in draws(6):
        M, N = rng.normal(size=(2, 2, 2))
        N[0] *= case not in {"one angle first", "separate"}
        M[1] *= case != "separate"
        N[0] = 0.7 * N[1] if case == "parallel" else N[0]
        x, y = angle(rng, special), angle(rng, special)
        c, s = np.array([math.cos(x), math.sin(x)]), np.array([math.cos(y), math.sin(y)])
        d, out = M @ c + N @ s, np.empty((4, 4))
        count = circle_pair(M, N, d, out)
        assert count >= 1
        found = out[:count]
        away.append(off(np.arctan2(found[:, 1::2], found[:, ::2]), (x, y)))
        error += list(np.abs(found[:, :2] @ M.T + found[:, 2:] @ N.T - d).max(axis=1))
    assert_margin(away, 1e-5)
    assert_margin(error, 1e-6, quantile=0.99)


def test_branchless_arctangent():
    """Every quadrant, axis and octant boundary agrees with the library's within 5e-16."""
    angles = np.concatenate([np.linspace(-math.pi, math.pi, 2001), np.arange(-4, 5) * math.pi / 4])
    for scale in (1e-200, 1.0, 1e200):
        for x in angles.tolist():
            s, c = scale * math.sin(x), scale * math.cos(x)
            assert abs(trig.arctangent(s, c) - math.atan2(s, c)) <= 5e-16
    assert trig.arctangent(0.0, -1.0) == math.pi
    assert trig.arctangent(1.0, 0.0) == math.pi / 2
    assert trig.arctangent(0.0, 0.0) == 0.0


@pytest.mark.parametrize("gap", [0.0, 1e-14, 1e-10, 1e-6, 1e-2])
@pytest.mark.parametrize("degree", [1, 2, 3, 4])
def test_roots_of_trigonometric_polynomials(degree, gap):
    """Every real root is found to the square root of rounding, two that nearly touch as well."""
    rng, away = np.random.default_rng(9), []
    for _ in range(300):
        known = rng.uniform(-math.pi, math.pi, 2 * degree)
        known[1] = known[0] + gap
        x = 2 * math.pi * np.arange(9) / 9
        f = np.prod([np.sin((x - root) / 2) for root in known], axis=0)
        m = np.arange(1, degree + 1)[:, None]
        series = np.empty(2 * degree + 1)
        series[0] = f.mean()
        series[1::2], series[2::2] = 2 / 9 * np.cos(m * x) @ f, 2 / 9 * np.sin(m * x) @ f
        c, s = np.empty(2 * degree), np.empty(2 * degree)
        count = trig.trig_roots(series, degree, c, s)
        found = np.arctan2(s[:count], c[:count])
        spread = np.sort(
            np.abs(np.sin((known[:, None] - known) / 2))[np.triu_indices(2 * degree, 1)]
        )
        if degree > 1 and spread[1] < 0.05:
            continue
        away += [off(found, root) for root in known]
    assert_margin(away, 1e-5)
