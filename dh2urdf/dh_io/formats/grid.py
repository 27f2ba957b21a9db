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
from dataclasses import replace

from dh2urdf.dh import DHConvention
from dh2urdf.dh_io.cells.document import Items, Keys, Mark, Node, Report, Scalar
from dh2urdf.dh_io.cells.schema import CONVENTIONS, TABLE_KEYS, canonical, nearest, of_previous_link
from dh2urdf.dh_io.cells.units import Kind, unit_kind, unit_name
from dh2urdf.dh_io.formats.columns import columns_of
from dh2urdf.dh_io.formats.heading import EMPTY, PARAMETERS, heading, limits
from dh2urdf.dh_io.formats.layout import Grid, Line

_META = re.compile(r"[\s#>*+`-]*([\w.]+)[*`]*\s*[:=]\s*[*`]*\s*(\S.*?)\s*$")
_TOOLBOX = re.compile(r"(?:DHRobot:|.*::|\S+: \d+ joints?,).*\b(standard |modified |std|mod)DH\b")
"""What robotics toolboxes, and this package, print above a table."""

_STEP = re.compile(r"\D*(?:0(?:\.0*)?\D+)*")
_GROUPS = ("units", "base", "tool", "constants")
_VARIABLE = re.compile(r"[^\W\d]")


def metadata(line: str, number: int, report: Report) -> tuple[Scalar, Scalar] | None:
    """Key and value of a line, None where it is prose."""
    if title := _TOOLBOX.match(line):
        mark = Mark(number, title.start(1) + 1)
        word = "standard" if title[1].startswith("st") else "modified"
        return Scalar("convention", mark), Scalar(word, mark)
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
    if name in ("base", "tool") and not rest:
        if not _STEP.fullmatch(f"{value} "):
            hint = f"write {name}.xyz: 0 0 0.1 and {name}.rpy: 0 0 90, each in a line of its own"
            report.fault(mark, name, f"found {value!r:.60}", hint)
        return None
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


def grid_document(grid: Grid, report: Report) -> Keys:
    """Document of a grid: the keys of the table, then one mapping a row."""
    columns = columns_of(grid.header, grid.rows, report)
    rows: list[Node] = []
    for cells in grid.rows:
        mark = Mark(cells[0].mark.line, 1)
        if len(cells) != len(grid.header):
            message = f"found {len(cells)} cells; the header has {len(grid.header)}"
            more = "a decimal comma? numbers take a point"
            more = "where cells hold spaces, part them by tabs" if report.format == "text" else more
            hint = more if len(cells) > len(grid.header) else ""
            report.fault(mark, f"joints[{len(rows) + 1}]", message, hint)
            rows.append(Keys(tuple((Scalar(k), Scalar("0")) for k in PARAMETERS), mark))
        else:
            rows.append(Keys(tuple(_pairs(columns, grid.header, cells)), mark))
    top = grid.header[0].mark
    pairs = [*_table_keys(grid, columns, report), (Scalar("joints", top), Items(tuple(rows)))]
    return Keys(tuple(pairs), top)


def _pairs(columns: list[tuple[str, str]], header: Line, cells: Line) -> list[tuple[Scalar, Node]]:
    """Keys and cells of a row; a parameter without a column is 0, a fault already."""
    pairs: list[tuple[Scalar, Node]] = []
    given: dict[str, str] = {}
    for (key, unit), head, cell in zip(columns, header, cells, strict=True):
        text = "" if cell.text in EMPTY else cell.text
        if key == "name" and text.startswith('"'):
            with contextlib.suppress(ValueError):
                text = str(json.loads(text))
        given[key] = text
        if key == "limits":
            ends = zip(("lower", "upper"), limits(text), strict=False)
            pairs += [(Scalar(k, head.mark), Scalar(v, cell.mark, unit)) for k, v in ends]
        elif key not in ("", "offset"):
            pairs.append((Scalar(key, head.mark), Scalar(text, cell.mark, unit)))
    if given.get("offset", "0") not in ("", "0"):
        pairs = [_with_offset(key, cell, given) for key, cell in pairs]
    if not any(given.get(key) for key in ("xyz", "rpy")):
        pairs += [(Scalar(k), Scalar("0")) for k in PARAMETERS if k not in given]
    return pairs


def _with_offset(key: Scalar, cell: Node, given: dict[str, str]) -> tuple[Scalar, Node]:
    """A cell, the joint's offset added to the one that holds the variable."""
    moving = "d" if _VARIABLE.match(given["d"].lstrip("+-− ")) else "theta"
    if key.text == moving and isinstance(cell, Scalar):
        cell = replace(cell, text=f"{cell.text or 0} + ({given['offset']})")
    return key, cell


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
        heads = zip(columns, grid.header, strict=True)
        measured = ((u, head) for (_, u), head in heads if u and unit_kind(u) is kind)
        unit, head = next(measured, ("", Scalar("")))
        given = groups.get("units", [])
        stated = any(k.text == kind.value for k, _ in given)
        if unit and not stated and not any(k.text == "units" for k, _ in out):
            groups.setdefault("units", []).append(
                (Scalar(kind.value, head.mark), Scalar(unit, head.mark))
            )
    for group, pairs in groups.items():
        out.append((Scalar(group, pairs[0][0].mark), Keys(tuple(pairs), pairs[0][0].mark)))
    return out + _modified_header(grid, report)


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


def _modified_header(grid: Grid, report: Report) -> list[tuple[Scalar, Node]]:
    """The convention where only columns such as ``a_{i-1}`` tell it; a fault against another."""
    stated = [v.text.strip().casefold() for k, v in grid.meta if k.text == "convention"]
    heads = [c for c in grid.header if of_previous_link(heading(c.text)[0])]
    for cell in heads if DHConvention.STANDARD in map(CONVENTIONS.get, stated) else ():
        message = f"{cell.text} is a modified table's column, but convention says standard"
        hint = "write convention: modified, or the columns a and alpha"
        report.fault(cell.mark, "header", message, hint)
    if stated or not heads:
        return []
    message = f"{heads[0].text} heads a column of modified tables (Craig); read as one"
    report.warn(heads[0].mark, "header", message)
    return [(Scalar("convention", heads[0].mark), Scalar("modified", heads[0].mark))]
