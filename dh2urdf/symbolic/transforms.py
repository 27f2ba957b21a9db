"""The transforms of a table in symbols: ``c_1``, ``s_12``, ``d_2 + 2``."""

import math
from typing import Any

from dh2urdf.dh import DHConvention, DHRow, DHTable, JointType
from dh2urdf.dh.motions import dh_matrix
from dh2urdf.dh.variables import terms
from dh2urdf.dh_io import TableLike, as_table
from dh2urdf.exceptions import MissingExtraError
from dh2urdf.grids import grid_matrix

__all__ = ["symbolic_product", "symbolic_text", "symbolic_transforms"]

SHORT = 3
"""Joints up to which the whole product is simplified; beyond, that takes minutes."""


def import_sympy(purpose: str = "transforms in symbols") -> Any:
    """Sympy; without it, an error that names the extra."""
    try:
        import sympy
    except ImportError:
        raise MissingExtraError("symbolic", purpose) from None
    return sympy


def exact_angle(value: float) -> Any:
    """An angle [rad], exact where it is a multiple of 15 degrees."""
    sp = import_sympy()
    turns = value / (math.pi / 12)
    if abs(turns - round(turns)) < 1e-12:
        return sp.Rational(round(turns), 12) * sp.pi
    return sp.Float(value, 17)


def exact_length(value: float) -> Any:
    """A length [m] as the rational number that its shortest decimal is."""
    sp = import_sympy()
    return sp.Rational(repr(value)) if value else sp.Integer(0)


def symbolic_transforms(table: TableLike) -> list[Any]:
    """``H_i^{i-1}`` for i = 1 ... n as sympy matrices, fixed rows folded in.

    In q_1 ... q_n, or in the fewer values by which joints move that follow others.
    """
    table, out = as_table(table), list[Any]()
    for row in table.rows:
        if row.is_joint:
            out.append(_row(row, _joint(table, len(out)), table.convention))
        elif out:
            out[-1] = out[-1] * _row(row, None, table.convention)
    return out


def _joint(table: DHTable, i: int) -> Any:
    """Joint i (from 0) in the values that move it."""
    sp = import_sympy()
    parts, constant = terms(table.joint_map, i)
    slides = table.joints[i].joint_type is JointType.PRISMATIC
    offset = exact_length(constant) if slides else exact_angle(constant)
    return sum((exact_length(f) * sp.Symbol(f"q_{k}") for f, k in parts), offset)


def _row(row: DHRow, joint: Any, convention: DHConvention) -> Any:
    sp = import_sympy()
    if row.origin is not None:
        roll, pitch, yaw = (exact_angle(v) for v in row.origin.rpy)
        R = sp.rot_ccw_axis3(yaw) * sp.rot_ccw_axis2(pitch) * sp.rot_ccw_axis1(roll)
        p = sp.Matrix([exact_length(v) for v in row.origin.xyz])
        return R.row_join(p).col_join(sp.Matrix([[0, 0, 0, 1]]))
    theta, d = exact_angle(row.theta), exact_length(row.d)
    if row.joint_type is JointType.REVOLUTE:
        theta += row.sign * joint
    elif row.joint_type is JointType.PRISMATIC:
        d += row.sign * joint
    a, alpha = exact_length(row.a), exact_angle(row.alpha)
    functions = sp.cos(theta), sp.sin(theta), sp.cos(alpha), sp.sin(alpha)
    return sp.Matrix(dh_matrix(*functions, d, a, convention))


def symbolic_product(table: TableLike) -> Any:
    """``H_n^0`` in symbols; angles about parallel axes are added (``c_12``)."""
    sp, table = import_sympy(), as_table(table)
    from sympy.simplify.fu import TR8  # products of sines and cosines as sums

    product, group = sp.eye(4), sp.eye(4)
    matrices = symbolic_transforms(table)
    for k, matrix in enumerate(matrices):
        group = (group * matrix).applyfunc(lambda e: TR8(sp.expand(e)))
        parallel = group[2, 2] ** 2 == 1
        if not parallel or k == len(matrices) - 1:
            product = product * group
            group = sp.eye(4)
    if table.n <= SHORT:
        return product.applyfunc(lambda e: sp.trigsimp(sp.expand(e)))
    return product.applyfunc(sp.expand)


def symbolic_text(matrix: Any) -> str:
    """A symbolic matrix in aligned columns, ``cos(q_1 + q_2)`` written ``c12``."""
    return grid_matrix([[_short(matrix[r, c]) for c in range(4)] for r in range(4)])


def _short(entry: Any) -> str:
    """The notes' abbreviations: c_i = cos q_i, s_i = sin q_i, c_ij = cos(q_i + q_j)."""
    sp = import_sympy()

    def name(letter: str, argument: Any) -> Any:
        terms = sp.Add.make_args(argument)
        if all(t.is_Symbol for t in terms):
            return sp.Symbol(letter + "".join(sorted(str(t).removeprefix("q_") for t in terms)))
        return (sp.cos if letter == "c" else sp.sin)(argument, evaluate=False)

    plain = entry.replace(sp.cos, lambda x: name("c", x)).replace(sp.sin, lambda x: name("s", x))
    decimal = plain.xreplace({r: sp.Float(r, 15) for r in plain.atoms(sp.Rational) if r.q > 1})
    text = sp.sstr(decimal, full_prec=False)
    return str(text).replace("*", "·").replace("··", "^").replace("-", "\N{MINUS SIGN}")
