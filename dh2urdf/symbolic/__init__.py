"""Transforms and inverse kinematics in symbols (``c_1``, ``s_12``, ``d_2``), with the extra sympy.

`transforms` are the matrices of a table and their product; `inverse` are the formulas of its
inverse kinematics: `letters` of a table, `families` of arms, `position`, `wrist` and `planar` their
parts, which are written down as steps (`formulas`) and printed (`written`).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from dh2urdf.dh_io import TableLike
from dh2urdf.symbolic.transforms import (
    import_sympy,
    symbolic_product,
    symbolic_text,
    symbolic_transforms,
)

if TYPE_CHECKING:
    from dh2urdf.symbolic.inverse import SymbolicIK

__all__ = ["symbolic_ik", "symbolic_product", "symbolic_text", "symbolic_transforms"]


def symbolic_ik(table: TableLike) -> SymbolicIK:
    """The inverse kinematics of an arm as formulas in the letters of its table.

    ``a_2``, ``d_4``, ``alpha_5`` are the table's, ``r_13`` and ``p_x`` the pose's. Every branch is
    a choice of signs. Of a pose that the arm can take all solutions are given, joint limits aside.

    Parameters
    ----------
    table : DHTable, path or name

    Returns
    -------
    SymbolicIK
        With ``text``, ``latex`` and ``python``, the last a function that needs nothing but
        ``math``; ``function`` is that one.

    Raises
    ------
    NoSolverError
        An arm without closed formulas; the message says which families have them.
    MissingExtraError
        sympy is not installed.
    """
    import_sympy("formulas")
    from dh2urdf.symbolic.inverse import formulas

    return formulas(table)
