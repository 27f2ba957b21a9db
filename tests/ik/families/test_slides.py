"""Six joints of which some slide, with neither a wrist nor another closed form."""

import itertools
import math

import numpy as np
import pytest
from dh_arm import arm_of
from ik_referee import (
    GAP,
    RESIDUAL,
    arm,
    distances,
    exists,
    forward,
    gaps,
    misses,
    random_robot,
    regularity,
    residuals,
    rows_of,
    search,
    solve,
)
from margins import assert_apart, assert_margin
from structured import rounded, sliding_tables, structured_configurations
from sweep import Tally, judge

import dh2urdf
from dh2urdf.dh import DHRow, DHTable, Origin
from dh2urdf.ik.arm.solver_order import select_solver

REACH = 1.0
"""How far slides move either way [m]; the arms have links of up to 0.7 m."""


def classes(slides):
    """Kinds of six joints with so many slides: ``PRRRRR``, ``RPRRRR``, ..."""
    for places in itertools.combinations(range(6), slides):
        yield "".join("P" if i in places else "R" for i in range(6))


def slider(kinds, right_angled, seed=0):
    """An arm of six random rows, its twists right angles or random ones."""
    rng = np.random.default_rng([seed, right_angled, *map(ord, kinds)])
    rows = rng.uniform((-0.5, -0.5, -3.1), (0.5, 0.5, 3.1), (6, 3))
    if right_angled:
        rows[:, 2] = rng.choice((-1, 1), 6) * math.pi / 2
    return arm(tuple(map(tuple, rows.tolist())), kinds, seed)


def configurations(chain, m, seed, least=1e-3):
    """Random configurations (m, 6), one in three near a singularity, none nearer than ``least``."""
    rng, found = np.random.default_rng(seed), np.empty((0, 6))
    span = np.where(chain.prismatic, REACH, math.pi)
    while len(found) < m:
        q = rng.uniform(-span, span, (4 * m, 6))
        sigma = regularity(chain, q)
        near = np.argsort(sigma)[: m // 3]
        some = np.concatenate([q[near], q[: m - len(near)]])
        found = np.concatenate([found, some[regularity(chain, some) > least]])
    return found[:m]


KINDS = [*classes(1), *classes(2), *classes(3)]


FAR = 100.0
"""Distance of slides, in sizes of the arm, from which rounding counts."""


def check(kinds, right_angled, m, seed):
    """All solutions reach their poses, none is there twice, one is what made the pose.

    Regular solutions come in pairs, however far out, but where two slides are nearly parallel in
    one of them: it may be a hundred kilometres out, and is left. Residuals are in parts of how far
    out slides are, from ``FAR`` on.
    """
    chain = slider(kinds, right_angled, seed)
    q = configurations(chain, m, seed)
    Ts = forward(chain, q)
    found = solve(chain, Ts)
    solutions, owner = rows_of(found)
    out = np.abs(solutions[:, chain.prismatic]).max(axis=1, initial=0.0) / chain.size
    for residual in (residuals(chain, solutions, Ts[owner]), found.residual[exists(found)]):
        assert_margin(residual / np.maximum(1.0, out / FAR), RESIDUAL)
    assert_margin(misses(chain, found, q), GAP, quantile=0.999)
    assert_apart(distances(chain, found), GAP, quantile=0.999)
    least = np.full(m, np.inf)
    np.minimum.at(least, owner, regularity(chain, solutions))
    odd = (found.count[least > 1e-3] % 2).sum()
    assert odd <= (m // 1000 if kinds.count("P") == 2 else 0)


def check_by_search(kinds, right_angled, m, seed):
    """Newton's method from 100 random starts finds what is found and nothing else."""
    chain = slider(kinds, right_angled, seed)
    Ts = forward(chain, configurations(chain, m, seed + 7))
    found = solve(chain, Ts)
    for i, T in enumerate(Ts):
        others = search(chain, T, i, starts=100)
        if len(others):
            assert_margin(gaps(chain, found.of(i)[0], others[:, None]).min(axis=1), GAP)


@pytest.mark.parametrize("right_angled", [False, True])
@pytest.mark.parametrize("kinds", KINDS)
def test_the_generating_configuration_is_among_distinct_solutions(kinds, right_angled):
    """Slides in any place, 200 poses: nothing is lost, wrong or twice."""
    check(kinds, right_angled, 200, seed=0)
    family = "three slides" if kinds.count("P") == 3 else f"general {kinds}"
    assert select_solver(slider(kinds, right_angled)).name == family


@pytest.mark.parametrize("kinds", KINDS)
def test_a_search_from_100_starts_finds_no_other_solution(kinds):
    """At poses of one arm with right angles and one without."""
    for right_angled in (False, True):
        check_by_search(kinds, right_angled, 1, seed=1)


@pytest.mark.exhaustive
@pytest.mark.parametrize("right_angled", [False, True])
@pytest.mark.parametrize("kinds", KINDS)
def test_no_configuration_is_lost_in_20_000_poses(kinds, right_angled):
    """Ten arms of each class of joints, 2,000 poses each, 20 of them searched."""
    for seed in range(10):
        check(kinds, right_angled, 2000, seed)
        check_by_search(kinds, right_angled, 2, seed)


def test_the_partner_of_a_pair_is_found_a_hundred_kilometres_out():
    """Where three slides are nearly in a plane they are solved for as exactly, and kept."""
    chain = slider("PPRRPR", right_angled=False, seed=3)
    q = np.array([-0.81805769, 0.45199622, 0.19978133, -2.12546967, -0.50848269, -1.80348063])
    found = solve(chain, forward(chain, q[None]))
    assert found.count[0] == 2
    assert np.abs(found.q[0, :2]).max() > 1e5
    assert_margin(found.residual[0, :2], RESIDUAL)


def crossed_slides():
    """A machine of two slides at right angles and four turns without a wrist."""
    h = math.pi / 2
    rows = (
        DHRow(0.0, 0.0, 0.0, -h, "prismatic"),
        DHRow(-h, 0.0, 0.0, h, "prismatic"),
        DHRow(0.0, 0.1, 0.0, h),
        DHRow(0.0, 0.01, 0.25, math.radians(30.0)),
        DHRow(0.0, 0.07, 0.0, math.radians(240.0)),
        DHRow(0.0, -0.05831, 0.05, 0.0),
    )
    base, tool = Origin((0.0, 0.0, 0.0), (0.0, h, 0.0)), Origin((0.0, -0.005, 0.0), (0.0, 0.0, 0.0))
    return dh2urdf.Robot.from_dh(DHTable(rows, "standard", base=base, tool=tool))


def test_both_known_configurations_of_a_machine_of_two_slides_are_found():
    """Where it stands, and with the last four joints turned over."""
    robot = crossed_slides()
    q = np.array([0.1, 0.2, 0.3, 0.4, 0.5, -0.2])
    found = robot.ik(robot.fk(q), within_limits=False)
    other = np.array([0.567924, 0.06803, 2.855506, 0.4, -1.408326, 2.553873])
    for known, digits in ((q, 1e-9), (other, 1e-6)):
        assert_margin(gaps(robot.chain, found.q, known).min(), digits, 1)


def lost(table, q):
    """What the referee of sweeps says of configurations q (m, 6) of a table."""
    tally = Tally("slides")
    judge(tally, table, q, lambda robot, Ts: robot.ik_batch(Ts, within_limits=False))
    return [note for note in tally.notes if not note.startswith("unnamed")]


def test_where_turns_are_in_line_and_three_slides_in_a_plane_nothing_is_lost():
    """The equations have no solution at one member of the family of turns, and at others do."""
    in_line = [-math.pi / 2, 0.3, 0.0, -math.pi / 2, 0.2, -math.pi]
    beside = [-2.3561935486797667, 0.2992918153728758, -0.0234270813445917]
    beside += [1.5707962780413265, 0.20391097312254722, 1.173418514392086]
    assert lost(sliding_tables(198)[197], np.array([in_line, beside])) == []
    in_plane = [3 * math.pi / 4, math.pi / 2, 0.1, -math.pi / 2, 0.0, 0.0]
    assert lost(sliding_tables(81)[80], np.array([in_plane])) == []


def test_a_slide_along_axes_that_are_parallel_but_for_rounding_is_measured_nearby():
    """Not from where they come nearest, tens of kilometres out."""
    table = rounded(sliding_tables(94)[93], 4)
    assert lost(table, structured_configurations(arm_of(table), 40, 0)) == []


def test_where_every_value_of_the_hidden_joint_carries_a_solution_a_member_is_found():
    """At a pose on a family that the polynomial says nothing of, the configuration is on one."""
    table = sliding_tables(68, 1)[67]
    robot = dh2urdf.Robot.from_dh(table)
    q = np.array([-0.2232742608, 0.1981212257, 0.0, -0.9086078705, math.pi, -1.363111170])
    found = robot.ik(robot.fk(q), within_limits=False)
    assert str(robot.solver) == "general PPRRRR"
    assert len(found)
    assert any(found.free_joints)


def test_limits_seeds_and_free_joints_are_as_of_other_arms():
    """The seed is the first, what is outside the limits is left out, out of reach is said so."""
    robot = random_robot(6, sliding=(1, 4), seed=3)
    q = robot.random_configuration(np.random.default_rng(0))
    T = robot.fk(q)
    inside, anywhere = robot.ik(T, seed=q), robot.ik(T, within_limits=False)
    assert_margin(np.abs(inside.q[0] - q).max(), GAP)
    assert ((inside.q >= robot.lower) & (inside.q <= robot.upper)).all()
    assert len(inside) <= len(anywhere)
    batch = robot.ik_batch(np.array([T, T]), within_limits=False)
    assert (batch.count == len(anywhere)).all()
    assert "Raghavan" not in robot.solver.explain()
    far = robot.fk(q)
    far[:3, 3] += 100.0
    assert "reach" in robot.why_unreachable(far)
    axis = robot.ik(T, task="position+axis", within_limits=False)
    assert len(axis)


@pytest.mark.parametrize("sliding", [(0,), (2,), (0, 3)])
@pytest.mark.parametrize("held", [0, 3, 6])
def test_held_joints_of_seven_with_slides_leave_nothing_out(sliding, held):
    """A rail and six joints: with any one held the configuration is found by the general solver."""
    robot = random_robot(7, sliding=sliding, seed=5)
    rng = np.random.default_rng(2)
    for _ in range(3):
        q = robot.random_configuration(rng)
        T = robot.fk(q)
        found = robot.ik(T, locked={held: q[held]}, within_limits=False)
        assert_margin(gaps(robot.chain, found.q, q).min(), GAP)
        assert_margin(residuals(robot.chain, found.q, T), RESIDUAL)
