"""Poses of arms with followers at which the polynomial says little: home, straight wrists."""

from math import pi, radians

import numpy as np
import pytest
from follower_arms import follower_chain
from ik_referee import forward, misses, solve
from margins import assert_margin

from dh2urdf import DHRow, DHTable, Mimic, Robot
from dh2urdf.ik.arm import starts_of

H, BEND = pi / 2, radians(35)

PAINTER = (
    {"d": 0.66, "a": 0.3, "alpha": -H},
    {"theta": -H, "a": 1.2},
    {"a": 0.186, "alpha": -H},
    {"d": 1.4083, "alpha": BEND},
    {"d": 0.079169, "alpha": -2 * BEND},
    {"d": 0.079169, "alpha": BEND, "mimic": Mimic("joint_5", -1.0)},
    {"d": 0.082},
)
"""A hollow wrist."""

GEARED = (
    {"d": 0.3, "a": 0.3, "alpha": -0.6, "theta": 0.3},
    {"a": 0.2, "alpha": 0.6, "theta": 0.3},
    {"alpha": -0.6, "theta": H},
    {"d": 0.2, "a": 0.2, "alpha": -0.6, "theta": 0.3, "mimic": Mimic("joint_3", 1.0)},
    {"a": 0.3, "theta": H},
    {"d": 0.3, "a": 0.2, "theta": 0.3},
    {"d": 0.2, "a": 0.2, "alpha": H, "theta": H},
)
"""Joint 4 turns as joint 3 does."""


def robot(rows):
    """The robot of rows in standard convention."""
    return Robot.from_dh(DHTable(tuple(DHRow(**row) for row in rows), "standard", name="arm"))


def off(arm, q, **asked):
    """How far the nearest solution of the pose at q is from it, angles on the circle."""
    found = arm.ik(arm.fk(q), within_limits=False, **asked).q
    return np.abs(np.remainder(found - q + pi, 2 * pi) - pi).max(axis=1).min(initial=pi)


@pytest.mark.parametrize("bent", [0.0, 1e-12, 1e-8, 1e-5, 1e-4, 1e-3])
def test_a_hollow_wrist_that_is_straight_keeps_its_family(bent):
    """The configuration, or the family that it is on, is among the solutions; home, too."""
    arm, rng = robot(PAINTER), np.random.default_rng(3)
    for k in range(6):
        q = rng.uniform(-3.0, 3.0, 6) if k else np.zeros(6)
        q[4] = bent
        assert off(arm, q, seed=q) < 1e-5, q


@pytest.mark.parametrize("third", [-2.3091, -2.309, -2.3])
def test_a_pose_in_doubt_is_searched_from_more_starts(third):
    """Regular, but the polynomial leads to an odd number; 64 starts missed the one at hand."""
    q = np.array([H, -H, third, 0.0, 0.0, 0.0])
    assert off(robot(GEARED), q) < 1e-9


PAIRS = (
    (122, 0.5, 0, (-1.74851516, 2.14083288, 0.70623296, 0.40997104, 0.46499794, 3.00363726)),
    (136, -1.0, 1, (3.03791654, 1.07998759, 0.56197286, -1.59501351, 2.06899305, -2.76377487)),
)
"""Chains of `follower_chain`, and configurations with another one of the same pose beside them."""


@pytest.mark.parametrize(("seed", "multiplier", "between", "q"), PAIRS)
def test_an_odd_number_of_solutions_is_searched_further(seed, multiplier, between, q):
    """Isolated solutions come in pairs; one of them was left out."""
    chain, q = follower_chain(seed, multiplier, between, False).in_turns, np.array([q])
    found = solve(chain, forward(chain, q))
    assert_margin(misses(chain, found, q), 1e-6)
    assert found.count[0] % 2 == 0


FLAT = (
    (
        113,
        1,
        6,
        (
            -0.7428061850510321,
            1.9103721588679203,
            -0.4761636053085829,
            0.5992706061571491,
            0.41705126900614164,
            -1.4612458453612802,
        ),
    ),
    (
        122,
        2,
        4,
        (
            1.280998189884487,
            1.8537407111729705,
            -2.109495010089149,
            3.104821462368558,
            -1.1940804009488655,
            -1.9365405074049085,
        ),
    ),
)
"""Right-angled chains, how many free turns are between, and how many solutions a pose has."""


@pytest.mark.parametrize(("seed", "between", "count", "q"), FLAT)
def test_a_pair_where_the_polynomial_is_flat_is_found(seed, between, count, q):
    """Two roots where it is 1e-12 of what it is 0.4 rad away: no rounding hides their signs."""
    chain, q = follower_chain(seed, 1.0, between, True).in_turns, np.array([q])
    found = solve(chain, forward(chain, q))
    assert_margin(misses(chain, found, q), 1e-6)
    assert found.count[0] == count


def half_geared():
    """Joint 4 turns half as far as joint 3, whose turns differ: two of them bring both back."""
    wide = {"lower": -9.0, "upper": 9.0}
    rows = [row if "mimic" in row else row | wide for row in GEARED]
    rows[2], rows[3] = rows[2] | {"a": 0.1}, rows[3] | {"mimic": Mimic("joint_3", 0.5)}
    return robot(rows)


def test_all_turns_are_sorted_in_the_values():
    """By distance from the seed in q, not in what the solver counts in."""
    arm, q = half_geared(), np.array([0.3, -0.5, 0.7, 0.4, -0.9, 1.1])
    found = arm.ik(arm.fk(q), seed=q, turns="all").q
    away = np.linalg.norm(found - q, axis=1)
    assert len(found) > 100
    assert (np.diff(away) >= 0.0).all()
    assert away[0] < 1e-9


@pytest.mark.parametrize(("turns", "count"), [(1, 0), (2, 1)])
def test_a_seed_is_near_after_as_many_turns_as_bring_all_joints_back(turns, count):
    """One turn of a value whose period is two is another pose."""
    arm, q = half_geared(), np.array([0.3, -0.5, 0.7, 0.4, -0.9, 1.1])
    seed = q + np.array([0.0, 0.0, 2.0 * pi * turns, 0.0, 0.0, 0.0])
    found = arm.ik(arm.fk(q), seed=seed, seed_tolerance=0.01, within_limits=False)
    assert len(found) == count


def test_there_are_as_many_starts_as_are_asked_for():
    """Of every joint."""
    assert starts_of(robot(PAINTER).chain, 192).shape == (192, 7)
