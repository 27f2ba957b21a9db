"""Poses of an arm with one joint to spare: what is nearest to a seed lies between the samples.

So does the shortest path, which is as short as self-motions allow.
"""

from typing import Any

import numpy as np

from dh2urdf.ik.arm import Outputs, Room
from dh2urdf.ik.problem.path import BREAK, MOST_STATES, PathFinder, Stage, trace
from dh2urdf.ik.problem.problem import Problem
from dh2urdf.ik.problem.solutions import IKSolutions
from dh2urdf.ik.redundant import MOST_MEMBERS, SweptJoint, reach_intervals, run, towards_seed
from dh2urdf.kernels.newton import POSE
from dh2urdf.kernels.redundant import onward, shorten
from dh2urdf.transforms import Array

SAMPLES = 64
"""Values of the swept joint at every pose."""

CELL = 0.2
"""Joint distance [rad or m] below which two states of a pose, or two ends, are as good as one: what
lies between is found when the path is made shorter."""

TRIALS = 64
"""Most paths that are made shorter: those to the cheapest ends."""

KEYS = 64
"""Poses from which a path is told from others; a longer one has them at equal distances."""

EQUAL = 1e-3
"""Relative difference of lengths below which the path found first stays."""


class SweptProblem(Problem):
    """A problem whose solver sweeps a joint."""

    solver: SweptJoint
    sampled = True

    def arranged(self, found: IKSolutions, seed: Array, within_limits: bool = True) -> IKSolutions:
        """The nearest members to the seed (n,) on all self-motions, then the samples."""
        k = len(found)
        some, room = Outputs.of(1, max(k, 1), self.chain.n), Room(MOST_MEMBERS + k, self.chain.n)
        some.q[0, :k], some.counts[0], room.Ts[0] = found.q, k, found.T
        some.branch[0, :k], some.free[0, :k] = found.codes
        run(towards_seed(self.solver, room.Ts, seed, within_limits, some, room.out))
        return IKSolutions(self, room.memory.tobytes())

    def intervals(self, T: Array, within_limits: bool) -> Array:
        """Intervals of the swept joint in which a pose (4, 4) is reached, shape (k, 2)."""
        return reach_intervals(self.solver, T, within_limits)


class SweptPath(PathFinder):
    """Between the samples of the poses a path follows the arm, and is then made shorter."""

    def __init__(self, problem: SweptProblem, *arguments: Any) -> None:
        solver = problem.solver.like(SAMPLES)
        dense = SweptProblem(problem.chain, solver, problem.task, problem.referee)
        super().__init__(dense, *arguments)
        links, joints = self.chain.tables
        if not self.within_limits:
            joints = np.column_stack([joints[:, 0], np.full((self.chain.n, 2), [-np.inf, np.inf])])
        self.arm = links, joints

    def next(self, last: Stage, pose: int) -> Stage:
        """The last stage's states where they follow the arm, and the samples, one for a cell."""
        samples = self.batch.solutions(pose).q
        q = np.concatenate([last.q, samples])
        cost, parent = np.empty(len(q)), np.empty(len(q), int)
        self._onward(pose, last.q, last.cost, samples, q, cost, parent)
        order = np.argsort(cost, kind="stable")[: np.isfinite(cost).sum()]
        cells = np.round(q[order] / CELL) @ 97.0 ** np.arange(self.chain.n)
        _, first = np.unique(cells, return_index=True)
        keep = order[np.sort(first)[:MOST_STATES]]
        return Stage(pose, q[keep], cost[keep], parent[keep])

    def _onward(self, pose: int, q: Array, *ways: Array) -> None:
        """Ways on to a pose from the states q (f, n) of the last one, see the kernel."""
        goal, room = (POSE, self.Ts[pose], self.chain.size), np.empty((2, len(q)), np.bool_)
        onward(self.arm, goal, self.jump, BREAK, q, *ways, room)

    def best(self, stages: list[Stage]) -> Array:
        """The shortest of the paths to several ends, each made as short as it gets.

        Through its keys a path is no longer than through all poses, so that those whose keys are
        longer than the shortest path need no more.
        """
        last, poses = stages[-1], np.array([stage.pose for stage in stages])
        trials: list[tuple[float, Array, Array, Array]] = []
        ends = np.empty((0, self.chain.n))
        for state in last.cheapest():
            if len(trials) == TRIALS or np.any(np.abs(ends - last.q[state]).max(axis=1) < CELL):
                continue
            q = trace(stages, int(state))
            rows = self._keys(q)
            keys = q[rows]
            breaks = BREAK * np.round(last.cost[state] / BREAK)
            trials.append((self._shorten(poses[rows], keys, np.inf) + breaks, rows, keys, q))
            ends = np.concatenate([ends, [last.q[state], keys[-1]]])
        best, least = np.empty(0), np.inf
        for length, rows, keys, q in sorted(trials, key=lambda trial: round(trial[0], 6)):
            for path in (self._filled(poses, rows, keys), q):
                if least - EQUAL * (least % BREAK) < length:
                    return best
                whole = self._shorten(poses, path, self.jump)
                if whole < least:
                    best, least = path, whole
        return best

    def _keys(self, q: Array) -> Array:
        """Rows of a path (m, n): some at equal distances, and both ends of each break."""
        m = len(q)
        breaks = np.flatnonzero(self.step_costs(np.diff(q, axis=0)) >= BREAK)
        rows: Array = np.unique([*range(0, m, -(-m // KEYS)), m - 1, *breaks, *(breaks + 1)])
        return rows

    def _shorten(self, poses: Array, q: Array, jump: float) -> float:
        """Shorten a path (m, n) through some poses in place; its length."""
        if not np.isfinite(q).all():
            return np.inf
        Ts = np.ascontiguousarray(self.Ts[poses])
        start = np.empty((0, self.chain.n)) if self.origin is None else self.origin[None]
        room = np.empty((2, *q.shape)), np.empty((8, len(q)))
        return float(shorten(self.arm, Ts, self.chain.size, start, jump, BREAK, q, *room))

    def _filled(self, poses: Array, rows: Array, keys: Array) -> Array:
        """A path (m, n) through all poses near some rows of it; NaN where it leaves the arm."""
        every = np.arange(len(poses))
        path = np.column_stack([np.interp(every, rows, column) for column in keys.T])
        none, cost, parent = np.empty((0, self.chain.n)), np.empty(1), np.empty(1, int)
        for i in np.setdiff1d(every, rows):
            here = path[i : i + 1]
            self._onward(poses[i], here.copy(), np.zeros(1), none, here, cost, parent)
            path[i] += 0.0 if np.isfinite(cost[0]) else np.nan
        return path
