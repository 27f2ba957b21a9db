"""A robot description, of whatever format, as a tree and the way from base to tip in it."""

import math
import os
from collections.abc import Collection
from pathlib import Path
from typing import NamedTuple

import pinocchio as pin
from lxml import etree

from dh2urdf.bounds import ROBOT_BYTES
from dh2urdf.conversions.read.apart import read_apart
from dh2urdf.conversions.read.kinematic_tree import (
    MOVING,
    KinematicTree,
    choose_ends,
    find_path,
    link_name,
)
from dh2urdf.conversions.read.urdf_tree import read_urdf
from dh2urdf.conversions.read.xacro_file import NOTHING, Xacro
from dh2urdf.conversions.write import inertial_element
from dh2urdf.dh_io.files import read_bytes, shown
from dh2urdf.dh_io.names import shipped_name
from dh2urdf.dh_io.xml import parse_xml
from dh2urdf.doors import found
from dh2urdf.exceptions import UrdfError, VerificationError

NUMBERS = {
    "origin": ("xyz", "rpy"),
    "axis": ("xyz",),
    "limit": ("lower", "upper", "effort", "velocity"),
    "dynamics": ("damping", "friction"),
}
"""What Pinocchio is handed of an element; another attribute on it means nothing."""

TEXT = "URDF text"
"""How messages name a text that is no path."""


class Description(NamedTuple):
    """A chain in a robot description.

    Parameters
    ----------
    root : lxml element
        The document; of a URDF with all that was mended.
    model : pin.Model
        Pinocchio's own reading; of a URDF the joints of the chain, all others held at 0.
    addresses : dict
        Of an MJCF the place of each joint in q, else empty.
    mends : tuple of str
        What was set right, each with its element and line.
    """

    tree: KinematicTree
    base: str
    tip: str
    root: etree._Element
    model: pin.Model
    addresses: dict[str, int]
    mends: tuple[str, ...]

    @property
    def base_frame(self) -> str:
        """Name of the base in the model; Pinocchio calls the world of an MJCF otherwise."""
        world = self.addresses and self.base == self.tree.root
        return str(self.model.frames[0].name) if world else self.base


def description_bytes(source: str | os.PathLike[str], given: Xacro = NOTHING) -> tuple[bytes, str]:
    """Bytes of a file, a xacro expanded, or of a text that is a URDF; and its name in messages."""
    if isinstance(source, str) and source.lstrip().startswith("<"):
        return source.encode(errors="replace"), TEXT
    if not isinstance(source, str | os.PathLike):
        raise UrdfError(f"expected a path, got {found(source)}")
    if not os.path.exists(source) and (name := shipped_name(os.fsdecode(source))):
        raise UrdfError(
            f"{shown(source)}: there is no such file; {name} is a table that ships, not a robot "
            f"description: dh2urdf show {name} prints it, dh2urdf convert {name} writes its URDF"
        )
    data = read_bytes(source, ROBOT_BYTES, UrdfError)
    if is_xacro(source):
        folders = {name: os.path.abspath(folder) for name, folder in given.packages.items()}
        with read_apart("xacro", Path(source), Xacro(given.args, folders)) as folder:
            data = read_bytes(folder / "text", ROBOT_BYTES, UrdfError)
    elif given.args:
        raise UrdfError(f"{shown(source)}: arguments are for a .xacro, which this is not")
    return data, shown(source)


def is_xacro(path: str | os.PathLike[str]) -> bool:
    """True by the name of a file."""
    return Path(path).suffix.lower() == ".xacro"


def read_description(
    source: str | os.PathLike[str],
    base: str | None,
    tip: str | None,
    *,
    strict: bool = False,
    given: Xacro = NOTHING,
) -> Description:
    """The chain between two links of a URDF, xacro or MJCF.

    Without base and tip the root and the end of the longest chain. With ``strict`` a file that
    needed mending is refused.

    Raises
    ------
    UrdfError
        The message names the element and its line.
    NameNotFoundError, MissingExtraError
    """
    base, tip = link_name(base, "base"), link_name(tip, "tip")
    data, where = description_bytes(source, given)
    root = parse_xml(data, where)
    if root.tag == "mujoco" and where != TEXT:
        return _from_mjcf(root, Path(source), base, tip)
    tree = read_urdf(root, where, base, tip)
    ends = choose_ends(tree, base, tip)
    steps = find_path(tree, *ends)
    mends = list(tree.mends)
    held = {s.joint.name: s.joint for s in steps if s.joint.kind not in (*MOVING, "fixed")}
    for element in root.iterchildren("joint"):
        if joint := held.get(element.get("name", "")):
            mends.append(f"{joint.where}: a {joint.kind} joint before the arm; held at rest")
            element.set("type", "fixed")
    if strict and mends:
        more = f"\nand {len(mends) - 20} more" if len(mends) > 20 else ""
        raise UrdfError("\n".join(mends[:20]) + more)
    chain = {step.joint.name for step in steps if step.joint.kind in MOVING}
    model = bare_model(tree, root, chain)
    return Description(tree, *ends, root, model, {}, tuple(mends))


def _from_mjcf(root: etree._Element, path: Path, base: str | None, tip: str | None) -> Description:
    from dh2urdf.conversions.read.read_mjcf import read_mjcf

    tree, addresses, model = read_mjcf(path)
    ends = choose_ends(tree, base, tip)
    steps = find_path(tree, *ends)
    if steps[0].joint.kind not in (*MOVING, "fixed"):
        joint = steps[0].joint
        raise UrdfError(
            f"{joint.where}: a {joint.kind} joint before the arm; choose a base behind it, such "
            f"as {joint.child!r}"
        )
    return Description(tree, *ends, root, model, addresses, ())


def bare_model(tree: KinematicTree, root: etree._Element, chain: Collection[str]) -> pin.Model:
    """Pinocchio's model of a URDF, its joints off the chain held at 0.

    The numbers of origins and axes are those of the document as
    :func:`~dh2urdf.conversions.read.urdf_tree.read_urdf` leaves it, read anew; nothing else is
    left for urdfdom to stumble over.
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
    for tag in NUMBERS if kind != "fixed" else ("origin",):
        part = joint.find(tag)
        if part is not None:
            keys = NUMBERS[tag][2:] if kind == "continuous" and tag == "limit" else NUMBERS[tag]
            numbers = {k: _plain(part.get(k)) for k in keys if k in part.attrib}
            if numbers:
                etree.SubElement(bare, tag, numbers)


def _plain(text: str) -> str:
    """The same numbers in digits that every program reads."""
    return " ".join(repr(float(word)) for word in text.split())


def mended_urdf(
    source: str | os.PathLike[str], base: str | None, tip: str | None, given: Xacro = NOTHING
) -> tuple[str, tuple[str, ...]]:
    """The text of a URDF or xacro with all that has an obvious reading mended, and what that was.

    Raises
    ------
    UrdfError
        Something on the way from base to tip has no obvious reading.
    VerificationError
        Read back, the text is not the same robot.
    """
    read = read_description(source, base, tip, given=given)
    text = etree.tostring(read.root.getroottree(), encoding="unicode")
    again = read_description(text, read.base, read.tip, strict=True).model
    again.lowerPositionLimit = read.model.lowerPositionLimit  # none is written as wide ones
    again.upperPositionLimit = read.model.upperPositionLimit
    if again != read.model:
        raise VerificationError(f"{read.tree.where}: the mended file is not read as it was meant")
    return text, read.mends
