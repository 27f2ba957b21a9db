"""An arm as it is drawn: its DH table, its bodies, and where they are at a configuration."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from dh2urdf.chain import SerialChain
from dh2urdf.conversions.assign import chain_to_dh
from dh2urdf.conversions.chains import following
from dh2urdf.conversions.write import (
    Body,
    dh_to_chain,
    draw_bodies,
    is_far,
    link_frames,
    straight_points,
)
from dh2urdf.dh import DHConvention, DHTable
from dh2urdf.doors import finite_array, instance
from dh2urdf.drawing.linkages import Bar, linkage_bars
from dh2urdf.exceptions import ConfigurationError
from dh2urdf.robot import Robot
from dh2urdf.transforms import Array, inverse, moved

OUTSIDE = 0.5
"""Distance from the arm, as a share of its size, above which a frame is moved to it."""


@dataclass(frozen=True, eq=False)
class DrawnArm:
    """A table, its chain, and what is drawn of it.

    ``bodies`` are those of base_link, of links 1 ... n and of the ``bars`` of parallelograms, each
    list in a frame of its own.
    """

    table: DHTable
    chain: SerialChain
    bodies: list[list[Body]]
    bars: list[Bar]

    def link_poses(self, q: Array) -> Array:
        """``T_base_link`` of base_link, links 1 ... n and bars at joints q (n,), (m, 4, 4)."""
        frames = self.table.frames(q)
        poses: Array = frames @ self._T_dh_link
        poses[0] = np.eye(4)
        return np.stack([*poses, *(bar.pose(frames) for bar in self.bars)])

    def bar_ends(self, q: Array) -> list[Array]:
        """Where bars begin and end in base at joints q (n,), each (2, 3)."""
        frames = self.table.frames(q)
        return [moved(bar.pose(frames), np.stack([0 * bar.along, bar.along])) for bar in self.bars]

    def frames(self, q: Array) -> Array:
        """DH frames 0 ... n in base at q (n,), moved by ``shifts`` along z, (n + 1, 4, 4)."""
        frames: Array = self.table.frames(q)
        frames[:, :3, 3] += self.shifts[:, None] * frames[:, :3, 2]
        return frames

    @cached_property
    def shifts(self) -> Array:
        """How far along its z each frame is moved to stand on the arm [m], shape (n + 1,).

        Zero but for calibrated arms: nearly parallel axes have their common normal, and with it a
        DH frame, hundreds of metres away. A frame turns with its link, so does its place there.
        """
        shifts = np.zeros(self.table.n + 1)
        if not is_far(self.table, self.chain):
            return shifts
        on_axis = slice(0, -1) if self.table.convention is DHConvention.STANDARD else slice(1, None)
        frames = self.table.frames(np.zeros(self.table.n))[on_axis]
        away = np.stack(straight_points(self.chain)[1:-1]) - frames[:, :3, 3]
        along = np.einsum("ij,ij->i", away, frames[:, :3, 2])
        shifts[on_axis] = np.where(np.abs(along) > OUTSIDE * self.size, along, 0.0)
        return shifts

    @cached_property
    def _T_dh_link(self) -> Array:
        return inverse(np.stack(link_frames(self.table).dh))

    @property
    def size(self) -> float:
        """Size of the arm [m]."""
        return max(self.chain.size, 1e-3)


def drawn_arm(table: DHTable) -> DrawnArm:
    """The bodies of a table."""
    chain = dh_to_chain(table)
    bodies = draw_bodies(table, chain)
    bars = linkage_bars(table, bodies)
    return DrawnArm(table, chain, [*bodies, *(bar.bodies for bar in bars)], bars)


def table_of(robot: Robot) -> DHTable:
    """The robot's own table, or the one that frame assignment finds for its chain."""
    instance(robot, "robot", Robot)
    if robot.table is not None:
        return robot.table
    table = chain_to_dh(robot.chain, name=robot.model.name).table
    return following(table, robot.followed_joints())


def arm_points(robot: Robot, Q: Array) -> Array:
    """Origins of the frames of a robot at configurations Q (m, n), on the arm, (m, k, 3)."""
    arm = drawn_arm(table_of(robot))
    return np.stack([arm.frames(q)[:, :3, 3] for q in robot.chain_configuration(Q)])


def zero_configuration(robot: Robot, q: ArrayLike | None) -> Array:
    """The configuration asked for, checked, or zero brought within the limits, shape (n,)."""
    if q is None:
        return np.clip(np.zeros(robot.n), robot.lower, robot.upper)
    expected = f"{robot.n} finite numbers ({', '.join(robot.joint_names)})"
    return finite_array(q, "q", expected, ConfigurationError, (robot.n,))
