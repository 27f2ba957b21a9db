"""The inverse kinematics of an arm as formulas in the letters of its table."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from dh2urdf.dh import DHTable
from dh2urdf.dh_io import TableLike, as_table
from dh2urdf.symbolic.families import Derivation, derive
from dh2urdf.symbolic.letters import letters_of
from dh2urdf.symbolic.written import as_latex, as_markdown, as_python, as_text

Solve = Callable[[Sequence[Sequence[float]]], list[list[float]]]


@dataclass(frozen=True)
class SymbolicIK:
    """Formulas for all joint values that reach a pose.

    Parameters
    ----------
    table : DHTable
        Whose letters they are in.
    derivation : Derivation
        Their steps, with sympy expressions.
    """

    table: DHTable
    derivation: Derivation = field(repr=False)

    @property
    def family(self) -> str:
        """What lets the equations come apart."""
        return self.derivation.family

    @cached_property
    def text(self) -> str:
        """The formulas to read."""
        return as_text(self.derivation)

    @cached_property
    def latex(self) -> str:
        """The formulas for a document with the package amsmath."""
        return as_latex(self.derivation)

    @cached_property
    def markdown(self) -> str:
        """The formulas for a page with MathJax."""
        return as_markdown(self.derivation)

    @cached_property
    def python(self) -> str:
        """A module of one function ``ik(T)`` that needs nothing but ``math``."""
        return as_python(self.derivation)

    @cached_property
    def function(self) -> Solve:
        """That function: a pose (4, 4), row by row, to a list of configurations [rad and m]."""
        space: dict[str, Any] = {}
        exec(compile(self.python, "<symbolic ik>", "exec"), space)
        solve: Solve = space["ik"]
        return solve

    def __str__(self) -> str:
        return self.text

    def _repr_markdown_(self) -> str:
        return self.markdown


def formulas(table: TableLike) -> SymbolicIK:
    """The formulas of a table, see :func:`dh2urdf.symbolic.symbolic_ik`."""
    table = as_table(table)
    return SymbolicIK(table, derive(letters_of(table)))
