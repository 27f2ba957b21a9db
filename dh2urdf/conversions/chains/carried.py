"""What rides on the joints: drives, bodies and frames of a source."""

from collections.abc import Sequence
from dataclasses import asdict, replace

import numpy as np
import pinocchio as pin

from dh2urdf.chain import SerialChain, resolved
from dh2urdf.conversions.chains.model_chain import ChainPath
from dh2urdf.conversions.chains.tree_chain import ChainSource
from dh2urdf.conversions.read import Actuation
from dh2urdf.conversions.write import FLIP, Inertial, LinkFrames, six_of, without_noise
from dh2urdf.dh import DHRow, DHTable, Mimic
from dh2urdf.transforms import Array, inverse


def carry(table: DHTable, source: ChainSource) -> DHTable:
    """The table with drives and inertial parameters of its source, moved into the DH frames."""
    frames = table.frames(np.zeros(table.n))[1:]
    parts = iter(zip(source.chain.joint_frames, frames, source.bodies, source.drives, strict=True))
    return replace(
        table,
        rows=tuple(_carried(row, *next(parts)) if row.is_joint else row for row in table.rows),
    )


def _carried(
    row: DHRow, T_base_joint: Array, T_base_dh: Array, body: Inertial | None, drive: Actuation
) -> DHRow:
    """The row with its drive, and with a body given in the chain's frame of its joint."""
    row = replace(row, **asdict(drive))
    if body is None:
        return row
    moved = body.moved(inverse(T_base_dh) @ T_base_joint)
    x, y, z = without_noise(moved.com, 1e-3).tolist()
    m = without_noise(0.5 * (moved.inertia + moved.inertia.T))
    return replace(row, mass=body.mass, com=(x, y, z), inertia=six_of(m))


def following(table: DHTable, mimics: Sequence[Mimic | None]) -> DHTable:
    """The table with what each of its joints follows."""
    if not any(mimics):
        return table
    each = iter(mimics)
    rows = (replace(row, mimic=next(each)) if row.is_joint else row for row in table.rows)
    return replace(table, rows=tuple(rows))


def following_alike(table: DHTable, mimics: Sequence[Mimic | None]) -> bool:
    """Whether the joints of a table follow as those of a source do, which may name other leaders.

    A file that is written of a joint which follows a follower names the one that leads both.
    """
    names = table.joint_names
    own, read = (
        {name: mimic for name, mimic in zip(names, each, strict=False) if mimic is not None}
        for each in ([row.mimic for row in table.joints], mimics)
    )
    return all(resolved(name, own) == resolved(name, read) for name in names)


def carried_dh_frames(table: DHTable, own: LinkFrames) -> Array:
    """Frame 0 in base, then DH frame i in the moved z frame of joint i, shape (n + 1, 4, 4)."""
    frames = np.stack(own.dh)
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
