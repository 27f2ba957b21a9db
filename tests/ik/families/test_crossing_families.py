"""Families of wrists: whole round an axis that is missed by rounding, and where two of them cross.

A slide at zero leaves joint 2 of the Stanford arm free. At one of its angles axes 4 and 6 are in
line, and joints 4 and 6 turn without it: another family, with one member in common.
"""

from dataclasses import replace

import numpy as np
import pytest
from dh_arm import arm_of
from ik_referee import forward, residuals
from self_motions import on_family, walks_to
from structured import rounded
from sweep import Tally, judge

import dh2urdf

H = np.pi / 2


def notes(table, q):
    """What a referee says of the solutions of the poses of configurations (m, n)."""
    tally = Tally(table.name)
    judge(tally, table, np.atleast_2d(q), lambda r, Ts: r.ik_batch(Ts, within_limits=False))
    return tally.notes


@pytest.mark.parametrize("noise", [0.0, 1e-11, 1e-10, 1e-9])
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_wrist_in_line_on_a_family_of_joint_2_is_a_family_of_its_own(side, noise):
    """It is named, and holds any turn of joints 4 and 6."""
    rng, table = np.random.default_rng(1), dh2urdf.load_table("stanford")
    q = np.zeros((6, 6))
    q[:, 1], q[:, 4] = side * H, 0.0
    q[:, 3], q[:, 5] = rng.uniform(-3.0, 3.0, (2, 6))
    q += noise * rng.standard_normal(q.shape)
    assert notes(table, q) == []


@pytest.mark.parametrize(
    ("name", "q"),
    [
        (
            "kuka_kr6_r700",
            (5.1e-10, 1.5707963260011528, 5.1e-11, -7.1e-11, 4.1061773834182753e-10, H),
        ),
        ("vx300s", (-3.1415926467149475, -1.5707963192145122, H, 1.66e-9, 1.57079631946, H)),
    ],
)
def test_an_axis_missed_by_less_than_half_of_what_is_accepted_is_turned_about(name, q):
    """All the way round the pose is accepted: one family, and no solution is left out of it."""
    table = dh2urdf.load_table(name)
    assert notes(table, q) == []


@pytest.mark.parametrize("decimals", [None, 4, 9])
def test_a_slide_near_zero_of_rounded_angles_loses_no_solution(decimals):
    """Four position solutions within a thousandth of each other, which a quartic says little of."""
    table = rounded(dh2urdf.load_table("stanford"), decimals)
    rng = np.random.default_rng(5)
    q = rng.uniform(-3.0, 3.0, (12, 6))
    q[:, 1] = np.where(q[:, 1] > 0.0, H, -H) + 1e-5 * rng.standard_normal(12)
    q[:, 2] = 10.0 ** rng.uniform(-5.0, -2.5, 12) * rng.choice((-1.0, 1.0), 12)
    assert notes(table, q) == []


@pytest.mark.parametrize("decimals", [None, 4, 9])
@pytest.mark.parametrize(
    ("lengths", "q"),
    [
        (  # the wrist centre 8e-7 m from axis 2, of which joint 1 alone comes no nearer
            {0: {"d": 0.58, "a": 0.1}, 1: {"d": 0.11}, 5: {"d": 0.21}},
            "-1.570795992689485 1.570795123261662 8.432998331509622e-07 "
            "1.832595876713885 2.094393617526178 1.83259587604543",
        ),
        (  # on it, with the wrist in line where joint 2 is at rest
            {0: {"d": 0.3}, 1: {"d": 0.13}, 2: {"alpha": H}, 5: {"d": 0.33}},
            "1.5707963270573557 -1.5707963274595282 5.632247615960988e-10 "
            "1.5707963263027187 1.5707963272437029 3.1415926539061716",
        ),
    ],
)
def test_a_wrist_centre_next_to_axis_2_loses_no_solution(lengths, q, decimals):
    """Whether that is a family or four solutions, what the configuration is on is found."""
    table = dh2urdf.load_table("stanford")
    rows = [replace(row, **lengths.get(i, {})) for i, row in enumerate(table.rows)]
    table = rounded(replace(table, rows=tuple(rows)), decimals)
    assert notes(table, [float(x) for x in q.split()]) == []


@pytest.mark.parametrize("decimals", [None, 9])
def test_five_joints_keep_a_family_of_each_elbow(decimals):
    """Axis 5 along axis 1, but for what rounding leaves: neither family has a member at rest."""
    assert notes(rounded(dh2urdf.load_table("vx300"), decimals), (-H, H, H, H, -H)) == []


def test_the_referee_arrives_at_a_configuration_that_is_accepted_and_beside_the_curve():
    """Joints 4 and 6 turned from a solution, the others as they are, keep the pose to 1e-9."""
    arm = arm_of(dh2urdf.load_table("vx300s"))
    q = np.array([1.5707963318357006, -1.95e-8, np.pi, np.pi, 4.616639767175981e-10, -H])
    T, free = forward(arm, q), np.array([False, False, False, True, False, True])
    p = q.copy()
    p[3:] = 0.0, -q[4], H  # the other wrist, as exact
    assert residuals(arm, p, T) < 1e-14
    assert on_family(arm, p, q, T, free, 1e-6)
    assert not walks_to(arm, p, q + np.array([0, 1e-3, 0, 0, 0, 0]), T, free, 1e-6)
