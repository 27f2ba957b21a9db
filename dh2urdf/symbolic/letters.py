"""A table in letters: ``a_2``, ``d_4``, ``alpha_5``; what is zero or a right angle is no letter.

Both conventions share the chain ``Rz(theta_i) Tz(d_i) Tx(a_i) Rx(alpha_i)``: a modified table has
``a_{i-1}`` and ``alpha_{i-1}`` in row i, so the letters between two joints are the same.
"""

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import sympy as sp

from dh2urdf.dh import DHConvention, DHRow, DHTable, JointType, dh_transform
from dh2urdf.exceptions import NoSolverError
from dh2urdf.transforms import Array, inverse

SMALL = 1e-12
"""Lengths [m] and angles [rad] from zero or from right angles that are rounding."""


@dataclass(frozen=True)
class Link:
    """A joint and the link after it, in letters.

    ``c``, ``s`` are the functions of theta; ``d`` is the unknown of a slide. ``way`` is -1 where
    the arm is seen from its tool, so that the joint turns the other way.
    """

    label: str
    slides: bool
    c: Any
    s: Any
    d: Any
    a: Any
    ca: Any
    sa: Any
    way: int = 1

    def offset(self, v: tuple[Any, Any, Any]) -> tuple[Any, Any, Any]:
        """``Tz(d) Tx(a) Rx(alpha) v``."""
        x, y, z = v
        return x + self.a, self.ca * y - self.sa * z, self.sa * y + self.ca * z + self.d

    def turned(self, v: tuple[Any, Any, Any]) -> tuple[Any, Any, Any]:
        """``Rz(theta) v``."""
        x, y, z = v
        return self.c * x - self.s * y, self.s * x + self.c * y, z

    def back(self, v: tuple[Any, Any, Any]) -> tuple[Any, Any, Any]:
        """``Rz(-theta) v``."""
        x, y, z = v
        return self.c * x + self.s * y, -self.s * x + self.c * y, z

    @property
    def rotation(self) -> Any:
        """``Rz(theta) Rx(alpha)``."""
        return sp.Matrix([[self.c, -self.s, 0], [self.s, self.c, 0], [0, 0, 1]]) * self.twist

    @property
    def twist(self) -> Any:
        """``Rx(alpha)``."""
        return sp.Matrix([[1, 0, 0], [0, self.ca, -self.sa], [0, self.sa, self.ca]])


@dataclass(frozen=True)
class Letters:
    """An arm in letters; ``R``, ``p``: ``H = to_base T to_last``, the product of its links."""

    links: tuple[Link, ...]
    rows: tuple[DHRow, ...]
    values: dict[str, float]
    to_base: Array
    to_last: Array
    R: Any
    p: Any

    @property
    def kinds(self) -> str:
        """R or P for each joint."""
        return "".join("P" if link.slides else "R" for link in self.links)

    def reversed(self) -> "Letters":
        """The same arm seen from its tool: ``Tx(a_n) Rx(alpha_n) H^-1``."""
        last = self.links[-1]
        links = []
        for link, before in zip(self.links[::-1], (*self.links[-2::-1], None), strict=True):
            a, ca, sa = (-before.a, before.ca, -before.sa) if before else (0, 1, 0)
            s, d = -link.s, -link.d
            links.append(replace(link, s=s, d=d, a=sp.S(a), ca=sp.S(ca), sa=sp.S(sa), way=-1))
        R = last.twist * self.R.T
        p = -R * self.p + sp.Matrix([last.a, 0, 0])
        return replace(self, links=tuple(links), R=R, p=p)


def letters_of(table: DHTable) -> Letters:
    """A table in letters, and what stands for what.

    Raises
    ------
    NoSolverError
        A fixed step between two joints, for which the four parameters have no letters.
    """
    joints = table.joints
    if table.joint_map is not None:
        raise NoSolverError("formulas need joints that neither follow others nor are coupled")
    if table.has_steps_between:
        raise NoSolverError(
            "formulas need a table without fixed steps between its joints; "
            "extract finds one, and Robot.symbolic_ik takes it"
        )
    base, tool = table.base_frame, np.eye(4)
    for row in table.rows[table.rows.index(joints[-1]) + 1 :]:
        tool = tool @ row.transform(0.0, table.convention)
    tool = tool @ table.tool.matrix
    links, values = list[Link](), dict[str, float]()
    shapes = [(row.a, row.alpha) for row in joints]
    if table.convention is DHConvention.MODIFIED:
        base = base @ dh_transform(0.0, 0.0, *shapes[0], DHConvention.MODIFIED)
        shapes = [*shapes[1:], (0.0, 0.0)]
    for i, (row, (a, alpha)) in enumerate(zip(joints, shapes, strict=True), 1):
        links.append(_link(i, row, a, alpha, values))
    R = sp.Matrix(3, 3, lambda i, j: sp.Symbol(f"r_{i + 1}{j + 1}"))
    p = sp.Matrix([sp.Symbol(f"p_{axis}") for axis in "xyz"])
    to_base, to_last = _rounded(inverse(base)), _rounded(inverse(tool))
    return Letters(tuple(links), joints, values, to_base, to_last, R, p)


def _rounded(T: Array) -> Array:
    """A pose whose rounding errors of 0 and 1 are taken away."""
    near = np.round(T)
    return np.where(np.abs(T - near) <= SMALL, near, T) + 0.0


def _link(i: int, row: DHRow, a: float, alpha: float, values: dict[str, float]) -> Link:
    slides = row.joint_type is JointType.PRISMATIC
    c, s = sp.Symbol(f"c_{i}"), sp.Symbol(f"s_{i}")
    d = sp.Symbol(f"d_{i}")
    if slides:
        c, s = _functions(f"theta_{i}", row.theta, values)
    else:
        d = _letter(f"d_{i}", row.d, values)
    ca, sa = _functions(f"alpha_{i}", alpha, values)
    return Link(str(i), slides, c, s, d, _letter(f"a_{i}", a, values), ca, sa)


def _letter(name: str, value: float, values: dict[str, float]) -> Any:
    """The letter of a length, or 0."""
    if abs(value) <= SMALL:
        return sp.S.Zero
    values[name] = float(value)
    return sp.Symbol(name)


def _functions(name: str, angle: float, values: dict[str, float]) -> tuple[Any, Any]:
    """Cosine and sine of a constant angle: numbers at right angles, else of its letter."""
    quarters = angle / (math.pi / 2)
    if abs(quarters - round(quarters)) <= SMALL:
        c, s = ((1, 0), (0, 1), (-1, 0), (0, -1))[round(quarters) % 4]
        return sp.Integer(c), sp.Integer(s)
    values[name] = float(angle)
    return sp.cos(sp.Symbol(name)), sp.sin(sp.Symbol(name))
