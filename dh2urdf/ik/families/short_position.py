"""One to three joints that put the tool's origin at a point: the task ``position``."""

import itertools

import numpy as np

from dh2urdf.chain import SerialChain
from dh2urdf.ik.arm import Others, SolverBase, Task, pose_along
from dh2urdf.kernels.short_chains import solve_short_positions
from dh2urdf.transforms import Array, dot, inverse, length, product

MOST_JOINTS = 3


class ShortPosition(SolverBase):
    """All configurations of one to three joints, turning or sliding, that reach a point."""

    name = "position arm"
    needs = "task position: one to three joints of any kind, each of which moves the tool's origin"
    solves = Task.POSITION
    if_spare = "some joints can move while the tool's origin stays"
    kmax = 4
    kernel = staticmethod(solve_short_positions)

    def __init__(self, chain: SerialChain, task: Task = Task.POSITION, others: Others = ()) -> None:
        super().__init__(chain, task, others)
        frames = axis_frames(chain)
        tip = product(inverse(frames[-1]), chain.tool)[:3, 3].copy()
        steps = [
            inverse(frames[0]),
            *(product(inverse(a), b) for a, b in itertools.pairwise(frames)),
        ]
        rest_unit = np.append(np.clip(0.0, chain.lower, chain.upper), chain.size)
        self.constants = chain.tables, np.stack(steps), tip, rest_unit

    def details(self) -> str:
        """Name the kinds of joints and what is solved."""
        kinds = "".join("P" if slides else "R" for slides in self.chain.prismatic)
        if self.chain.n < MOST_JOINTS:
            return f"{kinds}; the distance and the height over an axis"
        return f"{kinds}; joint 3 from Pieper's quartic, joints 1 and 2 from distance and height"


def axis_frames(chain: SerialChain) -> list[Array]:
    """Frames F_i on the axes at q = 0; the first two turning ones on their common normal."""
    frames = [frame.copy() for frame in chain.joint_frames]
    if chain.n > 1 and not chain.prismatic[:2].any():
        frames[0], frames[1] = _on_common_normal(frames[0], frames[1])
    return frames


def _on_common_normal(first: Array, second: Array) -> tuple[Array, Array]:
    """Frames moved along and turned about their z to the common normal, x from first to second."""
    z1, z2 = first[:3, 2], second[:3, 2]
    p1, p2 = first[:3, 3], second[:3, 3]
    normal = np.cross(z1, z2)
    square = float(dot(normal, normal))
    gap = p2 - p1
    if square > 1e-18:
        foot1 = p1 + z1 * float(dot(np.cross(gap, z2), normal)) / square
        foot2 = p2 + z2 * float(dot(np.cross(gap, z1), normal)) / square
    else:
        foot1, foot2 = p1, p2 - z2 * float(dot(z2, gap))
    x = foot2 - foot1
    if np.linalg.norm(x) <= 1e-12 * max(1.0, float(np.linalg.norm(gap))):
        x = normal
    x = x / length(x)
    lines = (z1, foot1), (z2, foot2)
    first, second = (pose_along(x - z * float(dot(x, z)), z, foot) for z, foot in lines)
    return first, second
