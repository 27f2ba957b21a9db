"""Joints to spare: arms with more joints than the task has dimensions, or idle ones.

Where a joint can move in every configuration while the task stays satisfied, there is a
one-parameter family through every solution. Joints are then held so that the rest determine the
task, at rest or at the first of a row of values at which the pose is reached; at rest only, where
the joints that are held are the only ones to move along the family. Where the pose is reached at
none of the values, as on the rim of the workspace, a numeric search looks for one member. A pose
may have several curves of solutions, and the values meet some of them; a seed finds its own.
"""

import itertools
from functools import cached_property

import numpy as np

from dh2urdf.chain import SerialChain
from dh2urdf.ik.arm import (
    NOMINAL,
    TRIALS,
    IntArray,
    Others,
    Outputs,
    SolverBase,
    Task,
    beside_seed,
    hold,
    moving_joints,
    near_ranges,
    random_configurations,
    scaled_jacobian,
    spare_joints,
)
from dh2urdf.ik.families import NumericProblem
from dh2urdf.ik.redundant.held_values import HeldOneByOne
from dh2urdf.ik.redundant.searched import nearly_reaching
from dh2urdf.transforms import Array

STARTS = 8
"""Starts of the numeric search; a member of a family is soon found, if there is one."""

ENOUGH = 4
"""Values after which poses are looked at that no configuration reaches, whatever is held."""

FAR = 0.01
"""Error, in sizes of the arm and radians, of such poses; what is reached, a rim too, is found to
rounding by one of the searches."""

MOST = 16
"""Solutions of a pose with the joints held; another solver may cover the chain at each value."""

VALUES = (1, 24, 7, 4)
"""Values at which each of 0 to 3 joints is held: a turn in steps of 15 degrees, of 51 for two, of a
right angle for three."""

HELD_FOR_POSE, HELD_OTHERWISE = 3, 2
"""Most joints that are held for a full pose, as of an arm folded onto itself, and for less."""


class RedundantChain(SolverBase):
    """A chain with joints to spare: some are held, a family through every solution."""

    name = "joints to spare"
    needs = "one to three joints that can move while the task stays satisfied; they are held"

    idle: int
    """Bits of the joints that take part in the motion to spare."""

    def __init__(self, chain: SerialChain, task: Task = Task.POSE, others: Others = ()) -> None:
        super().__init__(chain, task, others)
        self.held = _joints_to_hold(chain, task)
        anywhere = moving_joints(chain, task, random_configurations(chain, TRIALS))
        self.idle = int(np.bitwise_or.reduce(anywhere))
        self.alone = self.idle == sum(1 << i for i in self.held)
        rows = [_values(chain, i, len(self.held))[: 1 if self.alone else None] for i in self.held]
        self.values = list(itertools.product(*rows))
        self.one_by_one = HeldOneByOne(chain, self.held, task, self.values[0])
        self.kmax = max(self.one_by_one.kmax, MOST)

    @classmethod
    def obstacle(
        cls, chain: SerialChain, task: Task = Task.POSE, tolerance: float = NOMINAL
    ) -> str | None:
        """Say why no joint is held; None if one has to be."""
        spare = spare_joints(chain, task)
        if not spare:
            return "no joint can move while the tool stays"
        if spare == chain.n:
            return f"no joint moves what task {task.value} asks for"
        if spare > (HELD_FOR_POSE if task is Task.POSE else HELD_OTHERWISE):
            return f"{spare} joints to spare; hold some with locked="
        return None

    def details(self) -> str:
        """Name the held joints and the solver of the others."""
        names = ", ".join(self.chain.names[i] for i in self.held)
        return (
            f"{names} held at rest or where the pose is reached, for a member of each curve of "
            f"solutions that these values meet; a seed finds its own; {self.one_by_one}"
        )

    def beside_seed(self, T: Array, seed: Array, within_limits: bool) -> tuple[Array, IntArray]:
        """The solution that a seed (n,) leads to, (1, n) or (0, n), and its free joints.

        A pose may have several curves of solutions, and held values a member of some.
        """
        q = beside_seed(self.chain, self.task, T, seed, within_limits)
        return q, self.idle | moving_joints(self.chain, self.task, q)

    @cached_property
    def _numeric(self) -> NumericProblem:
        """The chain for a numeric search."""
        chain, n = self.chain, self.chain.n
        bounds = chain.lower, chain.upper
        return NumericProblem(chain, np.eye(n), np.zeros(n), chain.prismatic, *bounds)

    def _far_from(self, T: Array) -> bool:
        """Whether no configuration comes near a pose (4, 4), limits aside."""
        _, error = nearly_reaching(self.chain, T, self.task)
        error[:, :3] /= self.chain.size
        return bool(np.abs(error).max(axis=1).min() > FAR)

    def solve_batch(self, Ts: Array, within_limits: bool, out: Outputs) -> None:
        """Solve poses Ts (m, 4, 4) into the caller's arrays, held value by held value."""
        out.counts[:] = 0
        hopeless = np.zeros(len(Ts), np.bool_)
        for k, values in enumerate(self.values):
            open_ = np.flatnonzero((out.counts == 0) & ~hopeless)
            if k == ENOUGH:
                hopeless[open_] = [self._far_from(T) for T in Ts[open_]]
                open_ = open_[~hopeless[open_]]
            if not len(open_):
                break
            found = out.rows(open_)
            self.one_by_one.at(values).solve_batch(Ts[open_], within_limits, found)
            out.q[open_], out.residual[open_], out.counts[open_] = found[:3]
        for i in () if self.alone else np.flatnonzero(out.counts == 0):
            some = self._numeric.solve(
                Ts[i], within_limits=within_limits, task=self.task, starts=STARTS
            )
            k = out.counts[i] = len(some)
            out.q[i, :k], out.residual[i, :k] = some.q, some.residual
        used = np.arange(self.kmax) < out.counts[:, None]
        out.free[:] = 0
        out.free[used] = self.idle | moving_joints(self.chain, self.task, out.q[used])
        out.branch[:] = -1


def _joints_to_hold(chain: SerialChain, task: Task) -> tuple[int, ...]:
    """The last joints without which the others determine the task, or nearly, as best they can."""
    spare = spare_joints(chain, task)
    choices = sorted(itertools.combinations(range(chain.n), spare), reverse=True)
    for joints in choices:
        if not spare_joints(hold(chain, dict.fromkeys(joints, 0.1)), task):
            return joints
    J = scaled_jacobian(chain, task, random_configurations(chain, 1))[0]
    return max(choices, key=lambda c: float(np.linalg.norm(np.delete(J, c, axis=1), -2)))


def _values(chain: SerialChain, joint: int, held: int) -> list[float]:
    """Values at which a joint is held: rest, then spread over its range."""
    low, high = (float(end[joint]) for end in near_ranges(chain))
    rest = min(max(0.0, low), high)
    count = VALUES[held]
    grid = low + (high - low) * (np.arange(count) + 0.5) / count
    return [rest, *sorted(grid.tolist(), key=lambda v: abs(v - rest))]
