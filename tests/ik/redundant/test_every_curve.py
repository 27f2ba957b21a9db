"""Arms that are redundant everywhere: every curve of solutions, and none twice."""

import numpy as np
import pytest
from dh_arm import arm_of
from dh_product import rows
from self_motions import on_family
from sweep import contains

import dh2urdf

TWO_CURVES = dh2urdf.DHTable.from_array(
    rows(
        "pi -.1425 0 pi; 0 0 -.411 pi; -h .2 0 -1.0471975511965976;"
        "pi -.5697 .3 0; -h 0 .5 0; 0 .2 .3 0"
    ),
    convention="modified",
    columns="theta d a alpha",
)
FOUR_IN_A_PLANE = dh2urdf.DHTable.from_array(
    rows("0 0 .3 0; 0 0 .2 0; 0 0 .25 0; 0 0 .1 0"), "standard", "theta d a alpha"
)
"""Arms that are redundant everywhere."""


@pytest.mark.parametrize("poses", [20, pytest.param(1000, marks=pytest.mark.exhaustive)])
@pytest.mark.parametrize("table", [TWO_CURVES, FOUR_IN_A_PLANE], ids=["six", "plane"])
def test_a_member_of_every_curve_of_a_redundant_arm_is_found_without_a_seed(table, poses):
    """Each configuration is on the family of a solution, by a walk of the tests' own."""
    robot, arm = dh2urdf.Robot.from_dh(table), arm_of(table)
    q = np.random.default_rng(3).uniform(-3.1, 3.1, (poses, robot.n))
    if table is TWO_CURVES:
        q[0] = 1.4364, -2.9494, -1.7405, -2.9401, 1.2902, -3.104
    batch = robot.ik_batch(robot.fk(q), within_limits=False)
    for i, T in enumerate(robot.fk(q)):
        k = batch.count[i]
        assert contains(arm, batch.q[i, :k], batch.free_mask[i, :k], q[i], T, 1e-6)


def test_no_curve_that_starts_lead_to_is_there_twice():
    """A curve that no held value meets has one member; the small one of this pose is 0.6 rad."""
    robot, arm = dh2urdf.Robot.from_dh(TWO_CURVES), arm_of(TWO_CURVES)
    q = np.array([1.4364, -2.9494, -1.7405, -2.9401, 1.2902, -3.104])
    T = robot.fk(q)
    found = robot.ik(T, within_limits=False).q
    free = np.array([False, False, True, True, True, True])
    assert sum(on_family(arm, p, q, T, free, 1e-6) for p in found) == 1


def test_no_solution_of_rounded_angles_is_there_twice_by_a_full_turn():
    """Axes that are parallel to nine digits: curves that hardly move the tool."""
    a = 1.570796327
    rows = [(-a, 0.4, 0.3, 2 * a), (0, 0.4, 0.4, 0), (0, -0.1, 0.3, 2 * a)]
    rows += [(2 * a, -0.2, 0.1, -a), (2 * a, 0.1, 0.2, 0), (2 * a, 0.2, 0.3, 2 * a)]
    table = dh2urdf.DHTable.from_array(rows, "standard", "theta d a alpha")
    robot = dh2urdf.Robot.from_dh(table)
    for q in (
        (1.1985348946298655, -2.3561944901917866, 0.4730389515, 0.7853981634, 1.6333, 1.401077737),
        (1.8324343958980729, -2.1146604101636175, 1.5517063861, -1.58331673, 0.25604, -1.82733371),
    ):
        found = robot.ik(robot.fk(np.array(q)), within_limits=False).q
        assert len(found)
        for k, p in enumerate(found):
            away = np.abs(np.remainder(found[:k] - p + np.pi, 2.0 * np.pi) - np.pi)
            assert (away.max(axis=1) > 1e-6).all()


def test_a_pose_beyond_a_redundant_arm_has_no_solution():
    """A tenth of a millimetre beyond the stretched arm, and on its rim one."""
    robot = dh2urdf.Robot.from_dh(FOUR_IN_A_PLANE)
    T = robot.fk(np.array([0.4, 0.0, 0.0, 0.0]))
    assert len(robot.ik(T, within_limits=False)) == 1
    T[:3, 3] *= (0.85 + 1e-4) / 0.85
    assert len(robot.ik(T, within_limits=False)) == 0


def test_an_arm_with_two_joints_to_spare_says_that_it_holds_a_part():
    """Surfaces of solutions are not walked; the solver's words and the answers say so."""
    table = dh2urdf.DHTable.from_array(
        rows("0 0 .3 0; 0 0 .2 0; 0 0 .25 0; 0 0 .2 0; 0 0 .1 0"), "standard", "theta d a alpha"
    )
    robot = dh2urdf.Robot.from_dh(table)
    found = robot.ik(robot.fk(np.full(5, 0.4)), within_limits=False)
    assert found.partial
    assert all("a part of the solutions" in text for text in (robot.solver.explain(), str(found)))
    robot = dh2urdf.Robot.from_dh(FOUR_IN_A_PLANE)
    assert not robot.ik(robot.fk(np.full(4, 0.4)), within_limits=False).partial
