"""Full turns of joints that move together: which turns of the joints put the values inside limits.

A turn of joint j adds ``2 pi inverse[:, j]`` to the values, so that those of joints that move
together form a lattice; what a reference and the limits can mean of it is listed once, and the
nearest point inside the limits is chosen. All other joints are turned one by one.
"""

import itertools
import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from dh2urdf.chain import Coupling, SerialChain
from dh2urdf.dh import JointType
from dh2urdf.ik.arm import LIMIT_SLACK, TWO_PI, middle, seed_gaps, turn_counts
from dh2urdf.kernels.certificate import turn_together
from dh2urdf.kernels.shapes import Together
from dh2urdf.transforms import Array

Bools = NDArray[np.bool_]

WOUND = 16
"""Turns either way of a joint that moves together with others, of those that limits allow."""

POINTS = 50_000
"""Points of the lattice that are gone through; with many joints together fewer turns are."""


class TurnsTogether:
    """Turns of the joints of a square coupling.

    Parameters
    ----------
    coupling : Coupling
    values, joints : SerialChain
        With the limits of the values, and of the joints themselves.
    held, still : tuple of int
        Values that are held, and the joints that do not turn then.

    Attributes
    ----------
    block : int array
        Values that do not move one joint alone, which are the joints that they move.
    mask : int
        The same as bits.
    loose : SerialChain
        The values, those of the block as slides without limits.
    centre : array, shape (n,)
        Middle of the limits.
    """

    def __init__(
        self,
        coupling: Coupling,
        values: SerialChain,
        joints: SerialChain,
        held: tuple[int, ...] = (),
        still: tuple[int, ...] = (),
    ) -> None:
        assert coupling.inverse is not None
        n, every = coupling.n, np.arange(coupling.n)
        alone = (coupling.matrix == np.eye(n)).all(axis=0) & (coupling.offset == 0.0)
        alone &= (coupling.matrix == np.eye(n)).all(axis=1)
        self.block = every[~alone]
        self.mask = sum(1 << i for i in self.block.tolist())
        far, kinds = np.where(alone, 0.0, np.inf), zip(alone, values.joint_types, strict=True)
        self.loose = replace(
            values,
            joint_types=tuple(kind if one else JointType.PRISMATIC for one, kind in kinds),
            lower=values.lower - far,
            upper=values.upper + far,
        )
        self.coupling, self.values, self.centre = coupling, values, middle(values)
        self._turning = ~alone & ~joints.prismatic & ~np.isin(every, still)
        self._step = TWO_PI * coupling.inverse * self._turning
        self._bounded = np.isfinite(values.lower) & np.isfinite(values.upper) | alone
        slack = LIMIT_SLACK * (1.0 + np.abs(coupling.matrix).sum(axis=1))
        bounds = values.lower, values.upper, joints.lower - slack, joints.upper + slack
        flags = self._turning, np.isin(every, held)
        self._ends = np.column_stack([~alone, *bounds, *flags]).astype(float)
        self.about_centre = self._together(self.centre, self.centre)
        self.anywhere = self._together(values.lower, values.upper)

    def _together(self, first: Array, last: Array) -> Together:
        """What kernels take, with all turns that limits allow from references between two."""
        given = self.coupling.matrix, self.coupling.inverse, self.coupling.offset
        points = self._points(self._window(first, last))
        loose = np.column_stack([self.loose.prismatic, self.loose.lower, self.loose.upper])
        arrays = (*given, loose, self._ends, *points)
        return Together._make(np.ascontiguousarray(array, float) for array in arrays)

    def _window(self, first: Array, last: Array) -> tuple[Array, Array]:
        """Least and largest way of each value to the limits from references between two."""
        near = 0.5 * np.abs(self._step).sum(axis=1)  # of the lattice to any reference
        with np.errstate(invalid="ignore"):
            low = np.where(self._bounded, self.values.lower - last, -near) - near
            high = np.where(self._bounded, self.values.upper - first, near) + near
        return low - 1e-9, high + 1e-9

    def _points(self, window: tuple[Array, Array]) -> tuple[Array, Array]:
        """Turns (t, n) of the joints, and ways (t, n) of the values in a window, shortest first."""
        b = self.block
        low, high = (end[b] for end in window)
        matrix, step = self.coupling.matrix[np.ix_(b, b)], self._step[np.ix_(b, b)]
        ends = np.sort([matrix * low, matrix * high], axis=0).sum(axis=2) / TWO_PI
        first, last = np.where(self._turning[b], [np.ceil(ends[0]), np.floor(ends[1])], 0.0)
        most = float(WOUND)
        while most > 1 and (np.minimum(last, most) - np.maximum(first, -most) + 1).prod() > POINTS:
            most -= 1
        each = zip(np.maximum(first, -most), np.minimum(last, most), strict=True)
        turns = np.array(list(itertools.product(*(np.arange(a, z + 1) for a, z in each))))
        ways = turns @ step.T
        kept = ((ways >= low) & (ways <= high)).all(axis=1)
        order = np.argsort(np.linalg.norm(ways[kept], axis=1), kind="stable")
        out = np.zeros((2, int(kept.sum()), len(self.centre)))
        out[:, :, b] = turns[kept][order], ways[kept][order]
        return out[0], out[1]

    def nearest(self, joints: Array, reference: Array) -> tuple[Array, Bools]:
        """Values (..., n) of joints (..., n) in the turns nearest to a reference; which are inside.

        A turn inside the limits goes before a nearer one outside. The reference (..., n) is
        broadcast to the same shape.
        """
        shape = np.broadcast_shapes(joints.shape, reference.shape)
        q = np.array(np.broadcast_to(joints, shape), float, order="C")
        goal = reference if reference.ndim == 1 else np.broadcast_to(reference, shape)
        inside = np.empty(math.prod(shape[:-1]), np.bool_)
        turn_together(
            self.about_centre if reference is self.centre else self.anywhere,
            LIMIT_SLACK,
            np.ascontiguousarray(goal).reshape(-1, shape[-1]),
            q.reshape(-1, shape[-1]),
            inside,
        )
        return q, inside.reshape(shape[:-1])

    def _every(self, q: Array, goal: Array) -> tuple[Array, Bools]:
        """Values (t, n) in turns of the block about a goal (n,), and which are inside limits."""
        joints = self.coupling.joints(q)
        ask = np.rint((self.coupling.joints(goal) - joints) / TWO_PI) * self._turning
        turns, ways = ask + self.anywhere.turns, ask @ self._step.T + self.anywhere.ways
        every, moved = q + ways, joints + TWO_PI * turns
        lower, upper, least, most = self._ends[:, 1:5].T
        within = (every >= lower - LIMIT_SLACK) & (every <= upper + LIMIT_SLACK)
        within &= (moved >= least) & (moved <= most)
        return every, within[:, self.block].all(axis=1)

    def options(self, q: Array) -> Array:
        """Values q (n,) in every turn of the block inside the limits, shape (k, n).

        A value without both bounds has infinitely many turns; it keeps the one it has.
        """
        every, within = self._every(q, np.clip(q, self.values.lower, self.values.upper))
        within &= (self._bounded | (np.abs(every - q) < 1e-9)).all(axis=1)
        kept = every[within]
        on = np.clip(kept, self.values.lower, self.values.upper)
        return np.where(np.abs(on - kept) <= LIMIT_SLACK, on, kept)

    def counts(self, q: Array) -> Array:
        """How many turns of configurations q (k, n) are inside the limits, shape (k,)."""
        together = np.array([len(self.options(row)) for row in q], float)
        counts: Array = together * turn_counts(self.loose, q)
        return counts

    def gaps(self, q: Array, seed: Array) -> Array:
        """How far each value of q (k, n) is from a seed (n,), turns of joints aside, (k, n)."""
        out, block = seed_gaps(self.loose, q, seed), self.block
        for k, row in enumerate(q):
            ways = self._every(row, seed)[0][:, block] - seed[block]
            out[k, block] = np.abs(ways[np.square(ways).sum(axis=1).argmin()])
        return out
