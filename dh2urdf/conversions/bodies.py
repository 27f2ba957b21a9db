"""Drawn bodies of an arm: drums on the joints, capsule-like links, rails for prismatic joints.

Link i is drawn in its own URDF link frame, whose z is the axis of joint i. Its body starts
where the link before it ends on that axis, follows the offset d along the axis to the foot of
the common normal (the frame's origin), then the common normal of length a to the next axis,
then any fixed step. Sizes follow the arm's size, so that a toy and a crane look alike.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from dh2urdf.chain import SerialChain
from dh2urdf.conversions.dh_to_chain import split_row
from dh2urdf.conversions.inertia import Inertial
from dh2urdf.dh import DHConvention, DHRow, DHTable, JointType
from dh2urdf.transforms import Array, inverse

__all__ = ["Body", "LinkFrames", "draw_bodies", "link_frames"]

LINK_RADIUS = 0.040
"""Radius of the first link's capsule, as a share of the arm's size."""

TAPER = 0.5
"""Radius of the last link over that of the first."""

FAR = 10.0
"""A table whose lengths sum to this many times the arm's size has common normals far outside
the arm (calibrated arms); its links are drawn straight from axis to axis."""


@dataclass(frozen=True, eq=False)
class Body:
    """A solid in a link frame.

    Parameters
    ----------
    shape : str
        ``cylinder`` (size: radius, length along z), ``sphere`` (radius), ``box`` (x, y, z).
    size : tuple of float
        Lengths [m].
    pose : array, shape (4, 4)
        ``T_link_body``.
    material : str
    """

    shape: str
    size: tuple[float, ...]
    pose: Array
    material: str

    @property
    def volume(self) -> float:
        """Volume [m^3]."""
        if self.shape == "sphere":
            return 4.0 / 3.0 * np.pi * self.size[0] ** 3
        if self.shape == "cylinder":
            return float(np.pi * self.size[0] ** 2 * self.size[1])
        return float(np.prod(self.size))

    def inertial(self, density: float) -> Inertial:
        """Mass properties of the solid in the link frame, density in [kg/m^3]."""
        m = density * self.volume
        if self.shape == "sphere":
            moments = np.full(3, 0.4 * m * self.size[0] ** 2)
        elif self.shape == "cylinder":
            r, h = self.size
            side = m * (3 * r * r + h * h) / 12
            moments = np.array([side, side, 0.5 * m * r * r])
        else:
            x, y, z = self.size
            moments = m / 12 * np.array([y * y + z * z, x * x + z * z, x * x + y * y])
        return Inertial(m, np.zeros(3), np.diag(moments)).moved(self.pose)


@dataclass(frozen=True, eq=False)
class LinkFrames:
    """Where the URDF puts its links.

    Parameters
    ----------
    origins : tuple of n arrays (4, 4)
        ``T_parent_link`` of each joint's ``<origin>``: base_link to link 1, link 1 to link 2, ...
    dh : tuple of n + 1 arrays (4, 4)
        DH frame i in the frame of link i (frame 0 in base_link).
    tool : array, shape (4, 4)
        ``tool0`` in the frame of link n.
    """

    origins: tuple[Array, ...]
    dh: tuple[Array, ...]
    tool: Array


def link_frames(table: DHTable) -> LinkFrames:
    """Split the DH product into URDF origins and DH frames.

    Standard DH: the tail ``Trans_x(a) Rot_x(alpha)`` of a row goes into the next joint's origin,
    the last one into the tool. Modified DH: the link frames are the DH frames.
    """
    origins: list[Array] = []
    dh = [table.base.matrix]
    for row in table.rows:
        if row.is_joint:
            before, after = split_row(row, table.convention)
            origins.append(dh[-1] @ before)
            dh.append(after)
        else:
            dh[-1] = dh[-1] @ row.transform(0.0, table.convention)
    return LinkFrames(tuple(origins), tuple(dh), dh[-1] @ table.tool.matrix)


def draw_bodies(table: DHTable, chain: SerialChain) -> list[list[Body]]:
    """Bodies of base_link (index 0) and of links 1 ... n, each list in its link's frame."""
    frames = link_frames(table)
    size = max(chain.size, 1e-3)
    radii = LINK_RADIUS * size * np.linspace(1.0, TAPER, table.n + 1)
    straight = table.length > FAR * size
    paths = _straight_paths(chain, frames) if straight else _dh_paths(table, frames)
    bodies: list[list[Body]] = []
    for i, path in enumerate(paths):
        r = float(radii[i])
        row = table.joints[i - 1] if i else None
        parts = list(_capsules(path, r))
        if row is None:
            parts.insert(0, _pedestal(path[0], r))
        elif row.joint_type is JointType.PRISMATIC:
            parts.insert(0, _box(np.zeros(3), np.eye(3), (3.2 * r, 3.2 * r, 2.6 * r), "joint"))
        else:
            parts.insert(0, _drum(path[0] + _stand(i, row, frames, r), r))
        if i < table.n and table.joints[i].joint_type is JointType.PRISMATIC:
            parts.append(_rail(table, i, frames.origins[i], float(radii[i + 1]), chain))
        bodies.append(parts)
    return bodies


def _dh_paths(table: DHTable, frames: LinkFrames) -> list[list[Array]]:
    """Corner points of each link's body in its own frame, by the DH parameters."""
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
    """From axis to axis by the nearest points, in each link's frame."""
    points = [np.zeros(3)]
    for point, axis in zip(chain.points, chain.axes, strict=True):
        points.append(point + axis * float(axis @ (points[-1] - point)))
    points.append(chain.tool[:3, 3])
    T_base_link, paths = np.eye(4), []
    for i in range(chain.n + 1):
        T_base_link = T_base_link @ frames.origins[i - 1] if i else T_base_link
        T_link_base = inverse(T_base_link)
        paths.append([T_link_base[:3, :3] @ p + T_link_base[:3, 3] for p in points[i : i + 2]])
    return paths


def _capsules(path: list[Array], r: float) -> Iterator[Body]:
    """A rod for each leg of the path, with a ball at every corner."""
    last = path[0]
    for point in path[1:]:
        leg = point - last
        length = float(np.linalg.norm(leg))
        if length < 0.2 * r:
            continue
        yield _cylinder((last + point) / 2, leg / length, (r, length), "link")
        yield Body("sphere", (r,), _pose(np.eye(3), point), "link")
        last = point


def _drum(centre: Array, r: float) -> Body:
    return _cylinder(centre, np.array([0.0, 0, 1]), (1.5 * r, 3.2 * r), "joint")


def _stand(i: int, row: DHRow, frames: LinkFrames, r: float) -> Array:
    """How far the first drum is raised to stand on the floor instead of in it."""
    on_floor = i == 1 and float(np.linalg.norm(frames.dh[0][:3, 3])) < r and row.d > 2.4 * r
    return np.array([0.0, 0.0, 1.6 * r if on_floor else 0.0])


def _pedestal(centre: Array, r: float) -> Body:
    return _cylinder(
        centre + np.array([0, 0, 0.4 * r]), np.array([0.0, 0, 1]), (2.4 * r, 0.8 * r), "base"
    )


def _rail(table: DHTable, i: int, origin: Array, r: float, chain: SerialChain) -> Body:
    """A box along prismatic joint i + 1 over its travel, in the frame of the link before it."""
    row = table.joints[i]
    low = chain.lower[i] if np.isfinite(chain.lower[i]) else 0.0
    high = chain.upper[i] if np.isfinite(chain.upper[i]) else 0.5 * chain.size
    ends = sorted((row.sign * low, row.sign * high))
    start, stop = min(ends[0], -row.d, 0.0), max(ends[1], -row.d, 0.0)
    length = max(stop - start, r)
    middle = origin @ np.array([0.0, 0.0, 0.5 * (start + stop), 1.0])
    return _box(middle[:3], origin[:3, :3], (1.6 * r, 1.6 * r, length), "rail")


def _cylinder(centre: Array, axis: Array, size: tuple[float, float], material: str) -> Body:
    return Body("cylinder", size, _pose(_frame_along(axis), centre), material)


def _box(centre: Array, R: Array, size: tuple[float, float, float], material: str) -> Body:
    return Body("box", tuple(float(s) for s in size), _pose(R, centre), material)


def _pose(R: Array, p: Array) -> Array:
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = R, p
    return T


def _frame_along(axis: Array) -> Array:
    """A rotation whose z is the given unit axis."""
    helper = np.eye(3)[int(np.argmin(np.abs(axis)))]
    x = np.cross(helper, axis)
    x /= np.linalg.norm(x)
    return np.stack([x, np.cross(axis, x), axis], axis=1)
