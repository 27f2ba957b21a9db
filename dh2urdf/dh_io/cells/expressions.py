"""The arithmetic of a cell: numbers, units, pi, a few functions, constants, the joint's variable.

A grammar of its own, bounded in length, depth and exponent; nothing is ever evaluated by
Python::

    sum      = product (("+" | "-") product)*
    product  = signed (("*" | "/") signed)*
    signed   = ("+" | "-") signed | power
    power    = atom (("^" | "**") signed)?
    atom     = NUMBER UNIT? | NUMBER "pi" | "pi" | function "(" sum ("," sum)* ")"
             | NAME | "(" sum ")"

Two rules settle what a number means. **A bare number is in the file's unit**; a number with a
unit (``90deg``, ``100mm``) is what it says. **pi is half a turn**, whatever the file's unit:
in a file in degrees ``pi/2`` is 90 and ``pi/2 - 10`` is 80. (In a length or plain number pi is
3.14159...) Lengths and angles do not mix.
"""

import math
import re
from collections.abc import Callable
from dataclasses import replace
from decimal import Decimal, DecimalException

from dh2urdf.bounds import CELL_CHARACTERS, CELL_DEPTH
from dh2urdf.dh_io.cells.units import EXACT, PI, SI, Kind, Units, to_si, unit_kind, unit_name
from dh2urdf.dh_io.cells.values import (
    FUNCTIONS,
    NOUNS,
    ExpressionError,
    Value,
    call,
    failure,
    over,
    power,
    scale,
    times,
)

PI_NAMES = ("pi", "PI", "Pi", "π")

_TOKEN = re.compile(
    r"\s*(?:(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)"
    r"|(?P<name>[^\W\d]\w*|°|º)|(?P<mark>\*\*|[-+*/^(),]))"
)
_NOT_FINITE = re.compile(r"[-+]?\.?(nan|inf|infinity)", re.IGNORECASE)


Lookup = Callable[[str], Value]


def _no_names(name: str) -> Value:
    raise ExpressionError(f"{name!r} is not a number")


def parse_cell(text: str, kind: Kind | str = Kind.NUMBER, units: Units = SI) -> float:
    """Value of a number or expression without variables, a float in [m], [rad] or plain.

    ``"-90"``, ``"pi/2"``, ``"90deg"``, ``"100 mm"``; bare numbers are in ``units``. A `TableError`
    says why it is no finite number.
    """
    if _NOT_FINITE.fullmatch(text.strip()):
        raise ExpressionError("not a finite number")
    return to_float(evaluate(text, Kind(kind), units, _no_names).number)


def to_float(number: Decimal) -> float:
    """Nearest float, which has to be finite."""
    value = float(number)
    if not math.isfinite(value):
        raise ExpressionError("the number is too large")
    return value


def evaluate(text: str, kind: Kind, units: Units, lookup: Lookup, *, free: bool = False) -> Value:
    """Value of a cell of some kind; ``lookup`` gives that of a name, or an `ExpressionError`.

    Where it is ``free`` it may be of any kind, and a bare number stays bare (``constants:``).
    """
    if len(text) > CELL_CHARACTERS:
        raise ExpressionError(f"the cell has {len(text)} characters; at most {CELL_CHARACTERS}")
    if _NOT_FINITE.fullmatch(text.strip()):
        raise ExpressionError("not a finite number", "leave an unknown cell out")
    parser = _Parser(_tokens(plain_text(text)), Kind.ANGLE if free else kind, units, lookup)
    try:
        value = parser.whole()
        return value if free else parser.convert(value, kind)
    except DecimalException as error:
        raise ExpressionError(failure(error)) from None


_LATEX = (
    (re.compile(r"\\[()\[\]]"), " "),
    (re.compile(r"\^\s*(?:\{\s*)?(?:\*|\\ast)(?:\s*\})?"), "*"),
    (re.compile(r"\\[dt]?frac\s*\{([^{}]*)\}\s*\{([^{}]*)\}"), r"((\1)/(\2))"),
    (re.compile(r"\^\s*(?:\\circ\b|\{\s*(?:\\circ|o|°)\s*\}|o\b)"), "deg"),
    (re.compile(r"\\ell(?![a-zA-Z])"), " l"),
    (re.compile(r"\\(theta|pi|alpha|cdot|times)(?![a-zA-Z])"), r" \1"),
    (re.compile(r"_\{(\w+)\}"), r"_\1"),
    (re.compile(r"\\[,;! ]|\$"), " "),
)
_TYPED = str.maketrans(
    {
        **dict.fromkeys("−–‐‑‒—－", "-"),
        **dict.fromkeys("×·⋅∗∙", "*"),
        **dict.fromkeys("÷∕⁄", "/"),
        **dict.fromkeys("˚∘", "°"),
        **dict(zip("₀₁₂₃₄₅₆₇₈₉ᵢⱼ", "0123456789ij", strict=True)),
        **{"½": "0.5", "¼": "0.25", "¾": "0.75"},
    }
)


def plain_text(text: str) -> str:
    """Strip an expression of typeset signs: ``θ_3 + 90^{o}`` is ``θ_3 + 90deg``."""
    text = text.translate(_TYPED)
    if "\\" in text or "$" in text or "^" in text or "{" in text:
        for pattern, plain in _LATEX:
            text = pattern.sub(plain, text)
        text = re.sub(r" (?:cdot|times)\b", "*", text)
    return text.strip()


def _tokens(text: str) -> list[tuple[str, str]]:
    out, at = [], 0
    while at < len(text):
        match = _TOKEN.match(text, at)
        if match is None:
            raise ExpressionError(f"{text[at:].strip()[0]!r} has no place in a number")
        out.append((str(match.lastgroup), match[str(match.lastgroup)]))
        at = match.end()
    if len(out) > 1 and out[-1] == ("mark", "*") and out[-2][0] == "name":
        out.pop()  # theta1*: textbooks mark the variable by a star
    return out


def _with_point(before: str, after: str) -> str:
    """A number parted by a comma as it is written here: ``1.025,5`` and ``1,025.5`` are 1025.5."""
    if "." in before:
        return f"{before.replace('.', '')}.{after}"
    return f"{before}{after}" if "." in after else f"{before}.{after}"


class _Parser:
    """Recursive descent over the tokens of one cell."""

    def __init__(
        self, tokens: list[tuple[str, str]], kind: Kind, units: Units, lookup: Lookup
    ) -> None:
        self.tokens, self.kind, self.units, self.lookup = tokens, kind, units, lookup
        self.at = self.depth = 0

    def peek(self) -> tuple[str, str]:
        return self.tokens[self.at] if self.at < len(self.tokens) else ("end", "")

    def accept(self, *marks: str) -> str:
        kind, text = self.peek()
        if kind == "mark" and text in marks:
            self.at += 1
            return text
        return ""

    def whole(self) -> Value:
        value = self.sum()
        if self.at < len(self.tokens):
            _, text = self.peek()
            hint = "write * between factors" if text not in (")", ",") else ""
            if text == "," and len(self.tokens) == 3:
                hint = f"a decimal point: {_with_point(self.tokens[0][1], self.tokens[2][1])}"
            raise ExpressionError(f"{text!r} is not expected here", hint)
        return value

    def sum(self) -> Value:
        value = self.product()
        while sign := self.accept("+", "-"):
            other = self.product()
            value = self.add(value, other if sign == "+" else scale(other, Decimal(-1)))
        return value

    def product(self) -> Value:
        value = self.signed()
        while sign := self.accept("*", "/"):
            other = self.signed()
            value = times(value, other) if sign == "*" else over(value, other)
        return value

    def signed(self) -> Value:
        self.depth += 1
        if self.depth > CELL_DEPTH:
            raise ExpressionError(f"nested deeper than {CELL_DEPTH} levels")
        if sign := self.accept("+", "-"):
            value = self.signed()
            value = value if sign == "+" else scale(value, Decimal(-1))
        else:
            value = self.atom()
            if self.accept("^", "**"):
                value = power(value, self.signed())
        self.depth -= 1
        return value

    def atom(self) -> Value:
        kind, text = self.peek()
        self.at += 1
        if kind == "number":
            return self.number(Decimal(text))
        if kind == "name":
            if self.accept("("):
                return self.function(text)
            if text in PI_NAMES:
                return self.pi(Decimal(1))
            return self.lookup(text)
        if text == "(":
            value = self.sum()
            if not self.accept(")"):
                raise ExpressionError("a bracket is not closed")
            return value
        raise ExpressionError(f"unexpected {text!r}" if text else "the expression is not complete")

    def number(self, number: Decimal) -> Value:
        """Literal with the unit or the pi that follows it."""
        kind, text = self.peek()
        unit = unit_name(text)
        measured = unit_kind(unit)
        if kind != "name" or (measured is None and text not in PI_NAMES):
            return Value(number)
        self.at += 1
        return Value(to_si(number, unit), measured) if measured else self.pi(number)

    def pi(self, factor: Decimal) -> Value:
        kind = Kind.ANGLE if self.kind is Kind.ANGLE else Kind.NUMBER
        return Value(EXACT.multiply(PI, factor), kind)

    def function(self, name: str) -> Value:
        if name not in FUNCTIONS:
            known = ", ".join(FUNCTIONS)
            raise ExpressionError(f"{name}() is not a function here", f"one of {known}")
        outer, trigonometric = self.kind, name in ("sin", "cos", "tan")
        self.kind = Kind.ANGLE if trigonometric else outer
        values = [self.sum()]
        while self.accept(","):
            values.append(self.sum())
        if not self.accept(")"):
            raise ExpressionError("a bracket is not closed")
        if trigonometric:
            values = [self.convert(v, Kind.ANGLE) for v in values]
        self.kind = outer
        return call(name, values)

    def add(self, x: Value, y: Value) -> Value:
        """Sum; a bare number takes the unit of its partner's kind."""
        if x.kind is not y.kind:
            kind = y.kind if x.kind is Kind.NUMBER else x.kind
            x, y = self.convert(x, kind), self.convert(y, kind)
        if x.variable and y.variable and x.variable != y.variable:
            raise ExpressionError("more than one joint variable")
        number, coefficient = EXACT.add(x.number, y.number), EXACT.add(x.coefficient, y.coefficient)
        return Value(number, x.kind, x.variable or y.variable, coefficient)

    def convert(self, value: Value, kind: Kind) -> Value:
        """Value as the kind asked for; bare numbers are in the file's unit."""
        if value.kind is kind:
            return value
        if value.kind is Kind.NUMBER:
            return replace(value, number=to_si(value.number, self.units.of(kind)), kind=kind)
        raise ExpressionError(f"{NOUNS[value.kind]} where {NOUNS[kind]} is expected")
