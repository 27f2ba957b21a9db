"""What is said of the solutions of arms whose joints follow their controller's values."""

import numpy as np
import pytest
from coupled_arms import painter, palletiser

from dh2urdf import Robot


@pytest.mark.parametrize("arm", [painter, palletiser])
def test_explained_solutions_of_followers_are_those_of_ik(arm):
    """Each is written with the controller's values, fewer than the joints they move."""
    robot = Robot.from_dh(arm())
    q = np.linspace(0.3, 0.8, robot.n)
    found = robot.ik(robot.fk(q))
    assert np.abs(found.q - q).max(axis=1).min() < 1e-9
    told = str(robot.explain_ik(found, 0))
    for row in found.q:
        assert "(" + ", ".join(f"{value:.6g}" for value in row) + ")" in told


def test_arms_without_couplings_have_no_such_step():
    """Their joints are what the controller shows."""
    robot = Robot.from_dh("ur5")
    told = robot.explain_ik(robot.fk([0.3, -0.4, 0.9, 0.5, 0.6, -0.7]))
    assert all("controller" not in step.title for step in told.steps)
