"""Short chains where singularities meet, and beside: no configuration is lost."""

import math
from dataclasses import replace

import numpy as np
import pytest
from dh_arm import arm_of
from ik_referee import forward, gaps, search
from structured import random_tables, rounded, structured_configurations
from sweep import Tally, judge

import dh2urdf
from dh2urdf.conversions.write.table_chain import dh_to_chain
from dh2urdf.dh import DHRow, DHTable
from dh2urdf.ik.families.short import ThreeSlides
from dh2urdf.kernels.shapes import Outputs

HALF, PI = math.pi / 2, math.pi


def table_of(rows, kinds="RRRRR", convention="modified"):
    """A table of rows theta, d, a, alpha."""
    names = {"R": "revolute", "P": "prismatic"}
    cells = zip(rows, kinds, strict=True)
    return DHTable(tuple(DHRow(*row, names[kind]) for row, kind in cells), convention)


CORNERS = {
    "a turning joint last": (
        table_of(
            [
                *((0, 0, 0, 0), (PI, 0, 0.1, PI), (0, 0, 0.5, 0), (0, 0, 0.1, HALF)),
                (HALF, 0.2, 0.2, HALF),
            ]
        ),
        np.radians([-90.0, -90.0, 108.3841, 180.0, -132.7996]),
    ),
    "a slide last": (
        table_of(
            [
                (-1.686194626129054, -0.2, 0, -HALF),
                (-0.16583647443612293, 0, 0.3, PI),
                *((0, 0, -0.2, 0), (0, 0, -0.2, HALF), (PI, 0, 0, -HALF)),
            ],
            "RRRRP",
        ),
        np.array([-HALF, PI, -HALF, -HALF, 0.3]),
    ),
}
"""Chains, and configurations at which every cut of their loop is singular [rad, m]."""


def anywhere(robot, Ts):
    return robot.ik_batch(Ts, within_limits=False)


def assert_nothing_is_lost(table, q):
    """All configurations q (m, n) are found or on a named family, and nothing is wrong."""
    tally = Tally("short")
    judge(tally, table, q, anywhere)
    kinds = ("regular lost", "singular lost", "no answer", "wrong")
    assert [note for note in tally.notes if note.startswith(kinds)] == []


@pytest.mark.parametrize("size", [0.0, 1e-12, 1e-10, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3])
@pytest.mark.parametrize("name", CORNERS)
def test_a_pose_that_is_singular_for_every_cut_of_the_loop_is_searched(name, size):
    """40 configurations off by ``size`` from where singularities of five joints meet."""
    table, corner = CORNERS[name]
    noise = np.random.default_rng(0).standard_normal((40, 5))
    assert_nothing_is_lost(table, corner + size * noise)


def test_four_solutions_side_by_side_stay_four():
    """Three lie nearly on a line: the middle of the outer ones is no sign that they are one."""
    table = table_of(
        [
            *((HALF, -0.1, 0, 0), (0, 0.4, 0.4, PI), (HALF, -0.1, 0.2, PI)),
            *((0, 0.2, 0.1, HALF), (HALF, 0, 0.1, PI)),
        ]
    )
    rows = list(table.rows)
    rows[3] = replace(rows[3], sign=-1)
    table = DHTable(tuple(rows), "modified")
    q = np.array([1.5701674972804236, 3.140343386034597, -3.1427606116427635, 0, 0])
    q[3:] = -1.572968743130338, 3.1418980742434166
    chain, T = dh_to_chain(table), forward(arm_of(table), q)
    found = dh2urdf.Robot.from_dh(table).ik(T, within_limits=False).q
    assert len(found) == 4
    for p in search(chain, T, 0, starts=200):
        assert gaps(chain, found, p).min() < 1e-6
    assert gaps(chain, found, q).min() < 1e-6


@pytest.mark.parametrize("decimals", [None, 4])
def test_corners_of_square_chains_of_five_joints_are_found(decimals):
    """All joints at quarter turns, of chains of right angles; exact and rounded tables."""
    rng = np.random.default_rng(7)
    for table in random_tables(24, seed=11, joints=5):
        robot = dh2urdf.Robot.from_dh(table)
        if robot.solver.name == "joints to spare":
            continue
        assert_nothing_is_lost(rounded(table, decimals), HALF * rng.integers(-2, 3, (12, 5)))


def test_a_pose_beside_a_corner_that_is_out_of_reach_has_no_solution():
    """A millimetre along the last axis of a chain that is singular for every cut."""
    table, corner = CORNERS["a turning joint last"]
    T = forward(arm_of(table), corner)
    T[:3, 3] += 1e-3 * T[:3, 2]
    assert not len(search(dh_to_chain(table), T, 0))
    assert not len(dh2urdf.Robot.from_dh(table).ik(T, within_limits=False))


def test_a_batch_with_poses_in_doubt_equals_single_calls():
    """Also within limits; the others of the batch stay as they are."""
    table, corner = CORNERS["a turning joint last"]
    robot, rng = dh2urdf.Robot.from_dh(table), np.random.default_rng(2)
    q = np.concatenate([corner[None], rng.uniform(-3, 3, (5, 5)), corner[None] + 1e-6])
    Ts = robot.fk(q)
    for inside in (True, False):
        batch = robot.ik_batch(Ts, within_limits=inside)
        for k, T in enumerate(Ts):
            assert np.array_equal(batch.q[k, : batch.count[k]], robot.ik(T, within_limits=inside).q)


@pytest.mark.parametrize("poses", [12, pytest.param(400, marks=pytest.mark.exhaustive)])
def test_a_chain_that_is_redundant_but_for_a_hair_loses_no_configuration(poses):
    """A slide in the plane of three parallel axes, 5e-6 rad off it, and one axis across."""
    axes = [
        *((0.0, 0.0, 0.0, -1.0, -2.4e-6, 4.1e-6), (0.0, -1.0, 0.0, 0.3, 0.0, 0.0)),
        *((0.0, -1.0, 0.0, 0.3, 0.0, -0.3), (0.0, -1.0, 0.0, 0.7, 0.0, -0.3)),
        (0.0, 0.0, 1.0, 0.1, -0.4, 0.0),
    ]
    home = np.eye(4)
    home[:3, 3] = 0.4, 0.1, 0.6
    table = dh2urdf.Robot.from_screws(axes, home).table
    assert_nothing_is_lost(table, structured_configurations(arm_of(table), poses, 0))
    anyhow = np.random.default_rng(0).uniform(-2.0, 2.0, (poses, 5))
    assert_nothing_is_lost(table, anyhow * np.array([0.2, 1.0, 1.0, 1.0, 1.0]))


def test_an_elbow_beside_its_fold_is_there_both_ways():
    """Up and down are 1e-5 rad apart; axes 5 and 6 are one line, and joint 6 is held at rest."""
    h = math.pi / 2
    rows = [(0, 0.24, 0, h), (0, 0, -0.73, 0), (0, 0, -0.54, 0), (0, 0.16, 0, h), (0, 0.16, 0, 0)]
    table = DHTable.from_array([*rows, (0, 0.07, 0, 0)], "standard", "theta d a alpha")
    q = [0.7854166940104598, 0.7854097538946704, -3.141587616426078, -4.802019773822565e-06]
    assert_nothing_is_lost(table, np.array([[*q, -1.5707929340229096, 2.356205897246559]]))


def test_poses_of_three_slides_are_searched_beside_singular_ones_alone():
    """Where two angles of the middle turning joint meet, or nearly; elsewhere equations say all."""
    rows = [(0.3, 0, 0.1, 0.4), (0.2, 0, 0.2, 1.3), (-0.5, 0, 0, -0.9), (0, 0.1, 0.2, 0.7)]
    table = table_of([*rows, (0, 0.2, 0, 1.1), (0, 0.1, 0.3, -1.2)], "PPPRRR")
    solver = ThreeSlides(dh_to_chain(table))
    q = np.tile([0.1, -0.2, 0.3, 0.5, 1.0, -0.7], (2, 1))
    q[1, 4] = 1e-6
    found = Outputs.of(2, solver.kmax, 6)
    doubts = solver.kernel(solver.constants, forward(solver.chain, q), False, found)
    assert doubts == 1
    assert found.counts[0] == 2
    assert found.counts[1] < 0
