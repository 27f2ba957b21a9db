"""``dh2urdf export``: the arm for other programs to build with."""

import re
from pathlib import Path
from typing import Annotated, Literal

from cyclopts import Parameter

from dh2urdf.cli.options import Json, Link
from dh2urdf.cli.output import emit, emit_file, emit_json, read_any, robot_of
from dh2urdf.cli.progress import note
from dh2urdf.cli.reading import DEFAULT, Reading
from dh2urdf.dh_io import refuse_foreign, refuse_unwritable
from dh2urdf.exceptions import ArgumentError


def export_(
    arm: str,
    /,
    *,
    ros2: Path | None = None,
    plugin: bool = False,
    output: Annotated[Path | None, Parameter(name=["--output", "-o"])] = None,
    language: Literal["c", "c++", "python"] | None = None,
    prefix: str | None = None,
    held: str | None = None,
    tests: Path | None = None,
    base: Link = None,
    tip: Link = None,
    reading: Reading = DEFAULT,
    force: bool = False,
    json: Json = False,
) -> None:
    """Write a ROS 2 description package of an arm, or its solver as source code.

    Of the package, the URDF is loaded back by Pinocchio and compared with the DH product; beside it
    are an SRDF with the planning group and the pairs of links that need no collision check,
    MoveIt's parameters, and a launch file for RViz.

    The source code is one file that needs nothing else: forward kinematics, Jacobian and all
    solutions of the inverse kinematics, by the kernels of this package with the numbers of the arm
    in them. Its head says what its functions do.

    Parameters
    ----------
    arm
        A table file, the name of a table that ships, a robot description (URDF, xacro, MJCF; for a
        package the table that `extract` finds), or - for stdin.
    ros2
        Folder of the package, which is named after it.
    plugin
        With the arm's own solver as MoveIt's kinematics plugin.
    output
        The source file: .h for C, .hpp for C++, .py for Python; - for stdout. The C is C99 that C++
        takes, too; the Python needs nothing but math.
    language
        Of the source where the suffix does not tell.
    prefix
        With which all names of C begin. Default: the name of the table, or the file's.
    held
        Name or number (0 is the first) of a joint whose value is given with every pose; an arm of
        seven joints needs one.
    tests
        A C program to write, too, which checks the source where it is compiled: poses, their
        solutions and residuals.
    force
        Write the package's files into a folder that holds something, what else is there stays;
        replace a source file that dh2urdf did not write.
    """
    if ros2 is not None:
        _package(arm, ros2, reading, plugin=plugin, force=force, json=json)
        return
    if output is None:
        raise ArgumentError(
            "export: -o FILE writes the solver's source code, --ros2 DIR a ROS 2 package"
        )
    from dh2urdf.export.source import MARK, export_solver, exported

    robot = robot_of(arm, base, tip, reading)
    joint: int | str | None = held
    if held is not None and held not in robot.joint_names and re.fullmatch(r"[+-]?[0-9]+", held):
        joint = int(held)
    to_stdout = str(output) == "-"
    if tests is not None and (language == "python" or output.suffix.lower() == ".py"):
        raise ArgumentError("--tests writes a C program: it does nothing for Python")
    if tests is not None:
        if tests.resolve() == output.resolve():
            raise ArgumentError(f"--tests: {tests} is the file of -o; expected another one")
        refuse_unwritable(tests)
        if not force:
            refuse_foreign(tests, MARK)
    if to_stdout:
        made = exported(robot, language=language or "c", prefix=prefix, held=joint)
    else:
        made = export_solver(
            robot, output, language=language, prefix=prefix, held=joint, force=force
        )
    if tests is not None:
        from dh2urdf.export.self_test import write_self_test

        write_self_test(robot, made, output, tests, held=joint, force=force)
    if json:
        keys = ("language", "prefix", "solver", "solutions", "stack")
        told = {key: getattr(made, key) for key in keys}
        told |= {} if tests is None else {"tests": tests}
        text = {"text": made.text} if to_stdout else {}
        emit_json("export", source=arm, path=output, **told, **text)
    elif to_stdout:
        emit_file(made.text)
        note(str(made))
    else:
        emit(f"{output}: {made}")
        if tests is not None:
            emit(f"{tests}: checks it where it is compiled")


def _package(
    arm: str, ros2: Path, reading: Reading, *, plugin: bool, force: bool, json: bool
) -> None:
    """Write a ROS 2 package."""
    from dh2urdf.export.ros2 import write_ros2_package

    read = read_any(arm, reading)
    package = write_ros2_package(read.table, ros2, plugin=plugin, force=force)
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
