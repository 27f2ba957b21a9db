"""The border of an arm whose controller counts other angles than its joints': ``x = C q + c``.

Inside are the joints x of the chain, as its solvers take them; outside are the values q, which have
limits of their own. C is square. A full turn of a joint is no full turn of a value where C is not
whole, so turns are those of joints, and chosen by the values: see :class:`TurnsTogether`.
"""

from dataclasses import replace
from typing import Any

import numpy as np

from dh2urdf.chain import Coupling, SerialChain
from dh2urdf.exceptions import ConfigurationError
from dh2urdf.ik.arm import LIMIT_SLACK, IntArray, Outputs, all_turns
from dh2urdf.ik.problem.batch_solutions import IKBatch
from dh2urdf.ik.problem.chunks import in_chunks
from dh2urdf.ik.problem.problem import Problem, Progress
from dh2urdf.ik.problem.solutions import IKSolutions, joints_of_mask
from dh2urdf.ik.problem.turns_together import TurnsTogether
from dh2urdf.kernels.certificate import values_of_batch
from dh2urdf.kernels.numbers import pad_solutions
from dh2urdf.transforms import Array, length

MOVED = 1e-6
"""Motion of a value [rad or m] along a singular family that is more than rounding."""


def held_joints(coupling: Coupling, held: tuple[int, ...]) -> tuple[int, ...]:
    """The joints of the chain that stand still where these values do.

    Raises
    ------
    ConfigurationError
        A held value moves no joint alone.
    """
    rest = np.setdiff1d(np.arange(coupling.n), held)
    still = np.flatnonzero(~coupling.matrix[:, rest].any(axis=1))
    if len(still) == len(held):
        return tuple(still.tolist())
    for v in held:
        k = int(np.flatnonzero(coupling.matrix[:, v])[-1])
        others = [coupling.names[w] for w in np.flatnonzero(coupling.matrix[k]) if w not in held]
        if others:
            break
    name, more = coupling.names[v], " and ".join(others)
    raise ConfigurationError(
        f"locked: {name} alone holds no joint still, since the one that it moves also moves by "
        f"{more}; hold {more}, too"
    )


class CoupledProblem(Problem):
    """A problem in values q, solved by the inner one in the joints of the chain.

    Parameters
    ----------
    chain : SerialChain
        The arm with names, kinds and limits of the values in place of the joints'.
    coupling : Coupling
    inner : Problem
        Of the joints, in metres.
    held : tuple of int
        Values that are held, with the joints that this holds as ``inner`` has them.
    """

    def __init__(
        self, chain: SerialChain, coupling: Coupling, inner: Problem, held: tuple[int, ...] = ()
    ) -> None:
        super().__init__(chain, inner.solver, inner.task, inner.referee)
        self.inner, self.coupling, self.held = inner, coupling, held
        self.still = held_joints(coupling, held)
        self.turns = TurnsTogether(coupling, chain, inner.chain, held, self.still)
        each = enumerate((coupling.inverse != 0.0).T.tolist())  # type: ignore[union-attr]
        self._masks = {j: sum(1 << i for i, moves in enumerate(row) if moves) for j, row in each}

    @property
    def sampled(self) -> bool:
        """As :attr:`Problem.sampled`."""
        return self.inner.sampled

    def at(self, values: Array) -> "CoupledProblem":
        """The same problem with its values held at others."""
        still, held = list(self.still), list(self.held)
        matrix, offset = self.coupling.matrix[np.ix_(still, held)], self.coupling.offset[still]
        other = object.__new__(CoupledProblem)
        inner = self.inner.at(values @ matrix.T + offset)
        other.__dict__.update(self.__dict__, values=values, inner=inner)
        return other

    def joints_at(self, q: Array) -> tuple[SerialChain, Array]:
        """As :meth:`Problem.joints_at`."""
        return self.inner.joints_at(self.coupling.joints(q))

    def turned(self, q: Array, reference: Array, within_limits: bool) -> Array:
        """As :meth:`Problem.turned`."""
        return self.turns.nearest(self.coupling.joints(q), reference)[0]

    def gaps(self, q: Array, seed: Array) -> Array:
        """As :meth:`Problem.gaps`; values that move together are turned together."""
        return self.turns.gaps(q, seed)

    def turn_counts(self, q: Array) -> Array:
        """As :meth:`Problem.turn_counts`."""
        return self.turns.counts(q)

    def all_turns(self, q: Array) -> Array:
        """As :meth:`Problem.all_turns`."""
        options = self.turns.options(q)
        turns = [all_turns(self.turns.loose, option) for option in options]
        return np.concatenate([np.empty((0, len(q))), *turns])

    def turn_numbers(self, q: Array, reference: Array) -> Array:
        """As :meth:`Problem.turn_numbers`: of the joints."""
        both = self.coupling.joints(q), self.coupling.joints(reference)
        return self.inner.turn_numbers(*both)

    def _settled(self, found: IKSolutions, q: Array) -> IKSolutions:
        """As :meth:`Problem._settled`, where the values are."""
        return self._at(found, q)

    def solve_one(self, T: Array, within_limits: bool) -> IKSolutions:
        """All solutions of one checked pose T (4, 4)."""
        found = self.inner.solve_one(T, within_limits)
        return self._outside(found, self.turns.centre, within_limits, within_limits)

    def solve_many(
        self,
        Ts: Array,
        within_limits: bool,
        threads: int | None,
        progress: Progress | None,
        out: Outputs | None = None,
    ) -> IKBatch:
        """All solutions of checked poses Ts (m, 4, 4)."""
        found = self.inner.solve_many(Ts, within_limits, threads, progress, out)
        rooms = Outputs(found.q, found.residual, found.count, found.branch_code, found.free_mask)

        def work(rows: slice) -> None:
            self._turn_chunk(Ts[rows], rooms.rows(rows), within_limits, rows.start)

        in_chunks(work, len(Ts), threads, lambda done: None)
        return replace(found, problem=self)

    def measured(self, Ts: Array, q: Array, count: Any, residual: Array) -> None:
        """As :meth:`Problem.measured`."""
        self.inner.measured(Ts, self.coupling.joints(q), count, residual)

    def arranged(self, found: IKSolutions, seed: Array, within_limits: bool = True) -> IKSolutions:
        """As :meth:`Problem.arranged`; distances are those of the values."""
        goal = self.coupling.joints(seed)
        near = self.inner.arranged(self._inside(found), goal, within_limits)
        out = self._accepted(self._outside(near, seed, within_limits, drop=False))
        return out.select(np.argsort(np.linalg.norm(out.q - seed, axis=1), kind="stable"))

    def walked(self, found: IKSolutions, k: int) -> Array:
        """As :meth:`Problem.walked`."""
        return self.coupling.values(self.inner.walked(self._inside(found), k))

    def members_near(
        self, found: IKSolutions, k: int, goals: list[Array], within_limits: bool
    ) -> list[Array]:
        """As :meth:`Problem.members_near`; near as the joints are."""
        joints = [self.coupling.joints(goal) for goal in goals]
        out = []
        for member in self.inner.members_near(self._inside(found), k, joints, within_limits):
            goal = min(goals, key=lambda g: length(self.coupling.joints(g) - member))
            q, inside = self.turns.nearest(member, goal)
            out += [q] if inside or not within_limits else []
        return out

    def why_none(self, T: Array, within_limits: bool) -> str:
        """As :meth:`Problem.why_none`."""
        if not within_limits or not len(self.solve_one(T, False)):
            return self.inner.why_none(T, within_limits=False)
        return super().why_none(T, within_limits=True)

    def intervals(self, T: Array, within_limits: bool) -> Array:
        """As :meth:`SweptProblem.intervals`, of a joint that moves by its own value.

        Raises
        ------
        ConfigurationError
            It moves together with others, or limits of values that do are asked for.
        """
        joint = self.inner.solver.joint  # type: ignore[union-attr]
        names = ", ".join(self.coupling.names[i] for i in self.turns.block)
        if joint in self.turns.block:
            raise ConfigurationError(
                f"intervals: the joint that is swept, {self.inner.chain.names[joint]}, is one of "
                f"those that move together ({names}), and so no value of q"
            )
        if within_limits and not self.coupling.leaves_values(self.inner.chain):
            raise ConfigurationError(
                f"intervals: limits of joints that move together ({names}) are not intervals of "
                "one; within_limits=False gives those of a joint that moves alone"
            )
        out: Array = self.inner.intervals(T, within_limits)  # type: ignore[attr-defined]
        return out

    def _turn_chunk(self, Ts: Array, out: Outputs, within_limits: bool, first: int) -> None:
        """Put values in place of the joints of some poses' solutions."""
        families = np.flatnonzero((out.free != 0).any(axis=1)).tolist()
        values_of_batch(*self.kernel(within_limits), Ts, out)
        for i in families:
            found = self._one_of(Ts, out, i, first, within_limits)
            k = out.counts[i] = len(found)
            out.q[i, :k], out.residual[i, :k] = found.q, found.residual
            out.branch[i, :k], out.free[i, :k] = found.codes
        if self.values is not None:
            some = self.values if len(self.values) == 1 else self.values[first : first + len(Ts)]
            out.q[:, :, list(self.held)] = some[:, None]
        pad_solutions(out, np.nan)

    def kernel(self, within_limits: bool) -> tuple[Any, ...]:
        """What the kernel takes before poses and solutions."""
        chain, together = self.inner.joints_at(self.turns.centre)[0], self.turns.about_centre
        task = self.task.number
        return chain.tables, together, LIMIT_SLACK, task, within_limits, self.turns.centre

    def _one_of(
        self, Ts: Array, out: Outputs, i: int, first: int, within_limits: bool
    ) -> IKSolutions:
        """The solutions of a pose of which some are of singular families."""
        k = out.counts[i]
        codes = out.branch[i, :k], out.free[i, :k]
        found = IKSolutions.of(self.inner, Ts[i], out.q[i, :k], out.residual[i, :k], *codes)
        problem = self if self.values is None or len(self.values) == 1 else self._row(first + i)
        return problem._outside(found, self.turns.centre, within_limits, within_limits)

    def _row(self, i: int) -> "CoupledProblem":
        assert self.values is not None
        return self.at(self.values[i : i + 1])

    def _hold(self, q: Array, poses: IntArray | None = None) -> None:
        """Put held values (k, n) where they are held, in place; of these poses of the batch."""
        if self.values is not None:
            at = self.values[poses] if poses is not None and len(self.values) > 1 else self.values
            q[:, list(self.held)] = at

    def _outside(
        self, found: IKSolutions, goal: Array, within_limits: bool, drop: bool
    ) -> IKSolutions:
        """Solutions of the inner problem in values, turned to a goal, and only those inside limits.

        Unless none is to ``drop``.
        """
        q, inside = self.turns.nearest(found.q, goal)
        branch, free = found.codes
        masks = free.copy()
        for k in np.flatnonzero(free).tolist():
            masks[k] = self._mask_of(found, k)
            if within_limits and not inside[k] and free[k] & self.turns.mask:
                inside[k] = self._enter(found, k, goal, q)
        self._hold(q)
        whole = IKSolutions.of(self, found.T, q, found.residual, branch, masks)
        return self._at(whole, q).select(inside) if drop else self._at(whole, q)

    def _mask_of(self, found: IKSolutions, k: int) -> int:
        """Values that move along the family of solution k of the inner problem, as bits."""
        joints = joints_of_mask(int(found.codes[1][k]))
        mask = 0
        for j in joints:
            mask |= self._masks[j]
        if sum(j in self.turns.block for j in joints) > 1:  # their motions may cancel in a value
            moved = np.ptp(self.coupling.values(self.inner.walked(found, k)), axis=0) > MOVED
            mask &= sum(1 << i for i in np.flatnonzero(moved).tolist())
        return mask

    def _enter(self, found: IKSolutions, k: int, goal: Array, q: Array) -> bool:
        """Put row k of q to the member of its family that is inside the limits, if there is one."""
        turned, inside = self.turns.nearest(self.inner.walked(found, k), goal)
        if inside.any():
            some = turned[inside]
            q[k] = some[np.linalg.norm(some - goal, axis=1).argmin()]
        return bool(inside.any())

    def _inside(self, found: IKSolutions) -> IKSolutions:
        """Solutions as the inner problem has them; which joints are free is asked anew."""
        joints = self.coupling.joints(found.q)
        branch, free = found.codes
        masks = np.zeros_like(free)
        for k in np.flatnonzero(free).tolist():
            values = joints_of_mask(int(free[k]))
            moved = np.flatnonzero(self.coupling.matrix[:, values].any(axis=1)).tolist()
            masks[k] = sum(1 << j for j in moved if j not in self.still)
        return IKSolutions.of(self.inner, found.T, joints, found.residual, branch, masks)
