"""Any arm of six revolute joints: elimination, then Newton on the exact chain."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from dh2urdf.chain import SerialChain
from dh2urdf.ik.arm import AxisLines, Others, Outputs, SolverBase, Task, notice_if_slow
from dh2urdf.ik.families.closed_form import STUCK, not_six_revolute
from dh2urdf.transforms import Array

if TYPE_CHECKING:
    from dh2urdf.kernels.general_6r import Arm

TRIALS = 6
"""Random poses by which a plan is tried."""

SAME = 1e-4
"""Joint distance [rad] at which a solution is the configuration that was asked for."""


class General6R(SolverBase):
    """Raghavan and Roth's elimination of five joints; up to 16 solutions."""

    name = "general 6R"
    needs = "six revolute joints, any axes"
    kmax = 16
    if_spare = STUCK

    def __init__(self, chain: SerialChain, task: Task = Task.POSE, others: Others = ()) -> None:
        super().__init__(chain, task, others)
        from dh2urdf.kernels.certificate import finish_batch
        from dh2urdf.kernels.general_6r import solve_general_6r

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

        solver = General6R(chain, self.task)
        solver.plan = replan_general_6r(self.plan, np.ascontiguousarray(chain.links))
        return solver if solver.finds_itself() else General6R(chain, self.task)

    def finds_itself(self) -> bool:
        """Whether the configurations of a few random poses are among their solutions."""
        rng = np.random.default_rng(0)
        q = rng.uniform(-np.pi, np.pi, (TRIALS, 6))
        poses = np.stack([self.chain.fk(row) for row in q])
        out = Outputs.of(TRIALS, self.kmax, 6)
        out.q[:] = 0.0
        self.solve_unfinished(poses, out)
        gap = np.abs(np.remainder(out.q - q[:, None] + np.pi, 2.0 * np.pi) - np.pi).max(axis=2)
        gap[np.arange(self.kmax) >= out.counts[:, None]] = np.inf
        return bool((gap.min(axis=1) < SAME).all())

    @classmethod
    def misfit(cls, chain: SerialChain, tolerance: float) -> str | None:
        """Say what keeps the elimination from covering the chain; None if nothing does."""
        return not_six_revolute(chain)

    def solve_unfinished(self, Ts: Array, out: Outputs) -> None:
        """Candidates of poses Ts (m, 4, 4), limits or not: q and counts."""
        try:  # a copy of the plan that no other thread has
            arm = self._idle.pop()
        except IndexError:
            arm = self.plan.copy()
        self._kernel(arm, Ts, out.q, out.residual, out.counts)
        self._idle.append(arm)

    def details(self) -> str:
        """Name the axes and the method."""
        return (
            "five joints eliminated, the sixth from a polynomial of degree 16 (Raghavan and Roth "
            f"1993), then Newton's method on the exact chain; {AxisLines(self.chain).describe()}"
        )

    def solve_batch(self, Ts: Array, within_limits: bool, out: Outputs) -> None:
        """Solve poses Ts (m, 4, 4) in two jitted calls."""
        self.solve_unfinished(Ts, out)
        self._finish(self.links, self.joints, Ts, within_limits, *out)
