"""Why a pose has no solution, and by how much: a sentence for the user.

The arm's closest approach is found by damped least squares from many starts; this explains an
empty result and is no part of finding solutions.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from dh2urdf.chain import SerialChain
from dh2urdf.ik.arm.geometry import AxisLines
from dh2urdf.ik.arm.singular_families import task_error, task_jacobian
from dh2urdf.ik.arm.solver import Task
from dh2urdf.ik.arm.tolerances import ACCEPT
from dh2urdf.transforms import Array, inverse

__all__ = ["beyond_limits", "closest", "shortfall"]

STARTS = 64
STEPS = 60

FAR = 1e6
"""Distance, in sizes of the arm, at which the arm is a point."""

LESS = 0.05
"""Damping after a good step; in a valley it has to fall below the square of its slope."""

STIFF = 1e3
"""Weight of the position against the orientation where the position comes first."""


def shortfall(chain: SerialChain, T: Array, task: Task) -> str:
    """Say what part of a pose T (4, 4) a chain cannot reach, limits aside, and by how much."""
    away = math.dist(T[:3, 3], chain.links[0, :3, 3])
    if away > FAR * chain.size:
        return f"the point lies {_metres(away * chain.unit)} outside the reach of the tool"
    if chain.n == 6 and task is Task.POSE and AxisLines(chain).spherical(3):
        centre = AxisLines(chain).points[4]
        point = T[:3, :3] @ (inverse(chain.tool)[:3] @ np.append(centre, 1.0)) + T[:3, 3]
        gap, _ = closest(_arm_to(chain, 3, centre), _at(point), Task.POSITION)
        if gap > ACCEPT:
            apart = _metres(gap * chain.unit)
            return f"the wrist centre lies {apart} outside the reach of joints 1 to 3"
    gap, _ = closest(chain, T, Task.POSITION)
    if gap > ACCEPT:
        return f"the point lies {_metres(gap * chain.unit)} outside the reach of the tool"
    _, turn = closest(chain, T, task)
    what = "axis" if task is Task.POSITION_AXIS else "orientation"
    return (
        f"the tool reaches the point, but not with this {what}; the closest found is "
        f"{math.degrees(turn):.3g} deg away"
    )


def beyond_limits(chain: SerialChain, q: Array) -> tuple[int, int, float]:
    """The configuration of q (k, n) that breaks its limits least: its row, joint and excess."""
    excess = np.maximum(chain.lower - q, q - chain.upper)
    worst = excess.max(axis=1)
    row = int(worst.argmin())
    return row, int(excess[row].argmax()), float(worst[row])


def closest(chain: SerialChain, T: Array, task: Task) -> tuple[float, float]:
    """Least position error [m] that is found, and least orientation error [rad] there.

    Levenberg's method from ``STARTS`` random configurations side by side.
    """
    _, error = nearly_reaching(chain, T, task, STIFF)
    weight = np.where(np.arange(error.shape[1]) < 3, STIFF / chain.size, 1.0)
    best = error[((error * weight) ** 2).sum(axis=1).argmin()]
    return float(np.linalg.norm(best[:3])), float(np.linalg.norm(best[3:]))


def nearly_reaching(
    chain: SerialChain, T: Array, task: Task, stiff: float = 1.0
) -> tuple[Array, Array]:
    """Configurations (s, n) that come as near to a pose as they can, and their task errors.

    ``stiff`` is the weight of positions, in sizes of the arm, against the orientation.
    The steps are by singular values, not by normal equations, which lose the directions in which
    the pose hardly changes.
    """
    rng = np.random.default_rng(3)
    q = rng.uniform(-1.0, 1.0, (STARTS, chain.n)) * np.where(chain.prismatic, chain.size, np.pi)
    weight = np.ones(3 if task is Task.POSITION else 6)
    weight[:3] = stiff / chain.size
    error = _weighted(chain, q, T, task, weight)
    damping = np.full(STARTS, 1e-2)
    for _ in range(STEPS):
        U, sigma, Vt = np.linalg.svd(task_jacobian(chain, task, q) * weight[:, None], False)
        square = sigma**2 + (sigma**2).sum(axis=1, keepdims=True) * damping[:, None] + 1e-300
        along = np.einsum("kij,ki->kj", U, error) * sigma / square
        step = np.einsum("kij,ki->kj", Vt, along)
        step *= np.minimum(1.0, 0.5 / np.maximum(np.abs(step).max(axis=1), 1e-12))[:, None]
        trial = _weighted(chain, q + step, T, task, weight)
        better = (trial**2).sum(axis=1) < (error**2).sum(axis=1)
        q[better] += step[better]
        error[better] = trial[better]
        damping = np.clip(damping * np.where(better, LESS, 10.0), 1e-30, 1e3)
    return q, error / weight


def _weighted(chain: SerialChain, q: Array, T: Array, task: Task, weight: Array) -> Array:
    """Weighted task errors of configurations q (k, n), shape (k, 3 or 6)."""
    from dh2urdf.kernels.chain.forward import chain_fk_batch

    poses = np.empty((len(q), 4, 4))
    chain_fk_batch(chain.links, chain.prismatic, q, poses)
    return task_error(poses, T, task) * weight


def _arm_to(chain: SerialChain, joints: int, point: Array) -> SerialChain:
    """The first joints of a chain, with a point of the next link at q = 0 as the tool's origin."""
    last = inverse(chain.joint_frames[joints - 1]) @ _at(point)
    return replace(
        chain,
        links=np.concatenate([chain.links[:joints], last[None]]),
        joint_types=chain.joint_types[:joints],
        names=chain.names[:joints],
        lower=chain.lower[:joints],
        upper=chain.upper[:joints],
    )


def _at(point: Array) -> Array:
    """A pose with its origin at a point."""
    T = np.eye(4)
    T[:3, 3] = point
    return T


def _metres(gap: float) -> str:
    """A distance with as many digits as mean something."""
    if gap >= 1e4:
        return f"{gap:.5g} m"
    return f"{gap:.3f} m" if gap >= 0.01 else f"{gap:.2g} m"
