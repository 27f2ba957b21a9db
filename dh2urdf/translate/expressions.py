"""Expressions as C."""

import ast
from dataclasses import replace

from dh2urdf.translate.types import Array, Record, Tuple, Type, told, type_of_value, wider
from dh2urdf.translate.values import (
    AND,
    ATOM,
    CHOICE,
    COMPARISON,
    OR,
    POSTFIX,
    PREFIX,
    PRODUCT,
    SUM,
    Names,
    Value,
    sized,
)

BINARY: dict[type[ast.operator], tuple[str, int]] = {
    ast.Add: ("+", SUM),
    ast.Sub: ("-", SUM),
    ast.Mult: ("*", PRODUCT),
    ast.Div: ("/", PRODUCT),
    ast.LShift: ("<<", 11),
    ast.RShift: (">>", 11),
    ast.BitAnd: ("&", 8),
    ast.BitXor: ("^", 7),
    ast.BitOr: ("|", 6),
}
BITS = (ast.BitAnd, ast.BitOr, ast.BitXor, ast.LShift, ast.RShift)
FLOORED: dict[type[ast.operator], str] = {ast.FloorDiv: "floor_div", ast.Mod: "floor_mod"}
COMPARE: dict[type[ast.cmpop], str] = {
    ast.Lt: "<",
    ast.LtE: "<=",
    ast.Gt: ">",
    ast.GtE: ">=",
    ast.Eq: "==",
    ast.NotEq: "!=",
}


class Expressions(Names):
    """Writes the expressions of one kernel, and before them the statements that they need."""

    def value(self, n: ast.expr) -> Value:
        """An expression in C."""
        match n:
            case ast.Constant():
                return self.literal(n, n.value)
            case ast.Name():
                self.instance.asked.add(n.id)
                return self._named(n)
            case ast.Attribute():
                return self._attribute(n)
            case ast.Tuple():
                parts = tuple(value for _, value in self.spread(n.elts))
                return Value(Tuple(tuple(part.type for part in parts)), parts=parts)
            case ast.UnaryOp():
                return self._signed(n)
            case ast.BinOp():
                return self._binary(n, n.op, self.number(n.left), self.number(n.right))
            case ast.BoolOp():
                sign, binds = ("&&", AND) if isinstance(n.op, ast.And) else ("||", OR)
                first, *rest = n.values
                tests = [self.test(first), *(self.test(x, alone=True) for x in rest)]
                return Value("bool", f" {sign} ".join(t.at(OR + 2) for t in tests), binds)
            case ast.Compare():
                return self._compare(n)
            case ast.IfExp():
                return self._choice(n)
            case ast.Subscript():
                return self._subscript(n)
            case ast.Call():
                return self.call(n)
        self.refuse(n, f"{type(n).__name__} is not allowed", "numbers, names, indices and calls")

    def call(self, n: ast.Call) -> Value:
        """A call."""
        raise NotImplementedError

    def base(self, n: ast.expr) -> Value:
        """An expression whose first length does not matter."""
        return self._named(n) if isinstance(n, ast.Name) else self.value(n)

    def number(self, n: ast.expr) -> Value:
        """An expression that has to be a number."""
        value = self.value(n)
        if not isinstance(value.type, str):
            self.refuse(n, f"{told(value.type)} where a number is needed", "a loop")
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
        if value.parts:
            return value.parts
        if value.binds < ATOM:
            value = self.temporary(value, "got")
        return _fields(value)

    def text(self, value: Value) -> str:
        """The text of a value that may be a tuple of numbers, written out."""
        if not isinstance(value.type, Tuple) or not value.parts:
            return value.text
        parts = ", ".join(self.text(part) for part in value.parts)
        return f"({self.file.tuple_name(value.type)}){{{parts}}}"

    def _named(self, n: ast.Name) -> Value:
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

    def _attribute(self, n: ast.Attribute) -> Value:
        size, constant = self.size(n), self.source.stands_for(ast.unparse(n))
        if size is not None:
            return sized(size)
        if ast.unparse(n.value) != "math" or not isinstance(constant, float):
            self.refuse(n, "an attribute", "a name of the module, or one of math")
        return self.literal(n, constant)

    def _signed(self, n: ast.UnaryOp) -> Value:
        if isinstance(n.op, ast.Not):
            return Value("bool", f"!{self.test(n.operand).at(PREFIX)}", PREFIX)
        value = self.number(n.operand)
        if value.type == "bool":
            self.refuse(n, "a sign before true or false", "not")
        sign = "-" if isinstance(n.op, ast.USub) else "~" if isinstance(n.op, ast.Invert) else "+"
        return replace(value, text=sign + value.at(POSTFIX), binds=PREFIX)

    def _binary(self, n: ast.AST, op: ast.operator, left: Value, right: Value) -> Value:
        kind, t = type(op), wider(left.type, right.type) or "int"
        whole = "float" not in (left.type, right.type)
        if kind in FLOORED:
            if not whole:
                self.refuse(n, "floor division of floats", "np.floor(x / y)")
            return self.helper(FLOORED[kind], "int", left, right)
        if kind not in BINARY:
            self.refuse(n, f"{kind.__name__} is not allowed", "+, -, *, /, //, % or bits")
        sign, binds = BINARY[kind]
        if kind in BITS:
            if not whole:
                self.refuse(n, "bits of a float", "int(x)")
            t = t if kind not in (ast.LShift, ast.RShift) else "int"
            return Value(t, f"{left.at(PREFIX)} {sign} {right.at(PREFIX)}", binds)
        if kind is ast.Div and whole:
            left = Value("float", f"(double){left.at(PREFIX)}", PREFIX)
        t = "float" if kind is ast.Div else wider(t, "int") or t
        return Value(t, f"{left.at(binds)} {sign} {right.at(binds + 1)}", binds)

    def _compare(self, n: ast.Compare) -> Value:
        terms = [self.number(n.left), *(self.number(x) for x in n.comparators)]
        for x in n.comparators[:-1]:
            if any(
                isinstance(y, ast.Call) and self.source.kernel(ast.unparse(y.func))
                for y in ast.walk(x)
            ):
                self.refuse(x, "a call that would be made twice", "an assignment before")
        signs = [COMPARE[type(op)] for op in n.ops]
        tests = [
            f"{a.at(COMPARISON + 2)} {sign} {b.at(COMPARISON + 2)}"
            for a, sign, b in zip(terms[:-1], signs, terms[1:], strict=True)
        ]
        return Value("bool", " && ".join(tests), COMPARISON if len(tests) == 1 else AND)

    def _choice(self, n: ast.IfExp) -> Value:
        known = self.decided(n.test)
        if known is not None:
            return self.value(n.body if known else n.orelse)
        test = self.test(n.test)
        return self._chosen(n, test, self.alone(n.body), self.alone(n.orelse))

    def _chosen(self, n: ast.IfExp, test: Value, a: Value, b: Value) -> Value:
        if isinstance(a.type, Tuple) and isinstance(b.type, Tuple) and (a.parts or b.parts):
            if test.binds < ATOM:
                test = self.temporary(test, "chosen")
            pairs = zip(self.parts(n.body, a), self.parts(n.orelse, b), strict=True)
            parts = tuple(self._chosen(n, test, x, y) for x, y in pairs)
            return Value(Tuple(tuple(part.type for part in parts)), parts=parts)
        t = wider(a.type, b.type)
        if t is None:
            self.refuse(n, f"{told(a.type)} or {told(b.type)}", "if and else")
        text = f"{test.at(CHOICE + 1)} ? {a.at(CHOICE + 1)} : {b.at(CHOICE)}"
        return Value(t, text, CHOICE)

    def _subscript(self, n: ast.Subscript) -> Value:
        if isinstance(n.value, ast.Attribute) and n.value.attr == "shape":
            length = self.size(n)
            if length is None:
                self.refuse(n, "a length that is not known", "an argument for it")
            return sized(length)
        base = self.base(n.value)
        if isinstance(base.type, Tuple):
            k = self.size(n.slice)
            if not isinstance(k, int) or not 0 <= k < len(base.type.items):
                self.refuse(n, "item of a tuple by a variable", "a number")
            return (base.parts or _fields(base))[k]
        if isinstance(base.type, Record):
            key = n.slice.value if isinstance(n.slice, ast.Constant) else ""
            if key not in base.type.fields():
                self.refuse(n, "no field of the record", ", ".join(base.type.fields()))
            return Value(base.type.fields()[str(key)], f"{base.at(POSTFIX)}->{key}", POSTFIX)
        if not isinstance(base.type, Array):
            self.refuse(n, f"an index into {told(base.type)}", "an array or a tuple")
        index = n.slice.elts if isinstance(n.slice, ast.Tuple) else [n.slice]
        if len(index) > len(base.type.shape):
            self.refuse(n, f"too many indices into {told(base.type)}", "fewer")
        return self._item(n, base, base.type, index)

    def _item(self, n: ast.Subscript, base: Value, t: Array, index: list[ast.expr]) -> Value:
        *lead, last = index
        text = base.at(POSTFIX)
        for x, length in zip(lead, t.shape, strict=False):
            text += f"[{self._index(x, length)}]"
        if isinstance(last, ast.Slice):
            return self._slice(n, text, t.at(len(lead)), last)
        text += f"[{self._index(last, t.shape[len(lead)])}]"
        if isinstance(t.at(len(index)), Record):
            return Value(t.at(len(index)), f"&{text}", PREFIX)
        return Value(t.at(len(index)), text, POSTFIX)

    def _index(self, n: ast.expr, length: int | str | None) -> str:
        if isinstance(n, ast.Slice):
            self.refuse(n, "a slice before the last index", "a loop")
        value, k = self.value(n), self.size(n)
        if value.type not in ("int", "bool"):
            self.refuse(n, "an index that is no whole number", "int(x)")
        if isinstance(k, int) and not 0 <= k < (length if isinstance(length, int) else k + 1):
            self.refuse(n, "an index outside the array", "one from 0 to its length less 1")
        return value.text

    def _slice(self, n: ast.Subscript, text: str, t: Type, s: ast.Slice) -> Value:
        """A view from ``lower`` to ``upper``, which must not lie before it nor beyond the end."""
        assert isinstance(t, Array)
        if s.step is not None:
            self.refuse(n, "a slice with a step", "a loop")
        ends = [x for x in (s.lower, s.upper) if x is not None]
        if any(self.number(x).type != "int" for x in ends):
            self.refuse(n, "a slice by what is no whole number", "int(x)")
        low = 0 if s.lower is None else self.size(s.lower)
        high = t.shape[0] if s.upper is None else self.size(s.upper)
        if any(isinstance(x, int) and x < 0 for x in (low, high)):
            self.refuse(n, "a slice that counts from the end", "its place from the start")
        if s.upper is None and isinstance(n.value, ast.Name):
            self.instance.asked.add(n.value.id)
        length = high if low == 0 else None
        if isinstance(low, int) and isinstance(high, int):
            length = high - low
        match s.upper:
            case ast.BinOp(op=ast.Add()) if s.lower and ast.dump(s.upper.left) == ast.dump(s.lower):
                length = self.size(s.upper.right)
        if s.lower is None:
            return Value(t.first(length), text, POSTFIX)
        return Value(t.first(length), f"{text} + {self.value(s.lower).at(SUM)}", SUM)

    def helper(self, name: str, t: str, *values: Value) -> Value:
        """A call of one of the file's small functions."""
        arguments = ", ".join(value.text for value in values)
        return Value(t, f"{self.file.helper(name)}({arguments})", POSTFIX)


def _fields(value: Value) -> tuple[Value, ...]:
    assert isinstance(value.type, Tuple)
    items = enumerate(value.type.items)
    return tuple(Value(t, f"{value.at(POSTFIX)}.f{k}", POSTFIX) for k, t in items)
