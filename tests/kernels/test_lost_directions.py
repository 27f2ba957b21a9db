"""The Jacobian's determinant where its motions depend on each other."""

import importlib

import numpy as np

follow = importlib.import_module("dh2urdf.kernels.followers.follow")


def test_a_determinant_without_several_directions_is_zero(monkeypatch):
    """Also where rounding, over pivots that are none, leaves the range and makes no number."""

    def equations(chain, T, q, work):
        work[:] = np.eye(6, 14, 8)
        work[0, 8] = work[1, 9] = work[2, 10] = 0.0
        work[1, 8] = work[2, 8] = 1e-17

    monkeypatch.setattr(follow, "normal_equations", equations)
    with np.errstate(all="ignore"):
        assert follow.scaled_determinant(None, None, None, 1.0, np.empty((6, 14))) == 0.0
