"""Poses of six joints in doubt: what many starts find, and a member of each family."""

from functools import cache

import numpy as np

from dh2urdf.chain import SerialChain
from dh2urdf.ik.arm.singular_families import Family
from dh2urdf.ik.arm.solver import IntArray, Outputs
from dh2urdf.ik.arm.task import Task
from dh2urdf.kernels.certificate import finish_batch
from dh2urdf.kernels.in_doubt import search_beside, search_from
from dh2urdf.transforms import Array

STARTS = 64
"""Starts of the search, the same ones for every pose; every other one on a grid of 45 degrees,
where arms of right angles have their singular poses."""

WIDTH = 128
"""Most candidates of a pose."""

SHARP = 1e-11
"""Residual [m and rad] of a solution beside which a point of a valley is none."""

SAME = 1e-6
"""Joint distance [rad or m] at which two solutions are one."""

FAMILIES = 4
"""Families of a pose whose members are looked for at any distance: a few milliseconds each."""

ALIKE = 1e-14
"""Residuals [m and rad] below which one member of a family is as good as another."""


@cache
def _angles(joints: int, count: int) -> Array:
    """Angles of every joint (count, joints)."""
    rng = np.random.default_rng(4)
    starts: Array = rng.uniform(-np.pi, np.pi, (count, joints))
    grid, few = np.pi / 4.0, (count // 2, joints)
    starts[::2] = grid * np.round(starts[::2] / grid) + 0.02 * rng.standard_normal(few)
    return starts


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
    wide = Outputs.of(len(Ts), WIDTH, chain.n)
    if not len(Ts):
        return wide
    wide.q[:, : found.q.shape[1]], wide.counts[:] = found.q, found.counts
    some = wide.rows(deep)
    search_from(chain.tables, starts_of(chain, starts), chain.size, Ts[deep], some)
    wide.put(deep, some)
    finish_batch(chain.tables, Ts, False, wide)
    search_beside(chain.tables, Ts, wide)
    finish_batch(chain.tables, Ts, False, wide)
    unite_families(chain, Ts, within_limits, wide)
    return wide


def keep_sharp(out: Outputs, known: Array) -> None:
    """Of one pose with a solution, drop what is accepted beside it along a valley, in place.

    Solutions that are known (k, n) stay.
    """
    q, residual, free = out.q[0, : out.counts[0]], out.residual[0, : out.counts[0]], out.free[0]
    is_known = (np.abs(q[:, None] - known).max(axis=2, initial=0.0) <= SAME).any(axis=1)
    kept = np.flatnonzero((residual <= SHARP) | (free[: len(q)] != 0) | is_known)
    if len(kept):
        _keep(out, kept)


def _keep(out: Outputs, rows: IntArray | list[int]) -> None:
    """Keep some solutions of one pose, in place."""
    out.counts[0] = len(rows)
    for array in (out.q, out.residual, out.branch, out.free):
        array[0, : len(rows)] = array[0, rows]


def unite_families(chain: SerialChain, Ts: Array, within_limits: bool, wide: Outputs) -> None:
    """Keep one member of each family of poses Ts (d, 4, 4), and, then, what is within limits."""
    named = (wide.free != 0) & (np.arange(wide.q.shape[1]) < wide.counts[:, None])
    for i in np.flatnonzero(named.sum(axis=1) > 1).tolist():
        one_of_each_family(chain, Ts[i], wide.rows(slice(i, i + 1)))
    if within_limits:
        finish_batch(chain.tables, Ts, True, wide)


def one_of_each_family(chain: SerialChain, T: Array, out: Outputs) -> None:
    """Keep the best member of each family of a pose T (4, 4), isolated ones first, in place."""
    k = int(out.counts[0])
    q, free, residual = out.q[0, :k], out.free[0, :k], np.maximum(out.residual[0, :k], ALIKE)
    kept = np.flatnonzero(free == 0).tolist()
    members = sorted(np.flatnonzero(free).tolist(), key=lambda m: residual[m])
    isolated = len(kept)
    while members:
        first = members.pop(0)
        kept.append(first)
        joints = tuple(np.flatnonzero(free[first] >> np.arange(chain.n) & 1).tolist())
        family = Family(chain, Task.POSE, np.array(T), joints, q[first].copy())
        alike = [m for m in members if free[m] == free[first]]
        trials = 2 if len(kept) - isolated <= FAMILIES else 0
        same = {m for m, on in zip(alike, family.contains(q[alike], trials), strict=True) if on}
        members = [m for m in members if m not in same]
    _keep(out, kept)
