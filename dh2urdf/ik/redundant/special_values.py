"""Held values at which what is left of an arm has a joint to spare: there two axes line up.

The solver of a held joint is chosen for any of its values. At a special one, as 0 of a shoulder
whose axes 1 and 3 then are one line, the other joints move along families, and a solver is made
for that value alone. So is one for poses in doubt, and many starts are followed, too.
"""

from functools import cached_property

import numpy as np

from dh2urdf.engine import Step
from dh2urdf.ik.arm import (
    SPARE_RANK,
    TRIALS,
    TWO_PI,
    Family,
    HeldSolver,
    IntArray,
    Outputs,
    Solver,
    SolverBase,
    Task,
    drop_dull_members,
    from_starts,
    hold,
    inside,
    middle,
    near_ranges,
    random_configurations,
    scaled_jacobian,
    select_solver,
    spare_joints,
)
from dh2urdf.ik.redundant.held_values import HeldEnd, HeldJoints, HeldOneByOne
from dh2urdf.ik.redundant.held_wrist import TRIAL_VALUE
from dh2urdf.kernels.certificate import finish_batch, measure_all
from dh2urdf.transforms import Array

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


SHARP = 1e-11
"""Residual [m and rad] of a solution that is put in place of what a search finds."""


class InDoubt(SolverBase):
    """Six turning joints: what their solver finds of a pose, and what many starts do."""

    def __init__(self, inner: SolverBase) -> None:
        super().__init__(inner.chain, inner.task)
        self.inner, self.name, self.kmax = inner, inner.name, inner.kmax

    def details(self) -> str:
        """Say how the joints that move are solved for."""
        return self.inner.details()

    def solve_batch(self, Ts: Array, within_limits: bool, out: Outputs) -> None:
        """Solve poses Ts (m, 4, 4), one after the other."""
        known = Outputs.of(len(Ts), self.kmax, self.chain.n)
        self.inner.solve_batch(Ts, False, known)
        for i in range(len(Ts)):
            mine, T = known.rows(slice(i, i + 1)), Ts[i : i + 1]
            wide = from_starts(self.chain, T, mine, mine)
            drop_dull_members(mine)
            sharp = mine.residual[0, : mine.counts[0]] <= SHARP
            for k in np.flatnonzero(sharp & (mine.free[0, : mine.counts[0]] != 0)).tolist():
                self._put_for_its_family(wide, T[0], mine, k)
            if within_limits:
                finish_batch(self.chain.tables, T, True, wide)
                self._enter_limits(wide, T)
            drop_dull_members(wide)
            out.put(np.array([i]), wide)

    def _enter_limits(self, wide: Outputs, T: Array) -> None:
        """Go along families into the limits: some are reached only where they are none."""
        q, n = wide.q[0, : wide.counts[0]], self.chain.n
        outside = ~inside(self.chain, q) & (wide.free[0, : len(q)] != 0)
        for k in np.flatnonzero(outside):
            joints = np.flatnonzero(wide.free[0, k] >> np.arange(n) & 1).tolist()
            family = Family(self.chain, self.task, T[0], tuple(joints), q[k].copy())
            member = family.nearest(middle(self.chain), within_limits=True)
            if member is not None:
                q[k] = member
        if outside.any():
            tables, number = self.chain.tables, self.task.number
            measure_all(tables, number, T, wide.q, wide.counts, wide.residual)

    def _put_for_its_family(self, wide: Outputs, T: Array, known: Outputs, k: int) -> None:
        """Put a known solution, which names its family, in place of what a walk reaches from it.

        What other joints move from stays: that is a member of a larger family.
        """
        q, mask = known.q[0, k], known.free[0, k]
        family = Family(self.chain, self.task, T, tuple(range(self.chain.n)), q.copy())
        count = int(wide.counts[0])
        on = family.contains(wide.q[0, :count], count) & (wide.free[0, :count] & ~mask == 0)
        if on.any():
            rows = [k, *np.flatnonzero(~on)]
            for array, source in zip(wide, known, strict=True):
                if array.ndim > 1:
                    array[0, 1 : len(rows)] = array[0, rows[1:]]
                    array[0, 0] = source[0, k]
            wide.counts[0] = len(rows)


class HeldInDoubt(HeldOneByOne):
    """A solver for every value, of poses in doubt."""

    def make(self, values: tuple[float, ...]) -> Solver:
        """The solver for some held values; with joints to spare it is the usual one."""
        held = dict(zip(self.held, values, strict=True))
        rest = hold(self.chain, held)
        inner = select_solver(rest, self.task)
        if isinstance(inner, SolverBase) and not spare_joints(rest, self.task):
            inner = InDoubt(inner)
        return HeldJoints(self.chain, held, self.task, inner)


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
        self._solve_again(self.one_by_one, Ts, values, within_limits, out, special)
        rows = np.setdiff1d(doubt, special)
        self._solve_again(self.in_doubt, Ts, values, within_limits, out, rows)

    def _solve_again(
        self,
        solver: HeldSolver,
        Ts: Array,
        values: Array,
        within_limits: bool,
        out: Outputs,
        rows: IntArray,
    ) -> None:
        """Solve some of the poses by another solver; in doubt, what is sharper stays."""
        if len(rows):
            found, poses = Outputs.of(len(rows), self.kmax, self.chain.n), Ts[rows]
            solver.solve_held(np.ascontiguousarray(poses), values[rows], within_limits, found)
            blunt = (_worst(found) > SHARP) & (_worst(out.rows(rows)) <= SHARP)
            kept = ~blunt | (out.counts[rows] == 0) | (solver is self.one_by_one)
            out.put(rows[kept], found.rows(kept))

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
        for _ in range(ROUNDS if len(dips) else 0):
            trial = dips[:, None] + step * np.linspace(-1.0, 1.0, CLOSER)
            best = self._depth(trial.ravel()).reshape(trial.shape).argmin(axis=1)
            dips = trial[np.arange(len(dips)), best]
            step *= 2.0 / (CLOSER - 1)
        return dips[self._rank_gap(dips) <= DIP] if len(dips) else dips


def _worst(out: Outputs) -> Array:
    """Largest residual of each pose (m,); 0 where there is no solution."""
    used = np.arange(out.residual.shape[1]) < out.counts[:, None]
    worst: Array = np.where(used, out.residual, 0.0).max(axis=1)
    return worst


def at_any_value(solver: HeldSolver, task: Task) -> HeldSolver:
    """The solver with special ones at the values of its joint at which it has none."""
    ready = len(solver.held) > 1 or type(solver) in (HeldEnd, HeldOneByOne)
    return solver if ready else HeldAtAnyValue(solver, task)
