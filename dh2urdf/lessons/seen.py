"""A point seen twice from axis 2 (Pieper 1968), and the steps that such views lead to.

From the base, the point is ``y = k + C c + S s`` (joint 1 turns) or ``k + C d`` (it slides); along
the arm ``v = m + E c + F s`` or ``m + E d`` with joint 3. Joint 2 turns v onto y, which keeps
height and length, or slides it there, which keeps x and y: two equations in joints 1 and 3.
"""

import math
from dataclasses import dataclass

import numpy as np

from dh2urdf.lessons.circle import Linear
from dh2urdf.lessons.notation import shown
from dh2urdf.lessons.steps import Equation, Step
from dh2urdf.lessons.way import Asked, Way, joint_step
from dh2urdf.transforms import Array, inverse

ON_AXIS = 1e-9
"""Distance [m] of a point from an axis at which the joint is free."""


@dataclass(frozen=True, eq=False)
class Seen:
    """A point that one joint moves: ``k + C cos x + S sin x``, or ``k + C x`` for a slide."""

    joint: int
    slides: bool
    k: Array
    C: Array
    S: Array

    def at(self, x: float) -> Array:
        """The point with the joint's DH variable at x."""
        if self.slides:
            point: Array = self.k + x * self.C
            return point
        return self.k + math.cos(x) * self.C + math.sin(x) * self.S

    @property
    def name(self) -> str:
        """The DH variable."""
        return f"{'d' if self.slides else 'theta'}_{self.joint + 1}"

    def part(self, axis: int) -> str:
        """One coordinate of the point, as a sum in the joint's variable."""
        k, C, S = (float(v[axis]) for v in (self.k, self.C, self.S))
        if self.slides:
            return summed([(k, ""), (C, self.name)])
        return summed([(k, ""), (C, f"cos {self.name}"), (S, f"sin {self.name}")])


def summed(terms: list[tuple[float, str]]) -> str:
    """A sum with its numbers, zeros left out."""
    out = ""
    for value, what in terms:
        if shown(value) == "0":
            continue
        sign = ("-" if value < 0.0 else "") if not out else (" - " if value < 0.0 else " + ")
        size = shown(abs(value))
        out += sign + (what if size == "1" and what else f"{size} {what}".rstrip())
    return out or "0"


def from_base(asked: Asked, point: Array) -> Seen:
    """The point in frame 1."""
    row, p = asked.arm.rows[0], np.append(point, 1.0)
    places = [(inverse(row.motion(x)) @ p)[:3] for x in _values(row.slides)]
    return _sampled(0, row.slides, places, float(np.abs(point).max()))


def along_arm(asked: Asked, tip: Array) -> Seen:
    """The tip in frame 1 with the variable of joint 2 at zero."""
    second, row, w = asked.arm.rows[1].motion(0.0), asked.arm.rows[2], np.append(tip, 1.0)
    places = [(second @ row.motion(x) @ w)[:3] for x in _values(row.slides)]
    return _sampled(2, row.slides, places, 1.0)


def _sampled(joint: int, slides: bool, f: "list[Array]", scale: float) -> Seen:
    """The columns of a point from three of its places: at 0, at 1 or half a turn, at a quarter."""
    zero, one, quarter = f
    if slides:
        columns = zero, one - zero, np.zeros(3)
    else:
        middle = 0.5 * (zero + one)
        columns = middle, zero - middle, quarter - middle
    clean = [np.where(np.abs(c) <= 1e-15 * max(scale, 1.0), 0.0, c) for c in columns]
    return Seen(joint, slides, *clean)


def _values(slides: bool) -> tuple[float, float, float]:
    return (0.0, 1.0, 0.0) if slides else (0.0, math.pi, 0.5 * math.pi)


def twice_seen(asked: Asked, y: Seen, v: Seen, what: str) -> Step:
    """Both views of the point, and the two equations."""
    flat = asked.arm.rows[1].slides
    lines = [f"y = ({', '.join(y.part(i) for i in range(3))})"]
    lines.append(f"v = ({', '.join(v.part(i) for i in range(3))})")
    if flat:
        how = "Joint 2 slides along z_1: x and y of both are the same, the difference of z is d_2."
    else:
        how = (
            "Joint 2 turns v about z_1 onto y: that changes neither z nor the length, so y_z = v_z "
            "and y_x^2 + y_y^2 + y_z^2 = v_x^2 + v_y^2 + v_z^2."
        )
    words = (
        f"Look at {what} from frame 1, where z_1 is the axis of joint 2: from the base as y, "
        f"which {y.name} moves, and along the arm, with joint 2 at zero, as v, which {v.name} "
        f"moves. {how} Two equations, and joint 2 is in neither."
    )
    return Step("Seen from axis 2", f"{words}\n\n" + "\n".join(["In frame 1 [m]:", *lines]))


def linear_step(
    asked: Asked, seen: Seen, linear: Linear, root: float, words: str, choice: str = ""
) -> Step:
    """A step that finds a turning joint from a linear equation."""
    equations = [
        Equation("A", "A", {}, linear.A),
        Equation("B", "B", {}, linear.B),
        Equation("C", "C", {}, linear.C),
        linear.equation(root),
    ]
    return joint_step(
        asked.arm, seen.joint, seen.name, f"{words} {linear.test}", equations, root, (), choice
    )


def freely(asked: Asked, way: Way, seen: Seen) -> Way:
    """A joint on whose axis the point is."""
    value = asked.free_value(seen.joint)
    words = (
        f"The point is on the axis of joint {seen.joint + 1}, which moves it nowhere: the joint is "
        "free, and stays where it is asked to be (at q = 0 if nothing is asked)."
    )
    equation = Equation(seen.name, seen.name, {}, value, "rad")
    step = joint_step(asked.arm, seen.joint, f"{seen.name}: free", words, [equation], value)
    return way.then(step).put(seen.joint, value)


def slid(asked: Asked, way: Way, seen: Seen, value: float, words: str, how: Equation) -> Way:
    """The way with a slide found."""
    step = joint_step(asked.arm, seen.joint, seen.name, words, [how], value)
    return way.then(step).put(seen.joint, value)
