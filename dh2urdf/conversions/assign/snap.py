"""Near misses set right on request, each with what it costs in forward kinematics.

A file that says 1.5708 means pi / 2, but its arm is another arm by 3.7e-6 rad, and only the user
can say which was meant. Snapping works on one link at a time, before frames are assigned, so
that axes made parallel are treated as parallel; then on what is left in the table.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any, TypeVar

import numpy as np

from dh2urdf.bounds import SNAP
from dh2urdf.chain import SerialChain
from dh2urdf.conversions.assign.assigned_table import AssignedTable, chain_to_dh, near_angle
from dh2urdf.conversions.assign.axis_pairs import PARALLEL, across, classify, common_normal, compose
from dh2urdf.conversions.assign.frame_assignment import references
from dh2urdf.conversions.chains import table_poses, turn_slide
from dh2urdf.dh import DHTable
from dh2urdf.doors import number
from dh2urdf.exceptions import UrdfError
from dh2urdf.transforms import Array, pose_error

_T = TypeVar("_T")

DEFAULT_SNAP = 2e-5
"""Angle [rad] and length [m] within which numbers are set right when no tolerance is given.

Takes multiples of pi / 4 written with four decimals, 4.7124 among them (off by 1.1e-5).
"""

NEAR = 1e-4
"""Angle [rad] and length [m] within which a number looks like a miswritten round one."""

PARTS = {"xyz": ("x", "y", "z"), "rpy": ("roll", "pitch", "yaw")}

DECIMALS = 6
NANOMETRE = 1e-9
"""A length that misses a whole micrometre by a nanometre [m] was computed from a rounded angle."""


@dataclass(frozen=True)
class Change:
    """A number set right: where, what it was, what it is, and the cost.

    ``cost`` is the largest move of the tip [m or rad] over random configurations, measured with
    this change alone added to the ones before it.
    """

    where: str
    before: float
    after: float
    cost: float

    def __str__(self) -> str:
        return f"{self.where}: {self.before!r} -> {self.after!r} (moves the tip by {self.cost:.2g})"


def snap_tolerance(snap: float | bool | None) -> float:
    """The tolerance that an argument ``snap`` stands for, 0 for none; at most 0.1."""
    if snap is None or snap is False:
        return 0.0
    if snap is True:
        return DEFAULT_SNAP
    return number(snap, "snap", 0.0, SNAP, UrdfError, "rad and m")


def chain_poses(chain: SerialChain, qs: Array) -> Array:
    """``T_base_tool`` of a chain at many configurations, shape (m, 4, 4)."""
    T = np.broadcast_to(chain.links[0], (len(qs), 4, 4))
    for q, slides, link in zip(qs.T, chain.prismatic, chain.links[1:], strict=True):
        T = T @ turn_slide(0 * q if slides else q, q if slides else 0 * q) @ link
    return T


def snap_chain(chain: SerialChain, tolerance: float, qs: Array) -> tuple[SerialChain, list[Change]]:
    """Set neighbouring axes right: parallel, at multiples of 15 degrees, intersecting.

    The tolerance is for angles [rad] and lengths [m]; costs are measured at the configurations
    ``qs``, shape (m, n).
    """
    ref = references(chain.links)
    names = ("base", *chain.names, "tip")
    heights = (0.0, *ref.heights)
    changes: list[Change] = []
    poses = chain_poses(chain, qs)
    for i, L in enumerate(chain.links):
        for key, before, after, fixed in _snap_link(L, heights[i], ref.size, tolerance):
            links = chain.links.copy()
            links[i] = fixed
            chain = replace(chain, links=links)
            moved = chain_poses(chain, qs)
            where = f"{key} between {names[i]} and {names[i + 1]}"
            changes.append(Change(where, before, after, pose_error(moved, poses)))
            poses = moved
    return chain, changes


def _snap_link(
    L: Array, height: float, size: float, tolerance: float
) -> Iterator[tuple[str, float, float, Array]]:
    """What is set right between two axes, one after the other, and the link with it."""
    pair = classify(L, size)
    if pair.parallel or pair.tilt <= tolerance:
        n = across(L, pair, height)
        straight = math.pi if pair.opposed else 0.0
        fixed = n._replace(alpha=straight, beta=0.0)
        if pair.tilt > 0:
            before = math.pi - pair.tilt if pair.opposed else pair.tilt
            yield "angle", before, straight, compose(fixed)
    else:
        n = common_normal(L, pair)
        fixed = n._replace(alpha=near_angle(n.alpha, tolerance))
        if abs(fixed.alpha - n.alpha) > PARALLEL:
            yield "angle", n.alpha, fixed.alpha, compose(fixed)
    if 0 < abs(n.a) <= tolerance:
        yield "distance", n.a, 0.0, compose(fixed._replace(a=0.0))


def snap_table(table: DHTable, tolerance: float, qs: Array) -> tuple[DHTable, list[Change]]:
    """Round what is left: angles at multiples of 15 degrees, lengths at 0 or whole micrometres."""
    changes: list[Change] = []
    poses = table_poses(table, qs)
    for where, before, after, rounded in _roundings(table, tolerance):
        moved = table_poses(rounded, qs)
        changes.append(Change(where, before, after, pose_error(moved, poses)))
        table, poses = rounded, moved
    return table, changes


def _roundings(table: DHTable, tolerance: float) -> Iterator[tuple[str, float, float, DHTable]]:
    """Each number that is set right, and the table with it and those before."""
    rows = list(table.rows)
    for i, row in enumerate(table.rows):
        for key in ("theta", "alpha", "d", "a") if row.is_joint else ():
            before = getattr(row, key)
            after = _rounded(before, key in ("theta", "alpha"), tolerance)
            if after != before:
                rows[i] = _with(rows[i], key, after)
                table = replace(table, rows=tuple(rows))
                yield f"{key} of {row.name}", before, after, table
    for part in ("base", "tool"):
        for key, names in PARTS.items():
            old: tuple[float, ...] = getattr(getattr(table, part), key)
            new = tuple(_rounded(v, key == "rpy", tolerance) for v in old)
            for k, (before, after) in enumerate(zip(old, new, strict=True)):
                if before != after:
                    partly = (*new[: k + 1], *old[k + 1 :])
                    table = _with(table, part, _with(getattr(table, part), key, partly))
                    yield f"{names[k]} of {part}", before, after, table


def _with(thing: _T, key: str, value: object) -> _T:
    change: dict[str, Any] = {key: value}
    return replace(thing, **change)  # type: ignore[type-var]


def _rounded(value: float, angle: bool, tolerance: float) -> float:
    if angle:
        near = near_angle(value, tolerance)
        return near if abs(near - value) > 1e-15 else value
    if abs(value) <= tolerance:
        return 0.0
    short = round(value, DECIMALS)
    return short if abs(short - value) <= min(tolerance, NANOMETRE) else value


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
