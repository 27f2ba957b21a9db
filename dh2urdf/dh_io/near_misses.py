"""What is allowed in a table and probably not meant; told, never changed."""

import itertools
import math
import re
from collections.abc import Iterator, Mapping
from decimal import Decimal
from fractions import Fraction
from typing import NamedTuple

import numpy as np

from dh2urdf.dh import DHConvention, DHRow, DHTable, JointType
from dh2urdf.dh_io.cells.schema import ROW_KINDS
from dh2urdf.dh_io.cells.units import PI, SI, Kind, Units
from dh2urdf.dh_io.odd_couplings import odd_couplings

LONG = 10.0
"""A length [m] that few arms have; millimetres read as metres come out beyond it."""

SHORT = 0.003
"""Where no length [m] of a file in mm or cm exceeds this, its numbers are probably metres."""

FULL_TURN = 2 * math.pi + 1e-9
WIDE_LIMIT = 4 * math.pi + 0.1
"""Limits [rad]: wrists that turn twice either way exist, more is probably degrees."""

TRIANGLE_SLACK = 1e-3
"""Relative, for published tensors of three or four digits."""

_LITERAL = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")


class NearMiss(NamedTuple):
    """Path of a cell, ``joints[3].alpha``, and what looks odd about it."""

    path: str
    message: str


def near_misses(
    table: DHTable, units: Units = SI, texts: Mapping[str, str] | None = None
) -> tuple[NearMiss, ...]:
    """Cells of a table that are probably not meant as they stand.

    Rounded multiples of pi, lengths over 10 m or all below 3 mm, angles over a turn, tensors of no
    body, joints on one axis, couplings of nothing. ``units`` are those of the file and ``texts``
    its cells by their paths; where these are not given, the table's floats in [m] and [rad].
    """
    known = texts is not None
    cells = {
        path: (value, kind, texts.get(path, "") if texts is not None else repr(value))
        for path, value, kind in _cells(table)
    }
    out: list[NearMiss] = []
    for path, (value, kind, text) in cells.items():
        is_limit = path.endswith((".lower", ".upper"))
        if kind is Kind.ANGLE and _LITERAL.fullmatch(text):
            out += _angle(path, Decimal(text), value, units.angle if known else "rad", is_limit)
    lengths = {p: (v, t) for p, (v, k, t) in cells.items() if k is Kind.LENGTH}
    out += _lengths(lengths, units if known else SI)
    for number, row in enumerate(table.rows, 1):
        out += _tensor(f"joints[{number}].inertia", row)
    out += _same_axis(table)
    out += itertools.starmap(NearMiss, odd_couplings(table))
    return tuple(out)


def _cells(table: DHTable) -> Iterator[tuple[str, float, Kind]]:
    """Path, value and kind of all lengths and angles."""
    origins = [("base", table.base), ("tool", table.tool)]
    for number, row in enumerate(table.rows, 1):
        path = f"joints[{number}]"
        if row.origin is not None:
            origins.append((path, row.origin))
            continue
        moved = Kind.LENGTH if row.joint_type is JointType.PRISMATIC else Kind.ANGLE
        for key in ("theta", "d", "a", "alpha", "lower", "upper"):
            if (value := getattr(row, key)) is not None:
                yield f"{path}.{key}", value, ROW_KINDS.get(key, moved)
        for i, value in enumerate(row.com or (), 1):
            yield f"{path}.com[{i}]", value, Kind.LENGTH
    for path, origin in origins:
        for i in range(3):
            yield f"{path}.xyz[{i + 1}]", origin.xyz[i], Kind.LENGTH
            yield f"{path}.rpy[{i + 1}]", origin.rpy[i], Kind.ANGLE


def _angle(path: str, typed: Decimal, value: float, unit: str, is_limit: bool) -> list[NearMiss]:
    """A rounded multiple of pi, degrees in a file in radians, radians in one in degrees."""
    meant = rounded_pi(typed)
    if unit == "deg":
        if meant is None or meant.denominator > 2 or _decimals(typed) < 2 or is_limit:
            return []
        return [NearMiss(path, f"{typed} deg is {_pi_text(meant)} in radians; radians meant?")]
    over = abs(value) > (WIDE_LIMIT if is_limit else FULL_TURN)
    if over and (meant is None or abs(meant) > 2):
        turns = "two turns" if is_limit else "a full turn"
        return [NearMiss(path, f"{typed} rad is more than {turns}; degrees meant?")]
    if meant is None or is_limit:
        return []
    off = abs(value - float(meant.numerator * PI / meant.denominator))
    exact = _pi_text(meant)
    return [NearMiss(path, f"{typed} is {exact} rounded, off by {off:.1e} rad; write {exact}")]


def rounded_pi(typed: Decimal) -> Fraction | None:
    """Multiple of pi that a decimal is a rounding (or a cut) of, None where it is none.

    Two decimals count as multiples of pi/2, three of pi/4, four to twelve of pi/12, so that
    a number that is near one by chance is seldom taken for it.
    """
    decimals = _decimals(typed)
    if not 2 <= decimals <= 12 or typed == 0:
        return None
    parts = {2: 2, 3: 4}.get(decimals, 12)
    multiple = Fraction(round(typed * parts / PI), parts)
    exact = multiple.numerator * PI / multiple.denominator
    cut_off = (abs(exact) - abs(typed)).scaleb(decimals)
    return multiple if multiple and Decimal("-0.5") <= cut_off < 1 else None


def _decimals(typed: Decimal) -> int:
    exponent = typed.as_tuple().exponent
    return -exponent if isinstance(exponent, int) else 0


def _pi_text(multiple: Fraction) -> str:
    sign = "-" if multiple < 0 else ""
    count = "" if abs(multiple.numerator) == 1 else f"{abs(multiple.numerator)}*"
    return f"{sign}{count}pi" + (f"/{multiple.denominator}" if multiple.denominator > 1 else "")


def _lengths(lengths: dict[str, tuple[float, str]], units: Units) -> list[NearMiss]:
    long = [path for path, (value, _) in lengths.items() if abs(value) > LONG]
    if long:
        value, more = lengths[long[0]][0], f" (and {len(long) - 1} more)" if long[1:] else ""
        hint = "millimetres" if units.length == "m" else f"really {units.length}"
        return [NearMiss(long[0], f"{value:g} m is longer than {LONG:g} m{more}; {hint}?")]
    given = {path: abs(value) for path, (value, _) in lengths.items() if value}
    if units.length in ("mm", "cm") and given and max(given.values()) < SHORT:
        path = next(iter(given))
        text = f"no length exceeds {max(given.values()) * 1000:g} mm; metres meant?"
        return [NearMiss(path, text)]
    return []


def _tensor(path: str, row: DHRow) -> list[NearMiss]:
    """A tensor that no body has: a principal moment above the sum of the two others."""
    if row.inertia is None or _is_physical(row.inertia):
        return []
    ixx, iyy, izz, ixy, ixz, iyz = row.inertia
    hint = ""
    if _is_physical((ixx, ixy, ixz, iyy, iyz, izz)):
        hint = "; it would be one in the order ixx, iyy, izz, ixy, ixz, iyz"
    text = "no body has this tensor: a principal moment exceeds the sum of the two others"
    return [NearMiss(path, f"{text} (order ixx, ixy, ixz, iyy, iyz, izz, in kg m^2){hint}")]


def _is_physical(inertia: tuple[float, ...]) -> bool:
    """Triangle inequality of the principal moments, which implies that none is negative."""
    ixx, ixy, ixz, iyy, iyz, izz = inertia
    low, middle, high = np.linalg.eigvalsh([[ixx, ixy, ixz], [ixy, iyy, iyz], [ixz, iyz, izz]])
    return bool(high - low - middle <= TRIANGLE_SLACK * abs(high))


def _same_axis(table: DHTable) -> list[NearMiss]:
    """Rows that leave two joints of one type on the same axis, all their parameters being zero."""
    standard = table.convention is DHConvention.STANDARD
    out = []
    pairs = zip(table.rows, table.rows[1:], strict=False)
    for number, (first, second) in enumerate(pairs, 1):
        row = first if standard else second
        alike = first.joint_type is second.joint_type and first.is_joint
        alike = alike and not (first.mimic or second.mimic)
        if alike and not any((row.theta, row.d, row.a, row.alpha)):
            path = f"joints[{number if standard else number + 1}]"
            text = f"all zero: the joints of rows {number} and {number + 1} move on one axis"
            out.append(NearMiss(path, text))
    return out
