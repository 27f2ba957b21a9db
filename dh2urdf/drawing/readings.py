"""Numbers as a reader wants them: in one unit, short, rounding noise as zero."""

import math
from typing import NamedTuple

from dh2urdf.dh_io import Kind, Units
from dh2urdf.dh_io.cells.units import decimal_text
from dh2urdf.grids import number

UNITS = Units("m", "deg")
"""Units unless others are chosen."""

TINY = 1e-9
"""Size [m, rad or plain] below which a number is noise of the arithmetic and is read as 0."""

LONG = 8
"""Characters of a number from which it is rounded."""

DIGITS = {"m": 6, "mm": 3, "deg": 3, "rad": 5, "": 4}
"""Digits after the point that are kept of a long number, by unit."""

MINUS = "\N{MINUS SIGN}"


class Reading(NamedTuple):
    """A number as shown, and all of its digits."""

    text: str
    exact: str

    @property
    def is_noise(self) -> bool:
        """True where what is shown as 0 is not quite."""
        return self.text == "0" != self.exact


def sign_of(units: Units, kind: Kind) -> str:
    """Sign of the unit of one kind: ``m``, ``mm``, ``°``, ``rad``."""
    unit = units.of(kind)
    return "°" if unit == "deg" else unit


def scale_of(units: Units, kind: Kind) -> float:
    """What one [m] or [rad] is in the unit."""
    return {"mm": 1000.0, "deg": 180.0 / math.pi}.get(units.of(kind), 1.0)


def reading(
    value: float, kind: Kind = Kind.NUMBER, units: Units = UNITS, digits: int | None = None
) -> Reading:
    """A number [m, rad or plain] in a unit; ``digits`` after the point, only where it is long."""
    unit = units.of(kind)
    exact = decimal_text(float(value), unit).replace("-", MINUS)
    if abs(value) < TINY:
        return Reading("0", exact)
    if len(exact) <= LONG and digits is None:
        return Reading(exact, exact)
    kept = DIGITS[unit] if digits is None else digits
    return Reading(number(round(float(value) * scale_of(units, kind), kept) + 0.0), exact)


def measured(value: float, kind: Kind, units: Units = UNITS) -> str:
    """A number with its unit: ``−50°``, ``0.1333 m``."""
    sign = sign_of(units, kind)
    gap = "" if sign == "°" else " "
    return f"{reading(value, kind, units).text}{gap}{sign}"
