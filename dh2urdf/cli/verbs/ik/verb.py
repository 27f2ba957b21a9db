"""``dh2urdf ik``: every configuration that reaches a pose, or each of many."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
from cyclopts import Parameter

from dh2urdf.cli.options import DEFAULT, Arm, Json, Link, Reading, Values
from dh2urdf.cli.output import emit, emit_json, parse_configuration, robot_of
from dh2urdf.cli.progress import bar, note
from dh2urdf.cli.verbs.ik.answers import as_data, names_of, outside, solutions_text, words_of
from dh2urdf.cli.verbs.ik.poses import Poses, pose_of, poses_of_csv
from dh2urdf.exceptions import ConfigurationError
from dh2urdf.grids import grid_csv
from dh2urdf.transforms import Array

if TYPE_CHECKING:
    from dh2urdf.ik.problem import IKSolutions
    from dh2urdf.robot import Robot


_Options = dict[str, Any]

CHUNK = 1_000
"""Poses that are solved, and lines that are written, at once."""

SHOWN = 5
"""Poses without a solution whose reason is told."""


def ik_(
    robot: Arm,
    /,
    *,
    xyz: Values = None,
    rpy: Values = None,
    matrix: Values = None,
    csv: str | None = None,
    seed: Values = None,
    seed_tolerance: Values = None,
    locked: Values = None,
    task: Literal["pose", "position", "position+axis"] = "pose",
    turns: Literal["nearest", "all"] = "nearest",
    within_limits: Annotated[bool, Parameter(negative="--no-within-limits")] = True,
    nearest: bool = False,
    words: Literal["kuka", "abb", "fanuc"] | None = None,
    deg: bool = False,
    base: Link = None,
    tip: Link = None,
    reading: Reading = DEFAULT,
    json: Json = False,
) -> int:
    """Find every configuration that reaches a pose, each measured by Pinocchio.

    Parameters
    ----------
    xyz
        Position of the tip in the base: metres; 400mm also does.
    rpy
        Roll, pitch, yaw of the tip: radians (degrees with --deg); 90deg, pi/2 also do.
    matrix
        The pose as 16 or 12 numbers, row by row.
    csv
        A file (- for stdin) of many poses: columns x y z roll pitch yaw, x y z qx qy qz qw, or
        matrix entries t00 ... t23 or t33; a header line may order them and give units, as in
        "x [mm]" or "yaw (deg)". The answer is CSV, too.
    seed
        Joint values to be near to: sorts the solutions, picks turns and members of families.
    seed_tolerance
        How far each joint may be from the seed, on the circle: one value for all or for each.
        Solutions with a joint farther away are left out.
    locked
        Joints held at a value: --locked joint_7=0.3.
    task
        pose, position or position+axis (the tip's z).
    turns
        nearest, or all where a range is wider than a turn.
    within_limits
        Leave out solutions outside the joint limits, as `Robot.ik` does; else mark them.
    nearest
        Take the nearest rotation where that of a matrix is rounded, and tell how far it was.
    words
        Each solution's word in a controller's terms, for six axes with a spherical wrist: kuka
        status and turn, abb cf1 cf4 cf6 cfx, fanuc N U T with turns of J1, J4, J6.
    deg
        Bare angles are degrees, and angles are shown in degrees.
    """
    arm = robot_of(robot, base, tip, reading)
    options: _Options = {"locked": _held(locked, arm, deg=deg), "task": task}
    options |= {"within_limits": within_limits, "nearest": nearest}
    goal = parse_configuration(seed, arm, deg=deg, what="--seed") if seed else None
    near: _Options = {"seed": goal, "turns": turns}
    if seed_tolerance:
        each = seed_tolerance * (arm.n if len(seed_tolerance) == 1 else 1)
        most = parse_configuration(each, arm, deg=deg, what="--seed-tolerance")
        near["seed_tolerance"] = most
    if csv is not None:
        poses = poses_of_csv(csv, deg=deg, nearest=nearest)
        return _many(arm, poses, near, options, words, deg=deg, json=json)
    T = pose_of(xyz, rpy, matrix, deg=deg, position_only=task == "position", nearest=nearest)
    found = arm.ik(T, **near, **options)
    _tell_change(found.pose_change)
    if goal is None:
        found = found.select(np.argsort(outside(arm, found.q).any(axis=1), kind="stable"))
    reason = _reason(arm, T, found, near, options)
    if json:
        solver = arm.solver_for(locked=options["locked"], task=task)
        emit_json("ik", **as_data(arm, found, words), solver=str(solver), reason=reason)
    elif found:
        emit(solutions_text(arm, found, deg=deg, maker=words))
    if reason:
        hidden = within_limits and "outside the joint limits" in reason
        hint = "; --no-within-limits shows them" if hidden else ""
        note(f"no solution{' within limits' if found else ''}: {reason}{hint}")
    return 1 if reason else 0


def _tell_change(change: float) -> None:
    """Say how far rotations were from the nearest ones."""
    if change:
        note(f"--nearest: the rotation was off by {change:.2g} rad")


def _held(cells: list[str] | None, arm: Robot, *, deg: bool) -> dict[str, float] | None:
    """``joint=value`` pairs, values as on the rest of the command line."""
    if not cells:
        return None
    held = {}
    for cell in (part for text in cells for part in text.split(",")):
        name, _, value = cell.partition("=")
        if not value:
            raise ConfigurationError(f"--locked: joint=value is needed, got {cell!r}")
        if name not in arm.joint_names and name.isdigit() and int(name) < arm.n:
            name = arm.joint_names[int(name)]
        if name not in arm.joint_names:
            known = ", ".join(arm.joint_names)
            raise ConfigurationError(f"--locked: no joint named {name!r}; there are {known}")
        if name in held:
            raise ConfigurationError(f"--locked: {name} is held twice")
        row = ["0"] * arm.n
        row[arm.joint_names.index(name)] = value
        q = parse_configuration(row, arm, deg=deg, what="--locked")
        held[name] = float(q[arm.joint_names.index(name)])
    return held


def _reason(arm: Robot, T: Array, found: IKSolutions, near: _Options, options: _Options) -> str:
    """Why there is no solution within the limits; empty if there is one."""
    if found and (outside(arm, found.q) == 0.0).all(axis=1).any():
        return ""
    if not found and "seed_tolerance" in near:
        others = arm.ik(T, **{**near, **options, "seed_tolerance": None})
        if others:
            return _too_far(arm, others.q, near)
    return arm.why_unreachable(T, **{**options, "within_limits": True})


def _too_far(arm: Robot, q: Array, near: _Options) -> str:
    """By how much the nearest of solutions (k, n) is farther from the seed than is allowed."""
    from dh2urdf.ik.arm import seed_gaps

    excess = seed_gaps(arm.chain, q, near["seed"]) - near["seed_tolerance"]
    nearest = excess[excess.max(axis=1).argmin()]
    worst = int(nearest.argmax())
    by = f"{nearest[worst]:.4g} {'m' if arm.slides[worst] else 'rad'}"
    return (
        f"all {len(q)} solutions are farther from the seed than --seed-tolerance allows, the "
        f"nearest by {by} at {arm.joint_names[worst]}"
    )


def _many(
    arm: Robot,
    poses: Poses,
    near: _Options,
    options: _Options,
    maker: str | None,
    *,
    deg: bool,
    json: bool,
) -> int:
    """All solutions of many poses, as CSV or JSON; 1 if any pose has none within the limits."""
    missed: dict[int, IKSolutions | None] = {}
    change = 0.0
    data: list[dict[str, Any]] = []
    lines = [["pose", "solution", *arm.joint_names, "residual", "branch", "outside"]]
    lines[0] += ["word"] if maker else []
    for i, found in enumerate(_solved(arm, poses.T, near, options)):
        over, change = outside(arm, found.q), max(change, found.pose_change)
        if not (over == 0.0).all(axis=1).any():
            missed[i] = found if len(missed) < SHOWN else None
        if json:
            data.append(as_data(arm, found, maker))
            continue
        lines += _lines(arm, i, found, over, maker, deg=deg)
        if len(lines) > CHUNK:
            emit(grid_csv(lines[0], lines[1:]))
            lines.clear()
    reasons = {
        i: _reason(arm, poses.T[i], first, near, options)
        for i, first in missed.items()
        if first is not None
    }
    if json:
        emit_json("ik", poses=data, unreached=list(missed), reasons=reasons)
    elif lines:
        emit(grid_csv(lines[0], lines[1:]))
    _tell_change(change)
    for i, reason in reasons.items():
        note(f"{poses.name(i)}: no solution within limits: {reason}")
    if len(missed) > SHOWN:
        note(f"... and {len(missed) - SHOWN} more of {len(poses.T)} poses without a solution")
    return 1 if missed else 0


def _solved(arm: Robot, Ts: Array, near: _Options, options: _Options) -> Iterator[IKSolutions]:
    """The solutions of one pose after the other, telling how far it has come."""
    with bar("solving", len(Ts)) as report:
        for start in range(0, len(Ts), CHUNK):
            part = Ts[start : start + CHUNK]
            if near["seed"] is None and near["turns"] == "nearest":
                batch = arm.ik_batch(part, **options)
                yield from (batch[i] for i in range(len(batch)))
            else:
                yield from (arm.ik(T, **near, **options) for T in part)
            report(start + len(part), len(Ts))


def _lines(
    arm: Robot, pose: int, found: IKSolutions, over: Array, maker: str | None, *, deg: bool
) -> list[list[str]]:
    """One line a solution: pose, solution, joint values, residual, branch, outside limits, word."""
    q = found.q * np.where(arm.slides | (not deg), 1.0, 180.0 / math.pi)
    far = [" ".join(names_of(arm, one)) for one in over]
    words = [[word] if maker else [] for word in words_of(found, maker)]
    measured = zip(q.tolist(), found.verify(), found.branch, far, words, strict=True)
    return [
        [f"{pose + 1}", f"{k + 1}", *map(repr, row), f"{residual:.1e}", branch, names, *word]
        for k, (row, residual, branch, names, word) in enumerate(measured)
    ]
