"""Seven joints, one held, a spherical triple among the others: nothing is rebuilt for a value."""

from collections.abc import Callable
from functools import cached_property, lru_cache
from typing import NamedTuple

import numpy as np

from dh2urdf.chain import SerialChain
from dh2urdf.engine import Step
from dh2urdf.ik.arm import (
    NONE,
    SLACK,
    SNAP,
    AxisLines,
    DHForm,
    HeldSolver,
    IntArray,
    Outputs,
    hold,
    plain_ranges,
    row_motion,
    without_end,
)
from dh2urdf.ik.families import SphericalWrist
from dh2urdf.kernels.newton import POSE
from dh2urdf.kernels.redundant import solve_held_blocks, solve_held_wrist, sweep_pose
from dh2urdf.transforms import Array, inverse, product

TRIAL_VALUE = 0.731
"""Value of the held joint [rad or m] at which the geometry of the rest is looked at: one that
means nothing to any arm."""


HELD_PARTS = np.zeros((4, 4, 4))
"""A turn or slide of a joint is the sum of these, times its cosine, its sine, its slide, and 1."""
HELD_PARTS[0, 0, 0] = HELD_PARTS[0, 1, 1] = HELD_PARTS[1, 1, 0] = HELD_PARTS[2, 2, 3] = 1.0
HELD_PARTS[3, 2, 2] = HELD_PARTS[3, 3, 3] = 1.0
HELD_PARTS[1, 0, 1] = -1.0

MISS = 0.1
"""Relative amount by which an equation may miss its rim where a curve is only looked for."""


class _Oriented(NamedTuple):
    """The chain seen so that its spherical triple comes last, and its held joint there."""

    chain: SerialChain
    joint: int
    reversed: bool

    @property
    def varies(self) -> int:
        """Which of the links S0, S1, S2 depends on the held value; -1: the pose does."""
        return -1 if self.joint in (0, self.chain.n - 1) else self.joint - 1

    def sides(self, ends: Array) -> Array:
        """What the target stands between, (2, 4, 4): the ends, one cut off at the held joint.

        ``ends`` (3, 4, 4) are the inverse of the base, the inverse of the tool, the tool.
        """
        left = inverse(self.chain.links[0]) if self.joint == 0 else ends[0]
        right = inverse(self.chain.links[-1]) if self.joint == self.chain.n - 1 else ends[1]
        return np.stack([inverse(right), inverse(left)] if self.reversed else [left, right])

    def factors(self, link: Array, before: Array, after: Array, ends: Array) -> Array:
        """Factors of cosine, sine, slide of the held joint and of 1, (4, 4, 4), four rows each.

        Of the entries of S1 (rotation, then position), of the point in the last frame, or in
        the first of a reversed arm, where the user's tool origin is, and of a zero.
        """
        S1, links = np.array([link]), self.chain.links
        lever = np.array([ends[0] if self.reversed else ends[2]])
        if self.varies == 1:
            S1 = product(before, HELD_PARTS, after)
        if self.reversed and self.joint == 0:
            back = HELD_PARTS * [[[1]], [[-1]], [[-1]], [[1]]]
            lever = product(lever, back, inverse(links[0]))
        elif not self.reversed and self.joint == self.chain.n - 1:
            lever = product(lever, HELD_PARTS, links[-1])
        factors = np.zeros((16, 4))
        factors[:9, -len(S1) :] = S1[:, :3, :3].reshape(-1, 9).T
        factors[9:12, -len(S1) :] = S1[:, :3, 3].T
        factors[12:15, -len(lever) :] = lever[:, :3, 3].T
        return factors.reshape(4, 4, 4)

    def rest(self, value: float) -> SerialChain:
        """The chain of the moving joints; an end that moves with the held joint is cut off."""
        if self.varies < 0:
            return without_end(self.chain, self.joint)
        return hold(self.chain, {self.joint: value})


class HeldWrist(HeldSolver):
    """Spherical wrist or shoulder of a chain with one held joint, at any value; see :meth:`of`."""

    kmax = 8

    def __init__(self, chain: SerialChain, joint: int, oriented: _Oriented) -> None:
        super().__init__(chain, (joint,))
        self.name = "spherical shoulder" if oriented.reversed else "spherical wrist"
        rest = oriented.rest(TRIAL_VALUE)
        self.form = DHForm(SphericalWrist(rest, tolerance=SNAP).lines)
        self.rows = self.form.rows.copy()
        self.rows[:3, 4] = 0.0
        links = [row_motion(row, 0.0) for row in self.form.rows[:3]]
        before, after = np.eye(4), np.eye(4)
        j, seen, ends = oriented.varies, oriented.chain, self.form.ends
        if j >= 0:
            to_form = product(inverse(self.form.frames), rest.joint_frames)
            before = product(to_form[j], seen.links[oriented.joint])
            after = product(seen.links[oriented.joint + 1], inverse(to_form[j + 1]))
        fixed = chain.links, seen.links, np.stack([*links, before, after]), ends
        factors = oriented.factors(links[1], before, after, ends)
        self.frames = np.concatenate([*fixed, oriented.sides(ends), factors])
        which = [joint, chain.prismatic[joint], oriented.reversed, oriented.joint, j]
        self.which = np.array(which, np.int64)
        joints = np.delete(chain.tables[1], joint, axis=0)
        self.constants = self.frames, self.which, self.rows, joints, SLACK

    @classmethod
    def of(cls, chain: SerialChain, joint: int) -> "HeldWrist | None":
        """The solver; None where the other joints have no spherical triple at one end."""
        if chain.n != 7 or np.delete(chain.prismatic, joint).any():
            return None
        lines = _lines(chain)
        for reversed_, first in ((False, 4 if joint < 4 else 3), (True, 0 if joint > 2 else 1)):
            seen_joint = 6 - joint if reversed_ else joint
            if seen_joint in (4, 5) or not lines.spherical(first):
                continue
            seen = _Oriented(chain.reversed() if reversed_ else chain, seen_joint, reversed_)
            if SphericalWrist.obstacle(seen.rest(TRIAL_VALUE), tolerance=SNAP) is None:
                return cls(chain, joint, seen)
        return None

    @property
    def one_by_one(self) -> bool:
        """Whether the first two axes meet, so that the elbow is found first, the others after."""
        meet = self.form.rows[0, 0] == 0.0 and self.form.rows[0, 2] != 0.0
        return bool(meet and self.which[4] != 0)

    @cached_property
    def kernel(self) -> Callable[..., int]:
        """The fastest kernel that covers the geometry."""
        rows, varies = self.form.rows, self.which[4]
        orthogonal = rows[3, 1] == rows[4, 1] == 0.0
        blocks = self.one_by_one and orthogonal and varies in (-1, 1) and rows[0, 3] == 0.0
        blocks = blocks and plain_ranges(self.chain)
        fastest: Callable[..., int] = solve_held_blocks if blocks else solve_held_wrist
        return fastest

    def details(self) -> str:
        """Name the family and its axes."""
        seen = "seen from the tool, " if self.which[2] else ""
        return f"{self.name}: {seen}{self.form.lines.describe()}"

    def solve_held(self, Ts: Array, values: Array, within_limits: bool, out: Outputs) -> None:
        """Solve poses Ts (m, 4, 4), each with its held value (m, 1), in one call."""
        self.solve_plainly(Ts, values, within_limits, out)

    def solve_plainly(
        self, Ts: Array, values: Array, within_limits: bool, out: Outputs
    ) -> IntArray:
        """The same; which poses are in doubt: near a singular one equations leave some out."""
        if not self.kernel(self.constants, values.ravel(), Ts, within_limits, out):
            return NONE
        doubt = np.flatnonzero(out.counts < 0)
        out.counts[doubt] = -1 - out.counts[doubt]
        return doubt

    def steps(
        self, Ts: Array, values: Array, within_limits: bool, out: Outputs
    ) -> tuple[Step, ...]:
        """The kernel of poses Ts (m, 4, 4), each with its held value (m,)."""
        return ((self.kernel, (self.constants, values, Ts, within_limits, out), False),)

    @property
    def quick(self) -> bool:
        """Whether many values take little time, and their solutions have branches."""
        return self.kernel is solve_held_blocks

    def sweep(self, T: Array, values: Array, out: Outputs) -> Step:
        """What solves a pose (4, 4) at or near values (m,) of the held joint, of a whole turn."""
        arm, goal = (*self.constants[:4], MISS), (POSE, T, self.chain.size)
        margin = np.empty((len(values), 2))
        return sweep_pose, (arm, self.chain.tables, goal, self.quick, values, out, margin), False


@lru_cache(maxsize=4)
def _lines(chain: SerialChain) -> AxisLines:
    """The axes of a chain, which is looked at for one joint after the other."""
    return AxisLines(chain)
