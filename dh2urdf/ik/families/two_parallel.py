"""Six revolute joints, axes 2 and 3 parallel, 4 meets 5 or 5 meets 6; and the mirrored chains."""

from functools import lru_cache

import numpy as np

from dh2urdf.chain import SerialChain
from dh2urdf.engine import Step
from dh2urdf.ik.arm import (
    NEAR,
    NOMINAL,
    NONE,
    AxisLines,
    Others,
    Outputs,
    Task,
    form_of,
    lines_of,
    pose_along,
)
from dh2urdf.ik.families.closed_form import not_six_revolute
from dh2urdf.ik.families.general_6r import Arm, blank_general_6r
from dh2urdf.ik.families.near_family import Refereed
from dh2urdf.kernels.two_parallel import TwoParallel as Form
from dh2urdf.kernels.two_parallel import solve_two_parallel
from dh2urdf.transforms import Array, cross, dot, inverse, length, product

ROUNDED = 3e-5
"""Distance from the nominal arm [rad, sizes] of rounded tables. Calibrated arms are farther from it
and from its singular poses: the general solver alone loses nothing and is faster."""


class TwoParallel(Refereed):
    """A polynomial in joint 1 of the nominal arm, then Newton's method on the exact chain."""

    name = "two parallel axes"
    needs = "six revolute joints, axes 2, 3 parallel, 4, 5 or 5, 6 meeting; or so from the tool"

    def __init__(self, chain: SerialChain, task: Task = Task.POSE, others: Others = ()) -> None:
        super().__init__(chain, task, others)
        match = _match(chain)
        assert match is not None
        self.lines, self.mirrored = match
        self.record, self.form = blank_general_6r(self.links), _form(*match)
        self._idle: list[Arm] = []
        self.exact = self.lines.tolerance == NOMINAL
        self.name = self.name if self.exact else "nearly two parallel axes"

    @classmethod
    def misfit(cls, chain: SerialChain, tolerance: float) -> str | None:
        """Say what keeps the family from covering the chain; None if nothing does."""
        if unfit := not_six_revolute(chain):
            return unfit
        if _match(chain) is None:
            return "no parallel axes 2, 3 with 4, 5 or 5, 6 meeting, nor from the tool"
        return None

    def details(self) -> str:
        """Name the axes and the method."""
        seen = "seen from the tool, " if self.mirrored else ""
        near = "" if self.exact else "nearly, and the general solver for every pose: "
        return (
            f"{seen}{near}{self.lines.describe()}; joint 1 from a polynomial of degree 16 without "
            "an elimination, joints 4 and 5 from directions, 2 and 3 from a planar arm, then "
            f"Newton's method on the exact chain; where roots meet, {self.general.explain()}"
        )

    def solve_batch(self, Ts: Array, within_limits: bool, out: Outputs) -> None:
        """Solve poses Ts (m, 4, 4), those in doubt by the general solver too."""
        try:  # a record that no other thread has
            record = self._idle.pop()
        except IndexError:
            record = self.record.copy()
        kernel, arguments, _ = self._solve(record, Ts, within_limits, out)
        doubts = kernel(*arguments)
        self._idle.append(record)
        if doubts:
            self.look_wider(Ts, NONE, within_limits, out)

    def steps(self, Ts: Array, within_limits: bool, out: Outputs) -> tuple[Step, ...]:
        """The kernel alone, where its lines are the chain's and it has no doubt."""
        arm = self.record.copy()
        return (self._solve(arm, Ts, within_limits, out),) if self.exact else ()

    def all_steps(self, Ts: Array, within_limits: bool, out: Outputs) -> tuple[Step, ...]:
        """That kernel, and then the general solver where it has doubt."""
        arm = self.general.plan.copy()
        first = self._solve(arm, Ts, within_limits, out)
        return first, self.referee(arm, Ts, within_limits, out)

    def _solve(self, arm: Arm, Ts: Array, within_limits: bool, out: Outputs) -> Step:
        """The kernel of the family, and its arguments."""
        given = self.chain.tables, self.form, arm, self.exact, Ts, within_limits, out
        return solve_two_parallel, given, False


@lru_cache(maxsize=4)
def _match(chain: SerialChain) -> tuple[AxisLines, bool] | None:
    """The axes of the family, snapped as little as will do, and whether seen from the tool."""
    for tolerance in (NOMINAL, *NEAR):
        for mirrored in (False, True):
            seen = chain.reversed() if mirrored else chain
            lines = lines_of(seen, tolerance)
            if lines.parallel(1) and not lines.parallel(2) and (lines.meet(3) or lines.meet(4)):
                near = (
                    tolerance == NOMINAL or form_of(seen, tolerance).error <= ROUNDED * chain.size
                )
                return (lines, mirrored) if near else None
    return None


def _form(lines: AxisLines, mirrored: bool) -> Form:
    """Lines of the family as its kernel takes them."""
    chain, axes, points = lines.chain, lines.axes, lines.points.copy()
    points[2] += axes[2] * dot(axes[2], points[1] - points[2])
    if lines.meet(3):
        points[3] = points[4]
        points[5] += axes[5] * dot(axes[5], points[4] - points[5])
    else:
        points[4] = points[5]
        points[3] += axes[3] * dot(axes[3], points[4] - points[3])
    across = [cross(a, np.eye(3)[np.abs(a).argmin()]) for a in axes[[1, 5]]]
    frame = pose_along(across[0], axes[1], points[0])
    turn = frame[:3, :3].T
    steps = np.diff(points, axis=0, prepend=points[:1])
    rows = np.vstack([axes, across[1] / length(across[1])])
    rest, back = (chain.fk(np.zeros(6)), inverse(frame))
    ends = (product(back, rest), frame) if mirrored else (back, product(inverse(rest), frame))
    order = np.arange(6)[::-1] if mirrored else np.arange(6)
    return Form(
        np.stack(ends),
        product(rows, turn.T),
        product(steps, turn.T),
        np.ascontiguousarray(order),
        lines.signs,
        int(mirrored),
    )
