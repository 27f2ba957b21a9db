"""The planar arms of lecture notes 8.2, RR and RRR, and SCARA arms, which also slide."""

import cmath
import math
from collections.abc import Iterator

import numpy as np

from dh2urdf.lessons.marks import Mark
from dh2urdf.lessons.marks import triangle as triangle_marks
from dh2urdf.lessons.notation import shown
from dh2urdf.lessons.steps import Equation, Step
from dh2urdf.lessons.triangle import Elbow, Letters, Triangle
from dh2urdf.lessons.way import Asked, Way, joint_step

OFF = 2e-9
"""Distance [m] or angle [rad] by which a pose may miss the plane: twice what a residual may be."""

TINY = 1e-14


class Plane:
    """What the rows of an arm with parallel axes are, looked at along the axes.

    ``turning`` joints (from 0), the ``slide`` or None; ``links``: the way to the next axis, or to
    the last frame, in the frame that a joint turned; ``kinks``: how x turns on that way.
    """

    def __init__(self, asked: Asked, tip: complex) -> None:
        rows = asked.arm.rows
        self.turning = [i for i, row in enumerate(rows) if not row.slides]
        self.slide = next((i for i, row in enumerate(rows) if row.slides), None)
        self.before, start = 0j, rows[: self.turning[0]]
        self.first_kink = sum(row.theta for row in start)
        for row in start:
            self.before += row.a * cmath.exp(1j * row.theta)
        self.links, self.kinks = [], []
        for k, i in enumerate(self.turning):
            after = [*self.turning, len(rows)][k + 1]
            link, kink = complex(rows[i].a), 0.0
            for row in rows[i + 1 : after]:
                kink += row.theta
                link += row.a * cmath.exp(1j * kink)
            self.links.append(link)
            self.kinks.append(kink)
        self.links[-1] += tip * cmath.exp(1j * self.kinks[-1])

    @property
    def simple(self) -> bool:
        """Whether every link is its row's a, along x."""
        bends = [*self.kinks, self.first_kink, *(z.imag for z in self.links), abs(self.before)]
        return not any(bends) and all(z.real >= 0.0 for z in self.links)


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
    for found in _elbows(asked, plane, way, x, y):
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


def _elbows(asked: Asked, plane: Plane, way: Way, x: float, y: float) -> Iterator[Way]:
    """The first two turning joints, by the triangle."""
    z1, z2 = plane.links[:2]
    one, two = (i + 1 for i in plane.turning[:2])
    wrist = len(plane.turning) == 3 and abs(plane.links[2]) > TINY
    bent1 = cmath.phase(z1)
    bent2 = plane.kinks[0] + cmath.phase(z2) - bent1
    names = (f"theta_{one}", f"theta_{two}") if not bent1 and not bent2 else ("t_1", "t_2")
    letters = Letters(
        *(("x_w", "y_w") if wrist else ("x", "y")),
        shoulder=names[0],
        elbow=names[1],
        cosine=f"c_{two}",
        sine=f"s_{two}",
        tip="The wrist point" if wrist else "The point",
    )
    triangle = Triangle(letters, abs(z1), abs(z2), x, y)
    given = {letters.x: x, letters.y: y}
    root = Equation("r", f"sqrt({letters.x}^2 + {letters.y}^2)", given, triangle.distance, "m")
    words = (
        f"Look at the square of the distance: {letters.x}^2 + {letters.y}^2 = l_1^2 + l_2^2 + "
        f"2 l_1 l_2 c_{two} does not depend on theta_{one}, so it gives theta_{two}. "
        f"l_1 = {shown(abs(z1))} m, l_2 = {shown(abs(z2))} m. {triangle.test}"
    )
    test = Step("The triangle", words, (root, triangle.cosine))
    if not triangle.reaches:
        yield way.stop(test)
        return
    way = way.then(test)
    if triangle.distance <= 1e-10 * triangle.far:
        yield _folded(asked, plane, way)
        return
    elbows = triangle.elbows()
    for elbow in elbows:
        middle = plane.before + abs(z1) * cmath.exp(1j * elbow.shoulder)
        tip = plane.before + complex(x, y)
        flat = [(z.real, z.imag, asked.H[2, 3]) for z in (plane.before, middle, tip)]
        sides = triangle_marks(asked.arm.base, np.array(flat), ("l_1", "l_2", "r"))
        yield _bent(asked, plane, way, elbow, len(elbows), (bent1, bent2), names, sides)


def _bent(
    asked: Asked,
    plane: Plane,
    way: Way,
    elbow: Elbow,
    count: int,
    bends: tuple[float, float],
    names: tuple[str, str],
    sides: tuple[Mark, ...],
) -> Way:
    """One elbow: its joint, then the first one."""
    one, two = plane.turning[:2]
    if count == 1:
        words = "The arm is stretched or folded: the two elbows are one."
    else:
        sign = "negative" if elbow.elbow < 0.0 else "positive"
        words = f"The cosine does not tell the sign: elbow up or down. Here it is {sign}."
    values = elbow.shoulder - bends[0] - plane.first_kink, elbow.elbow - bends[1]
    equations = [elbow.shoulder_equations, elbow.elbow_equations[1:]]
    offsets = bends[0] + plane.first_kink, bends[1]
    for k, joint in enumerate((one, two)):
        if offsets[k]:
            letter, at = f"beta_{joint + 1}", {names[k]: (elbow.shoulder, elbow.elbow)[k]}
            given = at | {letter: offsets[k]}
            formula, name = f"{names[k]} - {letter}", f"theta_{joint + 1}"
            value = math.remainder(values[k], 2.0 * math.pi)
            equations[k] = [*equations[k], Equation(name, formula, given, value, "rad")]
    second = joint_step(
        asked.arm,
        two,
        f"theta_{two + 1}: the elbow",
        words,
        equations[1],
        values[1],
        sides,
        "elbow",
    )
    first = joint_step(
        asked.arm,
        one,
        f"theta_{one + 1}: the four-quadrant arctangent",
        f"atan2 gives the direction of the point; gamma is the angle in the triangle at axis "
        f"{one + 1}, between the first link and that direction.",
        equations[0],
        values[0],
        sides,
    )
    return way.then(second, first).put(one, values[0]).put(two, values[1])


def _folded(asked: Asked, plane: Plane, way: Way) -> Way:
    """Two links of one length, folded back: the point is on axis 1, and joint 1 is free."""
    one, two = plane.turning[:2]
    bend = math.pi - plane.kinks[0] - cmath.phase(plane.links[1]) + cmath.phase(plane.links[0])
    value = asked.free_value(one)
    second = joint_step(
        asked.arm,
        two,
        f"theta_{two + 1}: folded",
        "The point is on axis 1: link 2 lies back on link 1.",
        [Equation(f"theta_{two + 1}", "pi", {}, bend, "rad")],
        bend,
    )
    first = joint_step(
        asked.arm,
        one,
        f"theta_{one + 1}: free",
        "Turning the folded arm moves the point nowhere: the angle is free, and stays where it is "
        "asked to be (at 0 if nothing is asked).",
        [Equation(f"theta_{one + 1}", f"theta_{one + 1}", {}, value, "rad")],
        value,
    )
    return way.then(second, first).put(one, value).put(two, bend)


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
