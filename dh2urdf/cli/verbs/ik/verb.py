"""``dh2urdf ik``: every configuration that reaches a pose, or each of many."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
from cyclopts import Parameter

from dh2urdf.bounds import TURNS
from dh2urdf.cli.options import Arm, Force, Json, Link, Values, whole
from dh2urdf.cli.output import emit, emit_file, emit_json, parse_configuration, robot_of
from dh2urdf.cli.progress import note
from dh2urdf.cli.reading import DEFAULT, Reading
from dh2urdf.cli.verbs.ik.answers import as_data, outside, reason_of, solutions_text, tell_change
from dh2urdf.cli.verbs.ik.doubts import bare_angle, tell_doubts
from dh2urdf.cli.verbs.ik.explained import explained, lesson_text
from dh2urdf.cli.verbs.ik.formulas import tell_formulas
from dh2urdf.cli.verbs.ik.poses import pose_of, poses_of_csv
from dh2urdf.exceptions import ConfigurationError

if TYPE_CHECKING:
    from dh2urdf.robot import Robot

_Options = dict[str, Any]


def ik_(
    robot: Arm,
    /,
    *,
    xyz: Values = None,
    rpy: Values = None,
    matrix: Values = None,
    csv: str | None = None,
    output: Annotated[Path | None, Parameter(name=["--output", "-o"])] = None,
    best: bool = False,
    seed: Values = None,
    seed_tolerance: Values = None,
    locked: Values = None,
    task: Literal["pose", "position", "position+axis"] = "pose",
    turns: Literal["nearest", "all"] = "nearest",
    within_limits: Annotated[bool, Parameter(negative="--no-within-limits")] = True,
    nearest: bool = False,
    words: Literal["kuka", "abb", "fanuc"] | None = None,
    explain: bool = False,
    solution: Annotated[int | None, whole(1, TURNS)] = None,
    symbolic: bool = False,
    format: Literal["text", "md", "markdown", "latex", "python"] | None = None,
    deg: bool = False,
    base: Link = None,
    tip: Link = None,
    reading: Reading = DEFAULT,
    force: Force = False,
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
        A file (- for stdin) of many poses: columns x y z roll pitch yaw, x y z qx qy qz qw (the
        quaternion's scalar last), or matrix entries t00 ... t23 or t33; for --task position x y z
        will do. A header line may order them and give units, as in "x [mm]" or "yaw (deg)". The
        answer is CSV, too, with residuals measured on the arm's chain; of one pose in 2000
        Pinocchio measures them again.
    output
        The CSV file to write; - for stdout, the default.
    best
        One line for each pose: the solution nearest to --seed, or without it to the line before
        (the first to the middle of the limits); a pose without a solution has empty cells.
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
    explain
        The way to a solution step by step instead: formula, numbers put in, value, reason.
    solution
        Which one --explain leads to, by its number in the table that `ik` prints.
    symbolic
        No pose: formulas for all solutions in the letters of the arm's table (extra symbolic).
    format
        How --explain and --symbolic are written: text, md (Markdown with formulas), latex (needs
        amsmath), and formulas as python, a function that needs nothing but math.
    deg
        Bare angles are degrees, and angles are shown in degrees.
    """
    arm = robot_of(robot, base, tip, reading)
    if symbolic:
        return tell_formulas(arm, format or "text", json=json)
    options: _Options = {"locked": _held(locked, arm, deg=deg), "task": task}
    options |= {"within_limits": within_limits, "nearest": nearest}
    goal = parse_configuration(seed, arm, deg=deg, what="--seed") if seed else None
    near: _Options = {"seed": goal, "turns": turns}
    if seed_tolerance:
        each = seed_tolerance * (arm.n if len(seed_tolerance) == 1 else 1)
        most = parse_configuration(each, arm, deg=deg, what="--seed-tolerance")
        near["seed_tolerance"] = most
    if csv is not None:
        from dh2urdf.cli.verbs.ik.many import Asked, solve_file

        poses = poses_of_csv(csv, deg=deg, nearest=nearest, position_only=task == "position")
        tell_doubts(arm, poses.T, poses.angles, poses.name)
        asked = Asked(near, options, best, deg, words)
        return solve_file(arm, poses, asked, output, force=force, json=json)
    T = pose_of(xyz, rpy, matrix, deg=deg, position_only=task == "position", nearest=nearest)
    bare = 0.0 if deg else bare_angle(",".join(rpy or ()).split(","))
    tell_doubts(arm, T[None], np.array([bare]), lambda _: "the pose")
    found = arm.ik(T, **near, **options)
    tell_change(found.pose_change)
    if goal is None:
        found = found.select(np.argsort(outside(arm, found.q).any(axis=1), kind="stable"))
    reason = reason_of(arm, T, near, options, found)
    lesson = explained(arm, found, solution, T, options) if explain else None
    if json:
        solver = arm.solver_for(locked=options["locked"], task=task)
        told = {"explanation": lesson.as_data()} if lesson else {}
        emit_json("ik", **as_data(arm, found, words), solver=str(solver), reason=reason, **told)
    elif lesson:
        emit_file(lesson_text(lesson, format or "text"))
    elif found:
        emit(solutions_text(arm, found, deg=deg, maker=words))
        if found.partial:
            emit("members of a part of the solutions; --seed finds its own")
    if reason:
        hidden = within_limits and "outside the joint limits" in reason
        hint = "; --no-within-limits shows them" if hidden else ""
        note(f"no solution{' within limits' if found else ''}: {reason}{hint}")
    return 1 if reason else 0


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
