"""Solutions of poses of arms with two parallel axes and two that meet."""

import numpy as np

from dh2urdf.kernels.certificate import turn_inside
from dh2urdf.kernels.general_6r import (
    ARC,
    PAIRS,
    SINGULAR,
    Arms,
    add_roots,
    how_many_below,
    keep_lane,
    nudge,
    place_samples,
    polish_lanes,
)
from dh2urdf.kernels.newton import pose_residual
from dh2urdf.kernels.numbers import LANES, atan2, entry, side_by_side, sincos
from dh2urdf.kernels.rigid import (
    applied,
    dot,
    inverse_pose,
    load_pose,
    store_pose,
    times_link,
    turned,
)
from dh2urdf.kernels.shapes import Chain, Outputs, Poses
from dh2urdf.kernels.two_parallel.branches import (
    MOST,
    SEEDS,
    TOGETHER,
    lay_branch,
    take_elbows,
    take_seed,
)
from dh2urdf.kernels.two_parallel.polynomial import TwoParallel, cross, sample, vector

CONVERGED = 1e-14
"""Error at which a lane is not polished further, relative to the arm's size."""

CAREFUL = 2e-15
"""The same where solutions meet, and are united by what their residuals leave open."""

CLOSE = 0.01
"""Angle [rad] between roots between which F is looked at."""

NOUGHT = 1e-12
"""Value of F, in parts of the largest, that may be zero."""

VANISHED = 1e-14
"""The largest value of F, in parts of an arm's length to the power of eight, where a family of
solutions has every value of joint 1, as where axes 1 and 5 are one line."""

APART = 0.005, 0.0, 1.0, 1e-15
"""Where `add_roots` looks for pairs of roots around the circle: F is precise, so that real ones are
told apart by cutting arcs, and complex ones are none."""

CROWDED = 1e-3
"""Determinant of a solution's Jacobian below which poses nearby are asked too."""

NUDGES = np.array([0.0, 1e-3, -1e-3, 1e-4, -1e-4, 1e-2, -1e-2])
"""How far the poses are moved from whose solutions the seeds are taken."""


def _rows(h1, v, seen, row):
    """Constant, cosine and sine of ``R1^T v``."""
    f, (x, y, z) = dot(h1, v), cross(v, h1)
    a, b, c = f * h1[0], f * h1[1], f * h1[2]
    seen[row, 0], seen[row, 1], seen[row, 2] = a, b, c
    seen[row + 1, 0], seen[row + 1, 1], seen[row + 1, 2] = v[0] - a, v[1] - b, v[2] - c
    seen[row + 2, 0], seen[row + 2, 1], seen[row + 2, 2] = x, y, z


def see(form, T, nudged, D, seen):
    """What ``seen`` (9, 3) has of the target T (4, 4): u, l and a normal of axis 6."""
    ends, axes, steps, _, _, mirrored = form
    store_pose(times_link(times_link(load_pose(ends[0]), T), ends[1]), D)
    if mirrored == 1:
        store_pose(inverse_pose(D), D)
    if nudged != 0.0:
        nudge(D, nudged)
    x, y, z = 0.0, 0.0, 0.0
    for i in range(6):
        x, y, z = x + steps[i, 0], y + steps[i, 1], z + steps[i, 2]
    h1 = vector(axes[0])
    _rows(h1, applied(D, (x, y, z)), seen, 0)
    _rows(h1, turned(D, vector(axes[5])), seen, 3)
    _rows(h1, turned(D, vector(axes[6])), seen, 6)
    for j in range(3):
        seen[0, j] -= steps[1, j]


def _find_roots(form, seen, arm):
    """Values of joint 1, as by `add_roots`: their number, and the largest sample.

    Where axis 6 is parallel to 2 and 3, opposite places, F says nothing: midway between samples.
    """
    start = atan2(seen[5, 2], seen[4, 2]) + 0.5 * ARC
    count, k, largest = 0, 0, 0.0
    while count >= 0 and (k == 0 or k <= arm["spans"][0, 0]):
        middle, half_tan = place_samples(k, start, arm)
        sample(form, seen, arm["hidden"], LANES, arm["determinant"])
        for i in range(LANES):
            largest = max(largest, abs(arm["determinant"][i]))
        count = add_roots(k, middle, half_tan, PAIRS if k > 0 else APART, count, arm)
        k += 1
    return count, largest


def _roots_meet(form, seen, count, largest, arm):
    """Whether F may be zero throughout between two roots, or at an extremum beside the axis.

    There rounding hides roots: those that meet, two or more.
    """
    roots, slopes, hidden, values = arm["roots"], arm["slopes"], arm["hidden"], arm["determinant"]
    places = 0
    for k in range(count):
        for i in range(k + 1):
            touching = i == k and slopes[k] <= 0.0
            if places < LANES and (touching or (i < k and abs(roots[k] - roots[i]) < CLOSE)):
                hidden[1, places], hidden[0, places] = sincos(0.5 * (roots[k] + roots[i]))
                places += 1
    sample(form, seen, hidden, places, values)
    for k in range(places):
        if abs(values[k]) < NOUGHT * largest:
            return True
    return False


def _follow(form, seen, values, count, wide, converged, found, out_q, out_residual, arm, branches):
    """Append the solutions that ``count`` values of joint 1 lead to; their number.

    Where ``wide``, also from seeds that fit badly or are for special positions.
    """
    hidden, lane = arm["hidden"], 0
    for k in range(count):
        i = k % TOGETHER
        if i == 0:
            n = min((count - k + 7) // 8 * 8, TOGETHER)
            for j in side_by_side(n):
                hidden[1, j], hidden[0, j] = sincos(values[k + j])
            for b in range(4):
                sides = 1.0 - 2.0 * (b // 2), 1.0 - 2.0 * (b % 2)
                lay_branch(form, seen, hidden, n, sides, branches[b])
        for b in range(4):
            lane = take_seed(form, branches[b], i, wide, lane, arm)
            if wide:
                lane = take_elbows(form, seen, branches[b], i, lane, arm)
        if lane > LANES - (MOST if wide else 4) or (k == count - 1 and lane > 0):
            polish_lanes(lane, 0, converged, arm)
            for j in range(lane):
                found, _ = keep_lane(j, found, out_q, out_residual, arm)
            lane = 0
    return found


def _follow_widely(form, seen, count, found, out_q, out_residual, arm, branches):
    """Append the solutions that roots and spans of doubt lead to, taken widely; their number."""
    roots, spans, middles = arm["roots"], arm["spans"], arm["doubles"]
    found = _follow(
        form, seen, roots, count, True, CAREFUL, found, out_q, out_residual, arm, branches
    )
    n = int(spans[0, 0])
    for first in range(0, n, LANES):
        some = min(n - first, LANES)
        for k in range(some):
            middles[k] = 0.5 * (spans[0, first + k + 1] + spans[1, first + k + 1])
        found = _follow(
            form, seen, middles, some, True, CAREFUL, found, out_q, out_residual, arm, branches
        )
    return found


def _solve_pose(form, T, out_q, out_residual, arm, D, seen, branches):
    """All solutions of one pose; their number, or -1 minus it where in doubt."""
    kept, spans, slopes, target = arm["kept"], arm["spans"], arm["slopes"], arm["target"]
    target[:] = T[:3]
    found, agreed, rest = 0, 0, (out_q, out_residual, arm, branches)
    square = arm["size"] * arm["size"]
    fourth = square * square
    for attempt in range(len(NUDGES)):
        see(form, T, NUDGES[attempt], D, seen)
        count, largest = _find_roots(form, seen, arm)
        if attempt == 0 and largest < VANISHED * fourth * fourth:
            return -1
        if count < 0:
            agreed = 0
            continue
        converged = CONVERGED if attempt == 0 else CAREFUL
        simple = count - how_many_below(slopes, count, 1e-300)
        found = _follow(form, seen, arm["roots"], count, False, converged, found, *rest)
        clear = spans[1, 0] == 0.0 and simple == found
        clear = clear and not _roots_meet(form, seen, count, largest, arm)
        clear = clear and how_many_below(kept, found, SINGULAR) == 0
        if attempt == 0:
            sure = clear and spans[0, 0] == 0.0  # beside a root a pair may hide in noise
            if sure and how_many_below(kept, found, CROWDED) == 0:
                return found
            if not clear:
                found = _follow_widely(form, seen, count, found, *rest)
        else:
            agreed = agreed + 1 if clear else 0
            if agreed == 2:
                return found
    return -1 - found


@entry(n=6, solutions=16)
def solve_two_parallel(
    chain: Chain,
    form: TwoParallel,
    arms: Arms,
    exact: bool,
    Ts: Poses,
    within_limits: bool,
    outputs: Outputs,
):
    """Poses Ts (m, 4, 4), by the lines of an arm and its record ``arms`` (1,).

    A count is -1 minus that of the candidates where there may be other solutions, as everywhere if
    the lines are not exactly the chain's. Returns the number of such poses.
    """
    q, residual, count, branch, free = outputs
    doubts = 0
    arm, D, seen = arms[0], np.empty((4, 4)), np.empty((9, 3))
    branches = np.empty((4, SEEDS, TOGETHER))
    for i in range(Ts.shape[0]):
        found = _solve_pose(form, Ts[i], q[i], residual[i], arm, D, seen, branches)
        for k in range(found):
            residual[i, k] = pose_residual(chain, Ts[i], q[i, k])
            branch[i, k], free[i, k] = -1, 0
        if not exact:
            found = -1 - max(found, -1 - found)
        if found > 0:
            rows = q[i], residual[i], branch[i], free[i]
            found = turn_inside(chain, Ts[i], within_limits, *rows, found)
        count[i] = found
        doubts += 1 if found < 0 else 0
    return doubts
