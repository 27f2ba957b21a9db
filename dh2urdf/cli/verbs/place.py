"""``dh2urdf place``: where a robot should stand for a file of poses."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
from cyclopts import Parameter

from dh2urdf.bounds import LENGTH
from dh2urdf.cli.options import Arm, Dpi, Force, Json, Link, OptionalPicture, Values, read_numbers
from dh2urdf.cli.output import emit, emit_json, parse_angles, robot_of
from dh2urdf.cli.progress import bar, note
from dh2urdf.cli.reading import DEFAULT, Reading
from dh2urdf.cli.verbs.ik.doubts import tell_doubts
from dh2urdf.cli.verbs.ik.poses import Poses, poses_of_csv
from dh2urdf.dh_io import Kind, Units
from dh2urdf.exceptions import ArgumentError
from dh2urdf.grids import number

if TYPE_CHECKING:
    from dh2urdf.robot import Robot
    from dh2urdf.workspace import Placement

SHOWN = 20
"""Poses out of reach that are told one by one."""

ROWS, COLUMNS = 24, 60
"""Places of the map that are printed at most."""


def place_(
    robot: Arm,
    poses: str,
    /,
    *,
    output: OptionalPicture = None,
    against: str | None = None,
    region: Values = None,
    height: Values = None,
    yaw: Values = None,
    mount: Values = None,
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
    """Find where a robot should stand so that it reaches all poses with the most margin.

    The margin of a configuration is the smaller of two shares: how far its joints are from their
    limits, 1 in the middle, and its smallest singular value, 1 where that is largest. A base has
    the margin of its worst pose. Bases are tried on a lattice, then on finer ones about the best.
    Where none of them reaches all poses, those that stand in the way are told, and the exit status
    is 1; a base between them may, and --region lays them closer.

    Parameters
    ----------
    poses
        A CSV file (- for stdin) as of `dh2urdf ik --csv`, in the world.
    against
        A second robot, whose best base is told beside the first one's.
    region
        Lower and upper x, lower and upper y of the base in metres; default: wherever a pose is in
        reach.
    height
        The base's z in metres, or its lowest and highest; default: 0.
    yaw
        The base's turn about the vertical, or the range of it; default: all around.
    mount
        Roll, pitch, yaw of the base on what it stands on: --mount pi 0 0 hangs from above.
    task
        pose, position or position+axis (the tip's z).
    within_limits
        Keep the joint limits.
    nearest
        Take the nearest rotation where those of matrices are rounded.
    deg
        Bare angles are degrees, also the yaw that is told.
    """
    from dh2urdf.workspace import place

    if output is not None:
        from dh2urdf.figures.save import check_target

        check_target(output, force=force)
    if [robot, poses, against].count("-") > 1:
        raise ArgumentError("place: ROBOT, POSES and --against: stdin holds one of them")
    arms = [robot_of(robot, base, tip, reading)]
    arms += [robot_of(against)] if against is not None else []
    read = poses_of_csv(poses, deg=deg, nearest=nearest, position_only=task == "position")
    centred = read.T.copy()
    centred[:, :3, 3] -= centred[:, :3, 3].mean(axis=0)
    tell_doubts(arms[0], centred, read.angles, read.name)
    asked: dict[str, Any] = {
        "region": _pairs(region),
        "height": _range(height, "--height", Kind.LENGTH, deg=deg) or 0.0,
        "yaw": _range(yaw, "--yaw", Kind.ANGLE, deg=deg),
        "mount": parse_angles(mount, "--mount", 3, deg=deg),
        "task": task,
        "within_limits": within_limits,
    }
    found = []
    for arm in arms:
        with bar(f"placing {arm.model.name}", 1) as report:
            told = lambda _, done, total: report(done, total)  # noqa: E731
            found.append(place(arm, read.T, **asked, progress=told))
    if output is not None:
        from dh2urdf.figures import placement_figure, save_picture

        picture = placement_figure(read.T, list(zip(arms, found, strict=True)))
        save_picture(picture, output, dpi=dpi, force=force)
    if json:
        first, *others = [as_data(*each) for each in zip(arms, found, strict=True)]
        emit_json("place", **first, against=others[0] if others else None, figure=output)
    else:
        for arm, placement in zip(arms, found, strict=True):
            emit(_text(arm, placement, read, deg=deg))
        if len(found) > 1:
            emit(_better(arms, found))
        if output is not None:
            emit(str(output))
    for arm, placement in zip(arms, found, strict=True):
        _tell_missed(arm, placement, read)
    return 0 if found[0].found else 1


def as_data(arm: Robot, placement: Placement) -> dict[str, Any]:
    """What ``--json`` says of a placement."""
    rows: Any = [None if np.isnan(row[0]) else row for row in placement.q]
    area = placement.map
    names = ("x", "y", "z", "yaw", "margin", "margins", "missed", "never", "reasons", "tried")
    fields = ("x", "y", "margin", "reached", "z", "yaw")
    return {
        "robot": arm.model.name,
        "found": placement.found,
        **{name: getattr(placement, name) for name in names},
        "T_world_base": placement.T_world_base,
        "joint_names": arm.joint_names,
        "q": rows,
        "map": {name: getattr(area, name) for name in fields},
    }


def _range(
    cells: list[str] | None, what: str, kind: Kind, *, deg: bool
) -> float | tuple[float, float] | None:
    """One number, or a range of two."""
    if not cells:
        return None
    unit = "deg" if deg else "rad"
    ends = read_numbers(cells, what, (1, 2), kind, Units("m", unit))
    if kind is Kind.ANGLE and max(map(abs, ends)) > 2 * np.pi + 1e-9:
        turn, hint = ("360", "") if deg else ("6.2832", "; degrees are 90deg, or bare with --deg")
        raise ArgumentError(
            f"{what}: expected -{turn} to {turn} {unit}, got {' '.join(cells)} {unit}{hint}"
        )
    if ends[0] > ends[-1]:
        raise ArgumentError(f"{what}: lower end first, got {' '.join(cells)}")
    if kind is Kind.ANGLE and ends[-1] - ends[0] > 2 * np.pi + 1e-9:
        raise ArgumentError(f"{what}: a range of one turn at most, got {' '.join(cells)} {unit}")
    return ends[0] if len(ends) == 1 else (ends[0], ends[1])


def _pairs(cells: list[str] | None) -> list[list[float]] | None:
    """``--region``: lower and upper ends of x and y."""
    if not cells:
        return None
    x0, x1, y0, y1 = read_numbers(cells, "--region", (4,), Kind.LENGTH, Units("m", "rad"))
    if x0 > x1 or y0 > y1 or max(map(abs, (x0, x1, y0, y1))) > LENGTH:
        raise ArgumentError(
            f"--region: lower x, upper x, lower y, upper y are needed, up to {LENGTH:g} m, "
            f"got {' '.join(cells)}"
        )
    return [[x0, x1], [y0, y1]]


def _text(arm: Robot, placement: Placement, read: Poses, *, deg: bool) -> str:
    """The best base, its margin, and the map."""
    m, name = len(placement.margins), arm.model.name
    turn = f"{placement.yaw * 180 / np.pi:.2f} deg" if deg else f"{placement.yaw:.4f} rad"
    base = f"x {placement.x:.4f} m, y {placement.y:.4f} m, z {placement.z:.4f} m, yaw {turn}"
    whole = f"all {m} poses" if m > 1 else "the pose"
    if placement.found:
        worst = read.name(int(placement.margins.argmin()))
        reach = f"{whole} reached, margin {placement.margin:.3f} at {worst}"
        head = [f"{name}: base at {base}", reach]
    else:
        reached = m - len(placement.missed)
        base = base if reached else "any base that was tried"
        head = [f"{name}: no base found that reaches {whole}"]
        head.append(f"{reached} of {m} poses from {base}")
        if not placement.never:
            head.append("between those tried there may be one: --region and --yaw lay them closer")
    count, size = int((placement.map.margin > 0.0).sum()), placement.map.margin.size
    some = f"{count} of {size} places of the map reach all"
    most = round(float(placement.map.reached.max()) * m)
    few = f"{size} places of the map, which reach {most} of {m} poses at most"
    if placement.found:
        few = f"the base is between the {few}"
    head.append(f"{some if count else few}; {placement.tried} bases tried")
    return "\n".join([*head, *_map_lines(placement)])


def _map_lines(placement: Placement) -> list[str]:
    """The map in letters: tenths of the margin; where no place reaches all, poses reached.

    Of more than nine poses these are tenths, too.
    """
    area = placement.map
    rows, columns = np.nonzero(area.reached > 0.0)
    if not len(rows):
        return []
    part = slice(rows.min(), rows.max() + 1), slice(columns.min(), columns.max() + 1)
    x, y = area.x[part[1]], area.y[part[0]]
    if min(len(x), len(y)) < 2 or len(y) > ROWS or len(x) > COLUMNS:
        return []
    margin, reached = area.margin[part], area.reached[part]
    whole = bool((area.margin > 0.0).any())
    m = len(placement.margins)
    what = "tenths of the margin, . where poses are left out"
    if not whole:
        what = f"poses reached, of {m}" if m <= 9 else f"tenths of the {m} poses that are reached"
    lines = [f"{what}; bases at x {x[0]:.2f} to {x[-1]:.2f} m, y as written"]
    times = 10.0 if whole or m > 9 else m
    digits = np.minimum((times * (margin if whole else reached) + 1e-9).astype(int), 9)
    for k in range(len(y) - 1, -1, -1):
        signs = [" " if reached[k, i] == 0.0 else "." if whole and margin[k, i] == 0.0
                 else str(digits[k, i]) for i in range(len(x))]  # fmt: skip
        lines.append(f"{y[k]:8.2f}  {' '.join(signs)}".rstrip())
    return lines


def _better(arms: list[Robot], found: list[Placement]) -> str:
    """Which of two robots has more margin, or reaches more poses."""
    key = [(-len(p.missed), p.margin) for p in found]
    if key[0] == key[1]:
        return f"{arms[0].model.name} and {arms[1].model.name} are as good"
    k = int(key[1] > key[0])
    better, other = arms[k].model.name, arms[1 - k].model.name
    if key[0][0] != key[1][0]:
        counts = [number(float(len(p.margins) - len(p.missed))) for p in (found[k], found[1 - k])]
        return f"{better} reaches {counts[0]} poses, {other} {counts[1]}"
    return f"{better} has margin {found[k].margin:.3f}, {other} {found[1 - k].margin:.3f}"


def _tell_missed(arm: Robot, placement: Placement, read: Poses) -> None:
    """The poses that stand in the way, and why."""
    for i, reason in list(zip(placement.missed, placement.reasons, strict=False))[:SHOWN]:
        where = "from any base that was tried" if i in placement.never else "from that base"
        why = f": {reason}" if reason else ""
        note(f"{read.name(i)}: {arm.model.name}: out of reach {where}{why}")
    if len(placement.missed) > SHOWN:
        note(f"... and {len(placement.missed) - SHOWN} more poses out of reach")
