"""Comma, semicolon, tab or space separated values to a document."""

import csv
import re

from dh2urdf.dh_io.cells.document import Keys, Mark, Report, Scalar
from dh2urdf.dh_io.formats.grid import grid_document, metadata
from dh2urdf.dh_io.formats.heading import is_header
from dh2urdf.dh_io.formats.layout import Grid, Line, find_table

SPACES = ("  ", " ")
"""Cells parted by two spaces or more, or by one where that is all there is."""

_RULE = re.compile(r"[\s\u2500-\u257f]*(?:[\u2500-\u257f]|--|==)[\s=\-\u2500-\u257f]*")
_JOINED = re.compile(
    r"\b((?:link|joint|axis|frame)|\d)[ ]+(?=(?:[ijn#]|no\.?|deg|rad|mm|cm|m|°)(?:\s|$))"
    r"|[ ]+(?=[(\[][^)\]]*[)\]])|[ ]*([+*/])[ ]*|(?<=\w)[ ]+([-−–])[ ]+(?=\w)",
    re.IGNORECASE,
)


def read_csv(text: str, report: Report) -> Keys:
    """Read a CSV file: ``# key: value`` lines, a header row, one line a row."""
    meta, lines = list[tuple[Scalar, Scalar]](), list[tuple[int, str]]()
    for number, line in enumerate(text.split("\n"), 1):
        # #,theta,d,a,alpha is a header, not a comment
        heads = not lines and line.lstrip().startswith(("#,", "#;", "#\t"))
        if line.lstrip().startswith("#") and not heads:
            if entry := metadata(line, number, report):
                meta.append(entry)
        elif line.strip() and not _RULE.fullmatch(line):
            lines.append((number, line))
    return grid_document(_table(lines, meta, report), report)


def _table(lines: list[tuple[int, str]], meta: list[tuple[Scalar, Scalar]], report: Report) -> Grid:
    """The table, its cells parted by the first sign with which a line is a header."""
    for delimiter in (";", "\t", ",", *SPACES):
        quiet = Report(report.filename)
        block = _split(lines, delimiter, quiet)
        columns = [[line[0] for line in block]]
        if not any(map(is_header, [*block, *columns])):
            continue
        if delimiter == "  " and _is_uneven(block) and not _is_uneven(_split(lines, " ", quiet)):
            continue
        block = _split(lines, delimiter, report)
        block = _paragraph(block) if delimiter in SPACES else block
        for line in block:
            report.count(line[0].mark, cells=len(line))
        above = lines if delimiter in SPACES else []
        if grid := find_table([block], [*meta, *_prose(above, report)], report):
            return grid
    example = "name,type,theta,d,a,alpha" if report.format == "csv" else "theta d a alpha"
    hint = f"the first row names the columns, in any order: {example}"
    report.stop(
        Mark(lines[0][0], 1) if lines else Mark(), "no header row with theta, d, a and alpha", hint
    )


def _split(lines: list[tuple[int, str]], delimiter: str, report: Report) -> list[Line]:
    """Each line's cells."""
    return [_cells(line, number, delimiter, report) for number, line in lines]


def _is_uneven(block: list[Line]) -> bool:
    """Whether a line of the table has more or fewer cells than its header."""
    block = _paragraph(block)
    top = next((k for k, line in enumerate(block) if is_header(line)), len(block))
    return any(len(line) != len(block[top]) for line in block[top:]) if block[top:] else True


def _paragraph(block: list[Line]) -> list[Line]:
    """The lines up to the first empty one below a row of the table."""
    top = next((k for k, line in enumerate(block) if is_header(line)), 0)
    for k in range(top + 2, len(block)):
        if block[k][0].mark.line > block[k - 1][0].mark.line + 1:
            return block[:k]
    return block


def _prose(lines: list[tuple[int, str]], report: Report) -> list[tuple[Scalar, Scalar]]:
    """Keys in the lines of a text."""
    return [entry for number, line in lines if (entry := metadata(line, number, report))]


def _cells(line: str, number: int, delimiter: str, report: Report) -> Line:
    """Cells of one line, each with the column where its text begins."""
    if delimiter == "  ":
        return _placed(re.split(r"\s{2,}", line.strip()), line, number)
    if delimiter == " ":
        return _spaced(line, number)
    reader = csv.reader([line], delimiter=delimiter, skipinitialspace=True, strict=True)
    try:
        texts = next(reader)
    except csv.Error as error:
        report.fault(Mark(number, 1), "", f"not CSV: {error}", "a quote that does not end?")
        texts = line.split(delimiter)
    return _placed(texts, line, number)


def _spaced(line: str, number: int) -> Line:
    """Cells parted by spaces; ``theta (deg)``, ``Link i`` and ``q1 + 90`` stay together."""
    joined = _JOINED.sub(lambda m: f"{m[1] or ''}{m[2] or ''}{m[3] or ''}", line)
    return _placed(joined.split(), line, number)


def _placed(texts: list[str], line: str, number: int) -> Line:
    """Cells with the column where the text of each begins."""
    out, at = [], 0
    for text in map(str.strip, texts):
        start = max(line.find(text[:1], at), at) if text else at
        out.append(Scalar(text, Mark(number, start + 1)))
        at = min(start + len(text) + 1, len(line))
    return out
