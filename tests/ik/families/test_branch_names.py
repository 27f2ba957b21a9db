"""Branches have names that people see."""

import numpy as np
import pinocchio as pin
import pytest

from dh2urdf import Robot

ARMS = {"puma560": 1.0, "denso_vs060": 1.0, "kinova_jaco2_spherical": 1.0}
ARMS |= {"abb_irb140": 0.8, "kuka_kr6_r700": 0.8, "kuka_kr16_2": 0.7, "ur5e": 0.8}
"""The share of poses at which the elbow that is up is higher; offsets leave some that lean back."""


@pytest.mark.parametrize("name", ARMS)
def test_the_elbow_that_is_up_is_the_higher_one(name):
    """Also of arms whose axis 1 points down."""
    robot, rng = Robot.from_dh(name), np.random.default_rng(0)
    data, higher = robot.model.createData(), []
    for q in rng.uniform(-3.0, 3.0, (60, robot.n)):
        solutions, heights = robot.ik(robot.fk(q), within_limits=False), {}
        for solution, branch in zip(solutions.q, solutions.branch, strict=True):
            pin.forwardKinematics(robot.model, data, robot.model_configuration(solution))
            shoulder, elbow, wrist = branch.split(", ")
            heights[shoulder, wrist, elbow] = data.oMi[3].translation[2]
        for (shoulder, wrist, elbow), z in heights.items():
            other = heights.get((shoulder, wrist, "elbow down"))
            if elbow == "elbow up" and other is not None:
                higher.append(z > other)
    assert len(higher) > 100
    assert np.mean(higher) >= ARMS[name]
