"""Elbows held nearly straight: what is left turns about the arm's line, on curves of its own."""

import numpy as np
import pytest
from dh_arm import arm_of
from ik_referee import forward, residuals
from self_motions import on_curve
from structured import rounded
from sweep import Tally, judge

import dh2urdf
from dh2urdf.ik.redundant.special_values import HeldAtAnyValue


@pytest.mark.parametrize("poses", [8, pytest.param(200, marks=pytest.mark.exhaustive)])
@pytest.mark.parametrize("size", [0.0, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-3, 0.5])
def test_an_elbow_held_nearly_straight_loses_no_configuration(size, poses):
    """The joints whose parts in the family are as small as the angle of the elbow are named too."""
    table = dh2urdf.load_table("kuka_iiwa7")
    q = np.random.default_rng(0).uniform(-2, 2, (poses, 7))
    q[:, 3] = size * np.random.default_rng(1).uniform(0.3, 3.0, poses)
    tally = Tally(f"elbow held at {size:g}")

    def held(robot, Ts):
        return robot.ik_batch(Ts, within_limits=False, locked={3: q[:, 3]})

    judge(tally, table, q, held, held=(3,))
    print("\n" + tally.line())
    assert tally.failures() == []


FOLDED = [
    (size, joint) for size in (0.0, 1e-12, 1e-9, 3e-9, 1e-7, 1e-4) for joint in (0, 1, 2, 4, 6)
]


@pytest.mark.parametrize(("size", "joint"), FOLDED)
def test_an_elbow_folded_onto_the_shoulder_has_answers(joint, size):
    """The centre of the wrist is then on that of the shoulder, and says nothing of the elbow."""
    arm, robot = arm_of(dh2urdf.load_table("kuka_iiwa7")), dh2urdf.Robot.from_dh("kuka_iiwa7")
    rng = np.random.default_rng(2)
    q = rng.uniform(-2, 2, (3, 7))
    q[:, 3] = np.pi + size * rng.standard_normal(3)
    Ts = forward(arm, q)
    batch = robot.ik_batch(Ts, within_limits=False, locked={joint: q[:, joint]})
    assert batch.count.min() > 0
    for i, T in enumerate(Ts):
        assert residuals(arm, batch.q[i, : batch.count[i]], T).max() <= 1e-9


@pytest.mark.parametrize("joint", [0, 1, 2, 4, 6])
@pytest.mark.parametrize("size", [1e-9, 1e-8, 1e-7, 1e-6])
def test_all_branches_of_an_elbow_nearly_folded_come_from_equations(joint, size, monkeypatch):
    """Lengths are compared as differences, for their squares differ by less than rounding."""
    monkeypatch.setattr(HeldAtAnyValue, "_look_wider", lambda *_, **__: None)  # no search
    table, rng = dh2urdf.load_table("kuka_iiwa7"), np.random.default_rng(3)
    q = rng.uniform(-2, 2, (5, 7))
    q[:, 3] = np.pi + size * rng.uniform(0.5, 2.0, 5)
    tally = Tally("nearly folded")

    def held(robot, Ts):
        batch = robot.ik_batch(Ts, within_limits=False, locked={joint: q[:, joint]})
        assert batch.count.tolist() == [8] * 5
        assert batch.residual.max() <= 1e-13
        return batch

    judge(tally, table, q, held, held=(joint,))
    for fault in ("singular lost", "regular lost", "wrong", "twice", "no family"):
        assert tally.count[fault] == 0, fault


@pytest.mark.parametrize("decimals", [None, 9])
def test_of_an_elbow_held_folded_the_curve_that_is_named_has_the_configuration(decimals):
    """The referee follows the one curve on which the pose is kept to rounding, not weak ways."""
    table, tally = rounded(dh2urdf.load_table("kuka_iiwa7"), decimals), Tally("held folded")
    q = np.radians((0, 90, -45, -180, 0, -90, 90))
    q += (1.4e-9, 3.08e-8, -7.66e-9, -2.709e-8, -7.12e-8, -7.28e-8, -3.11e-8)

    def held(robot, Ts):
        return robot.ik_batch(Ts, within_limits=False, locked={3: q[3]})

    judge(tally, table, q[None], held, held=(3,))
    assert tally.failures() == []
    assert tally.count["singular lost"] == 0


def test_the_referee_tells_a_configuration_that_is_beside_that_curve():
    """Where the wrist's centre is elsewhere, next to the shoulder's, no curve leads."""
    arm = arm_of(dh2urdf.load_table("kuka_iiwa7"))
    q = np.radians((0, 90, -45, -180, 0, -90, 90)) + 3e-8
    other = q + np.array([0.3, 0.0, 0.0, 0.0, -0.3, 0.0, 0.0])
    free = np.arange(7) != 3
    assert on_curve(arm, q, q, forward(arm, q), free, 1e-6)
    assert not on_curve(arm, q, other, forward(arm, q), free, 1e-6)
