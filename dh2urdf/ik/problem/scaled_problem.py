"""The border of an arm that is solved in a unit of its own: metres outside.

Inside, lengths are in the chain's unit, see :mod:`dh2urdf.ik.arm.chains`; what comes out is in
[m], and its residuals are measured there.
"""

from dataclasses import replace

import numpy as np

from dh2urdf.chain import CoupledChain, SerialChain
from dh2urdf.exceptions import ConfigurationError
from dh2urdf.ik.arm import HeldSolver, Outputs, lengths_in
from dh2urdf.ik.problem.batch_solutions import IKBatch
from dh2urdf.ik.problem.coupled_problem import CoupledProblem
from dh2urdf.ik.problem.path import IKPath, PathFinder
from dh2urdf.ik.problem.problem import Problem, Progress
from dh2urdf.ik.problem.solutions import IKSolutions
from dh2urdf.ik.problem.swept_problem import SweptPath, SweptProblem
from dh2urdf.transforms import Array


class ScaledProblem(Problem):
    """A problem of a chain in metres, solved by the inner one of the chain in its own unit."""

    def __init__(self, chain: SerialChain, inner: Problem) -> None:
        super().__init__(chain, inner.solver, inner.task, inner.referee)
        self.inner, self.unit = inner, inner.chain.unit
        self.scale = inner.chain.value_units / chain.value_units

    @property
    def sampled(self) -> bool:
        """As :attr:`Problem.sampled`."""
        return self.inner.sampled

    def at(self, values: Array) -> "ScaledProblem":
        """The same problem with its joints held at other values."""
        assert isinstance(self.solver, HeldSolver)
        scaled = values / self.scale[list(self.solver.held)]
        other = ScaledProblem(self.chain, self.inner.at(scaled))
        other.values = values
        return other

    def solve_one(self, T: Array, within_limits: bool) -> IKSolutions:
        """All solutions of one checked pose T (4, 4)."""
        return self._outside(self.inner.solve_one(lengths_in(T, self.unit), within_limits), T)

    def solve_many(
        self,
        Ts: Array,
        within_limits: bool,
        threads: int | None,
        progress: Progress | None,
        out: Outputs | None = None,
    ) -> IKBatch:
        """All solutions of checked poses Ts (m, 4, 4)."""
        inside = lengths_in(Ts, self.unit)
        found = self.inner.solve_many(inside, within_limits, threads, progress, out)
        found.q[:] *= self.scale
        self.measured(Ts, found.q, found.count, found.residual)
        return replace(found, problem=self, targets=Ts)

    def arranged(self, found: IKSolutions, seed: Array, within_limits: bool = True) -> IKSolutions:
        """As :meth:`Problem.arranged`; a slide counts in the chain's unit."""
        near = self.inner.arranged(self._inside(found), seed / self.scale, within_limits)
        return self._sorted(self._outside(near, found.T), seed)

    def gaps(self, q: Array, seed: Array) -> Array:
        """As :meth:`Problem.gaps`; as many turns as bring all joints back are no distance."""
        out: Array = self.inner.gaps(q / self.scale, seed / self.scale) * self.scale
        return out

    def walked(self, found: IKSolutions, k: int) -> Array:
        """As :meth:`Problem.walked`."""
        out: Array = self.inner.walked(self._inside(found), k) * self.scale
        return out

    def members_near(
        self, found: IKSolutions, k: int, goals: list[Array], within_limits: bool
    ) -> list[Array]:
        """As :meth:`Problem.members_near`."""
        near = [goal / self.scale for goal in goals]
        members = self.inner.members_near(self._inside(found), k, near, within_limits)
        return [member * self.scale for member in members]

    def with_all_turns(self, found: IKSolutions, seed: Array | None = None) -> IKSolutions:
        """As :meth:`Problem.with_all_turns`."""
        goal = None if seed is None else seed / self.scale
        every = self._outside(self.inner.with_all_turns(self._inside(found), goal), found.T)
        return every if seed is None else self._sorted(every, seed)

    def _sorted(self, found: IKSolutions, seed: Array) -> IKSolutions:
        """By distance from a seed in the values, where one of them may be several turns inside."""
        if not isinstance(self.chain, CoupledChain):
            return found
        return found.select(np.argsort(np.linalg.norm(found.q - seed, axis=1), kind="stable"))

    def why_none(self, T: Array, within_limits: bool) -> str:
        """As :meth:`Problem.why_none`."""
        return self.inner.why_none(lengths_in(T, self.unit), within_limits)

    def intervals(self, T: Array, within_limits: bool) -> Array:
        """As :meth:`SweptProblem.intervals`."""
        assert isinstance(self.inner, SweptProblem)
        ends = self.inner.intervals(lengths_in(T, self.unit), within_limits)
        scaled: Array = ends * self.scale[self.inner.solver.joint]
        return scaled

    def _inside(self, found: IKSolutions) -> IKSolutions:
        """Solutions as the inner problem has them."""
        T, q = lengths_in(found.T, self.unit), found.q / self.scale
        return IKSolutions.of(self.inner, T, q, found.residual, *found.codes)

    def _outside(self, found: IKSolutions, T: Array) -> IKSolutions:
        """Solutions of the inner problem in metres, measured there."""
        in_metres = IKSolutions.of(self, T, found.q, found.residual, *found.codes)
        return self._at(in_metres, found.q * self.scale)


def find_path(
    problem: Problem,
    Ts: Array,
    start: Array | None,
    within_limits: bool,
    max_jump: float | None,
    tell: Progress | None = None,
) -> IKPath:
    """The path of least joint motion through poses Ts (m, 4, 4), see :class:`.PathFinder`."""
    if isinstance(problem, ScaledProblem):
        origin = None if start is None else start / problem.scale
        poses = lengths_in(Ts, problem.unit)
        found = find_path(problem.inner, poses, origin, within_limits, max_jump, tell)
        return replace(found, q=found.q * problem.scale)
    if isinstance(problem, CoupledProblem) and problem.sampled:
        return _path_of_joints(problem, Ts, start, within_limits, max_jump, tell)
    if isinstance(problem, SweptProblem):
        return SweptPath(problem, Ts, start, within_limits, max_jump, tell).find()
    return PathFinder(problem, Ts, start, within_limits, max_jump, tell).find()


def _path_of_joints(
    problem: CoupledProblem,
    Ts: Array,
    start: Array | None,
    within_limits: bool,
    max_jump: float | None,
    tell: Progress | None,
) -> IKPath:
    """The path of least motion of the joints, of which there is one to spare, in the values.

    Raises
    ------
    ConfigurationError
        The limits of the joints may put values outside theirs.
    """
    coupling = problem.coupling
    if within_limits and not coupling.leaves_values(problem.inner.chain):
        raise ConfigurationError(
            "path: of an arm with a joint to spare whose values have limits that are not those of "
            "the joints that they move together; hold a joint (locked), or give within_limits=False"
        )
    origin = None if start is None else coupling.joints(start)
    found = find_path(problem.inner, Ts, origin, within_limits, max_jump, tell)
    q, reached = coupling.values(found.q), np.isfinite(found.q[:, 0])
    steps = np.abs(np.diff(q[reached], axis=0)).max(axis=1, initial=0.0)
    breaks = np.flatnonzero(reached)[1:][steps > found.max_jump]
    return replace(found, q=q, breaks=tuple(breaks.tolist()), joint_names=coupling.names)
