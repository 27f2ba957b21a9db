"""How one arm follows from another, and by how much it misses."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from dh2urdf.chain import SerialChain
from dh2urdf.kernels.chain import chain_fk_batch
from dh2urdf.transforms import Array, inverse, product, rot_z, trans

NOTHING = 1e-9
"""Angle [rad] and length [arm's sizes] of a base, tool or offset that is none."""


CONFIGURATIONS = 64
"""Configurations at which arms are compared, q = 0 among them."""


def poses(chain: SerialChain, qs: Array) -> Array:
    """``T_base_tool`` at configurations (m, n), shape (m, 4, 4)."""
    T = np.empty((len(qs), 4, 4))
    chain_fk_batch(chain.links, chain.prismatic, np.ascontiguousarray(qs), T)
    return T


@dataclass(frozen=True, eq=False)
class Relation:
    """``T_A(q) = base T_B(directions * q + offsets) tool``.

    Parameters
    ----------
    base, tool : array, shape (4, 4)
    directions : array of +1 and -1, shape (n,)
    offsets : array, shape (n,)
        [rad] or [m].
    """

    base: Array
    tool: Array
    directions: Array
    offsets: Array

    @classmethod
    def none(cls, n: int) -> "Relation":
        """Two arms that are one."""
        return cls(np.eye(4), np.eye(4), np.ones(n), np.zeros(n))

    def configurations(self, qs: Array) -> Array:
        """q of B for q of A, shape (m, n)."""
        return qs * self.directions + self.offsets

    def poses(self, b: SerialChain, qs: Array) -> Array:
        """``T_A`` at q of A (m, n) as B makes it, shape (m, 4, 4)."""
        return product(self.base, poses(b, self.configurations(qs)), self.tool)

    def with_tool(self, a: SerialChain, b: SerialChain) -> "Relation":
        """The same with the tool that makes the two agree at q = 0."""
        T_b = product(self.base, b.fk(self.offsets))
        return replace(self, tool=product(inverse(T_b), a.tool))

    def simplest(self, a: SerialChain, b: SerialChain, slack: float) -> "Relation":
        """The same with base and tool in the zeros of the first and last joint, or these in those.

        Where a joint's own motion is all that the base does, its zero says so; where the base
        does more, the zero of joint 1 is left as it is. Likewise joint n and the tool.
        """
        length, offsets, base = slack * max(a.size, b.size), self.offsets.copy(), self.base
        first = b.links[0]
        turned = product(inverse(first), base, first, _motion(b, 0, offsets[0]))
        own = _own_motion(b, 0, turned, slack, length)
        offsets[0] = 0.0 if own is None else own
        left = turned if own is None else np.eye(4)
        base = product(first, left, inverse(first))
        before = replace(self, base=base, offsets=offsets)
        offsets = offsets.copy()
        offsets[-1] = 0.0
        bare = replace(before, offsets=offsets).with_tool(a, b)
        last = b.links[-1]
        turned = product(last, bare.tool, inverse(last))
        own = _own_motion(b, b.n - 1, turned, slack, length)
        if own is None:
            return bare
        offsets = offsets.copy()
        offsets[-1] = own
        return replace(bare, offsets=offsets, tool=np.eye(4))

    def wrapped(self, b: SerialChain) -> "Relation":
        """The same with offsets of turning joints in (-pi, pi]."""
        turned = [
            x if slides else math.pi - (math.pi - x) % (2 * math.pi)
            for x, slides in zip(self.offsets.tolist(), b.prismatic, strict=True)
        ]
        return replace(self, offsets=np.array(turned))

    def cost(self, tolerance: float, base: float = 2.0, tool: float = 2.0) -> float:
        """How much has to be said of it: a joint counts one, base and tool as given."""
        changed = (np.abs(self.offsets) > tolerance).sum() + (self.directions < 0).sum()
        steps = ((self.base, base), (self.tool, tool))
        moved = sum(weight for T, weight in steps if not is_none(T, tolerance))
        return float(changed + moved)


def is_none(T: Array, tolerance: float) -> bool:
    """True of a pose that neither moves nor turns anything."""
    return bool(np.abs(T - np.eye(4)).max() <= tolerance)


def plain_relations(a: SerialChain, b: SerialChain) -> Iterator[Relation]:
    """Relations of one cause: none, one joint's direction or zero, tool, base; and the last two."""
    same = Relation.none(a.n)
    yield same
    for k, frame in enumerate(b.joint_frames):
        one = np.arange(a.n) == k
        yield replace(same, directions=np.where(one, -1.0, 1.0))
        moved = product(inverse(frame), a.tool, inverse(b.tool), frame)
        own = _own_motion(b, k, moved, NOTHING, NOTHING * b.size)
        if own is not None:
            yield replace(same, offsets=np.where(one, own, 0.0)).wrapped(b)
    yield same.with_tool(a, b)
    yield replace(same, base=product(a.tool, inverse(b.tool)))
    onto = replace(same, base=product(a.joint_frames[0], inverse(b.joint_frames[0])))
    yield onto.with_tool(a, b)


def _motion(chain: SerialChain, joint: int, value: float) -> Array:
    return trans(0, 0, value) if chain.prismatic[joint] else rot_z(value)


def _own_motion(
    chain: SerialChain, joint: int, T: Array, slack: float, length: float
) -> float | None:
    """The value of a joint at which its own motion is T, up to a slack; None where none is."""
    value = float(T[2, 3]) if chain.prismatic[joint] else math.atan2(T[1, 0], T[0, 0])
    off = np.abs(T - _motion(chain, joint, value))
    return value if off[:3, :3].max() <= slack and off[:3, 3].max() <= length else None
