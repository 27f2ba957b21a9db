"""What is kept of the solutions of a pose: the best of three measures.

Of the task's Jacobian J, with lengths in [m] and angles in [rad]: ``sqrt(det(J J^T))``, the product
of its singular values (Yoshikawa, "Manipulability of robotic mechanisms", 1985), and the smallest
of them; and the distance of the joints from their limits.
"""

from dh2urdf.ik.problem import IKBatch
from dh2urdf.robot import Robot
from dh2urdf.transforms import Array
from dh2urdf.workspace.measures import measure_best

MEASURES = "manipulability", "singular_value", "limit_margin"
"""Names of what `measure` finds, in its order."""


def measure(robot: Robot, task: str, found: IKBatch, best: Array) -> None:
    """The best of each measure over the solutions of m poses, to ``best`` (3, m).

    Manipulability, the smallest singular value, and the smallest distance of a joint from its
    limits [rad] or [m], negative beyond; -inf where there is no solution.
    """
    measure_best(robot, task, found.q, found.count, best)
