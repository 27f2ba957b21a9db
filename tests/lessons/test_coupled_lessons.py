"""Worked solutions of arms whose controllers count other angles than their joints."""

import numpy as np
import pytest
from coupled_arms import painter, palletiser, pendant

from dh2urdf import Robot
from dh2urdf.conversions.assign import to_convention

RATIOS = [1.0, -1.0, 0.5, -2.0]


@pytest.mark.parametrize("convention", ["standard", "modified"])
@pytest.mark.parametrize("ratio", RATIOS)
def test_steps_lead_to_what_ik_gives(ratio, convention):
    """Each solution ends at its own values, through the joint itself."""
    robot = Robot.from_dh(to_convention(pendant(ratio), convention))
    found = robot.ik(robot.fk([0.3, 0.4, -0.2, 0.5, 0.6, -0.7]))
    assert len(found) >= 4
    for k in range(len(found)):
        told = robot.explain_ik(found, k)
        assert np.abs(told.q - found.q[k]).max() < 1e-9
        (step,) = [step for step in told.steps if step.title == "The values of the controller"]
        assert step.equations[0].name == "v_3"
        assert abs(step.equations[0].value - found.q[k, 2]) < 1e-9


def test_the_step_names_the_joint_and_its_sum():
    """v_3 = q_3 - v_2, as q3 + q2 stands in the table."""
    robot = Robot.from_dh(pendant())
    text = str(robot.explain_ik(robot.fk([0.3, 0.4, -0.2, 0.5, 0.6, -0.7])))
    assert "counts joint_3" in " ".join(text.split())
    assert "v_3 = q_3 - v_2" in text


def test_a_ratio_is_a_letter():
    """Half of the second value is taken off."""
    robot = Robot.from_dh(pendant(0.5))
    text = str(robot.explain_ik(robot.fk([0.3, 0.4, -0.2, 0.5, 0.6, -0.7])))
    assert "v_3 = q_3 - k_32 v_2" in text


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
