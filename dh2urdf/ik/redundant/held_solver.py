"""What a solver with held joints is: the held values are an argument, not a part of it."""

import numpy as np

from dh2urdf.chain import SerialChain, settled_state
from dh2urdf.ik.arm import Outputs
from dh2urdf.transforms import Array


class HeldSolver:
    """All solutions of many poses of a chain, each pose with its own values of the held joints."""

    name: str
    kmax: int
    __getstate__ = settled_state

    def __init__(self, chain: SerialChain, held: tuple[int, ...]) -> None:
        self.chain, self.held = chain, held

    def details(self) -> str:
        """Say how the joints that move are solved for."""
        raise NotImplementedError

    def solve_held(self, Ts: Array, values: Array, within_limits: bool, out: Outputs) -> None:
        """Solve poses Ts (m, 4, 4), each with its held values (m, h) [rad] or [m].

        Outputs as in :class:`dh2urdf.ik.arm.solver.Solver`, with all joints of the chain.
        """
        raise NotImplementedError

    def points_on_curves(self, T: Array, values: Array) -> Array:
        """Solutions of a pose (4, 4) at or near values (m,) of the one held joint, (k, n).

        Limits do not count here.
        """
        m, n = len(values), self.chain.n
        out, Ts = Outputs.of(m, self.kmax, n), np.repeat(T[None], m, axis=0)
        self.solve_held(Ts, np.ascontiguousarray(values[:, None]), False, out)
        points: Array = out.q[np.arange(self.kmax) < out.counts[:, None]]
        return points

    def explain(self) -> str:
        """Name the held joints and say how the others are solved for."""
        names = ", ".join(self.chain.names[i] for i in self.held)
        return f"held, at any value: {names}\n{self.details()}"

    def __str__(self) -> str:
        return self.name
