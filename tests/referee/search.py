"""All solutions that damped Newton steps lead to from random starts, in NumPy alone.

Of a pose, of its position, or of its position and the direction of its z axis.
"""

import math
from typing import Any

import numpy as np
from ik_referee import error_vectors, forward, gaps, jacobians

STEPS = 50
DAMPING = 0.3
"""Times the square of the error, lengths in sizes of the arm."""

REACHED = 1e-11
"""Error of what counts as found, in sizes of the arm and in rad."""

APART = 1e-4
"""Joint distance from which on two solutions are two [rad or m]."""


def task_errors(T: np.ndarray, T_target: np.ndarray, task: str) -> np.ndarray:
    """Differences of poses (k, 4, 4) from a target in a task, (k, 3 or 6), 0 at the target."""
    if task == "pose":
        return error_vectors(T, T_target)
    parts = [3] if task == "position" else [3, 2]
    return np.concatenate([T_target[:3, k] - T[..., :3, k] for k in parts], axis=-1)


def task_jacobians(arm: Any, q: np.ndarray, T: np.ndarray, task: str) -> np.ndarray:
    """The errors' derivatives, but for their sign, (k, 3 or 6, n)."""
    J = jacobians(arm, q)
    if task == "position+axis":
        J[..., 3:, :] = np.cross(J[..., 3:, :], T[..., :3, 2, None], axis=-2)
    return J[..., :3, :] if task == "position" else J


def search(
    arm: Any, T: np.ndarray, q: np.ndarray, moving: np.ndarray, task: str = "pose"
) -> np.ndarray:
    """Different solutions (k, n) from starts q (m, n); some joints keep their values."""
    q, weights = q.copy(), np.repeat((1.0 / arm.size, 1.0), 3)
    weights = weights[: 3 if task == "position" else 6]
    eye = np.eye(int(moving.sum()))
    error = np.inf
    for _ in range(STEPS):
        tips = forward(arm, q)
        e = task_errors(tips, T, task) * weights
        error = np.linalg.norm(e, axis=1)
        J = task_jacobians(arm, q, tips, task)[..., moving] * weights[:, None]
        JT = J.swapaxes(-1, -2)
        damped = (DAMPING * np.minimum(error, 1.0) ** 2 + 1e-14)[:, None, None] * eye
        step = np.linalg.solve(JT @ J + damped, JT @ e[..., None])[..., 0]
        length = np.maximum(np.abs(step).max(axis=1, keepdims=True), 1e-9)
        q[:, moving] += step * np.minimum(1.0, 0.6 / length)
    found = q[:0]
    for p in q[error < REACHED]:
        if not len(found) or gaps(arm, found, p).min() > APART:
            found = np.concatenate([found, p[None]])
    return found


def starts(arm: Any, q: np.ndarray, count: int, moving: np.ndarray, seed: int) -> np.ndarray:
    """Random configurations (count, n), but for joints that are held as in q (n,)."""
    made = np.random.default_rng(seed).uniform(-math.pi, math.pi, (count, arm.n))
    made[:, arm.prismatic] *= arm.size / math.pi
    made[:, ~moving] = q[~moving]
    return made
