"""6R arms with three neighbouring parallel axes: 1, 2, 3 or 2, 3, 4 (UR and its kin).

The three turn in a plane and leave alone what points or lies along their common normal. So the
height of the pose over that plane and the slope of axis 6 are two equations without them, in two
of the other joints: a subproblem 6, or 4 twice where axes 5 and 6 meet. Then axis 6 follows by
subproblem 1, and the three are a planar RR arm with a wrist (Elias and Wen; EAIK).

In Denavit-Hartenberg form (:mod:`dh2urdf.kernels.position_arm`) the parallel axes have
alpha = 0 between them. ``pair`` (8, 5) holds cosine and sine of the first unknown, of t5, and
whether t5 is free.
"""

from __future__ import annotations

import math

import numpy as np

from dh2urdf.kernels.certify import TWO_PI, finish_pose
from dh2urdf.kernels.compiled import inner_kernel, kernel
from dh2urdf.kernels.families import free_joints
from dh2urdf.kernels.parallel_pairs import outer_pairs
from dh2urdf.kernels.position_arm import FREE, NICE, tool_to_wrist
from dh2urdf.kernels.spherical_wrist import middle_angle
from dh2urdf.kernels.trig import elbow_angle

__all__ = [
    "add_pairs",
    "finish_pairs",
    "make_scratch",
    "solve_three_parallel",
]

ALL_FREE = 0b111111

FIFTH_FREE = 0b010111
"""Joints that move where axis 5 is parallel to axes 1, 2, 3."""

TRIALS = 64
"""Values at which a free t5 is tried."""

VAGUE = 1e-6
"""Sine of the angle between axis 6 and the parallel axes below which t6, which rounding turns by
1e-16 over that sine, may have left the interval in which the planar arm reaches."""

ROUNDING = 1e-12
"""Turn of the tool [rad] that rounding, also of t1 near its own rim, explains."""


@inner_kernel
def _reach_with_fifth_joint(form, D, cs):
    """Turn t5, free where axis 5 is parallel to 1, 2, 3, so that the planar arm reaches best."""
    upper, fore = form[0, 0], form[1, 0]
    least, best_c, best_s = math.inf, 1.0, 0.0
    for k in range(TRIALS):
        angle = form[4, 4] + TWO_PI * k / TRIALS
        cs[4, 0], cs[4, 1] = math.cos(angle), math.sin(angle)
        _last_joint(form, 0, D, cs)
        x, y, _ = _seen_arm(form, 0, D, cs, 0.0, 1.0)
        length = math.hypot(D[0, 3] - x, D[1, 3] - y)
        beyond = max(abs(upper - fore) - length, length - upper - fore)
        if beyond < least:
            least, best_c, best_s = beyond, cs[4, 0], cs[4, 1]
    cs[4, 0], cs[4, 1] = best_c, best_s


@inner_kernel
def _seen_from_plane(form, first, c1, s1, x, y, z):
    """A vector of frame 0 in the frame of the parallel axes, which joint 1 turns or not."""
    if first == 0:
        return x, y, z
    x, y = c1 * x + s1 * y, c1 * y - s1 * x
    ca, sa = form[0, 1], form[0, 2]
    return x, ca * y + sa * z, ca * z - sa * y


@inner_kernel
def _to_frame_six(form, last, cs, x, origin):
    """A vector of the frame after the last parallel axis, seen in frame 6.

    ``origin`` 1.0: the vector from that frame's origin to frame 6's; 0.0: the direction x.
    """
    x, y, z = (form[last, 0], 0.0, 0.0) if origin != 0.0 else (x, 0.0, 0.0)
    for i in range(last + 1, 6):
        ca, sa = form[i - 1, 1], form[i - 1, 2]
        y, z = ca * y + sa * z, ca * z - sa * y
        c, s = cs[i, 0], cs[i, 1]
        x, y = c * x + s * y, c * y - s * x
        x += origin * form[i, 0]
        z += origin * form[i, 3]
    return x, y, z


@inner_kernel
def _seen_arm(form, first, D, cs, x, origin):
    """``_to_frame_six`` brought on into the plane of the parallel axes."""
    x, y, z = _to_frame_six(form, first + 2, cs, x, origin)
    u = D[0, 0] * x + D[0, 1] * y + D[0, 2] * z
    v = D[1, 0] * x + D[1, 1] * y + D[1, 2] * z
    w = D[2, 0] * x + D[2, 1] * y + D[2, 2] * z
    return _seen_from_plane(form, first, cs[0, 0], cs[0, 1], u, v, w)


@inner_kernel
def _last_joint(form, first, D, cs):
    """Cosine and sine of t6 into cs by subproblem 1; returns whether axis 6 is in line.

    The common direction k has components ``r = k^T R`` in frame 6 and ``g`` before joint 6.
    """
    kx, ky, kz = 0.0, 0.0, 1.0
    if first == 1:
        kx, ky, kz = form[0, 2] * cs[0, 1], -form[0, 2] * cs[0, 0], form[0, 1]
    rx = kx * D[0, 0] + ky * D[1, 0] + kz * D[2, 0]
    ry = kx * D[0, 1] + ky * D[1, 1] + kz * D[2, 1]
    x, y, z = 0.0, 0.0, 1.0
    for i in range(first + 3, 6):
        ca, sa = form[i - 1, 1], form[i - 1, 2]
        y, z = ca * y + sa * z, ca * z - sa * y
        if i < 5:
            c, s = cs[i, 0], cs[i, 1]
            x, y = c * x + s * y, c * y - s * x
    in_line = math.hypot(rx, ry)
    c6, s6 = x * rx + y * ry, y * rx - x * ry
    r = math.hypot(c6, s6)
    if in_line <= NICE or r == 0.0:
        cs[5, 0], cs[5, 1] = math.cos(form[5, 4]), math.sin(form[5, 4])
    else:
        cs[5, 0], cs[5, 1] = c6 / r, s6 / r
    return in_line


@inner_kernel
def _reach_with_last_joint(form, first, D, cs, x, y, in_line):
    """Turn t6, free or nearly so, so that the planar arm reaches (lecture notes 8.2).

    The point that the arm has to reach goes round a circle about axis 6. It stays where t6 has
    it if that is within reach; else it goes to the middle of what is, or, where t6 is not quite
    free, by the shortest way to its end, if rounding explains that. Returns the point.
    """
    upper, fore = form[first, 0], form[first + 1, 0]
    near, far = abs(upper - fore), upper + fore
    bx, by, _ = _seen_arm(form, first, D, cs, 0.0, 1.0)
    cx, cy = x + bx, y + by
    distance, radius, length = math.hypot(cx, cy), math.hypot(bx, by), math.hypot(x, y)
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
    if in_line > FREE and in_line * math.hypot(1.0 - c, s) > ROUNDING:
        return x, y
    _, _, up = _seen_arm_axis(form, first, D, cs)
    s = -s if up > 0.0 else s
    cs[5, 0], cs[5, 1] = cs[5, 0] * c - cs[5, 1] * s, cs[5, 1] * c + cs[5, 0] * s
    return cx - vx, cy - vy


@inner_kernel
def _seen_arm_axis(form, first, D, cs):
    """Axis 6 in the plane's frame."""
    return _seen_from_plane(form, first, cs[0, 0], cs[0, 1], D[0, 2], D[1, 2], D[2, 2])


@inner_kernel
def _add_planar(form, first, D, cs, shoulder, mask, slack, q, branch, free, count):
    """Append the elbows of one set of outer joints; returns the new count."""
    in_line = _last_joint(form, first, D, cs)
    px, py, pz = D[0, 3], D[1, 3], D[2, 3]
    if first == 1:
        pz -= form[0, 3]
    x, y, _ = _seen_from_plane(form, first, cs[0, 0], cs[0, 1], px, py, pz)
    x -= form[0, 0] if first == 1 else 0.0
    bx, by, _ = _seen_arm(form, first, D, cs, 0.0, 1.0)
    x, y = x - bx, y - by
    if in_line <= FREE:
        mask |= (0b111 << first) | 0b100000
    if in_line <= VAGUE:
        x, y = _reach_with_last_joint(form, first, D, cs, x, y, in_line)
    hx, hy, _ = _seen_arm(form, first, D, cs, 1.0, 0.0)
    heading = math.atan2(hy, hx)
    upper, fore = form[first, 0], form[first + 1, 0]
    square = x * x + y * y
    elbows, cosine, sine = elbow_angle(upper, fore, square, slack)
    if square <= FREE * FREE:
        mask |= 0b101 << first
    up = form[0, 2] if first == 1 else -1.0
    side = -1.0 if (up > 0.0) == (shoulder == 0) else 1.0
    for elbow in range(elbows):
        s3 = side * sine
        along, across = upper + fore * cosine, fore * s3
        t_first = math.atan2(y * along - x * across, x * along + y * across)
        t_next = math.atan2(s3, cosine)
        for i in range(6):
            t = math.atan2(cs[i, 1], cs[i, 0])
            if i == first:
                t = t_first
            elif i == first + 1:
                t = t_next
            elif i == first + 2:
                t = heading - t_first - t_next
            q[count, i] = form[i, 6] * (t - form[i, 4])
        branch[count] = shoulder + 2 * elbow + (4 if cs[4, 1] < 0.0 else 0)
        free[count] = mask
        side = -side
        count += 1
    return count


@inner_kernel
def _slope_of_last(form, D, cs, slack):
    """Joint 5 into cs where axes 5 and 6 meet; the number of its signs, 1 if axis 6 is in line."""
    kx, ky, kz = form[0, 2] * cs[0, 1], -form[0, 2] * cs[0, 0], form[0, 1]
    x = kx * D[0, 0] + ky * D[1, 0] + kz * D[2, 0]
    y = kx * D[0, 1] + ky * D[1, 1] + kz * D[2, 1]
    z = kx * D[0, 2] + ky * D[1, 2] + kz * D[2, 2]
    wrists, cs[4, 0], cs[4, 1] = middle_angle(form, x, y, z, slack)
    return min(wrists, 1) if math.hypot(x, y) <= FREE else wrists


@inner_kernel
def add_pairs(form, first, pairs, slack, q, branch, free, scratch):
    """From ``pairs`` of outer joints of one pose to candidates in q (8, 6); their count.

    ``first`` is the index of the first parallel axis; ``scratch``: frame 6 in frame 0 (3, 4), the
    pairs (8, 5), cosines and sines (6, 2), certification.
    """
    D, pair, cs, _ = scratch
    outer = 0 if first == 1 else 3
    mask = ALL_FREE if pairs < 0 else 0
    found = 0
    for k in range(abs(pairs)):
        cs[outer, 0], cs[outer, 1] = pair[k, 0], pair[k, 1]
        cs[4, 0], cs[4, 1] = pair[k, 2], pair[k, 3]
        shoulder, wrists, free_with = 0, 1, mask
        if first == 0 and pair[k, 4] != 0.0:
            _reach_with_fifth_joint(form, D, cs)
            free_with = FIFTH_FREE
        if found + 2 > q.shape[0]:
            break
        if first == 1:
            shoulder = 1 if pair[k, 0] * D[0, 3] + pair[k, 1] * D[1, 3] < 0.0 else 0
            if form[4, 0] == 0.0:
                wrists = _slope_of_last(form, D, cs, slack)
        for _ in range(wrists):
            found = _add_planar(
                form, first, D, cs, shoulder, free_with, slack, q, branch, free, found
            )
            cs[4, 1] = -cs[4, 1]
    return found


@inner_kernel
def finish_pairs(
    links, joints, form, first, pairs, slack, T, within_limits, q, residual, branch, free, scratch
):
    """From ``pairs`` of outer joints of one pose to certified solutions in q (8, 6); their count.

    See :func:`add_pairs`.
    """
    found = add_pairs(form, first, pairs, slack, q, branch, free, scratch)
    for k in range(found):
        residual[k] = -1.0
    return finish_pose(
        links, joints, T, within_limits, q, residual, branch, free, found, scratch[3]
    )


@inner_kernel
def make_scratch():
    """Scratch of :func:`finish_pairs`, one for a batch."""
    return np.empty((3, 4)), np.empty((8, 5)), np.zeros((6, 2)), np.empty((6, 14))


@kernel
def solve_three_parallel(
    links, joints, form, ends, slack, Ts, within_limits, q, residual, count, branch, free
):
    """All solutions of poses Ts (m, 4, 4); q (m, 8, 6), the rest as its first axes.

    The parallel axes are 2, 3, 4 where ``form[0]`` has a twist, else 1, 2, 3.
    """
    scratch = make_scratch()
    D, pair, trial = scratch[0], scratch[1], np.empty(6)
    first = 1 if form[0, 2] != 0.0 else 0
    for i in range(Ts.shape[0]):
        tool_to_wrist(ends, Ts[i], D)
        pairs = outer_pairs(form, first, D, slack, pair)
        out = q[i], residual[i], branch[i], free[i]
        count[i] = finish_pairs(
            links, joints, form, first, pairs, slack, Ts[i], within_limits, *out, scratch
        )
        vague = 0.0
        for k in range(abs(pairs) if first == 0 else 0):
            vague = max(vague, pair[k, 4])
        for k in range(count[i] if vague != 0.0 else 0):
            free[i, k] = free_joints(links, joints, Ts[i], q[i, k], trial, scratch[3])
