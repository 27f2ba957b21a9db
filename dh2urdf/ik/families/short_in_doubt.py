"""Poses of short chains in doubt: where singularities meet, every cut of the loop is singular.

Solutions are then looked for by Newton's method from many starts and along valleys.
"""

import numpy as np

from dh2urdf.chain import SerialChain
from dh2urdf.ik.arm import Outputs, one_of_each_family
from dh2urdf.kernels.certificate import finish_batch, search_valleys
from dh2urdf.kernels.short_chains import search_starts
from dh2urdf.transforms import Array

STARTS = 64
"""Starts of the search, the same ones for every pose; every other one near a grid of 45 degrees,
where arms of right angles have their singular poses."""

SEEDS, WIDTH = 64, 96
"""Most seeds of a pose, and most candidates."""

SAME = 1e-6
"""Joint distance [rad or m] at which two solutions are one."""

SHARP = 1e-11
"""Residual [m and rad] of a solution beside which a point of a valley is none."""


def _starts(chain: SerialChain) -> Array:
    """Configurations (``STARTS``, n)."""
    rng = np.random.default_rng(4)
    starts: Array = rng.uniform(-np.pi, np.pi, (STARTS, chain.n))
    grid = np.pi / 4.0
    near = grid * np.round(starts[::2] / grid) + 0.02 * rng.standard_normal((STARTS // 2, chain.n))
    starts[::2] = near
    starts[:, chain.prismatic] *= chain.size / np.pi
    return starts


def _keep_sharp(out: Outputs, known: Array) -> None:
    """Of one pose with a solution, drop what is accepted beside it along a valley, in place.

    Solutions that are known (k, n) stay.
    """
    q, residual, free = out.q[0, : out.counts[0]], out.residual[0, : out.counts[0]], out.free[0]
    is_known = (np.abs(q[:, None] - known).max(axis=2, initial=0.0) <= SAME).any(axis=1)
    kept = np.flatnonzero((residual <= SHARP) | (free[: len(q)] != 0) | is_known)
    if len(kept):
        out.counts[0] = len(kept)
        for array in (out.q, out.residual, out.branch, out.free):
            array[0, : len(kept)] = array[0, kept]


def search_short(chain: SerialChain, Ts: Array, found: Outputs, within_limits: bool) -> Outputs:
    """Solve poses Ts (d, 4, 4), their solutions, limits aside, being known: wider outputs."""
    d, k = len(Ts), found.q.shape[1]
    wide, seeds = Outputs.of(d, WIDTH, chain.n), np.empty((d, SEEDS, chain.n))
    seeds[:, :k], many = found.q, found.counts.copy()
    search_starts(chain.tables, _starts(chain), chain.size, Ts, seeds, many)
    wide.q[:, :SEEDS], wide.counts[:] = seeds, many
    search_valleys(chain.tables, chain.size, Ts, seeds, many, wide.q, wide.counts)
    finish_batch(chain.tables, Ts, False, wide)
    for i in range(d):
        _keep_sharp(wide.rows(slice(i, i + 1)), found.q[i, : found.counts[i]])
    named = (wide.free != 0) & (np.arange(WIDTH) < wide.counts[:, None])
    for i in np.flatnonzero(named.sum(axis=1) > 1).tolist():
        one_of_each_family(chain, Ts[i], wide.rows(slice(i, i + 1)))
    if within_limits:
        finish_batch(chain.tables, Ts, True, wide)
    return wide
