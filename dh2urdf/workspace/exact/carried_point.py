"""A point that the arm carries, the tip or the wrist point, seen from axis 1."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from dh2urdf.chain import SerialChain
from dh2urdf.doors import choice, instance
from dh2urdf.exceptions import ArgumentError
from dh2urdf.ik.arm import part, pose_along
from dh2urdf.kernels.chain import chain_fk_batch, chain_jacobian_batch
from dh2urdf.robot import Robot
from dh2urdf.transforms import Array, inverse, product, trans
from dh2urdf.workspace.exact.box import Box, box_of

POINTS = ("tip", "wrist")
"""Points whose reach is asked for."""

ON_AXIS = 1e-9
"""Distance [sizes] of a point from an axis on which it counts as lying."""


class CarriedPoint(NamedTuple):
    """A point at the end of a chain, in a frame of axis 1.

    ``chain`` begins with joint 1 about or along z and ends at the point; ``T_base_axis`` is that
    frame, its origin nearest to axis 2: the shoulder. ``name`` is ``tip`` or ``wrist point``.
    ``box`` says of what the limits are a box: values q that move the joints, or the joints.
    """

    chain: SerialChain
    T_base_axis: Array
    name: str
    box: Box

    def places(self, q: Array) -> Array:
        """Where the point is (k, 3) for values (k, n) of what the box is of [m]."""
        T, joints = np.empty((len(q), 4, 4)), self.box.joints(q)
        chain_fk_batch(self.chain.links, self.chain.prismatic, np.ascontiguousarray(joints), T)
        return T[:, :3, 3]

    def jacobians(self, q: Array) -> tuple[Array, Array]:
        """Derivatives of the place by joints, and the axes of those that turn, each (k, 3, n)."""
        J, joints = np.empty((len(q), 6, self.chain.n)), self.box.joints(q)
        chain_jacobian_batch(
            self.chain.links, self.chain.prismatic, np.ascontiguousarray(joints), J
        )
        return J[:, :3], J[:, 3:]


def carried_point(robot: Robot, point: str) -> CarriedPoint:
    """The tip, or the wrist point: that of axis 4 nearest to axis 5.

    There the axes of a spherical wrist meet. Joints 1 to 3 alone place it. An arm of three joints,
    or of four of which the last rolls the tip on the spot, has none: there the tip is meant.

    Raises
    ------
    ArgumentError
        No such point; limits of values and of the joints that they move.
    """
    chain = instance(robot, "robot", Robot).chain
    choice(point, "point", POINTS)
    box = box_of(robot)
    if point == "tip":
        return _from_axis(chain, "tip", box)
    if box.moves is not None:
        raise ArgumentError(
            f"{robot.model.name} has joints that follow others: the section and the volume of its "
            "reach are not worked out; workspace draws a section of what is sampled"
        )
    tip_in_last = chain.links[-1][:3, 3]
    if chain.n == 3:
        return _from_axis(chain, "tip", box)
    three = box.of_first(3)
    if chain.n == 4 and not chain.prismatic[3] and _off_z(tip_in_last) < ON_AXIS * chain.size:
        return _from_axis(_ending(chain, tip_in_last), "tip", three)
    if chain.n not in (5, 6) or chain.prismatic[3:5].any():
        raise ArgumentError(
            f"{robot.model.name} has no wrist point: it needs five or six joints, of which the "
            "fourth and fifth turn"
        )
    link = chain.links[4]
    z, p = link[:3, 2], link[:3, 3]
    across = float(z[0] ** 2 + z[1] ** 2)
    if across < ON_AXIS**2:
        raise ArgumentError(f"{robot.model.name} has no wrist point: axes 4 and 5 are parallel")
    height = float(p[2] - z[2] * (z[0] * p[0] + z[1] * p[1]) / across)
    return _from_axis(_ending(chain, np.array([0.0, 0.0, height])), "wrist point", three)


def _off_z(p: Array) -> float:
    return float(np.hypot(p[0], p[1]))


def _ending(chain: SerialChain, p: Array) -> SerialChain:
    """Joints 1 to 3 of a chain, up to a point (3,) of joint 4's frame."""
    links = [*chain.links[:3], product(chain.links[3], trans(*p.tolist()))]
    return part(chain, np.stack(links), [0, 1, 2])


def _from_axis(chain: SerialChain, name: str, box: Box) -> CarriedPoint:
    """The chain in a frame on axis 1 whose origin is nearest to axis 2."""
    z, p = chain.axes[0], chain.points[0]
    origin = p
    if chain.n > 1:
        w, gap = chain.axes[1], chain.points[1] - p
        square = 1.0 - float(z @ w) ** 2
        slope = float(z @ gap) if square < ON_AXIS else float((z - w * (z @ w)) @ gap) / square
        origin = p + slope * z
    frame = pose_along(chain.joint_frames[0][:3, 0], z, origin)
    links = np.stack([product(inverse(frame), chain.links[0]), *chain.links[1:]])
    return CarriedPoint(replace(chain, links=links), frame, name, box)
