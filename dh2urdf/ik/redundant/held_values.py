"""Which solver a chain with held joints gets, and those that are not a spherical triple."""

from collections.abc import Mapping

import numpy as np

from dh2urdf.chain import CoupledChain, SerialChain
from dh2urdf.engine import Step
from dh2urdf.exceptions import ConfigurationError, NoSolverError
from dh2urdf.ik.arm import (
    HeldSolver,
    Outputs,
    Solver,
    SolverBase,
    Task,
    branch_words_of,
    hold,
    keep_most_apart,
    select_solver,
    spare_joints,
    without_end,
)
from dh2urdf.ik.families import SLIDES, General6R
from dh2urdf.ik.redundant.held_wrist import TRIAL_VALUE, HeldWrist
from dh2urdf.ik.redundant.searched import Search, SearchedSolver
from dh2urdf.kernels.chain import held_poses, insert_held_batch
from dh2urdf.transforms import Array

KEPT_VALUES = 64
"""Solvers for single held values kept ready, the latest ones."""


class HeldJoints:
    """Solver of a chain with joints held at values: that of the rest, columns put back."""

    def __init__(
        self, chain: SerialChain, held: Mapping[int, float], task: Task, inner: Solver | None = None
    ) -> None:
        if len(held) == chain.n:
            raise ConfigurationError(f"locked: all {chain.n} joints are held, none is left to move")
        self.chain, self.held = chain, dict(held)
        self.inner: Solver = inner or select_solver(hold(chain, held), task)
        if isinstance(self.inner, SearchedSolver):
            # families beside a special value, with a joint to spare, are looked for by others
            self.inner.at_singular &= not spare_joints(self.inner.chain, task)
        self.moving = np.array([i for i in range(chain.n) if i not in held])
        self.kmax = self.inner.kmax
        self.branch_words = branch_words_of(self.inner)

    @property
    def name(self) -> str:
        """Name of the solver of the joints that move."""
        return self.inner.name

    def explain(self) -> str:
        """Name the held joints, then what the solver of the others says."""
        held = ", ".join(f"{self.chain.names[i]} at {v:g}" for i, v in self.held.items())
        return f"held: {held}\n{self.inner.explain()}"

    def solve_batch(self, Ts: Array, within_limits: bool, out: Outputs) -> None:
        """Solve for the moving joints and write the held values between them.

        The outputs may have other numbers of rows than this solver has solutions: at another
        held value another solver may cover the chain.
        """
        found = Outputs.of(len(Ts), self.kmax, len(self.moving))
        self.inner.solve_batch(Ts, within_limits, found)
        self.insert(found, out)

    def insert(self, found: Outputs, out: Outputs) -> None:
        """Write solutions of the moving joints, and the held values between them.

        Where there is no room for all, those that are most unlike each other.
        """
        k = min(found.q.shape[1], out.q.shape[1])
        for row in np.flatnonzero(found.counts > k):
            keep_most_apart(self.inner.chain, found, int(row), k)
        out.counts[:] = np.minimum(found.counts, k)
        out.q[:, :k, self.moving], out.residual[:, :k] = found.q[:, :k], found.residual[:, :k]
        for i, value in self.held.items():
            out.q[:, :, i] = value
        out.branch[:, :k], out.free[:] = found.branch[:, :k], 0
        for bit, i in enumerate(self.moving):
            out.free[:, :k] |= (found.free[:, :k] >> bit & 1) << int(i)

    def moved(self, out: Outputs) -> Outputs:
        """Copies of solutions of all joints, those of the moving ones."""
        free = np.zeros_like(out.free)
        for bit, i in enumerate(self.moving):
            free |= (out.free >> int(i) & 1) << bit
        q = np.ascontiguousarray(out.q[:, :, self.moving])
        return out.rows(np.arange(len(free)))._replace(q=q, free=free)

    def __str__(self) -> str:
        return self.name


class HeldEnd(HeldSolver):
    """The first or the last joint is held: the rest is one arm, and the pose moves."""

    def __init__(self, chain: SerialChain, joint: int) -> None:
        super().__init__(chain, (joint,))
        self.inner = select_solver(without_end(chain, joint))
        self.name, self.kmax = self.inner.name, self.inner.kmax
        self.slides = bool(chain.prismatic[joint])

    def details(self) -> str:
        """Say how the joints that move are solved for."""
        return self.inner.explain()

    def solve_held(self, Ts: Array, values: Array, within_limits: bool, out: Outputs) -> None:
        """Move the poses, solve for the rest, put the held joint in its place."""
        joint = self.held[0]
        poses = np.empty_like(Ts)
        held_poses(self.chain.links, self.slides, joint, values[:, 0], Ts, poses)
        q, free = np.empty((len(Ts), self.kmax, self.chain.n - 1)), np.zeros_like(out.free)
        self.inner.solve_batch(poses, within_limits, out._replace(q=q, free=free))
        insert_held_batch(joint, values[:, 0], q, free, out.q, out.counts, out.free)

    def steps(
        self, Ts: Array, values: Array, within_limits: bool, out: Outputs
    ) -> tuple[Step, ...]:
        """The same in kernels, for values (m,)."""
        return self._around(False, Ts, values, within_limits, out)

    def all_steps(
        self, Ts: Array, values: Array, within_limits: bool, out: Outputs
    ) -> tuple[Step, ...]:
        """Those of any pose, as far as the rest has such."""
        return self._around(True, Ts, values, within_limits, out)

    def _around(
        self, whole: bool, Ts: Array, values: Array, within_limits: bool, out: Outputs
    ) -> tuple[Step, ...]:
        """Steps of the rest, between those that move the poses and put the held joint in."""
        if not isinstance(self.inner, SolverBase):
            return ()
        steps = self.inner.all_steps if whole else self.inner.steps
        joint, poses = self.held[0], np.empty_like(Ts)
        q, free = np.empty((len(Ts), self.kmax, self.chain.n - 1)), np.zeros_like(out.free)
        middle = steps(poses, within_limits, out._replace(q=q, free=free))
        before = held_poses, (self.chain.links, self.slides, joint, values, Ts, poses), False
        after = insert_held_batch, (joint, values, q, free, out.q, out.counts, out.free), False
        return (before, *middle, after) if middle else ()


class HeldOneByOne(HeldSolver):
    """A solver is made for every value, and the latest ones are kept: any chain, any task."""

    def __init__(
        self, chain: SerialChain, held: tuple[int, ...], task: Task, first: tuple[float, ...] = ()
    ) -> None:
        super().__init__(chain, held)
        self.task = task
        self._kept: dict[tuple[float, ...], HeldJoints] = {}
        trial = np.clip(TRIAL_VALUE, chain.lower, chain.upper)[list(held)]
        self._first = self.at(first or tuple(trial.tolist()))
        self.name, self.kmax = self._first.name, self._first.kmax

    def details(self) -> str:
        """Say how the joints that move are solved for."""
        return f"a solver is made for each value, such as this one\n{self._first.explain()}"

    def make(self, values: tuple[float, ...]) -> HeldJoints:
        """The solver for some held values."""
        held = dict(zip(self.held, values, strict=True))
        return HeldJoints(self.chain, held, self.task)

    def at(self, values: tuple[float, ...]) -> HeldJoints:
        """The solver for some held values, made or kept."""
        solver = self._kept.pop(values, None) or self.make(values)
        self._kept[values] = solver
        for oldest in list(self._kept)[:-KEPT_VALUES]:  # other threads come and go here
            self._kept.pop(oldest, None)
        return solver

    def in_batch(self, values: tuple[float, ...], alone: bool) -> HeldJoints:
        """The solver for some held values; where there is none, a search, unless all are these."""
        try:
            return self.at(values)
        except NoSolverError:
            if alone:
                raise
            held = dict(zip(self.held, values, strict=True))
            return HeldJoints(
                self.chain, held, self.task, Search(hold(self.chain, held), self.task)
            )

    def solve_held(self, Ts: Array, values: Array, within_limits: bool, out: Outputs) -> None:
        """Solve the poses of one set of values after the other."""
        order = np.lexsort(values.T)
        breaks = np.flatnonzero(np.any(np.diff(values[order], axis=0), axis=1)) + 1
        for rows in np.split(order, breaks):
            if not len(rows):
                continue
            solver = self.in_batch(tuple(values[rows[0]].tolist()), alone=not len(breaks))
            found = Outputs.of(len(rows), out.q.shape[1], self.chain.n)
            solver.solve_batch(np.ascontiguousarray(Ts[rows]), within_limits, found)
            for whole, part in zip(out, found, strict=True):
                whole[rows] = part


class HeldGeneral(HeldOneByOne):
    """An arm without a closed form is left: eliminations are chosen once, the rest for a value."""

    def __init__(self, chain: SerialChain, joint: int, model: General6R) -> None:
        self.model = model
        super().__init__(chain, (joint,), Task.POSE)

    def make(self, values: tuple[float, ...]) -> HeldJoints:
        """The solver for one value; eliminations chosen anew where those of the model fail."""
        held = {self.held[0]: values[0]}
        return HeldJoints(self.chain, held, self.task, self.model.like(hold(self.chain, held)))


def select_held(chain: SerialChain, held: tuple[int, ...], task: Task) -> HeldSolver:
    """The fastest solver that covers a chain with some held joints at any of their values.

    Raises
    ------
    NoSolverError, ConfigurationError
    """
    if len(held) == 1 and task is Task.POSE and not isinstance(chain, CoupledChain):
        joint = held[0]
        wrist = HeldWrist.of(chain, joint)
        if wrist is not None and wrist.one_by_one:
            return wrist
        if joint in (0, chain.n - 1) and chain.n > 1:
            return HeldEnd(chain, joint)
        if wrist is not None:
            return wrist
        if chain.n == 7 and np.delete(chain.prismatic, joint).sum() <= SLIDES:
            model = select_solver(hold(chain, {joint: TRIAL_VALUE}))
            if isinstance(model, General6R):
                return HeldGeneral(chain, joint, model)
    return HeldOneByOne(chain, held, task)
