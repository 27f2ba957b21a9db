"""The general 6R solver at poses in doubt: where solutions meet, beside families and on them."""

import numpy as np
import pytest
from dh_arm import arm_of
from dh_product import rows
from ik_referee import forward, gaps, shipped, solve
from margins import assert_margin
from sweep import contains

from dh2urdf.conversions.write.table_chain import dh_to_chain
from dh2urdf.dh import DHRow, DHTable
from dh2urdf.ik.families.general_6r import General6R

FOLDED = "0 .275 0 -h; -h 0 .7 pi; -h 0 0 -h; 0 -.5 0 h; 0 -.162 0 -h; 0 -.13 0 pi"
"""An arm whose wrist lines up with its shoulder at ``FOLD`` [deg]."""

FOLD = np.radians([0.0, 0.0, 180.0, -123.4, 0.0, 14.0])


@pytest.mark.parametrize("size", [1e-5, 1e-4, 1e-3])
def test_beside_a_fold_no_pose_is_without_an_answer(size):
    """40 poses that far from where a family of solutions begins: found, or named, all of them."""
    table = DHTable(tuple(DHRow(*row) for row in rows(FOLDED)), "standard")
    arm, chain = arm_of(table), dh_to_chain(table)
    q = FOLD + size * np.random.default_rng(0).standard_normal((40, 6))
    Ts = np.ascontiguousarray(forward(arm, q))
    found = solve(chain, Ts, solver=General6R(chain))
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
