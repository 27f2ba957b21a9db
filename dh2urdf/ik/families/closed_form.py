"""Six joints whose axes give frames in which the equations come apart: closed forms.

Here the UR and its kin: three neighbouring parallel axes, 1, 2, 3 or 2, 3, 4.
"""

from functools import cached_property

import numpy as np

from dh2urdf.chain import SerialChain
from dh2urdf.engine import Step
from dh2urdf.ik.arm import (
    ALMOST,
    BRANCH_WORDS,
    NOMINAL,
    SLACK,
    SLACK_OF_NOISE,
    BatchKernel,
    IntArray,
    Others,
    Outputs,
    SolverBase,
    Task,
    form_of,
    lines_of,
    plain_ranges,
    room_in_doubt,
    starts_of,
)
from dh2urdf.kernels.counts import DEEP
from dh2urdf.kernels.in_doubt import FOUND, VALLEYS, follow_candidates, widen_parallel
from dh2urdf.kernels.parallel_axes import solve_common_parallel, solve_three_parallel
from dh2urdf.transforms import Array

UPSIDE_DOWN = (BRANCH_WORDS[0], BRANCH_WORDS[1][::-1], BRANCH_WORDS[2])
"""Names of the branches where axis 1 points down in the base, from where the kernels look up."""

STUCK = "the arm cannot move its tool in all six directions"


class ClosedForm(SolverBase):
    """A closed form, in Denavit-Hartenberg frames found from the axes.

    ``tolerance`` is what is snapped: with a larger one an arm that is nearly of the family gets
    the nominal arm's solutions as seeds, and Newton's method on the exact chain the answers.
    """

    kmax = 8
    if_spare = STUCK
    doubts: bool
    """Whether the kernel leaves poses in doubt."""
    widen: BatchKernel
    """The kernel that looks for more solutions of these."""

    def __init__(
        self,
        chain: SerialChain,
        task: Task = Task.POSE,
        others: Others = (),
        tolerance: float = NOMINAL,
    ) -> None:
        super().__init__(chain, task, others)
        self.lines, self.form = lines_of(chain, tolerance), form_of(chain, tolerance)
        if self.lines.axes[0, 2] < 0.0:  # of joint 1, in the base
            self.branch_words = UPSIDE_DOWN
        slack = max(SLACK, SLACK_OF_NOISE * tolerance)
        self.constants = chain.tables, self.form.rows, self.form.ends, slack

    def look_wider(self, Ts: Array, rows: IntArray, within_limits: bool, out: Outputs) -> None:
        """Look for more solutions of poses in doubt: along valleys, or from many starts."""
        kernel, arguments, _ = self._widen(Ts, within_limits, out)
        kernel(*arguments)

    def all_steps(self, Ts: Array, within_limits: bool, out: Outputs) -> tuple[Step, ...]:
        """The kernel, and what looks for more where it is in doubt."""
        more = (self._widen(Ts, within_limits, out),) if self.doubts else ()
        return *self.steps(Ts, within_limits, out), *more

    def _widen(self, Ts: Array, within_limits: bool, out: Outputs) -> Step:
        """The kernel that looks for more, and its arguments."""
        starts, size = starts_of(self.chain), self.chain.size
        given = starts, size, room_in_doubt(), np.zeros(1, VALLEYS), Ts, within_limits, out
        return self.widen, (self.constants, *given), False

    def before_search(self, Ts: Array) -> tuple[Outputs, Outputs]:
        """What the equations find; and, where it is in doubt, what lies along valleys, too."""
        known = Outputs.of(len(Ts), self.kmax, 6)  # those outside the limits, too
        self.kernel(self.constants, Ts, False, known)
        doubt = known.counts < 0
        if not doubt.any():
            return known, known
        known.counts[doubt] = (-1 - known.counts[doubt]) % DEEP
        found, valleys = Outputs.of(len(Ts), FOUND, 6), np.zeros(1, VALLEYS)
        found.counts[:] = known.counts
        beside = self.chain.size, valleys, Ts, known.q, found.q, found.counts
        follow_candidates(self.constants, self.widen is widen_parallel, *beside)
        return known, found


def not_six_revolute(chain: SerialChain) -> str | None:
    """Say that a chain is not one of six revolute joints; None if it is."""
    six = chain.n == 6 and not chain.prismatic.any()
    return None if six else "it needs 6 revolute joints"


class ThreeParallel(ClosedForm):
    """Closed form in the plane of the three axes."""

    name = "three parallel axes"
    needs = "six revolute joints, axes 1, 2, 3 or 2, 3, 4 parallel"

    widen = staticmethod(widen_parallel)

    @classmethod
    def misfit(cls, chain: SerialChain, tolerance: float) -> str | None:
        """Say what keeps the family from covering the chain; None if nothing does."""
        if unfit := not_six_revolute(chain):
            return unfit
        lines = lines_of(chain, tolerance)
        if not (lines.three_parallel(0) or lines.three_parallel(1)):
            return "no three neighbouring axes are parallel"
        almost = lines_of(chain, ALMOST)
        if any(almost.parallel(k) and not lines.parallel(k) for k in range(5)):
            return "two other axes are almost parallel"
        return None

    @property
    def doubts(self) -> bool:  # type: ignore[override]
        """Not where the geometry is common."""
        return self.kernel is solve_three_parallel

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
