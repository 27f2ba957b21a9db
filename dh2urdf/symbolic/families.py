"""Which arms have formulas, and the steps of each family.

Decoupling at a spherical wrist (lecture notes 8.3), three parallel axes (Hawkins 2013; Elias and
Wen 2024), planar arms and SCARA (8.2), three joints that place a point; and the mirrored families.
"""

from collections.abc import Callable
from dataclasses import dataclass

import sympy as sp

from dh2urdf.exceptions import NoSolverError
from dh2urdf.symbolic.formulas import Formulas, Step
from dh2urdf.symbolic.letters import Letters
from dh2urdf.symbolic.parallel import before_last, first_parallel, second_parallel
from dh2urdf.symbolic.planar import planar, sliding_planar
from dh2urdf.symbolic.position import place
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
    centre = before_last(F, arm)
    F.heading("The first three joints put the wrist centre there")
    if reason := place(F, first, centre, (sp.S.Zero, sp.S.Zero, wrist[0].d)):
        return reason
    F.heading("What is left of the orientation is the wrist's")
    orient(F, wrist, rotation(F, first), arm.R * wrist[2].twist.T)
    return None


def positioning(F: Formulas, arm: Letters) -> str | None:
    """Three joints that put the tool at a point."""
    if len(arm.links) != 3:
        return "it has not three joints"
    F.heading("Three joints put the origin of the last frame at p")
    centre = tuple(F.let(f"p_{axis}", v) for axis, v in zip("xyz", arm.p, strict=True))
    return place(F, arm.links, centre, (sp.S.Zero,) * 3)


FAMILIES: dict[str, Family] = {
    "spherical wrist": spherical_wrist,
    "three parallel axes": second_parallel,
    "three parallel axes, the first": first_parallel,
    "planar arm": planar,
    "planar arm with a slide": sliding_planar,
    "three joints that place a point": positioning,
}
"""Families that have formulas, best first; those of :data:`FROM_TOOL` also seen from the tool."""

FROM_TOOL = {
    "spherical wrist": "spherical shoulder",
    "three parallel axes": "three parallel axes",
    "three parallel axes, the first": "three parallel axes, the last",
}

COVERED = (
    "formulas cover: spherical wrists (or shoulders) with any three joints for the position that "
    "need no quartic; three neighbouring parallel axes, of six joints with 5 meeting 6 (or 1 "
    "meeting 2), of four or five joints 2, 3 and 4; planar arms and SCARA arms; and three joints "
    "that place a point"
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
