"""Results of inverse kinematics: the solutions of one pose, and those of a batch.

Both hold the arrays that a kernel filled and make names, tuples and views when asked.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dh2urdf.exceptions import ConfigurationError

if TYPE_CHECKING:
    from dh2urdf.ik.problem import Problem
    from dh2urdf.transforms import Array

__all__ = ["IKBatch", "IKSolutions", "branch_name", "joints_of_mask"]

BRANCH_WORDS = (
    ("shoulder left", "shoulder right"),
    ("elbow up", "elbow down"),
    ("wrist no flip", "wrist flip"),
)
"""Names of the bits of a branch code, value 0 first."""


def branch_name(code: int, words: Sequence[tuple[str, str] | None] = BRANCH_WORDS) -> str:
    """Readable name of a branch code; empty where the family has no names (-1)."""
    if code < 0:
        return ""
    return ", ".join(pair[code >> bit & 1] for bit, pair in enumerate(words) if pair)


def joints_of_mask(mask: int) -> tuple[int, ...]:
    """Indices of the joints whose bits are set."""
    return tuple(i for i in range(mask.bit_length()) if mask >> i & 1)


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
    T : array, shape (4, 4)
        The target.
    """

    __slots__ = ("_branch", "_free", "_problem", "_q", "_residual", "_target")

    def __init__(
        self,
        problem: Problem,
        target: Array,
        q: Array,
        residual: Array,
        branch: NDArray[np.int64],
        free: NDArray[np.int64],
    ) -> None:
        self._problem, self._target = problem, target
        self._q, self._residual, self._branch, self._free = q, residual, branch, free

    @property
    def q(self) -> Array:
        """Configurations, shape (k, n), read-only."""
        self._q.flags.writeable = False
        return self._q

    @property
    def residual(self) -> Array:
        """Residual of each solution [m and rad], shape (k,), read-only."""
        self._residual.flags.writeable = False
        return self._residual

    @property
    def branch(self) -> tuple[str, ...]:
        """Name of each solution's branch."""
        words = self._problem.branch_words
        return tuple(branch_name(int(code), words) for code in self._branch)

    @property
    def free_joints(self) -> tuple[tuple[int, ...], ...]:
        """Joints that can move along a singular family, one tuple per solution."""
        return tuple(joints_of_mask(int(mask)) for mask in self._free)

    @property
    def T(self) -> Array:
        """The target pose, shape (4, 4)."""
        return self._target

    @property
    def codes(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Branch codes and masks of free joints, two arrays of shape (k,)."""
        return self._branch, self._free

    def nearest(self, q: ArrayLike) -> Array:
        """The solution with the least joint motion from q, shape (n,).

        Turned within the limits to where q is; singular families are entered at their
        nearest member.

        Raises
        ------
        LookupError
            There is no solution.
        """
        if not len(self):
            raise LookupError("there is no solution to choose from")
        near: Array = self._problem.arranged(self, q)[0]
        return near

    def verify(self) -> Array:
        """Residuals measured again by Pinocchio, shape (k,) [m and rad]."""
        return self._problem.measure(self.q, self._target)

    def __len__(self) -> int:
        return len(self._q)

    def __bool__(self) -> bool:
        return len(self._q) > 0

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

    def select(self, rows: NDArray[np.int64] | NDArray[np.bool_]) -> IKSolutions:
        """The solutions of some rows, in that order."""
        return IKSolutions(
            self._problem,
            self._target,
            self._q[rows],
            self._residual[rows],
            self._branch[rows],
            self._free[rows],
        )

    def __repr__(self) -> str:
        k = len(self)
        if not k:
            return "<IKSolutions: none>"
        worst = float(self._residual.max())
        return f"<IKSolutions: {k} of {self._q.shape[1]} joints, residual <= {worst:.1e}>"

    def __str__(self) -> str:
        if not self:
            return "no solution"
        lines = []
        rows = zip(self._q, self._residual, self.branch, self.free_joints, strict=True)
        for i, (q, residual, branch, free) in enumerate(rows):
            values = " ".join(f"{v:9.5f}" for v in q)
            notes = [note for note in (branch, free and f"free joints {free}") if note]
            lines.append(f"{i}: {values}  residual {residual:.1e}  {'; '.join(notes)}".rstrip())
        return "\n".join(lines)


@dataclass(frozen=True, eq=False, repr=False)
class IKBatch:
    """All solutions of many poses in a few arrays; ``batch[i]`` is an :class:`IKSolutions`.

    Attributes
    ----------
    q : array, shape (m, kmax, n)
        Configurations [rad] or [m], NaN after the last solution of a pose.
    residual : array, shape (m, kmax)
        Residuals [m and rad], NaN after the last.
    count : int array, shape (m,)
        Number of solutions of each pose.
    branch_code, free_mask : int array, shape (m, kmax)
        Bits of the branch, and bits of the joints free along a singular family; -1 and 0 where
        there is none.
    targets : array, shape (m, 4, 4)
    """

    problem: Problem
    targets: Array
    q: Array
    residual: Array
    count: NDArray[np.int64]
    branch_code: NDArray[np.int64]
    free_mask: NDArray[np.int64]

    def solutions(self, i: int) -> IKSolutions:
        """The solutions of pose i."""
        k = int(self.count[i])
        return IKSolutions(
            self.problem,
            self.targets[i],
            self.q[i, :k],
            self.residual[i, :k],
            self.branch_code[i, :k],
            self.free_mask[i, :k],
        )

    @cached_property
    def solved(self) -> NDArray[np.bool_]:
        """True where a pose has a solution, shape (m,)."""
        return self.count > 0

    def __len__(self) -> int:
        return len(self.count)

    @overload
    def __getitem__(self, index: int) -> IKSolutions: ...
    @overload
    def __getitem__(self, index: slice) -> IKBatch: ...
    def __getitem__(self, index: int | slice) -> IKSolutions | IKBatch:
        if isinstance(index, int):
            if not -len(self) <= index < len(self):
                raise IndexError(f"pose {index} of a batch of {len(self)}")
            return self.solutions(index)
        keys = ("targets", "q", "residual", "count", "branch_code", "free_mask")
        return replace(self, **{key: getattr(self, key)[index] for key in keys})

    def __repr__(self) -> str:
        total = int(self.count.sum())
        return f"<IKBatch: {len(self)} poses, {int(self.solved.sum())} reached, {total} solutions>"


def as_configuration(q: ArrayLike, n: int, what: str) -> Array:
    """Check a configuration: n finite numbers, shape (n,)."""
    try:
        out = np.asarray(q, float)
    except (TypeError, ValueError):
        raise ConfigurationError(f"{what}: expected {n} numbers, got {q!r:.60}") from None
    if out.shape != (n,):
        raise ConfigurationError(f"{what}: expected shape ({n},), got {out.shape}")
    if not np.isfinite(out).all():
        raise ConfigurationError(f"{what}[{int(np.argmin(np.isfinite(out)))}]: NaN or infinity")
    return out
