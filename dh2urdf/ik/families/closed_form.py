"""Six joints whose axes give frames in which the equations come apart: closed forms.

Here the UR and its kin: three neighbouring parallel axes, 1, 2, 3 or 2, 3, 4.
"""

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
    plain_ranges,
)
from dh2urdf.kernels.parallel_axes import solve_common_parallel, solve_three_parallel

STUCK = "the arm cannot move its tool in all six directions"


class ClosedForm(SolverBase):
    """A closed form, in Denavit-Hartenberg frames found from the axes.

    ``tolerance`` is what is snapped: with a larger one an arm that is nearly of the family gets
    the nominal arm's solutions as seeds, and Newton's method on the exact chain the answers.
    """

    kmax = 8
    if_spare = STUCK

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
        self.constants = chain.tables, self.form.rows, self.form.ends, slack


def not_six_revolute(chain: SerialChain) -> str | None:
    """Say that a chain is not one of six revolute joints; None if it is."""
    six = chain.n == 6 and not chain.prismatic.any()
    return None if six else "it needs 6 revolute joints"


class ThreeParallel(ClosedForm):
    """Closed form in the plane of the three axes."""

    name = "three parallel axes"
    needs = "six revolute joints, axes 1, 2, 3 or 2, 3, 4 parallel"

    @classmethod
    def misfit(cls, chain: SerialChain, tolerance: float) -> str | None:
        """Say what keeps the family from covering the chain; None if nothing does."""
        if unfit := not_six_revolute(chain):
            return unfit
        lines = AxisLines(chain, tolerance)
        if not (lines.three_parallel(0) or lines.three_parallel(1)):
            return "no three neighbouring axes are parallel"
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
    def kernel(self) -> BatchKernel:  # type: ignore[override]
        """The fastest kernel that covers the geometry."""
        rows = self.form.rows
        common = rows[0, 2] != 0.0 and rows[3, 1] == rows[4, 1] == rows[4, 0] == 0.0
        fast = common and self.form.exact and plain_ranges(self.chain)
        return solve_common_parallel if fast else solve_three_parallel
