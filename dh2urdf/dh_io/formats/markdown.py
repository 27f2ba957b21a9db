"""The DH table of a Markdown page to a document; the page's other lines are prose."""

import re
from itertools import pairwise

from dh2urdf.dh_io.cells.document import Keys, Mark, Report, Scalar
from dh2urdf.dh_io.formats.grid import Grid, grid_document, is_header, metadata

_RULE = re.compile(r"\s*\|?\s*:?-+:?\s*(\|\s*:?-+:?\s*)*\|?\s*")
_BAR = re.compile(r"(?<!\\)\|")


def read_markdown(text: str, report: Report) -> Keys:
    """Read a Markdown page with one pipe table whose header names theta, d, a and alpha."""
    grid = Grid([], [], [])
    lines = text.split("\n")
    at = 0
    while at < len(lines):
        rule = at + 1 < len(lines) and "|" in lines[at + 1] and _RULE.fullmatch(lines[at + 1])
        if "|" not in lines[at] or not rule:
            if "|" not in lines[at] and (entry := metadata(lines[at], at + 1, report)):
                grid.meta.append(entry)
            at += 1
            continue
        header = _cells(lines[at], at + 1)
        wanted = is_header(header)
        if wanted and grid.header:
            report.stop(Mark(at + 1, 1), "a second DH table; a file holds one")
        if wanted:
            grid.header.extend(header)
        at += 2
        while at < len(lines) and "|" in lines[at]:
            if wanted:
                grid.rows.append(_cells(lines[at], at + 1))
                report.count(Mark(at + 1, 1), cells=len(grid.rows[-1]))
            at += 1
    if not grid.header:
        hint = "| theta | d | a | alpha |, a line |---|---|---|---|, and one line a row"
        report.stop(Mark(), "no pipe table with the columns theta, d, a and alpha", hint)
    return grid_document(grid, report)


def _cells(line: str, number: int) -> list[Scalar]:
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
        out.append(Scalar(raw.strip().replace(r"\|", "|"), Mark(number, start)))
    return out or [Scalar("", Mark(number, 1))]
