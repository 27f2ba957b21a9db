"""Chains of which one value moves several joints, and a search that is no part of the solver."""

import math

import numpy as np
from ik_referee import error_vectors, forward, gaps, jacobians, residuals

from dh2urdf.chain import CoupledChain, Coupling, SerialChain
from dh2urdf.dh import JointType
from dh2urdf.transforms import product, rot_x, rot_y, rot_z, trans

H = math.pi / 2

MULTIPLIERS = (1.0, -1.0, 2.0, 0.5)

AWAY = (0, 1, 2)
"""Free turns between a joint and its follower."""

NAMES = tuple("abcdef")


def random_links(rng, count, square):
    """Rigid transforms: any, or of right angles and few lengths."""
    if square:
        turns = rng.choice([0.0, H, -H, math.pi], (count, 3))
        ways = rng.choice([0.0, 0.1, 0.2, 0.3, -0.2], (count, 3))
    else:
        turns, ways = rng.uniform(-3, 3, (count, 3)), rng.uniform(-0.4, 0.4, (count, 3))
    return np.stack(
        [
            product(rot_z(a), rot_y(b), rot_x(c), trans(*way))
            for (a, b, c), way in zip(turns, ways, strict=True)
        ]
    )


def coupled(links, leaders, factors, names=NAMES):
    """A chain of turning joints, joint i at ``factors[i] q[leaders[i]]``, without limits."""
    N, n = len(leaders), max(leaders) + 1
    far, types = np.full(N, np.inf), (JointType.REVOLUTE,) * N
    chain = SerialChain(links, types, tuple(f"joint_{i + 1}" for i in range(N)), -far, far)
    matrix = np.zeros((N, n))
    matrix[np.arange(N), leaders] = factors
    bounds = np.full(n, np.inf)
    slides = np.zeros(n, bool)
    return CoupledChain.of(chain, Coupling(matrix, np.zeros(N), names[:n], -bounds, bounds, slides))


def follower_chain(seed, multiplier, away, square=False):
    """Six values; the leader is anywhere, its follower so many free turns behind it."""
    rng = np.random.default_rng(seed)
    leader = int(rng.integers(0, 6 - away))
    follower = leader + 1 + away
    leaders = [i if i < follower else leader if i == follower else i - 1 for i in range(7)]
    factors = [multiplier if i == follower else 1.0 for i in range(7)]
    return coupled(random_links(rng, 8, square), leaders, factors)


def search(chain, T, starts, seed=0):
    """Different solutions (k, n) that damped Newton steps from random starts lead to."""
    rng = np.random.default_rng(seed)
    q = rng.uniform(-math.pi, math.pi, (starts, chain.n))
    for _ in range(60):
        e, J = error_vectors(forward(chain, q), T), jacobians(chain, q)
        square = (e**2).sum(axis=1)
        JT = J.transpose(0, 2, 1)
        A = JT @ J + (0.3 * np.minimum(square, 1.0) + 1e-13)[:, None, None] * np.eye(chain.n)
        step = np.linalg.solve(A, JT @ e[:, :, None])[:, :, 0]
        q = q + step * np.minimum(1.0, 0.6 / np.maximum(np.abs(step).max(axis=1), 1e-9))[:, None]
    good = q[residuals(chain, q, T) < 1e-8]
    found = np.empty((0, chain.n))
    for p in good:
        if not len(found) or gaps(chain, found, p).min() > 1e-4:
            found = np.concatenate([found, p[None]])
    return found


def configurations(chain, count, seed):
    """Values (count, n) anywhere, every third of them near a singularity.

    Between two configurations whose determinants differ in sign there is a singular one; from it
    the values are off by 1e-6 to 1e-2.
    """
    rng = np.random.default_rng(seed)
    q = rng.uniform(-math.pi, math.pi, (count, chain.n))
    near = np.arange(0, count, 3)
    low, high = (rng.uniform(-math.pi, math.pi, (len(near), chain.n)) for _ in range(2))
    sign = np.sign(np.linalg.det(jacobians(chain, low)))
    other = np.sign(np.linalg.det(jacobians(chain, high))) != sign
    for _ in range(45):
        middle = 0.5 * (low + high)
        same = np.sign(np.linalg.det(jacobians(chain, middle))) == sign
        low[same], high[~same] = middle[same], middle[~same]
    away = 10.0 ** rng.uniform(-6, -2, (len(near), 1)) * rng.normal(size=(len(near), chain.n))
    q[near[other]] = (low + away)[other]
    return q
