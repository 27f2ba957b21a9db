"""Poses of six joints in doubt: what many starts find, and a member of each family."""

from functools import cache, lru_cache

import numpy as np
from numpy.typing import NDArray

from dh2urdf.chain import SerialChain
from dh2urdf.ik.arm.limits import TWO_PI
from dh2urdf.ik.arm.singular_families import Family
from dh2urdf.ik.arm.solver import IntArray, Outputs
from dh2urdf.ik.arm.task import Task
from dh2urdf.kernels.certificate import finish_batch, name_batch
from dh2urdf.kernels.in_doubt import IN_DOUBT, MOST_STEPS, search_known, search_poses
from dh2urdf.kernels.in_doubt import unite_families as keep_members
from dh2urdf.kernels.redundant import WELL
from dh2urdf.kernels.shapes import DULL
from dh2urdf.transforms import Array

STARTS = 64
"""Starts of the search, the same ones for every pose; every other one on a grid of 45 degrees,
where arms of right angles have their singular poses."""

WIDTH = 128
"""Most candidates of a pose."""

SHARP = 1e-11
"""Residual [m and rad] of a solution beside which a point of a valley is none."""

KIND = 1e-3
"""Joint distance [rad or m] within which rounding parts members of one family."""

SAME = 1e-6
"""Joint distance [rad or m] at which two solutions are one."""


@cache
def _angles(joints: int, count: int) -> Array:
    """Angles of every joint (count, joints)."""
    rng = np.random.default_rng(4)
    starts: Array = rng.uniform(-np.pi, np.pi, (count, joints))
    grid, few = np.pi / 4.0, (count // 2, joints)
    starts[::2] = grid * np.round(starts[::2] / grid) + 0.02 * rng.standard_normal(few)
    return starts


@lru_cache(maxsize=64)
def starts_of(chain: SerialChain, count: int = STARTS) -> Array:
    """Configurations (count, n); slides up to the arm's size."""
    starts = _angles(chain.n, count)
    if chain.prismatic.any():
        starts = starts.copy()
        starts[:, chain.prismatic] *= chain.size / np.pi
    return starts


def search_in_doubt(
    chain: SerialChain,
    Ts: Array,
    found: Outputs,
    deep: IntArray,
    within_limits: bool,
    starts: int = STARTS,
) -> Outputs:
    """Solve poses Ts (d, 4, 4) from candidates, q and counts of ``found``: wider outputs.

    What lies beside is looked for at all of them, many starts are for the ``deep`` ones.
    """
    wide, many = Outputs.of(len(Ts), WIDTH, chain.n), np.zeros(len(Ts), np.int64)
    if len(Ts):
        wide.q[:, : found.q.shape[1]], wide.counts[:], many[deep] = found.q, found.counts, 1
        tables, given = chain.tables, (np.ascontiguousarray(Ts), many, within_limits, wide)
        search_poses(tables, starts_of(chain, starts), chain.size, room_in_doubt(), *given)
    return wide


def room_in_doubt() -> NDArray[np.void]:
    """What a thread searches in."""
    return np.zeros(1, IN_DOUBT)


def from_starts(chain: SerialChain, T: Array, found: Outputs, known: Outputs) -> Outputs:
    """What many starts find of a pose (1, 4, 4); of each family what is known, or a member.

    Candidates are ``found``. Solutions that are known keep their branch.
    """
    wide = Outputs.of(1, WIDTH, chain.n)
    wide.q[:, : found.q.shape[1]], wide.counts[:] = found.q, found.counts
    given = known.q, known.branch, known.counts, wide
    search_known(chain.tables, starts_of(chain), chain.size, room_in_doubt(), T, *given)
    return wide


def family_of(chain: SerialChain, T: Array, q: Array, mask: int) -> Family:
    """The family of a pose T (4, 4) by the joints of a mask, through a solution q (n,)."""
    joints = tuple(np.flatnonzero(mask >> np.arange(chain.n) & 1).tolist())
    return Family(chain, Task.POSE, T, joints, q.copy())


def keep_known(chain: SerialChain, T: Array, known: Outputs, wide: Outputs) -> None:
    """Add known sharp solutions of a pose (1, 4, 4) that others, or their curves, leave out.

    In place, at the end, with the joints that they are free in; the sharp ones come first, then.
    Where all that are known are sharp, the others that are not go. On surfaces walks go astray:
    all that is known of them stays.
    """
    name_batch(chain.tables, T, known)
    sharp = known.residual[0, : known.counts[0]] <= SHARP
    if len(sharp) and sharp.all():
        _keep(wide, np.flatnonzero(wide.residual[0, : wide.counts[0]] <= SHARP))
    curves, surfaces = _curves(chain, T[0], wide)
    for k in np.flatnonzero(sharp | surfaces):
        p, count = known.q[0, k], int(wide.counts[0])
        twins = np.flatnonzero(far(chain, wide.q[0, :count], p) <= SAME)
        if len(twins):
            place = int(twins[0])
            if not known.free[0, k] or not sharp[k] or wide.free[0, twins].any():
                continue
        elif count < wide.q.shape[1] and not any(
            curve.contains(p[None], held=WELL)[0] for curve in curves
        ):
            place, wide.counts[0] = count, count + 1
        else:
            continue
        for array, source in zip(wide, known, strict=True):
            if array.ndim > 1:
                array[0, place] = source[0, k]
        curves += _curves(chain, T[0], wide, place)[0]
    _drop_members(chain, T[0], wide)
    count = wide.counts[0]
    _keep(wide, np.argsort(wide.residual[0, :count] > SHARP, kind="stable"))


def _drop_members(chain: SerialChain, T: Array, out: Outputs) -> None:
    """Drop solutions that no walk leaves, but one along a family comes to, in place."""
    q, free = out.q[0, : out.counts[0]], out.free[0]
    kept = np.ones(len(q), np.bool_)
    for k in np.flatnonzero(free[: len(q)]):
        alone = np.flatnonzero(kept & (free[: len(q)] == 0))
        if len(alone):
            kept[alone] = ~family_of(chain, T, q[k], free[k]).contains(q[alone])
    _keep(out, np.flatnonzero(kept))


def _curves(
    chain: SerialChain, T: Array, out: Outputs, first: int = 0
) -> tuple[list[Family], bool]:
    """Families of one dimension of a pose T (4, 4), and whether there are others.

    Of its solutions from the ``first`` on.
    """
    rows, families = slice(first, int(out.counts[0])), []
    for q, free in zip(out.q[0, rows], out.free[0, rows], strict=True):
        families += [family_of(chain, T, q, free)] if free else []
    curves = [family for family in families if family.dimensions() == 1]
    return curves, len(curves) < len(families)


def far(chain: SerialChain, q: Array, p: Array) -> Array:
    """Largest difference of a joint from p (n,) of configurations q (k, n)."""
    gaps = q - p
    turns = np.abs(np.remainder(gaps + np.pi, TWO_PI) - np.pi)
    largest: Array = np.where(chain.prismatic, np.abs(gaps), turns).max(axis=1)
    return largest


def keep_most_apart(chain: SerialChain, out: Outputs, row: int, room: int) -> None:
    """Bring those solutions of a pose to the front, in place, that are kept where room is short.

    First those that are exact: one of the largest families, then always what is farthest from all
    that are kept, by joints that are not free in both, and of what is near by the largest family.
    So members of one family, parted by rounding, take no other's place.
    """
    count = out.counts[row]
    q, bits = out.q[row, :count], out.free[row, :count, None] >> np.arange(chain.n) & 1
    turn, kept = (out.residual[row, :count] > DULL).astype(np.int64), np.empty(room, np.int64)
    away, size = np.zeros(count), bits.sum(axis=1)
    for i in range(room):
        last = kept[i] = np.lexsort((-away, np.where(away > KIND, -chain.n, -size), turn))[0]
        gaps = far(chain, np.where(bits & bits[last], q[last], q), q[last])
        away = np.minimum(away, gaps) if i else gaps
        turn[last] = 2
    for array in (out.q, out.residual, out.branch, out.free):
        array[row, :room] = array[row, np.sort(kept)]


def keep_sharp(out: Outputs, known: Array) -> None:
    """Of one pose with a solution, drop what is accepted beside it along a valley, in place.

    Solutions that are known (k, n) stay.
    """
    q, residual, free = out.q[0, : out.counts[0]], out.residual[0, : out.counts[0]], out.free[0]
    is_known = (np.abs(q[:, None] - known).max(axis=2, initial=0.0) <= SAME).any(axis=1)
    kept = np.flatnonzero((residual <= SHARP) | (free[: len(q)] != 0) | is_known)
    if len(kept):
        _keep(out, kept)


def drop_dull_members(out: Outputs) -> None:
    """Of one pose with a sharp solution, drop members of families that are none, in place."""
    count = out.counts[0]
    sharp = out.residual[0, :count] <= SHARP
    if sharp.any():
        _keep(out, np.flatnonzero(sharp | (out.free[0, :count] == 0)))


def _keep(out: Outputs, rows: IntArray | list[int]) -> None:
    """Keep some solutions of one pose, in place."""
    out.counts[0] = len(rows)
    for array in (out.q, out.residual, out.branch, out.free):
        array[0, : len(rows)] = array[0, rows]


def unite_families(chain: SerialChain, Ts: Array, within_limits: bool, wide: Outputs) -> None:
    """Keep one member of each family of poses Ts (d, 4, 4), and, then, what is within limits."""
    poses, walk = np.ascontiguousarray(Ts), np.empty((2, MOST_STEPS, chain.n))
    key, (gone, asked) = np.empty(wide.q.shape[1]), np.empty((2, wide.q.shape[1]), np.bool_)
    keep_members(chain.tables, chain.size, poses, walk, key, gone, asked, wide)
    if within_limits:
        finish_batch(chain.tables, poses, True, wide)
