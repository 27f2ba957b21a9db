"""Seven joints and nothing held: one joint is swept through its range, the others solved for."""

from contextlib import suppress
from functools import cached_property, lru_cache

import numpy as np

from dh2urdf.chain import SerialChain
from dh2urdf.engine import Step
from dh2urdf.exceptions import NoSolverError
from dh2urdf.ik.arm import (
    HeldSolver,
    Others,
    Outputs,
    SolverBase,
    Task,
    near_ranges,
    scaled_jacobian,
)
from dh2urdf.ik.redundant.held_values import select_held
from dh2urdf.ik.redundant.held_wrist import HeldWrist
from dh2urdf.ik.redundant.self_motion import few_members, sample_values
from dh2urdf.kernels.redundant import gather_samples, repeat_pose
from dh2urdf.transforms import Array

SAMPLES = 16
"""Values of the swept joint, when the caller gives no other number."""

TRIALS = 64
"""Random configurations over which the motion of the joints is averaged."""

CLASSES = 10
"""Classes of mean motion; of joints in one class the first is taken."""

BLOCK = 16384
"""Most poses times samples that are worked on at once: a few MB."""


class SweptJoint(SolverBase):
    """All solutions at a row of values of the joint that is best held.

    Every solution of such an arm can move while the tool stays; joints that are free beyond that
    are the ones that a solution names.
    """

    name = "swept joint"
    if_spare = ""
    needs = "seven joints, one of which can be held so that a row above covers the others"

    def __init__(self, chain: SerialChain, task: Task = Task.POSE, others: Others = ()) -> None:
        super().__init__(chain, task, others)
        self.held, self.reason = _best_held(chain)
        self.joint, self.samples = self.held.held[0], SAMPLES
        self.kmax = SAMPLES * self.held.kmax
        self.name = f"{self.held.name}, {chain.names[self.joint]} swept"

    @classmethod
    def misfit(cls, chain: SerialChain, tolerance: float) -> str | None:
        """Say what keeps a sweep from covering the chain; None if nothing does."""
        if chain.n != 7:
            return f"it needs 7 joints, the chain has {chain.n}"
        try:
            _best_held(chain)
        except NoSolverError as error:
            return str(error)
        return None

    @cached_property
    def sweeps(self) -> tuple[HeldSolver, ...]:
        """The solvers with the swept joint held, and with the next best one."""
        motion = _self_motion(self.chain)
        for i in sorted(range(self.chain.n), key=lambda i: -motion[i]):
            other = HeldWrist.of(self.chain, i) if i != self.joint else None
            if other is not None:
                return self.held, other
        return (self.held,)

    def like(self, samples: int) -> "SweptJoint":
        """The same solver with another number of samples."""
        other: SweptJoint = object.__new__(type(self))
        other.__dict__.update(self.__dict__)
        other.samples, other.kmax = samples, samples * self.held.kmax
        return other

    def details(self) -> str:
        """Name the swept joint, why it was chosen, and how the others are solved for."""
        name = self.chain.names[self.joint]
        return f"{name} at {self.samples} values ({self.reason}); {self.held.explain()}"

    def solve_batch(self, Ts: Array, within_limits: bool, out: Outputs) -> None:
        """Solve poses Ts (m, 4, 4) at every value of the swept joint.

        Where none of them reaches a pose, curves between the values are looked for.
        """
        values = sample_values(self.chain, self.joint, self.samples, within_limits)
        self.solve_at(values, Ts, within_limits, out)
        missed = np.flatnonzero(out.counts == 0)
        for i in missed:
            q, residual = few_members(self, Ts[i], within_limits, self.kmax)
            k = out.counts[i] = len(q)
            out.q[i, :k], out.residual[i, :k] = q, residual
            out.branch[i, :k], out.free[i, :k] = -1, 0

    def steps(self, Ts: Array, within_limits: bool, out: Outputs) -> tuple[Step, ...]:
        """The same in kernels, of one pose that a value reaches."""
        poses, some = np.empty((self.samples, 4, 4)), Outputs.of(self.samples, self.held.kmax, 7)
        values = sample_values(self.chain, self.joint, self.samples, within_limits)
        held = self.held.steps(poses, values, within_limits, some)
        copy, join = (repeat_pose, (Ts, poses), False), (some, 0, 1, self.samples, out)
        return (copy, *held, (gather_samples, join, True)) if held else ()

    def solve_at(self, values: Array, Ts: Array, within_limits: bool, out: Outputs) -> None:
        """Solve poses at given values (s,) of the swept joint, s kmax of the held rows a pose."""
        samples = len(values)
        step = max(1, min(len(Ts), BLOCK // samples))
        found = Outputs.of(step * samples, self.held.kmax, self.chain.n)
        for first in range(0, len(Ts), step):
            last = min(first + step, len(Ts))
            some = found.rows(slice((last - first) * samples))
            poses = np.repeat(Ts[first:last], samples, axis=0)
            self.held.solve_held(poses, np.tile(values, last - first)[:, None], within_limits, some)
            gather_samples(some, first, last, samples, out)


@lru_cache(maxsize=4)
def _self_motion(chain: SerialChain) -> Array:
    """Mean size of each joint's part in the unit self-motion over random configurations, (n,)."""
    rng = np.random.default_rng(3)
    J = scaled_jacobian(chain, Task.POSE, rng.uniform(*near_ranges(chain), (TRIALS, chain.n)))
    motion: Array = np.abs(np.linalg.svd(J)[2][:, -1]).mean(axis=0)
    return motion


@lru_cache(maxsize=4)
def _best_held(chain: SerialChain) -> tuple[HeldSolver, str]:
    """The solver with the joint held that is best held, and why it was chosen.

    Raises
    ------
    NoSolverError
    """
    motion = _self_motion(chain)
    order = sorted(range(chain.n), key=lambda i: (-round(CLASSES * motion[i] / motion.max()), i))
    wrists: list[HeldWrist] = []
    for i in order:
        solver = HeldWrist.of(chain, i)
        if solver is not None:
            wrists.append(solver)
            if solver.one_by_one:
                break
    if wrists:
        best = wrists[-1] if wrists[-1].one_by_one else wrists[0]
        return best, "it leaves a closed form, and of such joints moves most with a fixed tool"
    for i in (0, chain.n - 1, *order):
        with suppress(NoSolverError):
            return select_held(chain, (i,), Task.POSE), "the other joints have a solver"
    raise NoSolverError("no joint can be held so that a solver covers the others")
