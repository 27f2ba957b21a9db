"""``dh2urdf map``: where the tip can be, in how many ways and how well, as a Zarr group."""

import math
from typing import Annotated

from cyclopts import Parameter

from dh2urdf.bounds import HALVINGS, LENGTH, ORIENTATIONS
from dh2urdf.cli.options import Arm, Json, Link, Values, read_numbers, real, whole
from dh2urdf.cli.output import emit, emit_json, robot_of, ten_digits
from dh2urdf.cli.progress import bar
from dh2urdf.cli.reading import DEFAULT, Reading
from dh2urdf.dh_io import Kind, Units
from dh2urdf.exceptions import ArgumentError

ENDS = "x from", "x to", "y from", "y to", "z from", "z to"


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

    if output == "-":
        raise ArgumentError("--output -: a map is a folder; give a path such as arm.zarr")
    arm = robot_of(robot, base, tip, reading)
    units = Units("m", "rad")
    ends = None
    if region:
        ends = read_numbers(region, "--region", (6,), Kind.LENGTH, units, names=ENDS)
    turns = None
    if towards:
        axis = read_numbers(towards, "--towards", (3,), Kind.NUMBER, units)
        angle = math.pi / 6 if within is None else within
        turns = cone(orientations, towards=axis, within=angle, spins=spins or 8)
    with bar("mapping", 1) as report:
        settings = settings_of(
            arm,
            step,
            orientations if turns is None else turns,
            None if ends is None else [ends[:2], ends[2:4], ends[4:]],
            limits,
            each,
            refine,
        )
        told = store_map(arm, settings, output, scheduler, report)
    if json:
        emit_json("map", path=output, within_limits=limits, **told._asdict())
        return
    shape = " x ".join(map(str, told.shape))
    emit(
        f"{output}\n{shape} voxels of {ten_digits(told.step)} m, {told.orientations} orientations: "
        f"{told.poses} poses\nreached: {told.volume:.4g} m^3, at best {told.largest_share:.3g} of "
        "the orientations"
    )
