"""A URDF's links and joints, with every fault named by element and line."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NoReturn

import numpy as np
from lxml import etree

from dh2urdf import transforms as tf
from dh2urdf.conversions.inertia import Inertial, tensor
from dh2urdf.conversions.kinematic_tree import MOVING, KinematicTree, TreeJoint, TreeLink
from dh2urdf.conversions.model_to_chain import as_pinocchio_takes
from dh2urdf.dh_io.xml import parse_xml
from dh2urdf.exceptions import UrdfError
from dh2urdf.transforms import Array

__all__ = ["parse_xml", "read_urdf"]

KINDS = (*MOVING, "fixed", "floating", "planar", "spherical")

UNIT = 1e-6
"""How far from 1 the length of an axis may be without a remark: six written digits."""

FARTHEST = 1e9
"""Largest length [m] of an origin: beyond it sixteen digits no longer hold a micrometre."""

LARGEST = 1e30
"""Largest number of any kind: squares and products of it are still floats."""

TENSOR = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")


def read_urdf(root: etree._Element, where: str) -> KinematicTree:
    """Links and joints of a ``<robot>``.

    Parameters
    ----------
    where : str
        Name of the file, for messages.

    Raises
    ------
    UrdfError
        Something missing, unknown, not a number, or links that do not form one tree.
    """
    if root.tag != "robot":
        raise UrdfError(f"{where}:{root.sourceline}: root element is <{root.tag}>, not <robot>")
    reader = _Reader(where)
    links: dict[str, TreeLink] = {}
    for element in root.iterchildren("link"):
        link = reader.link(element)
        if link.name in links:
            reader.fail(element, "a second link of this name")
        links[link.name] = link
    joints: dict[str, TreeJoint] = {}
    for element in root.iterchildren("joint"):
        joint = reader.joint(element, links)
        if joint.name in joints:
            reader.fail(element, "a second joint of this name")
        joints[joint.name] = joint
    tree_root = _root(where, root, links, list(joints.values()))
    name = root.get("name") or "robot"
    warnings = tuple(reader.warnings)
    return KinematicTree(where, name, tree_root, links, tuple(joints.values()), warnings)


class _Reader:
    """Reads elements; knows the file's name."""

    def __init__(self, where: str) -> None:
        self.where = where
        self.warnings: list[str] = []

    def place(self, element: etree._Element) -> str:
        """``file:line: <tag name="...">``, with the element around it where it has no name."""
        name = element.get("name")
        text = f'<{element.tag} name="{name}">' if name else f"<{element.tag}>"
        parent = element.getparent()
        if name is None and parent is not None and parent.getparent() is not None:
            owner = parent if parent.get("name") else parent.getparent()
            text += f' of <{owner.tag} name="{owner.get("name", "")}">'
        return f"{self.where}:{element.sourceline}: {text}"

    def fail(self, element: etree._Element, message: str) -> NoReturn:
        raise UrdfError(f"{self.place(element)}: {message}")

    def numbers(
        self, element: etree._Element, key: str, count: int, default: Sequence[float]
    ) -> list[float]:
        """``count`` finite numbers of an attribute."""
        text = element.get(key)
        if text is None:
            return list(default)
        try:
            values = [float(word) for word in text.split()]
        except ValueError:
            hint = "; this is xacro, not URDF" if "$" in text else ""
            self.fail(element, f'{key}="{text}" is not {_numbers(count)}{hint}')
        if len(values) != count:
            self.fail(element, f'{key}="{text}" is not {_numbers(count)}')
        if not all(abs(value) <= LARGEST for value in values):
            self.fail(element, f'{key}="{text}" is not finite')
        return values

    def number(self, element: etree._Element | None, key: str) -> float | None:
        """One number of an attribute; None where it is missing or infinite."""
        if element is None or element.get(key) is None:
            return None
        if element.get(key, "").strip().lower().lstrip("+-") in ("inf", "infinity"):
            return None
        return self.numbers(element, key, 1, (0.0,))[0]

    def amount(self, element: etree._Element | None, key: str) -> float | None:
        """Like :meth:`number`, for what cannot be negative; left out with a remark if it is."""
        value = self.number(element, key)
        if value is not None and value < 0:
            self.warnings.append(f'{self.place(element)}: {key}="{value!r}" is negative; left out')
            return None
        return value

    def name(self, element: etree._Element) -> str:
        name = element.get("name")
        if not name:
            self.fail(element, "has no name")
        return str(name)

    def origin(self, element: etree._Element) -> Array:
        """``<origin xyz rpy>`` of an element as a pose."""
        origin = element.find("origin")
        if origin is None:
            return np.eye(4)
        zeros = (0.0, 0.0, 0.0)
        xyz = self.numbers(origin, "xyz", 3, zeros)
        if max(map(abs, xyz)) > FARTHEST:
            self.fail(origin, f'xyz="{origin.get("xyz")}" is farther than {FARTHEST:.0e} m')
        return tf.origin_matrix(xyz, self.numbers(origin, "rpy", 3, zeros))

    def link(self, element: etree._Element) -> TreeLink:
        name, inertial = self.name(element), element.find("inertial")
        body = None if inertial is None else self.inertial(inertial)
        return TreeLink(name, self.place(element), body)

    def inertial(self, element: etree._Element) -> Inertial | None:
        pose = self.origin(element)
        mass_element, tensor_element = element.find("mass"), element.find("inertia")
        mass = self.number(mass_element, "value") or 0.0
        six = [0.0] * 6
        if tensor_element is not None:
            six = [self.number(tensor_element, key) or 0.0 for key in TENSOR]
        if mass < 0:
            self.fail(element, f"a mass of {mass!r}")
        if mass == 0:
            return None
        return Inertial(mass, np.zeros(3), tensor(six)).moved(pose)

    def joint(self, element: etree._Element, links: dict[str, TreeLink]) -> TreeJoint:
        name, kind = self.name(element), element.get("type", "")
        if kind not in KINDS:
            self.fail(element, f'type="{kind}" is not one of {", ".join(KINDS)}')
        parent, child = (self.end(element, tag, links) for tag in ("parent", "child"))
        if parent == child:
            self.fail(element, f"joins link {child!r} to itself")
        origin = self.origin(element)
        moves = kind in MOVING
        axis = self.axis(element) if moves else np.array([1.0, 0.0, 0.0])
        limit = element.find("limit") if moves else None
        dynamics = element.find("dynamics") if moves else None
        mimic = element.find("mimic")
        lower, upper = self.bounds(element, kind, limit)
        return TreeJoint(
            name,
            kind,
            parent,
            child,
            origin=origin,
            axis=axis,
            where=self.place(element),
            lower=lower,
            upper=upper,
            velocity=self.amount(limit, "velocity") or None,
            effort=self.amount(limit, "effort") or None,
            damping=self.amount(dynamics, "damping"),
            friction=self.amount(dynamics, "friction"),
            mimic="" if mimic is None else mimic.get("joint", ""),
        )

    def end(self, element: etree._Element, tag: str, links: dict[str, TreeLink]) -> str:
        end = element.find(tag)
        if end is None or not end.get("link"):
            self.fail(element, f'has no <{tag} link="...">')
        name = str(end.get("link"))
        if name not in links:
            self.fail(end, f"no link is named {name!r}")
        return name

    def axis(self, element: etree._Element) -> Array:
        axis = element.find("axis")
        if axis is None:
            return np.array([1.0, 0.0, 0.0])
        if axis.get("xyz") is None:
            self.fail(axis, "has no xyz")
        vector = as_pinocchio_takes(np.array(self.numbers(axis, "xyz", 3, ())))
        length = math.hypot(*vector.tolist())
        if length < 1e-9 or length > FARTHEST:
            what = "a zero axis" if length < 1e-9 else "no direction"
            self.fail(axis, f'xyz="{axis.get("xyz")}" is {what}')
        if abs(length - 1) > UNIT:
            self.warnings.append(f"{self.place(axis)}: length {length:.6g}, taken as a direction")
        return vector if length == 1.0 else vector / length

    def bounds(
        self, element: etree._Element, kind: str, limit: etree._Element | None
    ) -> tuple[float | None, float | None]:
        if kind not in ("revolute", "prismatic"):
            return None, None
        if limit is None:
            self.warnings.append(f"{self.place(element)}: no <limit>; read as unlimited")
            return None, None
        lower, upper = (
            0.0 if limit.get(key) is None else self.number(limit, key) for key in ("lower", "upper")
        )
        if lower is not None and upper is not None and lower > upper:
            self.fail(limit, f"lower {lower!r} lies above upper {upper!r}")
        return lower, upper


def _numbers(count: int) -> str:
    return "a number" if count == 1 else f"{count} numbers"


def _root(
    where: str, element: etree._Element, links: dict[str, TreeLink], joints: Sequence[TreeJoint]
) -> str:
    """The one link that is nobody's child, after checking that all others hang on it."""
    if not links:
        raise UrdfError(f"{where}:{element.sourceline}: <robot> has no links")
    if not joints:
        raise UrdfError(f"{where}:{element.sourceline}: <robot> has no joints")
    above: dict[str, TreeJoint] = {}
    for joint in joints:
        if joint.child in above:
            raise UrdfError(
                f"{joint.where}: link {joint.child!r} hangs on joint "
                f"{above[joint.child].name!r} already; a URDF is a tree"
            )
        above[joint.child] = joint
    roots = [name for name in links if name not in above]
    if len(roots) > 1:
        raise UrdfError(
            f"{links[roots[1]].where}: a second root; {', '.join(map(repr, roots))} hang on nothing"
        )
    for joint in joints:
        seen, link = {joint.child}, joint.parent
        while link in above and link not in seen:
            seen.add(link)
            link = above[link].parent
        if link in seen:
            raise UrdfError(f"{joint.where}: closes a loop of links; a URDF is a tree")
    return roots[0]
