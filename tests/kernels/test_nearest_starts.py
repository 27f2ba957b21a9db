"""Members of a family that a walk starts from again: those nearest to the middle, in order."""

import numpy as np
import pytest

from dh2urdf.kernels.redundant.families import _keep_nearest


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("members", [3, 8, 30])
def test_the_nearest_members_are_kept_in_ascending_order(members, seed):
    """Of any number in any order: as many as there is room for, each with its own size."""
    sizes = np.random.default_rng(seed).permutation(members).astype(float)
    starts, kept, count = np.zeros((8, 2)), np.zeros(8), 0
    for size in sizes:
        count = _keep_nearest(starts, kept, count, np.array([size, -size]), size)
    assert count == min(members, 8)
    np.testing.assert_array_equal(kept[:count], np.sort(sizes)[:count])
    np.testing.assert_array_equal(starts[:count], kept[:count, None] * [1, -1])
