"""Held values at which what is left of an arm has a joint to spare: there two axes line up.

The solver of a held joint is chosen for any of its values. At a special one, as 0 of a shoulder
whose axes 1 and 3 then are one line, the other joints move along families, and a solver is made
for that value alone. So is one for poses in doubt, and many starts are followed, too.
"""

from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from dh2urdf.engine import Step
from dh2urdf.ik.arm import (
    SNAP,
    SPARE_RANK,
    TRIALS,
    TWO_PI,
    AxisLines,
    HeldSolver,
    IntArray,
    Outputs,
    Task,
    keep_known,
    near_ranges,
    random_configurations,
    scaled_jacobian,
)
from dh2urdf.ik.redundant.held_in_doubt import SHARP, HeldInDoubt, InDoubt
from dh2urdf.ik.redundant.held_values import HeldEnd, HeldOneByOne
from dh2urdf.ik.redundant.held_wrist import TRIAL_VALUE, HeldWrist
from dh2urdf.transforms import Array, inverse

GRID = 48
"""Values at which the rank is looked at first: a turn in steps of 7.5 degrees."""

CLOSER, ROUNDS = 9, 8
"""Values between the neighbours of a dip, and how often: each round comes four times as near."""

BESIDE = 1e-4
"""Distance [rad or m] of a special value within which the rank decides; dips are to less."""

LINED_UP = 1e-10
"""Relative singular value that is none: half a turn moves the tool by less than ``ACCEPT``. Above
it the usual solver's answers are right to 1e-6 and better."""

DIP = 1e-3
"""Relative singular value above which a dip is none that a special value makes."""


FOLDED = 1e-5
"""Distance [m] between the centres of shoulder and wrist within which an elbow is folded."""


class HeldAtAnyValue(HeldSolver):
    """A solver of one held joint, and another at the values at which the rest has one to spare."""

    def __init__(self, inner: HeldSolver, task: Task) -> None:
        super().__init__(inner.chain, inner.held)
        self.inner, self.task = inner, task
        self.name, self.kmax = inner.name, inner.kmax

    def details(self) -> str:
        """Say how the joints that move are solved for."""
        return self.inner.details()

    def solve_held(self, Ts: Array, values: Array, within_limits: bool, out: Outputs) -> None:
        """Solve poses Ts (m, 4, 4), each with its held value (m, 1)."""
        doubt = self.inner.solve_plainly(Ts, values, within_limits, out)
        special = self._special(values[:, 0])
        folded = _left_open(np.flatnonzero(self._folded(Ts)), out, doubt).tolist()
        if len(special):
            found = Outputs.of(len(special), self.kmax, self.chain.n)
            poses = np.ascontiguousarray(Ts[special])
            self.one_by_one.solve_held(poses, values[special], within_limits, found)
            out.put(special, found)
        for i in np.setdiff1d(doubt, special).tolist() if len(doubt) else ():
            if i not in folded:
                self._look_wider(Ts, values, within_limits, out, i, void=False)
        for i in folded:
            self._look_wider(Ts, values, within_limits, out, i, void=True)

    def _look_wider(
        self, Ts: Array, values: Array, within_limits: bool, out: Outputs, i: int, void: bool
    ) -> None:
        """Add to the solutions of pose i, in doubt, what a solver for its value finds."""
        T, mine = np.ascontiguousarray(Ts[i : i + 1]), out.rows(slice(i, i + 1))
        solver = self.in_doubt.in_batch((float(values[i, 0]),), alone=False)
        inner, known = solver.inner, solver.moved(mine)
        if isinstance(inner, InDoubt):
            found = inner.solve(T, within_limits, void or known.counts[0] == 0)
        else:
            found = Outputs.of(1, solver.kmax, self.chain.n - 1)
            inner.solve_batch(T, within_limits, found)
        keep_known(inner.chain, T, known, found)
        solver.insert(found, mine)

    def _folded(self, Ts: Array) -> NDArray[np.bool_]:
        """Which poses (m, 4, 4) put the centre of the wrist onto that of the shoulder."""
        if self._centres is None:
            return np.zeros(len(Ts), np.bool_)
        shoulder, wrist = self._centres
        away = Ts[:, :3, :3] @ wrist + Ts[:, :3, 3] - shoulder
        folded: NDArray[np.bool_] = np.abs(away).max(axis=1) <= FOLDED
        return folded

    @cached_property
    def _centres(self) -> tuple[Array, Array] | None:
        """Where axes 1, 2, 3 meet, in the base, and 5, 6, 7, in the tool; None: they do not."""
        lines, n = AxisLines(self.chain, SNAP), self.chain.n
        seven = n == 7 and not self.chain.prismatic.any() and self.task is Task.POSE
        if not seven or not (lines.spherical(0) and lines.spherical(4)):
            return None
        home = inverse(self.chain.fk(np.zeros(n)))
        return lines.points[1], home[:3, :3] @ lines.points[5] + home[:3, 3]

    def steps(
        self, Ts: Array, values: Array, within_limits: bool, out: Outputs
    ) -> tuple[Step, ...]:
        """Kernels that solve poses Ts (m, 4, 4), each with its held value (m,)."""
        return self.inner.steps(Ts, values, within_limits, out)

    def clear_about(self, value: float) -> tuple[float, float]:
        """The values between two special ones, up to full turns."""
        ways = self.values - value
        if not self.chain.prismatic[self.held[0]]:
            ways = np.concatenate([ways, np.mod(ways, TWO_PI), np.mod(ways, TWO_PI) - TWO_PI])
        above = ways[ways >= 0.0].min(initial=np.inf) - 2.0 * BESIDE
        below = ways[ways <= 0.0].max(initial=-np.inf) + 2.0 * BESIDE
        return (value + below, value + above) if below < 0.0 < above else (value, value)

    def _special(self, values: Array) -> IntArray:
        """Rows of the values (m,) at which the rest has a joint to spare."""
        near = np.zeros(len(values), np.bool_)
        for special in self.values:
            near |= self._gap(values - special) <= BESIDE
        rows = np.flatnonzero(near)
        if len(rows):
            different, which = np.unique(values[rows], return_inverse=True)
            rows = rows[(self._rank_gap(different) <= LINED_UP)[which]]
        return rows

    def _gap(self, ways: Array) -> Array:
        """Distances of values that are ways (m,) apart, up to full turns."""
        if self.chain.prismatic[self.held[0]]:
            return np.abs(ways)
        return 2.0 * np.abs(np.sin(0.5 * ways))

    @cached_property
    def one_by_one(self) -> HeldOneByOne:
        """The solver made anew for each value at which it is asked."""
        return HeldOneByOne(self.chain, self.held, self.task)

    @cached_property
    def in_doubt(self) -> HeldOneByOne:
        """The same for poses in doubt."""
        return HeldInDoubt(self.chain, self.held, self.task)

    def _jacobians(self, values: Array) -> Array:
        """The rest's Jacobian at values (m,) and in generic configurations, (m, trials, 6, k)."""
        joint, n = self.held[0], self.chain.n
        q = np.repeat(random_configurations(self.chain, TRIALS)[None], len(values), axis=0)
        q[:, :, joint] = values[:, None]
        J = scaled_jacobian(self.chain, self.task, q.reshape(-1, n))
        return np.delete(J, joint, axis=2).reshape(len(values), TRIALS, -1, n - 1)

    def _singular_values(self, values: Array) -> Array:
        """Relative singular values (m, k) of the rest's Jacobian at values (m,), generic ones."""
        sigma = np.linalg.svd(self._jacobians(values), compute_uv=False)
        largest: Array = (sigma / sigma[:, :, :1]).max(axis=1)
        return largest

    @cached_property
    def _rank(self) -> int:
        """Rank of the rest's Jacobian at nearly all values."""
        return int((self._singular_values(np.array([TRIAL_VALUE])) > SPARE_RANK).sum())

    def _rank_gap(self, values: Array) -> Array:
        """The singular value, at values (m,), that vanishes where the rest loses rank, (m,)."""
        gap: Array = self._singular_values(values)[:, self._rank - 1]
        return gap

    def _depth(self, values: Array) -> Array:
        """What vanishes at values (m,) where the rest loses rank, in the least time, (m,)."""
        rows = 6 if self.task is Task.POSE else 0
        if self.chain.n - 1 == rows == self._rank:
            largest: Array = np.abs(np.linalg.det(self._jacobians(values))).max(axis=1)
            return largest
        return self._rank_gap(values)

    @cached_property
    def values(self) -> Array:
        """Special values, to within ``BESIDE``, shape (k,)."""
        joint, count = self.held[0], GRID
        low, high = -np.pi, np.pi
        if self.chain.prismatic[joint]:
            (low, high), count = (float(end[joint]) for end in near_ranges(self.chain)), GRID + 1
        grid = low + (high - low) * np.arange(count) / GRID
        gaps, step = self._depth(grid), (high - low) / GRID
        if np.ptp(gaps) <= LINED_UP * gaps.max():  # the joint at an end turns nothing of the rest
            return grid[:0]
        around = np.concatenate([[np.inf], gaps, [np.inf]])
        dips = grid[(gaps <= around[:-2]) & (gaps <= around[2:])]
        ways = np.linspace(-1.0, 1.0, CLOSER)
        for _ in range(ROUNDS if len(dips) else 0):
            trial = dips[:, None] + step * ways
            best = self._depth(trial.ravel()).reshape(trial.shape).argmin(axis=1)
            dips = trial[np.arange(len(dips)), best]
            step *= 2.0 / (CLOSER - 1)
        return dips[self._rank_gap(dips) <= DIP] if len(dips) else dips


def _left_open(some: IntArray, out: Outputs, doubt: IntArray) -> IntArray:
    """Those of some poses in doubt, or without all branches, each of them sharp and isolated."""
    if not len(some):  # as in most batches, whose residuals then need not be looked at
        return some
    every = out.residual[some, : HeldWrist.kmax].max(axis=1) <= SHARP
    every &= (out.counts[some] == HeldWrist.kmax) & ~out.free[some].any(axis=1)
    left: IntArray = some[~every | np.isin(some, doubt)]
    return left


def at_any_value(solver: HeldSolver, task: Task) -> HeldSolver:
    """The solver with special ones at the values of its joint at which it has none."""
    ready = len(solver.held) > 1 or type(solver) in (HeldEnd, HeldOneByOne)
    return solver if ready else HeldAtAnyValue(solver, task)
