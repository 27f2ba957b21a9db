"""Values that move more joints than there are, where that is a chain of joints that move freely.

Turns about parallel axes are turns in a plane: neighbours with parallel axes do together a sum of
ways, each turned by a sum of values, and a turn by another such sum. Ways that are turned by the
same sum are one, those by none are fixed, and the order does not matter. So a palletiser's four
parallel axes, two of which follow so that its tool stays level, are a planar arm of two links.

What is left is solved as if all its joints moved freely, by the family that covers it, and of the
solutions those stand whose joints are where some values put them.
"""

import itertools
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dh2urdf.chain import CoupledChain, SerialChain
from dh2urdf.dh import JointType
from dh2urdf.exceptions import NoSolverError
from dh2urdf.ik.arm import (
    NOMINAL,
    TWO_PI,
    IntArray,
    Others,
    Outputs,
    Solver,
    SolverBase,
    Task,
    search_in_doubt,
    select_solver,
    spare_joints,
)
from dh2urdf.ik.families.short import search_short
from dh2urdf.kernels.certificate import finish_batch
from dh2urdf.transforms import Array, dot, inverse, length, product, trans

MOST_JOINTS = 6
"""Joints of the longest chain that all solutions are found of when it moves freely."""

TOGETHER = 1e-3
"""Angle [rad], or length in sizes of the arm, by which a joint may be off where its values put it:
Newton's method brings it there, or the pose is not reached."""

WHOLE = 1e-9
"""Rounding of a whole number."""


FLAT = np.array([1.0, 1.0, 0.0])
"""What of a way counts in the plane."""


class Straight(NamedTuple):
    """A chain of joints that move freely, at ``matrix @ q`` of another chain's values q."""

    chain: SerialChain
    matrix: Array


class Straightened(SolverBase):
    """All configurations by a chain that moves freely."""

    name = "straightened chain"
    needs = "joints that follow others, and no more than six without those that parallel axes spare"

    def __init__(self, chain: SerialChain, task: Task = Task.POSE, others: Others = ()) -> None:
        super().__init__(chain, task, others)
        assert isinstance(chain, CoupledChain)
        self.straight = straighten(chain)
        self.inner = solver_of(chain, task)
        matrix, slides = self.straight.matrix, self.straight.chain.prismatic
        self.rows, self.back = _rows_that_tell(matrix)
        self.shifts = _shifts(self.back, slides[self.rows])
        self.kmax = self.inner.kmax * len(self.shifts)

    @classmethod
    def obstacle(
        cls, chain: SerialChain, task: Task = Task.POSE, tolerance: float = NOMINAL
    ) -> str | None:
        """Say what keeps the family from covering the chain for the task; None: it covers it."""
        if not isinstance(chain, CoupledChain):
            return "no joint follows another"
        if spare_joints(chain, task):
            return cls.if_spare
        straight = straighten(chain)
        if straight.chain.n > MOST_JOINTS:
            return f"{straight.chain.n} joints are left that have to move together"
        if spare_joints(straight.chain, task):
            return "its joints, each by itself, move on while the tool stays"
        try:
            solver_of(chain, task)
        except NoSolverError:
            return "no solver finds all solutions of its joints, each by itself"
        return None

    def details(self) -> str:
        """Name the sums, and the family."""
        names, slides = self.chain.names, self.straight.chain.prismatic
        sums = []
        for row, slide in zip(self.straight.matrix, slides, strict=True):
            terms = "".join(
                f"{factor:+g} {name}" for factor, name in zip(row, names, strict=True) if factor
            )
            sums.append(("slide" if slide else "turn") + f" {terms.removeprefix('+')}")
        return (
            f"its joints do the same as {len(sums)} that {', '.join(sums)}, which are solved as if "
            f"they moved freely: {self.inner.name}"
        )

    def solve_batch(self, Ts: Array, within_limits: bool, out: Outputs) -> None:
        """Solve poses Ts (m, 4, 4)."""
        found = Outputs.of(len(Ts), self.inner.kmax, self.straight.chain.n)
        self.inner.solve_batch(Ts, False, found)
        self._put_values(found, out)
        families = (found.free != 0) & (np.arange(self.inner.kmax) < found.counts[:, None])
        rows = np.flatnonzero(families.any(axis=1))
        if len(rows) and len(self.straight.matrix) > self.chain.n:
            self._search(np.ascontiguousarray(Ts[rows]), rows, within_limits, out)
            others = np.setdiff1d(np.arange(len(Ts)), rows)
            some = out.rows(others)
            finish_batch(self.chain.tables, np.ascontiguousarray(Ts[others]), within_limits, some)
            out.put(others, some)
        else:
            finish_batch(self.chain.tables, Ts, within_limits, out)

    def _put_values(self, found: Outputs, out: Outputs) -> None:
        """Values that put the joints where solutions have them, as candidates, to q and counts."""
        out.counts[:] = 0
        matrix, slides = self.straight.matrix, self.straight.chain.prismatic
        pose, k = np.nonzero(np.arange(found.q.shape[1]) < found.counts[:, None])
        joints = found.q[pose, k]
        for shift in self.shifts:
            q = (joints[:, self.rows] + shift) @ self.back.T
            gap = q @ matrix.T - joints
            gap -= np.where(slides, 0.0, TWO_PI * np.rint(gap / TWO_PI))
            reach = np.where(slides, self.chain.size, 1.0) * TOGETHER
            for i in np.flatnonzero((np.abs(gap) <= reach).all(axis=1)):
                m = pose[i]
                out.q[m, out.counts[m]] = q[i]
                out.counts[m] += 1

    def _search(self, Ts: Array, rows: IntArray, within_limits: bool, out: Outputs) -> None:
        """Search at poses with a family of the joints, in which the values may be anywhere."""
        found = out.rows(rows)
        if self.chain.n == MOST_JOINTS:
            deep = np.arange(len(rows))
            wide = search_in_doubt(self.chain, Ts, found, deep, within_limits)
        else:
            wide = search_short(self.chain, Ts, found, within_limits)
        out.put(rows, wide)


@lru_cache(maxsize=8)
def straighten(chain: CoupledChain) -> Straight:
    """The chain with fewer joints where neighbours have parallel axes, or with all of its own."""
    frames: list[Array] = []
    rows: list[Array] = []
    kinds: list[JointType] = []
    for run in _runs(chain):
        own = [chain.joint_frames[i] for i in run], [chain.matrix[i] for i in run]
        some = _in_plane(chain, run) if len(run) > 1 else own
        some = some if len(some[0]) < len(run) else own
        frames += some[0]
        rows += some[1]
        kinds += [chain.kinds[run[0]]] * len(some[0])
    links = [frames[0], *(product(inverse(a), b) for a, b in itertools.pairwise(frames))]
    links.append(product(inverse(frames[-1]), chain.tool))
    far, names = np.full(len(rows), np.inf), tuple(str(i + 1) for i in range(len(rows)))
    straight = SerialChain(np.stack(links), tuple(kinds), names, -far, far, chain.unit)
    return Straight(straight, np.array(rows))


def _runs(chain: CoupledChain) -> list[list[int]]:
    """Neighbours that turn about parallel axes; others alone."""
    runs: list[list[int]] = []
    for i, axis in enumerate(chain.axes):
        last = runs[-1][-1] if runs else -1
        turning = not chain.sliding[i] and runs and not chain.sliding[last]
        if turning and length(np.cross(axis, chain.axes[last])) <= NOMINAL:
            runs[-1].append(i)
        else:
            runs.append([i])
    return runs


def _in_plane(chain: CoupledChain, run: list[int]) -> tuple[list[Array], list[Array]]:
    """Frames and rows of fewer joints that do the same as a run of parallel ones."""
    first, near = chain.joint_frames[run[0]], NOMINAL * max(chain.size, 1.0)
    signs = [1.0 if dot(chain.axes[i], first[:3, 2]) > 0.0 else -1.0 for i in run]
    turned = np.cumsum([s * chain.matrix[i] for s, i in zip(signs, run, strict=True)], axis=0)
    ways: dict[tuple[float, ...], Array] = {}
    along = np.zeros(3)
    for angle, i, j in zip(turned, run, run[1:], strict=False):
        way = product(inverse(first), chain.joint_frames[j])[:3, 3]
        way = way - product(inverse(first), chain.joint_frames[i])[:3, 3]
        along[2] += way[2]
        key = tuple(np.round(angle, 9).tolist())
        ways[key] = ways.get(key, np.zeros(3)) + way * FLAT
    fixed, whole = tuple(np.zeros(chain.n).tolist()), tuple(np.round(turned[-1], 9).tolist())
    at = along + ways.pop(fixed, np.zeros(3))
    order = sorted((k for k in ways if length(ways[k]) > near), key=lambda k: k == whole)
    frames, rows, before = [], [], np.zeros(chain.n)
    for key in [*order, whole]:
        row = np.array(key) - before
        if np.abs(row).max() > WHOLE:
            frames.append(_shifted(first, at))
            rows.append(row)
        before = np.array(key)
        at = at + ways.get(key, np.zeros(3)) if key in order and key != whole else at
    return frames, rows


def _shifted(frame: Array, way: Array) -> Array:
    """A frame moved along its own axes."""
    return product(frame, trans(*way))


@lru_cache(maxsize=8)
def solver_of(chain: CoupledChain, task: Task) -> Solver:
    """The solver of the straightened chain.

    Raises
    ------
    NoSolverError
    """
    return select_solver(straighten(chain).chain, task)


def _rows_that_tell(matrix: Array) -> tuple[list[int], Array]:
    """Rows (n) of a matrix (m, n) from which values follow, and their inverse."""
    n, best, chosen = matrix.shape[1], np.inf, list(range(matrix.shape[1]))
    for rows in itertools.combinations(range(len(matrix)), n):
        size = abs(np.linalg.det(matrix[list(rows)]))
        if WHOLE < size < best:
            best, chosen = size, list(rows)
    return chosen, np.asarray(np.linalg.inv(matrix[chosen]), float)


def _shifts(back: Array, slides: NDArray[np.bool_]) -> list[Array]:
    """Full turns of joints, by which values differ that are no full turns themselves, each (n,)."""
    n = len(back)
    order = round(1.0 / abs(float(np.linalg.det(back))))
    found: dict[tuple[float, ...], Array] = {}
    for turns in itertools.product(range(max(order, 1)), repeat=n):
        if any(t and s for t, s in zip(turns, slides, strict=True)):
            continue
        values = np.remainder(np.round(back @ np.array(turns, float), 9), 1.0)
        found.setdefault(tuple(np.remainder(values, 1.0).tolist()), TWO_PI * np.array(turns, float))
    return list(found.values())
