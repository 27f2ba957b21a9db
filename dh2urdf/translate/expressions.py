"""Expressions as C."""

import ast
import math
from dataclasses import replace
from itertools import pairwise
from typing import Any

from dh2urdf.translate.definitions import number
from dh2urdf.translate.types import (
    Array,
    Fixed,
    Length,
    Record,
    Tuple,
    Type,
    told,
    type_of_value,
    wider,
)
from dh2urdf.translate.values import SIGNS, Binds, Names, Value, known_of, sized


class Expressions(Names):
    """Writes the expressions of one kernel, and before them the statements that they need.

    A method that has the name of a kind of nodes, as `_name`, writes them.
    """

    whole: tuple[Type, list[str]] = "a number", []
    """Where arrays stand for one element of them: what they have to be like, and its indices."""

    def value(self, n: ast.expr) -> Value:
        """An expression in C."""
        write = getattr(self, f"_{type(n).__name__.lower()}", None)
        if write is None:
            self.unknown(n, n, "numbers, names, indices, calls")
        found: Value = write(n)
        return found

    def base(self, n: ast.expr) -> Value:
        """An expression whose first length does not matter."""
        return self.named(n) if isinstance(n, ast.Name) else self.value(n)

    def number(self, n: ast.expr) -> Value:
        """An expression that has to be a number."""
        value, (like, indices) = self.base(n), self.whole
        t = value.type
        if isinstance(t, Array) and len(t.shape) == len(indices):
            text = value.at(Binds.POSTFIX) + "".join(f"[{e}]" for e in indices)
            return Value(t.at(len(indices)), text, Binds.POSTFIX)
        if not isinstance(t, str):
            self.refuse(n, f"{told(t)} where {told(like)} is needed", "a loop")
        return value

    def integer(self, n: ast.expr, where: str) -> Value:
        """An expression that has to be a whole number."""
        value = self.value(n)
        if value.type not in ("int", "bool"):
            self.refuse(n, f"{where} that is no whole number", "int(x)")
        return value

    def alone(self, n: ast.expr) -> Value:
        """An expression that needs no statement before it: it is not always evaluated."""
        before, value = len(self.lines), self.value(n)
        if len(self.lines) > before or value.maker:
            self.refuse(n, "what needs a statement before it", "an assignment before")
        return value

    def test(self, n: ast.expr, alone: bool = False) -> Value:
        """A condition; a number is true unless it is zero."""
        value = self.alone(n) if alone else self.value(n)
        if not isinstance(value.type, str):
            self.refuse(n, f"{told(value.type)} as a condition", "a comparison")
        return value

    def spread(self, elements: list[ast.expr]) -> list[tuple[str, Value]]:
        """Values one after the other, starred tuples taken apart; with the names of names."""
        found = list[tuple[str, Value]]()
        for n in elements:
            if isinstance(n, ast.Starred):
                found += [("", part) for part in self.parts(n.value, self.value(n.value))]
            else:
                found.append((n.id if isinstance(n, ast.Name) else "", self.base(n)))
        return found

    def parts(self, n: ast.expr, value: Value) -> tuple[Value, ...]:
        """The items of a tuple."""
        if not isinstance(value.type, Tuple):
            self.refuse(n, f"{told(value.type)} where a tuple is needed", "its items by index")
        if value.binds < Binds.ATOM and not value.parts:
            value = self.temporary(value, "got")
        return value.items()

    def text(self, value: Value) -> str:
        """The text of a value that may be a tuple of numbers, written out."""
        if not isinstance(value.type, Tuple) or not value.parts:
            return value.text
        return self.file.struct_of(value.type, [self.text(part) for part in value.parts])

    def helper(self, name: str, t: Type, *values: Value) -> Value:
        """A call of a small function of the file or of C."""
        arguments = ", ".join(value.text for value in values)
        return Value(t, f"{name}({arguments})", Binds.POSTFIX)

    def _constant(self, n: ast.expr, value: object = None) -> Value:
        value = n.value if isinstance(n, ast.Constant) else value
        t = type_of_value(value)
        if t is None and isinstance(value, int):
            self.refuse(n, "a whole number beyond 32 bits", "a float")
        if not isinstance(t, str):
            self.refuse(n, "a value that is no number", "numbers only")
        whole = isinstance(value, int) and t == "int"
        kept = whole or (self.file.folds and isinstance(value, float))
        text, known = number(value), value if kept and isinstance(value, int | float) else None
        return Value(t, text, Binds.PREFIX if text[0] == "-" else Binds.ATOM, known=known)

    def _name(self, n: ast.Name) -> Value:
        self.asked.add(n.id)
        return self.named(n)

    def _attribute(self, n: ast.Attribute) -> Value:
        if n.attr == "ndim":
            t = self.base(n.value).type
            return sized(len(t.shape) if isinstance(t, Array) else 0)
        if ast.unparse(n.value) != "math":
            self.refuse(n, "an attribute", "a name of the module, or one of math")
        return self._constant(n, self.source.stands_for(ast.unparse(n)))

    def length(self, n: ast.expr, index: Length) -> Value:
        """A length of an array; the first one of a parameter is asked for."""
        value = self.value(n) if index == 0 else self.base(n)
        shape = value.type.shape if isinstance(value.type, Array) else ()
        found = shape[index] if isinstance(index, int) and 0 <= index < len(shape) else None
        if found is None:
            self.refuse(n, "a length that is not known", "an argument for it")
        return sized(found)

    def _tuple(self, n: ast.Tuple) -> Value:
        parts = tuple(value for _, value in self.spread(n.elts))
        return Value(Tuple(tuple(part.type for part in parts)), parts=parts)

    def _unaryop(self, n: ast.UnaryOp) -> Value:
        if isinstance(n.op, ast.Not):
            test = self.test(n.operand)
            no = None if test.known is None else not test.known
            return Value("bool", f"!{test.at(Binds.PREFIX)}", Binds.PREFIX, known=no)
        value = self.number(n.operand)
        if value.type == "bool":
            self.refuse(n, "a sign before true or false", "not")
        text = SIGNS[type(n.op)][0] + value.at(Binds.POSTFIX)
        known = known_of(ast.Sub(), 0, value.known) if isinstance(n.op, ast.USub) else None
        if isinstance(value.known, float) and isinstance(n.op, ast.USub):
            known = -value.known  # of zero, too
        return Value(value.type, text, Binds.PREFIX, known=known)

    def _binop(self, n: ast.BinOp) -> Value:
        self.allow(n, n.op)
        return self.joined(n, n.op, self.number(n.left), self.number(n.right))

    def joined(self, n: ast.AST, op: ast.operator, left: Value, right: Value) -> Value:
        """Two numbers and an operator between them."""
        (sign, binds), t = SIGNS[type(op)], wider(left.type, right.type)
        floors, bits = binds == Binds.POSTFIX, binds < Binds.SUM
        if t == "float" and (floors or bits):
            self.refuse(n, "bits or floor division of floats", "int(x), or np.floor(x / y)")
        if floors:
            return self.helper(sign, "int", left, right)
        if bits:
            text = f"{left.at(Binds.PREFIX)} {sign} {right.at(Binds.PREFIX)}"
            return Value(t if t and binds < Binds.COMPARISON else "int", text, binds)
        if isinstance(op, ast.Div) and t != "float":
            left, t = Value("float", f"(double){left.at(Binds.PREFIX)}", Binds.PREFIX), "float"
        text = f"{left.at(binds)} {sign} {right.at(binds + 1)}"
        known = known_of(op, left.known, right.known)
        if self.file.folds and t == "int" and isinstance(known, int) and known >= 0:
            return sized(known)
        return Value("float" if t == "float" else "int", text, binds, known=known)

    def _boolop(self, n: ast.BoolOp) -> Value:
        sign, binds = SIGNS[type(n.op)]
        first, *rest = n.values
        tests = [self.test(first), *(self.test(x, alone=True) for x in rest)]
        ends = isinstance(n.op, ast.Or)  # what decides the whole if one test is so
        if any(t.known is not None and bool(t.known) is ends for t in tests):
            return Value("bool", str(ends).lower(), known=ends)
        tests = [t for t in tests if t.known is None] or [Value("bool", str(not ends).lower())]
        if len(tests) == 1:
            known = None if tests[0].words() - {"true", "false"} else not ends
            return replace(tests[0], type="bool", known=known)
        return Value("bool", f" {sign} ".join(t.at(Binds.OR + 2) for t in tests), binds)

    def _compare(self, n: ast.Compare) -> Value:
        middle = [x for term in n.comparators[:-1] for x in ast.walk(term)]
        if any(isinstance(x, ast.Call) and self.source.kernel(ast.unparse(x.func)) for x in middle):
            self.refuse(n, "a call that would be made twice", "an assignment before")
        self.allow(n, *n.ops)
        terms = [self.number(x) for x in (n.left, *n.comparators)]
        texts = pairwise(term.at(Binds.COMPARISON + 2) for term in terms)
        tests = [f"{a} {SIGNS[type(op)][0]} {b}" for op, (a, b) in zip(n.ops, texts, strict=True)]
        if len(tests) > 1:
            return Value("bool", " && ".join(tests), Binds.OR + 1)
        known = known_of(n.ops[0], terms[0].known, terms[1].known)
        return Value("bool", tests[0], Binds.COMPARISON, known=known)

    def _ifexp(self, n: ast.IfExp) -> Value:
        test = self.test(n.test)
        if test.known is not None:
            return self.value(n.body if test.known else n.orelse)
        return self._chosen(n, test, self.alone(n.body), self.alone(n.orelse))

    def _chosen(self, n: ast.IfExp, test: Value, a: Value, b: Value) -> Value:
        if a.parts or b.parts:
            if test.binds < Binds.ATOM:
                test = self.temporary(test, "chosen")
            pairs = zip(self.parts(n.body, a), self.parts(n.orelse, b), strict=True)
            parts = tuple(self._chosen(n, test, x, y) for x, y in pairs)
            return Value(Tuple(tuple(part.type for part in parts)), parts=parts)
        t = wider(a.type, b.type)
        if t is None:
            self.refuse(n, f"{told(a.type)} or {told(b.type)}", "if and else")
        text = f"{test.at(Binds.CHOICE + 1)} ? {a.at(Binds.CHOICE + 1)} : {b.at(Binds.CHOICE)}"
        return Value(t, text, Binds.CHOICE)

    def _subscript(self, n: ast.Subscript) -> Value:
        if isinstance(n.value, ast.Attribute) and n.value.attr == "shape":
            return self.length(n.value.value, self.value(n.slice).length)
        base = self.base(n.value)
        match base.type:
            case Tuple():
                k = self.value(n.slice).known
                if not isinstance(k, int) or not 0 <= k < len(base.type.items):
                    self.refuse(n, "item of a tuple by a variable", "a number")
                return base.items()[k]
            case Record():
                fields = base.type.fields()
                key = n.slice.value if isinstance(n.slice, ast.Constant) else ""
                if key not in fields:
                    self.refuse(n, "no field of the record", ", ".join(fields))
                return Value(fields[str(key)], f"{base.at(Binds.POSTFIX)}->{key}", Binds.POSTFIX)
            case Array():
                return self._element(n, base, base.type)
        self.refuse(n, f"an index into {told(base.type)}", "an array or a tuple")

    def _element(self, n: ast.Subscript, base: Value, t: Array) -> Value:
        """An element, or a part of an array."""
        indices = n.slice.elts if isinstance(n.slice, ast.Tuple) else [n.slice]
        if len(indices) > len(t.shape):
            self.refuse(n, f"too many indices into {told(t)}", "fewer")
        text, left = base.at(Binds.POSTFIX), t.at(len(indices))
        values: Any = t.fixed.values if t.fixed else None
        for k, (index, length) in enumerate(zip(indices, t.shape, strict=False)):
            if isinstance(index, ast.Slice):
                if k < len(indices) - 1:
                    self.refuse(n, "a slice before the last index", "a loop")
                return self._view(n, text, replace(t, shape=t.shape[k:], fixed=None), index)
            value = self.integer(index, "an index")
            known, end = value.known, length if isinstance(length, int) else math.inf
            if isinstance(known, int) and not 0 <= known < end:
                self.refuse(n, "an index outside the array", "one from 0 to its length less 1")
            values = values[known] if values is not None and isinstance(known, int) else None
            text = f"{text}[{self.place(value, length)}]"
        if isinstance(left, Record):
            return Value(left, f"&{text}", Binds.PREFIX)
        if values is not None and isinstance(left, Array):
            left = replace(left, fixed=Fixed(text, values))
        known = None if values is None or isinstance(left, Array) else values.item()
        return Value(left, text, Binds.POSTFIX, known=known)

    def place(self, index: Value, length: Length) -> str:
        """An index into so many, in C."""
        return index.text

    def _view(self, n: ast.Subscript, text: str, t: Array, s: ast.Slice) -> Value:
        """A view from ``lower`` to ``upper``, which must not lie before it nor beyond the end."""
        if s.step is not None:
            self.refuse(n, "a slice with a step", "a loop")
        start = self.integer(s.lower, "a slice") if s.lower else sized(0)
        low, high = start.length, t.shape[0]
        if s.upper:
            high = self.integer(s.upper, "a slice").length
        elif isinstance(n.value, ast.Name):
            self.asked.add(n.value.id)
        if any(isinstance(x, int) and x < 0 for x in (low, high)):
            self.refuse(n, "a slice that counts from the end", "its place from the start")
        length = high if low == 0 else None
        if isinstance(low, int) and isinstance(high, int):
            length = high - low
        match s.upper:
            case ast.BinOp(op=ast.Add()) if s.lower and ast.dump(s.upper.left) == ast.dump(s.lower):
                length = self.value(s.upper.right).length
        if s.lower is None:
            return Value(t.first(length), text, Binds.POSTFIX)
        return Value(t.first(length), f"{text} + {start.at(Binds.SUM)}", Binds.SUM)
