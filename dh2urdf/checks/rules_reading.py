"""Rules of how a file is read: elements given twice, links that are fused away."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from lxml import etree

from dh2urdf.checks.document import Document
from dh2urdf.checks.findings import Consumer, Verdict, effect
from dh2urdf.checks.report import Found

__all__ = ["fused_frames", "repeated_element"]

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
                        (
                            effect(Consumer.MUJOCO, Verdict.REFUSES),
                            effect(
                                (Consumer.PINOCCHIO, Consumer.CHECK_URDF, Consumer.YOURDFPY),
                                Verdict.MISREADS,
                                "take the first without a word",
                            ),
                        ),
                        "drop one of them",
                    )


def fused_frames(doc: Document) -> Iterator[Found]:
    """MuJoCo is told to keep links on fixed joints."""
    frames = [c for _, c, joint in doc.edges if doc.kind(joint) == "fixed"]
    if frames and doc.mujoco.get("fusestatic") != "false":
        shown = ", ".join(frames[:6]) + (", ..." if len(frames) > 6 else "")
        yield Found(
            doc.link_by_name[frames[0]],
            f"hangs on a fixed joint; such links: {shown}",
            (
                effect(
                    (Consumer.MUJOCO, Consumer.GAZEBO),
                    Verdict.ACCEPTS,
                    "fuse it with its parent: its name is gone, and MuJoCo drops all visuals",
                ),
            ),
            'add <mujoco><compiler fusestatic="false" discardvisual="false"/></mujoco>',
        )
