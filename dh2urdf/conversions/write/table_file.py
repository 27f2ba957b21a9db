"""A table in one of its own formats, read back before it is kept; how two tables differ."""

import math

import numpy as np

from dh2urdf.conversions.write.urdf_elements import default_limits
from dh2urdf.dh import DHTable, JointType
from dh2urdf.dh_io import READ_BACK, Units, parse_table, table_to_text
from dh2urdf.exceptions import TableError, VerificationError
from dh2urdf.transforms import Array, pose_error

COARSE = 1e-2
"""Largest FK difference [rad, and m per m of arm] of a rounded file that is of any use."""


def table_text_and_error(
    table: DHTable, format: str, units: Units, digits: int | None = None
) -> tuple[str, float]:
    """Text of a table in one of its formats, and how far that moves the arm [m and rad].

    What reads back is read back: with all digits it must be the same table, number by number.
    With numbers rounded on request its frames are compared over random configurations, and a
    `VerificationError` says where rounding leaves nothing of use.
    """
    text = table_to_text(table, format, units, digits)
    if format not in READ_BACK:
        return text, 0.0
    try:
        again = parse_table(text, format).table
    except TableError as fault:
        problem = f"{table.name}: the written text does not read back: {fault}"
        raise VerificationError(problem) from None
    if again == table:
        return text, 0.0
    if digits is None or table_to_text(again, format, units, digits) != text:
        raise VerificationError(f"{table.name}: the written text reads back as another table")
    error, share = table_difference(again, table)
    if not share <= COARSE:
        raise VerificationError(
            f"{table.name}: with {digits} decimals of {units.length} and {units.angle} the arm is "
            f"{error:.3g} m or rad off, {share:.3g} of it (allowed {COARSE:g}); give more digits"
        )
    return text, error


def table_difference(a: DHTable, b: DHTable, count: int = 16) -> tuple[float, float]:
    """Largest difference of one arm in two tables: in [m and rad], and relative to its size.

    Of the tool, and of the DH frames too where the conventions are the same.
    """
    size, largest, share = arm_size(b), 0.0, 0.0
    for q in random_configurations(b, count):
        pairs = [a.fk(q)[None], b.fk(q)[None]]
        if a.convention is b.convention:
            pairs = [np.concatenate([T, t.frames(q)]) for T, t in zip(pairs, (a, b), strict=True)]
        largest = max(largest, pose_error(*pairs))
        for T in pairs:
            T[:, :3, 3] /= size
        share = max(share, pose_error(*pairs))
    return largest, share


def arm_size(table: DHTable) -> float:
    """How far the arm reaches at most [m], its slides drawn out."""
    kinds = enumerate(row.joint_type for row in table.joints)
    slides = [i for i, kind in kinds if kind is JointType.PRISMATIC]
    travel = [np.abs(default_limits(table, i)).max() for i in slides]
    return math.hypot(*table.base.xyz) + table.length + float(sum(travel)) or 1.0


def random_configurations(table: DHTable, count: int, seed: int = 0) -> Array:
    """Configurations within the limits, at most one turn each way, shape (count, n)."""
    rng = np.random.default_rng(seed)
    bounds = np.array([default_limits(table, i) for i in range(table.n)])
    turns = np.array([row.joint_type is JointType.REVOLUTE for row in table.joints])
    low = np.where(turns, np.maximum(bounds[:, 0], -2 * np.pi), bounds[:, 0])
    high = np.where(turns, np.minimum(bounds[:, 1], 2 * np.pi), bounds[:, 1])
    return rng.uniform(low, np.maximum(low, high), size=(count, table.n))
