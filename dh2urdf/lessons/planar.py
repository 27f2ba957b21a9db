"""The planar arms of lecture notes 8.2, RR and RRR, and SCARA arms, which also slide."""

import cmath
import math
from collections.abc import Iterator

import numpy as np

from dh2urdf.lessons.notation import shown
from dh2urdf.lessons.planar_elbows import TINY, Plane, elbows
from dh2urdf.lessons.steps import Equation, Step
from dh2urdf.lessons.way import Asked, Way, joint_step

OFF = 2e-9
"""Distance [m] or angle [rad] by which a pose may miss the plane: twice what a residual may be."""


def planar(asked: Asked) -> Iterator[Way]:
    """All ways of two or three parallel turning axes, and a slide along them or none."""
    return _ways(asked, False)


def planar_place(asked: Asked) -> Iterator[Way]:
    """The same for the task position: the tool stays on, and lengthens the last link."""
    return _ways(asked, True)


def _ways(asked: Asked, place_only: bool) -> Iterator[Way]:
    arm, H = asked.arm, asked.H
    tip = complex(arm.tool[0, 3], arm.tool[1, 3]) if place_only else 0j
    plane = Plane(asked, tip)
    way = Way().then(_seen(asked, plane, place_only))
    if not place_only and abs(H[2, 2] - 1.0) + np.hypot(H[0, 2], H[1, 2]) > OFF:
        lean = math.degrees(math.atan2(np.hypot(H[0, 2], H[1, 2]), H[2, 2]))
        words = (
            f"All axes are parallel, so z_{arm.n} keeps the direction of z_0; the pose wants it "
            f"{shown(lean)} deg from there. No joint leans the tool, and here the solution ends."
        )
        yield way.stop(Step("The direction of the axes", words))
        return
    way = _height(asked, plane, way, arm.tool[2, 3] if place_only else 0.0)
    if way.stopped:
        yield way
        return
    x, y = _wrist_point(asked, plane)
    joints = len(plane.turning)
    if joints == 3:
        way = way.then(_back_from_the_hand(asked, plane, x, y))
    for found in elbows(asked, plane, way, x, y):
        if found.stopped or (joints == 2 and place_only):
            yield found
        elif joints == 2:
            yield _agree(asked, plane, found)
        else:
            yield _last(asked, plane, found)


def _seen(asked: Asked, plane: Plane, place_only: bool) -> Step:
    """The equations of the plane: how many, and how many unknowns."""
    slide = plane.slide
    unknowns = len(plane.turning)
    words = "All axes are parallel: look along them, and the arm is one in the plane. "
    if place_only:
        words += f"x and y are two equations in the {unknowns} joints that turn."
    elif unknowns == 2:
        words += (
            "x, y and phi are three equations in two unknowns: most poses have no solution. So "
            "forget about phi first, solve for x and y, and compare phi at the end."
        )
    else:
        words += "x, y and phi are three equations in the three joints that turn."
    if slide is not None:
        words += f" Joint {slide + 1} slides along the axes and makes the height."
    return Step("The plane", words)


def _height(asked: Asked, plane: Plane, way: Way, above: float) -> Way:
    """The slide makes the height; without one the height has to be the arm's own."""
    arm, z = asked.arm, float(asked.H[2, 3])
    fixed = sum(row.d for row in arm.rows if not row.slides) + above
    if plane.slide is None:
        if abs(z - fixed) <= OFF:
            return way
        words = (
            f"The arm moves in the plane z = {shown(fixed)} m, the pose is at z = {shown(z)} m: "
            f"{shown(abs(z - fixed))} m out of the plane. Here the solution ends."
        )
        return way.stop(Step("The height", words))
    i = plane.slide + 1
    given = {"z": z, "h": fixed}
    words = f"h = {shown(fixed)} m is the height of everything else, the sum of the other d."
    equation = Equation(f"d_{i}", "z - h", given, z - fixed, "m")
    step = joint_step(arm, plane.slide, f"d_{i}: the height", words, [equation], z - fixed)
    return way.then(step).put(plane.slide, z - fixed)


def _heading(asked: Asked) -> float:
    """``phi``, the direction of the last frame."""
    return math.atan2(asked.H[1, 0], asked.H[0, 0])


def _wrist_point(asked: Asked, plane: Plane) -> tuple[float, float]:
    """The point that the first two links have to reach, from the first axis."""
    point = complex(asked.H[0, 3], asked.H[1, 3]) - plane.before
    if len(plane.turning) == 3:
        turn = _heading(asked) - plane.kinks[2]
        point -= plane.links[2] * cmath.exp(1j * turn)
    return point.real, point.imag


def _back_from_the_hand(asked: Asked, plane: Plane, x: float, y: float) -> Step:
    """The last link has a known direction: go back along it."""
    phi, l3 = _heading(asked), abs(plane.links[2])
    o = asked.H[:3, 3]
    r = {"r_21": float(asked.H[1, 0]), "r_11": float(asked.H[0, 0])}
    equations = [Equation("phi", "atan2(r_21, r_11)", r, phi, "rad")]
    if l3 > TINY and plane.simple:
        given = {"x": float(o[0]), "y": float(o[1]), "l_3": l3, "phi": phi}
        equations += [
            Equation("x_w", "x - l_3 cos(phi)", given, x, "m"),
            Equation("y_w", "y - l_3 sin(phi)", given, y, "m"),
        ]
        words = (
            "The last link points along phi. Go back along it from the tool: the first two links "
            "have to reach (x_w, y_w)."
        )
    elif l3 > TINY:
        words = (
            "The direction phi of the tool is that of the last link, but for constants of the "
            "table. Go back along it: the first two links have to reach "
            f"({shown(x)}, {shown(y)}) m from axis 1."
        )
    else:
        words = "The last turning axis goes through the tool's origin, so phi does not move it."
    return Step("The direction", words, tuple(equations))


def _turned(plane: Plane, way: Way) -> tuple[float, dict[str, float]]:
    """Sum of the angles so far and of the constants, with the terms."""
    given = {f"theta_{i + 1}": way.variables[i] for i in plane.turning[:2]}
    constants = plane.first_kink + sum(plane.kinks)
    if constants:
        given["kappa"] = constants
    return sum(given.values()), given


def _agree(asked: Asked, plane: Plane, way: Way) -> Way:
    """Two joints cannot choose the direction: it is right or not."""
    phi, (both, given) = _heading(asked), _turned(plane, way)
    gap = math.remainder(both - phi, 2.0 * math.pi)
    r = {"r_21": float(asked.H[1, 0]), "r_11": float(asked.H[0, 0])}
    equations = (
        Equation("phi", "atan2(r_21, r_11)", r, phi, "rad"),
        Equation("theta_12", " + ".join(given), given, math.remainder(both, math.tau), "rad"),
    )
    if abs(gap) <= OFF:
        words = "The direction of link 2 is the sum of the angles, and it is the one asked for."
        return way.then(Step("The direction", words, equations))
    words = (
        f"The direction of link 2 is the sum of the angles. It misses the one asked for by "
        f"{shown(math.degrees(abs(gap)))} deg, and no joint is left to mend it: here this elbow "
        "ends. (The task position leaves the direction open.)"
    )
    return way.stop(Step("The direction", words, equations))


def _last(asked: Asked, plane: Plane, way: Way) -> Way:
    """The third angle makes the direction."""
    phi, last = _heading(asked), plane.turning[2]
    both, given = _turned(plane, way)
    formula = "phi - " + " - ".join(given)
    value = math.remainder(phi - both, 2.0 * math.pi)
    name = f"theta_{last + 1}"
    step = joint_step(
        asked.arm,
        last,
        f"{name}: what is left of the direction",
        "phi is the sum of the three angles.",
        [Equation(name, formula, given | {"phi": phi}, value, "rad")],
        value,
    )
    return way.then(step).put(last, value)
