"""The rule of rounded angles, and what they cost in forward kinematics."""

import math
from collections.abc import Iterator, Mapping

import numpy as np
from lxml import etree

from dh2urdf import transforms as tf
from dh2urdf.checks.document import Document
from dh2urdf.checks.findings import Finding, finding, misread
from dh2urdf.conversions.chains import turn_slide
from dh2urdf.conversions.read import MOVING
from dh2urdf.conversions.write import frame_along
from dh2urdf.transforms import Array

EXACT = 1e-8
"""Angle [rad] below which a rounding is of no account: eight decimals."""

COUNT = 64
"""Random configurations over which the cost is measured."""

STEPS = {2: math.pi / 2, 3: math.pi / 4}
"""Multiples of what an angle of so few decimals is taken to stand for; 15 degrees beyond."""


def meant_angle(word: str) -> float | None:
    """The multiple of 15 degrees that a number [rad] was rounded or cut off from, if it was."""
    value, decimals = float(word), len(word.partition(".")[2])
    step = STEPS.get(decimals, math.pi / 12)
    k = round(value / step)
    if decimals < 2 or k == 0 or "e" in word.lower():
        return None
    exact = (k // 6) * (math.pi / 2) if step == math.pi / 12 and k % 6 == 0 else k * step
    last = 10.0**-decimals
    off = abs(exact) - abs(value)
    return exact if -0.5 * last <= off < last and abs(off) > EXACT else None


def rounded_angle(doc: Document) -> Iterator[Finding]:
    """Right angles are written with every digit."""
    mended: dict[etree._Element, list[float]] = {}
    for _, _, joint in doc.edges:
        origin = joint.find("origin")
        rpy = doc.numbers(origin, "rpy")
        if rpy is not None and origin is not None:
            meant = [meant_angle(word) for word in origin.get("rpy", "").split()]
            if any(angle is not None for angle in meant):
                mended[joint] = [v if m is None else m for v, m in zip(rpy, meant, strict=True)]
    if not mended:
        return
    first, angles = next(iter(mended.items()))
    origin = first.find("origin")
    names = [str(joint.get("name")) for joint in mended]
    shown = ", ".join(names[:6]) + (f" and {len(names) - 6} more" if len(names) > 6 else "")
    message = f'rpy="{origin.get("rpy")}" is rounded; joints: {shown}. {_cost(doc, mended)}'
    text = "see axes that are nearly parallel or nearly meet; they look for ones that do"
    mend = f"write {' '.join(map(repr, angles))}; `dh2urdf extract --snap` sets such "
    mend += "angles right and prints what each costs"
    yield finding(origin, message, misread("IKFast MoveIt", text), mend=mend)


def _cost(doc: Document, mended: Mapping[etree._Element, list[float]]) -> str:
    q = np.random.default_rng(0).uniform(-math.pi, math.pi, size=(len(doc.edges), COUNT))
    written, exact = _poses(doc, {}, q), _poses(doc, mended, q)
    if written is None or exact is None:
        return "What it costs cannot be measured in this file"
    ways = {name: exact[name][:, :3, 3] - written[name][:, :3, 3] for name in written}
    moved = {name: float(np.linalg.norm(way, axis=-1).max()) for name, way in ways.items()}
    link = max(moved, key=lambda name: moved[name])
    if moved[link] > 1e-9:
        return f"That moves {link!r} by up to {_length(moved[link])} (measured)"
    turned = {name: tf.pose_error(exact[name], written[name]) for name in written}
    link = max(turned, key=lambda name: turned[name])
    return f"That turns {link!r} by up to {turned[link]:.2g} rad (measured)"


def _length(metres: float) -> str:
    for unit, size in (("m", 1.0), ("mm", 1e-3), ("um", 1e-6)):
        if metres >= size:
            return f"{metres / size:.3g} {unit}"
    return f"{metres * 1e9:.3g} nm"


def _poses(
    doc: Document, mended: Mapping[etree._Element, list[float]], q: Array
) -> dict[str, Array] | None:
    """Pose of every link at many configurations, (m, 4, 4) each; None for no sound tree.

    ``mended`` are angles to take in place of the file's; values within the limits are drawn by
    folding from ``q``, shape (joints, m).
    """
    index = {id(joint): k for k, (_, _, joint) in enumerate(doc.edges)}
    if len(doc.roots) != 1 or len(doc.edges) != len(doc.links) - 1:
        return None
    poses = {doc.roots[0]: np.broadcast_to(np.eye(4), (q.shape[1], 4, 4))}
    todo = list(doc.roots)
    for parent in todo:
        for child, joint in doc.children[parent]:
            step = _step(doc, joint, mended.get(joint), q[index[id(joint)]])
            if step is None:
                return None
            poses[child] = poses[parent] @ step
            todo.append(child)
    return poses


def _step(doc: Document, joint: etree._Element, rpy: list[float] | None, q: Array) -> Array | None:
    """``T_parent_child`` of a joint, shape (m, 4, 4)."""
    origin = joint.find("origin")
    given = {} if origin is None else origin.attrib
    xyz = doc.numbers(origin, "xyz") if given.get("xyz") else [0.0] * 3
    rpy = rpy or (doc.numbers(origin, "rpy") if given.get("rpy") else [0.0] * 3)
    if xyz is None or rpy is None:
        return None
    T = tf.origin_matrix(xyz, rpy)
    if doc.kind(joint) not in MOVING:
        return np.broadcast_to(T, (len(q), 4, 4))
    axis = np.array(doc.numbers(joint.find("axis"), "xyz") or (1.0, 0.0, 0.0))
    length = float(np.linalg.norm(axis))
    if not length:
        return None
    turn, still = tf.pose(frame_along(axis / length)), np.zeros(len(q))
    variable = _within(doc, joint, q)
    slides = doc.kind(joint) == "prismatic"
    motion = turn_slide(still, variable) if slides else turn_slide(variable, still)
    return np.asarray(T @ turn @ motion @ turn.T)


def _within(doc: Document, joint: etree._Element, q: Array) -> Array:
    """The random values brought into the joint's limits, where it has some."""
    limit = joint.find("limit")
    lower, upper = doc.number(limit, "lower"), doc.number(limit, "upper")
    if lower is None or upper is None or doc.kind(joint) == "continuous":
        return q
    return lower + (q + math.pi) / (2 * math.pi) * (upper - lower)
