"""Rigid transforms against their definitions."""

import math

import numpy as np
import pinocchio as pin
import pytest
from dh_product import difference, rigid, turn
from hypothesis import given, settings
from hypothesis import strategies as st
from strategies import ANGLES

from dh2urdf import transforms as tf
from dh2urdf.exceptions import PoseError

NEAR_LOCK = st.sampled_from([0.0, 1e-16, 1e-12, 1e-9, 1e-8, 1e-4]).flatmap(
    lambda e: st.sampled_from([math.pi / 2 - e, -math.pi / 2 + e, math.pi / 2 + e])
)


@settings(max_examples=500)
@given(ANGLES, st.one_of(ANGLES, NEAR_LOCK), ANGLES)
def test_rpy_comes_back_at_every_pitch(roll, pitch, yaw):
    """Roll, pitch and yaw of a matrix make the same matrix to 4 ulp, gimbal lock included."""
    R = rigid((0, 0, 0), (roll, pitch, yaw))[:3, :3]
    assert difference(tf.rpy_to_matrix((roll, pitch, yaw)), R) < 5e-16
    assert difference(tf.rpy_to_matrix(tf.matrix_to_rpy(R)), R) < 9e-16


@given(st.lists(st.floats(-1, 1), min_size=3, max_size=3), ANGLES)
def test_inverse_and_angle(xyz, angle):
    """The inverse undoes a pose; the angle between poses is the turn between them."""
    T = rigid(xyz, (0.3, angle, -1.0))
    assert difference(tf.inverse(T) @ T, np.eye(4)) < 1e-15 * 3
    wrapped = abs(math.remainder(angle, 2 * math.pi))
    assert float(tf.rotation_angle(turn(1, angle)[:3, :3])) == pytest.approx(wrapped, abs=1e-15)


@pytest.mark.parametrize("angle", [1e-12, 1e-9, 1e-5, 3.1, math.pi])
def test_small_angles_are_not_lost(angle):
    """The angle of a rotation keeps its digits near zero."""
    axis = np.array([0.6, 0.0, 0.8])
    assert float(tf.rotation_angle(tf.rotation(axis, angle))) == pytest.approx(angle, rel=1e-9)


def test_poses_are_accepted_as_documented():
    """Arrays, nested lists, stacks and pin.SE3 pass; 1e-7 off orthonormal passes too."""
    T = rigid((1, 2, 3), (0.1, 0.2, 0.3))
    assert difference(tf.check_pose(T.tolist()), T) == 0
    assert difference(tf.check_pose(pin.SE3(T)), T) == 0
    assert tf.check_pose(np.stack([T, T])).shape == (2, 4, 4)
    slack = T.copy()
    slack[0, 0] += 1e-7
    assert difference(tf.check_pose(slack), slack) == 0


def scaled(T):
    T[:3, :3] *= 1.001
    return T


def mirrored(T):
    T[:3, 0] *= -1
    return T


@pytest.mark.parametrize(
    ("bad", "message"),
    [
        (np.eye(3), r"expected shape \(4, 4\)"),
        (np.full((4, 4), np.nan), "NaN"),
        (scaled(np.eye(4)), "not orthonormal"),
        (mirrored(np.eye(4)), "reflection"),
        (np.eye(4) + np.eye(4)[[3, 0, 1, 2]] * [[0], [0], [0], [1]], "last row"),
        ("text", "expected numbers"),
        (np.stack([np.eye(4), scaled(np.eye(4))]), r"\[1\]"),
    ],
)
def test_what_is_no_pose_is_refused(bad, message):
    """Each kind of bad pose has its message, with the index in a stack."""
    with pytest.raises(PoseError, match=message):
        tf.check_pose(bad)


@pytest.mark.parametrize("seed", range(20))
def test_the_quick_forms_for_few_numbers_have_the_bits_of_the_general_ones(seed):
    """A cross product is that of NumPy, a product of two matrices that of two stacks."""
    rng = np.random.default_rng(seed)
    A, B = rng.normal(size=(2, 4, 4)) * 10.0 ** rng.integers(-3, 4, (2, 4, 4))
    assert np.array_equal(tf.cross(A[0, :3], B[0, :3]), np.cross(A[0, :3], B[0, :3]))
    assert np.array_equal(tf.product(A, B), tf.product(A[None], B[None])[0])
    assert tf.dot(A[0], B[0]) == tf.dot(A, B)[0]


@pytest.mark.parametrize("shapes", [((4, 4), (4, 4)), ((5, 3, 2), (5, 2, 4)), ((4, 4), (6, 4, 4))])
def test_products_are_summed_from_the_first_term_to_the_last(shapes):
    """Whether or not the kernel takes the shapes; in any memory order."""
    rng = np.random.default_rng(0)
    a, b = (rng.normal(size=shape) for shape in shapes)
    expected = a[..., :, 0, None] * b[..., 0, None, :]
    for k in range(1, a.shape[-1]):
        expected = expected + a[..., :, k, None] * b[..., k, None, :]
    assert (tf.product(a, b) == expected).all()
    turned = np.swapaxes(np.ascontiguousarray(np.swapaxes(a, -1, -2)), -1, -2)
    assert (tf.product(turned, b) == expected).all()
