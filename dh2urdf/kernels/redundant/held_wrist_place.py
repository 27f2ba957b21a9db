"""Where three joints of an arm with a joint held put the wrist centre: joints 1, 3, and then 2.

Seen from axis 2, ``y(q1) = S0^-1 Z1^-1 p`` and ``u(q3) = S1 Z3 w`` have one height and one length;
see :mod:`dh2urdf.kernels.redundant.held_wrist` for the links S.
"""

import math

import numpy as np

from dh2urdf.kernels.certificate import EXACT, bring_back
from dh2urdf.kernels.newton import make_damped, pose_residual
from dh2urdf.kernels.numbers import atan2, circle_pair, hypot, linear_trig, root_of_gap
from dh2urdf.kernels.rigid import applied, applied_inverse, cross, dot, turned, turned_back
from dh2urdf.kernels.spherical_wrist import FREE, SHOULDER_FREE, UPPER_FREE, elbow_on_axis

VOID = 1e-4
"""Size of an equation, in sizes of the arm, that says too little for a pose to be out of reach."""

FOLDED = 1e-4
"""Distance of the wrist centre from where axes 1 and 2 meet, in sizes of the arm, below which
lengths are compared as differences: their squares differ by less than rounding."""

MEET = 1e-14
"""Distance of axes 1 and 2, in sizes of the arm, that is rounding."""

NOTHING = 1e-11
"""The same [m] at which nothing but rounding is left of it, and joints 1 and 2 are free."""

IN_LINE = 1e-5
"""How far a wrist may be out of line [rad] that is put there."""

OTHERS = 0b111111
"""The mask of the joints that move."""


def place_held(form, D, S, slack, scratch):
    """Joints 1, 2, 3 that put the wrist centre where D has it: rows of ``arm``; how many.

    Seen from axis 2, ``y(q1) = S0^-1 Z1^-1 p`` and ``u(q3) = S1 Z3 w`` have one height and one
    length: a subproblem 6 in q1 and q3. Subproblem 1 gives q2. The rows are as in
    :mod:`dh2urdf.kernels.spherical_wrist.position_arm`, without names of branches, then the volume
    that the three motions of the centre span. -1 where there are none for equations are void.
    """
    arm, (two, series, pairs) = scratch[4], scratch[8]
    M, N, d = two[0], two[1], two[2, 0]
    S0, S1, reach = S[0], S[1], form[3, 3]
    px, py, pz = D[0, 3], D[1, 3], D[2, 3]
    wx, wy, wz = applied(S[2], (0.0, 0.0, reach))
    tx, ty, tz, ux, uy, uz = S0[0, 3], S0[1, 3], S0[2, 3], S1[0, 3], S1[1, 3], S1[2, 3]
    nx, ny, nz = turned_back(S1, (ux, uy, uz))
    gx, gy, gz, hx, hy, hz = S0[0, 2], S0[1, 2], S0[2, 2], S1[2, 0], S1[2, 1], S1[2, 2]
    M[0, 0], M[0, 1] = gx * px + gy * py, gx * py - gy * px
    N[0, 0], N[0, 1] = -hx * wx - hy * wy, hx * wy - hy * wx
    d[0] = hz * wz + uz - gz * pz + gx * tx + gy * ty + gz * tz
    M[1, 0], M[1, 1] = -2.0 * (tx * px + ty * py), -2.0 * (tx * py - ty * px)
    N[1, 0], N[1, 1] = -2.0 * (nx * wx + ny * wy), -2.0 * (ny * wx - nx * wy)
    square = px * px + py * py
    size = square + pz * pz + tx * tx + ty * ty + tz * tz
    size = math.sqrt(size + wx * wx + wy * wy + wz * wz + ux * ux + uy * uy + uz * uz)
    d[1] = wx * wx + wy * wy + wz * wz + ux * ux + uy * uy + uz * uz + 2.0 * nz * wz
    d[1] -= square + pz * pz + tx * tx + ty * ty + tz * tz - 2.0 * tz * pz
    away = math.sqrt(square + (pz - tz) * (pz - tz))
    folded = hypot(tx, ty) <= MEET * size and NOTHING < away <= FOLDED * size
    free = square <= FREE * FREE and not folded
    if folded:
        count = _folded(S0, S1, (px, py, pz - tz), (wx, wy, wz), slack, pairs)
    elif free:
        count = elbow_on_axis(N, d, 0.0, slack, pairs)
    else:
        count = circle_pair(M, N, d, slack, series, pairs)
    if count <= 0:
        first = hypot(M[0, 0], M[0, 1]) + hypot(M[1, 0], M[1, 1]) / size
        last = hypot(N[0, 0], N[0, 1]) + hypot(N[1, 0], N[1, 1]) / size
        return -1 if min(first, last) <= VOID * size else 0
    for k in range(count):
        c1, s1, c3, s3 = pairs[k, 0], pairs[k, 1], pairs[k, 2], pairs[k, 3]
        y = applied_inverse(S0, (c1 * px + s1 * py, c1 * py - s1 * px, pz))
        v = applied(S1, (c3 * wx - s3 * wy, s3 * wx + c3 * wy, wz))
        (yx, yy, _), (vx, vy, _) = y, v
        upper_free = vx * vx + vy * vy <= FREE * FREE and not folded
        arm[k, 0], arm[k, 2], arm[k, 3] = atan2(s1, c1), atan2(s3, c3), -1.0
        arm[k, 1] = 0.0 if upper_free else atan2(vx * yy - vy * yx, vx * yx + vy * yy)
        arm[k, 4] = SHOULDER_FREE if free else (UPPER_FREE if upper_free else 0.0)
        arm[k, 5] = _volume(S0, S1, y, v) / (size * size * size)
    return count


def _folded(S0, S1, p, w, slack, pairs):
    """Joints 1 and 3 where p, the wrist centre seen from where axes 1 and 2 meet, is next to it.

    The elbow is next to where the centre is nearest, and by half the angle between, the sine of
    which is known to as many digits as p: ``|p|^2 = |v_0|^2 + 4 a sin^2(angle / 2)``.
    """
    wx, wy, wz = w
    k = applied(S1, (0.0, 0.0, wz))
    C, F = turned(S1, (wx, wy, 0.0)), turned(S1, (-wy, wx, 0.0))
    a, b = dot(k, C), dot(k, F)
    amplitude = hypot(a, b)
    if not amplitude > 0.0:
        return 0
    c0, s0 = -a / amplitude, -b / amplitude
    nearest = applied(S1, (c0 * wx - s0 * wy, s0 * wx + c0 * wy, wz))
    rows = 0
    half = root_of_gap((dot(p, p) - dot(nearest, nearest)) / (4.0 * amplitude), 1.0, -abs(slack))
    if not 0.0 <= half <= 1.0:
        return 0
    gx, gy, gz = S0[0, 2], S0[1, 2], S0[2, 2]
    for side in range(2 if half > 0.0 else 1):
        rise, sine = -2.0 * half * half, 2.0 * half * math.sqrt(1.0 - half * half)
        sine = sine if side == 0 else -sine
        # from the nearest point on, so that no digit is lost where it is next to axis 2
        height = nearest[2] + rise * (c0 * C[2] + s0 * F[2]) + sine * (c0 * F[2] - s0 * C[2])
        across, along = gx * p[0] + gy * p[1], gx * p[1] - gy * p[0]
        count, c, s, e, f = linear_trig(across, along, height - gz * p[2], slack)
        for j in range(count):
            pairs[rows, 0], pairs[rows, 1] = (c, s) if j == 0 else (e, f)
            pairs[rows, 2] = c0 + rise * c0 - sine * s0
            pairs[rows, 3] = s0 + rise * s0 + sine * c0
            rows += 1
    return rows


def _volume(S0, S1, y, v):
    """What the motions of the wrist centre by joints 1, 2 and 3 span.

    y is the centre seen from axis 2, v the same behind joint 2.
    """
    square = max(v[0] * v[0] + v[1] * v[1], 1e-300)
    c, s = (v[0] * y[0] + v[1] * y[1]) / square, (v[0] * y[1] - v[1] * y[0]) / square
    px, py, _ = applied(S0, y)
    first, second = turned_back(S0, (-py, px, 0.0)), (-y[1], y[0], 0.0)
    third = cross(
        (S1[0, 2], S1[1, 2], S1[2, 2]), (v[0] - S1[0, 3], v[1] - S1[1, 3], v[2] - S1[2, 3])
    )
    third = c * third[0] - s * third[1], s * third[0] + c * third[1], third[2]
    return abs(dot(first, cross(second, third)))


def put_in_line(chain, T, form, reversed_, rows, count):
    """Put wrists that are in line but for rounding there, where the pose is reached as well.

    Where the elbow is straight, too, such an angle is known to the root of rounding, and on either
    side of it is a solution, from which nothing is free.
    """
    (q, residual, _, free), middle = rows, 1 if reversed_ else 4
    room, trial = (make_damped(6), np.empty((6, 6)), np.empty(6), np.empty(6)), np.empty(6)
    for k in range(count):
        bent = form[4, 6] * q[k, middle] + form[4, 4]
        off = math.pi * np.rint(bent / math.pi) - bent
        if free[k] != 0 or abs(off) > IN_LINE:
            continue
        trial[:] = q[k]
        trial[middle] += form[4, 6] * off
        bring_back(chain, T, trial, OTHERS - (1 << middle), IN_LINE, room)
        there = pose_residual(chain, T, trial)
        if there <= max(EXACT, residual[k]):
            q[k], residual[k] = trial, there
