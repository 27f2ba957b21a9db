"""fk and ik_batch of Dask arrays: the same bits as of the whole, a chunk at a time."""

import dask
import dask.array as da
import numpy as np
import pytest

from dh2urdf import Robot
from dh2urdf.exceptions import ArgumentError, ConfigurationError, PoseError


@pytest.fixture(scope="module")
def robot():
    return Robot.from_dh("denso_vs6556")


@pytest.fixture(scope="module")
def Q(robot):
    return np.random.default_rng(0).uniform(robot.lower, robot.upper, (300, 6))


@pytest.mark.parametrize("shape", [(300, 6), (20, 15, 6), (6,)])
def test_fk_of_a_dask_array_is_a_dask_array_of_the_same_bits(robot, Q, shape):
    """Whatever the chunks, also across the joints."""
    q = Q.ravel()[: np.prod(shape)].reshape(shape)
    found = robot.fk(da.from_array(q, chunks=7))
    assert isinstance(found, da.Array)
    assert found.shape == (*shape[:-1], 4, 4)
    np.testing.assert_array_equal(found.compute(), robot.fk(q))


@pytest.mark.parametrize("asked", [{}, {"within_limits": False}, {"task": "position"},
                                   {"locked": {"joint_6": 0.5}, "on_bad": "skip"}])  # fmt: skip
def test_ik_of_a_dask_array_has_dask_arrays_of_the_same_bits(robot, Q, asked):
    """Every array of the answer, in the chunks of the poses."""
    if asked.get("task") == "position":
        robot = Robot.from_dh("planar_rr")
        Q = Q[:, :2]
    Ts = robot.fk(Q)
    if "on_bad" in asked:
        Ts[5] = np.nan
    lazy = robot.ik_batch(da.from_array(Ts, chunks=(64, 2, 4)), **asked)
    assert lazy.q.chunks[0] == (64, 64, 64, 64, 44)
    whole = robot.ik_batch(Ts, **asked)
    names = "q", "residual", "count", "branch_code", "free_mask", "pose_change", "targets"
    for name, found in zip(names, dask.compute(*(getattr(lazy, n) for n in names)), strict=True):
        np.testing.assert_array_equal(found, getattr(whole, name))


def test_what_dask_arrays_cannot_be_asked_is_refused(robot, Q):
    """Shapes at once, before anything is worked out; what only a whole array can have."""
    lazy = da.from_array(robot.fk(Q), chunks=64)
    with pytest.raises(
        ConfigurationError, match=r"q: expected shape \(..., 6\), got \(300, 4, 4\)"
    ):
        robot.fk(lazy)
    with pytest.raises(PoseError, match=r"Dask array of known shape \(m, 4, 4\), got \(300, 6\)"):
        robot.ik_batch(da.from_array(Q))
    for given in ({"locked": {0: np.zeros(300)}}, {"progress": print},
                  {"out": robot.ik_batch(robot.fk(Q))}):  # fmt: skip
        with pytest.raises(ArgumentError, match=next(iter(given))):
            robot.ik_batch(lazy, **given)
