"""Poses that people type, by class of arm: nothing is lost, nothing is wrong.

Each class prints a line of figures; ``SWEEP=10`` in the environment takes ten times as many poses,
and what is lost or wrong is added to the file that ``SWEEP_NOTES`` names: so two commits compare.
``SWEEP_POSES=regular`` leaves out singular ones, which take most of the time.
"""

import math
import os
import re
from collections import Counter
from types import SimpleNamespace

import numpy as np
import pytest
from dh_arm import arm_of
from follower_arms import AWAY, MULTIPLIERS, follower_chain
from ik_referee import forward, gaps, solve
from structured import (
    ROUNDINGS,
    random_tables,
    rounded,
    shipped_tables,
    sliding_tables,
    structured_configurations,
    variant_tables,
)
from sweep import MOST, Tally, contains, judge, judge_arm, smallest

import dh2urdf
from dh2urdf.conversions.write.table_chain import dh_to_chain
from dh2urdf.exceptions import NoSolverError
from dh2urdf.ik.arm import Task, select_solver, spare_joints

SIZE = float(os.environ.get("SWEEP", "1"))
"""Poses of a class, as a multiple of what follows."""

NOTES = os.environ.get("SWEEP_NOTES")

POSES, TABLES, MANY = int(120 * SIZE), int(60 * SIZE), int(2000 * SIZE)
"""Poses a table that ships, and tables of other classes, each with a third as many poses; tables of
which only a few poses are tried."""

LISTED = {
    "shipped, 4 digits": {"unnamed: mycobot_280": 2},
    "shipped, 9 digits": {"unnamed: ur10": 1},
    "random of 6, exact": {"unnamed: random 0/50": 2},
    "random of 6, 9 digits": {"unnamed: random 0/50": 2, "no family: random 0/57": 1},
    "sliding of 6, exact": {"unnamed: sliding 0/173": 1},
    "seven held, 9 digits": {"unnamed: kuka_iiwa14": 1},
    "many of 6, exact": {"unnamed: random 1/817": 1},
    "many of 6, 9 digits": {"singular lost: random 1/1088": 1},
    "followers, 0 turns between, 0.5 times": {"singular lost: follower_chain(1001)": 1},
}
"""What is known, by class and arm, of how many poses: families without a name, all found, where
three directions are flat or a loop is 1e-3 short; one that the referee does not walk; and the two
configurations that are lost, on curves that few starts find."""

SEVEN = [table for table in shipped_tables() if len(table.rows) == 7]


def anywhere(robot, Ts):
    return robot.ik_batch(Ts, within_limits=False)


def refused(table):
    """Whether no solver covers an arm: three joints or more can move while the tool stays."""
    try:
        return not dh2urdf.Robot.from_dh(table).solver
    except NoSolverError:
        return True


def moves_freely(table):
    """Whether an arm has no joint to spare."""
    return not spare_joints(dh_to_chain(table), Task.POSE)


def sweep(name, tables, poses, decimals=None, seed=0):
    """The tally of a class of tables."""
    tally = Tally(f"{name}, {'exact' if decimals is None else f'{decimals} digits'}")
    for k, table in enumerate(rounded(table, decimals) for table in tables):
        if refused(table):
            tally.count["refused"] += 1
            continue
        judge(tally, table, structured_configurations(arm_of(table), poses, seed + k), anywhere)
    return tally


def report(tally):
    """Print the figures, and fail with what may not be and is not listed."""
    print("\n" + tally.line())
    if NOTES:
        with open(NOTES, "a") as file:
            file.writelines(f"{tally.name}; {note}\n" for note in tally.notes)
    ends = " (?:standard: |modified: |at q = )"
    arms = Counter(re.split(ends, note)[0] for note in tally.failures())
    assert not arms - Counter(LISTED.get(tally.name, {})), "\n".join(tally.failures())


CLASSES = {
    "shipped": lambda: [table for table in shipped_tables() if len(table.rows) != 7],
    "variants": lambda: [t for t in variant_tables(5 * TABLES // 3) if len(t.rows) != 7],
    "random of 6": lambda: random_tables(TABLES),
    "random of 5": lambda: random_tables(TABLES // 4, joints=5),
    "random of 4": lambda: random_tables(TABLES // 4, joints=4),
}


def test_the_referee_misses_what_is_taken_away():
    """Without the solution that is nearest, and without its family, a configuration is lost."""
    table = dh2urdf.load_table("puma560")
    q = structured_configurations(arm_of(table), 60, 0)

    def without_nearest(robot, Ts):
        batch = anywhere(robot, Ts)
        for i, k in enumerate(batch.count):
            away = gaps(arm_of(table), batch.q[i, :k], q[i])
            away[batch.free_mask[i, :k] > 0] = 0.0
            keep = away > 0.2
            batch.count[i] = keep.sum()
            batch.q[i, : keep.sum()] = batch.q[i, :k][keep]
            batch.free_mask[i, : keep.sum()] = 0
        return batch

    tally = Tally("taken away")
    judge(tally, table, q, without_nearest)
    assert tally.count["regular lost"] == tally.count["regular"]
    assert tally.count["singular lost"] == tally.count["singular"]


def test_members_are_the_same_to_rounding_where_the_tool_hardly_moves_and_nowhere_else():
    """Axes 1 and 2, and 5 and 6, in line but for rounding, of which 5 and 6 are named as free.

    What is solved is a member that is aside by less than the pose tells; farther off it tells.
    """
    table = rounded(random_tables(448, seed=1)[447], 4)
    arm = arm_of(table)
    q = np.array([math.pi, -math.pi / 2, 5 * math.pi / 6, math.pi / 6, math.pi / 3, math.pi / 6])
    T = forward(arm, q[None])[0]
    found = dh2urdf.Robot.from_dh(table).ik(T, within_limits=False)
    masks = np.array([sum(1 << j for j in free) for free in found.free_joints])
    aside = np.array([1.0, 1.0, 0.0, 0.0, 0.0, 0.0])
    told = [contains(arm, found.q, masks, q + x * aside, T, MOST) for x in (0.0, 1e-2, -1e-1)]
    assert told == [True, False, False]


LONG = {
    524: (
        -1.4577068903209045,
        -4.7226889e-08,
        -1.0719100384,
        -0.7740820057,
        2.783023093,
        3.039136169,
    ),
    1509: (
        1.57078904266,
        1.57078988838,
        -1.57080004735,
        -1.57079476899,
        3.14158734575,
        1.57078076852,
    ),
}
"""Configurations on long curves of two of many random tables of 9 digits; another curve comes
within 1e-4 of the second."""


@pytest.mark.exhaustive
@pytest.mark.parametrize("k", LONG)
def test_a_family_is_walked_to_its_end_and_with_short_steps_where_another_is_near(k):
    """The configuration is 28 rad along the curve that is named, or past where another is near."""
    table = rounded(random_tables(k + 1, seed=1)[k], 9)
    tally = Tally("long")
    judge(tally, table, np.array([LONG[k]]), anywhere)
    assert tally.notes == []


def test_the_referee_misses_names_that_are_taken_away():
    """Axes 4 and 6 in line: what turns round them both goes on for a turn, and has to be named."""
    table, q = dh2urdf.load_table("puma560"), np.array([[0.3, -0.7, 0.4, 0.2, 0.0, 0.5]])

    def without_names(robot, Ts):
        batch = anywhere(robot, Ts)
        batch.free_mask[:] = 0
        return batch

    for answers, missing in ((anywhere, 0), (without_names, 1)):
        tally = Tally("names")
        judge(tally, table, q, answers)
        assert tally.count["unnamed"] == missing


def test_a_slice_of_structured_poses_loses_nothing_that_is_regular():
    """A few poses of each table that ships, and of random ones."""
    for name, poses in (("shipped", 8), ("random of 6", 4)):
        check_regular(sweep(name, CLASSES[name](), poses, seed=1000))


def check_regular(tally):
    """Nothing that is regular is lost, nothing is wrong or twice, and each pose has an answer."""
    print("\n" + tally.line())
    faults = ("regular lost", "wrong", "twice", "no answer")
    assert [note for note in tally.notes if note.startswith(faults)] == []


def sliding(count):
    """Tables of six joints with slides that have no joint to spare, about a quarter of so many."""
    return [table for table in sliding_tables(count) if moves_freely(table)]


def test_a_slice_of_structured_poses_with_slides_loses_nothing_that_is_regular():
    """A few poses of arms of right angles of which one, two or three joints slide."""
    check_regular(sweep("sliding of 6", sliding(2 * TABLES), 3, seed=1000))


@pytest.mark.exhaustive
@pytest.mark.parametrize("decimals", ROUNDINGS)
def test_structured_poses_with_slides_lose_nothing(decimals):
    """As of other arms."""
    report(sweep("sliding of 6", sliding(5 * TABLES), POSES // 3, decimals))


def followers_tally(away, multiplier, chains, poses):
    """The tally of right-angled chains of six values, of which one moves two joints."""
    tally = Tally(f"followers, {away} turns between, {multiplier:g} times")
    for seed in range(chains):
        chain = follower_chain(1000 + seed, multiplier, away, square=True).in_turns
        try:
            solver = select_solver(chain)
        except NoSolverError:
            tally.count["refused"] += 1
            continue

        def solved(Ts, chain=chain, solver=solver):
            found = solve(chain, Ts, solver=solver)
            return SimpleNamespace(q=found.q, count=found.count, free_mask=found.free)

        q = structured_configurations(chain, poses, seed)
        judge_arm(tally, (f"follower_chain({1000 + seed})", chain), q, solved)
    return tally


def test_a_slice_of_structured_poses_with_followers_loses_nothing_that_is_regular():
    """A few poses of chains in which a joint follows another one."""
    for away, multiplier in ((0, -1.0), (1, 1.0), (2, 2.0)):
        check_regular(followers_tally(away, multiplier, 4, 8))


@pytest.mark.exhaustive
@pytest.mark.parametrize("multiplier", MULTIPLIERS)
@pytest.mark.parametrize("away", AWAY)
def test_structured_poses_with_followers_lose_nothing(away, multiplier):
    """As of other arms."""
    report(followers_tally(away, multiplier, TABLES // 3, POSES // 4))


@pytest.mark.exhaustive
@pytest.mark.parametrize("decimals", ROUNDINGS)
@pytest.mark.parametrize("name", CLASSES)
def test_structured_poses_lose_nothing(name, decimals):
    """All joints on a grid, or one or two of them, with noise from none to 1e-2."""
    poses = POSES if name == "shipped" else POSES // 3
    report(sweep(name, CLASSES[name](), poses, decimals))


@pytest.mark.exhaustive
@pytest.mark.parametrize("decimals", ROUNDINGS)
def test_structured_poses_of_many_tables_lose_nothing(decimals):
    """Two poses of each of so many random tables."""
    report(sweep("many of 6", random_tables(MANY, seed=1), 2, decimals))


@pytest.mark.exhaustive
@pytest.mark.parametrize("decimals", ROUNDINGS)
def test_seven_joints_held_on_a_grid_lose_nothing(decimals):
    """Each joint in turn is held at the value that it has."""
    tally = Tally(f"seven held, {'exact' if decimals is None else f'{decimals} digits'}")
    others = [table for table in variant_tables(TABLES) if len(table.rows) == 7]
    for table in (rounded(table, decimals) for table in [*SEVEN, *others]):
        robot = dh2urdf.Robot.from_dh(table)
        for joint in range(7):
            q = structured_configurations(arm_of(table), POSES // 6, joint)

            def held(robot, Ts, joint=joint, values=q[:, joint]):
                return robot.ik_batch(Ts, within_limits=False, locked={joint: values})

            judge(tally, table, q, held, robot, (joint,))
    report(tally)


@pytest.mark.parametrize("poses", [10, pytest.param(POSES, marks=pytest.mark.exhaustive)])
def test_a_seed_that_reaches_the_pose_is_the_first_answer_of_seven_joints(poses):
    """A configuration is its own nearest solution."""
    tally = Tally("seven seeded, exact")
    for table in SEVEN:
        robot, arm = dh2urdf.Robot.from_dh(table), arm_of(table)
        for q in structured_configurations(arm, poses, 1):
            tally.count["poses"] += 1
            found = robot.ik(robot.fk(q), seed=q, within_limits=False)
            kind = "regular" if smallest(arm, q, np.ones(7, bool)) > 1e-4 else "singular"
            tally.count[kind] += 1
            if not len(found) or gaps(arm, found.q[0], q) > 1e-6:
                tally.note(f"{kind} lost", table, q)
    report(tally)
