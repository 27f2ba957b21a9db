"""``dh2urdf export``: the arm for other programs to build with."""

from pathlib import Path

from dh2urdf.cli.options import Json
from dh2urdf.cli.output import emit, emit_json, read_any
from dh2urdf.cli.progress import note
from dh2urdf.cli.reading import DEFAULT, Reading


def export_(
    arm: str, /, *, ros2: Path, reading: Reading = DEFAULT, force: bool = False, json: Json = False
) -> None:
    """Write a ROS 2 description package of an arm.

    The URDF is loaded back by Pinocchio and compared with the DH product; beside it are an SRDF
    with the planning group and the pairs of links that need no collision check, MoveIt's
    parameters, and a launch file for RViz.

    Parameters
    ----------
    arm
        A table file, the name of a table that ships, a robot description (URDF, xacro, MJCF) for
        the table that `extract` finds, or - for stdin.
    ros2
        Folder of the package, which is named after it.
    force
        Write the package's files into a folder that holds something; what else is there stays.
    """
    from dh2urdf.export.ros2 import write_ros2_package

    read = read_any(arm, reading)
    package = write_ros2_package(read.table, ros2, force=force)
    warnings = [*read.warnings, *package.warnings]
    if json:
        emit_json(
            "export",
            source=arm,
            path=ros2,
            package=package.name,
            files=list(package.files),
            max_error=package.max_error,
            disabled_collisions=[vars(pair) for pair in package.disabled],
            warnings=warnings,
        )
        return
    for warning in warnings:
        note(f"warning: {warning}")
    checked = f"largest difference between Pinocchio and the DH product {package.max_error:.1e}"
    pairs = f"{len(package.disabled)} pairs of links need no collision check"
    emit(f"{ros2}  package {package.name}, {len(package.files)} files; {checked}; {pairs}")
