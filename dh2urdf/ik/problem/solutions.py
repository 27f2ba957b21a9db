"""The solutions of one pose: arrays that a kernel filled, names and views when asked."""

from __future__ import annotations

from collections.abc import Iterator
from struct import Struct
from typing import NamedTuple, Protocol, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dh2urdf.chain import SerialChain
from dh2urdf.exceptions import NoSolutionError
from dh2urdf.ik.arm import BRANCH_WORDS, BranchWords, IntArray, as_configuration
from dh2urdf.ik.problem.notebook import solutions_html
from dh2urdf.ik.problem.words import controller_words
from dh2urdf.transforms import Array


def branch_name(code: int, words: BranchWords = BRANCH_WORDS) -> str:
    """Readable name of a branch code; empty where the family has no names (-1)."""
    if code < 0:
        return ""
    return ", ".join(pair[code >> bit & 1] for bit, pair in enumerate(words) if pair)


def joints_of_mask(mask: int) -> tuple[int, ...]:
    """Indices of the joints whose bits are set."""
    return tuple(i for i in range(mask.bit_length()) if mask >> i & 1)


_NUMBER = Struct("=q").unpack_from


class Answering(Protocol):
    """What solutions ask of the problem that they are of."""

    chain: SerialChain
    branch_words: BranchWords

    @property
    def sampled(self) -> bool:
        """Whether there are solutions between those that are listed."""

    @property
    def partial(self) -> bool:
        """Whether there may be solutions that those that are listed do not lead to."""

    def arranged(self, found: IKSolutions, seed: Array, within_limits: bool = True) -> IKSolutions:
        """The solutions towards a seed, nearest first."""

    def turned(self, q: Array, reference: Array, within_limits: bool) -> Array:
        """Configurations (..., n) in the turns nearest to a reference."""

    def gaps(self, q: Array, seed: Array) -> Array:
        """As :meth:`Problem.gaps`."""

    def joints_at(self, q: Array) -> tuple[SerialChain, Array]:
        """The chain, and its joints at configurations (..., n)."""

    def measure(self, q: Array, T: Array) -> Array:
        """Residuals of configurations (k, n) at a pose, by another forward kinematics."""


class IKSolutions:
    """All solutions of one pose: sized, iterable, indexed by solution.

    Attributes
    ----------
    q : array, shape (k, n)
        Configurations [rad] or [m].
    residual : array, shape (k,)
        Larger of position error [m] and orientation error [rad] of each on the exact chain.
    branch : tuple of str
        ``shoulder left, elbow up, wrist flip``; empty where these words mean nothing.
    free_joints : tuple of tuples of int
        Joints that can move along the singular family through each solution; mostly empty.
    partial : bool
        Whether the arm has two joints or more to spare: there may be solutions that are on no
        family of these, and a seed finds its own.
    T : array, shape (4, 4)
        The target.
    pose_change : float
        How far the given pose was from T [rad]; 0 unless ``nearest=True`` was asked for.
    """

    __slots__ = ("_memory", "_problem", "pose_change")

    def __init__(self, problem: Answering, memory: bytes) -> None:
        self._problem, self._memory, self.pose_change = problem, memory, 0.0

    @property
    def count(self) -> int:
        """Number of solutions."""
        count: int = _NUMBER(self._memory, 128)[0]
        return count

    @property
    def q(self) -> Array:
        """Configurations, shape (k, n), read-only."""
        n, count = self._problem.chain.n, self.count
        return np.frombuffer(self._memory, float, n * count, 8 * 17).reshape(count, n)

    @property
    def residual(self) -> Array:
        """Residual of each solution [m and rad], shape (k,), read-only."""
        return self._run(0)

    @property
    def branch(self) -> tuple[str, ...]:
        """Name of each solution's branch."""
        words = self._problem.branch_words
        return tuple(branch_name(code, words) for code in self.codes[0].tolist())

    @property
    def free_joints(self) -> tuple[tuple[int, ...], ...]:
        """Joints that can move along a singular family, one tuple per solution."""
        return tuple(joints_of_mask(mask) for mask in self.codes[1].tolist())

    @property
    def partial(self) -> bool:
        """Whether the arm has two joints or more to spare: these are members of a part."""
        return self._problem.partial

    @property
    def T(self) -> Array:
        """The target pose, shape (4, 4), read-only."""
        return np.frombuffer(self._memory, float, 16).reshape(4, 4)

    @property
    def codes(self) -> tuple[IntArray, IntArray]:
        """Branch codes and masks of free joints, two arrays of shape (k,)."""
        return self._run(1).view(np.int64), self._run(2).view(np.int64)

    def _run(self, number: int) -> Array:
        """Numbers of each solution, after the pose, their number and room for configurations."""
        n, room = self._problem.chain.n, len(self._memory) // 8 - 17
        first = 17 + room // (n + 3) * (n + number)
        return np.frombuffer(self._memory, float, self.count, 8 * first)

    def nearest(self, q: ArrayLike) -> Array:
        """The solution with the least joint motion from q, shape (n,).

        Turned within the limits to where q is; singular families are entered at their
        nearest member.

        Raises
        ------
        NoSolutionError
            The list is empty.
        ConfigurationError
        """
        found = self.sorted_by(q)
        if not len(found):
            raise NoSolutionError("nearest: there is no solution to choose from")
        return found[0]

    def sorted_by(self, q: ArrayLike) -> IKSolutions:
        """All solutions, nearest to q first, turned and moved as :meth:`nearest` does."""
        goal = as_configuration(q, self._problem.chain.prismatic, "q")
        found = self._problem.arranged(self, goal)
        found.pose_change = self.pose_change
        return found

    def gaps(self, seed: ArrayLike) -> Array:
        """How far each value of each solution is from a seed (n,), full turns aside, (k, n)."""
        goal = as_configuration(seed, self._problem.chain.prismatic, "seed")
        return self._problem.gaps(self.q, goal)

    def words(self, maker: str) -> tuple[NamedTuple, ...]:
        """The word of each solution in the terms of a controller: its text is what that shows.

        For arms of six axes with a spherical wrist; see :mod:`dh2urdf.ik.problem.words` for the
        makers' definitions, and for how joint angles become the controller's.

        Parameters
        ----------
        maker : {"kuka", "abb", "fanuc"}
            ``S 2, T 35`` (status, turn), ``[0,-1,1,0]`` (cf1, cf4, cf6, cfx), or
            ``N U T, 0, 0, 0`` (flip, elbow, side, turns of J1, J4 and J6).

        Raises
        ------
        ArgumentError
        NotOrthoParallelError
            An arm of another geometry; the message has every condition that fails.
        """
        return controller_words(*self._problem.joints_at(self.q), maker)

    def verify(self) -> Array:
        """Residuals measured again by Pinocchio, shape (k,) [m and rad]."""
        return self._problem.measure(self.q, self.T)

    def __len__(self) -> int:
        return self.count

    @overload
    def __getitem__(self, index: int) -> Array: ...
    @overload
    def __getitem__(self, index: slice) -> IKSolutions: ...
    def __getitem__(self, index: int | slice) -> Array | IKSolutions:
        if isinstance(index, slice):
            return self.select(np.arange(len(self))[index])
        row: Array = self.q[index]
        return row

    def __iter__(self) -> Iterator[Array]:
        return iter(self.q)

    def select(self, rows: IntArray | NDArray[np.bool_]) -> IKSolutions:
        """The solutions of some rows, in that order."""
        branch, free = self.codes
        q, residual = self.q[rows], self.residual[rows]
        some = IKSolutions.of(self._problem, self.T, q, residual, branch[rows], free[rows])
        some.pose_change = self.pose_change
        return some

    @classmethod
    def of(
        cls, problem: Answering, target: Array, q: Array, residual: Array, *codes: IntArray
    ) -> IKSolutions:
        """Solutions of one target (4, 4) from arrays with a row for each; as :attr:`codes`."""
        count, *rest = (whole.view(np.float64) for whole in (np.array([len(q)]), *codes))
        numbers = target.ravel(), count, q.ravel(), residual, *rest
        return cls(problem, np.concatenate(numbers).tobytes())

    def __repr__(self) -> str:
        if not self:
            return "<IKSolutions: none>"
        worst = float(self.residual.max())
        return f"<IKSolutions: {len(self)} of {self.q.shape[1]} joints, residual <= {worst:.1e}>"

    def _repr_html_(self) -> str:
        return solutions_html(self, self._problem.chain)

    def __str__(self) -> str:
        if not self:
            return "no solution"
        lines = []
        rows = zip(self.q + 0.0, self.residual, self.branch, self.free_joints, strict=True)
        for i, (q, residual, branch, free) in enumerate(rows):
            values = " ".join(f"{v:9.5f}" for v in q)
            notes = [note for note in (branch, free and f"free joints {free}") if note]
            lines.append(f"{i}: {values}  residual {residual:.1e}  {'; '.join(notes)}".rstrip())
        if self.partial:
            lines.append("members of a part of the solutions; a seed finds its own")
        return "\n".join(lines)
