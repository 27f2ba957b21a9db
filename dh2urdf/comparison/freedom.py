"""What is still free once the first joint axes of two arms lie on each other.

The axes after joint i of the second arm may yet be moved by every motion that leaves the axes up
to i where they are: of the whole arm (then of its base), or of a joint j <= i that the axes
behind it do not feel (then the zero of j is another). Together that is a turn about at most one
axis and slides.
"""

from typing import NamedTuple

import numpy as np

from dh2urdf.chain import SerialChain
from dh2urdf.transforms import Array, dot


class Freedom(NamedTuple):
    """The motions left; each with the joint that makes it, None for the base.

    ``turn`` is a line ``(axis, point, joint)``; ``slides`` are ``(direction, joint)``.
    """

    turn: tuple[Array, Array, int | None] | None
    slides: list[tuple[Array, int | None]]


class Axes:
    """Joint axes of an arm at q = 0, and which of them are parallel or one line.

    Parameters
    ----------
    chain : SerialChain
    slack : float
        Angle [rad], and distance in arm's sizes, up to which two axes count as such.
    """

    def __init__(self, chain: SerialChain, slack: float) -> None:
        self.u, self.p, self.prismatic = chain.axes, chain.points, chain.prismatic
        self.slack, self.size, self.length = slack, chain.size, slack * chain.size
        sine = np.linalg.norm(np.cross(self.u[:, None], self.u[None]), axis=-1)
        between = self.p[None] - self.p[:, None]
        off = between - self.u[:, None] * dot(between, self.u[:, None])[..., None]
        self.parallel = sine <= slack
        self.one_line = self.parallel & (np.linalg.norm(off, axis=-1) <= self.length)

    def freedom(self, placed: int) -> Freedom:
        """What is free behind the first ``placed`` axes, which is at least one."""
        turn: tuple[Array, Array, int | None] | None = None
        slides: list[tuple[Array, int | None]] = []
        kept = self.prismatic[:placed]
        for j in reversed(range(placed)):
            slides_on, one_line = (m[j, j + 1 : placed] for m in (self.parallel, self.one_line))
            behind = kept[j + 1 :]
            if kept[j] and np.all(behind | slides_on):
                slides.append((self.u[j], j))
            elif not kept[j] and turn is None and np.all(np.where(behind, slides_on, one_line)):
                turn = self.u[j], self.p[j], j
        turning = np.flatnonzero(~kept)
        if turning.size == 0:
            slides += [(x, None) for x in np.eye(3)]
            if self.parallel[0, :placed].all():
                turn = self.u[0], self.p[0], None
        elif self.parallel[turning[0], turning].all():
            slides.append((self.u[turning[0]], None))
        return Freedom(turn, slides)
