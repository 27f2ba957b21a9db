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
    return Value("int", text, ATOM if re.fullmatch(r"\w+|\(.*\)", text) else SUM)


class Names:
    """The names of one kernel, and the whole numbers that are known before it runs."""

    def __init__(self, file: Definitions, instance: Instance) -> None:
        self.file, self.instance, self.source = file, instance, instance.source
        self.values: dict[str, Value] = {}
        """What names stand for that have been given a value so far."""
        self.known: dict[str, Length] = {}
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
        if n.id in self.known:
            return sized(self.known[n.id])
        if n.id in self.values:
            return self.values[n.id]
        if n.id in self.source.stored:
            self.refuse(n, "a name before its value", "the assignment above it")
        t = type_of_value(self.source.stands_for(n.id))
        if t is None:
            self.refuse(n, "a name that stands for no number or array", "an argument")
        return Value(t, self.file.constant(self.source, n.id))

    def base(self, n: ast.expr) -> Value:
        """An expression whose first length does not matter."""
        raise NotImplementedError

    def size(self, n: ast.expr) -> Length:
        """A whole number that is known before the kernel runs, or in terms of its lengths."""
        match n:
            case ast.Constant(value=int(value)) if not isinstance(value, bool):
                return value
            case ast.Name() if n.id in self.source.stored:
                return self.known.get(n.id)
            case ast.Name():
                constant = self.source.stands_for(n.id)
                return int(constant) if type_of_value(constant) == "int" else None
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                return self._sum(ast.Constant(0), ast.Sub(), operand)
            case ast.BinOp():
                return self._sum(n.left, n.op, n.right)
            case ast.Attribute(attr="ndim"):
                t = self.base(n.value).type
                return len(t.shape) if isinstance(t, Array) else None
            case ast.Subscript(value=ast.Attribute(attr="shape", value=array)):
                index = self.size(n.slice)
                return self._length(array, index) if isinstance(index, int) else None
            case ast.Call(func=ast.Name(id="len"), args=[array]):
                return self._length(array, 0)
        return None

    def _sum(self, left: ast.expr, op: ast.operator, right: ast.expr) -> Length:
        signs = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.FloorDiv: "//"}
        sign, a, b = signs.get(type(op)), self.size(left), self.size(right)
        if sign is None or a is None or b is None:
            return None
        if isinstance(a, int) and isinstance(b, int):
            return int(eval(f"{a} {sign} {b}"))
        return None if sign == "//" else f"({a} {sign} {b})"

    def _length(self, n: ast.expr, index: int) -> Length:
        """A length of a named array or tuple; that of a parameter is asked for."""
        if not isinstance(n, ast.Name | ast.Subscript):
            return None
        if index == 0 and isinstance(n, ast.Name):
            self.instance.asked.add(n.id)
        t = self.base(n).type
        if isinstance(t, Tuple):
            return len(t.items)
        return t.shape[index] if isinstance(t, Array) and 0 <= index < len(t.shape) else None

    def decided(self, test: ast.expr) -> bool | None:
        """What a comparison of whole numbers says that are known before the kernel runs."""
        if isinstance(test, ast.Compare):
            a, b = self.size(test.left), self.size(test.comparators[0])
            if isinstance(a, int) and isinstance(b, int) and len(test.ops) == 1:
                return bool(
                    eval(ast.unparse(ast.Compare(ast.Constant(a), test.ops, [ast.Constant(b)])))
                )
        return None
