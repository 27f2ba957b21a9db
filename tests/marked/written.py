"""The kernels as C that marks its statements, and checks indices: what the translator writes else.

A mark is one of a statement of the sources, whatever types it is translated for.
"""

import ast
import re
from pathlib import Path
from typing import NamedTuple

from dh2urdf.translate.c_file import CFile
from dh2urdf.translate.definitions import HEAD
from dh2urdf.translate.entries import argument_types, doors, entries
from dh2urdf.translate.source import Source
from dh2urdf.translate.statements import Body
from dh2urdf.translate.types import Array, Length
from dh2urdf.translate.values import Binds, Value, sized

RUNTIME = Path(__file__).with_name("marks.h").read_text()


class Place(NamedTuple):
    """A statement: file below the kernels, function, line."""

    file: str
    function: str
    line: int


KINDS = 5
"""Bytes of a mark: that it was reached, and four kinds of errors."""

OUTSIDE = Place("", "outside the kernels", 0)


class MarkedBody(Body):
    """Writes a kernel with marks."""

    file: "MarkedFile"
    here = 0
    """The mark of the statement that is being written."""

    def write(self) -> None:
        """Write the body; all lengths are asked for."""
        self.asked |= set(self.source.parameters)
        self.compared: list[str] = []
        super().write()
        self.body = re.sub(r"LENGTH(\d+)", lambda k: self.compared[int(k[1])], self.body)

    def _length(self, length: Length) -> str:
        """What stands for a length until all is written: it is none of the names of a value."""
        self.compared.append(str(length))
        return f"LENGTH{len(self.compared) - 1}"

    def _statement(self, s: ast.stmt) -> bool:
        self.here = self.file.mark(self.source, s.lineno)
        self.out(f"MARK_OF_LINE({self.here});")
        return super()._statement(s)

    def test(self, n: ast.expr, alone: bool = False) -> Value:
        """A condition; where no statement can stand before it, its mark is a part of it."""
        found = super().test(n, alone)
        if not alone or found.known is not None:
            return found
        self.here = self.file.mark(self.source, n.lineno)
        return Value(found.type, f"(MARK_OF_LINE({self.here}), {found.text})")

    def place(self, index: Value, length: Length) -> str:
        """An index that is checked unless both are known."""
        if length is None or (isinstance(index.known, int) and isinstance(length, int)):
            return index.text
        return f"INDEX_INSIDE({index.text}, {self._length(length)}, {self.here})"

    def _made_by(self, n: ast.Call, callee: Source) -> Value:
        """Arrays that a kernel makes: its statements are a part of this one."""
        for s in callee.body:
            self.out(f"MARK_OF_LINE({self.file.mark(callee, s.lineno)});")
        return super()._made_by(n, callee)

    def _view(self, n: ast.Subscript, text: str, t: Array, s: ast.Slice) -> Value:
        found, whole = super()._view(n, text, t, s), t.shape[0]
        start = self.value(s.lower) if s.lower else sized(0)
        end = self.value(s.upper) if s.upper else sized(whole)
        if whole is None or all(isinstance(x, int) for x in (start.known, end.known, whole)):
            return found
        checked = f"STRETCH_INSIDE({start.text}, {end.text}, {self._length(whole)}, {self.here})"
        return Value(found.type, f"{text} + {checked}", Binds.SUM)


class MarkedFile(CFile):
    """The C file, and its marks."""

    writes = MarkedBody
    head = HEAD.replace(
        "static void leave(void)\n{", "static void leave(void)\n{\n    MARK_OF_LINE(0);"
    )

    def __init__(self) -> None:
        super().__init__()
        self.marks = {OUTSIDE: 0}

    def mark(self, source: Source, line: int) -> int:
        """The mark of a line of a kernel."""
        file = str(source.file).rpartition("dh2urdf/kernels/")[2]
        place = Place(file, source.name, source.line + line - 1)
        return self.marks.setdefault(place, len(self.marks))


def texts() -> tuple[dict[str, str], list[Place]]:
    """The C files of all entries, by name, and the statements, in the order of their marks."""
    file = MarkedFile()
    for function in entries().values():
        file.add_entry(function, argument_types(function))
    kernels = f"#define COUNT_OF_MARKS {len(file.marks)}\n{RUNTIME}\n{file.kernels()}"
    found = {"kernels.h": file.header(), "kernels.c": kernels, "doors.h": doors(file)}
    return found, list(file.marks)


def statements(kernels: Path) -> list[Place]:
    """Every statement of the kernels' functions but docstrings, each line once."""
    found = dict[Place, None]()
    for path in sorted(kernels.rglob("*.py")):
        if path.name == "shapes.py":
            continue
        for f in ast.walk(ast.parse(path.read_text())):
            if isinstance(f, ast.FunctionDef):
                body = f.body[1:] if ast.get_docstring(f) else f.body
                lines = {s.lineno for top in body for s in ast.walk(top) if isinstance(s, ast.stmt)}
                name = str(path.relative_to(kernels))
                found |= dict.fromkeys(Place(name, f.name, line) for line in sorted(lines))
    return list(found)
