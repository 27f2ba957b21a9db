"""A serial chain whose joints follow fewer values: some turn or slide by multiples of others.

    T_base_tool(q) = links[0] Z_1(f_1 q_v1) links[1] ... Z_N(f_N q_vN) links[N]

with ``v_i`` the value that moves joint i, and ``f_i`` by how much it moves for one of it. What
joints are offset by is in the links.
"""

import math
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property
from typing import Self

import numpy as np
from numpy.typing import NDArray

from dh2urdf.chain.coupling import Coupling
from dh2urdf.chain.serial_chain import SerialChain
from dh2urdf.dh import JointType
from dh2urdf.exceptions import Dh2UrdfError, NoSolverError
from dh2urdf.transforms import Array, product, rot_z, trans

LARGEST = 12
"""Largest denominator of a multiplier that is taken for a ratio of whole numbers."""

RATIO = 1e-12
"""What such a multiplier may be off, in parts of itself: that a file writes, and rounding."""


def _turns_of(ratios: list[Fraction]) -> float:
    """Turns after which all joints that follow a value by these ratios are back."""
    return math.lcm(*(r.denominator for r in ratios)) / math.gcd(*(r.numerator for r in ratios))


def _nothing() -> Array:
    return np.zeros(0)


@dataclass(frozen=True, eq=False)
class CoupledChain(SerialChain):
    """A chain of N joints that n values move.

    What is said of joints, from ``joint_types`` to ``upper`` and ``n``, is said of the values;
    ``links`` are N + 1, and ``axes``, ``points`` and ``joint_frames`` those of the N joints.

    Parameters
    ----------
    leaders : tuple of int
        For each joint the value that moves it.
    factors : array, shape (N,)
        By how much it moves for one of that.
    kinds : tuple of JointType
        Of the N joints.
    turns : tuple of float
        For each value, how many turns of the user's one turn is here.
    """

    leaders: tuple[int, ...] = ()
    factors: Array = field(default_factory=_nothing)
    kinds: tuple[JointType, ...] = ()
    turns: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        joints, n = len(self.leaders), len(self.joint_types)
        sizes = (self.links.shape, len(self.factors), len(self.kinds), len(self.names))
        if sizes != ((joints + 1, 4, 4), joints, joints, n) or len(self.turns) != n:
            raise Dh2UrdfError(f"a chain of {joints} joints cannot have parts of sizes {sizes}")
        for key in ("links", "lower", "upper", "factors"):
            array = np.array(getattr(self, key), float, order="C")
            array.flags.writeable = False
            object.__setattr__(self, key, array)

    @classmethod
    def of(cls, chain: SerialChain, coupling: Coupling) -> Self:
        """The chain whose joints are moved by the values of a coupling.

        Raises
        ------
        NoSolverError
            A joint follows two values.
        """
        matrix, offset, names = coupling.matrix, coupling.offset, coupling.names
        links, joints = [chain.links[0]], []
        for i in range(chain.n):
            moved = np.flatnonzero(matrix[i])
            if len(moved) > 1:
                two = " and ".join(names[v] for v in moved)
                raise NoSolverError(
                    f"joint {chain.names[i]!r} follows {two}, and there are fewer values than "
                    "joints; ik needs joints that follow one each; ik_numeric finds solutions one "
                    "at a time"
                )
            start = trans(0.0, 0.0, offset[i]) if chain.prismatic[i] else rot_z(offset[i])
            links[-1] = product(links[-1], start) if offset[i] else links[-1]
            if len(moved):
                joints.append((i, int(moved[0])))
                links.append(chain.links[i + 1])
            else:
                links[-1] = product(links[-1], chain.links[i + 1])
        kinds = (JointType.REVOLUTE, JointType.PRISMATIC)
        return cls(
            np.stack(links),
            tuple(kinds[bool(s)] for s in coupling.prismatic),
            names,
            coupling.lower,
            coupling.upper,
            chain.unit,
            tuple(v for _, v in joints),
            np.array([matrix[i, v] for i, v in joints]),
            tuple(chain.joint_types[i] for i, _ in joints),
            (1.0,) * len(names),
        )

    @cached_property
    def sliding(self) -> NDArray[np.bool_]:
        """True where one of the N joints slides, shape (N,)."""
        return np.array([kind is JointType.PRISMATIC for kind in self.kinds])

    @cached_property
    def matrix(self) -> Array:
        """The joints' values for the chain's: ``matrix @ q``, shape (N, n)."""
        out = np.zeros((len(self.leaders), self.n))
        out[np.arange(len(self.leaders)), self.leaders] = self.factors
        return out

    @cached_property
    def tables(self) -> tuple[Array, Array]:
        """Links, and the values' kinds and limits with what follows them, as kernels take them."""
        values = np.column_stack([self.prismatic, self.lower, self.upper])
        joints = np.column_stack([self.leaders, self.factors, self.sliding])
        return np.array(self.links), np.concatenate([values, joints]).astype(float)

    @property
    def serial(self) -> SerialChain:
        """The N joints as if each moved by itself, without limits."""
        far = np.full(len(self.leaders), np.inf)
        names = tuple(str(i + 1) for i in range(len(self.leaders)))
        return SerialChain(self.links, self.kinds, names, -far, far, self.unit)

    @property
    def value_units(self) -> Array:
        """What one of each value is in the user's [rad] or [m], shape (n,)."""
        units: Array = np.where(self.prismatic, self.unit, self.turns)
        return units

    def fk(self, q: Array) -> Array:
        """``T_base_tool`` at q (n,) by the defining product, shape (4, 4)."""
        return self.serial.fk(self.matrix @ q)

    def in_unit(self, unit: float) -> Self:
        """The same chain with lengths in a unit of its own, a power of two [m]: nothing rounds."""
        more = unit / self.unit
        links = self.links.copy()
        links[:, :3, 3] /= more
        values, joints = np.where(self.prismatic, more, 1.0), np.where(self.sliding, more, 1.0)
        return replace(
            self,
            links=links,
            lower=self.lower / values,
            upper=self.upper / values,
            unit=unit,
            factors=self.factors * values[list(self.leaders)] / joints,
        )

    @cached_property
    def in_turns(self) -> Self:
        """The same chain with values of which a turn, and no less, brings all joints back.

        Raises
        ------
        NoSolverError
            No number of turns does.
        """
        ratios: list[list[Fraction]] = [[] for _ in range(self.n)]
        for i, v in enumerate(self.leaders):
            if self.prismatic[v]:
                continue
            ratio = Fraction(float(self.factors[i])).limit_denominator(LARGEST)
            exact = abs(ratio - self.factors[i]) <= RATIO * abs(self.factors[i])
            if self.sliding[i] or not exact:
                raise NoSolverError(self._never_back(i, v))
            ratios[v].append(ratio)
        turns = [_turns_of(of) if of else 1.0 for of in ratios]
        if turns == [1.0] * self.n:
            return self
        each, turning = np.array(turns), ~self.prismatic[list(self.leaders)]
        more = np.round(self.factors * each[list(self.leaders)])
        return replace(
            self,
            lower=self.lower / each,
            upper=self.upper / each,
            factors=np.where(turning, more, self.factors),
            turns=tuple(a * b for a, b in zip(self.turns, turns, strict=True)),
        )

    def _never_back(self, i: int, v: int) -> str:
        """Why no number of turns of value v brings joint i back, and what there is instead."""
        if self.sliding[i]:
            by = math.radians(self.factors[i] * self.unit * 1e3)
            return (
                f"a slide that follows {self.names[v]}, which turns, moves {by:.6g} mm for each "
                "degree of it: such an arm has no closed form; ik_numeric finds solutions one at "
                "a time"
            )
        how = (
            f"turns {self.factors[i]:.12g} times as far, no ratio of whole numbers up to {LARGEST}"
        )
        many = "infinitely many solutions, since it has no limits on both sides"
        if np.isfinite(self.upper[v] - self.lower[v]):
            many = "different solutions in each turn within its limits, which are not counted"
        return (
            f"a joint that follows {self.names[v]} {how}: there is no number of turns after which "
            f"the pose comes again, and {many}; ik_numeric finds solutions one at a time"
        )

    def held(self, values: dict[int, float]) -> Self:
        """The chain without the held values."""
        rest = [v for v in range(self.n) if v not in values]
        links, joints = [self.links[0]], []
        for i, v in enumerate(self.leaders):
            if v in values:
                by = self.factors[i] * values[v]
                Z = trans(0.0, 0.0, by) if self.sliding[i] else rot_z(by)
                links[-1] = product(links[-1], Z, self.links[i + 1])
            else:
                joints.append(i)
                links.append(self.links[i + 1])
        return replace(
            self,
            links=np.stack(links),
            joint_types=tuple(self.joint_types[v] for v in rest),
            names=tuple(self.names[v] for v in rest),
            lower=self.lower[rest],
            upper=self.upper[rest],
            leaders=tuple(rest.index(self.leaders[i]) for i in joints),
            factors=self.factors[joints],
            kinds=tuple(self.kinds[i] for i in joints),
            turns=tuple(self.turns[v] for v in rest),
        )
