"""Seven joints with one held: a value for all poses, or one for each, is the same problem."""

import numpy as np
import pytest

from dh2urdf import Robot


@pytest.mark.parametrize(
    ("name", "joint"),
    [("franka_fer", 6), *(("kuka_iiwa14", j) for j in (0, 2, 4, 6)), ("kinova_gen3", 2)],
)
def test_one_value_for_all_and_one_for_each_agree(name, joint):
    """Poses of a block with equal held values have the solutions that they have by themselves.

    In the other batch every second pose has another value, so that its blocks have no value in
    common; the poses at the first value are looked at.
    """
    robot = Robot.from_dh(name)
    Q = np.random.default_rng(joint).uniform(-2.5, 2.5, (200, 7))
    Q[:, joint] = 0.4
    Ts = robot.fk(Q)
    alike = robot.ik_batch(Ts, locked={joint: 0.4}, within_limits=False)
    values = np.full(200, 0.4)
    values[1::2] = -0.3
    mixed = robot.ik_batch(Ts, locked={joint: values}, within_limits=False)
    for i in range(0, 200, 2):
        k = alike.count[i]
        assert mixed.count[i] == k
        gap = np.abs(alike.q[i, :k] - mixed.q[i, :k])
        assert gap.max() < 1e-9
        assert (np.abs(np.angle(np.exp(1j * (alike.q[i, :k] - Q[i])))).max(axis=1) < 1e-6).any()
    found = alike.q[np.arange(alike.q.shape[1]) < alike.count[:, None]]
    by_pinocchio = np.array([robot.fk(q) for q in found])
    assert np.abs(by_pinocchio - np.repeat(Ts, alike.count, axis=0)).max() < 1e-12
