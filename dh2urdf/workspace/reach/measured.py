"""What is kept of the solutions of a pose: the best of three measures.

Of the task's Jacobian J, with lengths in [m] and angles in [rad]: ``sqrt(det(J J^T))``, the product
of its singular values (Yoshikawa, "Manipulability of robotic mechanisms", 1985), and the smallest
of them; and the distance of the joints from their limits.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dh2urdf.ik.arm import Task, task_jacobian
from dh2urdf.robot import Robot
from dh2urdf.transforms import Array


class Measures(NamedTuple):
    """Of m poses the largest over their solutions, -inf where there is none; each (m,).

    Attributes
    ----------
    manipulability
        ``sqrt(det(J J^T))``, of fewer joints than the task asks ``sqrt(det(J^T J))``.
    singular_value
        The smallest singular value of J.
    limit_margin
        The smallest distance of a joint from its limits [rad] or [m], negative beyond.
    """

    manipulability: Array
    singular_value: Array
    limit_margin: Array

    @classmethod
    def of(cls, m: int) -> "Measures":
        """Room for m poses, nothing found."""
        return cls(*np.full((3, m), -np.inf))


Integers = NDArray[np.integer[Any]]


def measure(
    robot: Robot, task: str, q: Array, count: Integers, out: Measures, at: Integers
) -> None:
    """Put the best of solutions q (m, k, n), the first ``count[i]`` of each, to ``out`` at (m,)."""
    chain, has = robot.chain, np.arange(q.shape[1]) < count[:, None]
    found = q[has]
    if not len(found):
        return
    sigma = np.linalg.svd(task_jacobian(chain, Task(task), found), compute_uv=False)
    sigma = sigma[:, : min(chain.n, {"pose": 6, "position": 3, "position+axis": 5}[task])]
    room = np.minimum(found - chain.lower, chain.upper - found).min(axis=1)
    for best, values in zip(out, (sigma.prod(axis=1), sigma[:, -1], room), strict=True):
        each = np.full(has.shape, -np.inf)
        each[has] = values
        best[at] = each.max(axis=1)
