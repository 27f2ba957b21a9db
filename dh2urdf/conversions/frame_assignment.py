"""Frame assignment: lecture notes section 4, from the joint axes to the DH parameters.

The chain is ``B Z_1(q1) L_1 Z_2(q2) ... L_{n-1} Z_n(qn) M``. Every ``L_i`` is factored along a
common normal (:mod:`dh2urdf.conversions.axis_pairs`); the turns and slides about one axis,
from the pair before and the pair after, add up to that joint's theta and d. What the notes
leave free is settled here, once:

- parallel axes: the common normal is the one with d = 0; for the first pair, whose d has a
  meaning above the base, the one through joint 1's own origin;
- intersecting axes: of the two directions of x, the one that leaves fewest theta non-zero;
- collinear axes: x stays, theta = 0, or goes with the next x where only the first joint slides;
- frame 0 is the base frame where joint 1's axis allows it;
- frame n is the tool frame where four DH motions reach it.

The notes let x point away from the axis before it (a > 0). By default that is turned round
where it would cost theta a half turn at q = 0, as data sheets do (a UR's a_2 = -0.425);
``XRule.AWAY`` keeps to the notes.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import NamedTuple

from dh2urdf import transforms as tf
from dh2urdf.conversions.axis_pairs import (
    AxisPair,
    Normal,
    across,
    classify,
    common_normal,
)
from dh2urdf.conversions.frame_directions import Directions, choose_directions
from dh2urdf.conversions.frame_ends import End, EndPlacer, Start, first_frame, slide_turn
from dh2urdf.dh import DHConvention
from dh2urdf.transforms import Array

__all__ = ["FAR", "Assignment", "Reference", "XRule", "assign_frames", "references"]

FAR = 20.0
"""Common normals farther off than this many arm's lengths are not gone to.

A calibrated arm whose parallel axes are off by a milliradian meets its common normal hundreds
of metres away, and each of those metres costs a digit; below two degrees or so of tilt a table
with one extra rotation is shorter and exact.
"""


class XRule(StrEnum):
    """Which way x points along a common normal."""

    AUTO = "auto"  # away from the axis before it, unless the other way saves theta a half turn
    AWAY = "away"  # away from the axis before it, always: a >= 0, as in the notes


class Reference(NamedTuple):
    """Where the arm is on each axis: heights along z in the joint frames [m], and its size."""

    heights: tuple[float, ...]
    size: float


@dataclass(frozen=True)
class Assignment:
    """The frames, as factors: all of a DH table but its names.

    ``pairs``, ``normals`` and ``compact`` have n - 1 entries, ``theta`` and ``d`` have n.
    """

    convention: DHConvention
    start: Start
    end: End
    base: Array
    theta: tuple[float, ...]
    d: tuple[float, ...]
    pairs: tuple[AxisPair, ...]
    normals: tuple[Normal, ...]
    compact: tuple[bool, ...]
    size: float

    @property
    def n(self) -> int:
        """Number of joints."""
        return len(self.theta)

    @property
    def lengths(self) -> tuple[float, ...]:
        """Every length of the table, base and tool, by which tables are called simple."""
        between = tuple(n.a for n in self.normals)
        base, tool = self.base[:3, 3], self.end.tool[:3, 3]
        ends = (*map(float, base), *map(float, tool), self.start.a, self.end.a)
        return (*self.d, *between, *ends)


def references(links: Array) -> Reference:
    """Walk from the base to the tool, each time to the nearest point of the next axis.

    Tells where the arm stands, whatever far-away origins a file gives its joints.
    """
    heights = [float(tf.inverse(links[0])[2, 3])]
    size = 0.0
    for L in links[1:]:
        inv = tf.inverse(L)
        x, y, z = (float(v) for v in inv[:3, 2] * heights[-1] + inv[:3, 3])
        last = len(heights) == len(links) - 1
        size += math.hypot(x, y, z) if last else math.hypot(x, y)
        heights.append(z)
    return Reference(tuple(heights[:-1]), max(size, 1e-9))


def assign_frames(
    links: Array,
    convention: DHConvention,
    *,
    prismatic: Sequence[bool] = (),
    x_rule: XRule = XRule.AUTO,
    compact: bool = True,
    size: float | None = None,
) -> Assignment:
    """Assign all frames of a chain.

    Parameters
    ----------
    links : array, shape (n + 1, 4, 4)
        Constant transforms of a :class:`~dh2urdf.chain.SerialChain`.
    prismatic : sequence of n bool, optional
        True where a joint slides; none does where left out.
    compact : bool
        Slide the frames of pairs whose common normal is :data:`FAR` away back to the arm and
        leave the rest to one rotation ``beta``.
    size : float, optional
        Length of the arm [m], where it is not to be measured on these links.
    """
    ref = references(links)
    if size is not None:
        ref = ref._replace(size=size)
    start = first_frame(links[0], convention, ref.size)
    pairs = [classify(L, ref.size) for L in links[1:-1]]
    normals: list[Normal] = []
    slid = []
    s = start.s
    for i, pair in enumerate(pairs):
        normal, near = _normal(links[i + 1], pair, i, ref, s, convention, compact)
        normals.append(normal)
        slid.append(near)
        s = normal.s2
    n = len(links) - 1
    own = _own_height(ref, n - 1, s)
    ends = EndPlacer(links[-1], convention, own, ref.size)
    turns = tuple(prismatic) or (False,) * n
    path = choose_directions(start.phi, pairs, normals, ends, turns, x_rule is XRule.AWAY)
    base, theta = start.base, list(path.theta)
    d = [a + b for a, b in zip(_before(start.s, path.normals), _after(path), strict=True)]
    if base is None:
        base = links[0] @ slide_turn(theta[0], d[0])
        theta[0] = d[0] = 0.0
    return Assignment(
        convention,
        start,
        path.end,
        base,
        tuple(theta),
        tuple(d),
        tuple(pairs),
        path.normals,
        tuple(slid),
        ref.size,
    )


def _before(s: float | None, normals: Sequence[Normal]) -> list[float]:
    """Slide along each axis that the pair before it leaves [m]."""
    return [s or 0.0, *(normal.s2 for normal in normals)]


def _after(path: Directions) -> list[float]:
    """Slide along each axis to the foot of the pair after it [m]."""
    return [*(normal.s1 for normal in path.normals), path.end.s1]


def _own_height(ref: Reference, i: int, s: float | None) -> float:
    """Height of joint i's own origin, or of a point nearby where that is far off the arm."""
    if abs(ref.heights[i]) <= FAR * ref.size:
        return 0.0
    return ref.heights[i] if s is None else -s


def _normal(
    L: Array,
    pair: AxisPair,
    i: int,
    ref: Reference,
    s: float | None,
    convention: DHConvention,
    compact: bool,
) -> tuple[Normal, bool]:
    """The common normal of pair i, and whether it stands in for one far away."""
    if not pair.parallel:
        normal = common_normal(L, pair)
        reach = max(abs(normal.s1 - ref.heights[i]), abs(-normal.s2 - ref.heights[i + 1]))
        if not compact or reach <= FAR * ref.size:
            return normal, False
    height = _own_height(ref, i, s) if i == 0 or s is None else -s
    return across(L, pair, height, 0.0, convention), not pair.parallel
