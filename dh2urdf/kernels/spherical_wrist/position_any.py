"""Where any three joints put a wrist centre, each of which turns or slides (Pieper 1968).

The centre is seen from axis 2 twice: from the base, ``y = L1^-1 J1^-1 p``, and along the arm,
``v = L2 J3 w``. Both are linear in what moves them, ``k + c C + s S`` with the cosine and sine of a
joint that turns, or ``k + t C`` of one that slides, and kept as the three vectors (k, C, S), S = 0.
Joint 2 keeps height and length of v where it turns, the other two coordinates where it slides: two
equations in joints 1 and 3, whose solutions are rows (c, s or t, 0) of both. Joint 2 is what is
left.

Notation and output as in :mod:`dh2urdf.kernels.spherical_wrist.position_arm`.
"""

import numpy as np

from dh2urdf.kernels.certificate import ACCEPT
from dh2urdf.kernels.numbers import atan2, circle_pair, hypot, linear_trig, sincos
from dh2urdf.kernels.rigid import dot
from dh2urdf.kernels.spherical_wrist.position_arm import (
    FREE,
    SHOULDER_FREE,
    UPPER_FREE,
    VAGUE,
    place_wrist_in_plane,
)
from dh2urdf.kernels.spherical_wrist.position_slides import (
    about_z,
    point_at,
    turn_and_slide,
    two_slides,
)

ON_AXIS = 1e-6
"""Distance [m] of the wrist centre from axis 2 at which it may be on it, but for rounding."""

BESIDE = 1e-5
"""Distance [m] of the wrist centre from axis 2 at which joint 2 is vague: joints 1 and 3 are off by
the root of rounding where that is nearest."""


def place_wrist(form, px, py, pz, slack, arm):
    """All joint values that put the wrist centre at p (frame 0)."""
    first, second, third = form[0, 5] != 0.0, form[1, 5] != 0.0, form[2, 5] != 0.0
    if form[1, 2] == 0.0 and not (first or second or third):
        return place_wrist_in_plane(form, px, py, pz, slack, arm)
    Y, V = _from_base(form, px, py, pz), _along_arm(form)
    free = not first and px * px + py * py <= FREE * FREE
    pairs = np.empty((8, 4))
    if not first and not third:
        count = _two_turns(form, Y, V, free, slack, pairs)
    elif first and third:
        count = two_slides(form, Y, V, slack, pairs)
    else:
        turn, slide = (V, Y) if first else (Y, V)
        count = turn_and_slide(turn, slide, second, free, form[0, 4], slack, pairs)
        for k in range(count if first else 0):
            c, s = pairs[k, 0], pairs[k, 1]
            pairs[k, 0], pairs[k, 1], pairs[k, 2], pairs[k, 3] = pairs[k, 2], pairs[k, 3], c, s
    return _write_rows(form, Y, V, free, slack, count, pairs, arm)


def _from_base(form, px, py, pz):
    """The columns of y."""
    a, ca, sa, d = form[0, 0], form[0, 1], form[0, 2], form[0, 3]
    if form[0, 5] != 0.0:
        s, c = sincos(form[0, 4])
        x, y = c * px + s * py, c * py - s * px
        return (x - a, ca * y + sa * pz, ca * pz - sa * y), (0.0, -sa, -ca), (0.0, 0.0, 0.0)
    z = pz - d
    return (-a, sa * z, ca * z), (px, ca * py, -sa * py), (py, -ca * px, sa * px)


def _along_arm(form):
    """The columns of v, turned by theta_2 where joint 2 slides, lifted by d_2 where it turns."""
    a, ca, sa, lift = form[1, 0], form[1, 1], form[1, 2], form[1, 3]
    c, s = 1.0, 0.0
    if form[1, 5] != 0.0:
        (s, c), lift = sincos(form[1, 4]), 0.0
    x, y, z = form[2, 0], -form[2, 2] * form[3, 3], form[2, 1] * form[3, 3]
    if form[2, 5] != 0.0:
        f, e = sincos(form[2, 4])
        k, C, S = (e * x - f * y, f * x + e * y, z), (0.0, 0.0, 1.0), (0.0, 0.0, 0.0)
    else:
        k, C, S = (0.0, 0.0, z + form[2, 3]), (x, y, 0.0), (-y, x, 0.0)
    k, C, S = _turned_up(k, ca, sa), _turned_up(C, ca, sa), _turned_up(S, ca, sa)
    k = k[0] + a, k[1], k[2] + lift
    return about_z(k, c, s), about_z(C, c, s), about_z(S, c, s)


def _turned_up(v, c, s):
    """``Rot_x v``."""
    return v[0], c * v[1] - s * v[2], s * v[1] + c * v[2]


def _two_turns(form, Y, V, free, slack, pairs):
    """Joints 1 and 3 turn: a subproblem 6, of joint 3 alone where joint 1 is free."""
    (k, C, S), (m, E, F) = Y, V
    M, N, d = np.empty((2, 2)), np.empty((2, 2)), np.empty(2)
    if form[1, 5] != 0.0:
        M[0, 0], M[0, 1], N[0, 0], N[0, 1], d[0] = C[0], S[0], -E[0], -F[0], m[0] - k[0]
        M[1, 0], M[1, 1], N[1, 0], N[1, 1], d[1] = C[1], S[1], -E[1], -F[1], m[1] - k[1]
    else:
        M[0, 0], M[0, 1], N[0, 0], N[0, 1], d[0] = C[2], S[2], -E[2], -F[2], m[2] - k[2]
        # k.C, k.S, m.E and m.F without what cancels in them, so that what vanishes is 0
        d2 = form[1, 3]
        M[1, 0], M[1, 1] = 2.0 * k[0] * C[0], 2.0 * k[0] * S[0]
        N[1, 0] = -2.0 * (m[0] * E[0] + d2 * E[2])
        N[1, 1] = -2.0 * (m[0] * F[0] + d2 * F[2])
        d[1] = dot(m, m) + dot(E, E) - dot(k, k) - dot(C, C)
    if free:
        return elbow_on_axis(N, d, form[0, 4], slack, pairs)
    if form[1, 5] == 0.0:
        return circle_pair(M, N, d, slack, np.empty((3, 5)), pairs)
    # joint 3 first: where the slide is square to axis 1, one equation is its alone
    count = circle_pair(N, M, d, slack, np.empty((3, 5)), pairs)
    for row in range(count):
        e, f = pairs[row, 0], pairs[row, 1]
        pairs[row, 0], pairs[row, 1], pairs[row, 2] = pairs[row, 2], pairs[row, 3], e
        pairs[row, 3] = f
    return count


def _nearest(columns, slides, c, s):
    """The value of a joint, as a row has it, at which its point is nearest to axis 2.

    Returned are the distance, and the height along the axis, too.
    For a point that is next to the axis: there its root is double, and rounding parts it by 1e-8.
    """
    _, C, S = columns
    x, y, _ = point_at(columns, c, s)
    dx, dy = (C[0], C[1]) if slides else (c * S[0] - s * C[0], c * S[1] - s * C[1])
    square = dx * dx + dy * dy
    move = -(x * dx + y * dy) / square if square > 0.0 else 0.0
    if slides:
        c += move
    else:
        f, e = sincos(move)
        c, s = c * e - s * f, s * e + c * f
    x, y, height = point_at(columns, c, s)
    return c, s, hypot(x, y), height


def _write_rows(form, Y, V, free, slack, count, pairs, arm):
    """Joint 2 of all pairs, and rows of ``arm``; where the centre is on axis 2, joint 2 is free."""
    for k in range(count):
        c, s, e, f = pairs[k, 0], pairs[k, 1], pairs[k, 2], pairs[k, 3]
        (x, y, z), (vx, vy, vz) = point_at(Y, c, s), point_at(V, e, f)
        arm[k, 1], arm[k, 4] = z - vz, 0.0
        if form[1, 5] == 0.0:
            arm[k, 1] = atan2(vx * y - vy * x, vx * x + vy * y)
            rough = (s if form[0, 5] != 0.0 else f if form[2, 5] != 0.0 else 0.0) != 0.0
            arm[k, 4] = VAGUE if rough or vx * vx + vy * vy <= BESIDE * BESIDE else 0.0
            if vx * vx + vy * vy <= ON_AXIS * ON_AXIS:
                near_c, near_s, off, high = _nearest(Y, form[0, 5] != 0.0, c, s)
                near_e, near_f, miss, low = _nearest(V, form[2, 5] != 0.0, e, f)
                off = max(off, miss, abs(high - low))
                if off <= ACCEPT or (slack > 0.0 and off <= ON_AXIS):
                    c, s, e, f, arm[k, 1] = near_c, near_s, near_e, near_f, form[1, 4]
                    arm[k, 4] = UPPER_FREE if off <= ACCEPT else VAGUE
        if free:
            arm[k, 4] = SHOULDER_FREE
        arm[k, 0] = c if form[0, 5] != 0.0 else atan2(s, c)
        arm[k, 2] = e if form[2, 5] != 0.0 else atan2(f, e)
        arm[k, 3] = -1.0
    return max(count, 0)


def elbow_on_axis(N, d, nice, slack, pairs):
    """The wrist centre on axis 1: q1 is free, and q3 alone has to satisfy both equations."""
    det = N[0, 0] * N[1, 1] - N[0, 1] * N[1, 0]
    first, second = abs(N[0, 0]) + abs(N[0, 1]), abs(N[1, 0]) + abs(N[1, 1])
    if abs(det) > 1e-12 * first * second:
        c = (N[1, 1] * d[0] - N[0, 1] * d[1]) / det
        s = (N[0, 0] * d[1] - N[1, 0] * d[0]) / det
        r = hypot(c, s)
        count, c1, s1, c2, s2 = (1, c / r, s / r, c, s) if r > 0.0 else (0, 1.0, 0.0, 1.0, 0.0)
    else:
        i = 0 if first >= second else 1
        count, c1, s1, c2, s2 = linear_trig(N[i, 0], N[i, 1], d[i], slack)
    for k in range(count):
        pairs[k, 1], pairs[k, 0] = sincos(nice)
        pairs[k, 2], pairs[k, 3] = (c1, s1) if k == 0 else (c2, s2)
    return count
