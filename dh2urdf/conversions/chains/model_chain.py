"""From a Pinocchio model to the serial chain between two of its frames, and what it moves."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import pinocchio as pin

from dh2urdf import transforms as tf
from dh2urdf.bounds import ANGLE, JOINTS, LENGTH, LINKS
from dh2urdf.chain import SerialChain
from dh2urdf.conversions.chains.tree_chain import ChainSource, frame_with_z
from dh2urdf.conversions.read import TIP_NAMES, Actuation, listed, no_such
from dh2urdf.conversions.write import Inertial
from dh2urdf.dh import JointType
from dh2urdf.doors import instance, text
from dh2urdf.exceptions import NameNotFoundError, UrdfError
from dh2urdf.transforms import Array

CONTINUOUS = ("JointModelRUB", "JointModelRevoluteUnboundedUnaligned")


@dataclass(frozen=True)
class ChainPath:
    """Joints between two frames: up from the base to their common ancestor, then down to the tip.

    ``ids`` are Pinocchio joint indices in the order from base to tip; ``up`` of them are passed
    against their direction.
    """

    base: int
    tip: int
    ids: tuple[int, ...]
    up: int


def frame_names(model: pin.Model) -> list[str]:
    """Names of the model's links, in its own order."""
    return [f.name for f in model.frames if f.type == pin.FrameType.BODY]


def tip_names(model: pin.Model) -> list[str]:
    """Links that no other link hangs on."""
    parents = {f.parentFrame for f in model.frames}
    links = {i for i, f in enumerate(model.frames) if f.type == pin.FrameType.BODY}
    inner = {model.frames[p].parentFrame for p in parents} | parents
    return [model.frames[i].name for i in sorted(links - inner)]


def frame_id(model: pin.Model, name: str) -> int:
    """Index of a link, or else of any frame, by name; NameNotFoundError lists the links."""
    instance(model, "model", pin.Model), text(name, "base or tip")
    for kind in (pin.FrameType.BODY, pin.FrameType.FIXED_JOINT, pin.FrameType.OP_FRAME):
        if model.existFrame(name, kind):
            return int(model.getFrameId(name, kind))
    raise NameNotFoundError(f"no frame named {no_such(name, frame_names(model), 'the model')}")


def chain_path(model: pin.Model, base: int, tip: int) -> ChainPath:
    """The joints between frames base and tip (indices), each of one degree of freedom."""
    up = list(model.supports[model.frames[base].parentJoint])
    down = list(model.supports[model.frames[tip].parentJoint])
    while up and down and up[0] == down[0]:
        up.pop(0)
        down.pop(0)
    ids = tuple(int(i) for i in (*reversed(up), *down))
    names = f"{model.frames[base].name!r} and {model.frames[tip].name!r}"
    if not ids:
        raise UrdfError(f"no joint moves between {names}; tips: {listed(tip_names(model))}")
    if len(ids) > JOINTS:
        raise UrdfError(f"{len(ids)} joints between {names}; a chain has up to {JOINTS}")
    for i in ids:
        if model.joints[i].nv != 1 or "Helical" in model.joints[i].shortname():
            raise UrdfError(
                f"joint {model.names[i]!r} between {names} is a {model.joints[i].shortname()}; "
                "a serial chain takes revolute, continuous and prismatic joints"
            )
    return ChainPath(base, tip, ids, len(up))


def model_to_chain(model: pin.Model, path: ChainPath) -> SerialChain:
    """The chain of a path, all joints off the path held at neutral.

    q of the chain is the model's joint value, an angle where Pinocchio keeps cosine and sine.
    """
    data = model.createData()
    neutral = pin.neutral(model)
    pin.computeJointJacobians(model, data, neutral)
    pin.updateFramePlacements(model, data)
    frames: list[Array] = [data.oMf[path.base].homogeneous]
    types: list[JointType] = []
    for k, i in enumerate(path.ids):
        S = np.asarray(data.joints[i].S, float).reshape(6)
        linear = bool(np.abs(S[:3]).max() > np.abs(S[3:]).max())
        axis = S[:3] if linear else S[3:]
        types.append(JointType.PRISMATIC if linear else JointType.REVOLUTE)
        turn = tf.pose(frame_with_z(-axis if k < path.up else axis))
        frames.append(data.oMi[i].homogeneous @ turn)
    frames.append(data.oMf[path.tip].homogeneous)
    slides = [kind is JointType.PRISMATIC for kind in types]
    lower, upper = zip(*map(_limits, [model] * len(types), path.ids, slides), strict=True)
    return SerialChain(
        links=np.stack([_relative(a, b) for a, b in pairwise(frames)]),
        joint_types=tuple(types),
        names=tuple(model.names[i] for i in path.ids),
        lower=np.array(lower),
        upper=np.array(upper),
    )


def is_continuous(model: pin.Model, i: int) -> bool:
    """True for a joint that Pinocchio keeps as cosine and sine."""
    return bool(model.joints[i].shortname().startswith(CONTINUOUS))


def _limits(model: pin.Model, i: int, slides: bool) -> tuple[float, float]:
    """Bounds of a joint; none where they are so far that they bound nothing."""
    if is_continuous(model, i):
        return -np.inf, np.inf
    k, far = model.joints[i].idx_q, LENGTH if slides else ANGLE
    lower, upper = float(model.lowerPositionLimit[k]), float(model.upperPositionLimit[k])
    return lower if abs(lower) <= far else -np.inf, upper if abs(upper) <= far else np.inf


def _relative(T_world_a: Array, T_world_b: Array) -> Array:
    """``T_a_b``, with the rotation's rounding noise below 1e-16 cleared."""
    T_a_b: Array = pin.SE3(T_world_a).inverse().homogeneous @ T_world_b
    T_a_b[np.abs(T_a_b) < 1e-16] = 0.0
    return T_a_b


def with_locked(model: pin.Model, ids: Sequence[int]) -> pin.Model:
    """The model with some joints held at neutral.

    Pinocchio looks joints up among all names, where a link may have the same: they take names of
    their own meanwhile.
    """
    model = model.copy()
    names = dict(enumerate(list(model.names)))
    for frame in model.frames:
        if frame.type == pin.FrameType.JOINT:
            frame.name = f"\n{frame.parentJoint}"
    for i in range(1, model.njoints):
        model.names[i] = f"\n{i}"
    reduced = pin.buildReducedModel(model, list(ids), pin.neutral(model))
    for i in range(1, reduced.njoints):
        reduced.names[i] = names[int(reduced.names[i])]
    for frame in reduced.frames:
        if frame.name.startswith("\n"):
            frame.name = names[int(frame.name)]
    return reduced


def model_source(
    model: pin.Model, base: str | None, tip: str | None
) -> tuple[ChainSource, ChainPath]:
    """The chain between two frames of a model; without names its root and its longest chain."""
    links = frame_names(model)
    if model.njoints > LINKS:
        raise UrdfError(f"{model.name}: {model.njoints} joints; up to {LINKS} are read")
    if not links:
        raise UrdfError(f"{model.name}: the model has no links")
    base_id = frame_id(model, base or links[0])
    tip_id = _default_tip(model, base_id) if tip is None else frame_id(model, tip)
    path = chain_path(model, base_id, tip_id)
    with np.errstate(all="ignore"):  # of numbers that the chain refuses
        chain = model_to_chain(model, path)
    source = ChainSource(
        chain,
        model.name or "robot",
        model.frames[base_id].name,
        model.frames[tip_id].name,
        bodies=_bodies(model, path, chain.joint_frames),
        drives=tuple(_drive(model, i) for i in path.ids),
        origin="a Pinocchio model",
    )
    return source, path


def _bodies(model: pin.Model, path: ChainPath, joint_frames: Array) -> tuple[Inertial | None, ...]:
    """All bodies that move with each joint of the path, other joints at neutral."""
    data = model.createData()
    pin.framesForwardKinematics(model, data, pin.neutral(model))
    frames = data.oMf[path.base].homogeneous @ joint_frames
    on_path = set(path.ids)
    groups: dict[int, list[int]] = {}
    for body in range(model.njoints):
        carrier = body
        while carrier != 0 and carrier not in on_path:
            carrier = int(model.parents[carrier])
        groups.setdefault(carrier, []).append(body)
    out = []
    for k, i in enumerate(path.ids):
        # Passed upwards, a joint moves what lies above it: the next group, at last the root's.
        carrier = i if k >= path.up else (path.ids[k + 1] if k + 1 < path.up else 0)
        T_joint_world = tf.inverse(frames[k])
        parts = [
            Inertial(inertia.mass, np.array(inertia.lever), np.array(inertia.inertia)).moved(
                T_joint_world @ data.oMi[body].homogeneous
            )
            for body in groups.get(carrier, [])
            if (inertia := model.inertias[body]).mass > 0
        ]
        out.append(Inertial.total(parts) if parts else None)
    return tuple(out)


def _drive(model: pin.Model, i: int) -> Actuation:
    """Velocity, effort, damping and friction of a joint, None where the model has no number."""
    v = model.joints[i].idx_v
    found = []
    for values in (model.velocityLimit, model.effortLimit, model.damping, model.friction):
        value = float(values[v])
        found.append(value if np.isfinite(value) and 0 < value < 1e10 else None)
    return Actuation(*found)


def _default_tip(model: pin.Model, base: int) -> int:
    """The tip with the most joints from the base; on one last joint a usual name, or the last."""
    found: dict[tuple[int, ...], list[int]] = {}
    refused = UrdfError("the model has no chain of revolute and prismatic joints")
    for name in tip_names(model):
        tip = frame_id(model, name)
        try:
            found.setdefault(chain_path(model, base, tip).ids, []).append(tip)
        except UrdfError as error:
            refused = error
    if not found:
        raise refused
    most = max(map(len, found))
    longest = [tips for ids, tips in found.items() if len(ids) == most]
    if len(longest) > 1:
        names = listed(model.frames[t].name for tips in longest for t in tips)
        raise UrdfError(f"several chains of {most} joints; name the tip, one of: {names}")
    tips = {model.frames[t].name: t for t in longest[0]}
    usual = [tips[name] for name in TIP_NAMES if name in tips]
    return usual[0] if usual else longest[0][-1]
