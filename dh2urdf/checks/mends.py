"""Findings that can be mended without a guess about the robot, mended.

What has one obvious reading is mended by the reader of URDF files; here is what reads well and is
written badly. Everything else is left as it is, and found again.
"""

import math
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
from lxml import etree

from dh2urdf.checks.document import Document
from dh2urdf.checks.findings import label
from dh2urdf.checks.rounding import meant_angle
from dh2urdf.checks.rules.reading import ONCE
from dh2urdf.checks.rules.tree import VERSIONS
from dh2urdf.conversions.read import FLOAT, read_description
from dh2urdf.dh_io.xml import parse_xml
from dh2urdf.exceptions import VerificationError

UNIT = 1e-6
"""Length that an axis may miss 1 by and be left alone."""

MOVED = 0.01
"""Largest change of a joint's placement [rad and m] that a mend may bring: 3.14 for pi."""

Mended = Iterator[tuple[etree._Element, str]]


def certain_mends(
    text: str, base: str | None, tip: str | None, name: str
) -> tuple[str, tuple[str, ...]]:
    """The text of a sound URDF with certain mends, each told with its line; comments stay.

    Raises
    ------
    VerificationError
        Read back, the text is not the same robot.
    """
    root = parse_xml(text.encode(), name)
    doc = Document(root, Path(name))
    told = [
        f"{name}:{element.sourceline}: {label(element)}: {what}"
        for mend in MENDS
        for element, what in mend(doc)
    ]
    if not told:
        return text, ()
    if not root.get("name"):
        root.set("name", Path(name).stem or "robot")
    mended = str(etree.tostring(root.getroottree(), encoding="unicode"))
    before, after = (read_description(t, base, tip, strict=True).model for t in (text, mended))
    pairs = zip(before.jointPlacements, after.jointPlacements, strict=False)
    off = max(float(np.abs(p.homogeneous - q.homogeneous).max()) for p, q in pairs)
    if list(before.names) != list(after.names) or off > MOVED:
        raise VerificationError(f"{name}: the mended file is not read as the same robot")
    return mended, tuple(told)


def _robot_name(doc: Document) -> Mended:
    if not doc.root.get("name"):
        yield doc.root, "named after the file"


def _version(doc: Document) -> Mended:
    text = doc.root.get("version")
    if text is not None and text not in VERSIONS:
        del doc.root.attrib["version"]
        yield doc.root, f'version="{text}" left out'


def _repeated(doc: Document) -> Mended:
    """Elements that stand twice, word by word."""
    for tag, once in ONCE.items():
        for element in doc.root.iter(tag):
            seen: set[bytes] = set()
            for child in list(element.iterchildren(*once)):
                yield from _dropped(child, seen, "stood twice; one left out")


def _materials(doc: Document) -> Mended:
    seen: set[bytes] = set()
    for material in list(doc.root.iterchildren("material")):
        yield from _dropped(material, seen, "stood twice; one left out")


def _dropped(element: etree._Element, seen: set[bytes], what: str) -> Mended:
    """The element told and taken out where one like it was seen."""
    text = etree.tostring(element, method="c14n", with_tail=False)
    if text in seen:
        yield element, what
        _take_out(element)
    seen.add(text)


def _take_out(element: etree._Element) -> None:
    """An element removed, what follows it kept."""
    parent, before = element.getparent(), element.getprevious()
    if element.tail and element.tail.strip():
        if before is None:
            parent.text = (parent.text or "") + element.tail
        else:
            before.tail = (before.tail or "") + element.tail
    parent.remove(element)


def _unit_axes(doc: Document) -> Mended:
    for joint in doc.joints:
        axis = joint.find("axis")
        values = doc.numbers(axis, "xyz") or [0.0]
        length = math.hypot(*values)
        if axis is not None and any(values) and abs(length - 1) > UNIT:
            axis.set("xyz", " ".join(repr(v / length + 0.0) for v in values))
            yield axis, f"of length {length:.6g}; written with length 1"


def _right_angles(doc: Document) -> Mended:
    for joint in doc.joints:
        origin = joint.find("origin")
        if origin is None or doc.numbers(origin, "rpy") is None:
            continue
        words = origin.get("rpy", "").split()
        meant = [meant_angle(word) for word in words]
        if any(angle is not None for angle in meant):
            made = " ".join(w if m is None else repr(m) for w, m in zip(words, meant, strict=True))
            yield origin, f'rpy="{" ".join(words)}" written as {made}'
            origin.set("rpy", made)


def _zeros(doc: Document) -> Mended:
    for joint in doc.joints:
        for element in joint.iterchildren("origin", "axis"):
            for key in ("xyz", "rpy"):
                words = element.get(key, "").split()
                plain = [
                    "0" if w[0] == "-" and FLOAT.fullmatch(w) and float(w) == 0 else w
                    for w in words
                ]
                if plain != words:
                    element.set(key, " ".join(plain))
                    yield element, f"minus zero in {key} written as 0"


def _empty_shapes(doc: Document) -> Mended:
    for link in doc.links:
        for shell in list(link.iterchildren("visual", "collision")):
            geometry = shell.find("geometry")
            if geometry is None or not len(geometry):
                yield shell, "has no shape; left out"
                _take_out(shell)


def _material_names(doc: Document) -> Mended:
    taken = {str(material.get("name")) for material in doc.root.iter("material")}
    for material in doc.root.iter("material"):
        owner = material.getparent()
        if material.get("name") is None and owner is not None and owner.tag == "visual":
            name = next(n for k in range(1, len(taken) + 2) if (n := f"material_{k}") not in taken)
            taken.add(name)
            yield material, f"named {name}"
            material.set("name", name)


MENDS: tuple[Callable[[Document], Mended], ...] = (
    _robot_name,
    _version,
    _repeated,
    _materials,
    _unit_axes,
    _right_angles,
    _zeros,
    _empty_shapes,
    _material_names,
)
