"""Singular families: from one representative to the member that the user wants.

Where joints are free, the solutions form a curve (seldom a surface) in joint space. A member is
moved along the null space of the Jacobian of the free joints and put back on the curve by
Newton's method on the exact chain.
"""

from __future__ import annotations

import numpy as np

from dh2urdf.chain import SerialChain
from dh2urdf.ik import limits
from dh2urdf.ik.solver import Task
from dh2urdf.ik.tolerances import ACCEPT, FAMILY_RANK, FAMILY_STEP
from dh2urdf.transforms import Array

__all__ = ["Family", "slide_to_seed", "task_error", "task_jacobian"]

SAME = 1e-6
"""Joint distance [rad or m] at which two members are one, as two solutions are."""

MOST_STEPS = 100
"""Steps along a family before the search for its nearest member is given up."""


def task_error(T_found: Array, T: Array, task: Task) -> Array:
    """Error vectors of poses (k, 4, 4) against a target (4, 4), shape (k, 3 or 6).

    Position difference [m], then the rotation vector, as long as its sine, from the found to
    the target orientation; for ``position+axis`` that between the two z axes.
    """
    position = T[:3, 3] - T_found[:, :3, 3]
    if task is Task.POSITION:
        return position
    if task is Task.POSITION_AXIS:
        turn = np.cross(T_found[:, :3, 2], T[:3, 2])
        behind = T_found[:, :3, 2] @ T[:3, 2] < 0.0
    else:
        turn = 0.5 * np.cross(T_found[:, :3, :3], T[None, :3, :3], axisa=1, axisb=1).sum(axis=1)
        behind = np.einsum("kij,ij->k", T_found[:, :3, :3], T[:3, :3]) < 1.0
    turn[behind] = np.pi, 0.0, 0.0
    return np.concatenate([position, turn], axis=1)


def task_jacobian(chain: SerialChain, task: Task, q: Array) -> Array:
    """Derivative of the task at configurations q (k, n), shape (k, 3 or 6, n).

    For ``position+axis`` the turn about the tool's own z is taken out.
    """
    from dh2urdf.kernels.chain import chain_fk_batch, chain_jacobian_batch

    q = np.ascontiguousarray(q)
    J = np.empty((len(q), 6, chain.n))
    chain_jacobian_batch(chain.links, chain.prismatic, q, J)
    if task is Task.POSITION:
        return J[:, :3]
    if task is Task.POSITION_AXIS:
        T = np.empty((len(q), 4, 4))
        chain_fk_batch(chain.links, chain.prismatic, q, T)
        z = T[:, :3, 2]
        J[:, 3:] -= z[:, :, None] * (z[:, None] @ J[:, 3:])
    return J


class Family:
    """The solutions of one pose that a representative can slide to.

    Parameters
    ----------
    chain : SerialChain
    task : Task
    T : array, shape (4, 4)
        Target.
    free : tuple of int
        Indices of the joints that move along the family.
    """

    def __init__(self, chain: SerialChain, task: Task, T: Array, free: tuple[int, ...]) -> None:
        self.chain, self.task, self.T = chain, task, T
        self.free = list(free)

    def nearest(
        self, q: Array, seed: Array, within_limits: bool, full_turns: bool = True
    ) -> Array | None:
        """The member of the family through q (n,) with the least motion from the seed.

        ``full_turns``: start also from q with a free joint a turn to either side.

        Returns
        -------
        array, shape (n,), or None
            None where no member keeps the limits and ``within_limits`` is asked for.
        """
        start = limits.turned_to(self.chain, q, seed)
        members = [self._slide(start, seed)]
        for i in self.free:
            if full_turns and not self.chain.prismatic[i]:
                turn = limits.TWO_PI * np.eye(self.chain.n)[i]
                members += [self._slide(start + turn, seed), self._slide(start - turn, seed)]
        if within_limits:
            inside = [m for m in members if bool(limits.inside(self.chain, m))]
            members = inside or self._inside_members(q, seed)
        if not members:
            return None
        return min(members, key=lambda m: float(np.linalg.norm(m - seed)))

    def holds(self, q: Array, seed: Array) -> bool:
        """Whether the seed reaches the pose and only free joints tell it from the member q (n,)."""
        error = self._error(seed)
        if max(np.linalg.norm(error[:3]), np.linalg.norm(error[3:])) > ACCEPT:
            return False
        gap = np.abs(limits.turned_to(self.chain, q, seed) - seed)
        gap = np.where(
            self.chain.prismatic, gap, np.abs(np.remainder(gap + np.pi, limits.TWO_PI) - np.pi)
        )
        gap[self.free] = 0.0
        return bool(gap.max() <= SAME)

    def _slide(self, q: Array, seed: Array) -> Array:
        """Go along the family while that brings q nearer to the seed."""
        for _ in range(MOST_STEPS):
            tangent = self._tangent(q)
            step = tangent @ (tangent.T @ (seed - q)[self.free])
            longest = float(np.abs(step).max(initial=0.0))
            if longest < 1e-12:
                break
            moved = self._moved(q, step)
            if moved is None:
                moved = self._moved(q, step * min(1.0, FAMILY_STEP / longest))
            if moved is None or np.linalg.norm(moved - seed) >= np.linalg.norm(q - seed):
                break
            q = moved
        return q

    def _inside_members(self, q: Array, seed: Array) -> list[Array]:
        """Samples of the family that keep the limits, by walking it both ways."""
        found = []
        for sign in (1.0, -1.0):
            member, heading = q, None
            for _ in range(2 * MOST_STEPS):
                tangent = self._tangent(member)
                if tangent.shape[1] == 0:
                    break
                along = tangent[:, 0] if heading is None else tangent @ (tangent.T @ heading)
                length = float(np.linalg.norm(along))
                if length < FAMILY_RANK:
                    break
                along = along * (sign if heading is None else 1.0) / length
                moved = self._moved(member, FAMILY_STEP * along)
                if moved is None:
                    break
                member, heading = moved, along
                turned = limits.turned_to(self.chain, member, seed)
                if bool(limits.inside(self.chain, turned)):
                    found.append(turned)
        return found

    def _moved(self, q: Array, step: Array) -> Array | None:
        """Q with its free joints moved by step and put back on the family; None if that fails."""
        out = q.copy()
        out[self.free] += step
        for _ in range(4):
            error = self._error(out)
            size = float(np.abs(error).max())
            if size <= 1e-14:
                return out
            if size > 0.5 * FAMILY_STEP * self.chain.size:
                return None
            J = self._jacobian(out)
            out[self.free] += np.linalg.pinv(J, rcond=FAMILY_RANK) @ error
        return out if float(np.abs(self._error(out)).max()) <= ACCEPT else None

    def _error(self, q: Array) -> Array:
        """Task error of q (n,)."""
        row: Array = task_error(self.chain.fk(q)[None], self.T, self.task)[0]
        return row

    def _jacobian(self, q: Array) -> Array:
        """Rows of the task, columns of the free joints: derivative of the pose."""
        columns: Array = task_jacobian(self.chain, self.task, q[None])[0][:, self.free]
        return columns

    def _tangent(self, q: Array) -> Array:
        """Orthonormal directions of the free joints that leave the task alone, shape (f, d)."""
        J = self._jacobian(q)
        _, sigma, Vt = np.linalg.svd(J)
        rank = int((sigma > FAMILY_RANK * max(float(sigma[0]), 1e-9)).sum())
        null: Array = Vt[rank:].T
        return null


def slide_to_seed(families: dict[int, Family], q: Array, seed: Array, within_limits: bool) -> None:
    """Move solutions q (k, n) in place, each along its family, to the members nearest to the seed.

    A walk may end where the family turns away from the seed. So where the seed itself is a
    member and no walk arrives at it, the walk that ends nearest to it gives way; and one walk a
    family is enough.
    """
    chain = next(iter(families.values())).chain
    goal = limits.turned_to(chain, seed, seed)
    reachable = not within_limits or bool(limits.inside(chain, goal))
    around = [k for k, family in families.items() if reachable and family.holds(q[k], goal)]
    for k, family in families.items():
        if around == [k]:
            q[k] = goal
            continue
        member = family.nearest(q[k], seed, within_limits, full_turns=k not in around)
        q[k] = q[k] if member is None else member
    gaps = {k: float(np.linalg.norm(q[k] - goal)) for k in around}
    if gaps and min(gaps.values()) > SAME:
        q[min(gaps, key=lambda k: gaps[k])] = goal
