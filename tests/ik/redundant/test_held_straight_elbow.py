"""An elbow held straight and a wrist in line: what turns both ways about one line is a family."""

import math

import numpy as np
import pytest
from sweep import Tally, judge

import dh2urdf

H, T = math.pi / 2, math.pi / 6

POSES = [
    (-H, -6 * T, -6 * T, 0.0, 5 * T, 0.0, H),
    (0.0, 6 * T, -6 * T, 0.0, H, 0.0, 0.0),
    (0.0, H, -6 * T, 0.0, -H, 0.0, 0.0),
    (-H, 0.0, -6 * T, 0.0, H, 0.0, 0.0),
    (6 * T, -H, -6 * T, 0.0, 0.0, 0.0, H),
    (-H, -H, 0.0, 0.0, -H, 0.0, 0.0),
    (-H / 2, -H / 2, 0.0, 0.0, H, 0.0, -H),
    (6 * T, -1.5 * H, 6 * T, 0.0, 0.0, 0.0, H / 2),
]
"""Of an arm whose elbow is a centimetre off the line, so that it is known to the root of rounding:
the wrist is on either side of the line by a millionth."""


@pytest.mark.parametrize("q", POSES)
def test_a_wrist_that_rounding_takes_out_of_line_names_its_family(q):
    """The configuration is a member of it by the referee's walk; no solution has a twin beside."""
    table, q = dh2urdf.load_table("kinova_gen3"), np.array(q)
    tally = Tally("straight elbow")

    def held(robot, Ts):
        return robot.ik_batch(Ts, within_limits=False, locked={3: q[3:4]})

    judge(tally, table, q[None], held, held=(3,))
    assert tally.notes == []
    robot = dh2urdf.Robot.from_dh(table)
    found = robot.ik(robot.fk(q), within_limits=False, locked={3: 0.0})
    assert (4, 6) in found.free_joints
    assert np.linalg.matrix_rank(robot.jacobian(q)[:, [4, 6]], tol=1e-9) == 1
