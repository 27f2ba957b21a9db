"""The planar arm of two revolute joints, in closed form."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dh2urdf.doors import instance
from dh2urdf.robot import Robot
from dh2urdf.transforms import Array, inverse
from dh2urdf.workspace.task import PARALLEL


@dataclass(frozen=True)
class PlanarArm:
    """Two parallel revolute joints in series.

    Parameters
    ----------
    l1, l2 : float
        From axis 1 to axis 2, from there to the tip [m].
    T_base_plane : array, shape (4, 4)
        Origin on axis 1, z along it.
    offset : tuple of 3 floats
        Directions at q = 0 in the plane [rad]: of link 1, of link 2, of the tip's x axis.
    lower, upper : array, shape (2,)
    """

    l1: float
    l2: float
    T_base_plane: Array
    offset: tuple[float, float, float]
    lower: Array
    upper: Array

    def forward(self, t1: Array, t2: Array) -> tuple[Array, Array]:
        """Place of the tip in the plane [m] for angles t1 of link 1 and t2 between the links.

        Lecture notes, section 1.1: ``x = l1 c1 + l2 c12``, ``y = l1 s1 + l2 s12``.
        """
        x = self.l1 * np.cos(t1) + self.l2 * np.cos(t1 + t2)
        y = self.l1 * np.sin(t1) + self.l2 * np.sin(t1 + t2)
        return x, y

    def elbow(self, x: Array, y: Array) -> Array:
        """Angle between the links at a place, in [0, pi], NaN out of reach.

        Lecture notes, section 8.2, by the half angle: near 0 and pi the cosine loses digits.
        """
        r = np.hypot(x, y)
        over = (self.l1 + self.l2) ** 2 - r * r
        under = r * r - (self.l1 - self.l2) ** 2
        with np.errstate(invalid="ignore"):
            return 2.0 * np.arctan2(np.sqrt(over), np.sqrt(under))

    def shoulder(self, x: Array, y: Array, t2: Array) -> Array:
        """Angle of link 1 at a place for an angle t2 between the links."""
        return np.arctan2(y, x) - np.arctan2(self.l2 * np.sin(t2), self.l1 + self.l2 * np.cos(t2))

    def inside(self, t1: Array, t2: Array) -> NDArray[np.bool_]:
        """True where both joints keep their limits, full turns allowed."""
        first, between, _ = self.offset
        ok = np.ones(np.broadcast(t1, t2).shape, np.bool_)
        for k, q in enumerate((t1 - first, t2 - between)):
            if np.isfinite([self.lower[k], self.upper[k]]).all():
                turned = np.remainder(q - self.lower[k] + 1e-9, 2 * np.pi) - 1e-9
                ok &= turned <= self.upper[k] - self.lower[k] + 1e-9
        return ok


def planar_arm(robot: Robot) -> PlanarArm | None:
    """The robot as a planar RR arm; None where it is another."""
    chain = instance(robot, "robot", Robot).chain
    if chain.n != 2 or robot.is_coupled or chain.prismatic.any():
        return None
    z = chain.axes
    if abs(float(z[0] @ z[1])) < 1.0 - PARALLEL:
        return None
    T_plane_base = inverse(chain.joint_frames[0])
    elbow = (T_plane_base @ np.array([*chain.points[1], 1.0]))[:2]
    tool = T_plane_base @ chain.tool
    second = tool[:2, 3] - elbow
    l1, l2 = float(np.hypot(*elbow)), float(np.hypot(*second))
    if min(l1, l2) < 1e-9 or float(z[0] @ z[1]) < 0:
        return None
    first = math.atan2(elbow[1], elbow[0])
    between = math.atan2(second[1], second[0]) - first
    turn = math.atan2(tool[1, 0], tool[0, 0])
    return PlanarArm(
        l1, l2, chain.joint_frames[0], (first, between, turn), robot.lower, robot.upper
    )
