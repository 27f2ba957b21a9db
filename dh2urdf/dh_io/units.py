"""Units of files: read as decimals and rounded once, so that nothing is lost either way.

``89.159 mm`` is exactly the float ``0.089159`` and ``90 deg`` exactly ``math.pi / 2``, because
a cell is converted from its decimal text with forty digits before it becomes a float.
"""

from __future__ import annotations

from decimal import Context, Decimal, DivisionByZero, InvalidOperation, Overflow
from enum import StrEnum
from typing import NamedTuple

__all__ = ["EXACT", "PI", "SI", "UNIT_SIZES", "Kind", "Units", "decimal_text"]

EXACT = Context(prec=50, traps=[DivisionByZero, InvalidOperation, Overflow])
"""Arithmetic of cells: fifty digits, so that one rounding remains, the one to a float."""

PI = Decimal("3.14159265358979323846264338327950288419716939937510")


class Kind(StrEnum):
    """What a cell measures."""

    NUMBER = "number"
    LENGTH = "length"
    ANGLE = "angle"


UNIT_SIZES: dict[Kind, dict[str, Decimal]] = {
    Kind.LENGTH: {
        "m": Decimal(1),
        "cm": Decimal("0.01"),
        "mm": Decimal("0.001"),
        "in": Decimal("0.0254"),
    },
    Kind.ANGLE: {"rad": Decimal(1), "deg": EXACT.divide(PI, Decimal(180))},
    Kind.NUMBER: {},
}
"""Size of each unit in [m] or [rad]."""

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
    for kind, sizes in UNIT_SIZES.items():
        if unit in sizes:
            return kind
    return None


def to_si(number: Decimal, unit: str) -> Decimal:
    """Decimal of some unit in [m] or [rad], fifty digits; plain numbers stay."""
    kind = unit_kind(unit)
    return EXACT.multiply(number, UNIT_SIZES[kind][unit]) if kind else number


def decimal_text(value: float, unit: str = "") -> str:
    """Shortest decimal, in the unit, that reads back as exactly this float.

    Parameters
    ----------
    value : float
        In [m], [rad] or, with no unit, plain.
    unit : str
    """
    kind = unit_kind(unit)
    if value == 0 or kind is None or UNIT_SIZES[kind][unit] == 1:
        return repr(value).removesuffix(".0")
    exact = EXACT.divide(Decimal(repr(value)), UNIT_SIZES[kind][unit])
    for digits in range(15, 25):
        short = Context(prec=digits).plus(exact).normalize(EXACT)
        if float(to_si(short, unit)) == value:
            break
    return f"{short:f}" if -7 < short.adjusted() < 16 else f"{short:e}"
