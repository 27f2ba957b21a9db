"""The DH table of a Markdown page or of a text drawn with bars to a document."""

import re
from itertools import pairwise

from dh2urdf.dh_io.cells.document import Keys, Mark, Report, Scalar
from dh2urdf.dh_io.formats.csv import read_csv
from dh2urdf.dh_io.formats.grid import grid_document, metadata
from dh2urdf.dh_io.formats.layout import Line, find_table

_RULE = re.compile(r"[\s|:+=\-\u2500-\u257f]*(?:--|==|[\u2500-\u257f])[\s|:+=\-\u2500-\u257f]*")
_SHORT_RULE = re.compile(r"[\s|:-]*-[\s|:-]*")
_BARS = str.maketrans("│┃║", "|||")
_BAR = re.compile(r"(?<!\\)\|")
_BOLD = re.compile(r"(\*\*|__|`)(.*)\1")


def read_markdown(text: str, report: Report) -> Keys:
    """Read a page with one table whose cells stand between bars, its other lines prose.

    Pipe tables, ``+---+`` grids and box drawing; the header names theta, d, a and alpha.
    """
    meta, blocks = list[tuple[Scalar, Scalar]](), list[list[Line]]([[]])
    for number, line in enumerate(text.translate(_BARS).split("\n"), 1):
        under_header = len(blocks[-1]) == 1 and "|" in line
        if _RULE.fullmatch(line) or (under_header and _SHORT_RULE.fullmatch(line)):
            continue
        if "|" in line:
            cells = _cells(line, number)
            report.count(Mark(number, 1), cells=len(cells))
            blocks[-1].append(cells)
            continue
        blocks.append([])
        if entry := metadata(line, number, report):
            meta.append(entry)
    grid = find_table([block for block in blocks if block], meta, report)
    if grid is None:
        hint = "| theta | d | a | alpha |, a line |---|---|---|---|, and one line a row"
        report.stop(Mark(), "no pipe table with the columns theta, d, a and alpha", hint)
    return grid_document(grid, report)


def read_page(text: str, report: Report) -> Keys:
    """Read a text: cells between bars where there are any, else parted by spaces or signs."""
    drawn = [line for line in text.translate(_BARS).split("\n") if line.count("|") > 2]
    return read_markdown(text, report) if len(drawn) > 1 else read_csv(text, report)


def _cells(line: str, number: int) -> Line:
    """Cells between bars, each with the column where its text begins."""
    end = len(line.rstrip())
    bars = [m.start() for m in _BAR.finditer(line)]
    first = len(line) - len(line.lstrip())
    edges = ([] if bars[:1] == [first] else [-1]) + bars
    if edges[-1] != end - 1:
        edges.append(end)
    out = []
    for left, right in pairwise(edges):
        raw = line[left + 1 : right]
        start = left + 2 + len(raw) - len(raw.lstrip())
        text = raw.strip().replace(r"\|", "|")
        out.append(Scalar(_BOLD.sub(r"\2", text), Mark(number, start)))
    return out or [Scalar("", Mark(number, 1))]
