"""The notes' section 8: planar arms in closed form, the wrist centre, the ZYZ angles."""

import math

import numpy as np
import pytest
from dh_product import dh_frames
from hypothesis import given
from hypothesis import strategies as st
from ik_checks import away_but_free
from margins import assert_margin

import dh2urdf
from dh2urdf.exceptions import ConfigurationError, PoseError
from dh2urdf.ik.families.planar import planar_reach, planar_rr_ik, planar_rrr_ik, wrist_centre

LENGTHS = st.floats(0.05, 3.0)
ANGLES = st.floats(-math.pi, math.pi)


def tip(lengths, angles):
    """End of a planar arm, written out."""
    total, x, y = 0.0, 0.0, 0.0
    for length, angle in zip(lengths, angles, strict=True):
        total += angle
        x, y = x + length * math.cos(total), y + length * math.sin(total)
    return x, y, total


def same_angle(a, b):
    return abs(math.remainder(a - b, 2 * math.pi))


@given(LENGTHS, LENGTHS, ANGLES, ANGLES)
def test_both_elbows_reach_the_point(l1, l2, t1, t2):
    """Every row reaches the point to rounding; the elbows are t2 and -t2."""
    x, y, _ = tip((l1, l2), (t1, t2))
    rows = planar_rr_ik(l1, l2, x, y)
    assert len(rows) in (1, 2)
    away = [math.dist(tip((l1, l2), row)[:2], (x, y)) for row in rows]
    assert_margin(away, 4e-14 * (l1 + l2))
    if len(rows) == 2:
        assert rows[0, 1] < 0 < rows[1, 1]
        assert rows[0, 1] == -rows[1, 1]


@given(LENGTHS, LENGTHS, st.floats(-2.5, -0.05), ANGLES)
def test_generating_angles_are_among_the_rows(l1, l2, t2, t1):
    """The configuration that made the point is found again."""
    x, y, _ = tip((l1, l2), (t1, t2))
    row = planar_rr_ik(l1, l2, x, y)[0]
    assert_margin([same_angle(row[0], t1), same_angle(row[1], t2)], 1e-9)


def test_the_annulus_is_the_workspace():
    """Solutions exist exactly for (l1 - l2)^2 <= x^2 + y^2 <= (l1 + l2)^2."""
    inner, outer = planar_reach(1.0, 0.7)
    assert (inner, outer) == pytest.approx((0.3, 1.7))
    rng = np.random.default_rng(0)
    for x, y in rng.uniform(-2, 2, (500, 2)):
        expected = 2 if inner < math.hypot(x, y) < outer else 0
        assert len(planar_rr_ik(1.0, 0.7, x, y)) == expected


@pytest.mark.parametrize("angle", np.linspace(-3, 3, 7))
def test_on_either_rim_the_elbows_are_one(angle):
    """On the rim one row, stretched or folded; 1e-6 beyond it none."""
    for radius, elbow in ((1.7, 0.0), (0.3, math.pi)):
        rows = planar_rr_ik(1.0, 0.7, radius * math.cos(angle), radius * math.sin(angle))
        assert len(rows) == 1
        assert_margin(abs(abs(rows[0, 1]) - elbow), 1e-7)
        far = radius + 1e-6 if radius > 1 else radius - 1e-6
        assert len(planar_rr_ik(1.0, 0.7, far * math.cos(angle), far * math.sin(angle))) == 0


@pytest.mark.parametrize("power", range(1, 13))
def test_near_the_rim_no_digits_are_lost(power):
    """At 10^-k rad from stretched, t2 is known to 1e-16 over its distance, unlike by acos."""
    t2, elbows = 10.0**-power, []
    for t1 in np.linspace(-3.0, 3.0, 300):
        x, y, _ = tip((1.0, 0.7), (t1, t2))
        elbows.append(abs(planar_rr_ik(1.0, 0.7, x, y)[-1, 1]))
    if power > 6:  # the gap to the rim is rounding: both elbows are the straight arm
        assert not np.any(elbows)
        return
    # Two roundings of x^2 + y^2 over its slope in t2: nobody can know more, nor ten times as much.
    bound = 2 * np.finfo(float).eps * 1.7**2 / (1.0 * 0.7 * t2)
    assert_margin(np.abs(np.array(elbows) - t2), bound, 1)


def test_equal_links_folded_leave_theta_1_free():
    """At x = y = 0 with l1 = l2 one row is returned, theta_1 = 0, folded."""
    rows = planar_rr_ik(0.5, 0.5, 0.0, 0.0)
    assert rows.shape == (1, 2)
    assert rows[0, 0] == 0.0
    assert abs(rows[0, 1]) == math.pi


@given(LENGTHS, ANGLES, st.sampled_from([0.0, *(10.0**-k for k in range(2, 15))]))
def test_nearly_folded_equal_links_keep_both_elbows(length, t1, gap):
    """Folded up to a gap, both angles are known to a rounding of the point over its distance."""
    x, y, _ = tip((length, length), (t1, math.pi - gap))
    rows = planar_rr_ik(length, length, x, y)
    away = [same_angle(rows[-1, 0], t1), same_angle(rows[-1, 1], math.pi - gap)]
    if math.hypot(x, y) <= 2e-10 * length:  # theta_1 is free
        assert len(rows) == 1
        away[0] = 0.0
    bound = 1e-15 / max(gap, 2e-10) + 1e-14
    assert_margin(away, bound, 1)


@pytest.mark.parametrize("joints", [2, 3])
@given(LENGTHS, ANGLES, st.sampled_from([0.0, *(10.0**-k for k in range(2, 15))]), ANGLES)
def test_folded_planar_arms_lose_no_configuration(joints, length, t1, gap, t3):
    """A folded arm's configuration is found, or only free joints tell it from a solution.

    With two joints the direction of the tool fixes both angles, and none is free.
    """
    rows = [(0, 0, length, 0), (0, 0, length, 0), (0, 0, 0.3, 0)][:joints]
    table = dh2urdf.DHTable.from_array(rows, "standard", "theta d a alpha")
    robot, q = dh2urdf.Robot.from_dh(table), np.array([t1, math.pi - gap, t3][:joints])
    for task in ("pose", "position")[: 4 - joints]:
        found = robot.ik(robot.fk(q), task=task, within_limits=False)
        free = [sum(1 << i for i in joints) for joints in found.free_joints]
        fixed = joints == 2 and task == "pose"
        assert not (fixed and any(free))
        away = away_but_free(robot.chain, found.q, np.array(free), q)
        assert_margin(away, 1e-13 if fixed else 2e-15 / (length * max(gap, 1e-10)) + 1e-13, 1)


@given(LENGTHS, LENGTHS, LENGTHS, st.floats(-2.5, -0.05), ANGLES, ANGLES)
def test_rrr_reaches_point_and_direction(l1, l2, l3, t2, t1, t3):
    """Both rows of the RRR arm have the point and the direction phi; one is the original."""
    x, y, phi = tip((l1, l2, l3), (t1, t2, t3))
    rows = planar_rrr_ik(l1, l2, l3, x, y, phi)
    assert len(rows) == 2
    for row in rows:
        reached = tip((l1, l2, l3), row)
        assert_margin([math.dist(reached[:2], (x, y)), same_angle(reached[2], phi)], 1e-13)
    assert_margin([same_angle(a, b) for a, b in zip(rows[0], (t1, t2, t3), strict=True)], 1e-9)


def test_bad_numbers_are_refused():
    """Negative lengths and NaN are errors, not empty results."""
    with pytest.raises(ConfigurationError, match="l1: expected a number from 0 "):
        planar_rr_ik(-1.0, 1.0, 0.5, 0.5)
    with pytest.raises(PoseError, match=r"x: expected a number .* got nan"):
        planar_rr_ik(1.0, 1.0, math.nan, 0.5)


def test_wrist_centre_is_where_the_wrist_axes_meet():
    """o - d6 R e3 of the Denso's frame 6 is the origin of frames 4 and 5."""
    table = dh2urdf.load_table("denso_vs6556")
    away = []
    for q in np.random.default_rng(1).uniform(-2, 2, (200, 6)):
        frames = dh_frames(table, q)
        centre = wrist_centre(frames[6], table.rows[5].d)
        away += [centre - frames[4][:3, 3], centre - frames[5][:3, 3]]
    assert_margin(np.abs(away), 1e-15, 5)  # half a rounding of a coordinate under a metre is 1e-16


def test_decoupling_by_hand_gives_the_robots_solutions():
    """R_6^3 as ZYZ angles gives, up to the signs of the alphas, the wrists that ik returns."""
    robot = dh2urdf.Robot.from_dh("denso_vs6556")
    q = np.array([0.3, -1.2, 0.4, 0.5, 0.6, 0.7])
    frames = dh_frames(robot.table, q)
    R_3_6 = frames[3][:3, :3].T @ frames[6][:3, :3]
    by_hand = {
        tuple(np.round((phi, -theta, psi), 9) + 0.0)
        for phi, theta, psi in dh2urdf.transforms.matrix_to_zyz(R_3_6)
    }
    solutions = robot.ik(robot.fk(q), within_limits=False)
    same_arm = [s for s in solutions if np.abs(s[:3] - q[:3]).max() < 1e-9]
    assert {tuple(np.round(s[3:], 9) + 0.0) for s in same_arm} == by_hand


@pytest.mark.parametrize(("name", "task"), [("planar_rr", "position"), ("planar_rrr", "pose")])
def test_the_robot_uses_the_notes_formulas(name, task):
    """Robot.ik of the shipped planar arms equals the named functions, elbows named."""
    robot = dh2urdf.Robot.from_dh(name)
    lengths = [row.a for row in robot.table.rows]
    assert robot.solver_for(task=task).name == "planar arm"
    apart = []
    for q in np.random.default_rng(2).uniform(-2.5, 2.5, (200, robot.n)):
        T = robot.fk(q)
        x, y, phi = tip(lengths, q)
        found = robot.ik(T, task=task)
        if task == "pose":
            expected = planar_rrr_ik(*lengths, x, y, phi)
        else:
            expected = planar_rr_ik(*lengths, x, y)
        expected = expected[(np.abs(expected) <= math.pi).all(axis=1)]
        assert len(found) == len(expected) == 2
        apart.append(found.q - expected)
        assert found.branch == ("elbow up", "elbow down")
    assert_margin(np.abs(apart), 1e-12)


def test_rr_pose_exists_only_with_the_right_direction():
    """The RR arm reaches a full pose in one configuration; turned by 1e-6 in none."""
    robot = dh2urdf.Robot.from_dh("planar_rr")
    q = np.random.default_rng(3).uniform((-1.0, 0.8), (1.0, 1.8), (300, 2))
    found = robot.ik_batch(robot.fk(q))
    assert (found.count == 1).all()
    assert_margin(np.abs(found.q[:, 0] - q), 1e-14, 4)  # ten times less is four roundings of 1
    assert not robot.ik_batch(robot.fk(q) @ dh2urdf.transforms.rot_z(1e-6)).count.any()
