"""Poses beside a family: the solution itself, among what is accepted along the valley.

The tool hardly moves along it, and Newton's method comes to rest anywhere.
"""

import numpy as np
import pytest
from follower_arms import follower_chain
from ik_referee import forward, solve
from structured import sliding_tables
from sweep import Tally, contains, judge

FOLDED = (
    -1.5707963267716896,
    -1.179146439493451e-10,
    2.356194490328209,
    3.1415926534605307,
    1.5707963268203384,
    -1.570796326781406,
)
"""Of the right-angled chain 1003, 1e-10 beside its family; the accepted points fill the answer."""

STRAIGHT = (
    -1.5707963385743258,
    -2.5606735214501327e-06,
    3.1415935600904468,
    -1.5707971114192698,
    3.1415937334577038,
    -1.5707958146172059,
)
"""Of an arm with a slide, its valley 1e-14 deep at a thousandth of a radian."""

LONG = (
    2.8142625854347583,
    0.9279484278683131,
    0.5201390799540764,
    -2.7482567048109217,
    -2.819276653893055,
    1.5653069125706516,
)
"""Of a curve that is 31 rad long, on the far side from the member that is found."""

ALONG = (
    (
        1010,
        1.0,
        (
            -3.141592789349471,
            -0.7853980709123841,
            2.356194543302743,
            -1.5707964941312,
            -8.692968870461613e-08,
            -2.3561944557507437,
        ),
    ),
    (
        1008,
        2.0,
        (
            1.6320696332450208e-10,
            -1.5707963236364597,
            1.5707963258716144,
            1.570796326913808,
            1.5707963286445799,
            7.84050957456133e-10,
        ),
    ),
)
"""Right-angled chains, multipliers, and solutions with a valley along which 1e-11 is added."""


def answer(seed, multiplier, q):
    """The chain, q as (1, 6), its pose and what is found."""
    chain, q = follower_chain(seed, multiplier, 0, square=True).in_turns, np.array([q])
    Ts = forward(chain, q)
    return chain, q, Ts, solve(chain, Ts)


@pytest.mark.parametrize(
    ("seed", "multiplier", "q"), [(1003, -1.0, FOLDED), (1001, 2.0, LONG)], ids=["folded", "long"]
)
def test_a_solution_of_a_chain_with_followers_is_listed_or_on_a_family(seed, multiplier, q):
    """The sharpest stay where not all fit; a curve is walked to its far side."""
    chain, q, Ts, found = answer(seed, multiplier, q)
    k = found.count[0]
    assert contains(chain, found.q[0, :k], found.free[0, :k], q[0], Ts[0], 1e-6)


def test_a_solution_in_a_valley_of_an_arm_with_a_slide_is_found():
    """Plain steps go to and fro along the valley, and bend off it."""
    table = next(t for t in sliding_tables(157) if t.name == "sliding 0/156")
    tally = Tally("one")

    def anywhere(robot, Ts):
        return robot.ik_batch(Ts, within_limits=False)

    judge(tally, table, np.array([STRAIGHT]), anywhere)
    assert tally.notes == []


@pytest.mark.parametrize(("seed", "multiplier", "q"), ALONG)
def test_all_members_of_a_valley_that_is_kept_have_its_name(seed, multiplier, q):
    """It bends: a quarter of the way adds more than a quarter."""
    _, _, _, found = answer(seed, multiplier, q)
    assert (found.free[0, : found.count[0]] != 0).all()
