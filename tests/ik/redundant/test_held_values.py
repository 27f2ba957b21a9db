"""Seven joints with one held: a value for all poses, or one for each, is the same problem."""

import numpy as np
import pytest
from dh_product import rows
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from ik_checks import away_but_free
from ik_referee import by_pinocchio, exists, misses, rows_of
from margins import assert_margin

from dh2urdf import Robot
from dh2urdf.dh import DHConvention, DHRow, DHTable, JointType
from dh2urdf.exceptions import NoSolverError


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


SPECIAL = [("kuka_iiwa7", j, v) for j in (1, 3, 5) for v in (0.0, np.pi)] + [("franka_fer", 3, 0.0)]
"""Joints and values at which two axes line up, or a shoulder meets a wrist."""


def lost(robot, found, Q):
    """Distances (m,) of configurations from the solutions of their poses, free joints left out."""
    rows = [slice(count) for count in found.count]
    some = [(found.q[i, k], found.free_mask[i, k]) for i, k in enumerate(rows)]
    away = [away_but_free(robot.chain, *pair, q) for pair, q in zip(some, Q, strict=True)]
    return np.array(away)


@pytest.mark.parametrize(("name", "joint", "value"), SPECIAL)
def test_a_held_value_that_lines_axes_up_loses_no_configuration(name, joint, value):
    """What is left has a joint to spare: each solution names the joints of its family.

    The configuration that made the pose is a member, and as a seed it comes first.
    """
    robot = Robot.from_dh(name)
    Q = np.random.default_rng(joint).uniform(-np.pi, np.pi, (20, 7))
    Q[:, joint] = value
    Ts = robot.fk(Q)
    found = robot.ik_batch(Ts, locked={joint: value}, within_limits=False)
    assert (found.count > 0).all()
    assert (found.free_mask[exists(found)] != 0).all()
    assert not (found.free_mask >> joint & 1).any()
    assert_margin(lost(robot, found, Q), 1e-6)
    for T, q in zip(Ts[:5], Q, strict=False):
        near = robot.ik(T, seed=q, locked={joint: value}, within_limits=False)
        assert_margin(np.abs(near.q[0] - q).max(), 1e-6)


@pytest.mark.parametrize(("name", "joint", "value"), SPECIAL)
def test_a_special_value_does_not_end_a_batch(name, joint, value):
    """Poses at other values have what they have without it, and it has what it has alone."""
    robot = Robot.from_dh(name)
    Q = np.random.default_rng(9).uniform(-np.pi, np.pi, (12, 7))
    Q[::3, joint] = value
    Ts = robot.fk(Q)
    batch = robot.ik_batch(Ts, locked={joint: Q[:, joint]}, within_limits=False)
    for i, (T, q) in enumerate(zip(Ts, Q, strict=True)):
        alone = robot.ik(T, locked={joint: q[joint]}, within_limits=False)
        assert np.array_equal(batch[i].q, alone.q)
        assert batch[i].free_joints == alone.free_joints


LINING_UP = {
    ("franka_fer", 1): [-np.pi, 0.0, np.pi],
    ("franka_fer", 3): [0.0, 2.0 * np.arctan2(0.316, 0.0825)],
    ("kuka_iiwa14", 5): [-np.pi, 0.0, np.pi],
    **{("franka_fer", joint): [] for joint in (2, 4, 5, 6)},
    **{("kuka_iiwa14", joint): [] for joint in (0, 2, 4, 6)},
}
"""Held joints and the values that line two of the other axes up, or put them into one plane."""


@pytest.mark.parametrize(("name", "joint"), LINING_UP)
def test_the_values_that_line_axes_up_are_all_found_and_no_others(name, joint):
    """Each is found to the distance within which the rank decides."""
    found = Robot.from_dh(name).solver_for(locked={joint: 0.4}).values
    assert np.sort(found) == pytest.approx(LINING_UP[name, joint], abs=1e-4)


@pytest.mark.parametrize("gap", [1e-7, 1e-8, 1e-9, 6e-10, 3e-10, 2e-10, 1e-10, 1e-11, 1e-13])
def test_beside_a_special_value_no_configuration_is_lost(gap):
    """A little away from it, what tells joints 1 and 3 apart is known to rounding over the gap."""
    robot = Robot.from_dh("kuka_iiwa7")
    Q = np.random.default_rng(7).uniform(-np.pi, np.pi, (40, 7))
    Q[:, 1] = gap
    found = robot.ik_batch(robot.fk(Q), locked={1: gap}, within_limits=False)
    rounding = 1e-14 / gap if gap > 4e-10 else 1e-4
    assert np.quantile(lost(robot, found, Q), 0.9) < rounding


RIGHT_ANGLES = st.sampled_from([0.0, 0.5 * np.pi, -0.5 * np.pi, np.pi])
SQUARE_ROWS = st.tuples(RIGHT_ANGLES, *(st.sampled_from([0.0, 0.2, 0.3]),) * 2, RIGHT_ANGLES)


@settings(max_examples=20)
@given(st.lists(SQUARE_ROWS, min_size=7, max_size=7), st.integers(0, 6), RIGHT_ANGLES)
def test_right_angles_held_in_square_arms_lose_no_configuration(rows, joint, value):
    """Any joint of seven with twists of 90 degrees may be held at any multiple of them."""
    robot = Robot.from_dh(DHTable.from_array(rows, "standard", "theta d a alpha"))
    Q = np.random.default_rng(1).uniform(-np.pi, np.pi, (3, 7))
    Q[:, joint] = value
    try:
        found = robot.ik_batch(robot.fk(Q), locked={joint: value}, within_limits=False)
    except NoSolverError as error:  # nearly all axes are one
        assume("joints to spare; hold some" not in str(error))
        raise
    assert_margin(lost(robot, found, Q), 1e-6, 1)


def test_a_value_that_no_solver_covers_is_searched_in_a_batch():
    """Four joints to spare at one value: an error alone, families that are found in a batch."""
    rows = [(0, 0.3, 0, 0.5 * np.pi), (0, 0, 0, 0.5 * np.pi), *[(0, 0.2, 0, 0)] * 4]
    robot = Robot.from_dh(DHTable.from_array(rows, "standard", "theta d a alpha"))
    Q = np.random.default_rng(2).uniform(-np.pi, np.pi, (3, 6))
    Q[1, 1] = np.pi
    with pytest.raises(NoSolverError):
        robot.ik(robot.fk(Q[1]), locked={1: np.pi}, within_limits=False)
    found = robot.ik_batch(robot.fk(Q), locked={1: Q[:, 1]}, within_limits=False)
    assert_margin(lost(robot, found, Q), 1e-6)


@pytest.mark.parametrize("name", ["wx250s", "denso_vs6556", "abb_irb140", "stanford"])
def test_a_position_whose_middle_joint_of_three_is_free_is_a_family_that_a_seed_enters(name):
    """With joint 5 straight, joint 4 does not move the tool's origin: a root of multiplicity four.

    Three joints are held at where they are, so that joints 4 and 5 and one before them are left.
    """
    robot, rng = Robot.from_dh(name), np.random.default_rng(0)
    for _ in range(25):
        q = rng.uniform(*robot.bounded(1.0, np.pi))
        right = ~robot.slides & (rng.random(6) < 0.4)
        q = np.where(right, np.round(q / (np.pi / 2)) * np.pi / 2, q)
        q[4] = 0.0
        moving = {3, 4, int(rng.choice([0, 1, 2]))}
        held = {k: q[k] for k in range(6) if k not in moving}
        found = robot.ik(robot.fk(q), seed=q, locked=held, task="position", within_limits=False)
        assert np.abs(found.q - q).max(axis=1).min() < 1e-6
