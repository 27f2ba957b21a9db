"""A Pinocchio model as a source of a chain, with the inertias that move with each joint."""

import numpy as np
import pinocchio as pin

from dh2urdf import transforms as tf
from dh2urdf.bounds import LINKS
from dh2urdf.conversions.chains.model_chain import (
    ChainPath,
    chain_path,
    frame_id,
    frame_names,
    model_to_chain,
    tip_names,
)
from dh2urdf.conversions.chains.tree_chain import Actuation, ChainSource
from dh2urdf.conversions.read import TIP_NAMES, listed
from dh2urdf.conversions.write import Inertial
from dh2urdf.exceptions import UrdfError
from dh2urdf.transforms import Array


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
    """The tip with the most joints from the base.

    Among tips on the same last joint a usual name wins, then the last in the file.

    Raises
    ------
    UrdfError
        Tips of different branches with equally many joints; the message lists them.
    """
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
