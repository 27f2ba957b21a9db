"""What a worked solution is made of: steps with their equations, and what a picture would draw."""

import textwrap
from dataclasses import dataclass
from typing import Any

from dh2urdf.lessons.curve import Curve
from dh2urdf.lessons.equation import Equation
from dh2urdf.lessons.marks import Mark
from dh2urdf.lessons.wording import (
    latex_block,
    latex_words,
    markdown_block,
    markdown_words,
    paragraphs,
)
from dh2urdf.transforms import Array

__all__ = ["Equation", "IKExplanation", "Mark", "Step"]


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
    curve : Curve or None
        A function whose roots are the values that the step finds.
    choice : str
        ``shoulder``, ``elbow`` or ``wrist`` where one of two values was taken; else empty.
    """

    title: str
    words: str
    equations: tuple[Equation, ...] = ()
    joint: int | None = None
    marks: tuple[Mark, ...] = ()
    choice: str = ""
    curve: Curve | None = None

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
        lines = [textwrap.indent(e.text, "    ") for e in self.equations]
        for line, before in zip(lines, ["\n", *lines], strict=False):
            short = "\n" not in line and "\n" not in before
            parts[-1:] = [f"{parts[-1]}\n{line}"] if short else [parts[-1], line]
        if self.curve:
            parts[1:1] = [textwrap.indent(self.curve.text, "    ")]
        return "\n\n".join(parts)

    __str__ = text

    def markdown(self, number: str = "") -> str:
        """The step in Markdown, formulas between dollar signs."""
        parts = [
            f"### {number}{markdown_words(self.title)}",
            *map(markdown_block, self.words.split("\n\n")),
        ]
        parts += [f"```text\n{self.curve.text}\n```"] if self.curve else []
        begin, end = "$$\n\\begin{aligned}\n", "\n\\end{aligned}\n$$"
        return "\n\n".join([*parts, *(f"{begin}{e.latex}{end}" for e in self.equations)])

    def latex(self, number: str = "") -> str:
        """The step as a LaTeX subsection."""
        title = latex_words(number + self.title)
        parts = [rf"\subsection*{{{title}}}", *map(latex_block, self.words.split("\n\n"))]
        parts += [self.curve.latex] if self.curve else []
        begin, end = "\\begin{align*}\n", "\n\\end{align*}"
        return "\n".join([*parts, *(f"{begin}{e.latex}{end}" for e in self.equations)])

    def as_data(self) -> dict[str, Any]:
        """Plain values, full precision."""
        equations = [equation.as_data() for equation in self.equations]
        keys = "title", "words", "joint", "choice"
        curve = {"curve": self.curve.as_data()} if self.curve else {}
        return {key: getattr(self, key) for key in keys} | {"equations": equations} | curve


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
