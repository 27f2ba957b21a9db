"""Arms whose values move joints together, with a joint to spare, or with followers beside."""

from dataclasses import replace

import numpy as np
import pytest
from coupled_arms import H

from dh2urdf import DHRow, DHTable, Mimic, Robot, load_table
from dh2urdf.exceptions import ConfigurationError, NoSolverError
from dh2urdf.workspace import held_values

TURN = 2 * np.pi


def seven(name, other, **changes):
    """A seven-joint arm of which one joint adds half of what another turns."""
    table = load_table("kuka_iiwa14")
    rows = tuple(replace(row, **changes) for row in table.rows)
    couplings = {f"joint_a{name}": {f"joint_a{other}": 0.5}}
    return Robot.from_dh(DHTable(rows, table.convention, "seven", couplings=couplings))


FREE = {"lower": None, "upper": None}


@pytest.mark.parametrize(("name", "other"), [(6, 5), (3, 2)])
def test_a_path_of_seven_coupled_joints_without_limits_is_continuous(name, other):
    """In the values, and through every pose, the swept joint among those that move together too."""
    robot = seven(name, other, **FREE)
    q = np.linspace(np.full(7, 0.2), np.full(7, 0.7), 12)
    Ts = robot.fk(q)
    for start in (None, q[0]):
        path = robot.ik_path(Ts, start=start)
        assert path.continuous
        assert np.abs(robot.fk(path.q) - Ts).max() < 1e-9
        assert path.joint_names == robot.joint_names
    assert np.abs(np.diff(path.q, axis=0)).max() < 0.5
    assert np.abs(path.q[0] - q[0]).max() < 1e-3


def test_a_path_that_limits_of_values_may_cut_is_refused_with_what_to_do():
    robot = seven(6, 5)
    Ts = robot.fk(np.full((3, 7), 0.3))
    with pytest.raises(ConfigurationError, match=r"hold a joint \(locked\), or give within_limits"):
        robot.ik_path(Ts)
    assert robot.ik_path(Ts, within_limits=False).continuous
    assert robot.ik_path(Ts, locked={"joint_a3": 0.3}).continuous


def test_intervals_of_a_joint_that_moves_alone_are_those_of_the_uncoupled_arm():
    robot, table = seven(6, 5, **FREE), load_table("kuka_iiwa14")
    rows = tuple(replace(row, **FREE) for row in table.rows)
    plain = Robot.from_dh(DHTable(rows, table.convention, "plain"))
    T = robot.fk(np.full(7, 0.4))
    for within_limits in (True, False):
        ends = [each.ik_intervals(T, within_limits=within_limits) for each in (robot, plain)]
        assert np.allclose(*ends)


def test_intervals_of_a_joint_that_moves_with_others_are_refused_by_name():
    robot = seven(3, 2, **FREE)
    T = robot.fk(np.full(7, 0.4))
    with pytest.raises(ConfigurationError, match="is one of those that move together"):
        robot.ik_intervals(T)


def test_a_map_holds_the_value_of_the_swept_joint_where_one_has_it():
    assert list(held_values(seven(6, 5))) == [2]
    assert held_values(seven(3, 2)) is None


def hollow(ratio, *, span=7.0):
    """A hollow wrist whose follower turns by a ratio, behind a pendant's J3 and a coupled wrist."""
    ends = {"lower": -span, "upper": span} if np.isfinite(span) else {}
    rows = (
        DHRow(d=0.45, a=0.32, alpha=-H, **ends),
        DHRow(theta=-H, a=0.87, **ends),
        DHRow(a=0.225, alpha=-H, **ends),
        DHRow(d=1.015, alpha=0.6, **ends),
        DHRow(d=0.08, alpha=-1.2, **ends),
        DHRow(d=0.08, alpha=0.6, mimic=Mimic("joint_5", ratio)),
        DHRow(d=0.175, **ends),
    )
    couplings = {"joint_3": {"joint_2": 1.0}, "joint_5": {"joint_4": 0.5}}
    return Robot.from_dh(DHTable(rows, "standard", couplings=couplings))


@pytest.mark.parametrize("ratio", [-1.0, 0.5, 2.0, -2 / 3])
def test_values_and_followers_of_any_ratio_are_found_together(ratio):
    """The generating values in their own turn, and what a search finds that knows no turns."""
    robot, rng = hollow(ratio), np.random.default_rng(3)
    for _ in range(5):
        q = robot.random_configuration(rng)
        T = robot.fk(q)
        every = robot.ik(T, turns="all")
        assert (every.residual < 1e-9).all()
        assert np.abs(robot.fk(every.q) - T).max() < 1e-9
        assert (np.abs(every.q) <= 7.0 + 1e-9).all()
        assert np.abs(every.q - q).max(axis=1).min() < 1e-6
        assert np.abs(robot.ik(T, seed=q).q[0] - q).max() < 1e-6
        for p in robot.ik_numeric(T, solutions=6, starts=24).q:
            assert np.abs(every.q - p).max(axis=1).min() < 1e-5


def test_solutions_beside_followers_say_what_moves_what():
    said = hollow(0.5).solver.explain()
    assert "joint_5 turns axes 5 and 6, by 1 and 0.5" in said
    assert "joint_5 is at q5 + 0.5 q4" in said


@pytest.mark.parametrize(
    ("span", "words"), [(np.inf, "infinitely many"), (3.0, "in each turn wit")]
)
def test_a_ratio_that_never_comes_back_says_how_many_solutions_there_are(span, words):
    robot = hollow(1 / np.sqrt(2), span=span)
    T = robot.fk(np.zeros(6))
    with pytest.raises(NoSolverError, match=words):
        robot.ik(T)
