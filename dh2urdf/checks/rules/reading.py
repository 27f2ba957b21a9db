"""Rules of how a file is read: elements given twice, links fused away, joints that follow."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from lxml import etree

from dh2urdf.checks.document import MOVING, Document
from dh2urdf.checks.findings import URDFDOM, Consumer, accept, complain, misread, refuse
from dh2urdf.checks.report import Found

__all__ = ["fused_frames", "mimic", "mimic_leader", "repeated_element"]

ONCE = {
    "link": ("inertial",),
    "joint": ("origin", "parent", "child", "axis", "limit", "dynamics", "mimic"),
    "inertial": ("origin", "mass", "inertia"),
}
"""Elements that may stand once in another."""


def repeated_element(doc: Document) -> Iterator[Found]:
    """What may stand once stands once."""
    for tag, once in ONCE.items():
        for element in doc.root.iter(tag):
            counts = Counter(child.tag for child in element.iterchildren(etree.Element))
            for key in once:
                if counts[key] > 1:
                    yield Found(
                        element,
                        f"has {counts[key]} <{key}>",
                        refuse(Consumer.MUJOCO),
                        misread(
                            Consumer.PINOCCHIO,
                            Consumer.CHECK_URDF,
                            Consumer.YOURDFPY,
                            text="take the first without a word",
                        ),
                        mend="drop one of them",
                    )


def fused_frames(doc: Document) -> Iterator[Found]:
    """MuJoCo is told to keep links on fixed joints."""
    frames = [c for _, c, joint in doc.edges if doc.kind(joint) == "fixed"]
    if frames and doc.mujoco.get("fusestatic") != "false":
        shown = ", ".join(frames[:6]) + (", ..." if len(frames) > 6 else "")
        yield Found(
            doc.link_by_name[frames[0]],
            f"hangs on a fixed joint; such links: {shown}",
            accept(
                Consumer.MUJOCO,
                Consumer.GAZEBO,
                text="fuse it with its parent: its name is gone, and MuJoCo drops all visuals",
            ),
            mend='add <mujoco><compiler fusestatic="false" discardvisual="false"/></mujoco>',
        )


def mimic_leader(doc: Document) -> Iterator[Found]:
    """A <mimic> names another moving joint."""
    for joint in doc.joints:
        element = joint.find("mimic")
        if element is None:
            continue
        leader = element.get("joint")
        if leader is None:
            yield Found(
                element,
                "names no joint",
                refuse(*URDFDOM, Consumer.MUJOCO, Consumer.DRAKE),
                complain(Consumer.YOURDFPY),
                mend='write <mimic joint="..."/>',
            )
            continue
        itself = leader == joint.get("name")
        known = doc.joint_by_name.get(leader)
        if itself or known is None or doc.kind(known) not in MOVING:
            what = "the joint itself" if itself else f"{leader!r}, which is no moving joint"
            yield Found(
                element,
                f"follows {what}",
                refuse(Consumer.DRAKE),
                (refuse if itself else complain)(Consumer.MUJOCO),
                complain(Consumer.YOURDFPY, text="takes the leader as 0"),
                accept(
                    Consumer.PINOCCHIO, Consumer.CHECK_URDF, Consumer.IKPY, text="do not look at it"
                ),
                mend="mend the name of the joint that it follows",
            )


def mimic(doc: Document) -> Iterator[Found]:
    """No joint follows another."""
    for joint in doc.joints:
        element = joint.find("mimic")
        leader = None if element is None else doc.joint_by_name.get(element.get("joint", ""))
        if leader is not None and leader is not joint and doc.kind(leader) in MOVING:
            yield Found(
                element,
                f"follows {leader.get('name')!r}",
                accept(
                    Consumer.PINOCCHIO,
                    Consumer.PYBULLET,
                    Consumer.KDL,
                    Consumer.IKPY,
                    text="move it on its own; Pinocchio follows when asked (mimic=True)",
                ),
                mend="couple the joints in your own program",
            )
