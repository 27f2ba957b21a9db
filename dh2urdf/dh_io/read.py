"""A path or a text to a table."""

import difflib
import os
import re
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import NamedTuple

from dh2urdf.bounds import TABLE_BYTES
from dh2urdf.dh import DHTable
from dh2urdf.dh_io.cells.document import Node, Report
from dh2urdf.dh_io.cells.told import NOTHING, Told
from dh2urdf.dh_io.cells.units import Units
from dh2urdf.dh_io.checker import check_document
from dh2urdf.dh_io.files import path_of, read_text, shown
from dh2urdf.dh_io.forms import other_form
from dh2urdf.doors import choice
from dh2urdf.exceptions import TableFileError

FORMATS = {
    ".yaml": "yaml",
    ".yml": "yaml",
    ".toml": "toml",
    ".json": "json",
    ".csv": "csv",
    ".tsv": "tsv",
    ".md": "markdown",
    ".markdown": "markdown",
}
"""Format of a file by its suffix."""

Reader = Callable[[str, Report], Node]

_READERS = {
    "yaml": "yaml:read_yaml",
    "toml": "toml:read_toml",
    "json": "json:read_json",
    "csv": "csv:read_csv",
    "tsv": "csv:read_csv",
    "markdown": "markdown:read_markdown",
    "text": "markdown:read_page",
}
"""Module in `formats` and function, imported when a file of the format is read."""


_SIGNS = {
    "text": re.compile(r"[│┃║]|^\s*\+[-=]{2}|\A[^:=,;\t{\[|]*\Z", re.MULTILINE),
    "json": re.compile(r"\A\s*\{"),
    "markdown": re.compile(r"^\s*\|", re.MULTILINE),
    "yaml": re.compile(r"^(?:joints|convention|units|name)\s*:", re.MULTILINE),
    "toml": re.compile(r"^\s*(?:\[|\w+\s*=)", re.MULTILINE),
    "csv": re.compile(r"^[^#\n]*[,;\t]", re.MULTILINE),
}


_PAGES = {
    "LaTeX": re.compile(r"\\begin\s*\{(?:tabular|array|longtable|tabulary?)"),
    "HTML": re.compile(r"<(?:!doctype\s+html|html|table)\b", re.IGNORECASE),
}
_AS_ROWS = "copy the rows into a .csv file: theta,d,a,alpha, then a line a row, parted by commas"


class TableFile(NamedTuple):
    """A table read from a file, what looked odd about it, and the units that the file is in."""

    table: DHTable
    warnings: tuple[str, ...]
    units: Units | None = None


def format_of(path: str | os.PathLike[str]) -> str:
    """Format of a path by its suffix; an error where it is not one of `FORMATS`."""
    suffix = Path(path).suffix.casefold()
    if suffix in FORMATS:
        return FORMATS[suffix]
    known = ", ".join([*FORMATS, ".txt"])
    message = f"{shown(path)}: not a table file by its name; known suffixes: {known}"
    if suffix in (".urdf", ".xacro", ".xml", ".mjcf"):
        message += "\n  hint: to get a table from a robot description, extract it"
    if suffix in (".tex", ".html", ".htm"):
        message += f"\n  hint: {_AS_ROWS}"
    raise TableFileError(message)


def format_of_text(text: str) -> str:
    """Format of a text without a path, by the first sign of one."""
    return next((name for name, sign in _SIGNS.items() if sign.search(text)), "yaml")


def read_table(
    path: str | os.PathLike[str], *, format: str | None = None, told: Told = NOTHING
) -> TableFile:
    """Read a table from a YAML, TOML, JSON, CSV, Markdown or text file.

    Parameters
    ----------
    path : path
    format : str, optional
        ``yaml``, ``toml``, ``json``, ``csv``, ``markdown`` or ``text`` (a table drawn with
        bars or parted by spaces); by the suffix where not given.
    told : Told
        Convention and units, for a file that does not say them.

    Raises
    ------
    TableFileError
        All faults of the file at once, each with its line and column.
    """
    where = path_of(path)
    kind = format
    if kind is None and not os.path.isdir(where):
        kind = "text" if where.suffix.casefold() == ".txt" else format_of(where)
    try:
        text = read_text(where, TABLE_BYTES, TableFileError)
    except TableFileError as error:
        near = _near(where)
        raise TableFileError(
            f"{error}\n  hint: did you mean {near}?" if near else str(error)
        ) from None
    return parse_table(text, kind or "yaml", shown(where), told)


def parse_table(
    text: str, format: str, filename: str = "<text>", told: Told = NOTHING
) -> TableFile:
    """Read a table from a text in one of the formats.

    Messages call the text by the file's name, whose stem names a table that has no name.
    """
    module, function = _READERS[choice(format, "format", _READERS, TableFileError)].split(":")
    read: Reader = getattr(import_module(f"dh2urdf.dh_io.formats.{module}"), function)
    if format != "markdown":
        refuse_page(text, filename)
    report = Report.of_text(filename, text, format)
    root, name = read(text, report), Path(filename).stem or "robot"
    if (form := other_form(root, report, name, told)) is not None:
        return TableFile(*form)
    table, units = check_document(root, report, name, told)
    return TableFile(table, report.warnings, units)


def refuse_page(text: str, filename: str) -> None:
    """Refuse a table that is typeset, in LaTeX or HTML, and say how it can be read."""
    for kind, sign in _PAGES.items():
        if sign.search(text):
            message = f"{filename}: a table in {kind} is for people and is not read"
            raise TableFileError(f"{message}\n  hint: {_AS_ROWS}")


def _near(path: Path) -> str:
    if os.path.exists(path):
        return ""
    try:
        names = [p.name for p in path.parent.iterdir() if p.suffix.casefold() in FORMATS]
    except (OSError, ValueError):
        return ""
    near = difflib.get_close_matches(path.name, names, n=1)
    return str(path.with_name(near[0])) if near else ""
