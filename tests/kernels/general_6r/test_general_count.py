"""All solutions of arms with a closed form, counted by a search, by that form and by elimination.

On an arm with a spherical wrist or three parallel axes solutions come in pairs that share roots of
the elimination, so that the general solver meets double roots at every pose.
"""

import pytest
from ik_referee import CLOSED_FORMS, GAP, draw, forward, gaps, regularity, search, shipped, solve

from dh2urdf.ik.families.general_6r import General6R

REGULAR = 1e-3
"""Smallest singular value of the Jacobian, lengths relative, of a solution that is counted."""


def missing(chain, q, found):
    """Which of the solutions q (k, n) are not among those found (j, n)."""
    if not len(found):
        return q
    return q[gaps(chain, q[:, None], found[None]).min(axis=1) > 0.1 * GAP]


def lost_by_elimination(name, poses, seed, starts):
    """Poses, by their drawn configurations, at which a search finds a solution that is lost."""
    chain = shipped(name)
    drawn = draw(chain, poses, seed)
    Ts = forward(chain, drawn)
    general, closed = solve(chain, Ts, solver=General6R(chain)), solve(chain, Ts)
    lost = []
    for i, T in enumerate(Ts):
        mine, others = general.of(i)[0], closed.of(i)[0]
        if starts or len(mine) != len(others):
            others = search(chain, T, seed=i, starts=starts or 400)
        others = others[regularity(chain, others) > REGULAR] if len(others) else others
        away = missing(chain, others, mine)
        if len(away):
            lost.append((drawn[i].tolist(), len(mine), away.tolist()))
    return lost


@pytest.mark.parametrize("name", ["puma560", "ur5", "lite6"])
def test_a_search_finds_nothing_that_elimination_loses(name):
    """Newton from 400 random starts finds no regular solution that the general solver has not."""
    assert not lost_by_elimination(name, 3, seed=11, starts=400)


@pytest.mark.exhaustive
@pytest.mark.parametrize("name", CLOSED_FORMS)
def test_a_long_search_finds_nothing_that_elimination_loses(name):
    """Nor at 25 poses of each arm with a closed form."""
    assert not lost_by_elimination(name, 25, seed=12, starts=400)


@pytest.mark.exhaustive
@pytest.mark.parametrize("name", CLOSED_FORMS)
def test_where_counts_differ_a_search_finds_nothing_more(name):
    """At 3,000 poses, where closed form and elimination differ, elimination has all there is."""
    assert not lost_by_elimination(name, 3000, seed=13, starts=0)


@pytest.mark.exhaustive
@pytest.mark.parametrize("name", CLOSED_FORMS)
def test_a_long_search_finds_nothing_that_the_closed_form_loses(name):
    """The closed forms have every regular solution that a search finds."""
    chain = shipped(name)
    Ts = forward(chain, draw(chain, 25, seed=12))
    found = solve(chain, Ts)
    for i, T in enumerate(Ts):
        others = search(chain, T, seed=i)
        others = others[regularity(chain, others) > REGULAR]
        assert not len(missing(chain, others, found.of(i)[0]))
