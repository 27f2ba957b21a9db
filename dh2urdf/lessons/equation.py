"""One equation of a worked solution: the formula, the numbers put in, the value."""

import re
from dataclasses import dataclass
from typing import Any

import numpy as np

from dh2urdf.grids import grid_matrix
from dh2urdf.lessons.evaluated import turn_shown
from dh2urdf.lessons.notation import (
    Given,
    latex,
    latex_name,
    latex_number,
    measured,
    shown,
    tokens,
    vector_shown,
    with_numbers,
)
from dh2urdf.transforms import Array


@dataclass(frozen=True, eq=False)
class Equation:
    """One equation: the formula, the numbers put in, the value.

    An angle is given within half a turn of zero; where the numbers add up to more, the turn that
    is added or taken off stands behind them.

    Parameters
    ----------
    name : str
        What is found: ``theta_1``, ``o_c``, ``R_6^3``.
    formula : str
        In the letters of the notes, see :mod:`dh2urdf.lessons.notation`.
    given : mapping of str to float or array
        Numbers of the letters in the formula.
    value : float or array
        In metres, radians or plain; (3,) a vector, (3, 3) a rotation.
    unit : str
        ``m``, ``rad`` or empty.
    others : tuple of float
        Other values that satisfy it: the other sign of a square root.
    via : str
        The formula in letters that all have numbers, where its own have not: z_6 for R e_3.
    """

    name: str
    formula: str
    given: Given
    value: float | Array
    unit: str = ""
    others: tuple[float, ...] = ()
    via: str = ""

    @property
    def numbers(self) -> str:
        """The formula with its numbers put in; empty where that would show matrices."""
        letters = {t.text for t in tokens(self.via or self.formula)}
        matrices = any(np.ndim(v) == 2 for key, v in self.given.items() if key in letters)
        letters = letters if len(letters) > 1 else set()
        told = self.given and not matrices and letters & set(self.given)
        return with_numbers(self.via or self.formula, self.given) + self._turn if told else ""

    @property
    def _turn(self) -> str:
        """The turn between the numbers and the value: `` + 2π``; mostly empty."""
        if self.unit != "rad" or np.ndim(self.value):
            return ""
        values = float(self.value), *self.others
        return turn_shown(self.via or self.formula, self.given, values)

    @property
    def found(self) -> str:
        """The value with its unit, and the other values; a matrix over three lines."""
        if np.ndim(self.value) == 2:
            rows = [[shown(float(v)) for v in row] for row in np.asarray(self.value)]
            return grid_matrix(rows)
        if np.ndim(self.value) == 1:
            return f"{vector_shown(np.asarray(self.value))} {self.unit}".rstrip()
        values = float(self.value), *self.others
        return ", or ".join(measured(v, self.unit) for v in values)

    @property
    def text(self) -> str:
        """The equation in lines of text, equal signs below each other."""
        lines = [self.formula.replace(" +- ", " ± ").replace("+- ", "±"), self.numbers]
        indent = " " * len(self.name)
        if np.ndim(self.value) != 2:
            lines.append(self.found.replace(", or ", f",\n{indent}   or "))
        if np.ndim(self.value) == 1 and self.numbers == vector_shown(np.asarray(self.value)):
            lines[1] = ""
        lines[0] = "" if self.formula == self.name else lines[0]
        unlike = [line for k, line in enumerate(lines) if line and line not in lines[:k]]
        out = f"{self.name} = " + f"\n{indent} = ".join(unlike)
        return f"{out}\n{self.found}" if np.ndim(self.value) == 2 else out

    @property
    def latex(self) -> str:
        """The equation in LaTeX's mathematics, a sign of equality a line."""
        lines = [latex(self.formula)]
        if self.numbers:
            turn = self._turn.replace("(mod ", r"\ (\mathrm{mod}\ ").replace("π", r" \pi")
            lines.append(latex(self.via or self.formula, self.given) + turn)
        lines.append(self._latex_found())
        lines = lines[1:] if self.formula == self.name else lines
        unlike = [line for k, line in enumerate(lines) if line not in lines[:k]]
        return f"{latex_name(self.name)} &= " + " \\\\\n&= ".join(unlike)

    def _latex_found(self) -> str:
        if np.ndim(self.value) == 2:
            rows = [[shown(float(v)) for v in row] for row in np.asarray(self.value)]
            inside = r" \\ ".join(" & ".join(map(latex_number, row)) for row in rows)
            return rf"\begin{{bmatrix}} {inside} \end{{bmatrix}}"
        text = latex_number(self.found)
        for plain, spelt in ((", or ", r"\text{, or }"), (" rad", r"\,\mathrm{rad}")):
            text = text.replace(plain, spelt)
        text = re.sub(r" \((\S+) deg\)", r"\\ (\1^\\circ)", text)
        return text.replace(" m", r"\,\mathrm{m}")

    def as_data(self) -> dict[str, Any]:
        """Plain values, full precision."""
        keys = "name", "formula", "numbers", "latex", "value", "unit"
        return {key: getattr(self, key) for key in keys} | {"others": list(self.others)}
