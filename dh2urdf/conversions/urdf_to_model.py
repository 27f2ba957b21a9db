"""A URDF, xacro or MJCF file as a Pinocchio model."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

import pinocchio as pin
from lxml import etree

from dh2urdf.exceptions import MissingExtraError, UrdfError

__all__ = ["Mimic", "load_model", "read_mimics"]


@dataclass(frozen=True)
class Mimic:
    """A joint that follows another: ``q = multiplier * q_leader + offset``."""

    leader: str
    multiplier: float
    offset: float


def load_model(path: str | os.PathLike[str]) -> tuple[pin.Model, dict[str, Mimic]]:
    """Pinocchio's model of a file, and which of its joints mimic another.

    Mimicking joints are joints of their own in the model.

    Raises
    ------
    UrdfError
        The file cannot be read or is no robot.
    MissingExtraError
        A xacro file without the ``xacro`` extra.
    """
    source = Path(path)
    try:
        head = source.read_bytes()
    except OSError as error:
        raise UrdfError(f"{source}: {error.strerror or error}") from None
    if source.suffix == ".xacro":
        head = expand_xacro(source).encode()
    root = parse_xml(head, str(source))
    if root.tag == "mujoco":
        return pin.buildModelFromMJCF(os.fspath(source)), {}
    if root.tag != "robot":
        raise UrdfError(f"{source}:{root.sourceline}: root element is <{root.tag}>, not <robot>")
    try:
        model = pin.buildModelFromXML(head.decode("utf-8", "replace"))
    except (ValueError, RuntimeError) as error:
        raise UrdfError(f"{source}: Pinocchio does not load it: {error}") from None
    return model, read_mimics(root)


def parse_xml(data: bytes, name: str) -> etree._Element:
    """The root element, entities and network off.

    Raises
    ------
    UrdfError
        Not XML; the message names the line.
    """
    parser = etree.XMLParser(resolve_entities=False, no_network=True, load_dtd=False)
    try:
        root = etree.fromstring(data, parser)
    except etree.XMLSyntaxError as error:
        raise UrdfError(f"{name}: not XML: {error.msg}") from None
    if root.getroottree().docinfo.doctype:
        raise UrdfError(f"{name}: a document type or entities are not allowed in a URDF")
    return root


def expand_xacro(source: Path) -> str:
    """The URDF text of a xacro file.

    Raises
    ------
    MissingExtraError, UrdfError
    """
    try:
        import xacro
    except ImportError:
        raise MissingExtraError("xacro", f"reading {source.name}") from None
    try:
        return str(xacro.process_file(os.fspath(source)).toxml())
    except Exception as error:
        raise UrdfError(f"{source}: xacro: {error}") from None


def read_mimics(root: etree._Element) -> dict[str, Mimic]:
    """Joints with a ``<mimic>`` element, by name."""
    out = {}
    for joint in root.iterfind("joint"):
        mimic = joint.find("mimic")
        if mimic is not None:
            multiplier = float(mimic.get("multiplier", "1"))
            offset = float(mimic.get("offset", "0"))
            out[joint.get("name", "")] = Mimic(mimic.get("joint", ""), multiplier, offset)
    return out
