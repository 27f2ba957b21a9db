"""Drawn bodies of an arm: drums on the joints, capsule-like links, rails and rams that slide.

Each body is drawn in the URDF frame of its link, along the corner points of its link's path.
Thickness follows what a link has to carry, the length of the arm from there on, so that a toy
and a crane look alike and an arm on a long track stays an arm.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from dh2urdf.chain import SerialChain
from dh2urdf.conversions.write.inertia import Inertial
from dh2urdf.conversions.write.link_paths import link_paths
from dh2urdf.conversions.write.table_chain import link_frames
from dh2urdf.dh import DHTable, JointType
from dh2urdf.transforms import Array, pose, trans

LINK_RADIUS = 0.042
"""Radius of the first link's capsule, as a share of the arm's length."""

TAPER = 0.78
"""Least radius of a link over that of the link before it: the drum shows around the rod."""

DRUM = (1.45, 3.0)
"""Radius and length of a joint's drum, in radii of its link."""

SLEEVE = (3.2, 2.6)
"""Width and length of what slides on a rail, or of what a ram slides in, in radii."""

PEDESTAL = (2.3, 0.7)
"""Radius and height of the base, in radii of the first link."""

UNKNOWN_TRAVEL = 0.5
"""Travel drawn for a prismatic joint without limits, as a share of the arm's size."""


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


def draw_bodies(table: DHTable, chain: SerialChain) -> list[list[Body]]:
    """Bodies of base_link (index 0) and of links 1 ... n, each list in its link's frame."""
    return _Artist(table, chain).draw()


class _Artist:
    """One arm's frames, paths, travels and radii."""

    def __init__(self, table: DHTable, chain: SerialChain) -> None:
        self.joints = table.joints
        self.frames = link_frames(table)
        self.paths = link_paths(table, chain, self.frames)
        self.travels = [_travel(chain, i, row.sign) for i, row in enumerate(self.joints)]
        self.radii = self._radii(max(chain.size, 1e-3))

    def draw(self) -> list[list[Body]]:
        base, standing = self._pedestal()
        bodies = [[base, *_capsules(self.paths[0], self.radii[0])]]
        for i, path in enumerate(self.paths[1:]):
            r = self.radii[i + 1]
            parts = list(_capsules(path, r))
            if self.joints[i].joint_type is JointType.PRISMATIC:
                fixed, moving = self._slide(i)
                bodies[-1].append(fixed)
                parts.insert(0, moving)
            else:
                parts.insert(0, standing if i == 0 and standing else _drum(path[0], r, DRUM[1] * r))
            bodies.append(parts)
        return bodies

    def _radii(self, size: float) -> list[float]:
        """Radius of each link [m]: geometric mean of the arm (once) and what it carries (twice)."""
        lengths = [_length(path) for path in self.paths[1:]]
        whole = 0.0
        carried: list[float] = []
        for length, travel in zip(lengths[::-1], self.travels[::-1], strict=True):
            carried.insert(0, whole + length)
            whole = carried[0] + travel[1] - travel[0]
        whole = whole if whole > 1e-3 * size else size
        radii: list[float] = []
        for i, length in enumerate(carried):
            least = TAPER * radii[i - 1] if i else 0.25 * LINK_RADIUS * whole
            radii.append(max(LINK_RADIUS * math.cbrt(whole * length * length), least))
        return [radii[0], *radii]

    def _pedestal(self) -> tuple[Body, Body | None]:
        """The disc under the arm, and the first drum where it has to be fitted to the disc."""
        r = self.radii[0]
        radius, height = PEDESTAL[0] * r, PEDESTAL[1] * r
        column = _length(self.paths[0]) >= r
        if column or self.joints[0].joint_type is JointType.PRISMATIC:
            up = np.array([0.0, 0.0, -1.0 if self.paths[0][-1][2] < -r else 1.0])
            return _cylinder(0.5 * height * up, up, (radius, height), "base"), None
        start, foot = self.paths[1][:2]
        T_base_link = self.frames.origins[0]
        axis, leg = T_base_link[:3, 2], float(foot[2] - start[2])
        side = np.sign(leg) if abs(leg) > 1e-9 else (1.0 if axis[2] >= -1e-9 else -1.0)
        ground = (T_base_link @ np.array([*start, 1.0]))[:3]
        standing = None
        if abs(leg) > 1.5 * r:
            length = min(DRUM[1] * r, abs(leg) - height)
            centre = start + np.array([0.0, 0.0, side * (height + 0.5 * length)])
            standing = _drum(centre, r, length)
            middle = ground + 0.5 * height * side * axis
        else:
            middle = ground - 0.5 * (height + DRUM[1] * r) * side * axis
        return _cylinder(middle, axis, (radius, height), "base"), standing

    def _slide(self, i: int) -> tuple[Body, Body]:
        """What joint i slides on, in the link before it, and what slides, in its own link.

        A ram runs in a sleeve where the arm goes on along the axis, a sleeve on a rail where it
        turns off it.
        """
        r, d = self.radii[i + 1], self.joints[i].d
        width, length = SLEEVE[0] * r, SLEEVE[1] * r
        origin = self.frames.origins[i]
        low, high = self.travels[i]
        last = i + 1 == len(self.joints)
        follows = i > 0 and (last or self.joints[i + 1].joint_type is not JointType.PRISMATIC)
        turns_off = any(np.hypot(p[0], p[1]) > r for p in self.paths[i + 1])
        if follows and not turns_off:
            sleeve = _box(origin, -d, (width, width, length), "joint")
            ends = (min(0.0, -(high + d) - 0.6 * length), max(0.0, -(low + d) + 0.6 * length))
            ram = _box(np.eye(4), sum(ends) / 2, (1.6 * r, 1.6 * r, ends[1] - ends[0]), "rail")
            return sleeve, ram
        ends = (min(low - 0.6 * length, -d), max(high + 0.6 * length, -d))
        rail = _box(origin, sum(ends) / 2, (1.6 * r, 1.6 * r, ends[1] - ends[0]), "rail")
        return rail, _box(np.eye(4), 0.0, (width, width, length), "joint")


def _travel(chain: SerialChain, i: int, sign: int) -> tuple[float, float]:
    """Range of a prismatic joint along its own z [m]; (0, 0) for a revolute one."""
    if not chain.prismatic[i]:
        return 0.0, 0.0
    low = chain.lower[i] if np.isfinite(chain.lower[i]) else 0.0
    high = chain.upper[i] if np.isfinite(chain.upper[i]) else low + UNKNOWN_TRAVEL * chain.size
    a, b = sorted((float(sign * low), float(sign * high)))
    return a, b


def _length(path: list[Array]) -> float:
    return float(sum(np.linalg.norm(b - a) for a, b in pairwise(path)))


def _capsules(path: list[Array], r: float) -> Iterator[Body]:
    """A rod for each leg of the path, with a ball at every corner."""
    last = path[0]
    for point in path[1:]:
        leg = point - last
        length = float(np.linalg.norm(leg))
        if length < 0.2 * r:
            continue
        yield _cylinder((last + point) / 2, leg / length, (r, length), "link")
        yield Body("sphere", (r,), trans(*point), "link")
        last = point


def _drum(centre: Array, r: float, length: float) -> Body:
    return _cylinder(centre, np.array([0.0, 0, 1]), (DRUM[0] * r, length), "joint")


def _cylinder(centre: Array, axis: Array, size: tuple[float, float], material: str) -> Body:
    return Body("cylinder", size, pose(frame_along(axis), centre), material)


def _box(T: Array, z: float, size: tuple[float, float, float], material: str) -> Body:
    """A box along the z axis of a frame, its middle at height z."""
    middle = T @ np.array([0.0, 0.0, z, 1.0])
    return Body("box", size, pose(T[:3, :3], middle[:3]), material)


def frame_along(axis: Array) -> Array:
    """A rotation whose z is the given unit axis."""
    helper = np.eye(3)[int(np.argmin(np.abs(axis)))]
    x = np.cross(helper, axis)
    x /= np.linalg.norm(x)
    return np.stack([x, np.cross(axis, x), axis], axis=1)
