"""Arms with a spherical wrist: kinematic decoupling, lecture notes 8.3."""

from collections.abc import Iterator

import numpy as np

from dh2urdf.lessons.notation import Given
from dh2urdf.lessons.position import place_wrist
from dh2urdf.lessons.steps import Equation, Mark, Step
from dh2urdf.lessons.way import Asked, Way
from dh2urdf.lessons.wrist import wrists
from dh2urdf.transforms import moved


def spherical_wrist(asked: Asked) -> Iterator[Way]:
    """All ways to a pose of a six-axis arm whose last three axes meet."""
    decoupled = Step(
        "What decouples",
        "Axes 4, 5 and 6 meet in one point, the wrist centre o_c. Joints 4, 5 and 6 turn the hand "
        "about it and do not move it. So o_c fixes joints 1, 2, 3 (a positioning problem), and "
        "what is left of the orientation joints 4, 5, 6: two problems with three unknowns each "
        "instead of one with six.",
    )
    way = Way().then(decoupled, _centre(asked))
    for placed in place_wrist(asked, way, np.asarray(way.steps[-1].value)):
        if placed.stopped:
            yield placed
        else:
            yield from wrists(asked, placed)


def _centre(asked: Asked) -> Step:
    """``o_c = o - d_6 R e_3``, equation (5) of the notes."""
    arm, o, R = asked.arm, asked.H[:3, 3], asked.H[:3, :3]
    d6, a6 = arm.rows[5].d, arm.rows[5].a
    centre = o - d6 * R[:, 2] - a6 * R[:, 0]
    given: Given = {"o": o, "d_6": d6, "R": R, "k": R[:, 2], "a_6": a6, "i": R[:, 0]}
    beside, via = (" - a_6 R e_1", " - a_6 i") if a6 else ("", "")
    equation = Equation("o_c", "o - d_6 R e_3" + beside, given, centre, "m", via="o - d_6 k" + via)
    ends = moved(arm.base, np.stack([o, centre]))
    marks = Mark("line", ends, "d_6"), Mark("point", ends[1:], "o_c")
    words = (
        f"Frame 6 is d_6 = {d6:.6g} m beyond the wrist centre along z_6 = R e_3, the third column "
        "of R: go back that far."
        if d6
        else "d_6 = 0: frame 6 is at the wrist centre already."
    )
    if a6:
        words += f" Beside axis 6 it is a_6 = {a6:.6g} m along x_6 = R e_1."
    return Step("The wrist centre", words, (equation,), marks=marks)
