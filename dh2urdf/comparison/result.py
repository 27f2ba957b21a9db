"""What a comparison of two arms found, in numbers and in words."""

import math
from collections.abc import Iterable
from dataclasses import dataclass

from dh2urdf.comparison.cells import Difference
from dh2urdf.comparison.mistakes import Mistake
from dh2urdf.dh import Origin
from dh2urdf.dh.print import step
from dh2urdf.dh.variables import plus
from dh2urdf.grids import number

DIGITS = 9
"""Digits behind the point of what is told of base, tool and zeros, in [m] and degrees."""


@dataclass(frozen=True)
class Comparison:
    """Whether two arms are the same, up to what, and where not.

    For all q, ``T_A(q) = base T_B(directions * q + offsets) tool``: with the found base, tool,
    offsets and directions where the arms are the same or nearly so; these are None otherwise.

    Parameters
    ----------
    a, b : str
        Names of the arms.
    same : bool
        True of arms that are the same up to ``up_to``.
    up_to : tuple of str
        What has to be changed in B to make it A, in words; empty for arms that agree as they are.
    base, tool : Origin or None
        The base frame of B in that of A, and the tool of A in that of B.
    offsets : tuple of float or None
        Zeros of the joints of B [rad or m].
    directions : tuple of int or None
        -1 for joints of B that move the other way.
    max_error : float
        Largest difference [m and rad] that is left over ``configurations`` configurations; of
        arms of other joints infinite.
    mistakes : tuple of Mistake
        What B reads as if it was meant to be A; several where they come to the same.
    differences : tuple of Difference
        Cells that differ, each with what it does to the tool.
    tolerance : float
        [m and rad]
    warnings : tuple of str
        What looked odd about the files.
    """

    a: str
    b: str
    same: bool
    up_to: tuple[str, ...]
    base: Origin | None
    tool: Origin | None
    offsets: tuple[float, ...] | None
    directions: tuple[int, ...] | None
    max_error: float
    mistakes: tuple[Mistake, ...]
    differences: tuple[Difference, ...]
    configurations: int
    tolerance: float
    warnings: tuple[str, ...] = ()

    @property
    def equal(self) -> bool:
        """True of arms that agree for every q as they are, up to nothing."""
        return self.same and not self.up_to

    def __str__(self) -> str:
        return self.told()

    def told(self, *, exact: bool = False) -> str:
        """In words; ``exact`` asks for the same base, tool, zeros and directions, too."""
        lines = [f"{self.a} and {self.b}: {self._verdict(exact=exact)}"]
        lines += [f"  {text}" for text in self.up_to]
        lines += [f"  {difference}" for difference in self.differences]
        if self.mistakes:
            texts = dict.fromkeys(mistake.text for mistake in self.mistakes)
            lead = "taken as they stand, " if self.same else ""
            lines.append(f"  {lead}B reads as A with a mistake: {self._joint().join(texts)}")
        return "\n".join(lines)

    def _joint(self) -> str:
        """Mistakes that share the rows that differ were all made; others come to the same."""
        rows = sorted(row for mistake in self.mistakes for row in mistake.rows)
        return " and " if rows == sorted({d.row or 0 for d in self.differences}) else " or "

    def _verdict(self, *, exact: bool) -> str:
        error = f"{self.max_error:.2g} m or rad"
        if self.base is None:
            apart = "" if math.isinf(self.max_error) else f", up to {error} apart as they stand"
            return f"different arms{apart}"
        up_to = ", up to" if self.up_to else ""
        if self.same:
            if exact and self.up_to:
                return "different with --exact, the same arm only up to"
            over = f"(largest difference {error} over {self.configurations} configurations)"
            return f"the same arm {over}{up_to}"
        enough = number(_above(self.max_error), minus="-")
        return f"nearly the same arm ({error} apart; --tolerance {enough} takes it for one){up_to}"


def _above(error: float) -> float:
    """One digit that is not below an error."""
    digit = 10.0 ** math.floor(math.log10(error))
    return float(f"{math.ceil(error / digit) * digit:.1g}")


def in_words(
    prismatic: Iterable[bool],
    tolerance: float,
    base: Origin,
    tool: Origin,
    offsets: tuple[float, ...],
    directions: tuple[int, ...],
) -> tuple[str, ...]:
    """What a relation changes by more than the tolerance, a line each."""
    lines = []
    if not _none(base, tolerance):
        lines.append(f"base: that of B stands at {step(_rounded(base))} in that of A")
    if not _none(tool, tolerance):
        lines.append(f"tool: that of A stands at {step(_rounded(tool))} in that of B")
    for i, (x, sign, slides) in enumerate(zip(offsets, directions, prismatic, strict=True), 1):
        what = [w for w, said in (("direction", sign < 0), ("zero", abs(x) > tolerance)) if said]
        if not what:
            continue
        value = round(x if slides else math.degrees(x), DIGITS)
        zero = plus("", number(value)) + (" m" if slides else "°") if "zero" in what else ""
        minus = "\N{MINUS SIGN}" if sign < 0 else ""
        lines.append(f"{' and '.join(what)} of joint {i}: q{i} of B = {minus}q{i} of A{zero}")
    return tuple(lines)


def _none(origin: Origin, tolerance: float) -> bool:
    return max(map(abs, (*origin.xyz, *origin.rpy))) <= tolerance


def _rounded(origin: Origin) -> Origin:
    """Few digits for people, exact multiples of a degree kept."""
    x, y, z = (round(v, DIGITS) + 0.0 for v in origin.xyz)
    r, p, w = (math.radians(round(math.degrees(v), DIGITS)) + 0.0 for v in origin.rpy)
    return Origin((x, y, z), (r, p, w))
