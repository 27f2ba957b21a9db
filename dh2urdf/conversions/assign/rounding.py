"""Rounding of computed numbers to the ones they were meant to be, within rounding error."""

import math

import numpy as np

from dh2urdf import transforms as tf
from dh2urdf.dh import Origin
from dh2urdf.transforms import Array

STEP = math.pi / 12
"""Angles are drawn to multiples of 15 degrees."""

ANGLE = 1e-14
"""Rounding error of an angle that went through a few dozen matrix products [rad]."""

ULPS = 8
"""Rounding error of a length, in units of the last digit of the arm's size."""


def near_angle(angle: float, tolerance: float) -> float:
    """The multiple of 15 degrees within the tolerance [rad], or the angle itself."""
    k = round(angle / STEP)
    target = k * STEP if k % 6 else (k // 6) * (math.pi / 2)
    return target + 0.0 if abs(angle - target) <= tolerance else angle


def tidy_angle(angle: float) -> float:
    """The angle [rad] without rounding error, if it is a multiple of 15 degrees."""
    return near_angle(math.pi if angle == -math.pi else angle, ANGLE)


def tidy_length(length: float, size: float) -> float:
    """The shortest decimal that is the length [m] within the last digits of the arm's size [m]."""
    tolerance = ULPS * float(np.spacing(max(abs(length), size)))
    for digits in range(13):
        short = round(length, digits)
        if abs(short - length) <= tolerance:
            return short + 0.0
    return length


def tidy_origin(T: Array, size: float) -> Origin:
    """A rigid step with both kinds of rounding error taken off."""
    x, y, z = (tidy_length(float(v), size) for v in T[:3, 3])
    roll, pitch, yaw = (tidy_angle(v) for v in tf.matrix_to_rpy(T))
    return Origin((x, y, z), (roll, pitch, yaw))
