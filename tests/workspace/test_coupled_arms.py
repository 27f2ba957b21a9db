"""Reach of arms of which values move joints together: limits and measures are of the values."""

from dataclasses import replace

import numpy as np
import pytest
from coupled_arms import painter, palletiser

from dh2urdf import DHRow, DHTable, Mimic, Robot
from dh2urdf.exceptions import ArgumentError
from dh2urdf.ik.arm import Task
from dh2urdf.workspace import (
    dexterity,
    extreme_reach,
    orientations,
    place,
    reach_ball,
    reach_section,
    reach_volume,
    section,
    task_of,
)
from dh2urdf.workspace.measures import _measures, measure_best
from dh2urdf.workspace.planar import planar_arm
from dh2urdf.workspace.reach import reach_map
from dh2urdf.workspace.section import turns_in_plane
from dh2urdf.workspace.task import rolls_about

SHIPPED = "abb_irb460", "abb_irb5400", "fanuc_r1000ia80f"
ROWS = tuple(DHRow(a=0.3, alpha=1.0, d=0.1, lower=-1.0, upper=1.0) for _ in range(6))


def coupled(**limits):
    """Joint 3 adds what joint 2 turns."""
    rows = list(ROWS)
    rows[2] = DHRow(a=0.3, alpha=1.0, d=0.1, lower=-1.0, upper=1.0, **limits)
    return Robot.from_dh(DHTable(tuple(rows), "standard", couplings={"joint_3": {"joint_2": 1.0}}))


def anywhere(robot, count):
    """Values inside all limits, of the joints, too."""
    q = robot.lower + np.random.default_rng(0).random((count, robot.n)) * (
        robot.upper - robot.lower
    )
    joints = robot.chain_configuration(q)
    return q[((joints >= robot.chain.lower) & (joints <= robot.chain.upper)).all(axis=1)]


@pytest.mark.parametrize("name", SHIPPED)
def test_the_tip_is_never_beyond_its_extremes_and_comes_near_them(name):
    robot = Robot.from_dh(name)
    found = extreme_reach(robot)
    away = np.linalg.norm(robot.fk(anywhere(robot, 40_000))[:, :3, 3] - found.centre, axis=1)
    low, high = found.distance
    assert low - 1e-9 <= away.min()
    assert high - 0.05 < away.max() <= high + 1e-9
    for k, q in enumerate(found.q["distance"]):
        at = found.places["distance"][k]
        assert np.abs(robot.fk(q)[:3, 3] - at).max() < 1e-9
        assert abs(np.linalg.norm(at - found.centre) - (low, high)[k]) < 1e-9
        assert (q >= robot.lower - 1e-9).all()
        assert (q <= robot.upper + 1e-9).all()


def test_a_pendant_counts_nothing_that_the_arm_reaches():
    """Its limits leave joint 3 in its own, so that reach is that of the joints."""
    robot = Robot.from_dh("fanuc_r1000ia80f")
    rows = list(robot.table.rows)
    for k, (low, high) in enumerate(zip(robot.chain.lower, robot.chain.upper, strict=True)):
        ends = {"lower": low, "upper": high, "serial_lower": None, "serial_upper": None}
        rows[k] = replace(rows[k], **ends)
    plain = Robot.from_dh(DHTable(tuple(rows), "standard", robot.table.name))
    assert np.allclose(
        extreme_reach(robot, "wrist").distance, extreme_reach(plain, "wrist").distance
    )
    assert reach_volume(robot).value == pytest.approx(reach_volume(plain).value)
    q = extreme_reach(robot, "wrist").q["height"]
    joints = extreme_reach(plain, "wrist").q["height"]
    assert np.allclose(q[:, 2], joints[:, 2] - joints[:, 1])


def test_limits_of_values_and_of_a_joint_that_two_move_are_refused_by_name():
    """They are no box, so that exact reach would be that of another arm."""
    with pytest.raises(ArgumentError, match=r"joint_3 moves by several values.*without --exact"):
        extreme_reach(coupled(serial_lower=-0.5))
    assert extreme_reach(coupled()).distance[1] > 0.5


def test_sections_of_arms_with_followers_are_refused_by_name():
    for name in ("abb_irb460", "abb_irb5400"):
        with pytest.raises(ArgumentError, match="has joints that follow others"):
            reach_section(Robot.from_dh(name))


@pytest.mark.parametrize("name", ["abb_irb460", "fanuc_r1000ia80f"])
def test_what_a_map_says_of_a_voxel_is_what_ik_finds_there(name):
    robot = Robot.from_dh(name)
    found = reach_map(robot, step=0.8, orientations=5, each=True)
    task, turns = task_of(robot).name, found["rotation"].values[:, 0]
    reached = np.argwhere(found.share.values > 0)
    assert len(reached)
    for x, y, z in reached[:: max(len(reached) // 6, 1)]:
        ways = []
        for R in turns:
            T = np.eye(4)
            T[:3, :3] = R
            T[:3, 3] = found.x[x], found.y[y], found.z[z]
            ways.append(len(robot.ik(T, task=task)))
        assert found.solutions_each.values[x, y, z].tolist() == ways


def test_measures_are_those_of_the_jacobian_by_the_values():
    robot = Robot.from_dh(painter())
    q = np.random.default_rng(0).uniform(-1, 1, (5, 2, 6))
    best = np.empty((3, 5))
    measure_best(robot, "pose", q, np.array([2, 1, 0, 2, 2]), best)
    step, flat = 1e-6, q.reshape(-1, 6)
    J = np.empty((10, 6, 6))
    for i, e in enumerate(np.eye(6)):
        before, after = robot.fk(flat - step * e), robot.fk(flat + step * e)
        J[:, :3, i] = (after - before)[:, :3, 3] / (2 * step)
        turn = (after - before)[:, :3, :3] @ robot.fk(flat)[:, :3, :3].swapaxes(1, 2) / (2 * step)
        J[:, 3:, i] = np.stack([turn[:, 2, 1], turn[:, 0, 2], turn[:, 1, 0]], axis=1)
    sigma = np.linalg.svd(J, compute_uv=False)
    least, whole = sigma[:, -1].reshape(5, 2), sigma.prod(axis=1).reshape(5, 2)
    for row, each in ((best[1], least), (best[0], whole)):
        expected = [each[0].max(), each[1, 0], -np.inf, *each[3:].max(axis=1)]
        assert np.allclose(row, expected, rtol=1e-6)
    assert (best[:, 2] == -np.inf).all()


@pytest.mark.parametrize("task", ["pose", "position", "position+axis"])
def test_joints_that_move_by_themselves_are_measured_as_the_kernel_does(task):
    robot = Robot.from_dh("puma560")
    q = np.random.default_rng(0).uniform(-1, 1, (4, 1, 6))
    best = np.empty((3, 4))
    measure_best(robot, task, q, np.ones(4, int), best, 0.5)
    assert np.allclose(best, _measures(robot, Task(task), q[:, 0], 0.5))


def test_the_margin_is_of_the_joint_that_two_values_move_too():
    robot = coupled(serial_lower=-0.5, serial_upper=0.7)
    q, best = np.array([[[0.0, 0.3, 0.35, 0.0, 0.0, 0.0]]]), np.empty((3, 1))
    measure_best(robot, "pose", q, np.ones(1, int), best)
    assert best[2, 0] == pytest.approx(0.05)


@pytest.mark.parametrize("name", SHIPPED)
def test_a_base_is_found_for_an_arm_whose_joints_move_together(name):
    robot = Robot.from_dh(name)
    T = robot.fk((robot.lower + robot.upper) / 2 + 0.2)
    found = place(robot, T[None])
    assert found.margin > 0.0
    assert len(robot.ik(np.linalg.inv(found.T_world_base) @ T, task=task_of(robot).name))


def test_a_last_joint_that_follows_does_not_turn_the_tip_all_around():
    """It turns with the joint that it follows, so that each orientation has to be tried."""
    rows = (*(DHRow(a=0.3, alpha=1.0, d=0.1) for _ in range(6)), DHRow(mimic=Mimic("joint_2", 1.0)))
    following = Robot.from_dh(DHTable(rows, "standard"))
    assert rolls_about(following, False) is None
    assert len(orientations(following, task_of(following), 50, within_limits=False)) == 50
    assert rolls_about(Robot.from_dh("abb_irb5400"), True) is not None


def test_an_arm_whose_first_value_moves_another_joint_is_not_the_same_all_around():
    rows = (DHRow(d=0.3, alpha=1.5707963267948966), DHRow(a=0.5), DHRow(a=0.4))
    couplings = {"joint_3": {"joint_1": 1.0}}
    for given, alike in (({}, True), (couplings, False)):
        robot = Robot.from_dh(DHTable(rows, "standard", couplings=given))
        assert turns_in_plane(robot, section(robot, "xz"), False) is alike


def test_a_slide_that_follows_is_as_far_as_its_leader_takes_it():
    """Its own row has no limits; the leader's put it 0.6 m out."""
    rows = (
        DHRow(d=0.3, alpha=1.0),
        DHRow(joint_type="prismatic", a=0.2, lower=0.0, upper=0.3),
        DHRow(joint_type="prismatic", mimic=Mimic("joint_2", 2.0)),
    )
    robot = Robot.from_dh(DHTable(rows, "standard"))
    centre, radius = reach_ball(robot)
    tips = robot.fk(np.column_stack([np.linspace(-3, 3, 50), np.full(50, 0.3)]))[:, :3, 3]
    assert (np.linalg.norm(tips - centre, axis=1) <= radius).all()


def test_poses_beyond_the_lengths_are_left_aside_and_told_of():
    """Shares are as of all poses solved; progress comes more often than at the end."""
    robot, told = Robot.from_dh("abb_irb5400"), []
    grid = section(robot, "xz", count=5)
    share = dexterity(robot, grid, 30, progress=lambda done, total: told.append(done / total))
    assert told == sorted(told)
    assert told[-1] == 1.0
    turns = orientations(robot, task_of(robot), 30)
    T = np.tile(np.eye(4), (len(turns), 1, 1))
    T[:, :3, :3] = turns
    for i, j in ((2, 3), (3, 3), (2, 4), (0, 0)):
        T[:, :3, 3] = grid.points[i, j]
        assert share[i, j] == pytest.approx((robot.ik_batch(T).count > 0).mean())


def test_a_coupled_arm_in_a_plane_is_not_drawn_as_two_free_joints():
    """Its elbow's limits are not those of its second value."""
    rows = (DHRow(a=1.0), DHRow(a=0.5))
    coupled = DHTable(rows, "standard", couplings={"joint_2": {"joint_1": 1.0}})
    assert planar_arm(Robot.from_dh(DHTable(rows, "standard"))) is not None
    assert planar_arm(Robot.from_dh(coupled)) is None


def test_a_palletiser_without_limits_is_placed():
    robot = Robot.from_dh(palletiser())
    assert place(robot, robot.fk([0.3, 0.5, 0.2, 0.4])[None]).margin > 0.0
