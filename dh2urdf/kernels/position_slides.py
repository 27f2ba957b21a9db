"""Where three joints put a wrist centre when some of them slide: RRP, RPR, PRR, RPP, PRP, PPR, PPP.

Notation and output as in :mod:`dh2urdf.kernels.position_arm`. A slide enters linearly, so it is
eliminated first; what is left is one trigonometric equation in one angle, of degree 1 where the
slide is square to a neighbour (Stanford arm, cylinder, gantry), else of degree 2.
"""

from __future__ import annotations

import math

import numpy as np

from dh2urdf.kernels.compiled import inner_kernel
from dh2urdf.kernels.position_arm import (
    FREE,
    ON_AXIS,
    SHOULDER_FREE,
    UPPER_FREE,
    onto_axis_2,
    seen_from_axis_2,
)
from dh2urdf.kernels.trig import add_square, linear_trig, root_of_gap, trig_roots

__all__ = ["place_wrist_sliding"]

OBLIQUE = 1e-9
"""Cosine between a slide and a neighbouring axis up to which they count as square."""


@inner_kernel
def place_wrist_sliding(form, px, py, pz, slack, arm):
    """All joint values that put the wrist centre at p (frame 0) for any first three joints."""
    kind = int(form[0, 5]) + 2 * int(form[1, 5]) + 4 * int(form[2, 5])
    if kind & 1:
        c, s = math.cos(form[0, 4]), math.sin(form[0, 4])
        px, py = c * px + s * py, c * py - s * px
    else:
        pz -= form[0, 3]
    if kind == 4:
        rows = _turn_turn_slide(form, px, py, pz, slack, arm)
    elif kind == 2:
        rows = _turn_slide_turn(form, px, py, pz, slack, arm)
    elif kind == 1:
        rows = _slide_turn_turn(form, px, py, pz, slack, arm)
    elif kind == 6:
        rows = _turn_slide_slide(form, px, py, pz, slack, arm)
    elif kind == 5:
        rows = _slide_turn_slide(form, px, py, pz, slack, arm)
    elif kind == 3:
        rows = _slide_slide_turn(form, px, py, pz, slack, arm)
    else:
        rows = _three_slides(form, px, py, pz, arm)
    for k in range(rows):
        arm[k, 3] = -1.0
    return rows


@inner_kernel
def _after_link(form, i, x, y, z, point):
    """``Trans_x(a_i) Rot_x(alpha_i)`` of a point (1.0) or a direction (0.0)."""
    ca, sa = form[i, 1], form[i, 2]
    return x + point * form[i, 0], ca * y - sa * z, sa * y + ca * z


@inner_kernel
def _after_joint(form, i, x, y, z, point):
    """A fixed angle theta_i and, for a point of a turning joint, its offset d_i."""
    c, s = math.cos(form[i, 4]), math.sin(form[i, 4])
    lift = 0.0 if form[i, 5] != 0.0 else point * form[i, 3]
    return c * x - s * y, s * x + c * y, z + lift


@inner_kernel
def _wrist_in_three(form):
    """The wrist centre before joint 3 turns or slides; turned by theta_3 if it slides."""
    x, y, z = _after_link(form, 2, 0.0, 0.0, form[3, 3], 1.0)
    if form[2, 5] != 0.0:
        x, y, z = _after_joint(form, 2, x, y, z, 1.0)
    else:
        z += form[2, 3]
    return x, y, z


@inner_kernel
def _between(vx, vy, x, y):
    """Angle from (vx, vy) to (x, y): subproblem 1 about z."""
    return math.atan2(vx * y - vy * x, vx * x + vy * y)


@inner_kernel
def _turn_turn_slide(form, px, py, pz, slack, arm):
    """RRP (Stanford arm): height and length of p seen from axis 2, in q1 and d3."""
    a1, ca1, sa1, ca2, sa2 = form[0, 0], form[0, 1], form[0, 2], form[1, 1], form[1, 2]
    x, y, z = _wrist_in_three(form)
    x, y, z = _after_link(form, 1, x, y, z, 1.0)
    z += form[1, 3]
    along = -sa2 * y + ca2 * z
    size2 = x * x + y * y + z * z + px * px + py * py + pz * pz + a1 * a1
    length2 = 2.0 * (x * x + y * y + z * z) - size2
    series, cosines, sines = np.zeros(5), np.empty(4), np.empty(4)
    oblique = abs(ca2) > OBLIQUE
    d0, dc, ds = 0.0, 0.0, 0.0
    free = px * px + py * py <= FREE * FREE
    if oblique:
        d0, dc, ds = (ca1 * pz - z) / ca2, -sa1 * py / ca2, sa1 * px / ca2
        series[0] = length2 + 2.0 * along * d0
        series[1] = 2.0 * (a1 * px + along * dc)
        series[2] = 2.0 * (a1 * py + along * ds)
        add_square(series, 1.0, d0, dc, ds)
        count = trig_roots(series, 2, cosines, sines)
    else:
        count, c, s, e, f = linear_trig(-sa1 * py, sa1 * px, z - ca1 * pz, slack)
        cosines[0], sines[0], cosines[1], sines[1] = c, s, e, f
    if free:
        count, cosines[0], sines[0] = 1, math.cos(form[0, 4]), math.sin(form[0, 4])
    rows = 0
    for k in range(count):
        c, s = cosines[k], sines[k]
        found, d, other = 1, d0 + dc * c + ds * s, 0.0
        if not oblique:
            rest = length2 + 2.0 * a1 * (c * px + s * py)
            root = root_of_gap(along * along - rest, size2, slack)
            found = 0 if root < 0.0 else (1 if root == 0.0 else 2)
            d, other = root - along, -root - along
        for j in range(found):
            d = d if j == 0 else other
            vx, vy = x, y - sa2 * d
            upper_free = False
            if vx * vx + vy * vy <= ON_AXIS * ON_AXIS:
                near_c, near_s, off = onto_axis_2(form, c, s, px, py, pz)
                upper_free = max(off, abs(x)) <= FREE and sa2 != 0.0
                if upper_free:
                    c, s, d = near_c, near_s, y / sa2
            ux, uy = seen_from_axis_2(form, c, s, px, py, pz)
            arm[rows, 0], arm[rows, 1] = math.atan2(s, c), _between(vx, vy, ux, uy)
            arm[rows, 2] = d
            arm[rows, 4] = SHOULDER_FREE if free else 0.0
            if upper_free:
                arm[rows, 1], arm[rows, 4] = form[1, 4], UPPER_FREE
            rows += 1
    return rows


@inner_kernel
def _turn_slide_turn(form, px, py, pz, slack, arm):
    """RPR: height over frame 0 and distance from axis 1, in d2 and q3."""
    a1, ca1, sa1 = form[0, 0], form[0, 1], form[0, 2]
    wx, wy, wz = _wrist_in_three(form)
    kx, ky, kz = _after_link(form, 1, 0.0, 0.0, wz, 1.0)
    kx, ky, kz = _after_joint(form, 1, kx, ky, kz, 1.0)
    cx, cy, cz = _after_link(form, 1, wx, wy, 0.0, 0.0)
    cx, cy, cz = _after_joint(form, 1, cx, cy, cz, 0.0)
    sx, sy, sz = _after_link(form, 1, -wy, wx, 0.0, 0.0)
    sx, sy, sz = _after_joint(form, 1, sx, sy, sz, 0.0)
    square = px * px + py * py
    series, cosines, sines = np.zeros(5), np.empty(4), np.empty(4)
    oblique = abs(ca1) > OBLIQUE
    if oblique:
        series[0] = -square
        add_square(series, 1.0, a1 + kx, cx, sx)
        add_square(series, 1.0 / (ca1 * ca1), ky - sa1 * pz, cy, sy)
        count = trig_roots(series, 2, cosines, sines)
    else:
        count, c, s, e, f = linear_trig(sa1 * cy, sa1 * sy, pz - sa1 * ky, slack)
        cosines[0], sines[0], cosines[1], sines[1] = c, s, e, f
    rows = 0
    for k in range(count):
        c, s = cosines[k], sines[k]
        x, y, z = kx + c * cx + s * sx, ky + c * cy + s * sy, kz + c * cz + s * sz
        x += a1
        if oblique:
            found, depth = 1, (pz - sa1 * y) / ca1
        else:
            depth2 = square - x * x
            depth = root_of_gap(depth2, square + x * x, slack)
            if depth < 0.0:
                continue
            found = 2 if depth > 0.0 else 1
        for _ in range(found):
            ux, uy = x, ca1 * y - sa1 * depth
            arm[rows, 0], arm[rows, 1] = _between(ux, uy, px, py), depth - z
            arm[rows, 2], arm[rows, 4] = math.atan2(s, c), 0.0
            if square <= FREE * FREE:
                arm[rows, 0], arm[rows, 4] = form[0, 4], SHOULDER_FREE
            depth = -depth
            rows += 1
    return rows


@inner_kernel
def _slide_turn_turn(form, px, py, pz, slack, arm):
    """PRR: p across the slide, in q2 and q3."""
    ca1, sa1 = form[0, 1], form[0, 2]
    wx, wy, wz = _wrist_in_three(form)
    kx, ky, kz = _after_link(form, 1, 0.0, 0.0, wz, 1.0)
    cx, cy, cz = _after_link(form, 1, wx, wy, 0.0, 0.0)
    sx, sy, sz = _after_link(form, 1, -wy, wx, 0.0, 0.0)
    kz += form[1, 3]
    x = px - form[0, 0]
    series, cosines, sines = np.zeros(5), np.empty(4), np.empty(4)
    oblique = abs(ca1) > OBLIQUE
    if oblique:
        series[0] = x * x
        add_square(series, 1.0 / (ca1 * ca1), py + sa1 * kz, sa1 * cz, sa1 * sz)
        add_square(series, -1.0, kx, cx, sx)
        add_square(series, -1.0, ky, cy, sy)
        count = trig_roots(series, 2, cosines, sines)
    else:
        count, c, s, e, f = linear_trig(-sa1 * cz, -sa1 * sz, py + sa1 * kz, slack)
        cosines[0], sines[0], cosines[1], sines[1] = c, s, e, f
    rows = 0
    for k in range(count):
        c, s = cosines[k], sines[k]
        vx, vy, vz = kx + c * cx + s * sx, ky + c * cy + s * sy, kz + c * cz + s * sz
        square = vx * vx + vy * vy
        if oblique:
            found, y = 1, (py + sa1 * vz) / ca1
        else:
            y2 = square - x * x
            y = root_of_gap(y2, square + x * x, slack)
            if y < 0.0:
                continue
            found = 2 if y > 0.0 else 1
        for _ in range(found):
            arm[rows, 0] = pz - sa1 * y - ca1 * vz
            arm[rows, 1], arm[rows, 2] = _between(vx, vy, x, y), math.atan2(s, c)
            arm[rows, 4] = 0.0
            if square <= FREE * FREE:
                arm[rows, 1], arm[rows, 4] = form[1, 4], UPPER_FREE
            y = -y
            rows += 1
    return rows


@inner_kernel
def _two_slides(ax, ay, az, bx, by, bz, x, y, z):
    """Lengths along directions a and b that add up to (x, y, z), least squares (twin of 2)."""
    nx, ny, nz = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
    square = nx * nx + ny * ny + nz * nz
    first = nx * (y * bz - z * by) + ny * (z * bx - x * bz) + nz * (x * by - y * bx)
    second = nx * (ay * z - az * y) + ny * (az * x - ax * z) + nz * (ax * y - ay * x)
    return first / square, second / square


@inner_kernel
def _turn_slide_slide(form, px, py, pz, slack, arm):
    """RPP (cylinder): p in the plane of the two slides, subproblem 4 in q1."""
    x, y, z = _wrist_in_three(form)
    x, y, z = _after_link(form, 1, x, y, z, 1.0)
    x, y, z = _after_joint(form, 1, x, y, z, 1.0)
    x, y, z = _after_link(form, 0, x, y, z, 1.0)
    ax, ay, az = _after_link(form, 0, 0.0, 0.0, 1.0, 0.0)
    bx, by, bz = _after_link(form, 1, 0.0, 0.0, 1.0, 0.0)
    bx, by, bz = _after_joint(form, 1, bx, by, bz, 0.0)
    bx, by, bz = _after_link(form, 0, bx, by, bz, 0.0)
    nx, ny, nz = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
    level = nx * x + ny * y + nz * (z - pz)
    count, c, s, e, f = linear_trig(nx * px + ny * py, nx * py - ny * px, level, slack)
    free = px * px + py * py <= FREE * FREE
    if free:
        count, c, s = 1, math.cos(form[0, 4]), math.sin(form[0, 4])
    for k in range(count):
        c, s = (c, s) if k == 0 else (e, f)
        ux, uy = c * px + s * py, c * py - s * px
        arm[k, 0] = math.atan2(s, c)
        arm[k, 1], arm[k, 2] = _two_slides(ax, ay, az, bx, by, bz, ux - x, uy - y, pz - z)
        arm[k, 4] = SHOULDER_FREE if free else 0.0
    return max(count, 0)


@inner_kernel
def _slide_turn_slide(form, px, py, pz, slack, arm):
    """PRP: p across the first slide, d3 eliminated; subproblem 4 in q2."""
    ca1, sa1, ca2, sa2 = form[0, 1], form[0, 2], form[1, 1], form[1, 2]
    x, y, z = _wrist_in_three(form)
    x, y, z = _after_link(form, 1, x, y, z, 1.0)
    z += form[1, 3]
    gx, gy = px - form[0, 0], py + sa1 * z
    count, c, s, e, f = linear_trig(
        -ca1 * sa2 * gx + sa1 * ca2 * x,
        -sa2 * gy - sa1 * ca2 * y,
        sa1 * ca2 * gx - ca1 * sa2 * x,
        slack,
    )
    rows = 0
    for k in range(count):
        c, s = (c, s) if k == 0 else (e, f)
        fx, fy = s * sa2, -ca1 * c * sa2 - sa1 * ca2
        square = fx * fx + fy * fy
        if square <= 0.0:
            continue
        hx, hy = gx - c * x + s * y, gy - ca1 * (s * x + c * y)
        d = (hx * fx + hy * fy) / square
        vy, vz = y - sa2 * d, z + ca2 * d
        arm[rows, 0] = pz - sa1 * (s * x + c * vy) - ca1 * vz
        arm[rows, 1], arm[rows, 2] = math.atan2(s, c), d
        arm[rows, 4] = UPPER_FREE if x * x + vy * vy <= FREE * FREE else 0.0
        rows += 1
    return rows


@inner_kernel
def _slide_slide_turn(form, px, py, pz, slack, arm):
    """PPR: p off the plane of the slides, subproblem 4 in q3."""
    wx, wy, wz = _wrist_in_three(form)
    kx, ky, kz = _after_link(form, 1, 0.0, 0.0, wz, 1.0)
    kx, ky, kz = _after_joint(form, 1, kx, ky, kz, 1.0)
    kx, ky, kz = _after_link(form, 0, kx, ky, kz, 1.0)
    cx, cy, cz = _after_link(form, 1, wx, wy, 0.0, 0.0)
    cx, cy, cz = _after_joint(form, 1, cx, cy, cz, 0.0)
    cx, cy, cz = _after_link(form, 0, cx, cy, cz, 0.0)
    sx, sy, sz = _after_link(form, 1, -wy, wx, 0.0, 0.0)
    sx, sy, sz = _after_joint(form, 1, sx, sy, sz, 0.0)
    sx, sy, sz = _after_link(form, 0, sx, sy, sz, 0.0)
    ax, ay, az = _after_link(form, 0, 0.0, 0.0, 1.0, 0.0)
    count, c, s, e, f = linear_trig(
        -ay * cx + ax * cy, -ay * sx + ax * sy, -ay * (px - kx) + ax * (py - ky), slack
    )
    for k in range(count):
        c, s = (c, s) if k == 0 else (e, f)
        x, y, z = kx + c * cx + s * sx, ky + c * cy + s * sy, kz + c * cz + s * sz
        first, second = _two_slides(0.0, 0.0, 1.0, ax, ay, az, px - x, py - y, pz - z)
        arm[k, 0], arm[k, 1], arm[k, 2], arm[k, 4] = first, second, math.atan2(s, c), 0.0
    return max(count, 0)


@inner_kernel
def _three_slides(form, px, py, pz, arm):
    """PPP (gantry): three linear equations, solved by Cramer's rule."""
    x, y, z = _wrist_in_three(form)
    bx, by, bz = 0.0, 0.0, 1.0
    for i in (1, 0):
        x, y, z = _after_link(form, i, x, y, z, 1.0)
        bx, by, bz = _after_link(form, i, bx, by, bz, 0.0)
        if i == 1:
            x, y, z = _after_joint(form, i, x, y, z, 1.0)
            bx, by, bz = _after_joint(form, i, bx, by, bz, 0.0)
    ax, ay, az = _after_link(form, 0, 0.0, 0.0, 1.0, 0.0)
    x, y, z = px - x, py - y, pz - z
    det = ax * by - ay * bx
    second, third = (x * by - y * bx) / det, (ax * y - ay * x) / det
    arm[0, 0], arm[0, 1], arm[0, 2] = z - second * az - third * bz, second, third
    arm[0, 4] = 0.0
    return 1
