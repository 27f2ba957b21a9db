"""Where three joints put a wrist centre when some of them slide: RRP, RPR, PRR, RPP, PRP, PPR, PPP.

Notation and output as in :mod:`dh2urdf.kernels.spherical_wrist.position_arm`. A slide enters
linearly, so it is eliminated first; what is left is one trigonometric equation in one angle, of
degree 1 where the slide is square to a neighbour (Stanford arm, cylinder, gantry), else of degree
2.
"""

import math

import numpy as np

from dh2urdf.kernels.certificate import ACCEPT
from dh2urdf.kernels.chain import after_link, wrist_circle, wrist_in_three
from dh2urdf.kernels.numbers import add_square, inner_kernel, linear_trig, root_of_gap, trig_roots
from dh2urdf.kernels.spherical_wrist.position_arm import (
    FREE,
    ON_AXIS,
    SHOULDER_FREE,
    UPPER_FREE,
    onto_axis_2,
    seen_from_axis_2,
)
from dh2urdf.kernels.spherical_wrist.position_more_slides import (
    slide_slide_turn,
    slide_turn_slide,
    three_slides,
    turn_slide_slide,
)

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
        rows = turn_slide_slide(form, px, py, pz, slack, arm)
    elif kind == 5:
        rows = slide_turn_slide(form, px, py, pz, slack, arm)
    elif kind == 3:
        rows = slide_slide_turn(form, px, py, pz, slack, arm)
    else:
        rows = three_slides(form, px, py, pz, arm)
    for k in range(rows):
        arm[k, 3] = -1.0
    return rows


@inner_kernel
def _between(vx, vy, x, y):
    """Angle from (vx, vy) to (x, y): subproblem 1 about z."""
    return math.atan2(vx * y - vy * x, vx * x + vy * y)


@inner_kernel
def _across(oblique, known, square, x, slack):
    """How many y there are, and one: the known one, or both with ``x^2 + y^2 = square``."""
    if oblique:
        return 1, known
    y = root_of_gap(square - x * x, square + x * x, slack)
    return (0 if y < 0.0 else (2 if y > 0.0 else 1)), y


@inner_kernel
def _slide_to_axis_2(form, x, y, px, py, pz, slack, c, s, d):
    """Put the wrist centre on axis 2 by joints 1 and 3 if only rounding keeps it off.

    Returns whether it was put there, whether joint 2 is free, cosine and sine of joint 1, d3. The
    centre is (x, y - sin(alpha2) d3) across the axis, seen after joint 2.
    """
    sa2 = form[1, 2]
    across = y - sa2 * d
    if x * x + across * across > ON_AXIS * ON_AXIS or abs(x) > FREE or sa2 == 0.0:
        return False, False, c, s, d
    near_c, near_s, off = onto_axis_2(form, c, s, px, py, pz)
    free = off <= ACCEPT
    if free or (slack > 0.0 and off <= ON_AXIS):
        return True, free, near_c, near_s, y / sa2
    return False, False, c, s, d


@inner_kernel
def _turn_turn_slide(form, px, py, pz, slack, arm):
    """RRP (Stanford arm): height and length of p seen from axis 2, in q1 and d3."""
    a1, ca1, sa1, ca2, sa2 = form[0, 0], form[0, 1], form[0, 2], form[1, 1], form[1, 2]
    x, y, z = wrist_in_three(form)
    x, y, z = after_link(form, 1, x, y, z, 1.0)
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
            found = 0 if root < 0.0 else (1 if root == 0.0 and slack > 0.0 else 2)
            d, other = root - along, -root - along
        for j in range(found):
            d = d if j == 0 else other
            vx, vy = x, y - sa2 * d
            on_axis, upper_free, c, s, d = _slide_to_axis_2(form, x, y, px, py, pz, slack, c, s, d)
            ux, uy = seen_from_axis_2(form, c, s, px, py, pz)
            arm[rows, 0], arm[rows, 1] = math.atan2(s, c), _between(vx, vy, ux, uy)
            arm[rows, 2] = d
            arm[rows, 4] = SHOULDER_FREE if free else 0.0
            if on_axis:
                arm[rows, 1] = form[1, 4]
            if upper_free:
                arm[rows, 4] = UPPER_FREE
            rows += 1
    return rows


@inner_kernel
def _turn_slide_turn(form, px, py, pz, slack, arm):
    """RPR: height over frame 0 and distance from axis 1, in d2 and q3."""
    a1, ca1, sa1 = form[0, 0], form[0, 1], form[0, 2]
    (kx, ky, kz), (cx, cy, cz), (sx, sy, sz) = wrist_circle(form, 2)
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
        found, depth = _across(oblique, (pz - sa1 * y) / ca1, square, x, slack)
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
    (kx, ky, kz), (cx, cy, cz), (sx, sy, sz) = wrist_circle(form, 1)
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
        found, y = _across(oblique, (py + sa1 * vz) / ca1, square, x, slack)
        for _ in range(found):
            arm[rows, 0] = pz - sa1 * y - ca1 * vz
            arm[rows, 1], arm[rows, 2] = _between(vx, vy, x, y), math.atan2(s, c)
            arm[rows, 4] = 0.0
            if square <= FREE * FREE:
                arm[rows, 1], arm[rows, 4] = form[1, 4], UPPER_FREE
            y = -y
            rows += 1
    return rows
