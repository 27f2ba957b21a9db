"""Six values, of which one moves two turning joints or more: a hollow wrist, and any other."""

import numpy as np

from dh2urdf.chain import CoupledChain, SerialChain
from dh2urdf.engine import Step
from dh2urdf.ik.arm import IntArray, Others, Outputs, SolverBase, Task, search_in_doubt
from dh2urdf.ik.families.closed_form import STUCK
from dh2urdf.ik.families.follower_plan import (
    KERNELS,
    Arm,
    eliminations_of,
    leaders_of,
    plan_followers,
)
from dh2urdf.ik.families.own_record import OwnRecord
from dh2urdf.kernels.certificate import finish_batch
from dh2urdf.kernels.followers import MOTIONS
from dh2urdf.transforms import Array

STARTS, MORE_STARTS = 192, 3072
"""Starts of the search at poses in doubt, where there is one elimination only the second opinion;
and where an odd number of solutions was found."""


class Followers(OwnRecord, SolverBase):
    """Elimination of five free joints; the leader's turn from a polynomial."""

    name = "followers"
    needs = "six values that turn, one of which moves two joints or more"
    if_spare = STUCK

    def __init__(self, chain: SerialChain, task: Task = Task.POSE, others: Others = ()) -> None:
        super().__init__(chain, task, others)
        assert isinstance(chain, CoupledChain)
        self.arm = chain
        plan = plan_followers(chain)
        assert plan is not None
        self.kernels, self.plan, self.degree = plan
        self.kmax = 2 * self.kernels.degree
        self._idle: list[Arm] = []

    @classmethod
    def misfit(cls, chain: SerialChain, tolerance: float) -> str | None:
        """Say what keeps the elimination from covering the chain; None if nothing does."""
        if not isinstance(chain, CoupledChain):
            return "no joint follows another"
        if chain.n != 6:
            return f"{chain.n} values move it"
        if chain.prismatic.any() or chain.sliding.any():
            return "a joint slides"
        if len(led := leaders_of(chain)) != 1:
            names = " and ".join(chain.names[v] for v in led) or "none"
            return (
                f"of the values {names} move more than one joint each, and it needs one that does"
            )
        if len(chain.leaders) > MOTIONS:
            return f"it has {len(chain.leaders)} joints, more than {MOTIONS}"
        if not eliminations_of(chain):
            return "followers stand on both sides of every two neighbours among the free joints"
        if plan_followers(chain) is None:
            return f"its polynomial has a degree above {KERNELS[-1].degree}, or vanishes"
        return None

    def details(self) -> str:
        """Name the leader, what follows it, and the method."""
        leader = leaders_of(self.arm)[0]
        moved = [
            (i + 1, factor / self.arm.turns[leader])
            for i, (v, factor) in enumerate(zip(self.arm.leaders, self.arm.factors, strict=True))
            if v == leader
        ]
        axes, times = (
            " and ".join(f"{each:g}" for each in part) for part in zip(*moved, strict=True)
        )
        return (
            f"{self.arm.names[leader]} turns axes {axes}, by {times}; the five others are "
            "eliminated (Raghavan and Roth 1993), its turn is a root of a trigonometric polynomial "
            "of degree "
            f"{self.degree}; then Newton's method on the exact chain"
        )

    def solve_batch(self, Ts: Array, within_limits: bool, out: Outputs) -> None:
        """Solve poses Ts (m, 4, 4); those in doubt are searched, too."""
        doubt = self.solve_sure(Ts, within_limits, out)
        if not len(doubt):
            return
        found, poses = out.rows(doubt), Ts[doubt]
        found.counts[:] = -1 - found.counts
        wide = self._searched(poses, found, STARTS)
        listed = np.arange(wide.q.shape[1]) < wide.counts[:, None]
        odd = np.flatnonzero((wide.counts % 2 == 1) & ~(listed & (wide.free != 0)).any(axis=1))
        if len(odd):  # isolated solutions come in pairs
            wide.put(odd, self._searched(poses[odd], wide.rows(odd), MORE_STARTS))
        if within_limits:
            finish_batch(self.chain.tables, poses, True, wide)
        out.put(doubt, wide)

    def _searched(self, Ts: Array, found: Outputs, starts: int) -> Outputs:
        """What so many starts add to the candidates of poses Ts (m, 4, 4), limits or not."""
        every = np.arange(len(Ts))
        return search_in_doubt(self.chain, Ts, found, every, False, starts)

    def solve_sure(self, Ts: Array, within_limits: bool, out: Outputs) -> IntArray:
        """Solve poses Ts (m, 4, 4) but those in doubt, whose counts are -1 minus their candidates.

        Returned are their indices.
        """
        with self.record() as arm:
            doubts = self.kernels.finished(self.chain.tables, arm, Ts, within_limits, out)
        return np.flatnonzero(out.counts < 0) if doubts else np.empty(0, np.int64)

    def steps(self, Ts: Array, within_limits: bool, out: Outputs) -> tuple[Step, ...]:
        """The kernel alone, where it has no doubt."""
        arguments = self.chain.tables, self.plan.copy(), Ts, within_limits, out
        return ((self.kernels.finished, arguments, False),)
