"""An elbow arm whose wrist centre is on axis 1: joint 1 is named as free, and there once."""

import math

import numpy as np
import pytest

from dh2urdf.kernels.spherical_wrist.position_any import elbow_on_axis
from dh2urdf.kernels.spherical_wrist.position_arm import FREE, SHOULDER_FREE, place_wrist_in_plane


def rows_for(px, py):
    """Joint values, codes and masks of an arm of two links of 0.5 m, for a point 0.8 m up."""
    form, arm = np.zeros((4, 7)), np.zeros((8, 5))
    form[:, 1], form[:, 6] = 1.0, 1.0
    form[0, 1], form[0, 2] = 0.0, 1.0  # axis 2 level
    form[1, 0] = form[2, 0] = 0.5
    found = place_wrist_in_plane(form, px, py, 0.8, 1e-12, arm)
    return arm[:found]


@pytest.mark.parametrize("away", [0.0, 0.5 * FREE])
def test_on_axis_1_joint_1_is_free(away):
    """Both elbows, once each; the same arm turned half round is no other."""
    rows = rows_for(away, 0.0)
    assert len(rows) == 2
    assert (rows[:, 4].astype(int) & SHOULDER_FREE == SHOULDER_FREE).all()


def test_beside_axis_1_both_shoulders_are_found():
    """Two shoulders, two elbows each, which reach the point; none is free."""
    rows = rows_for(1e-3, 0.0)
    assert len(rows) == 4
    assert (rows[:, 4] == 0).all()
    for q1, q2, q3 in rows[:, :3]:
        out = 0.5 * (math.cos(q2) + math.cos(q2 + q3))
        up = 0.5 * (math.sin(q2) + math.sin(q2 + q3))
        np.testing.assert_allclose([out * math.cos(q1), up], [1e-3, 0.8], atol=1e-12)


@pytest.mark.parametrize("which", [0, 1])
def test_of_two_equations_of_the_elbow_the_one_that_says_more_gives_both(which):
    """The centre on axis 1, where the other equation is empty: both angles, at the nice joint 1."""
    N, d, pairs = np.zeros((2, 2)), np.zeros(2), np.empty((4, 4))
    N[which], d[which] = (0.8, 0.6), 0.5
    assert elbow_on_axis(N, d, 0.3, 1e-12, pairs) == 2
    assert abs(pairs[0, 2:] - pairs[1, 2:]).max() > 0.1
    for c1, s1, c3, s3 in pairs[:2]:
        np.testing.assert_allclose(
            [0.8 * c3 + 0.6 * s3, c1, s1], [0.5, math.cos(0.3), math.sin(0.3)]
        )
