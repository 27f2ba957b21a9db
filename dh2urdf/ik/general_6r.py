"""Any arm of six revolute joints: elimination, then Newton on the exact chain."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from dh2urdf.chain import SerialChain
from dh2urdf.ik.geometry import AxisLines, moves_freely
from dh2urdf.ik.notice import notice_if_slow
from dh2urdf.ik.solver import IntArray, SolverBase, Task
from dh2urdf.transforms import Array

if TYPE_CHECKING:
    from dh2urdf.kernels.general_6r import Arm

__all__ = ["General6R"]

TRIALS = 6
"""Random poses by which a plan is tried."""

SAME = 1e-4
"""Joint distance [rad] at which a solution is the configuration that was asked for."""


class General6R(SolverBase):
    """Raghavan and Roth's elimination of five joints; up to 16 solutions."""

    name = "general 6R"
    kmax = 16

    def __init__(
        self,
        chain: SerialChain,
        task: Task = Task.POSE,
        others: tuple[tuple[str, str], ...] = (),
        plan: Arm | None = None,
    ) -> None:
        super().__init__(chain, task, others)
        from dh2urdf.kernels.finish import finish_batch
        from dh2urdf.kernels.general_6r import solve_general_6r

        if plan is not None:
            self.plan = plan
        self._kernel, self._finish = solve_general_6r, finish_batch
        self._idle: list[Arm] = []

    @cached_property
    def plan(self) -> Arm:
        """The eliminations that suit the arm; they are chosen when first asked for."""
        from dh2urdf.kernels.general_6r import plan_general_6r

        with notice_if_slow():
            return plan_general_6r(self.links)

    def like(self, chain: SerialChain) -> General6R:
        """The solver of a chain that differs little, with the same eliminations if they do."""
        from dh2urdf.kernels.general_6r import replan_general_6r

        plan = replan_general_6r(self.plan, np.ascontiguousarray(chain.links))
        solver = General6R(chain, self.task, plan=plan)
        return solver if solver.finds_itself() else General6R(chain, self.task)

    def finds_itself(self) -> bool:
        """Whether the configurations of a few random poses are among their solutions."""
        rng = np.random.default_rng(0)
        q = rng.uniform(-np.pi, np.pi, (TRIALS, 6))
        poses = np.stack([self.chain.fk(row) for row in q])
        found, residual = np.zeros((TRIALS, self.kmax, 6)), np.empty((TRIALS, self.kmax))
        count = np.zeros(TRIALS, np.int64)
        self._solve(poses, found, residual, count)
        gap = np.abs(np.remainder(found - q[:, None] + np.pi, 2.0 * np.pi) - np.pi).max(axis=2)
        gap[np.arange(self.kmax) >= count[:, None]] = np.inf
        return bool((gap.min(axis=1) < SAME).all())

    def _solve(self, Ts: Array, q: Array, residual: Array, count: IntArray) -> None:
        """Run the kernel on a copy of the plan that no other thread has."""
        try:
            arm = self._idle.pop()
        except IndexError:
            arm = self.plan.copy()
        self._kernel(arm, Ts, q, residual, count)
        self._idle.append(arm)

    @classmethod
    def obstacle(cls, chain: SerialChain, task: Task = Task.POSE) -> str | None:
        """Say what keeps the elimination from covering the chain; None if nothing does."""
        if task is not Task.POSE:
            return f"it solves for the full pose, not for {task.value}"
        if chain.n != 6 or chain.prismatic.any():
            return "it needs 6 revolute joints"
        if not moves_freely(chain):
            return "the arm cannot move its tool in all six directions"
        return None

    def solve_unfinished(self, Ts: Array, q_out: Array, count_out: IntArray) -> None:
        """Candidates of poses Ts (m, 4, 4), limits or not: q (m, 16, 6) and count (m,)."""
        self._solve(Ts, q_out, np.empty(q_out.shape[:2]), count_out)

    def details(self) -> str:
        """Name the axes and the method."""
        return (
            "five joints eliminated, the sixth from a polynomial of degree 16 (Raghavan and Roth "
            f"1993), then Newton's method on the exact chain; {AxisLines(self.chain).describe()}"
        )

    def solve_batch(
        self,
        Ts: Array,
        within_limits: bool,
        q_out: Array,
        residual_out: Array,
        count_out: IntArray,
        branch_out: IntArray,
        free_out: IntArray,
    ) -> None:
        """Solve poses Ts (m, 4, 4) in two jitted calls."""
        outputs = (q_out, residual_out, count_out)
        self._solve(Ts, *outputs)
        self._finish(self.links, self.joints, Ts, within_limits, *outputs, branch_out, free_out)
