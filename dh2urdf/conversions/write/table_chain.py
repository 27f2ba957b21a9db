"""From a DH table to a serial chain."""

from __future__ import annotations

import math

import numpy as np

from dh2urdf import transforms as tf
from dh2urdf.chain import SerialChain
from dh2urdf.dh import DHConvention, DHRow, DHTable

__all__ = ["dh_to_chain", "split_row"]

FLIP = np.diag([1.0, -1.0, -1.0, 1.0])
"""``Rot_x(pi)`` exactly: turns an axis round, ``FLIP Z(q) FLIP = Z(-q)``."""


def split_row(row: DHRow, convention: DHConvention) -> tuple[tf.Array, tf.Array]:
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


def dh_to_chain(table: DHTable) -> SerialChain:
    """The chain whose product equals the DH product of the table, factor by factor."""
    links = [table.base.matrix]
    for row in table.rows:
        if not row.is_joint:
            links[-1] = links[-1] @ row.transform(0.0, table.convention)
            continue
        before, after = split_row(row, table.convention)
        flip = np.eye(4) if row.sign > 0 else FLIP
        links[-1] = links[-1] @ before @ flip
        links.append(flip @ after)
    links[-1] = links[-1] @ table.tool.matrix
    joints = table.joints
    return SerialChain(
        links=np.stack(links),
        joint_types=tuple(row.joint_type for row in joints),
        names=table.joint_names,
        lower=np.array([-math.inf if r.lower is None else r.lower for r in joints]),
        upper=np.array([math.inf if r.upper is None else r.upper for r in joints]),
    )
