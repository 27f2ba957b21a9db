"""Why a pose has no solution, and by how much: a sentence for the user.

The arm's closest approach is found by damped least squares from many starts; this explains an
empty result and is no part of finding solutions.
"""

import math

import numpy as np

from dh2urdf.chain import CoupledChain, SerialChain
from dh2urdf.ik.arm import ACCEPT, AxisLines, Task, middle, part, tips_at, turned_to
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
    gap, turn = closest(chain, T, task)
    if max(gap, turn) <= ACCEPT:
        return (
            "the pose is not out of reach: a configuration comes to within "
            f"{math.degrees(turn):.3g} deg of it, but no solution is listed; ik_numeric may find it"
        )
    what = "axis" if task is Task.POSITION_AXIS else "orientation"
    return (
        f"the tool reaches the point, but not with this {what}; the closest found is "
        f"{math.degrees(turn):.3g} deg away"
    )


def all_outside(chain: SerialChain, count: int, q: Array) -> str:
    """Say that so many solutions are outside the limits; their joints, and members' of families.

    They are q (k, n), in any turns.
    """
    joint, excess = beyond_limits(chain, turned_to(chain, q, middle(chain)))
    by = f"{excess * chain.unit:.4g} m" if chain.prismatic[joint] else f"{excess:.4g} rad"
    return (
        f"all {count} solutions are outside the joint limits, the nearest by {by} at "
        f"{chain.names[joint]}"
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
    q, error = nearly_reaching(chain, T, task, STIFF)
    away, turns = np.linalg.norm(error[:, :3], axis=1), _angles(tips_at(chain, q), T, task)
    best = ((away * STIFF / chain.size) ** 2 + turns**2).argmin()
    return float(away[best]), float(turns[best])


def _angles(T_found: Array, T: Array, task: Task) -> Array:
    """Angles [rad] of the orientations, or axes, of poses (k, 4, 4) to that of T (4, 4), (k,)."""
    if task is Task.POSITION:
        return np.zeros(len(T_found))
    if task is Task.POSITION_AXIS:
        sine, cosine = np.cross(T_found[:, :3, 2], T[:3, 2]), T_found[:, :3, 2] @ T[:3, 2]
    else:
        sine = 0.5 * np.cross(T_found[:, :3, :3], T[None, :3, :3], axisa=1, axisb=1).sum(axis=1)
        cosine = 0.5 * (np.einsum("kij,ij->k", T_found[:, :3, :3], T[:3, :3]) - 1.0)
    angles: Array = np.arctan2(np.linalg.norm(sine, axis=1), cosine)
    return angles


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
