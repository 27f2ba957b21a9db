"""The common arm: axis 1 upright, axes 2 and 3 parallel. Joint 1 turns a plane, in it an RR arm."""

import math
from collections.abc import Iterator

import numpy as np

from dh2urdf.lessons.marks import Mark
from dh2urdf.lessons.marks import triangle as triangle_marks
from dh2urdf.lessons.notation import shown
from dh2urdf.lessons.steps import Equation, Step
from dh2urdf.lessons.triangle import Elbow, Letters, Triangle
from dh2urdf.lessons.way import MERGED, RIM, Asked, Way, joint_step
from dh2urdf.transforms import Array, moved

ON_AXIS = 5e-10
"""Distance [m] of the wrist centre from axis 1 at which joint 1 is free."""


WRIST_PLANE = "Axes 2 and 3 are parallel: links 2 and 3 stay in a plane that joint 1 turns. "


def articulated(asked: Asked, way: Way, centre: Array) -> Iterator[Way]:
    """All ways: shoulder, then elbow."""
    row2, row3, row4 = asked.arm.rows[1:4]
    beside = Equation(
        "b",
        "d_2 + d_3 + d_4 cos(alpha_3)",
        {"d_2": row2.d, "d_3": row3.d, "d_4": row4.d, "alpha_3": row3.alpha},
        row2.d + row3.d + row4.d * row3.ca,
        "m",
    )
    for turned, reach in shoulders(asked, way, centre, beside):
        if turned.stopped:
            yield turned
        else:
            yield from _elbows(asked, turned, centre, reach)


def shoulders(
    asked: Asked, way: Way, centre: Array, beside: Equation, said: str = WRIST_PLANE
) -> Iterator[tuple[Way, tuple[float, float]]]:
    """Joint 1 turns the arm's plane, ``beside`` off axis 1, through a point (3,) of frame 0.

    The ways, each with the point's coordinates u, v in frame 1; ``said`` says what the plane is,
    and the point is x_c, y_c, z_c.
    """
    row = asked.arm.rows[0]
    x, y, z = (float(v) for v in centre)
    offset, high = float(beside.value), z - row.d
    m = (row.ca * high - offset) / row.sa
    plane = Equation(
        "m",
        "(cos(alpha_1) (z_c - d_1) - b) / sin(alpha_1)",
        {"alpha_1": row.alpha, "z_c": z, "d_1": row.d, "b": offset},
        m,
        "m",
    )
    equations = [beside, plane] if m or offset else []
    square = x * x + y * y - m * m
    words = said
    if m:
        words += (
            f"The plane passes axis 1 at a distance of |m| = {shown(abs(m))} m, so "
            "y_c cos theta_1 - x_c sin theta_1 = m. "
        )
    if square < -RIM * (abs(m) + abs(row.a)) ** 2:
        end = (
            f"The point is {shown(math.hypot(x, y))} m from axis 1, less than |m|: no turn "
            "of joint 1 brings the plane there, and here the solution ends."
        )
        yield way.stop(Step("theta_1", words + end, tuple(equations))), (0.0, 0.0)
        return
    root = math.sqrt(square) if square > MERGED * (x * x + y * y) else 0.0
    if x * x + y * y <= ON_AXIS**2 and root <= ON_AXIS:
        facings = [_any_facing(asked, words)]
        root = 0.0
    else:
        facings = [_facing(asked, centre, m, r, words, equations) for r in _both(root)]
    for r, (theta, step) in zip(_both(root), facings, strict=True):
        yield way.then(step).put(0, theta), (r - row.a, row.ca * m + row.sa * high)


def _both(root: float) -> tuple[float, ...]:
    """Both signs of a square root, positive first."""
    return (root, -root) if root else (0.0,)


def _any_facing(asked: Asked, words: str) -> tuple[float, Step]:
    """Joint 1 where the wrist centre is on its axis."""
    theta = asked.free_value(0)
    words += (
        "The point (x_c, y_c, z_c) is on axis 1: joint 1 moves it nowhere and is free. It stays "
        "where it is asked to be (at q_1 = 0 if nothing is asked); all other angles "
        "are solutions too."
    )
    equation = Equation("theta_1", "theta_1", {}, theta, "rad")
    return theta, joint_step(asked.arm, 0, "theta_1: free", words, [equation], theta)


def _facing(
    asked: Asked, centre: Array, m: float, r: float, words: str, equations: list[Equation]
) -> tuple[float, Step]:
    """One of the two ways that the arm's plane may face: theta_1 and its step."""
    x, y = float(centre[0]), float(centre[1])
    both = [
        math.remainder(math.atan2(y, x) - math.atan2(m, side), 2.0 * math.pi) for side in (r, -r)
    ]
    given = {"x_c": x, "y_c": y, "m": m, "r": r}
    formula = "atan2(y_c, x_c) - atan2(m, r)"
    if not m:
        formula = "atan2(y_c, x_c)" if r > 0.0 else "atan2(-y_c, -x_c)"
    inside = "x_c^2 + y_c^2 - m^2" if m else "x_c^2 + y_c^2"
    others = ((-r,), (both[1],)) if r else ((), ())
    found = [
        Equation("r", f"+- sqrt({inside})", given, r, "m", others[0]),
        Equation("theta_1", formula, given, both[0], "rad", others[1]),
    ]
    words += "Seen from above, atan2 gives the direction. "
    if r > 0.0:
        words += (
            "The plane may also be turned half round, so that the arm reaches back over axis 1: "
            "the second solution. Here r > 0: the point is on the side to which x_1 points."
        )
    elif r < 0.0:
        words += (
            "Here the second solution: the plane is turned half round, r < 0, the point is behind "
            "axis 1, and the arm reaches back over it."
        )
    title, level = "theta_1: which way the arm faces", np.array([0.0, 0.0, centre[2]])
    marks = (Mark("line", moved(asked.arm.base, np.stack([level, centre])), "r"),)
    equations = [*equations, *found]
    step = joint_step(asked.arm, 0, title, words, equations, both[0], marks, "shoulder")
    return both[0], step


def _elbows(asked: Asked, way: Way, centre: Array, reach: tuple[float, float]) -> Iterator[Way]:
    """Joints 2 and 3: the triangle of upper arm, forearm and the way to the wrist centre."""
    arm, (u, v) = asked.arm, reach
    row2, row3, row4 = arm.rows[1:4]
    fore_x, fore_y = row3.a, -row3.sa * row4.d
    fore, lean = math.hypot(fore_x, fore_y), math.atan2(fore_y, fore_x)
    given = {"a_3": row3.a, "d_4": row4.d, "alpha_3": row3.alpha}
    forearm = [
        Equation("l_3", "sqrt(a_3^2 + (d_4 sin(alpha_3))^2)", given, fore, "m"),
        Equation("beta", "atan2(-d_4 sin(alpha_3), a_3)", given, lean, "rad"),
    ]
    letters = Letters(
        *("u", "v", "a_2", "l_3", "theta_2", "eta", "c_eta", "s_eta"),
        tip="The wrist centre",
        root="the shoulder (o_1)",
    )
    triangle = Triangle(letters, row2.a, fore, u, v)
    words = (
        "In the plane it is a planar arm of two links. The wrist centre is at (u, v), seen "
        "from frame 1. The upper arm is a_2 long; the forearm, from o_2 to the wrist centre, l_3, "
        f"and it makes the constant angle beta with x_3. {triangle.test}"
    )
    distance = Equation("r_c", "sqrt(u^2 + v^2)", {"u": u, "v": v}, triangle.distance, "m")
    equations = (*_seen_from_shoulder(asked, centre, reach), *forearm, distance, triangle.cosine)
    shoulder = arm.frames(way.first(1))[1][:3, 3]
    ends = moved(arm.base, np.stack([shoulder, centre]))
    found: tuple[Mark, ...] = Mark("line", ends, "r_c"), Mark("point", ends[:1], "o_1")
    seen = Step("The triangle in the arm's plane", words, equations, marks=found)
    if not triangle.reaches:
        yield way.stop(seen)
        return
    elbows = triangle.elbows()
    for elbow in elbows:
        theta3 = math.remainder(elbow.elbow - lean, 2.0 * math.pi)
        H_2 = arm.frames([*way.first(1), elbow.shoulder])[2]
        corners = np.stack([shoulder, H_2[:3, 3], centre])
        marks = triangle_marks(arm.base, corners, ("a_2", "l_3", "r_c"))
        steps = _bent(asked, elbow, (theta3, lean), len(elbows), marks)
        yield way.then(seen, *steps).put(2, theta3).put(1, elbow.shoulder)


def _seen_from_shoulder(
    asked: Asked, centre: Array, reach: tuple[float, float]
) -> tuple[Equation, Equation]:
    """The wrist centre in frame 1, in the arm's plane."""
    row, (u, v), z = asked.arm.rows[0], reach, float(centre[2])
    given = {"alpha_1": row.alpha, "z_c": z, "d_1": row.d}
    formula = "(z_c - d_1) sin(alpha_1)"
    if row.ca:
        formula = f"m cos(alpha_1) + {formula}"
        given["m"] = (v - row.sa * (z - row.d)) / row.ca
    return (
        Equation("u", "r - a_1", {"r": u + row.a, "a_1": row.a}, u, "m"),
        Equation("v", formula, given, v, "m"),
    )


def _bent(
    asked: Asked, elbow: Elbow, angles: tuple[float, float], count: int, marks: tuple[Mark, ...]
) -> tuple[Step, Step]:
    """One elbow: theta_3, then theta_2; angles: theta_3 and beta."""
    theta3, lean = angles
    given = {"eta": elbow.elbow, "beta": lean}
    third = Equation("theta_3", "eta - beta", given, theta3, "rad")
    sign = "negative" if elbow.elbow < 0.0 else "positive"
    both = (
        f"The cosine does not tell its sign: the elbow bends either way. Here eta is {sign}."
        if count > 1
        else "The arm is stretched or folded: both elbows are one."
    )
    step3 = joint_step(
        asked.arm,
        2,
        "theta_3: the elbow",
        f"eta = theta_3 + beta is the angle between upper arm and forearm. {both}",
        [*elbow.elbow_equations[1:], third],
        theta3,
        marks,
        "elbow",
    )
    step2 = joint_step(
        asked.arm,
        1,
        "theta_2: the shoulder",
        "Once the elbow is known, the direction to the wrist centre gives theta_2: gamma is the "
        "angle in the triangle between the upper arm and the way to the wrist centre.",
        elbow.shoulder_equations,
        elbow.shoulder,
        marks,
    )
    return step3, step2
