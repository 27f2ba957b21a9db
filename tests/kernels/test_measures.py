"""Measures of solutions against NumPy's singular values and plain differences."""

import numpy as np
import pytest

from dh2urdf import Robot
from dh2urdf.ik.arm import Task, task_jacobian
from dh2urdf.kernels.measures import best_measures

CASES = [
    ("ur5e", "pose"),
    ("stanford", "pose"),
    ("panda", "pose"),
    ("omron_cobra600", "pose"),
    ("planar_rr", "position"),
    ("ur5e", "position"),
    ("ur5e", "position+axis"),
    ("panda", "position+axis"),
]


def solutions(robot, poses=300, most=5):
    """Configurations (m, k, n), some at singularities, and how many of each count."""
    rng = np.random.default_rng(3)
    low, high = robot.bounded(1.0, np.pi)
    q = rng.uniform(low, high, (poses, most, robot.n))
    q[::7], q[1::7, :, -2:] = 0.0, 0.0
    q[2::7] *= 1e-5
    return q, rng.integers(0, most + 1, poses)


@pytest.mark.parametrize(("name", "task"), CASES)
def test_measures_are_those_of_the_jacobian(name, task):
    """Best product, best smallest singular value, best margin: to rounding, at singularities too.

    Both are off by rounding of the largest singular value, with which SVD has to put up as well.
    """
    robot = Robot.from_dh(name)
    q, count = solutions(robot)
    best = np.empty((3, len(q)))
    best_measures(robot.chain.tables, Task(task).number, q, count, best)
    rank = min({"pose": 6, "position": 3, "position+axis": 5}[task], robot.n)
    for i, k in enumerate(count):
        if k == 0:
            assert (best[:, i] == -np.inf).all()
            continue
        J = task_jacobian(robot.chain, Task(task), q[i, :k])
        sigma = np.linalg.svd(J, compute_uv=False)[:, :rank]
        room = np.minimum(q[i, :k] - robot.lower, robot.upper - q[i, :k]).min(axis=1)
        rounding = 1e-14 * sigma.max() ** rank
        np.testing.assert_allclose(best[0, i], sigma.prod(axis=1).max(), rtol=1e-12, atol=rounding)
        np.testing.assert_allclose(best[1, i], sigma[:, -1].max(), rtol=1e-12, atol=2e-14)
        assert best[2, i] == room.max()


def test_a_pose_has_the_same_bits_alone_and_among_others():
    """Which lane a solution is in, and what stands beside it, changes no bit."""
    robot = Robot.from_dh("ur5e")
    q, count = solutions(robot)
    best, one = np.empty((3, len(q))), np.empty((3, 1))
    best_measures(robot.chain.tables, 0, q, count, best)
    for i in range(len(q)):
        best_measures(robot.chain.tables, 0, q[i : i + 1], count[i : i + 1], one)
        np.testing.assert_array_equal(one[:, 0], best[:, i])
