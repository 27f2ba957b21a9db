"""What rides on the joints: drives, bodies and frames of a source, and joints that mimic others."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace

import numpy as np
import pinocchio as pin

from dh2urdf.chain import SerialChain
from dh2urdf.conversions.chains.model_chain import ChainPath
from dh2urdf.conversions.chains.tree_chain import ChainSource
from dh2urdf.conversions.read import Actuation, Mimic
from dh2urdf.conversions.write import FLIP, Inertial, LinkFrames, six_of, without_noise
from dh2urdf.dh import DHRow, DHTable
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


@dataclass(frozen=True, eq=False)
class Coupling:
    """``q_chain = matrix @ q + offset``, with matrix (chain.n, n) and offset (chain.n,).

    ``names`` are the n leading joints, ``lower`` and ``upper`` the bounds within which every
    follower stays in its own, ``first`` for each value the first joint of the chain that it
    moves. ``warnings`` name joints whose own bounds leave nothing of those of the others, and so
    count for nothing.
    """

    matrix: Array
    offset: Array
    names: tuple[str, ...]
    lower: Array
    upper: Array
    first: tuple[int, ...]
    warnings: tuple[str, ...] = ()


def couple(chain: SerialChain, mimics: Mapping[str, Mimic]) -> Coupling | None:
    """The coupling of a chain; None where no joint of it mimics another.

    A leader that is not on the chain itself is still a value of q, since it moves the tip.
    """
    if not any(name in mimics for name in chain.names):
        return None
    terms = [_resolve(name, mimics) for name in chain.names]
    names = tuple(dict.fromkeys(leader for leader, _, _ in terms))
    matrix = np.zeros((chain.n, len(names)))
    offset = np.array([constant for _, _, constant in terms])
    lower, upper = np.full(len(names), -np.inf), np.full(len(names), np.inf)
    first = [chain.n] * len(names)
    warnings = []
    leads = [name == leader for name, (leader, _, _) in zip(chain.names, terms, strict=True)]
    for k in sorted(range(chain.n), key=lambda k: not leads[k]):  # leaders before followers
        leader, factor, constant = terms[k]
        v = names.index(leader)
        matrix[k, v] = factor
        first[v] = min(first[v], k)
        if factor:
            own = chain.lower[k], chain.upper[k]
            ends = sorted((bound - constant) / factor for bound in own)
            low, high = max(lower[v], ends[0]), min(upper[v], ends[1])
            if low <= high:
                lower[v], upper[v] = low, high
            else:
                warnings.append(
                    f"joint {chain.names[k]!r}: its limits exclude those of {leader!r}, which it "
                    "follows; left out"
                )
    return Coupling(matrix, offset, names, lower, upper, tuple(first), tuple(warnings))


def _resolve(name: str, mimics: Mapping[str, Mimic]) -> tuple[str, float, float]:
    """Leader, factor and constant of a joint, through chains of mimics."""
    factor, constant, seen = 1.0, 0.0, {name}
    while name in mimics and mimics[name].leader not in seen:
        mimic = mimics[name]
        constant += factor * mimic.offset
        factor *= mimic.multiplier
        name = mimic.leader
        seen.add(name)
    return name, factor, constant
