"""Whether the same values move the joints of two arms alike."""

from dataclasses import replace
from typing import Any

import numpy as np

from dh2urdf.comparison.cells import Difference
from dh2urdf.comparison.relation import Relation
from dh2urdf.dh import DHTable
from dh2urdf.dh.coupling import JointMap
from dh2urdf.dh.variables import followed, moved_by
from dh2urdf.transforms import Array


def coupled_otherwise(
    a: DHTable, b: DHTable, relation: Relation | None, tolerance: float
) -> tuple[Difference, ...]:
    """Joints that the values of B move otherwise than those of A, the joints being related so.

    With ``q_joints = M q + c`` in both, B is moved as A where values of B can be found, each that
    of A or its opposite plus a number, by which its joints are ``directions * joints of A +
    offsets``.
    """
    if (a.joint_map is None and b.joint_map is None) or a.n != b.n:
        return ()
    mine, other = (table.joint_map or _each_its_own(table.n) for table in (a, b))
    wrong = np.zeros(a.n, bool)
    if mine.own == other.own:
        turned, shifted = _missing(mine, other, relation or Relation.none(a.n))
        wrong = (np.abs(turned).max(axis=1) > tolerance) | (np.abs(shifted) > tolerance)
    else:
        wrong[list(set(mine.own) ^ set(other.own))] = True
    told = [_told(a, b, (mine, other), i) for i in np.flatnonzero(wrong).tolist()]
    return tuple(one for one in told if one.a != one.b)  # without what follows from its leader


def uncoupled(table: DHTable) -> DHTable:
    """The table with every joint on its own."""
    if table.joint_map is None:
        return table
    free: dict[str, Any] = dict.fromkeys(("mimic", "serial_lower", "serial_upper"))
    return replace(table, rows=tuple(replace(row, **free) for row in table.rows), couplings={})


def _each_its_own(n: int) -> JointMap:
    return JointMap(np.eye(n), np.zeros(n), tuple(range(n)))


def _missing(a: JointMap, b: JointMap, relation: Relation) -> tuple[Array, Array]:
    """What the matrix (m, n) and the offset (m,) of B would have to be more."""
    own, ways = list(a.own), relation.directions
    turned = ways[:, None] * a.matrix * ways[own] - b.matrix
    shifted = ways * a.offset + relation.offsets - b.offset
    values = np.linalg.solve(b.matrix[own], shifted[own])
    return turned, shifted - b.matrix @ values


def _told(a: DHTable, b: DHTable, maps: tuple[JointMap, JointMap], i: int) -> Difference:
    """Joint i (from 0) of both tables, by the row of A."""
    number = [k for k, row in enumerate(a.rows, 1) if row.is_joint][i]
    one, two = a.joints[i].mimic, b.joints[i].mimic
    if one and two and one.joint == two.joint:
        for key in ("multiplier", "offset"):
            if getattr(one, key) != getattr(two, key):
                return Difference(number, key, f"{getattr(one, key):g}", f"{getattr(two, key):g}")
    if one or two:
        first, second = (followed(mimic) if mimic else "none" for mimic in (one, two))
        return Difference(number, "mimic", first, second)
    first, second = (moved_by(each, i, minus="-")[0] for each in maps)
    return Difference(number, "coupling", first, second)
