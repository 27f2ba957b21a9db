"""A robot description with what has an obvious reading written out."""

from __future__ import annotations

import os

import numpy as np
import pinocchio as pin
from lxml import etree

from dh2urdf.conversions.bare_urdf import bare_model
from dh2urdf.conversions.description import description_bytes, read_description
from dh2urdf.conversions.kinematic_tree import MOVING
from dh2urdf.conversions.read_urdf import read_urdf
from dh2urdf.dh_io.xml import parse_xml
from dh2urdf.exceptions import UrdfError, VerificationError
from dh2urdf.transforms import pose_error

__all__ = ["mended_urdf"]


def mended_urdf(
    path: str | os.PathLike[str], base: str | None = None, tip: str | None = None
) -> tuple[bytes, tuple[str, ...]]:
    """The text of a URDF or xacro, mended, and what was mended in it.

    Without base and tip the root and the end of the longest chain.

    The text has been read back: there is nothing left to mend, and its links are where the
    mended tree has them.

    Raises
    ------
    UrdfError
        Something on the way from base to tip has no obvious reading.
    VerificationError
        The mended text is not read as it was meant.
    """
    data, where = description_bytes(path)
    root = parse_xml(data, where)
    tree = read_urdf(root, where, base, tip)
    mends = tree.mends
    try:
        found = read_description(path, base, tip)
        root, tree, mends = found.root, found.tree, found.mends
    except UrdfError:  # no chain, or several: then every joint may be on the way
        if tip is not None:
            raise
        for joint in tree.joints:
            if joint.fault:
                raise UrdfError(joint.fault) from None
    text: bytes = etree.tostring(root.getroottree(), encoding="utf-8", xml_declaration=True)
    again = parse_xml(text, where)
    tree_again = read_urdf(again, where, base, tip)
    chain = {joint.name for joint in tree.joints if joint.kind in MOVING}
    models = (bare_model(tree, root, chain), bare_model(tree_again, again, chain))
    differs = pose_error(*(_placements(model) for model in models))
    if tree_again.mends or not differs <= 1e-12:
        raise VerificationError(f"{where}: the mended file is not read as it was meant")
    return text, mends


def _placements(model: pin.Model) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    """Every frame of a model at one configuration in general position."""
    data = model.createData()
    q = pin.integrate(model, pin.neutral(model), np.linspace(-1.0, 1.0, model.nv))
    pin.framesForwardKinematics(model, data, q)
    return np.stack([placed.homogeneous for placed in data.oMf])
