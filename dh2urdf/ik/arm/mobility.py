"""How many motions a chain has in nearly every configuration: joints to spare, weak directions."""

import numpy as np

from dh2urdf.chain import SerialChain
from dh2urdf.ik.arm.singular_families import task_jacobian
from dh2urdf.ik.arm.solver import Task
from dh2urdf.ik.arm.tolerances import NO_RANK, SPARE_RANK, WEAK_RANK
from dh2urdf.transforms import Array

TRIALS = 4
"""Random configurations on which the rank of the Jacobian is taken; one would nearly always do."""

MOST_JOINTS = 6
"""Joints of the longest chain that is looked at for weak directions."""


def random_configurations(chain: SerialChain, count: int) -> Array:
    """Configurations anywhere, the same ones each time, shape (count, n)."""
    rng = np.random.default_rng(2)
    span = np.where(chain.prismatic, chain.size, np.pi)
    return rng.uniform(-1.0, 1.0, (count, chain.n)) * span


def spare_joints(chain: SerialChain, task: Task) -> int:
    """Dimension of the motions that leave the task alone in every configuration."""
    q = random_configurations(chain, TRIALS)
    J = task_jacobian(chain, task, q)
    if not chain.n:
        return 0
    if task is not Task.POSITION:
        J[:, :3] /= chain.size
    sigma = np.linalg.svd(J, compute_uv=False)
    return chain.n - int((sigma > SPARE_RANK * sigma[:, :1]).sum(axis=1).max())


def hardly_moves(chain: SerialChain, task: Task) -> bool:
    """Whether the tool moves little in one direction everywhere, but more than within rounding."""
    if task is not Task.POSE or not 1 < chain.n <= MOST_JOINTS:
        return False
    J = task_jacobian(chain, task, random_configurations(chain, TRIALS))
    J[:, :3] /= chain.size
    sigma = np.linalg.svd(J, compute_uv=False)
    least = (sigma / sigma[:, :1]).max(axis=0)
    return bool(((least > NO_RANK) & (least < WEAK_RANK)).any())
