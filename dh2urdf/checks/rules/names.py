"""Rules of names: of the robot, its links and joints."""

from __future__ import annotations

from collections.abc import Iterator

from lxml import etree

from dh2urdf.checks.document import Document
from dh2urdf.checks.findings import (
    STRICT,
    URDFDOM,
    Consumer,
    Effect,
    accept,
    complain,
    misread,
    refuse,
)
from dh2urdf.checks.report import Found

__all__ = [
    "duplicate_joint",
    "duplicate_link",
    "joint_named_as_link",
    "name_characters",
    "no_name",
    "robot_name",
    "version",
]


def robot_name(doc: Document) -> Iterator[Found]:
    """<robot> has a name."""
    if not doc.root.get("name"):
        refusing = (*URDFDOM, Consumer.YOURDFPY, Consumer.PYBULLET, Consumer.DRAKE)
        yield Found(
            doc.root, "the robot has no name", refuse(*refusing), mend='write <robot name="...">'
        )


def version(doc: Document) -> Iterator[Found]:
    """The version of the format is one that urdfdom knows."""
    text = doc.root.get("version")
    if text is not None and text not in ("1.0", "1.1", "1.2", "1"):
        yield Found(
            doc.root,
            f'version="{text}" is no version of URDF',
            refuse(*URDFDOM),
            complain(Consumer.DRAKE, text="ignores the attribute"),
            mend="leave the attribute out, or write 1.0",
        )


def no_name(doc: Document) -> Iterator[Found]:
    """Every link and joint has a name."""
    everyone = (*STRICT, Consumer.YOURDFPY, Consumer.IKPY)
    for element in (*doc.links, *doc.joints):
        if element.get("name") is None:
            effects: tuple[Effect, ...] = (refuse(*everyone),)
        elif not element.get("name"):
            effects = (
                refuse(Consumer.PYBULLET),
                complain(Consumer.YOURDFPY, text="does not validate it"),
            )
        else:
            continue
        yield Found(element, "has no name", *effects, mend='write name="..."')


def _repeated(elements: list[etree._Element]) -> Iterator[etree._Element]:
    seen: set[str] = set()
    for element in elements:
        name = element.get("name")
        if name and name in seen:
            yield element
        seen.add(str(name))


def duplicate_link(doc: Document) -> Iterator[Found]:
    """No two links share a name."""
    for link in _repeated(doc.links):
        yield Found(
            link,
            "a second link of this name",
            refuse(*STRICT),
            misread(Consumer.YOURDFPY, Consumer.IKPY, text="take one and drop the other"),
            mend="rename one of them",
        )


def duplicate_joint(doc: Document) -> Iterator[Found]:
    """No two joints share a name."""
    for joint in _repeated(doc.joints):
        yield Found(
            joint,
            "a second joint of this name",
            refuse(*URDFDOM, Consumer.DRAKE),
            refuse(Consumer.PYBULLET, text="crashes"),
            misread(
                Consumer.YOURDFPY, Consumer.MUJOCO, text="take the file; one shadows the other"
            ),
            mend="rename one of them",
        )


def joint_named_as_link(doc: Document) -> Iterator[Found]:
    """No joint has the name of a link."""
    for joint in doc.joints:
        if joint.get("name") in doc.link_by_name:
            yield Found(
                joint,
                "a link has this name too",
                accept(
                    Consumer.PINOCCHIO, text="getFrameId without a FrameType raises on the name"
                ),
                mend="name the joint otherwise, such as ..._joint",
            )


def name_characters(doc: Document) -> Iterator[Found]:
    """Names are of letters, digits and underscores."""
    for element in (*doc.links, *doc.joints):
        name = str(element.get("name", ""))
        odd = [c for c in dict.fromkeys(name) if not (c.isascii() and (c.isalnum() or c in "_-."))]
        if odd:
            yield Found(
                element,
                f"the name holds {' '.join(map(repr, odd))}",
                accept(
                    Consumer.MOVEIT,
                    Consumer.IKFAST,
                    text="names become ROS parameters, topics and C++ identifiers",
                ),
                accept(Consumer.RVIZ, text="frame names of tf hold no slashes"),
                mend="keep to ASCII letters, digits and underscores",
            )
