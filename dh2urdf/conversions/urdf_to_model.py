"""A URDF, xacro or MJCF file as a Pinocchio model."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

import pinocchio as pin
from lxml import etree

from dh2urdf.bounds import ROBOT_BYTES
from dh2urdf.conversions.kinematic_tree import choose_ends
from dh2urdf.conversions.read_urdf import parse_xml, read_urdf
from dh2urdf.dh_io.files import read_bytes
from dh2urdf.exceptions import MissingExtraError, UrdfError

__all__ = ["LoadedModel", "Mimic", "load_model"]


@dataclass(frozen=True)
class Mimic:
    """A joint that follows another: ``q = multiplier * q_leader + offset``."""

    leader: str
    multiplier: float
    offset: float


@dataclass(frozen=True, eq=False)
class LoadedModel:
    """Pinocchio's model of a file, the ends of the chain in it, and which joints mimic another.

    Mimicking joints are joints of their own in the model.
    """

    model: pin.Model
    base: str
    tip: str
    mimics: dict[str, Mimic]


def load_model(path: str | os.PathLike[str], base: str | None, tip: str | None) -> LoadedModel:
    """Read a file; without base and tip take the root and the end of the longest chain.

    Raises
    ------
    UrdfError
        The file cannot be read or is no robot; the message names the line and the element.
    NameNotFoundError
        No link of that name.
    MissingExtraError
        A xacro file without the ``xacro`` extra, an MJCF without ``mjcf``.
    """
    source = Path(path)
    data = read_bytes(source, ROBOT_BYTES, UrdfError)
    if source.suffix == ".xacro":
        data = expand_xacro(source).encode()
    root = parse_xml(data, str(source))
    if root.tag == "mujoco":
        return _from_mjcf(source, base, tip)
    ends = choose_ends(read_urdf(root, str(source)), base, tip)
    try:
        model = pin.buildModelFromXML(etree.tostring(root, encoding="unicode"))
    except (ValueError, RuntimeError) as error:
        raise UrdfError(f"{source}: Pinocchio does not load it: {error}") from None
    return LoadedModel(model, *ends, read_mimics(root))


def _from_mjcf(source: Path, base: str | None, tip: str | None) -> LoadedModel:
    from dh2urdf.conversions.read_mjcf import read_mjcf

    tree, _ = read_mjcf(source)
    start, end = choose_ends(tree, base, tip)
    try:
        model = pin.buildModelFromMJCF(os.fspath(source))
    except (ValueError, RuntimeError) as error:
        raise UrdfError(f"{source}: Pinocchio does not load it: {error}") from None
    return LoadedModel(model, model.frames[0].name if start == tree.root else start, end, {})


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
