"""What a base is worth for a job: how many of its poses are reached, and how well."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from dh2urdf.robot import Robot
from dh2urdf.transforms import Array
from dh2urdf.workspace.measures import measure_best
from dh2urdf.workspace.refine import Progress
from dh2urdf.workspace.section import reach_ball

PIECE = 8_192
"""Poses solved at a time."""

TRIALS = 20_000
"""Configurations among which the arm's best singular value is sought."""


@dataclass(frozen=True, eq=False)
class Job:
    """Poses to be reached by an arm whose base is to be found.

    Parameters
    ----------
    robot : Robot
    T_world_tool : array, shape (m, 4, 4)
    T_foot_base : array, shape (4, 4)
        The base as mounted, in a frame that stands at (x, y, z) turned by yaw about the vertical.
    task : str
    within_limits : bool
    """

    robot: Robot
    T_world_tool: Array
    T_foot_base: Array
    task: str
    within_limits: bool

    def __len__(self) -> int:
        return len(self.T_world_tool)

    @cached_property
    def best_singular(self) -> float:
        """The largest of the smallest singular values over the arm's configurations."""
        low, high = self.robot.bounded(1.0, np.pi)
        q = low + np.random.default_rng(0).random((TRIALS, self.robot.n)) * (high - low)
        return float(self._singular(q).max())

    def poses(self, bases: Array, which: NDArray[np.intp]) -> Array:
        """``T_base_tool`` of pose ``which[k]`` from base k (x, y, z, yaw), shape (k, 4, 4)."""
        c, s = np.cos(bases[:, 3]), np.sin(bases[:, 3])
        R_world_foot = np.zeros((len(bases), 3, 3))
        R_world_foot[:, 0, 0] = R_world_foot[:, 1, 1] = c
        R_world_foot[:, 1, 0], R_world_foot[:, 0, 1], R_world_foot[:, 2, 2] = s, -s, 1.0
        R_world_base = R_world_foot @ self.T_foot_base[:3, :3]
        origin = bases[:, :3] + R_world_foot @ self.T_foot_base[:3, 3]
        T = np.zeros((len(bases), 4, 4))
        targets = self.T_world_tool[which]
        R_base_world = R_world_base.swapaxes(1, 2)
        T[:, :3, :3] = R_base_world @ targets[:, :3, :3]
        T[:, :3, 3] = np.einsum("kij,kj->ki", R_base_world, targets[:, :3, 3] - origin)
        T[:, 3, 3] = 1.0
        return T

    def reached(self, bases: Array, which: NDArray[np.intp], tell: Progress) -> NDArray[np.bool_]:
        """Whether pose ``which[k]`` is reached from base k, shape (k,)."""
        out = np.zeros(len(bases), np.bool_)
        centre, radius = reach_ball(self.robot)
        for start in range(0, len(bases), PIECE):
            part = slice(start, start + PIECE)
            T = self.poses(bases[part], which[part])
            near = np.linalg.norm(T[:, :3, 3] - centre, axis=1) <= radius * (1.0 + 1e-9)
            if near.any():
                found = self.robot.ik_batch(
                    T[near], within_limits=self.within_limits, task=self.task
                )
                out[start + np.flatnonzero(near)] = found.count > 0
            tell(min(start + PIECE, len(bases)), len(bases))
        return out

    def margins(self, bases: Array, which: NDArray[np.intp], tell: Progress) -> tuple[Array, Array]:
        """Margin (k,) of pose ``which[k]`` from base k, and the configuration (k, n) that has it.

        0 and NaN where it is not reached.
        """
        n = self.robot.n
        margin, q = np.zeros(len(bases)), np.full((len(bases), n), np.nan)
        for start in range(0, len(bases), PIECE):
            part = slice(start, start + PIECE)
            T = self.poses(bases[part], which[part])
            found = self.robot.ik_batch(T, within_limits=self.within_limits, task=self.task)
            has = np.arange(found.q.shape[1]) < found.count[:, None]
            each = np.full(has.shape, -1.0)
            each[has] = self.margin_of(found.q[has])
            best = each.argmax(axis=1)
            rows = np.flatnonzero(has.any(axis=1))
            margin[start + rows] = each[rows, best[rows]]
            q[start + rows] = found.q[rows, best[rows]]
            tell(min(start + PIECE, len(bases)), len(bases))
        return margin, q

    def margin_of(self, q: Array) -> Array:
        """Margin of configurations (k, n), 0 to 1, shape (k,)."""
        if not len(q):
            return np.empty(0)
        limits = np.ones(len(q))
        width = self.robot.upper - self.robot.lower
        some = np.isfinite(width) & (width > 0.0)
        if self.within_limits and some.any():
            low, high = self.robot.lower[some], self.robot.upper[some]
            room = 2 * np.minimum(q[:, some] - low, high - q[:, some]) / (high - low)
            limits = np.clip(room.min(axis=1), 0.0, 1.0)
        return np.minimum(limits, np.clip(self._singular(q) / self.best_singular, 0.0, 1.0))

    def _singular(self, q: Array) -> Array:
        """Smallest singular value of the task's Jacobian, lengths in sizes of the arm, (k,)."""
        best, ones = np.empty((3, len(q))), np.ones(len(q), np.int64)
        measure_best(self.robot, self.task, q[:, None], ones, best, self.robot.chain.size)
        return np.asarray(best[1])
