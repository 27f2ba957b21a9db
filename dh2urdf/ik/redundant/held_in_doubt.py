"""Poses in doubt of six joints that are left where one of seven is held: they are searched, too."""

import numpy as np

from dh2urdf.ik.arm import (
    ACCEPT,
    WIDTH,
    Family,
    Outputs,
    SolverBase,
    drop_dull_members,
    from_starts,
    hold,
    inside,
    middle,
    select_solver,
    spare_joints,
)
from dh2urdf.ik.redundant.held_values import HeldJoints, HeldOneByOne
from dh2urdf.ik.redundant.searched import nearly_reaching
from dh2urdf.kernels.certificate import finish_batch, measure_all, name_batch
from dh2urdf.transforms import Array

SHARP = 1e-11
"""Residual [m and rad] of a solution that is put in place of what a search finds."""


class InDoubt(SolverBase):
    """Six turning joints: what their solver finds of a pose, and what many starts do."""

    def __init__(self, inner: SolverBase) -> None:
        super().__init__(inner.chain, inner.task)
        self.inner, self.name, self.kmax = inner, inner.name, WIDTH

    def details(self) -> str:
        """Say how the joints that move are solved for."""
        return self.inner.details()

    def solve_batch(self, Ts: Array, within_limits: bool, out: Outputs) -> None:
        """Solve poses Ts (m, 4, 4), one after the other."""
        for i in range(len(Ts)):
            out.put(np.array([i]), self.solve(Ts[i : i + 1], within_limits, void=False))

    def solve(self, T: Array, within_limits: bool, void: bool) -> Outputs:
        """Solve a pose (1, 4, 4); ``void``: equations say so little that others are searched."""
        known, found = self.inner.before_search(T)
        wide = from_starts(self.chain, T, self._candidates(T, found) if void else found, known)
        name_batch(self.chain.tables, T, known)
        drop_dull_members(known)
        sharp = known.residual[0, : known.counts[0]] <= SHARP
        for k in np.flatnonzero(sharp & (known.free[0, : known.counts[0]] != 0)).tolist():
            self._put_for_its_family(wide, T[0], known, k)
        if within_limits:
            finish_batch(self.chain.tables, T, True, wide)
            self._enter_limits(wide, T)
        drop_dull_members(wide)
        return wide

    def _candidates(self, T: Array, found: Outputs) -> Outputs:
        """What is found of a pose (1, 4, 4), and what steps that heed valleys lead to."""
        q, error = nearly_reaching(self.chain, T[0], self.task)
        q = np.concatenate([found.q[0, : found.counts[0]], q[np.abs(error).max(axis=1) <= ACCEPT]])
        more = Outputs.of(1, max(len(q), 1), self.chain.n)
        more.q[0, : len(q)], more.counts[0] = q, len(q)
        return more

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

    def make(self, values: tuple[float, ...]) -> HeldJoints:
        """The solver for some held values; with joints to spare it is the usual one."""
        held = dict(zip(self.held, values, strict=True))
        rest = hold(self.chain, held)
        inner = select_solver(rest, self.task)
        if isinstance(inner, SolverBase) and not spare_joints(rest, self.task):
            inner = InDoubt(inner)
        return HeldJoints(self.chain, held, self.task, inner)
