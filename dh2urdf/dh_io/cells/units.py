"""Units of files: read as decimals and rounded once, so that nothing is lost either way.

``89.159 mm`` is exactly the float ``0.089159`` and ``90 deg`` exactly ``math.pi / 2``, because
a cell is converted from its decimal text with a hundred digits before it becomes a float.
"""

from decimal import Context, Decimal, DivisionByZero, InvalidOperation, Overflow
from enum import StrEnum
from typing import NamedTuple

EXACT = Context(prec=100, traps=[DivisionByZero, InvalidOperation, Overflow])
"""Arithmetic of cells: a hundred digits, so that one rounding remains, the one to a float."""

PI = Decimal("3.14159265358979323846264338327950288419716939937510")


class Kind(StrEnum):
    """What a cell measures."""

    NUMBER = "number"
    LENGTH = "length"
    ANGLE = "angle"


ONE = Decimal(1)

UNIT_SIZES: dict[Kind, dict[str, tuple[Decimal, Decimal]]] = {
    Kind.LENGTH: {
        "m": (ONE, ONE),
        "cm": (ONE, Decimal(100)),
        "mm": (ONE, Decimal(1000)),
        "in": (Decimal(254), Decimal(10_000)),
    },
    Kind.ANGLE: {"rad": (ONE, ONE), "deg": (PI, Decimal(180))},
    Kind.NUMBER: {},
}
"""Size of each unit in [m] or [rad], as a quotient: 30 deg is then pi/6 to the last digit."""

UNIT_ALIASES = {
    **dict.fromkeys(("meter", "meters", "metre", "metres"), "m"),
    **dict.fromkeys(("centimeter", "centimeters", "centimetre", "centimetres"), "cm"),
    **dict.fromkeys(("millimeter", "millimeters", "millimetre", "millimetres"), "mm"),
    **dict.fromkeys(("inch", "inches"), "in"),
    **dict.fromkeys(("degree", "degrees", "°", "º"), "deg"),
    **dict.fromkeys(("radian", "radians"), "rad"),
}


class Units(NamedTuple):
    """Unit of bare numbers: of lengths, and of angles."""

    length: str = "m"
    angle: str = "rad"

    def of(self, kind: Kind) -> str:
        """Name of the unit of one kind, empty for plain numbers."""
        return {Kind.LENGTH: self.length, Kind.ANGLE: self.angle}.get(kind, "")


SI = Units()


def unit_name(text: str) -> str:
    """Short name of a unit in any of its spellings; the text itself where it is none."""
    clean = text.strip().casefold()
    return UNIT_ALIASES.get(clean, clean)


def unit_kind(unit: str) -> Kind | None:
    """Kind that a unit measures, None where it is none."""
    return next((kind for kind, sizes in UNIT_SIZES.items() if unit in sizes), None)


def to_si(number: Decimal, unit: str) -> Decimal:
    """Decimal of some unit in [m] or [rad]; plain numbers stay."""
    kind = unit_kind(unit)
    if kind is None:
        return number
    numerator, denominator = UNIT_SIZES[kind][unit]
    return EXACT.divide(EXACT.multiply(number, numerator), denominator)


def decimal_text(value: float, unit: str = "", digits: int | None = None) -> str:
    """Shortest decimal, in the unit, that reads back as exactly this float in [m] or [rad].

    With ``digits`` it is rounded to so many decimals instead.
    """
    kind = unit_kind(unit)
    numerator, denominator = UNIT_SIZES[kind][unit] if kind else (ONE, ONE)
    if value == 0:
        return "0"
    if numerator == denominator and digits is None:
        return repr(value).removesuffix(".0")
    exact = EXACT.divide(EXACT.multiply(Decimal(repr(value)), denominator), numerator)
    if digits is not None:
        rounded = EXACT.normalize(EXACT.quantize(exact, Decimal(1).scaleb(-digits)))
        return f"{rounded:f}" if rounded else "0"
    for precision in range(15, 25):
        short = Context(prec=precision).plus(exact).normalize(EXACT)
        if float(to_si(short, unit)) == value:
            break
    return f"{short:f}" if -5 < short.adjusted() < 16 else f"{short:e}"
