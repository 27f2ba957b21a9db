"""The public face: checked input in, solutions out.

:class:`InverseKinematics` belongs to one chain and keeps a solver for each task and set of held
joints that was asked for.
"""

import sys
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from dh2urdf.bounds import SAMPLES, THREADS
from dh2urdf.chain import CoupledChain, Coupling, SerialChain
from dh2urdf.dh import JointMap
from dh2urdf.dh.variables import coupled_words
from dh2urdf.doors import choice, flag, instance, integer
from dh2urdf.exceptions import ArgumentError, ConfigurationError, PoseError
from dh2urdf.ik.arm import (
    HeldSolver,
    Solver,
    SolverBase,
    Task,
    as_configuration,
    as_tolerance,
    in_own_unit,
    many_poses,
    one_pose,
    select_solver,
)
from dh2urdf.ik.problem import (
    CoupledProblem,
    ForwardKinematics,
    HeldCalls,
    IKBatch,
    IKPath,
    IKSolutions,
    Locked,
    PlainCalls,
    Problem,
    Progress,
    ScaledProblem,
    SweptProblem,
    find_path,
    held_joints,
    held_values,
)
from dh2urdf.ik.redundant import SweptJoint, at_any_value, select_held
from dh2urdf.transforms import Array

FULL_POSE, NEAREST = sys.intern("pose"), sys.intern("nearest")
"""What a call asks for if it does not say; known at sight."""

ON_BAD = ("raise", "skip")
"""What may be done about a pose of a batch that is none."""

TASKS = tuple(Task)

Asked = tuple[Task | str, Locked | None, bool, int | None, bool]
"""What a call may ask for: ``task``, ``locked``, ``within_limits``, ``samples``, ``nearest``."""


class InverseKinematics:
    """Inverse kinematics of one chain; its methods are documented at :class:`dh2urdf.Robot`.

    Parameters
    ----------
    chain : SerialChain
    coupling : Coupling or None
        By which values q, as many as the chain's, move its joints; None where they are the joints.
    referee : callable
        Forward kinematics of values q that is independent of the kernels.
    """

    def __init__(
        self, chain: SerialChain, coupling: Coupling | None, referee: ForwardKinematics
    ) -> None:
        self._given = chain, coupling
        if coupling is not None and isinstance(chain, CoupledChain):
            chain = chain.in_turns
            coupling = coupling.in_turns(np.where(chain.prismatic, 1.0, chain.turns))
        self.chain, self.coupling, self.referee = chain, coupling, referee
        self.own = in_own_unit(chain)
        self.values = chain if coupling is None else coupling.chain_of(chain)
        self._problems: dict[tuple[Any, ...], Problem] = {}
        self._plain, self._held = PlainCalls(), HeldCalls()

    def __getstate__(self) -> dict[str, Any]:
        return InverseKinematics(*self._given, self.referee).__dict__

    @property
    def solver(self) -> Solver:
        """The solver of the full pose with no joint held."""
        solver = self.problem().solver
        assert not isinstance(solver, HeldSolver)
        return solver

    def solve(
        self,
        T: ArrayLike,
        seed: ArrayLike | None,
        tolerance: ArrayLike | None,
        turns: str,
        asked: Asked,
    ) -> IKSolutions:
        """All configurations that put the tool at a pose, see :meth:`dh2urdf.Robot.ik`."""
        task, locked, within_limits, samples, nearest = asked
        swept = samples is None or (locked is None and type(samples) is int)
        plain = task is FULL_POSE and tolerance is None and nearest is False and turns is NEAREST
        usual = plain and swept
        if usual and (within_limits is True or within_limits is False):
            answer = self._in_one_call(T, seed, locked, within_limits, samples)
            if answer is not None:
                return answer
        inside = flag(within_limits, "within_limits")
        problem = self.problem(task, locked, inside, samples)
        if usual:
            self._learn(problem, locked, samples, 2 * (seed is not None) + inside)
        goal = None if seed is None else as_configuration(seed, self.values.prismatic, "seed")
        most = None if tolerance is None else as_tolerance(tolerance, self.chain.n)
        if most is not None and goal is None:
            raise ArgumentError("seed_tolerance: there is no seed from which to measure it")
        every = turns is not NEAREST and choice(turns, "turns", ("nearest", "all")) == "all"
        pose, change = one_pose(T, problem.task, nearest)
        if problem.values is not None:
            _check_held(problem, 1)
        found = problem.solve_one(pose, inside)
        if goal is not None:
            found = problem.arranged(found, goal, inside)
        if every:
            found = problem.with_all_turns(found, goal)
        if goal is not None and most is not None:
            found = found.select(np.all(problem.gaps(found.q, goal) <= most, axis=1))
        if change:
            found.pose_change = change
        return found

    def _in_one_call(
        self,
        T: ArrayLike,
        seed: ArrayLike | None,
        locked: Locked | None,
        within_limits: bool,
        samples: int | None,
    ) -> IKSolutions | None:
        """The answer if all is of the usual kind and there is a function for it."""
        if locked is None:
            found = self._plain.answer(T, seed, within_limits, samples)
        else:
            found = self._held.answer(T, locked, within_limits, seed)
        if found is None:
            return None
        problem, memory = found
        return None if memory is None else IKSolutions(problem, memory)

    def _learn(
        self, problem: Problem, locked: Locked | None, samples: int | None, way: int
    ) -> None:
        """Make the function that answers in one call what was asked: with a seed, within limits."""
        if locked is None:
            self._plain.learn(problem, samples, way)
        else:
            self._held.learn(problem, locked, way % 2 == 1)

    def solve_batch(
        self,
        Ts: ArrayLike,
        asked: Asked,
        threads: int | None,
        tell: Progress | None,
        on_bad: str,
        out: IKBatch | None,
    ) -> IKBatch:
        """All configurations of many poses, see :meth:`dh2urdf.Robot.ik_batch`."""
        task, locked, within_limits, samples, nearest = asked
        inside, skip = flag(within_limits, "within_limits"), choice(on_bad, "on_bad", ON_BAD)
        workers = None if threads is None else integer(threads, "threads", 1, THREADS)
        if tell is not None:
            instance(tell, "progress", Callable)
        problem = self.problem(task, locked, inside, samples)
        poses, change = many_poses(Ts, nearest, skip == "skip")
        flat, shape = poses.reshape(-1, 4, 4), poses.shape[:-2]
        _check_held(problem, len(flat))
        room = None
        if out is not None:
            earlier: IKBatch = instance(out, "out", IKBatch)
            room = earlier.room(len(flat), problem.solver.kmax, self.chain.n)
        good = ~np.isnan(flat[:, 3, 3])
        if good.all():
            batch = problem.solve_many(flat, inside, workers, tell, room)
        else:
            some = problem
            if problem.values is not None and len(problem.values) > 1:
                some = problem.at(problem.values[good])
            batch = some.solve_many(flat[good], inside, workers, tell).among(good)
        batch.pose_change[:] = change.ravel()
        return batch if len(shape) == 1 else batch.shaped(shape)

    def solve_path(
        self,
        Ts: ArrayLike,
        start: ArrayLike | None,
        max_jump: float | None,
        asked: Asked,
        tell: Progress | None = None,
    ) -> IKPath:
        """A continuous joint path through a sequence of poses, see :func:`find_path`."""
        task, locked, within_limits, _, nearest = asked
        inside = flag(within_limits, "within_limits")
        problem = self.problem(task, locked, inside)
        poses, change = many_poses(Ts, nearest, False)
        if poses.ndim != 3:
            raise PoseError(f"poses: expected shape (m, 4, 4), got {poses.shape}")
        _check_held(problem, len(poses))
        origin = None if start is None else as_configuration(start, self.values.prismatic, "start")
        if tell is not None:
            instance(tell, "progress", Callable)
        found = find_path(problem, poses, origin, inside, max_jump, tell)
        return replace(found, pose_change=change)

    def why_none(self, T: ArrayLike, asked: Asked) -> str:
        """Say why a pose has no solution, and by how much; empty if it has one."""
        task, locked, within_limits, _, nearest = asked
        inside = flag(within_limits, "within_limits")
        problem = self.problem(task, locked, inside)
        pose, _ = one_pose(T, problem.task, nearest)
        _check_held(problem, 1)
        return problem.why_none(pose, inside)

    def intervals(self, T: ArrayLike, within_limits: bool, nearest: bool) -> Array:
        """Intervals of the swept joint in which a pose is reached, see :mod:`~.self_motion`."""
        inside = flag(within_limits, "within_limits")
        problem = self.problem(Task.POSE, None, inside)
        if not isinstance(problem.solver, SweptJoint):
            raise ConfigurationError(_no_sweep("intervals", problem.solver))
        assert isinstance(problem, (SweptProblem, ScaledProblem, CoupledProblem))
        pose, _ = one_pose(T, problem.task, nearest)
        return problem.intervals(pose, inside)

    def problem(
        self,
        task: Task | str = Task.POSE,
        locked: Locked | None = None,
        within_limits: bool = False,
        samples: int | None = None,
    ) -> Problem:
        """The problem of a task and held joints; its solver is built when first asked for."""
        wanted = Task(choice(task, "task", TASKS))
        joints, values = held_values(self.values, locked, within_limits)
        if joints and samples is not None:
            raise ConfigurationError("samples: a joint is swept or locked, not both")
        if samples is not None:
            swept = self.problem(wanted).solver
            if not isinstance(swept, SweptJoint):
                raise ConfigurationError(_no_sweep("samples", swept))
            samples = integer(samples, "samples", 1, SAMPLES)
        key = wanted, samples, joints
        if key not in self._problems:
            self._problems[key] = self._new_problem(*key)
        return self._problems[key].at(values) if joints else self._problems[key]

    def _new_problem(self, task: Task, samples: int | None, joints: tuple[int, ...]) -> Problem:
        """A problem with a solver of its own, of the chain in its unit; outside are metres."""
        if len(joints) == self.chain.n:
            raise ConfigurationError("locked: all joints are held, none is left to move")
        held = joints if self.coupling is None else held_joints(self.coupling, joints)
        solver: Solver | HeldSolver
        if joints:
            solver = at_any_value(select_held(self.own, held, task), task)
        else:
            solver = self.problem(task).solver if samples else select_solver(self.own, task)
        if isinstance(solver, SweptJoint):
            swept = solver.like(samples) if samples else solver
            problem: Problem = SweptProblem(self.own, swept, task, self.referee)
        else:
            problem = Problem(self.own, solver, task, self.referee)
        if self.own is not self.chain:
            problem = ScaledProblem(self.chain, problem)
        if self.coupling is None:
            return problem
        given = self._given[1] or self.coupling
        if isinstance(solver, SolverBase) and set(self.coupling.names) == set(self.chain.names):
            own = tuple(map(self.chain.names.index, self.coupling.names))
            joints_of = JointMap(given.matrix, given.offset, own)
            solver.moved = coupled_words(self.chain.names, joints_of)
        return CoupledProblem(self.values, self.coupling, problem, joints)


def _no_sweep(what: str, solver: Solver | HeldSolver) -> str:
    """Say that an arm has no joint to sweep."""
    return f"{what}: no joint is swept, the solver is {solver}; it takes an arm of seven joints"


def _check_held(problem: Problem, poses: int) -> None:
    """Refuse held values that are neither one for all poses nor one for each."""
    if problem.values is not None and len(problem.values) not in (1, poses):
        number = "one pose" if poses == 1 else f"{poses} poses"
        raise ConfigurationError(f"locked: {len(problem.values)} values for {number}")
