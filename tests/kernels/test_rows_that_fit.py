"""Solutions of a pose that has more of them than there is room for."""

import numpy as np

from dh2urdf.kernels.certificate import copy_rows
from dh2urdf.kernels.shapes import Outputs

RESIDUALS = [1e-10, 1e-16, 3e-10, 1e-9, 2e-10]
FREE = [0, 0, 0, 7, 0]
KEPT = [0.0, 1.0, 3.0]
"""The two sharpest that are isolated, and the member of a family, in their order."""


def rows():
    """Five solutions of two joints, the first joint numbers them."""
    out = Outputs.of(1, 5, 2)
    out.q[0, :, 0], out.residual[0], out.free[0], out.counts[0] = range(5), RESIDUALS, FREE, 5
    return out


def test_the_dullest_isolated_solutions_are_left_out_by_the_kernel():
    """Points of a valley go, not the solution among them."""
    few, (q, residual, _, branch, free) = Outputs.of(1, 3, 2), rows()
    target = few.q[0], few.residual[0], few.branch[0], few.free[0]
    assert copy_rows((q[0], residual[0], branch[0], free[0]), 5, target) == 3
    assert few.q[0, :, 0].tolist() == KEPT
    assert few.free[0].tolist() == [0, 0, 7]


def test_the_dullest_isolated_solutions_are_left_out_of_a_batch():
    """The same of arrays; a pose whose solutions fit keeps them as they are."""
    few = Outputs.of(2, 3, 2)
    few.put(np.array([1]), rows())
    assert few.counts.tolist() == [0, 3]
    assert few.q[1, :, 0].tolist() == KEPT
    fits = rows()
    fits.counts[0] = 2
    few.put(np.array([0]), fits)
    assert few.counts.tolist() == [2, 3]
    assert few.q[0, :2, 0].tolist() == [0.0, 1.0]
