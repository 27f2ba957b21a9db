"""Six values, one of which moves two joints or more, against products and a search."""

import math
from itertools import product as pairs

import numpy as np
import pytest
from follower_arms import (
    AWAY,
    MULTIPLIERS,
    configurations,
    coupled,
    follower_chain,
    random_links,
    search,
)
from hypothesis import given, settings
from hypothesis import strategies as st
from ik_referee import (
    GAP,
    RESIDUAL,
    distances,
    exists,
    forward,
    gaps,
    misses,
    regularity,
    residuals,
    rows_of,
    solve,
)
from margins import assert_margin

from dh2urdf.exceptions import NoSolverError
from dh2urdf.ik.arm import select_solver

CLASSES = list(pairs(AWAY, MULTIPLIERS))
REGULAR = 1e-4

LOST = 3e-4
"""Part of those near a singularity that may be lost: several meet at one turn of the leader."""

STARTS = 100, 400, 1600, 6400
"""Of the search; each time where that before found fewer."""


def check(chain, q):
    """Solutions reach their poses, are different, and the configurations are among them.

    Returned are the residuals, and how many are not that are nearly singular: closer than
    ``REGULAR`` to where others meet them. Regular ones all are.
    """
    Ts = forward(chain, q)
    found = solve(chain, Ts)
    assert found.count.all(), q[found.count == 0].tolist()
    solutions, owner = rows_of(found)
    sigma, residual = regularity(chain, q), residuals(chain, solutions, Ts[owner])
    away, regular = misses(chain, found, q), sigma > REGULAR
    assert residual.max() < RESIDUAL
    assert residual[regular[owner]].max(initial=0.0) < 0.1 * RESIDUAL
    lost = regular & (away > 1e-12 / np.maximum(sigma, REGULAR) + 1e-8)
    assert not lost.any(), q[lost].tolist()
    assert distances(chain, found).min(initial=9.0) > GAP
    families = (exists(found) & (found.free != 0)).any(axis=1)
    return residual, int((~regular & ~families & (away > 1e-3)).sum())


def check_class(away, multiplier, square, seeds, poses):
    """The same of chains of a class, as many poses each, one in three near a singularity.

    Returned are how many chains there were, for right-angled ones may have joints to spare, and
    how many of the nearly singular are lost.
    """
    lost, some = 0, []
    for seed in seeds:
        chain = follower_chain(seed, multiplier, away, square).in_turns
        try:
            residual, missed = check(chain, configurations(chain, poses, seed))
        except NoSolverError:
            assert square
            continue
        some.append(residual)
        lost += missed
    assert_margin(np.concatenate(some), RESIDUAL, quantile=0.999)
    return len(some), lost


@pytest.mark.parametrize(("away", "multiplier"), CLASSES)
@pytest.mark.parametrize("square", [False, True])
def test_the_configuration_of_a_pose_is_found(away, multiplier, square):
    """Random and right-angled chains."""
    chains, lost = check_class(away, multiplier, square, range(4), 15)
    assert chains >= (1 if square else 4)
    assert lost <= square


@pytest.mark.exhaustive
@pytest.mark.parametrize(("away", "multiplier"), CLASSES)
@pytest.mark.parametrize("square", [False, True])
def test_the_configuration_of_20_000_poses_is_found(away, multiplier, square):
    """The same of forty chains of each class or more."""
    chains, lost = check_class(away, multiplier, square, range(100, 145 if square else 140), 500)
    print(f"{lost} nearly singular lost of {500 * chains} poses")
    assert chains >= 40
    assert lost <= LOST * 500 * chains / 3


def check_counts(chain, count, seed):
    """A search from 100 starts, or from more where it finds fewer, finds the same solutions."""
    q = np.random.default_rng(seed).uniform(-math.pi, math.pi, (count, 6))
    Ts = forward(chain, q)
    found = solve(chain, Ts)
    for i, T in enumerate(Ts):
        mine, searched = found.of(i)[0], np.empty((0, 6))
        for starts in STARTS:
            searched = search(chain, T, starts, seed=i)
            if len(searched) >= len(mine):
                break
        assert len(searched) == len(mine), q[i].tolist()
        assert gaps(chain, searched[:, None], mine[None]).min(axis=1).max() < 1e-5


@pytest.mark.parametrize(("away", "multiplier"), [(0, -1.0), (1, 1.0), (2, 0.5)])
def test_counts_equal_those_of_a_search(away, multiplier):
    """At two poses of a chain."""
    check_counts(follower_chain(7, multiplier, away).in_turns, 2, 1)


@pytest.mark.exhaustive
@pytest.mark.parametrize(("away", "multiplier"), CLASSES)
def test_counts_equal_those_of_a_search_at_40_poses(away, multiplier):
    """Four chains of each class."""
    for seed in range(200, 204):
        check_counts(follower_chain(seed, multiplier, away).in_turns, 10, seed)


@pytest.mark.parametrize("step", [math.pi / 2, math.pi / 4])
@pytest.mark.parametrize("away", AWAY)
def test_poses_on_a_grid_keep_their_configuration(away, step):
    """All joints at multiples of 90 and of 45 degrees, where that is an isolated solution."""
    rng = np.random.default_rng(11)
    regular = 0
    for seed in range(3):
        chain = follower_chain(seed, -1.0, away, square=True).in_turns
        q = step * rng.integers(-4, 5, (12, 6))
        q = q[regularity(chain, q) > 1e-3]
        regular += len(q)
        if len(q):
            try:
                check(chain, q)
            except NoSolverError:
                continue
    assert regular > 3


def test_two_followers_of_one_joint_are_covered():
    rng = np.random.default_rng(0)
    for leaders in ((0, 1, 2, 2, 2, 3, 4, 5), (0, 1, 1, 2, 1, 3, 4, 5)):
        factors = [1.0, 1.0, 1.0, 1.0, -1.0, 1.0, 1.0, 1.0]
        chain = coupled(random_links(rng, 9, False), leaders, factors).in_turns
        check(chain, configurations(chain, 6, 1))


def test_two_joints_with_followers_are_refused_by_name():
    leaders = (0, 1, 1, 2, 2, 3, 4, 5)
    chain = coupled(random_links(np.random.default_rng(0), 9, False), leaders, np.ones(8))
    with pytest.raises(NoSolverError, match="ik_numeric finds some") as refused:
        select_solver(chain.in_turns)
    assert "the values b and c move more than one joint each" in str(refused.value)


@given(
    st.integers(0, 10_000),
    st.sampled_from([(1, 1), (1, -1), (2, 1), (1, 2), (-2, 1), (3, 1), (1, -3)]),
    st.sampled_from(AWAY),
)
@settings(max_examples=15, deadline=None)
def test_any_coupling_finds_the_configuration(seed, ratio, away):
    """Multipliers p/q with p + q up to 4, also negative ones, anywhere."""
    chain = follower_chain(seed, ratio[0] / ratio[1], away).in_turns
    check(chain, np.random.default_rng(seed).uniform(-math.pi, math.pi, (2, 6)))
