"""JSON to a document: strict, with the place of each cell, and bounded in depth."""

import re
from collections.abc import Callable
from json import JSONDecodeError, JSONDecoder
from typing import NoReturn, TypeVar

from dh2urdf.dh_io.cells.document import Items, Keys, LineStarts, Mark, Node, Report, Scalar

_SPACE = re.compile(r"[ \t\n\r]*")
_NUMBER = re.compile(r"-?(?:0|[1-9]\d*)(?:\.\d+)?(?:[eE][-+]?\d+)?")
_WORD = re.compile(r"-?\w+")
_DECODER = JSONDecoder()
_LITERALS = {"null": "", **{w: w for w in ("true", "false", "NaN", "Infinity", "-Infinity")}}
"""The last three are refused by the cell, which knows its own name."""

Entry = TypeVar("Entry")


def read_json(text: str, report: Report) -> Node:
    """Read one JSON value."""
    return _Reader(text, report).document()


class _Reader:
    """Recursive descent (RFC 8259); numbers keep their text."""

    def __init__(self, text: str, report: Report) -> None:
        self.text, self.report, self.lines = text, report, LineStarts(text)
        self.at = 0

    def document(self) -> Node:
        node = self.node(0)
        if self.peek():
            self.stop("more text after the end of the table")
        return node

    def peek(self) -> str:
        """Next character after spaces, empty at the end."""
        match = _SPACE.match(self.text, self.at)
        self.at = match.end() if match else self.at
        return self.text[self.at : self.at + 1]

    def mark(self) -> Mark:
        return self.lines.mark(self.at)

    def stop(self, message: str) -> NoReturn:
        self.report.stop(self.mark(), f"not JSON: {message}")

    def node(self, depth: int) -> Node:
        character, mark = self.peek(), self.mark()
        self.report.count(mark, depth)
        if character == "{":
            return Keys(self.inside("}", self.pair, depth + 1), mark)
        if character == "[":
            return Items(self.inside("]", self.node, depth + 1), mark)
        if character == '"':
            return Scalar(self.string(), mark, quoted=True)
        return Scalar(self.literal(character), mark)

    def literal(self, character: str) -> str:
        """Number as typed, or true, false, null."""
        match = _WORD.match(self.text, self.at)
        if match and match[0] in _LITERALS:
            self.at = match.end()
            return _LITERALS[match[0]]
        number = _NUMBER.match(self.text, self.at)
        if number is None:
            what = f"unexpected {character!r}" if character else "the text ends too early"
            self.stop(what + ("; a text takes double quotes" if character == "'" else ""))
        self.at = number.end()
        return number[0]

    def string(self) -> str:
        try:
            text, self.at = _DECODER.raw_decode(self.text, self.at)
        except JSONDecodeError as error:
            self.at = min(error.pos, len(self.text))
            self.stop(error.msg.lower().removesuffix(" at").removesuffix(" starting"))
        return str(text)

    def inside(self, end: str, entry: Callable[[int], Entry], depth: int) -> tuple[Entry, ...]:
        """Entries from a bracket to the one that closes it."""
        out: list[Entry] = []
        self.at += 1
        while self.peek() != end:
            if out:
                self.comma(end)
            out.append(entry(depth))
        self.at += 1
        return tuple(out)

    def pair(self, depth: int) -> tuple[Scalar, Node]:
        if self.peek() != '"':
            self.stop("a key in double quotes is expected")
        mark = self.mark()
        key = Scalar(self.string(), mark)
        if self.peek() != ":":
            self.stop("a colon is expected after a key")
        self.at += 1
        return key, self.node(depth)

    def comma(self, end: str) -> None:
        """Step over the comma before another value."""
        character = self.peek()
        if character != ",":
            self.stop(f"a comma or {end} is expected" if character else "the text ends too early")
        self.at += 1
        if self.peek() == end:
            self.stop("a comma after the last value")
