"""KDL's segments: a joint and the frame of the tip, each in the frame of the tip before.

``T_root_tip(q) = Trans(origin) Rot(axis, q) Trans(-origin) f_tip`` for a joint of type RotAxis,
``Trans(q axis) f_tip`` for TransAxis (Orocos KDL, joint.cpp and segment.cpp). In PyKDL::

    Segment(name, Joint(joint_name, Vector(*origin), Vector(*axis), Joint.RotAxis),
            Frame(Rotation.RPY(*rpy), Vector(*xyz)))
"""

from collections.abc import Mapping
from itertools import pairwise
from typing import Any

import numpy as np

from dh2urdf import transforms as tf
from dh2urdf.bounds import JOINTS
from dh2urdf.chain import SerialChain
from dh2urdf.conversions.assign import chain_to_dh, tidy_length
from dh2urdf.conversions.chains import typed_to_chain
from dh2urdf.conversions.forms.parts import (
    Read,
    check_keys,
    limits,
    mapping,
    numbers,
    step,
    step_of,
)
from dh2urdf.dh import JointType
from dh2urdf.dh_io import Kind
from dh2urdf.doors import choice, found, text
from dh2urdf.exceptions import TableError
from dh2urdf.transforms import Array, product

HEAD = """\
KDL segments [m, rad]: T_root_tip(q) = Trans(origin) Rot(axis, q) Trans(-origin) f_tip,
each in the tip frame of the segment before"""

TYPES = ("RotAxis", "TransAxis", "RotX", "RotY", "RotZ", "TransX", "TransY", "TransZ", "Fixed")
SEGMENT = ("name", "joint", "f_tip")
JOINT = ("name", "type", "origin", "axis", "lower", "upper")


def kdl_content(chain: SerialChain, name: str) -> dict[str, Any]:
    """What a file of segments says of a chain: tips are the frames of the joints, then the tool."""
    frames = [np.eye(4), *chain.joint_frames[1:], chain.tool]
    segments = []
    for i, (T_root, T_tip) in enumerate(pairwise(frames)):
        T_root_joint = product(tf.inverse(T_root), chain.joint_frames[i])
        joint: dict[str, Any] = {"name": chain.names[i]}
        joint["type"] = "TransAxis" if chain.prismatic[i] else "RotAxis"
        for key, column, size in (("origin", 3, chain.size), ("axis", 2, 1.0)):
            joint[key] = [tidy_length(float(v), size) for v in T_root_joint[:3, column]]
        bounds = {"lower": float(chain.lower[i]), "upper": float(chain.upper[i])}
        joint |= {key: v for key, v in bounds.items() if np.isfinite(v)}
        tip = step_of(product(tf.inverse(T_root), T_tip), chain.size)
        segments.append({"name": f"segment_{i + 1}", "joint": joint, "f_tip": tip})
    return {"name": name, "segments": segments}


def read_kdl(content: Mapping[str, Any], name: str) -> Read:
    """The table of a file of segments, by frame assignment.

    Raises
    ------
    TableError
    """
    check_keys(content, ("name", "segments"))
    segments = content["segments"]
    if not isinstance(segments, list) or not 0 < len(segments) <= 2 * JOINTS:
        raise TableError(f"segments: expected up to {2 * JOINTS}, got {found(segments)}")
    T, joints, axes = np.eye(4), [], []
    for i, cell in enumerate(segments, 1):
        given = mapping(cell, f"segments[{i}]", SEGMENT)
        joint = mapping(given.get("joint", {}), f"segments[{i}].joint", JOINT)
        kind = choice(joint.get("type", "Fixed"), f"segments[{i}].joint.type", TYPES, TableError)
        if kind != "Fixed":
            axes.append(_line(T, joint, kind, f"segments[{i}].joint"))
            joints.append((joint, JointType.PRISMATIC if kind[0] == "T" else JointType.REVOLUTE))
        T = product(T, step(given.get("f_tip", {}), f"segments[{i}].f_tip"))
    if not joints:
        raise TableError("segments: none of the joints moves")
    labels = [
        text(joint.get("name") or f"joint_{i}", "name", TableError)
        for i, (joint, _) in enumerate(joints, 1)
    ]
    kinds = [Kind.LENGTH if t is JointType.PRISMATIC else Kind.ANGLE for _, t in joints]
    ends = {key: [joint.get(key) for joint, _ in joints] for key in ("lower", "upper")}
    chain = typed_to_chain(np.array(axes), [t for _, t in joints], T, labels)
    low, high = limits(ends, kinds)
    bounded = SerialChain(chain.links, chain.joint_types, chain.names, low, high)
    return chain_to_dh(bounded, name=content.get("name") or name).table, ()


def _line(T_base_root: Array, joint: Mapping[str, Any], kind: str, what: str) -> Array:
    """Direction and point of a joint's axis in the base, shape (2, 3)."""
    axis = np.eye(3)["XYZ".index(kind[-1])].tolist() if kind[-1] in "XYZ" else [0, 0, 1]
    direction = numbers(joint.get("axis", axis), f"{what}.axis", Kind.LENGTH, 3)
    origin = numbers(joint.get("origin", [0, 0, 0]), f"{what}.origin", Kind.LENGTH, 3)
    line = np.array([T_base_root[:3, :3] @ direction, T_base_root[:3, :3] @ origin])
    line[1] += T_base_root[:3, 3]
    return line
