"""Three parallel axes 1, 2, 3: joints 4 and 5 by height and slope, joint 6, then a planar arm."""

import math
from collections.abc import Iterator

import numpy as np

from dh2urdf.lessons.arm import Row
from dh2urdf.lessons.circle import Linear
from dh2urdf.lessons.notation import Given
from dh2urdf.lessons.parallel_outer import Outer, coefficients, last_turn, outer_joints
from dh2urdf.lessons.parallel_plane import before_last, bend_in_plane
from dh2urdf.lessons.steps import Step
from dh2urdf.lessons.way import Asked, Way
from dh2urdf.transforms import Array

UP = np.array([0.0, 0.0, 1.0])
"""The common direction k in frame 0."""


def fits(rows: tuple[Row, ...]) -> bool:
    """Whether rows are three parallel turns, axis 4 not parallel to them, and two more."""
    if len(rows) != 6 or any(row.slides for row in rows) or rows[2].sa == 0.0:
        return False
    return rows[0].sa == rows[1].sa == 0.0 and (rows[4].a != 0.0 or rows[4].sa != 0.0)


def first_parallel(asked: Asked) -> Iterator[Way]:
    """All ways of an arm with axes 1, 2, 3 parallel."""
    words = (
        "Axes 1, 2 and 3 are parallel: their three joints move things in planes across k = z_0, "
        "not along it, and leave as it is how a line leans against k. So how high a point of axis "
        "6 is along k, and how axis 6 leans, is due to joints 4 and 5 alone: two equations in two "
        "joints. These come first, then joint 6; the three are left with x, y and a direction: a "
        "planar arm of three links."
    )
    way = Way().then(Step("What decouples", words))
    point, step = before_last(asked)
    outer, told = _height_and_slope(asked, point)
    for turned in outer_joints(asked, way.then(step, told), outer):
        if turned.stopped:
            yield turned
        else:
            bent = last_turn(asked, turned, UP, outer.seen(turned.variables[3]))
            yield from bend_in_plane(asked, bent, 0)


def _height_and_slope(asked: Asked, point: Array) -> tuple[Outer, Step]:
    """Both equations in theta_4 and theta_5."""
    rows, lean = asked.arm.rows, float(asked.H[2, 2])
    three, four, five = rows[2:5]
    given: Given = {f"d_{i + 1}": row.d for i, row in enumerate(rows[:5])}
    given = {**given, "alpha_3": three.alpha, "alpha_4": four.alpha, "alpha_5": five.alpha}
    given = {**given, "a_4": four.a, "z_c": float(point[2]), "r_33": lean}
    turn, flat = three.sa * four.sa, three.ca * four.ca
    level = sum(row.d for row in rows[:3]) + three.ca * four.d + five.d * flat
    height = Linear("theta_4", five.d * turn, -four.a * three.sa, level - float(point[2]))
    slope = Linear("theta_4", five.ca * turn, 0.0, five.ca * flat - lean)
    formulas = (
        "d_5 sin(alpha_3) sin(alpha_4)",
        "-a_4 sin(alpha_3)",
        "d_1 + d_2 + d_3 + d_4 cos(alpha_3) + d_5 cos(alpha_3) cos(alpha_4) - z_c",
        "cos(alpha_5) sin(alpha_3) sin(alpha_4)",
        "0",
        "cos(alpha_5) cos(alpha_3) cos(alpha_4) - r_33",
    )
    equations = coefficients(height, slope, formulas, given)
    words = (
        "Seen from frame 4, k is f = (f_x, f_y, f_z) = (R_4^3)^T (0, sin(alpha_3), cos(alpha_3)), "
        "which theta_4 turns. Go up along k from o_0 to o_c: what theta_5 adds is a_5 (f_x "
        "cos(theta_5) + f_y sin(theta_5)), and it has to be n_1 = A_1 cos(theta_4) + B_1 "
        "sin(theta_4) - C_1. Axis 6 leans by r_33 = k^T R e_3: sin(alpha_5) (f_x sin(theta_5) - "
        "f_y cos(theta_5)) has to be n_2 = A_2 cos(theta_4) + B_2 sin(theta_4) - C_2."
    )

    def seen(theta4: float) -> Array:
        c, s = math.cos(theta4), math.sin(theta4)
        y, z = four.ca * c, -four.sa * c
        return np.array(
            [three.sa * s, three.sa * y + three.ca * four.sa, three.sa * z + three.ca * four.ca]
        )

    return Outer(3, height, slope, seen), Step("Height and slope", words, equations)
