"""A pose of the usual kind solved by one call into the extension: what it goes through.

All others go through Python, which says what is wrong with them. The functions answer the memory of
:class:`~dh2urdf.ik.problem.IKSolutions`, or None.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from dh2urdf.bounds import ANGLE, LENGTH
from dh2urdf.engine import AtOnce, Step, at_once, nothing_at_once
from dh2urdf.ik.arm import LIMIT_SLACK, HeldSolver, Outputs, Room, SolverBase
from dh2urdf.ik.problem.coupled_problem import CoupledProblem
from dh2urdf.ik.problem.locked import Locked
from dh2urdf.ik.problem.problem import Problem
from dh2urdf.ik.problem.swept_problem import SweptProblem
from dh2urdf.ik.redundant import MOST_MEMBERS, SweptJoint, towards_seed
from dh2urdf.kernels.certificate import arrange_plain, arrange_together, values_of_batch
from dh2urdf.kernels.numbers import any_family, is_pose
from dh2urdf.kernels.redundant import families_inside
from dh2urdf.transforms import Array

COUNT = slice(128, 136)
"""Bytes of the number of solutions, see :class:`dh2urdf.ik.arm.Room`."""


def call_of(problem: Problem, within_limits: bool) -> AtOnce:
    """The function of a pose."""
    room = _room(problem)
    steps = _steps(problem, room, within_limits)
    return _call(room, _into_limits(problem, room, steps, within_limits))


def seeded_call_of(problem: Problem, within_limits: bool) -> AtOnce:
    """The function of a pose and a seed (n,); a singular family is nothing for it."""
    if isinstance(problem.solver, SweptJoint):
        return _swept_call_of(problem, problem.solver, within_limits)
    room, seed = _room(problem), np.empty(problem.chain.n)
    steps = _steps(problem, room, within_limits)
    if not steps or problem.spare is not None:
        return nothing_at_once
    return _call(room, (*steps, _arrange(problem, room, seed, within_limits)), seed)


def _swept_call_of(problem: Problem, solver: SweptJoint, within_limits: bool) -> AtOnce:
    """The function of a pose and a seed (n,), of which a sample of the swept joint is near."""
    n, some = solver.chain.n, Outputs.of(1, solver.kmax, solver.chain.n)
    room, seed = Room(MOST_MEMBERS + solver.kmax, n), np.empty(n)
    steps = solver.steps(room.Ts, within_limits, some)
    if not steps or type(problem) is not SweptProblem:
        return nothing_at_once
    families: Step = any_family, (some.counts, some.free), False
    arrange = towards_seed(solver, room.Ts, seed, within_limits, some, room.out)
    return _call(room, (*steps, families, *arrange), seed)


def _arrange(problem: Problem, room: Room, seed: Array, within_limits: bool) -> Step:
    """Turn and sort what has been found towards a seed (n,)."""
    chain, distance = problem.chain, np.empty(problem.solver.kmax)
    largest, task = np.where(chain.prismatic, LENGTH, ANGLE), problem.task.number
    given = room.Ts, seed, room.out, distance
    if isinstance(problem, CoupledProblem):
        tables = problem.inner.chain.tables, problem.turns.anywhere
        return arrange_together, (*tables, largest, LIMIT_SLACK, task, *given), True
    return arrange_plain, (chain.tables, within_limits, largest, LIMIT_SLACK, task, *given), True


class PlainCalls(dict[tuple[int | None, int], tuple[Problem, AtOnce]]):
    """The functions for which no joint is held, and their problems.

    By how many samples of a swept joint are asked for, and by a number: 1 within the limits, and 2
    with a seed.
    """

    def answer(
        self, T: ArrayLike, seed: ArrayLike | None, within_limits: bool, samples: int | None
    ) -> tuple[Problem, bytes | None] | None:
        """A problem, and the memory of its answer to a pose, if there is a function for it."""
        if seed is None:
            made = self.get((samples, within_limits))
            return made and (made[0], made[1](T))
        made = self.get((samples, 2 + within_limits))
        return made and (made[0], made[1](T, seed))

    def learn(self, problem: Problem, samples: int | None, way: int) -> None:
        """Make one of the functions, if it has not been made."""
        if (samples, way) not in self:
            make = seeded_call_of if way > 1 else call_of
            self[samples, way] = problem, make(problem, way % 2 == 1)


class HeldCall(NamedTuple):
    """The function of a pose and the value of one held joint, between two values.

    ``seeded`` is that of a seed (n,), too.
    """

    call: AtOnce
    seeded: AtOnce
    low: float
    high: float
    problem: Problem

    @classmethod
    def of(cls, problem: Problem, value: float, within_limits: bool) -> "HeldCall":
        """That of a problem of one held joint, for values about the one that it is held at."""
        assert isinstance(problem.solver, HeldSolver)
        chain, room, held = problem.chain, _room(problem), np.empty(1)
        seed = np.empty(chain.n)
        steps = problem.solver.steps(room.Ts, held, within_limits, room.out)
        joint, (low, high) = problem.solver.held[0], problem.solver.clear_about(value)
        bound = LENGTH if chain.prismatic[joint] else ANGLE
        lower, upper = (
            (chain.lower[joint], chain.upper[joint]) if within_limits else (-bound, bound)
        )
        low, high = max(low, float(lower), -bound), min(high, float(upper), bound)
        arranged = (*steps, _arrange(problem, room, seed, within_limits)) if steps else ()
        call = _call(room, _into_limits(problem, room, steps, within_limits), held)
        return cls(call, _call(room, arranged, held, seed), low, high, problem)


class HeldCalls(dict[tuple[int | str, type, bool], HeldCall]):
    """The latest function for each joint that was held, as it was named, with limits or without."""

    def answer(
        self, T: ArrayLike, locked: Locked, within_limits: bool, seed: ArrayLike | None
    ) -> tuple[Problem, bytes | None] | None:
        """A problem, and the memory of its answer to a pose, if there is a function for it."""
        if type(locked) is not dict or len(locked) != 1:
            return None
        [(key, value)] = locked.items()
        held = self.get((key, type(key), within_limits))
        if not held or type(value) is not float or not held.low < value < held.high:
            return None
        memory = held.call(T, value) if seed is None else held.seeded(T, value, seed)
        if memory is not None and not any(memory[COUNT]):  # what is searched, is so in Python
            return None
        return held.problem, memory

    def learn(self, problem: Problem, locked: Locked, within_limits: bool) -> None:
        """Make the function for what is held, if that is one joint at one value."""
        if type(problem) is not Problem or len(locked) != 1 or problem.values is None:
            return
        [key] = locked
        name = key, type(key), within_limits
        useless = name in self and self[name].call is nothing_at_once
        if problem.values.shape == (1, 1) and type(key) in (int, str) and not useless:
            self[name] = HeldCall.of(problem, float(problem.values[0, 0]), within_limits)


def _room(problem: Problem) -> Room:
    return Room(problem.solver.kmax, problem.chain.n)


def _steps(problem: Problem, room: Room, within_limits: bool) -> tuple[Step, ...]:
    """The kernels that solve; none where Python helps."""
    if isinstance(problem, CoupledProblem):
        inner = _steps(problem.inner, room, within_limits)
        families: Step = any_family, (room.out.counts, room.out.free), False
        put: Step = values_of_batch, (*problem.kernel(within_limits), room.Ts, room.out), True
        return (*inner, families, put) if inner else ()
    if type(problem) not in (Problem, SweptProblem) or not isinstance(problem.solver, SolverBase):
        return ()
    return problem.solver.steps(room.Ts, within_limits, room.out)


def _into_limits(
    problem: Problem, room: Room, steps: tuple[Step, ...], within_limits: bool
) -> tuple[Step, ...]:
    """Steps, if there are any, and the one after them that brings families into the limits."""
    if not steps or not within_limits or isinstance(problem, CoupledProblem):
        return steps
    return *steps, (families_inside, (*problem.limits, room.Ts, room.out), False)


def _call(room: Room, steps: tuple[Step, ...], *more: Array) -> AtOnce:
    """The function that checks a pose and goes through steps; none if there are none."""
    if not steps:
        return nothing_at_once
    is_one: Step = is_pose, (room.Ts[0],), True
    return at_once(room.memory, is_one, *steps, more=more)
