"""A continuous joint path through a sequence of poses.

Dynamic programming over all solutions of all poses (Bellman's principle): of all ways through
the branches, the one with the fewest breaks and, among those, the least joint motion.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from dh2urdf.doors import number
from dh2urdf.ik import limits
from dh2urdf.ik.batch import IKBatch
from dh2urdf.ik.families import Family
from dh2urdf.ik.problem import Problem
from dh2urdf.ik.solutions import IKSolutions
from dh2urdf.ik.tolerances import PATH_JUMP
from dh2urdf.transforms import Array

__all__ = ["IKPath", "find_path"]

MOST_STATES = 512
"""Configurations (solutions times turns) followed side by side."""

BREAK = 1e9
"""Cost of one break [rad or m]: more than any motion without one."""

UNWOUND = 1e-6
"""Cost of a beginning per distance from the middle of the limits: decides between equals only."""


@dataclass(frozen=True, eq=False)
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
        """Length of the path in joint space [rad or m], jumps included."""
        reached = self.q[np.isfinite(self.q[:, :1]).all(axis=1)]
        return float(np.linalg.norm(np.diff(reached, axis=0), axis=1).sum())

    def __len__(self) -> int:
        return len(self.q)

    def __str__(self) -> str:
        lines = [f"{len(self)} poses, joint motion {self.motion:.4g}"]
        lines += [f"pose {i} is out of reach" for i in self.unreachable]
        for i in self.breaks:
            before = i - 1
            while before in self.unreachable:
                before -= 1
            step = self.q[i] - self.q[before]
            j = int(np.abs(step).argmax())
            lines.append(
                f"break between poses {before} and {i}: {self.joint_names[j]} "
                f"would have to move by {step[j]:.4g}"
            )
        return "\n".join(lines)


@dataclass(frozen=True)
class _Stage:
    """The configurations considered at one pose, their cost so far and their predecessors."""

    pose: int
    q: Array
    cost: Array
    parent: np.ndarray[tuple[int], np.dtype[np.int64]]


def find_path(
    problem: Problem,
    batch: IKBatch,
    start: Array | None,
    within_limits: bool,
    max_jump: float | None,
) -> IKPath:
    """The path of least joint motion through the solutions of a batch of poses.

    Parameters
    ----------
    problem : Problem
    batch : IKBatch
        All solutions of the poses, in the order of the path.
    start : array, shape (n,), optional
        Checked configuration before the first pose; the way from there counts as motion.
    within_limits : bool
    max_jump : float, optional
        Motion of a joint between neighbours that counts as a break [rad or m].
    """
    jump = PATH_JUMP if max_jump is None else number(max_jump, "max_jump", 1e-9, np.inf)
    stages: list[_Stage] = []
    unreachable = []
    for i in range(len(batch)):
        found = batch.solutions(i)
        if not found:
            unreachable.append(i)
        elif not stages:
            stages.append(_first_stage(problem, i, found, start, within_limits))
        else:
            ahead = batch.solutions(i + 1) if i + 1 < len(batch) else None
            stages.append(_next_stage(problem, stages[-1], i, found, ahead, within_limits, jump))
    q = np.full((len(batch), problem.chain.n), np.nan)
    breaks = _trace(stages, q, jump)
    return IKPath(q, breaks, tuple(unreachable), problem.chain.names, jump)


def _first_stage(
    problem: Problem, pose: int, found: IKSolutions, origin: Array | None, within_limits: bool
) -> _Stage:
    """Where the path may begin: near the start, or at any solution in any turn."""
    if origin is not None:
        q = problem.arranged(found, origin, within_limits).q
        return _Stage(pose, q, np.linalg.norm(q - origin, axis=1), np.zeros(len(q), np.int64))
    few = 0 < limits.turn_counts(problem.chain, found.q).sum() <= MOST_STATES
    q = problem.with_all_turns(found).q if few else found.q
    wound = np.linalg.norm(q - limits.middle(problem.chain), axis=1)
    return _Stage(pose, q, UNWOUND * wound, np.zeros(len(q), np.int64))


def _next_stage(
    problem: Problem,
    last: _Stage,
    pose: int,
    found: IKSolutions,
    ahead: IKSolutions | None,
    within_limits: bool,
    jump: float,
) -> _Stage:
    """Every way on from the last stage; for each configuration the cheapest."""
    targets = _with_members(problem, last, found, ahead, within_limits)
    q = limits.turned_to(problem.chain, targets[None], last.q[:, None])
    step = q - last.q[:, None]
    cost = last.cost[:, None] + np.linalg.norm(step, axis=2)
    cost = cost + BREAK * (np.abs(step).max(axis=2) > jump)
    order = np.argsort(cost, axis=None, kind="stable")
    _, first = np.unique(_turn_keys(q, targets).ravel()[order], return_index=True)
    keep = order[np.sort(first)[:MOST_STATES]]
    source, target = np.unravel_index(keep, cost.shape)
    return _Stage(pose, q[source, target], cost[source, target], source.astype(np.int64))


def _turn_keys(q: Array, targets: Array) -> Array:
    """One number for each target and its turns, of configurations q (f, k, n), shape (f, k)."""
    turns = np.round((q - targets) / limits.TWO_PI)
    keys: Array = np.arange(float(len(targets))) + turns @ (
        len(targets) * 64.0 ** np.arange(q.shape[2])
    )
    return keys


def _with_members(
    problem: Problem,
    last: _Stage,
    found: IKSolutions,
    ahead: IKSolutions | None,
    within_limits: bool,
) -> Array:
    """Solutions (k, n), singular families by their members nearest to where the path is or goes."""
    rows = [found.q]
    for q, free in zip(found.q, found.free_joints, strict=True):
        if not free:
            continue
        family = Family(problem.chain, problem.task, found.T, free, q)
        best = last.q[np.argsort(last.cost, kind="stable")[:8]]
        goals = [*best, *(ahead.q if ahead is not None else ())]
        members = (family.nearest(goal, within_limits) for goal in goals)
        rows += [member[None] for member in members if member is not None]
    return np.concatenate(rows)


def _trace(stages: list[_Stage], q: Array, jump: float) -> tuple[int, ...]:
    """Follow the cheapest end back to the beginning, into q (m, n); the breaks on the way."""
    if not stages:
        return ()
    state = int(stages[-1].cost.argmin())
    breaks = []
    for stage, before in zip(stages[::-1], [*stages[-2::-1], None], strict=True):
        q[stage.pose] = stage.q[state]
        if before is None:
            break
        parent = int(stage.parent[state])
        if np.abs(stage.q[state] - before.q[parent]).max() > jump:
            breaks.append(stage.pose)
        state = parent
    return tuple(breaks[::-1])
