"""Where three turning joints put a wrist centre: all q1, q2, q3 for a point (Pieper 1968).

The arm is given by its Denavit-Hartenberg rows ``form`` (n, 7): a, cos alpha, sin alpha, d, theta,
sliding, sign. Row 4's d is the distance of the wrist centre along axis 4. With frame 0 moved up
by d1, ``p = Z1 L1 Z2 L2 Z3 w``, where ``L_i`` carries a_i, alpha_i, d_{i+1} and w is constant.

Each function writes rows to ``arm`` (8, 5): the three joint values as DH variables, branch code and
mask of free joints; and returns how many.
"""

import math

import numpy as np

from dh2urdf.kernels.certificate import ACCEPT
from dh2urdf.kernels.numbers import circle_pair, elbow_angle, inner_kernel, linear_trig, root_of_gap

FREE = 5e-10
"""Distance from an axis [m], or sine, up to which the angle about it is reported as free: turned
round by any amount, the residual stays within what a solution may have."""

NICE = 1e-13
"""The same, below which there is nothing left of the angle, and the joint is put to zero."""

ON_AXIS = 1e-6
"""Distance [m] of the wrist centre from axis 2 at which it may be on it, but for rounding."""

WRIST_MASK = 0b111000
SHOULDER_FREE = 0b000001 | WRIST_MASK
UPPER_FREE = 0b000010 | WRIST_MASK


@inner_kernel
def tool_to_wrist(ends, T, D):
    """Frame 6 in frame 0, ``D = base^-1 T tool^-1``, both inverses in ``ends``; D (3, 4)."""
    for i in range(3):
        a, b, c, t = ends[0, i, 0], ends[0, i, 1], ends[0, i, 2], ends[0, i, 3]
        r0 = a * T[0, 0] + b * T[1, 0] + c * T[2, 0]
        r1 = a * T[0, 1] + b * T[1, 1] + c * T[2, 1]
        r2 = a * T[0, 2] + b * T[1, 2] + c * T[2, 2]
        r3 = a * T[0, 3] + b * T[1, 3] + c * T[2, 3] + t
        for j in range(4):
            D[i, j] = r0 * ends[1, 0, j] + r1 * ends[1, 1, j] + r2 * ends[1, 2, j]
        D[i, 3] += r3


@inner_kernel
def place_wrist(form, px, py, pz, slack, arm):
    """All joint values of a turning arm that put the wrist centre at p (frame 0)."""
    if form[1, 2] == 0.0:
        return place_wrist_in_plane(form, px, py, pz, slack, arm)
    return _any_elbow(form, px, py, pz - form[0, 3], slack, arm)


@inner_kernel
def place_wrist_in_plane(form, px, py, pz, slack, arm):
    """Axis 2 parallel to 3: p fixes the arm's plane, subproblem 4; in it a planar RR arm.

    The plane is off axis 1 by a fixed lateral distance, and the height of p above frame 0 is the
    height in the plane, whatever the other joints do.
    """
    pz -= form[0, 3]
    a1, ca1, sa1, a2 = form[0, 0], form[0, 1], form[0, 2], form[1, 0]
    wx, wy, wz = form[2, 0], -form[2, 2] * form[3, 3], form[2, 1] * form[3, 3]
    forearm, lean = math.hypot(wx, wy), math.atan2(wy, wx)
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
            q1 = math.atan2(py * reach - px * offset, px * reach + py * offset)
        up = 1.0 if sa1 * reach > 0.0 or (reach == 0.0 and sa1 > 0.0) else -1.0
        found = _planar(a2, forearm, x, y, up, slack, arm, rows)
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


@inner_kernel
def _planar(upper, fore, x, y, up, slack, arm, row):
    """Planar RR arm (lecture notes 8.2): angles t2 and t3 in columns 1 and 2 from ``row`` on.

    ``up`` is the sign of sin t3 times -1 of the elbow-up branch.
    """
    square = x * x + y * y
    count, cosine, sine = elbow_angle(upper, fore, square, slack)
    side = -up
    for k in range(count):
        s3 = side * sine
        along, across = upper + fore * cosine, fore * s3
        arm[row + k, 1] = math.atan2(y * along - x * across, x * along + y * across)
        arm[row + k, 2] = math.atan2(s3, cosine)
        arm[row + k, 3] = 2.0 * k
        arm[row + k, 4] = 0.0
        side = -side
    return count


@inner_kernel
def _any_elbow(form, px, py, pz, slack, arm):
    """Any other geometry: the point seen from axis 2 keeps height and distance.

    Seen from axis 2, ``y(q1) = L1^-1 Z1^-1 p`` and ``v(q3) = L2 Z3 w`` have one height and one
    length: a subproblem 6 in q1 and q3, a quartic that falls apart where axis 1 meets or is
    parallel to axis 2. Subproblem 1 gives q2.
    """
    a1, ca1, sa1, d2 = form[0, 0], form[0, 1], form[0, 2], form[1, 3]
    a2, ca2, sa2 = form[1, 0], form[1, 1], form[1, 2]
    wx, wy, wz = form[2, 0], -form[2, 2] * form[3, 3], form[2, 1] * form[3, 3] + form[2, 3]
    square = px * px + py * py
    M, N, d = np.empty((2, 2)), np.empty((2, 2)), np.empty(2)
    M[0, 0], M[0, 1] = -sa1 * py, sa1 * px
    N[0, 0], N[0, 1] = -sa2 * wy, -sa2 * wx
    d[0] = ca2 * wz - ca1 * pz + d2
    M[1, 0], M[1, 1] = -2.0 * a1 * px, -2.0 * a1 * py
    N[1, 0] = -2.0 * a2 * wx - 2.0 * d2 * sa2 * wy
    N[1, 1] = 2.0 * a2 * wy - 2.0 * d2 * sa2 * wx
    d[1] = a2 * a2 + wx * wx + wy * wy + wz * wz + 2.0 * d2 * ca2 * wz + d2 * d2
    d[1] -= square + pz * pz + a1 * a1
    pairs = np.empty((4, 4))
    free = square <= FREE * FREE
    if free:
        count = elbow_on_axis(N, d, form[0, 4], slack, pairs)
    else:
        count = circle_pair(M, N, d, slack, np.empty((3, 5)), pairs)
    for k in range(count):
        c1, s1, c3, s3 = pairs[k, 0], pairs[k, 1], pairs[k, 2], pairs[k, 3]
        x, y = seen_from_axis_2(form, c1, s1, px, py, pz)
        vx = a2 + c3 * wx - s3 * wy
        vy = ca2 * (s3 * wx + c3 * wy) - sa2 * wz
        on_axis, upper_free = False, False
        if vx * vx + vy * vy <= ON_AXIS * ON_AXIS:
            ux, uy = -s3 * wx - c3 * wy, ca2 * (c3 * wx - s3 * wy)
            turn = -(vx * ux + vy * uy) / (ux * ux + uy * uy)
            near_c, near_s, off = onto_axis_2(form, c1, s1, px, py, pz)
            off = max(off, math.hypot(vx + turn * ux, vy + turn * uy))
            upper_free = off <= ACCEPT
            on_axis = upper_free or (slack > 0.0 and off <= ON_AXIS)
            if on_axis:
                c1, s1 = near_c, near_s
                c3, s3 = c3 - turn * s3, s3 + turn * c3
        arm[k, 0] = math.atan2(s1, c1)
        arm[k, 1] = form[1, 4] if on_axis else math.atan2(vx * y - vy * x, vx * x + vy * y)
        arm[k, 2] = math.atan2(s3, c3)
        arm[k, 3] = -1.0
        arm[k, 4] = SHOULDER_FREE if free else (UPPER_FREE if upper_free else 0.0)
    return max(count, 0)


@inner_kernel
def seen_from_axis_2(form, c1, s1, px, py, pz):
    """The point p (frame 0 moved up by d1) across axis 2, with joint 1 at (c1, s1)."""
    x, y = c1 * px + s1 * py, c1 * py - s1 * px
    return x - form[0, 0], form[0, 1] * y + form[0, 2] * pz


@inner_kernel
def onto_axis_2(form, c1, s1, px, py, pz):
    """Turn joint 1 so that p is nearest to axis 2, on which it nearly lies; cosine, sine, distance.

    There the root of joint 1 is double, and rounding has parted it by 1e-8.
    """
    x, y = seen_from_axis_2(form, c1, s1, px, py, pz)
    dx, dy = c1 * py - s1 * px, -form[0, 1] * (c1 * px + s1 * py)
    square = dx * dx + dy * dy
    if square == 0.0:
        return c1, s1, math.hypot(x, y)
    turn = -(x * dx + y * dy) / square
    c, s = math.cos(turn), math.sin(turn)
    c1, s1 = c1 * c - s1 * s, s1 * c + c1 * s
    x, y = seen_from_axis_2(form, c1, s1, px, py, pz)
    return c1, s1, math.hypot(x, y)


@inner_kernel
def elbow_on_axis(N, d, nice, slack, pairs):
    """The wrist centre on axis 1: q1 is free, and q3 alone has to satisfy both equations."""
    det = N[0, 0] * N[1, 1] - N[0, 1] * N[1, 0]
    first, second = abs(N[0, 0]) + abs(N[0, 1]), abs(N[1, 0]) + abs(N[1, 1])
    if abs(det) > 1e-12 * first * second:
        c = (N[1, 1] * d[0] - N[0, 1] * d[1]) / det
        s = (N[0, 0] * d[1] - N[1, 0] * d[0]) / det
        r = math.hypot(c, s)
        count, c1, s1, c2, s2 = (1, c / r, s / r, c, s) if r > 0.0 else (0, 1.0, 0.0, 1.0, 0.0)
    else:
        i = 0 if first >= second else 1
        count, c1, s1, c2, s2 = linear_trig(N[i, 0], N[i, 1], d[i], slack)
    for k in range(count):
        pairs[k, 0], pairs[k, 1] = math.cos(nice), math.sin(nice)
        pairs[k, 2], pairs[k, 3] = (c1, s1) if k == 0 else (c2, s2)
    return count
