"""``dh2urdf path``: one joint motion through a file of poses."""

from __future__ import annotations

import sys
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
from cyclopts import Parameter

from dh2urdf.cli.options import Arm, Dpi, Force, Json, Link, Values, real
from dh2urdf.cli.output import emit, emit_json, parse_configuration, robot_of
from dh2urdf.cli.progress import bar, note
from dh2urdf.cli.reading import DEFAULT, Reading
from dh2urdf.cli.verbs.ik.answers import joint_heads, tell_change
from dh2urdf.cli.verbs.ik.doubts import tell_doubts
from dh2urdf.cli.verbs.ik.poses import Poses, poses_of_csv
from dh2urdf.dh_io import atomic_write, refuse_foreign
from dh2urdf.exceptions import ArgumentError

if TYPE_CHECKING:
    from collections.abc import Callable

    from dh2urdf.ik.problem import IKPath
    from dh2urdf.robot import Robot
    from dh2urdf.transforms import Array

SHOWN = 20
"""Breaks, and poses out of reach, that are told one by one."""


def path_(
    robot: Arm,
    poses: str,
    /,
    *,
    output: Annotated[Path | None, Parameter(name=["--output", "-o"])] = None,
    start: Values = None,
    max_jump: Annotated[float | None, real(1e-9, 1e5)] = None,
    figure: Path | None = None,
    task: Literal["pose", "position", "position+axis"] = "pose",
    within_limits: Annotated[bool, Parameter(negative="--no-within-limits")] = True,
    nearest: bool = False,
    deg: bool = False,
    base: Link = None,
    tip: Link = None,
    reading: Reading = DEFAULT,
    dpi: Dpi = 180.0,
    force: Force = False,
    json: Json = False,
) -> int:
    """Find one joint motion through many poses: fewest breaks, then least motion.

    The answer is CSV, a line for each pose; `break` is 1 where a joint would have to jump on the
    way from the pose before, and a pose out of reach has empty cells. Exit status 1 where there
    is any of these.

    Parameters
    ----------
    poses
        A CSV file (- for stdin) as of `dh2urdf ik --csv`.
    output
        The CSV file to write; - for stdout, the default.
    start
        Joint values before the first pose; the way from there counts as motion.
    max_jump
        Motion of a joint between two poses that counts as a break, in radians or metres;
        default: 0.5.
    figure
        A picture of the joints over the path: .png, .svg or .pdf.
    task
        pose, position or position+axis (the tip's z).
    within_limits
        Keep the joint limits.
    nearest
        Take the nearest rotation where those of matrices are rounded.
    deg
        Bare angles are degrees, also those that are written.
    """
    if figure is not None:
        from dh2urdf.figures.save import check_target

        check_target(figure, force=force)
    to_file = str(output or "-") != "-"
    if to_file and not force:
        assert output is not None
        refuse_foreign(output, ",break\n")
    if robot == poses == "-":
        raise ArgumentError("path: ROBOT and POSES: stdin holds one of them")
    arm = robot_of(robot, base, tip, reading)
    read = poses_of_csv(poses, deg=deg, nearest=nearest, position_only=task == "position")
    tell_doubts(arm, read.T, read.angles, read.name)
    begin = parse_configuration(start, arm, deg=deg, what="--start") if start else None
    with bar("following the poses", len(read.T)) as report:
        found = arm.ik_path(
            read.T,
            start=begin,
            within_limits=within_limits,
            task=task,
            max_jump=max_jump,
            nearest=nearest,
            progress=report,
        )
    text = _csv(arm, found, deg=deg)
    if to_file:
        assert output is not None
        atomic_write(output, text)
    elif not json:
        sys.stdout.write(text.decode())
    if figure is not None:
        from dh2urdf.figures import path_figure, save_picture

        save_picture(path_figure(arm, found), figure, dpi=dpi, force=force)
    why = partial(arm.why_unreachable, within_limits=within_limits, task=task, nearest=nearest)
    _tell(arm, found, read, output if to_file else None, figure, why, json=json)
    return 0 if found.continuous else 1


def _csv(arm: Robot, path: IKPath, *, deg: bool) -> bytes:
    """A line for each pose."""
    from dh2urdf.cli.verbs.ik.digits import number_words, text_of, whole_words
    from dh2urdf.grids import grid_csv

    m = len(path)
    scale = np.where(arm.slides | (not deg), 1.0, 180.0 / np.pi)
    jumps = np.isin(np.arange(m), path.breaks)
    ends = np.array([b",0\n", b",1\n"], "S4").view(np.uint32)[jumps.astype(int)][:, None]
    numbers = number_words(path.q * scale).reshape(m, 8 * arm.n)
    head = grid_csv(["pose", *joint_heads(arm, deg=deg), "break"], []).encode()
    return head + text_of([whole_words(np.arange(1, m + 1))[:, 1:], numbers, ends])


def _tell(
    arm: Robot,
    path: IKPath,
    read: Poses,
    output: Path | None,
    figure: Path | None,
    why: Callable[[Array], str],
    *,
    json: bool,
) -> None:
    """What was found: a summary, where the path breaks, and ``why`` poses have no solution."""
    tell_change(float(path.pose_change.max(initial=0.0)))
    told = [_break(arm, path, read, i) for i in path.breaks[:SHOWN]]
    if len(path.breaks) > SHOWN:
        told.append(f"... and {len(path.breaks) - SHOWN} more breaks")
    for first, last in path.gaps[:SHOWN]:
        reason = why(read.T[first]) or "out of reach"
        many = f"{read.file}: lines {read.lines[first]} to {read.lines[last]}: of the first, "
        told.append(f"{many if first < last else f'{read.name(first)}: '}{reason}")
    if len(path.gaps) > SHOWN:
        told.append(f"... and {len(path.gaps) - SHOWN} more gaps")
    for line in told:
        note(line)
    if json:
        rows: Any = [None if np.isnan(row[0]) else row for row in path.q]
        keys = ("joint_names", "breaks", "unreachable", "continuous", "motion", "max_jump")
        paths = {"path": output, "figure": figure}
        emit_json("path", **{key: getattr(path, key) for key in keys}, **paths, q=rows)
    elif output is not None:
        emit(f"{output}: {path.summary}")
    if figure is not None and not json and output is not None:
        emit(str(figure))


def _break(arm: Robot, path: IKPath, read: Poses, i: int) -> str:
    """Where the arm would have to jump, which joint most, and how far."""
    before, joint, by = path.jump(i)
    move = f"{path.joint_names[joint]} would have to move by {by:.4g}"
    unit = "m" if arm.slides[joint] else "rad"
    return f"{read.name(i)}: break: {move} {unit} from the pose on line {read.lines[before]}"
