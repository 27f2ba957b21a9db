"""The worked solutions of the notes' own arms say what the notes say (sections 8.2 and 8.3)."""

import itertools
import math

import numpy as np
import pytest

import dh2urdf
from dh2urdf import transforms as tf

L1, L2 = 1.0, 0.7


def equations(told):
    """All equations of a worked solution by name; the last one of a name counts."""
    return {e.name: e for step in told.steps for e in step.equations}


@pytest.mark.parametrize("k", [0, 1])
def test_planar_rr_arm_is_solved_by_the_equations_of_section_8_2(k):
    """cos theta_2 from the square of the distance, theta_2 both signs, theta_1 by two atan2."""
    robot = dh2urdf.Robot.from_dh("planar_rr")
    x, y = 0.9, 0.8
    told = robot.explain_ik(tf.trans(x, y, 0.0), k, task="position")
    said = equations(told)
    c2 = (x * x + y * y - L1 * L1 - L2 * L2) / (2.0 * L1 * L2)
    theta2 = (-1.0, 1.0)[k] * math.acos(c2)
    gamma = math.atan2(L2 * math.sin(theta2), L1 + L2 * math.cos(theta2))
    assert said["c_2"].formula == "(x^2 + y^2 - l_1^2 - l_2^2) / (2 l_1 l_2)"
    assert said["c_2"].value == pytest.approx(c2, abs=1e-15)
    assert said["theta_2"].value == pytest.approx(theta2, abs=1e-15)
    assert said["theta_2"].others == pytest.approx((-theta2,), abs=1e-15)
    assert said["gamma"].formula == "atan2(l_2 s_2, l_1 + l_2 c_2)"
    assert said["gamma"].value == pytest.approx(gamma, abs=1e-15)
    assert said["theta_1"].formula == "atan2(y, x) - gamma"
    assert said["theta_1"].value == pytest.approx(math.atan2(y, x) - gamma, abs=1e-15)
    assert told.q == pytest.approx(robot.ik(tf.trans(x, y, 0.0), task="position").q[k], abs=1e-12)
    assert told.branch == ("elbow up", "elbow down")[k]


@pytest.mark.parametrize(("x", "gap"), [(1.8, "0.1 m too far"), (0.2, "0.1 m too near")])
def test_beyond_the_annulus_the_solution_ends_at_the_triangle(x, gap):
    """(l1 - l2)^2 <= x^2 + y^2 <= (l1 + l2)^2 is said in metres."""
    robot = dh2urdf.Robot.from_dh("planar_rr")
    told = robot.explain_ik(tf.trans(x, 0.0, 0.0), task="position")
    last = told.steps[-1]
    assert told.q is None
    assert "from their difference, 0.3 m, to their sum, 1.7 m" in last.words
    assert gap in last.words
    assert abs(last.value) > 1.0


def test_three_equations_in_two_unknowns_end_at_the_direction():
    """With phi in the task most poses have no solution: phi = theta_1 + theta_2 is compared."""
    robot = dh2urdf.Robot.from_dh("planar_rr")
    told = robot.explain_ik(tf.trans(0.9, 0.8, 0.0) @ tf.rot_z(0.1))
    assert told.q is None
    assert "three equations in two unknowns" in told.text
    assert "no joint is left to mend it" in told.steps[-1].words


def denso_pose():
    """A pose of the notes' arm, in millimetre steps and degrees."""
    return tf.origin_matrix([0.35, 0.12, 0.31], [0.3, math.pi - 0.4, 0.2])


@pytest.mark.parametrize("k", range(4))
def test_denso_arm_is_decoupled_as_in_section_8_3(k):
    """Equation (5) to R_6^3 = (R_3^0)^-1 R and the ZYZ angles, line by line."""
    robot = dh2urdf.Robot.from_dh("denso_vs6556")
    T = denso_pose()
    found = robot.ik(T, within_limits=False)
    told = robot.explain_ik(found, k)
    said, R = equations(told), T[:3, :3]
    centre = T[:3, 3] - 0.08 * R[:, 2]
    assert said["o_c"].formula == "o - d_6 R e_3"
    assert said["o_c"].value == pytest.approx(centre, abs=1e-16)
    assert said["o_c"].value == pytest.approx(dh2urdf.wrist_centre(T, 0.08), abs=1e-16)
    q = found.q[k]
    H = robot.frames(q)
    assert H[4][:3, 3] == pytest.approx(centre, abs=1e-12)
    assert H[5][:3, 3] == pytest.approx(centre, abs=1e-12)
    facing = math.atan2(centre[1], centre[0])
    turned = math.remainder(facing - q[0], math.pi)
    assert turned == pytest.approx(0.0, abs=1e-12)
    assert said["theta_1"].value == pytest.approx(q[0], abs=1e-12)
    other = math.remainder(q[0] + math.pi, 2.0 * math.pi)
    assert said["theta_1"].others == pytest.approx((other,), abs=1e-12)
    assert said["l_3"].value == pytest.approx(math.hypot(0.09, 0.295), abs=1e-15)
    assert said["R_3^0"].value == pytest.approx(H[3][:3, :3], abs=1e-12)
    assert said["R_6^3"].value == pytest.approx(H[3][:3, :3].T @ R, abs=1e-12)
    angles = [said[name].value for name in ("phi", "theta", "psi")]
    known = tf.matrix_to_zyz(said["R_6^3"].value)
    assert min(np.abs(np.array(each) - angles).max() for each in known) < 1e-12
    assert [said[f"theta_{i}"].value for i in (4, 6)] == pytest.approx(angles[::2], abs=1e-15)
    assert said["theta_5"].value == pytest.approx(-angles[1], abs=1e-15)
    assert told.q == pytest.approx(q, abs=1e-12)


def test_denso_arm_names_the_branches_that_ik_prints():
    """Each choice is called what ik calls it, on all ways together."""
    robot = dh2urdf.Robot.from_dh("denso_vs6556")
    found = robot.ik(denso_pose(), within_limits=False)
    for k, branch in enumerate(found.branch):
        told = robot.explain_ik(found, k)
        named = [step for step in told.steps if step.choice]
        assert [step.joint for step in named] == [0, 2, 4]
        for step, word in zip(named, branch.split(", "), strict=True):
            assert f"`ik` calls this choice: {word}." in step.words


def test_out_of_reach_the_denso_ends_at_the_triangle_in_metres():
    """The wrist centre's distance from the shoulder, and what the two links reach."""
    robot = dh2urdf.Robot.from_dh("denso_vs6556")
    told = robot.explain_ik(tf.trans(0.8, 0.0, 0.335))
    last = told.steps[-1]
    assert told.q is None
    assert "0.7294 m from the shoulder" in last.words
    assert "0.0384234 m, to their sum, 0.578423 m" in last.words
    assert "0.150977 m too far" in last.words
    assert last.words.endswith("The other choices on the way end without a solution, too.")


def test_singular_wrist_is_said_in_words():
    """sin theta_5 = 0: only the sum of theta_4 and theta_6 is known, one of them is chosen."""
    robot = dh2urdf.Robot.from_dh("denso_vs6556")
    q = [0.3, -0.9, 0.5, 0.4, 0.0, -0.2]
    told = robot.explain_ik(robot.fk(q), seed=q)
    assert "the wrist is singular" in told.text
    assert "the orientation fixes only phi + psi" in told.text
    assert told.q == pytest.approx(q, abs=1e-12)


def test_wrist_centre_on_axis_1_leaves_joint_1_free():
    """x_c = y_c = 0: every theta_1 will do, the one of the solution is taken."""
    robot = dh2urdf.Robot.from_dh("denso_vs060")
    q = _under_axis_1(robot)
    told = robot.explain_ik(robot.fk(q), seed=q)
    assert "joint 1 moves it nowhere and is free" in told.text
    assert told.q == pytest.approx(q, abs=1e-12)


def _under_axis_1(robot):
    """A configuration with the wrist centre on axis 1."""

    def off(q3):
        return robot.frames([0.0, 0.5, q3, 0.2, 0.5, 0.1])[4][0, 3]

    grid = np.linspace(-3.0, 3.0, 61)
    low = next(a for a, b in itertools.pairwise(grid) if off(a) * off(b) < 0.0)
    high, side = low + 0.1, off(low)
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if off(middle) * side > 0.0 else (low, middle)
    return np.array([0.4, 0.5, low, 0.2, 0.5, 0.1])
