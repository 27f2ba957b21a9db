"""Three joints slide: the turning ones, two or three, follow from the orientation alone.

``R_0 Rz(q_i) R_1 Rz(q_j) R_2 Rz(q_k) R_3 = R``; then ``sum z_s q_s = p - p(0)``, three linear
equations, gives the slides.
"""

import math
from typing import Annotated, NamedTuple

import numpy as np

from dh2urdf.kernels.certificate import finish_families, finish_pose
from dh2urdf.kernels.newton import (
    POLISH,
    POSE,
    add_transposed,
    error_and_jacobian,
    make_damped,
    solve_damped,
    work_array,
)
from dh2urdf.kernels.numbers import atan2, entry, linear_trig
from dh2urdf.kernels.rigid import (
    cross,
    dot,
    invert_pose,
    joint_times_link,
    load_pose,
    store_pose,
    times_link,
)
from dh2urdf.kernels.shapes import Chain, Floats, Outputs, Poses

IN_PLANE = 1e-12
"""Volume spanned by the slides' directions below which they lie in a plane, but for rounding: then
they move as little as possible."""

DAMPING = 1e-10
"""Added to their normal equations there."""

STEPS = 4
"""Most steps of the slides; the second mends what rounding of the first left over."""

SLACK = 1e-6
"""Relative excess over a rim that is clamped; the residual decides."""

IN_LINE = 1e-10
"""Sine of the middle angle at which only the sum or difference of the outer two is known."""

SINGULAR = 1e-4
"""Such a sine, and half the difference of two middle angles [rad], and the volume of the slides'
directions, below which there may be more solutions, or families of them."""

FAR = 100.0
"""How much farther slides are out than the way that they are to bridge where such a volume only
says that one of a pair is far out."""

ROWS = 20
"""Rows of scratch: four links and the middle rotation, 4 x 4."""


def _turning_links(chain, turning, scratch):
    """Products of the links between the turning joints, to rows of scratch; how many turn."""
    (links, joints), count = chain, 0
    r = load_pose(links[0])
    for i in range(joints.shape[0]):
        if joints[i, 0] == 0.0:
            store_pose(r, scratch[4 * count : 4 * count + 4])
            turning[count] = i
            count += 1
            r = load_pose(links[i + 1])
        else:
            r = joint_times_link(r, False, 0.0, links[i + 1])
    store_pose(r, scratch[4 * count : 4 * count + 4])
    return count


def _sine(M):
    """Square of the sine between the axes before and after M."""
    return M[0, 2] * M[0, 2] + M[1, 2] * M[1, 2]


def _outer(M, B):
    """Angles x, y with ``Rz(x) M Rz(y) = B``; x = 0 where M only turns about z."""
    across = _sine(M)
    if across <= IN_LINE * IN_LINE:
        c = M[0, 0] * B[0, 0] + M[1, 0] * B[1, 0]
        s = M[0, 1] * B[0, 0] + M[1, 1] * B[1, 0]
        return 0.0, atan2(s, c)
    x = atan2(B[1, 2] * M[0, 2] - B[0, 2] * M[1, 2], B[0, 2] * M[0, 2] + B[1, 2] * M[1, 2])
    y = atan2(M[2, 1] * B[2, 0] - M[2, 0] * B[2, 1], M[2, 0] * B[2, 0] + M[2, 1] * B[2, 1])
    return x, y


def _candidates(chain, T, q, turning, scratch, damped):
    """Candidate configurations of a pose, at most two, in the first rows of q.

    Returned are how many, and whether one is singular or nearly so. ``turning`` (3,), ``scratch``
    (ROWS, 4) and ``damped`` are scratch.
    """
    count, least = _turning_links(chain, turning, scratch), SINGULAR * SINGULAR
    B, M = scratch[16:20], scratch[12:16]
    found, doubt = 1, False
    q[:] = 0.0
    # B = R_0^T R R_last^T
    invert_pose(scratch[4 * count : 4 * count + 4], B)
    invert_pose(scratch[0:4], M)
    store_pose(times_link(times_link(load_pose(M), T), B), B)
    if count == 2:
        q[0, turning[0]], q[0, turning[1]] = _outer(scratch[4:8], B)
    else:
        first, second = scratch[4:8], scratch[8:12]
        a = first[2, 0] * second[0, 2] + first[2, 1] * second[1, 2]
        b = first[2, 1] * second[0, 2] - first[2, 0] * second[1, 2]
        d = B[2, 2] - first[2, 2] * second[2, 2]
        found, c1, s1, c2, s2 = linear_trig(a, b, d, SLACK)
        square = a * a + b * b
        doubt = square - d * d < least * square
        for k in range(found):
            c, s = (c1, s1) if k == 0 else (c2, s2)
            q[k, turning[1]] = atan2(s, c)
            store_pose(joint_times_link(load_pose(first), False, q[k, turning[1]], second), M)
            q[k, turning[0]], q[k, turning[2]] = _outer(M, B)
            doubt = doubt or _sine(M) < least
    for k in range(found):
        doubt = _place(chain, T, q[k], damped) or doubt
    return max(found, 0), doubt and found > 0


def _slides(joints, J):
    """The joints that slide, and their directions (3 rows of J)."""
    i = 0
    while joints[i, 0] == 0.0:
        i += 1
    j = i + 1
    while joints[j, 0] == 0.0:
        j += 1
    k = j + 1
    while joints[k, 0] == 0.0:
        k += 1
    x, y, z = J[i], J[j], J[k]
    ways = (x[0], x[1], x[2]), (y[0], y[1], y[2]), (z[0], z[1], z[2])
    return i, j, k, *ways


def _place(chain, T, q, damped):
    """Solve the three equations of the slides of q (n,) in place, the turns being known.

    Returned is whether the slides are nearly in a plane, and not far out.
    """
    joints, (J, work), flat = chain[1], damped, False
    for step in range(STEPS):
        residual = error_and_jacobian(chain, (POSE, T, 1.0), q, damped)
        i, j, k, x, y, z = _slides(joints, J)
        error, normal = (work[0, 6], work[1, 6], work[2, 6]), cross(y, z)
        volume = dot(x, normal)
        if step == 0 and abs(volume) < SINGULAR:
            far = FAR * abs(volume) * math.sqrt(dot(error, error))
            flat = abs(dot(error, normal)) <= far + abs(volume)
        if residual <= POLISH:
            break
        if abs(volume) > IN_PLANE:
            q[i] += dot(error, normal) / volume
            q[j] += dot(error, cross(z, x)) / volume
            q[k] += dot(error, cross(x, y)) / volume
        else:
            for joint in range(q.shape[0]):
                J[joint] *= joints[joint, 0]
            solve_damped(damped, DAMPING)
            add_transposed(damped, 1.0, q)
    return flat


class SlidingArm(NamedTuple):
    """Three joints that slide and two or three that turn; where a free joint rests."""

    chain: Chain
    rest: Annotated[Floats, "n"]


@entry(solutions=8)
def solve_three_slides(arm: SlidingArm, Ts: Poses, within_limits: bool, outputs: Outputs):
    """Solve poses Ts (m, 4, 4) of a chain of three sliding and two or three turning joints.

    Of a family the member stays whose first free joint is at its value in ``rest`` (n,). The count
    of a pose that is singular or nearly so is -1 minus that of its solutions; returned is how many
    are.
    """
    chain, rest = arm
    q, residual, count, branch, free = outputs
    n = rest.shape[0]
    work, damped, trial = work_array(n), make_damped(n), np.empty((2, n))
    turning, scratch, doubts = np.empty(3, np.int64), np.empty((ROWS, 4)), 0
    for i in range(Ts.shape[0]):
        T, rows = Ts[i], (q[i], residual[i], branch[i], free[i])
        found, doubt = _candidates(chain, T, q[i], turning, scratch, damped)
        for k in range(found):
            residual[i, k], branch[i, k], free[i, k] = -1.0, -1, 0
        found = finish_pose(chain, T, False, *rows, found, work)
        count[i], _ = finish_families(chain, T, rest, within_limits, rows, found, trial, work)
        if doubt:
            count[i] = -1 - count[i]
            doubts += 1
    return doubts
