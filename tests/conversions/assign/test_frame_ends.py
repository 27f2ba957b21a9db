"""Frame 0 is a pose that leads to the first joint, however its axis lies to the base."""

import math

import numpy as np
import pytest

from dh2urdf import transforms as tf
from dh2urdf.conversions.assign.frame_ends import BaseChoice, first_frame, slide_turn
from dh2urdf.dh import DHConvention

AXES = {
    BaseChoice.BASE: tf.trans(0, 0, 0.1),
    BaseChoice.BESIDE: tf.trans(0.3, 0.2, 0.1),
    BaseChoice.TURNED: tf.trans(0.3, 0.2, 0.1) @ tf.rot_x(math.pi),
}


@pytest.mark.parametrize("choice", AXES)
def test_frame_0_leads_to_the_first_joint(choice):
    """On z, beside it, or against it: base, then a, alpha, theta and d are the joint's frame."""
    L = AXES[choice] @ tf.rot_z(0.4)
    start = first_frame(L, DHConvention.STANDARD, 1.0)
    assert start.choice is choice
    tf.check_pose(start.base, what="base")
    np.testing.assert_array_equal(start.base[3], [0, 0, 0, 1])
    X = tf.trans(start.a, 0, 0) @ tf.rot_x(start.alpha)
    np.testing.assert_allclose(start.base @ X @ slide_turn(start.phi, start.s), L, atol=1e-15)
