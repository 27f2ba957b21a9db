"""Double singularities of UR arms: axis 6 in line and the elbow straight or the arm upright."""

import ik_referee as ref
import numpy as np
import pytest
from ik_referee import GAP, RESIDUAL
from margins import assert_margin

from dh2urdf import Robot

HALF = np.pi / 2
UPRIGHT = np.array([0, -HALF, 0, -HALF, 0, 0])
LISTED = [
    [0, -1.57, 0, -1.57, 0, 0],
    [0.3, -1.57, 0, -1.57, 0, 0.5],
    [0, -1.5685689407, 0, -1.5708488462, 0, 0],
    [-2.1370483663744593, 1.4933990669309187, 0, -0.4237758402314249, 1e-9, 0.982102435973863],
    [-1.3147736315810614, 1.3842359751504167, 0, 2.3996747606336903, 0, -0.5603229297969121],
]


def check_found(robot, configurations):
    """Ik without a seed has q or a family through it, and with q as seed it returns q.

    With q5 not quite zero, a pose rounded to 1e-16 gives q6 to 1e-16 / q5, and the elbow next to
    straight to the root of that: there a solution of the same pose to rounding, near q, is q.
    What is nearer to a family than the contract may be that family: the distance is its residual.
    """
    residual, away, allowed = [], [], []
    for q in configurations:
        T = ref.forward(robot.chain, q)
        for seed in (None, q):
            found = robot.ik(T, within_limits=False, seed=seed)
            assert len(found.q), q.tolist()
            apart = 2 * np.abs(np.sin((found.q - q) / 2))
            for row, free in zip(apart, found.free_joints, strict=True):
                row[list(free)] *= seed is not None
            best = apart.max(axis=1).argmin()
            residual += found.residual.tolist()
            away.append(apart[best].max())
            allowed.append(tolerance_of(robot, q, found.q[best], T))
    assert_margin(residual, RESIDUAL, quantile=0.95)
    assert_margin(away, allowed, quantile=0.9)


def tolerance_of(robot, q, found, T):
    """1e-5 rad; 5e-3 where q5 is not quite zero and the pose found is T to rounding.

    Beside upright the solutions are a loop; where it is shorter than 5e-4, any point stands for it.
    """
    off = np.abs(ref.forward(robot.chain, found) - T).max()
    if abs(q[4]) >= 1e-9:
        return 5e-3 if off <= 3e-15 else 1e-5
    upright = np.abs(q[[1, 2, 3]] - UPRIGHT[[1, 2, 3]]).max() < 3e-3
    return 5e-4 if upright and off <= 1e-13 else 1e-5


@pytest.mark.parametrize("name", ["ur3", "ur5e", "ur10e"])
def test_listed_poses_keep_their_configuration(name):
    """Upright arms and straight elbows with the wrist in line have the solution they come from."""
    robot = Robot.from_dh(name)
    check_found(robot, np.array(LISTED))


@pytest.mark.parametrize("name", ["ur3", "ur5e", "ur10e"])
def test_nearly_upright_arms_are_found(name):
    """From 1e-3 to 1e-11 beside upright, forty arms each, none is lost."""
    robot = Robot.from_dh(name)
    q = np.tile(UPRIGHT, (5, 40, 1))
    beside = np.random.default_rng(5).normal(size=(5, 40, 2))
    q[..., [1, 3]] += np.reshape([1e-3, 1e-5, 1e-7, 1e-9, 1e-11], (5, 1, 1)) * beside
    check_found(robot, q.reshape(-1, 6))


@pytest.mark.parametrize("sine", [0.0, 1e-12, 1e-9, 1e-6])
def test_straight_elbow_with_the_wrist_in_line_is_found(sine):
    """At q3 = 0 with q5 from 0 to 1e-6, sixty random configurations are all found."""
    robot = Robot.from_dh("ur10e")
    q = np.random.default_rng(6).uniform(-3, 3, (60, 6))
    q[:, [2, 4]] = 0.0, sine
    check_found(robot, q)


def test_a_seed_on_a_family_is_its_nearest_member():
    """With the wrist in line, 200 seeds that reach the pose are the first solution."""
    robot = Robot.from_dh("ur10e")
    q = np.random.default_rng(7).uniform(-3, 3, (200, 6))
    q[:, 4] = 0.0
    for within_limits in (False, True):
        first = [robot.ik(robot.fk(x), within_limits=within_limits, seed=x)[0] for x in q]
        assert_margin(np.abs(first - q).max(axis=1), GAP)
