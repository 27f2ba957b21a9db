"""A solution stands alone: kept or pickled, it does not hold the batch that it is of."""

import pickle
import tracemalloc

import numpy as np
import pytest

import dh2urdf


@pytest.mark.parametrize("arm", ["ur5", "puma560", "planar_rr"])
def test_a_pickled_solution_does_not_hold_its_batch(arm):
    """It is as large as that of one pose, however many poses the batch has."""
    robot = dh2urdf.Robot.from_dh(arm)
    q = np.random.default_rng(0).uniform(-1.0, 1.0, (5_000, robot.n))
    T = robot.fk(q)
    one = len(pickle.dumps(robot.ik(T[7])))
    batch = robot.ik_batch(T)
    for of in (batch, robot.ik_batch(T[:10]), batch[5:9]):
        assert len(pickle.dumps(of[3])) < 1.2 * one
    again = pickle.loads(pickle.dumps(batch[7]))
    np.testing.assert_array_equal(again.q, robot.ik(T[7]).q)
    assert len(pickle.dumps(batch)) > 20 * one


def test_a_solution_that_is_kept_lets_the_batch_go():
    """The arrays of a batch are freed when only one of its solutions is left."""
    robot = dh2urdf.Robot.from_dh("ur5")
    T = robot.fk(np.random.default_rng(0).uniform(-1.0, 1.0, (20_000, 6)))
    tracemalloc.start()
    found = robot.ik_batch(T)[3]
    kept = tracemalloc.get_traced_memory()[0]
    tracemalloc.stop()
    assert len(found)
    assert kept < 1e6
