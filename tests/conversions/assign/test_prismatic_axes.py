"""A sliding axis may stand anywhere, but is drawn near the joint that follows it."""

import numpy as np
import pytest

from dh2urdf import transforms as tf
from dh2urdf.conversions.assign.prismatic_axes import ASIDE, place_prismatic_axes
from dh2urdf.conversions.chains.tree_chain import frame_with_z


def links_with_crossing(x):
    """A slide whose next axis lies along x from x = 1, and the one before crosses that at x."""
    after = tf.pose(frame_with_z(np.array([1.0, 0, 0])), np.array([1.0, 0, 0]))
    before = tf.pose(frame_with_z(np.array([0, 1.0, 0])), np.array([x, 3.0, 0]))
    return np.stack([tf.inverse(before), after])


@pytest.mark.parametrize("x", [1 - ASIDE - 0.5, 1 - ASIDE + 0.5, 1 + ASIDE - 0.5, 1 + ASIDE + 0.5])
def test_a_sliding_axis_goes_no_farther_than_ten_lengths_from_the_next_joint(x):
    """Where the lengths would vanish, if that is near: to either side of the next joint."""
    links = links_with_crossing(x)
    placed = place_prismatic_axes(links, [True], lambda L: [L[1][0, 3] - (1 - x)], 1.0)
    vanished = placed[1][0, 3] == pytest.approx(1 - x, abs=1e-12)
    assert vanished == (abs(x - 1) < ASIDE)
    np.testing.assert_allclose(placed[0] @ placed[1], links[0] @ links[1], atol=1e-12)
