"""Arms whose axes 1, 2 and 3 are parallel where their direction is that of axis 5, too."""

import importlib
import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

plane = importlib.import_module("dh2urdf.kernels.parallel_axes.plane")


def seen_after_joint_4(alpha, t4):
    """The direction of axis 3 in frame 4: turned back by the twists and by joint 4."""
    x, y, z = 0.0, math.sin(alpha[2]), math.cos(alpha[2])
    x, y = math.cos(t4) * x + math.sin(t4) * y, math.cos(t4) * y - math.sin(t4) * x
    c, s = math.cos(alpha[3]), math.sin(alpha[3])
    return np.array([x, c * y + s * z])


@pytest.mark.parametrize("c4", [1.0, -1.0])
@pytest.mark.parametrize("e", [1e-3, -0.4, 1.3])
def test_the_common_direction_leaves_axis_5_as_joint_4_turns(c4, e):
    """What it has across axis 5 is what the turn by e adds, by the product of rotations."""
    alpha = np.random.default_rng(3).uniform(-2.0, 2.0, 6)
    form = np.full((6, 5), 9.0)
    form[:, 1], form[:, 2] = np.cos(alpha), np.sin(alpha)
    start = 0.0 if c4 > 0.0 else math.pi
    added = seen_after_joint_4(alpha, start + e) - seen_after_joint_4(alpha, start)
    np.testing.assert_allclose(plane._common_direction(form, c4, e), added, atol=1e-15)


@pytest.mark.parametrize("seed", range(4))
def test_levels_are_those_of_the_arm_at_every_angle_of_joint_4(seed):
    """Height and slope along the common axes, by rotations about x and z."""
    rng = np.random.default_rng(seed)
    a, d, alpha = rng.uniform(-1.0, 1.0, (3, 6))
    form = np.column_stack([a, np.cos(alpha), np.sin(alpha), d])
    D, t4 = rng.uniform(-1.0, 1.0, (3, 4)), rng.uniform(-3.0, 3.0)
    rise, slope = np.empty((2, 3))
    plane.levels(form, D, rise, slope)
    to_4 = _about("x", alpha[2]) @ _about("z", t4)
    axis_5 = (to_4 @ _about("x", alpha[3]))[2, 2]
    height = d[:3].sum() + math.cos(alpha[2]) * d[3] + to_4[2, 0] * a[3] + axis_5 * d[4]
    by_joint_4 = 1.0, math.cos(t4), math.sin(t4)
    assert math.isclose(rise @ by_joint_4, D[2, 3] - height, abs_tol=1e-14)
    assert math.isclose(slope @ by_joint_4, D[2, 2] - math.cos(alpha[4]) * axis_5, abs_tol=1e-14)


def _about(axis, angle):
    return Rotation.from_euler(axis, angle).as_matrix()
