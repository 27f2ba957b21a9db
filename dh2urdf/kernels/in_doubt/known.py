"""Poses of which solutions are known: many starts find others, and members of their families."""

from typing import Annotated, TypeAlias

import numpy as np

from dh2urdf.kernels.certificate import CLUSTER, NO_JOINT, move, name_families, same
from dh2urdf.kernels.in_doubt.members import dimensions, one_of_each_family
from dh2urdf.kernels.in_doubt.poses import Rooms, Starts, search_pose
from dh2urdf.kernels.newton import POSE, STAYING, make_damped, work_array
from dh2urdf.kernels.numbers import entry
from dh2urdf.kernels.shapes import AnyChain, Counts, Floats, Integers, Outputs, Poses

ALL = 0b111111
"""The mask of all six joints."""

SHARP = 1e-11
"""Residual [m and rad] of a solution beside which a point of a valley is none."""

Known: TypeAlias = Annotated[Floats, "poses", "known", 6]


def _name_again(chain, T, unit, rows, count, named):
    """Name families by their joints alone, but surfaces not by a curve's; ``named`` is scratch."""
    (q, _, _, free), looked = rows, (make_damped(6), np.empty((6, 6)), np.empty(6))
    for k in range(count):
        named[k] = free[k]
    name_families(chain, T, rows, count, True, work_array(6))
    for k in range(count):
        every, some = named[k], free[k]
        if some != every and some != 0 and some & ~every == 0:
            more = POSE + STAYING * (ALL - every), T, unit
            fewer = POSE + STAYING * (ALL - some), T, unit
            surface = dimensions(chain, more, q[k], every, looked)
            free[k] = every if surface > dimensions(chain, fewer, q[k], some, looked) else some


def _is_among(q, p, known, count):
    """Whether p (n,) is, without full turns, one of the first known ones (k, n)."""
    for k in range(count):
        most = 0.0
        for i in range(p.shape[0]):
            most = max(most, abs(p[i] - known[k, i]))
        if most <= CLUSTER:
            return True
    return False


def _keep_sharp(rows, count, known, some):
    """Drop what is accepted along a valley beside solutions; how many are left.

    What is known (k, n) stays, and all do where there is no solution.
    """
    (q, residual, branch, free), kept = rows, 0
    for k in range(count):
        if residual[k] <= SHARP or free[k] != 0 or _is_among(q, q[k], known, some):
            kept += 1
    if kept == 0:
        return count
    kept = 0
    for k in range(count):
        if residual[k] <= SHARP or free[k] != 0 or _is_among(q, q[k], known, some):
            move(q, residual, branch, free, k, kept)
            kept += 1
    return kept


def from_starts(chain, starts, unit, T, known, branch, some, rows, count, room):
    """What many starts find of a pose, in the rows of which so many are candidates; how many.

    Of each family what is known (k, 6), or a member; what is known keeps its ``branch`` (k,).
    """
    families = room["walk"], room["key"], room["gone"], room["asked"]
    count = search_pose(chain, starts, unit, T, True, False, rows, count, families)
    _name_again(chain, T, unit, rows, count, room["named"])
    count = _keep_sharp(rows, count, known, some)
    count = one_of_each_family(chain, T, unit, rows, count, families)
    for j in range(some):
        for k in range(count):
            if same(chain[1], rows[0][k], known[j], CLUSTER, NO_JOINT):
                rows[2][k] = branch[j]
    return count


@entry(n=6)
def search_known(
    chain: AnyChain,
    starts: Starts,
    unit: float,
    rooms: Rooms,
    Ts: Poses,
    known: Known,
    branch: Annotated[Integers, "poses", "known"],
    some: Counts,
    outputs: Outputs,
):
    """Solve poses Ts (m, 4, 4) from candidates, the first of q, and many starts, in place.

    Limits aside. Solutions that are known (m, k, 6), of which there are ``some`` (m,), go before
    others of their families, and keep their ``branch`` (m, k).
    """
    q, residual, count, free_branch, free = outputs
    for i in range(Ts.shape[0]):
        rows = q[i], residual[i], free_branch[i], free[i]
        count[i] = from_starts(
            chain, starts, unit, Ts[i], known[i], branch[i], some[i], rows, count[i], rooms[0]
        )
