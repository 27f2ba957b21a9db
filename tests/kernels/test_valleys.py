"""Points of a valley beside exact solutions: when they are none."""

import importlib

import numpy as np
import pytest

members = importlib.import_module("dh2urdf.kernels.in_doubt.members")


@pytest.mark.parametrize(("slides", "best", "left"), [
    ([0, 1], 1e-15, [0, 2]), ([1, 0], 1e-15, [0, 2]), ([0, 0], 1e-15, [0, 1, 2]),
    ([0, 1], 2e-14, [0, 1, 2]),
])  # fmt: skip
def test_dull_points_beside_exact_solutions_of_slides_are_dropped(monkeypatch, slides, best, left):
    """Not those of arms that only turn, of families, or where no solution is exact."""
    joints = np.column_stack([slides, [-2.0, -3.0], [2.0, 3.0]]).astype(float)
    q, residual = np.arange(6.0).reshape(3, 2), np.array([best, 2e-13, 2e-13])
    rows = q, residual, np.zeros(3, int), np.array([0, 0, 1])
    monkeypatch.setattr(members, "_hardly_moves", lambda *_: True)
    count = members.drop_valleys((None, joints), None, 1.0, rows, 3)
    assert q[:count, 0].tolist() == [2.0 * k for k in left]
