"""Poses as callers have them: rounded, in stacks of any shape, some of them none, none at all."""

import re

import numpy as np
import pinocchio as pin
import pytest
from dh_product import dh_frames
from hypothesis import given, settings
from hypothesis import strategies as st
from ik_referee import misses
from margins import assert_margin

from dh2urdf import Robot, transforms
from dh2urdf.exceptions import ArgumentError, ConfigurationError, PoseError

ARM = Robot.from_dh("puma560")
SEVEN = Robot.from_dh("franka_fer")
SEEDS = st.integers(0, 2**32 - 1)


def poses(m, seed=0):
    """Configurations (m, 6) and poses of them by the product of the table's rows."""
    q = np.random.default_rng(seed).uniform(ARM.lower, ARM.upper, (m, 6))
    return q, np.array([dh_frames(ARM.table, row)[-1] for row in q]).reshape(m, 4, 4)


def angle(R, S):
    """Angle between rotations, by Pinocchio's logarithm [rad]."""
    return np.linalg.norm(pin.log3(R.T @ S))


@settings(max_examples=100)
@given(SEEDS, st.integers(2, 9))
def test_no_rotation_is_nearer_than_the_nearest_one(seed, digits):
    """Of a rounded rotation: rigid to 1e-15, and every other rotation is farther in any norm."""
    R = poses(1, seed)[1][0, :3, :3]
    rounded = R.round(digits)
    got, change = transforms.nearest_rotation(rounded)
    # Some ten roundings of a singular value decomposition: 1e-14 has no factor of ten to give.
    assert_margin(np.abs(got.T @ got - np.eye(3)), 1e-14, 3)
    assert np.linalg.det(got) > 0
    assert change == pytest.approx(np.linalg.norm(got - rounded, 2), abs=1e-14)
    assert change <= 1.5 * 10.0**-digits
    rng = np.random.default_rng(seed)
    least = np.linalg.norm(got - rounded)
    for size in (1e-1, 1e-3, 1e-5):
        other = got @ pin.exp3(size * rng.normal(size=3))
        assert np.linalg.norm(other - rounded) > least


@pytest.mark.parametrize("shape", [(), (1,), (5,), (2, 3), (0,)])
@pytest.mark.parametrize("k", [3, 4])
def test_rotations_and_poses_of_any_stack_are_taken(shape, k):
    """(3, 3) and (4, 4), one or many: each is what it is alone; lengths stay."""
    many = poses(int(np.prod(shape, dtype=int)))[1].round(5)[:, :k, :k].reshape(*shape, k, k)
    got, change = transforms.nearest_rotation(many)
    assert got.shape == many.shape
    assert change.shape == shape
    for i in np.ndindex(shape):
        alone, far = transforms.nearest_rotation(many[i].tolist())
        assert np.array_equal(alone, got[i])
        assert far == change[i]
        assert np.array_equal(got[i][:3, 3:], many[i][:3, 3:])


FAR_OFF = {
    "a zero": np.zeros((3, 3)),
    "a mirror": np.diag([1.0, 1.0, -1.0]),
    "a scale": np.eye(3) * 1.06,
    "a shear": np.eye(3) + np.eye(3, k=1) * 0.2,
    "degrees": np.eye(3) * 57.3,
    "one decimal": np.array([[0.4, -0.9, 0], [0.9, 0.4, 0], [0.3, 0, 1]]),
    "NaN": np.full((3, 3), np.nan),
    "huge": np.eye(3) * 1e300,
    "a plane": np.diag([1.0, 1.0, 0.0]),
}


@pytest.mark.parametrize("kind", FAR_OFF)
def test_what_was_never_a_rotation_is_refused_even_then(kind):
    """Mirrors, scales and what is off by more than 0.05 have no nearest rotation."""
    T = np.eye(4)
    T[:3, :3] = FAR_OFF[kind]
    calls = (transforms.nearest_rotation, lambda T: ARM.ik(T, nearest=True))
    calls += (lambda T: ARM.ik_batch([T], nearest=True),)
    told = r"is \S+ away from the nearest rotation \(allowed 0\.05\)|reflection|NaN"
    for call in calls:
        with pytest.raises(PoseError, match=told) as caught:
            call(T)
        if "away" in str(caught.value):  # by how much: the largest singular value of R' - R
            U, _, Vt = np.linalg.svd(T[:3, :3])
            R = U @ np.diag([1.0, 1.0, np.linalg.det(U @ Vt)]) @ Vt
            away = float(re.search(r"is (\S+) away", str(caught.value))[1])
            assert away == pytest.approx(np.linalg.norm(R - T[:3, :3], 2), rel=0.06)
    with pytest.raises(PoseError):
        transforms.nearest_rotation(FAR_OFF[kind])


CALLS = {
    "ik": ARM.ik,
    "ik_batch": lambda T, **o: ARM.ik_batch([T, T], **o),
    "ik_path": lambda T, **o: ARM.ik_path([T, T], **o),
    "ik_numeric": ARM.ik_numeric,
    "why_unreachable": ARM.why_unreachable,
    "ik_intervals": SEVEN.ik_intervals,
}


@pytest.mark.parametrize("digits", [3, 4, 5, 6])
@pytest.mark.parametrize("call", CALLS)
def test_a_rounded_pose_is_refused_with_a_hint_and_taken_when_asked(call, digits):
    """Whatever takes a pose names nearest=True, and takes it then."""
    arm = SEVEN if call == "ik_intervals" else ARM
    T = arm.fk(0.9 * arm.lower + 0.1 * arm.upper).round(digits)
    T[0, 0] += 2e-6
    with pytest.raises(PoseError, match=r"orthonormal.*nearest=True.*--nearest.*nearest_rotation"):
        CALLS[call](T)
    assert not isinstance(CALLS[call](T, nearest=True), Exception)
    with pytest.raises(ArgumentError, match="nearest: expected True or False, got 1"):
        CALLS[call](T, nearest=1)


@settings(max_examples=50)
@given(SEEDS, st.integers(3, 6))
def test_the_nearest_pose_is_reached_and_how_far_it_was_is_told(seed, digits):
    """Solutions reach T, which is as near to the pose given as pose_change says."""
    q, (T,) = poses(1, seed)
    rounded = T.round(digits)
    found = ARM.ik(rounded, nearest=True, seed=q[0])
    assert angle(found.T[:3, :3], T[:3, :3]) < 2.0 * 10.0**-digits
    assert found.pose_change == pytest.approx(np.linalg.norm(found.T - rounded, 2), abs=1e-14)
    assert_margin([np.abs(dh_frames(ARM.table, row)[-1] - found.T).max() for row in found], 1e-9)
    for other in (found[:1], found.sorted_by(np.zeros(6)), found.select(np.arange(len(found)))):
        assert other.pose_change == found.pose_change
    many = ARM.ik_batch([rounded, T], nearest=True)
    assert many.pose_change[0] == many[0].pose_change == pytest.approx(found.pose_change, abs=1e-14)
    assert many.pose_change[1] < 1e-15
    assert ARM.ik_path([rounded], nearest=True).pose_change.shape == (1,)
    assert ARM.ik_numeric(rounded, nearest=True).pose_change == many.pose_change[0]


def test_a_pose_that_needs_nothing_is_changed_by_nothing():
    """Without nearest the change is exactly 0; with it solutions are the same to rounding."""
    _, Ts = poses(20)
    assert ARM.ik(Ts[0]).pose_change == 0.0
    plain, near = ARM.ik_batch(Ts), ARM.ik_batch(Ts, nearest=True)
    assert not plain.pose_change.any()
    assert np.array_equal(plain.count, near.count)


@pytest.mark.parametrize("empty", [[], (), np.empty((0, 4, 4)), np.empty((0, 4, 4), ">f4")])
def test_no_poses_have_no_solutions(empty):
    """Empty in, empty out: shapes that can be joined to those of others."""
    for arm, options in ((ARM, {}), (SEVEN, {"locked": {2: 0.1}}), (SEVEN, {})):
        batch = arm.ik_batch(empty, **options)
        assert batch.q.shape[0::2] == (0, arm.n)
        assert len(batch) == len(batch.count) == len(list(batch)) == 0
        assert batch.bad.shape == (0,)
        assert "0 poses" in repr(batch)
        path = arm.ik_path(empty, **options)
        assert path.q.shape == (0, arm.n)
        assert path.continuous
        assert path.motion == 0.0
        assert "0 poses" in str(path)


BAD = {
    "NaN": lambda T: T * np.nan,
    "one NaN": lambda T: T + np.where(np.arange(16).reshape(4, 4) == 7, np.nan, 0.0),
    "infinite": lambda T: T + np.where(np.arange(16).reshape(4, 4) == 3, np.inf, 0.0),
    "scaled": lambda T: T * [[1.1], [1.1], [1.1], [1.0]],
    "mirrored": lambda T: T * [-1.0, 1, 1, 1],
    "zero": np.zeros_like,
    "last row": lambda T: np.add(T, [[0.0], [0], [0], [1e-3]]),
}


@pytest.mark.parametrize("nearest", [False, True])
@pytest.mark.parametrize("where", [[0], [9], [4, 5, 9], list(range(10))])
@pytest.mark.parametrize("kind", BAD)
def test_bad_poses_of_a_batch_are_named_and_the_others_are_solved(kind, where, nearest):
    """skip: the bad ones are listed and have nothing, the others what they have alone."""
    _, Ts = poses(10)
    expected = ARM.ik_batch(Ts, nearest=nearest)
    given = Ts.copy()
    for i in where:
        given[i] = BAD[kind](Ts[i])
    before = given.copy()
    with pytest.raises(PoseError, match=rf"poses\[{where[0]}\]"):
        ARM.ik_batch(given, nearest=nearest)
    batch = ARM.ik_batch(given, on_bad="skip", nearest=nearest)
    assert batch.bad.tolist() == where
    assert np.array_equal(given, before, equal_nan=True)
    assert not batch.count[where].any()
    assert np.isnan(batch.q[where]).all()
    assert np.isnan(batch.residual[where]).all()
    assert (batch.branch_code[where] == -1).all()
    good = np.setdiff1d(np.arange(10), where)
    for key in ("q", "residual", "count", "branch_code", "free_mask", "targets"):
        a, b = getattr(batch, key)[good], getattr(expected, key)[good]
        assert np.array_equal(a, b, equal_nan=True)
    assert len(batch[where[0]]) == 0
    assert str(batch[where[0]]) == "no solution"


def test_one_bad_pose_among_many_costs_little():
    """The others of a large batch are solved, each as in the batch without it."""
    _, Ts = poses(3000)
    Ts[1234] = np.nan
    batch = ARM.ik_batch(Ts, on_bad="skip", threads=2)
    assert batch.bad.tolist() == [1234]
    assert batch.solved.sum() == 2999


def test_held_values_stay_with_their_poses_when_one_is_skipped():
    """A value for each pose, a bad pose between them: the values of the others do not shift."""
    rng = np.random.default_rng(1)
    q = rng.uniform(SEVEN.lower, SEVEN.upper, (40, 7))
    Ts = SEVEN.fk(q)
    Ts[2] = 0.0
    batch = SEVEN.ik_batch(Ts, locked={2: q[:, 2]}, on_bad="skip")
    assert batch.bad.tolist() == [2]
    assert_margin(np.delete(misses(SEVEN.chain, batch, q), 2), 1e-6)


@pytest.mark.parametrize("shape", [(6,), (2, 3), (1, 2, 3), (3, 0), (2, 1, 1, 3)])
def test_a_batch_has_the_leading_axes_of_its_poses(shape):
    """ik_batch takes what fk gives, and has the solutions in the same places."""
    q = np.random.default_rng(0).uniform(ARM.lower, ARM.upper, (*shape, 6))
    Ts = ARM.fk(q)
    batch = ARM.ik_batch(Ts)
    assert batch.q.shape == (*shape, ARM.solver.kmax, 6)
    assert batch.residual.shape == (*shape, ARM.solver.kmax)
    assert batch.count.shape == batch.solved.shape == batch.pose_change.shape == shape
    assert batch.targets.shape == Ts.shape
    for index in np.ndindex(shape):
        alone = ARM.ik(Ts[index])
        assert np.array_equal(batch.q[index][: batch.count[index]], alone.q)
        assert np.array_equal(batch[index].q, alone.q)
        row = batch
        for i in index:
            row = row[i]
        assert np.array_equal(row.q, alone.q)
    assert f"{int(np.prod(shape))} poses" in repr(batch)


def test_a_stack_is_no_path():
    """A path has an order: its poses stand in one row."""
    with pytest.raises(PoseError, match=r"expected shape \(m, 4, 4\)"):
        ARM.ik_path(ARM.fk(np.zeros((2, 3, 6))))


@pytest.mark.parametrize("shape", [(), (4,), (3, 3), (5, 3, 4), (4, 4, 1), (16,), (2, 16)])
def test_other_shapes_are_refused(shape):
    """What is no stack of (4, 4) is refused by its shape."""
    for call in (ARM.ik, ARM.ik_batch, ARM.ik_path, ARM.ik_numeric, ARM.why_unreachable):
        with pytest.raises(PoseError, match=r"shape|numbers"):
            call(np.zeros(shape))


@pytest.mark.parametrize("bad", ["", "ignore", None, 1, ["skip"], np.array(["skip"])])
def test_what_to_do_about_bad_poses_is_one_of_two_words(bad):
    """on_bad takes raise and skip."""
    with pytest.raises(ConfigurationError, match="on_bad: expected 'raise' or 'skip', got"):
        ARM.ik_batch([np.eye(4)], on_bad=bad)
