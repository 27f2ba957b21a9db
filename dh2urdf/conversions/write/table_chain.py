"""From a DH table to a serial chain, and to the frames in which the URDF puts its links."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from dh2urdf import transforms as tf
from dh2urdf.chain import SerialChain
from dh2urdf.dh import DHConvention, DHRow, DHTable
from dh2urdf.transforms import Array, product

FLIP = np.diag([1.0, -1.0, -1.0, 1.0])
"""``Rot_x(pi)`` exactly: turns an axis round, ``FLIP Z(q) FLIP = Z(-q)``."""


def _split_row(row: DHRow, convention: DHConvention) -> tuple[Array, Array]:
    """A joint's row at q = 0 as ``(before, after)``: ``T(q) = before Z(sign q) after``.

    Standard: ``before = Rot_z(theta) Trans_z(d)``, ``after = Trans_x(a) Rot_x(alpha)``.
    Modified: ``before = Trans_x(a) Rot_x(alpha) Rot_z(theta) Trans_z(d)``, ``after = 1``.
    """
    if convention is DHConvention.MODIFIED:
        return row.transform(0.0, convention), np.eye(4)
    before = tf.rot_z(row.theta)
    before[2, 3] = row.d
    after = tf.rot_x(row.alpha)
    after[0, 3] = row.a
    return before, after


def grouped_rows(table: DHTable) -> tuple[list[DHRow], list[tuple[DHRow, list[DHRow]]]]:
    """Fixed rows before the first joint, and each joint with the fixed rows after it."""
    leading: list[DHRow] = []
    groups: list[tuple[DHRow, list[DHRow]]] = []
    for row in table.rows:
        if row.is_joint:
            groups.append((row, []))
        else:
            (groups[-1][1] if groups else leading).append(row)
    return leading, groups


@dataclass(frozen=True, eq=False)
class LinkFrames:
    """Where the URDF puts its links.

    Parameters
    ----------
    origins : tuple of n arrays (4, 4)
        ``T_parent_link`` of each joint's ``<origin>``: base_link to link 1, link 1 to link 2, ...
    dh : tuple of n + 1 arrays (4, 4)
        DH frame i in the frame of link i (frame 0 in base_link).
    tool : array, shape (4, 4)
        ``tool0`` in the frame of link n.
    """

    origins: tuple[Array, ...]
    dh: tuple[Array, ...]
    tool: Array


def link_frames(table: DHTable) -> LinkFrames:
    """Split the DH product into URDF origins and DH frames.

    Standard DH: the tail ``Trans_x(a) Rot_x(alpha)`` of a row goes into the next joint's origin,
    the last one into the tool. Modified DH: the link frames are the DH frames.
    """
    origins: list[Array] = []
    dh = [table.base.matrix]
    for row in table.rows:
        if row.is_joint:
            before, after = _split_row(row, table.convention)
            origins.append(product(dh[-1], before))
            dh.append(after)
        else:
            dh[-1] = product(dh[-1], row.transform(0.0, table.convention))
    return LinkFrames(tuple(origins), tuple(dh), product(dh[-1], table.tool.matrix))


def turned_round(links: Array, signs: Iterable[int]) -> Array:
    """Links (n + 1, 4, 4) of the chain whose joints have z turned round where the sign is -1."""
    out = links.copy()
    for i, sign in enumerate(signs):
        if sign < 0:
            out[i], out[i + 1] = product(out[i], FLIP), product(FLIP, out[i + 1])
    return out


def dh_to_chain(table: DHTable, frames: LinkFrames | None = None) -> SerialChain:
    """The chain whose product equals the DH product of the table, factor by factor."""
    joints, frames = table.joints, frames or link_frames(table)
    links = np.stack([*frames.origins, frames.tool])
    return SerialChain(
        links=turned_round(links, [row.sign for row in joints]),
        joint_types=tuple(row.joint_type for row in joints),
        names=table.joint_names,
        lower=np.array([low for low, _ in table.joint_ranges]),
        upper=np.array([high for _, high in table.joint_ranges]),
    )
