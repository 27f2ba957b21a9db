"""Chains of one to five joints, any kinds and geometry: the closed loop as a linear system.

Three slides among five or six joints come apart: the orientation first.
"""

from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dh2urdf.chain import SerialChain
from dh2urdf.ik.arm import (
    NOMINAL,
    BatchKernel,
    IntArray,
    Others,
    Outputs,
    SolverBase,
    Task,
    form_of,
    keep_sharp,
    lines_of,
    plain_ranges,
    search_in_doubt,
    starts_of,
    unite_families,
)
from dh2urdf.kernels.certificate import finish_batch, search_valleys
from dh2urdf.kernels.numbers import dual_of_pose
from dh2urdf.kernels.parallel_axes import solve_five_joints
from dh2urdf.kernels.short_chains import (
    close_loop,
    loop_columns,
    loop_matrix,
    search_starts,
    solve_short_chains,
    solve_three_slides,
)
from dh2urdf.transforms import Array, inverse

MOST_JOINTS = 5

SLIDES = 3

CUTS = (0, 1, 1, 3, 2, 5)
"""Different ways to cut the loop of 0 to 5 joints."""

PLACES = {
    1: (0, -1, -1, -1, -1),
    2: (0, -1, -1, 1, -1),
    3: (0, 1, -1, 2, -1),
    4: (0, 1, -1, 2, 3),
    5: (0, 1, 2, 3, 4),
}
"""How n joints fill the places a, b, x, c, d of a cut loop; -1 stays empty."""

TRIALS = 8
"""Random configurations on which the cuts are compared."""

VANISHED = 1e-9
"""Singular value of a loop's matrix, columns of size about 1, that counts as zero."""

SEEDS, WIDTH = 64, 96
"""Most seeds of a pose, and most candidates."""


class ShortChain(SolverBase):
    """All configurations of one to five joints that reach a full pose."""

    name = "short chain"
    needs = "one to five joints of any kind, each of which moves the tool"
    kmax = 8

    def __init__(self, chain: SerialChain, task: Task = Task.POSE, others: Others = ()) -> None:
        super().__init__(chain, task, others)
        self.ends = inverse(self.links[[0, -1]])
        self.unit = chain.size
        self.rest_unit = np.append(np.clip(0.0, chain.lower, chain.upper), self.unit)

    def look_wider(self, Ts: Array, rows: IntArray, within_limits: bool, out: Outputs) -> None:
        """Search at poses Ts[rows]."""
        poses, known = (
            np.ascontiguousarray(Ts[rows]),
            Outputs.of(len(rows), self.kmax, self.chain.n),
        )
        solve_short_chains(self.closed_loop, poses, False, known)
        known.counts[:] = np.maximum(known.counts, -1 - known.counts)
        out.put(rows, search_short(self.chain, poses, known, within_limits))

    @cached_property
    def kernel(self) -> BatchKernel:  # type: ignore[override]
        """The fastest kernel that covers the geometry."""
        return solve_short_chains if self.lanes is None else solve_five_joints

    @cached_property
    def lanes(self) -> tuple[Any, ...] | None:
        """What the kernel of five joints with axes 2, 3, 4 parallel knows; None of other arms."""
        chain = self.chain
        if chain.n != MOST_JOINTS or chain.prismatic.any() or not plain_ranges(chain):
            return None
        if not lines_of(chain, NOMINAL).three_parallel(1):
            return None
        form = form_of(chain, NOMINAL)
        fits = form.exact and form.rows[0, 2] != 0.0 and form.rows[3, 2] != 0.0
        return (chain.tables, form.rows, form.ends, 0.0) if fits else None

    @cached_property
    def constants(self) -> tuple[Any, ...]:
        """What the kernel knows of the arm."""
        return self.closed_loop if self.lanes is None else (self.lanes, self.closed_loop)

    @cached_property
    def closed_loop(self) -> tuple[Any, ...]:
        """Links, joints and the cuts of the loop, as the kernels take them."""
        return self.chain.tables, self.ends, self.loop, self.plan, self.rest_unit

    @cached_property
    def loop(self) -> Array:
        """Dual quaternions of the links between joints, and a row for the closing one, (n, 8)."""
        loop = np.zeros((self.chain.n, 8))
        for row, link in zip(loop[:-1], self.links[1:-1], strict=True):
            dual_of_pose(link, self.unit, row)
        return loop

    @cached_property
    def plan(self) -> IntArray:
        """Cuts of the loop, best first, each with its shape and its slots, (s, 2, 8)."""
        cuts = range(CUTS[self.chain.n])
        shapes = np.array([_shape(self.chain.prismatic, s) for s in cuts], np.int64)
        used = np.array([_slots(self.chain.prismatic, shape) for shape in shapes], np.int64)
        trials = self._trials()
        qualities = [self._quality(trials, *cut) for cut in zip(shapes, used, strict=True)]
        best = sorted(cuts, key=lambda s: qualities[s])
        plan = [([*shapes[s], qualities[s][1]], used[s]) for s in best]
        return np.array(plan, np.int64).reshape(-1, 2, 8)

    @classmethod
    def misfit(cls, chain: SerialChain, tolerance: float) -> str | None:
        """Say what keeps the loop equations from covering a chain; None if nothing does."""
        if chain.n > MOST_JOINTS:
            return f"it needs at most {MOST_JOINTS} joints, the chain has {chain.n}"
        if chain.n == MOST_JOINTS and chain.prismatic.sum() == SLIDES:
            return "three of five joints slide, which decouples them from the others"
        return None

    def details(self) -> str:
        """Name the pairs of joints and what is solved."""
        kinds = "".join("P" if slides else "R" for slides in self.chain.prismatic)
        if self.lanes is not None:
            kinds += (
                ", axes 2, 3, 4 parallel: joints 1 and 5, then a planar arm; near singularities"
            )
        a, b, x, c, d = (int(i) for i in self.plan[0, 0, :5])
        pairs = [", ".join(str(i + 1) for i in pair if i >= 0) for pair in ((a, b), (c, d))]
        text = f"{kinds}; the closed loop cut into joints {' | '.join(p for p in pairs if p)}"
        if x >= 0:
            return f"{text}, joint {x + 1} from a quartic, the others from a null vector"
        equation = ", a quadratic equation" if self.plan[0, 0, 7] == 2 else ""
        return f"{text}, linear in dual quaternions{equation}"

    def _trials(self) -> list[tuple[Array, Array]]:
        """Random configurations (n,), and the loops (n, 8) that their poses close."""
        rng, pose, trials = np.random.default_rng(1), np.empty((4, 4)), []
        for _ in range(TRIALS):
            q = np.where(self.chain.prismatic, self.unit, np.pi) * rng.uniform(-1, 1, self.chain.n)
            loop = self.loop.copy()
            close_loop(self.ends, self.chain.fk(q), self.unit, pose, loop)
            trials.append((q, loop))
        return trials

    def _quality(
        self, trials: list[tuple[Array, Array]], shape: IntArray, used: IntArray
    ) -> tuple[bool, int, float]:
        """How well a cut of the loop finds the configurations of trials; the smallest is best.

        Whether the determinant vanishes for every x, the dimension of the null space at a
        solution, and minus the smallest singular value that does not vanish.
        """
        columns, x, size = np.empty((12, 8)), shape[2], 0
        at, beside = np.empty((2, TRIALS, 8, 8))
        for k, (q, loop) in enumerate(trials):
            loop_columns(loop, self.joints, shape, columns)
            half = 0.0
            if x >= 0:
                half = np.arctan(0.5 * q[x] / self.unit) if self.chain.prismatic[x] else 0.5 * q[x]
                loop_matrix(columns, used, np.cos(half + 1.0), np.sin(half + 1.0), beside[k])
            size = loop_matrix(columns, used, np.cos(half), np.sin(half), at[k])
        sigma = np.linalg.svd(at[:, :size], compute_uv=False)
        blind = x >= 0 and np.linalg.svd(beside[:, :size], compute_uv=False)[:, -1] < VANISHED
        here = (sigma < VANISHED).sum(axis=1)
        gap = sigma[np.arange(TRIALS), size - here - 1].min()
        return bool(np.any(blind)), int(here.max()), -round(float(gap), 9)


def _shape(prismatic: NDArray[np.bool_], start: int) -> list[int]:
    """Joints a, b, x, c, d of the loop cut before joint ``start``; which pairs have four slots."""
    n = len(prismatic)
    a, b, x, c, d = ((start + k) % n if k >= 0 else -1 for k in PLACES[n])
    full = [i >= 0 and j >= 0 and not (prismatic[i] and prismatic[j]) for i, j in ((a, b), (c, d))]
    return [a, b, x, c, d, int(full[0]), int(full[1])]


def _slots(prismatic: NDArray[np.bool_], shape: NDArray[np.int64]) -> list[int]:
    """Slots 0 to 7 of the pairs that a shape has, -1 after the last."""
    slots = []
    for at, i, j, full in ((0, shape[0], shape[1], shape[5]), (4, shape[3], shape[4], shape[6])):
        slots += [at]
        slots += [at + 1] if j >= 0 else []
        slots += [at + 2] if i >= 0 else []
        slots += [at + 3] if full else []
    return slots + [-1] * (8 - len(slots))


class ThreeSlides(SolverBase):
    """Turning joints from the orientation alone, then the slides from linear equations."""

    name = "three slides"
    needs = "three sliding joints and two or three turning ones"
    kmax = 8
    kernel = staticmethod(solve_three_slides)

    def __init__(self, chain: SerialChain, task: Task = Task.POSE, others: Others = ()) -> None:
        super().__init__(chain, task, others)
        self.constants = self.chain.tables, np.clip(0.0, chain.lower, chain.upper)

    def look_wider(self, Ts: Array, rows: IntArray, within_limits: bool, out: Outputs) -> None:
        """Search at poses Ts[rows], from what the equations give and many starts."""
        poses, known = (
            np.ascontiguousarray(Ts[rows]),
            Outputs.of(len(rows), self.kmax, self.chain.n),
        )
        self.kernel(self.constants, poses, False, known)
        known.counts[:] = -1 - known.counts
        if self.chain.n == MOST_JOINTS:
            wide = search_short(self.chain, poses, known, within_limits)
        else:
            deep = np.arange(len(rows))
            wide = search_in_doubt(self.chain, poses, known, deep, within_limits)
        out.put(rows, wide)

    @classmethod
    def misfit(cls, chain: SerialChain, tolerance: float) -> str | None:
        """Say what keeps orientation and position from being decoupled; None if nothing does."""
        if chain.n not in (5, 6) or chain.prismatic.sum() != SLIDES:
            return "it needs three sliding joints and two or three turning ones"
        return None

    def details(self) -> str:
        """Name the kinds of joints and what is solved."""
        kinds = "".join("P" if slides else "R" for slides in self.chain.prismatic)
        turning = [str(i + 1) for i in np.flatnonzero(~self.chain.prismatic)]
        return (
            f"{kinds}; joints {', '.join(turning)} from the orientation alone, "
            "the slides from three linear equations"
        )


def search_short(chain: SerialChain, Ts: Array, found: Outputs, within_limits: bool) -> Outputs:
    """Solve poses Ts (d, 4, 4), their solutions, limits aside, being known: wider outputs."""
    d, k = len(Ts), found.q.shape[1]
    wide, seeds = Outputs.of(d, WIDTH, chain.n), np.empty((d, SEEDS, chain.n))
    seeds[:, :k], many = found.q, found.counts.copy()
    search_starts(chain.tables, starts_of(chain), chain.size, Ts, seeds, many)
    wide.q[:, :SEEDS], wide.counts[:] = seeds, many
    search_valleys(chain.tables, chain.size, Ts, seeds, many, wide.q, wide.counts)
    finish_batch(chain.tables, Ts, False, wide)
    for i in range(d):
        keep_sharp(wide.rows(slice(i, i + 1)), found.q[i, : found.counts[i]])
    unite_families(chain, Ts, within_limits, wide)
    return wide
