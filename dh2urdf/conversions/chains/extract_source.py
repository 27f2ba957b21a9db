"""Whatever a user hands over, as a chain and a referee for it."""

import os
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import pinocchio as pin
from lxml import etree

from dh2urdf.chain import SerialChain
from dh2urdf.conversions.chains.model_chain import frame_id, model_source
from dh2urdf.conversions.chains.referee import (
    Referee,
    addressed_referee,
    model_referee,
    screw_referee,
)
from dh2urdf.conversions.chains.tree_chain import ChainSource, tree_to_chain
from dh2urdf.conversions.chains.typed_axes import SUFFIXES, read_axes, typed_to_chain
from dh2urdf.conversions.read import NOTHING, Actuation, Xacro, link_name, read_description
from dh2urdf.dh import DHTable, JointType
from dh2urdf.dh_io.files import shown
from dh2urdf.exceptions import ArgumentError, UrdfError

WRITTEN_ENDS = ("base_link", "tool0")
"""Base and tip of every URDF that this package writes; an MJCF has the first in its world."""


class Source(NamedTuple):
    """A chain, Pinocchio's FK of it, and the table that the file was written from, if any."""

    found: ChainSource
    referee: Referee
    embedded: DHTable | None = None


def read_source(
    source: Any,
    base: str | None,
    tip: str | None,
    given: Xacro = NOTHING,
    model: str | None = None,
    *,
    joint_types: str | Sequence[JointType | str] | None = None,
    tool: Any = None,
    names: Sequence[str] | None = None,
) -> Source:
    """The chain between two frames of a source, and Pinocchio's FK of it."""
    typed = {"joint_types": joint_types, "tool": tool, "names": names}
    if isinstance(source, (str, os.PathLike, pin.Model)):
        extra = [key for key, value in typed.items() if value is not None]
        if extra:
            raise UrdfError(f"{extra[0]}: only for joint axes typed by hand")
        if isinstance(source, pin.Model):
            found, path = model_source(source, link_name(base, "base"), link_name(tip, "tip"))
            return Source(found, model_referee(source, path.base, path.tip, found.chain.names))
        return _from_file(source, base, tip, given, model)
    if base is not None or tip is not None:
        raise UrdfError("base and tip: typed axes go from the base frame to the tool")
    chain = source if isinstance(source, SerialChain) else typed_to_chain(source, **typed)
    return _from_chain(chain, "robot", "joint axes")


def _from_chain(chain: SerialChain, name: str, origin: str) -> Source:
    bodies, drives = (None,) * chain.n, (Actuation(),) * chain.n
    found = ChainSource(chain, name, "base", "tool", bodies, drives, origin=origin)
    return Source(found, screw_referee(chain))


def _from_file(
    source: str | os.PathLike[str],
    base: str | None,
    tip: str | None,
    xacro: Xacro,
    model: str | None,
) -> Source:
    """A path, or the text of a URDF."""
    if not (isinstance(source, str) and source.lstrip().startswith("<")):
        path = Path(source)
        if path.suffix.lower() in SUFFIXES:
            if base is not None or tip is not None:
                where = shown(source)
                raise UrdfError(f"{where}: base and tip: typed axes go from the base to the tool")
            return _from_chain(*read_axes(path, model), path.name)
    if model is not None:
        raise ArgumentError("model: only a calibration.conf needs it, not a robot description")
    given = read_description(source, base, tip, given=xacro)
    found = tree_to_chain(given.tree, given.base, given.tip)
    found = replace(found, warnings=(*given.mends, *found.warnings))
    pinocchio, names = given.model, (found.base, found.tip)
    if given.addresses:
        ends = [0 if name == given.tree.root else frame_id(pinocchio, name) for name in names]
        indices = [given.addresses[name] for name in found.chain.names]
        if max(indices, default=-1) >= pinocchio.nq:
            raise UrdfError(
                f"{given.tree.where}: Pinocchio finds {pinocchio.nq} of its joints, "
                f"MuJoCo at least {max(indices) + 1}; the file is read in two ways"
            )
        referee = addressed_referee(pinocchio, ends[0], ends[1], indices)
        written = replace(found, base="base_link") if found.base == given.tree.root else found
        return Source(found, referee, _embedded(given.root, given.tree.where, written))
    start, end = (frame_id(pinocchio, name) for name in names)
    referee = model_referee(pinocchio, start, end, found.chain.names)
    return Source(found, referee, _embedded(given.root, given.tree.where, found))


def _embedded(root: etree._Element, where: str, found: ChainSource) -> DHTable | None:
    """The table that the file carries, where it spans the same two links."""
    from dh2urdf.dh_io import parse_table
    from dh2urdf.dh_io.xml import carried_text

    text = carried_text(root)
    if not text or (found.base, found.tip) != WRITTEN_ENDS:
        return None
    return parse_table(text, "json", f"{where}: <dh2urdf>").table
