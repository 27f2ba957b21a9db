"""``seed_tolerance``: a hard bound on how far each joint may be from the seed."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dh2urdf import Robot
from dh2urdf.exceptions import ArgumentError

ARMS = {name: Robot.from_dh(name) for name in ("puma560", "ur5", "stanford", "planar_rrr")}
SEEDS = st.integers(0, 2**32 - 1)


def gaps(arm, q, seed):
    """Distances (k, n) by the angle between unit vectors, or of lengths."""
    turn = np.abs(np.angle(np.exp(1j * (q - seed))))
    return np.where(arm.slides, np.abs(q - seed), turn)


@settings(max_examples=60, deadline=None)
@given(st.sampled_from(sorted(ARMS)), SEEDS, st.floats(0.01, 3.5), st.booleans())
def test_what_is_given_is_what_is_near_and_nothing_near_is_left_out(name, draw, most, inside):
    """Against the list without a bound, each joint measured here; the order stays."""
    arm, rng = ARMS[name], np.random.default_rng(draw)
    q, seed = (rng.uniform(arm.lower, arm.upper) for _ in range(2))
    seed = q + rng.uniform(-most, most, arm.n) if rng.random() < 0.5 else seed
    tolerance = most if rng.random() < 0.5 else rng.uniform(0, most, arm.n)
    every = arm.ik(arm.fk(q), seed=seed, within_limits=inside)
    found = arm.ik(arm.fk(q), seed=seed, seed_tolerance=tolerance, within_limits=inside)
    near = (gaps(arm, every.q, seed) <= tolerance).all(axis=1)
    np.testing.assert_array_equal(found.q, every.q[near])
    assert found.branch == tuple(np.array(every.branch, object)[near])


def test_a_full_turn_is_no_distance():
    """The seed is 359 degrees where the solution is at -1, and the range ends between them."""
    arm = Robot.from_dh("denso_vs6556")
    q = np.radians([-169.0, -20, 40, 30, 50, 60])
    seed = q + np.radians([360.0, 0, 0, 0, 0, 0])
    assert len(arm.ik(arm.fk(q), seed=seed, seed_tolerance=1e-6)) == 1


def test_all_turns_of_what_is_near_are_listed():
    """The bound chooses solutions, ``turns`` lists each in the turns of its range."""
    arm = Robot.from_dh("ur5e")
    q = np.array([0.3, -1.1, 0.9, -0.4, 0.8, 0.2])
    found = arm.ik(arm.fk(q), seed=q, seed_tolerance=0.01, turns="all")
    assert len(found) == 2**6
    assert (gaps(arm, found.q, q) < 1e-6).all()


@pytest.mark.parametrize(
    ("tolerance", "got"), [(-0.1, "-0.1"), (float("nan"), "nan"), ([1.0, 2.0], "[1.0, 2.0]")]
)
def test_a_tolerance_is_a_number_or_one_for_each_joint(tolerance, got):
    """Not below 0, and no NaN; the message has what was given."""
    arm = ARMS["puma560"]
    with pytest.raises(ArgumentError) as caught:
        arm.ik(np.eye(4), seed=np.zeros(6), seed_tolerance=tolerance)
    expected = "a number, or 6 of them, not below 0"
    assert str(caught.value) == f"seed_tolerance: expected {expected}, got {got}"


def test_a_tolerance_needs_a_seed():
    """On its own it is refused, with limits and without."""
    for inside in (True, False):
        with pytest.raises(ArgumentError, match="no seed from which"):
            ARMS["ur5"].ik(np.eye(4), seed_tolerance=0.1, within_limits=inside)
