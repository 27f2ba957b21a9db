"""Where in a page the table stands: its header, its rows, and the keys in the lines around it."""

import re
from collections.abc import Sequence
from dataclasses import replace
from itertools import zip_longest
from typing import NamedTuple

from dh2urdf.dh_io.cells.document import Report, Scalar
from dh2urdf.dh_io.cells.schema import TABLE_KEYS, canonical
from dh2urdf.dh_io.formats.heading import EMPTY, column, is_header, unit_alone

Line = list[Scalar]

_COMMA = re.compile(r"(?<![\d,.])(\d*),(\d+)(?![\d,.])")
_THOUSANDS = re.compile(r"[-+−–]?[1-9]\d{0,2},\d{3}")
_POINT = re.compile(r"\d\.\d|(?<!\w)\.\d")


class Grid(NamedTuple):
    """The parts of a file: lines of keys, the header and the rows."""

    meta: list[tuple[Scalar, Scalar]]
    header: Line
    rows: list[Line]


def find_table(
    blocks: Sequence[list[Line]], meta: list[tuple[Scalar, Scalar]], report: Report
) -> Grid | None:
    """The one DH table among blocks of lines; None where no line names its columns."""
    found: Grid | None = None
    for lines in blocks:
        block, at = lines, _header_of(lines)
        if at is None:
            block = [list(line) for line in zip_longest(*lines, fillvalue=Scalar(""))]
            at = _header_of(block)
            if at is None or at > 0:
                continue
        if found is not None:
            report.stop(block[at][0].mark, "a second DH table; a file holds one")
        names = [cell.text for cell in block[at]]
        if any([cell.text for cell in line] == names for line in block[at + 1 :]):
            report.stop(block[-1][0].mark, "a second DH table; a file holds one")
        above = [entry for line in block[:at] if (entry := _keys_in_cells(line))]
        found = Grid([*meta, *above], *_trimmed(block[at], block[at + 1 :]))
    if found is not None:
        _decimal_points(found.rows, report)
    return found


def _header_of(block: list[Line]) -> int | None:
    return next((k for k, line in enumerate(block) if is_header(line)), None)


def _keys_in_cells(line: Line) -> tuple[Scalar, Scalar] | None:
    """``Convention;standard`` and ``Units;mm;deg`` above the header of a spreadsheet."""
    key = canonical(line[0].text.rstrip(": "))
    words = [cell for cell in line[1:] if cell.text]
    if key not in TABLE_KEYS or key == "joints" or not words:
        return None
    text = ", ".join(cell.text for cell in words)
    return Scalar(key, line[0].mark), replace(words[0], text=text)


def _trimmed(header: Line, rows: list[Line]) -> tuple[Line, list[Line]]:
    """Without empty columns at the end and empty rows, units of a second row in the header."""
    lines = [header, *(line[: len(header)] for line in rows)]
    width = max(k for line in lines for k, cell in enumerate(line, 1) if cell.text)
    rows = [
        line if any(cell.text for cell in line[width:]) else line[:width]
        for line in rows
        if len(line) == 1 or any(cell.text for cell in line)
    ]
    header, first = header[:width], rows[0] if rows else []
    units = [unit_alone(cell.text) for cell in first]
    if any(units) and all(u or c.text in EMPTY for u, c in zip(units, first, strict=True)):
        header = [_with_unit(*pair) for pair in zip(header, units, strict=False)] + header[
            len(units) :
        ]
        rows = rows[1:]
    return header, rows


def _with_unit(cell: Scalar, unit: str) -> Scalar:
    return replace(cell, text=f"{cell.text} [{unit}]") if unit and not column(cell)[1] else cell


def _decimal_points(rows: list[Line], report: Report) -> None:
    """Points for decimal commas, where no number has a point and not all may be thousands."""
    texts = [cell.text for line in rows for cell in line]
    commas = [text for text in texts if _COMMA.search(text)]
    if any(map(_POINT.search, texts)) or all(map(_THOUSANDS.fullmatch, commas)):
        return
    for line in rows:
        for k, cell in enumerate(line):
            plain = _COMMA.sub(r"\1.\2", cell.text)
            if plain != cell.text and not re.search(r"[\[(]", plain):
                line[k] = replace(cell, text=plain)
