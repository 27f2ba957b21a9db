"""What moves and what is moved: the values q of a robot, and the joints of its chain.

They differ where a joint follows another (a hollow wrist, a parallelogram, ``<mimic>`` of a URDF)
and where a controller counts an angle otherwise than from the link before, such as FANUC's J3 from
the level: ``q_chain = matrix @ q + offset``.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from dh2urdf.chain.serial_chain import SerialChain, settled_state
from dh2urdf.dh import DHTable, JointType, Mimic
from dh2urdf.dh.coupling import narrowed, value_ranges
from dh2urdf.transforms import Array


@dataclass(frozen=True, eq=False)
class Coupling:
    """``q_chain = matrix @ q + offset``.

    Parameters
    ----------
    matrix, offset : array, shape (chain.n, n) and (chain.n,)
    names : tuple of n str
        Joints whose values q are.
    lower, upper : array, shape (n,)
        Bounds of q [rad] or [m], within which every follower of one value stays in its own; what
        moves by several values is bounded by the chain's limits, too.
    prismatic : array of bool, shape (n,)
        True where a value is a length.
    warnings : tuple of str
        Joints whose own bounds leave nothing of those of the others, and so count for nothing.
    """

    matrix: Array
    offset: Array
    names: tuple[str, ...]
    lower: Array
    upper: Array
    prismatic: NDArray[np.bool_]
    warnings: tuple[str, ...] = ()

    __getstate__ = settled_state

    @property
    def n(self) -> int:
        """Number of values."""
        return len(self.names)

    @cached_property
    def inverse(self) -> Array | None:
        """The matrix (n, chain.n) back to the values, None where it is not square."""
        square = self.matrix.shape[0] == self.matrix.shape[1]
        return np.asarray(np.linalg.inv(self.matrix), float) if square else None

    def chain_of(self, chain: SerialChain) -> SerialChain:
        """A chain of as many joints with names, kinds and limits of the values instead."""
        kinds = tuple(JointType.PRISMATIC if s else JointType.REVOLUTE for s in self.prismatic)
        chain = replace(chain, joint_types=kinds, names=self.names)
        return replace(chain, lower=self.lower, upper=self.upper)

    def joints(self, q: Array) -> Array:
        """Joints of the chain (..., chain.n) at values q (..., n)."""
        return q @ self.matrix.T + self.offset

    def ranges(self, lower: Array, upper: Array) -> tuple[Array, Array]:
        """Between which values each joint is (chain.n,) while the values are between such (n,)."""
        return _image(self.matrix, self.offset, lower, upper)

    def values_of(self, lower: Array, upper: Array) -> tuple[Array, Array]:
        """The same of values (n,) of a square coupling, while the joints are between such."""
        assert self.inverse is not None
        return _image(self.inverse, -self.inverse @ self.offset, lower, upper)

    def leaves_values(self, joints: SerialChain) -> bool:
        """Whether the limits of the joints of a square coupling alone keep the values in theirs."""
        if self.inverse is None:
            return False
        low, high = self.values_of(joints.lower, joints.upper)
        return within(low, high, self.lower, self.upper)

    def in_turns(self, turns: Array) -> "Coupling":
        """The same for joints that are counted in so many turns each, (chain.n,)."""
        matrix, offset = self.matrix / turns[:, None], self.offset / turns
        return replace(self, matrix=matrix, offset=offset)

    def values(self, joints: Array) -> Array:
        """Values q (..., n) of joints (..., n) of a square coupling."""
        assert self.inverse is not None
        out: Array = (joints - self.offset) @ self.inverse.T
        return out


ALIKE = 1e-9
"""Rounding [rad or m] of a limit that follows from others."""


def within(low: Array, high: Array, lower: Array, upper: Array) -> bool:
    """Whether ranges (n,) are inside others."""
    return bool((low >= lower - ALIKE).all() and (high <= upper + ALIKE).all())


def _image(matrix: Array, offset: Array, lower: Array, upper: Array) -> tuple[Array, Array]:
    """Bounds of ``matrix @ x + offset`` for x between bounds, some of them infinite."""
    with np.errstate(invalid="ignore"):
        ends = np.stack([matrix * lower, matrix * upper])
    low, high = np.sort(np.where(matrix == 0.0, 0.0, ends), axis=0).sum(axis=2) + offset
    return low, high


ROUNDING = 1e-12
"""Part of a multiplier that is rounding of an inverse."""


def parted(chain: SerialChain, coupling: Coupling) -> tuple[Coupling, Coupling | None]:
    """A coupling of fewer values than joints, as followers of these, and as values of those.

    The first says how joints follow those that have a value of their own, the second, None where
    that changes nothing, how the values move them.
    """
    if any(name not in chain.names for name in coupling.names):
        return coupling, None
    own = [chain.names.index(name) for name in coupling.names]
    square = coupling.matrix[own]
    if np.array_equal(square, np.eye(coupling.n)):
        return coupling, None
    matrix = coupling.matrix @ np.linalg.inv(square)
    matrix[np.abs(matrix) < ROUNDING * np.abs(matrix).max()] = 0.0
    bounds = chain.lower[own], chain.upper[own]
    lead = Coupling(matrix, coupling.offset, coupling.names, *bounds, coupling.prismatic)
    return _bounded(chain, lead), replace(coupling, matrix=square, offset=coupling.offset[own])


def follow(chain: SerialChain, mimics: Mapping[str, Mimic]) -> Coupling | None:
    """The coupling of a chain of which joints follow others; None where none does.

    A leader that is not on the chain itself is still a value of q, since it moves the tip; it has
    the place of the first joint that follows it.
    """
    if not any(name in mimics for name in chain.names):
        return None
    terms = [resolved(name, mimics) for name in chain.names]
    leaders = [leader for leader, _, _ in terms]
    places = {v: chain.names.index(v) if v in chain.names else leaders.index(v) for v in leaders}
    names = tuple(sorted(places, key=lambda v: places[v]))
    matrix = np.zeros((chain.n, len(names)))
    offset = np.array([constant for _, _, constant in terms])
    for k, (leader, factor, _) in enumerate(terms):
        matrix[k, names.index(leader)] = factor
    bounds = np.full(len(names), -np.inf), np.full(len(names), np.inf)
    slides = chain.prismatic[[places[v] for v in names]]
    return _bounded(chain, Coupling(matrix, offset, names, *bounds, slides))


def coupling_of(table: DHTable, chain: SerialChain) -> Coupling | None:
    """The coupling of a table's chain; None where every joint is at a value of its own."""
    joints = table.joint_map
    if joints is None:
        return None
    own, bounds = list(joints.own), value_ranges(table.joints, joints)
    names = tuple(chain.names[i] for i in own)
    return _bounded(
        chain, Coupling(joints.matrix, joints.offset, names, *bounds, chain.prismatic[own])
    )


def _bounded(chain: SerialChain, given: Coupling) -> Coupling:
    """The coupling, its bounds narrowed by those of joints that move by one value alone."""
    order = sorted(range(chain.n), key=lambda k: chain.names[k] not in given.names)
    joints = {k: (float(chain.lower[k]), float(chain.upper[k])) for k in order}
    values = given.lower, given.upper
    lower, upper, clashes = narrowed(given.matrix, given.offset, values, joints)
    warnings = tuple(
        f"joint {chain.names[clash.joint]!r}: "
        f"{clash.words(given.names[clash.value], bool(given.prismatic[clash.value]))}"
        for clash in clashes
    )
    return replace(given, lower=lower, upper=upper, warnings=warnings)


def resolved(name: str, mimics: Mapping[str, Mimic]) -> tuple[str, float, float]:
    """Leader that follows none, factor and constant of a joint, through chains of mimics."""
    factor, constant, seen = 1.0, 0.0, {name}
    while name in mimics and mimics[name].joint not in seen:
        mimic = mimics[name]
        constant += factor * mimic.offset
        factor *= mimic.multiplier
        name = mimic.joint
        seen.add(name)
    return name, factor, constant
