"""Between the standard and the modified convention, without loss."""

from dataclasses import replace
from functools import reduce

import numpy as np

from dh2urdf import transforms as tf
from dh2urdf.conversions.write import Inertial, grouped_rows, six_of, table_difference, tensor
from dh2urdf.dh import DHConvention, DHRow, DHTable, JointType, Origin
from dh2urdf.dh.motions import convention_of
from dh2urdf.dh_io import TableLike, as_table
from dh2urdf.exceptions import VerificationError
from dh2urdf.transforms import Array

LARGEST_ERROR = 1e-9
"""Largest FK difference [rad, and m per m of arm] of a table in the other convention."""


def to_convention(table: TableLike, convention: DHConvention | str) -> DHTable:
    """The same arm in the other convention; FK from base to tool is equal for every q.

    ``Rot_z(theta) Trans_z(d)`` stays in its row. The tail ``Trans_x(a) Rot_x(alpha)`` of a
    standard row moves to the head of the next modified row and back; what is left at the ends
    goes into the tool (to modified) or the base (to standard). Where a fixed row stands between,
    the tail joins it. Centres of mass and tensors move with the frames.

    Examples
    --------
    >>> from dh2urdf import load_table, to_convention
    >>> craig = to_convention(load_table("puma560"), "modified")
    >>> print(craig.convention, [row.a for row in craig.rows])
    modified [0.0, 0.0, 0.4318, 0.0203, 0.0, 0.0]
    """
    table, target = as_table(table), convention_of(convention)
    if target is table.convention:
        return table
    if target is DHConvention.MODIFIED:
        return _to_modified(table)
    return _to_standard(table)


def in_convention(table: DHTable, convention: DHConvention | str | None) -> tuple[DHTable, float]:
    """The arm in a convention, its own for None; largest difference of the tool [m and rad].

    Raises
    ------
    VerificationError
        It would differ by more than rounding.
    """
    if convention is None or convention_of(convention) is table.convention:
        return table, 0.0
    other = to_convention(table, convention)
    error, share = table_difference(other, table)
    if not share <= LARGEST_ERROR:
        raise VerificationError(
            f"{table.name}: in the {other.convention} convention the arm is {error:.3g} m or rad "
            f"off, {share:.3g} of it (allowed {LARGEST_ERROR:g})"
        )
    return other, error


def _tail(row: DHRow) -> Array:
    """``Trans_x(a) Rot_x(alpha)`` of a row, shape (4, 4)."""
    return tf.trans(row.a, 0, 0) @ tf.rot_x(row.alpha)


def _groups(table: DHTable) -> list[tuple[DHRow, Array | None]]:
    """Each joint's row with the product of the fixed rows below it, None for none."""
    steps = (
        (joint, [row.transform(0.0, table.convention) for row in fixed])
        for joint, fixed in grouped_rows(table)[1]
    )
    return [(joint, reduce(np.matmul, Ts) if Ts else None) for joint, Ts in steps]


def _to_modified(table: DHTable) -> DHTable:
    groups = _groups(table)
    rows: list[DHRow] = []
    a = alpha = 0.0
    for k, (row, step) in enumerate(groups):
        T_new_old = _tail(row) if step is None else _tail(row) @ step
        last = k == len(groups) - 1
        moves = last or step is not None
        inertial_step = np.eye(4) if step is not None and not last else T_new_old
        rows.append(_with_inertial(replace(row, a=a, alpha=alpha), inertial_step))
        a, alpha = (0.0, 0.0) if moves else (row.a, row.alpha)
        if step is not None and not last:
            rows.append(DHRow(joint_type=JointType.FIXED, origin=Origin.from_matrix(T_new_old)))
    return replace(
        table,
        convention=DHConvention.MODIFIED,
        rows=tuple(rows),
        base=table.base if table.rows[0].is_joint else Origin.from_matrix(table.base_frame),
        tool=_compose(T_new_old, row if step is None else None, table.tool),
    )


def _to_standard(table: DHTable) -> DHTable:
    groups = _groups(table)
    first = groups[0][0]
    rows: list[DHRow] = []
    for k, (row, step) in enumerate(groups):
        following = groups[k + 1][0] if k + 1 < len(groups) else None
        a, alpha = (following.a, following.alpha) if following and step is None else (0.0, 0.0)
        new = replace(row, a=a, alpha=alpha)
        if step is not None:
            T = step @ (_tail(following) if following else np.eye(4))
            T_new_old = tf.inverse(T) @ step
            rows.append(_with_inertial(new, T_new_old))
            rows.append(DHRow(joint_type=JointType.FIXED, origin=Origin.from_matrix(T)))
        else:
            rows.append(_with_inertial(new, tf.inverse(_tail(new))))
    untouched = table.rows[0].is_joint and not (first.a or first.alpha)
    return replace(
        table,
        convention=DHConvention.STANDARD,
        rows=tuple(rows),
        base=table.base if untouched else Origin.from_matrix(table.base_frame @ _tail(first)),
    )


def _compose(tail: Array, row: DHRow | None, tool: Origin) -> Origin:
    """``tail @ tool``, in exact digits where the tool or the tail is none."""
    if row is not None and tool.is_identity:
        return Origin((row.a, 0.0, 0.0), (row.alpha, 0.0, 0.0))
    if row is not None and not (row.a or row.alpha):
        return tool
    return Origin.from_matrix(tail @ tool.matrix)


def _with_inertial(row: DHRow, T_new_old: Array) -> DHRow:
    """The row with its centre of mass and tensor moved from the old DH frame to the new."""
    if row.com is None and row.inertia is None:
        return row
    com = np.zeros(3) if row.com is None else np.array(row.com)
    inertia = np.zeros((3, 3)) if row.inertia is None else tensor(row.inertia)
    moved = Inertial(row.mass or 0.0, com, inertia).moved(T_new_old)
    x, y, z = (float(v) for v in moved.com)
    return replace(
        row,
        com=None if row.com is None else (x, y, z),
        inertia=None if row.inertia is None else six_of(moved.inertia),
    )
