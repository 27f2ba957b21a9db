"""The elbow of planar arms: two links and the way to a point, by the law of cosines."""

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

TINY = 1e-14
"""Length [m] of a last link that is none."""


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


def elbows(asked: Asked, plane: Plane, way: Way, x: float, y: float) -> Iterator[Way]:
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
    both = triangle.elbows()
    for elbow in both:
        middle = plane.before + abs(z1) * cmath.exp(1j * elbow.shoulder)
        tip = plane.before + complex(x, y)
        flat = [(z.real, z.imag, asked.H[2, 3]) for z in (plane.before, middle, tip)]
        sides = triangle_marks(asked.arm.base, np.array(flat), ("l_1", "l_2", "r"))
        yield _bent(asked, plane, way, elbow, len(both), (bent1, bent2), names, sides)


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
