"""The solutions of many poses, in the arrays that a kernel filled."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dh2urdf.exceptions import ArgumentError
from dh2urdf.ik.arm import IntArray, Outputs, as_configuration
from dh2urdf.ik.problem.solutions import Answering, IKSolutions
from dh2urdf.kernels.numbers import pad_solutions

if TYPE_CHECKING:
    from dh2urdf.transforms import Array


ARRAYS = ("targets", "q", "residual", "count", "branch_code", "free_mask", "pose_change")
"""The fields of a batch that have a row for each pose."""


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
        NaN for a pose that was skipped.
    pose_change : array, shape (m,)
        As of :class:`IKSolutions`.

    A stack of poses with more axes, (..., 4, 4), has them in place of the one of length m.
    """

    problem: Answering
    targets: Array
    q: Array
    residual: Array
    count: IntArray
    branch_code: IntArray
    free_mask: IntArray
    pose_change: Array

    def solutions(self, i: int) -> IKSolutions:
        """The solutions of pose i of a plain row of poses."""
        k = int(self.count[i])
        codes = self.branch_code[i, :k], self.free_mask[i, :k]
        q, residual = self.q[i, :k], self.residual[i, :k]
        found = IKSolutions.of(self.problem, self.targets[i], q, residual, *codes)
        found.pose_change = float(self.pose_change[i])
        return found

    def nearest(self, q: ArrayLike, *, follow: bool = False, within_limits: bool = True) -> IKBatch:
        """Of each pose of a plain row the solution with the least joint motion from q (n,).

        It is turned to q and moved along singular families, as by :meth:`IKSolutions.nearest`.
        With ``follow`` the solution found takes the place of q for the pose after it.

        Returns
        -------
        IKBatch
            With up to one solution for each pose.
        """
        problem, m = self.problem, len(self)
        goal = as_configuration(q, problem.chain.prismatic, "q")
        out, families = Outputs.of(m, 1, len(goal)), (self.free_mask != 0).any(axis=1).tolist()
        for i in range(m):
            k = self.count[i]
            if k and (families[i] or problem.sampled):
                found = problem.arranged(self.solutions(i), goal, within_limits)
                rows = found.q, found.residual, *found.codes
                k, best = len(found), 0
            elif k:
                near = problem.turned(self.q[i, :k], goal, within_limits)
                rows = near, self.residual[i], self.branch_code[i], self.free_mask[i]
                best = int(np.square(near - goal).sum(axis=1).argmin())
            out.counts[i] = min(k, 1)
            if k:
                out.q[i, 0], out.residual[i, 0], out.branch[i, 0], out.free[i, 0] = (
                    row[best] for row in rows
                )
                goal = out.q[i, 0] if follow else goal
        pad_solutions(out, np.nan)
        return replace(
            self,
            q=out.q,
            residual=out.residual,
            count=out.counts,
            branch_code=out.branch,
            free_mask=out.free,
        )

    @cached_property
    def solved(self) -> NDArray[np.bool_]:
        """True where a pose has a solution, shape (m,)."""
        return self.count > 0

    @property
    def bad(self) -> IntArray:
        """Indices of the poses that were skipped because they are none, in flattened order."""
        return np.flatnonzero(np.isnan(self.targets[..., 3, 3]))

    def room(self, m: int, kmax: int, n: int) -> Outputs:
        """Its arrays, for another answer to m poses.

        Raises
        ------
        ArgumentError
            They are for other numbers of poses or solutions, or parts of larger arrays.
        """
        arrays = self.q, self.residual, self.count, self.branch_code, self.free_mask
        axes, whole = self.count.ndim, all(a.flags.carray for a in arrays)
        if self.count.size != m or self.q.shape[axes:] != (kmax, n) or not whole:
            here = f"{m} poses with up to {kmax} solutions of {n} joints"
            raise ArgumentError(f"out: expected an answer to {here}, got arrays {self.q.shape}")
        return Outputs._make(a.reshape(m, *a.shape[axes:]) for a in arrays)

    def each(self, change: Callable[[Any], Any]) -> IKBatch:
        """The batch with all of its arrays changed in one way."""
        changed: dict[str, Any] = {key: change(getattr(self, key)) for key in ARRAYS}
        return replace(self, **changed)

    def shaped(self, shape: tuple[int, ...]) -> IKBatch:
        """The batch with the axes of its poses folded to others."""
        axes = self.count.ndim
        return self.each(lambda a: np.reshape(a, (*shape, *np.shape(a)[axes:])))

    def among(self, good: NDArray[np.bool_]) -> IKBatch:
        """The batch as part of a larger one (m,), with nothing found at the other poses."""
        batch = self.each(lambda a: np.zeros((len(good), *a.shape[1:]), a.dtype))
        for key in ARRAYS:
            getattr(batch, key)[good] = getattr(self, key)
        for nothing in (batch.targets, batch.q, batch.residual):
            nothing[~good] = np.nan
        batch.branch_code[~good] = -1
        return batch

    def __len__(self) -> int:
        return len(self.count)

    @overload
    def __getitem__(self, index: int) -> IKSolutions: ...
    @overload
    def __getitem__(self, index: slice) -> IKBatch: ...
    @overload
    def __getitem__(self, index: tuple[int, ...]) -> IKSolutions | IKBatch: ...
    def __getitem__(self, index: Any) -> IKSolutions | IKBatch:
        if isinstance(index, int) and self.count.ndim == 1:
            if not -len(self) <= index < len(self):
                raise IndexError(f"pose {index} of a batch of {len(self)}")
            return self.solutions(index % len(self))
        part = self.each(lambda a: a[index])
        return part if part.count.ndim else part.shaped((1,)).solutions(0)

    def __repr__(self) -> str:
        reached, total = int(self.solved.sum()), int(self.count.sum())
        return f"<IKBatch: {self.count.size} poses, {reached} reached, {total} solutions>"
