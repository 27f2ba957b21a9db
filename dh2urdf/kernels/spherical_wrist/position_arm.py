"""Where three turning joints put a wrist centre: all q1, q2, q3 for a point (Pieper 1968).

The arm is given by its Denavit-Hartenberg rows ``form`` (n, 7): a, cos alpha, sin alpha, d, theta,
sliding, sign. Row 4's d is the distance of the wrist centre along axis 4. With frame 0 moved up
by d1, ``p = Z1 L1 Z2 L2 Z3 w``, where ``L_i`` carries a_i, alpha_i, d_{i+1} and w is constant.

Each function writes rows to ``arm`` (8, 5): the three joint values as DH variables, branch code and
mask of free joints; and returns how many.
"""

from dh2urdf.kernels.numbers import atan2, elbow_angle, hypot, root_of_gap
from dh2urdf.kernels.rigid import load_pose, store_pose, times_link

FREE = 5e-10
"""Distance from an axis [m], or sine, up to which the angle about it is reported as free: turned
round by any amount, the residual stays within what a solution may have."""

NICE = 1e-13
"""The same, below which there is nothing left of the angle, and the joint is put to zero."""

WRIST_MASK = 0b111000
SHOULDER_FREE = 0b000001 | WRIST_MASK
UPPER_FREE = 0b000010 | WRIST_MASK

VAGUE = -1.0
"""In place of a mask: no joint is free, but joint 2 hardly moves the wrist centre."""


def tool_to_wrist(ends, T, D):
    """Frame 6 in frame 0, ``D = base^-1 T tool^-1``, both inverses in ``ends``; D (4, 4)."""
    store_pose(times_link(times_link(load_pose(ends[0]), T), ends[1]), D)


def place_wrist_in_plane(form, px, py, pz, slack, arm):
    """Axis 2 parallel to 3: p fixes the arm's plane, subproblem 4; in it a planar RR arm.

    The plane is off axis 1 by a fixed lateral distance, and the height of p above frame 0 is the
    height in the plane, whatever the other joints do.
    """
    pz -= form[0, 3]
    a1, ca1, sa1, a2 = form[0, 0], form[0, 1], form[0, 2], form[1, 0]
    wx, wy, wz = form[2, 0], -form[2, 2] * form[3, 3], form[2, 1] * form[3, 3]
    forearm, lean = hypot(wx, wy), atan2(wy, wx)
    lateral = wz + form[1, 3] + form[2, 3]
    y = (pz - ca1 * lateral) / sa1
    offset = ca1 * y - sa1 * lateral
    square = px * px + py * py
    reach2 = square - offset * offset
    scale = (a1 + a2 + forearm) * (a1 + a2 + forearm) + offset * offset
    if reach2 < -abs(slack) * scale:
        return 0
    reach = max(root_of_gap(reach2, square, slack), 0.0)
    free = square <= FREE * FREE and reach <= FREE
    rows = 0
    for shoulder in range(2):
        if shoulder == 1 and (free or reach == 0.0):
            break
        x = reach - a1
        if square <= NICE * NICE:
            q1 = form[0, 4]
        else:
            q1 = atan2(py * reach - px * offset, px * reach + py * offset)
        up = 1.0 if sa1 * reach > 0.0 or (reach == 0.0 and sa1 > 0.0) else -1.0
        found = planar(a2, forearm, x, y, up, slack, arm, rows)
        for k in range(rows, rows + found):
            arm[k, 0] = q1
            arm[k, 2] -= lean
            arm[k, 3] += shoulder
            if free:
                arm[k, 4] = SHOULDER_FREE
            elif x * x + y * y <= FREE * FREE:
                arm[k, 4] = UPPER_FREE
        rows += found
        reach = -reach
    return rows


def planar(upper, fore, x, y, up, slack, arm, row):
    """Planar RR arm (lecture notes 8.2): angles t2 and t3 in columns 1 and 2 from ``row`` on.

    ``up`` is the sign of sin t3 times -1 of the elbow-up branch.
    """
    square = x * x + y * y
    count, cosine, sine = elbow_angle(upper, fore, square, slack)
    side = -up
    for k in range(count):
        s3 = side * sine
        along, across = upper + fore * cosine, fore * s3
        arm[row + k, 1] = atan2(y * along - x * across, x * along + y * across)
        arm[row + k, 2] = atan2(s3, cosine)
        arm[row + k, 3] = 2.0 * k
        arm[row + k, 4] = 0.0
        side = -side
    return count
