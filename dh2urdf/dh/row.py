"""One row of a DH table: frozen, plain floats, in metres and radians, checked when it is made."""

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from dh2urdf import transforms as tf
from dh2urdf.bounds import ANGLE, INERTIA, LENGTH, NUMBER
from dh2urdf.dh.mimic import Mimic
from dh2urdf.dh.motions import DHConvention, dh_transform
from dh2urdf.dh.reach import why_unreachable
from dh2urdf.doors import choice, found, instance, number, real_array, text
from dh2urdf.exceptions import ArgumentError, TableError
from dh2urdf.transforms import Array


class JointType(StrEnum):
    """Kind of a row's joint."""

    REVOLUTE = "revolute"
    PRISMATIC = "prismatic"
    FIXED = "fixed"


@dataclass(frozen=True)
class Origin:
    """A rigid step in URDF's terms: xyz [m], then roll, pitch, yaw [rad]."""

    xyz: tuple[float, float, float] = (0.0, 0.0, 0.0)
    rpy: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        if problems := [*_vector(self, "xyz", 3), *_vector(self, "rpy", 3)]:
            raise TableError(problems)

    @property
    def matrix(self) -> Array:
        """The step as a homogeneous matrix, shape (4, 4)."""
        return np.eye(4) if self.is_identity else tf.origin_matrix(self.xyz, self.rpy)

    @property
    def is_identity(self) -> bool:
        """True where the step is exactly none."""
        return not (any(self.xyz) or any(self.rpy))

    @classmethod
    def from_matrix(cls, T: ArrayLike) -> Self:
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
    mimic : Mimic or None
        The joint that this one follows; it has no value in q then, and ``lower`` and ``upper``
        bound the joint itself.
    serial_lower, serial_upper : float or None
        Bounds of the joint itself [rad] or [m], where the table's couplings tell it from q.

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
    mimic: Mimic | None = None
    serial_lower: float | None = None
    serial_upper: float | None = None

    def __post_init__(self) -> None:
        kinds = tuple(JointType)
        problems = _put(self, "joint_type", lambda v: JointType(choice(v, "type", kinds)))
        problems += _put(self, "name", lambda v: text(v, "name"))
        for key in ("theta", "d", "a", "alpha", "sign"):
            problems += _scalar(self, key)
        for key in _OPTIONAL:
            problems += _scalar(self, key) if getattr(self, key) is not None else []
        for key, size in (("com", 3), ("inertia", 6)):
            problems += _vector(self, key, size) if getattr(self, key) is not None else []
        if self.origin is not None:
            problems += _put(self, "origin", lambda v: instance(v, "origin", Origin))
        if self.mimic is not None:
            problems += _put(self, "mimic", lambda v: instance(v, "mimic", Mimic))
        bad = {problem.partition(":")[0] for problem in problems}
        problems += [p for p in self._range_problems(bad) if p.partition(":")[0] not in bad]
        if problems:
            raise TableError(problems)
        object.__setattr__(self, "sign", int(self.sign))

    def _range_problems(self, bad: set[str]) -> list[str]:
        """Faults of the fields that are of the right kind; ``bad`` names those that are not."""
        out = []
        if "sign" not in bad and self.sign not in (1, -1):
            out.append(f"sign: {self.sign!r} is not allowed; +1 or -1")
        for low, high in _PAIRS:
            lower, upper = getattr(self, low), getattr(self, high)
            if not {low, high} & bad and None not in (lower, upper) and lower > upper:
                out.append(f"{low}: {lower!r} lies above {high} {upper!r}")
        offset = self.mimic.offset if self.mimic is not None and "mimic" not in bad else 0.0
        if abs(offset) > ANGLE and self.joint_type is JointType.REVOLUTE:
            expected = f"expected a number from {-ANGLE:g} to {ANGLE:g} rad"
            out.append(f"mimic.offset: {expected}, got {offset!r}")
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
        elif self.origin is not None and not bad:
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
        q = number(q, "q", -NUMBER, NUMBER)
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


_PAIRS = (("lower", "upper"), ("serial_lower", "serial_upper"))
_OPTIONAL = (*_PAIRS[0], *_PAIRS[1], "velocity", "effort", "damping", "friction", "mass")
_JOINT_ONLY = (*_OPTIONAL, "mimic")


def _bound(row: DHRow | Origin, key: str) -> tuple[float, str]:
    """Largest value of a field, and its unit for messages."""
    if key in (*_PAIRS[0], *_PAIRS[1]):
        key = "d" if getattr(row, "joint_type", "") is JointType.PRISMATIC else "theta"
    if key in ("d", "a", "com", "xyz"):
        return LENGTH, "m"
    if key == "sign":
        return 1.0, ""
    if key in ("theta", "alpha", "rpy"):
        return ANGLE, "rad"
    return (INERTIA if key == "inertia" else NUMBER), ""


def _put(row: DHRow | Origin, key: str, door: Callable[[Any], object]) -> list[str]:
    """Put what a door makes of a field in its place; say what is wrong with it otherwise."""
    try:
        object.__setattr__(row, key, door(getattr(row, key)))
    except ArgumentError as error:
        return [str(error)]
    return []


def _scalar(row: DHRow, key: str) -> list[str]:
    bound, unit = _bound(row, key)
    value = getattr(row, key)
    if value is None:
        return [f"{key}: missing"]
    return _put(row, key, lambda v: number(v, key, -bound, bound, unit=unit) + 0.0)


def _vector(row: DHRow | Origin, key: str, size: int) -> list[str]:
    bound, unit = _bound(row, key)
    expected = f"{size} numbers from {-bound:g} to {bound:g}{' ' * bool(unit)}{unit}"

    def door(value: Any) -> tuple[float, ...]:
        array = real_array(value, key, expected)
        if array.shape != (size,) or not np.all(np.abs(array) <= bound):
            raise ArgumentError(f"{key}: expected {expected}, got {found(value)}")
        return tuple((array + 0.0).tolist())

    return _put(row, key, door)
