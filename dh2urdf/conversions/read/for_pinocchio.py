"""The bare kinematics of a URDF that has been read, as a text that Pinocchio takes."""

import math
from collections.abc import Collection

import numpy as np
import pinocchio as pin
from lxml import etree

from dh2urdf.conversions.read.kinematic_tree import KinematicTree
from dh2urdf.conversions.write import inertial_element
from dh2urdf.exceptions import UrdfError
from dh2urdf.transforms import Array

NUMBERS = ("xyz", "rpy", "lower", "upper", "effort", "velocity", "damping", "friction")

SNAP = 1e-12
"""Distance from x, y or z up to which Pinocchio takes an axis to be that one."""


def as_pinocchio_takes(axis: Array) -> Array:
    """The axis, or the coordinate axis that it misses by no more than 1e-12.

    Pinocchio has joints of their own for x, y and z (not for their opposites), and takes those up
    to this distance (Eigen's ``isApprox``): a picometre on an arm of a metre. The same axis is
    read here, so that a chain and Pinocchio's placement of it are one thing.
    """
    length = _square(axis)
    for unit in np.eye(3):
        if _square(axis - unit) <= SNAP * SNAP * min(length, 1.0):
            return unit
    return axis


def _square(v: Array) -> float:
    """Squared length, summed in Eigen's order."""
    x, y, z = v.tolist()
    return float(x * x + (y * y + z * z))


def bare_model(tree: KinematicTree, root: etree._Element, chain: Collection[str]) -> pin.Model:
    """Pinocchio's model of a URDF: its links with their inertias, its joints and their numbers.

    The numbers of origins and axes are the file's own, read anew; nothing else is left for
    urdfdom to stumble over.

    Parameters
    ----------
    root : lxml element
        The document, as :func:`~dh2urdf.conversions.read.urdf_tree.read_urdf` leaves it.
    chain : collection of str
        Joints that move; all others are held at 0.
    """
    robot = etree.Element("robot", name=tree.name)
    for name, link in tree.links.items():
        element = etree.SubElement(robot, "link", name=name)
        if link.inertial is not None:
            inertial_element(element, link.inertial)
    for joint in root.iterchildren("joint"):
        _joint(robot, joint, chain)
    try:
        model = pin.buildModelFromXML(etree.tostring(robot, encoding="unicode"))
    except (ValueError, RuntimeError) as error:
        raise UrdfError(f"{tree.where}: Pinocchio does not load it: {error}") from None
    for read in tree.joints:
        if read.name in chain and read.kind in ("revolute", "prismatic"):
            k = model.joints[list(model.names).index(read.name, 1)].idx_q
            model.lowerPositionLimit[k] = -math.inf if read.lower is None else read.lower
            model.upperPositionLimit[k] = math.inf if read.upper is None else read.upper
    return model


def _joint(robot: etree._Element, joint: etree._Element, chain: Collection[str]) -> None:
    name = joint.get("name")
    kind = joint.get("type") if name in chain else "fixed"
    bare = etree.SubElement(robot, "joint", name=name, type=kind)
    for tag in ("parent", "child"):
        etree.SubElement(bare, tag, link=joint.find(tag).get("link"))
    parts = ("origin", "axis", "limit", "dynamics") if kind != "fixed" else ("origin",)
    for tag in parts:
        part = joint.find(tag)
        if part is not None:
            keys = NUMBERS[-4:] if kind == "continuous" and tag == "limit" else NUMBERS
            numbers = {k: _plain(part.get(k)) for k in keys if k in part.attrib}
            if numbers:
                etree.SubElement(bare, tag, numbers)


def _plain(text: str) -> str:
    """The same numbers in digits that every program reads."""
    return " ".join(repr(float(word)) for word in text.split())
