"""Poses on the command line and in CSV files."""

import csv
import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from dh2urdf.bounds import POSES_BYTES
from dh2urdf.cli.options import LARGEST, read_number, read_numbers
from dh2urdf.cli.output import stdin
from dh2urdf.dh_io import Kind, Units
from dh2urdf.dh_io.cells.document import Report
from dh2urdf.dh_io.cells.units import UNIT_SIZES
from dh2urdf.dh_io.files import read_text, shown
from dh2urdf.dh_io.formats.grid import metadata, separator, unit_words
from dh2urdf.dh_io.formats.heading import INDEX, heading, without_name
from dh2urdf.doors import found
from dh2urdf.exceptions import PoseError
from dh2urdf.poses import check_pose, rounded_off
from dh2urdf.transforms import Array, origin_matrix, pose, quaternion_to_matrix

_Cells = Sequence[str] | None

PLACE, TURN, QUATERNION = ("x", "y", "z"), ("roll", "pitch", "yaw"), ("qx", "qy", "qz", "qw")
MATRIX = tuple(f"t{i}{j}" for i in range(4) for j in range(4))

LAYOUTS = ((*PLACE, *TURN), (*PLACE, *QUATERNION), MATRIX[:12], MATRIX)
"""Columns that make a pose, in the order in which they are read."""

NAMELESS = (LAYOUTS[0], *LAYOUTS[2:])
"""Those that a file may hold without a header."""

SURE = min(LARGEST.values())
"""Up to here a number is within the bounds of every kind."""

KNOWN = ", or ".join([*(", ".join(names) for names in LAYOUTS[:2]), "t00 ... t23 or t33"])

KINDS = {
    **dict.fromkeys((*MATRIX, *QUATERNION), Kind.NUMBER),
    **dict.fromkeys((*PLACE, "t03", "t13", "t23"), Kind.LENGTH),
    **dict.fromkeys(TURN, Kind.ANGLE),
}

OFF_UNIT = 0.01
"""How far the norm of a quaternion may be from 1: one typed with three decimals is within it."""


class Poses(NamedTuple):
    """Poses of a file, shape (m, 4, 4), and the line of each."""

    T: Array
    file: str
    lines: Sequence[int]

    def name(self, i: int) -> str:
        """What a pose is called in messages."""
        return f"{self.file}:{self.lines[i]}"


def pose_of(
    xyz: _Cells, rpy: _Cells, matrix: _Cells, *, deg: bool, position_only: bool, nearest: bool
) -> Array:
    """The pose of ``--xyz --rpy`` or of ``--matrix``, shape (4, 4), as it was given.

    Raises
    ------
    PoseError
        None is given, a wrong number of values, not numbers, or not a rigid pose.
    """
    units = Units("m", "deg" if deg else "rad")
    if matrix:
        kinds = [KINDS[key] for key in MATRIX]
        entries = read_numbers(matrix, "--matrix", (12, 16), kinds, units, error=PoseError)
        return _of_matrix(entries, "--matrix", nearest)
    if not xyz:
        raise PoseError("a pose is needed: --xyz X Y Z --rpy R P Y, --matrix, or --csv FILE")
    position = read_numbers(xyz, "--xyz", (3,), Kind.LENGTH, units, error=PoseError)
    if not rpy and not position_only:
        raise PoseError("--rpy is needed, too (or --task position)")
    angles = read_numbers(rpy or "000", "--rpy", (3,), Kind.ANGLE, units, error=PoseError)
    return origin_matrix(position, angles)


def poses_of_csv(source: str, *, deg: bool, nearest: bool = False) -> Poses:
    """The poses of a CSV file, a line each; commas, semicolons or tabs part its cells.

    A header line names the columns in any order, with their units where these are not metres and
    radians (``x [mm]``, ``yaw_deg``), as in table files: x y z with roll pitch yaw or with the
    quaternion qx qy qz qw, or the matrix t00 ... t23 or t33. Without one the columns are x y z
    roll pitch yaw, or 12 or 16 matrix entries. Empty lines and lines that begin with # are
    skipped, but for ``# units: mm, deg``.

    Raises
    ------
    PoseError
        The message names file and line.
    """
    text = read_text(stdin() if source == "-" else source, POSES_BYTES, PoseError)
    file = "<stdin>" if source == "-" else shown(source)
    units, columns = Units("m", "deg" if deg else "rad"), list[_Column]()
    nameless = list[int]()
    poses, at, lines = list[Array](), list[int](), text.split("\n")
    first = next((line for line in lines if line.strip() and line.lstrip()[0] != "#"), "")
    rows = csv.reader(lines, delimiter=separator(first), skipinitialspace=True, strict=True)
    try:
        for row in rows:
            cells, where = [cell.strip() for cell in row], f"{file}:{rows.line_num}"
            if not any(cells):
                continue
            if cells[0].startswith("#") and cells[0] != "#":
                units = _stated(units, lines[rows.line_num - 1], where, late=bool(columns))
                continue
            if not columns:
                columns = _columns(cells, units, where)
                if columns[0].named:
                    nameless = [k for k, cell in enumerate(cells) if not cell]
                    continue
            filled = [k for k in nameless if k < len(cells) and cells[k]]
            if filled not in ([], [0]):
                raise PoseError(f"{where}: {without_name(filled)}")
            poses.append(_pose(cells, columns, where, nearest))
            at.append(rows.line_num)
    except csv.Error as error:
        raise PoseError(f"{file}: not CSV: {error}") from None
    if not poses:
        raise PoseError(f"{file}: holds no poses")
    return Poses(np.stack(poses), file, at)


class _Column(NamedTuple):
    """Name of a column, where it stands among how many, its unit and the size of that."""

    name: str
    place: int
    width: int
    units: Units
    size: float
    named: bool


def _stated(units: Units, comment: str, where: str, *, late: bool) -> Units:
    """Units of the columns that name none, where a comment tells them."""
    entry = metadata(comment, 1, Report(where))
    if entry is None or not entry[0].text.startswith("units"):
        return units
    words = unit_words(entry[1])
    if not words or late:
        given = found(entry[1].text)
        raise PoseError(f"{where}: found units: {given}; expected units: mm, deg above the poses")
    return units._replace(**{kind.text: getattr(unit, "text", "") for kind, unit in words})


def _columns(cells: list[str], units: Units, where: str) -> list[_Column]:
    """The columns that a first row names, or those of so many numbers, in the order of a layout."""
    named = not any(cell[:1] in "+-.0123456789" for cell in cells if cell)
    head = cells if named else next((n for n in NAMELESS if len(n) == len(cells)), None)
    if head is None:
        quaternion = "; name the columns of a quaternion" if len(cells) == 7 else ""
        raise PoseError(f"{where}: 6 or 12 or 16 numbers are needed, got {len(cells)}{quaternion}")
    columns = dict[str, _Column]()
    for place, (cell, (text, unit)) in enumerate(zip(head, map(heading, head), strict=True)):
        name = text.casefold()
        if name in INDEX:
            continue
        if name not in KINDS or name in columns:
            fault = "a second" if name in columns else "unknown"
            raise PoseError(f"{where}: {fault} column {found(cell)}; known are {KNOWN}")
        sizes, kind = UNIT_SIZES[KINDS[name]], str(KINDS[name])
        if unit and unit not in sizes:
            allowed = ", ".join(sizes) or "none"
            raise PoseError(f"{where}: found unit {unit!r} for {name}; allowed: {allowed}")
        own = units._replace(**{kind: unit}) if unit else units
        one, parts = sizes.get(own.of(KINDS[name]), (1, 1))
        size = float(parts) / float(one)
        columns[name] = _Column(name, place, len(cells), own, size, named)
    for layout in LAYOUTS:
        if set(layout) == set(columns):
            return [columns[name] for name in layout]
    raise PoseError(f"{where}: columns {KNOWN} are needed, got {', '.join(columns)}")


def _pose(cells: list[str], columns: list[_Column], where: str, nearest: bool) -> Array:
    """The pose of one line, shape (4, 4)."""
    if len(cells) != columns[0].width:
        raise PoseError(f"{where}: {len(cells)} cells, the first line has {columns[0].width}")
    picked = [cells[column.place] for column in columns]
    try:
        values = [float(c) / column.size for c, column in zip(picked, columns, strict=True)]
    except ValueError:
        values = [math.nan]
    if not all(abs(v) <= SURE for v in values) or "_" in "".join(picked):
        values = [
            read_number(cell, f"{where}: {c.name}", KINDS[c.name], c.units, PoseError)
            for cell, c in zip(picked, columns, strict=True)
        ]
    if columns[0].name == MATRIX[0]:
        return _of_matrix(values, where, nearest)
    if columns[-1].name == "yaw":
        return origin_matrix(values[:3], values[3:])
    norm = math.hypot(*values[3:])
    if abs(norm - 1.0) > OFF_UNIT:
        raise PoseError(f"{where}: the norm of the quaternion is {norm:.3g}; expected 1")
    return pose(quaternion_to_matrix(np.array(values[3:]) / norm), values[:3])


def _of_matrix(entries: list[float], what: str, nearest: bool) -> Array:
    """A pose from 12 or 16 numbers, row by row, that is rigid, or nearly where that will do."""
    T = np.eye(4)
    T[: len(entries) // 4] = np.reshape(entries, (-1, 4))
    check_pose(rounded_off(T)[0] if nearest else T, what=what)
    return T
