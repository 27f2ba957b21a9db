"""A slide next to zero and a wrist that is nearly aligned: what turns there has a name.

Neither is as near as where it would be singular alone, but together they leave a family.
"""

import math

import numpy as np
import pytest
from structured import rounded
from sweep import Tally, judge

from dh2urdf.dh import DHRow, DHTable

H = math.pi / 2


def stanford(d, alphas, theta=-H, convention="standard"):
    """An arm with a slide, by its offsets and twists; joint 5 is turned by ``theta + H``."""
    rows = [DHRow(0.0, x, 0.0, alpha) for x, alpha in zip(d, alphas, strict=True)]
    rows[2] = DHRow(-H, 0.0, 0.0, alphas[2], joint_type="prismatic")
    rows[4] = DHRow(theta + H, d[4], 0.0, alphas[4])
    return DHTable(tuple(rows), convention, name="stanford*")


MEETINGS = [
    (
        stanford((0.3, 0.13, 0, 0, 0, 0.33), (-H, H, H, -H, H, 0.0)),
        None,
        (
            *(1.5707554740045033, 0.7852610574305068, 0.00012671166616620366),
            *(-5.329288225455526e-05, -3.1415599149974662, 3.9099951622454414e-05),
        ),
    ),
    (
        stanford((0.36, 0.16, 0, 0, 0, 0.17), (-H, H, 0.0, -H, H, 0.0)),
        None,
        (
            *(-2.6180013093577834, -1.0471993467331409, 2.188865519789605e-05),
            *(-2.0944044561999746, 3.1415962749564605, -3.1415857070021787),
        ),
    ),
    (
        stanford((0.26, 0.14, 0, 0, 0, 0.27), (0.0, -H, H, 0.0, -H, H), 0.0, "modified"),
        9,
        (
            *(3.1416359587748617, 3.141635047801898, 5.872312197292389e-05),
            *(-3.141577842271882, 1.5710004645390248, -1.5708433485673208),
        ),
    ),
]
"""Tables, decimals of their angles, and configurations near where singularities meet."""


@pytest.mark.parametrize(("table", "decimals", "q"), MEETINGS)
def test_a_family_where_two_singularities_nearly_meet_is_named_and_contains_its_members(
    table, decimals, q
):
    def answers(robot, Ts):
        return robot.ik_batch(Ts, within_limits=False)

    tally = Tally("meetings")
    judge(tally, rounded(table, decimals), np.array(q)[None], answers)
    assert tally.failures() == []
