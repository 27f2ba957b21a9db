"""``dh2urdf workspace``: what an arm reaches, as a picture."""

from __future__ import annotations

import sys
import time
from pathlib import Path
from typing import Annotated, Literal

from cyclopts import Parameter

from dh2urdf.bounds import DPI, LENGTH, ORIENTATIONS, POINTS
from dh2urdf.cli.options import Values, read_numbers, real, whole
from dh2urdf.cli.output import emit, emit_json, robot_of
from dh2urdf.dh_io import Kind, Units

__all__ = ["workspace_"]

PATIENCE = 0.5
"""Seconds before the progress shows."""


def workspace_(
    robot: str,
    /,
    *,
    output: Annotated[Path, Parameter(name=["--output", "-o"])],
    plane: Literal["xz", "yz", "xy"] | None = None,
    at: Annotated[float | None, real(-LENGTH, LENGTH, Kind.LENGTH)] = None,
    rpy: Values = None,
    deg: bool = False,
    points: Annotated[int | None, whole(*POINTS)] = None,
    orientations: Annotated[int | None, whole(1, ORIENTATIONS)] = None,
    limits: Annotated[bool, Parameter(negative="--no-limits")] = True,
    base: str | None = None,
    tip: str | None = None,
    dpi: Annotated[float, real(*DPI)] = 180.0,
    force: bool = False,
    json: bool = False,
) -> int:
    """Draw what an arm can reach.

    A planar arm of two joints: the surface of its poses (x, y, phi) and its annulus. Any other:
    a section with the number of branches and the share of orientations reached.

    Parameters
    ----------
    robot
        A table file, the name of a table that ships, or a URDF.
    output
        The picture to write: .png, .svg or .pdf.
    plane
        Plane of the section in the base; default: that of a planar arm, else xz.
    at
        Where the plane stands along its normal, in metres.
    rpy
        Orientation in which branches are counted; default: the tool pointing down.
    deg
        rpy is in degrees.
    points
        Points along a side of the map of branches.
    orientations
        Orientations tried at each point; default: 150.
    limits
        Keep the joint limits.
    base, tip
        Links of a URDF to measure between.
    dpi
        Resolution of a PNG.
    force
        Replace a file that dh2urdf did not write.
    json
        One JSON object instead of text.
    """
    from dh2urdf.figures import save_picture, workspace_figure
    from dh2urdf.figures.save import check_target

    check_target(output, force=force)
    arm = robot_of(robot, base, tip)
    units = Units("m", "deg" if deg else "rad")
    turned = read_numbers(rpy, "--rpy", (3,), Kind.ANGLE, units) if rpy else None
    bar = _Bar()
    picture = workspace_figure(
        arm,
        plane=plane or "",
        at=at,
        rpy=turned,
        points=points,
        orientations=orientations,
        within_limits=limits,
        progress=bar.show,
    )
    bar.clear()
    path = save_picture(picture, output, dpi=dpi, force=force)
    if json:
        emit_json("workspace", path=path, within_limits=limits)
    else:
        emit(str(path))
    return 0


class _Bar:
    """How far it has come, on one line of a terminal."""

    def __init__(self) -> None:
        self.start, self.on = time.monotonic(), False

    def show(self, what: str, done: int, total: int) -> None:
        if sys.stderr.isatty() and time.monotonic() - self.start > PATIENCE:
            self.on = True
            sys.stderr.write(f"\r{what}: {100 * done // max(total, 1):3d} %")
            sys.stderr.flush()

    def clear(self) -> None:
        if self.on:
            sys.stderr.write("\r\033[K")
