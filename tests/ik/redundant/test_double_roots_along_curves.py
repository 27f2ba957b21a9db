"""Families along which other joints are at a double root all the way, and three solutions in a row.

There the Jacobian is flat in directions in which nothing moves, for solvers and for the referee.
"""

import numpy as np
import pytest
from dh_arm import arm_of
from ik_referee import forward, gaps, residuals
from self_motions import STEP, directions, is_family, round_walk
from structured import random_tables, rounded, structured_configurations
from sweep import Tally, judge

import dh2urdf

POSES = 40


def posed(table, row, decimals=None):
    """A random table, and one configuration (1, n) of its structured ones."""
    arm = rounded(random_tables(60)[table], decimals)
    return arm, structured_configurations(arm_of(arm), POSES, table)[row : row + 1]


def faults(table, q):
    """What the referee of sweeps says."""
    tally = Tally("listed")
    judge(tally, table, q, lambda robot, Ts: robot.ik_batch(Ts, within_limits=False))
    return tally.failures()


@pytest.mark.parametrize(
    ("table", "row"),
    [(9, 23), (20, 2), (20, 25), (26, 7), (40, 33), (47, 30), (48, 20), (48, 39), (51, 29)],
)
def test_a_configuration_of_two_planar_groups_is_on_a_named_family(table, row):
    """Four parallel axes and two others: the two are where the height is greatest, all along."""
    assert faults(*posed(table, row)) == []


@pytest.mark.parametrize("noise", [1e-2, 1e-3])
def test_an_arm_that_is_folded_in_both_halves_is_found_on_its_short_loop(noise):
    """Two planar groups at right angles, each next to its fold; the loop is short as the noise."""
    table, rng = random_tables(60)[57], np.random.default_rng(0)
    q = np.radians([90, -90, -180, -45, 90, -45]) + noise * rng.standard_normal((6, 6))
    assert faults(table, q) == []


@pytest.mark.parametrize(("table", "row"), [(26, 6), (47, 18), (57, 17)])
def test_an_arm_that_can_hardly_move_names_what_a_walk_confirms(table, row):
    """A joint is to spare, but here its curve is short, or a point."""
    assert faults(*posed(table, row)) == []


def test_the_one_between_two_solutions_is_found():
    """Right angles of four digits: three solutions within 5e-3 rad, the pose kept to 1e-11."""
    assert faults(*posed(22, 5, 4)) == []


@pytest.mark.parametrize(("table", "row"), [(20, 25), (48, 20)])
def test_the_referee_walks_where_no_flat_direction_is_a_tangent(table, row):
    """Its points are a chain from the pose on: each reaches it, each is next to the last."""
    dh, q = posed(table, row)
    arm, p, free = arm_of(dh), q[0], np.ones(6, bool)
    T = forward(arm, p)
    sigma, V = directions(arm, p, free)
    flat = V[sigma < 1e-5]
    assert len(flat) == 2
    assert is_family(arm, p, T, free)
    for way in np.random.default_rng(0).normal(size=(6, 2)) @ flat:
        walked = np.array([p, *round_walk(arm, p, T, free, way)])
        if len(walked) > 10:
            assert residuals(arm, walked, T).max() < 1e-12
            assert gaps(arm, walked[1:], walked[:-1]).max() < 2.0 * STEP
            return
    pytest.fail("no walk")


def test_the_referee_walks_no_way_from_a_regular_configuration():
    """Though Newton's method by all directions leads somewhere."""
    table = random_tables(60)[40]
    arm = arm_of(table)
    q = structured_configurations(arm, POSES, 40)
    alone = [p for p in q if directions(arm, p, np.ones(6, bool))[0][-1] > 1e-3]
    assert len(alone) > 3
    for p in alone:
        assert not is_family(arm, p, forward(arm, p), np.ones(6, bool))


@pytest.mark.parametrize("row", [3, 9])
def test_a_planar_arm_of_rounded_angles_has_an_answer(row):
    """All axes nearly parallel: three joints nearly to spare, each pose a double root."""
    table, q = posed(53, row, 4)
    arm = arm_of(table)
    T = forward(arm, q[0])
    found = dh2urdf.Robot.from_dh(table).ik(T, within_limits=False)
    assert len(found)
    assert residuals(arm, found.q, T).max() <= 1e-9
