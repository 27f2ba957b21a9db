"""What the axes of a chain do: parallel, intersecting, through one point; and the DH form.

The joint axes at q = 0 are lines. Where two neighbours are parallel or meet within a tolerance
they are snapped, and the Denavit-Hartenberg form of the snapped lines has exact zeros there,
which is what the closed forms are written in. The residual is always measured on the exact chain.
"""

import math
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray

from dh2urdf.chain import SerialChain
from dh2urdf.ik.arm.shared_tolerances import EXACT, FORM_ERROR, SNAP
from dh2urdf.kernels.axis_lines import CENTRAL, MEETING, PARALLEL, dh_frames, snap_lines
from dh2urdf.kernels.chain import chain_fk_batch
from dh2urdf.kernels.numbers import atan2, hypot, sincos
from dh2urdf.transforms import Array, cross, inverted, length, pose_error, product


@dataclass(frozen=True, eq=False)
class AxisLines:
    """The joint axes at q = 0 in base, snapped to what they nearly are.

    Parameters
    ----------
    chain : SerialChain
    tolerance : float
        Angle [rad] and length relative to ``chain.size`` that is snapped.
    """

    chain: SerialChain
    tolerance: float = SNAP

    @cached_property
    def length(self) -> float:
        """Length that counts as zero [m]."""
        return self.tolerance * self.chain.size

    @property
    def signs(self) -> Array:
        """-1 where a line points against its joint: parallel neighbours point one way, (n,)."""
        return self._snapped[2]

    @property
    def axes(self) -> Array:
        """Unit directions, shape (n, 3); parallel neighbours are equal."""
        return self._snapped[0]

    @property
    def points(self) -> Array:
        """A point on each line [m], shape (n, 3): the foot of the normal from the line before.

        A sliding joint has a direction only: its line goes through the point before it.
        """
        return self._snapped[1]

    @property
    def ties(self) -> NDArray[np.int64]:
        """What each line does with those that follow, bits of the kernel, shape (n,)."""
        return self._snapped[3]

    @cached_property
    def _snapped(self) -> tuple[Array, Array, Array, NDArray[np.int64]]:
        chain, n = self.chain, self.chain.n
        found = np.empty((n, 3)), np.empty((n, 3)), np.empty(n), np.empty(n, np.int64)
        slides = np.ascontiguousarray(chain.prismatic)
        snap_lines(chain.joint_frames, slides, self.tolerance, self.length, *found)
        return found

    def parallel(self, i: int) -> bool:
        """Whether lines i and i + 1 are parallel."""
        return bool(self.ties[i] & PARALLEL)

    def meet(self, i: int) -> bool:
        """Whether lines i and i + 1 have exactly one point in common."""
        return bool(self.ties[i] & MEETING)

    def spherical(self, i: int) -> bool:
        """Whether three revolute joints from i on have axes through one point."""
        return bool(self.ties[i] & CENTRAL)

    def three_parallel(self, i: int) -> bool:
        """Whether three revolute joints from i on have parallel axes."""
        turning = not self.chain.prismatic[i : i + 3].any()
        return turning and self.parallel(i) and self.parallel(i + 1)

    def describe(self) -> str:
        """Say in one line what neighbours do: ``1 meets 2, 2 || 3, ...`` (skew ones left out)."""
        words = []
        for i in range(self.chain.n - 1):
            if self.parallel(i):
                words.append(f"{i + 1} || {i + 2}")
            elif self.meet(i):
                words.append(f"{i + 1} meets {i + 2}")
        return ", ".join(words) or "all neighbouring axes are skew"


@lru_cache(maxsize=8)
def lines_of(chain: SerialChain, tolerance: float = SNAP) -> AxisLines:
    """The lines of a chain, which its families ask for one after the other."""
    return AxisLines(chain, tolerance)


@lru_cache(maxsize=8)
def form_of(chain: SerialChain, tolerance: float = SNAP) -> "DHForm":
    """The form of :func:`lines_of`."""
    return DHForm(lines_of(chain, tolerance))


@dataclass(frozen=True, eq=False)
class DHForm:
    """Snapped lines as standard Denavit-Hartenberg rows between a base and a tool transform.

    ``T_base_tool = base prod_i Rot_z(t_i) Trans_z(d_i) Trans_x(a_i) Rot_x(alpha_i) tool`` with
    ``t_i = sign_i q_i + theta_i`` (revolute) or ``d_i = sign_i q_i + d_i`` (prismatic).
    """

    lines: AxisLines

    @cached_property
    def frames(self) -> Array:
        """DH frames 0 ... n - 1 at q = 0 in base, z_i along line i, shape (n, 4, 4)."""
        lines = self.lines
        frames = np.empty((lines.chain.n, 4, 4))
        dh_frames(lines.axes, lines.points, lines.ties, lines.length, frames)
        return frames

    @cached_property
    def rows(self) -> Array:
        """Rows of a, cos alpha, sin alpha, d, theta, sliding, sign; shape (n, 7)."""
        lines, chain, frames = self.lines, self.lines.chain, self.frames
        rows = np.zeros((chain.n, 7))
        rows[:, 1], rows[:, 5], rows[:, 6] = 1.0, chain.prismatic, lines.signs
        steps = product(inverted(frames[:-1]), frames[1:])
        for i, (x, y, z, _) in enumerate(steps.tolist()):
            theta = atan2(y[0], x[0])
            sine, cosine = sincos(theta)
            a = cosine * x[3] + sine * y[3]
            ca, sa = (1.0, 0.0) if lines.parallel(i) else _unit(z[2], z[1])
            rows[i, :5] = a if abs(a) > lines.length else 0.0, ca, sa, z[3], theta
        rows[np.abs(rows[:, 3]) <= 1e-15 * chain.size, 3] = 0.0
        return rows

    @cached_property
    def tool(self) -> Array:
        """``T_dhn_tool``; frame n is frame n - 1 at q = 0, shape (4, 4)."""
        return product(inverted(self.frames[-1]), self.lines.chain.tool)

    @cached_property
    def ends(self) -> Array:
        """Inverse of base, inverse of tool, tool; shape (3, 4, 4): what the kernels need."""
        return np.stack([inverted(self.frames[0]), inverted(self.tool), self.tool])

    @cached_property
    def links(self) -> Array:
        """The snapped arm as links between z axes, shape (n + 1, 4, 4)."""
        motions = [row_motion(row, 0.0) for row in self.rows]
        return np.stack([self.frames[0], *motions[:-1], product(motions[-1], self.tool)])

    def fk(self, q: Array) -> Array:
        """Forward kinematics of the snapped arm at q (m, n), shape (m, 4, 4)."""
        T = np.empty((len(q), 4, 4))
        chain_fk_batch(self.links, self.lines.chain.prismatic, q * self.lines.signs, T)
        return T

    @cached_property
    def error(self) -> float:
        """Largest difference from the exact chain over a few configurations [m and rad]."""
        chain = self.lines.chain
        draws = np.random.default_rng(0).uniform(-3.0, 3.0, (8, chain.n))
        T = np.empty((len(draws), 4, 4))
        chain_fk_batch(chain.links, chain.prismatic, draws, T)
        return pose_error(self.fk(draws), T)

    @property
    def exact(self) -> bool:
        """Whether the snapped arm is the exact one up to rounding."""
        return self.error <= FORM_ERROR * max(1.0, self.lines.chain.size)


def row_motion(row: Array, q: float) -> Array:
    """The displacement of a row of :class:`DHForm` with its joint at q, shape (4, 4)."""
    a, ca, sa, d, theta, slides, sign = row
    t, s = (theta, sign * q + d) if slides else (sign * q + theta, d)
    st, ct = sincos(t)
    return np.array(
        [
            [ct, -st * ca, st * sa, a * ct],
            [st, ct * ca, -ct * sa, a * st],
            [0.0, sa, ca, s],
            [0.0, 0.0, 0.0, 1.0],
        ]
    )


def _unit(c: float, s: float) -> tuple[float, float]:
    """Cosine and sine on the unit circle, right angles exact."""
    if abs(c) <= EXACT:
        return 0.0, math.copysign(1.0, s)
    if abs(s) <= EXACT:
        return math.copysign(1.0, c), 0.0
    r = hypot(c, s)
    return c / r, s / r


def pose_along(x: Array, z: Array, origin: Array) -> Array:
    """Frame with the given z, the direction of x, and origin, shape (4, 4)."""
    T = np.eye(4)
    x = x / length(x)
    T[:3, 0], T[:3, 1], T[:3, 2], T[:3, 3] = x, cross(z, x), z, origin
    return T
