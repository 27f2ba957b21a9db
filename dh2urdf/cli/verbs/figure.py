"""``dh2urdf figure``: the arm with its DH frames, for print."""

import math
from typing import Annotated, Literal

from cyclopts import Parameter

from dh2urdf.cli.options import Arm, Deg, Dpi, Force, Json, Link, PicturePath, Values
from dh2urdf.cli.output import emit, emit_json, parse_angles, parse_configuration, robot_of
from dh2urdf.cli.progress import note
from dh2urdf.cli.reading import DEFAULT, Reading
from dh2urdf.transforms import Array


def figure_(
    robot: Arm,
    /,
    *,
    output: PicturePath,
    q: Values = None,
    deg: Deg = False,
    style: Literal["bodies", "schematic"] = "bodies",
    branches: bool = False,
    task: Literal["pose", "position", "position+axis"] | None = None,
    frames: Annotated[bool, Parameter(negative="--no-frames")] = True,
    table: Annotated[bool, Parameter(negative="--no-table")] = True,
    view: Values = None,
    base: Link = None,
    tip: Link = None,
    reading: Reading = DEFAULT,
    dpi: Dpi = 180.0,
    force: Force = False,
    json: Json = False,
) -> None:
    """Draw an arm with its DH frames and its table.

    Parameters
    ----------
    q
        Configuration: --q=0,-pi/2,90deg or --q 0 -90 90 --deg; default zero.
    style
        Solid bodies, or the lines, cylinders and boxes of textbooks.
    branches
        Draw every other configuration that reaches the same pose as a ghost, in a planar arm with
        its angles; without --q at a bent pose where zero has no other.
    task
        What of the pose the branches share: pose, position or position+axis (the tip's z);
        default: as much as an arm of its kind can reach.
    frames
        Draw the DH frames and lengths.
    table
        Draw the DH table beside the arm.
    view
        Azimuth and elevation of the eye in degrees; default: one that shows the arm.
    """
    from dh2urdf.figures import branch_ghosts, figure, save_picture
    from dh2urdf.figures.save import check_target

    check_target(output, force=force)
    arm = robot_of(robot, base, tip, reading)
    eye = parse_angles(view, "--view", 2, deg=True)
    config = parse_configuration(q, arm, deg=deg) if q else None
    ghosts, names, others = list[Array](), list[str](), 0
    if branches:
        config, ghosts, names = branch_ghosts(arm, config, task)
        others = len(ghosts) - 1
        if not others:
            note("this pose has one solution only: nothing to draw as a ghost")
    picture = figure(
        arm,
        config,
        style=style,
        ghosts=ghosts,
        ghost_names=names,
        frames=frames,
        table=table,
        view=(math.degrees(eye[0]), math.degrees(eye[1])) if eye else None,
    )
    path = save_picture(picture, output, dpi=dpi, force=force)
    if json:
        emit_json("figure", path=path, branches=others)
    else:
        emit(str(path))
