"""``dh2urdf workspace``: what an arm reaches, as a picture."""

from pathlib import Path
from typing import Annotated, Any, Literal

from cyclopts import Parameter

from dh2urdf.bounds import LENGTH, ORIENTATIONS, POINTS
from dh2urdf.cli.options import Arm, Dpi, Force, Json, Link, OptionalPicture, Values, real, whole
from dh2urdf.cli.output import emit, emit_json, parse_angles, robot_of
from dh2urdf.cli.progress import bar
from dh2urdf.cli.reading import DEFAULT, Reading
from dh2urdf.dh_io import Kind
from dh2urdf.exceptions import ArgumentError

Variable = Literal[
    "share", "solutions_mean", "solutions_max", "manipulability", "singular_value", "limit_margin"
]
"""What a map says of each voxel."""


def workspace_(
    robot: Arm,
    /,
    *,
    output: OptionalPicture = None,
    plane: Literal["xz", "yz", "xy"] | None = None,
    at: Annotated[float | None, real(-LENGTH, LENGTH, Kind.LENGTH)] = None,
    rpy: Values = None,
    deg: bool = False,
    points: Annotated[int | None, whole(*POINTS)] = None,
    orientations: Annotated[int | None, whole(1, ORIENTATIONS)] = None,
    limits: Annotated[bool, Parameter(negative="--no-limits")] = True,
    envelope: bool = False,
    exact: bool = False,
    against: str | None = None,
    variable: Variable | None = None,
    base: Link = None,
    tip: Link = None,
    reading: Reading = DEFAULT,
    dpi: Dpi = 180.0,
    force: Force = False,
    json: Json = False,
) -> None:
    """Draw what an arm can reach.

    A planar arm of two joints: the surface of its poses (x, y, phi) and its annulus. Any other:
    a section with the number of branches and the share of orientations reached. A map of
    `dh2urdf map`, arm.zarr, may stand for the robot: then a layer of it is drawn.

    Parameters
    ----------
    plane
        Plane of the section in the base; default: that of a planar arm or a flat map, else xz.
    at
        Where the plane stands along its normal, in metres.
    rpy
        Orientation in which branches are counted; default: the tool pointing down.
    deg
        rpy is in degrees.
    points
        Points along a side of the maps, worked out where the maps change; default: 161, or less
        where a point takes long.
    orientations
        Orientations tried at each point at least; default: 2000, or 5000 where that takes no time.
    limits
        Keep the joint limits.
    envelope
        Draw the boundary of all that is reached, in the round, a quarter of it cut out.
    exact
        Not by a grid: how far and near the tip and the wrist reach, the best of searches that each
        end to 1e-9; the section of the wrist's reach, with voids, from where the arm is singular
        and its limits; its volume. No picture is needed then.
    against
        A second map: the first one, this, and their difference are drawn.
    variable
        What of a map is drawn; default: the share of orientations reached.
    """
    is_map = Path(robot).suffix == ".zarr"
    if output is None and (is_map or not exact):
        raise ArgumentError("--output is needed: the picture to write, .png, .svg or .pdf")
    if output is not None:
        from dh2urdf.figures.save import check_target

        check_target(output, force=force)
    if is_map:
        asked: dict[str, Any] = {"--rpy": rpy, "--points": points, "--orientations": orientations}
        asked |= {"--base": base, "--tip": tip, "--envelope": envelope, "--exact": exact}
        _refuse("a map", {**asked, "--no-limits": not limits})
        assert output is not None
        from dh2urdf.figures import map_figure, save_picture

        cut = map_figure(robot, against, variable=variable or "share", plane=plane or "", at=at)
        path = save_picture(cut, output, dpi=dpi, force=force)
        return emit_json("workspace", path=path) if json else emit(str(path))
    _refuse("a robot that is no map", {"--against": against, "--variable": variable})
    arm = robot_of(robot, base, tip, reading)
    if exact:
        from dh2urdf.cli.verbs.exact_reach import tell_exact_reach

        return tell_exact_reach(arm, output, limits=limits, dpi=dpi, force=force, json=json)
    assert output is not None
    from dh2urdf.figures import save_picture, workspace_figure

    with bar("mapping", 1) as report:
        picture = workspace_figure(
            arm,
            plane=plane or "",
            at=at,
            rpy=parse_angles(rpy, "--rpy", 3, deg=deg),
            points=points,
            orientations=orientations,
            within_limits=limits,
            envelope=envelope,
            progress=lambda _, done, total: report(done, total),
        )
    path = save_picture(picture, output, dpi=dpi, force=force)
    if json:
        emit_json("workspace", path=path, within_limits=limits)
    else:
        emit(str(path))


def _refuse(what: str, asked: dict[str, Any]) -> None:
    """Refuse options that say nothing of it."""
    for option, value in asked.items():
        if value not in (None, False):
            raise ArgumentError(f"{option} does nothing for {what}")
