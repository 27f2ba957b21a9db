"""Two links in a plane, near the places where they fold: what is found reaches the point."""

import math

import numpy as np
import pytest

from dh2urdf.kernels.short_chains.planar import _by_heading, _one_link


def place(l1, l2, t1, t2):
    """Where two links end."""
    x = l1 * math.cos(t1) + l2 * math.cos(t1 + t2)
    return x, l1 * math.sin(t1) + l2 * math.sin(t1 + t2)


@pytest.mark.parametrize("t1", [-3.0, -0.4, 0.7, 2.5])
def test_near_the_fold_the_heading_of_the_second_link_decides(t1):
    """The angles of a folded arm come back from where it ends and how link 2 points."""
    out, t2 = np.zeros((1, 2)), math.pi - 1e-9
    assert _by_heading(0.5, 0.5, *place(0.5, 0.5, t1, t2), t1 + t2, out)
    np.testing.assert_allclose(np.cos(out[0]), np.cos([t1, t2]), atol=1e-9)
    np.testing.assert_allclose(np.sin(out[0]), np.sin([t1, t2]), atol=1e-8)


@pytest.mark.parametrize(("l1", "l2"), [(0.4, 0.0), (0.0, 0.4)])
@pytest.mark.parametrize("rest", [-0.3, 1.2])
def test_a_link_without_length_leaves_an_angle_at_rest(l1, l2, rest):
    """On the circle there is one arm, one angle of which is free; beside it there is none."""
    out, point = np.zeros((1, 2)), place(0.4, 0.0, 0.9, 0.0)
    assert _one_link(l1, l2, *point, 1e-12, rest, out) == (1, True)
    np.testing.assert_allclose(place(l1, l2, *out[0]), point, atol=1e-15)
    assert rest in out[0]
    assert _one_link(l1, l2, point[0] + 0.01, point[1], 1e-12, rest, out) == (0, False)
