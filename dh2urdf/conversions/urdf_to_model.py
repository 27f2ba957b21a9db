"""A URDF, xacro or MJCF file as a Pinocchio model."""

from __future__ import annotations

import os
from dataclasses import dataclass

import pinocchio as pin
from lxml import etree

from dh2urdf.conversions.description import read_description

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

    Mimicking joints are joints of their own in the model. ``mends`` tells what was set right.
    """

    model: pin.Model
    base: str
    tip: str
    mimics: dict[str, Mimic]
    mends: tuple[str, ...]


def load_model(
    path: str | os.PathLike[str], base: str | None, tip: str | None, *, strict: bool = False
) -> LoadedModel:
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
    found = read_description(path, base, tip, strict=strict)
    start = found.base
    if found.addresses and start == found.tree.root:
        start = found.model.frames[0].name
    return LoadedModel(found.model, start, found.tip, read_mimics(found.root), found.mends)


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
