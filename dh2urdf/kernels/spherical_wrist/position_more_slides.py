"""Where three joints put a wrist centre when two or all of them slide: RPP, PRP, PPR, PPP.

Notation and output as in :mod:`dh2urdf.kernels.spherical_wrist.position_arm`.
"""

import math

from dh2urdf.kernels.chain import after_joint, after_link, wrist_circle, wrist_in_three
from dh2urdf.kernels.numbers import inner_kernel, linear_trig
from dh2urdf.kernels.spherical_wrist.position_arm import FREE, SHOULDER_FREE, UPPER_FREE


@inner_kernel
def _two_slides(ax, ay, az, bx, by, bz, x, y, z):
    """Lengths along directions a and b that add up to (x, y, z), least squares (twin of 2)."""
    nx, ny, nz = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
    square = nx * nx + ny * ny + nz * nz
    first = nx * (y * bz - z * by) + ny * (z * bx - x * bz) + nz * (x * by - y * bx)
    second = nx * (ay * z - az * y) + ny * (az * x - ax * z) + nz * (ax * y - ay * x)
    return first / square, second / square


@inner_kernel
def turn_slide_slide(form, px, py, pz, slack, arm):
    """RPP (cylinder): p in the plane of the two slides, subproblem 4 in q1."""
    x, y, z = wrist_in_three(form)
    x, y, z = after_link(form, 1, x, y, z, 1.0)
    x, y, z = after_joint(form, 1, x, y, z, 1.0)
    x, y, z = after_link(form, 0, x, y, z, 1.0)
    ax, ay, az = after_link(form, 0, 0.0, 0.0, 1.0, 0.0)
    bx, by, bz = after_link(form, 1, 0.0, 0.0, 1.0, 0.0)
    bx, by, bz = after_joint(form, 1, bx, by, bz, 0.0)
    bx, by, bz = after_link(form, 0, bx, by, bz, 0.0)
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
def slide_turn_slide(form, px, py, pz, slack, arm):
    """PRP: p across the first slide, d3 eliminated; subproblem 4 in q2."""
    ca1, sa1, ca2, sa2 = form[0, 1], form[0, 2], form[1, 1], form[1, 2]
    x, y, z = wrist_in_three(form)
    x, y, z = after_link(form, 1, x, y, z, 1.0)
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
def slide_slide_turn(form, px, py, pz, slack, arm):
    """PPR: p off the plane of the slides, subproblem 4 in q3."""
    (kx, ky, kz), (cx, cy, cz), (sx, sy, sz) = wrist_circle(form, 3)
    ax, ay, az = after_link(form, 0, 0.0, 0.0, 1.0, 0.0)
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
def three_slides(form, px, py, pz, arm):
    """PPP (gantry): three linear equations, solved by Cramer's rule."""
    x, y, z = wrist_in_three(form)
    bx, by, bz = 0.0, 0.0, 1.0
    for i in (1, 0):
        x, y, z = after_link(form, i, x, y, z, 1.0)
        bx, by, bz = after_link(form, i, bx, by, bz, 0.0)
        if i == 1:
            x, y, z = after_joint(form, i, x, y, z, 1.0)
            bx, by, bz = after_joint(form, i, bx, by, bz, 0.0)
    ax, ay, az = after_link(form, 0, 0.0, 0.0, 1.0, 0.0)
    x, y, z = px - x, py - y, pz - z
    det = ax * by - ay * bx
    second, third = (x * by - y * bx) / det, (ax * y - ay * x) / det
    arm[0, 0], arm[0, 1], arm[0, 2] = z - second * az - third * bz, second, third
    arm[0, 4] = 0.0
    return 1
