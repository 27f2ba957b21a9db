"""The Pinocchio model of a table, without a file on the way.

It is the one that Pinocchio reads from the table's URDF: the same joints and frames in the same
order, with the same limits and masses.
"""

from collections.abc import Callable

import numpy as np
import pinocchio as pin

from dh2urdf.chain import SerialChain
from dh2urdf.conversions.write.bodies import draw_bodies
from dh2urdf.conversions.write.inertia import Inertial
from dh2urdf.conversions.write.link_masses import link_masses
from dh2urdf.conversions.write.table_chain import LinkFrames, link_frames
from dh2urdf.conversions.write.urdf_elements import (
    DEFAULT_EFFORT,
    DEFAULT_VELOCITY,
    check_names,
    default_limits,
)
from dh2urdf.conversions.write.urdf_options import UrdfOptions
from dh2urdf.dh import DHRow, DHTable, JointType
from dh2urdf.transforms import Array

UP, DOWN = np.array([0.0, 0.0, 1.0]), np.array([0.0, 0.0, -1.0])

BASE = "base_link_inertia"
"""The link that has the mass of the base."""


def table_model(table: DHTable, frames: LinkFrames) -> pin.Model:
    """The model of a table whose links weigh nothing yet, see :func:`add_masses`.

    Raises
    ------
    TableError
        A name that a URDF cannot have.
    """
    check_names(table)
    return _Builder(table, frames).model


class _Builder:
    """Joints and frames from the base on; what hangs on a link by the names of its joints."""

    def __init__(self, table: DHTable, frames: LinkFrames) -> None:
        self.table, self.frames, self.model = table, frames, pin.Model()
        self.joints, self.names = table.joints, table.joint_names
        self.model.name = table.name
        self._link("base_link", 0, 0)

    def _link(self, name: str, i: int, before: int) -> None:
        """Link i behind a frame, and all that hangs on it."""
        link = self.model.addBodyFrame(name, i, pin.SE3.Identity(), before)
        hung: dict[str, Callable[[], None]] = {}
        if i == 0:
            hung[f"{BASE}_fixed"] = lambda: self._fixed(BASE, i, link, np.eye(4))
        hung[f"dh_{i}_fixed"] = lambda: self._fixed(f"dh_{i}", i, link, self.frames.dh[i])
        if i < len(self.joints):
            hung[self.names[i]] = lambda: self._joint(i + 1, link)
        else:
            hung["tool0_fixed"] = lambda: self._fixed("tool0", i, link, self.frames.tool)
        for key in sorted(hung, key=str.encode):
            hung[key]()

    def _joint(self, i: int, before: int) -> None:
        """Joint i on the frame of the link before it, and its link."""
        row, name = self.joints[i - 1], self.names[i - 1]
        effort = DEFAULT_EFFORT if row.effort is None else row.effort
        velocity = DEFAULT_VELOCITY if row.velocity is None else row.velocity
        bounds = np.array([effort, velocity, *default_limits(self.table, i - 1)])
        place = pin.SE3(self.frames.origins[i - 1])
        model = self.model
        at = model.addJoint(i - 1, _joint_model(row), place, name, *bounds[:, None])
        v, friction = model.joints[at].idx_v, row.friction or 0.0
        model.damping[v], model.friction[v] = row.damping or 0.0, friction
        model.lowerDryFrictionLimit[v] = -friction
        self._link(f"link_{i}", i, model.addJointFrame(at, before))

    def _fixed(self, name: str, i: int, before: int, T: Array) -> None:
        """A link that is fixed to link i, and the joint that fixes it."""
        place, kind = pin.SE3(T), pin.FrameType.FIXED_JOINT
        joint = pin.Frame(f"{name}_fixed", i, before, place, kind)
        at = self.model.addFrame(joint, False)
        self.model.addBodyFrame(name, i, place, at)


def _joint_model(row: DHRow) -> pin.JointModel:
    """The joint of a row about or along its z, or against it."""
    if row.joint_type is JointType.PRISMATIC:
        return pin.JointModelPZ() if row.sign > 0 else pin.JointModelPrismaticUnaligned(DOWN)
    return pin.JointModelRZ() if row.sign > 0 else pin.JointModelRevoluteUnaligned(DOWN)


def add_masses(model: pin.Model, table: DHTable, chain: SerialChain) -> None:
    """Give the links of a table's model their masses; again, it changes nothing."""
    dh, bodies = link_frames(table).dh, draw_bodies(table, chain)
    base, *links = link_masses(table, dh, bodies, UrdfOptions())[0]
    model.inertias[0] = model.frames[model.getFrameId(f"{BASE}_fixed")].inertia = _inertia(base)
    for i, link in enumerate(links, 1):
        model.inertias[i] = _inertia(link)


def _inertia(body: Inertial) -> pin.Inertia:
    return pin.Inertia(body.mass, body.com, body.inertia)
