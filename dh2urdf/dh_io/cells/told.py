"""What is told of a table file from outside, for all that the file does not say itself."""

from collections.abc import Iterable
from typing import NamedTuple

from dh2urdf.dh import DHConvention
from dh2urdf.dh_io.cells.schema import CONVENTIONS, did_you_mean
from dh2urdf.dh_io.cells.units import UNIT_SIZES, Kind, unit_kind, unit_name
from dh2urdf.doors import found
from dh2urdf.exceptions import TableError


class Told(NamedTuple):
    """Convention and units of a file that is silent about them, and whose calibration one is.

    A file that says otherwise is at fault, unless it ``may_differ``.
    """

    convention: DHConvention | None = None
    length: str = ""
    angle: str = ""
    may_differ: bool = False
    model: str | None = None


NOTHING = Told()


def told(
    convention: DHConvention | str | None = None,
    units: Iterable[str] | str | None = None,
    *,
    may_differ: bool = False,
    model: str | None = None,
) -> Told:
    """Convention and units, such as ``"mm, deg"`` or ``("mm", "deg")``, in any spelling.

    Raises
    ------
    TableError
        No convention, or no units of lengths and angles.
    """
    chosen = None
    if convention is not None:
        word = convention.strip().casefold() if isinstance(convention, str) else ""
        if word not in CONVENTIONS:
            hint = did_you_mean(word, CONVENTIONS)
            allowed = f"allowed: {', '.join(DHConvention)}{hint and '; ' + hint}"
            raise TableError(f"convention: found {found(convention)}; {allowed}")
        chosen = CONVENTIONS[word]
    words = units.replace(",", " ").split() if isinstance(units, str) else units
    names = {Kind.LENGTH: "", Kind.ANGLE: ""}
    try:
        given = [unit_name(word) for word in words or ()]
    except (AttributeError, TypeError):
        given = [""]
    for unit in given:
        kind = unit_kind(unit)
        if kind is None or names[kind]:
            lengths, angles = (", ".join(UNIT_SIZES[kind]) for kind in names)
            expected = f'a length ({lengths}) and an angle ({angles}), as in "mm,deg"'
            raise TableError(f"units: found {found(units)}; expected {expected}")
        names[kind] = unit
    return Told(chosen, names[Kind.LENGTH], names[Kind.ANGLE], may_differ, model)
