"""Poses on the command line and in CSV files."""

import csv
import math
import re
from collections.abc import Iterator, Sequence
from contextlib import suppress
from itertools import chain
from typing import NamedTuple

import numpy as np

from dh2urdf.bounds import POSES_BYTES
from dh2urdf.cli.options import LARGEST, read_number, read_numbers
from dh2urdf.cli.output import stdin
from dh2urdf.cli.verbs.ik.doubts import bare_angle
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
"""Those that a file may hold without a header; of positions alone there is no other."""

SURE = min(LARGEST.values())
"""Up to here a number is within the bounds of every kind."""

KNOWN = ", or ".join([*(", ".join(names) for names in LAYOUTS[:2]), "t00 ... t23 or t33"])

KINDS = {
    **dict.fromkeys((*MATRIX, *QUATERNION), Kind.NUMBER),
    **dict.fromkeys((*PLACE, "t03", "t13", "t23"), Kind.LENGTH),
    **dict.fromkeys(TURN, Kind.ANGLE),
}

_DECIMAL_COMMA = re.compile(
    r"(?:(?<=[;\t\n])|\A)( *[-+]?\d*),(\d+(?:[eE][-+]?\d+)? *(?:[^\W\d_]|°)* *)(?=[;\t\n]|\Z)"
)

OFF_UNIT = 0.01
"""How far the norm of a quaternion may be from 1: one typed with three decimals is within it."""


class Poses(NamedTuple):
    """Poses of a file, shape (m, 4, 4), the largest bare angle [rad] and the line of each."""

    T: Array
    angles: Array
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


def poses_of_csv(
    source: str, *, deg: bool, nearest: bool = False, position_only: bool = False
) -> Poses:
    """The poses of a CSV file, a line each; commas, semicolons or tabs part its cells.

    A header line names the columns in any order, with their units where these are not metres and
    radians (``x [mm]``, ``yaw_deg``), as in table files: x y z with roll pitch yaw or with the
    quaternion qx qy qz qw, or the matrix t00 ... t23 or t33; with ``position_only`` x y z alone
    will do. Without one the columns are x y z roll pitch yaw, or 12 or 16 matrix entries. Empty
    lines and lines that begin with # are skipped, but for ``# units: mm, deg``. A comma that
    parts no cells may be a decimal point.

    Raises
    ------
    PoseError
        The message names file and line.
    """
    text = read_text(stdin() if source == "-" else source, POSES_BYTES, PoseError)
    file, lines = "<stdin>" if source == "-" else shown(source), text.split("\n")
    units = Units("m", "deg" if deg else "rad")
    first = next((line for line in lines if line.strip() and line.lstrip()[0] != "#"), "")
    part = separator(_DECIMAL_COMMA.sub(r"\1.\2", first))
    if part != ",":
        lines = _DECIMAL_COMMA.sub(r"\1.\2", text).split("\n")
    rows = _rows(lines, part, file)
    for cells, number in rows:
        if not _is_comment(cells):
            break
        units = _stated(units, lines[number - 1], f"{file}:{number}", late=False)
    else:
        raise PoseError(f"{file}: holds no poses")
    columns = _columns(cells, units, f"{file}:{number}", position_only)
    named = columns[0].named
    numbers = [n for n in range(number - (not named), len(lines)) if lines[n].strip()]
    turns = [k for k, c in enumerate(columns) if c.name in TURN and c.size == 1.0]
    values = _all_at_once([lines[n] for n in numbers], part, columns)
    with suppress(PoseError):  # to be told with its line
        if values is not None:
            angles = np.abs(values[:, turns]).max(axis=1, initial=0.0)
            T = _stack(values, columns, "", nearest)
            return Poses(T, angles, file, [n + 1 for n in numbers])
    unnamed = [k for k, cell in enumerate(cells) if named and not cell]
    begin = [] if named else [(cells, number)]
    at, poses, bare = list[int](), list[Array](), list[float]()
    for cells, number in chain(begin, rows):
        where = f"{file}:{number}"
        if _is_comment(cells):
            _stated(units, lines[number - 1], where, late=True)
            continue
        filled = [k for k in unnamed if k < len(cells) and cells[k]]
        if filled not in ([], [0]):
            raise PoseError(f"{where}: {without_name(filled)}")
        poses.append(_pose(cells, columns, where, nearest))
        bare.append(bare_angle(cells[columns[k].place] for k in turns))
        at.append(number)
    if not poses:
        raise PoseError(f"{file}: holds no poses")
    return Poses(np.stack(poses), np.array(bare), file, at)


def _rows(lines: list[str], part: str, file: str) -> Iterator[tuple[list[str], int]]:
    """Cells of each line that has any, and its number."""
    reader = csv.reader(lines, delimiter=part, skipinitialspace=True, strict=True)
    try:
        for row in reader:
            cells = [cell.strip() for cell in row]
            if any(cells):
                yield cells, reader.line_num
    except csv.Error as error:
        raise PoseError(f"{file}: not CSV: {error}") from None


def _is_comment(cells: list[str]) -> bool:
    """Whether a line is none of a pose; a heading ``#`` is that of a count."""
    return cells[0].startswith("#") and cells[0] != "#"


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


def _columns(cells: list[str], units: Units, where: str, position_only: bool) -> list[_Column]:
    """The columns that a first row names, or those of so many numbers, in the order of a layout."""
    named = not any(cell[:1] in "+-.0123456789" for cell in cells if cell)
    layouts = (*LAYOUTS, PLACE) if position_only else LAYOUTS
    nameless = (*NAMELESS, PLACE) if position_only else NAMELESS
    head = cells if named else next((n for n in nameless if len(n) == len(cells)), None)
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
    for layout in layouts:
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
    T: Array = _stack(np.array([values]), columns, where, nearest)[0]
    return T


def _all_at_once(lines: list[str], part: str, columns: list[_Column]) -> Array | None:
    """Values of lines that hold nothing but numbers, in the order of a layout; None of others."""
    if not lines:
        return None
    try:
        cells = np.loadtxt(lines, delimiter=part, comments=None, ndmin=2)
        if cells.shape[1] != columns[0].width:
            return None
        sizes = np.array([column.size for column in columns])
        values: Array = cells[:, [column.place for column in columns]] / sizes
        return values if (np.abs(values) <= SURE).all() else None
    except ValueError:
        return None


def _stack(values: Array, columns: list[_Column], where: str, nearest: bool) -> Array:
    """Poses of numbers in the order of a layout, shape (m, 4, 4)."""
    if columns[0].name == MATRIX[0]:
        T = np.broadcast_to(np.eye(4), (len(values), 4, 4)).copy()
        T[:, : values.shape[1] // 4] = values.reshape(len(values), -1, 4)
        check_pose(rounded_off(T)[0] if nearest else T, what=where, rounded=nearest)
        return T
    position, turn = values[:, :3], values[:, 3:]
    if columns[-1].name == "z":
        return pose(np.broadcast_to(np.eye(3), (len(values), 3, 3)), position)
    if columns[-1].name == "yaw":
        return pose(_rotations(turn), position)
    norm = np.linalg.norm(turn, axis=1, keepdims=True)
    if np.abs(norm - 1.0).max() > OFF_UNIT:
        raise PoseError(f"{where}: the norm of the quaternion is {norm[0, 0]:.3g}; expected 1")
    return pose(quaternion_to_matrix(turn / norm), position)


def _rotations(rpy: Array) -> Array:
    """``Rz(yaw) Ry(pitch) Rx(roll)`` of angles (m, 3), shape (m, 3, 3)."""
    (cr, cp, cy), (sr, sp, sy) = np.cos(rpy.T), np.sin(rpy.T)
    rows = [
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
        [-sp, cp * sr, cp * cr],
    ]
    return np.moveaxis(np.array(rows), -1, 0)


def _of_matrix(entries: list[float], what: str, nearest: bool) -> Array:
    """A pose from 12 or 16 numbers, row by row, that is rigid, or nearly where that will do."""
    T = np.eye(4)
    T[: len(entries) // 4] = np.reshape(entries, (-1, 4))
    check_pose(rounded_off(T)[0] if nearest else T, what=what, rounded=nearest)
    return T
