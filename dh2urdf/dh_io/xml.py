"""XML documents, and the DH table that a URDF or MJCF of this package carries."""

import os
from typing import BinaryIO

from lxml import etree

from dh2urdf.bounds import ROBOT_BYTES
from dh2urdf.dh import DHTable
from dh2urdf.dh_io.files import read_bytes, shown
from dh2urdf.dh_io.read import parse_table
from dh2urdf.exceptions import TableFileError, UrdfError


def parse_xml(data: bytes, where: str) -> etree._Element:
    """The root element of a document, entities and network off; a `UrdfError` names the line."""
    parser = etree.XMLParser(resolve_entities=False, no_network=True, load_dtd=False)
    try:
        root = etree.fromstring(data, parser)
    except (etree.XMLSyntaxError, ValueError) as error:
        line = getattr(error, "lineno", None) or 1
        message = str(getattr(error, "msg", error)).split(", line ")[0]
        raise UrdfError(f"{where}:{line}: not XML: {message}") from None
    if root.getroottree().docinfo.doctype:
        line = data[: max(data.find(b"<!DOCTYPE"), 0)].count(b"\n") + 1
        message = "<!DOCTYPE>: document types and entities are not allowed in a URDF"
        raise UrdfError(f"{where}:{line}: {message}")
    return root


def carried_text(root: etree._Element) -> str | None:
    """The DH table that a URDF or MJCF of this package carries, as JSON."""
    if root.tag == "mujoco":
        found = root.xpath("custom/text[@name='dh2urdf']/@data")
        return str(found[0]) if found else None
    text = root.findtext("dh2urdf")
    return None if text is None else str(text)


def embedded_table(path: str | os.PathLike[str] | BinaryIO) -> DHTable:
    """The DH table that a file written by this package carries, identical to the original.

    Raises
    ------
    UrdfError
        Not XML, or no embedded table.
    """
    where = shown(path) if isinstance(path, str | os.PathLike) else "<stdin>"
    root = parse_xml(read_bytes(path, ROBOT_BYTES, UrdfError), where)
    text = carried_text(root)
    if not text:
        kind = "MJCF" if root.tag == "mujoco" else "URDF"
        raise UrdfError(
            f"{where}: no DH table is embedded in this {kind}; `dh2urdf extract` finds one by "
            "frame assignment"
        )
    try:
        return parse_table(text, "json", f"{where}:<dh2urdf>").table
    except TableFileError as error:
        raise UrdfError(f"{where}: the embedded DH table is damaged: {error}") from None
