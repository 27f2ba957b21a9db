"""What a picture of a step draws: lines, arcs, frames and points, in the base frame."""

import math
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from dh2urdf.lessons.arm import Arm
from dh2urdf.transforms import Array, moved

ARC = 0.16
"""Radius of an arc, as a share of the arm's lengths."""

POINTS = 25
"""On an arc."""


LEVEL = 1e-6
"""Height of an elbow above the line that it bends from, as a share of the link, that is none."""


@dataclass(frozen=True, eq=False)
class Mark:
    """Something that a picture of a step draws.

    Parameters
    ----------
    kind : str
        ``line``, ``arc``, ``frame`` or ``point``.
    points : array
        A line's points (k, 3), an arc's centre and then its points (k, 3), a point (1, 3), all
        in [m]; a frame's pose (4, 4).
    label : str
        The letter of the formulas.
    """

    kind: Literal["line", "arc", "frame", "point"]
    points: Array
    label: str = ""

    def seen_from(self, T: Array) -> "Mark":
        """The mark with its coordinates taken on by a pose T (4, 4)."""
        points = T @ self.points if self.kind == "frame" else moved(T, self.points)
        return replace(self, points=points)


def triangle(base: Array, corners: Array, sides: tuple[str, str, str]) -> tuple[Mark, ...]:
    """Three sides with their letters, corners (3, 3) in frame 0."""
    a, b, c = moved(base, corners)
    ends = (a, b), (b, c), (a, c)
    return tuple(Mark("line", np.stack(e), s) for e, s in zip(ends, sides, strict=True))


def elbow_side(marks: tuple[Mark, ...], axis: Array) -> Literal["upper", "lower", ""]:
    """Which of the two elbows along z a :func:`triangle` in the base has; empty of level ones.

    The triangle is seen along the elbow's axis (3,): sides may be offset along it.
    """
    lines = [mark.points for mark in marks if mark.kind == "line"][:3]
    if len(lines) < 3:
        return ""
    sides = np.stack([lines[0][1] - lines[0][0], lines[2][1] - lines[2][0]])
    away, straight = sides - np.outer(sides @ axis, axis)
    square = float(straight @ straight)
    above = away - (away @ straight) / square * straight if square else away
    if abs(above[2]) <= LEVEL * float(np.linalg.norm(away)):
        return ""
    return "upper" if above[2] > 0.0 else "lower"


def joint_mark(arm: Arm, variables: list[float], joint: int) -> Mark:
    """The arc about the joint's axis from x_{i-1} to x_i, or the way that a slide goes."""
    row, frame = arm.rows[joint], arm.frames(variables)[joint]
    value, i = variables[joint], joint + 1
    if row.slides:
        ends = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, value]])
        return Mark("line", moved(arm.base @ frame, ends), f"d_{i}")
    radius = ARC * max(sum(math.hypot(r.a, r.d) for r in arm.rows), 1e-3)
    turn = np.linspace(0.0, value, POINTS)
    lift = np.full(POINTS, row.d)
    ring = np.column_stack([radius * np.cos(turn), radius * np.sin(turn), lift])
    around = np.vstack([[0.0, 0.0, row.d], ring])
    return Mark("arc", moved(arm.base @ frame, around), f"theta_{i}")
