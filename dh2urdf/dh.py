"""Denavit-Hartenberg tables: frozen rows of plain floats, in metres and radians.

The transform of row i is the Big Equation (lecture notes section 5; Spong, Hutchinson and
Vidyasagar, eq. 3.10) in the standard convention, and its proximal twin (Craig, eq. 3.6) in
the modified one::

    standard  T_{i-1,i} = Rot_z(theta) Trans_z(d) Trans_x(a) Rot_x(alpha)
    modified  T_{i-1,i} = Trans_x(a) Rot_x(alpha) Rot_z(theta) Trans_z(d)

where a revolute joint puts ``sign * q + theta`` in place of theta and a prismatic joint puts
``sign * q + d`` in place of d.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from enum import StrEnum
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from dh2urdf import transforms as tf
from dh2urdf.dh_reach import why_unreachable
from dh2urdf.exceptions import ConfigurationError, TableError
from dh2urdf.transforms import Array

__all__ = ["DHConvention", "DHRow", "DHTable", "JointType", "Origin", "dh_factors", "dh_transform"]


class DHConvention(StrEnum):
    """Which end of the link carries the frame."""

    STANDARD = "standard"  # distal: Paul, Spong, the lecture notes
    MODIFIED = "modified"  # proximal: Craig, Khalil


class JointType(StrEnum):
    """Kind of a row's joint."""

    REVOLUTE = "revolute"
    PRISMATIC = "prismatic"
    FIXED = "fixed"


class DHFactors(NamedTuple):
    """The four simple displacements of one row, each (4, 4)."""

    rot_z: Array
    trans_z: Array
    trans_x: Array
    rot_x: Array


def dh_factors(theta: float, d: float, a: float, alpha: float) -> DHFactors:
    """``Rot_z(theta)``, ``Trans_z(d)``, ``Trans_x(a)`` and ``Rot_x(alpha)`` of one row."""
    return DHFactors(tf.rot_z(theta), tf.trans(0, 0, d), tf.trans(a, 0, 0), tf.rot_x(alpha))


def dh_transform(
    theta: float,
    d: float,
    a: float,
    alpha: float,
    convention: DHConvention | str = DHConvention.STANDARD,
) -> Array:
    """``T_{i-1,i}`` of one row: the Big Equation, or Craig's (3.6) for modified tables.

    Parameters
    ----------
    theta, d, a, alpha : float
        Joint angle [rad], link offset [m], link length [m], link twist [rad].

    Returns
    -------
    array, shape (4, 4)
    """
    ct, st, ca, sa = math.cos(theta), math.sin(theta), math.cos(alpha), math.sin(alpha)
    if DHConvention(convention) is DHConvention.STANDARD:
        return np.array(
            [
                [ct, -st * ca, st * sa, a * ct],
                [st, ct * ca, -ct * sa, a * st],
                [0.0, sa, ca, d],
                [0.0, 0.0, 0.0, 1.0],
            ]
        )
    return np.array(
        [
            [ct, -st, 0.0, a],
            [st * ca, ct * ca, -sa, -sa * d],
            [st * sa, ct * sa, ca, ca * d],
            [0.0, 0.0, 0.0, 1.0],
        ]
    )


@dataclass(frozen=True)
class Origin:
    """A rigid step in URDF's terms: xyz [m], then roll, pitch, yaw [rad]."""

    xyz: tuple[float, float, float] = (0.0, 0.0, 0.0)
    rpy: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        for key in ("xyz", "rpy"):
            value = _triple(getattr(self, key), key)
            object.__setattr__(self, key, value)

    @property
    def matrix(self) -> Array:
        """The step as a homogeneous matrix, shape (4, 4)."""
        return tf.origin_matrix(self.xyz, self.rpy)

    @property
    def is_identity(self) -> bool:
        """True where the step is exactly none."""
        return not (any(self.xyz) or any(self.rpy))

    @classmethod
    def from_matrix(cls, T: ArrayLike) -> Origin:
        """The step of a rigid (4, 4) matrix."""
        m = tf.check_pose(T)
        x, y, z = (float(v) + 0.0 for v in m[:3, 3])
        r, p, w = (v + 0.0 for v in tf.matrix_to_rpy(m))
        return cls((x, y, z), (r, p, w))


@dataclass(frozen=True)
class DHRow:
    """One row of a DH table, at q = 0.

    Parameters
    ----------
    theta, d, a, alpha : float
        Joint angle [rad], link offset [m], link length [m], link twist [rad].
    joint_type : JointType
        A ``FIXED`` row is the rigid step ``T(theta, d, a, alpha)``, or ``origin``; it belongs to
        the row above it, whose frame is taken after it.
    sign : int
        +1 or -1: the joint variable is ``sign * q + theta`` or ``sign * q + d``.
    name : str
        Joint name; empty for ``joint_i``.
    lower, upper : float or None
        Bounds of q, what the controller shows, in [rad] or [m].
    velocity, effort : float or None
        Largest speed [rad/s or m/s] and torque or force [N m or N].
    damping, friction : float or None
        Viscous [N m s/rad or N s/m] and dry friction [N m or N].
    mass : float or None
        Link mass [kg].
    com : tuple or None
        Centre of mass [m] in DH frame i.
    inertia : tuple or None
        ``(ixx, ixy, ixz, iyy, iyz, izz)`` [kg m^2] about the centre of mass, axes of DH frame i.
    origin : Origin or None
        The step of a fixed row, in place of its four parameters.

    Raises
    ------
    TableError
        Every fault of the row at once.
    """

    theta: float = 0.0
    d: float = 0.0
    a: float = 0.0
    alpha: float = 0.0
    joint_type: JointType = JointType.REVOLUTE
    sign: int = 1
    name: str = ""
    lower: float | None = None
    upper: float | None = None
    velocity: float | None = None
    effort: float | None = None
    damping: float | None = None
    friction: float | None = None
    mass: float | None = None
    com: tuple[float, float, float] | None = None
    inertia: tuple[float, float, float, float, float, float] | None = None
    origin: Origin | None = None

    def __post_init__(self) -> None:
        problems: list[str] = []
        put = object.__setattr__
        try:
            put(self, "joint_type", JointType(self.joint_type))
        except ValueError:
            allowed = ", ".join(JointType)
            problems.append(f"type: {self.joint_type!r} is not a joint type; allowed: {allowed}")
        for key in ("theta", "d", "a", "alpha"):
            problems += _floats(self, key, required=True)
        for key in ("lower", "upper", "velocity", "effort", "damping", "friction", "mass"):
            problems += _floats(self, key, required=False)
        for key, size in (("com", 3), ("inertia", 6)):
            problems += _tuples(self, key, size)
        bad = {problem.partition(":")[0] for problem in problems}
        problems += [p for p in self._range_problems(bad) if p.partition(":")[0] not in bad]
        if problems:
            raise TableError(problems)
        put(self, "sign", int(self.sign))

    def _range_problems(self, bad: set[str]) -> list[str]:
        """Faults of the fields that are of the right kind; ``bad`` names those that are not."""
        out = []
        if self.sign not in (1, -1):
            out.append(f"sign: {self.sign!r} is not allowed; +1 or -1")
        lower = None if {"lower", "upper"} & bad else self.lower
        if lower is not None and self.upper is not None and lower > self.upper:
            out.append(f"lower: {lower!r} lies above upper {self.upper!r}")
        for key in ("mass", "velocity", "damping", "friction", "effort"):
            value = None if key in bad else getattr(self, key)
            if value is not None and value < 0:
                out.append(f"{key}: {value!r} must not be negative")
            elif value == 0 and key in {"mass", "velocity"}:
                out.append(f"{key}: {value!r} must be greater than 0")
        if self.mass is None and (self.com is not None or self.inertia is not None):
            out.append("mass: missing, but com or inertia is given")
        if self.joint_type is JointType.FIXED:
            out += [
                f"{key}: a fixed row has none; give it to the joint's row above"
                for key in _JOINT_ONLY
                if getattr(self, key) is not None
            ]
            if self.origin is not None and any((self.theta, self.d, self.a, self.alpha)):
                out.append("origin: a fixed row takes either xyz and rpy or DH parameters")
        elif self.origin is not None:
            step = dh_transform(self.theta, self.d, self.a, self.alpha) @ self.origin.matrix
            reason = why_unreachable(step) or "give its four DH parameters instead"
            out.append(
                f"xyz: only a fixed row has xyz and rpy, this one is {self.joint_type}; {reason}"
            )
        return out

    @property
    def is_joint(self) -> bool:
        """True for a row that moves."""
        return self.joint_type is not JointType.FIXED

    def variables(self, q: float = 0.0) -> tuple[float, float]:
        """Joint angle theta [rad] and link offset d [m] with the joint at q."""
        if self.joint_type is JointType.REVOLUTE:
            return self.sign * q + self.theta, self.d
        if self.joint_type is JointType.PRISMATIC:
            return self.theta, self.sign * q + self.d
        return self.theta, self.d

    def transform(self, q: float, convention: DHConvention) -> Array:
        """``T_{i-1,i}`` of this row with its joint at q [rad or m], shape (4, 4)."""
        if self.origin is not None:
            return self.origin.matrix
        theta, d = self.variables(q)
        return dh_transform(theta, d, self.a, self.alpha, convention)


_JOINT_ONLY = ("lower", "upper", "velocity", "effort", "damping", "friction", "mass")


@dataclass(frozen=True)
class DHTable:
    """A DH table: convention, rows, base and tool.

    Parameters
    ----------
    rows : tuple of DHRow
    convention : DHConvention
        No default: the two differ silently.
    name : str
    base : Origin
        Frame 0 in ``base_link``.
    tool : Origin
        ``tool0`` in frame n.
    source, checked : str
        Where the figures come from, and what they were checked against.

    Raises
    ------
    TableError
        No joint at all, or two joints of one name.
    """

    rows: tuple[DHRow, ...]
    convention: DHConvention
    name: str = "robot"
    base: Origin = field(default_factory=Origin)
    tool: Origin = field(default_factory=Origin)
    source: str = ""
    checked: str = ""

    def __post_init__(self) -> None:
        put = object.__setattr__
        put(self, "rows", tuple(self.rows))
        try:
            put(self, "convention", DHConvention(self.convention))
        except ValueError:
            allowed = " or ".join(DHConvention)
            raise TableError(f"convention: {self.convention!r}; allowed: {allowed}") from None
        if self.n == 0:
            raise TableError("joints: a table needs at least one revolute or prismatic row")
        names = self.joint_names
        twice = sorted({name for name in names if names.count(name) > 1})
        if twice:
            raise TableError(f"name: {', '.join(map(repr, twice))} names more than one joint")

    @property
    def joints(self) -> tuple[DHRow, ...]:
        """The rows that move, in order."""
        return tuple(row for row in self.rows if row.is_joint)

    @property
    def n(self) -> int:
        """Number of joints."""
        return len(self.joints)

    @property
    def joint_names(self) -> tuple[str, ...]:
        """Names of the joints; ``joint_i`` where the row has none."""
        return tuple(row.name or f"joint_{i}" for i, row in enumerate(self.joints, 1))

    @property
    def length(self) -> float:
        """Sum of all lengths of the table [m], an upper bound of the reach at q = 0."""
        total = math.dist((0, 0, 0), self.tool.xyz)
        for row in self.rows:
            total += abs(row.a) + abs(row.d)
            total += math.dist((0, 0, 0), row.origin.xyz) if row.origin else 0.0
        return total

    def transforms(self, q: ArrayLike) -> Array:
        """``T_{i-1,i}`` for i = 1 ... n at q (n,), fixed rows folded in, shape (n, 4, 4).

        A fixed row before the first joint moves frame 0 and is not part of these.
        """
        config = self._config(q)
        out: list[Array] = []
        for row in self.rows:
            if row.is_joint:
                out.append(row.transform(config[len(out)], self.convention))
            elif out:
                out[-1] = out[-1] @ row.transform(0.0, self.convention)
        return np.stack(out)

    def frames(self, q: ArrayLike) -> Array:
        """DH frames 0 ... n in ``base_link`` at q (n,), shape (n + 1, 4, 4)."""
        frames = [self.base_frame]
        for T_prev_i in self.transforms(q):
            frames.append(frames[-1] @ T_prev_i)
        return np.stack(frames)

    def fk(self, q: ArrayLike) -> Array:
        """``T_base_tool`` at q (n,): the product of all rows, shape (4, 4)."""
        T_base_tool: Array = self.frames(q)[-1] @ self.tool.matrix
        return T_base_tool

    @property
    def base_frame(self) -> Array:
        """Frame 0 in ``base_link``: base, then the fixed rows before the first joint."""
        T = self.base.matrix
        for row in self.rows:
            if row.is_joint:
                break
            T = T @ row.transform(0.0, self.convention)
        return T

    def renamed(self, name: str) -> DHTable:
        """The same table under another name."""
        return replace(self, name=name)

    def to_markdown(self) -> str:
        """The table as a Markdown pipe table, angles in degrees."""
        from dh2urdf.dh_print import table_markdown

        return table_markdown(self)

    def to_csv(self) -> str:
        """The table as comma-separated values as shown, angles in degrees."""
        from dh2urdf.dh_print import table_csv

        return table_csv(self)

    def to_latex(self) -> str:
        """The table as a LaTeX ``tabular`` (package booktabs), angles in degrees."""
        from dh2urdf.dh_print import table_latex

        return table_latex(self)

    def _config(self, q: ArrayLike) -> Array:
        config = np.asarray(q, float)
        if config.shape != (self.n,):
            raise ConfigurationError(
                f"q: expected shape ({self.n},) for {self.n} joints, got {config.shape}"
            )
        return config

    def __str__(self) -> str:
        from dh2urdf.dh_print import table_text

        return table_text(self)

    def _repr_html_(self) -> str:
        from dh2urdf.dh_print import table_html

        return table_html(self)


def _triple(value: Sequence[float], key: str) -> tuple[float, float, float]:
    try:
        x, y, z = (float(v) for v in value)
    except (TypeError, ValueError):
        raise TableError(f"{key}: expected three numbers, got {value!r:.60}") from None
    if not all(map(math.isfinite, (x, y, z))):
        raise TableError(f"{key}: {value!r} is not finite")
    return x, y, z


def _floats(row: DHRow, key: str, *, required: bool) -> list[str]:
    """Turn one field into a float in place; say what is wrong with it otherwise."""
    value = getattr(row, key)
    if value is None:
        return [f"{key}: missing"] if required else []
    try:
        number = float(value)
    except (TypeError, ValueError):
        return [f"{key}: expected a number, got {value!r:.60}"]
    if not math.isfinite(number):
        return [f"{key}: {value!r} is not finite"]
    object.__setattr__(row, key, number + 0.0)
    return []


def _tuples(row: DHRow, key: str, size: int) -> list[str]:
    value = getattr(row, key)
    if value is None:
        return []
    try:
        numbers = tuple(float(v) for v in value)
    except (TypeError, ValueError):
        return [f"{key}: expected {size} numbers, got {value!r:.60}"]
    if len(numbers) != size or not all(map(math.isfinite, numbers)):
        return [f"{key}: expected {size} finite numbers, got {value!r:.60}"]
    object.__setattr__(row, key, numbers)
    return []
