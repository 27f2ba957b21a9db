"""A function of one angle and its roots, as a line of text."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from dh2urdf.transforms import Array

BARS = "▁▂▃▄▅▆▇█"

COLUMNS = 72
"""Width of the plot in text."""


@dataclass(frozen=True, eq=False)
class Curve:
    """What an elimination leaves: a function of one angle, which vanishes at the solutions.

    Parameters
    ----------
    name : str
        The angle: ``theta_3``.
    values : array, shape (k,)
        The function in the middle of k equal parts of -180 to 180 degrees.
    roots : tuple of float
        Where it vanishes [rad].
    """

    name: str
    values: Array
    roots: tuple[float, ...]

    @property
    def levels(self) -> Array:
        """The function between -1 and 1, large values compressed so that small ones show."""
        scale = float(np.median(np.abs(self.values))) or 1.0
        level = np.arcsinh(self.values / scale)
        found: Array = level / max(float(np.abs(level).max()), 1e-300)
        return found

    @property
    def text(self) -> str:
        """One line of bars, zero in the middle of their height; the roots below."""
        level = self.levels.reshape(COLUMNS, -1).mean(axis=1)
        bars = "".join(BARS[min(int(4.0 * (v + 1.0)), 7)] for v in level)
        marks = [" "] * COLUMNS
        for root in self.roots:
            marks[min(int((root + math.pi) / math.tau * COLUMNS), COLUMNS - 1)] = "^"
        ends = "-180" + f"{self.name} [deg]".center(COLUMNS - 7) + "180"
        return "\n".join([bars, "".join(marks).rstrip(), ends])

    @property
    def latex(self) -> str:
        """The roots in words, since LaTeX sets no bars."""
        degrees = ", ".join(f"${math.degrees(x):.6g}^\\circ$" for x in self.roots)
        return f"Real roots: {degrees or 'none'}.\n"

    def as_data(self) -> dict[str, Any]:
        """Plain values."""
        return {"name": self.name, "values": self.values, "roots": list(self.roots)}
