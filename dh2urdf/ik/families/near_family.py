"""Six revolute joints that are nearly of a closed-form family: the drawing as seed."""

import math
from functools import lru_cache

import numpy as np

from dh2urdf.chain import SerialChain
from dh2urdf.engine import Step
from dh2urdf.ik.arm import (
    NEAR,
    NEARLY_SINGULAR,
    NOISE_MOTION,
    SLACK,
    SLACK_OF_NEAR,
    AxisLines,
    IntArray,
    Others,
    Outputs,
    SolverBase,
    Task,
    lines_of,
    room_in_doubt,
    spare_joints,
    starts_of,
)
from dh2urdf.ik.families.closed_form import STUCK, ThreeParallel, not_six_revolute
from dh2urdf.ik.families.general_6r import Arm, General6R
from dh2urdf.ik.families.spherical_wrist import SphericalWrist
from dh2urdf.kernels.certificate import finish_batch
from dh2urdf.kernels.general_6r import finish_general_6r
from dh2urdf.kernels.in_doubt import referee_doubtful
from dh2urdf.kernels.nearly import (
    put_doubtful,
    reverse_all,
    settle_counts,
    skip_sure,
    solve_near_parallel,
    solve_near_wrist,
)
from dh2urdf.kernels.rigid import invert_poses
from dh2urdf.transforms import Array

_Family = type[SphericalWrist | ThreeParallel]

CALIBRATED = 1e-3
"""Distance [rad, sizes] from the nominal arm from which its solutions are hardly ever trusted. With
three parallel axes the general solver then comes first; with a wrist it would miss solutions of
one pose in a thousand at which singularities nearly meet."""


class Refereed(SolverBase):
    """Six revolute joints, and the general solver for poses that are left in doubt."""

    kmax = 16
    if_spare = STUCK

    def __init__(self, chain: SerialChain, task: Task = Task.POSE, others: Others = ()) -> None:
        super().__init__(chain, task, others)
        self.general = General6R(chain)

    def look_wider(self, Ts: Array, rows: IntArray, within_limits: bool, out: Outputs) -> None:
        """Solve poses Ts[rows], in doubt, by the general solver and a search, too."""
        with self.general.record() as arm:
            kernel, arguments, _ = self.referee(arm, Ts, within_limits, out)
            kernel(*arguments)

    def referee(self, arm: Arm, Ts: Array, within_limits: bool, out: Outputs) -> Step:
        """The kernel that solves poses in doubt, and its arguments."""
        chain, given = self.chain, (arm, room_in_doubt(), Ts, within_limits, out)
        return referee_doubtful, (chain.tables, starts_of(chain), chain.size, *given), False


class NearFamily(Refereed):
    """The nominal arm's solutions as seeds, Newton on the exact chain, general solver in doubt."""

    name = "nearly a family"
    needs = "six revolute joints, rounded or calibrated: nearly one of the first four rows"

    def __init__(self, chain: SerialChain, task: Task = Task.POSE, others: Others = ()) -> None:
        super().__init__(chain, task, others)
        match = _match(chain)
        assert match is not None
        family, self.reversed, tolerance = match
        seen = chain.reversed() if self.reversed else chain
        self.nominal = family(seen, tolerance=tolerance)
        self.name = f"nearly {self.nominal.name}{', from the tool' if self.reversed else ''}"
        self.distance = float(f"{self.nominal.form.error:.3g}")
        noise = math.sqrt(max(self.distance / min(1.0, chain.size), 1e-16))
        self.slack = min(max(SLACK, SLACK_OF_NEAR * self.distance, noise), 0.3)
        far = self.distance > CALIBRATED * min(1.0, chain.size)
        self.far = far and family is ThreeParallel and not self.reversed
        self.trust = np.array([chain.size, NOISE_MOTION * noise, NEARLY_SINGULAR * noise])

    @classmethod
    def misfit(cls, chain: SerialChain, tolerance: float) -> str | None:
        """Say what keeps a nominal arm from the chain; None if nothing does."""
        if unfit := not_six_revolute(chain):
            return unfit
        if spare_joints(chain, Task.POSE):
            return STUCK
        if _match(chain) is None:
            return f"no three axes nearly meet or are nearly parallel (within {NEAR[-1]:g})"
        return None

    def details(self) -> str:
        """Name the family, the distance from it, and what is done about it."""
        seen = "seen from the tool, " if self.reversed else ""
        return (
            f"{seen}poses of the arm are up to {self.distance:.1g} (m, rad) away from those of a "
            f"nominal one, whose solutions are seeds of Newton's method on the exact chain "
            f"({self.nominal.explain()}); {'first' if self.far else 'near singularities'}, where "
            f"noise takes and gives branches, {self.general.explain()}"
        )

    def solve_batch(self, Ts: Array, within_limits: bool, out: Outputs) -> None:
        """Solve poses Ts (m, 4, 4) by the nominal arm, and where in doubt by the general solver.

        Or, far from the nominal arm, by the general solver first, and where in doubt by both.
        """
        if not self.far:
            self._solve_both(Ts, within_limits, out)
        elif len(rows := self.general.solve_sure(Ts, within_limits, out)):
            some = Outputs.of(len(rows), self.kmax, 6)
            self._solve_both(Ts[rows], within_limits, some)
            out.put(rows, some)

    def _solve_both(self, Ts: Array, within_limits: bool, out: Outputs) -> None:
        """Solve poses Ts (m, 4, 4) by the nominal arm, those in doubt by the general solver."""
        for kernel, arguments, _ in self._by_nominal(Ts, out):
            kernel(*arguments)
        finish_batch(self.chain.tables, Ts, within_limits, out)
        if len(rows := np.flatnonzero(out.counts < 0)):
            self.look_wider(Ts, rows, within_limits, out)

    def steps(self, Ts: Array, within_limits: bool, out: Outputs) -> tuple[Step, ...]:
        """Of a pose that is not in doubt: the general solver, or the nominal arm's as seeds."""
        if self.far:
            return self.general.steps(Ts, within_limits, out)
        settle: Step = settle_counts, (out.counts,), False
        finish: Step = finish_batch, (self.chain.tables, Ts, within_limits, out), False
        return *self._by_nominal(Ts, out), settle, finish

    def all_steps(self, Ts: Array, within_limits: bool, out: Outputs) -> tuple[Step, ...]:
        """Those of any pose: what the nominal arm gives is certified, or its candidates are."""
        arm, tables = self.general.plan.copy(), self.chain.tables
        some = Outputs.of(len(Ts), self.kmax, 6) if self.far else out
        nominal = self._by_nominal(Ts, some)
        finish: Step = finish_batch, (tables, Ts, within_limits, some), False
        rest = finish, self.referee(arm, Ts, within_limits, some)
        if not self.far:
            return *nominal, *rest
        first: Step = finish_general_6r, (tables, arm, Ts, within_limits, out), False
        skip: Step = skip_sure, (out.counts, some.counts), False
        put: Step = put_doubtful, (some, out), False
        return first, *nominal, skip, *rest, put

    def _by_nominal(self, Ts: Array, out: Outputs) -> tuple[Step, ...]:
        """The kernels that make candidates of what the nominal arm does."""
        form, poses = self.nominal.form, np.empty_like(Ts)
        wrist = isinstance(self.nominal, SphericalWrist)
        solve = solve_near_wrist if wrist else solve_near_parallel
        arm = self.nominal.chain.tables, form.rows, form.ends, self.slack
        seen = poses if self.reversed else Ts
        first: Step = solve, (arm, self.trust, seen, out), False
        turned: Step = reverse_all, (out.q,), False
        return ((invert_poses, (Ts, poses), False), first, turned) if self.reversed else (first,)


@lru_cache(maxsize=4)
def _match(chain: SerialChain) -> tuple[_Family, bool, float] | None:
    """The nearest family, whether seen from the tool, and within which tolerance its axes snap."""
    if not _candidates(lines_of(chain, NEAR[-1])):
        return None
    for tolerance in NEAR:
        for family, reversed_ in _candidates(lines_of(chain, tolerance)):
            seen = chain.reversed() if reversed_ else chain
            if family.obstacle(seen, tolerance=tolerance) is None:
                return family, reversed_, tolerance
    return None


def _candidates(lines: AxisLines) -> list[tuple[_Family, bool]]:
    """Families whose axes the snapped lines have, and whether seen from the tool."""
    rows: tuple[tuple[_Family, bool, bool], ...] = (
        (SphericalWrist, False, lines.spherical(3)),
        (ThreeParallel, False, lines.three_parallel(0) or lines.three_parallel(1)),
        (SphericalWrist, True, lines.spherical(0)),
        (ThreeParallel, True, lines.three_parallel(2) or lines.three_parallel(3)),
    )
    return [(family, reversed_) for family, reversed_, has in rows if has]
