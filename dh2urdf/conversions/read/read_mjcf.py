"""An MJCF's bodies and joints, as MuJoCo compiles them; the only importer of mujoco here."""

import os
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin

from dh2urdf import transforms as tf
from dh2urdf.bounds import ANGLE, LENGTH, LINKS
from dh2urdf.conversions.read.apart import read_apart
from dh2urdf.conversions.read.kinematic_tree import Actuation, KinematicTree, TreeJoint, TreeLink
from dh2urdf.conversions.read.urdf_elements import as_pinocchio_takes
from dh2urdf.conversions.write import Inertial
from dh2urdf.dh import Mimic
from dh2urdf.dh_io.files import shown
from dh2urdf.exceptions import UrdfError
from dh2urdf.transforms import Array

NUMBERS = "body_pos body_quat body_mass body_inertia body_ipos jnt_axis jnt_pos qpos0 site_pos"
"""What is read of a compiled model, by MuJoCo's own names."""

JOINT_EQUALITY = 2
"""``mjEQ_JOINT``."""

KINDS = ("free", "ball", "prismatic", "revolute")
"""MuJoCo's joint types in its own order."""


def read_mjcf(path: Path) -> tuple[KinematicTree, dict[str, int], pin.Model]:
    """Bodies and sites of an MJCF as links, the place of each joint in ``qpos``, and a model.

    A body with several joints becomes a row of links; a joint off its body's origin or with a
    reference value gets the steps that say so, so that q is MuJoCo's ``qpos``. The model is
    Pinocchio's own reading.
    """
    with read_apart("mjcf", path) as folder:
        import mujoco

        bodies = _Bodies(mujoco.MjModel.from_binary_path(str(folder / "mjb")), shown(path))
        model = pin.Model()
        model.loadFromBinary(str(folder / "pin"))
    return bodies.tree(), bodies.addresses, model


class _Bodies:
    """Walks a compiled model."""

    def __init__(self, model: Any, where: str) -> None:
        self.m, self.where = model, where
        self.links: dict[str, TreeLink] = {}
        self.joints: list[TreeJoint] = []
        self.addresses: dict[str, int] = {}

    def tree(self) -> KinematicTree:
        m = self.m
        if m.nbody + m.njnt + m.nsite > LINKS:
            raise UrdfError(f"{self.where}: more than {LINKS} bodies, joints and sites")
        for key in NUMBERS.split():
            if not (np.abs(getattr(m, key)) <= LENGTH).all():
                raise UrdfError(f"{self.where}: {key}: numbers that are no numbers or beyond 1e9")
        root = self.link(m.body(0).name or "world", None)
        names = {0: root}
        for b in range(1, m.nbody):
            names[b] = self.body(b, names[int(m.body_parentid[b])])
        for s in range(m.nsite):
            site = m.site(s).name
            if site and site not in self.links:
                pose = _pose(m.site_pos[s], m.site_quat[s])
                self.fixed(names[int(m.site_bodyid[s])], self.link(site, None), pose)
        if m.njnt == 0:
            raise UrdfError(f"{self.where}: no joints")
        name = os.path.splitext(os.path.basename(self.where))[0]
        remarks = self.follow()
        return KinematicTree(self.where, name, root, self.links, tuple(self.joints), remarks)

    def follow(self) -> tuple[str, ...]:
        """Let joints follow as ``<equality><joint>`` says; returns what is not taken over.

        MuJoCo's ``q1 - q1_0 = c0 + c1 (q2 - q2_0) + ...``, the references being ``qpos0``.
        """
        m, remarks, follows = self.m, list[str](), dict[str, Mimic]()
        for e in range(m.neq):
            if m.eq_type[e] != JOINT_EQUALITY or not m.eq_active0[e] or m.eq_obj2id[e] < 0:
                continue
            ids = int(m.eq_obj1id[e]), int(m.eq_obj2id[e])
            own, other = (m.joint(j).name or f"joint_{j}" for j in ids)
            constant, factor, *higher = m.eq_data[e][:5].tolist()
            bent, circle = any(higher), other == own
            at = other
            while at in follows and not circle:
                at = follows[at].joint
                circle = at == own
            if bent or circle or own in follows:
                why = "no straight line" if bent else "in a circle" if circle else "of a second one"
                remarks.append(
                    f"{self.where}: <equality> of joint {shown(own)!r}, {why}; not followed"
                )
                continue
            start, lead = (float(m.qpos0[m.jnt_qposadr[j]]) for j in ids)
            follows[own] = Mimic(other, factor, start + constant - factor * lead)
        self.joints = [replace(j, mimic=follows.get(j.name)) for j in self.joints]
        return tuple(remarks)

    def body(self, b: int, parent: str) -> str:
        """Links and joints from a body's parent to the body."""
        m = self.m
        name = m.body(b).name or f"body_{b}"
        pose = _pose(m.body_pos[b], m.body_quat[b])
        first, count = int(m.body_jntadr[b]), int(m.body_jntnum[b])
        for j in range(first, first + count):
            carrier = self.link(f"{name}/{m.joint(j).name or j}", None)
            pose = self.moving(j, parent, carrier, pose)
            parent = carrier
        inertial = None
        if m.body_mass[b] > 0:
            principal = Inertial(float(m.body_mass[b]), np.zeros(3), np.diag(m.body_inertia[b]))
            inertial = principal.moved(_pose(m.body_ipos[b], m.body_iquat[b]))
        self.fixed(parent, self.link(name, inertial), pose)
        return name

    def moving(self, j: int, parent: str, child: str, pose: Array) -> Array:
        """One joint; returns the body in the frame that it moves."""
        m = self.m
        kind = KINDS[int(m.jnt_type[j])]
        anchor = tf.trans(*(float(v) for v in m.jnt_pos[j]))
        axis = as_pinocchio_takes(np.array(m.jnt_axis[j], float))
        rest = np.eye(4)
        if kind in ("revolute", "prismatic"):
            if not np.linalg.norm(axis) > 0.5:
                raise UrdfError(f"{self.where}: joint {m.joint(j).name!r}: no direction")
            reference = -float(m.qpos0[m.jnt_qposadr[j]])
            if kind == "revolute":
                rest[:3, :3] = tf.rotation(axis, reference)
            else:
                rest[:3, 3] = axis * reference
        limited = bool(m.jnt_limited[j])
        far = LENGTH if kind == "prismatic" else ANGLE
        name = m.joint(j).name or f"joint_{j}"
        dof = int(m.jnt_dofadr[j])
        resists = (float(values[dof]) or None for values in (m.dof_damping, m.dof_frictionloss))
        drive = Actuation(None, None, *resists)
        self.addresses[name] = int(m.jnt_qposadr[j])
        where, origin = f'{self.where}: <joint name="{name}">', pose @ anchor
        low, high = (v if limited and abs(v) <= far else None for v in m.jnt_range[j].tolist())
        ends = parent, child
        self.joints.append(TreeJoint(name, kind, *ends, origin, axis, where, low, high, drive))
        return rest @ tf.inverse(anchor)

    def link(self, name: str, inertial: Inertial | None) -> str:
        self.links[name] = TreeLink(name, f'{self.where}: <body name="{name}">', inertial)
        return name

    def fixed(self, parent: str, child: str, pose: Array) -> None:
        axis = np.array([0.0, 0.0, 1.0])
        where = self.links[child].where
        self.joints.append(TreeJoint(f"{child}/fixed", "fixed", parent, child, pose, axis, where))


def _pose(position: Array, wxyz: Array) -> Array:
    """A pose from MuJoCo's position and quaternion (w first)."""
    return tf.pose(tf.quaternion_to_matrix(np.roll(wxyz, -1)), position)
