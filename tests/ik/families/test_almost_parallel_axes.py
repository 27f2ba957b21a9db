"""Closed forms, and two axes that a rounded twist makes almost parallel."""

import math

import numpy as np
import pytest
from dh_arm import arm_of
from ik_referee import forward, gaps
from sweep import REGULAR, smallest

import dh2urdf
from dh2urdf.dh import DHRow, DHTable

H = math.pi / 2

ARMS = 60
"""Random arms of each of the other families."""

TILTS = [0.0, 1e-9, 1e-8, 1e-6, 7.3e-6, 1e-5, 1e-4, 1e-3, 2e-3, 5e-3, 1e-2, 1.9e-2, 2.1e-2, 3e-2]
"""Angles of axes 5 and 6 [rad], on both sides of the one from which the equations are trusted."""


@pytest.mark.parametrize("tilt", TILTS)
def test_regular_poses_are_found_however_small_the_angle_of_axes_5_and_6(tilt):
    """Equations that divide by its sine lost all of them at 1e-8, and one in a thousand at 1e-3."""
    cells = [(-0.2, 0.2, 0.0), (-0.1, 0.3, 0.0), (0.0, 0.4, -H), (0.3, 0.0, H)]
    cells += [(0.1, 0.2, math.pi + tilt), (0.1, 0.4, H)]
    rows = tuple(DHRow(0.0, d, a, alpha) for d, a, alpha in cells)
    table = DHTable(rows, "standard", name="almost parallel")
    assert regular_found(table, dh2urdf.Robot.from_dh(table), 1500) > 1400


def regular_found(table, robot, poses):
    """How many of random configurations are regular; all of them are found from their poses."""
    arm = arm_of(table)
    q = np.random.default_rng(1).uniform(-3.0, 3.0, (poses, 6))
    q = q[smallest(arm, q, slice(None)) > REGULAR]
    batch = robot.ik_batch(np.ascontiguousarray(forward(arm, q)), within_limits=False)
    for k, found, p in zip(batch.count, batch.q, q, strict=True):
        assert k
        assert gaps(arm, found[:k], p).min() < 1e-6
    return len(q)


def with_wrist(rng):
    """Cells (d, a, alpha) of right angles, the last three axes meet."""
    cells = right_angled(rng)
    cells[3:] = [(cells[3][0], 0.0, -H), (0.0, 0.0, H), (cells[5][0], 0.0, 0.0)]
    return cells


def with_two_parallel(rng):
    """Axes 2 and 3 are parallel, 4 and 5 meet."""
    cells = right_angled(rng)
    cells[1] = (*cells[1][:2], 0.0)
    cells[3] = (cells[3][0], 0.0, float(rng.choice((H, -H))))
    return cells


def right_angled(rng):
    """Cells (d, a, alpha) of six joints."""
    lengths, twists = rng.choice((0.0, 0.1, 0.2, 0.3, 0.4), (6, 2)), rng.choice((H, -H), 6)
    return [
        (float(d), float(a), float(twist)) for (d, a), twist in zip(lengths, twists, strict=True)
    ]


@pytest.mark.parametrize(
    ("cells", "places", "name"),
    [
        (with_wrist, (0, 1, 2), "spherical wrist"),
        (with_two_parallel, (0, 2, 4), "two parallel axes"),
    ],
)
def test_regular_poses_of_other_closed_forms_are_found(cells, places, name):
    """Two neighbouring axes of which the family says nothing, parallel but for a small angle."""
    rng, seen = np.random.default_rng(5), 0
    for k in range(ARMS):
        tilt, rows = TILTS[1 + k % (len(TILTS) - 1)], cells(rng)
        place = int(rng.choice(places))
        rows[place] = (*rows[place][:2], float(rng.choice((0.0, math.pi))) + tilt)
        rows = tuple(DHRow(0.0, d, a, alpha) for d, a, alpha in rows)
        table = DHTable(rows, "standard", name="almost parallel")
        robot = dh2urdf.Robot.from_dh(table)
        if regular_found(table, robot, 100) and str(robot.solver) == name:
            seen += 1
    assert seen > ARMS / 4
