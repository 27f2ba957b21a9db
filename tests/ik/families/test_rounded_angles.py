"""Files with 1.5708 for a right angle: families are gone but for a few points, which are kept."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from structured import rounded
from sweep import Tally, judge

import dh2urdf
from dh2urdf.dh import DHTable

ROUNDED = [np.pi / 2, 1.570796327, 1.5708, 1.571]
"""Right angles as tables have them [rad]."""


def lost(table, q):
    """What of configurations q (m, 6) is lost, and what is wrong, in words."""
    tally = Tally(table.name)
    judge(tally, table, q, lambda robot, Ts: robot.ik_batch(Ts, within_limits=False))
    return [note for note in tally.notes if "lost" in note or "wrong" in note or "answer" in note]


def ur(right):
    """A UR5e with an angle for a right one."""
    rows = [(0, 0.1625, 0, right), (0, 0, -0.425, 0), (0, 0, -0.3922, 0)]
    rows += [(0, 0.1333, 0, right), (0, 0.0997, 0, -right), (0, 0.0996, 0, 0)]
    return DHTable.from_array(rows, "standard", "theta d a alpha")


def ur_as_printed(right):
    """The same with lengths along x and a tool that is turned by half a turn."""
    rows = [(0, 0.1625, 0, -right), (0, 0, 0.425, 0), (0, 0, 0.3922, 0)]
    rows += [(0, 0.1333, 0, -right), (0, 0.0997, 0, right), (np.pi, 0.0996, 0, 0)]
    return DHTable.from_array(rows, "standard", "theta d a alpha")


def puma(right):
    """An arm with a spherical wrist and an angle for a right one."""
    rows = [(0, 0.3, 0.05, -right), (0, 0, 0.4, 0), (0, 0, 0.03, -right)]
    rows += [(0, 0.4, 0, right), (0, 0, 0, -right), (0, 0.1, 0, 0)]
    return DHTable.from_array(rows, "standard", "theta d a alpha")


@pytest.mark.parametrize("noise", [0.0, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5])
@pytest.mark.parametrize("right", ROUNDED[:3])
@pytest.mark.parametrize("arm", [ur, puma])
def test_a_wrist_at_zero_loses_no_configuration(arm, right, noise):
    """With joint 5 at zero, or next to it, axis 6 hardly says anything, and nothing is lost."""
    q0 = np.radians([-23, 180, -7.3, -28.7, 0, 87.7])
    assert lost(arm(right), q0 + noise * np.random.default_rng(0).standard_normal((40, 6))) == []


@pytest.mark.parametrize("noise", [1e-9, 1e-7, 1e-5])
def test_nine_digits_lose_no_configuration(noise):
    """The same of a table as it is printed, half a turn in its last row."""
    q0 = np.radians([-23, 180, -7.3, -28.7, 0, 87.7])
    q = q0 + noise * np.random.default_rng(0).standard_normal((40, 6))
    assert lost(ur_as_printed(1.570796327), q) == []


def test_a_home_pose_of_a_rounded_arm_is_found():
    """All joints at zero, 1.5708 throughout, twice 1.5708 for a half turn."""
    b = 1.5708
    rows = [(0, 0.22, 0, b), (b, 0.2275, 0.455, 2 * b), (b, 0.2275, 0, b)]
    rows += [(0, 0.495, 0, -b), (0, 0, 0, b), (b, 0, 0.109, 0)]
    assert lost(DHTable.from_array(rows, "standard", "theta d a alpha"), np.zeros((1, 6))) == []


QUARTERS = st.integers(-2, 2).map(lambda k: 0.5 * np.pi * k)
BESIDE = st.sampled_from([0.0, 1e-10, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4])


@settings(max_examples=60)
@given(st.sampled_from(ROUNDED[1:3]), st.integers(0, 2**31), QUARTERS, BESIDE)
def test_wrists_beside_a_right_angle_lose_no_configuration(right, seed, fifth, beside):
    """Joint 5 at a multiple of 90 degrees, or beside it; the other joints anywhere."""
    q = np.random.default_rng(seed).uniform(-3.0, 3.0, 6)
    q[4] = fifth + beside
    for arm in (ur, puma):
        J = dh2urdf.Robot.from_dh(arm(np.pi / 2)).jacobian(q)[:, :4]
        if np.linalg.svd(J, compute_uv=False)[-1] > 0.01:  # no other singularity is near
            assert lost(arm(right), q[None]) == []


NEARLY_SQUARE = [
    (3, (0.0032, 1.5727, 3.146, -1.5802, 1.5677, -1.5735, 1.5737)),
    (2, (-0.01342, 1.58673, -2.61579, -2.11198, -0.26883, 1.05125, 2.62203)),
    (2, (-0.3, 1.5708, -2.6, -2.1, -0.3, 1.1, 2.6)),
]


@pytest.mark.parametrize(("joint", "q"), NEARLY_SQUARE)
def test_a_slide_that_is_nearly_square_to_the_next_axis_loses_no_pair(joint, q):
    """An arm on a rail of which a joint is held: both ways along the rail, also next to its rim."""
    table = rounded(dh2urdf.load_table("abb_irb4600_track"), 4)
    tally, q = Tally("rail"), np.array([q]) + 1e-3 * np.random.default_rng(0).normal(size=(20, 7))

    def held(robot, Ts):
        return robot.ik_batch(Ts, within_limits=False, locked={joint: q[:, joint]})

    judge(tally, table, q, held, held=(joint,))
    assert tally.failures() == []
    assert tally.count["singular lost"] == 0
