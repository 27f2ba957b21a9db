"""Any arm of six joints, at most two of them slides: elimination, then Newton on the exact chain.

Which eliminations suit an arm is found by trying all twelve on random poses.
"""

import math
from functools import cached_property
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from dh2urdf.chain import SerialChain
from dh2urdf.engine import Step
from dh2urdf.ik.arm import (
    AxisLines,
    IntArray,
    Others,
    Outputs,
    SolverBase,
    Task,
    room_in_doubt,
    starts_of,
)
from dh2urdf.ik.families.closed_form import STUCK
from dh2urdf.ik.families.own_record import OwnRecord
from dh2urdf.ik.families.short_links import screw, short_links
from dh2urdf.kernels.general_6r import ARM_6R, MOST, WORK, finish_general_6r, solve_general_6r
from dh2urdf.kernels.in_doubt import search_doubtful
from dh2urdf.kernels.numbers import sincos
from dh2urdf.transforms import Array, inverse, product

Arm: TypeAlias = NDArray[np.void]
"""What the kernel knows of an arm, and the arrays that it works in: one record."""

TURN = np.array([0.7310, -1.1170, 0.4127, 1.3019, -0.8233, 0.5171])
"""Zero of each joint's angle inside the solver [rad]: none that a user's pose would have."""

SLIDES = 2
"""Most joints that slide; with three the orientation alone gives the turns."""

REACH = 0.3
"""What a slide is measured in, in parts of the summed lengths of the links."""

POSES = 24
"""Random poses on which each elimination is tried."""

USABLE = 0.3
"""Part of the best elimination's solutions that another must find to be kept."""

WORTH = 0.03
"""Solutions a pose that one more digit in the seeds outweighs."""

DEAREST = 6.0
"""Most digits that spans of doubt, which take time, count for."""

TRIALS = 6
"""Random poses by which a plan is tried."""

SAME = 1e-4
"""Joint distance [rad] at which a solution is the configuration that was asked for."""


class General6R(OwnRecord, SolverBase):
    """Raghavan and Roth's elimination of five joints; up to 16 solutions."""

    name = "general 6R"
    needs = "six joints, any axes, at most two of them sliding"
    kmax = 16
    if_spare = STUCK

    def __init__(self, chain: SerialChain, task: Task = Task.POSE, others: Others = ()) -> None:
        super().__init__(chain, task, others)
        if chain.prismatic.any():
            kinds = "".join("P" if slides else "R" for slides in chain.prismatic)
            self.name = f"general {kinds}"
        self._idle: list[Arm] = []

    @cached_property
    def plan(self) -> Arm:
        """The eliminations that suit the arm; they are chosen when first asked for."""
        return plan_general_6r(self.links, self.chain.prismatic)

    def like(self, chain: SerialChain) -> "General6R":
        """The solver of a chain that differs little, with the same eliminations if they do."""
        solver = General6R(chain, self.task)
        solver.plan = replan_general_6r(self.plan, np.ascontiguousarray(chain.links))
        return solver if solver.finds_itself() else General6R(chain, self.task)

    def finds_itself(self) -> bool:
        """Whether the configurations of a few random poses are among their solutions."""
        rng = np.random.default_rng(0)
        q = rng.uniform(-np.pi, np.pi, (TRIALS, 6))
        slides = self.chain.prismatic
        q[:, slides] *= self.chain.size / np.pi
        poses = np.stack([self.chain.fk(row) for row in q])
        out = Outputs.of(TRIALS, self.kmax, 6)
        out.q[:] = 0.0
        self.solve_unfinished(poses, out)
        way = out.q - q[:, None]
        turns = np.abs(np.remainder(way + np.pi, 2.0 * np.pi) - np.pi)
        gap = np.where(slides, np.abs(way) / self.chain.size, turns).max(axis=2)
        gap[np.arange(self.kmax) >= out.counts[:, None]] = np.inf
        return bool((gap.min(axis=1) < SAME).all())

    @classmethod
    def misfit(cls, chain: SerialChain, tolerance: float) -> str | None:
        """Say what keeps the elimination from covering the chain; None if nothing does."""
        if chain.n != 6 or chain.prismatic.sum() > SLIDES:
            return "it needs six joints of which two slide at most"
        return None

    def solve_unfinished(self, Ts: Array, out: Outputs) -> IntArray:
        """Candidates of poses Ts (m, 4, 4), limits or not: q and counts; the poses in doubt."""
        doubt = np.zeros(len(Ts), np.int64)
        with self.record() as arm:
            solve_general_6r(arm, Ts, out.q, out.residual, out.counts, doubt)
        return np.flatnonzero(doubt)

    def details(self) -> str:
        """Name the axes and the method."""
        how = (
            "one turn from the roots of a trigonometric polynomial, the other three from the "
            "orientation, the slides from linear equations"
            if self.chain.prismatic.sum() == SLIDES
            else "five joints eliminated, the sixth from a polynomial of degree 16 (Raghavan and "
            "Roth 1993)"
        )
        return f"{how}, then Newton's method on the exact chain; {AxisLines(self.chain).describe()}"

    def solve_batch(self, Ts: Array, within_limits: bool, out: Outputs) -> None:
        """Solve poses Ts (m, 4, 4); those in doubt are searched, too."""
        if len(self.solve_sure(Ts, within_limits, out)):
            kernel, arguments, _ = self._search(Ts, within_limits, out)
            kernel(*arguments)

    def _search(self, Ts: Array, within_limits: bool, out: Outputs) -> Step:
        """The kernel that searches at poses in doubt, and its arguments."""
        chain, given = self.chain, (room_in_doubt(), Ts, within_limits, out)
        return search_doubtful, (chain.tables, starts_of(chain), chain.size, *given), False

    def solve_sure(self, Ts: Array, within_limits: bool, out: Outputs) -> IntArray:
        """Solve poses Ts (m, 4, 4) but those in doubt, whose counts are -1 minus their candidates.

        Returned are their indices.
        """
        with self.record() as arm:
            doubts = finish_general_6r(self.chain.tables, arm, Ts, within_limits, out)
        return np.flatnonzero(out.counts < 0) if doubts else np.empty(0, np.int64)

    def steps(self, Ts: Array, within_limits: bool, out: Outputs) -> tuple[Step, ...]:
        """The kernel alone, where it has no doubt."""
        arguments = self.chain.tables, self.plan.copy(), Ts, within_limits, out
        return ((finish_general_6r, arguments, False),)

    def all_steps(self, Ts: Array, within_limits: bool, out: Outputs) -> tuple[Step, ...]:
        """That kernel, and the search where it has."""
        return *self.steps(Ts, within_limits, out), self._search(Ts, within_limits, out)


def _outer_slides(chain: Array, slides: Array, outer: Array) -> None:
    """Directions of the slides next to base and tool, and of their shares of a vector.

    ``outer`` (6, 2, 3), seen from joint 1 or joint 6; by links (5, 3, 4) between the joints.
    """
    for joints, seen in ((range(6), 0), (range(5, -1, -1), 1)):
        turn, ways, some = np.eye(3), [], []
        for j in joints:
            if not slides[j]:
                break
            ways.append(turn[:, 2])
            some.append(j)
            if seen == 0 and j < 5:
                turn = product(turn, chain[j, :, :3])
            elif j > 0:
                turn = product(turn, chain[j - 1, :, :3].T)
        if some:
            outer[some, 0], outer[some, 1] = ways, np.linalg.pinv(np.array(ways), rcond=1e-6).T


def _random_poses(arm: Arm) -> Array:
    """Reachable poses (POSES, 4, 4), the same ones each time."""
    rng = np.random.default_rng(0)
    poses = np.empty((POSES, 4, 4))
    links, slides = np.zeros((7, 4, 4)), arm["slides"][0]
    links[:, :3], links[:, 3, 3] = arm["links"][0], 1.0
    span = arm["reach"][0] * arm["size"][0] / REACH / math.pi
    for m, q in enumerate(rng.uniform(-math.pi, math.pi, (POSES, 6))):
        T = links[0]
        for i in range(6):
            Z = screw(0.0, arm["middles"][0, i] + span * q[i]) if slides[i] else screw(q[i], 0.0)
            T = product(T, Z, links[i + 1])
        poses[m] = T
    return poses


def _rank(arm: Arm, poses: Array) -> list[tuple[int, int]]:
    """The eliminations to keep, best first: by solutions found, then by precision."""
    eliminations = [(shift, reverse) for reverse in (0, 1) for shift in range(6)]
    # the hidden joint of the loop has to turn where two slide, else the last one
    label = 2 if arm["two_slides"][0] else 5
    slides = arm["slides"][0]
    last = [(11 - s - label) % 6 if r else (s + label) % 6 for s, r in eliminations]
    eliminations = [cut for cut, joint in zip(eliminations, last, strict=True) if not slides[joint]]
    outputs = np.empty((1, 16, 6)), np.empty((1, 16)), *np.zeros((2, 1), np.int64)
    found, digits = np.zeros(len(eliminations)), np.zeros(len(eliminations))
    for k, elimination in enumerate(eliminations):
        _choose(arm, [elimination])
        for m in range(POSES):
            solve_general_6r(arm, poses[m : m + 1], *outputs)
            seeded, spans = arm["first"][0]
            found[k] += outputs[2][0] / POSES
            digits[k] -= min(math.log10(max(seeded, 1e-16)) + min(spans, DEAREST), 0.0) / POSES
    order = np.argsort(-found - digits * WORTH)
    return [eliminations[k] for k in order if found[k] >= USABLE * found.max()][:MOST]


def _choose(arm: Arm, eliminations: list[tuple[int, int]]) -> None:
    """Prepare some eliminations."""
    arm["trials"], arm["choices"][0, : len(eliminations)] = len(eliminations), eliminations
    arm["ready"] = 0
    none = np.empty((0, 4, 4)), np.empty((0, 16, 6)), np.empty((0, 16))
    solve_general_6r(arm, *none, *np.empty((2, 0), np.int64))


def _place(arm: Arm, links: Array) -> None:
    """Set the links (7, 4, 4) of an arm."""
    short, arm["middles"][0] = short_links(links, arm["slides"][0], TURN)
    lengths = np.linalg.norm(short[1:6, :3, 3], axis=1)
    size = float(lengths.max()) or 1.0
    arm["links"], arm["size"], arm["ends"] = links[:, :3], size, inverse(short[[0, 6]])
    arm["reach"] = REACH * max(float(lengths.sum()) / size, 1.0)
    sines, cosines = zip(*(sincos(x) for x in TURN.tolist()), strict=True)
    arm["turns"] = cosines, sines, TURN
    arm["chain"][0, :5] = short[1:6, :3]
    arm["chain"][0, :5, :, 3] /= size
    _outer_slides(arm["chain"][0, :5], arm["slides"][0], arm["outer"][0])


def blank_general_6r(links: Array, slides: NDArray[np.bool_] | None = None) -> Arm:
    """The record (1,) of an arm with these links (7, 4, 4), no eliminations chosen.

    ``slides`` (6,): which joints do; none by default.
    """
    arm = np.zeros(1, ARM_6R)
    if slides is not None:
        arm["slides"], arm["two_slides"] = slides, slides.sum() == SLIDES
    _place(arm, links)
    return arm


def plan_general_6r(links: Array, slides: NDArray[np.bool_] | None = None) -> Arm:
    """The record (1,) by which the kernel solves an arm, its arguments as of `blank_general_6r`.

    ``T_base_tool = links[0] Z_1(q1) links[1] ... Z_6(q6) links[6]``.
    """
    arm = blank_general_6r(links, slides)
    _choose(arm, _rank(arm, _random_poses(arm)))
    for name in WORK:
        arm[name] = 0.0
    return arm


def replan_general_6r(arm: Arm, links: Array) -> Arm:
    """The record of an arm with other links (7, 4, 4), with the eliminations of an arm.

    Some 20 times faster than :func:`plan_general_6r`. Eliminations that are good for one arm are
    so for nearly all that differ in the value of a held joint.
    """
    other = arm.copy()
    _place(other, links)
    _choose(other, [tuple(row) for row in arm["choices"][0, : arm["trials"][0]].tolist()])
    return other
