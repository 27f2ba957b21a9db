"""Maps against forward sampling, which knows no inverse kinematics.

Configurations spread evenly over the limits land in poses with density ``1 / |det J|``, so that
``integral of |det J| dq`` over those whose tip is in a box is that of the number of solutions over
the box and SO(3), of volume ``8 pi^2``. Where no pose has two solutions, it is the share.
"""

from dataclasses import replace

import numpy as np
import pytest

import dh2urdf
from dh2urdf import Robot
from dh2urdf.workspace import reach_map

LARGE = pytest.param(20, marks=pytest.mark.exhaustive)

WHOLE = {
    "denso_vs6556": ((0.2, 0.5), (-0.3, 0.0), (0.2, 0.5)),
    "ur5e": ((-0.7, -0.3), (0.0, 0.4), (0.1, 0.5)),
    "kuka_kr6_r700": ((0.3, 0.6), (-0.15, 0.15), (0.3, 0.6)),
}
"""Arms and boxes [m]."""

ONE_WAY = {
    "denso_vs6556": ([-1.2, -1.2, 0.1, -3.1, 0.05, -3.1], [1.2, 0.8, 1.3, 3.1, 2.0, 3.1]),
    "ur5e": ([-1.0, -2.6, 0.2, -3.1, 0.05, -3.1], [1.0, -0.2, 2.8, 3.1, 3.1, 3.1]),
    "kuka_kr6_r700": ([-1.2, -2.6, 0.2, -3.1, 0.05, -3.1], [1.2, -0.3, 2.6, 3.1, 2.0, 3.1]),
}
"""Limits [rad] within which no pose has two solutions."""


def limited(name, low, high):
    """The arm with other limits."""
    table = dh2urdf.load_table(name)
    rows = zip(table.rows, low, high, strict=True)
    return Robot.from_dh(
        replace(table, rows=tuple(replace(r, lower=a, upper=b) for r, a, b in rows))
    )


def forward(robot, box, samples):
    """Mean number of solutions over a box (3, 2) and all orientations, and its standard error."""
    rng, sums, n = np.random.default_rng(7), np.zeros(2), 0
    for _ in range(samples):
        q = rng.uniform(robot.lower, robot.upper, (100_000, 6))
        p = robot.fk(q)[:, :3, 3]
        inside = ((p > box[:, 0]) & (p < box[:, 1])).all(axis=1)
        weight = np.abs(np.linalg.det(robot.jacobian(q[inside])))
        sums += weight.sum(), (weight**2).sum()
        n += len(q)
    mean = sums[0] / n
    scale = np.prod(robot.upper - robot.lower) / (8 * np.pi**2 * np.prod(box[:, 1] - box[:, 0]))
    return mean * scale, np.sqrt((sums[1] / n - mean**2) / n) * scale


def mapped(robot, box, samples):
    """The map of a box, and the standard error of its mean if its orientations were random.

    All voxels have the same ones, so that these are the draws.
    """
    step = float((box[:, 1] - box[:, 0]).min()) / (5 if samples < 10 else 10)
    found = reach_map(robot, step=step, orientations=4000, region=box, each=True)
    ways = found.solutions_each.values.mean(axis=(0, 1, 2))
    return found, ways.std() / np.sqrt(ways.size)


@pytest.mark.parametrize("samples", [5, LARGE])
@pytest.mark.parametrize("name", WHOLE)
def test_numbers_of_solutions_agree_with_forward_sampling(name, samples):
    """Over a box, within four standard errors of the two estimates, which are below 2 %."""
    table, box = dh2urdf.load_table(name), np.array(WHOLE[name])
    ends = np.array([(r.lower, r.upper) for r in table.rows])
    ends = np.clip(ends, -np.pi, np.pi)
    robot = limited(name, *ends.T.tolist())
    found, rough = mapped(robot, box, samples)
    mean, error = forward(robot, box, samples)
    assert error < 0.02 * mean
    assert abs(float(found.solutions_mean.mean()) - mean) < 4 * np.hypot(error, rough)


@pytest.mark.parametrize("samples", [5, LARGE])
@pytest.mark.parametrize("name", ONE_WAY)
def test_shares_agree_with_forward_sampling(name, samples):
    """Of arms with at most one solution, within four standard errors, which are below 2 %."""
    robot = limited(name, *ONE_WAY[name])
    middle = robot.fk((robot.lower + robot.upper) / 2)[:3, 3]
    box = middle[:, None] + [-0.15, 0.15]
    found, rough = mapped(robot, box, samples)
    assert found.solutions_max.max() == 1
    mean, error = forward(robot, box, samples)
    assert error < 0.02 * mean
    assert abs(float(found.share.mean()) - mean) < 4 * np.hypot(error, rough)
