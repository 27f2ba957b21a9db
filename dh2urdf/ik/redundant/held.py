"""A chain with joints held at a value: a solver that gives whole configurations back."""

from collections.abc import Mapping

import numpy as np

from dh2urdf.chain import SerialChain
from dh2urdf.exceptions import ConfigurationError
from dh2urdf.ik.arm import Outputs, Solver, Task, branch_words_of, hold, select_solver
from dh2urdf.transforms import Array


class HeldJoints:
    """Solver of a chain with joints held at values: that of the rest, columns put back."""

    def __init__(
        self, chain: SerialChain, held: Mapping[int, float], task: Task, inner: Solver | None = None
    ) -> None:
        if len(held) == chain.n:
            raise ConfigurationError(f"locked: all {chain.n} joints are held, none is left to move")
        self.chain, self.held = chain, dict(held)
        self.inner: Solver = inner or select_solver(hold(chain, held), task)
        self.moving = np.array([i for i in range(chain.n) if i not in held])
        self.kmax = self.inner.kmax
        self.branch_words = branch_words_of(self.inner)

    @property
    def name(self) -> str:
        """Name of the solver of the joints that move."""
        return self.inner.name

    def explain(self) -> str:
        """Name the held joints, then what the solver of the others says."""
        held = ", ".join(f"{self.chain.names[i]} at {v:g}" for i, v in self.held.items())
        return f"held: {held}\n{self.inner.explain()}"

    def solve_batch(self, Ts: Array, within_limits: bool, out: Outputs) -> None:
        """Solve for the moving joints and write the held values between them.

        The outputs may have other numbers of rows than this solver has solutions: at another
        held value another solver may cover the chain.
        """
        found = Outputs.of(len(Ts), self.kmax, len(self.moving))
        self.inner.solve_batch(Ts, within_limits, found)
        k = min(self.kmax, out.q.shape[1])
        out.counts[:] = np.minimum(found.counts, k)
        out.q[:, :k, self.moving], out.residual[:, :k] = found.q[:, :k], found.residual[:, :k]
        for i, value in self.held.items():
            out.q[:, :, i] = value
        out.branch[:, :k], out.free[:] = found.branch[:, :k], 0
        for bit, i in enumerate(self.moving):
            out.free[:, :k] |= (found.free[:, :k] >> bit & 1) << int(i)

    def __str__(self) -> str:
        return self.name
