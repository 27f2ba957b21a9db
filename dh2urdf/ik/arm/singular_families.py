"""Singular families: from one representative to the member that the user wants.

Where joints are free, the solutions form a curve (seldom a surface) in joint space. A member is
moved along it by the kernels for self-motions, on the chain whose other joints are held.
"""

import itertools
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray

from dh2urdf.chain import CoupledChain, SerialChain
from dh2urdf.ik.arm import limits
from dh2urdf.ik.arm.chains import hold
from dh2urdf.ik.arm.shared_tolerances import ACCEPT, FAMILY_STEP
from dh2urdf.ik.arm.task import Task, scaled_jacobian, task_error
from dh2urdf.kernels.certificate import find_solutions
from dh2urdf.kernels.redundant import nearest_members, on_one_family, walk_family
from dh2urdf.transforms import Array, length

SAME = 1e-6
"""Joint distance [rad or m] at which two members are one, as two solutions are."""

FLAT = 1e-5
"""Singular value, relative to the largest, of a direction in which a family goes on."""

MOST_STEPS = 200
"""Steps each way of a walk along a family."""

STARTS = 8
"""Members inside the limits, nearest to a seed first, that are moved on towards it."""


class Family:
    """The solutions of a pose T that a representative q (n,) reaches by its free joints alone."""

    def __init__(
        self, chain: SerialChain, task: Task, T: Array, free: tuple[int, ...], q: Array
    ) -> None:
        self.chain, self.task, self.T, self.q = chain, task, T, q
        self.free = list(free)
        self.moving = hold(chain, {i: float(q[i]) for i in range(chain.n) if i not in free})

    def nearest(self, seed: Array, within_limits: bool, full_turns: bool = True) -> Array | None:
        """The member (n,) with the least motion from the seed; None if none keeps the limits.

        ``full_turns``: start also from where a free joint is a turn to either side.
        """
        start = limits.turned_to(self.chain, self.q, seed, within_limits)
        turns = np.diag(np.where(self.moving.prismatic, 0.0, limits.TWO_PI)) * full_turns
        starts = start[self.free] + np.concatenate([turns[:1] * 0.0, turns, -turns])
        members = self._slide(np.unique(starts, axis=0), seed, within_limits=False)
        if within_limits:
            inside = members[self._inside(start, members)]
            members = inside if len(inside) else self._inside_members(start, seed)
        if not len(members):
            return None
        start[self.free] = min(members, key=lambda m: length(m - seed[self.free]))
        return start

    def holds(self, seed: Array) -> bool:
        """Whether the seed reaches the pose and only free joints tell it from the members."""
        error = task_error(self.chain.fk(seed)[None], self.T, self.task)[0]
        if max(np.linalg.norm(error[:3]), np.linalg.norm(error[3:])) > ACCEPT:
            return False
        return bool(self._apart(seed[None])[0] <= SAME)

    def contains(
        self, others: Array, trials: int = 2, held: float = 0.9 * ACCEPT
    ) -> NDArray[np.bool_]:
        """Which configurations (k, n) of the same free joints a walk along the family arrives at.

        Straight towards each of them, where a family has more than one dimension, until this has
        failed in so many ``trials``, and from the point of a walk both ways that is nearest; the
        residual is ``held`` at most, a little less than that of a solution.
        """
        found = self._apart(others) <= SAME
        some = np.ascontiguousarray(others[found][:, self.free])
        on = np.empty(len(some), np.bool_)
        if len(some):
            walk, straight = np.empty((2, MOST_STEPS, len(self.free))), self.dimensions() > 1
            steps = self._goal, FAMILY_STEP, held, self.q[self.free]
            on_one_family(self.moving.tables, *steps, some, trials * straight, on, walk)
        found[found] = on
        return found

    def members(self) -> Array:
        """Members (k, n) on a walk both ways from the representative, and itself."""
        walked = np.concatenate([self.q[None, self.free], self._walk(self.q)])
        out = np.repeat(self.q[None], len(walked), axis=0)
        out[:, self.free] = walked
        return out

    def dimensions(self) -> int:
        """In how many directions the family leaves the representative."""
        J = scaled_jacobian(self.chain, self.task, self.q[None])[0][:, self.free]
        sigma = np.linalg.svd(J, compute_uv=False)
        return len(self.free) - int((sigma > FLAT * sigma[0]).sum())

    def _apart(self, others: Array) -> Array:
        """Largest differences (k,) of joints that are not free from configurations (k, n)."""
        gaps = np.abs(_principal(self.chain, others - self.q))
        gaps[:, self.free] = 0.0
        apart: Array = gaps.max(axis=1)
        return apart

    def _walk(self, start: Array) -> Array:
        """Members (k, f) on a walk both ways from a member (n,)."""
        walk = np.empty((2, MOST_STEPS, len(self.free)))
        counts = np.empty(2, np.int64)
        walk_family(self.moving.tables, self._goal, FAMILY_STEP, start[self.free], walk, counts)
        return np.concatenate([way[:count] for way, count in zip(walk, counts, strict=True)])

    def _inside(self, start: Array, members: Array) -> NDArray[np.bool_]:
        """Which members (k, f), with the other joints as in start (n,), keep all limits."""
        whole = np.repeat(start[None], len(members), axis=0)
        whole[:, self.free] = members
        return limits.inside(self.chain, whole)

    def _slide(self, members: Array, seed: Array, within_limits: bool) -> Array:
        """Move members (k, f) along the family to where they are nearest to the seed (n,)."""
        out = np.ascontiguousarray(members)
        tables, residual = self.moving.tables, np.empty(len(out))
        nearest_members(tables, self._goal, within_limits, out, seed[self.free], residual)
        return out

    def _inside_members(self, start: Array, seed: Array) -> Array:
        """Members (k, f) inside the limits that are nearest to the seed, found by a walk."""
        found = limits.turned_to(self.moving, self._walk(start), seed[self.free])
        found = found[self._inside(start, found)]
        order = np.argsort(np.linalg.norm(found - seed[self.free], axis=1), kind="stable")
        return self._slide(found[order[:STARTS]], seed, within_limits=True)

    @cached_property
    def _goal(self) -> tuple[int, Array, float]:
        """Task, target and size of the arm, as kernels take them."""
        return self.task.number, np.array(self.T), self.chain.size


def beside_seed(
    chain: SerialChain, task: Task, T: Array, seed: Array, within_limits: bool
) -> Array:
    """The solution (1, n) of a pose that Newton's method leads to from a seed, or none (0, n).

    A curve of solutions that is short, or close to another one, may have none of the values at
    which joints are held.
    """
    arm = coupled(chain, within_limits)
    start = np.clip(seed[None], arm[3][:, 1], arm[3][:, 2])
    found, residual = np.empty((1, chain.n)), np.empty(1)
    goal = task.number, np.array(T), chain.size
    count, _ = find_solutions(arm, goal, start, found, residual)
    return found[:count]


@lru_cache(maxsize=16)
def coupled(
    chain: SerialChain, within_limits: bool
) -> tuple[tuple[Array, Array], Array, Array, Array]:
    """A chain as a search takes it, with or without its limits, and how joints follow values."""
    bounds = np.column_stack([chain.prismatic, chain.lower, chain.upper]).astype(float)
    if not within_limits:
        bounds[:, 1:] = -np.inf, np.inf
    if isinstance(chain, CoupledChain):
        return chain.serial.tables, chain.matrix, np.zeros(len(chain.leaders)), bounds
    return chain.tables, np.eye(chain.n), np.zeros(chain.n), bounds


def _principal(chain: SerialChain, gap: Array) -> Array:
    """Joint differences (..., n), angles in [-pi, pi)."""
    turned = np.remainder(gap + np.pi, limits.TWO_PI) - np.pi
    principal: Array = np.where(chain.prismatic, gap, turned)
    return principal


def slide_to_seed(
    families: dict[int, Family], q: Array, seed: Array, within_limits: bool
) -> NDArray[np.bool_]:
    """Move solutions q (k, n) in place, each along its family, to the members nearest to the seed.

    Returns which of them to keep, shape (k,): two that meet were of one family.

    A walk may end where the family turns away from the seed. So where the seed itself is a
    member and no walk arrives at it, the walk that ends nearest to it gives way; and one walk a
    family is enough.
    """
    chain = next(iter(families.values())).chain
    goal = limits.turned_to(chain, seed, seed, within_limits)
    reachable = not within_limits or bool(limits.inside(chain, goal))
    around = [k for k, family in families.items() if reachable and family.holds(goal)]
    for k, family in families.items():
        if around == [k]:
            q[k] = goal
            continue
        member = family.nearest(seed, within_limits, full_turns=k not in around)
        q[k] = q[k] if member is None else member
    gaps = {k: length(q[k] - goal) for k in around}
    if gaps and min(gaps.values()) > SAME:
        q[min(gaps, key=lambda k: gaps[k])] = goal
    keep = np.ones(len(q), np.bool_)
    for k, j in itertools.combinations(families, 2):
        keep[j] &= not keep[k] or bool(np.abs(q[k] - q[j]).max() > SAME)
    return keep
