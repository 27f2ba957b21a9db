"""Six revolute joints with three neighbouring parallel axes, 1, 2, 3 or 2, 3, 4: UR and its kin."""

from __future__ import annotations

from functools import cached_property

from dh2urdf.chain import SerialChain
from dh2urdf.ik.arm import (
    NOMINAL,
    SLACK,
    SLACK_OF_NOISE,
    AxisLines,
    BatchKernel,
    DHForm,
    Others,
    SolverBase,
    Task,
    moves_freely,
    plain_ranges,
)

__all__ = ["ThreeParallel"]


class ThreeParallel(SolverBase):
    """Closed form in the plane of the three axes; ``tolerance`` as in ``SphericalWrist``."""

    name = "three parallel axes"
    kmax = 8

    def __init__(
        self,
        chain: SerialChain,
        task: Task = Task.POSE,
        others: Others = (),
        tolerance: float = NOMINAL,
    ) -> None:
        super().__init__(chain, task, others)
        self.lines = AxisLines(chain, tolerance)
        self.form = DHForm(self.lines)
        slack = max(SLACK, SLACK_OF_NOISE * tolerance)
        self.constants = self.links, self.joints, self.form.rows, self.form.ends, slack

    @classmethod
    def obstacle(
        cls, chain: SerialChain, task: Task = Task.POSE, tolerance: float = NOMINAL
    ) -> str | None:
        """Say what keeps the family from covering the chain; None if nothing does."""
        if task is not Task.POSE:
            return f"it solves for the full pose, not for {task.value}"
        if chain.n != 6 or chain.prismatic.any():
            return "it needs 6 revolute joints"
        lines = AxisLines(chain, tolerance)
        if not (lines.three_parallel(0) or lines.three_parallel(1)):
            return "no three neighbouring axes are parallel"
        if not moves_freely(chain):
            return "the arm cannot move its tool in all six directions"
        return None

    def details(self) -> str:
        """Name the axes and the subproblems."""
        first = 2 if self.lines.three_parallel(1) else 1
        meet = self.lines.meet(4)
        outer = ("1 and 5" if first == 2 else "4 and 5") + (
            " one after the other (subproblem 4)" if meet else " together (subproblem 6)"
        )
        return (
            f"axes {first}, {first + 1}, {first + 2} are parallel ({self.lines.describe()}); "
            f"joints {outer}, joint 6 (subproblem 1), then a planar arm (subproblems 3 and 1)"
        )

    @cached_property
    def kernel(self) -> BatchKernel:
        """The fastest kernel that covers the geometry."""
        from dh2urdf.kernels.parallel_axes import solve_common_parallel, solve_three_parallel

        rows = self.form.rows
        common = rows[0, 2] != 0.0 and rows[3, 1] == rows[4, 1] == rows[4, 0] == 0.0
        fast = common and self.form.exact and plain_ranges(self.chain)
        return solve_common_parallel if fast else solve_three_parallel  # type: ignore[no-any-return]
