"""Poses of closed forms in doubt: what lies along valleys, or is found from many starts.

Next to a singular pose equations say little. What they give is candidates, which lead along the
valleys beside them to what is left of a family; and where they say nothing of a joint, or a
solution is dull, many starts find others.
"""

from typing import Annotated, Any, TypeAlias

import numpy as np

from dh2urdf.kernels.certificate import (
    CLUSTER,
    MOST_POINTS,
    NO_JOINT,
    copy_rows,
    finish_all,
    follow_valleys,
    same,
)
from dh2urdf.kernels.counts import DEEP, how_many
from dh2urdf.kernels.in_doubt.known import SHARP, Known, from_starts
from dh2urdf.kernels.in_doubt.poses import Rooms, Starts
from dh2urdf.kernels.nearly import parallel_seeds, wrist_seeds
from dh2urdf.kernels.newton import POSE, work_array
from dh2urdf.kernels.numbers import entry
from dh2urdf.kernels.parallel_axes import solve_three_parallel
from dh2urdf.kernels.shapes import ClosedForm, Counts, Outputs, Poses, Solutions
from dh2urdf.kernels.spherical_wrist import solve_wrist_arm

MOST, SEEDS, FOUND = 8, 32, 40
"""Most solutions of a closed form, most candidates of a pose in doubt, most that they lead to."""

WIDE = 0.1
"""Relative amount by which an equation may miss its rim where a candidate is looked for."""

NEAR = 0.01
"""Joint distance [rad] within which solutions may have been united; the certificate's own."""

VALLEYS = np.dtype(
    [
        ("known_q", np.float64, (1, MOST, 6)),
        ("known_residual", np.float64, (1, MOST)),
        ("known_count", np.int64, (1,)),
        ("known_branch", np.int64, (1, MOST)),
        ("known_free", np.int64, (1, MOST)),
        ("raw", np.float64, (1, SEEDS, 6)),
        ("raw_count", np.int64, (1,)),
        ("seeds", np.float64, (MOST + SEEDS, 6)),
        ("q", np.float64, (FOUND, 6)),
        ("residual", np.float64, FOUND),
        ("branch", np.int64, FOUND),
        ("free", np.int64, FOUND),
        ("trail", np.float64, (MOST_POINTS, 6)),
    ],
    align=True,
)
"""What a pose in doubt is looked at in, each of a thread's own."""

Valleys: TypeAlias = Annotated[Any, VALLEYS, "in_valleys", 1]


def _along_valleys(chain, unit, T, room, q):
    """What is known of a pose, and what lies along valleys beside it and its candidates, to q."""
    seeds, count = room["seeds"], how_many(room["known_count"][0])
    for k in range(count):
        seeds[k] = room["known_q"][0, k]
        q[k] = room["known_q"][0, k]
    for k in range(room["raw_count"][0]):
        seeds[count + k] = room["raw"][0, k]
    many = count + room["raw_count"][0]
    return follow_valleys(chain, (POSE, T, unit), seeds, many, room["trail"], q, count)


def _is_known(joints, q, count, p, reach):
    """Whether p (n,) is, up to full turns, within reach of one of the first of q (k, n)."""
    for k in range(count):
        if same(joints, q[k], p, reach, NO_JOINT):
            return True
    return False


def _add_new(joints, rows, found, known, some, out, count):
    """Add solutions of a pose to those of ``out`` that are not known (k, n) yet; the new count.

    One that is known, and was united with a sharper one, is replaced by that.
    """
    q, residual, _, free = rows
    for k in range(found):
        if residual[k] > SHARP or _is_known(joints, known, some, q[k], CLUSTER):
            continue
        row = count
        for j in range(count - 1, -1, -1):
            near = same(joints, out[0][j], q[k], NEAR, NO_JOINT)
            if near and not _is_known(joints, q, found, out[0][j], CLUSTER):
                row = j
        if row >= out[0].shape[0]:
            continue
        out[0][row] = q[k]
        out[1][row], out[3][row] = residual[k], free[k]
        if row == count:
            out[2][row] = -1
            count += 1
    return count


def _widen(chain, starts, unit, T, deep, within_limits, out, count, rooms):
    """Look for more solutions of a pose than the ``count`` of ``out``; how many there are then."""
    (room, beside), work, trial = rooms, work_array(6), np.empty((2, 6))
    rows = beside["q"], beside["residual"], beside["branch"], beside["free"]
    known, branch, some = beside["known_q"], beside["known_branch"], beside["known_count"][0]
    some = how_many(some)
    found = _along_valleys(chain, unit, T, beside, rows[0])
    if deep:
        wide = room["q"], room["residual"], room["branch"], room["free"]
        for k in range(found):
            wide[0][k] = rows[0][k]
        found = from_starts(chain, starts, unit, T, known[0], branch[0], some, wide, found, room)
        if within_limits:
            found = finish_all(chain, T, True, wide, found, trial, work)
        return copy_rows(wide, found, out)
    if found > some:
        found = finish_all(chain, T, within_limits, rows, found, trial, work)
        count = _add_new(chain[1], rows, found, known[0], some, out, count)
    return count


@entry(n=6)
def follow_candidates(
    arm: ClosedForm,
    parallel: bool,
    unit: float,
    valleys: Valleys,
    Ts: Poses,
    known: Known,
    q: Solutions,
    count: Counts,
):
    """What lies along valleys beside poses Ts (m, 4, 4), after what is known (m, k, 6), to q.

    ``count`` (m,) are those of what is known, then of q; ``unit`` is the size of the arm [m];
    ``parallel``: its form is that of three parallel axes, not of a spherical wrist.
    """
    (chain, form, ends, _), beside = arm, valleys[0]
    wide = chain, form, ends, WIDE
    for i in range(Ts.shape[0]):
        beside["known_count"][0] = count[i]
        for k in range(count[i]):
            beside["known_q"][0, k] = known[i, k]
        if parallel:
            parallel_seeds(wide, Ts[i : i + 1], beside["raw"], beside["raw_count"])
        else:
            wrist_seeds(wide, Ts[i : i + 1], beside["raw"], beside["raw_count"])
        count[i] = _along_valleys(chain, unit, Ts[i], beside, q[i])


@entry(n=6, solutions=8)
def widen_wrists(
    arm: ClosedForm,
    starts: Starts,
    unit: float,
    rooms: Rooms,
    valleys: Valleys,
    Ts: Poses,
    within_limits: bool,
    outputs: Outputs,
):
    """Look for more solutions of poses Ts (m, 4, 4) in doubt: along valleys, or from many starts.

    Those are the ones of which :func:`.solve_wrist_arm` made the count negative; what it found is
    in ``outputs``. ``starts`` (s, 6), the ``unit`` and ``rooms`` (1,) as of
    :func:`.search_doubtful`; ``valleys`` (1,) is scratch, too.
    """
    (chain, form, ends, _), (q, residual, count, branch, free), beside = arm, outputs, valleys[0]
    wide = chain, form, ends, WIDE
    known = (
        beside["known_q"],
        beside["known_residual"],
        beside["known_count"],
        beside["known_branch"],
        beside["known_free"],
    )
    for i in range(Ts.shape[0]):
        if count[i] >= 0:
            continue
        deep, T = -1 - count[i] >= DEEP, Ts[i : i + 1]
        solve_wrist_arm(arm, T, False, known)
        wrist_seeds(wide, T, beside["raw"], beside["raw_count"])
        out, some = (q[i], residual[i], branch[i], free[i]), how_many(count[i])
        count[i] = _widen(
            chain, starts, unit, Ts[i], deep, within_limits, out, some, (rooms[0], beside)
        )


@entry(n=6, solutions=8)
def widen_parallel(
    arm: ClosedForm,
    starts: Starts,
    unit: float,
    rooms: Rooms,
    valleys: Valleys,
    Ts: Poses,
    within_limits: bool,
    outputs: Outputs,
):
    """:func:`widen_wrists` where axes are parallel, of :func:`.solve_three_parallel`."""
    (chain, form, ends, _), (q, residual, count, branch, free), beside = arm, outputs, valleys[0]
    wide = chain, form, ends, WIDE
    known = (
        beside["known_q"],
        beside["known_residual"],
        beside["known_count"],
        beside["known_branch"],
        beside["known_free"],
    )
    for i in range(Ts.shape[0]):
        if count[i] >= 0:
            continue
        deep, T = -1 - count[i] >= DEEP, Ts[i : i + 1]
        solve_three_parallel(arm, T, False, known)
        parallel_seeds(wide, T, beside["raw"], beside["raw_count"])
        out, some = (q[i], residual[i], branch[i], free[i]), how_many(count[i])
        count[i] = _widen(
            chain, starts, unit, Ts[i], deep, within_limits, out, some, (rooms[0], beside)
        )
