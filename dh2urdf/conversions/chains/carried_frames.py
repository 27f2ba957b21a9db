"""Frames that ride on the joints of a chain: DH frames, or a model's joint frames."""

from __future__ import annotations

import numpy as np
import pinocchio as pin

from dh2urdf.chain import SerialChain
from dh2urdf.conversions.chains.model_chain import ChainPath
from dh2urdf.conversions.write import FLIP, link_frames
from dh2urdf.dh import DHTable
from dh2urdf.transforms import Array, inverse

__all__ = ["carried_dh_frames", "carried_joint_frames"]


def carried_dh_frames(table: DHTable) -> Array:
    """Frame 0 in base, then DH frame i in the moved z frame of joint i, shape (n + 1, 4, 4)."""
    frames = np.stack(link_frames(table).dh)
    for i, row in enumerate(table.joints, 1):
        if row.sign < 0:
            frames[i] = FLIP @ frames[i]
    frames[0] = table.base_frame
    return frames


def carried_joint_frames(model: pin.Model, path: ChainPath, chain: SerialChain) -> Array:
    """The base, then Pinocchio's frame of joint i in the chain's, shape (n + 1, 4, 4)."""
    frames = np.tile(np.eye(4), (chain.n + 1, 1, 1))
    data = model.createData()
    pin.framesForwardKinematics(model, data, pin.neutral(model))
    M_base_world = data.oMf[path.base].inverse()
    for k, i in enumerate(path.ids):
        T_base_joint = (M_base_world * data.oMi[i]).homogeneous
        frames[k + 1] = inverse(chain.joint_frames[k]) @ T_base_joint
    return frames
