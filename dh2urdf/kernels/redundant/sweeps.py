"""One pose at many values of a held joint: all solutions there, and curves that pass between.

The poses of a block differ in the held value alone. A curve of solutions between two values is seen
by how far its equations miss there: by least where they come nearest, and by less than what they
change from value to value. It is then walked along.
"""

from typing import Annotated

import numpy as np

from dh2urdf.kernels.blocks import BLOCK, LANES, ROWS, VALID, emit
from dh2urdf.kernels.certificate import NO_JOINT, TWO_PI
from dh2urdf.kernels.newton import make_damped, restore
from dh2urdf.kernels.numbers import entry
from dh2urdf.kernels.redundant.held_wrist import HELD, SLIDES, HeldForm, make_scratch, points_at
from dh2urdf.kernels.redundant.held_wrist_blocks import ANGLES, place_block, prepare
from dh2urdf.kernels.redundant.self_motion import HELD as KEPT
from dh2urdf.kernels.redundant.self_motion import first_guess, tangent_near
from dh2urdf.kernels.shapes import Chain, Floats, Goal, Outputs

BETWEEN = 0.5
"""Part of the second difference of how far equations are from their rim, by which a curve between
two values may miss both: of a parabola it is an eighth."""

STEP, HALF = 0.2, 32
"""Step along a curve between two values [rad or m], and how many each way."""

WALKED = 2 * HALF + 1
"""Rows of such curves behind those of the values."""

ALIKE = 1e-4
"""Joint distance [rad or m] at which two solutions at a value are one."""

MOST_CURVES = 8
"""How many of them are walked along."""


@entry(n=7, solutions=8)
def sweep_pose(
    arm: HeldForm,
    chain: Chain,
    goal: Goal,
    in_blocks: bool,
    values: Annotated[Floats, "values"],
    outputs: Outputs,
    margin: Annotated[Floats, "values", 2],
):
    """Solutions of one pose at values (m,) of the held joint, limits or not, and near them.

    ``values`` are equally spaced, over a whole turn if the joint turns. Codes of branches are
    numbers of solutions; -1 where a solution was found by a careful look. In ``WALKED`` rows behind
    those of the values are points of curves between values, a code a curve. ``margin`` is how far
    the equations of both elbows are from their rims. The slack of the arm is for careful looks;
    without ``in_blocks``, which says that :func:`solve_held_blocks` covers the arm, all are.
    """
    q, _, count, branch, _ = outputs
    S, Ts, m = np.empty(ROWS * BLOCK), np.empty((LANES, 4, 4)), values.shape[0]
    oriented, place = np.empty((6, 3)), np.empty(6, np.int64)
    for i in range(LANES):
        Ts[i] = goal[1]
    prepare(arm, values, oriented, place, S)
    count[:] = -1
    for first in range(0, m if in_blocks else 0, LANES):
        n = min(LANES, m - first)
        place_block(arm, values[first : first + n], Ts, False, 0.0, 0, n, S)
        emit(arm[2], oriented, ANGLES, False, place, True, first, n, S, outputs)
        for i in range(n):
            for elbow in range(2):
                margin[first + i, elbow] = S[BLOCK * (VALID + 2 * elbow) + i]
            for k in range(8):
                q[first + i, k, arm[1][HELD]] = values[first + i]
    scratch, damped, room, work = make_scratch(), make_damped(7), np.empty((8, 7)), np.empty((3, 7))
    found = room, np.empty(8), np.empty(8, np.int64), np.empty(8, np.int64)
    curves = 0
    for i in range(m, count.shape[0]):
        count[i] = 0
    for i in range(m):
        careful = count[i] < 0
        if not careful and not _is_close(margin, i, arm[1][SLIDES] == 0):
            continue
        count[i] = max(count[i], 0)
        for k in range(points_at(arm, chain, goal, values[i], found, scratch, damped, work[0])):
            if careful:
                q[i, k], branch[i, k], count[i] = room[k], -1, k + 1
            elif curves < MOST_CURVES and not _is_known(chain[1], outputs, i, m, room[k]):
                _walk(chain, goal, room[k], curves, m, outputs, work, damped)
                curves += 1


def _walk(chain, goal, start, code, first, outputs, work, damped):
    """Points of the curve through a solution (n,), to the rows from the first one on."""
    guess, tangent, at = work[0], work[1], work[2]
    _add_point(outputs, first + HALF, start, code)
    for side in range(2):
        at[:] = start
        first_guess(guess, NO_JOINT)
        for i in range(start.shape[0]):
            guess[i] *= 1.0 - 2.0 * side
        for k in range(HALF):
            if not tangent_near(chain, goal, at, guess, tangent, damped):
                break
            guess[:] = tangent
            at += STEP * tangent
            if not restore(chain, goal, at, tangent, damped) <= KEPT:
                break
            _add_point(outputs, first + HALF + (k + 1 if side == 0 else -k - 1), at, code)
            if k > 3 and step_between(chain[1], start, at) <= 0.6 * STEP:
                return


def _add_point(outputs, i, q, code):
    """Put a point q (n,) of a curve to row i."""
    k = outputs[2][i]
    outputs[0][i, k], outputs[3][i, k] = q, code
    outputs[2][i] = k + 1


def _is_close(margin, i, around):
    """Whether equations nearly reach their rim between the value i and its neighbours."""
    last = margin.shape[0] - 1
    before, after = _neighbour(i, -1, last, around), _neighbour(i, 1, last, around)
    for elbow in range(2):
        here = margin[i, elbow]
        left = margin[before, elbow] if before >= 0 else here
        right = margin[after, elbow] if after >= 0 else here
        if left <= here >= right and 0.0 >= here > BETWEEN * (left + right - 2.0 * here):
            return True
    return False


def _neighbour(i, way, last, around):
    """The row before or after row i of a sweep; -1 where there is none."""
    if 0 <= i + way <= last:
        return i + way
    return (0 if way > 0 else last) if around else -1


def step_between(joints, q, p):
    """Largest motion of a joint from q (n,) to p (n,), without full turns."""
    most = 0.0
    for i in range(q.shape[0]):
        gap = abs(p[i] - q[i])
        most = max(most, gap if joints[i, 0] != 0.0 else min(gap, abs(TWO_PI - gap)))
    return most


def _is_known(joints, outputs, i, first, p):
    """Whether p (n,) is a solution at value i, or near a curve in rows from the first on."""
    q, _, count, _, _ = outputs
    for k in range(count[i]):
        if step_between(joints, q[i, k], p) <= ALIKE:
            return True
    for j in range(first, first + WALKED):
        for k in range(count[j]):
            if step_between(joints, q[j, k], p) <= 0.5 * STEP:
                return True
    return False
