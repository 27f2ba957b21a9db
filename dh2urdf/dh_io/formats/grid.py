"""What CSV and Markdown share: a header row, rows of cells, and ``key: value`` lines around them.

The header's order is free and its columns may carry units, ``d [mm]``, ``alpha (deg)`` or
``theta_deg``. Keys of the table itself stand in lines of their own, in CSV behind a ``#``::

    convention: standard
    units: mm, deg
    base.xyz: 0 0 0.1
    constants.l2: 400
"""

import contextlib
import json
import re
from typing import NamedTuple

from dh2urdf.dh import DHConvention
from dh2urdf.dh_io.cells.cells import found
from dh2urdf.dh_io.cells.document import Items, Keys, Mark, Node, Report, Scalar
from dh2urdf.dh_io.cells.schema import (
    CONVENTIONS,
    MISUSED_KEYS,
    ROW_KEYS,
    ROW_KINDS,
    TABLE_KEYS,
    canonical,
    nearest,
    of_previous_link,
)
from dh2urdf.dh_io.cells.units import UNIT_SIZES, Kind, unit_kind, unit_name

_META = re.compile(r"[\s#>*+`-]*([\w.]+)[*`]*\s*[:=]\s*[*`]*\s*(\S.*?)\s*$")
_GROUPS = ("units", "base", "tool", "constants")
_PARAMETERS = ("theta", "d", "a", "alpha")
INDEX = ("", "i", "#", "no", "no.", "nr", "n", "row", "index")
_LABELS = ("joint", "link", "frame")
_EMPTY = ("", "-", "–", "—", "−", "n/a")
_UNIT = re.compile(
    r"(.+?)\s*(?:\[(.*)\]|\((.*)\)|(?:/\s*|(?=[°º]))([a-zA-Z°º]+))$|(.+)_(mm|cm|m|deg|rad)$"
)
_INDEX_I = re.compile(r"i\s*(?:[-−]\s*1)?")
_SI_UNITS = {
    "mass": ("kg",),
    "inertia": ("kgm2", "kgm^2", "kgm²"),
    "effort": ("n", "nm", "n,nm", "nmorn"),
    "damping": ("nms/rad", "ns/m"),
    "friction": ("n", "nm"),
}


class Grid(NamedTuple):
    """The parts of a file: lines of keys, the header and the rows."""

    meta: list[tuple[Scalar, Scalar]]
    header: list[Scalar]
    rows: list[list[Scalar]]


def metadata(line: str, number: int, report: Report) -> tuple[Scalar, Scalar] | None:
    """Key and value of a line, None where it is prose."""
    match = _META.match(line)
    if match is None:
        return None
    key = {"length": "units.length", "angle": "units.angle"}.get(match[1].casefold(), match[1])
    group, _, rest = key.partition(".")
    name = canonical(group)
    mark = Mark(number, match.start(1) + 1)
    if name not in TABLE_KEYS or name == "joints":
        if near := nearest(name, ("convention", "units", "source", "checked")):
            report.warn(mark, key, f"this line is not read; did you mean {near}?")
        return None
    value = match[2]
    if value.startswith('"'):
        try:
            value = json.loads(value)
        except ValueError:
            report.fault(mark, key, "the text in double quotes does not end")
    return Scalar(f"{name}.{rest}" if rest else name, mark), Scalar(
        str(value), Mark(number, match.start(2) + 1)
    )


def separator(line: str) -> str:
    """What parts the cells of a CSV file, by its first line: comma, semicolon or tab."""
    return max(",;\t", key=line.count)


def is_header(cells: list[Scalar]) -> bool:
    """Tell whether a row names at least two of theta, d, a and alpha, or an ambiguous column."""
    return len({_column(cell)[0] for cell in cells} & {*_PARAMETERS, "r"}) >= 2


def grid_document(grid: Grid, report: Report) -> Keys:
    """Document of a grid: the keys of the table, then one mapping a row."""
    columns = _columns(grid, report)
    rows: list[Node] = []
    for cells in grid.rows:
        mark = Mark(cells[0].mark.line, 1)
        if len(cells) != len(grid.header):
            message = f"found {len(cells)} cells; the header has {len(grid.header)}"
            hint = "a decimal comma? numbers take a point" if len(cells) > len(grid.header) else ""
            report.fault(mark, f"joints[{len(rows) + 1}]", message, hint)
            rows.append(Keys(tuple((Scalar(k), Scalar("0")) for k in _PARAMETERS), mark))
            continue
        pairs: list[tuple[Scalar, Node]] = []
        for (key, unit), head, cell in zip(columns, grid.header, cells, strict=True):
            text = "" if cell.text in _EMPTY else cell.text
            if key == "name" and text.startswith('"'):
                with contextlib.suppress(ValueError):
                    text = str(json.loads(text))
            if key:
                pairs.append((Scalar(key, head.mark), Scalar(text, cell.mark, unit)))
        present = {key for key, _ in columns}
        fixed = {"xyz", "rpy"} & {k.text for k, c in pairs if isinstance(c, Scalar) and c.text}
        if not fixed:
            pairs += [(Scalar(k), Scalar("0")) for k in _PARAMETERS if k not in present]
        rows.append(Keys(tuple(pairs), mark))
    joints = Scalar("joints", grid.header[0].mark if grid.header else Mark())
    pairs = [*_table_keys(grid, columns, report), (joints, Items(tuple(rows)))]
    return Keys(tuple(pairs), Mark(1, 1))


def heading(text: str) -> tuple[str, str]:
    """Name and unit of a column: ``d [mm]``, ``alpha (deg)``, ``theta_deg``, ``yaw °``."""
    text = text.strip(" *`")
    match = _UNIT.fullmatch(text)
    if match is None:
        return text, ""
    stem, unit = (match[1], match[2] or match[3] or match[4]) if match[1] else (match[5], match[6])
    if not unit or _INDEX_I.fullmatch(unit.strip()):
        return text, ""
    return stem, unit_name(unit.replace("/s", ""))


def _column(cell: Scalar) -> tuple[str, str]:
    """Canonical key and unit of a header cell."""
    name, unit = heading(cell.text)
    return canonical(name), unit


def _columns(grid: Grid, report: Report) -> list[tuple[str, str]]:
    """Key and unit of each column; an empty key for a column that is not read."""
    out: list[tuple[str, str]] = []
    for number, cell in enumerate(grid.header):
        key, unit = _column(cell)
        taken = [k for k, _ in out]
        if key in INDEX:
            out.append(("", ""))
        elif key in _LABELS:
            texts = [row[number].text for row in grid.rows if number < len(row)]
            counting = all(t.isdigit() or not t for t in texts)
            out.append(("" if counting or "name" in taken else "name", ""))
        elif key not in ROW_KEYS:
            near = nearest(key, ROW_KEYS)
            hint = MISUSED_KEYS.get(key) or (f"did you mean {near}?" if near else "")
            message = f"unknown column {found(cell)}; allowed: {', '.join(ROW_KEYS)}"
            report.fault(cell.mark, "header", message, hint)
            out.append((near if near not in taken and key not in MISUSED_KEYS else "", ""))
        elif key in taken:
            report.fault(cell.mark, "header", f"a second column for {key}: {found(cell)}")
            out.append(("", ""))
        else:
            out.append((key, _checked_unit(cell, key, unit, report)))
    _refuse_nameless(grid, report)
    present = {k for k, _ in out}
    unclear = any(_column(cell)[0] in MISUSED_KEYS for cell in grid.header)
    missing = [k for k in _PARAMETERS if k not in present]
    if missing and not unclear:
        mark = grid.header[0].mark if grid.header else Mark()
        report.fault(mark, "header", f"no column for {', '.join(missing)}")
    return out


def _refuse_nameless(grid: Grid, report: Report) -> None:
    """Only the first column, which then counts the rows, may hold values and have no name."""
    nameless = [k for k, cell in enumerate(grid.header) if not _column(cell)[0]]
    filled = [k for k in nameless if any(k < len(r) and r[k].text not in _EMPTY for r in grid.rows)]
    if filled not in ([], [0]):
        mark = grid.header[filled[-1]].mark
        report.fault(mark, "header", without_name(filled), f"allowed: {', '.join(ROW_KEYS)}")


def without_name(columns: list[int]) -> str:
    """Fault of columns, counted from 0, that hold values and have no name."""
    many = len(columns) > 1
    numbers = " and ".join(str(k + 1) for k in columns)
    return f"column{'s' * many} {numbers} {'have' if many else 'has'} values but no name"


def _checked_unit(cell: Scalar, key: str, unit: str, report: Report) -> str:
    """Unit of a column, empty where it is none or does not belong there."""
    if not unit:
        return ""
    plain = re.sub(r"[\s*·]", "", unit)
    if plain in _SI_UNITS.get(key, ()) or unit in ("1", "-"):
        return ""
    either = key in ("lower", "upper", "velocity")
    kinds = (Kind.ANGLE, Kind.LENGTH) if either else (ROW_KINDS.get(key, Kind.NUMBER),)
    if unit_kind(unit) in kinds:
        return unit
    allowed = [u for kind in kinds for u in UNIT_SIZES[kind]] or list(_SI_UNITS.get(key, ("none",)))
    message = f"found unit {unit!r} for {key}; allowed: {', '.join(allowed)}"
    report.fault(cell.mark, "header", message)
    return ""


def _table_keys(
    grid: Grid, columns: list[tuple[str, str]], report: Report
) -> list[tuple[Scalar, Node]]:
    """Pairs of the table's own keys, dotted ones gathered."""
    out: list[tuple[Scalar, Node]] = []
    groups: dict[str, list[tuple[Scalar, Node]]] = {}
    for key, value in grid.meta:
        group, _, rest = key.text.partition(".")
        if rest and group in _GROUPS:
            groups.setdefault(group, []).append((Scalar(rest, key.mark), value))
        elif group == "units" and (parts := unit_words(value)):
            groups.setdefault(group, []).extend(parts)
        else:
            out.append((key, value))
    for kind in (Kind.LENGTH, Kind.ANGLE):
        unit = next((u for _, u in columns if u and unit_kind(u) is kind), "")
        given = groups.get("units", [])
        stated = any(k.text == kind.value for k, _ in given)
        if unit and not stated and not any(k.text == "units" for k, _ in out):
            groups.setdefault("units", []).append((Scalar(kind.value), Scalar(unit)))
    for group, pairs in groups.items():
        out.append((Scalar(group, pairs[0][0].mark), Keys(tuple(pairs), pairs[0][0].mark)))
    _refuse_modified_header(grid, report)
    return out


def unit_words(value: Scalar) -> list[tuple[Scalar, Node]]:
    """``mm, deg`` or ``{length: mm, angle: deg}`` as pairs; none where a word is not a unit."""
    words = [unit_name(w) for w in re.findall(r"[^\s,;:{}&]+", value.text)]
    pairs: list[tuple[Scalar, Node]] = []
    for word in words:
        kind = unit_kind(word)
        if kind is not None:
            pairs.append((Scalar(kind.value, value.mark), Scalar(word, value.mark)))
        elif word not in ("length", "angle", "and", "lengths", "angles", "in"):
            return []
    return pairs


def _refuse_modified_header(grid: Grid, report: Report) -> None:
    stated = {CONVENTIONS.get(v.text.casefold()) for k, v in grid.meta if k.text == "convention"}
    for cell in grid.header:
        if of_previous_link(heading(cell.text)[0]) and DHConvention.STANDARD in stated:
            message = f"{cell.text} is a modified table's column, but convention says standard"
            hint = "write convention: modified, or the columns a and alpha"
            report.fault(cell.mark, "header", message, hint)
