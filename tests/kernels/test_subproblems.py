"""Each subproblem against the equation that defines it, at random and at the edges."""

from __future__ import annotations

import math

import numpy as np
import pytest
from margins import assert_margin

from dh2urdf.kernels.numbers import subproblems as sp
from dh2urdf.kernels.numbers import trig

DRAWS = 300
SLACK = 1e-9


def turn(k, x):
    """Rotation matrix about k (Rodrigues), independent of the kernels."""
    K = np.array([[0, -k[2], k[1]], [k[2], 0, -k[0]], [-k[1], k[0], 0]])
    return np.eye(3) + math.sin(x) * K + (1 - math.cos(x)) * K @ K


def unit(rng):
    v = rng.normal(size=3)
    return v / np.linalg.norm(v)


def draws(seed):
    """Random generators; every third draw is to be made degenerate by the test."""
    for i in range(DRAWS):
        yield np.random.default_rng((seed, i)), i % 3 == 0


def angle(rng, special):
    return rng.choice([0.0, math.pi / 2, math.pi, -math.pi / 2]) if special else rng.uniform(-3, 3)


def off(found, expected):
    """How far the nearest of some angles, or rows of angles, is from those expected."""
    rows = np.abs(np.sin((np.array(found) - np.array(expected)) / 2))
    return rows.reshape(len(found), -1).max(axis=1).min()


def t(v):
    return tuple(float(x) for x in v)


def test_sp1_turns_one_point_onto_the_other():
    """R(k, x) p1 = p2 for every p2 that was made by a turn."""
    away = []
    for rng, special in draws(1):
        k, p1, x = unit(rng), rng.normal(size=3), angle(rng, special)
        count, found = sp.sp1(t(p1), t(turn(k, x) @ p1), t(k))
        assert count == 1
        away.append(off([found], x))
    assert_margin(away, 1e-12)


def test_sp1_of_a_point_on_the_axis_is_free():
    """A point on the axis stays where it is at every angle."""
    k = (0.0, 0.0, 1.0)
    assert sp.sp1((0.0, 0.0, 2.0), (0.0, 0.0, 2.0), k)[0] == -1


def test_sp2_two_turns_meet():
    """Both solutions meet, and the generating pair is one of them."""
    away, apart = [], []
    for rng, special in draws(2):
        k1, k2, x, y = unit(rng), unit(rng), angle(rng, special), angle(rng, special)
        p1 = rng.normal(size=3)
        if special:
            k2 = np.cross(k1, unit(rng))
            k2 /= np.linalg.norm(k2)
        p2 = turn(k2, y).T @ turn(k1, x) @ p1
        count, x1, y1, x2, y2 = sp.sp2(t(p1), t(p2), t(k1), t(k2), SLACK)
        assert count >= 1
        apart += [turn(k1, a) @ p1 - turn(k2, b) @ p2 for a, b in ((x1, y1), (x2, y2))]
        away.append(off([(x1, y1), (x2, y2)], (x, y)))
    assert_margin(np.abs(apart), 1e-7)
    assert_margin(away, 1e-6)


def test_sp2_out_of_reach_has_no_solution():
    """Cones of different height along k2 that never touch give none."""
    assert (
        sp.sp2((1.0, 0.0, 0.0), (0.0, 0.0, 1.0), (0.0, 0.0, 1.0), (0.0, 0.1, 0.995), SLACK)[0] == 0
    )


@pytest.mark.parametrize("straight", [False, True])
def test_sp3_keeps_the_distance(straight):
    """Both turns put the point at the distance; at the far rim they merge and are not lost."""
    away, error = [], []
    for rng, special in draws(3):
        k, p1, p2 = unit(rng), rng.normal(size=3), rng.normal(size=3)
        x = angle(rng, special)
        if straight:
            p1, p2 = p1 - (k @ p1) * k, p2 - (k @ p2) * k
            x = math.atan2(np.cross(k, p1) @ -p2, -p2 @ p1)
        distance = float(np.linalg.norm(turn(k, x) @ p1 - p2))
        count, x1, x2 = sp.sp3(t(p1), t(p2), t(k), distance, SLACK)
        assert count >= 1
        away.append(off([x1, x2], x))
        error += [np.linalg.norm(turn(k, a) @ p1 - p2) - distance for a in (x1, x2)]
    assert_margin(away, 1e-6)
    assert_margin(np.abs(error), 1e-13)


def test_sp4_lies_on_the_plane():
    """Both turns put the point on the plane; where it touches, the merged turn is not lost."""
    away, error = [], []
    for rng, special in draws(4):
        k, p, h = unit(rng), rng.normal(size=3), unit(rng)
        x = angle(rng, special)
        if special:
            x = math.atan2(np.cross(k, p) @ h, p @ h - (k @ p) * (k @ h))
        level = float(h @ turn(k, x) @ p)
        count, x1, x2 = sp.sp4(t(h), t(p), t(k), level, SLACK)
        assert count >= 1
        away.append(off([x1, x2], x))
        error += [h @ turn(k, a) @ p - level for a in (x1, x2)]
    assert_margin(away, 1e-6)
    assert_margin(np.abs(error), 1e-13)


def test_sp4_beyond_the_rim_has_no_solution():
    """A plane 1e-6 beyond the circle is not touched; one 1e-12 beyond is."""
    h, k = (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)
    assert sp.sp4(h, h, k, 1 + 1e-6, SLACK)[0] == 0
    assert sp.sp4(h, h, k, 1 + 1e-12, SLACK)[0] == 1
    assert sp.sp4(h, k, k, 0.0, SLACK)[0] == -1


@pytest.mark.parametrize("case", ["skew", "2||3", "1 meets 2", "1||2", "meets and parallel"])
def test_sp5_three_turns_meet(case):
    """All solutions meet, and the generating angles are among them, in every special geometry."""
    away = []
    for rng, special in draws(5):
        k1, k2, k3 = unit(rng), unit(rng), unit(rng)
        p = rng.normal(size=(4, 3))
        k3 = k2 if "2||3" in case or "and" in case else k3
        k2 = k1 if case == "1||2" else k2
        p[0] = 0 if "meets" in case else p[0]
        x, y, z = (angle(rng, special) for _ in range(3))
        p[0] = turn(k2, y) @ (p[2] + turn(k3, z) @ p[3]) - turn(k1, x) @ p[1]
        if "meets" in case:
            # axes 1 and 2 meet where p0 lies on axis 1: move it there, and p1 with it
            p[1] += turn(k1, x).T @ p[0]
            p[0] = 0
        out = np.empty((4, 3))
        count = sp.sp5(*map(t, p), t(k1), t(k2), t(k3), SLACK, out)
        assert count >= 1
        away.append(off(out[:count], (x, y, z)))
        for a, b, c in out[:count]:
            left, right = p[0] + turn(k1, a) @ p[1], p[2] + turn(k3, c) @ p[3]
            if np.allclose(turn(k2, b) @ right, left, atol=1e-6):
                continue
            assert abs(k2 @ (left - right)) > 1e-4 or abs(left @ left - right @ right) > 1e-4
    assert_margin(away, 1e-5)


@pytest.mark.parametrize("case", ["general", "one angle first", "separate"])
def test_sp6_two_equations(case):
    """The generating angles are among the solutions of both equations."""
    away = []
    for rng, special in draws(6):
        k1, k2 = unit(rng), unit(rng)
        h = np.array([unit(rng) for _ in range(4)])
        p = rng.normal(size=(4, 3))
        if case != "general":
            p[1] = k2
        if case == "separate":
            p[2] = k1
        x, y = angle(rng, special), angle(rng, special)
        d1 = float(h[0] @ turn(k1, x) @ p[0] + h[1] @ turn(k2, y) @ p[1])
        d2 = float(h[2] @ turn(k1, x) @ p[2] + h[3] @ turn(k2, y) @ p[3])
        out = np.empty((4, 2))
        args = (tuple(map(t, h)), tuple(map(t, p)), t(k1), t(k2), d1, d2, SLACK, out)
        count = sp.sp6(*args)
        assert count >= 1
        away.append(off(out[:count], (x, y)))
    assert_margin(away, 1e-5)


def test_slides_meet_their_equations():
    """The prismatic twins 1 to 4 satisfy what they solve, and say where they are free."""
    along, pairs, roots, error, levels = [], [], [], [], []
    for rng, _ in draws(7):
        k1, k2, p, h = unit(rng), unit(rng), rng.normal(size=3), unit(rng)
        x, y = rng.uniform(-2, 2, 2)
        along.append(sp.sp_slide1(t(p), t(p + x * k1), t(k1))[1] - x)
        _, a, b = sp.sp_slide2(t(p), t(p + x * k1 - y * k2), t(k1), t(k2))
        pairs.append((a - x, b - y))
        distance = float(np.linalg.norm(p + x * k1 - h))
        _, a, b = sp.sp_slide3(t(p), t(h), t(k1), distance, SLACK)
        roots.append(min(abs(a - x), abs(b - x)))
        error += [np.linalg.norm(p + root * k1 - h) - distance for root in (a, b)]
        _, a = sp.sp_slide4(t(h), t(p), t(k1), float(h @ (p + x * k1)))
        levels.append(a - x)
    assert_margin(np.abs(along), 1e-12)
    assert_margin(np.abs(pairs), 1e-9)
    assert_margin(roots, 1e-6)
    assert_margin(np.abs(error), 1e-12)
    assert_margin(np.abs(levels), 1e-8)
    assert sp.sp_slide2((0.0, 0.0, 0.0), (1.0, 2.0, 3.0), (0.0, 0.0, 1.0), (0.0, 0.0, 1.0))[0] == -1
    assert sp.sp_slide4((1.0, 0.0, 0.0), (1.0, 2.0, 3.0), (0.0, 0.0, 1.0), 0.0)[0] == -1
    assert sp.sp_slide3((0.0, 0.0, 0.0), (0.0, 2.0, 0.0), (1.0, 0.0, 0.0), 1.0, SLACK)[0] == 0


def test_a_turn_meets_a_slide():
    """R(k1, x) p1 = p2 + y k2 holds for every solution, oblique or in the plane of the circle."""
    away, apart = [], []
    for rng, special in draws(8):
        k1, k2, p1 = unit(rng), unit(rng), rng.normal(size=3)
        if special:
            k2 = np.cross(k1, k2)
            k2 /= np.linalg.norm(k2)
        x, y = rng.uniform(-2, 2, 2)
        p2 = turn(k1, x) @ p1 - y * k2
        count, x1, y1, x2, y2 = sp.sp_turn_slide(t(p1), t(p2), t(k1), t(k2), SLACK)
        assert count >= 1
        away.append(off([x1, x2], x))
        apart += [turn(k1, a) @ p1 - p2 - b * k2 for a, b in ((x1, y1), (x2, y2))]
    assert_margin(away, 1e-6)
    assert_margin(np.abs(apart), 1e-9)


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
