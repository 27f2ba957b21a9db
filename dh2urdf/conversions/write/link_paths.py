"""Where the URDF puts its links, and the corner points that each link's body runs along.

Link i lives in its own URDF link frame, whose z is the axis of joint i. Its body starts where
the link before it ends on that axis, follows the offset d along the axis to the foot of the
common normal (the frame's origin), then the common normal of length a to the next axis, then
any fixed step.
"""

import numpy as np

from dh2urdf.chain import SerialChain
from dh2urdf.conversions.write.table_chain import LinkFrames
from dh2urdf.dh import DHConvention, DHTable, JointType
from dh2urdf.transforms import Array, inverse

FAR = 2.5
"""A table whose lengths sum to this many times the arm's size has common normals far outside
the arm (calibrated arms); its links are drawn straight from axis to axis."""


def link_paths(table: DHTable, chain: SerialChain, frames: LinkFrames) -> list[list[Array]]:
    """Corner points [m] of base_link (index 0) and of links 1 ... n, each in its link's frame."""
    return _straight_paths(chain, frames) if is_far(table, chain) else _dh_paths(table, frames)


def is_far(table: DHTable, chain: SerialChain) -> bool:
    """Tell whether the common normals of a table lie far outside its arm."""
    return table.length > FAR * chain.size


def straight_points(chain: SerialChain) -> list[Array]:
    """From the base over a point on each axis to the tip, each the nearest to the one before.

    In base at q = 0 [m], n + 2 of shape (3,).
    """
    points = [np.zeros(3)]
    for point, axis in zip(chain.points, chain.axes, strict=True):
        points.append(point + axis * float(axis @ (points[-1] - point)))
    return [*points, chain.tool[:3, 3]]


def _dh_paths(table: DHTable, frames: LinkFrames) -> list[list[Array]]:
    """By the DH parameters."""
    zero = np.zeros(3)
    modified = table.convention is DHConvention.MODIFIED
    paths: list[list[Array]] = [[zero, frames.dh[0][:3, 3]]]
    for i, row in enumerate(table.joints, 1):
        slides = row.joint_type is JointType.PRISMATIC
        start = zero if slides else np.array([0.0, 0.0, -row.d])
        corners = [start, zero]
        if not modified:
            corners.append(np.array([row.a, 0.0, 0.0]))
        corners.append(frames.dh[i][:3, 3])
        paths.append(corners)
    paths[-1].append(frames.tool[:3, 3])
    if modified:
        for i, row in enumerate(table.joints):
            paths[i].append((frames.dh[i] @ np.array([row.a, 0.0, 0.0, 1.0]))[:3])
    return paths


def _straight_paths(chain: SerialChain, frames: LinkFrames) -> list[list[Array]]:
    """From axis to axis by the nearest points."""
    points = straight_points(chain)
    T_base_link, paths = np.eye(4), []
    for i in range(chain.n + 1):
        T_base_link = T_base_link @ frames.origins[i - 1] if i else T_base_link
        T_link_base = inverse(T_base_link)
        paths.append([T_link_base[:3, :3] @ p + T_link_base[:3, 3] for p in points[i : i + 2]])
    return paths
