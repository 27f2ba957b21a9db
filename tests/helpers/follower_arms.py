"""Chains of which one value moves several joints, and a search that is no part of the solver."""

import math

import numpy as np

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


def _joints_at(chain, q):
    """Before each joint moves its pose, (k, 4, 4) each, and the tip's, by products."""
    T, joints = np.repeat(chain.links[:1], len(q), axis=0), []
    for link, v, factor in zip(chain.links[1:], chain.leaders, chain.factors, strict=True):
        joints.append(T)
        angle = factor * q[:, v]
        Z = np.repeat(np.eye(4)[None], len(q), axis=0)
        Z[:, 0, 0], Z[:, 1, 1] = np.cos(angle), np.cos(angle)
        Z[:, 1, 0], Z[:, 0, 1] = np.sin(angle), -np.sin(angle)
        T = T @ Z @ link
    return joints, T


def poses_at(chain, q):
    """Poses (k, 4, 4) at values q (k, n)."""
    return _joints_at(chain, q)[1]


def error(T_found, T):
    """Errors (k, 6) of poses: way, and half the sum of cross products."""
    T = np.broadcast_to(T, T_found.shape)
    turn = 0.5 * np.cross(T_found[:, :3, :3], T[:, :3, :3], axisa=1, axisb=1).sum(axis=1)
    wrong = np.einsum("kij,kij->k", T_found[:, :3, :3], T[:, :3, :3]) < 1.0
    turn[wrong] += 3.0
    return np.concatenate([T[:, :3, 3] - T_found[:, :3, 3], turn], axis=1)


def jacobians(chain, q):
    """Jacobians (k, 6, n) of values: sums over the joints that they move."""
    joints, tip = _joints_at(chain, q)
    J = np.zeros((len(q), 6, chain.n))
    for T, v, factor in zip(joints, chain.leaders, chain.factors, strict=True):
        z = factor * T[:, :3, 2]
        J[:, :3, v] += np.cross(z, tip[:, :3, 3] - T[:, :3, 3])
        J[:, 3:, v] += z
    return J


def smallest(chain, q):
    """Smallest singular values of the Jacobians at q (k, n), (k,)."""
    J = jacobians(chain, q)
    J[:, :3] /= chain.size
    return np.linalg.svd(J, compute_uv=False)[:, -1]


def apart(q, p):
    """Largest difference of angles of configurations, up to full turns."""
    return np.abs(np.remainder(q - p + math.pi, 2.0 * math.pi) - math.pi).max(axis=-1)


def search(chain, T, starts, seed=0):
    """Different solutions (k, n) that damped Newton steps from random starts lead to."""
    rng = np.random.default_rng(seed)
    q = rng.uniform(-math.pi, math.pi, (starts, chain.n))
    for _ in range(60):
        e, J = error(poses_at(chain, q), T), jacobians(chain, q)
        square = (e**2).sum(axis=1)
        JT = J.transpose(0, 2, 1)
        A = JT @ J + (0.3 * np.minimum(square, 1.0) + 1e-13)[:, None, None] * np.eye(chain.n)
        step = np.linalg.solve(A, JT @ e[:, :, None])[:, :, 0]
        q = q + step * np.minimum(1.0, 0.6 / np.maximum(np.abs(step).max(axis=1), 1e-9))[:, None]
    good = q[np.abs(error(poses_at(chain, q), T)).max(axis=1) < 1e-8]
    found = np.empty((0, chain.n))
    for p in good:
        if not len(found) or apart(found, p).min() > 1e-4:
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
