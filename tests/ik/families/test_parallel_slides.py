"""Six joints of which some slide, at poses where axes are parallel and equations vanish."""

from math import pi

import numpy as np
import pytest
from dh_arm import arm_of
from structured import bent_tables, structured_configurations
from sweep import MOST, Tally, contains, judge

import dh2urdf
from dh2urdf.conversions.write.table_chain import dh_to_chain
from dh2urdf.dh import DHRow, DHTable
from dh2urdf.exceptions import NoSolverError
from dh2urdf.ik.arm import Outputs, Task, select_solver, spare_joints
from dh2urdf.ik.problem.shortfall import shortfall

H = pi / 2

SHOULDER = (
    "RRRPPR",
    [
        (H, 0.2, 0, 1.65),
        (0, 0, -0.1, 0),
        (0, 0.25, 0.35, H),
        (0, 0.1, 0.3, -H),
        (0, 0, 0, H),
        (-H, 0.5, 0.3, -H),
    ],
)
SPREAD = (
    "RPRRPR",
    [
        (0, 0.2, 0, 0),
        (0, 0.3, 0.25, H),
        (0, 0.25, 0, 0),
        (0, 0, 0, -H),
        (0, 0.1, 0.3, 0),
        (0, 0.25, -0.4, 0),
    ],
)
CROSS = (
    "RPPRRR",
    [
        (0, 0, 0, -2.2),
        (0, 0.3, 0.3, H),
        (pi, 0, 0, H),
        (-H, 0.2, 0, pi / 4),
        (0, -0.36, 0, H),
        (-H, 0, 0.35, 0),
    ],
)
OUTER = (
    "PRRRPR",
    [
        (-H, 0.1, 0, H),
        (0, 0.25, -0.08, H),
        (-H, 0, 0.25, -H),
        (pi, -0.35, 0.25, 0),
        (0, 0.1, 0, -H),
        (1.5, 0.15, 0, pi),
    ],
)

CASES = {
    "axes 1 and 6 parallel": (SHOULDER, (0, H, pi, 0.57, 0.01, 0)),
    "axes 1 and 2 as far from each other as axes 6 and 1": (OUTER, (0.52, pi, -H, 0, 0.95, -H)),
    "all at zero": (SPREAD, (0, 0.5, 0, 0, 0.5, 0)),
    "a root of four solutions": (CROSS, (H, 0.5, 0.5, H, pi, 0)),
}


def table_of(kinds, rows):
    """The table of rows (theta, d, a, alpha), modified."""
    kind = {"P": "prismatic", "R": "revolute"}
    return DHTable(
        tuple(DHRow(*row, kind[k]) for row, k in zip(rows, kinds, strict=True)), "modified"
    )


def anywhere(robot, Ts):
    return robot.ik_batch(Ts, within_limits=False)


@pytest.mark.parametrize("noise", [0.0, 1e-11, 1e-9, 1e-7, 1e-5])
@pytest.mark.parametrize("name", CASES)
def test_a_singular_pose_of_two_slides_has_its_configuration_among_the_answers(name, noise):
    """Or a family with it, with rounding or without."""
    (kinds, rows), q = CASES[name]
    table = table_of(kinds, rows)
    arm, robot = arm_of(table), dh2urdf.Robot.from_dh(table)
    beside = noise * np.random.default_rng(0).standard_normal(6) * ~arm.prismatic
    q = q + beside
    T = robot.fk(q)
    found = anywhere(robot, T[None])
    k = found.count[0]
    assert contains(arm, found.q[0, :k], found.free_mask[0, :k], q, T, MOST)


@pytest.mark.parametrize("name", CASES)
def test_elimination_says_that_it_is_in_doubt_at_a_singular_pose_of_two_slides(name):
    """So the search is asked, and files of elimination alone say that they are not complete."""
    (kinds, rows), q = CASES[name]
    robot = dh2urdf.Robot.from_dh(table_of(kinds, rows))
    out = Outputs.of(1, 16, 6)
    doubtful = select_solver(robot.chain).solve_sure(robot.fk(q)[None], False, out)
    assert doubtful.tolist() == [0]


def test_a_pose_that_a_configuration_reaches_is_not_called_unreachable():
    """Where a miss is below what is certified, no reason says how far away the pose is."""
    robot = dh2urdf.Robot.from_dh(table_of(*SPREAD))
    T = robot.fk([0.3, 0.2, 0.4, -0.7, 0.1, 1.1])
    assert shortfall(robot.chain, T, Task.POSE).startswith("the pose is not out of reach")


def test_random_poses_of_two_slides_are_not_in_doubt():
    """Searches take milliseconds, elimination microseconds."""
    rng = np.random.default_rng(0)
    for kinds, rows in (SHOULDER, SPREAD, CROSS, OUTER):
        robot, out = dh2urdf.Robot.from_dh(table_of(kinds, rows)), Outputs.of(200, 16, 6)
        Ts = np.stack([robot.fk(q) for q in rng.uniform(-1.0, 1.0, (200, 6))])
        assert len(select_solver(robot.chain).solve_sure(Ts, False, out)) == 0


def test_structured_poses_of_one_to_three_slides_with_twists_of_any_size_have_answers():
    """Tables of which one twist is no right angle."""
    tally = Tally("bent, sliding")
    for k, table in enumerate(bent_tables(24)):
        try:
            freely = not spare_joints(dh_to_chain(table), Task.POSE)
            freely = freely and bool(dh2urdf.Robot.from_dh(table).solver)
        except NoSolverError:
            continue
        if freely:
            judge(tally, table, structured_configurations(arm_of(table), 3, k), anywhere)
    faults = ("regular lost", "wrong", "twice", "no answer")
    assert tally.count["poses"] > 20
    assert [note for note in tally.notes if note.startswith(faults)] == []
