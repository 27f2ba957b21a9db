"""One of joints 1 and 3 slides, or both: linear equations, a right triangle, a quartic."""

import math
from collections.abc import Iterator

import numpy as np

from dh2urdf.lessons.circle import Linear, curve_of, real_roots
from dh2urdf.lessons.notation import shown, vector_shown
from dh2urdf.lessons.seen import ON_AXIS, Seen, freely, linear_step, slid
from dh2urdf.lessons.steps import Equation, Step
from dh2urdf.lessons.way import MERGED, RIM, Asked, Way, joint_step
from dh2urdf.transforms import Array

SQUARE = 1e-9
"""Cosine of a slide with axis 2 up to which it is at right angles."""


def turn_and_slide(asked: Asked, way: Way, y: Seen, v: Seen) -> Iterator[Way]:
    """One of joints 1 and 3 turns, the other slides."""
    turn, slide = (v, y) if y.slides else (y, v)
    E = slide.C
    if turn.joint == 0 and math.hypot(*turn.C[:2]) <= ON_AXIS:
        freed = freely(asked, way, turn)
        yield from _slide_length(asked, freed, turn, slide)
        return
    if asked.arm.rows[1].slides:
        across = np.array([-E[1], E[0], 0.0])
        words = f"x and y are equal. Take them across the direction in which {slide.name} slides: "
    elif abs(E[2]) <= SQUARE:
        across = np.array([0.0, 0.0, 1.0])
        words = f"{slide.name} slides at a right angle to z_1, so z is free of it: "
    else:
        yield from _oblique(asked, way, turn, slide)
        return
    linear = Linear(
        turn.name,
        *(float(across @ turn.C), float(across @ turn.S)),
        float(across @ (slide.k - turn.k)),
    )
    words += f"A cos {turn.name} + B sin {turn.name} = C."
    if not linear.solvable:
        yield way.stop(Step(turn.name, f"{words} {linear.test} Here the solution ends."))
        return
    for root in linear.roots():
        step = linear_step(asked, turn, linear, root, words)
        turned = way.then(step).put(turn.joint, root)
        if not asked.arm.rows[1].slides:
            yield from _slide_length(asked, turned, turn, slide)
            continue
        gap = turn.at(root) - slide.k
        t = float(gap[:2] @ E[:2]) / float(E[:2] @ E[:2])
        given = {"u": np.append(gap[:2], 0.0), "e": np.append(E[:2], 0.0)}
        yield slid(
            asked,
            turned,
            slide,
            t,
            "x and y along that direction: u is how far the point is from where the slide is at "
            "zero, e the direction.",
            Equation(slide.name, "(e^T u) / (e^T e)", given, t, "m"),
        )


def _slide_length(asked: Asked, way: Way, turn: Seen, slide: Seen) -> Iterator[Way]:
    """The slide from the length, which is a quadratic equation in it."""
    y = turn.at(way.variables[turn.joint])
    along = float(slide.k @ slide.C)
    square, rest = float(y @ y), float(slide.k @ slide.k)
    room = along * along - rest + square
    given = {"f": along, "g": rest, "h": square}
    words = (
        f"The lengths are equal: {slide.name}^2 + 2 f {slide.name} + g = h, with f the slide's "
        "direction times the point at zero, g and h the squared lengths of the point at zero and "
        "of where it has to be. A right triangle: "
    )
    if room < -RIM * max(square, rest):
        short = math.sqrt(max(rest - along * along, 0.0))
        words += (
            f"the point stands {shown(math.sqrt(square))} m from o_1, but along the slide it is "
            f"never nearer than {shown(short)} m. Here the solution ends."
        )
        yield way.stop(Step(slide.name, words))
        return
    root = math.sqrt(room) if room > MERGED * max(square, rest) else 0.0
    for side in (root, -root) if root else (0.0,):
        value = side - along
        others = (-side - along,) if root else ()
        how = Equation(slide.name, "-f +- sqrt(f^2 - g + h)", given, value, "m", others)
        said = words + "the slide may point to it or away from it."
        yield slid(asked, way, slide, value, said, how)


def _oblique(asked: Asked, way: Way, turn: Seen, slide: Seen) -> Iterator[Way]:
    """The slide leans on axis 2: it follows from z, and the lengths are a quartic in the angle."""
    steep = float(slide.C[2])

    def reached(x: float) -> float:
        return float(turn.at(x)[2] - slide.k[2]) / steep

    def f(x: float) -> float:
        y, v = turn.at(x), slide.at(reached(x))
        return float(y @ y - v @ v)

    roots = real_roots(f, 2)
    words = (
        f"z gives {slide.name} as a sum in cos and sin of {turn.name}; put into the lengths, what "
        f"is left has degree two in them: a quartic equation in tan({turn.name}/2). "
        f"{len(roots) or 'None'} of its roots {'is' if len(roots) == 1 else 'are'} real"
    )
    curve = curve_of(turn.name, f, roots)
    if not roots:
        yield way.stop(Step(turn.name, f"{words}: here the solution ends.", curve=curve))
        return
    for root in roots:
        others = tuple(x for x in roots if x != root)
        step = joint_step(
            asked.arm,
            turn.joint,
            f"{turn.name}: a quartic",
            f"{words}.",
            [Equation(turn.name, turn.name, {}, root, "rad", others)],
            root,
            curve=curve,
        )
        value = reached(root)
        given = {"y_z": float(turn.at(root)[2]), "k_z": float(slide.k[2]), "e_z": steep}
        how = Equation(slide.name, "(y_z - k_z) / e_z", given, value, "m")
        turned = way.then(step).put(turn.joint, root)
        yield slid(asked, turned, slide, value, "z gives it.", how)


def two_slides(asked: Asked, way: Way, y: Seen, v: Seen) -> Iterator[Way]:
    """Joints 1 and 3 slide: linear equations, once joint 2 is known if it turns."""
    if asked.arm.rows[1].slides:
        yield _solved(asked, way, y, v, np.eye(3), "x and y are equal: two linear equations.")
        return
    g, h = np.cross(v.C, v.k), np.cross(y.k, y.C)
    C, E = y.C, v.C
    linear = Linear(
        "theta_2",
        float(C[:2] @ g[:2] - h[:2] @ E[:2]),
        float(C[1] * g[0] - C[0] * g[1] - h[1] * E[0] + h[0] * E[1]),
        float(h[2] * E[2] - C[2] * g[2]),
    )
    words = (
        "Only theta_2 turns. Across both directions of sliding neither d_1 nor d_3 counts: what is "
        "left of y = Rz(theta_2) v is A cos theta_2 + B sin theta_2 = C."
    )
    if not linear.solvable:
        yield way.stop(Step("theta_2", f"{words} {linear.test} Here the solution ends."))
        return
    turning = Seen(1, False, y.k, y.C, y.S)
    for root in linear.roots():
        step = linear_step(asked, turning, linear, root, words)
        c, s = math.cos(root), math.sin(root)
        turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        turned = way.then(step).put(1, root)
        yield _solved(asked, turned, y, v, turn, "With it d_1 and d_3 are linear.")


def _solved(asked: Asked, way: Way, y: Seen, v: Seen, turn: Array, words: str) -> Way:
    """d_1 and d_3 from ``k + d_1 C = turn (m + d_3 E)``, along z where joint 2 turns only."""
    flat = asked.arm.rows[1].slides
    A = np.column_stack([y.C, -turn @ v.C])
    b = turn @ v.k - y.k
    if flat:
        A, b = A[:2], b[:2]
    d1, d3 = (float(t) for t in np.linalg.lstsq(A, b, rcond=None)[0])
    told = f"{words} d_1 {vector_shown(A[:, 0])} + d_3 {vector_shown(A[:, 1])} = {vector_shown(b)}."
    found = slid(asked, way, y, d1, told, Equation("d_1", "d_1", {}, d1, "m"))
    return slid(asked, found, v, d3, told, Equation("d_3", "d_3", {}, d3, "m"))
