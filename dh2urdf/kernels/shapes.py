"""Kinds and shapes of the arrays that entries take: names of lengths stand for any number.

The ``n`` joints of a chain, ``poses`` of a batch, ``solutions`` for which there is room.
"""

from typing import Annotated, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

Floats: TypeAlias = NDArray[np.float64]
Integers: TypeAlias = NDArray[np.int64]
Flags: TypeAlias = NDArray[np.bool_]

Pose: TypeAlias = Annotated[Floats, 4, 4]
Poses: TypeAlias = Annotated[Floats, "poses", 4, 4]
Three: TypeAlias = Annotated[Floats, 3]

Links: TypeAlias = Annotated[Floats, "n + 1", 4, 4]
"""``T_base_tool = links[0] Z_1(q_1) links[1] ... Z_n(q_n) links[n]``."""

Joints: TypeAlias = Annotated[Floats, "n", 3]
"""A row a joint: 1.0 where it slides, lower bound, upper bound."""

Rows: TypeAlias = Annotated[Floats, "n", 7]
"""A row a joint: a, cos alpha, sin alpha, d, offset, its sine, sign of the joint."""

Ends: TypeAlias = Annotated[Floats, 3, 4, 4]
"""From base to the first row's frame and from the last to the tool, both inverse; the tool."""

Configuration: TypeAlias = Annotated[Floats, "n"]
Configurations: TypeAlias = Annotated[Floats, "poses", "n"]
Some: TypeAlias = Annotated[Floats, "solutions", "n"]
"""Configurations, one a row."""

References: TypeAlias = Annotated[Floats, "references", "n"]
Flagged: TypeAlias = Annotated[Flags, "solutions"]
Square: TypeAlias = Annotated[Floats, "n", "n"]
Lattice: TypeAlias = Annotated[Floats, "points", "n"]
Bounds: TypeAlias = Annotated[Floats, "n", 7]

Sizes: TypeAlias = Annotated[Floats, "solutions"]
Masks: TypeAlias = Annotated[Integers, "solutions"]

Solutions: TypeAlias = Annotated[Floats, "poses", "solutions", "n"]
Values: TypeAlias = Annotated[Floats, "poses", "solutions"]
Codes: TypeAlias = Annotated[Integers, "poses", "solutions"]
Counts: TypeAlias = Annotated[Integers, "poses"]
Slides: TypeAlias = Annotated[Flags, "n"]
"""Whether each joint slides."""

Held: TypeAlias = Annotated[Floats, "poses"]
"""Values of the held joint."""


class Chain(NamedTuple):
    """A serial chain: its links, the kinds and limits of its joints."""

    links: Links
    joints: Joints


class AnyChain(NamedTuple):
    """A serial chain whose joints may follow its values: its links, kinds and limits of the values.

    Where joints follow, there are as many rows more as joints: the value that moves it, by how much
    a joint moves for one of it, 1.0 where the joint slides.
    """

    links: Annotated[Floats, "frames", 4, 4]
    joints: Annotated[Floats, "moves", 3]


class Found(NamedTuple):
    """Solutions of one pose: a row of `Outputs`, without their number."""

    q: Some
    residual: Sizes
    branch: Masks
    free: Masks


class Goal(NamedTuple):
    """What a chain is asked for: a task of :mod:`dh2urdf.kernels.newton.damped` at a pose.

    Errors of the position count in parts of ``unit``, a length of the arm's size [m].
    """

    task: int
    T: Pose
    unit: float


class ClosedForm(NamedTuple):
    """An arm with a closed form: its chain, its Denavit-Hartenberg rows, how far rims reach."""

    chain: Chain
    form: Rows
    ends: Ends
    slack: float


class Together(NamedTuple):
    """Values q that move joints x together, ``x = matrix @ q + offset``, as many as these.

    Attributes
    ----------
    matrix, inverse : array, shape (n, n)
    offset : array, shape (n,)
    loose : array, shape (n, 3)
        Kinds and limits of the values that move one joint alone; the others as slides without.
    ends : array, shape (n, 7)
        Of the others: 1.0, bounds of the value, bounds of the joint, whether the joint turns,
        whether the value is held.
    turns, ways : array, shape (points, n)
        Turns of the joints, and what the values do then.
    """

    matrix: Square
    inverse: Square
    offset: Configuration
    loose: Joints
    ends: Bounds
    turns: Lattice
    ways: Lattice


DULL = 1e-13
"""Residual [m and rad] above which an isolated solution may be a point of a valley: where there is
no room for all, those that are less come first, then members of families, then those."""


class Outputs(NamedTuple):
    """Solutions of m poses, a row for each.

    Attributes
    ----------
    q : array, shape (m, kmax, n)
        Solutions in the first ``counts[i]`` rows; the others may hold anything.
    residual : array, shape (m, kmax)
    counts : int64 array, shape (m,)
    branch : int64 array, shape (m, kmax)
        Bits of the branch; -1 where the family has none.
    free : int64 array, shape (m, kmax)
        Bits of the joints that are free along a singular family.
    """

    q: Solutions
    residual: Values
    counts: Counts
    branch: Codes
    free: Codes

    @classmethod
    def of(cls, m: int, kmax: int, n: int) -> "Outputs":
        """Arrays for m poses, nothing in them, of one piece of memory that nobody has touched."""
        whole, k = np.zeros(m * (kmax * (n + 3) + 1)), m * kmax
        q, rest = whole[: k * n].reshape(m, kmax, n), whole[k * n : k * (n + 3)]
        residual, *codes = rest.reshape(3, m, kmax)
        branch, free = (code.view(np.int64) for code in codes)
        return cls(q, residual, whole[k * (n + 3) :].view(np.int64), branch, free)

    def put(self, index: Integers, other: "Outputs") -> None:
        """Put those of other arrays, with as many rows a pose or more, in place of some poses.

        If not all fit, the last by :data:`DULL` are left out.
        """
        k, width = self.q.shape[1], other.q.shape[1]
        if (other.counts > k).any():
            dull = np.where(other.residual > DULL, other.residual, 0.0)
            dull[other.free != 0] = DULL
            dull[np.arange(width) >= other.counts[:, None]] = np.inf
            rows = np.sort(np.argsort(dull, axis=1, kind="stable")[:, :k], axis=1)
            every = np.arange(len(rows))[:, None]
            other = Outputs._make(x[every, rows] if x.ndim > 1 else x for x in other)
        for whole, part in zip(self, other, strict=True):
            whole[index] = part[:, :k] if part.ndim > 1 else np.minimum(part, k)

    def rows(self, index: slice | Integers) -> "Outputs":
        """Those of some poses: views by a slice, copies by indices."""
        return Outputs._make(array[index] for array in self)
