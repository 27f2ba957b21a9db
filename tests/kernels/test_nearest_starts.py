"""Where walks start: members nearest to the middle of a family, and where curves come near."""

import importlib

import numpy as np
import pytest

from dh2urdf.engine import INTERPRETED
from dh2urdf.kernels.redundant import Starts
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


@pytest.mark.parametrize(("end", "rows"), [(-3, [[0, -1, 1], [2, 1, -1]]), (3, [[0, 2, 1]])])
def test_the_first_value_of_a_sweep_follows_on_the_last_in_whole_turns_alone(
    monkeypatch, end, rows
):
    """Elsewhere both begin a curve, and each is nearest to the seed if its one neighbour is not."""
    module, seen = importlib.import_module("dh2urdf.kernels.redundant.starts"), []
    monkeypatch.setattr(module, "_towards", lambda *given: seen.append(given[5].tolist()))
    q = np.array([[[0.0, 0.0]], [[0.1, 0.2]], [[0.0, -0.1]]])
    outputs = q, np.zeros((3, 1)), np.ones(3, int), np.zeros((3, 1), int), None
    find = INTERPRETED["dh2urdf.kernels.redundant.starts.find_starts"]
    given = (None, np.zeros((2, 3))), None, 0.0, False, np.zeros(2), np.array([end])
    find(*given, outputs, Starts.of(4, 2))
    assert seen == rows
