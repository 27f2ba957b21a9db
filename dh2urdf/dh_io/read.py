"""A path or a text to a table."""

from __future__ import annotations

import difflib
import os
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from dh2urdf.bounds import TABLE_BYTES
from dh2urdf.dh import DHTable
from dh2urdf.dh_io.checker import check_document
from dh2urdf.dh_io.document import Node, Report
from dh2urdf.dh_io.read_csv import read_csv
from dh2urdf.dh_io.read_json import read_json
from dh2urdf.dh_io.read_markdown import read_markdown
from dh2urdf.dh_io.read_toml import read_toml
from dh2urdf.exceptions import TableFileError

__all__ = ["FORMATS", "TableFile", "format_of", "parse_table", "read_table"]

FORMATS = {
    ".yaml": "yaml",
    ".yml": "yaml",
    ".toml": "toml",
    ".json": "json",
    ".csv": "csv",
    ".tsv": "csv",
    ".md": "markdown",
    ".markdown": "markdown",
}
"""Format of a file by its suffix."""

_READERS: dict[str, Callable[[str, Report], Node]] = {
    "toml": read_toml,
    "json": read_json,
    "csv": read_csv,
    "markdown": read_markdown,
}


class TableFile(NamedTuple):
    """A table read from a file, and what looked odd about it."""

    table: DHTable
    warnings: tuple[str, ...]


def format_of(path: str | os.PathLike[str]) -> str:
    """Format of a path by its suffix.

    Raises
    ------
    TableFileError
        The suffix is not one of `FORMATS`.
    """
    suffix = Path(path).suffix.casefold()
    if suffix in FORMATS:
        return FORMATS[suffix]
    message = f"{path}: not a table file by its name; known suffixes: {', '.join(FORMATS)}"
    if suffix in (".urdf", ".xacro", ".xml", ".mjcf"):
        message += "\n  hint: to get a table from a robot description, extract it"
    raise TableFileError(message)


def read_table(path: str | os.PathLike[str], *, format: str | None = None) -> TableFile:
    """Read a table from a YAML, TOML, JSON, CSV or Markdown file.

    Parameters
    ----------
    path : path
    format : str, optional
        ``yaml``, ``toml``, ``json``, ``csv`` or ``markdown``; by the suffix where not given.

    Raises
    ------
    TableFileError
        All faults of the file at once, each with its line and column.
    """
    where = Path(path)
    kind = format
    if kind is None and not where.is_dir():
        kind = format_of(where)
    data = _bytes(where)
    return parse_table(_text(data, str(path)), kind or "yaml", str(path))


def parse_table(text: str, format: str, filename: str = "<text>") -> TableFile:
    """Read a table from a text in one of the formats.

    Parameters
    ----------
    text, format : str
    filename : str
        How messages name the text; its stem is the table's name where the text gives none.
    """
    report = Report.of_text(filename, text)
    table = check_document(_document(text, format, report), report, Path(filename).stem or "robot")
    return TableFile(table, report.warnings)


def _document(text: str, format: str, report: Report) -> Node:
    if format == "yaml":
        from dh2urdf.dh_io.read_yaml import read_yaml

        return read_yaml(text, report)
    if format in _READERS:
        return _READERS[format](text, report)
    formats = ", ".join(dict.fromkeys(FORMATS.values()))
    raise TableFileError(f"format: {format!r} is not known; allowed: {formats}")


def _bytes(path: Path) -> bytes:
    try:
        with path.open("rb") as stream:
            return stream.read(4 * TABLE_BYTES + 1)
    except FileNotFoundError:
        message = f"{path}: there is no such file"
    except IsADirectoryError:
        message = f"{path}: this is a folder, not a table file"
    except PermissionError:
        message = f"{path}: no permission to read it"
    except (OSError, ValueError) as error:
        message = f"{path}: cannot read: {getattr(error, 'strerror', None) or error}"
    if path.parent.is_dir() and (near := _near(path)):
        message += f"\n  hint: did you mean {near}?"
    raise TableFileError(message)


def _near(path: Path) -> str:
    if path.exists():
        return ""
    names = [p.name for p in path.parent.iterdir() if p.suffix.casefold() in FORMATS]
    near = difflib.get_close_matches(path.name, names, n=1)
    return str(path.with_name(near[0])) if near else ""


def _text(data: bytes, filename: str) -> str:
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        raise TableFileError(f"{filename}: the file is UTF-16 text; save it as UTF-8")
    try:
        return data.decode("utf-8-sig").replace("\r\n", "\n").replace("\r", "\n")
    except UnicodeDecodeError:
        reason = "it holds binary data" if b"\0" in data else "it is not UTF-8"
        raise TableFileError(f"{filename}: not a text file: {reason}") from None
