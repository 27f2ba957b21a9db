"""Arms whose last three axes meet: position and orientation apart (lecture notes 8.3, Pieper 1968).

The wrist centre fixes the first three joints; what is left of the orientation,
``R_36 = Rz(t4) Rx(alpha4) Rz(t5) Rx(alpha5) Rz(t6)``, the wrist: ZYZ angles where alpha4 and
alpha5 are right angles, and the same two steps (subproblem 4, then 1) where they are not.
"""

import math

import numpy as np

from dh2urdf.kernels.certificate import (
    ACCEPT,
    CLUSTER,
    ROUNDING,
    certify_pose,
    copy_rows,
    move,
    name_families,
    principal,
    same,
    turn_inside,
)
from dh2urdf.kernels.counts import DEEP
from dh2urdf.kernels.newton import polish
from dh2urdf.kernels.numbers import atan2, entry, hypot, root_of_gap, sincos
from dh2urdf.kernels.shapes import ClosedForm, Outputs, Poses
from dh2urdf.kernels.spherical_wrist.crossings import is_crossing, turn_in_line
from dh2urdf.kernels.spherical_wrist.position_any import place_wrist
from dh2urdf.kernels.spherical_wrist.position_arm import (
    FREE,
    NICE,
    SHOULDER_FREE,
    UPPER_FREE,
    WRIST_MASK,
    tool_to_wrist,
)

MEETING = 1e-5
"""Distance [rad or m] of two position solutions that may be a double root: `MERGE` parts roots by
1e-7, and by as much divided by the sine of a position near another singularity."""

IN_LINE = 3e-5
"""Sine of the angle between axes 4 and 6 below which a wrist is in doubt: an angle that was rounded
to five digits weighs as much."""

AWAY = 1.0
"""Turn [rad] of a free joint 1 or 2 away from where axes 4 and 6 are in line and families cross."""

DULL = 1e-12
"""Residual [m and rad] of a solution that Newton's method did not make sharp: it is singular."""

WRIST_FREE = 0b101000
"""Joints 4 and 6: axes 4 and 6 in line."""


def middle_angle(form, x, y, z, slack):
    """How many signs the sine of t5 has, its cosine, and its sine, not negative.

    ``z = cos alpha4 cos alpha5 - sin alpha4 sin alpha5 cos t5`` for a unit vector (x, y, z): an
    outer axis of the wrist seen from the other. The sine comes from a product of two
    differences, of which one that can vanish is taken from x and y.
    """
    ca4, sa4, ca5, sa5 = form[3, 1], form[3, 2], form[4, 1], form[4, 2]
    square = x * x + y * y
    scale = sa4 * sa5
    cosine = (ca4 * ca5 - z) / scale
    if ca4 == 0.0 and ca5 == 0.0:
        sine = math.sqrt(square)
    else:
        low = _above(z, ca4 * ca5 - scale, square)
        high = -_above(z, ca4 * ca5 + scale, square)
        sine2 = low * high / (scale * scale)
        # a rim at which the outer axes are in line is no double root, and known to all digits
        level = ca4 * ca5 - scale if abs(low) < abs(high) else ca4 * ca5 + scale
        in_line = abs(abs(level) - 1.0) < 1e-12
        sine = root_of_gap(sine2, 1.0, -abs(slack) if in_line else slack)
        if sine < 0.0:
            return 0, 1.0, 0.0
    length = hypot(cosine, sine)
    return (1 if sine == 0.0 else 2), cosine / length, sine / length


def _above(z, level, square):
    """``z - level`` for the z of a unit vector with ``x^2 + y^2 = square``; exact near +-1."""
    if abs(level - 1.0) < 1e-12:
        return -square / (1.0 + z) if z > 0.0 else z - 1.0
    if abs(level + 1.0) < 1e-12:
        return square / (1.0 - z) if z < 0.0 else z + 1.0
    return z - level


def add_wrist(form, D, values, R, slack, q, residual, branch, free, count):
    """Append the one or two wrists of a position solution, a row of ``arm``; the new count.

    D (4, 4) is frame 6 in frame 0, the orientation left ``R_36 = R_03^T R_06`` goes to R (3, 3).
    """
    for i in range(3):
        R[i, 0], R[i, 1], R[i, 2] = D[i, 0], D[i, 1], D[i, 2]
    for i in range(3):
        angle = form[i, 4] if form[i, 5] != 0.0 else values[i]
        (s, c), ca, sa = sincos(angle), form[i, 1], form[i, 2]
        for j in range(3):
            x, y, z = R[0, j], R[1, j], R[2, j]
            x, y = c * x + s * y, c * y - s * x
            R[0, j], R[1, j], R[2, j] = x, ca * y + sa * z, ca * z - sa * y
    return append_wrist(form, values, R, slack, q, residual, branch, free, count)


def append_wrist(form, values, R, slack, q, residual, branch, free, count):
    """:func:`add_wrist` for a known orientation ``R_36`` (3, 3)."""
    wrists, c5, s5 = middle_angle(form, R[0, 2], R[1, 2], R[2, 2], slack)
    ca4, sa4, ca5, sa5 = form[3, 1], form[3, 2], form[4, 1], form[4, 2]
    wx, wy = R[0, 2], R[1, 2]
    in_line = hypot(wx, wy)
    mask = int(max(values[4], 0.0))
    if in_line <= FREE:
        wrists = min(wrists, 1)
        mask |= WRIST_FREE
    for wrist in range(wrists):
        a, b = s5 * sa5, -(c5 * sa5 * ca4 + sa4 * ca5)
        c4, s4 = a * wx + b * wy, a * wy - b * wx
        r = hypot(c4, s4)
        if in_line <= NICE or r == 0.0:
            s4, c4 = sincos(form[3, 4])
        else:
            c4, s4 = c4 / r, s4 / r
        x, y = c5 * c4 - s5 * ca4 * s4, c5 * s4 + s5 * ca4 * c4
        c6 = x * R[0, 0] + y * R[1, 0] + s5 * sa4 * R[2, 0]
        s6 = -(x * R[0, 1] + y * R[1, 1] + s5 * sa4 * R[2, 1])
        for i in range(3):
            q[count, i] = form[i, 6] * (values[i] - form[i, 3 if form[i, 5] != 0.0 else 4])
        q[count, 3] = form[3, 6] * (atan2(s4, c4) - form[3, 4])
        q[count, 4] = form[4, 6] * (atan2(s5, c5) - form[4, 4])
        q[count, 5] = form[5, 6] * (atan2(s6, c6) - form[5, 4])
        branch[count] = int(values[3]) + 4 * wrist if values[3] >= 0.0 else -1
        free[count] = mask
        s5 = -s5
        count += 1
    return count


def add_wrist_aside(form, D, values, R, slack, rows, count):
    """:func:`add_wrist`; a free joint 1 or 2 is turned where the wrist is in line."""
    found, mask = add_wrist(form, D, values, R, slack, *rows, count), int(max(values[4], 0.0))
    if mask & ~WRIST_MASK == 0 or hypot(R[0, 2], R[1, 2]) > IN_LINE:
        return found
    values[0 if mask == SHOULDER_FREE else 1] += AWAY
    return add_wrist(form, D, values, R, slack, *rows, count)


def roots_meet(joints, arm, rows):
    """Whether two position solutions nearly coincide: rounding may have parted a double root.

    Joints 1 and 3 fix joint 2, unless the wrist centre is next to its axis.
    """
    for k in range(rows):
        for j in range(k):
            free = (int(max(arm[k, 4], 0.0)) & int(max(arm[j, 4], 0.0))) | 0b010
            if same(joints, arm[k, :3], arm[j, :3], MEETING, free):
                return True
    return False


def add_merged(arm, places, T, scratch):
    """Candidates of position solutions whose double roots were merged; their count.

    Those of singular families, which only exist where the roots do merge, and those that reach
    the pose to rounding, which a straight elbow rather than one bent by 1e-8 does.
    """
    (chain, form, _, slack), (D, R, place, work, rows) = arm, scratch
    (_, joints), (q, residual, _, free), kept = chain, rows, 0
    for k in range(places):
        found = add_wrist_aside(form, D, place[k], R, slack, rows, kept)
        for j in range(kept, found):
            residual[j] = polish(chain, T, q[j], work)
            for i in range(6):
                q[j, i] = q[j, i] if joints[i, 0] != 0.0 else principal(q[j, i])
            if residual[j] <= ROUNDING or (free[j] != 0 and residual[j] <= ACCEPT):
                move(*rows, j, kept)
                kept += 1
    return kept


def add_crossings(arm, values, T, scratch, count):
    """Append where a joint 1 or 2 that is free lines axes 4 and 6 up; the new count.

    ``values`` (5,) are a position solution, whose wrists were the last to be computed.
    """
    (_, form, _, slack), (D, R, _, _, rows) = arm, scratch
    mask, turned, turns = int(max(values[4], 0.0)), np.empty(5), np.empty(2)
    if mask != SHOULDER_FREE and mask != UPPER_FREE:
        return count
    joint = 0 if mask == SHOULDER_FREE else 1
    for side in range(2):
        turns[side] = turn_in_line(form, values, joint, R, 1.0 - 2.0 * side)
    for side in range(2):
        turned[:] = values
        turned[joint] += turns[side]
        turned[3], turned[4] = -1.0, 0.0
        found = add_wrist(form, D, turned, R, slack, *rows, count)
        in_line = hypot(R[0, 2], R[1, 2])
        if found > count and is_crossing(arm, T, in_line, rows[0][count]):
            rows[1][count], rows[3][count] = -1.0, WRIST_FREE
            count += 1
    return count


def hidden(joints, rows, merged, k):
    """Whether candidate k is, but for rounding, a member of a family among the merged ones.

    Both have the same values of the joints that are not free.
    """
    q, _, _, free = rows
    for i in range(q.shape[1]):
        q[k, i] = q[k, i] if joints[i, 0] != 0.0 else principal(q[k, i])
    for j in range(merged):
        covered = free[j] != 0 and free[k] & ~free[j] == 0
        if covered and same(joints, q[j], q[k], CLUSTER, free[j]):
            return True
    return False


def finish_wrists(arm, places, found, meet, T, within_limits, out, scratch):
    """Certified solutions of one pose in the rows ``out``; their count.

    From ``places`` position solutions, whether these ``meet``, and ``found`` candidates of
    :func:`add_merged`. The count is -1 minus that where a candidate was lost or axes 4 and 6 are
    nearly in line, less ``DEEP`` where joint 2 is vague or a solution dull.
    """
    (chain, form, _, slack), (D, R, place, work, rows) = arm, scratch
    (_, joints), merged, doubt, deep = chain, found, False, False
    for k in range(places):
        parted = add_wrist_aside(form, D, place[k], R, slack, rows, found)
        in_line = hypot(R[0, 2], R[1, 2])
        doubt = doubt or FREE < in_line < IN_LINE
        deep = deep or place[k, 4] < 0.0
        for j in range(found, parted):
            rows[1][j] = -1.0
            if not (merged and hidden(joints, rows, merged, j)):
                move(*rows, j, found)
                found += 1
        found = add_crossings(arm, place[k], T, scratch, found)
    left = certify_pose(chain, T, *rows, found, work)
    for k in range(left):
        deep = deep or rows[1][k] > DULL
    doubt = doubt or deep or (left < found and merged == 0)
    slides = joints[0, 0] + joints[1, 0] + joints[2, 0] != 0.0
    name_families(chain, T, rows, left, doubt or meet or slides, work)
    left = turn_inside(chain, T, within_limits, *rows, left)
    left = copy_rows(rows, left, out)
    return -1 - left - (DEEP if deep else 0) if doubt else left


def make_scratch():
    """Frame 6 in frame 0, a rotation, position solutions, certification, candidates."""
    return (
        *(np.empty((4, 4)), np.empty((3, 3)), np.empty((8, 5)), np.empty((6, 14))),
        (np.empty((32, 6)), np.empty(32), np.empty(32, np.int64), np.empty(32, np.int64)),
    )


def solve_pose(arm, T, within_limits, out, scratch):
    """All solutions of one pose in ``out``; their count, as :func:`finish_wrists` has it.

    Position solutions are parted, merged if they meet, and parted again.
    """
    (_, joints), form, ends, slack = arm
    D, place = scratch[0], scratch[2]
    tool_to_wrist(ends, T, D)
    x, y, z, merged = D[0, 3], D[1, 3], D[2, 3], 0
    found = place_wrist(form, x, y, z, -slack, place)
    meet = roots_meet(joints, place, found)
    if meet:
        found = place_wrist(form, x, y, z, slack, place)
        merged = add_merged(arm, found, T, scratch)
        found = place_wrist(form, x, y, z, -slack, place)
    return finish_wrists(arm, found, merged, meet, T, within_limits, out, scratch)


@entry(n=6, solutions=8)
def solve_wrist_arm(arm: ClosedForm, Ts: Poses, within_limits: bool, outputs: Outputs):
    """All solutions of poses Ts (m, 4, 4) of an arm of six joints with a spherical wrist.

    Of the exact chain, ``form`` and ``ends`` are in its Denavit-Hartenberg form. The count of
    a pose in doubt is -1 minus that of its solutions; returned is how many are.
    """
    q, residual, count, branch, free = outputs
    scratch, doubts = make_scratch(), 0
    for i in range(Ts.shape[0]):
        out = q[i], residual[i], branch[i], free[i]
        count[i] = solve_pose(arm, Ts[i], within_limits, out, scratch)
        doubts += 1 if count[i] < 0 else 0
    return doubts
