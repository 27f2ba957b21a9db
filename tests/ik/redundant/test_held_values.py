"""Seven joints with one held: a value for all poses, or one for each, is the same problem."""

import numpy as np
import pytest
from dh_product import rows
from ik_referee import by_pinocchio, exists, misses, rows_of
from margins import assert_margin

from dh2urdf import Robot
from dh2urdf.dh import DHConvention, DHRow, DHTable, JointType


@pytest.mark.parametrize(
    ("name", "joint"),
    [("franka_fer", 6), *(("kuka_iiwa14", j) for j in (0, 2, 4, 6)), ("kinova_gen3", 2)],
)
def test_one_value_for_all_and_one_for_each_agree(name, joint):
    """Poses of a block with equal held values have the solutions that they have by themselves.

    In the other batch every second pose has another value, so that its blocks have no value in
    common; the poses at the first value are looked at.
    """
    robot = Robot.from_dh(name)
    Q = np.random.default_rng(joint).uniform(-2.5, 2.5, (200, 7))
    Q[:, joint] = 0.4
    Ts = robot.fk(Q)
    alike = robot.ik_batch(Ts, locked={joint: 0.4}, within_limits=False)
    values = np.full(200, 0.4)
    values[1::2] = -0.3
    mixed = robot.ik_batch(Ts, locked={joint: values}, within_limits=False)
    assert np.array_equal(alike.count[::2], mixed.count[::2])
    # Near a fold both are off by rounding over the smallest singular value.
    apart = np.abs(alike.q - mixed.q)[::2][exists(alike)[::2]].max(axis=1)
    assert_margin(apart, 1e-9, quantile=0.99)
    assert_margin(misses(robot.chain, alike, Q), 1e-6)
    found, owner = rows_of(alike)
    assert_margin(np.abs(by_pinocchio(robot, found) - Ts[owner]), 1e-12)


WRIST_LAST = rows(".1 0 90; .1 .4 10; .05 .03 80; .4 0 -90; 0 0 90; .1 0 0")
WRIST_FIRST = rows(".3 0 90; 0 0 -90; .4 .05 80; .02 .3 15; .1 0 90; .2 .1 30")
"""Six turning joints with a spherical triple and axes that meet at the other end: d, a [m], alpha
[deg]."""


def with_a_seventh(rows, place, kind):
    """The six joints and one more, before them or behind them."""
    six = [DHRow(theta=0.1 * i, d=d, a=a, alpha=np.deg2rad(w)) for i, (d, a, w) in enumerate(rows)]
    six.insert(place, DHRow(theta=0.2, d=0.15, a=0.07, alpha=1.1, joint_type=kind))
    return Robot.from_dh(DHTable(tuple(six), DHConvention.STANDARD, name="seven"))


@pytest.mark.parametrize("kind", [JointType.REVOLUTE, JointType.PRISMATIC])
@pytest.mark.parametrize("place", [0, 6])
@pytest.mark.parametrize("rows", [WRIST_LAST, WRIST_FIRST])
def test_a_joint_held_at_either_end_of_a_spherical_arm(rows, place, kind):
    """A turn or a slide before or behind an arm with its triple at either end takes any value.

    Among the values are turns far beyond a revolution. All solutions reach their pose at their
    value, as many as with one value a call, and the generating configuration is one of them.
    """
    robot = with_a_seventh(rows, place, kind)
    rng = np.random.default_rng(place)
    Q = rng.uniform(-2.5, 2.5, (100, 7))
    Q[::9, place] *= 1e4 if kind is JointType.REVOLUTE else 1.0
    Ts = np.array([robot.fk(q) for q in Q])
    batch = robot.ik_batch(Ts, locked={place: Q[:, place]}, within_limits=False)
    assert (batch.count >= 2).all()
    found, owner = rows_of(batch)
    assert (found[:, place] == Q[owner, place]).all()
    assert_margin(np.abs(by_pinocchio(robot, found) - Ts[owner]).max(axis=(1, 2)), 1e-11)
    assert_margin(misses(robot.chain, batch, Q), 1e-7)
    alone = [
        robot.ik(T, locked={place: q[place]}, within_limits=False).q
        for T, q in zip(Ts, Q, strict=True)
    ]
    assert_margin(np.abs(np.concatenate(alone) - found), 1e-9)
