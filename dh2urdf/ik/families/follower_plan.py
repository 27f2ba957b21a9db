"""Which eliminations suit an arm whose followers move with one value, and of which degree.

All that fit are tried on random poses: the degree of a polynomial is where its coefficients end,
and roots that it has at every pose are divided out.
"""

import math
from functools import lru_cache
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from dh2urdf.chain import CoupledChain
from dh2urdf.ik.arm import TWO_PI, Outputs
from dh2urdf.ik.families.general_6r import DEAREST, TURN, WORTH
from dh2urdf.ik.families.short_links import short_links
from dh2urdf.kernels.followers import (
    ALWAYS,
    FOLLOWERS_16,
    FOLLOWERS_48,
    finish_followers_16,
    finish_followers_48,
    sample_followers,
    try_followers_16,
    try_followers_48,
)
from dh2urdf.kernels.general_6r import MOST, tables_of
from dh2urdf.kernels.numbers import sincos
from dh2urdf.transforms import Array, inverse, product

Arm: TypeAlias = NDArray[np.void]

FLIP = np.diag([1.0, -1.0, -1.0, 1.0])
"""Rotation by which a joint turns the other way."""

Always: TypeAlias = list[tuple[float, int]]
"""Roots that a polynomial has at every pose [rad], and half of how many there are."""

BUILT = np.arange(-11, 13) * (np.pi / 12.0)
"""Turns of a leader at which neighbours' axes fall into one in arms as they are built [rad]."""

ABOUT, EXACTLY = 0.03, 1e-6
"""How far apart roots are found that are one, and the middle of them from where it is [rad]."""

POSES = 8
"""Random poses on which each elimination is tried."""

VANISHING = 1e-12
"""Part of the polynomial's largest coefficient below which others are rounding."""

NO_DEGREE = 1000
"""Of an elimination that does not do."""

USABLE = 0.9
"""Part of the best elimination's solutions that another must find to be kept."""


class Kernel(NamedTuple):
    """The kernels of a degree."""

    degree: int
    record: np.dtype[Any]

    @property
    def tried(self) -> Any:
        """The kernel that gives candidates."""
        return try_followers_16 if self.degree == 16 else try_followers_48

    @property
    def finished(self) -> Any:
        """The kernel that gives solutions."""
        return finish_followers_16 if self.degree == 16 else finish_followers_48


KERNELS = Kernel(16, FOLLOWERS_16), Kernel(48, FOLLOWERS_48)
"""By degree, the lowest first."""


def leaders_of(chain: CoupledChain) -> list[int]:
    """Values that move more than one joint."""
    return [v for v in range(chain.n) if chain.leaders.count(v) > 1]


def eliminations_of(chain: CoupledChain) -> list[tuple[int, int]]:
    """Where the loop may be cut, and in which direction.

    Its first two joints and the last are free, and there are two free ones in between.
    """
    leader, n = leaders_of(chain)[0], len(chain.leaders)
    found = []
    for reverse in range(2):
        for shift in range(n):
            order = [
                (shift + i) % n if not reverse else (2 * n - 1 - shift - i) % n for i in range(n)
            ]
            free = [chain.leaders[j] != leader for j in order]
            if free[0] and free[1] and free[-1]:
                found.append((shift, reverse))
    return found


class Plan(NamedTuple):
    """How an arm is solved: by which kernels and which record, of which degrees."""

    kernel: Kernel
    record: Arm
    degree: int


@lru_cache(maxsize=8)
def plan_followers(chain: CoupledChain) -> Plan | None:
    """The eliminations of the lowest degree that suit an arm, best first; None if none do."""
    largest, poses = blank_followers(chain, KERNELS[-1]), _random_poses(chain)
    looked = {e: _look(largest, e, poses) for e in eliminations_of(chain)}
    degrees = {e: degree for e, (degree, _) in looked.items()}
    always = {e: roots for e, (_, roots) in looked.items()}
    least = min(degrees.values(), default=NO_DEGREE)
    if least == NO_DEGREE:
        return None
    kernel = next(k for k in KERNELS if k.degree >= least)
    record = blank_followers(chain, kernel)
    some = [e for e, degree in degrees.items() if degree <= kernel.degree]
    best = _rank(chain, kernel, record, {e: degrees[e] for e in some}, always, poses)
    _choose(record, best, always)
    return Plan(kernel, record, degrees[best[0]])


def _look(arm: Arm, elimination: tuple[int, int], poses: Array) -> tuple[int, Always]:
    """Degree of an elimination's polynomial without the roots that it has at every pose; those.

    ``NO_DEGREE`` where it is higher than can be, or vanishes.
    """
    values = np.empty((len(poses), arm["hidden"].shape[2]))
    _choose(arm, [elimination], {})
    sample_followers(arm, poses, values)
    series = np.fft.fft(values, axis=1) / values.shape[1]
    sizes = np.abs(series[:, : values.shape[1] // 2 + 1])
    largest = sizes.max(axis=1, keepdims=True)
    if not (largest > 0.0).all():
        return NO_DEGREE, []
    parts = np.median(sizes / largest, axis=0)
    degree = int(np.flatnonzero(parts > VANISHING)[-1])
    if degree > KERNELS[-1].degree:
        return NO_DEGREE, []
    zero = float(arm["zeros"][0, arm["leader"][0]]) * (1.0 if elimination[1] == 0 else -1.0)
    always = _always([_real_roots(row, degree) + zero for row in series], zero)
    return degree - sum(half for _, half in always), always


def _real_roots(series: Array, degree: int) -> Array:
    """Roots of a polynomial on the circle or next to it [rad], by its Fourier coefficients."""
    if degree == 0:
        return np.zeros(0)
    z = np.roots(np.concatenate([series[: degree + 1][::-1], series[-degree:][::-1]]))
    angles: Array = np.angle(z[np.abs(np.abs(z) - 1.0) < ABOUT])
    return angles


def _always(roots: list[Array], zero: float) -> Always:
    """Which of the turns that arms are built with are roots at every pose, two or more at once.

    Where the axes next to leader and followers fall into one, whatever the pose. Other roots
    that are there at every pose are found each time, which takes longer.
    """
    found: Always = []
    for place in BUILT:
        near = [np.remainder(r - place + np.pi, TWO_PI) - np.pi for r in roots]
        some = [gap[np.abs(gap) < ABOUT] for gap in near]
        half = min(len(gap) for gap in some) // 2
        if half and np.median([abs(gap.mean()) for gap in some]) < EXACTLY:
            found.append((place - zero, half))
    return found[:ALWAYS]


def _rank(
    chain: CoupledChain,
    kernel: Kernel,
    arm: Arm,
    degrees: dict[tuple[int, int], int],
    always: dict[tuple[int, int], Always],
    poses: Array,
) -> list[tuple[int, int]]:
    """The eliminations to keep, of the lowest degree first, then by solutions and precision."""
    some = list(degrees)
    out = Outputs.of(1, 2 * kernel.degree, 6)
    found, digits = np.zeros(len(some)), np.zeros(len(some))
    for k, elimination in enumerate(some):
        _choose(arm, [elimination], always)
        for T in poses:
            kernel.tried(chain.tables, arm, T[None], out)
            seeded, spans = arm["first"][0]
            found[k] += out.counts[0] / len(poses)
            digits[k] -= min(math.log10(max(seeded, 1e-16)) + min(spans, DEAREST), 0.0) / len(poses)
    order = np.argsort(-found - digits * WORTH, kind="stable")
    good = [some[k] for k in order if found[k] >= USABLE * found.max()]
    return sorted(good, key=lambda e: degrees[e])[:MOST]


def _choose(
    arm: Arm, eliminations: list[tuple[int, int]], always: dict[tuple[int, int], Always]
) -> None:
    """Set the eliminations of a record, and the roots that they have at every pose."""
    arm["trials"], arm["choices"][0, : len(eliminations)] = len(eliminations), eliminations
    arm["always"] = 0.0
    for k, elimination in enumerate(eliminations):
        for i, (place, half) in enumerate(always.get(elimination, [])):
            sine, cosine = sincos(place)
            arm["always"][0, k, i] = cosine, sine, half


def _random_poses(chain: CoupledChain) -> Array:
    """Reachable poses (POSES, 4, 4), the same ones each time."""
    rng = np.random.default_rng(0)
    return np.stack([chain.fk(q) for q in rng.uniform(-np.pi, np.pi, (POSES, 6))])


def blank_followers(chain: CoupledChain, kernel: Kernel) -> Arm:
    """The record (1,) of an arm, no eliminations chosen."""
    arm, n = np.zeros(1, kernel.record), len(chain.leaders)
    values, leader = np.array(chain.leaders), leaders_of(chain)[0]
    links, factors = chain.links.copy(), np.where(values == leader, chain.factors, 0.0)
    for i in np.flatnonzero((factors == 0.0) & (chain.factors < 0.0)):
        links[i], links[i + 1] = product(links[i], FLIP), product(FLIP, links[i + 1])
    by = np.where(factors == 0.0, 1.0, factors)
    short, _ = short_links(links, np.zeros(n, np.bool_), by * TURN[values])
    size = float(np.linalg.norm(short[1:n, :3, 3], axis=1).max()) or 1.0
    for name, table in tables_of(kernel.degree).items():
        arm[name] = table
    arm["motions"], arm["leader"], arm["size"] = n, leader, size
    arm["factors"][0, :n], arm["values"][0, :n] = factors, values
    arm["ends"], arm["zeros"] = inverse(short[[0, n]]), TURN
    arm["chain"][0, : n - 1] = short[1:n, :3]
    arm["chain"][0, : n - 1, :, 3] /= size
    return arm
