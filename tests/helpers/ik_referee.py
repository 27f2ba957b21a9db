"""What the inverse-kinematics tests share: arms, a forward kinematics of their own, a referee.

Nothing here uses the kernels: the product of the chain is NumPy, and the independent count of
solutions is a damped Newton search from many random starts.
"""

import math
from dataclasses import replace
from functools import cache
from typing import NamedTuple

import numpy as np

import dh2urdf
from dh2urdf.chain import CoupledChain, SerialChain
from dh2urdf.conversions.write.table_chain import dh_to_chain
from dh2urdf.dh import DHRow, DHTable, JointType
from dh2urdf.ik.arm import Outputs
from dh2urdf.ik.arm.solver_order import select_solver
from dh2urdf.ik.families.general_6r import General6R

HALF = math.pi / 2

RESIDUAL = 1e-9
"""What every solution keeps: distance from the pose [m], and sine of the angle from it."""

GAP = 1e-6
"""Joint distance [rad or m] from which on two solutions are two."""


class Found(NamedTuple):
    """The five output arrays of a solver."""

    q: np.ndarray
    residual: np.ndarray
    count: np.ndarray
    branch: np.ndarray
    free: np.ndarray

    def of(self, i):
        """Configurations, residuals, branch codes and masks of pose i."""
        k = self.count[i]
        return self.q[i, :k], self.residual[i, :k], self.branch[i, :k], self.free[i, :k]


table_of = cache(dh2urdf.load_table)


@cache
def shipped(name):
    return dh_to_chain(table_of(name))


CLOSED_FORMS = [
    name
    for name in dh2urdf.list_tables()
    if table_of(name).joint_map is None
    and shipped(name).n == 6
    and not shipped(name).prismatic.any()
    and not isinstance(select_solver(shipped(name)), General6R)
]


@cache
def arm(rows, kinds="RRRRRR", seed=0):
    """A chain of Denavit-Hartenberg steps (d, a, alpha) with random base, tool and zeros."""
    rng = np.random.default_rng(seed)
    links = [random_pose(rng, 0.2)]
    for d, a, alpha in rows:
        theta = rng.uniform(-3, 3)
        c, s = math.cos(theta), math.sin(theta)
        zero = np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1.0, 0], [0, 0, 0, 1.0]])
        c, s = math.cos(alpha), math.sin(alpha)
        step = np.array([[1, 0, 0, a], [0, c, -s, 0], [0, s, c, d], [0, 0, 0, 1.0]])
        links.append(zero @ step)
    links[-1] = links[-1] @ random_pose(rng, 0.2)
    types = tuple(JointType.PRISMATIC if k == "P" else JointType.REVOLUTE for k in kinds)
    names = tuple(f"joint_{i}" for i in range(1, len(rows) + 1))
    free = np.full(len(rows), math.inf)
    return SerialChain(np.stack(links), types, names, -free, free)


def changed(table, change):
    """The table with every parameter of every row changed."""
    keys = ("theta", "d", "a", "alpha")
    rows = (replace(row, **{k: change(getattr(row, k)) for k in keys}) for row in table.rows)
    return replace(table, rows=tuple(rows))


def noisy_table(name, size, seed):
    """A shipped arm as a factory calibrates it."""
    rng = np.random.default_rng(seed)
    return changed(dh2urdf.load_table(name), lambda x: x + size * float(rng.uniform(-1, 1)))


def random_robot(n, sliding=(), seed=0, turn=2.5):
    """An arm of n random rows with limits; some joints slide."""
    rng, rows = np.random.default_rng(seed), []
    for i in range(n):
        cells = rng.uniform((-3, -0.4, -0.4, -3), (3, 0.4, 0.4, 3)).tolist()
        kind, low, high = ("prismatic", 0.0, 0.5) if i in sliding else ("revolute", -turn, turn)
        rows.append(DHRow(*cells, kind, lower=low, upper=high))
    return dh2urdf.Robot.from_dh(DHTable(tuple(rows), "standard"))


def random_pose(rng, spread):
    Q = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    T = np.eye(4)
    T[:3, :3] = Q * np.linalg.det(Q)
    T[:3, 3] = rng.normal(size=3) * spread
    return T


def with_limits(chain, lower, upper):
    return SerialChain(
        chain.links,
        chain.joint_types,
        chain.names,
        np.broadcast_to(lower, chain.n).astype(float),
        np.broadcast_to(upper, chain.n).astype(float),
    )


def forward(chain, q):
    """Poses of configurations (..., n) by the product of the chain."""
    return frames(chain, q)[-1]


def frames(chain, q):
    """Poses of the joints at configurations (..., n), then of the tip: n + 1 of shape (..., 4, 4).

    A joint's is what its motion starts from. Of a coupled chain they are those of its serial one.
    """
    if isinstance(chain, CoupledChain):
        return frames(chain.serial, q @ chain.matrix.T)
    moves = joint_matrices(chain, q)
    T = [np.broadcast_to(chain.links[0], (*q.shape[:-1], 4, 4))]
    for i in range(chain.n):
        T.append(T[-1] @ moves[..., i, :, :] @ chain.links[i + 1])
    return T


def joint_matrices(chain, q):
    """Motions of all joints at configurations (..., n), (..., n, 4, 4)."""
    Z, angle = np.zeros((*q.shape, 4, 4)), np.where(chain.prismatic, 0.0, q)
    Z[..., 0, 0] = Z[..., 1, 1] = np.cos(angle)
    Z[..., 1, 0] = np.sin(angle)
    Z[..., 0, 1] = -Z[..., 1, 0]
    Z[..., 2, 2] = Z[..., 3, 3] = 1.0
    Z[..., 2, 3] = np.where(chain.prismatic, q, 0.0)
    return Z


FOLLOWING, LAST = np.array([1, 2, 0]), np.array([2, 0, 1])


def cross(a, b):
    """The vector product of the last axes, as np.cross, sooner."""
    return a.take(FOLLOWING, -1) * b.take(LAST, -1) - a.take(LAST, -1) * b.take(FOLLOWING, -1)


def error_vectors(T, T_target):
    """Position difference and rotation vector (sine long) from T to T_target, (..., 6)."""
    R, R_target = T[..., :3, :3], T_target[..., :3, :3]
    turn = 0.5 * cross(R.swapaxes(-1, -2), R_target.swapaxes(-1, -2)).sum(-2)
    behind = (R * R_target).sum((-1, -2)) < 1.0
    turn[behind] = math.pi
    return np.concatenate([T_target[..., :3, 3] - T[..., :3, 3], turn], axis=-1)


def residuals(chain, q, T_target):
    return pose_errors(forward(chain, q), T_target)


def pose_errors(T, T_target):
    """Larger of distance and sine of the angle between poses, (...)."""
    return larger_of(error_vectors(T, T_target))


def larger_of(errors):
    """The longer one of both halves of error vectors (..., 6), (...)."""
    halves = errors.reshape(*errors.shape[:-1], 2, 3)
    return np.sqrt((halves * halves).sum(-1)).max(-1)


def by_pinocchio(robot, q):
    """Poses of configurations (k, n), each by a call of its own, which is Pinocchio's."""
    return np.array([robot.fk(row) for row in q]).reshape(-1, 4, 4)


def jacobians(chain, q):
    """Geometric Jacobians at the tip in base axes, (..., 6, n)."""
    return jacobians_at(chain, frames(chain, q))


def jacobians_at(chain, placed):
    """The same from the :func:`frames` of configurations."""
    if isinstance(chain, CoupledChain):
        return jacobians_at(chain.serial, placed) @ chain.matrix
    T = np.stack(placed[:-1], -3)
    z, p, tip = T[..., :3, 2], T[..., :3, 3], placed[-1][..., None, :3, 3]
    slides = chain.prismatic[:, None]
    J = np.empty((*z.shape[:-2], 6, chain.n))
    J[..., :3, :] = np.where(slides, z, cross(z, tip - p)).swapaxes(-1, -2)
    J[..., 3:, :] = np.where(slides, 0.0, z).swapaxes(-1, -2)
    return J


def gaps(chain, q, p):
    """Largest joint difference of configurations modulo full turns, broadcast."""
    d = np.asarray(q) - np.asarray(p)
    return np.where(chain.prismatic, np.abs(d), np.abs(np.arcsin(np.sin(d / 2)) * 2)).max(-1)


def regularity(chain, q):
    """Smallest singular value of the Jacobian at configurations (..., n), lengths relative."""
    J = jacobians(chain, q)
    J[..., :3, :] /= chain.size
    return np.linalg.svd(J, compute_uv=False)[..., -1]


def exists(found):
    """Which rows of a batch are solutions, (m, k)."""
    return np.arange(found.q.shape[1]) < found.count[:, None]


def rows_of(found):
    """All solutions (k, n) of a batch, and the poses (k,) that they are of."""
    return found.q[exists(found)], np.repeat(np.arange(len(found.q)), found.count)


def misses(chain, found, q):
    """Distance of each configuration (m, n) from the nearest solution of its pose, (m,)."""
    away = gaps(chain, np.nan_to_num(found.q), q[:, None])
    return np.where(exists(found), away, np.inf).min(axis=1)


def distances(chain, found):
    """Distances between any two solutions of a pose, of all poses, (k,)."""
    q = [np.nan_to_num(found.q[found.count > i, : i + 1]) for i in range(found.q.shape[1])]
    return np.concatenate([gaps(chain, rows[:, -1:], rows[:, :-1]).ravel() for rows in q])


def draw(chain, m, seed):
    q = np.random.default_rng(seed).uniform(-math.pi, math.pi, (m, chain.n))
    q[:, chain.prismatic] *= 0.2
    return q


def solve(chain, Ts, within_limits=False, solver=None):
    solver = solver or select_solver(chain)
    Ts = np.ascontiguousarray(Ts)
    m, k = len(Ts), solver.kmax
    found = Found(
        np.full((m, k, chain.n), np.nan),
        np.full((m, k), np.nan),
        np.zeros(m, np.int64),
        np.zeros((m, k), np.int64),
        np.zeros((m, k), np.int64),
    )
    solver.solve_batch(Ts, within_limits, Outputs(*found))
    return found


def search(chain, T, seed, starts=400, steps=40):
    """All solutions that damped Newton finds from random starts, (k, n)."""
    q = draw(chain, starts, seed)
    for step in range(steps):
        placed = frames(chain, q)
        e, J = error_vectors(placed[-1], T), jacobians_at(chain, placed)
        damping = 1e-2 if step < steps // 2 else 1e-14
        A = J @ J.swapaxes(-1, -2) + damping * np.eye(6)
        dq = (J.swapaxes(-1, -2) @ np.linalg.solve(A, e[..., None]))[..., 0]
        q = q + np.clip(dq, -0.5, 0.5)
    q = q[residuals(chain, q, T) < 1e-12]
    distinct = []
    for candidate in q:
        if not distinct or gaps(chain, candidate, np.array(distinct)).min() > 1e-4:
            distinct.append(candidate)
    return np.array(distinct).reshape(-1, chain.n)


def same_to_rounding(chain, found, q, T, moving=slice(None)):
    """Whether a way leads from a solution to q on which the pose is T to rounding.

    It is one of the joints ``moving``. Where singularities meet, a pose is that of a whole stretch
    of configurations as far as double precision goes. The way goes towards q in directions in which
    the pose hardly changes, and is brought back to the stretch across them; every point has to
    reach T to 4e-15.
    """
    p, turning = found.copy(), ~chain.prismatic
    for _ in range(150):
        d = q - p
        d[turning] = (d[turning] + math.pi) % (2 * math.pi) - math.pi
        if np.abs(d).max() < 1e-5:
            return True
        _, sigma, Vt = np.linalg.svd(jacobians(chain, p)[:, moving])
        flat, step = Vt[sigma < 1e-5 * sigma[0]], np.zeros_like(d)
        step[moving] = flat.T @ (flat @ d[moving])
        if np.abs(step).max() < 0.1 * np.abs(d).max():
            return False
        p = p + step * min(1.0, 0.05 / np.abs(step).max())
        for _ in range(6):
            placed = frames(chain, p)
            e = error_vectors(placed[-1], T)
            if larger_of(e) < 4e-15:
                break
            p[moving] += np.linalg.pinv(jacobians_at(chain, placed)[:, moving], rcond=1e-5) @ e
        if residuals(chain, p, T) > 4e-15:
            return False
    return False


def on_flat_way(chain, found, q, T):
    """Whether the pose stays within 1e-9 of T on the straight way from a solution to q."""
    step = q - found
    turning = ~chain.prismatic
    step[turning] = (step[turning] + math.pi) % (2 * math.pi) - math.pi
    way = found + np.linspace(0.0, 1.0, 17)[:, None] * step
    return residuals(chain, way, T).max() < 1e-9
