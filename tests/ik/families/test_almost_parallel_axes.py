"""Three parallel axes, and two others that a rounded twist makes almost parallel."""

import math

import numpy as np
import pytest
from dh_arm import arm_of
from ik_referee import forward, gaps
from sweep import REGULAR, smallest

import dh2urdf
from dh2urdf.dh import DHRow, DHTable

H = math.pi / 2


TILTS = [0.0, 1e-9, 1e-8, 1e-6, 7.3e-6, 1e-5, 1e-4, 1e-3, 2e-3, 5e-3, 1e-2, 1.9e-2, 2.1e-2, 3e-2]
"""Angles of axes 5 and 6 [rad], on both sides of the one from which the equations are trusted."""


@pytest.mark.parametrize("tilt", TILTS)
def test_regular_poses_are_found_however_small_the_angle_of_axes_5_and_6(tilt):
    """Equations that divide by its sine lost all of them at 1e-8, and one in a thousand at 1e-3."""
    cells = [(-0.2, 0.2, 0.0), (-0.1, 0.3, 0.0), (0.0, 0.4, -H), (0.3, 0.0, H)]
    cells += [(0.1, 0.2, math.pi + tilt), (0.1, 0.4, H)]
    rows = tuple(DHRow(0.0, d, a, alpha) for d, a, alpha in cells)
    table = DHTable(rows, "standard", name="almost parallel")
    arm, robot = arm_of(table), dh2urdf.Robot.from_dh(table)
    q = np.random.default_rng(1).uniform(-3.0, 3.0, (1500, 6))
    q = q[smallest(arm, q, slice(None)) > REGULAR]
    batch = robot.ik_batch(np.ascontiguousarray(forward(arm, q)), within_limits=False)
    assert len(q) > 1400
    for k, found, p in zip(batch.count, batch.q, q, strict=True):
        assert k
        assert gaps(arm, found[:k], p).min() < 1e-6
