"""What the verbs share: printing, JSON, angles, robots by path or name."""

from __future__ import annotations

import io
import json
import re
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np

from dh2urdf.bounds import ROBOT_BYTES, TABLE_BYTES
from dh2urdf.cli.options import read_numbers
from dh2urdf.cli.progress import note
from dh2urdf.cli.reading import DEFAULT, Reading
from dh2urdf.dh import DHTable
from dh2urdf.dh_io import Kind, TableFile, Told, Units
from dh2urdf.dh_io.cells.told import NOTHING
from dh2urdf.exceptions import ArgumentError, ConfigurationError, TableError, UrdfError
from dh2urdf.grids import grid_matrix, number
from dh2urdf.transforms import Array

if TYPE_CHECKING:
    from dh2urdf.robot import Robot


SCHEMA = 1
"""Number of the layout of ``--json`` objects; it grows when a key changes its meaning."""

PLACE = re.compile(
    r"(?P<place>(?:(?!: )[^\n])+?):(?P<line>\d+)(?::(?P<column>\d+))?: |(?P<word>\S+): "
)
"""How messages begin: ``arm.yaml:3:12: ``, ``poses.csv:5: `` or ``--xyz: ``."""

ROBOT_SUFFIXES = {".urdf", ".xacro", ".xml", ".mjcf"}


def emit(text: str) -> None:
    """Result on stdout: a terminal shows the true minus, a program reads ASCII numbers."""
    if not sys.stdout.isatty():
        text = text.replace("\N{MINUS SIGN}", "-").replace("\N{DEGREE SIGN}", " deg")
    emit_file(text)


def emit_file(text: str) -> None:
    """Text on stdout as a file would hold it."""
    sys.stdout.write(text.rstrip("\n") + "\n")


def emit_json(verb: str, **values: Any) -> None:
    """One JSON object on stdout: full precision, metres and radians."""
    sys.stdout.write(to_json({"schema": SCHEMA, "verb": verb, **values}) + "\n")


def to_json(data: dict[str, Any], indent: int | None = 2) -> str:
    """JSON that stdout can take."""
    spelt = "utf" not in (sys.stdout.encoding or "").lower()
    return json.dumps(data, default=_plain, ensure_ascii=spelt, indent=indent)


def emit_error(verb: str, error: Exception) -> None:
    """One JSON object on stdout that says what was wrong, and where."""
    problems = error.problems if isinstance(error, TableError) else (str(error),)
    each = [{"message": problem, "where": _where(problem)} for problem in problems]
    kind, where = type(error).__name__, each[0]["where"]
    emit_json(verb, kind=kind, message=str(error), where=where, problems=each)


def _where(problem: str) -> dict[str, Any] | None:
    """File, option or name that a message begins with; its line and column where it tells them."""
    match = PLACE.match(problem)
    if match is None:
        return None
    line, column = (int(number) if number else None for number in match.group("line", "column"))
    return {"place": match["place"] or match["word"], "line": line, "column": column}


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, Path):
        return str(value)
    raise TypeError(f"not serialisable: {type(value)}")


def stdin() -> BinaryIO:
    """Bytes on stdin."""
    return getattr(sys.stdin, "buffer", None) or io.BytesIO(sys.stdin.read().encode())


def read_source(source: str, told: Told = NOTHING) -> TableFile:
    """A table by path, by name, or from stdin (``-``); what it does not say was told."""
    from dh2urdf.robots import load_table_file

    return _table_of_text(_piped(), told) if source == "-" else load_table_file(source, told)


def read_any(source: str, reading: Reading) -> TableFile:
    """Like :func:`read_source`, also of a robot description, by extraction where need be.

    An MJCF is read by MuJoCo from a file; on stdin only for the table that it carries.
    """
    from dh2urdf.convert import table_of_description
    from dh2urdf.dh_io.read import refuse_page

    text = _piped() if source == "-" else ""
    if text.lstrip().startswith("<"):
        refuse_page(text, "<stdin>")
    if text.lstrip().startswith("<") and not text.lstrip().startswith("<mujoco"):
        return table_of_description(text, reading.convention, **reading.given)
    if Path(source).suffix.lower() in ROBOT_SUFFIXES:
        return table_of_description(source, reading.convention, **reading.given)
    _refuse_given(reading)
    return _table_of_text(text, reading.told) if text else read_source(source, reading.told)


def _refuse_given(reading: Reading) -> None:
    """Refuse what is given for a robot description where there is a table."""
    for option, named in reading.given.items():
        if named:
            raise ArgumentError(
                f"--{option.replace('_args', '-arg').rstrip('s')} does nothing for a table"
            )


def _piped() -> str:
    """The text on stdin: a table or a robot description."""
    from dh2urdf.dh_io.files import read_text

    return read_text(stdin(), ROBOT_BYTES, TableError)


def _table_of_text(text: str, told: Told) -> TableFile:
    """The table of a text in any format, also one that a URDF carries."""
    from dh2urdf.dh_io import parse_table
    from dh2urdf.dh_io.forms import CONF_SIGN, read_conf_text, refuse_model
    from dh2urdf.dh_io.read import format_of_text
    from dh2urdf.dh_io.xml import embedded_table

    if CONF_SIGN.search(text) and len(text) <= TABLE_BYTES:
        return TableFile(*read_conf_text(text, "<stdin>", told, "calibration"))
    refuse_model(told, "<stdin>")
    if text.lstrip().startswith("<"):
        return TableFile(embedded_table(io.BytesIO(text.encode())), ())
    if len(text) > TABLE_BYTES:
        raise TableError(f"<stdin>: larger than {TABLE_BYTES // 1000} kB, the most that is read")
    return parse_table(text, format_of_text(text), "<stdin>", told)


def table_of(source: str, told: Told = NOTHING) -> DHTable:
    """The table of a source, its oddities noted on stderr."""
    return noted(read_source(source, told)).table


def noted(read: TableFile) -> TableFile:
    """What was read, its oddities noted on stderr."""
    for warning in read.warnings:
        note(f"warning: {warning}")
    return read


def robot_of(
    source: str, base: str | None = None, tip: str | None = None, reading: Reading = DEFAULT
) -> Robot:
    """The robot of a table or of a robot description, by suffix; of what stdin holds for ``-``."""
    from dh2urdf.robot import Robot

    if source == "-":
        text = _piped()
        if text.lstrip().startswith("<"):
            return _followed(Robot.from_urdf(text, base, tip, **reading.given))
        if base or tip:
            raise UrdfError("<stdin>:1: not XML; --base and --tip are links of a URDF")
        return Robot.from_dh(noted(_table_of_text(text, reading.told)).table)
    if Path(source).suffix.lower() in ROBOT_SUFFIXES or base or tip:
        return _followed(Robot.from_urdf(source, base, tip, **reading.given))
    _refuse_given(reading)
    return Robot.from_dh(table_of(source, reading.told))


def _followed(robot: Robot) -> Robot:
    """The robot of a description, limits of its followers that count for nothing noted."""
    for warning in robot.coupling.warnings if robot.coupling else ():
        note(f"warning: {warning}")
    return robot


def parse_configuration(
    values: Iterable[str], robot: Robot, *, deg: bool, what: str = "q"
) -> Array:
    """q from the command line, in [rad] and [m].

    Bare numbers are radians (degrees with ``deg``) and metres. Each value may carry its unit
    (``90deg``, ``120mm``) or be an expression (``-pi/2``); spaces or commas part them.
    """
    kinds = [Kind.LENGTH if slides else Kind.ANGLE for slides in robot.slides]
    units = Units("m", "deg" if deg else "rad")
    names, error = robot.joint_names, ConfigurationError
    return np.array(read_numbers(values, what, (robot.n,), kinds, units, names=names, error=error))


def parse_angles(
    values: Iterable[str] | None, what: str, count: int, *, deg: bool
) -> list[float] | None:
    """So many angles from the command line, in [rad]; None where none are given."""
    units = Units("m", "deg" if deg else "rad")
    return read_numbers(values, what, (count,), Kind.ANGLE, units) if values else None


def ten_digits(value: float) -> str:
    """A number for people, rounding noise below 1e-15 shown as 0."""
    return number(0.0 if abs(value) < 1e-15 else float(f"{value:.10g}"))


def matrix_text(T: Array) -> str:
    """A (4, 4) matrix in aligned columns."""
    return grid_matrix([list(map(ten_digits, row)) for row in T])
