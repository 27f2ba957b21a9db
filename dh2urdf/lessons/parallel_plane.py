"""Three parallel axes: what the joints outside leave them, a planar arm (notes 8.2)."""

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


def bend_in_plane(asked: Asked, way: Way, first: int = 1) -> Iterator[Way]:
    """The three parallel joints, of which ``first`` is the first (from 0): a planar arm."""
    arm, (one, two, three) = asked.arm, (first + 1, first + 2, first + 3)
    R, o = _frame_after(asked, way, three)
    link, point = arm.rows[three - 1].a, o - arm.rows[three - 1].a * R[:, 0]
    H = arm.frames(way.first(first))[first]
    (u, v), (cx, cy) = (H[:3, :2].T @ w for w in (point - H[:3, 3], R[:, 0]))
    phi = math.atan2(cy, cx)
    names = f"a_{one}", f"a_{two}", f"theta_{one}", f"theta_{two}", f"c_{two}", f"s_{two}"
    letters = Letters("u", "v", *names, tip=f"Axis {three}", root=f"axis {one} (o_{first})")
    triangle = Triangle(letters, arm.rows[first].a, arm.rows[first + 1].a, float(u), float(v))
    name = f"a_{three}"
    back = f"{name} = {shown(link)} m back along it" if link else f"at its origin, as {name} = 0"
    words = (
        f"Frame {three} is known from the joints after it. Its x_{three} points along phi, seen in "
        f"the plane from frame {first}, and axis {three} is {back}: it passes p_{three}, at (u, v) "
        f"from o_{first}. Links {one} and {two} have to reach it. "
        f"{triangle.test}"
    )
    x, y, p, root = f"x_{first}", f"y_{first}", f"p_{three}", f"o_{first}"
    seen_from: Given = {x: H[:3, 0], y: H[:3, 1], p: point, root: H[:3, 3]}
    equations = (
        Equation("phi", "atan2(x_y, x_x)", {"x_x": float(cx), "x_y": float(cy)}, phi, "rad"),
        Equation("u", f"{x}^T ({p} - {root})", seen_from, float(u), "m"),
        Equation("v", f"{y}^T ({p} - {root})", seen_from, float(v), "m"),
        Equation(f"r_{three}", "sqrt(u^2 + v^2)", {"u": u, "v": v}, triangle.distance, "m"),
        triangle.cosine,
    )
    ends = moved(arm.base, np.stack([H[:3, 3], point]))
    marks = Mark("line", ends, f"r_{three}"), Mark("point", ends, root)
    seen = Step("The triangle in the arm's plane", words, equations, marks=marks)
    if not triangle.reaches:
        yield way.stop(seen)
        return
    yield from _bends(asked, way.then(seen), first, triangle, phi)


def _frame_after(asked: Asked, way: Way, count: int) -> tuple[Array, Array]:
    """Rotation (3, 3) and origin (3,) of frame ``count`` in frame 0: back from the last frame."""
    H: Array = asked.H
    for i in reversed(range(count, asked.arm.n)):
        H = H @ inverse(asked.arm.rows[i].motion(way.variables[i]))
    return H[:3, :3], H[:3, 3]


def _bends(asked: Asked, way: Way, first: int, triangle: Triangle, phi: float) -> Iterator[Way]:
    """Each elbow of the planar arm."""
    arm, names, elbows = asked.arm, triangle.letters, triangle.elbows()
    for elbow in elbows:
        frames = arm.frames([*way.first(first), elbow.shoulder])
        point = (frames[first] @ [triangle.x, triangle.y, 0.0, 1.0])[:3]
        corners = np.stack([frames[first][:3, 3], frames[first + 1][:3, 3], point])
        sides = triangle_marks(arm.base, corners, (names.l1, names.l2, f"r_{first + 3}"))
        steps, last = _bent(asked, first, elbow, phi, len(elbows), sides)
        found = way.then(*steps).put(first, elbow.shoulder).put(first + 1, elbow.elbow)
        yield found.put(first + 2, last)


def _bent(
    asked: Asked, first: int, elbow: Elbow, phi: float, count: int, sides: tuple[Mark, ...]
) -> tuple[tuple[Step, Step, Step], float]:
    """One elbow: the elbow's angle, the shoulder's, and what the third has to add."""
    sign = "negative" if elbow.elbow < 0.0 else "positive"
    both = (
        f"The cosine does not tell its sign: the elbow bends either way. Here it is {sign}."
        if count > 1
        else "The arm is stretched or folded: both elbows are one."
    )
    one, two, three = (f"theta_{first + k}" for k in (1, 2, 3))
    arm, title, equations = asked.arm, f"{two}: the elbow", elbow.elbow_equations[1:]
    middle = joint_step(arm, first + 1, title, both, equations, elbow.elbow, sides, "elbow")
    words = (
        f"The direction to axis {first + 3}, less gamma, the angle in the triangle at the shoulder."
    )
    title, equations = f"{one}: the shoulder", elbow.shoulder_equations
    root = joint_step(arm, first, title, words, equations, elbow.shoulder, sides)
    given = {"phi": phi, one: elbow.shoulder, two: elbow.elbow}
    last = math.remainder(phi - elbow.shoulder - elbow.elbow, math.tau)
    how = Equation(three, f"phi - {one} - {two}", given, last, "rad")
    words = f"The three angles add up to the direction phi of x_{first + 3}."
    end = joint_step(arm, first + 2, three, words, [how], last)
    return (middle, root, end), last
