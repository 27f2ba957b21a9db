"""The serial chain: the one form that every conversion and every algorithm starts from.

A table, a URDF, an MJCF and a Pinocchio model all become::

    T_base_tool(q) = links[0] Z_1(q_1) links[1] Z_2(q_2) ... Z_n(q_n) links[n]

with constant rigid ``links`` and ``Z_i = Rot_z(q_i)`` for a revolute, ``Trans_z(q_i)`` for a
prismatic joint: every joint's axis is its own z, signs and offsets are in the links. The
product equals the DH product factor by factor, so nothing is lost to rounding; axes and
points of the screws at q = 0 follow from it.
"""

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Self

import numpy as np

from dh2urdf.bounds import LENGTH
from dh2urdf.dh import JointType
from dh2urdf.doors import instance, real_array
from dh2urdf.exceptions import Dh2UrdfError, UrdfError
from dh2urdf.transforms import Array, dot, inverse, product

FARTHEST = 1000 * LENGTH
"""Longest link [m]: all rows of the largest table in one."""

FAR_START = 10
"""A first frame so many times the arm's length along axis 1 is not part of the arm."""


def settled_state(thing: object) -> dict[str, Any]:
    """What of an object is pickled, copied so that other threads may go on filling its caches."""
    state = thing.__dict__.copy().items()
    return {key: v.copy() if type(v) in (dict, list) else v for key, v in state}


@dataclass(frozen=True, eq=False)
class SerialChain:
    """A serial chain of single-degree joints, immutable.

    Parameters
    ----------
    links : array, shape (n + 1, 4, 4)
        Constant transforms before, between and after the joints, lengths in [m].
    joint_types : tuple of JointType
        ``REVOLUTE`` or ``PRISMATIC``, n of them.
    names : tuple of str
    lower, upper : array, shape (n,)
        Bounds of q [rad] or [m]; infinite where there are none.
    unit : float
        Length [m] in which all lengths of the chain are; see :meth:`in_unit`.
    """

    links: Array
    joint_types: tuple[JointType, ...]
    names: tuple[str, ...]
    lower: Array
    upper: Array
    unit: float = 1.0

    def __post_init__(self) -> None:
        for key, kind in (("links", "4 x 4 matrices"), ("lower", "numbers"), ("upper", "numbers")):
            array = np.array(real_array(getattr(self, key), key, kind), order="C")
            array.flags.writeable = False
            object.__setattr__(self, key, array)
        n = len(instance(self.joint_types, "joint_types", tuple))
        instance(self.names, "names", tuple)
        sizes = (self.links.shape, len(self.names), self.lower.shape, self.upper.shape)
        if sizes != ((n + 1, 4, 4), n, (n,), (n,)):
            raise Dh2UrdfError(f"a chain of {n} joints cannot have parts of sizes {sizes}")
        if not (np.abs(self.links) * self.unit <= FARTHEST).all():
            raise UrdfError(f"a chain with numbers that are none, or beyond {FARTHEST:.0e} m")

    __getstate__ = settled_state

    @property
    def n(self) -> int:
        """Number of joints."""
        return len(self.joint_types)

    @cached_property
    def prismatic(self) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
        """True where a joint slides, shape (n,)."""
        out = np.array([t is JointType.PRISMATIC for t in self.joint_types], dtype=np.bool_)
        out.flags.writeable = False
        return out

    @property
    def value_units(self) -> Array:
        """What one of each value is in [rad] or [m], shape (n,)."""
        units: Array = np.where(self.prismatic, self.unit, 1.0)
        return units

    @cached_property
    def tables(self) -> tuple[Array, Array]:
        """Links (n + 1, 4, 4) and joints (n, 3: sliding, lower, upper), as kernels take them."""
        joints = np.column_stack([self.prismatic, self.lower, self.upper]).astype(float)
        return np.array(self.links), joints

    @cached_property
    def joint_frames(self) -> Array:
        """Frame of each joint in base at q = 0, z along the axis, shape (n, 4, 4)."""
        frames, T = [], np.eye(4)
        for link in self.links[:-1]:
            T = product(T, link)
            frames.append(T)
        return np.stack(frames)

    @property
    def axes(self) -> Array:
        """Unit joint axes in base at q = 0, shape (n, 3)."""
        return self.joint_frames[:, :3, 2]

    @property
    def points(self) -> Array:
        """A point on each joint axis in base at q = 0 [m], shape (n, 3)."""
        return self.joint_frames[:, :3, 3]

    @cached_property
    def tool(self) -> Array:
        """``T_base_tool`` at q = 0, shape (4, 4)."""
        return product(self.joint_frames[-1], self.links[-1])

    @cached_property
    def size(self) -> float:
        """Size of the arm [m], the length that tolerances and drawings are relative to.

        Its length, plus the travel of prismatic joints where they have limits. 1 m for an arm
        without any length.
        """
        total = self.length
        for slides, low, high in zip(self.prismatic, self.lower, self.upper, strict=True):
            if slides and math.isfinite(low) and math.isfinite(high):
                total += max(abs(low), abs(high), high - low)
        return total if total > 1e-9 else 1.0

    @cached_property
    def length(self) -> float:
        """Distances [m] from axis to axis and to the tool, added up.

        They are measured between the axes as lines, so that frames far out along parallel axes
        (calibrated arms) do not count; nor does a first frame so far along its axis.
        """
        start, z = self.points[0], self.axes[0]
        near = start - z * float(dot(z, start))
        total, from_base = self._walk(start), self._walk(near)
        return from_base if math.dist(start, near) > FAR_START * from_base else total

    def _walk(self, last: Array) -> float:
        """Way [m] from a point of axis 1 over the nearest points of the others to the tool."""
        total = 0.0
        for point, axis in zip(self.points[1:], self.axes[1:], strict=True):
            foot = point + axis * float(dot(axis, last - point))
            total += math.dist(foot, last)
            last = foot
        return total + math.dist(self.tool[:3, 3], last)

    def in_unit(self, unit: float) -> Self:
        """The same chain with lengths in a unit of its own, a power of two [m]: nothing rounds."""
        links, scale = self.links.copy(), np.where(self.prismatic, unit / self.unit, 1.0)
        links[:, :3, 3] /= unit / self.unit
        bounds = self.lower / scale, self.upper / scale
        return replace(self, links=links, lower=bounds[0], upper=bounds[1], unit=unit)

    def fk(self, q: Array) -> Array:
        """``T_base_tool`` at q (n,) by the defining product, shape (4, 4)."""
        T: Array = self.links[0]
        for qi, slides, link in zip(q, self.prismatic, self.links[1:], strict=True):
            c, s, t = (1.0, 0.0, qi) if slides else (math.cos(qi), math.sin(qi), 0.0)
            Z = np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, t], [0, 0, 0, 1]])
            T = product(T, Z, link)
        return T

    def reversed(self) -> Self:
        """The chain from tool to base: ``T_tool_base`` with the joints in reverse order.

        ``Z(q)^-1 = Z(-q) = S Z(q) S`` with ``S = Rot_x(pi)`` keeps the joint values.
        """
        return self._reversed

    @cached_property
    def _reversed(self) -> Self:
        S = np.diag([1.0, -1.0, -1.0, 1.0])
        inv = inverse(self.links)[::-1]
        links = np.stack([L if k == 0 else product(S, L) for k, L in enumerate(inv)])
        links[:-1] = product(links[:-1], S)
        return replace(
            self,
            links=links,
            joint_types=self.joint_types[::-1],
            names=self.names[::-1],
            lower=self.lower[::-1],
            upper=self.upper[::-1],
        )
