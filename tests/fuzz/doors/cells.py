"""Expressions of a cell."""

import math
from pathlib import Path

from hostile import outcome

from dh2urdf.dh_io import Units, parse_cell
from dh2urdf.exceptions import TableError
from tests.fuzz.door import Door


def compute(data: bytes, _: Path) -> None:
    """A text is a finite number of every kind and unit, or refused."""
    text = data.decode("utf-8", "surrogateescape")
    for kind in ("length", "angle", "number"):
        for units in (Units("m", "rad"), Units("in", "deg")):
            found = outcome(parse_cell, text, kind, units)
            assert isinstance(found, TableError) or math.isfinite(found)


DOORS = [Door("cells", compute, ("cells",))]
