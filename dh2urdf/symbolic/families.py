"""Which arms have formulas, and the steps of each family.

Decoupling at a spherical wrist (lecture notes 8.3), three parallel axes (Hawkins 2013; Elias and
Wen 2024), planar arms and SCARA (8.2), three joints that place a point; and the mirrored families.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import sympy as sp

from dh2urdf.exceptions import NoSolverError
from dh2urdf.symbolic.formulas import Formulas, Step
from dh2urdf.symbolic.letters import Letters, Link
from dh2urdf.symbolic.planar import planar, sliding_planar
from dh2urdf.symbolic.position import first_of_parallel, place
from dh2urdf.symbolic.wrist import orient, rotation

Family = Callable[[Formulas, Letters], str | None]


def spherical_wrist(F: Formulas, arm: Letters) -> str | None:
    """Axes 4, 5, 6 meet: first the wrist centre, then the orientation."""
    if len(arm.links) != 6:
        return "it has not six joints"
    first, wrist = arm.links[:3], arm.links[3:]
    if any(link.slides for link in wrist) or 0 in (wrist[0].sa, wrist[1].sa):
        return "its last three joints are no wrist"
    if any((wrist[0].a, wrist[1].a, wrist[1].d)):
        return "the axes of its last three joints do not meet in one point"
    F.heading("The wrist centre, where the axes of the last three joints meet")
    centre = _before(F, arm)
    F.heading("The first three joints put the wrist centre there")
    if reason := place(F, first, centre, (sp.S.Zero, sp.S.Zero, wrist[0].d)):
        return reason
    F.heading("What is left of the orientation is the wrist's")
    orient(F, wrist, rotation(F, first), arm.R * wrist[2].twist.T)
    return None


def _before(F: Formulas, arm: Letters) -> tuple[Any, Any, Any]:
    """Origin of the last frame but one, ``o_c = p - R (a_n, 0, d_n)`` for alpha_n = 0."""
    last = arm.links[-1]
    centre = arm.p - arm.R * last.twist.T * sp.Matrix([last.a, 0, last.d])
    x, y, z = (F.let(f"{axis}_c", value) for axis, value in zip("xyz", centre, strict=True))
    return x, y, z


def three_parallel(F: Formulas, arm: Letters) -> str | None:
    """Axes 2, 3, 4 are parallel and 5 meets 6."""
    if arm.kinds != "RRRRRR":
        return "it has not six joints that turn"
    one, two, three, four, five, six = arm.links
    if two.sa != 0 or three.sa != 0:
        return "its axes 2, 3 and 4 are not parallel"
    if five.a != 0:
        return "its axes 5 and 6 do not meet"
    if 0 in (one.sa, four.sa, five.sa, two.a, three.a):
        return "some of its joints do the same"
    F.heading("The point where axes 5 and 6 meet")
    centre = _before(F, arm)
    F.heading("Joint 1 puts it as far along axis 2 as the offsets say")
    ways = two.ca, two.ca * three.ca
    height = two.d + ways[0] * three.d + ways[1] * (four.d + four.ca * five.d)
    X, Y = first_of_parallel(F, one, centre, height)
    F.heading("The orientation gives joints 5 and 6, and the sum of 2, 3, 4")
    together = _together(arm)
    orient(F, (together, five, six), one.rotation, arm.R * six.twist.T)
    F.heading("Joints 2, 3, 4 are a planar arm")
    tail = together.turned((four.a, -together.sa * five.d, sp.S.Zero))
    X, Y = F.let("X_4", X - tail[0], always=True), F.let("Y_4", Y - tail[1], always=True)
    reach = X**2 + Y**2 - two.a**2 - three.a**2
    F.meet(three, 2 * two.a * three.a * three.c - reach)
    F.point(two, two.a + three.a * three.c, ways[0] * three.a * three.s, X, Y)
    angles = {n: sp.Symbol(f"theta_{n.label}") for n in (together, one, two, three)}
    sums = together.way * angles[together] - two.way * angles[two]
    F.angle(four, ways[1] * (sums - ways[0] * three.way * angles[three]))
    return None


def _together(arm: Letters) -> Link:
    """Joints 2, 3, 4 as one that turns about axis 2, ``theta_2 +- theta_3 +- theta_4``."""
    two, three, four = arm.links[1:4]
    way, names = two.ca * three.ca, sorted(link.label for link in (two, three, four))
    label = "".join(names)
    c, s = sp.symbols(f"c_{label} s_{label}")
    return replace(four, label=label, c=c, s=two.way * s, ca=way * four.ca, sa=way * four.sa)


def positioning(F: Formulas, arm: Letters) -> str | None:
    """Three joints that put the tool at a point."""
    if len(arm.links) != 3:
        return "it has not three joints"
    F.heading("Three joints put the origin of the last frame at p")
    centre = tuple(F.let(f"p_{axis}", v) for axis, v in zip("xyz", arm.p, strict=True))
    return place(F, arm.links, centre, (sp.S.Zero,) * 3)


FAMILIES: dict[str, Family] = {
    "spherical wrist": spherical_wrist,
    "three parallel axes": three_parallel,
    "planar arm": planar,
    "planar arm with a slide": sliding_planar,
    "three joints that place a point": positioning,
}
"""Families that have formulas, best first; the first two seen from the tool as well."""

FROM_TOOL = {"spherical wrist": "spherical shoulder", "three parallel axes": "three parallel axes"}

COVERED = (
    "formulas cover: spherical wrists (or shoulders) with any three joints for the position that "
    "need no quartic, three parallel axes 2, 3, 4 with 5 meeting 6 (or 3, 4, 5 with 1 meeting 2), "
    "planar arms and SCARA arms, and three joints that place a point"
)


@dataclass(frozen=True)
class Derivation:
    """The family of an arm, and the steps of its solution."""

    arm: Letters
    family: str
    steps: tuple[Step, ...]


def derive(arm: Letters) -> Derivation:
    """The formulas of an arm.

    Raises
    ------
    NoSolverError
        None has formulas for it; the message says which do.
    """
    reasons = []
    for name, family in FAMILIES.items():
        F = Formulas()
        reason = family(F, arm)
        if reason is None:
            return Derivation(arm, name, tuple(F.steps))
        reasons.append(f"{name}: {reason}")
    for name, mirrored in FROM_TOOL.items():
        F = Formulas()
        if FAMILIES[name](F, arm.reversed()) is None:
            return Derivation(arm, f"{mirrored}, seen from the tool", tuple(F.steps))
    raise NoSolverError(f"{COVERED}. This arm is none: {'; '.join(reasons)}")
