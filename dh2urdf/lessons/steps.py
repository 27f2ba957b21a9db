"""What a worked solution is made of: steps with their equations, and what a picture would draw."""

import re
import textwrap
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from dh2urdf.grids import grid_matrix
from dh2urdf.lessons.notation import (
    LETTER,
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

WIDTH = 88
"""Columns of text."""


@dataclass(frozen=True, eq=False)
class Equation:
    """One equation: the formula, the numbers put in, the value.

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
        return with_numbers(self.via or self.formula, self.given) if told else ""

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
        lines = [self.formula.replace("+- ", "±"), self.numbers]
        lines += [] if np.ndim(self.value) == 2 else [self.found]
        indent = " " * len(self.name)
        if np.ndim(self.value) == 1 and self.numbers == vector_shown(np.asarray(self.value)):
            lines[1] = ""
        unlike = [line for k, line in enumerate(lines) if line and line not in lines[:k]]
        out = f"{self.name} = " + f"\n{indent} = ".join(unlike)
        return f"{out}\n{self.found}" if np.ndim(self.value) == 2 else out

    @property
    def latex(self) -> str:
        """The equation in LaTeX's mathematics, a sign of equality a line."""
        lines = [latex(self.formula)]
        if self.numbers:
            lines.append(latex(self.via or self.formula, self.given))
        lines.append(self._latex_found())
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


@dataclass(frozen=True, eq=False)
class Mark:
    """Something that a picture of a step draws, in the base frame.

    ``line``: points (k, 3), one after the other; ``arc``: centre, then points on it; ``frame``: a
    pose (4, 4); ``point``: (1, 3).
    """

    kind: Literal["line", "arc", "frame", "point"]
    points: Array
    label: str = ""


@dataclass(frozen=True, eq=False)
class Step:
    """One step of a worked solution.

    Parameters
    ----------
    title : str
    words : str
        What is done and why.
    equations : tuple of Equation
        The value of the last one is what the step is for.
    joint : int or None
        Index of the joint whose value q that is.
    marks : tuple of Mark
    choice : str
        ``shoulder``, ``elbow`` or ``wrist`` where one of two values was taken; else empty.
    """

    title: str
    words: str
    equations: tuple[Equation, ...] = ()
    joint: int | None = None
    marks: tuple[Mark, ...] = ()
    choice: str = ""

    @property
    def formula(self) -> str:
        """The last equation's formula; empty where there is none."""
        return self.equations[-1].formula if self.equations else ""

    @property
    def numbers(self) -> str:
        """The last equation with its numbers put in."""
        return self.equations[-1].numbers if self.equations else ""

    @property
    def value(self) -> float | Array | None:
        """What the step finds."""
        return self.equations[-1].value if self.equations else None

    def text(self, number: str = "") -> str:
        """The step in plain text, its title after a number."""
        title = number + self.title
        parts = [f"{title}\n{'-' * len(title)}\n{paragraphs(self.words)}"]
        parts += [textwrap.indent(e.text, "    ") for e in self.equations]
        return "\n\n".join(parts)

    __str__ = text

    def markdown(self, number: str = "") -> str:
        """The step in Markdown, formulas between dollar signs."""
        parts = [
            f"### {number}{markdown_words(self.title)}",
            *map(markdown_block, self.words.split("\n\n")),
        ]
        begin, end = "$$\n\\begin{aligned}\n", "\n\\end{aligned}\n$$"
        return "\n\n".join([*parts, *(f"{begin}{e.latex}{end}" for e in self.equations)])

    def latex(self, number: str = "") -> str:
        """The step as a LaTeX subsection."""
        title = latex_words(number + self.title)
        parts = [rf"\subsection*{{{title}}}", *map(latex_block, self.words.split("\n\n"))]
        begin, end = "\\begin{align*}\n", "\n\\end{align*}"
        return "\n".join([*parts, *(f"{begin}{e.latex}{end}" for e in self.equations)])

    def as_data(self) -> dict[str, Any]:
        """Plain values, full precision."""
        equations = [equation.as_data() for equation in self.equations]
        keys = "title", "words", "joint", "choice"
        return {key: getattr(self, key) for key in keys} | {"equations": equations}


@dataclass(frozen=True, eq=False)
class IKExplanation:
    """Inverse kinematics of one pose as a worked solution; ``print`` shows it.

    Attributes
    ----------
    robot, solver : str
        Names of the arm and of its solver.
    T : array, shape (4, 4)
        The pose.
    steps : tuple of Step
    q : array, shape (n,), or None
        The solution that the steps lead to; None where a step has none.
    solution : int or None
        Its place among the solutions that ``ik`` gives, from 0.
    branch : str
        Its name.
    """

    robot: str
    solver: str
    T: Array
    steps: tuple[Step, ...]
    q: Array | None
    solution: int | None = None
    branch: str = ""

    @property
    def heading(self) -> str:
        """What is solved, and how."""
        return f"Inverse kinematics of {self.robot}: {self.solver}"

    def __str__(self) -> str:
        rule = "=" * len(self.heading)
        return "\n\n".join([f"{self.heading}\n{rule}", *(s.text(i) for i, s in self._numbered())])

    @property
    def text(self) -> str:
        """The whole as plain text."""
        return str(self)

    @property
    def markdown(self) -> str:
        """The whole in Markdown, formulas between dollar signs."""
        steps = (step.markdown(i) for i, step in self._numbered())
        return "\n\n".join([f"## {self.heading}", *steps]) + "\n"

    @property
    def latex(self) -> str:
        """The whole as a LaTeX section; it needs amsmath."""
        head = rf"\section*{{{latex_words(self.heading)}}}"
        return "\n\n".join([head, *(step.latex(i) for i, step in self._numbered())]) + "\n"

    def _numbered(self) -> list[tuple[str, Step]]:
        return [(f"{i}. ", step) for i, step in enumerate(self.steps, 1)]

    def _repr_markdown_(self) -> str:
        return self.markdown

    def as_data(self) -> dict[str, Any]:
        """Plain values, full precision, metres and radians."""
        return {
            "robot": self.robot,
            "solver": self.solver,
            "solution": self.solution,
            "branch": self.branch,
            "q": self.q,
            "steps": [step.as_data() for step in self.steps],
        }


def paragraphs(words: str) -> str:
    """Words in lines; lines that are set out already (a table) stay as they are."""
    blocks = words.split("\n\n")
    return "\n\n".join(b if "\n" in b else textwrap.fill(b, WIDTH) for b in blocks)


def markdown_block(block: str) -> str:
    """A paragraph; lines that are set out already as they are."""
    return f"```text\n{block}\n```" if "\n" in block else markdown_words(block)


def markdown_words(words: str) -> str:
    """Plain words, letters of formulas as such, in which nothing is taken for emphasis."""
    return _with_letters(words, lambda text: re.sub(r"([*_|<])", r"\\\1", text))


def latex_block(block: str) -> str:
    """A paragraph; lines that are set out already as they are."""
    if "\n" in block:
        return f"\\begin{{verbatim}}\n{block}\n\\end{{verbatim}}"
    return latex_words(block) + "\n"


ESCAPES = {"\\": r"\textbackslash{}", "^": r"\textasciicircum{}", "~": r"\textasciitilde{}"}
ESCAPES |= {sign: f"\\{sign}" for sign in "&%$#_{}"}


def latex_words(words: str) -> str:
    """Plain words, letters of formulas as such, with what LaTeX would take for orders escaped."""
    words = re.sub(r"`(\w+)`", r"\1", words)
    return _with_letters(words, lambda text: "".join(ESCAPES.get(sign, sign) for sign in text))


def _with_letters(words: str, escaped: Callable[[str], str]) -> str:
    """Words with the letters of formulas between dollar signs, the rest escaped."""
    out, at = "", 0
    for match in LETTER.finditer(words):
        out += f"{escaped(words[at : match.start()])}${latex_name(match.group())}$"
        at = match.end()
    return out + escaped(words[at:])
