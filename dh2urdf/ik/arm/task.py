"""What of a pose is asked: its error and Jacobian, and how chains move in it nearly everywhere."""

from enum import StrEnum
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dh2urdf.chain import CoupledChain, SerialChain
from dh2urdf.ik.arm.shared_tolerances import FAMILY_RANK, NO_RANK, SPARE_RANK, WEAK_RANK
from dh2urdf.kernels.chain import chain_fk_batch, chain_jacobian_batch
from dh2urdf.transforms import Array, dot, product

TRIALS = 4
"""Random configurations on which the rank of the Jacobian is taken; one would nearly always do."""

STILL = 1e-10
"""Part of a joint in a unit motion below which it stands still: half a turn moves the tool by less
than a solution may be off."""

MOST_JOINTS = 6
"""Joints of the longest chain that is looked at for weak directions."""


class Task(StrEnum):
    """What of the target pose has to be reached."""

    POSE = "pose"
    POSITION = "position"
    POSITION_AXIS = "position+axis"

    @property
    def number(self) -> int:
        """The task's number in the kernels."""
        return list(Task).index(self)


def task_error(T_found: Array, T: Array, task: Task) -> Array:
    """Error vectors of poses (k, 4, 4) against a target (4, 4), shape (k, 3 or 6).

    Position difference [m], then the rotation vector, as long as its sine, from the found to
    the target orientation; for ``position+axis`` that between the two z axes.
    """
    position = T[:3, 3] - T_found[:, :3, 3]
    if task is Task.POSITION:
        return position
    if task is Task.POSITION_AXIS:
        turn = np.cross(T_found[:, :3, 2], T[:3, 2])
        behind = dot(T_found[:, :3, 2], T[:3, 2]) < 0.0
    else:
        turn = 0.5 * np.cross(T_found[:, :3, :3], T[None, :3, :3], axisa=1, axisb=1).sum(axis=1)
        behind = np.einsum("kij,ij->k", T_found[:, :3, :3], T[:3, :3]) < 1.0
    turn[behind] = np.pi, 0.0, 0.0
    return np.concatenate([position, turn], axis=1)


def _joints(chain: SerialChain, q: Array) -> tuple[Array, NDArray[np.bool_]]:
    """Values (k, N) of the joints at configurations q (k, n), and which slide."""
    if isinstance(chain, CoupledChain):
        return np.ascontiguousarray(q @ chain.matrix.T), chain.sliding
    return np.ascontiguousarray(q), chain.prismatic


def _tips(chain: SerialChain, slides: NDArray[np.bool_], joints: Array) -> Array:
    """Poses (k, 4, 4) at values (k, N) of the joints."""
    T = np.empty((len(joints), 4, 4))
    chain_fk_batch(chain.links, slides, joints, T)
    return T


def tips_at(chain: SerialChain, q: Array) -> Array:
    """``T_base_tool`` at configurations q (k, n), shape (k, 4, 4)."""
    joints, slides = _joints(chain, q)
    return _tips(chain, slides, joints)


def task_jacobian(chain: SerialChain, task: Task, q: Array) -> Array:
    """Derivative of the task at configurations q (k, n), shape (k, 3 or 6, n).

    For ``position+axis`` the turn about the tool's own z is taken out.
    """
    q, slides = _joints(chain, q)
    J = np.empty((len(q), 6, q.shape[1]))
    chain_jacobian_batch(chain.links, slides, q, J)
    if isinstance(chain, CoupledChain):
        J = J @ chain.matrix
    if task is Task.POSITION:
        return J[:, :3]
    if task is Task.POSITION_AXIS:
        z = _tips(chain, slides, q)[:, :3, 2]
        J[:, 3:] -= z[:, :, None] * product(z[:, None], J[:, 3:])
    return J


def random_configurations(chain: SerialChain, count: int) -> Array:
    """Configurations anywhere, the same ones each time, shape (count, n)."""
    span = np.where(chain.prismatic, chain.size, np.pi)
    return _draws(count, chain.n) * span


@lru_cache(maxsize=8)
def _draws(count: int, n: int) -> Array:
    """Numbers from -1 to 1, the same ones each time, shape (count, n)."""
    return np.random.default_rng(2).uniform(-1.0, 1.0, (count, n))


def scaled_jacobian(chain: SerialChain, task: Task, q: Array) -> Array:
    """:func:`task_jacobian` with positions in sizes of the arm."""
    J = task_jacobian(chain, task, q)
    J[:, :3] /= chain.size
    return J


@lru_cache(maxsize=8)
def _singular_values(chain: SerialChain, task: Task) -> NDArray[np.floating[Any]]:
    """Singular values of the Jacobian at a few configurations, shape (``TRIALS``, k)."""
    J = scaled_jacobian(chain, task, random_configurations(chain, TRIALS))
    return np.linalg.svd(J, compute_uv=False)


def spare_joints(chain: SerialChain, task: Task) -> int:
    """Dimension of the motions that leave the task alone in every configuration."""
    sigma = _singular_values(chain, task)
    return chain.n - int((sigma > SPARE_RANK * sigma[:, :1]).sum(axis=1).max())


def hardly_moves(chain: SerialChain, task: Task) -> bool:
    """Whether the tool moves little in one direction everywhere, but more than within rounding."""
    if task is not Task.POSE or isinstance(chain, CoupledChain) or not 1 < chain.n <= MOST_JOINTS:
        return False
    sigma = _singular_values(chain, task)
    least = (sigma / sigma[:, :1]).max(axis=0)
    return bool(((least > NO_RANK) & (least < WEAK_RANK)).any())


def moving_joints(chain: SerialChain, task: Task, q: Array) -> NDArray[np.int64]:
    """Bits of the joints that move in the null space of the task at q (k, n)."""
    J = task_jacobian(chain, task, q)
    _, sigma, Vt = np.linalg.svd(J, full_matrices=True)
    full = np.zeros((len(q), chain.n))
    full[:, : sigma.shape[1]] = sigma
    null = full <= FAMILY_RANK * full[:, :1]
    motion = np.sqrt(((Vt * null[:, :, None]) ** 2).sum(axis=1))
    bits = (motion > STILL).astype(np.int64) << np.arange(chain.n)
    mask: NDArray[np.int64] = bits.sum(axis=1)
    return mask
