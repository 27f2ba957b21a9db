"""Solutions of a pose that has more of them than there is room for."""

import numpy as np
import pytest

from dh2urdf.kernels.certificate import copy_rows
from dh2urdf.kernels.shapes import Outputs

RESIDUALS = [1e-10, 1e-16, 1e-11, 3e-10, 1e-9, 2e-16, 2e-10]
FREE = [0, 0, 7, 0, 7, 0, 0]
KEPT = [[1, 5], [1, 2, 5], [1, 2, 4, 5], [0, 1, 2, 4, 5]]
"""Of two to five: exact isolated ones, members of families, the sharpest of the others."""


def rows():
    """Seven solutions of two joints, the first joint numbers them."""
    out = Outputs.of(1, 7, 2)
    out.q[0, :, 0], out.residual[0], out.free[0], out.counts[0] = range(7), RESIDUALS, FREE, 7
    return out


@pytest.mark.parametrize("kept", KEPT)
def test_the_dullest_isolated_solutions_are_left_out_by_the_kernel(kept):
    """Points of a valley go, not the solutions among them, and not before members of families."""
    few, (q, residual, _, branch, free) = Outputs.of(1, len(kept), 2), rows()
    target = few.q[0], few.residual[0], few.branch[0], few.free[0]
    assert copy_rows((q[0], residual[0], branch[0], free[0]), 7, target) == len(kept)
    assert few.q[0, :, 0].tolist() == kept
    assert few.free[0].tolist() == [FREE[k] for k in kept]


@pytest.mark.parametrize("kept", KEPT)
def test_the_dullest_isolated_solutions_are_left_out_of_a_batch(kept):
    """The same of arrays; a pose whose solutions fit keeps them as they are."""
    few = Outputs.of(2, len(kept), 2)
    few.put(np.array([1]), rows())
    assert few.counts.tolist() == [0, len(kept)]
    assert few.q[1, :, 0].tolist() == kept
    fits = rows()
    fits.counts[0] = 2
    few.put(np.array([0]), fits)
    assert few.counts.tolist() == [2, len(kept)]
    assert few.q[0, :2, 0].tolist() == [0.0, 1.0]
