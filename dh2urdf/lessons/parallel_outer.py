"""Two joints outside three parallel axes: what the three leave alone are two equations in them.

k is the direction of the three, f(x) the same seen from frame 4, where x is the one joint and
theta_5 the other. With n_1 and n_2, the height and the slope of the pose less what theta_5 does not
change, both linear in cos x and sin x,

    a_5 (f_x cos(theta_5) + f_y sin(theta_5)) = n_1(x),
    sin(alpha_5) (f_x sin(theta_5) - f_y cos(theta_5)) = n_2(x).
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from dh2urdf.lessons.circle import Linear, curve_of, real_roots, series_of
from dh2urdf.lessons.curve import Curve
from dh2urdf.lessons.notation import Given
from dh2urdf.lessons.steps import Equation, Step
from dh2urdf.lessons.way import Asked, Way, joint_step
from dh2urdf.transforms import Array

FREE = 5e-10
"""Sine up to which an axis is in line with another."""

VOID = 1e-12
"""Coefficients of an equation, in sizes of the arm and sines, that says nothing of its joint."""


@dataclass(frozen=True)
class Outer:
    """What the two equations are: ``joint`` x (from 0), ``height`` n_1, ``slope`` n_2, ``seen`` f.

    Their coefficients are called A_1, B_1, C_1 and so on: ``n_1 = A_1 cos x + B_1 sin x - C_1``.
    """

    joint: int
    height: Linear
    slope: Linear
    seen: Callable[[float], Array]
    choice: str = ""

    @property
    def name(self) -> str:
        """What x is called."""
        return f"theta_{self.joint + 1}"


def coefficients(
    height: Linear, slope: Linear, formulas: tuple[str, ...], given: Given
) -> tuple[Equation, ...]:
    """A_1, B_1, C_1 of the height and A_2, B_2, C_2 of the slope, by their formulas."""
    values = height.A, height.B, height.C, slope.A, slope.B, slope.C
    names = ("A_1", "B_1", "C_1", "A_2", "B_2", "C_2")
    return tuple(
        Equation(name, formula, given, value, "m" if name.endswith("1") else "")
        for name, formula, value in zip(names, formulas, values, strict=True)
    )


def outer_joints(asked: Asked, way: Way, outer: Outer) -> Iterator[Way]:
    """All ways of both joints, where a_5 and sin(alpha_5) are not both zero."""
    five = asked.arm.rows[4]
    if five.a and five.sa:
        found = _by_both(asked, way, outer)
    elif five.sa:
        found = _by_one(asked, way, outer, 1)
    else:
        found = _by_one(asked, way, outer, 2)
    for turned in found:
        if turned.stopped:
            yield turned
        else:
            yield from _fifth(asked, turned, outer)


def _by_both(asked: Asked, way: Way, outer: Outer) -> Iterator[Way]:
    """The first joint from the sum of squares: theta_5 is eliminated."""
    five, name = asked.arm.rows[4], outer.name

    def rest(x: float) -> float:
        n_1, n_2 = outer.height(x) / five.a, outer.slope(x) / five.sa
        return n_1 * n_1 + n_2 * n_2 + float(outer.seen(x)[2]) ** 2 - 1.0

    words = (
        "Divide the first equation by a_5 and the second by sin(alpha_5), square both and add: "
        "theta_5 drops out, and f_x^2 + f_y^2 = 1 - f_z^2, as f is a unit vector. What is left, "
        "(n_1 / a_5)^2 + (n_2 / sin(alpha_5))^2 + f_z^2 - 1 = 0, is of degree 2 in "
        f"cos({name}) and sin({name}), so of degree 4 in tan({name}/2). "
    )
    if float(np.abs(series_of(rest, 2)).max()) <= VOID:
        yield _free(asked, way, outer.joint, f"{words}Here it holds for all values: {name} is free")
        return
    roots = real_roots(rest, 2)
    curve = curve_of(name, rest, roots)
    if not roots:
        words += "It has no real root: here the solution ends."
        yield way.stop(Step(name, words, curve=curve))
    words += f"Its real roots: {len(roots)}. Each is tried; here the one below."
    for root in roots:
        others = tuple(x for x in roots if x != root)
        equations = [Equation(name, name, {}, root, "rad", others)]
        yield _turned(asked, way, outer, words, equations, curve)


def _by_one(asked: Asked, way: Way, outer: Outer, number: int) -> Iterator[Way]:
    """The first joint from the equation, first or second, whose left side vanishes."""
    linear = (outer.height, outer.slope)[number - 1]
    why = ("a_5 = 0: axes 5 and 6 meet", "sin(alpha_5) = 0: axes 5 and 6 are parallel")[number - 1]
    words = (
        f"{why}, and theta_5 drops out of the equation for n_{number}: n_{number} = 0, or "
        f"A cos {outer.name} + B sin {outer.name} = C with its coefficients."
    )
    if linear.amplitude <= FREE and abs(linear.C) <= FREE:
        yield _free(asked, way, outer.joint, f"{words} Here all are 0: {outer.name} is free")
    elif not linear.solvable:
        yield way.stop(Step(outer.name, f"{words} {linear.test} Here the solution ends."))
    else:
        letters = [
            Equation(name, f"{name}_{number}", {f"{name}_{number}": value}, value)
            for name, value in zip("ABC", (linear.A, linear.B, linear.C), strict=True)
        ]
        for root in linear.roots():
            yield _turned(asked, way, outer, words, [*letters, linear.equation(root)])


def _turned(
    asked: Asked,
    way: Way,
    outer: Outer,
    words: str,
    equations: list[Equation],
    curve: Curve | None = None,
) -> Way:
    """One root of the first joint."""
    i, root = outer.joint, float(equations[-1].value)
    step = joint_step(
        *(asked.arm, i, outer.name, words, equations, root, (), outer.choice), curve=curve
    )
    return way.then(step).put(i, root)


def _free(asked: Asked, way: Way, joint: int, words: str) -> Way:
    """A joint that the equations say nothing of."""
    name, value = f"theta_{joint + 1}", asked.free_value(joint)
    words += ", and stays where it is asked to be (at q = 0 if nothing is)."
    equations = [Equation(name, name, {}, value, "rad")]
    return way.then(joint_step(asked.arm, joint, name, words, equations, value)).put(joint, value)


def _fifth(asked: Asked, way: Way, outer: Outer) -> Iterator[Way]:
    """theta_5: both equations are linear in its cosine and sine."""
    five, x = asked.arm.rows[4], way.variables[outer.joint]
    f, n_1, n_2 = outer.seen(x), outer.height(x), outer.slope(x)
    given: Given = {"f_x": float(f[0]), "f_y": float(f[1]), "n_1": n_1, "n_2": n_2}
    known = [Equation("f", "f", {}, f)]
    for k, value in ((1, n_1), (2, n_2)):
        linear = (outer.height, outer.slope)[k - 1]
        letters = {f"A_{k}": linear.A, f"B_{k}": linear.B, f"C_{k}": linear.C}
        formula = f"A_{k} cos({outer.name}) + B_{k} sin({outer.name}) - C_{k}"
        unit = "m" if k == 1 else ""
        known.append(Equation(f"n_{k}", formula, {**letters, outer.name: x}, value, unit))
    if math.hypot(f[0], f[1]) <= FREE:
        words = "Axis 5 is parallel to k: theta_5 changes neither height nor slope and is free"
        yield _free(asked, way, 4, words)
    elif five.a and five.sa:
        c, s = n_1 / five.a, n_2 / five.sa
        value = math.atan2(f[1] * c + f[0] * s, f[0] * c - f[1] * s)
        formula = (
            "atan2(f_y n_1 / a_5 + f_x n_2 / sin(alpha_5), f_x n_1 / a_5 - f_y n_2 / sin(alpha_5))"
        )
        given = {**given, "a_5": five.a, "alpha_5": five.alpha}
        words = "With it both equations are known: together they give cosine and sine of theta_5."
        equations = [*known, Equation("theta_5", formula, given, value, "rad")]
        step = joint_step(asked.arm, 4, "theta_5: the wrist", words, equations, value)
        yield way.then(step).put(4, value)
    else:
        yield from _fifth_by_one(asked, way, f, known)


def _fifth_by_one(asked: Asked, way: Way, f: Array, known: list[Equation]) -> Iterator[Way]:
    """theta_5 from the equation that is left: two wrists."""
    five = asked.arm.rows[4]
    n_1, n_2 = (float(equation.value) for equation in known[1:])
    if five.sa:
        A, B, C = -five.sa * f[1], five.sa * f[0], n_2
        letters = "-sin(alpha_5) f_y", "sin(alpha_5) f_x", "n_2"
    else:
        A, B, C = five.a * f[0], five.a * f[1], n_1
        letters = "a_5 f_x", "a_5 f_y", "n_1"
    given: Given = {"f_x": float(f[0]), "f_y": float(f[1]), "n_1": n_1, "n_2": n_2}
    given = {**given, "a_5": five.a, "alpha_5": five.alpha}
    linear = Linear("theta_5", float(A), float(B), C)
    words = "The other equation is A cos theta_5 + B sin theta_5 = C. " + linear.test
    known = [
        *known,
        *(
            Equation(name, letter, given, getattr(linear, name))
            for name, letter in zip("ABC", letters, strict=True)
        ),
    ]
    if not linear.solvable:
        yield way.stop(Step("theta_5", f"{words} Here the solution ends.", tuple(known)))
    for root in linear.roots():
        equations = [*known, linear.equation(root)]
        title = "theta_5: the wrist"
        step = joint_step(asked.arm, 4, title, words, equations, root, (), "wrist")
        yield way.then(step).put(4, root)


def last_turn(asked: Asked, way: Way, k: Array, f: Array) -> Way:
    """theta_6 turns the common direction, ``k`` in frame 0 and ``f`` in frame 4, to the pose's."""
    e = asked.arm.rows[4].motion(way.variables[4])[:3, :3].T @ f
    n = asked.H[:3, :3].T @ k
    words = (
        "Seen from frame 5 the common direction is e = (R_5^4)^T f, from frame 6 it is n = R^T k. "
        "Rz(theta_6)^T turns e into n."
    )
    given: Given = {"e_x": float(e[0]), "e_y": float(e[1])}
    given = {**given, "n_x": float(n[0]), "n_y": float(n[1])}
    value = math.remainder(math.atan2(e[1], e[0]) - math.atan2(n[1], n[0]), math.tau)
    formula = "atan2(e_y, e_x) - atan2(n_y, n_x)"
    if math.hypot(n[0], n[1]) <= FREE:
        words += (
            " Both are along axis 6, which is parallel to k: joint 6 turns the tool as the three "
            "do. It is free, and stays where it is asked to be (at q_6 = 0 if nothing is)."
        )
        value, formula = asked.free_value(5), "theta_6"
    equations = [
        Equation("e", "(R_5^4)^T f", {}, e),
        Equation("n", "R^T k", {}, n),
        Equation("theta_6", formula, given, value, "rad"),
    ]
    return way.then(joint_step(asked.arm, 5, "theta_6", words, equations, value)).put(5, value)
