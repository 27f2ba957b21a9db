"""What ``--explain`` prints: the way to one of the solutions, step by step."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from dh2urdf.exceptions import ArgumentError
from dh2urdf.transforms import Array

if TYPE_CHECKING:
    from dh2urdf.ik.problem import IKSolutions
    from dh2urdf.lessons import IKExplanation
    from dh2urdf.robot import Robot


def explained(
    arm: Robot, found: IKSolutions, number: int | None, T: Array, options: dict[str, Any]
) -> IKExplanation:
    """The worked solution of a pose, to the solution of a number in the table that is printed."""
    wanted = (number or 1) - 1
    if number is not None and wanted >= len(found):
        there = f"there are {len(found)}" if found else "there is none"
        raise ArgumentError(f"--solution: no solution {number}, {there}")
    asked = {key: value for key, value in options.items() if key != "nearest"}
    if not found:
        return arm.explain_ik(found.T, **asked)
    return arm.explain_ik(found, wanted, locked=asked["locked"], task=asked["task"])


def lesson_text(lesson: IKExplanation, form: str) -> str:
    """The worked solution as text, Markdown or LaTeX."""
    if form == "latex":
        return lesson.latex
    return lesson.text if form == "text" else lesson.markdown
