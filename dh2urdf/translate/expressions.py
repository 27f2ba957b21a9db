"""Expressions as C, each with how tightly it binds."""

import ast
import math
from typing import TYPE_CHECKING

from dh2urdf.translate.c_text import number
from dh2urdf.translate.inference import C_FUNCTIONS, INTEGERS, Instance
from dh2urdf.translate.source import MAKERS
from dh2urdf.translate.types import Array, Kernel, Record, Tuple, Type, is_sized_late

if TYPE_CHECKING:
    from dh2urdf.translate.c_file import CFile

BINARY: dict[type[ast.operator], tuple[str, int]] = {
    ast.Add: ("+", 12),
    ast.Sub: ("-", 12),
    ast.Mult: ("*", 13),
    ast.Div: ("/", 13),
    ast.LShift: ("<<", 11),
    ast.RShift: (">>", 11),
    ast.BitAnd: ("&", 8),
    ast.BitXor: ("^", 7),
    ast.BitOr: ("|", 6),
}
COMPARE: dict[type[ast.cmpop], str] = {
    ast.Lt: "<",
    ast.LtE: "<=",
    ast.Gt: ">",
    ast.GtE: ">=",
    ast.Eq: "==",
    ast.NotEq: "!=",
}
BITS = (ast.BitAnd, ast.BitOr, ast.BitXor, ast.LShift, ast.RShift)
UNARY = {ast.USub: "-", ast.Not: "!", ast.Invert: "~", ast.UAdd: "+"}
ATOM, POSTFIX, PREFIX = 16, 15, 14


class Expressions:
    """Writes the expressions of one instance."""

    def __init__(self, file: "CFile", instance: Instance) -> None:
        self.file, self.instance = file, instance
        self.taken = set(instance.types)
        self.element = ""
        """Indices of the element, while a whole array is assigned."""
        self.pending: list[str] = []
        """Declarations that have to come before the statement."""

    def name(self, name: str) -> str:
        """A name of the kernel in C."""
        return self.file.local(self.instance, name)

    def fresh(self, name: str) -> str:
        """A name that is not taken."""
        k, candidate = 2, name
        while candidate in self.taken:
            candidate, k = f"{name}{k}", k + 1
        self.taken.add(candidate)
        return candidate

    def value(self, n: ast.expr, want: Type = None, level: int = 0) -> str:
        """An expression, in brackets where it binds less than ``level``."""
        text, binds = self._expression(n, want)
        return f"({text})" if binds < level else text

    def type_of(self, n: ast.expr) -> Type:
        """The type that was inferred."""
        return self.instance.types_of[n]

    def _expression(self, n: ast.expr, want: Type) -> tuple[str, int]:
        match n:
            case ast.Constant():
                whole = want == "float" and type(n.value) is int
                return number(n.value) + (".0" if whole else ""), ATOM
            case ast.Name():
                own = n.id in self.instance.types
                text = self.name(n.id) if own else self.file.constant(self.instance.source, n)
                whole = self.element and isinstance(self.type_of(n), Array)
                return text + (self.element if whole else ""), ATOM
            case ast.Attribute():
                known = self.instance.whole(n)
                return number(getattr(math, n.attr) if known is None else known), ATOM
            case ast.UnaryOp():
                plain = isinstance(n.operand, ast.Name | ast.Subscript | ast.Constant | ast.Call)
                sign = UNARY[type(n.op)]
                level = PREFIX if plain or sign != "-" else POSTFIX
                return sign + self.value(n.operand, None, level), PREFIX
            case ast.BinOp():
                return self._binary(n)
            case ast.BoolOp():
                sign, binds = ("&&", 5) if isinstance(n.op, ast.And) else ("||", 4)
                return f" {sign} ".join(self.value(x, None, 6) for x in n.values), binds
            case ast.Compare():
                return self._compare(n)
            case ast.IfExp():
                t = want if isinstance(want, Tuple) else self.type_of(n)
                test = self.value(n.test, None, 4)
                return f"{test} ? {self.value(n.body, t, 4)} : {self.value(n.orelse, t, 4)}", 3
            case ast.Tuple():
                struct = want or self.type_of(n)
                assert isinstance(struct, Tuple)
                parts = [self.value(x, w) for x, w in zip(n.elts, struct.items, strict=True)]
                return f"({self.file.tuple_name(struct)}){{{', '.join(parts)}}}", POSTFIX
            case ast.Subscript():
                text, binds = self._subscript(n)
                if not (self.element and isinstance(self.type_of(n), Array)):
                    return text, binds
                return (text if binds >= POSTFIX else f"({text})") + self.element, POSTFIX
        assert isinstance(n, ast.Call)
        return self._call(n)

    def _binary(self, n: ast.BinOp) -> tuple[str, int]:
        kind = type(n.op)
        if isinstance(self.type_of(n), Tuple):
            return self._chained(n)
        if kind in (ast.FloorDiv, ast.Mod):
            helper = self.file.helper("floor_div" if kind is ast.FloorDiv else "floor_mod")
            return f"{helper}({self.value(n.left)}, {self.value(n.right)})", POSTFIX
        sign, binds = BINARY[kind]
        loose = issubclass(kind, BITS)
        left = self.value(n.left, None, PREFIX if loose else binds)
        right = self.value(n.right, None, PREFIX if loose else binds + 1)
        if kind is ast.Div and "float" not in (self.type_of(n.left), self.type_of(n.right)):
            left = f"(double){self.value(n.left, None, PREFIX)}"
        return f"{left} {sign} {right}", binds

    def _chained(self, n: ast.BinOp) -> tuple[str, int]:
        """Two tuples as one."""
        parts = []
        for side in (n.left, n.right):
            t, text = self.type_of(side), self.value(side)
            assert isinstance(t, Tuple)
            if not isinstance(side, ast.Name):
                keep = self.fresh("part")
                self.pending.append(f"const {self.file.declaration(t, keep)} = {text};")
                text = keep
            parts += [self.part(text, i, x) for i, x in enumerate(t.items)]
        t = self.type_of(n)
        assert isinstance(t, Tuple)
        return f"({self.file.tuple_name(t)}){{{', '.join(parts)}}}", POSTFIX

    def _compare(self, n: ast.Compare) -> tuple[str, int]:
        parts, left = [], n.left
        for op, right in zip(n.ops, n.comparators, strict=True):
            if isinstance(op, ast.In | ast.NotIn):
                assert isinstance(right, ast.Tuple)
                x = self.value(left, None, 10)
                inside = " || ".join(f"{x} == {self.value(y, None, 10)}" for y in right.elts)
                return (f"!({inside})", PREFIX) if isinstance(op, ast.NotIn) else (inside, 4)
            sign = COMPARE[type(op)]
            parts.append(f"{self.value(left, None, 11)} {sign} {self.value(right, None, 11)}")
            left = right
        return " && ".join(parts), 5 if len(parts) > 1 else 9

    def _subscript(self, n: ast.Subscript) -> tuple[str, int]:
        keep, self.element = self.element, ""
        found = self._item(n)
        self.element = keep
        return found

    def _item(self, n: ast.Subscript) -> tuple[str, int]:
        length = self.instance.length(n)
        if isinstance(n.value, ast.Attribute) and n.value.attr == "shape":
            if length is None:
                self.instance.refuse(n, "a length that is not known")
            return str(length), ATOM
        t = self.type_of(n.value)
        if isinstance(t, Tuple):
            k = self.instance.whole(n.slice)
            assert k is not None
            if isinstance(n.value, ast.Name) and n.value.id not in self.instance.types:
                return number(self.instance.source.stands_for(n.value)[k]), PREFIX
            return self.part(self.value(n.value, None, POSTFIX), k, t.items[k]), POSTFIX
        base = self.value(n.value, None, POSTFIX)
        if isinstance(t, Record):
            assert isinstance(n.slice, ast.Constant)
            return f"{base}->{n.slice.value}", POSTFIX
        index = n.slice.elts if isinstance(n.slice, ast.Tuple) else [n.slice]
        last = index[-1]
        if isinstance(last, ast.Slice):
            base += "".join(f"[{self.value(x)}]" for x in index[:-1])
            if last.lower is None:
                return base, POSTFIX
            return f"{base} + {self.value(last.lower, None, 12)}", 12
        text = base + "".join(f"[{self.value(x)}]" for x in index)
        return (f"&{text}", PREFIX) if isinstance(self.type_of(n), Record) else (text, POSTFIX)

    def _call(self, n: ast.Call) -> tuple[str, int]:
        name, file = ast.unparse(n.func), self.file
        if name in MAKERS:
            made = self.fresh("array")
            self.pending += self.storage(n, made)
            return made, ATOM
        if name == "abs":
            c = "fabs" if self.type_of(n.args[0]) == "float" else file.helper("size_int")
            return f"{c}({self.value(n.args[0])})", POSTFIX
        if name in ("max", "min"):
            ending = "" if self.type_of(n) == "float" else "_int"
            c = file.helper(("larger" if name == "max" else "smaller") + ending)
            text = self.value(n.args[0])
            for a in n.args[1:]:
                text = f"{c}({text}, {self.value(a)})"
            return text, POSTFIX
        if name in INTEGERS:
            return self._integer(n, name)
        if name in C_FUNCTIONS:
            text = f"{C_FUNCTIONS[name]}({', '.join(self.value(a) for a in n.args)})"
            return (f"(int){text}", PREFIX) if self.type_of(n) == "int" else (text, POSTFIX)
        instance = self.instance.called[n]
        handed: list[str] = []
        for a in n.args:
            if isinstance(a, ast.Starred):
                base, t = self.value(a.value, None, POSTFIX), self.type_of(a.value)
                assert isinstance(t, Tuple)
                handed += [self.part(base, i, x) for i, x in enumerate(t.items)]
            else:
                t = instance.arguments[len(handed)]
                handed.append("" if isinstance(t, Kernel) else self.value(a, t))
        lengths = self._lengths(n, instance)
        return f"{instance.name}({', '.join([*lengths, *(h for h in handed if h)])})", POSTFIX

    def part(self, base: str, k: int, t: Type) -> str:
        """An item of a tuple; an array sized late has lost its type there."""
        if not is_sized_late(t):
            return f"{base}.f{k}"
        return f"(({self.file.declaration(t, '')}){base}.f{k})"

    def storage(self, made: ast.Call, name: str) -> list[str]:
        """Declaration of an array that a kernel makes."""
        t = self.type_of(made)
        assert isinstance(t, Array)
        declared = self.file.declaration(t, name, storage=True)
        if ast.unparse(made.func) == "np.full":
            filled = self.value(made.args[1])
            flat = f"(&{name}{'[0]' * len(t.shape)})[e]"
            count = " * ".join(str(d) for d in t.shape)
            return [f"{declared};", f"for (int e = 0; e < {count}; e++) {{ {flat} = {filled}; }}"]
        if ast.unparse(made.func) != "np.zeros":
            return [f"{declared};"]
        if all(isinstance(d, int) for d in t.shape):
            return [f"{declared} = {{0}};"]
        return [f"{declared};", f"memset({name}, 0, sizeof {name});"]

    def _lengths(self, n: ast.Call, instance: Instance) -> list[str]:
        """Lengths that a callee is handed: the caller has them by the same names."""
        missing = set(instance.lengths()) - set(self.instance.lengths())
        if missing:
            self.instance.refuse(n, f"the length {missing} is not known here")
        return instance.lengths()

    def _integer(self, n: ast.Call, name: str) -> tuple[str, int]:
        if name == "len":
            length = self.instance.length(n)
            if length is None:
                self.instance.refuse(n, "a length that is not known")
            return str(length), ATOM
        x = n.args[0]
        if self.type_of(x) == "float":
            return f"(int){self.value(x, None, PREFIX)}", PREFIX
        return self._expression(x, None)
