"""Singular poses of arms that rounding of their tables, or of a held value, makes redundant."""

import math

import numpy as np
import pytest
from structured import random_tables, rounded
from sweep import Tally, judge

from dh2urdf.dh import DHRow, DHTable

TABLES = random_tables(54)

POSES = [
    (
        53,
        4,
        (
            -1.4499352883043357e-06,
            -3.061593335661819e-07,
            3.141592916539113,
            1.5707968153590757,
            -9.669395318730715e-07,
            -1.1329981610984426e-06,
        ),
    ),
    (
        17,
        9,
        (
            -1.523560571331681e-10,
            -1.3185380542536534e-11,
            2.887191731421331e-11,
            -3.141592653541557,
            -3.1415926537919114,
            3.141592653738577,
        ),
    ),
    (
        17,
        9,
        (
            -1.3545647506926906e-06,
            9.297327247231177e-07,
            1.5707966983500552,
            -1.5707959275508525,
            1.5707951675828922,
            -3.1415923418826854,
        ),
    ),
    (
        20,
        9,
        (
            3.141304286550413,
            -0.7857876591816537,
            0.0010282968502954425,
            -0.7855465027453793,
            1.570627821269262,
            -0.7866833104425598,
        ),
    ),
    (
        26,
        9,
        (
            0.7853983299340073,
            9.12100268474451e-08,
            -1.5707963705454153,
            -9.937634880518732e-08,
            2.356194490185819,
            -3.141592435184487,
        ),
    ),
    (
        26,
        9,
        (
            1.6279071202482125,
            3.1415927730009146,
            -2.6370894916553107,
            2.0943949833615467,
            2.9176682080287852,
            -1.834540708121013,
        ),
    ),
    (
        53,
        4,
        (
            -2.3561954440772137,
            1.0471980348935586,
            2.0943951241331757,
            1.308995707760125,
            3.141590880619545,
            1.570796332536979,
        ),
    ),
    (
        52,
        4,
        (
            -0.6799472889044181,
            0.07551397151046442,
            -1.6694386563052166,
            -3.1421158652466845,
            -2.349598254870131,
            -2.5677590628317013,
        ),
    ),
]
"""Which table, how many decimals its angles have, and a configuration, which hardly moves the tool
in two directions or more; of the last, in one, along which it is on a family."""


@pytest.mark.parametrize(("table", "decimals", "q"), POSES)
def test_a_singular_pose_of_an_arm_that_hardly_moves_is_searched(table, decimals, q):
    """The configuration is found, or walked to along a family that is one, by the referee."""

    def anywhere(robot, Ts):
        return robot.ik_batch(Ts, within_limits=False)

    tally = Tally("rounded")
    judge(tally, rounded(TABLES[table], decimals), np.array([q]), anywhere)
    assert tally.notes == []


LENGTHS = (0.26, 0.0, 0.55, 0.0, 0.31, 0.0, 0.1)
TWISTS = (0.0, -90.0, 90.0, 90.0, 0.0, -90.0, 90.0)

BESIDE = [
    (1.28e-06, 1.218e-05, 1.570785, -1.570802, 1.5707886, 1.5707814, 1.570806),
    (-1.5707965, -1.62e-07, 1.5707963, -1.5707962, 1.5707963, -6e-08, -1.5707964),
]
"""Configurations of seven joints with joint 2 next to the value at which axes 1 and 3 line up."""


@pytest.mark.parametrize("q", BESIDE)
def test_a_held_value_beside_a_special_one_keeps_families(q):
    """What a search finds beside it does not take their place."""
    rows = (DHRow(0.0, d, 0.0, math.radians(t)) for d, t in zip(LENGTHS, TWISTS, strict=True))
    table, values = DHTable(tuple(rows), "modified", name="seven"), np.array(q)

    def held(robot, Ts):
        return robot.ik_batch(Ts, within_limits=False, locked={1: values[1:2]})

    tally = Tally("held")
    judge(tally, table, values[None], held, held=(1,))
    assert not tally.count["singular lost"]
