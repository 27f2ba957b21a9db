"""What inverse kinematics answered, in words and as a table with the ghosts' colours."""

from dataclasses import dataclass, replace
from html import escape
from typing import Self

import numpy as np

from dh2urdf.dh_io import Units
from dh2urdf.drawing.colours import BRANCH_COLOURS
from dh2urdf.drawing.readings import MINUS, Reading, reading, scale_of, sign_of
from dh2urdf.exceptions import Dh2UrdfError
from dh2urdf.robot import Robot
from dh2urdf.transforms import Array
from dh2urdf.viewer.tabs.html import FAINT, MARKED, NUMBERS, STYLE, number
from dh2urdf.viewer.tabs.joints_tab import kinds_of

SAME = 1e-4
"""Difference [rad or m] up to which the arm stands at a solution."""

TIGHT = "text-align:right;padding:1px 3px;white-space:nowrap;font-size:11px;"
COLUMN_DIGITS = {"m": 4, "mm": 1, "deg": 1, "rad": 3}
"""Digits after the point of joint values, by unit."""

TO_BUTTON = (
    "[...document.querySelectorAll('button')].find(b => b.textContent.trim() === '{0}')?.click()"
)
"""Script of a table row: press the button of that number."""


@dataclass(frozen=True, eq=False)
class Answer:
    """All solutions q (k, n) of a target, and words on what was found, or why nothing.

    ``free`` are the joints free along singular families, ``current`` is the solution where the
    arm stands, -1 for none, and ``nearest`` (n,) the one nearest to it.
    """

    words: str
    q: Array
    residual: Array
    branch: tuple[str, ...]
    free: tuple[tuple[int, ...], ...]
    current: int
    nearest: Array | None

    def at(self, q: Array) -> Self:
        """The same answer with the arm at another configuration."""
        return replace(self, current=_standing(self.q, q, self.free))


def answer(
    robot: Robot, T: Array, q: Array, *, task: str, within: bool, locked: dict[int, float] | None
) -> Answer:
    """All solutions of a target, or a word on why there is none."""
    try:
        found = robot.ik(T, within_limits=within, task=task, locked=locked)
        nearest = found.nearest(q) if len(found) else None
    except Dh2UrdfError as error:
        return _none(robot, str(error).partition("\n")[0])
    if nearest is None:
        outside = robot.ik(T, within_limits=False, task=task, locked=locked) if within else ()
        return _none(robot, _why(len(outside)))
    rows, residual, free = np.array(found.q), np.array(found.residual), found.free_joints
    reached = float(np.abs(robot.fk(q) - T).max()) < SAME
    current = _standing(rows, q, free if reached else ())
    words = _count_words(len(rows), free, robot)
    return Answer(words, rows, residual, found.branch, free, current, nearest)


def _none(robot: Robot, words: str) -> Answer:
    return Answer(words, np.empty((0, robot.n)), np.empty(0), (), (), -1, None)


def _why(outside: int) -> str:
    """Tell whether limits or reach stand in the way, by the solutions outside the limits."""
    if not outside:
        return "Out of reach: no configuration takes the tip there."
    many = "one solution lies" if outside == 1 else f"all {outside} solutions lie"
    return f"Not within the joint limits: {many} outside them."


def _count_words(count: int, free: tuple[tuple[int, ...], ...], robot: Robot) -> str:
    words = "One solution." if count == 1 else f"{count} solutions."
    joints = sorted({j for group in free for j in group})
    if joints:
        names = ", ".join(robot.joint_names[j] for j in joints)
        words += f" Singular: {names} can move without moving the tip."
    return words


def _standing(rows: Array, q: Array, free: tuple[tuple[int, ...], ...]) -> int:
    """The row that is q up to full turns and up to joints that are free there, -1 for none."""
    if not len(rows):
        return -1
    away = np.abs(np.remainder(rows - q + np.pi, 2 * np.pi) - np.pi)
    for k, joints in enumerate(free):
        away[k, list(joints)] = 0.0
    best = int(np.argmin(away.max(axis=1)))
    return best if float(away[best].max()) < SAME else -1


def initials(branch: str) -> str:
    """``shoulder left, elbow up, wrist no flip`` as ``L U N``."""
    parts = [part.split() for part in branch.split(", ") if part]
    return " ".join(part[1][0].upper() for part in parts if len(part) > 1)


def _legend(robot: Robot, units: Units, branch: tuple[str, ...]) -> str:
    """Units of the joints' values, and what the letters of the branches mean."""
    kinds = kinds_of(robot)
    said = []
    for kind in sorted(set(kinds)):
        names = [f"q{i}" for i, own in enumerate(kinds, 1) if own is kind]
        said.append(f"{', '.join(names) if len(set(kinds)) > 1 else 'q'} in {sign_of(units, kind)}")
    said += branch_letters(branch)
    return f'<div style="{STYLE}color:#46505f">{" · ".join(said)}</div>'


def branch_letters(branch: tuple[str, ...]) -> list[str]:
    """What the letters mean: ``shoulder Left Right``, ``elbow Up Down``, initials in bold."""
    words: dict[str, dict[str, None]] = {}
    for part in (part for name in branch for part in name.split(", ") if " " in part):
        what, _, which = part.partition(" ")
        words.setdefault(what, {})[which] = None
    return [
        f"{escape(what)} "
        + " ".join(f"<b>{escape(w[0].upper())}</b>{escape(w[1:])}" for w in which)
        for what, which in words.items()
    ]


def branch_table(found: Answer, robot: Robot, units: Units) -> str:
    """A line a solution: colour, branch, joint values, residual; the arm's own is marked.

    Values outside the limits are red, joints that are free at a singularity underlined.
    """
    named = any(found.branch)
    joints = [f"q{i}" for i in range(1, robot.n + 1)]
    head = ["", *(["branch"] if named else []), *joints, "residual"]
    header = "".join(f'<th style="{TIGHT}font-weight:600">{h}</th>' for h in head)
    lines = [_line(found, robot, units, k, named=named) for k in range(len(found.q))]
    return (
        f'<div style="{STYLE}"><table style="border-collapse:collapse" data-ik="branches">'
        f"<thead><tr>{header}</tr></thead><tbody>{''.join(lines)}</tbody></table></div>"
        f"{_legend(robot, units, found.branch)}"
    )


def _line(found: Answer, robot: Robot, units: Units, k: int, *, named: bool) -> str:
    colour = BRANCH_COLOURS[k % len(BRANCH_COLOURS)]
    square = (
        f'<span style="display:inline-block;width:10px;height:10px;background:{colour}"></span>'
    )
    cells = [f'<td style="{TIGHT}">{square} {k + 1}</td>']
    if named:
        branch = escape(found.branch[k])
        cells.append(f'<td style="{TIGHT}" title="{branch}">{initials(found.branch[k])}</td>')
    for j, (value, kind) in enumerate(zip(found.q[k], kinds_of(robot), strict=True)):
        outside = not robot.lower[j] - 1e-9 <= value <= robot.upper[j] + 1e-9
        style = "color:#b3261e;" if outside else ""
        style += "text-decoration:underline;" if j in found.free[k] else ""
        places = COLUMN_DIGITS[units.of(kind)]
        rounded = round(float(value) * scale_of(units, kind), places) + 0.0
        text = f"{rounded:.{places}f}".replace("-", MINUS)
        cell = number(Reading(text, reading(float(value), kind, units).exact))
        cells.append(f'<td style="{TIGHT}{NUMBERS}{style}">{cell}</td>')
    residual = f"{found.residual[k]:.0e}".replace("-", MINUS)
    cells.append(f'<td style="{TIGHT}{NUMBERS}color:{FAINT}">{residual}</td>')
    marked = MARKED if k == found.current else ""
    script = TO_BUTTON.format(k + 1)
    return f'<tr style="cursor:pointer;{marked}" onclick="{script}">{"".join(cells)}</tr>'
