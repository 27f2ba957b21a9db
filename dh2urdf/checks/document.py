"""A URDF read leniently: whatever can be understood of it, faults and all."""

import os
from collections.abc import Iterator, Mapping
from functools import cached_property
from pathlib import Path
from types import MappingProxyType

from lxml import etree

from dh2urdf.bounds import NUMBER as LARGEST
from dh2urdf.conversions.read import (
    FLOAT,
    MOVING,
    NOTHING,
    Xacro,
    count_elements,
    description_bytes,
)
from dh2urdf.conversions.write import TENSOR
from dh2urdf.dh_io.files import shown
from dh2urdf.dh_io.xml import parse_xml
from dh2urdf.exceptions import UrdfError

NUMBERS = {
    **dict.fromkeys((("origin", "xyz"), ("origin", "rpy"), ("axis", "xyz")), 3),
    **{("limit", key): 1 for key in ("lower", "upper", "effort", "velocity")},
    **{("inertia", key): 1 for key in TENSOR},
    **dict.fromkeys((("dynamics", "damping"), ("dynamics", "friction"), ("mass", "value")), 1),
    **dict.fromkeys((("mimic", "multiplier"), ("mimic", "offset"), ("sphere", "radius")), 1),
    **dict.fromkeys((("cylinder", "radius"), ("cylinder", "length")), 1),
    **dict.fromkeys((("box", "size"), ("mesh", "scale")), 3),
    ("color", "rgba"): 4,
}
"""Attributes that hold numbers, and how many."""


class Document:
    """Links and joints of a robot file, as far as they can be understood.

    Parameters
    ----------
    root : lxml element
        The ``<robot>``.
    path : Path
        Where it was read from; meshes are looked for from there.
    packages : dict
        Folders of ROS packages by name.
    """

    def __init__(
        self, root: etree._Element, path: Path, packages: Mapping[str, str] = MappingProxyType({})
    ) -> None:
        self.root, self.path, self.packages = root, path, packages
        self.links = list(root.iterchildren("link"))
        self.joints = list(root.iterchildren("joint"))
        self.lines: list[str] = []

    @classmethod
    def read(cls, path: str | os.PathLike[str], given: Xacro = NOTHING) -> "Document":
        """A file's robot.

        Raises
        ------
        UrdfError
            No such file, not XML, entities, or no ``<robot>``.
        """
        data, where = description_bytes(path, given)
        root = parse_xml(data, where)
        if root.tag != "robot":
            tag = shown(str(etree.QName(root).localname))
            hint = "; this is MJCF" if tag == "mujoco" else "; this is SDF" if tag == "sdf" else ""
            raise UrdfError(f"{where}:{root.sourceline}: the root is <{tag}>, not <robot>{hint}")
        for tag in ("link", "joint"):
            count_elements(root, tag, where)
        doc = cls(root, Path(path), given.packages)
        doc.lines = data.decode(errors="replace").split("\n")
        return doc

    def end(self, joint: etree._Element, tag: str) -> str:
        """Name of a joint's ``parent`` or ``child`` link; empty where there is none."""
        element = joint.find(tag)
        return "" if element is None else str(element.get("link", ""))

    def kind(self, joint: etree._Element) -> str:
        """Type of a joint."""
        return str(joint.get("type", ""))

    def numbers(self, element: etree._Element | None, key: str) -> list[float] | None:
        """Numbers of an attribute; None where they are missing, not finite or beyond 1e30."""
        text = None if element is None else element.get(key)
        if element is None or text is None:
            return None
        words = text.split()
        if len(words) != NUMBERS[(element.tag, key)] or not all(map(FLOAT.fullmatch, words)):
            return None
        values = [float(word) for word in words]
        return values if all(abs(value) <= LARGEST for value in values) else None

    def number(self, element: etree._Element | None, key: str) -> float | None:
        """One number of an attribute, or None."""
        values = self.numbers(element, key)
        return values[0] if values else None

    def with_numbers(self) -> Iterator[tuple[etree._Element, str, int]]:
        """Every element of the robot with an attribute that holds numbers, and how many."""
        for owner in (*self.links, *self.joints, *self.root.iterchildren("material")):
            for element in owner.iter(etree.Element):
                for key in element.attrib:
                    count = NUMBERS.get((element.tag, key))
                    if count:
                        yield element, str(key), count

    @cached_property
    def link_by_name(self) -> dict[str, etree._Element]:
        """The first link of each name."""
        return {str(link.get("name")): link for link in reversed(self.links) if link.get("name")}

    @cached_property
    def joint_by_name(self) -> dict[str, etree._Element]:
        """The first joint of each name."""
        return {str(j.get("name")): j for j in reversed(self.joints) if j.get("name")}

    @cached_property
    def edges(self) -> list[tuple[str, str, etree._Element]]:
        """``(parent, child, joint)`` of the joints whose ends are links of the file."""
        ends = ((self.end(j, "parent"), self.end(j, "child"), j) for j in self.joints)
        known = self.link_by_name
        return [(p, c, j) for p, c, j in ends if p in known and c in known and p != c]

    @cached_property
    def children(self) -> dict[str, list[tuple[str, etree._Element]]]:
        """Child links of each link with their joints, in the order of the file."""
        out: dict[str, list[tuple[str, etree._Element]]] = {name: [] for name in self.link_by_name}
        for parent, child, joint in self.edges:
            out[parent].append((child, joint))
        return out

    @cached_property
    def joint_above(self) -> dict[str, etree._Element]:
        """The joint that each link but the roots hangs on (the last, where there are several)."""
        return {child: joint for _, child, joint in self.edges}

    @cached_property
    def roots(self) -> list[str]:
        """Links that hang on nothing."""
        return [name for name in self.link_by_name if name not in self.joint_above]

    def rigid_part(self, link: str) -> list[str]:
        """The link and all that hangs on it by fixed joints."""
        part = [link]
        for name in part:
            for child, joint in self.children[name]:
                if self.kind(joint) == "fixed" and child not in part:
                    part.append(child)
        return part

    @cached_property
    def moving(self) -> list[str]:
        """Links that a joint moves directly."""
        return [c for _, c, joint in self.edges if self.kind(joint) in MOVING]

    @cached_property
    def moved(self) -> set[str]:
        """Links that some joint moves, directly or from afar."""
        return self.below(self.moving)

    def below(self, links: list[str]) -> set[str]:
        """Links and all that hangs on them."""
        todo, seen = list(links), set(links)
        for name in todo:
            below = [child for child, _ in self.children[name] if child not in seen]
            seen.update(below)
            todo += below
        return seen

    def geometries(self) -> Iterator[tuple[etree._Element, etree._Element]]:
        """``(visual or collision, geometry)`` of every link; those without geometry left out."""
        for link in self.links:
            for tag in ("visual", "collision"):
                for shell in link.iterchildren(tag):
                    geometry = shell.find("geometry")
                    if geometry is not None:
                        yield shell, geometry

    @cached_property
    def mujoco(self) -> dict[str, str]:
        """Attributes of the ``<compiler>`` in a ``<mujoco>`` element."""
        compiler = self.root.find("mujoco/compiler")
        return {} if compiler is None else {str(k): str(v) for k, v in compiler.attrib.items()}

    def mujoco_reads(self, shell: etree._Element) -> bool:
        """True where MuJoCo keeps this geometry: collisions, and visuals on request."""
        return shell.tag == "collision" or self.mujoco.get("discardvisual") == "false"
