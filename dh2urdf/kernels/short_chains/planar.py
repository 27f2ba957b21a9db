"""The planar RR and RRR arms of lecture notes 8.2, also with a slide across their plane.

``x = l1 cos t1 + l2 cos(t1 + t2)``, ``y = l1 sin t1 + l2 sin(t1 + t2)``, ``phi = t1 + t2 + t3``.
"""

import math
from typing import Annotated, NamedTuple, TypeAlias

import numpy as np

from dh2urdf.kernels.certificate import finish_pose, principal
from dh2urdf.kernels.newton import work_array
from dh2urdf.kernels.numbers import atan2, elbow_angle, entry, hypot, root_of_gap, sincos
from dh2urdf.kernels.rigid import applied, turned
from dh2urdf.kernels.shapes import Chain, Floats, Integers, Outputs, Poses

ON_AXIS = 1e-10
"""Distance of the point from axis 1, relative to the reach, that leaves no direction."""

FOLDED = 1e-3
"""The same, within which both links are as good as equal: l1 + l2 cos t2 keeps no digits there, and
the direction of the point few."""

Elbows: TypeAlias = Annotated[Floats, 2, 2]

SLACK = 1e-6
"""Relative excess over a rim that is clamped; the residual decides."""


@entry()
def planar_rr(l1: float, l2: float, x: float, y: float, slack: float, rest: float, out: Elbows):
    """Both elbows of the planar RR arm.

    ``cos t2 = (x^2 + y^2 - l1^2 - l2^2) / (2 l1 l2)`` with its sine of either sign, and
    ``t1 = atan2(y, x) - atan2(l2 sin t2, l1 + l2 cos t2)``. A solution exists for
    ``(l1 - l2)^2 <= x^2 + y^2 <= (l1 + l2)^2``; on either rim the elbows are one.

    Link lengths are not negative; ``slack`` is the relative excess over a rim that is clamped.
    Rows t1, t2 [rad] go to ``out`` (2, 2), elbow up (t2 negative) first. Returns their number, and
    whether t1 is free, as where ``x = y = 0``: then it is at ``rest``.
    """
    if l1 <= 0.0 or l2 <= 0.0:
        return _one_link(l1, l2, x, y, slack, rest, out)
    square = x * x + y * y
    if square <= FOLDED * FOLDED * (l1 + l2) * (l1 + l2):
        return _folded(l1, l2, x, y, slack, rest, out)
    count, c2, s2 = elbow_angle(l1, l2, square, slack)
    towards, inside, t2 = atan2(y, x), atan2(l2 * s2, l1 + l2 * c2), atan2(s2, c2)
    out[0, 0], out[0, 1], out[1, 0], out[1, 1] = towards + inside, -t2, towards - inside, t2
    return count, False


def _folded(l1, l2, x, y, slack, rest, out):
    """The arm with link 2 nearly back on link 1: the point as link 1 sees it, digits kept.

    It is ``(l1 + l2 cos t2, l2 sin t2)``, the first from ``2 l1 along = l1^2 - l2^2 + |p|^2``.
    """
    distance = hypot(x, y)
    along = ((l1 - l2) * (l1 + l2) + distance * distance) / (2.0 * l1)
    gap = distance - abs(along)
    if gap < -slack * (l1 + l2):
        return 0, False
    if distance <= ON_AXIS * (l1 + l2):
        out[0, 0], out[0, 1] = rest, math.pi
        return 1, True
    root = max(root_of_gap(gap, distance, slack), 0.0) * math.sqrt(distance + abs(along))
    count = 1 if root == 0.0 else 2
    for k in range(count):
        across = -root if k == 0 else root
        out[k, 0] = atan2(y, x) - atan2(across, along)
        out[k, 1] = atan2(across, along - l1)
    return count, False


def _by_heading(l1, l2, x, y, both, out):
    """The one arm whose second link has a direction, ``both`` = t1 + t2, near the fold."""
    if l1 <= 0.0 or x * x + y * y > FOLDED * FOLDED * (l1 + l2) * (l1 + l2):
        return False
    out[0, 0] = atan2(y - l2 * sincos(both)[0], x - l2 * sincos(both)[1])
    out[0, 1] = principal(both - out[0, 0])
    return True


def _one_link(l1, l2, x, y, slack, rest, out):
    """The arm with a link of no length: a circle, and one angle free."""
    length, distance = l1 + l2, hypot(x, y)
    if abs(distance - length) > slack * length:
        return 0, False
    t = atan2(y, x)
    out[0, 0], out[0, 1] = (t, rest) if l1 > 0.0 else (rest, t - rest)
    return 1, True


class PlanarArm(NamedTuple):
    """Two or three joints with parallel axes and a slide along them, or none: a SCARA arm."""

    chain: Chain
    places: Annotated[Integers, 4]
    plane: Annotated[Floats, 2, 4, 4]
    form: Annotated[Floats, 11]
    pose: bool


@entry(solutions=2)
def solve_planar(arm: PlanarArm, Ts: Poses, within_limits: bool, outputs: Outputs):
    """Solve poses Ts (m, 4, 4), or their positions, of two or three joints with parallel axes.

    ``places`` (4,): the turning joints and the slide, -1 for none. ``plane`` (2, 4, 4): base to
    the frame on axis 1, x to axis 2; what takes the tool's pose at q = 0 back to it. ``form``
    (11,): l1, l2, angle of link 2 at q = 0 [rad], signs of axes 2 and 3, the point on the last axis
    (the tool's origin for two joints) in the tool frame [m], rest value of joint 1, sign of the
    slide, and height of the point at q = 0.
    """
    chain, places, plane, form, pose = arm
    q, residual, count, branch, free = outputs
    F, heading, work = plane[0], 0.0, work_array(q.shape[2])
    pairs, point = np.empty((2, 2)), np.empty(3)
    first, second, third, slide = places[0], places[1], places[2], places[3]
    l1, l2, lean, sign2, sign3, rest = form[0], form[1], form[2], form[3], form[4], form[8]
    mask = 1 << first | (1 << third if third >= 0 else 0)
    for i in range(Ts.shape[0]):
        T = Ts[i]
        x, y, z = applied(F, applied(T, (form[5], form[6], form[7])))
        rows, no_direction = planar_rr(l1, l2, x, y, SLACK, rest, pairs)
        if pose:
            heading = _heading(F, T, plane[1]) + lean
        if third < 0 and pose and _by_heading(l1, l2, x, y, heading, pairs):
            rows, no_direction = 1, False
        for k in range(rows):
            t1, t2 = pairs[k, 0], pairs[k, 1]
            q[i, k, first], q[i, k, second] = t1, sign2 * (t2 - lean)
            if third >= 0:
                q[i, k, third] = sign3 * (heading - t1 - t2)
            if slide >= 0:
                q[i, k, slide] = form[9] * (z - form[10])
            residual[i, k] = -1.0
            branch[i, k] = 2 if k == 1 or (rows == 1 and 0.0 < t2 < math.pi) else 0  # elbow
            free[i, k] = mask if no_direction else 0
        out = q[i], residual[i], branch[i], free[i]
        if pose:
            count[i] = finish_pose(chain, T, within_limits, *out, rows, work)
        else:
            point[0], point[1], point[2] = T[0, 3], T[1, 3], T[2, 3]
            count[i] = finish_pose(chain, point, within_limits, *out, rows, work)


def _heading(F, T, N):
    """Angle about the axes from the tool at q = 0 to T: that of ``F R N``."""
    x, y, _ = turned(F, turned(T, (N[0, 0], N[1, 0], N[2, 0])))
    return atan2(y, x)
