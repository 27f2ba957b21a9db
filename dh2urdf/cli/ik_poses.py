"""Poses on the command line and in CSV files."""

from __future__ import annotations

import csv
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from dh2urdf.cli.options import read_numbers
from dh2urdf.dh_io import Kind, Units
from dh2urdf.exceptions import PoseError
from dh2urdf.transforms import Array, check_pose, origin_matrix

__all__ = ["Poses", "pose_of", "poses_of_csv"]

COLUMNS = ("x", "y", "z", "roll", "pitch", "yaw")

ROW_BY_ROW = tuple(f"t{i}{j}" for i in range(4) for j in range(4))


class Poses(NamedTuple):
    """Poses of a file and what to call them in messages."""

    T: Array
    names: tuple[str, ...]


def pose_of(
    xyz: Sequence[str] | None,
    rpy: Sequence[str] | None,
    matrix: Sequence[str] | None,
    *,
    deg: bool,
    position_only: bool = False,
) -> Array:
    """The pose of ``--xyz --rpy`` or of ``--matrix``, shape (4, 4).

    Raises
    ------
    PoseError
        Neither or both are given, a wrong number of values, not numbers, or not a rigid pose.
    """
    units = Units("m", "deg" if deg else "rad")
    if matrix:
        return _from_entries(_numbers(matrix, "--matrix", (12, 16), Kind.NUMBER, units), "--matrix")
    if not xyz:
        raise PoseError("a pose is needed: --xyz X Y Z --rpy R P Y, --matrix, or --csv FILE")
    position = _numbers(xyz, "--xyz", (3,), Kind.LENGTH, units)
    if not rpy and not position_only:
        raise PoseError("--rpy is needed, too (or --task position)")
    angles = _numbers(rpy, "--rpy", (3,), Kind.ANGLE, units) if rpy else [0.0, 0.0, 0.0]
    return origin_matrix(position, angles)


def poses_of_csv(source: str, *, deg: bool) -> Poses:
    """The poses of a CSV file: x y z roll pitch yaw, or 12 or 16 matrix entries a line.

    A header line may name the columns and put them in any order (``x`` ... ``yaw``, ``t00`` ...
    ``t33``); empty lines and lines that begin with # are skipped.

    Raises
    ------
    PoseError
        The message names file and line.
    """
    name = "<stdin>" if source == "-" else source
    try:
        text = sys.stdin.read() if source == "-" else Path(source).read_text("utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise PoseError(f"{name}: cannot be read: {error}") from None
    units = Units("m", "deg" if deg else "rad")
    order: list[int] | None = None
    poses: list[Array] = []
    names: list[str] = []
    for line, row in enumerate(csv.reader(text.splitlines()), 1):
        cells = [cell.strip() for cell in row]
        if not any(cells) or cells[0].startswith("#"):
            continue
        if not poses and order is None and cells[0][:1].isalpha():
            order = _header(cells, f"{name}:{line}")
            continue
        where = f"{name}:{line}"
        poses.append(_row(cells, order, where, units))
        names.append(where)
    if not poses:
        raise PoseError(f"{name}: holds no poses")
    return Poses(np.stack(poses), tuple(names))


def _header(cells: list[str], where: str) -> list[int]:
    """For each wanted column, where it is."""
    keys = [cell.lower().split("[")[0].strip() for cell in cells]
    for wanted in (COLUMNS, ROW_BY_ROW, ROW_BY_ROW[:12]):
        if set(wanted) <= set(keys):
            return [keys.index(key) for key in wanted]
    raise PoseError(
        f"{where}: columns {', '.join(COLUMNS)} or t00 ... t33 are needed, got {', '.join(keys)}"
    )


def _row(cells: list[str], order: list[int] | None, where: str, units: Units) -> Array:
    """The pose of one line."""
    if order is not None:
        if len(cells) <= max(order):
            raise PoseError(f"{where}: {len(cells)} cells, the header has more")
        cells = [cells[k] for k in order]
    if len(cells) == len(COLUMNS):
        position = _numbers(cells[:3], where, (3,), Kind.LENGTH, units)
        return origin_matrix(position, _numbers(cells[3:], where, (3,), Kind.ANGLE, units))
    return _from_entries(_numbers(cells, where, (6, 12, 16), Kind.NUMBER, units), where)


def _numbers(
    cells: Sequence[str], where: str, sizes: tuple[int, ...], kind: Kind, units: Units
) -> list[float]:
    return read_numbers(cells, where, sizes, kind, units, error=PoseError)


def _from_entries(entries: list[float], where: str) -> Array:
    """A pose from 12 or 16 numbers, row by row."""
    T = np.eye(4)
    T[: len(entries) // 4] = np.reshape(entries, (-1, 4))
    return check_pose(T, what=where)
