"""Arms that hardly move in some direction, as where a twist is a millionth: search what is lost.

The pose then says little of a combination of joints, and equations that are solved one after the
other lose what it says to rounding.
"""

import numpy as np

from dh2urdf.chain import SerialChain
from dh2urdf.ik.arm import (
    ACCEPT,
    Outputs,
    Solver,
    SolverBase,
    Task,
    branch_words_of,
    inside,
    keep_known,
    middle,
    moving_joints,
    scaled_jacobian,
    search_in_doubt,
    spare_joints,
    task_error,
    task_jacobian,
    tips_at,
    turned_to,
)
from dh2urdf.ik.families import search_short
from dh2urdf.kernels.certificate import finish_batch
from dh2urdf.transforms import Array

STARTS = 64
STEPS = 60

SIX = 6
"""Joints of an arm of which poses without a solution are searched, and singular ones."""

WEAK = 1e-5
"""Singular value, relative to the largest, of a second direction in which a solution hardly moves:
curves of nearly exact solutions come close to each other, and held values meet some of them."""

STILL = 1e-9
"""That of a direction in which an isolated solution may move on: it may be on a family."""

LESS = 0.05
"""Damping after a good step; in a valley it has to fall below the square of its slope."""


class Search(SolverBase):
    """Some solutions of any chain, by search alone: where a held value leaves no other solver."""

    name = "search"
    kmax = STARTS

    def details(self) -> str:
        """Say what is done."""
        return f"damped least squares from {STARTS} starts; there may be more solutions"

    def solve_batch(self, Ts: Array, within_limits: bool, out: Outputs) -> None:
        """Search for solutions of poses Ts (m, 4, 4), one after the other."""
        for i in range(len(Ts)):
            q, error = nearly_reaching(self.chain, Ts[i], self.task)
            fits = np.abs(error).max(axis=1) <= ACCEPT
            q, off = turned_to(self.chain, q[fits], middle(self.chain)), np.abs(error[fits])
            free = moving_joints(self.chain, self.task, q)
            kept = np.flatnonzero((free != 0) | inside(self.chain, q) | (not within_limits))
            kept = kept[: out.q.shape[1]]
            k = out.counts[i] = len(kept)
            out.q[i, :k], out.residual[i, :k] = q[kept], off[kept].max(axis=1)
            out.branch[i, :k], out.free[i, :k] = -1, free[kept]


class SearchedSolver:
    """A solver whose lost poses are searched for from many starts."""

    def __init__(self, inner: Solver) -> None:
        self.inner, self.chain, self.kmax, self.name = inner, inner.chain, inner.kmax, inner.name
        self.branch_words = branch_words_of(inner)
        self.at_singular = inner.chain.n == SIX and spare_joints(inner.chain, Task.POSE) <= 1

    def explain(self) -> str:
        """Name the solver, and that it is helped."""
        what = "a pose that is not found, and a singular one," if self.at_singular else ""
        return (
            f"{self.inner.explain()}\nsome joints hardly move the tool together; "
            f"{what or 'a pose that is not found'} is searched for from many starts"
        )

    def solve_batch(self, Ts: Array, within_limits: bool, out: Outputs) -> None:
        """Solve poses Ts (m, 4, 4), and search: of six joints where there is no solution."""
        always = self.chain.n < SIX
        self.inner.solve_batch(Ts, within_limits and not always, out)
        if self.at_singular:
            self._look_at_singular(Ts, within_limits, out)
        rows = np.flatnonzero((out.counts == 0) | always)
        if not len(rows):
            return
        poses, known = np.ascontiguousarray(Ts[rows]), out.rows(rows)
        if within_limits and not always:
            self.inner.solve_batch(poses, False, known)
        out.put(rows, search_short(self.chain, poses, known, within_limits))

    def _look_at_singular(self, Ts: Array, within_limits: bool, out: Outputs) -> None:
        """Search where solutions hardly move in two directions, or isolated ones not in one."""
        used = np.arange(out.q.shape[1]) < out.counts[:, None]
        J, weak = scaled_jacobian(self.chain, Task.POSE, out.q[used]), np.zeros_like(used)
        sigma = np.linalg.svd(J, compute_uv=False)
        still = (sigma[:, SIX - 1] <= STILL * sigma[:, 0]) & (out.free[used] == 0)
        weak[used] = still | (sigma[:, SIX - 2] <= WEAK * sigma[:, 0])
        rows = np.flatnonzero(weak.any(axis=1))
        if not len(rows):
            return
        poses, known = np.ascontiguousarray(Ts[rows]), out.rows(rows)
        if within_limits:
            self.inner.solve_batch(poses, False, known)
        wide = search_in_doubt(self.chain, poses, known, np.arange(len(rows)), False)
        for i in range(len(rows)):
            row = slice(i, i + 1)
            keep_known(self.chain, poses[row], known.rows(row), wide.rows(row))
        if within_limits:
            finish_batch(self.chain.tables, poses, True, wide)
        out.put(rows, wide)

    def __str__(self) -> str:
        return self.name


def nearly_reaching(
    chain: SerialChain, T: Array, task: Task, stiff: float = 1.0
) -> tuple[Array, Array]:
    """Configurations (s, n) that come as near to a pose as they can, and their task errors.

    ``stiff`` is the weight of positions, in sizes of the arm, against the orientation.
    The steps are by singular values, not by normal equations, which lose the directions in which
    the pose hardly changes.
    """
    rng = np.random.default_rng(3)
    q = rng.uniform(-1.0, 1.0, (STARTS, chain.n)) * np.where(chain.prismatic, chain.size, np.pi)
    weight = np.ones(3 if task is Task.POSITION else 6)
    weight[:3] = stiff / chain.size
    error = _weighted(chain, q, T, task, weight)
    damping = np.full(STARTS, 1e-2)
    for _ in range(STEPS):
        U, sigma, Vt = np.linalg.svd(task_jacobian(chain, task, q) * weight[:, None], False)
        square = sigma**2 + (sigma**2).sum(axis=1, keepdims=True) * damping[:, None] + 1e-300
        along = np.einsum("kij,ki->kj", U, error) * sigma / square
        step = np.einsum("kij,ki->kj", Vt, along)
        step *= np.minimum(1.0, 0.5 / np.maximum(np.abs(step).max(axis=1), 1e-12))[:, None]
        trial = _weighted(chain, q + step, T, task, weight)
        better = (trial**2).sum(axis=1) < (error**2).sum(axis=1)
        q[better] += step[better]
        error[better] = trial[better]
        damping = np.clip(damping * np.where(better, LESS, 10.0), 1e-30, 1e3)
    return q, error / weight


def _weighted(chain: SerialChain, q: Array, T: Array, task: Task, weight: Array) -> Array:
    """Weighted task errors of configurations q (k, n), shape (k, 3 or 6)."""
    return task_error(tips_at(chain, q), T, task) * weight
