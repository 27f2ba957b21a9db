"""The general 6R solver at poses in doubt: where solutions meet, beside families and on them."""

import numpy as np
import pytest
from dh_arm import arm_of
from dh_product import rows
from ik_referee import forward, gaps, shipped, solve
from margins import assert_margin
from sweep import contains

import dh2urdf
from dh2urdf.conversions.write.table_chain import dh_to_chain
from dh2urdf.dh import DHRow, DHTable, Origin
from dh2urdf.ik.arm.solver_order import select_solver
from dh2urdf.ik.families.general_6r import General6R

H = 0.5 * np.pi

FOLDED = "0 .275 0 -h; -h 0 .7 pi; -h 0 0 -h; 0 -.5 0 h; 0 -.162 0 -h; 0 -.13 0 pi"
"""An arm whose wrist lines up with its shoulder at ``FOLD`` [deg]."""

FOLD = np.radians([0.0, 0.0, 180.0, -123.4, 0.0, 14.0])


@pytest.mark.parametrize(
    ("family", "size"),
    [(select_solver, 1e-6)]
    + [pytest.param(select_solver, size, marks=pytest.mark.exhaustive) for size in (1e-8, 1e-7)]
    + [(family, size) for family in (select_solver, General6R) for size in (1e-5, 1e-4, 1e-3)],
)
def test_beside_a_fold_no_pose_is_without_an_answer(family, size):
    """40 poses that far from where a family of solutions begins: found, or named, all of them."""
    table = DHTable(tuple(DHRow(*row) for row in rows(FOLDED)), "standard")
    arm, chain = arm_of(table), dh_to_chain(table)
    q = FOLD + size * np.random.default_rng(0).standard_normal((40, 6))
    Ts = np.ascontiguousarray(forward(arm, q))
    found = solve(chain, Ts, solver=family(chain))
    for i, T in enumerate(Ts):
        solutions, residual, _, free = found.of(i)
        assert_margin(residual, 1e-9, 1)
        assert contains(arm, solutions, free, q[i], T, 1e-6)


def test_roots_that_meet_are_as_many_solutions():
    """Solutions that share the hidden joint's value are all found, at poses of right angles."""
    for name, degrees in (
        ("doosan_m1013", (135, 0, -90, -45, -90, 90)),
        ("yaskawa_gp7", (-90, 135, 90, 0, 45, 90)),
    ):
        chain, q = shipped(name), np.radians(degrees)
        found = solve(chain, forward(chain, q[None]), solver=General6R(chain)).of(0)[0]
        assert_margin(gaps(chain, found, q).min(), 1e-6)


OFFSET = [
    DHRow(0.0, 0.4, 0.0, H),
    DHRow(2.0 * H, -0.2, 0.10061661957895685, H),
    DHRow(0.0, 0.1, -0.2, 0.0, sign=-1),
    DHRow(-H, 0.0, -0.2, H),
    DHRow(0.0, 0.0, 0.1, -H),
    DHRow(0.0, 0.4, 0.3, 2.0 * H),
]
"""An arm of right angles that is of no family."""


@pytest.mark.parametrize(
    "q",
    [(0.762617, 0.686075, 0.956577, H, 0.311565, 1.502757), (-H, 2 * H, 0.0, H, 2 * H, -H)],
    ids=["on a family", "where roots meet"],
)
def test_a_singular_pose_of_an_arm_of_right_angles_is_found(q):
    """The configuration is found, to rounding, or is on a family that is named."""
    tool = Origin((0.05, 0.1, 0.2), (0.1, 0.2, 0.3))
    table = DHTable(tuple(OFFSET), "modified", tool=tool)
    arm, robot, q = arm_of(table), dh2urdf.Robot.from_dh(table), np.array(q)
    assert robot.solver.name == "general 6R"
    T = forward(arm, q)
    found = robot.ik_batch(T[None], within_limits=False)
    k = found.count[0]
    assert_margin(found.residual[0, :k], 1e-9, 1)
    assert contains(arm, found.q[0, :k], found.free_mask[0, :k], q, T, 1e-6)
