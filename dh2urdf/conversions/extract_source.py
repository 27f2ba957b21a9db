"""Whatever a user hands over, as a chain and a referee for it."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import pinocchio as pin
from lxml import etree

from dh2urdf.bounds import ROBOT_BYTES
from dh2urdf.chain import SerialChain
from dh2urdf.conversions.kinematic_tree import choose_ends
from dh2urdf.conversions.model_source import model_source
from dh2urdf.conversions.model_to_chain import frame_id
from dh2urdf.conversions.read_axes import SUFFIXES as AXES_SUFFIXES
from dh2urdf.conversions.read_axes import read_axes
from dh2urdf.conversions.read_urdf import parse_xml, read_urdf
from dh2urdf.conversions.referee import (
    Referee,
    addressed_referee,
    model_referee,
    screw_referee,
    urdf_model,
)
from dh2urdf.conversions.tree_to_chain import Actuation, ChainSource, tree_to_chain
from dh2urdf.conversions.typed_axes import typed_to_chain
from dh2urdf.conversions.urdf_to_model import expand_xacro
from dh2urdf.dh import DHTable, JointType
from dh2urdf.dh_io.files import read_bytes
from dh2urdf.exceptions import UrdfError

__all__ = ["Source", "read_source"]

WRITTEN_ENDS = ("base_link", "tool0")
"""Base and tip of every URDF that this package writes."""


class Source(NamedTuple):
    """A chain, Pinocchio's FK of it, and the table that the file was written from, if any."""

    found: ChainSource
    referee: Referee
    embedded: DHTable | None = None


def read_source(
    source: Any,
    base: str | None,
    tip: str | None,
    *,
    joint_types: str | Sequence[JointType | str] | None = None,
    tool: Any = None,
    names: Sequence[str] | None = None,
) -> Source:
    """The chain between two frames of a source, and Pinocchio's FK of it.

    Raises
    ------
    UrdfError, NameNotFoundError, PoseError, MissingExtraError
    """
    typed = {"joint_types": joint_types, "tool": tool, "names": names}
    if isinstance(source, (str, os.PathLike, pin.Model)):
        extra = [key for key, value in typed.items() if value is not None]
        if extra:
            raise UrdfError(f"{extra[0]}: only for joint axes typed by hand")
        if isinstance(source, pin.Model):
            return _from_model(source, base, tip)
        return _from_file(source, base, tip)
    if base is not None or tip is not None:
        raise UrdfError("base and tip: typed axes go from the base frame to the tool")
    chain = source if isinstance(source, SerialChain) else typed_to_chain(source, **typed)
    return _from_chain(chain, "robot", "joint axes")


def _from_chain(chain: SerialChain, name: str, origin: str) -> Source:
    found = ChainSource(
        chain,
        name,
        "base",
        "tool",
        bodies=(None,) * chain.n,
        drives=(Actuation(),) * chain.n,
        origin=origin,
    )
    return Source(found, screw_referee(chain))


def _from_model(model: pin.Model, base: str | None, tip: str | None) -> Source:
    found, path = model_source(model, base, tip)
    return Source(found, model_referee(model, path.base, path.tip, found.chain.names))


def _from_file(source: str | os.PathLike[str], base: str | None, tip: str | None) -> Source:
    """A path, or the text of a URDF."""
    if isinstance(source, str) and source.lstrip().startswith("<"):
        return _from_urdf(parse_xml(source.encode(), "URDF text"), "URDF text", base, tip)
    path = Path(source)
    where = os.fspath(source)
    data = read_bytes(path, ROBOT_BYTES, UrdfError)
    if path.suffix == ".xacro":
        data = expand_xacro(path).encode()
    if path.suffix.lower() in AXES_SUFFIXES:
        if base is not None or tip is not None:
            raise UrdfError(f"{where}: base and tip: typed axes go from the base to the tool")
        return _from_chain(read_axes(path, data), path.stem, path.name)
    root = parse_xml(data, where)
    if root.tag == "mujoco":
        from dh2urdf.conversions.read_mjcf import read_mjcf

        tree, addresses = read_mjcf(path)
        found = tree_to_chain(tree, *choose_ends(tree, base, tip))
        return Source(found, _mjcf_referee(where, found, tree.root, addresses))
    return _from_urdf(root, where, base, tip)


def _mjcf_referee(where: str, found: ChainSource, root: str, addresses: dict[str, int]) -> Referee:
    """Pinocchio's own reading of an MJCF; both parsers order q by the file."""
    try:
        model = pin.buildModelFromMJCF(where)
    except (ValueError, RuntimeError) as error:
        raise UrdfError(f"{where}: Pinocchio does not load it: {error}") from None
    ends = [0 if name == root else frame_id(model, name) for name in (found.base, found.tip)]
    indices = [addresses[name] for name in found.chain.names]
    return addressed_referee(model, ends[0], ends[1], indices)


def _from_urdf(root: etree._Element, where: str, base: str | None, tip: str | None) -> Source:
    tree = read_urdf(root, where)
    found = tree_to_chain(tree, *choose_ends(tree, base, tip))
    ways = (tree.above(found.base), tree.above(found.tip))
    links = {tree.root, *(joint.child for way in ways for joint in way)}
    model = urdf_model(root, where, links)
    ends = frame_id(model, found.base), frame_id(model, found.tip)
    referee = model_referee(model, *ends, found.chain.names)
    return Source(found, referee, _embedded(root, where, found))


def _embedded(root: etree._Element, where: str, found: ChainSource) -> DHTable | None:
    """The table in the ``<dh2urdf>`` element, where it spans the same two links.

    Raises
    ------
    TableFileError
    """
    element = root.find("dh2urdf")
    if element is None or not element.text or (found.base, found.tip) != WRITTEN_ENDS:
        return None
    from dh2urdf.dh_io import parse_table

    return parse_table(element.text, "json", f"{where}:{element.sourceline}: <dh2urdf>").table
