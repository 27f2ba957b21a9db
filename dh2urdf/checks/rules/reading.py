"""Rules of how a file is read: elements given twice, links fused away, xacro, numbers."""

import math
import re
from collections import Counter
from collections.abc import Iterator

from lxml import etree

from dh2urdf.bounds import NUMBER as LARGEST
from dh2urdf.checks.document import NUMBER, Document
from dh2urdf.checks.findings import (
    CHECK_URDF,
    DRAKE,
    GAZEBO,
    IKFAST,
    IKPY,
    MUJOCO,
    PINOCCHIO,
    PYBULLET,
    URDFDOM,
    YOURDFPY,
    Consumer,
    Effect,
    Found,
    accept,
    complain,
    misread,
    refuse,
)

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


def repeated_element(doc: Document) -> Iterator[Found]:
    """What may stand once stands once."""
    first = misread(PINOCCHIO, CHECK_URDF, YOURDFPY, text="take the first without a word")
    for tag, once in ONCE.items():
        for element in doc.root.iter(tag):
            counts = Counter(child.tag for child in element.iterchildren(etree.Element))
            for key in once:
                if counts[key] > 1:
                    message = f"has {counts[key]} <{key}>"
                    yield Found(element, message, refuse(MUJOCO), first, mend="drop one of them")


def fused_frames(doc: Document) -> Iterator[Found]:
    """MuJoCo is told to keep links on fixed joints."""
    frames = [c for _, c, joint in doc.edges if doc.kind(joint) == "fixed"]
    if frames and doc.mujoco.get("fusestatic") != "false":
        shown = ", ".join(frames[:6]) + (", ..." if len(frames) > 6 else "")
        text = "fuse it with its parent: its name is gone, and MuJoCo drops all visuals"
        yield Found(
            doc.link_by_name[frames[0]],
            f"hangs on a fixed joint; such links: {shown}",
            accept(MUJOCO, GAZEBO, text=text),
            mend='add <mujoco><compiler fusestatic="false" discardvisual="false"/></mujoco>',
        )


def xacro(doc: Document) -> Iterator[Found]:
    """Nothing is left of xacro."""
    everyone = (*URDFDOM, MUJOCO, YOURDFPY, DRAKE, IKPY)
    for element in doc.root.iter(etree.Element):
        name = etree.QName(element)
        if name.namespace == XACRO:
            effects: tuple[Effect, ...] = (misread(*URDFDOM, MUJOCO, text="skip the element"),)
            message = "is an element of xacro"
        else:
            left = [v for v in element.attrib.values() if "${" in v or "$(" in v]
            if not left:
                continue
            message = f"holds {left[0]!r}, an expression of xacro"
            keys = [k for k, v in element.attrib.items() if v == left[0]]
            in_joint = element.getparent() in doc.joints and (element.tag, keys[0]) in NUMERIC
            effects = (refuse(*everyone),) if in_joint else ()
            effects += (misread(PYBULLET, text="reads 0"),)
        yield Found(
            element, message, *effects, mend="expand the file first: xacro robot.xacro > robot.urdf"
        )


def _words(doc: Document) -> Iterator[tuple[etree._Element, str, int, list[str]]]:
    for element, key, count in doc.with_numbers():
        text = element.get(key, "")
        if "${" not in text and "$(" not in text:
            yield element, key, count, text.split()


def _owner(element: etree._Element) -> str:
    """``joint``, ``inertial``, ``visual``, ``collision`` or ``material``; empty for no such."""
    owner: etree._Element | None = element
    while owner is not None and owner.tag not in OWNERS:
        owner = owner.getparent()
    return "" if owner is None else str(owner.tag)


def number(doc: Document) -> Iterator[Found]:
    """Where a number belongs there is one."""
    for element, key, count, words in _words(doc):
        bad = [w for w in words if not NUMBER.fullmatch(w) and not NO_NUMBER.fullmatch(w)]
        if bad:
            yield Found(
                element,
                f'{key}="{element.get(key)}": {bad[0]!r} is no number',
                *_text_effects(doc, element, bad[0], short=len(words) < count),
                mend="write it out; URDF has no expressions, units, commas or underscores",
            )


def _text_effects(
    doc: Document, element: etree._Element, word: str, *, short: bool
) -> tuple[Effect, ...]:
    owner = _owner(element)
    python = bool(PYTHON.fullmatch(word))
    readers: tuple[Consumer, ...] = () if python else (YOURDFPY,)
    verdict = complain if short else misread
    zero = verdict(PYBULLET, text="reads what it can, 0 otherwise")
    if owner == "joint":
        if not python and element.tag in ("origin", "axis"):
            readers += (IKPY,)
        if short or not DIGIT.match(word):
            readers += (DRAKE,)
        return (refuse(*URDFDOM, *readers, MUJOCO), zero)
    if owner == "inertial":
        return (
            refuse(*readers, MUJOCO),
            complain(*URDFDOM, text="leave the whole <inertial> out"),
            zero,
        )
    if owner in ("visual", "collision") and doc.mujoco_reads(element):
        return (refuse(*readers, MUJOCO), complain(*URDFDOM, text=f"leave the {owner} out"))
    return (refuse(*readers), complain(*URDFDOM, text=f"leave the {owner} out"))


def number_count(doc: Document) -> Iterator[Found]:
    """There are as many numbers as there should be."""
    for element, key, count, words in _words(doc):
        if len(words) != count and all(NUMBER.fullmatch(word) for word in words):
            few = len(words) < count
            in_joint = _owner(element) == "joint"
            readers = (*((YOURDFPY,) if few else ()), DRAKE, IKPY)
            effects: tuple[Effect, ...] = (
                complain(*URDFDOM, text="leave the element around it out"),
            )
            if in_joint:
                effects = (refuse(*URDFDOM, MUJOCO, *readers),)
            if in_joint and few:
                worst = refuse if element.tag == "axis" else complain
                effects += (worst(PYBULLET),)
            yield Found(
                element,
                f'{key}="{element.get(key)}": {len(words)} numbers, {count} belong there',
                *effects,
                mend=f"write {count}",
            )


def not_finite(doc: Document) -> Iterator[Found]:
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
        yield Found(element, message, *tuple(_infinite_effects(element, bad[0])), mend=mend)


def _infinite_effects(element: etree._Element, word: str) -> Iterator[Effect]:
    in_joint = _owner(element) == "joint"
    yield refuse(*(URDFDOM if in_joint else ()), DRAKE)
    if not in_joint:
        yield complain(*URDFDOM, text="leave the element around it out")
    if _overflows(word) or element.tag == "mass":
        yield refuse(MUJOCO)
    elif element.tag == "origin" or "nan" in word.lower():
        yield complain(MUJOCO, text="computes NaN")
    if in_joint and element.tag == "origin":
        yield complain(IKPY, text="computes NaN")
        if "nan" not in word.lower():
            yield complain(YOURDFPY, text="computes NaN")
    yield misread(PYBULLET, YOURDFPY, text="compute with it")


def _overflows(word: str) -> bool:
    return bool(NUMBER.fullmatch(word)) and abs(float(word)) > LARGEST


def negative_zero(doc: Document) -> Iterator[Found]:
    """No number of a joint's origin or axis is a minus zero."""
    for element, key, _, words in _words(doc):
        if element.tag not in ("origin", "axis") or _owner(element) != "joint":
            continue
        minus = [w for w in words if w.startswith("-") and NUMBER.fullmatch(w) and float(w) == 0]
        if minus:
            yield Found(
                element,
                f'{key}="{element.get(key)}": {minus[0]} is zero',
                accept(
                    IKFAST,
                    text="programs that generate code may carry the sign along: "
                    "atan2(-0.0, -1) is -pi, atan2(0.0, -1) is pi",
                ),
                mend="write 0",
            )
