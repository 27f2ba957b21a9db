"""Values of cells and what may be done with them: plain numbers, lengths and angles.

A value is linear in at most one joint variable, and lengths and angles keep apart: a sum takes
two of a kind, a product one that is plain.
"""

import math
from dataclasses import dataclass, replace
from decimal import Decimal, DecimalException, Overflow

from dh2urdf.bounds import EXPONENT
from dh2urdf.dh_io.cells.units import EXACT, Kind
from dh2urdf.exceptions import TableError

FUNCTIONS = ("sqrt", "sin", "cos", "tan", "asin", "acos", "atan", "atan2", "hypot", "abs")

NOUNS = {Kind.ANGLE: "an angle", Kind.LENGTH: "a length", Kind.NUMBER: "a plain number"}


class ExpressionError(TableError):
    """A cell that is no number; ``hint`` says what to write instead."""

    def __init__(self, message: str, hint: str = "") -> None:
        self.hint = hint
        super().__init__(message)

    def __reduce__(self) -> "tuple[type[ExpressionError], tuple[str, str]]":  # type: ignore[override]
        """Pickle by message and hint."""
        return type(self), (str(self), self.hint)


@dataclass(frozen=True, slots=True)
class Value:
    """``number + coefficient * variable``, in [m], [rad] or plain as ``kind`` says."""

    number: Decimal
    kind: Kind = Kind.NUMBER
    variable: str = ""
    coefficient: Decimal = Decimal(0)


def scale(x: Value, factor: Decimal) -> Value:
    """Value times a plain number."""
    number = x.number.copy_negate() if factor == -1 else EXACT.multiply(x.number, factor)
    return replace(x, number=number, coefficient=EXACT.multiply(x.coefficient, factor))


def times(x: Value, y: Value) -> Value:
    """Product of two values, one of them plain."""
    if y.kind is Kind.NUMBER and not y.variable:
        return scale(x, y.number)
    if x.kind is Kind.NUMBER and not x.variable:
        return scale(y, x.number)
    raise ExpressionError(f"{NOUNS[x.kind]} times {NOUNS[y.kind]} is neither a length nor an angle")


def over(x: Value, y: Value) -> Value:
    """Quotient by a plain number."""
    if y.kind is not Kind.NUMBER or y.variable:
        raise ExpressionError("a division is by a plain number only")
    if y.number == 0:
        raise ExpressionError("division by zero")
    number, coefficient = (EXACT.divide(v, y.number) for v in (x.number, x.coefficient))
    return replace(x, number=number, coefficient=coefficient)


def power(x: Value, y: Value) -> Value:
    """Power of plain numbers with a small exponent."""
    if any(v.kind is not Kind.NUMBER or v.variable for v in (x, y)):
        raise ExpressionError("a power takes plain numbers only")
    if abs(y.number) > EXPONENT:
        raise ExpressionError(f"an exponent of at most {EXPONENT} is allowed")
    if x.number == 0 and y.number < 0:
        raise ExpressionError("division by zero")
    return Value(EXACT.power(x.number, y.number))


def call(name: str, values: list[Value]) -> Value:
    """Value of a function; lengths and angles pass through where that makes sense."""
    wanted = 2 if name in ("atan2", "hypot") else 1
    if len(values) != wanted:
        plural = "s" * (wanted > 1)
        raise ExpressionError(f"{name}() takes {wanted} value{plural}, got {len(values)}")
    if any(v.variable for v in values):
        raise ExpressionError("a joint variable enters with the factor +1 or -1 only")
    first, kinds = values[0], {v.kind for v in values}
    if name == "abs":
        return replace(first, number=EXACT.abs(first.number))
    if len(kinds) > 1:
        raise ExpressionError(f"{name}() takes two values of one kind")
    if name not in ("sin", "cos", "tan", "atan2", "hypot") and first.kind is not Kind.NUMBER:
        raise ExpressionError(f"{name}() takes a plain number")
    if name == "sqrt":
        return Value(EXACT.sqrt(first.number))
    try:
        result = getattr(math, name)(*(float(v.number) for v in values))
    except ValueError:
        raise ExpressionError(f"{name}() has no value there") from None
    kind = {"hypot": first.kind, "sin": Kind.NUMBER, "cos": Kind.NUMBER, "tan": Kind.NUMBER}
    return Value(Decimal(repr(result)), kind.get(name, Kind.ANGLE))


def failure(error: DecimalException) -> str:
    """Reason for which decimals failed."""
    return "the number is too large" if isinstance(error, Overflow) else "has no real value"
