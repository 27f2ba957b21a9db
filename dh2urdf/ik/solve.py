"""The public face: checked input in, solutions out.

:class:`InverseKinematics` belongs to one chain and keeps a solver for each task and set of held
joints that was asked for.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from dh2urdf.chain import SerialChain
from dh2urdf.doors import real_array
from dh2urdf.exceptions import ConfigurationError, PoseError
from dh2urdf.ik import path
from dh2urdf.ik.chain_unit import in_own_unit
from dh2urdf.ik.held_solver import HeldSolver
from dh2urdf.ik.held_values import select_held
from dh2urdf.ik.locked import Locked, held_values
from dh2urdf.ik.notice import notice_if_slow
from dh2urdf.ik.problem import ForwardKinematics, Problem, Progress
from dh2urdf.ik.scaled_problem import ScaledProblem
from dh2urdf.ik.solutions import IKBatch, IKSolutions, as_configuration
from dh2urdf.ik.solver import Solver, Task, select_solver
from dh2urdf.ik.swept import SweptJoint
from dh2urdf.ik.swept_problem import SweptProblem
from dh2urdf.transforms import POSE, Array, check_pose

__all__ = ["InverseKinematics", "Locked"]


class InverseKinematics:
    """Inverse kinematics of one chain.

    Parameters
    ----------
    chain : SerialChain
    referee : callable
        Configurations (k, n) to poses (k, 4, 4), independent of the kernels; ``verify`` uses it.
    """

    def __init__(self, chain: SerialChain, referee: ForwardKinematics) -> None:
        self.chain, self.referee, self.own = chain, referee, in_own_unit(chain)
        self._solvers: dict[tuple[Any, ...], Solver | HeldSolver] = {}
        self._problems: dict[tuple[Any, ...], Problem] = {}
        self._plain: Problem | None = None
        self._run_once: set[int] = set()

    def __getstate__(self) -> dict[str, Any]:
        fresh: dict[str, Any] = {
            "_solvers": {},
            "_problems": {},
            "_plain": None,
            "_run_once": set(),
        }
        return {**self.__dict__, **fresh}

    @property
    def solver(self) -> Solver:
        """The solver of the full pose with no joint held."""
        solver = self.problem().solver
        assert not isinstance(solver, HeldSolver)
        return solver

    def solve(
        self,
        T: ArrayLike,
        seed: ArrayLike | None = None,
        within_limits: bool = True,
        locked: Locked | None = None,
        task: Task | str = Task.POSE,
        turns: str = "nearest",
        samples: int | None = None,
    ) -> IKSolutions:
        """All configurations that put the tool at a pose, see :meth:`dh2urdf.Robot.ik`."""
        problem = self._plain
        if problem is None or locked is not None or task != "pose" or samples is not None:
            problem = self._compiled(task, locked, within_limits, samples)
        goal = None if seed is None else as_configuration(seed, self.chain.prismatic, "seed")
        found = problem.solve_one(_one_pose(T, problem), within_limits)
        if goal is not None:
            found = problem.arranged(found, goal, within_limits)
        if turns != "nearest":
            if turns != "all":
                raise ConfigurationError(f"turns: 'nearest' or 'all', not {turns!r}")
            found = problem.with_all_turns(found, goal)
        return found

    def solve_batch(
        self,
        Ts: ArrayLike,
        *,
        within_limits: bool = True,
        locked: Locked | None = None,
        task: Task | str = Task.POSE,
        samples: int | None = None,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> IKBatch:
        """All configurations of many poses, see :meth:`dh2urdf.Robot.ik_batch`."""
        if threads is not None and threads < 1:
            raise ConfigurationError(f"threads: at least 1, not {threads}")
        problem = self._compiled(task, locked, within_limits, samples)
        return problem.solve_many(_poses(Ts, problem), within_limits, threads, progress)

    def solve_path(
        self,
        Ts: ArrayLike,
        *,
        start: ArrayLike | None = None,
        within_limits: bool = True,
        locked: Locked | None = None,
        task: Task | str = Task.POSE,
        max_jump: float | None = None,
    ) -> path.IKPath:
        """A continuous joint path through a sequence of poses, see :func:`path.find_path`."""
        problem = self._compiled(task, locked, within_limits)
        poses = _poses(Ts, problem)
        origin = None if start is None else as_configuration(start, self.chain.prismatic, "start")
        if isinstance(problem, ScaledProblem):
            return problem.path(poses, origin, within_limits, max_jump)
        batch = problem.solve_many(poses, within_limits, None, None)
        return path.find_path(problem, batch, origin, within_limits, max_jump)

    def why_none(
        self,
        T: ArrayLike,
        *,
        within_limits: bool = True,
        locked: Locked | None = None,
        task: Task | str = Task.POSE,
    ) -> str:
        """Say why a pose has no solution, and by how much; empty if it has one."""
        problem = self.problem(task, locked, within_limits)
        return problem.why_none(_one_pose(T, problem)[0], within_limits)

    def intervals(self, T: ArrayLike, *, within_limits: bool = True) -> Array:
        """Intervals of the swept joint in which a pose is reached, see :mod:`~.self_motion`."""
        problem = self._compiled(Task.POSE, None, within_limits)
        if not isinstance(problem.solver, SweptJoint):
            raise ConfigurationError(_no_sweep("intervals", problem.solver))
        assert isinstance(problem, (SweptProblem, ScaledProblem))
        return problem.intervals(_one_pose(T, problem)[0], within_limits)

    def problem(
        self,
        task: Task | str = Task.POSE,
        locked: Locked | None = None,
        within_limits: bool = False,
        samples: int | None = None,
    ) -> Problem:
        """The problem of a task and held joints; its solver is built when first asked for."""
        try:
            wanted = Task(task)
        except ValueError:
            allowed = ", ".join(repr(t.value) for t in Task)
            raise ConfigurationError(f"task: one of {allowed}, not {task!r}") from None
        if not locked:
            return self._free_problem(wanted, samples)
        if samples is not None:
            raise ConfigurationError("samples: a joint is swept or locked, not both")
        joints, values = held_values(self.chain, locked, within_limits)
        key = (wanted, *joints)
        if key not in self._problems:
            solver = self._solver(wanted, joints)
            self._problems[key] = self._outside(Problem(self.own, solver, wanted, self.referee))
        return self._problems[key].at(values)

    def _free_problem(self, task: Task, samples: int | None) -> Problem:
        """The problem of a task with no joint held."""
        solver = self._solver(task, ())
        if isinstance(solver, SweptJoint):
            if samples is not None:
                if isinstance(samples, bool) or not isinstance(samples, int) or samples < 1:
                    raise ConfigurationError(f"samples: a whole number from 1, not {samples!r}")
                solver = self._solvers.setdefault((task, f"{samples}"), solver.like(samples))
                assert isinstance(solver, SweptJoint)
            return self._outside(SweptProblem(self.own, solver, task, self.referee))
        if samples is not None:
            raise ConfigurationError(_no_sweep("samples", solver))
        return self._outside(Problem(self.own, solver, task, self.referee))

    def _outside(self, problem: Problem) -> Problem:
        """A problem of the chain in its own unit, for callers whose unit is the metre."""
        return problem if self.own is self.chain else ScaledProblem(self.chain, problem)

    def _compiled(
        self,
        task: Task | str,
        locked: Locked | None,
        within_limits: bool,
        samples: int | None = None,
    ) -> Problem:
        """The problem, its kernels run once so that only the first call has to wait for them."""
        problem = self.problem(task, locked, within_limits, samples)
        if id(problem.solver) not in self._run_once:
            with notice_if_slow():
                trial = problem if problem.values is None else problem.at(problem.values[:1])
                regular = self.chain.fk(np.linspace(0.4, 1.3, self.chain.n))
                trial.solve_many(regular[None], False, 1, None)
            self._run_once.add(id(problem.solver))
        if problem.values is None and problem.task is Task.POSE and samples is None:
            self._plain = problem
        return problem

    def _solver(self, task: Task, joints: tuple[int, ...]) -> Solver | HeldSolver:
        """The solver of a task with some joints held, built when it is first asked for."""
        key = (task, *joints)
        if key not in self._solvers:
            if len(joints) == self.chain.n:
                raise ConfigurationError("locked: all joints are held, none is left to move")
            self._solvers[key] = (
                select_held(self.own, joints, task) if joints else select_solver(self.own, task)
            )
        return self._solvers[key]


def _no_sweep(what: str, solver: Solver | HeldSolver) -> str:
    """Say that an arm has no joint to sweep."""
    return f"{what}: no joint is swept, the solver is {solver}; it takes an arm of seven joints"


def _one_pose(T: ArrayLike, problem: Problem) -> Array:
    """A checked copy of one pose, shape (1, 4, 4)."""
    given = T if type(T) is np.ndarray else getattr(T, "homogeneous", T)
    m = np.array(real_array(given, "pose", POSE, PoseError), order="C", ndmin=3)
    if m.shape == (1, 4, 4):
        if problem.first_bad_pose(m) >= 0:
            check_pose(m[0])
        if problem.values is not None and len(problem.values) != 1:
            raise ConfigurationError(f"locked: {len(problem.values)} values for one pose")
        return m
    if problem.task is Task.POSITION and m.shape == (1, 1, 3):
        pose = np.eye(4)
        pose[:3, 3] = m[0, 0]
        return _one_pose(pose, problem)
    checked = check_pose(T)
    raise PoseError(f"pose: expected shape (4, 4), got {checked.shape}; ik_batch takes many")


def _poses(Ts: ArrayLike, problem: Problem) -> Array:
    """Checked poses, shape (m, 4, 4), C-contiguous."""
    given = real_array(getattr(Ts, "homogeneous", Ts), "poses", POSE, PoseError)
    m = np.require(given, requirements=["C", "A", "W"])
    if m.shape == (4, 4):
        m = m[None]
    if m.ndim != 3 or m.shape[1:] != (4, 4):
        raise PoseError(f"poses: expected shape (m, 4, 4), got {m.shape}")
    if problem.first_bad_pose(m) >= 0:
        check_pose(m, what="poses")
    if problem.values is not None and len(problem.values) not in (1, len(m)):
        raise ConfigurationError(f"locked: {len(problem.values)} values for {len(m)} poses")
    return m
