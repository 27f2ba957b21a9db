"""Arms for the general 6R solver's tests, their kinematics and a search, written without it."""

import math

import numpy as np
from dh_product import rows

from dh2urdf import load_table

PI = math.pi
DEG = PI / 180.0

SHIPPED = {"crx10ia": "fanuc_crx10ia", "jaco2": "kinova_jaco2", "gofa5": "abb_gofa5"}
SHIPPED |= {name: name for name in ("xarm6", "ur5", "puma560")}
ARMS = {
    name: [(row.theta, row.d, row.a, row.alpha) for row in load_table(table).rows]
    for name, table in SHIPPED.items()
}
"""Rows (theta, d, a, alpha) of standard tables; Manseur & Doty 1989: 16 real solutions."""

ARMS["manseur_doty"] = rows("0 0 .3 h; 0 0 1 deg; 0 .2 0 h; 0 0 1.5 deg; 0 0 0 h; 0 0 0 deg")
for _seed in range(8):
    _rng = np.random.default_rng(_seed)
    ARMS[f"random{_seed}"] = [
        (*_rng.uniform((-PI, -0.5, -0.5), (PI, 0.5, 0.5)), _rng.uniform(-PI, PI)) for _ in range(6)
    ]
for _name in ("ur5", "puma560"):
    for _exponent in (12, 9, 6, 4, 3):
        _rng = np.random.default_rng(_exponent)
        ARMS[f"{_name}_1e-{_exponent}"] = [
            tuple(
                x + 10.0**-_exponent * e for x, e in zip(row, _rng.uniform(-1, 1, 4), strict=True)
            )
            for row in ARMS[_name]
        ]


def dh_matrix(theta, d, a, alpha):
    """``Rz(theta) Tz(d) Tx(a) Rx(alpha)`` of angles (m,) as (m, 4, 4)."""
    c, s = np.cos(theta), np.sin(theta)
    ca, sa = math.cos(alpha), math.sin(alpha)
    T = np.zeros((*np.shape(theta), 4, 4))
    T[..., 0, 0], T[..., 0, 1], T[..., 0, 2], T[..., 0, 3] = c, -s * ca, s * sa, a * c
    T[..., 1, 0], T[..., 1, 1], T[..., 1, 2], T[..., 1, 3] = s, c * ca, -c * sa, a * s
    T[..., 2, 1], T[..., 2, 2], T[..., 2, 3], T[..., 3, 3] = sa, ca, d, 1.0
    return T


def forward(rows, q):
    """``T_base_tool`` (m, 4, 4) of configurations (m, 6): the product of the table's rows."""
    T = np.broadcast_to(np.eye(4), (len(q), 4, 4))
    for i, (theta, d, a, alpha) in enumerate(rows):
        T = T @ dh_matrix(q[:, i] + theta, d, a, alpha)
    return T


def links_of(rows):
    """The constant transforms around the joints: links[0] = 1, links[i] = row i at q = 0."""
    return np.array([np.eye(4)] + [dh_matrix(np.float64(row[0]), *row[1:]) for row in rows])


def residuals(T, target):
    """Larger of position and orientation error, (m,)."""
    position = np.linalg.norm(T[:, :3, 3] - target[:, :3, 3], axis=1)
    chord = np.linalg.norm(T[:, :3, :3] - target[:, :3, :3], axis=(1, 2))
    return np.maximum(position, chord / math.sqrt(2.0))


def angular_distance(a, b):
    """Largest joint difference, wrapped, over the last axis."""
    return np.abs((a - b + PI) % (2 * PI) - PI).max(axis=-1)


def newton_search(rows, pose, starts, seed):
    """Isolated solutions of one pose by damped Newton from many random seeds, (k, 6)."""
    rng = np.random.default_rng(seed)
    q = rng.uniform(-PI, PI, (starts, 6))
    damping = np.full(starts, 1e-2)
    error, J = twist_and_jacobian(rows, q, pose)
    for _ in range(80):
        normal = J.transpose(0, 2, 1) @ J + damping[:, None, None] * np.eye(6)
        step = np.linalg.solve(normal, J.transpose(0, 2, 1) @ error[:, :, None])[:, :, 0]
        step *= np.minimum(1.0, 0.6 / np.maximum(np.abs(step).max(axis=1), 1e-9))[:, None]
        new_error, new_J = twist_and_jacobian(rows, q + step, pose)
        better = (new_error**2).sum(axis=1) < (error**2).sum(axis=1)
        q[better] += step[better]
        error[better], J[better] = new_error[better], new_J[better]
        damping = np.where(better, np.maximum(damping * 0.2, 1e-14), np.minimum(damping * 4, 1e3))
    reached = (np.abs(error).max(axis=1) < 1e-10) & (np.linalg.svd(J)[1][:, -1] > 1e-3)
    distinct = []
    for x in q[reached]:
        if all(angular_distance(x, y) > 1e-4 for y in distinct):
            distinct.append(x)
    return np.array(distinct).reshape(-1, 6)


def twist_and_jacobian(rows, q, pose):
    """Twist to the pose (m, 6), linear over angular, and geometric Jacobian (m, 6, 6)."""
    T = np.broadcast_to(np.eye(4), (len(q), 4, 4))
    frames = []
    for i, (theta, d, a, alpha) in enumerate(rows):
        frames.append(T)
        T = T @ dh_matrix(q[:, i] + theta, d, a, alpha)
    J = np.empty((len(q), 6, 6))
    for i, frame in enumerate(frames):
        J[:, :3, i] = np.cross(frame[:, :3, 2], T[:, :3, 3] - frame[:, :3, 3])
        J[:, 3:, i] = frame[:, :3, 2]
    turn = pose[:3, :3] @ T[:, :3, :3].transpose(0, 2, 1)
    axis = np.stack([turn[:, 2, 1], turn[:, 0, 2], turn[:, 1, 0]], axis=1) / 2
    axis -= np.stack([turn[:, 1, 2], turn[:, 2, 0], turn[:, 0, 1]], axis=1) / 2
    sine = np.linalg.norm(axis, axis=1)
    angle = np.arctan2(sine, (np.trace(turn, axis1=1, axis2=2) - 1) / 2)
    axis *= (angle / np.maximum(sine, 1e-12))[:, None]
    return np.hstack([pose[:3, 3] - T[:, :3, 3], axis]), J
