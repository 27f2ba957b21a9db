"""Rules of the tree: names, what joints join, roots and loops."""

from __future__ import annotations

from collections.abc import Iterator

from lxml import etree

from dh2urdf.checks.document import MOVING, Document
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
    "joins_itself",
    "joint_ends",
    "joint_type",
    "loop",
    "many_degrees",
    "no_links",
    "several_roots",
    "side_frame_first",
    "two_parents",
    "unknown_child",
    "unknown_parent",
]

KINDS = (*MOVING, "fixed", "floating", "planar")


def no_links(doc: Document) -> Iterator[Found]:
    """There are links."""
    if not doc.links:
        yield Found(
            doc.root,
            "the robot has no links",
            refuse(*URDFDOM, Consumer.PYBULLET, Consumer.IKPY),
            mend="is this the right file, or a xacro that was not expanded?",
        )


def joint_ends(doc: Document) -> Iterator[Found]:
    """Every joint names a parent and a child."""
    everyone = (*STRICT, Consumer.YOURDFPY, Consumer.IKPY)
    for joint in doc.joints:
        for tag in ("parent", "child"):
            if not doc.end(joint, tag):
                yield Found(
                    joint, f"has no <{tag}>", refuse(*everyone), mend=f'write <{tag} link="..."/>'
                )


def _unknown(doc: Document, tag: str) -> Iterator[tuple[etree._Element, str]]:
    for joint in doc.joints:
        name = doc.end(joint, tag)
        if name and name not in doc.link_by_name:
            yield joint, f"its {tag} {name!r} is no link of the file"


def unknown_child(doc: Document) -> Iterator[Found]:
    """The child of every joint is a link of the file."""
    for joint, message in _unknown(doc, "child"):
        yield Found(
            joint,
            message,
            refuse(*STRICT, Consumer.YOURDFPY),
            misread(Consumer.IKPY, text="takes the joint as a link of its chain"),
            mend="mend the name, or add the link",
        )


def unknown_parent(doc: Document) -> Iterator[Found]:
    """The parent of every joint is a link of the file."""
    for joint, message in _unknown(doc, "parent"):
        yield Found(
            joint,
            message,
            refuse(*STRICT),
            misread(Consumer.YOURDFPY, Consumer.IKPY, text="take the file all the same"),
            mend="mend the name, or add the link",
        )


def joins_itself(doc: Document) -> Iterator[Found]:
    """No joint joins a link to itself."""
    for joint in doc.joints:
        if doc.end(joint, "parent") == doc.end(joint, "child") != "":
            yield Found(
                joint,
                f"joins {doc.end(joint, 'child')!r} to itself",
                refuse(Consumer.CHECK_URDF, Consumer.IKPY, text="do not come back"),
                refuse(Consumer.PYBULLET, text="crashes"),
                refuse(Consumer.PINOCCHIO, Consumer.YOURDFPY, Consumer.MUJOCO, Consumer.DRAKE),
                mend="mend its parent or its child",
            )


def two_parents(doc: Document) -> Iterator[Found]:
    """No link hangs on two joints."""
    above: dict[str, str] = {}
    for joint in doc.joints:
        child = doc.end(joint, "child")
        if child in above and doc.end(joint, "parent") != child:
            yield Found(
                joint,
                f"{child!r} hangs on joint {above[child]!r} already; a URDF is a tree",
                refuse(Consumer.PYBULLET, text="crashes"),
                refuse(Consumer.YOURDFPY, Consumer.MUJOCO, Consumer.DRAKE),
                refuse(Consumer.PINOCCHIO, text="or misreads, as the names fall"),
                misread(Consumer.CHECK_URDF, text="takes the file as a tree without a word"),
                mend="cut one of the joints; closed loops need SDF or MJCF",
            )
        above.setdefault(child, str(joint.get("name")))


def loop(doc: Document) -> Iterator[Found]:
    """Links do not hang on themselves in a circle."""
    reached: set[str] = set()
    todo = list(doc.roots)
    while todo:
        name = todo.pop()
        if name not in reached:
            reached.add(name)
            todo += [child for child, _ in doc.children[name]]
    circle = [joint for _, child, joint in doc.edges if child not in reached]
    if circle:
        names = ", ".join(str(joint.get("name")) for joint in circle)
        yield Found(
            circle[0],
            f"joints form a loop: {names}",
            refuse(*STRICT, Consumer.IKPY),
            misread(Consumer.YOURDFPY, text="takes the file all the same"),
            mend="cut one of the joints; closed loops need SDF or MJCF",
        )


def several_roots(doc: Document) -> Iterator[Found]:
    """One link only hangs on nothing."""
    hung = {doc.end(joint, "child") for joint in doc.joints}
    loose = [name for name in doc.roots if name not in hung]
    for name in loose[1:]:
        yield Found(
            doc.link_by_name[name],
            f"hangs on nothing, and so does {loose[0]!r}",
            refuse(*URDFDOM),
            refuse(Consumer.PYBULLET, text="crashes"),
            complain(Consumer.YOURDFPY, text="hangs it on the base"),
            misread(Consumer.DRAKE, text="leaves it floating"),
            misread(Consumer.MUJOCO, text="welds it to the world"),
            mend="join it by a fixed joint, or drop it",
        )


def joint_type(doc: Document) -> Iterator[Found]:
    """Every joint is of a type that URDF has."""
    for joint in doc.joints:
        kind = doc.kind(joint)
        if kind not in KINDS:
            yield Found(
                joint,
                f"type {kind!r} is none of {', '.join(KINDS)}" if kind else "has no type",
                refuse(*STRICT, Consumer.IKPY)
                if kind != "spherical"
                else refuse(*URDFDOM, Consumer.DRAKE, Consumer.IKPY),
                complain(Consumer.YOURDFPY),
                mend="a ball joint is three revolute joints; all else is one of the types above",
            )


def many_degrees(doc: Document) -> Iterator[Found]:
    """No joint has more than one degree of freedom."""
    for joint in doc.joints:
        if doc.kind(joint) == "floating":
            yield Found(
                joint,
                "has six degrees of freedom",
                refuse(Consumer.IKPY),
                *([] if doc.end(joint, "parent") in doc.roots else [_below_top()]),
                complain(Consumer.DRAKE, text="leaves the child a free body"),
                complain(Consumer.PYBULLET, text="makes it a fixed joint"),
                misread(Consumer.KDL, text="makes it a fixed joint"),
                mend="fix the base, and let the program that loads the file free it",
            )
        elif doc.kind(joint) == "planar":
            yield Found(
                joint,
                "has three degrees of freedom",
                refuse(Consumer.IKPY),
                misread(Consumer.KDL, text="makes it a fixed joint"),
                mend="write two prismatic joints and a revolute one",
            )


def _below_top() -> Effect:
    return refuse(Consumer.MUJOCO, text="refuses one below the top of the tree")


def side_frame_first(doc: Document) -> Iterator[Found]:
    """The first joint of each link leads on along the longest chain."""
    order = list(doc.roots)
    for name in order:
        order += [child for child, _ in doc.children[name]]
        if len(order) > len(doc.link_by_name):
            return
    below: dict[str, int] = {}
    for name in reversed(order):
        below[name] = max(
            (_moving_below(doc, below, c, j) for c, j in doc.children[name]), default=0
        )
    for link, children in doc.children.items():
        if len(children) > 1 and link in doc.moved | set(doc.roots):
            ways = [_moving_below(doc, below, child, joint) for child, joint in children]
            if ways[0] < max(ways):
                child, joint = children[0]
                yield Found(
                    joint,
                    f"stands before the joint of {link!r} that leads on along the arm",
                    accept(
                        Consumer.IKPY,
                        text=f"follows the first joint of each link, and so ends at {child!r} "
                        "unless told every element of its way",
                    ),
                    mend="write joints of side frames behind those of the arm",
                )


def _moving_below(doc: Document, below: dict[str, int], child: str, joint: etree._Element) -> int:
    return below.get(child, 0) + (doc.kind(joint) in MOVING)
