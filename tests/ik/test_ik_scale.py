"""Inverse kinematics does not depend on the size of the arm.

The reference of an arm made larger is the arm itself: the same recall of the configurations that
poses were made from, and the same residuals relative to its size.
"""

from functools import cache

import numpy as np
import pytest
from ik_referee import exists, noisy_table
from margins import assert_margin
from strategies import scaled

import dh2urdf
from dh2urdf.dh import DHRow, DHTable, JointType

SCALES = [1e-6, 1e-3, 1e3, 1e6]

POSES = 12

RELATIVE = 1e-12
"""Residual of a solution, position relative to the size: a thousandth of what is promised."""

GAP = 1e-6
"""Joint distance [rad, or m at scale 1] at which a solution is the configuration itself."""


@cache
def case(name, factor, count=POSES):
    """Robot at a scale, configurations, and their poses by its own DH product."""
    table = SPECIAL[name] if name in SPECIAL else dh2urdf.load_table(name)
    small = dh2urdf.Robot.from_dh(table)
    robot = dh2urdf.Robot.from_dh(scaled(table, factor))
    unit = np.where(robot.slides, factor, 1.0)
    q = np.stack([small.random_configuration(i) for i in range(count)]) * unit
    return robot, unit, q, np.stack([robot.table.fk(robot.chain_configuration(row)) for row in q])


def arm(kinds, numbers, twists):
    """A table of turning (R) and sliding (P) joints from their offsets, lengths and twists."""
    rows = []
    for kind, (d, a), alpha in zip(kinds, numbers, twists, strict=True):
        if kind == "R":
            rows.append(DHRow(0.3, d, a, alpha, lower=-3.0, upper=3.0))
        else:
            rows.append(DHRow(d, 0.2, a, alpha, JointType.PRISMATIC, lower=-0.5, upper=0.7))
    return DHTable(tuple(rows), "standard", name=f"arm_{kinds}")


SIX = [(0.3, 0.2), (0.1, 0.5), (0.2, 0.1), (0.4, 0.3), (-0.1, 0.2), (0.2, 0.1)]
SHOULDER = [(0.3, 0.0), (0.0, 0.0), *SIX[2:]]
TWISTS = [1.1, 0.4, -0.9, 1.3, 0.7, 0.2]

SPECIAL = {
    "nearly spherical": noisy_table("puma560", 1e-5, seed=1),
    "nearly parallel": noisy_table("ur5", 1e-4, seed=1),
    "spherical shoulder": arm("RRRRRR", SHOULDER, TWISTS),
    "general 6R": arm("RRRRRR", SIX, TWISTS),
    "three slides": arm("PPRPRR", SIX, TWISTS),
    "one turning joint": arm("R", SIX[:1], TWISTS[:1]),
    "two joints": arm("RP", SIX[:2], TWISTS[:2]),
    "five joints": arm("RPRRR", SIX[:5], TWISTS[:5]),
    "to spare": arm("RRRR", SIX[:4], [0.0] * 4),
}

ARMS = [*dh2urdf.list_tables(), *SPECIAL]


def misses(robot, q, found, unit):
    """Distance of each configuration from the nearest solution, relative to the unit, turns off."""
    out = []
    for k, row in enumerate(q):
        gap = (found[k].q - row) / unit
        turned = np.abs(np.remainder(gap + np.pi, 2.0 * np.pi) - np.pi)
        gap = np.where(robot.slides, np.abs(gap), turned)
        out.append(gap.max(axis=1).min(initial=np.inf))
    return np.array(out)


def relative(robot, T, solutions):
    """Residuals of configurations (k, n) by the table's own product, lengths in sizes."""
    D = np.array([robot.table.fk(robot.chain_configuration(row)) for row in solutions]) - T
    D[:, :3, 3] /= robot.chain.size
    return np.abs(D).max(axis=(1, 2))


@pytest.mark.parametrize("name", ARMS)
def test_recall_and_relative_residual_do_not_depend_on_size(name):
    """An arm of micrometres, and one of a thousand kilometres, finds what the arm itself does."""
    robot, unit, q, T = case(name, 1.0)
    first = robot.ik_batch(T)
    spare = robot.n == 7 or name == "to spare"
    if not spare:
        assert_margin(misses(robot, q, first, unit), GAP)
    for factor in SCALES:
        robot, unit, q, T = case(name, factor)
        found = robot.ik_batch(T)
        assert found.solved.all()
        if not spare:
            assert np.array_equal(found.count, first.count)
            assert_margin(misses(robot, q, found, unit), GAP)
        error = [relative(robot, T[k], found[k].q[:4]) for k in range(POSES)]
        assert_margin(np.concatenate(error), RELATIVE)
        held = found.residual[exists(found)]
        assert_margin(held, 1e-9 * max(1.0, 2.0 * robot.chain.size))


ONE_BY_ONE = ["omron_cobra600", "stanford", "puma560", "gantry", "nearly parallel"]


@pytest.mark.parametrize("factor", SCALES)
@pytest.mark.parametrize("name", ONE_BY_ONE)
def test_single_calls_seeds_and_reports_are_in_metres(name, factor):
    """Residuals are what Pinocchio measures, seeds are found, reasons are in metres."""
    robot, unit, q, T = case(name, factor)
    found = robot.ik(T[0])
    size = robot.chain.size
    measured = found.verify()
    assert_margin(np.abs(found.residual - measured), 1e-14 * max(1.0, size))
    assert_margin(np.abs((robot.ik(T[0], seed=q[0])[0] - q[0]) / unit), GAP)
    assert_margin(np.abs((found.nearest(q[0]) - q[0]) / unit), GAP)
    assert np.array_equal(found.T, T[0])
    assert len(robot.ik(T[0], turns="all")) >= len(found)
    assert robot.why_unreachable(T[0]) == ""
    far = T[0].copy()
    far[:3, 3] += 1e3 * size
    away = float(np.linalg.norm(far[:3, 3]))
    why = robot.why_unreachable(far, within_limits=False)
    if "outside the reach" in why:
        said = float(why.split(" lies ")[1].split(" m ")[0])
        assert 0.94 * away < said < 1.06 * away


@pytest.mark.parametrize("factor", SCALES)
def test_joints_held_and_paths_scale(factor):
    """A held slide keeps its value in metres, and a path is the same one, only larger."""
    robot, unit, q, T = case("stanford", factor)
    held = robot.ik(T[3], locked={2: float(q[3, 2])})
    assert_margin(np.abs((held.q - q[3]) / unit).max(axis=1).min(), GAP)
    assert (held.q[:, 2] == q[3, 2]).all()
    small, _, q1, _ = case("stanford", 1.0)
    way = q1[0] + np.linspace(0.0, 0.2, 9)[:, None] * (np.clip(q1[1] - q1[0], -1.0, 1.0))
    one = small.ik_path(small.fk(way), start=way[0])
    large = robot.ik_path(robot.fk(way * unit), start=way[0] * unit)
    assert one.continuous
    assert large.continuous
    assert_margin(np.abs(large.q / unit - way), GAP)


@pytest.mark.parametrize("factor", SCALES)
@pytest.mark.parametrize("name", ["franka_fer", "kuka_iiwa7", "kinova_gen3"])
def test_seven_joints_scale_held_swept_and_in_intervals(name, factor):
    """Seven joints give the seed back, with a joint held too, and the same intervals of reach."""
    robot, _, q, T = case(name, factor)
    small, _, _, T1 = case(name, 1.0)
    for joint in (0, 2, 6):
        held = robot.ik_batch(T, locked={joint: q[:, joint]})
        assert_margin(misses(robot, q, held, 1.0), GAP)
    assert_margin(np.abs(robot.ik(T[0], seed=q[0])[0] - q[0]), GAP)
    one, large = small.ik_intervals(T1[0]), robot.ik_intervals(T[0])
    assert one.shape == large.shape
    assert_margin(np.abs(one - large), 1e-8)


TASKS = [
    *((name, "position") for name in ("planar_rr", "cylindrical", "rpr_new_frame")),
    *((name, "position+axis") for name in ("stanford", "xarm5", "puma560")),
]


@pytest.mark.parametrize("factor", SCALES)
@pytest.mark.parametrize(("name", "task"), TASKS)
def test_tasks_scale(name, task, factor):
    """Position, and position with axis, are reached at any size where they are at a metre."""
    robot, _, _, T = case(name, factor)
    small, _, _, T1 = case(name, 1.0)
    for k in range(4):
        one, found = small.ik(T1[k], task=task), robot.ik(T[k], task=task)
        assert len(one) == len(found) > 0
        D = np.array([robot.table.fk(row) for row in found.q])[:, :3] - T[k, :3]
        assert_margin(np.abs(D[..., 3]), 1e-9 * factor)
        if task != "position":
            assert_margin(np.abs(D[..., 2]), 1e-9)


@pytest.mark.parametrize("factor", SCALES)
@pytest.mark.parametrize("name", ["puma560", "stanford", "omron_cobra600", "franka_fer"])
def test_the_numeric_search_scales(name, factor):
    """What a search finds for an arm it finds for the larger one, measured in metres."""
    robot, unit, q, T = case(name, factor)
    found = robot.ik_numeric(T[0], seed=q[0])
    assert_margin(np.abs((found[0] - q[0]) / unit), GAP)
    other = robot.ik_numeric(T[1], solutions=2)
    small, _, _, T1 = case(name, 1.0)
    assert len(other) == len(small.ik_numeric(T1[1], solutions=2))
    assert_margin(relative(robot, T[1], other), 1e-9)


@pytest.mark.parametrize("name", ["ur5", "puma560", "omron_cobra600"])
def test_an_arm_of_a_metre_is_solved_in_metres(name):
    """The chain of a normal arm is the solvers' own, so its numbers are what they were."""
    robot = dh2urdf.Robot.from_dh(name)
    assert robot.solver.chain is robot.chain
