"""Poses in doubt, one after the other: candidates, a search, certificates, one of each family."""

from typing import Annotated, Any, TypeAlias

import numpy as np

from dh2urdf.kernels.certificate import copy_rows, finish_all
from dh2urdf.kernels.general_6r import Arms, make_ready, solve_pose
from dh2urdf.kernels.in_doubt.members import MOST_STEPS, drop_valleys, one_of_each_family
from dh2urdf.kernels.in_doubt.search import make_room, search_beside, search_from
from dh2urdf.kernels.newton import POSE
from dh2urdf.kernels.numbers import entry
from dh2urdf.kernels.shapes import AnyChain, Chain, Counts, Flagged, Floats, Outputs, Poses, Sizes

WIDTH, FIRST = 128, 16
"""Most candidates of a pose, and those of the general solver."""

IN_DOUBT = np.dtype(
    [
        ("branch", np.int64, WIDTH),
        ("free", np.int64, WIDTH),
        ("q", np.float64, (WIDTH, 6)),
        ("residual", np.float64, WIDTH),
        ("first_q", np.float64, (FIRST, 6)),
        ("first_residual", np.float64, FIRST),
        ("walk", np.float64, (2, MOST_STEPS, 6)),
        ("key", np.float64, WIDTH),
        ("gone", np.bool_, WIDTH),
        ("asked", np.bool_, WIDTH),
        ("named", np.int64, WIDTH),
    ],
    align=True,
)
"""What a pose in doubt is solved in, each of a thread's own."""

Rooms: TypeAlias = Annotated[Any, IN_DOUBT, "in_doubt", 1]

Starts: TypeAlias = Annotated[Floats, "starts", 6]


def search_pose(chain, starts, unit, T, deep, within_limits, rows, count, families):
    """Solutions of a pose T (4, 4) from so many candidates, in the rows of which these are first.

    Beside all of them others are looked for, from the starts (s, 6) where ``deep``; how many.
    """
    room, trial = make_room(), np.empty((2, 6))
    work = room[6]
    if deep:
        count = search_from(chain, (POSE, T, unit), starts, rows[0], count, room)
    count = finish_all(chain, T, False, rows, count, trial, work)
    count = search_beside(chain, T, rows[0], count, room)
    count = finish_all(chain, T, False, rows, count, trial, work)
    count = drop_valleys(chain, T, unit, rows, count)
    count = one_of_each_family(chain, T, unit, rows, count, families)
    return finish_all(chain, T, True, rows, count, trial, work) if within_limits else count


@entry(n=6)
def search_poses(
    chain: AnyChain,
    starts: Starts,
    unit: float,
    rooms: Rooms,
    Ts: Poses,
    deep: Counts,
    within_limits: bool,
    outputs: Outputs,
):
    """Solve poses Ts (m, 4, 4) from candidates, the first of q, in place.

    What lies beside is looked for at all of them, from the starts (s, 6) at those that ``deep``
    (m,) says. ``unit`` is the size of the arm [m]; ``rooms`` (1,) is scratch.
    """
    q, residual, count, branch, free = outputs
    room = rooms[0]
    families = room["walk"], room["key"], room["gone"], room["asked"]
    for i in range(Ts.shape[0]):
        rows, some = (q[i], residual[i], branch[i], free[i]), deep[i] != 0
        count[i] = search_pose(
            chain, starts, unit, Ts[i], some, within_limits, rows, count[i], families
        )


@entry()
def unite_families(
    chain: AnyChain,
    unit: float,
    Ts: Poses,
    walk: Annotated[Floats, 2, "steps", "n"],
    key: Sizes,
    gone: Flagged,
    asked: Flagged,
    outputs: Outputs,
):
    """Keep one member of each family of poses Ts (m, 4, 4), isolated solutions first, in place.

    ``walk`` (2, steps, n), ``key``, ``gone`` and ``asked`` (solutions,) are scratch.
    """
    q, residual, count, branch, free = outputs
    room = walk, key, gone, asked
    for i in range(Ts.shape[0]):
        rows = q[i], residual[i], branch[i], free[i]
        count[i] = one_of_each_family(chain, Ts[i], unit, rows, count[i], room)


@entry(n=6)
def search_doubtful(
    chain: Chain,
    starts: Starts,
    unit: float,
    rooms: Rooms,
    Ts: Poses,
    within_limits: bool,
    outputs: Outputs,
):
    """Search at poses Ts (m, 4, 4) whose counts are -1 minus that of their candidates.

    Arguments as those of :func:`search_poses`.
    """
    q, residual, count, branch, free = outputs
    room = rooms[0]
    families = room["walk"], room["key"], room["gone"], room["asked"]
    wide = room["q"], room["residual"], room["branch"], room["free"]
    for i in range(Ts.shape[0]):
        if count[i] >= 0:
            continue
        some = -1 - count[i]
        for k in range(some):
            wide[0][k] = q[i, k]
        some = search_pose(chain, starts, unit, Ts[i], True, within_limits, wide, some, families)
        count[i] = copy_rows(wide, some, (q[i], residual[i], branch[i], free[i]))


@entry(n=6)
def referee_doubtful(
    chain: Chain,
    starts: Starts,
    unit: float,
    arms: Arms,
    rooms: Rooms,
    Ts: Poses,
    within_limits: bool,
    outputs: Outputs,
):
    """The same with candidates of the general solver, too, by the record ``arms`` (1,) of the arm.

    Many starts are for those poses of which that solver is not sure.
    """
    q, residual, count, branch, free = outputs
    arm, room = arms[0], rooms[0]
    families = room["walk"], room["key"], room["gone"], room["asked"]
    make_ready(arm)
    wide, first = (room["q"], room["residual"], room["branch"], room["free"]), room["first_q"]
    for i in range(Ts.shape[0]):
        if count[i] >= 0:
            continue
        some, doubt = solve_pose(Ts[i], first, room["first_residual"], arm)
        for k in range(some):
            wide[0][k] = first[k]
        for k in range(-1 - count[i]):
            wide[0][some + k] = q[i, k]
        some += -1 - count[i]
        deep = doubt == 1
        some = search_pose(chain, starts, unit, Ts[i], deep, within_limits, wide, some, families)
        count[i] = copy_rows(wide, some, (q[i], residual[i], branch[i], free[i]))
