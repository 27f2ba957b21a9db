"""Why a pose has no solution, and by how much: a sentence for the user.

The arm's closest approach is found by damped least squares from many starts; this explains an
empty result and is no part of finding solutions.
"""

import math

import numpy as np

from dh2urdf.chain import CoupledChain, SerialChain
from dh2urdf.ik.arm import ACCEPT, AxisLines, Task, part
from dh2urdf.ik.redundant import nearly_reaching
from dh2urdf.transforms import Array, inverse

FAR = 1e6
"""Distance, in sizes of the arm, at which the arm is a point."""

STIFF = 1e3
"""Weight of the position against the orientation where the position comes first."""


def shortfall(chain: SerialChain, T: Array, task: Task) -> str:
    """Say what part of a pose T (4, 4) a chain cannot reach, limits aside, and by how much."""
    away = math.dist(T[:3, 3], chain.links[0, :3, 3])
    if away > FAR * chain.size:
        return f"the point lies {_metres(away * chain.unit)} outside the reach of the tool"
    free = not isinstance(chain, CoupledChain)
    if free and chain.n == 6 and task is Task.POSE and AxisLines(chain).spherical(3):
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


def beyond_limits(chain: SerialChain, q: Array) -> tuple[int, float]:
    """The joint farthest beyond its limits where q (k, n) breaks them least, and its excess."""
    excess = np.maximum(chain.lower - q, q - chain.upper)
    row = excess[excess.max(axis=1).argmin()]
    return int(row.argmax()), float(row.max())


def closest(chain: SerialChain, T: Array, task: Task) -> tuple[float, float]:
    """Least position error [m] that is found, and least orientation error [rad] there.

    Levenberg's method from ``STARTS`` random configurations side by side.
    """
    _, error = nearly_reaching(chain, T, task, STIFF)
    weight = np.where(np.arange(error.shape[1]) < 3, STIFF / chain.size, 1.0)
    best = error[((error * weight) ** 2).sum(axis=1).argmin()]
    return float(np.linalg.norm(best[:3])), float(np.linalg.norm(best[3:]))


def _arm_to(chain: SerialChain, joints: int, point: Array) -> SerialChain:
    """The first joints of a chain, with a point of the next link at q = 0 as the tool's origin."""
    last = inverse(chain.joint_frames[joints - 1]) @ _at(point)
    return part(chain, np.concatenate([chain.links[:joints], last[None]]), list(range(joints)))


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
