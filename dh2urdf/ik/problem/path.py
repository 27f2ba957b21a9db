"""A continuous joint path through a sequence of poses.

Dynamic programming over all solutions of all poses (Bellman's principle): of all ways through
the branches, the one with the fewest breaks and, among those, the least joint motion.
"""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from dh2urdf.doors import number
from dh2urdf.ik.arm import PATH_JUMP, middle
from dh2urdf.ik.problem.problem import Problem, Progress
from dh2urdf.transforms import Array

MOST_STATES = 512
"""Configurations (solutions times turns) followed side by side."""

BREAK = 1e9
"""Cost of one break [rad or m]: more than any motion without one."""

SHOWN = 5
"""Breaks, and poses out of reach, that are printed."""

UNWOUND = 1e-6
"""Cost of a beginning per distance from the middle of the limits: decides between equals only."""


@dataclass(frozen=True, eq=False, repr=False)
class IKPath:
    """A joint path, and where it cannot be continuous.

    Attributes
    ----------
    q : array, shape (m, n)
        Configuration at each pose [rad] or [m]; NaN where the pose is out of reach.
    breaks : tuple of int
        Indices i where a joint has to jump on the way from the pose before to pose i.
    unreachable : tuple of int
        Indices of poses without a solution.
    joint_names : tuple of str
    max_jump : float
        Motion of a joint between two poses that counts as a jump [rad or m].
    pose_change : array, shape (m,)
        How far each given pose was from a rigid one [rad]; 0 unless ``nearest=True`` was asked for.
    """

    q: Array
    breaks: tuple[int, ...]
    unreachable: tuple[int, ...]
    joint_names: tuple[str, ...]
    max_jump: float
    pose_change: Array = field(default_factory=lambda: np.zeros(0))

    @property
    def continuous(self) -> bool:
        """Whether every pose is reached and no joint jumps."""
        return not self.breaks and not self.unreachable

    @property
    def motion(self) -> float:
        """Length of the path in joint space, jumps included, [rad or m].

        The sum over the steps of ``sqrt(dq_1^2 + ... + dq_n^2)``.
        """
        reached = self.q[np.isfinite(self.q[:, :1]).all(axis=1)]
        return float(np.linalg.norm(np.diff(reached, axis=0), axis=1).sum())

    def __len__(self) -> int:
        return len(self.q)

    @property
    def summary(self) -> str:
        """One line: poses, motion, breaks, poses out of reach."""
        counts = {"break": len(self.breaks), "out of reach": len(self.unreachable)}
        found = [
            f"{k} {what}{'s' * (k > 1 and what == 'break')}" for what, k in counts.items() if k
        ]
        return ", ".join([f"{len(self)} poses, joint motion {self.motion:.4g}", *found])

    @property
    def gaps(self) -> tuple[tuple[int, int], ...]:
        """First and last of each run of poses out of reach."""
        missing = np.array(self.unreachable, int)
        runs = np.split(missing, np.flatnonzero(np.diff(missing) > 1) + 1)
        return tuple((int(run[0]), int(run[-1])) for run in runs if len(run))

    def jump(self, i: int) -> tuple[int, int, float]:
        """Of pose i of ``breaks``: the pose before, the joint that jumps most, by how much."""
        before = i - 1
        while np.isnan(self.q[before, 0]):
            before -= 1
        step = self.q[i] - self.q[before]
        joint = int(np.abs(step).argmax())
        return before, joint, float(step[joint])

    def __str__(self) -> str:
        lines = [
            f"poses {first} to {last} are out of reach"
            if first < last
            else f"pose {first} is out of reach"
            for first, last in self.gaps[:SHOWN]
        ]
        more = len(self.gaps) - SHOWN
        lines += [f"... and {more} more gaps"] if more > 0 else []
        for i in self.breaks[:SHOWN]:
            before, joint, by = self.jump(i)
            name = self.joint_names[joint]
            move = f"{name} would have to move by {by:.4g}"
            lines.append(f"break between poses {before} and {i}: {move}")
        more = len(self.breaks) - SHOWN
        lines += [f"... and {more} more breaks"] if more > 0 else []
        return "\n".join([self.summary, *lines])

    def __repr__(self) -> str:
        return f"<IKPath: {self.summary}>"


@dataclass(frozen=True)
class Stage:
    """The configurations considered at one pose, their cost so far and their predecessors."""

    pose: int
    q: Array
    cost: Array
    parent: NDArray[np.int64]

    def cheapest(self) -> NDArray[np.int64]:
        """Indices of the states, the cheapest first."""
        return np.argsort(self.cost, kind="stable")


class PathFinder:
    """Finds the path of least joint motion through checked poses (m, 4, 4).

    It may begin at a configuration before the first pose; the way from there counts as motion.
    """

    def __init__(
        self,
        problem: Problem,
        Ts: Array,
        start: Array | None,
        within_limits: bool,
        max_jump: float | None,
        tell: Progress | None = None,
    ) -> None:
        self.tell = tell
        self.jump = PATH_JUMP if max_jump is None else number(max_jump, "max_jump", 1e-9, np.inf)
        self.problem, self.chain, self.Ts = problem, problem.chain, Ts
        self.origin, self.within_limits = start, within_limits
        self.batch = problem.solve_many(Ts, within_limits, None, None)

    def find(self) -> IKPath:
        """The path."""
        reached = self.batch.count > 0
        stages: list[Stage] = []
        for i in np.flatnonzero(reached).tolist():
            stages.append(self.next(stages[-1], i) if stages else self.first(i))
            if self.tell:
                self.tell(i + 1, len(self.Ts))
        q = np.full((len(self.Ts), self.chain.n), np.nan)
        if stages:
            q[reached] = self.best(stages)
        steps = np.abs(np.diff(q[reached], axis=0)).max(axis=1, initial=0.0)
        breaks = np.flatnonzero(reached)[1:][steps > self.jump]
        missing = tuple(np.flatnonzero(~reached).tolist())
        return IKPath(q, tuple(breaks.tolist()), missing, self.chain.names, self.jump)

    def first(self, pose: int) -> Stage:
        """Where the path may begin: near the start, or at any solution in any turn."""
        found = self.batch.solutions(pose)
        if self.origin is not None:
            q = self.problem.arranged(found, self.origin, self.within_limits).q
            return Stage(pose, q, np.linalg.norm(q - self.origin, axis=1), np.zeros(len(q), int))
        few = 0 < self.problem.turn_counts(found.q).sum() <= MOST_STATES
        q = self.problem.with_all_turns(found).q if few else found.q
        wound = np.linalg.norm(q - middle(self.chain), axis=1)
        return Stage(pose, q, UNWOUND * wound, np.zeros(len(q), int))

    def next(self, last: Stage, pose: int) -> Stage:
        """Every way on from the last stage; for each configuration the cheapest."""
        targets = self.targets(last, pose)
        q = self.problem.turned(targets[None], last.q[:, None], self.within_limits)
        cost = last.cost[:, None] + self.step_costs(q - last.q[:, None])
        order = np.argsort(cost, axis=None, kind="stable")
        keys = _turn_keys(self.problem.turn_numbers(q, targets))
        _, first = np.unique(keys.ravel()[order], return_index=True)
        keep = order[np.sort(first)[:MOST_STATES]]
        source, target = np.unravel_index(keep, cost.shape)
        return Stage(pose, q[source, target], cost[source, target], source.astype(np.int64))

    def step_costs(self, step: Array) -> Array:
        """Lengths of steps (..., n), more by ``BREAK`` where a joint jumps."""
        jumps = np.abs(step).max(axis=-1, initial=0.0) > self.jump
        costs: Array = np.linalg.norm(step, axis=-1) + BREAK * jumps
        return costs

    def targets(self, last: Stage, pose: int) -> Array:
        """Solutions (k, n), singular families by members nearest to where the path is or goes."""
        found = self.batch.solutions(pose)
        rows = [found.q]
        for k in np.flatnonzero(found.codes[1]).tolist():
            ahead = self.batch.solutions(pose + 1).q if pose + 1 < len(self.batch) else ()
            goals = [*last.q[last.cheapest()[:8]], *ahead]
            members = self.problem.members_near(found, k, goals, self.within_limits)
            rows += [member[None] for member in members]
        return np.concatenate(rows)

    def best(self, stages: list[Stage]) -> Array:
        """The cheapest path (m, n)."""
        return trace(stages, int(stages[-1].cheapest()[0]))


def trace(stages: list[Stage], state: int) -> Array:
    """Follow a state of the last stage back to the beginning: a path (m, n)."""
    q = np.empty((len(stages), stages[0].q.shape[1]))
    for i in range(len(stages) - 1, -1, -1):
        q[i] = stages[i].q[state]
        state = int(stages[i].parent[state])
    return q


def _turn_keys(turns: Array) -> Array:
    """One number for each of k targets and its turns (f, k, n), shape (f, k)."""
    k, n = turns.shape[1:]
    keys: Array = np.arange(float(k)) + turns @ (k * 64.0 ** np.arange(n))
    return keys
