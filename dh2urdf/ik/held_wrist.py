"""Seven joints, one held, a spherical triple among the others: nothing is rebuilt for a value."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from dh2urdf.chain import SerialChain
from dh2urdf.ik.geometry import AxisLines, DHForm
from dh2urdf.ik.held import hold, without_end
from dh2urdf.ik.held_solver import HeldSolver
from dh2urdf.ik.solver import IntArray
from dh2urdf.ik.spherical_wrist import SphericalWrist
from dh2urdf.ik.tolerances import SLACK
from dh2urdf.transforms import Array, inverse, rot_z, trans

__all__ = ["HeldWrist"]

TRIAL_VALUE = 0.731
"""Value of the held joint [rad or m] at which the geometry of the rest is looked at: one that
means nothing to any arm."""


class _Oriented(NamedTuple):
    """The chain seen so that its spherical triple comes last, and its held joint there."""

    chain: SerialChain
    joint: int
    reversed: bool

    @property
    def varies(self) -> int:
        """Which of the links S0, S1, S2 depends on the held value; -1: the pose does."""
        return -1 if self.joint in (0, self.chain.n - 1) else self.joint - 1

    def rest(self, value: float) -> SerialChain:
        """The chain of the moving joints; an end that moves with the held joint is cut off."""
        if self.varies < 0:
            return without_end(self.chain, self.joint)
        return hold(self.chain, {self.joint: value})


class HeldWrist(HeldSolver):
    """Spherical wrist or shoulder of a chain with one held joint, at any value of it.

    Parameters
    ----------
    chain : SerialChain
        The whole chain.
    joint : int
        Index of the held joint.
    """

    kmax = 8

    def __init__(self, chain: SerialChain, joint: int) -> None:
        oriented = self._oriented(chain, joint)
        assert oriented is not None
        super().__init__(chain, (joint,))
        self.name = "spherical shoulder" if oriented.reversed else "spherical wrist"
        rest = oriented.rest(TRIAL_VALUE)
        self.form = DHForm(SphericalWrist(rest).lines)
        rows = self.form.rows.copy()
        rows[:3, 4] = 0.0
        links = [_row_transform(row) for row in self.form.rows[:3]]
        before, after = np.eye(4), np.eye(4)
        if oriented.varies >= 0:
            j = oriented.varies
            to_form = inverse(self.form.frames) @ rest.joint_frames
            before = to_form[j] @ oriented.chain.links[oriented.joint]
            after = oriented.chain.links[oriented.joint + 1] @ inverse(to_form[j + 1])
        self.frames = np.ascontiguousarray(
            np.concatenate(
                [chain.links, oriented.chain.links, links, [before, after], self.form.ends]
            )
        )
        self.which = np.array(
            [joint, chain.prismatic[joint], oriented.reversed, oriented.joint, oriented.varies],
            np.int64,
        )
        self.rows = np.ascontiguousarray(rows)
        moving = [i for i in range(chain.n) if i != joint]
        self.joints = np.column_stack([np.zeros(6), chain.lower[moving], chain.upper[moving]])

    @staticmethod
    def _oriented(chain: SerialChain, joint: int) -> _Oriented | None:
        """How to see the chain so that the family covers it; None: it does not."""
        if chain.n != 7 or chain.prismatic[[i for i in range(7) if i != joint]].any():
            return None
        lines = AxisLines(chain)
        for seen, first in (
            (_Oriented(chain, joint, False), 4 if joint < 4 else 3),
            (_Oriented(chain.reversed(), 6 - joint, True), 0 if joint > 2 else 1),
        ):
            if seen.joint in (4, 5) or not lines.spherical(first):
                continue
            if SphericalWrist.obstacle(seen.rest(TRIAL_VALUE)) is None:
                return seen
        return None

    @classmethod
    def covers(cls, chain: SerialChain, joint: int) -> bool:
        """Whether the other joints have a spherical wrist or shoulder whatever the value."""
        return cls._oriented(chain, joint) is not None

    @property
    def one_by_one(self) -> bool:
        """Whether the first two axes meet, so that the elbow is found first, the others after."""
        return bool(self.form.rows[0, 0] == 0.0 and self.form.rows[0, 2] != 0.0)

    def details(self) -> str:
        """Name the family and its axes."""
        seen = "seen from the tool, " if self.which[2] else ""
        return f"{self.name}: {seen}{self.form.lines.describe()}"

    def solve_held(
        self,
        Ts: Array,
        values: Array,
        within_limits: bool,
        q_out: Array,
        residual_out: Array,
        count_out: IntArray,
        branch_out: IntArray,
        free_out: IntArray,
    ) -> None:
        """Solve poses Ts (m, 4, 4), each with its held value (m, 1), in one jitted call."""
        from dh2urdf.kernels.held_wrist import solve_held_wrist

        solve_held_wrist(
            self.frames,
            self.which,
            self.rows,
            self.joints,
            SLACK,
            values[:, 0],
            Ts,
            within_limits,
            q_out,
            residual_out,
            count_out,
            branch_out,
            free_out,
        )


def _row_transform(row: Array) -> Array:
    """``Rot_z(theta) Trans_z(d) Trans_x(a) Rot_x(alpha)`` of a row of :class:`DHForm`."""
    a, ca, sa, d, theta = row[:5]
    T: Array = rot_z(theta) @ trans(a, 0.0, d)
    X = np.eye(4)
    X[1, 1], X[1, 2], X[2, 1], X[2, 2] = ca, -sa, sa, ca
    return T @ X
