"""Positions, with and without the tool's axis, of arms whose joints follow others."""

from dataclasses import replace

import numpy as np
import pytest
from coupled_arms import H, driven_palletiser, palletiser

from dh2urdf import DHRow, DHTable, Mimic, Origin, Robot
from dh2urdf.exceptions import NoSolverError
from dh2urdf.transforms import rot_y

TURN = 2 * np.pi
TASKS = "position", "position+axis"


def leaning():
    """Joint 4 takes back what joint 3 turns, so that the tool leans as joint 2 does."""
    rows = (
        DHRow(d=0.3, a=0.1, alpha=-H),
        DHRow(theta=-H, a=0.5),
        DHRow(theta=H, a=0.4),
        DHRow(a=0.1, alpha=H, mimic=Mimic("joint_3", -1.0)),
    )
    return DHTable(rows, "standard", name="leaning")


def geared():
    """A second joint about the first axis turns half as far, so that the arm turns by 1.5 q1."""
    rows = (
        DHRow(d=0.3),
        DHRow(a=0.1, alpha=-H, mimic=Mimic("joint_1", 0.5)),
        DHRow(a=0.5),
        DHRow(a=0.4),
    )
    return DHTable(rows, "standard", name="geared")


ARMS = {
    "shipped": lambda: "abb_irb460",
    "palletiser": palletiser,
    "driven": driven_palletiser,
    "leaning": leaning,
    "geared": geared,
}


def apart(q, p):
    """Largest difference (k,) of angles of configurations, up to full turns."""
    return np.abs(np.remainder(q - p + np.pi, TURN) - np.pi).max(axis=-1)


@pytest.mark.parametrize("task", TASKS)
@pytest.mark.parametrize("arm", ["shipped", "palletiser", "driven"])
def test_all_solutions_of_a_palletiser_are_found(arm, task):
    """The joint about the tool is free; of the other three, four solutions and no others."""
    robot, rng = Robot.from_dh(ARMS[arm]()), np.random.default_rng(0)
    for _ in range(20):
        q = rng.uniform(-1, 1, 4) * [3, 0.5, 1, 3]
        T = robot.fk(q)
        found = robot.ik(T, task=task, within_limits=False)
        assert (apart(found.q[:, :3], q[:3]) < 1e-7).any()
        assert found.free_joints == ((3,),) * len(found)
        searched = robot.ik_numeric(T, task=task, within_limits=False, solutions=40, starts=60)
        for p in searched.q:
            assert (apart(found.q[:, :3], p[:3]) < 1e-6).any()
        for a, b in zip(*np.triu_indices(len(found), 1), strict=True):
            assert apart(found.q[a, :3], found.q[b, :3]) > 1e-6


@pytest.mark.parametrize(("arm", "most", "turn"), [("leaning", 4, TURN), ("geared", 12, 2 * TURN)])
def test_three_values_put_the_tool_at_a_point(arm, most, turn):
    """A geared joint comes back after two turns, in which it passes each direction three times."""
    robot, rng, counts = Robot.from_dh(ARMS[arm]()), np.random.default_rng(1), []
    for _ in range(10):
        q = rng.uniform(-3, 3, 3)
        found = robot.ik(robot.fk(q), task="position", within_limits=False)
        gap = found.q - q
        gap[:, 0] -= turn * np.rint(gap[:, 0] / turn)
        gap[:, 1:] -= TURN * np.rint(gap[:, 1:] / TURN)
        assert (np.abs(gap).max(axis=1) < 1e-7).any()
        assert (found.residual < 1e-9).all()
        counts.append(len(found))
    assert max(counts) == most


def test_a_seed_tells_how_the_tool_is_turned():
    robot, q = Robot.from_dh("abb_irb460"), np.array([0.3, 0.4, 0.5, 1.2])
    for task in TASKS:
        assert np.abs(robot.ik(robot.fk(q), seed=q, task=task).q[0] - q).max() < 1e-9


def test_a_tool_beside_the_last_axis_leaves_a_curve_of_solutions():
    """Joint 4 moves the tool, too, so that all four values move along; a seed finds its own."""
    robot = Robot.from_dh(replace(palletiser(), tool=Origin(xyz=(0.1, 0.0, 0.0))))
    q = np.array([0.3, 0.5, 0.2, 0.4])
    found = robot.ik(robot.fk(q), task="position", seed=q)
    assert np.abs(found.q[0] - q).max() < 1e-9
    assert found.free_joints[0] == (0, 1, 2, 3)


def test_the_direction_of_a_level_tool_cannot_be_tilted():
    robot = Robot.from_dh("abb_irb460")
    T = robot.fk([0.3, 0.4, 0.5, 0.6])
    tilted = T @ rot_y(0.2)
    assert len(robot.ik(T, task="position+axis"))
    assert not len(robot.ik(tilted, task="position+axis"))
    assert len(robot.ik(tilted, task="position"))
    assert "11.5 deg away" in robot.why_unreachable(tilted, task="position+axis")


def test_the_limits_of_a_position_are_kept():
    robot, rng = Robot.from_dh("abb_irb460"), np.random.default_rng(2)
    Ts = robot.fk(robot.lower + rng.random((200, 4)) * (robot.upper - robot.lower))
    for task in TASKS:
        batch = robot.ik_batch(Ts, task=task)
        assert batch.count.min() >= 1
        for i in range(0, 200, 20):
            inside = batch[i].q
            assert (inside >= robot.lower - 1e-12).all()
            assert (inside <= robot.upper + 1e-12).all()
            assert len(inside) == len(robot.ik(Ts[i], task=task))


def test_the_direction_of_a_painter_leaves_its_last_joint_free():
    robot, q = Robot.from_dh("abb_irb5400"), np.array([0.2, 0.3, -0.4, 0.5, 1.1, -0.6])
    T = robot.fk(q)
    found = robot.ik(T, task="position+axis", seed=q)
    assert np.abs(found.q[0] - q).max() < 1e-9
    assert found.free_joints == ((5,),) * len(found)
    every = robot.ik(T, task="position+axis", within_limits=False)
    assert len(every) == len(robot.ik(T, within_limits=False))


def test_a_point_is_reached_by_three_joints_of_a_painter_where_the_others_are_held():
    robot, q = Robot.from_dh("abb_irb5400"), np.array([0.2, 0.3, -0.4, 0.5, 1.1, -0.6])
    with pytest.raises(NoSolverError, match="3 joints to spare; hold some"):
        robot.ik(robot.fk(q), task="position")
    held = {"joint4": q[3], "joint5": q[4], "joint6": q[5]}
    found = robot.ik(robot.fk(q), task="position", locked=held, seed=q)
    assert np.abs(found.q[0] - q).max() < 1e-9
