"""Pairs of links whose collisions need no check, found by sampling.

The rules, their order and their names are those of MoveIt's setup assistant (moveit2,
``compute_default_collisions.cpp``).
"""

from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum
from itertools import combinations

import numpy as np
import pinocchio as pin

from dh2urdf.transforms import Array

SAMPLES = 10_000
"""Configurations after which a pair that was never seen to meet is taken never to."""

FIRST_SAMPLES = 1_000
"""Configurations whose share of collisions is measured."""

ALWAYS = 0.95
"""Share of collisions from which a pair counts as always meeting, as the setup assistant has it."""

SEED = 0


class Reason(StrEnum):
    """Why a pair of links is not checked."""

    ADJACENT = "Adjacent"
    DEFAULT = "Default"
    ALWAYS = "Always"
    NEVER = "Never"


@dataclass(frozen=True)
class Disabled:
    """Two links and why their collisions are not checked."""

    link1: str
    link2: str
    reason: Reason


def disabled_collisions(urdf: str, home: Array) -> list[Disabled]:
    """Pairs of links that need no check, in the order of the links in the URDF.

    Parameters
    ----------
    urdf : str
        A URDF with collision bodies on a serial chain.
    home : array, shape (n,)
        The configuration [rad, m] whose collisions are the bodies' own.
    """
    sampler = _Sampler(urdf)
    reasons = dict.fromkeys(sampler.adjacent(), Reason.ADJACENT)
    sampler.watch(set(sampler.pairs) - reasons.keys())
    reasons |= dict.fromkeys(sampler.meeting(home), Reason.DEFAULT)
    sampler.watch(set(sampler.pairs) - reasons.keys())
    shares = sampler.shares(FIRST_SAMPLES)
    reasons |= {pair: Reason.ALWAYS for pair, share in shares.items() if share >= ALWAYS}
    sampler.watch({pair for pair, share in shares.items() if share == 0.0})
    reasons |= dict.fromkeys(sampler.never(SAMPLES - FIRST_SAMPLES), Reason.NEVER)
    names = sampler.links
    return [Disabled(names[i], names[j], reasons[i, j]) for i, j in sorted(reasons)]


class _Sampler:
    """Bodies of a URDF in Pinocchio; a pair of links is a pair of numbers into `links`."""

    def __init__(self, urdf: str) -> None:
        self.model = pin.buildModelFromXML(urdf)
        self.data = self.model.createData()
        self.bodies = pin.buildGeomFromUrdfString(self.model, urdf, pin.GeometryType.COLLISION)
        frames = [body.parentFrame for body in self.bodies.geometryObjects]
        order = sorted(set(frames), key=lambda f: (self.model.frames[f].parentJoint, f))
        self.links = [self.model.frames[f].name for f in order]
        self.joints = [self.model.frames[f].parentJoint for f in order]
        self.owners = [order.index(f) for f in frames]
        self.pairs = list(combinations(range(len(order)), 2))
        self.random = np.random.default_rng(SEED)
        self.watch(set())

    def adjacent(self) -> list[tuple[int, int]]:
        """Pairs with no link between them that has a body."""
        return [(i, i + 1) for i in range(len(self.links) - 1)]

    def watch(self, pairs: set[tuple[int, int]]) -> None:
        """Check these pairs of links only."""
        self.bodies.removeAllCollisionPairs()
        self.owner_pairs = []
        for a, b in combinations(range(len(self.owners)), 2):
            first, second = sorted((self.owners[a], self.owners[b]))
            if (first, second) in pairs:
                self.bodies.addCollisionPair(pin.CollisionPair(a, b))
                self.owner_pairs.append((first, second))
        self.results = self.bodies.createData()

    def meeting(self, q: Array) -> set[tuple[int, int]]:
        """Watched pairs that collide at q."""
        if not pin.computeCollisions(self.model, self.data, self.bodies, self.results, q, False):
            return set()
        hits = zip(self.owner_pairs, self.results.collisionResults, strict=True)
        return {pair for pair, result in hits if result.isCollision()}

    def shares(self, count: int) -> dict[tuple[int, int], float]:
        """In how many of the sampled configurations each watched pair collides, 0 to 1."""
        found = dict.fromkeys(self.owner_pairs, 0)
        for q in self._configurations(count):
            for pair in self.meeting(q):
                found[pair] += 1
        return {pair: hits / count for pair, hits in found.items()}

    def never(self, count: int) -> set[tuple[int, int]]:
        """Watched pairs that no sampled configuration makes collide."""
        left = set(self.owner_pairs)
        for q in self._configurations(count):
            if met := self.meeting(q):
                left -= met
                self.watch(left)
        return left

    def _configurations(self, count: int) -> Iterator[Array]:
        lower, upper = self.model.lowerPositionLimit, self.model.upperPositionLimit
        yield from self.random.uniform(lower, upper, (count, self.model.nq))
