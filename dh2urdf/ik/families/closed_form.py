"""Six joints whose axes give frames in which the equations come apart: closed forms.

Here the UR and its kin: three neighbouring parallel axes, 1, 2, 3 or 2, 3, 4.
"""

from functools import cached_property

import numpy as np

from dh2urdf.chain import SerialChain
from dh2urdf.ik.arm import (
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
    far,
    form_of,
    from_starts,
    lines_of,
    plain_ranges,
)
from dh2urdf.kernels.certificate import finish_batch, search_valleys
from dh2urdf.kernels.counts import DEEP
from dh2urdf.kernels.nearly import parallel_seeds
from dh2urdf.kernels.parallel_axes import solve_common_parallel, solve_three_parallel
from dh2urdf.transforms import Array

SEEDS, WIDTH = 32, 40
"""Most candidates of a pose in doubt, and most solutions that they lead to."""

WIDE = 0.1
"""Relative amount by which an equation may miss its rim where a seed is looked for."""

SHARP = 1e-11
"""Residual [m and rad] of what is added; one that was put onto a limit has more."""

SAME = 1e-6
"""Joint distance [rad or m] at which two solutions are one."""

UPSIDE_DOWN = (BRANCH_WORDS[0], BRANCH_WORDS[1][::-1], BRANCH_WORDS[2])
"""Names of the branches where axis 1 points down in the base, from where the kernels look up."""

NEAR = 0.01
"""Joint distance [rad] within which solutions may have been united; the certificate's own."""

STUCK = "the arm cannot move its tool in all six directions"


class ClosedForm(SolverBase):
    """A closed form, in Denavit-Hartenberg frames found from the axes.

    ``tolerance`` is what is snapped: with a larger one an arm that is nearly of the family gets
    the nominal arm's solutions as seeds, and Newton's method on the exact chain the answers.
    """

    kmax = 8
    if_spare = STUCK
    seeds: BatchKernel
    """The kernel that gives candidates as they are before certification."""

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
        """Look for more solutions of poses Ts[rows]: along valleys, or from many starts."""
        coded = -1 - out.counts[rows]
        out.counts[rows] = coded % DEEP
        poses = np.ascontiguousarray(Ts[rows])
        known, found = self.before_search(poses)
        deep = coded >= DEEP
        for i, row in enumerate(rows):
            mine = slice(i, i + 1)
            if deep[i]:
                wide = from_starts(self.chain, poses[mine], found.rows(mine), known.rows(mine))
                if within_limits:
                    finish_batch(self.chain.tables, poses[mine], True, wide)
                out.put(np.array([row]), wide)
            elif found.counts[i] > known.counts[i]:
                one = found.rows(mine)
                finish_batch(self.chain.tables, poses[mine], within_limits, one)
                self._add_new(one, known.q[i, : known.counts[i]], out.rows(slice(row, row + 1)))

    def before_search(self, Ts: Array) -> tuple[Outputs, Outputs]:
        """What the equations find; and, where it is in doubt, what lies along valleys, too."""
        known = Outputs.of(len(Ts), self.kmax, 6)  # those outside the limits, too
        self.kernel(self.constants, Ts, False, known)
        doubt = known.counts < 0
        known.counts[doubt] = (-1 - known.counts[doubt]) % DEEP
        return known, self._along_valleys(Ts, known) if doubt.any() else known

    def _along_valleys(self, poses: Array, known: Outputs) -> Outputs:
        """What lies along valleys beside candidates of poses (d, 4, 4), after what is known."""
        chain, k, d = self.chain, self.kmax, len(poses)
        raw, many = np.empty((d, SEEDS, 6)), np.empty(d, np.int64)
        self.seeds((*self.constants[:3], WIDE), poses, raw, many)
        found, seeds = Outputs.of(d, WIDTH, 6), np.empty((d, k + SEEDS, 6))
        found.q[:, :k], found.counts[:] = known.q, known.counts
        for i, count in enumerate(known.counts):
            seeds[i, :count], seeds[i, count : count + many[i]] = (
                known.q[i, :count],
                raw[i, : many[i]],
            )
        many += known.counts
        search_valleys(chain.tables, chain.size, poses, seeds, many, found.q, found.counts)
        return found

    def _add_new(self, found: Outputs, known: Array, out: Outputs) -> None:
        """Add solutions of one pose that are not known (k, 6) yet.

        One that is known, and was united with a sharper one, is replaced by that.
        """
        q = found.q[0, : found.counts[0]]
        for k, p in enumerate(q):
            count = out.counts[0]
            if found.residual[0, k] > SHARP or (far(self.chain, known, p) <= SAME).any():
                continue
            near = np.flatnonzero(far(self.chain, out.q[0, :count], p) <= NEAR)
            gone = [j for j in near if not (far(self.chain, q, out.q[0, j]) <= SAME).any()]
            if not gone and count == self.kmax:
                continue
            row = gone[0] if gone else count
            out.q[0, row], out.residual[0, row] = p, found.residual[0, k]
            out.free[0, row] = found.free[0, k]
            if not gone:
                out.branch[0, row] = -1
                out.counts[0] += 1


def not_six_revolute(chain: SerialChain) -> str | None:
    """Say that a chain is not one of six revolute joints; None if it is."""
    six = chain.n == 6 and not chain.prismatic.any()
    return None if six else "it needs 6 revolute joints"


class ThreeParallel(ClosedForm):
    """Closed form in the plane of the three axes."""

    name = "three parallel axes"
    needs = "six revolute joints, axes 1, 2, 3 or 2, 3, 4 parallel"

    seeds = staticmethod(parallel_seeds)

    @classmethod
    def misfit(cls, chain: SerialChain, tolerance: float) -> str | None:
        """Say what keeps the family from covering the chain; None if nothing does."""
        if unfit := not_six_revolute(chain):
            return unfit
        lines = lines_of(chain, tolerance)
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
