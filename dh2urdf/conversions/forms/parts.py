"""What forms share: numbers with units, names, limits, steps; their text."""

import json
import math
import re
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from dh2urdf import transforms as tf
from dh2urdf.bounds import ANGLE, LENGTH
from dh2urdf.chain import SerialChain
from dh2urdf.conversions.assign import tidy_origin
from dh2urdf.dh import DHTable
from dh2urdf.dh_io import Kind, parse_cell
from dh2urdf.doors import found, text
from dh2urdf.exceptions import TableError
from dh2urdf.transforms import Array

Read = tuple[DHTable, tuple[str, ...]]
"""A table, and what there is to say of it."""

LARGEST = {Kind.LENGTH: LENGTH, Kind.ANGLE: ANGLE, Kind.NUMBER: 1.0}

_DEGREES = re.compile(r"\s*deg\s*\((.*)\)\s*", re.DOTALL)


def number(cell: object, what: str, kind: Kind) -> float:
    """A number in [m] or [rad], or an expression such as ``pi/2``, ``deg(-90)``, ``25mm``."""
    if isinstance(cell, str):
        inner = _DEGREES.fullmatch(cell)
        try:
            value = parse_cell(f"({inner[1]})*pi/180" if inner else cell, kind)
        except TableError as error:
            raise TableError(f"{what}: {found(cell)}: {error}") from None
    elif isinstance(cell, (int, float)) and not isinstance(cell, bool):
        value = float(cell)
    else:
        raise TableError(f"{what}: expected a number, got {found(cell)}")
    if not abs(value) <= LARGEST[kind]:
        raise TableError(f"{what}: expected a number up to {LARGEST[kind]:g}, got {found(cell)}")
    return value


def numbers(cells: object, what: str, kind: Kind, count: int) -> list[float]:
    """So many numbers of a list."""
    if not isinstance(cells, list) or len(cells) != count:
        raise TableError(f"{what}: expected {count} numbers, got {found(cells)}")
    return [number(cell, f"{what}[{i}]", kind) for i, cell in enumerate(cells, 1)]


def check_keys(content: Mapping[str, Any], allowed: Sequence[str], what: str = "") -> None:
    """Refuse keys that are not known."""
    unknown = [key for key in content if key not in allowed]
    if unknown:
        raise TableError(f"{what}{found(unknown[0])} is not known; allowed: {', '.join(allowed)}")


def mapping(cell: object, what: str, allowed: Sequence[str]) -> Mapping[str, Any]:
    """Keys and values, none of them unknown."""
    if not isinstance(cell, Mapping):
        raise TableError(f"{what}: expected keys {', '.join(allowed)}, got {found(cell)}")
    check_keys(cell, allowed, f"{what}: ")
    return cell


def joint_names(content: Mapping[str, Any], n: int) -> tuple[str, ...]:
    """Names of n joints, ``joint_1`` ... where there are none."""
    given = content.get("joint_names")
    if given is None:
        return tuple(f"joint_{i}" for i in range(1, n + 1))
    if not isinstance(given, list) or len(given) != n:
        raise TableError(f"joint_names: expected {n} texts, got {found(given)}")
    return tuple(text(label, "joint_names", TableError) for label in given)


def limits(content: Mapping[str, Any], kinds: Sequence[Kind]) -> tuple[Array, Array]:
    """Bounds of the joints [rad] or [m], infinite where there are none."""
    out = []
    for key, none in (("lower", -math.inf), ("upper", math.inf)):
        cells = content.get(key)
        cells = [None] * len(kinds) if cells is None else cells
        if not isinstance(cells, list) or len(cells) != len(kinds):
            raise TableError(f"{key}: expected {len(kinds)} numbers, got {found(cells)}")
        out.append(
            [
                none if cell is None else number(cell, f"{key}[{i}]", kind)
                for i, (cell, kind) in enumerate(zip(cells, kinds, strict=True), 1)
            ]
        )
    return np.array(out[0]), np.array(out[1])


def limits_of(chain: SerialChain) -> dict[str, list[float | None]]:
    """Bounds as a file has them; none at all where no joint has any."""
    out = {
        key: [v if math.isfinite(v) else None for v in getattr(chain, key).tolist()]
        for key in ("lower", "upper")
    }
    return {key: cells for key, cells in out.items() if any(v is not None for v in cells)}


def step(cell: object, what: str) -> Array:
    """A rigid step of ``xyz`` and ``rpy``, shape (4, 4)."""
    given = mapping(cell, what, ("xyz", "rpy"))
    xyz = numbers(given.get("xyz", [0, 0, 0]), f"{what}.xyz", Kind.LENGTH, 3)
    return tf.origin_matrix(xyz, numbers(given.get("rpy", [0, 0, 0]), f"{what}.rpy", Kind.ANGLE, 3))


def step_of(T: Array, size: float) -> dict[str, list[float]]:
    """A rigid step of an arm of some size [m] as a file has it."""
    origin = tidy_origin(T, size)
    return {"xyz": list(origin.xyz), "rpy": list(origin.rpy)}


def form_text(content: Mapping[str, Any], head: str, format: str) -> str:
    """A form as YAML, a line a value, or as JSON."""
    if format == "json":
        return json.dumps(content, indent=2, ensure_ascii=False) + "\n"
    lines = [*(f"# {line}" for line in head.splitlines()), "# extracted by dh2urdf"]
    for key, value in content.items():
        if isinstance(value, dict) and len(value) > 2:
            lines += [f"{key}:", *(f"  {k}: {_flow(v)}" for k, v in value.items())]
        elif isinstance(value, list) and value and isinstance(value[0], (dict, list)):
            lines += [f"{key}:", *(f"  - {_flow(entry)}" for entry in value)]
        else:
            lines.append(f"{key}: {_flow(value)}")
    return "\n".join(lines) + "\n"


def _flow(value: object) -> str:
    """A value in one line, as JSON, which YAML reads."""
    return json.dumps(value, ensure_ascii=False)
