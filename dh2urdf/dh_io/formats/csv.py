"""Comma, semicolon or tab separated values to a document."""

import csv

from dh2urdf.dh_io.cells.document import Keys, Mark, Report, Scalar
from dh2urdf.dh_io.formats.grid import Grid, grid_document, is_header, metadata, separator


def read_csv(text: str, report: Report) -> Keys:
    """Read a CSV file: ``# key: value`` lines, a header row, one line a row."""
    grid = Grid([], [], [])
    delimiter = ""
    for number, line in enumerate(text.split("\n"), 1):
        if not line.strip():
            continue
        # #,theta,d,a,alpha is a header, not a comment
        heads = not delimiter and line.lstrip().startswith(("#,", "#;", "#\t"))
        if line.lstrip().startswith("#") and not heads:
            if entry := metadata(line, number, report):
                grid.meta.append(entry)
            continue
        delimiter = delimiter or separator(line)
        cells = _cells(line, number, delimiter, report)
        report.count(Mark(number, 1), cells=len(cells))
        if grid.header:
            grid.rows.append(cells)
        elif is_header(cells):
            grid.header.extend(cells)
        else:
            hint = "the first row names the columns, in any order: name,type,theta,d,a,alpha"
            report.stop(Mark(number, 1), "no header row with theta, d, a and alpha", hint)
    return grid_document(grid, report)


def _cells(line: str, number: int, delimiter: str, report: Report) -> list[Scalar]:
    """Cells of one line, each with the column where its text begins."""
    reader = csv.reader([line], delimiter=delimiter, skipinitialspace=True, strict=True)
    try:
        texts = next(reader)
    except csv.Error as error:
        report.fault(Mark(number, 1), "", f"not CSV: {error}", "a quote that does not end?")
        texts = line.split(delimiter)
    out, at = [], 0
    for text in texts:
        start = max(line.find(text.strip()[:1], at), at) if text.strip() else at
        out.append(Scalar(text.strip(), Mark(number, start + 1)))
        at = min(start + len(text.strip()) + 1, len(line))
    return out
