"""6R arms with three neighbouring parallel axes: 1, 2, 3 or 2, 3, 4 (UR and its kin).

The three turn in a plane and leave alone what points or lies along their common normal. So the
height of the pose over that plane and the slope of axis 6 are two equations without them, in two
of the other joints: a subproblem 6, or 4 twice where axes 5 and 6 meet. Then axis 6 follows by
subproblem 1, and the three are a planar RR arm with a wrist (Elias and Wen; EAIK).

In Denavit-Hartenberg form (:mod:`dh2urdf.kernels.spherical_wrist.position_arm`) the parallel axes
have alpha = 0 between them.
"""

import math

import numpy as np

from dh2urdf.kernels.certificate import (
    certify_pose,
    copy_rows,
    name_families,
    side_by_side,
    turn_inside,
)
from dh2urdf.kernels.counts import DEEP
from dh2urdf.kernels.numbers import atan2, entry, hypot
from dh2urdf.kernels.parallel_axes.pairs import outer_pairs, says_little
from dh2urdf.kernels.parallel_axes.plane import (
    MOST_ARCS,
    common_axis,
    last_joint,
    pairs_of_leaning,
    seen_arm,
    seen_from_plane,
)
from dh2urdf.kernels.shapes import ClosedForm, Outputs, Poses
from dh2urdf.kernels.spherical_wrist import FREE, NICE, middle_angle, planar, tool_to_wrist

ALL_FREE = 0b111111

FIFTH_FREE = 0b010111
"""Joints that move where axis 5 is parallel to axes 1, 2, 3."""

VAGUE = 1e-6
"""Sine of the angle between axis 6 and the parallel axes below which t6, which rounding turns by
1e-16 over that sine, may have left the interval in which the planar arm reaches."""

IN_LINE = 3e-5
"""The same below which t6 is in doubt: an angle that was rounded to five digits weighs as much."""

DULL = 1e-12
"""Residual [m and rad] of a solution that Newton's method did not make sharp: it is singular."""

LOOSE = 1e-3
"""The same where a seed is looked for, which may have any t6."""

ROUNDING = 1e-12
"""Turn of the tool [rad] that rounding, also of t1 near its own rim, explains."""


def _reach_with_last_joint(form, first, D, cs, x, y, in_line, loose):
    """Turn t6, free or nearly so, so that the planar arm reaches (lecture notes 8.2).

    The point that the arm has to reach goes round a circle about axis 6. It stays where t6 has
    it if that is within reach; else it goes to the middle of what is, or, where t6 is not quite
    free, by the shortest way to its end, if rounding explains that. Returns the point.
    """
    upper, fore = form[first, 0], form[first + 1, 0]
    near, far = abs(upper - fore), upper + fore
    bx, by, _ = seen_arm(form, first, D, cs, 1.0)
    cx, cy = x + bx, y + by
    distance, radius, length = hypot(cx, cy), hypot(bx, by), hypot(x, y)
    if near <= length <= far or distance * radius == 0.0:
        return x, y
    low, high = max(near, abs(distance - radius)), min(far, distance + radius)
    goal = 0.5 * (low + high)
    if in_line > NICE and low < high:
        goal = high if length > far else low
    cosine = (distance * distance + radius * radius - goal * goal) / (2.0 * distance * radius)
    cosine = min(max(cosine, -1.0), 1.0)
    sine = math.sqrt((1.0 - cosine) * (1.0 + cosine))
    ux, uy = cx / distance, cy / distance
    if ux * by < uy * bx:
        sine = -sine
    vx, vy = radius * (ux * cosine - uy * sine), radius * (uy * cosine + ux * sine)
    c, s = (bx * vx + by * vy) / (radius * radius), (bx * vy - by * vx) / (radius * radius)
    if not loose and in_line > FREE and in_line * hypot(1.0 - c, s) > ROUNDING:
        return x, y
    _, _, up = seen_from_plane(form, first, cs[0, 0], cs[0, 1], D[0, 2], D[1, 2], D[2, 2])
    s = -s if up > 0.0 else s
    cs[5, 0], cs[5, 1] = cs[5, 0] * c - cs[5, 1] * s, cs[5, 1] * c + cs[5, 0] * s
    return cx - vx, cy - vy


def _two_arcs(form, first, distance, radius):
    """Whether the planar arm reaches two arcs of a circle so far off its first axis: not all."""
    upper, fore = form[first, 0], form[first + 1, 0]
    return abs(upper - fore) > abs(distance - radius) and upper + fore < distance + radius


def _add_planar(
    form, first, D, cs, shoulder, mask, slack, loose, arm, q, residual, branch, free, count
):
    """Append the elbows of one set of outer joints; the new count, and the doubt that is left.

    1: axis 6 is nearly along the common normal; 2: what t6 can be is two arcs.
    """
    in_line = last_joint(form, first, D, cs)
    px, py, pz = D[0, 3], D[1, 3], D[2, 3]
    if first == 1:
        pz -= form[0, 3]
    x, y, _ = seen_from_plane(form, first, cs[0, 0], cs[0, 1], px, py, pz)
    x -= form[0, 0] if first == 1 else 0.0
    bx, by, _ = seen_arm(form, first, D, cs, 1.0)
    parted = in_line < IN_LINE and _two_arcs(form, first, hypot(x, y), hypot(bx, by))
    x, y = x - bx, y - by
    if in_line <= FREE:
        mask |= (0b111 << first) | 0b100000
    if in_line <= (LOOSE if loose else VAGUE):
        x, y = _reach_with_last_joint(form, first, D, cs, x, y, in_line, loose)
    hx, hy, _ = seen_arm(form, first, D, cs, 0.0)
    heading = atan2(hy, hx)
    if x * x + y * y <= FREE * FREE:
        mask |= 0b101 << first
    up = 1.0 if (first == 1 and form[0, 2] > 0.0) == (shoulder == 0) else -1.0
    elbows = planar(form[first, 0], form[first + 1, 0], x, y, up, slack, arm, 0)
    for elbow in range(elbows):
        for i in range(6):
            t = atan2(cs[i, 1], cs[i, 0])
            if first <= i < first + 2:
                t = arm[elbow, 1 + i - first]
            elif i == first + 2:
                t = heading - arm[elbow, 1] - arm[elbow, 2]
            q[count, i] = form[i, 6] * (t - form[i, 4])
        branch[count] = shoulder + 2 * elbow + (4 if cs[4, 1] < 0.0 else 0)
        free[count] = mask
        count += 1
    return count, 2 if parted else (1 if FREE < in_line < IN_LINE else 0)


def slope_of_last(form, D, cs, slack):
    """Joint 5 into cs where axes 5 and 6 meet; the number of its signs, 1 if axis 6 is in line."""
    x, y, z = common_axis(form, 1, D, cs)
    wrists, cs[4, 0], cs[4, 1] = middle_angle(form, x, y, z, slack)
    return min(wrists, 1) if hypot(x, y) <= FREE else wrists


def add_pairs(form, first, pairs, slack, loose, rows, scratch):
    """From ``pairs`` of outer joints of one pose to candidates; their count, and the doubt.

    That of :func:`_add_planar`. ``first`` is
    the index of the first parallel axis; ``loose`` turns joint 6 to where the planar arm reaches.
    """
    D, pair, cs, _, arcs, _, arm = scratch
    outer = 0 if first == 1 else 3
    mask = ALL_FREE if pairs < 0 else 0
    found, doubt = 0, 0
    for k in range(abs(pairs)):
        leaning = first == 0 and pair[k, 4] != 0.0
        values = pairs_of_leaning(form, D, cs, pair[k, 0], pair[k, 1], arcs) if leaning else 1
        for value in range(values):
            row = arcs[value] if leaning else pair[k]
            cs[outer, 0], cs[outer, 1] = row[0], row[1]
            cs[4, 0], cs[4, 1] = row[2], row[3]
            shoulder, wrists = 0, 1
            if found + 2 > rows[0].shape[0]:
                break
            if first == 1:
                shoulder = 1 if row[0] * D[0, 3] + row[1] * D[1, 3] < 0.0 else 0
                if form[4, 0] == 0.0:
                    wrists = slope_of_last(form, D, cs, slack)
            moving = FIFTH_FREE if leaning else mask
            for _ in range(wrists):
                found, more = _add_planar(
                    *(form, first, D, cs, shoulder, moving, slack, loose, arm), *rows, found
                )
                doubt = max(doubt, more)
                cs[4, 1] = -cs[4, 1]
    return found, doubt


def finish_pairs(arm, first, pairs, T, within_limits, out, scratch):
    """Certified solutions of one pose in the rows ``out``, from :func:`add_pairs`; their count.

    It is -1 minus that where there may be more: a candidate was lost, two fell together, or, then
    less ``DEEP``, the equations say little.
    """
    (chain, form, _, slack), work, rows = arm, scratch[3], scratch[5]
    found, more = add_pairs(form, first, pairs, slack, False, rows, scratch)
    deep = more == 2 or says_little(form, first, pairs, scratch[0], scratch[1])
    rows[1][:found] = -1.0
    left = certify_pose(chain, T, *rows, found, work)
    for k in range(left):
        deep = deep or rows[1][k] > DULL
    deep = deep or side_by_side(chain, T, rows[0], left, work)
    doubt = more > 0 or left < found or deep
    deep = deep or (doubt and left == 0)
    name_families(chain, T, rows, left, doubt, work)
    left = turn_inside(chain, T, within_limits, *rows, left)
    left = copy_rows(rows, left, out)
    return -1 - left - (DEEP if deep else 0) if doubt else left


def make_scratch():
    """Frame 6 in frame 0, pairs, cosines and sines, certification, arcs, candidates, elbows."""
    return (
        *(np.empty((4, 4)), np.empty((8, 5)), np.zeros((6, 2)), np.empty((6, 14))),
        np.empty((MOST_ARCS, 4)),
        (np.empty((32, 6)), np.empty(32), np.empty(32, np.int64), np.empty(32, np.int64)),
        np.empty((2, 5)),
    )


@entry(n=6, solutions=8)
def solve_three_parallel(arm: ClosedForm, Ts: Poses, within_limits: bool, outputs: Outputs):
    """All solutions of poses Ts (m, 4, 4); q (m, 8, 6), the rest as its first axes.

    The parallel axes are 2, 3, 4 where ``form[0]`` has a twist, else 1, 2, 3. The count of a pose
    in doubt is as :func:`finish_pairs` has it; returned is how many are.
    """
    _, form, ends, slack = arm
    q, residual, count, branch, free = outputs
    scratch = make_scratch()
    D, pair = scratch[0], scratch[1]
    first, doubts = 1 if form[0, 2] != 0.0 else 0, 0
    for i in range(Ts.shape[0]):
        tool_to_wrist(ends, Ts[i], D)
        pairs = outer_pairs(form, first, D, slack, pair)
        out = q[i], residual[i], branch[i], free[i]
        count[i] = finish_pairs(arm, first, pairs, Ts[i], within_limits, out, scratch)
        doubts += 1 if count[i] < 0 else 0
    return doubts
