"""Poses with two directions in which the tool hardly moves, one of which is a family, or none is.

Angles of 4 or 9 digits leave of a family a stretch on which the pose is kept to 1e-12, beside
another direction that moves the tool by a millionth; and where curves of solutions cross, each of
them leaves between the two directions.
"""

from dataclasses import replace

import numpy as np
import pytest
from dh_arm import arm_of
from ik_referee import forward
from self_motions import crossing_ways, directions, is_family, newton
from sweep import Tally, judge

from dh2urdf.dh import DHTable
from dh2urdf.transforms import planar_rotation

ALL = np.ones(6, bool)


def arm(text, right):
    """A standard table, rows of theta, d, a, alpha, angles in multiples of a right angle."""
    rows = np.array([[float(cell) for cell in row.split()] for row in text.split(";")])
    rows[:, [0, 3]] *= right
    signs = rows[:, 4] if rows.shape[1] > 4 else np.ones(6)
    table = DHTable.from_array(rows[:, :4], "standard", "theta d a alpha")
    turned = zip(table.rows, signs, strict=True)
    return replace(table, rows=tuple(replace(row, sign=int(sign)) for row, sign in turned))


FOUR, NINE = 1.5708, 1.570796327

UR3 = "0 .14 0 2; 0 0 -.31 0; 0 0 -.27 0; 0 .08 0 1; 0 .06 0 -1; 0 .08 0 0"
UR3_FLAT = "0 .18 0 2; 0 0 -.29 0; 0 0 -.18 0; 0 .09 0 1; 0 .11 0 -1; 0 .12 0 0"
UR30 = "0 0 0 1; 0 0 -.39 0; 0 0 -.38 0; 0 .28 0 1; 0 .22 0 -1; 0 .16 0 0"
CRX = "0 .28 0 -1 1; -1 0 .91 0 1; 0 0 0 -1 -1; 0 .74 0 1 -1; 0 -.18 0 -1 -1; 0 .16 0 0 -1"
TX2 = "0 .26 0 -1; -1 .02 .36 0; 1 0 0 2; 0 .33 0 -1; 0 0 0 1; 0 .07 0 0"
CROSSING = "-1 0 .2 1 -1; 2 .3 -.1 0 1; 1 0 -.2 0 1; 0 0 -.1 0 1; 2 -.1 .3 -1 -1; 2 .3 .2 0 1"
"""Axes 2 to 5 are parallel, links and base of equal lengths: parallelograms, or crossed."""

H = np.pi / 2
POSES = {
    "beside another weak direction": (
        *(UR3, FOUR),
        (
            *(-0.7853981633966225, 1.8385956935511776, -0.583363544674335),
            *(0.560449366700603, -7.41365025921679e-13, -2.056007530141892),
        ),
    ),
    "stretched, beside one": (
        *(UR3_FLAT, FOUR),
        (
            *(-3.1415926534827285, -0.7853981634046221, -2.932702569523467e-11),
            *(-0.7853981634141557, 7.743040154776809e-11, -2.0321838457985583e-10),
        ),
    ),
    "a double root beyond a stretch": (
        *(UR30, NINE),
        (
            *(2.0943951028770504, 0.5235987753812444, 3.14159266871013),
            *(2.0943951085573183, 3.1415926488286976, 2.617993865266221),
        ),
    ),
    "other joints have to move a little": (CRX, FOUR, (H / 2, 0, H, H, 2 * H, -H)),
    "hardly moving in two directions": (TX2, NINE, (4 * H / 3, 0, 2 * H / 3, H, 4 * H / 3, -H)),
    "on a parallelogram": (CROSSING, H, (-H, -H, 0, H, H, 0)),
    "where parallelograms cross": (CROSSING, H, (-H, H, H, -2 * H, -2 * H, H)),
}


@pytest.mark.parametrize("noise", [0.0, 1e-9])
@pytest.mark.parametrize("name", POSES)
def test_a_pose_of_two_flat_directions_loses_nothing_and_names_what_a_walk_confirms(name, noise):
    """The configuration is found, or is on a family that is named; each named one is walked."""
    text, right, q = POSES[name]
    q = np.array(q) + noise * np.random.default_rng(0).standard_normal((1, 6))
    tally = Tally(name)
    judge(tally, arm(text, right), q, lambda robot, Ts: robot.ik_batch(Ts, within_limits=False))
    assert tally.notes == []


@pytest.mark.parametrize("turn", [0.0, 0.4, 0.8])
def test_the_referee_sees_in_which_ways_curves_cross(turn, monkeypatch):
    """Two curves leave a straight parallelogram, and each of their points reaches the pose.

    Whichever two flat directions the decomposition gives, which differs between processors.
    """
    chain = arm_of(arm(CROSSING, H))
    q = np.array([-H, 2 * H, H, 0.0, 0.0, 0.0])
    T = forward(chain, q)

    def turned(*given):
        sigma, V = directions(*given)
        return sigma, np.vstack([V[:-2], planar_rotation(turn)[:2, :2] @ V[-2:]])

    monkeypatch.setattr("self_motions.directions", turned)
    assert (directions(chain, q, ALL)[0][-2:] < 1e-12).all()
    left = []
    for way in crossing_ways(chain, q, T, ALL, 0.05):
        point, residual = newton(chain, q + 0.05 * way, T, ALL, 1e-12, 30, 1e-14)
        arrives = np.linalg.norm(point - q - 0.05 * way) < 0.01
        if arrives and all(way @ other < 0.99 for other in left):
            assert residual < 1e-13
            left.append(way)
    assert len(left) == 4
    assert is_family(chain, q, T, ALL)
