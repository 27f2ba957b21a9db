"""Arms that hardly move in some direction, as where a twist is a millionth: search what is lost.

The pose then says little of a combination of joints, and equations that are solved one after the
other lose what it says to rounding.
"""

from __future__ import annotations

import numpy as np

from dh2urdf.chain import SerialChain
from dh2urdf.ik.arm.outputs import Outputs
from dh2urdf.ik.arm.singular_families import task_jacobian
from dh2urdf.ik.arm.solver import Solver, Task
from dh2urdf.ik.arm.tolerances import NO_RANK, SLACK, WEAK_RANK
from dh2urdf.ik.problem.shortfall import nearly_reaching
from dh2urdf.ik.problem.solutions import branch_words_of
from dh2urdf.ik.redundant.redundancy import TRIALS, random_configurations
from dh2urdf.transforms import Array

__all__ = ["SearchedSolver", "hardly_moves"]

MOST_JOINTS = 6


def hardly_moves(chain: SerialChain, task: Task) -> bool:
    """Whether the tool moves little in one direction everywhere, but more than within rounding."""
    if task is not Task.POSE or not 1 < chain.n <= MOST_JOINTS:
        return False
    J = task_jacobian(chain, task, random_configurations(chain, TRIALS))
    J[:, :3] /= chain.size
    sigma = np.linalg.svd(J, compute_uv=False)
    least = (sigma / sigma[:, :1]).max(axis=0)
    return bool(((least > NO_RANK) & (least < WEAK_RANK)).any())


class SearchedSolver:
    """A solver whose lost poses are searched for from many starts."""

    def __init__(self, inner: Solver) -> None:
        self.inner, self.chain, self.kmax, self.name = inner, inner.chain, inner.kmax, inner.name
        self.branch_words = branch_words_of(inner)

    def explain(self) -> str:
        """Name the solver, and that it is helped."""
        return (
            f"{self.inner.explain()}\nsome joints hardly move the tool together; a pose that is "
            "not found is searched for from many starts"
        )

    def solve_batch(self, Ts: Array, within_limits: bool, out: Outputs) -> None:
        """Solve poses Ts (m, 4, 4) into the caller's arrays, and search for those without any."""
        from dh2urdf.kernels.certificate.finish import finish_batch

        self.inner.solve_batch(Ts, within_limits, out)
        for i in np.flatnonzero(out.counts == 0):
            q, error = nearly_reaching(self.chain, Ts[i], Task.POSE)
            q = q[np.abs(error).max(axis=1) <= SLACK]
            found = Outputs.of(1, max(len(q), self.kmax), self.chain.n)
            found.q[0, : len(q)], found.counts[0] = q, len(q)
            finish_batch(*self.chain.tables, Ts[i : i + 1], within_limits, *found)
            np.minimum(found.counts, self.kmax, out=found.counts)
            for whole, part in zip(out, found, strict=True):
                whole[i] = part[0, : self.kmax] if part.ndim > 1 else part[0]

    def __str__(self) -> str:
        return self.name
