"""What an expression is in C, and the names and lengths that it rests on."""

import ast
import operator
import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NoReturn, TypeAlias

from dh2urdf.translate.definitions import RESERVED, Definitions
from dh2urdf.translate.source import Source, named
from dh2urdf.translate.types import Array, Length, Record, Tuple, Type, lengths_of, type_of_value


class Binds:
    """How tightly the operators of C bind."""

    ATOM, POSTFIX, PREFIX, SUM, COMPARISON, OR, CHOICE = 16, 15, 14, 12, 9, 4, 3


LEVELS: dict[int, dict[type[ast.AST], str]] = {
    Binds.POSTFIX: {ast.FloorDiv: "floor_div", ast.Mod: "floor_mod"},
    Binds.PREFIX: {ast.USub: "-", ast.UAdd: "+", ast.Invert: "~"},
    13: {ast.Mult: "*", ast.Div: "/"},
    Binds.SUM: {ast.Add: "+", ast.Sub: "-"},
    11: {ast.LShift: "<<", ast.RShift: ">>"},
    Binds.COMPARISON + 1: {ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">="},
    Binds.COMPARISON: {ast.Eq: "==", ast.NotEq: "!="},
    8: {ast.BitAnd: "&"},
    7: {ast.BitXor: "^"},
    6: {ast.BitOr: "|"},
    Binds.OR + 1: {ast.And: "&&"},
    Binds.OR: {ast.Or: "||"},
}
SIGNS = {kind: (sign, level) for level, signs in LEVELS.items() for kind, sign in signs.items()}
"""C's signs for operators, or functions, and how tightly they bind."""

_ADVICE = {
    "ListComp GeneratorExp DictComp SetComp MatMult": "a loop",
    "List": "np.empty, or a tuple",
    "Dict ClassDef": "a record of the module, or arguments",
    "Set In NotIn Is IsNot": "comparisons with == or !=",
    "Lambda FunctionDef": "a kernel of the module",
    "Try Raise Assert": "a returned status",
    "With": "the statements alone",
    "Yield YieldFrom": "into an array that is handed in",
    "Global Nonlocal": "an argument",
    "keyword": "a positional argument",
    "JoinedStr": "numbers only",
    "Import ImportFrom": "the import at the head of the module",
    "Delete": "nothing",
    "NamedExpr": "an assignment of its own",
    "AnnAssign": "an assignment without a type",
    "Match": "if and elif",
    "Pow": "products, or math.sqrt",
}
ADVICE = {kind: advice for kinds, advice in _ADVICE.items() for kind in kinds.split()}
"""What to write instead of syntax outside the subset."""


Known: TypeAlias = Length | float


@dataclass(frozen=True)
class Value:
    """An expression in C."""

    type: Type
    text: str = ""
    binds: int = Binds.ATOM
    parts: tuple["Value", ...] = ()
    """Of a tuple that is written out."""
    maker: str = ""
    """What makes an array that has no name yet."""
    known: Known = None
    """Of a number that is known before the kernel runs, or of a length in terms of lengths."""

    def at(self, level: int) -> str:
        """The text, in brackets where it binds less."""
        return f"({self.text})" if self.binds < level else self.text

    def words(self) -> set[str]:
        """Names in the text."""
        inside = set[str]().union(*(part.words() for part in self.parts))
        return inside | set(re.findall(r"\w+", self.text))

    def items(self) -> tuple["Value", ...]:
        """The items of a tuple."""
        assert isinstance(self.type, Tuple)
        fields = self.type.fields().items()
        return self.parts or tuple(
            Value(t, f"{self.at(Binds.POSTFIX)}.{f}", Binds.POSTFIX) for f, t in fields
        )

    def leaves(self) -> list["Value"]:
        """What goes from kernel to kernel: itself, or its parts one by one."""
        if isinstance(self.type, Tuple) and not self.type.is_struct:
            return [leaf for part in self.parts for leaf in part.leaves()]
        return [self]

    @property
    def length(self) -> Length:
        """What is known, if it can be a length."""
        return None if isinstance(self.known, float) else self.known

    def meant(self) -> Any:
        """What Python has for a value that is known; None for another."""
        if isinstance(self.type, Tuple):
            items = tuple(part.meant() for part in self.parts)
            return None if not items or any(item is None for item in items) else items
        if isinstance(self.type, Array):
            return self.type.fixed and self.type.fixed.values
        return None if isinstance(self.known, str) else self.known


def sized(length: Length) -> Value:
    """A length as a value."""
    text = str(length)
    return Value(
        "int", text, Binds.ATOM if re.fullmatch(r"\w+|\(.*\)", text) else Binds.SUM, known=length
    )


def known_of(op: ast.AST, a: Known, b: Known) -> Known:
    """What is known of two numbers, or lengths, with an operator between them."""
    sign, _ = SIGNS[type(op)]
    if isinstance(a, int | float) and isinstance(b, int | float):
        return _OPERATORS[sign](a, b) if sign in _OPERATORS and (sign != "/" or b) else None
    if isinstance(a, str) and a == b and sign in ("==", "!="):
        return sign == "=="
    both = isinstance(a, int | str) and isinstance(b, int | str)
    return f"({a} {sign} {b})" if both and sign in "+-*" and a and b else None


_OPERATORS: dict[str, Callable[[Any, Any], Known]] = {
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "/": operator.truediv,
    "==": operator.eq,
    "!=": operator.ne,
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
}


Translate: TypeAlias = Callable[[Source, tuple[Type, ...]], "Names"]
"""Gives a kernel for some types of arguments."""


class Names:
    """A kernel for one list of argument types: what its names stand for, and what C is told."""

    def __init__(
        self, file: Definitions, source: Source, arguments: tuple[Type, ...], translate: Translate
    ) -> None:
        self.file, self.source, self.translate = file, source, translate
        self.refuse = source.refuse
        self.arguments, self.entered = arguments, arguments
        """Types of the arguments, without the lengths that it does not ask for, and with all."""
        self.function, self.body = "", ""
        """Its name in C, and what is between the braces there."""
        self.returned: Type | None = None
        self.parameters: list[tuple[str, Type]] = []
        """Those of C, where tuples with arrays are taken apart."""
        self.asked = set[str]()
        """Parameters whose first length the kernel asks for."""
        self.values: dict[str, Value] = {}
        """What names stand for that have been given a value so far."""
        self.lines: list[tuple[int, str]] = []
        self.depth = 1
        names = set(named(self.source.tree))
        outside = {x.lstrip("_") for x in names - self.source.stored}
        self.reserved = RESERVED | outside | set(self.lengths())
        self.taken = names | self.reserved

    def lengths(self) -> list[str]:
        """Names of the lengths that it is handed."""
        return lengths_of(self.arguments)

    def unknown(self, node: ast.AST, kind: ast.AST, instead: str = "") -> NoReturn:
        """Refuse syntax that the subset has not got."""
        name = type(kind).__name__
        self.refuse(node, f"{name} is not allowed", ADVICE.get(name, instead))

    def allow(self, node: ast.AST, *operators: ast.AST) -> None:
        """Refuse operators that the subset has not got."""
        for op in operators:
            if type(op) not in SIGNS:
                self.unknown(node, op)

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
        constant = self.file.stands_for(self.source, n.id)
        t = type_of_value(constant)
        if t is None:
            self.refuse(n, "a name that stands for no number or array", "an argument")
        known = int(constant) if t == "int" else None
        return Value(t, self.file.constant(self.source, n.id), known=known)
