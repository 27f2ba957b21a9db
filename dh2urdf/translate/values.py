"""What an expression is in C, and the names and lengths that it rests on."""

import ast
import re
from dataclasses import dataclass
from typing import NoReturn

from dh2urdf.translate.c_text import RESERVED
from dh2urdf.translate.definitions import Definitions, Instance
from dh2urdf.translate.types import Array, Length, Record, Tuple, Type, type_of_value

ATOM, POSTFIX, PREFIX, SUM, COMPARISON, OR, CHOICE = 16, 15, 14, 12, 9, 4, 3
"""How tightly the operators of C bind."""

LEVELS: dict[int, dict[type[ast.AST], str]] = {
    PREFIX: {ast.USub: "-", ast.UAdd: "+", ast.Invert: "~"},
    13: {ast.Mult: "*", ast.Div: "/"},
    SUM: {ast.Add: "+", ast.Sub: "-"},
    11: {ast.LShift: "<<", ast.RShift: ">>"},
    COMPARISON + 1: {ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">="},
    COMPARISON: {ast.Eq: "==", ast.NotEq: "!="},
    8: {ast.BitAnd: "&"},
    7: {ast.BitXor: "^"},
    6: {ast.BitOr: "|"},
    OR + 1: {ast.And: "&&"},
    OR: {ast.Or: "||"},
}
SIGNS = {kind: (sign, level) for level, signs in LEVELS.items() for kind, sign in signs.items()}
"""C's signs for operators, and how tightly they bind."""


@dataclass(frozen=True)
class Value:
    """An expression in C."""

    type: Type
    text: str = ""
    binds: int = ATOM
    parts: tuple["Value", ...] = ()
    """Of a tuple that is written out."""
    maker: str = ""
    """What makes an array that has no name yet."""
    known: Length = None
    """Of a whole number that is known before the kernel runs, or in terms of its lengths."""

    def at(self, level: int) -> str:
        """The text, in brackets where it binds less."""
        return f"({self.text})" if self.binds < level else self.text

    def words(self) -> set[str]:
        """Names in the text."""
        inside = set[str]().union(*(part.words() for part in self.parts))
        return inside | set(re.findall(r"\w+", self.text))

    def leaves(self) -> list["Value"]:
        """What goes from kernel to kernel: itself, or its parts one by one."""
        if isinstance(self.type, Tuple) and not self.type.is_struct:
            return [leaf for part in self.parts for leaf in part.leaves()]
        return [self]


def sized(length: Length) -> Value:
    """A length as a value."""
    text = str(length)
    return Value("int", text, ATOM if re.fullmatch(r"\w+|\(.*\)", text) else SUM, known=length)


def known_of(op: ast.operator, a: Length, b: Length) -> Length:
    """What is known of two lengths with an operator between them."""
    sign = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.FloorDiv: "//"}.get(type(op))
    if sign is None or a is None or b is None:
        return None
    if isinstance(a, int) and isinstance(b, int):
        return {"+": a + b, "-": a - b, "*": a * b, "//": a // b if b else None}[sign]
    return None if sign == "//" else f"({a} {sign} {b})"


class Names:
    """The names of one kernel, and the whole numbers that are known before it runs."""

    def __init__(self, file: Definitions, instance: Instance) -> None:
        self.file, self.instance, self.source = file, instance, instance.source
        self.values: dict[str, Value] = {}
        """What names stand for that have been given a value so far."""
        self.lines: list[tuple[int, str]] = []
        self.depth = 1
        outside = {x.lstrip("_") for x in self.source.names - self.source.stored}
        self.reserved = RESERVED | outside | set(instance.lengths())
        self.taken = self.source.names | self.reserved

    def refuse(self, node: ast.AST, found: str, instead: str = "") -> NoReturn:
        """Refuse a node of the body."""
        self.source.refuse(node, found, instead)

    def out(self, text: str) -> None:
        """A line of C."""
        self.lines.append((self.depth, text))

    def name(self, name: str) -> str:
        """A name of the kernel in C: what C or something else has taken is marked."""
        return f"{name}_" if name in self.reserved else name

    def fresh(self, name: str) -> str:
        """A name that is not taken."""
        numbered = (f"{name}{k}" for k in range(2, 999))
        found = next(x for x in (name, *numbered) if x not in self.taken)
        self.taken.add(found)
        return found

    def temporary(self, value: Value, name: str) -> Value:
        """A constant of its own for a value."""
        name, t = self.fresh(name), value.type
        const = "" if isinstance(t, Array | Record) else "const "
        self.out(f"{const}{self.file.declaration(t, name)} = {value.text};")
        return Value(t, name)

    def named(self, n: ast.Name) -> Value:
        """What a name stands for."""
        if n.id in self.values:
            return self.values[n.id]
        if n.id in self.source.stored:
            self.refuse(n, "a name before its value", "the assignment above it")
        constant = self.source.stands_for(n.id)
        t = type_of_value(constant)
        if t is None:
            self.refuse(n, "a name that stands for no number or array", "an argument")
        known = int(constant) if t == "int" else None
        return Value(t, self.file.constant(self.source, n.id), known=known)
