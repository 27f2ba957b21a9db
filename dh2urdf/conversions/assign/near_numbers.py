"""Numbers that were probably meant to be others: named and priced, never changed."""

from __future__ import annotations

import math
from collections.abc import Iterator

from dh2urdf.chain import SerialChain
from dh2urdf.conversions.assign.assigned_table import AssignedTable, chain_to_dh
from dh2urdf.conversions.assign.snap import snap_chain, snap_table
from dh2urdf.conversions.chains import table_poses
from dh2urdf.transforms import Array, pose_error

__all__ = ["near_misses"]

NEAR = 1e-4
"""Angle [rad] and length [m] within which a number looks like a miswritten round one."""


def near_misses(assigned: AssignedTable, chain: SerialChain, qs: Array) -> list[str]:
    """Warnings: what is nearly round, and what setting it right would cost; far common normals.

    The cost is measured at the configurations ``qs``, shape (m, n).
    """
    warnings = list(_far_normals(assigned))
    snapped, changes = snap_chain(chain, NEAR, qs)
    again = chain_to_dh(snapped, assigned.table.convention) if changes else assigned
    table, rounded = snap_table(again.table, NEAR, qs)
    changes += rounded
    if changes:
        off = max(abs(change.after - change.before) for change in changes)
        tolerance = _above(off)
        cost = pose_error(table_poses(table, qs), table_poses(assigned.table, qs))
        named = "; ".join(f"{c.where} = {c.before!r}" for c in changes[:3])
        more = f" and {len(changes) - 3} more" if len(changes) > 3 else ""
        warnings.append(
            f"nearly round: {named}{more}. Kept as given; snap={tolerance:.0e} sets them right "
            f"and moves the tip by at most {cost:.2g} m or rad (measured)"
        )
    return warnings


def _above(value: float) -> float:
    """The next larger power of ten times 1, 2 or 5."""
    power = 10.0 ** math.floor(math.log10(value))
    return next(step * power for step in (2.0, 5.0, 10.0) if value < step * power)


def _far_normals(assigned: AssignedTable) -> Iterator[str]:
    found = assigned.assignment
    joints = assigned.table.joint_names
    for i, (pair, slid) in enumerate(zip(found.pairs, found.compact, strict=True)):
        if slid and pair.tilt > NEAR:
            yield (
                f"the axes of {joints[i]} and {joints[i + 1]} are {pair.tilt:.3g} rad from "
                f"parallel and meet their common normal far away; the fixed row after {joints[i]} "
                "stands in for it (compact=False for four parameters a row)"
            )
