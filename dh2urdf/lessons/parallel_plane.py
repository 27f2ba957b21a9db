"""Three parallel axes 2, 3, 4: what the joints outside leave them, a planar arm (notes 8.2)."""

import math
from collections.abc import Iterator

import numpy as np

from dh2urdf.lessons.marks import Mark
from dh2urdf.lessons.marks import triangle as triangle_marks
from dh2urdf.lessons.notation import Given, shown
from dh2urdf.lessons.steps import Equation, Step
from dh2urdf.lessons.triangle import Elbow, Letters, Triangle
from dh2urdf.lessons.way import Asked, Way, joint_step
from dh2urdf.transforms import Array, inverse, moved

PLANE = (
    "Axes 2, 3 and 4 are parallel: their links stay in a plane that joint 1 turns, and the three "
    "joints do not move anything across it. "
)


def before_last(asked: Asked) -> tuple[Array, Step]:
    """The origin of the frame before the last one, of which only its joint's turn is unknown."""
    arm, n = asked.arm, asked.arm.n
    row, R, o = arm.rows[-1], asked.H[:3, :3], asked.H[:3, 3]
    point = o - row.d * R[:, 2] - row.a * R[:, 0]
    given: Given = {"o": o, f"d_{n}": row.d, "k": R[:, 2], f"a_{n}": row.a, "i": R[:, 0], "R": R}
    formula, via = "o", "o"
    if row.d:
        formula, via = f"{formula} - d_{n} R e_3", f"{via} - d_{n} k"
    if row.a:
        formula, via = f"{formula} - a_{n} R e_1", f"{via} - a_{n} i"
    equation = Equation("o_c", formula, given, point, "m", via=via)
    words = (
        f"Joint {n} turns the tool about z_{n - 1} = R e_3 and does not move the origin of frame "
        f"{n - 1}, o_c = (x_c, y_c, z_c): go back the lengths of the last row from o."
    )
    ends = moved(arm.base, np.stack([o, point]))
    marks = Mark("line", ends, f"d_{n}"), Mark("point", ends[1:], "o_c")
    return point, Step(f"The origin of frame {n - 1}", words, (equation,), marks=marks)


def beside(asked: Asked) -> Equation:
    """How far the arm's plane with o_c is from o_0 along the common direction."""
    rows = asked.arm.rows
    names, terms = ["d_2", "d_3", "d_4"], [row.d for row in rows[1:4]]
    given = dict(zip(names, terms, strict=True))
    formula, value = "d_2 + d_3 + d_4", sum(terms)
    if len(rows) == 6 and rows[4].d:
        formula, value = f"{formula} + d_5 cos(alpha_4)", value + rows[4].d * rows[3].ca
        given |= {"d_5": rows[4].d, "alpha_4": rows[3].alpha}
    return Equation("b", formula, given, value, "m")


def common_axis(asked: Asked, theta: float) -> Array:
    """The common direction of the three axes in frame 0."""
    row = asked.arm.rows[0]
    return np.array([row.sa * math.sin(theta), -row.sa * math.cos(theta), row.ca])


def bend_in_plane(asked: Asked, way: Way) -> Iterator[Way]:
    """Joints 2, 3, 4: a planar arm."""
    arm = asked.arm
    R_4, o_4 = _fourth_frame(asked, way)
    H_1 = arm.frames(way.first(1))[1]
    a4, point = arm.rows[3].a, o_4 - arm.rows[3].a * R_4[:, 0]
    (u, v), (cx, cy) = (H_1[:3, :2].T @ w for w in (point - H_1[:3, 3], R_4[:, 0]))
    phi = math.atan2(cy, cx)
    letters = Letters(
        *("u", "v", "a_2", "a_3", "theta_2", "theta_3", "c_3", "s_3"),
        tip="Axis 4",
        root="axis 2 (o_1)",
    )
    triangle = Triangle(letters, arm.rows[1].a, arm.rows[2].a, float(u), float(v))
    back = f"a_4 = {shown(a4)} m back along it" if a4 else "at its origin, as a_4 = 0"
    words = (
        "Frame 4 is known from the joints after it. Its x_4 points along phi, seen in the plane "
        f"from frame 1, and axis 4 is {back}: it passes p_4, at (u, v) from o_1. Links 2 and 3 "
        "have to reach it. "
        f"{triangle.test}"
    )
    seen_from: Given = {"x_1": H_1[:3, 0], "y_1": H_1[:3, 1], "p_4": point, "o_1": H_1[:3, 3]}
    equations = (
        Equation("phi", "atan2(x_y, x_x)", {"x_x": float(cx), "x_y": float(cy)}, phi, "rad"),
        Equation("u", "x_1^T (p_4 - o_1)", seen_from, float(u), "m"),
        Equation("v", "y_1^T (p_4 - o_1)", seen_from, float(v), "m"),
        Equation("r_4", "sqrt(u^2 + v^2)", {"u": u, "v": v}, triangle.distance, "m"),
        triangle.cosine,
    )
    ends = moved(arm.base, np.stack([H_1[:3, 3], point]))
    marks = Mark("line", ends, "r_4"), Mark("point", ends, "o_1")
    seen = Step("The triangle in the arm's plane", words, equations, marks=marks)
    if not triangle.reaches:
        yield way.stop(seen)
        return
    elbows = triangle.elbows()
    for elbow in elbows:
        H_2 = arm.frames([*way.first(1), elbow.shoulder])[2]
        corners = np.stack([H_1[:3, 3], H_2[:3, 3], point])
        sides = triangle_marks(arm.base, corners, ("a_2", "a_3", "r_4"))
        steps, theta4 = _bent(asked, elbow, phi, len(elbows), sides)
        found = way.then(seen, *steps).put(1, elbow.shoulder).put(2, elbow.elbow)
        yield found.put(3, theta4)


def _fourth_frame(asked: Asked, way: Way) -> tuple[Array, Array]:
    """Rotation (3, 3) and origin (3,) of frame 4 in frame 0: back from the last frame."""
    H: Array = asked.H
    for i in reversed(range(4, asked.arm.n)):
        H = H @ inverse(asked.arm.rows[i].motion(way.variables[i]))
    return H[:3, :3], H[:3, 3]


def _bent(
    asked: Asked, elbow: Elbow, phi: float, count: int, sides: tuple[Mark, ...]
) -> tuple[tuple[Step, Step, Step], float]:
    """One elbow: theta_3, theta_2, and what theta_4 has to add."""
    sign = "negative" if elbow.elbow < 0.0 else "positive"
    both = (
        f"The cosine does not tell its sign: the elbow bends either way. Here it is {sign}."
        if count > 1
        else "The arm is stretched or folded: both elbows are one."
    )
    title, equations = "theta_3: the elbow", elbow.elbow_equations[1:]
    step3 = joint_step(asked.arm, 2, title, both, equations, elbow.elbow, sides, "elbow")
    step2 = joint_step(
        asked.arm,
        1,
        "theta_2: the shoulder",
        "The direction to axis 4, less gamma, the angle in the triangle at the shoulder.",
        elbow.shoulder_equations,
        elbow.shoulder,
        sides,
    )
    given = {"phi": phi, "theta_2": elbow.shoulder, "theta_3": elbow.elbow}
    theta4 = math.remainder(phi - elbow.shoulder - elbow.elbow, math.tau)
    how = Equation("theta_4", "phi - theta_2 - theta_3", given, theta4, "rad")
    words = "The three angles add up to the direction phi of x_4."
    step4 = joint_step(asked.arm, 3, "theta_4", words, [how], theta4)
    return (step3, step2, step4), theta4
