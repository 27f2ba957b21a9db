"""Axes 2, 3, 4 parallel, and 5 and 6 anyhow: height and slope are equations in joints 1 and 5."""

import numpy as np

from dh2urdf.lessons.circle import Linear
from dh2urdf.lessons.notation import Given
from dh2urdf.lessons.parallel_outer import Outer, coefficients
from dh2urdf.lessons.parallel_plane import beside
from dh2urdf.lessons.steps import Step
from dh2urdf.lessons.way import Asked
from dh2urdf.transforms import Array


def first_and_fifth(asked: Asked, point: Array) -> tuple[Outer, Step]:
    """Both equations in theta_1 and theta_5, with o_c (3,) in frame 0."""
    one, four, five = (asked.arm.rows[i] for i in (0, 3, 4))
    z, aside, f = asked.H[:3, 2], beside(asked), np.array([0.0, four.sa, four.ca])
    x_c, y_c, z_c = (float(v) for v in point)
    r_13, r_23, r_33 = (float(v) for v in z)
    given: Given = {"x_c": x_c, "y_c": y_c, "z_c": z_c, "d_1": one.d, "b": float(aside.value)}
    given = {**given, "r_13": r_13, "r_23": r_23, "r_33": r_33, "alpha_1": one.alpha}
    given = {**given, "alpha_4": four.alpha, "alpha_5": five.alpha}
    level = float(aside.value) - (z_c - one.d) * one.ca
    height = Linear("theta_1", -y_c * one.sa, x_c * one.sa, level)
    slope = Linear("theta_1", -r_23 * one.sa, r_13 * one.sa, four.ca * five.ca - r_33 * one.ca)
    formulas = (
        "-y_c sin(alpha_1)",
        "x_c sin(alpha_1)",
        "b - (z_c - d_1) cos(alpha_1)",
        "-r_23 sin(alpha_1)",
        "r_13 sin(alpha_1)",
        "cos(alpha_4) cos(alpha_5) - r_33 cos(alpha_1)",
    )
    equations = (aside, *coefficients(height, slope, formulas, given))
    words = (
        "The common direction k of axes 2, 3, 4 is (sin(alpha_1) sin(theta_1), -sin(alpha_1) "
        "cos(theta_1), cos(alpha_1)): theta_1 turns it. Seen from frame 4 it is f = (0, "
        "sin(alpha_4), cos(alpha_4)). Go along k from o_0 to o_c: the offsets make b, and theta_5 "
        "adds a_5 f_y sin(theta_5), which has to be n_1 = k^T (o_c - d_1 e_3) - b = A_1 "
        "cos(theta_1) + B_1 sin(theta_1) - C_1. Axis 6 leans against k by k^T R e_3: "
        "-sin(alpha_5) f_y cos(theta_5) has to be n_2 = k^T R e_3 - cos(alpha_4) cos(alpha_5) = "
        "A_2 cos(theta_1) + B_2 sin(theta_1) - C_2."
    )
    outer = Outer(0, height, slope, lambda _: f, "shoulder")
    return outer, Step("Height and slope", words, equations)
