"""What the verbs share: printing, JSON, angles, robots by path or name."""

from __future__ import annotations

import io
import json
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np

from dh2urdf.bounds import TABLE_BYTES
from dh2urdf.cli.options import DEFAULT, Reading, read_numbers
from dh2urdf.cli.progress import note
from dh2urdf.dh import DHTable
from dh2urdf.dh_io import Kind, TableFile, Told, Units
from dh2urdf.dh_io.cells.told import NOTHING
from dh2urdf.exceptions import ConfigurationError, TableError
from dh2urdf.grids import grid_matrix, number
from dh2urdf.transforms import Array

if TYPE_CHECKING:
    from dh2urdf.robot import Robot


SCHEMA = 1
"""Number of the layout of ``--json`` objects; it grows when a key changes its meaning."""

ROBOT_SUFFIXES = {".urdf", ".xacro", ".xml", ".mjcf"}


def emit(text: str) -> None:
    """Result for people, on stdout."""
    sys.stdout.write(text.rstrip("\n") + "\n")


def emit_json(verb: str, **values: Any) -> None:
    """One JSON object on stdout: full precision, metres and radians."""
    data = {"schema": SCHEMA, "verb": verb, **values}
    spelt = "utf" not in (sys.stdout.encoding or "").lower()
    sys.stdout.write(json.dumps(data, default=_plain, ensure_ascii=spelt, indent=2) + "\n")


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
    """A table by path, by name, or from stdin (``-``, YAML); what it does not say was told."""
    from dh2urdf.dh_io import parse_table
    from dh2urdf.dh_io.files import read_text
    from dh2urdf.robots import load_table_file

    if source == "-":
        return parse_table(read_text(stdin(), TABLE_BYTES, TableError), "yaml", "<stdin>", told)
    return load_table_file(source, told)


def table_of(source: str, told: Told = NOTHING) -> DHTable:
    """The table of a source, its oddities noted on stderr."""
    table, warnings = read_source(source, told)
    for warning in warnings:
        note(f"warning: {warning}")
    return table


def robot_of(
    source: str, base: str | None = None, tip: str | None = None, reading: Reading = DEFAULT
) -> Robot:
    """The robot of a table or of a robot description, by suffix."""
    from dh2urdf.robot import Robot

    if Path(source).suffix.lower() in ROBOT_SUFFIXES or base or tip:
        return Robot.from_urdf(source, base, tip)
    return Robot.from_dh(table_of(source, reading.told))


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
