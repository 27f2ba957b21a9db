"""Joints to spare: arms with more joints than the task has dimensions, or idle ones.

Where a joint can move in every configuration while the task stays satisfied, there is a
one-parameter family through every solution. Joints are then held so that the rest determine the
task, at rest or at the first of a row of values at which the pose is reached; at rest only, where
the joints that are held are the only ones to move along the family. Where the pose is reached at
none of the values, as on the rim of the workspace, a numeric search looks for one member. A pose
may have several curves of solutions, and the values meet some of them: with one joint to spare the
others are looked for from many starts, with more the answer holds a part. A seed finds its own.
"""

import itertools
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from dh2urdf.chain import CoupledChain, SerialChain
from dh2urdf.exceptions import NoSolverError
from dh2urdf.ik.arm import (
    NOMINAL,
    TRIALS,
    IntArray,
    Others,
    Outputs,
    SolverBase,
    Task,
    beside_seed,
    coupled,
    hold,
    middle,
    moving_joints,
    near_ranges,
    random_configurations,
    scaled_jacobian,
    select_solver,
    spare_joints,
    turned_to,
    unite_families,
)
from dh2urdf.ik.families import NumericProblem
from dh2urdf.ik.redundant.held_values import HeldOneByOne
from dh2urdf.ik.redundant.searched import nearly_reaching
from dh2urdf.kernels.certificate import measure_all, name_batch
from dh2urdf.kernels.redundant import DULL, add_curves
from dh2urdf.transforms import Array

STARTS = 8
"""Starts of the numeric search; a member of a family is soon found, if there is one."""

ENOUGH = 4
"""Values after which poses are looked at that no configuration reaches, whatever is held."""

FAR = 0.01
"""Error, in sizes of the arm and radians, of such poses; what is reached, a rim too, is found to
rounding by one of the searches."""

OFF = 1e-4
"""The same after damped least squares from many starts, which come close to rims, too."""

HARDLY, PATIENCE = 1e-5, 8
"""Error, in sizes of the arm and radians, to which starts come without a solution, as of an arm
that is folded and hardly moves, and then how many times as many steps they may take."""

SURE = 1e-11
"""Residual [m and rad] of a solution beside which a walk decides whether there is a family."""

SAME = 1e-6
"""Joint distance [rad or m] at which two solutions are one."""

WEAK = 1e-3
"""Singular value, relative to the largest, of an arm that can hardly move along its curve."""

CURVES = 48
"""Starts from which curves are looked for that no held value meets."""

MOST = 16
"""Solutions of a pose with the joints held; another solver may cover the chain at each value."""

VALUES = (1, 24, 7, 4)
"""Values at which each of 0 to 3 joints is held: a turn in steps of 15 degrees, of 51 for two, of a
right angle for three."""

HELD_FOR_POSE, HELD_OTHERWISE = 3, 2
"""Most joints that are held for a full pose, as of an arm folded onto itself, and for less."""


Values = list[tuple[float, ...]]


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
        self.partial = len(self.held) > 1 and not self.alone

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
            return f"{spare} joints to spare; hold some (locked=, or --locked)"
        if isinstance(chain, CoupledChain):
            try:
                select_solver(hold(chain, dict.fromkeys(_joints_to_hold(chain, task), 0.1)), task)
            except NoSolverError:
                return "no solver finds all solutions of what is left where joints are held"
        return None

    def details(self) -> str:
        """Name the held joints and the solver of the others."""
        names = ", ".join(self.chain.names[i] for i in self.held)
        if self.alone:
            whole = "a member of each family"
        elif self.partial:
            whole = "members of a part of the solutions"
        else:
            whole = f"a member of each curve of solutions, those without one from {CURVES} starts"
        return (
            f"{names} held at rest or where the pose is reached: {whole}; a seed finds its own; "
            f"{self.one_by_one}"
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
        chain, bounds = self.chain, (self.chain.lower, self.chain.upper)
        joints = chain.serial if isinstance(chain, CoupledChain) else chain
        _, matrix, offset, _ = coupled(chain, within_limits=True)
        return NumericProblem(joints, matrix, offset, chain.prismatic, *bounds)

    def _far_from(self, T: Array) -> bool:
        """Whether no configuration comes near a pose (4, 4), limits aside."""
        _, error = nearly_reaching(self.chain, T, self.task)
        error[:, :3] /= self.chain.size
        return bool(np.abs(error).max(axis=1).min() > OFF)

    @cached_property
    def _starts(self) -> Array:
        """Configurations (``CURVES``, n) from which curves are looked for."""
        return random_configurations(self.chain, CURVES)

    def _add_curves(self, Ts: Array, out: Outputs, patience: int = 1) -> Array:
        """Add members of curves that no held value has met; how near starts come to poses, (m,)."""
        chain, number, before = self.chain, self.task.number, out.counts.copy()
        least, residual = np.empty(len(Ts)), np.empty_like(out.residual)
        how = number, chain.size, patience
        add_curves(chain.tables, *how, Ts, self._starts, out.q, out.counts, least)
        measure_all(chain.tables, number, Ts, out.q, out.counts, residual)
        for i in np.flatnonzero(out.counts > before):
            new = slice(before[i], out.counts[i])
            out.q[i, new] = turned_to(chain, out.q[i, new], middle(chain))
            out.residual[i, new] = residual[i, new]
        dull = (np.arange(self.kmax) < before[:, None]) & (out.residual > DULL)
        out.residual[dull] = residual[dull]
        return least

    def _hold_at(
        self, values: Values, Ts: Array, within_limits: bool, out: Outputs, rows: IntArray
    ) -> None:
        """Solve poses Ts[rows], held value by held value, until they have a solution."""
        for held in values:
            rows = rows[out.counts[rows] == 0]
            if not len(rows):
                return
            found = out.rows(rows)
            self.one_by_one.at(held).solve_batch(Ts[rows], within_limits, found)
            out.q[rows], out.residual[rows], out.counts[rows] = found[:3]

    def solve_batch(self, Ts: Array, within_limits: bool, out: Outputs) -> None:
        """Solve poses Ts (m, 4, 4) into the caller's arrays, held value by held value."""
        out.counts[:] = 0
        self._hold_at(self.values[:ENOUGH], Ts, within_limits, out, np.arange(len(Ts)))
        least = np.full(len(Ts), np.inf)
        if self.alone:
            hopeless = np.ones(len(Ts), np.bool_)
        elif len(self.held) == 1:
            least = self._add_curves(Ts, out)
            hopeless = least > FAR
        else:
            none = [k == 0 and self._far_from(T) for k, T in zip(out.counts, Ts, strict=True)]
            hopeless = np.array(none, np.bool_)
        self._hold_at(self.values[ENOUGH:], Ts, within_limits, out, np.flatnonzero(~hopeless))
        for i in () if self.alone else np.flatnonzero(out.counts == 0):
            some = self._numeric.solve(
                Ts[i], within_limits=within_limits, task=self.task, starts=STARTS
            )
            k = out.counts[i] = len(some)
            out.q[i, :k], out.residual[i, :k] = some.q, some.residual
        if len(rows := np.flatnonzero((out.counts == 0) & (least <= HARDLY))):
            found = out.rows(rows)
            self._add_curves(np.ascontiguousarray(Ts[rows]), found, PATIENCE)
            out.put(rows, found)
        used = np.arange(self.kmax) < out.counts[:, None]
        out.free[:] = 0
        out.free[used] = self.idle | moving_joints(self.chain, self.task, out.q[used])
        if self.task is Task.POSE:
            self._name_again(Ts, out, used)
        out.branch[:] = -1
        for i in np.flatnonzero(out.counts > 1):
            self._drop_twice(out.rows(slice(i, i + 1)))

    def _drop_twice(self, out: Outputs) -> None:
        """Keep the first of solutions of one pose that full turns tell apart, in place."""
        kept: list[int] = []
        for k, q in enumerate(out.q[0, : out.counts[0]]):
            others = turned_to(self.chain, out.q[0, kept], q)
            if not (np.abs(others - q).max(axis=1) <= SAME).any():
                kept.append(k)
        out.counts[0] = len(kept)
        for array in (out.q, out.residual, out.branch, out.free):
            array[0, : len(kept)] = array[0, kept]

    def _name_again(self, Ts: Array, out: Outputs, used: NDArray[np.bool_]) -> None:
        """Walk where the arm can hardly move: short curves may be points, of which none is free."""
        sigma = np.linalg.svd(scaled_jacobian(self.chain, Task.POSE, out.q[used]), compute_uv=False)
        weak = np.zeros_like(used)
        weak[used] = sigma[:, self.chain.n - len(self.held) - 1] <= WEAK * sigma[:, 0]
        rows = np.flatnonzero(weak.any(axis=1))
        some, Ts = out.rows(rows), np.ascontiguousarray(Ts[rows])
        some.branch[:] = some.free
        name_batch(self.chain.tables, Ts, some)
        unite_families(self.chain, Ts, False, some)
        still = (some.free == 0) & (some.residual <= SURE)
        some.free[:] = np.where(still, 0, some.branch)
        out.put(rows, some)


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
