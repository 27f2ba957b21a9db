"""Poses on the command line and in CSV files."""

from __future__ import annotations

import csv
from array import array
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from dh2urdf.bounds import POSES_BYTES
from dh2urdf.cli.options import LARGEST, read_number, read_numbers
from dh2urdf.cli.output import stdin
from dh2urdf.dh_io import Kind, Units
from dh2urdf.dh_io.document import Report
from dh2urdf.dh_io.files import read_text, shown
from dh2urdf.dh_io.grid import INDEX, heading, metadata, separator, unit_words
from dh2urdf.dh_io.units import UNIT_SIZES, unit_kind
from dh2urdf.doors import found
from dh2urdf.exceptions import PoseError
from dh2urdf.transforms import (
    Array,
    check_pose,
    origin_matrix,
    quaternion_to_matrix,
    rounded_off,
    rpy_to_matrix,
)

__all__ = ["Poses", "pose_of", "poses_of_csv"]

PLACE, TURN, QUATERNION = ("x", "y", "z"), ("roll", "pitch", "yaw"), ("qx", "qy", "qz", "qw")
MATRIX = tuple(f"t{i}{j}" for i in range(4) for j in range(4))

LAYOUTS = ((*PLACE, *TURN), (*PLACE, *QUATERNION), MATRIX[:12], MATRIX)
"""Columns that make a pose, in the order in which they are read."""

KNOWN = ", or ".join([*(", ".join(names) for names in LAYOUTS[:2]), "t00 ... t23 or t33"])

KINDS = {
    **dict.fromkeys((*MATRIX, *QUATERNION), Kind.NUMBER),
    **dict.fromkeys((*PLACE, "t03", "t13", "t23"), Kind.LENGTH),
    **dict.fromkeys(TURN, Kind.ANGLE),
}

OFF_UNIT = 0.01
"""How far the norm of a quaternion may be from 1: one typed with three decimals is within it."""


@dataclass(frozen=True)
class Poses:
    """Poses of a file, shape (m, 4, 4), and the line of each."""

    T: Array
    file: str
    lines: Sequence[int]

    def name(self, i: int) -> str:
        """What a pose is called in messages."""
        return f"{self.file}:{self.lines[i]}"


def pose_of(
    xyz: Sequence[str] | None,
    rpy: Sequence[str] | None,
    matrix: Sequence[str] | None,
    *,
    deg: bool,
    position_only: bool = False,
    nearest: bool = False,
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
        return _checked(_of_matrix(np.array(entries)), "--matrix", nearest)
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
    name = "<stdin>" if source == "-" else shown(source)
    sheet = _Sheet(name, Units("m", "deg" if deg else "rad"), nearest)
    try:
        sheet.read(text.split("\n"))
    except csv.Error as error:
        raise PoseError(f"{sheet.file}: not CSV: {error}") from None
    return Poses(sheet.poses(), sheet.file, sheet.lines)


@dataclass
class _Sheet:
    """The numbers of a file of poses, the line of each, and what its columns are."""

    file: str
    units: Units
    nearest: bool = False
    layout: tuple[str, ...] = ()
    order: list[int] = field(default_factory=list)
    width: int = 0
    each: list[Units] = field(default_factory=list)
    cells: array[float] = field(default_factory=lambda: array("d"))
    lines: array[int] = field(default_factory=lambda: array("q"))
    measured: dict[int, list[float]] = field(default_factory=dict)

    def read(self, lines: list[str]) -> None:
        """Take all lines."""
        first = next((line for line in lines if line.strip() and line.lstrip()[0] != "#"), "")
        rows = csv.reader(lines, delimiter=separator(first), skipinitialspace=True, strict=True)
        for row in rows:
            cells = [cell.strip() for cell in row]
            if not any(cells):
                continue
            if cells[0].startswith("#") and cells[0] != "#":
                self._comment(lines[rows.line_num - 1], rows.line_num)
            elif self.layout:
                self._row(cells, rows.line_num)
            elif any(cell[:1] in "+-.0123456789" for cell in cells if cell):
                self._unnamed(len(cells), rows.line_num)
                self._row(cells, rows.line_num)
            else:
                self._header(cells, rows.line_num)

    def _fault(self, line: int, message: str) -> PoseError:
        return PoseError(f"{self.file}:{line}: {message}")

    def _comment(self, text: str, line: int) -> None:
        """Units of the columns that name none, where the comment tells them."""
        entry = metadata(text, line, Report(self.file))
        if entry is None or not entry[0].text.startswith("units"):
            return
        words = unit_words(entry[1])
        if not words or self.layout:
            message = f"found units: {found(entry[1].text)}; expected units: mm, deg above the rows"
            raise self._fault(line, message)
        for kind, unit in words:
            self.units = self.units._replace(**{kind.text: getattr(unit, "text", "")})

    def _header(self, cells: list[str], line: int) -> None:
        """Find where each wanted column is, and its unit."""
        heads = [(key.casefold(), unit) for key, unit in map(heading, cells)]
        at = {key: k for k, (key, _) in enumerate(heads) if key not in INDEX}
        for k, (key, unit) in enumerate(heads):
            if key not in at:
                continue
            if key not in KINDS:
                raise self._fault(line, f"unknown column {found(cells[k])}; known are {KNOWN}")
            if at[key] != k:
                raise self._fault(line, f"two columns for {key}")
            if unit and unit_kind(unit) is not KINDS[key]:
                allowed = ", ".join(UNIT_SIZES[KINDS[key]]) or "none"
                raise self._fault(line, f"found unit {unit!r} for {key}; allowed: {allowed}")
        layout = next((names for names in LAYOUTS if set(names) == set(at)), None)
        if layout is None:
            raise self._fault(line, f"columns {KNOWN} are needed, got {', '.join(at)}")
        self._take(layout, [at[key] for key in layout], [heads[at[key]][1] for key in layout])
        self.width = len(cells)

    def _unnamed(self, count: int, line: int) -> None:
        """Choose the layout that has so many columns."""
        layout = next((n for n in LAYOUTS if len(n) == count and "qw" not in n), None)
        if layout is None:
            name = "; a quaternion needs a header line that names its columns"
            message = f"6 or 12 or 16 numbers are needed, got {count}{name if count == 7 else ''}"
            raise self._fault(line, message)
        self._take(layout, list(range(count)), [""] * count)
        self.width = count

    def _take(self, layout: tuple[str, ...], order: list[int], units: list[str]) -> None:
        self.layout, self.order = layout, order
        self.each = [
            self.units._replace(**{str(KINDS[key]): unit}) if unit else self.units
            for key, unit in zip(layout, units, strict=True)
        ]

    def _row(self, cells: list[str], line: int) -> None:
        """Numbers of one line as they stand; measured at once where they are more than that."""
        if len(cells) != self.width:
            raise self._fault(line, f"{len(cells)} cells, the first line has {self.width}")
        picked, size = [cells[k] for k in self.order], len(self.cells)
        try:
            self.cells.extend(map(float, picked))
            if "_" not in "".join(picked):
                self.lines.append(line)
                return
        except ValueError:
            pass
        del self.cells[size:]
        columns = zip(self.layout, picked, self.each, strict=True)
        values = [
            read_number(cell, f"{self.file}:{line}: {key}", KINDS[key], units, PoseError)
            for key, cell, units in columns
        ]
        self.cells.extend(values)
        self.measured[len(self.lines)] = values
        self.lines.append(line)

    def poses(self) -> Array:
        """All poses, shape (m, 4, 4)."""
        if not self.lines:
            raise PoseError(f"{self.file}: holds no poses")
        values = np.array(self.cells).reshape(len(self.lines), -1)
        for k, (key, units) in enumerate(zip(self.layout, self.each, strict=True)):
            size, parts = UNIT_SIZES[KINDS[key]].get(units.of(KINDS[key]), (1, 1))
            values[:, k] /= float(parts) / float(size)
        for i, row in self.measured.items():
            values[i] = row
        for k, key in enumerate(self.layout):
            far = ~(np.abs(values[:, k]) <= LARGEST[KINDS[key]])
            self._refuse(far, f"{key}: not a number from -{{0:g}} to {{0:g}}", LARGEST[KINDS[key]])
        return self._assembled(values)

    def _refuse(self, bad: Array, message: str, *parts: object) -> None:
        if bad.any():
            raise self._fault(self.lines[int(np.argmax(bad))], message.format(*parts))

    def _assembled(self, values: Array) -> Array:
        """Poses of the rows of a layout."""
        if self.layout[0] == MATRIX[0]:
            return self._rigid(_of_matrix(values))
        T = np.tile(np.eye(4), (len(values), 1, 1))
        T[:, :3, 3] = values[:, :3]
        if "qw" in self.layout:
            norm = np.linalg.norm(values[:, 3:], axis=1)
            far = np.abs(norm - 1.0) > OFF_UNIT
            message = "the norm of the quaternion is {:.3g}; expected 1"
            self._refuse(far, message, norm[np.argmax(far)])
            T[:, :3, :3] = quaternion_to_matrix(values[:, 3:] / norm[:, None])
        else:
            for pose, row in zip(T, values[:, 3:].tolist(), strict=True):
                pose[:3, :3] = rpy_to_matrix(row)
        return T

    def _rigid(self, T: Array) -> Array:
        """Rigid poses; one that is not is named by its line."""
        try:
            return _checked(T, self.file, self.nearest)
        except PoseError:
            for line, pose in zip(self.lines, T, strict=True):
                _checked(pose, f"{self.file}:{line}", self.nearest)
            raise


def _checked(T: Array, what: str, nearest: bool) -> Array:
    """Poses that are rigid, or near enough to a rotation where that is asked for."""
    check_pose(rounded_off(T)[0] if nearest else T, what=what)
    return T


def _of_matrix(entries: Array) -> Array:
    """Matrices from 12 or 16 numbers each, row by row, shape (..., 4, 4)."""
    T = np.zeros((*entries.shape[:-1], 4, 4))
    T[..., 3, 3] = 1.0
    T[..., : entries.shape[-1] // 4, :] = entries.reshape(*entries.shape[:-1], -1, 4)
    return T
