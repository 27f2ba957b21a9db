"""Frame assignment: lecture notes section 4, from the joint axes to the DH parameters.

The chain is ``B Z_1(q1) L_1 Z_2(q2) ... L_{n-1} Z_n(qn) M``. Every ``L_i`` is factored along a
common normal (:mod:`dh2urdf.conversions.assign.axis_pairs`); the turns and slides about one axis,
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

import math
from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from functools import partial
from typing import NamedTuple

from dh2urdf import transforms as tf
from dh2urdf.conversions.assign.axis_pairs import AxisPair, Normal, across, classify, common_normal
from dh2urdf.conversions.assign.frame_directions import Ends, choose_directions
from dh2urdf.conversions.assign.frame_ends import End, Start, first_frame, last_frames, slide_turn
from dh2urdf.dh import DHConvention
from dh2urdf.transforms import Array

FAR = 20.0
"""Common normals farther off than this many arm's lengths are not gone to.

A calibrated arm whose parallel axes are off by a milliradian meets its common normal hundreds
of metres away, and each of those metres costs a digit; below two degrees or so of tilt a table
with one extra rotation is shorter and exact.
"""

NEARLY = 0.02
"""Tilt [rad] below which axes were meant to be parallel: more than any calibration corrects."""

FAR_NEARLY = 2.0
"""Like :data:`FAR`, for axes that are nearly parallel: their common normal means nothing."""


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


class FrameAssigner:
    """Assigns all frames of a chain; what it found of a link it keeps.

    Parameters
    ----------
    links : array, shape (n + 1, 4, 4)
        Constant transforms of a :class:`~dh2urdf.chain.SerialChain`.
    prismatic : sequence of n bool
        True where a joint slides.
    compact : bool
        Slide the frames of pairs whose common normal is far away back to the arm and leave the
        rest to one rotation ``beta``.
    """

    def __init__(
        self,
        links: Array,
        convention: DHConvention,
        *,
        prismatic: Sequence[bool],
        x_rule: XRule = XRule.AUTO,
        compact: bool = True,
    ) -> None:
        self.links, self.convention, self.compact = links, convention, compact
        self.prismatic, self.strict = tuple(prismatic), x_rule is XRule.AWAY
        self.ref = references(links)
        self._known: dict[bytes, tuple[AxisPair, Normal | None]] = {}

    def assign(self, links: Array) -> Assignment:
        """The frames of the chain, the axes of its sliding joints where ``links`` have them."""
        start, ends, pairs, normals, slid = self._place(links)
        path, end = choose_directions(start.phi, pairs, normals, ends, self.prismatic, self.strict)
        base, theta, d = start.base, list(path.theta), _offsets(start, path.normals, end)
        if base is None:
            base = links[0] @ slide_turn(theta[0], d[0])
            theta[0] = d[0] = 0.0
        parts = tuple(theta), tuple(d), tuple(pairs), path.normals, tuple(slid)
        return Assignment(self.convention, start, end, base, *parts, self.ref.size)

    def lengths(self, links: Array) -> tuple[float, ...]:
        """Every length of the table, base and tool, by which tables are called simple."""
        start, ends, _, normals, _ = self._place(links)
        end = ends(0.0)[0]
        d = _offsets(start, normals, end)
        base = start.base
        if base is None:
            base = links[0] @ slide_turn(0.0, d[0])
            d[0] = 0.0
        between = (normal.a for normal in normals)
        return (*d, *between, *base[:3, 3], *end.tool[:3, 3], start.a, end.a)

    def _place(self, links: Array) -> tuple[Start, Ends, list[AxisPair], list[Normal], list[bool]]:
        """Everything but the directions of x, which do not bear on any length."""
        start = first_frame(links[0], self.convention, self.ref.size)
        pairs, normals, slid = [], [], []
        s = start.s
        for i, L in enumerate(links[1:-1]):
            pair, normal, near = self._normal(L, i, s)
            pairs.append(pair)
            normals.append(normal)
            slid.append(near)
            s = normal.s2
        own = self._own_height(len(links) - 2, s)
        ends = partial(last_frames, links[-1], self.convention, own, self.ref.size)
        return start, ends, pairs, normals, slid

    def _normal(self, L: Array, i: int, s: float | None) -> tuple[AxisPair, Normal, bool]:
        """The common normal of pair i, and whether it stands in for one far away."""
        key = L.tobytes()
        if key not in self._known:
            pair = classify(L, self.ref.size)
            self._known[key] = pair, None if pair.parallel else common_normal(L, pair)
        pair, normal = self._known[key]
        if normal is not None:
            heights = self.ref.heights
            reach = max(abs(normal.s1 - heights[i]), abs(-normal.s2 - heights[i + 1]))
            limit = (FAR_NEARLY if pair.tilt < NEARLY else FAR) * self.ref.size
            if not self.compact or reach <= limit:
                return pair, normal, False
        height = self._own_height(i, s) if i == 0 or s is None else -s
        return pair, across(L, pair, height, 0.0, self.convention), not pair.parallel

    def _own_height(self, i: int, s: float | None) -> float:
        """Height of joint i's own origin, or of a point nearby where that is far off the arm."""
        if abs(self.ref.heights[i]) <= FAR * self.ref.size:
            return 0.0
        return self.ref.heights[i] if s is None else -s


def _offsets(start: Start, normals: Sequence[Normal], end: End) -> list[float]:
    """Each joint's d [m]: the slides along its axis that the pairs before and after it leave."""
    before = [start.s or 0.0, *(normal.s2 for normal in normals)]
    after = [*(normal.s1 for normal in normals), end.s1]
    return [a + b for a, b in zip(before, after, strict=True)]
