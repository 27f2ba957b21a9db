"""Arms with an ortho-parallel base and a spherical wrist, by the parameters that they are built to.

M. Brandstötter, A. Angerer and M. Hofbauer, *An Analytical Solution of the Inverse Kinematics
Problem of Industrial Serial Manipulators with an Ortho-parallel Basis and a Spherical Wrist*
(Austrian Robotics Workshop 2014). With ``t_i = sign_i q_i - offset_i`` and all ``t_i = 0`` the arm
stands straight up: axes 1, 4 and 6 point along z, axes 2, 3 and 5 along y, and::

    axis 2 through (a1, ., c1)    axis 3 c2 above it    wrist centre (a1 + a2, b, c1 + c2 + c3)

with the flange c4 above the wrist centre. T_base_flange is closed, see :meth:`OrthoParallel.fk`.
"""

import math
from dataclasses import dataclass, field
from typing import Any, Self

import numpy as np

from dh2urdf import transforms as tf
from dh2urdf.chain.serial_chain import SerialChain
from dh2urdf.dh import JointType
from dh2urdf.exceptions import NotOrthoParallelError
from dh2urdf.transforms import Array, dot, inverse, length, product

EXACT = 1e-9
"""Angle [rad], and length per m of arm, within which axes are what they must be."""

NONE = "no ortho-parallel arm with a spherical wrist"

LETTERS = ("a1", "a2", "b", "c1", "c2", "c3", "c4")

Six = tuple[float, float, float, float, float, float]

AXES = "zyyzyz"
"""Axes of the six joints where the arm stands straight up."""


def _identity() -> Array:
    return np.eye(4)


@dataclass(frozen=True, eq=False)
class OrthoParallel:
    """The seven lengths [m] of such an arm, with offsets [rad] and signs of its joints.

    Parameters
    ----------
    a1, a2, b, c1, c2, c3, c4 : float
    offsets, signs : tuple of six
        ``t_i = sign_i q_i - offset_i`` is zero where the arm stands straight up.
    base, tool : array, shape (4, 4)
        What the seven lengths cannot say: the base of the form in that of the arm, and the tip in
        the flange of the form. Mostly identities.
    """

    a1: float
    a2: float
    b: float
    c1: float
    c2: float
    c3: float
    c4: float
    offsets: Six
    signs: tuple[int, ...]
    base: Array = field(default_factory=_identity)
    tool: Array = field(default_factory=_identity)

    @classmethod
    def of_chain(cls, chain: SerialChain) -> Self:
        """The parameters of a chain.

        Raises
        ------
        NotOrthoParallelError
        """
        return cls(**_parameters(chain))

    def fk(self, q: Array) -> Array:
        """``T_base_tip`` at q (6,) by the closed form of the paper, shape (4, 4)."""
        t = np.asarray(self.signs) * q - np.asarray(self.offsets)
        forearm, bend = math.hypot(self.a2, self.c3), math.atan2(self.a2, self.c3)
        reach = self.a1 + self.c2 * math.sin(t[1]) + forearm * math.sin(t[1] + t[2] + bend)
        height = self.c1 + self.c2 * math.cos(t[1]) + forearm * math.cos(t[1] + t[2] + bend)
        wrist = product(tf.rot_z(t[3]), tf.rot_y(t[4]), tf.rot_z(t[5]))
        turned = product(tf.rot_y(t[1] + t[2]), wrist)
        out = product(tf.trans(reach, self.b, height), turned, tf.trans(0, 0, self.c4))
        return product(self.base, tf.rot_z(t[0]), out, self.tool)

    def chain(self, names: tuple[str, ...], lower: Array, upper: Array) -> SerialChain:
        """The serial chain of these parameters."""
        places = [
            (0.0, 0.0, 0.0),
            (self.a1, 0.0, self.c1),
            (0.0, 0.0, self.c2),
            (self.a2, self.b, self.c3),
            (0.0, 0.0, 0.0),
            (0.0, 0.0, 0.0),
        ]
        links, T = [], self.base
        for place, axis, sign, offset in zip(places, AXES, self.signs, self.offsets, strict=True):
            turn = tf.rot_z if axis == "z" else tf.rot_y
            facing = FACING[axis, sign]
            links.append(product(T, tf.trans(*place), turn(-offset), facing))
            T = facing.T
        links.append(product(T, tf.trans(0.0, 0.0, self.c4), self.tool))
        return SerialChain(np.stack(links), (JointType.REVOLUTE,) * 6, names, lower, upper)


FACING = {
    ("z", 1): np.eye(4),
    ("z", -1): np.diag([1.0, -1.0, -1.0, 1.0]),
    ("y", 1): np.array([[1.0, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]]),
    ("y", -1): np.array([[1.0, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1]]),
}
"""Rotations that take z to an axis or against it."""


def _check(chain: SerialChain) -> None:
    """Refuse other geometries, with every condition that fails."""
    z, points, near = chain.axes, chain.points, EXACT * max(1.0, chain.size)
    pairs = [(1, 2, "at right angles"), (2, 3, "parallel")]
    pairs += [(i, i + 1, "at right angles") for i in (3, 4, 5)]
    fails = []
    for i, j, what in pairs:
        along, across = dot(z[i - 1], z[j - 1]), length(np.cross(z[i - 1], z[j - 1]))
        off = (
            math.atan2(abs(along), across) if what != "parallel" else math.atan2(across, abs(along))
        )
        if off > EXACT:
            fails.append(f"axes {i} and {j} are not {what} ({off:.3g} rad off)")
    wrist = _wrist_centre(list(chain.joint_frames))
    gap = max(_distance(wrist, points[i], z[i]) for i in (3, 5))
    if gap > near:
        fails.append(f"axes 4, 5 and 6 do not meet in one point ({gap:.3g} m off)")
    if not fails and _distance(points[2], points[1], z[1]) <= near:
        fails.append("axes 2 and 3 are one line")
    if fails:
        raise NotOrthoParallelError(f"{NONE}: {'; '.join(fails)}")


def _distance(point: Array, start: Array, axis: Array) -> float:
    """Distance [m] of a point from a line."""
    return length(np.cross(point - start, axis))


def _base(z: Array, point: Array, near: float) -> Array:
    """The base of the form in that of the arm: axis 1 is its z through its origin, (4, 4)."""
    if _distance(np.zeros(3), point, z) <= near and length(z[:2]) <= EXACT:
        return np.eye(4)
    x = np.eye(3)[0 if abs(z[0]) < 0.9 else 1]
    x = x - z * dot(z, x)
    x /= length(x)
    origin = point - z * dot(z, point)
    return tf.pose(np.stack([x, np.cross(z, x), z], axis=1), origin)


def _frames(links: Array, q: list[float]) -> list[Array]:
    """Frames of the joints before their motion, then the tip, at q (6,)."""
    frames, T = [], links[0]
    for link, value in zip(links[1:], q, strict=True):
        frames.append(T)
        T = product(T, tf.rot_z(value), link)
    return [*frames, T]


def _turn(axis: str, v: Array, both_ways: bool = False) -> float:
    """Angle [rad] about z or y that takes a vector to y or to z; the smaller one of both ways."""
    angle = math.atan2(v[0], v[1]) if axis == "z" else -math.atan2(v[0], v[2])
    if both_ways and abs(angle) > 0.5 * math.pi + EXACT:
        angle -= math.copysign(math.pi, angle)
    return 0.0 if abs(angle) <= 1e-15 else abs(angle) if angle == -math.pi else angle


def _wrist_centre(frames: list[Array]) -> Array:
    """The point of axis 5 that is nearest to axis 4, (3,)."""
    axis, point = frames[4][:3, 2], frames[4][:3, 3]
    centre: Array = point + axis * dot(axis, frames[3][:3, 3] - point)
    return centre


def _offset(i: int, frames: list[Array], facing: bool) -> float:
    """Angle [rad] by which joint i + 1 turns the next axis upright; 1 to i stand so already."""
    z = [T[:3, 2] for T in frames]
    if i in (0, 3):
        return _turn("z", z[i + 1], both_ways=True)
    if i == 1:
        return _turn("y", frames[2][:3, 3] - frames[1][:3, 3])
    if i == 2:
        ahead = dot(_wrist_centre(frames) - frames[2][:3, 3], z[3])
        return _turn("y", z[3] * (1.0 if ahead > -EXACT else -1.0))
    if i == 4:
        outwards = math.copysign(1.0, dot(z[5], z[6])) if facing else 1.0
        return _turn("y", z[5] * outwards, both_ways=not facing)
    return _turn("z", frames[6][:3, 1]) if facing else 0.0


def _parameters(chain: SerialChain) -> dict[str, Any]:
    """Stand the arm straight up, joint by joint, and read its lengths there."""
    if chain.n != 6 or chain.prismatic.any():
        kinds = "".join("P" if slides else "R" for slides in chain.prismatic)
        raise NotOrthoParallelError(f"{NONE}: its joints are {kinds}, not RRRRRR")
    _check(chain)
    near = EXACT * max(1.0, chain.size)
    base = _base(chain.axes[0], chain.points[0], near)
    links = np.stack([product(inverse(base), chain.links[0]), *chain.links[1:]])
    tip, axis = chain.tool, chain.axes[5]
    facing = length(np.cross(tip[:3, 2], axis)) <= EXACT
    facing = facing and _distance(tip[:3, 3], chain.points[5], axis) <= near
    q, offsets, signs = [0.0] * 6, [], []
    for i, letter in enumerate(AXES):
        frames = _frames(links, q)
        signs.append(1 if frames[i]["xyz".index(letter), 2] > 0 else -1)
        offsets.append(_offset(i, frames, facing))
        q[i] = signs[i] * offsets[i]
    frames = _frames(links, q)
    elbow, centre, tip = frames[2][:3, 3], _wrist_centre(frames), frames[6]
    a1, c1 = frames[1][0, 3], frames[1][2, 3]
    heights = (c1, elbow[2] - c1, centre[2] - elbow[2], tip[2, 3] - centre[2])
    lengths = (a1, centre[0] - a1, centre[1], *heights)
    rounded = (0.0 if abs(v) <= 1e-15 * near / EXACT else float(v) for v in lengths)
    flange = tf.trans(centre[0], centre[1], tip[2, 3])
    tool = np.eye(4) if facing else product(inverse(flange), tip)
    found = dict(zip(LETTERS, rounded, strict=True))
    return {**found, "offsets": tuple(offsets), "signs": tuple(signs), "base": base, "tool": tool}
