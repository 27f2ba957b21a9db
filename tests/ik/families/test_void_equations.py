"""Closed forms where an equation fixes none of its unknowns, or singularities meet."""

from dataclasses import replace

import numpy as np
import pytest
from dh_arm import arm_of
from structured import random_tables, structured_configurations
from sweep import Tally, judge

import dh2urdf
from dh2urdf.dh import DHRow, DHTable
from dh2urdf.exceptions import NoSolverError

H = np.pi / 2

FOLDED = "0 0 0 180; 0 0 .3 180; 0 .2 .5 180; 90 .5 .1 -90; 0 .1 .3 -90; 0 .2 .51581 0"
ELBOW = "0 0 1 90; 0 2 1 -90; -90 0 1 -90; 0 1 0 90; 0 0 0 -90; 0 1 0 0"

PARALLEL = [
    (1.2603656866744277, 0.0, 0.3, -H),
    (0.0, 0.0, 0.3, H),
    (-1.9359248319902347, 0.0, 0.3, H),
    (-2.1663299899221236, 0.0, -0.2, 2.0882619294067917),
    (-1.8901278765367486, 0.0, 0.1, np.pi),
    (0.0, 0.0, 0.3, np.pi),
]
"""Axes 4, 5, 6 are parallel, and axes 1 and 2 may line up with them."""


def anywhere(robot, Ts):
    return robot.ik_batch(Ts, within_limits=False)


def in_degrees(text):
    """Rows of theta, d, a, alpha, angles in degrees."""
    rows = [[float(cell) for cell in row.split()] for row in text.split(";")]
    return [(np.radians(t), d, a, np.radians(alpha)) for t, d, a, alpha in rows]


def judged(rows, convention, q):
    """The tally of configurations q (m, 6) of a table."""
    table, tally = DHTable(tuple(DHRow(*row) for row in rows), convention), Tally("listed")
    judge(tally, table, np.atleast_2d(q), anywhere)
    return tally


@pytest.mark.parametrize("noise", [0.0, 1e-12, 1e-9, 1e-7, 1e-5, 1e-3])
def test_a_stretched_arm_in_line_with_its_last_axis_keeps_its_configuration(noise):
    """Three parallel axes, axis 5 in line with them and the pose on a rim."""
    q = np.radians([-90, -90, -115.6475, -90, -6.3789, 90])
    beside = noise * np.random.default_rng(0).standard_normal((10, 6))
    assert judged(in_degrees(FOLDED), "modified", q + beside).failures() == []


@pytest.mark.parametrize("noise", [0.0, 1e-12, 1e-9, 1e-7, 1e-5, 1e-3])
def test_an_elbow_folded_with_the_wrist_centre_on_axis_1_keeps_its_configuration(noise):
    """A wrist, axis 1 through its centre, and the elbow folded."""
    q = np.radians([90, 153.473, 180, 90, -90, -141.409])
    beside = noise * np.random.default_rng(0).standard_normal((10, 6))
    assert judged(in_degrees(ELBOW), "standard", q + beside).failures() == []


@pytest.mark.parametrize(
    "q",
    [
        (np.pi, np.pi, np.pi, -H, np.pi, 0.0),
        (0.158101, np.pi, 0.252897, -0.293006, -0.764938, -0.99627),
        (np.pi, np.pi, -H, np.pi, 0.0, H),
    ],
)
def test_where_outer_axes_line_up_a_configuration_is_found_or_on_a_family(q):
    """Three parallel axes of a random structured table."""
    assert judged(PARALLEL, "modified", q).failures() == []


def three_parallel(seed):
    """A random structured table with three neighbouring parallel axes."""
    rng, table = np.random.default_rng(seed), random_tables(1, seed)[0]
    rows, first = list(table.rows), int(rng.integers(4)) + (table.convention == "modified")
    for i in (first, first + 1):
        length, twist = rng.choice([0.1, 0.2, 0.3, 0.5]), rng.choice([0.0, np.pi])
        rows[i] = replace(rows[i], a=float(length), alpha=float(twist))
    return replace(table, rows=tuple(rows))


@pytest.mark.parametrize("tables", [12, pytest.param(300, marks=pytest.mark.exhaustive)])
def test_random_tables_of_parallel_axes_have_answers_at_structured_poses(tables):
    """No pose without one, regular configurations all found, families walked."""
    tally = Tally("three parallel, exact")
    for seed in range(tables):
        table = three_parallel(seed)
        try:
            name = str(dh2urdf.Robot.from_dh(table).solver)
        except NoSolverError:
            continue
        if "three parallel" in name:
            q = structured_configurations(arm_of(table), 20, seed)
            judge(tally, table, q, anywhere)
    print("\n" + tally.line())
    for fault in ("no answer", "regular lost", "wrong", "twice"):
        assert tally.count[fault] == 0, tally.notes
    assert tally.count["singular lost"] <= 0.02 * tally.count["singular"], tally.notes
