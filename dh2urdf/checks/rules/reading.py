"""Rules of how a file is read: elements given twice, links fused away, xacro, numbers."""

import math
import re
from collections import Counter
from collections.abc import Iterator

from lxml import etree

from dh2urdf.bounds import NUMBER as LARGEST
from dh2urdf.checks.document import Document
from dh2urdf.checks.findings import Effect, Finding, accept, complain, finding, misread, refuse
from dh2urdf.conversions.read import FLOAT

XACRO = "http://www.ros.org/wiki/xacro"

NO_NUMBER = re.compile(r"[+-]?(inf(inity)?|nan)", re.IGNORECASE)

PYTHON = re.compile(r"[+-]?(\d(_?\d)*\.?(\d(_?\d)*)?|\.\d(_?\d)*)([eE][+-]?\d(_?\d)*)?")
"""What Python's float reads; C++ and MuJoCo stop at an underscore."""

DIGIT = re.compile(r"[+-]?[.\d]")
"""How a word begins of which Drake reads the number and drops the rest."""

OWNERS = ("joint", "inertial", "visual", "collision", "material")

NUMERIC = {("origin", "xyz"), ("origin", "rpy"), ("axis", "xyz")}

ONCE = {
    "link": ("inertial",),
    "joint": ("origin", "parent", "child", "axis", "limit", "dynamics", "mimic"),
    "inertial": ("origin", "mass", "inertia"),
}
"""Elements that may stand once in another."""


def repeated_element(doc: Document) -> Iterator[Finding]:
    """What may stand once stands once."""
    first = misread("Pinocchio check_urdf yourdfpy", "take the first without a word")
    effects = refuse("MuJoCo"), first
    for tag, once in ONCE.items():
        for element in doc.root.iter(tag):
            counts = Counter(child.tag for child in element.iterchildren(etree.Element))
            for key in once:
                if counts[key] > 1:
                    message = f"has {counts[key]} <{key}>"
                    yield finding(element, message, *effects, mend="drop one of them")


def fused_frames(doc: Document) -> Iterator[Finding]:
    """MuJoCo is told to keep links on fixed joints."""
    frames = [c for _, c, joint in doc.edges if doc.kind(joint) == "fixed"]
    if frames and doc.mujoco.get("fusestatic") != "false":
        shown = ", ".join(frames[:6]) + (", ..." if len(frames) > 6 else "")
        text = "fuse it with its parent: its name is gone, and MuJoCo drops all visuals"
        mend = 'add <mujoco><compiler fusestatic="false" discardvisual="false"/></mujoco>'
        message = f"hangs on a fixed joint; such links: {shown}"
        first = doc.link_by_name[frames[0]]
        yield finding(first, message, accept("MuJoCo Gazebo", text), mend=mend)


def xacro(doc: Document) -> Iterator[Finding]:
    """Nothing is left of xacro."""
    mend = "expand the file first: xacro robot.xacro > robot.urdf"
    for element in doc.root.iter(etree.Element):
        name = etree.QName(element)
        if name.namespace == XACRO:
            skipped = misread("urdfdom MuJoCo", "skip the element")
            yield finding(element, "is an element of xacro", skipped, mend=mend)
            continue
        left = [(k, v) for k, v in element.attrib.items() if "${" in v or "$(" in v]
        if left:
            in_joint = element.getparent() in doc.joints and (element.tag, left[0][0]) in NUMERIC
            refused = refuse("urdfdom MuJoCo yourdfpy Drake ikpy") if in_joint else None
            message = f"holds {left[0][1]!r}, an expression of xacro"
            yield finding(element, message, refused, misread("PyBullet", "reads 0"), mend=mend)


def _words(doc: Document) -> Iterator[tuple[etree._Element, str, int, list[str]]]:
    for element, key, count in doc.with_numbers():
        text = element.get(key, "")
        if "${" not in text and "$(" not in text:
            yield element, key, count, text.split()


def _owner(element: etree._Element) -> str:
    """``joint``, ``inertial``, ``visual``, ``collision`` or ``material``; empty for no such."""
    chain = (element, *element.iterancestors())
    return next((str(owner.tag) for owner in chain if owner.tag in OWNERS), "")


def number(doc: Document) -> Iterator[Finding]:
    """Where a number belongs there is one."""
    for element, key, count, words in _words(doc):
        bad = [w for w in words if not FLOAT.fullmatch(w) and not NO_NUMBER.fullmatch(w)]
        if bad:
            effects = _text_effects(doc, element, bad[0], short=len(words) < count)
            message = f'{key}="{element.get(key)}": {bad[0]!r} is no number'
            mend = "write it out; URDF has no expressions, units, commas or underscores"
            yield finding(element, message, *effects, mend=mend)


def _text_effects(
    doc: Document, element: etree._Element, word: str, *, short: bool
) -> tuple[Effect, ...]:
    owner = _owner(element)
    python = bool(PYTHON.fullmatch(word))
    readers = "" if python else "yourdfpy "
    zero = (complain if short else misread)("PyBullet", "reads what it can, 0 otherwise")
    if owner == "joint":
        if not python and element.tag in ("origin", "axis"):
            readers += "ikpy "
        if short or not DIGIT.match(word):
            readers += "Drake "
        return refuse(f"urdfdom {readers}MuJoCo"), zero
    whole = "whole <inertial>" if owner == "inertial" else owner
    left_out = complain("urdfdom", f"leave the {whole} out")
    if owner == "inertial":
        return refuse(f"{readers}MuJoCo"), left_out, zero
    read = owner in ("visual", "collision") and doc.mujoco_reads(element)
    return refuse(f"{readers}MuJoCo" if read else readers), left_out


def number_count(doc: Document) -> Iterator[Finding]:
    """There are as many numbers as there should be."""
    for element, key, count, words in _words(doc):
        if len(words) != count and all(FLOAT.fullmatch(word) for word in words):
            few, worst = len(words) < count, None
            refused = complain("urdfdom", "leave the element around it out")
            if _owner(element) == "joint":
                refused = refuse(f"urdfdom MuJoCo {'yourdfpy ' if few else ''}Drake ikpy")
                worst = (refuse if element.tag == "axis" else complain)("PyBullet") if few else None
            message = f'{key}="{element.get(key)}": {len(words)} numbers, {count} belong there'
            yield finding(element, message, refused, worst, mend=f"write {count}")


def not_finite(doc: Document) -> Iterator[Finding]:
    """No number is infinite or NaN."""
    for element, key, _, words in _words(doc):
        bad = [w for w in words if NO_NUMBER.fullmatch(w) or _overflows(w)]
        if not bad:
            continue
        limit = element.tag == "limit"
        mend = "write the value; an unlimited joint has wide limits" if limit else "write the value"
        huge = _overflows(bad[0]) and math.isfinite(float(bad[0]))
        what = f"lies beyond {LARGEST:.0e}" if huge else "is not finite"
        message = f'{key}="{element.get(key)}": {bad[0]} {what}'
        yield finding(element, message, *_infinite_effects(element, bad[0]), mend=mend)


def _infinite_effects(element: etree._Element, word: str) -> Iterator[Effect]:
    in_joint = _owner(element) == "joint"
    yield refuse("urdfdom Drake" if in_joint else "Drake")
    if not in_joint:
        yield complain("urdfdom", "leave the element around it out")
    if _overflows(word) or element.tag == "mass":
        yield refuse("MuJoCo")
    elif element.tag == "origin" or "nan" in word.lower():
        yield complain("MuJoCo", "computes NaN")
    if in_joint and element.tag == "origin":
        yield complain("ikpy", "computes NaN")
        if "nan" not in word.lower():
            yield complain("yourdfpy", "computes NaN")
    yield misread("PyBullet yourdfpy", "compute with it")


def _overflows(word: str) -> bool:
    return bool(FLOAT.fullmatch(word)) and abs(float(word)) > LARGEST


def negative_zero(doc: Document) -> Iterator[Finding]:
    """No number of a joint's origin or axis is a minus zero."""
    text = "programs that generate code may carry the sign along: "
    carried = accept("IKFast", f"{text}atan2(-0.0, -1) is -pi, atan2(0.0, -1) is pi")
    for element, key, _, words in _words(doc):
        minus = [w for w in words if w.startswith("-") and FLOAT.fullmatch(w) and float(w) == 0]
        if minus and element.tag in ("origin", "axis") and _owner(element) == "joint":
            message = f'{key}="{element.get(key)}": {minus[0]} is zero'
            yield finding(element, message, carried, mend="write 0")
