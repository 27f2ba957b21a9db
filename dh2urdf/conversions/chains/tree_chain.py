"""From a tree of links and joints to the serial chain between two of its links."""

import math
import os
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from dh2urdf import transforms as tf
from dh2urdf.chain import SerialChain
from dh2urdf.conversions.read import (
    MOVING,
    Actuation,
    KinematicTree,
    Step,
    TreeJoint,
    find_path,
    rigid_part,
)
from dh2urdf.conversions.write import FLIP, Inertial
from dh2urdf.dh import JointType, Mimic
from dh2urdf.transforms import Array


@dataclass(frozen=True, eq=False)
class ChainSource:
    """A chain and what else a DH table can carry of its source.

    Parameters
    ----------
    bodies : tuple of n Inertial or None
        All that moves with joint i, in the chain's frame of joint i.
    drives : tuple of n Actuation
    mimics : tuple of n Mimic or None
        What joint i follows of the others; empty where none does.
    warnings : tuple of str
    origin : str
        What the chain was read from, in a word or a file's name.
    """

    chain: SerialChain
    name: str
    base: str
    tip: str
    bodies: tuple[Inertial | None, ...]
    drives: tuple[Actuation, ...]
    warnings: tuple[str, ...] = ()
    origin: str = ""
    mimics: tuple[Mimic | None, ...] = ()


def tree_to_chain(tree: KinematicTree, base: str, tip: str) -> ChainSource:
    """The chain from base to tip, either anywhere in the tree.

    A joint passed from child to parent turns the other way round: its axis is reversed and its
    q stays the file's. Joints off the way are held at 0, and what hangs on them is part of the
    body that carries them. The product of each link is made on its own, from the file's numbers
    alone, so that no rounding of the rest of the tree is in it.
    """
    steps = find_path(tree, base, tip)
    moving = [step for step in steps if step.joint.kind in MOVING]
    links, T = [], np.eye(4)
    for step in steps:
        if step.joint.kind in MOVING:
            before, after = _halves(step)
            links.append(T @ before)
            T = after
        else:
            T = T @ step.at_rest
    links.append(T)
    joints = [step.joint for step in moving]
    chain = SerialChain(
        links=np.stack(links),
        joint_types=tuple(
            JointType.PRISMATIC if j.kind == "prismatic" else JointType.REVOLUTE for j in joints
        ),
        names=tuple(j.name for j in joints),
        lower=np.array([-math.inf if j.lower is None else j.lower for j in joints]),
        upper=np.array([math.inf if j.upper is None else j.upper for j in joints]),
    )
    cut = frozenset(j.name for j in joints)
    return ChainSource(
        chain,
        tree.name,
        base,
        tip,
        bodies=tuple(_body(tree, step, cut) for step in moving),
        drives=tuple(j.drive for j in joints),
        warnings=(*tree.remarks, *_remarks(tree, moving, cut)),
        origin=os.path.basename(tree.where),
        mimics=_mimics(tree, joints),
    )


def frame_with_z(axis: Array) -> Array:
    """A rotation whose z is the unit axis, exact where the axis is a coordinate axis."""
    z = np.asarray(axis, float)
    if np.count_nonzero(z) == 1:
        x = np.eye(3)[(int(np.argmax(np.abs(z))) + 1) % 3]
    else:
        x = np.cross(np.eye(3)[int(np.argmin(np.abs(z)))], z)
        x /= np.linalg.norm(x)
    return np.stack([x, np.cross(z, x), z], axis=1)


def _halves(step: Step) -> tuple[Array, Array]:
    """A moving step at q as ``before Z(q) after``."""
    joint = step.joint
    turn = tf.pose(frame_with_z(joint.axis))
    if step.forward:
        return joint.origin @ turn, turn.T
    # (origin turn Z(q) turn^-1)^-1 = turn FLIP Z(q) FLIP turn^-1 origin^-1
    return turn @ FLIP, FLIP @ turn.T @ tf.inverse(joint.origin)


def _body(tree: KinematicTree, step: Step, cut: frozenset[str]) -> Inertial | None:
    """All that is fixed to the link after a joint, in the chain's frame of that joint."""
    _, T_joint_link = _halves(step)
    parts = [
        inertial.moved(T_joint_link @ T_link_part)
        for name, _, T_link_part in rigid_part(tree, step.link, cut)
        if (inertial := tree.links[name].inertial) is not None
    ]
    return Inertial.total(parts) if parts else None


def _mimics(tree: KinematicTree, joints: Sequence[TreeJoint]) -> tuple[Mimic | None, ...]:
    """What each joint of a chain follows of it, be it through joints that are off it."""
    follows = {joint.name: joint.mimic for joint in tree.joints if joint.mimic}
    names = {joint.name for joint in joints}
    out: list[Mimic | None] = []
    for joint in joints:
        mimic, seen = joint.mimic, {joint.name}
        while mimic is not None and mimic.joint not in names | seen:
            seen.add(mimic.joint)
            above = follows.get(mimic.joint)
            mimic = above and Mimic(
                above.joint,
                mimic.multiplier * above.multiplier,
                mimic.multiplier * above.offset + mimic.offset,
            )
        out.append(None if mimic is None or mimic.joint in seen else mimic)
    return tuple(out) if any(out) else ()


def _remarks(tree: KinematicTree, moving: Sequence[Step], cut: frozenset[str]) -> list[str]:
    """What a user should know of the chain and cannot see from it."""
    follows = _mimics(tree, [step.joint for step in moving]) or (None,) * len(moving)
    remarks = [
        f"{step.joint.where}: follows joint {step.joint.mimic.joint!r}, which is not on the chain; "
        "in the table it is a joint of its own"
        for step, mimic in zip(moving, follows, strict=True)
        if step.joint.mimic and mimic is None
    ]
    held = [
        last.joint.name
        for step in moving
        for _, last, _ in rigid_part(tree, step.link, cut)
        if last is not None and last.joint.kind != "fixed"
    ]
    if held:
        names = list(dict.fromkeys(held))
        more = f" and {len(names) - 3} more" if len(names) > 3 else ""
        remarks.append(
            f"{tree.where}: joints off the chain are held at 0, and what hangs on them counts as "
            f"part of its links: {', '.join(names[:3])}{more}"
        )
    return remarks
