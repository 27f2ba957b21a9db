"""One problem of inverse kinematics: a chain, a task, the joints that are held, a solver."""

from collections.abc import Callable
from typing import Any

import numpy as np

from dh2urdf.bounds import TURNS
from dh2urdf.chain import SerialChain
from dh2urdf.exceptions import ArgumentError
from dh2urdf.ik.arm import (
    ACCEPT,
    LIMIT_SLACK,
    TWO_PI,
    Family,
    HeldSolver,
    Outputs,
    Room,
    Solver,
    Task,
    all_turns,
    branch_words_of,
    hold,
    middle,
    seed_gaps,
    slide_to_seed,
    task_error,
    turn_counts,
    turned_to,
)
from dh2urdf.ik.problem.batch_solutions import IKBatch
from dh2urdf.ik.problem.chunks import in_chunks
from dh2urdf.ik.problem.shortfall import all_outside, shortfall
from dh2urdf.ik.problem.solutions import IKSolutions, joints_of_mask
from dh2urdf.ik.redundant import RedundantChain, SearchedSolver
from dh2urdf.kernels.certificate import measure_all, measure_and_sort, settle_on_bounds, turn_all
from dh2urdf.kernels.numbers import pad_solutions
from dh2urdf.kernels.redundant import families_inside
from dh2urdf.transforms import Array, length

ForwardKinematics = Callable[[Array], Array]
"""Configurations (k, n) to poses ``T_base_tool`` (k, 4, 4)."""

Progress = Callable[[int, int], None]
"""Called with the number of poses done and their total."""


ALL = slice(None)

NEARER = 1e-5
"""Joint distance [rad or m] by which a solution is nearer to a seed than those that are known."""


class Problem:
    """Solves poses; arranges, turns and measures what was found.

    Parameters
    ----------
    chain : SerialChain
        The whole chain, held joints included.
    solver : Solver or HeldSolver
    task : Task
    referee : callable
        Forward kinematics that is independent of the kernels.

    Attributes
    ----------
    values : array, shape (1, h) or (m, h), or None
        Values of the held joints, for all poses or for each; with a ``HeldSolver`` only.
    """

    values: Array | None = None

    def __init__(
        self,
        chain: SerialChain,
        solver: Solver | HeldSolver,
        task: Task,
        referee: ForwardKinematics,
    ) -> None:
        self.chain, self.solver, self.task = chain, solver, task
        self.referee = referee
        self.branch_words = branch_words_of(solver)
        inner = solver.inner if isinstance(solver, SearchedSolver) else solver
        self.spare = inner if isinstance(inner, RedundantChain) else None
        self._rooms: list[Room] = []
        self._solve: Any = None if isinstance(solver, HeldSolver) else solver.solve_batch

    @property
    def sampled(self) -> bool:
        """Whether there are solutions between those that are listed."""
        return self.spare is not None

    @property
    def partial(self) -> bool:
        """Whether there may be solutions that those that are listed do not lead to."""
        return self.spare is not None and self.spare.partial

    def at(self, values: Array) -> "Problem":
        """The same problem with its joints held at other values."""
        other = object.__new__(Problem)
        other.__dict__.update(self.__dict__, values=values)
        return other

    def solve_one(self, T: Array, within_limits: bool) -> IKSolutions:
        """All solutions of one checked pose T (4, 4)."""
        try:
            room = self._rooms.pop()  # that no other thread has
        except IndexError:
            room = Room(self.solver.kmax, self.chain.n)
        room.Ts[0] = T
        if self.values is None:
            self._solve(room.Ts, within_limits, room.out)
        else:
            self._solve_held(room.Ts, within_limits, room.out)
        if within_limits:
            self._families_inside(room.Ts, room.out)
        found = IKSolutions(self, room.memory.tobytes())
        self._rooms.append(room)
        return found

    def solve_many(
        self,
        Ts: Array,
        within_limits: bool,
        threads: int | None,
        progress: Progress | None,
        out: Outputs | None = None,
    ) -> IKBatch:
        """All solutions of checked poses Ts (m, 4, 4), in chunks on threads; ``out`` is filled."""
        m = len(Ts)
        room = out or Outputs.of(m, self.solver.kmax, self.chain.n)

        def work(rows: slice) -> None:
            self._solve_chunk(Ts[rows], within_limits, room.rows(rows), rows)

        in_chunks(work, m, threads, lambda done: progress(done, m) if progress else None)
        return IKBatch(self, Ts, *room, np.zeros(m))

    def _solve_held(self, Ts: Array, within_limits: bool, out: Outputs, rows: slice = ALL) -> None:
        """Solve poses Ts (m, 4, 4) at the held values of these rows of the whole batch."""
        assert isinstance(self.solver, HeldSolver)
        assert self.values is not None
        values = self.values if len(self.values) == 1 else self.values[rows]
        if len(values) < len(Ts):
            values = np.repeat(values, len(Ts), axis=0)
        self.solver.solve_held(Ts, values, within_limits, out)

    def _solve_chunk(self, Ts: Array, within_limits: bool, out: Outputs, rows: slice) -> None:
        """Fill the arrays of a chunk of poses Ts (m, 4, 4), these rows of the whole batch."""
        if self.values is None:
            self._solve(Ts, within_limits, out)
        else:
            self._solve_held(Ts, within_limits, out, rows)
        if pad_solutions(out, np.nan) and within_limits:
            self._families_inside(Ts, out)
            pad_solutions(out, np.nan)

    def _families_inside(self, Ts: Array, out: Outputs) -> None:
        """Bring the representatives of singular families into the limits, or drop them."""
        families_inside(*self.limits, Ts, out)

    @property
    def limits(self) -> tuple[Any, ...]:
        """First arguments of :func:`.families_inside`."""
        chain = self.chain
        return chain.tables, LIMIT_SLACK, self.task.number, chain.size, middle(chain)

    def joints_at(self, q: Array) -> tuple[SerialChain, Array]:
        """The chain in metres, and its joints at values q (..., n)."""
        return self.chain, q

    def turned(self, q: Array, reference: Array, within_limits: bool) -> Array:
        """Configurations q (..., n) in the turns nearest to a reference, see :func:`turned_to`."""
        return turned_to(self.chain, q, reference, within_limits)

    def gaps(self, q: Array, seed: Array) -> Array:
        """How far each value of q (k, n) is from a seed (n,), see :func:`seed_gaps`."""
        return seed_gaps(self.chain, q, seed)

    def turn_counts(self, q: Array) -> Array:
        """How many turns of configurations q (k, n) are inside the limits, shape (k,)."""
        return turn_counts(self.chain, q)

    def all_turns(self, q: Array) -> Array:
        """Every turn of one configuration q (n,) inside the limits, shape (k, n)."""
        return all_turns(self.chain, q)

    def turn_numbers(self, q: Array, reference: Array) -> Array:
        """How many turns q (..., n) is from the same configuration as a reference has it."""
        turns: Array = np.round((q - reference) / TWO_PI)
        return turns

    def walked(self, found: IKSolutions, k: int) -> Array:
        """Members (m, n) of the singular family of solution k, on a walk both ways."""
        return self._family(found, k).members()

    def members_near(
        self, found: IKSolutions, k: int, goals: list[Array], within_limits: bool
    ) -> list[Array]:
        """Members (n,) of the singular family of solution k that are nearest to goals (n,)."""
        family = self._family(found, k)
        members = (family.nearest(goal, within_limits) for goal in goals)
        return [member for member in members if member is not None]

    def _family(self, found: IKSolutions, k: int) -> Family:
        return Family(self.chain, self.task, found.T, found.free_joints[k], found.q[k])

    def arranged(self, found: IKSolutions, seed: Array, within_limits: bool = True) -> IKSolutions:
        """Turn to the seed (n,), resolve singular families nearest to it, sort by distance."""
        q, residual = found.q.copy(), found.residual.copy()
        branch, free = (codes.copy() for codes in found.codes)
        how = within_limits, LIMIT_SLACK, self.task.number
        turn_all(self.chain.tables, *how, found.T, seed, q)
        families = {
            k: Family(self.chain, self.task, found.T, joints_of_mask(mask), q[k].copy())
            for k, mask in enumerate(free.tolist())
            if mask
        }
        keep = slide_to_seed(families, q, seed, within_limits) if families else ALL
        arrays = q[keep], residual[keep], branch[keep], free[keep]
        room = np.empty(len(arrays[0]))
        measure_and_sort(self.chain.tables, self.task.number, found.T, seed, arrays, room)
        arranged = self._accepted(IKSolutions.of(self, found.T, *arrays))
        return self._with_nearer(arranged, seed, within_limits)

    def _with_nearer(self, found: IKSolutions, seed: Array, within_limits: bool) -> IKSolutions:
        """With a nearer solution of an arm with joints to spare, on a curve of its own or not."""
        if self.spare is None:
            return found
        for q, mask in zip(*self.spare.beside_seed(found.T, seed, within_limits), strict=True):
            family = Family(self.chain, self.task, found.T, joints_of_mask(int(mask)), q)
            member = family.nearest(seed, within_limits)
            gaps = np.linalg.norm(found.q - seed, axis=1)
            if member is None or length(member - seed) > gaps.min(initial=np.inf) - NEARER:
                continue
            others = found.select(~family.contains(found.q))
            more = np.zeros(1), np.array([-1]), np.array([mask])
            rows = zip(
                (member[None], *more), (others.q, others.residual, *others.codes), strict=True
            )
            found = IKSolutions.of(self, found.T, *(np.concatenate(both) for both in rows))
            found = self._accepted(self._at(found, found.q))
        return found

    def with_all_turns(self, found: IKSolutions, seed: Array | None = None) -> IKSolutions:
        """Each solution in every turn that the limits allow, sorted by distance from a seed.

        Raises
        ------
        ArgumentError
            There are more than ``bounds.TURNS``.
        """
        counts = self.turn_counts(found.q)
        total = int(counts.sum())
        if total > TURNS:
            raise ArgumentError(
                f"turns: {counts.sum():.3g} solutions with all their turns, at most {TURNS} are "
                "listed; turns='nearest' gives one turn of each"
            )
        if not total:
            return found
        turns = [self.all_turns(q) for q in found.q]
        rows = np.repeat(np.arange(len(found)), [len(t) for t in turns])
        all_of_them = self._accepted(self._settled(found.select(rows), np.concatenate(turns)))
        if seed is None:
            return all_of_them
        distance = np.linalg.norm(all_of_them.q - seed, axis=1)
        return all_of_them.select(np.argsort(distance, kind="stable"))

    def _at(self, found: IKSolutions, q: Array) -> IKSolutions:
        """The solutions at other members or turns q, with the residuals there."""
        residual = np.empty(len(q))
        self.measured(found.T[None], q[None], np.array([len(q)]), residual[None])
        return IKSolutions.of(self, found.T, q, residual, *found.codes)

    def _settled(self, found: IKSolutions, q: Array) -> IKSolutions:
        """The solutions in other turns q, of which joints were put onto their bounds."""
        residual = np.empty(len(q))
        settle_on_bounds(self.chain.tables, self.task.number, found.T, q, residual)
        return IKSolutions.of(self, found.T, q, residual, *found.codes)

    @staticmethod
    def _accepted(found: IKSolutions) -> IKSolutions:
        """Those of which the residual is a solution's; turns by thousands round."""
        fine = found.residual <= ACCEPT
        return found if fine.all() else found.select(fine)

    def measured(self, Ts: Array, q: Array, count: Any, residual: Array) -> None:
        """Measure q (m, k, n), the first ``count[i]`` of pose Ts[i], into residual (m, k)."""
        measure_all(self.chain.tables, self.task.number, Ts, q, count, residual)

    def why_none(self, T: Array, within_limits: bool) -> str:
        """Say why a pose T (4, 4) has no solution, and by how much; empty if it has one."""
        if self.solve_one(T, within_limits):
            return ""
        if within_limits and (anywhere := self.solve_one(T, within_limits=False)):
            free = (k for k, joints in enumerate(anywhere.free_joints) if joints)
            members = [anywhere.q, *(self.walked(anywhere, k) for k in free)]
            return all_outside(self.chain, len(anywhere), np.concatenate(members))
        if not isinstance(self.solver, HeldSolver) or self.values is None:
            return shortfall(self.chain, T, self.task)
        held = dict(zip(self.solver.held, self.values[0].tolist(), strict=True))
        return shortfall(hold(self.chain, held), T, self.task)

    def measure(self, q: Array, T: Array) -> Array:
        """Residuals of configurations q (k, n) by the independent forward kinematics."""
        error = task_error(self.referee(q), T, self.task)
        position, turn = np.linalg.norm(error[:, :3], axis=1), np.linalg.norm(error[:, 3:], axis=1)
        largest: Array = np.maximum(position, turn)
        return largest
