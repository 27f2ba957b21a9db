"""The arm of a worked solution, as standard Denavit-Hartenberg rows between a base and a tool.

The user's own table where it is one, else the frames that lecture notes section 4 gives its axes.
"""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from dh2urdf.chain import SerialChain
from dh2urdf.conversions.assign import chain_to_dh
from dh2urdf.dh import DHConvention, DHRow, DHTable, JointType
from dh2urdf.transforms import Array, inverse, rot_x

EXACT = 1e-12
"""Cosine or sine that is rounding of a right angle."""


class Row(NamedTuple):
    """A row: constant part of the joint, d, a, alpha, with cosine and sine of alpha; the joint."""

    theta: float
    d: float
    a: float
    alpha: float
    ca: float
    sa: float
    sign: int
    slides: bool

    def motion(self, value: float) -> Array:
        """``H_i^{i-1}`` with the DH variable (theta_i or d_i) at a value, shape (4, 4)."""
        t, d = (self.theta, value) if self.slides else (value, self.d)
        c, s, ca, sa = math.cos(t), math.sin(t), self.ca, self.sa
        rows = [c, -s * ca, s * sa, self.a * c], [s, c * ca, -c * sa, self.a * s]
        return np.array([*rows, [0.0, sa, ca, d], [0.0, 0.0, 0.0, 1.0]])


@dataclass(frozen=True, eq=False)
class Arm:
    """Standard DH rows between a base and a tool, joints counted from 1.

    ``T_base_tool = base H_1^0 ... H_n^{n-1} tool``; the last row has alpha = 0: the tool has
    taken that turn over.
    """

    rows: tuple[Row, ...]
    base: Array
    tool: Array
    names: tuple[str, ...]
    own: bool
    table: DHTable

    @property
    def n(self) -> int:
        """Number of joints."""
        return len(self.rows)

    def frames(self, values: list[float]) -> list[Array]:
        """DH frames 0 ... k in frame 0 with the first k DH variables at values."""
        out = [np.eye(4)]
        for row, value in zip(self.rows, values, strict=False):
            out.append(out[-1] @ row.motion(value))
        return out

    def variable(self, i: int, q: float) -> float:
        """The DH variable of joint i (from 0) at q."""
        row = self.rows[i]
        return row.sign * q + (row.d if row.slides else row.theta)

    def joint_value(self, i: int, variable: float) -> float:
        """The joint value q of joint i (from 0) at a DH variable; angles in (-pi, pi]."""
        row = self.rows[i]
        if row.slides:
            return row.sign * (variable - row.d)
        return wrapped(row.sign * (variable - row.theta))

    def fk(self, q: Array) -> Array:
        """``T_base_tool`` by the product of the rows, shape (4, 4)."""
        T: Array = (
            self.base @ self.frames([self.variable(i, float(v)) for i, v in enumerate(q)])[-1]
        )
        return T @ self.tool


def wrapped(angle: float) -> float:
    """An angle [rad] in (-pi, pi]."""
    turned = math.remainder(angle, 2.0 * math.pi)
    return math.pi if turned == -math.pi else turned


def arm_of(chain: SerialChain, table: DHTable | None) -> Arm:
    """The arm of a chain, in the letters of its table where these are standard ones."""
    own = table is not None and _plain(table)
    found = table if table is not None and own else _assigned(chain)
    joints = found.joints
    rows = [_row(row) for row in joints]
    last = rows[-1]
    tool = rot_x(last.alpha) @ _trailing(found) @ found.tool.matrix
    rows[-1] = last._replace(alpha=0.0, ca=1.0, sa=0.0)
    return Arm(tuple(rows), found.base_frame, tool, chain.names, own, found)


def _row(row: DHRow) -> Row:
    """A row with exact zeros in the cosine and sine of right angles."""
    ca, sa = (0.0 if abs(v) < EXACT else v for v in (math.cos(row.alpha), math.sin(row.alpha)))
    slides = row.joint_type is JointType.PRISMATIC
    return Row(row.theta, row.d, row.a, row.alpha, ca, sa, row.sign, slides)


def _plain(table: DHTable) -> bool:
    """Whether a table's own letters will do: standard, neighbours that point one way."""
    moving = [i for i, row in enumerate(table.rows) if row.is_joint]
    between = table.rows[moving[0] : moving[-1] + 1]
    fixed = any(not row.is_joint for row in between)
    opposed = any(math.cos(row.alpha) < EXACT - 1.0 for row in table.joints[:-1])
    return table.convention is DHConvention.STANDARD and not fixed and not opposed


def _trailing(table: DHTable) -> Array:
    """Fixed rows after the last joint, shape (4, 4)."""
    T = np.eye(4)
    for row in reversed(table.rows):
        if row.is_joint:
            break
        T = row.transform(0.0, table.convention) @ T
    return T


def _assigned(chain: SerialChain) -> DHTable:
    """Standard DH frames of a chain's axes, z of parallel neighbours one way."""
    axes, signs = chain.axes.copy(), [1]
    for i in range(1, chain.n):
        opposed = float(axes[i] @ axes[i - 1]) < EXACT - 1.0
        signs.append(-1 if opposed else 1)
        axes[i] *= signs[-1]
    return chain_to_dh(chain, signs=signs, compact=False).table


def without_ends(arm: Arm, T: Array) -> Array:
    """``H_n^0``, the pose of frame n in frame 0: base and tool taken off, shape (4, 4)."""
    H: Array = inverse(arm.base) @ T @ inverse(arm.tool)
    return H
