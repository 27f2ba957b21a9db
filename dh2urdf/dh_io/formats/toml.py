"""TOML to a document. The standard library gives no places; they are found by search."""

import re
import tomllib
from typing import Any

from dh2urdf.dh_io.cells.document import Items, Keys, LineStarts, Mark, Node, Report, Scalar

_AT = re.compile(r"(.*?)\s*\(at (?:line (\d+), column (\d+)|end of document)\)", re.DOTALL)
_HEADER = re.compile(r"(\[\[?)([^\[\]\n]*)\]\]?")
_TOKEN = re.compile(
    r"""(?P<skip>[\s]+|\#[^\n]*)
    |(?P<word>\"\"\".*?\"\"\"|\'\'\'.*?\'\'\'|"(?:\\.|[^"\\])*"|'[^']*'|[^\s\[\]{},=\#"']+)
    |(?P<mark>[\[\]{},=])""",
    re.VERBOSE | re.DOTALL,
)

Path = tuple[str | int, ...]


def read_toml(text: str, report: Report) -> Node:
    """Read one TOML file."""
    try:
        return _node(tomllib.loads(text, parse_float=_Literal), (), _Places(text))
    except tomllib.TOMLDecodeError as error:
        match = _AT.match(str(error))
        reason = match[1] if match else str(error)
        line, column = (int(match[2]), int(match[3])) if match and match[2] else (0, 0)
        report.stop(Mark(line, column), f"not TOML: {reason[:1].lower()}{reason[1:]}")
    except RecursionError:
        report.stop(Mark(), "not TOML: nested too deeply")
    except ValueError:
        report.stop(Mark(), "not TOML: an integer with thousands of digits")


class _Literal(str):
    """A float as it was typed."""

    __slots__ = ()


class _Places:
    """Places of all values of a text that is known to be TOML."""

    def __init__(self, text: str) -> None:
        self.lines = LineStarts(text)
        self.places: dict[Path, int] = {}
        self.table: Path = ()
        self.value: Path | None = None  # what the next value belongs to
        self.key: Path = ()
        self.open: list[tuple[Path, int]] = []  # brackets: path, index (-1 in a table)
        self.tables: dict[Path, int] = {}
        at = 0
        while match := _TOKEN.match(text, at):
            at = match.end()
            if match["word"] is not None:
                self.word(match["word"], match.start())
            elif match["mark"] == "[" and not self.open and self.value is None:
                at = self.header(_HEADER.match(text, match.start()), at)
            elif match["mark"] is not None:
                self.mark(match["mark"], match.start())

    def of(self, path: Path) -> Mark:
        """Place of a value, or of what it stands in."""
        while path and path not in self.places:
            path = path[:-1]
        return self.lines.mark(self.places[path]) if path else Mark()

    def header(self, match: re.Match[str] | None, at: int) -> int:
        """Open ``[table]`` or the next ``[[row]]``; where it ends."""
        if match is None:
            return at
        self.table = _parts(match[2])
        if match[1] == "[[":
            index = self.tables[self.table] = self.tables.get(self.table, -1) + 1
            self.table = (*self.table, index)
        self.places.setdefault(self.table, match.start())
        return match.end()

    def word(self, text: str, at: int) -> None:
        if self.value is not None or (self.open and self.open[-1][1] >= 0):
            self.take(at)
        else:
            self.key = _parts(text)

    def mark(self, text: str, at: int) -> None:
        if text in "[{":
            self.open.append((self.take(at), 0 if text == "[" else -1))
        elif text in "]}" and self.open:
            self.open.pop()
        elif text == "=":
            self.value = (*(self.open[-1][0] if self.open else self.table), *self.key)
        elif text == "," and self.open and self.open[-1][1] >= 0:
            path, index = self.open.pop()
            self.open.append((path, index + 1))

    def take(self, at: int) -> Path:
        """Path of the value that begins here."""
        path = self.value
        if path is None:
            outer, index = self.open[-1]
            path = (*outer, index)
        self.value = None
        self.places.setdefault(path, at)
        return path


def _parts(key: str) -> Path:
    """Parts of a dotted key."""
    return tuple(part.strip().strip("\"'") for part in key.split("."))


def _node(value: Any, path: Path, places: _Places) -> Node:
    """Node of a value, which TOML has kept within a bounded depth."""
    mark = places.of(path)
    if isinstance(value, dict):
        pairs = [
            (Scalar(key, places.of((*path, key))), _node(v, (*path, key), places))
            for key, v in value.items()
        ]
        return Keys(tuple(pairs), mark)
    if isinstance(value, list):
        return Items(tuple(_node(v, (*path, i), places) for i, v in enumerate(value)), mark)
    if isinstance(value, bool):
        return Scalar(str(value).lower(), mark)
    if isinstance(value, str | int):
        return Scalar(str(value), mark)
    return Scalar(f"{type(value).__name__} {value}", mark)  # a date is not a subtraction
