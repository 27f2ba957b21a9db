"""What is said of the solutions of one pose: a table that fits the terminal, or plain values."""

from __future__ import annotations

import math
import shutil
import sys
import textwrap
from typing import TYPE_CHECKING, Any

import numpy as np

from dh2urdf.cli.progress import note
from dh2urdf.exceptions import NotOrthoParallelError
from dh2urdf.grids import grid_text, number
from dh2urdf.transforms import Array

if TYPE_CHECKING:
    from dh2urdf.ik.problem import IKSolutions
    from dh2urdf.robot import Robot

FINE, COARSE = {"deg": 4, "rad": 6, "m": 6}, {"deg": 2, "rad": 4, "m": 4}
"""Decimals of joint values where there is room for them, and where there is not."""


def outside(arm: Robot, q: Array) -> Array:
    """Excess of each joint over its limits, 0 inside, shape (k, n)."""
    excess: Array = np.maximum(np.maximum(arm.lower - q, q - arm.upper), 0.0)
    return np.where(excess > 1e-12, excess, 0.0)


def names_of(arm: Robot, over: Array) -> list[str]:
    """The joints outside their limits."""
    return [arm.joint_names[j] for j in np.flatnonzero(over)]


def joint_heads(arm: Robot, *, deg: bool) -> list[str]:
    """Headings of joint columns of a file, with the unit where it is not that of the package."""
    turns = zip(arm.joint_names, arm.slides, strict=True)
    return [f"{name} [deg]" if deg and not slides else name for name, slides in turns]


def words_of(found: IKSolutions, maker: str | None) -> list[str]:
    """A controller's word of each solution, or no text."""
    if maker is None:
        return [""] * len(found)
    try:
        return [str(word) for word in found.words(maker)]
    except NotOrthoParallelError as error:
        raise NotOrthoParallelError(f"--words {maker}: {error}") from None


def as_data(arm: Robot, found: IKSolutions, maker: str | None = None) -> dict[str, Any]:
    """The solutions as plain values: metres and radians, full precision."""
    over_limits = outside(arm, found.q)
    words = [{"word": word} if maker else {} for word in words_of(found, maker)]
    return {
        "base": arm.base,
        "tip": arm.tip,
        "T_base_tip": found.T,
        "pose_change": found.pose_change,
        "joint_names": arm.joint_names,
        "solutions": [
            {
                "q": q,
                "residual": float(residual),
                "branch": branch,
                "free_joints": [arm.joint_names[i] for i in free],
                "outside_limits": names_of(arm, over),
                **word,
            }
            for q, residual, branch, free, over, word in zip(
                *(found.q, found.verify(), found.branch, found.free_joints, over_limits, words),
                strict=True,
            )
        ],
    }


def solutions_text(arm: Robot, found: IKSolutions, *, deg: bool, maker: str | None = None) -> str:
    """Solutions for people: values, residual by Pinocchio, controller's word, branch, remarks.

    Where a terminal is too narrow for a line a solution, the values have fewer digits and the
    branch stands below them.
    """
    units = ["m" if slides else "deg" if deg else "rad" for slides in arm.slides]
    heads = [f"{name} [{unit}]" for name, unit in zip(arm.joint_names, units, strict=True)]
    remarks = _remarks(arm, found, deg, maker)
    rows = [[*row, remark] for row, remark in zip(_rows(found, units, FINE), remarks, strict=True)]
    text = grid_text(["#", *heads, "residual", "branch"], rows, left={len(heads) + 2})
    width = shutil.get_terminal_size().columns if sys.stdout.isatty() else len(text)
    if max(map(len, text.splitlines())) <= width:
        return text
    short = [f"q{i}" for i in range(1, len(heads) + 1)]
    each = (
        f"{q} {head}".replace(" ", "\N{NO-BREAK SPACE}")
        for q, head in zip(short, heads, strict=True)
    )
    legend = textwrap.fill(", ".join(each), width).replace("\N{NO-BREAK SPACE}", " ")
    head, *lines = grid_text(["#", *short, "residual"], _rows(found, units, COARSE)).splitlines()
    below = ["", *("\n" + _indented(remark, width) if remark else "" for remark in remarks)]
    lines = [line + more for line, more in zip(lines, below, strict=True)]
    return "\n".join([legend, head, *lines])


def _indented(text: str, width: int) -> str:
    """A text in lines of some width that stand in from the left."""
    return textwrap.fill(text, width, initial_indent="    ", subsequent_indent="    ")


def _rows(found: IKSolutions, units: list[str], digits: dict[str, int]) -> list[list[str]]:
    """Number, joint values and residual of each solution."""
    return [
        [str(i), *(_shown(v, u, digits) for v, u in zip(q, units, strict=True)), f"{residual:.1e}"]
        for i, (q, residual) in enumerate(zip(found.q, found.verify(), strict=True), 1)
    ]


def _remarks(arm: Robot, found: IKSolutions, deg: bool, maker: str | None) -> list[str]:
    """Controller's word, branch, free joints and joints outside their limits of each solution."""
    units = ["m" if slides else "deg" if deg else "rad" for slides in arm.slides]
    remarks = []
    words = words_of(found, maker)
    for word, branch, free, over in zip(
        words, found.branch, found.free_joints, outside(arm, found.q), strict=True
    ):
        parts = [part for part in (word, branch) if part]
        parts += [f"free: {', '.join(arm.joint_names[j] for j in free)}"] if free else []
        far = [
            f"{arm.joint_names[j]} by {_shown(over[j], units[j], FINE)}"
            for j in np.flatnonzero(over)
        ]
        parts += [f"outside limits: {', '.join(far)}"] if far else []
        remarks.append("; ".join(parts))
    return remarks


def _shown(value: float, unit: str, digits: dict[str, int]) -> str:
    """A joint value in its unit, with so many decimals."""
    return number(round(math.degrees(value) if unit == "deg" else value, digits[unit]))


def reason_of(
    arm: Robot,
    T: Array,
    near: dict[str, Any],
    options: dict[str, Any],
    found: IKSolutions | None = None,
) -> str:
    """Why there is no solution within the limits; empty if there is one."""
    found = arm.ik(T, **near, **options) if found is None else found
    if found and (outside(arm, found.q) == 0.0).all(axis=1).any():
        return ""
    if not found and "seed_tolerance" in near:
        others = arm.ik(T, **{**near, **options, "seed_tolerance": None})
        if others:
            return _too_far(arm, others, near)
    return arm.why_unreachable(T, **{**options, "within_limits": True})


def _too_far(arm: Robot, others: IKSolutions, near: dict[str, Any]) -> str:
    """By how much the nearest of solutions is farther from the seed than is allowed."""
    excess = others.gaps(near["seed"]) - near["seed_tolerance"]
    nearest = excess[excess.max(axis=1).argmin()]
    worst = int(nearest.argmax())
    by = f"{nearest[worst]:.4g} {'m' if arm.slides[worst] else 'rad'}"
    return (
        f"all {len(others)} solutions are farther from the seed than --seed-tolerance allows, the "
        f"nearest by {by} at {arm.joint_names[worst]}"
    )


def tell_change(change: float) -> None:
    """Say how far rotations were from the nearest ones."""
    if change:
        note(f"--nearest: the rotation was off by {change:.2g} rad")
