"""``dh2urdf map``: where the tip can be, in how many ways and how well, as a Zarr group."""

import math
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from dh2urdf.bounds import HALVINGS, LENGTH, ORIENTATIONS
from dh2urdf.cli.options import Arm, Json, Link, Values, read_numbers, real, whole
from dh2urdf.cli.output import emit, emit_json, robot_of, ten_digits
from dh2urdf.cli.progress import bar
from dh2urdf.cli.reading import DEFAULT, Reading
from dh2urdf.dh_io import Kind, Units
from dh2urdf.exceptions import ArgumentError

if TYPE_CHECKING:
    from dh2urdf.robot import Robot
    from dh2urdf.workspace import MapSummary

ENDS = "x from", "x to", "y from", "y to", "z from", "z to"

OPTIONS = "step", "orientations", "region", "each", "refine"
"""Arguments of a map that are options here."""


def map_(
    robot: Arm,
    /,
    *,
    output: Annotated[str, Parameter(name=["--output", "-o"])],
    step: Annotated[float, real(1e-6, LENGTH, Kind.LENGTH)] = 0.05,
    orientations: Annotated[int, whole(1, ORIENTATIONS)] = 200,
    region: Values = None,
    towards: Values = None,
    within: Annotated[float | None, real(0.0, math.pi, Kind.ANGLE)] = None,
    spins: Annotated[int | None, whole(1, ORIENTATIONS)] = None,
    limits: Annotated[bool, Parameter(negative="--no-limits")] = True,
    each: bool = False,
    refine: Annotated[int, whole(0, HALVINGS)] = 0,
    scheduler: str | None = None,
    base: Link = None,
    tip: Link = None,
    reading: Reading = DEFAULT,
    json: Json = False,
) -> None:
    """Map what an arm reaches: all solutions on a grid of positions times orientations.

    Of each voxel the share of orientations reached, numbers of solutions, the best manipulability,
    singular value and distance from the joint limits. A map that was begun is gone on with.

    Parameters
    ----------
    output
        The Zarr group to write, such as arm.zarr or s3://bucket/arm.zarr; xarray opens it.
    step
        Side of a voxel, in metres.
    orientations
        Orientations tried at each voxel's centre, evenly spread.
    region
        x, y and z from and to, in metres; default: all that the arm's lengths allow.
    towards
        Only directions of the tool's z around this one, such as 0,0,-1 for down.
    within
        How far from it they may be; default: 30deg.
    spins
        Turns tried about each of those directions, one of which has to be reached; default: 8.
    limits
        Keep the joint limits.
    each
        Keep the values of each orientation, too.
    refine
        How often to halve voxels where the share changes fast.
    scheduler
        Address of a Dask scheduler whose workers do the work, such as tcp://10.0.0.1:8786.
    """
    from dh2urdf.workspace import cone, settings_of, store_map
    from dh2urdf.workspace.task import task_of

    if output == "-":
        raise ArgumentError("--output -: a map is a folder; give a path such as arm.zarr")
    if each and refine:
        raise ArgumentError("--each: values of each orientation are kept without --refine only")
    for option, value in (("--within", within), ("--spins", spins)):
        if value is not None and not towards:
            raise ArgumentError(f"{option} does nothing without --towards")
    arm = robot_of(robot, base, tip, reading)
    units = Units("m", "rad")
    ends = None
    if region:
        ends = read_numbers(region, "--region", (6,), Kind.LENGTH, units, names=ENDS)
    turns = None
    if towards:
        if task_of(arm).sides == "turns" or task_of(arm).name == "position":
            raise ArgumentError(
                f"--towards: the joints of {arm.model.name} do not let its tool be turned towards "
                "a direction"
            )
        axis = read_numbers(towards, "--towards", (3,), Kind.NUMBER, units)
        angle = math.pi / 6 if within is None else within
        turns = cone(orientations, towards=axis, within=angle, spins=spins or 8)
    with bar("mapping", 1) as report:
        try:
            settings = settings_of(
                arm,
                step,
                orientations if turns is None else turns,
                None if ends is None else [ends[:2], ends[2:4], ends[4:]],
                limits,
                each,
                refine,
            )
        except ArgumentError as error:
            of_option = str(error).partition(":")[0] in OPTIONS
            raise ArgumentError(f"--{error}" if of_option else str(error)) from None
        told = store_map(arm, settings, output, scheduler, report)
    if json:
        emit_json("map", path=output, within_limits=limits, **told._asdict())
        return
    emit(_text(output, arm, told, one=turns is None and task_of(arm).sides == "none"))


def _text(output: str, arm: "Robot", told: "MapSummary", *, one: bool) -> str:
    """A map in a few lines; ``one``: of an arm that is tried in one orientation."""
    from dh2urdf.workspace.section import reach_ball

    shape = " x ".join(map(str, told.shape))
    size = f"{told.volume:.4g} m^3" if told.area is None else f"{told.area:.4g} m^2"
    lines = [
        output,
        f"{shape} voxels of {ten_digits(told.step)} m, {told.orientations} orientation"
        f"{'s' * (told.orientations != 1)}, task {told.task}: {told.poses} poses",
        f"reached: {size}, at best {told.largest_share:.3g} of the orientations",
    ]
    if one:
        lines.append(
            f"{arm.model.name} has too few joints to turn its tool all around: one orientation was "
            "tried, --orientations does nothing"
        )
    if told.largest_share == 0.0:
        centre, radius = reach_ball(arm)
        place = ", ".join(f"{c:.3g}" for c in centre + 0.0)
        lines.append(
            f"no voxel's centre is reached: the tip stays within {radius:.3g} m of ({place}); "
            "see --region and --step"
        )
    return "\n".join(lines)
