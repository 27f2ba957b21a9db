"""Mirrored families: an arm seen from its tool.

Reversed, the chain ``T_tool_base`` has the same joints in the opposite order, and a spherical
shoulder becomes a spherical wrist.
"""

from collections.abc import Callable
from typing import ClassVar

import numpy as np

from dh2urdf.chain import SerialChain
from dh2urdf.engine import Step
from dh2urdf.ik.arm import NOMINAL, Others, Outputs, SolverBase, Task
from dh2urdf.ik.families.closed_form import ThreeParallel
from dh2urdf.ik.families.spherical_wrist import SphericalWrist
from dh2urdf.kernels.certificate import turn_back
from dh2urdf.kernels.rigid import invert_poses
from dh2urdf.transforms import Array


class ReversedSolver(SolverBase):
    """A family applied to the reversed chain."""

    inner_class: ClassVar[type[SolverBase]]

    def __init__(self, chain: SerialChain, task: Task = Task.POSE, others: Others = ()) -> None:
        super().__init__(chain, task, others)
        self.inner = self.inner_class(chain.reversed(), task)
        self.kmax = self.inner.kmax

    @classmethod
    def obstacle(
        cls, chain: SerialChain, task: Task = Task.POSE, tolerance: float = NOMINAL
    ) -> str | None:
        """Say what keeps the family from the reversed chain, joints numbered from the tool."""
        reason = cls.inner_class.obstacle(chain.reversed(), task, tolerance)
        return None if reason is None else f"seen from the tool, {reason}"

    def details(self) -> str:
        """Name the axes as the reversed chain has them."""
        return f"the arm seen from its tool, joint 1 the last: {self.inner.details()}"

    def solve_batch(self, Ts: Array, within_limits: bool, out: Outputs) -> None:
        """Solve the inverse poses, and turn the solutions back."""
        inverse_poses = np.empty_like(Ts)
        invert_poses(Ts, inverse_poses)
        self.inner.solve_batch(inverse_poses, False, out)
        turn_back(self.chain.tables, Ts, within_limits, out)

    def before_search(self, Ts: Array) -> tuple[Outputs, Outputs]:
        """The same of the inverse poses, turned back."""
        inverse_poses = np.empty_like(Ts)
        invert_poses(Ts, inverse_poses)
        known, found = self.inner.before_search(inverse_poses)
        for some in (known,) if found is known else (known, found):
            turn_back(self.chain.tables, Ts, False, some)
        return known, found

    def steps(self, Ts: Array, within_limits: bool, out: Outputs) -> tuple[Step, ...]:
        """As :meth:`solve_batch`."""
        return self._around(self.inner.steps, Ts, within_limits, out)

    def all_steps(self, Ts: Array, within_limits: bool, out: Outputs) -> tuple[Step, ...]:
        """The same with what is done of poses in doubt."""
        return self._around(self.inner.all_steps, Ts, within_limits, out)

    def _around(
        self, steps: Callable[..., tuple[Step, ...]], Ts: Array, within_limits: bool, out: Outputs
    ) -> tuple[Step, ...]:
        """Steps of the reversed chain, between those that invert the poses and turn back."""
        inverse_poses = np.empty_like(Ts)
        invert: Step = invert_poses, (Ts, inverse_poses), False
        back: Step = turn_back, (self.chain.tables, Ts, within_limits, out), False
        return invert, *steps(inverse_poses, False, out), back


class SphericalShoulder(ReversedSolver):
    """The first three axes meet in one point."""

    name = "spherical shoulder"
    needs = "six joints, the first three revolute with axes through one point"
    inner_class = SphericalWrist


class ThreeParallelReversed(ReversedSolver):
    """Axes 3, 4, 5 or 4, 5, 6 are parallel."""

    name = "three parallel axes, from the tool"
    needs = "six revolute joints, axes 3, 4, 5 or 4, 5, 6 parallel"
    inner_class = ThreeParallel
