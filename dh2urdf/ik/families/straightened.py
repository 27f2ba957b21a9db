"""Values that move more joints than there are, by a chain of fewer joints that move freely.

What is left of the chain (:mod:`~.straight_chain`) is solved as if all its joints moved freely, by
the family that covers it, and of the solutions those stand whose joints are where some values put
them.
"""

import itertools
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from dh2urdf.chain import CoupledChain, SerialChain
from dh2urdf.exceptions import NoSolverError
from dh2urdf.ik.arm import (
    NOMINAL,
    TWO_PI,
    IntArray,
    Others,
    Outputs,
    Solver,
    SolverBase,
    Task,
    coupled,
    inside,
    middle,
    moving_joints,
    search_in_doubt,
    select_solver,
    spare_joints,
    turned_to,
)
from dh2urdf.ik.families.short import search_short
from dh2urdf.ik.families.straight_chain import WHOLE, straighten
from dh2urdf.kernels.certificate import find_solutions, finish_batch
from dh2urdf.transforms import Array

MOST_JOINTS = 6
"""Joints of the longest chain that all solutions are found of when it moves freely."""

TOGETHER = 1e-3
"""Angle [rad], or length in sizes of the arm, by which a joint may be off where its values put it:
Newton's method brings it there, or the pose is not reached."""


class Straightened(SolverBase):
    """All configurations by a chain that moves freely."""

    name = "straightened chain"
    needs = "joints that follow others, and no more than six without those that parallel axes spare"

    def __init__(self, chain: SerialChain, task: Task = Task.POSE, others: Others = ()) -> None:
        super().__init__(chain, task, others)
        assert isinstance(chain, CoupledChain)
        self.straight = straighten(chain, task)
        self.inner = solver_of(chain, task)
        matrix, slides = self.straight.matrix, self.straight.chain.prismatic
        self.rows, self.back = _rows_that_tell(matrix)
        self.shifts = _shifts(self.back, slides[self.rows])
        self.kmax = self.inner.kmax * len(self.shifts)

    @classmethod
    def obstacle(
        cls, chain: SerialChain, task: Task = Task.POSE, tolerance: float = NOMINAL
    ) -> str | None:
        """Say what keeps the family from covering the chain for the task; None: it covers it."""
        if not isinstance(chain, CoupledChain):
            return "no joint follows another"
        if task is Task.POSITION_AXIS:
            return f"it solves for the full pose or the position, not for {task.value}"
        if spare_joints(chain, task):
            return cls.if_spare
        straight = straighten(chain, task)
        if straight.chain.n > MOST_JOINTS:
            return f"{straight.chain.n} joints are left that have to move together"
        if spare_joints(straight.chain, task):
            return "its joints, each by itself, move on while the tool stays"
        try:
            solver_of(chain, task)
        except NoSolverError:
            return "no solver finds all solutions of its joints, each by itself"
        return None

    def details(self) -> str:
        """Name the sums, and the family."""
        slides = self.straight.chain.prismatic
        sums = [
            f"{'slide' if slide else 'turn'} by {_sum(row, self.chain.names)}"
            for row, slide in zip(self.straight.matrix, slides, strict=True)
        ]
        return (
            f"its joints do the same as {len(sums)} that {', '.join(sums)}; these are solved as if "
            f"they moved freely: {self.inner.name}"
        )

    def solve_batch(self, Ts: Array, within_limits: bool, out: Outputs) -> None:
        """Solve poses Ts (m, 4, 4)."""
        found = Outputs.of(len(Ts), self.inner.kmax, self.straight.chain.n)
        self.inner.solve_batch(Ts, False, found)
        self._put_values(found, out)
        if self.task is Task.POSITION:
            for i in range(len(Ts)):
                row = slice(i, i + 1)
                self._finish_position(Ts[i], within_limits, found.rows(row), out.rows(row))
            return
        families = (found.free != 0) & (np.arange(self.inner.kmax) < found.counts[:, None])
        rows = np.flatnonzero(families.any(axis=1))
        if len(rows) and len(self.straight.matrix) > self.chain.n:
            self._search(np.ascontiguousarray(Ts[rows]), rows, within_limits, out)
            others = np.setdiff1d(np.arange(len(Ts)), rows)
            some = out.rows(others)
            finish_batch(self.chain.tables, np.ascontiguousarray(Ts[others]), within_limits, some)
            out.put(others, some)
        else:
            finish_batch(self.chain.tables, Ts, within_limits, out)

    def _put_values(self, found: Outputs, out: Outputs) -> None:
        """Values that put the joints where solutions have them, as candidates, to q and counts."""
        out.counts[:] = 0
        matrix, slides = self.straight.matrix, self.straight.chain.prismatic
        pose, k = np.nonzero(np.arange(found.q.shape[1]) < found.counts[:, None])
        joints = found.q[pose, k]
        for shift in self.shifts:
            q = (joints[:, self.rows] + shift) @ self.back.T
            gap = q @ matrix.T - joints
            gap -= np.where(slides, 0.0, TWO_PI * np.rint(gap / TWO_PI))
            reach = np.where(slides, self.chain.size, 1.0) * TOGETHER
            for i in np.flatnonzero((np.abs(gap) <= reach).all(axis=1)):
                m = pose[i]
                out.q[m, out.counts[m]] = q[i]
                out.counts[m] += 1

    def _finish_position(self, T: Array, within_limits: bool, found: Outputs, out: Outputs) -> None:
        """Make solutions of the candidates of one pose T (4, 4), of which the origin counts."""
        arm = coupled(self.chain, within_limits=False)
        starts, goal = out.q[0, : out.counts[0]].copy(), (self.task.number, T, self.chain.size)
        q, residual = np.empty_like(starts), np.empty(len(starts))
        count, _ = find_solutions(arm, goal, starts, q, residual)
        q = turned_to(self.chain, q[:count], middle(self.chain))
        free = np.zeros(count, np.int64)
        if found.free[0, : found.counts[0]].any():
            free = moving_joints(self.chain, self.task, q)
        kept = np.flatnonzero((free != 0) | inside(self.chain, q) | (not within_limits))
        k = out.counts[0] = len(kept)
        out.q[0, :k], out.residual[0, :k] = q[kept], residual[kept]
        out.branch[0, :k], out.free[0, :k] = -1, free[kept]

    def _search(self, Ts: Array, rows: IntArray, within_limits: bool, out: Outputs) -> None:
        """Search at poses with a family of the joints, in which the values may be anywhere."""
        found = out.rows(rows)
        if self.chain.n == MOST_JOINTS:
            deep = np.arange(len(rows))
            wide = search_in_doubt(self.chain, Ts, found, deep, within_limits)
        else:
            wide = search_short(self.chain, Ts, found, within_limits)
        out.put(rows, wide)


@lru_cache(maxsize=8)
def solver_of(chain: CoupledChain, task: Task) -> Solver:
    """The solver of the straightened chain.

    Raises
    ------
    NoSolverError
    """
    return select_solver(straighten(chain, task).chain, task)


def _sum(row: Array, names: tuple[str, ...]) -> str:
    """Values times numbers in words: ``joint_3 - 0.5 joint_2``."""
    terms = sorted(zip(row.tolist(), names, strict=True), key=lambda term: term[0] < 0.0)
    text = ""
    for factor, name in terms:
        if factor:
            size = "" if abs(factor) == 1.0 else f"{abs(factor):g} "
            sign = ("-" if factor < 0.0 else "") if not text else " - " if factor < 0.0 else " + "
            text += f"{sign}{size}{name}"
    return text


def _rows_that_tell(matrix: Array) -> tuple[list[int], Array]:
    """Rows (n) of a matrix (m, n) from which values follow, and their inverse."""
    n, best, chosen = matrix.shape[1], np.inf, list(range(matrix.shape[1]))
    for rows in itertools.combinations(range(len(matrix)), n):
        size = abs(np.linalg.det(matrix[list(rows)]))
        if WHOLE < size < best:
            best, chosen = size, list(rows)
    return chosen, np.asarray(np.linalg.inv(matrix[chosen]), float)


def _shifts(back: Array, slides: NDArray[np.bool_]) -> list[Array]:
    """Full turns of joints, by which values differ that are no full turns themselves, each (n,)."""
    n = len(back)
    order = round(1.0 / abs(float(np.linalg.det(back))))
    found: dict[tuple[float, ...], Array] = {}
    for turns in itertools.product(range(max(order, 1)), repeat=n):
        if any(t and s for t, s in zip(turns, slides, strict=True)):
            continue
        values = np.remainder(np.round(back @ np.array(turns, float), 9), 1.0)
        found.setdefault(tuple(np.remainder(values, 1.0).tolist()), TWO_PI * np.array(turns, float))
    return list(found.values())
