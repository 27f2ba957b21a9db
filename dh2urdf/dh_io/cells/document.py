"""What every table format is read into: keys, items and the text of each cell, with its place.

Cells stay text until the checker knows what they are meant to be, so a number keeps all the
digits that were typed, and a fault can show them.
"""

import bisect
import re
from dataclasses import dataclass
from typing import NamedTuple, NoReturn

from dh2urdf.bounds import DEPTH, NODES, TABLE_BYTES
from dh2urdf.doors import found as value
from dh2urdf.exceptions import TableFileError

MAX_SHOWN = 25
"""Faults listed one by one; a file with more has one cause that shows among the first."""

SNIPPET_WIDTH = 96

_EQUALS = {"yaml": (": ", "", ""), "toml": (" = ", "", '"'), "json": (": ", '"', '"')}
"""Of a format with keys: what stands after a key, and the quotes of keys and of words."""

_CONTROL = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff]")


class Mark(NamedTuple):
    """Line and column of a cell, counted from 1; line 0 where they are not known."""

    line: int = 0
    column: int = 0


NOWHERE = Mark()


class LineStarts:
    """Lines of a text, to turn an offset into a mark."""

    def __init__(self, text: str) -> None:
        self.starts = [0, *(match.end() for match in re.finditer("\n", text))]

    def mark(self, offset: int) -> Mark:
        """Line and column of a character."""
        line = bisect.bisect_right(self.starts, offset)
        return Mark(line, offset - self.starts[line - 1] + 1)


@dataclass(frozen=True, slots=True)
class Scalar:
    """One cell.

    ``text`` is empty where there is none (``null``); ``unit`` is its column's; ``quoted`` where
    the format says that it is a text.
    """

    text: str
    mark: Mark = NOWHERE
    unit: str = ""
    quoted: bool = False


@dataclass(frozen=True, slots=True)
class Items:
    """A list of nodes."""

    values: "tuple[Node, ...]"
    mark: Mark = NOWHERE


@dataclass(frozen=True, slots=True)
class Keys:
    """Pairs of a key and its node, in the file's order, doubles included."""

    pairs: "tuple[tuple[Scalar, Node], ...]"
    mark: Mark = NOWHERE


Node = Scalar | Items | Keys


class Report:
    """Faults and warnings of one file, collected so that all are told at once."""

    def __init__(self, filename: str, text: str = "", format: str = "yaml") -> None:
        self.filename, self.lines, self._cells = filename, text.split("\n"), 0
        self.format = format
        self._faults: list[tuple[Mark, str]] = []
        self._warnings: list[tuple[Mark, str]] = []

    @classmethod
    def of_text(cls, filename: str, text: str, format: str = "yaml") -> "Report":
        """Report of a text that has been looked at: of bounded size, printable, not empty."""
        if not isinstance(text, str):
            raise TableFileError(f"text: expected a text, got {value(text)}")
        report = cls(filename, text, format)
        if "\0" in text:
            report.stop(NOWHERE, "not a text file: it holds binary data")
        if len(text) > TABLE_BYTES:
            report.stop(NOWHERE, f"larger than {TABLE_BYTES // 1000} kB; a DH table is smaller")
        if control := _CONTROL.search(text):
            mark = LineStarts(text).mark(control.start())
            report.stop(mark, f"control character U+{ord(control[0]):04X}")
        if not text.strip():
            report.stop(NOWHERE, "the file is empty")
        return report

    def count(self, mark: Mark, depth: int = 0, cells: int = 1, what: str = "") -> None:
        """Count cells as they are read, and stop at the bounds of a file."""
        self._cells += cells
        if self._cells > NODES:
            self.stop(mark, f"{what}more than {NODES} cells; a DH table is smaller")
        if depth > DEPTH:
            self.stop(mark, f"{what}nested deeper than {DEPTH} levels")

    def fault(self, mark: Mark, path: str, message: str, hint: str = "") -> None:
        """Note a fault of the cell ``path`` at ``mark``."""
        text = f"{self._place(mark)}: {path}{': ' if path else ''}{message}{self._snippet(mark)}"
        self._faults.append((mark, text + (f"\n  hint: {hint}" if hint else "")))

    def warn(self, mark: Mark, path: str, message: str) -> None:
        """Note something that is allowed and probably not meant."""
        self._warnings.append((mark, f"{self._place(mark)}: {path}: {message}"))

    def stop(self, mark: Mark, message: str, hint: str = "") -> NoReturn:
        """Note a fault that makes reading on pointless, and raise."""
        self.fault(mark, "", message, hint)
        self.raise_faults()
        raise AssertionError("unreachable")

    def example(self, key: str, word: str = "", **parts: str) -> str:
        """How the file's own format says so: ``units: {length: mm, angle: deg}``."""
        if self.format == "frame":
            return f'{key}="{word or ",".join(parts.values())}"'
        if self.format not in _EQUALS:
            start = "# " if self.format in ("csv", "tsv") else ""
            if key == "constants":
                return ", ".join(f"{start}{key}.{name}: {value}" for name, value in parts.items())
            return f"{start}{key}: {word or ', '.join(parts.values())}"
        equals, name, text = _EQUALS[self.format]
        if word:
            return f"{name}{key}{name}{equals}{text}{word}{text}"
        cells = {k: v if v[:1].isdigit() else f"{text}{v}{text}" for k, v in parts.items()}
        inside = ", ".join(f"{name}{k}{name}{equals}{v}" for k, v in cells.items())
        return f"{name}{key}{name}{equals}{{{inside}}}"

    def remedy(self, option: str, key: str, word: str = "", **parts: str) -> str:
        """What to write into the file, or to tell of it: ``write ..., or give --units``."""
        example = self.example(key, word, **parts)
        return f"give {example}" if self.format == "frame" else f"write {example}, or give {option}"

    def cell(self, key: str, value: str) -> str:
        """How a row's cell says so: ``a: 0``, or the value alone where columns have headings."""
        if self.format not in _EQUALS:
            return value
        equals, name, _ = _EQUALS[self.format]
        return f"{name}{key}{name}{equals}{value}"

    def raise_faults(self) -> None:
        """Raise one error with all faults noted so far, in the file's order."""
        if not self._faults:
            return
        texts = _in_order(self._faults)
        if len(texts) > MAX_SHOWN:
            more = len(texts) - MAX_SHOWN
            texts = [*texts[:MAX_SHOWN], f"{self.filename}: and {more} more"]
        raise TableFileError(texts)

    @property
    def warnings(self) -> tuple[str, ...]:
        """The warnings in the file's order."""
        return tuple(_in_order(self._warnings))

    def _place(self, mark: Mark) -> str:
        return f"{self.filename}:{mark.line}:{mark.column}" if mark.line else self.filename

    def _snippet(self, mark: Mark) -> str:
        """Line of the file and a caret under the column."""
        if not 1 <= mark.line <= len(self.lines):
            return ""
        line = self.lines[mark.line - 1].rstrip().replace("\t", " ")
        start = max(0, min(mark.column - 1 - SNIPPET_WIDTH // 2, len(line) - SNIPPET_WIDTH))
        shown = "".join(c if c.isprintable() else "?" for c in line[start : start + SNIPPET_WIDTH])
        number = f"{mark.line:>5}"
        caret = " " * (mark.column - 1 - start) + "^"
        return f"\n{number} | {shown}\n{' ' * len(number)} | {caret}"


def _in_order(notes: list[tuple[Mark, str]]) -> list[str]:
    """Texts in the order of their marks, each once."""
    return list(dict.fromkeys(text for _, text in sorted(notes, key=lambda note: note[0])))
