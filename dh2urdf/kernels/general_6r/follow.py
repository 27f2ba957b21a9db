"""From roots to solutions: seeds, Newton on the exact chain, a list without doubles."""

import math

import numpy as np

from dh2urdf.kernels.certificate import TWO_PI
from dh2urdf.kernels.general_6r.elimination import joint_of
from dh2urdf.kernels.general_6r.resultant import (
    as_length,
    other_joints,
    sample_resultants,
    split_pairs,
    two_joints,
)
from dh2urdf.kernels.general_6r.two_slides import joints_of_two_slides, sample_two_slides
from dh2urdf.kernels.newton import chain_frames, newton_step, pose_error
from dh2urdf.kernels.numbers import LANES, atan2, null_vectors, side_by_side, sincos

TOLERANCE = 1e-9
"""Largest accepted residual: position [m] (of an arm of a metre or more), orientation [rad]."""

CONVERGED = 2e-15
"""Error at which a lane is not polished further, relative to the arm's size."""

MOST_STEPS = 40
DAMPED_STEPS = 12
"""Damped steps before undamped ones: those are safer, these more precise."""

SAME = 1e-6
"""Solutions closer than this [rad] are one."""

SHARP = 1e-13
"""Residual above which a solution has not converged: it lies beside a double one."""

VALLEY = 100.0
"""Distance [rad] to the double solution, in square roots of such a residual."""

SINGULAR = 1e-6
"""Determinant of the Jacobian, in parts of size cubed, below which a solution is singular."""

MEMBERS = 8
"""Most singular solutions kept."""

AT_ROOT = 1e-4
"""Angle [rad] between a root and the hidden joint's value at a solution of it: double roots are
known to 1e-8 at best, to the root of that where four solutions nearly meet."""


def _from_null_vectors(n, copies, arm):
    """All six joints of the loop at each value of the hidden one, or every other one, in lanes."""
    loop, right, basis, factors = arm["loop"], arm["right"], arm["basis"], arm["factors"]
    W, b, second, frames = arm["W"], arm["null"], arm["second"], arm["frames"]
    c, s, slides, reach = arm["loop_cosines"], arm["loop_sines"], arm["loop_slides"], arm["reach"]
    sample_resultants(n, arm)
    for copy in range(copies):
        null_vectors(W, b, second if copy > 0 else b, copy == 0, n)
    if copies == 2:
        split_pairs(b, second, n)
    two_joints(b, n, c, s)
    for i in range(2, 5):
        if slides[i] != 0:
            as_length(reach, i, n, c, s)
    functions, pairs = arm["functions"], arm["pairs"]
    other_joints(loop, slides, reach, right, factors, basis, frames, n, c, s, functions, pairs)


def _seeds(e, roots, slopes, count, copies, arm):
    """All six joints at each root, in lanes; two of each in neighbouring lanes if ``copies`` is 2.

    Returns the number of lanes in use; the next ones are filled up to a multiple of eight.
    """
    turns, hidden = arm["turns"], arm["hidden"]
    c, s, cosines, sines = arm["loop_cosines"], arm["loop_sines"], arm["cosines"], arm["sines"]
    slides = arm["loop_slides"]
    sign = 1.0 if arm["choices"][e, 1] == 0 else -1.0
    lanes = count * copies
    n = (lanes + 7) // 8 * 8
    for k in side_by_side(n):
        root = roots[min(k // copies, count - 1)]
        hidden[0, k], hidden[1, k] = sincos(root)[1], sincos(root)[0]
        c[2 * LANES + k], s[2 * LANES + k] = hidden[0, k], hidden[1, k]
    if arm["two_slides"] == 0:
        _from_null_vectors(n, copies, arm)
    else:
        sample_two_slides(n, arm)
        joints_of_two_slides(n, copies, slopes, arm)
    for i in range(6):
        joint = joint_of(arm["choices"], e, i)
        p = i * LANES
        o = joint * LANES
        tc, ts = turns[0, joint], turns[1, joint]
        if slides[i] != 0:
            for k in side_by_side(n):
                cosines[o + k], sines[o + k] = 1.0, turns[2, joint] + sign * arm["size"] * s[p + k]
            continue
        for k in side_by_side(n):
            x, z = c[p + k], sign * s[p + k]
            cosines[o + k] = x * tc - z * ts
            sines[o + k] = z * tc + x * ts
    return lanes


def polish_lanes(lanes, damped, converged, arm):
    """Newton on the exact chain until every lane has converged or has ceased to.

    Converged: to an error of that size, relative to the arm's.

    Leaves the errors of the seeds, lengths in parts of the arm's size, in ``seeded``, and the
    determinant of the Jacobian, in parts of the size cubed, in ``determinant``.
    """
    target, A, J, V, beta = arm["target"], arm["A"], arm["W"], arm["V"], arm["beta"]
    cosines, sines, frames = arm["cosines"], arm["sines"], arm["frames"]
    links, size, scale, seeded = arm["links"], arm["size"], arm["determinant"], arm["seeded"]
    slides = arm["slides"]
    error, position, angle, before = arm["error"], arm["position"], arm["angle"], arm["before"]
    n = (lanes + 7) // 8 * 8
    goal = converged * max(size, 1.0)
    weight = 1.0 / size
    before[:lanes] = math.inf
    for step in range(MOST_STEPS + 1):
        chain_frames(links, slides, cosines, sines, n, frames)
        pose_error(target, frames, n, error, position, angle)
        going = 0
        for k in range(lanes):
            now = max(position[k], angle[k])
            if step == 0:
                seeded[k] = max(position[k] * weight, angle[k])
            if now <= goal:
                for i in range(6):
                    error[i * LANES + k] = 0.0
            elif step < 6 or step == DAMPED_STEPS or now < 0.7 * before[k]:
                going += 1
            before[k] = now
        if (going == 0 and step > 0) or step == MOST_STEPS:
            break
        if step == DAMPED_STEPS:
            damped = 0
        newton_step(frames, slides, error, size, damped, n, A, J, scale, V, beta, cosines, sines)
    for k in range(lanes):
        product = abs(scale[k])
        scale[k] = math.sqrt(product) if damped == 1 else product * weight * weight * weight


def keep_lane(k, found, out_q, out_residual, arm):
    """Store lane k unless it missed the target or is known.

    Of a family of solutions only some members are kept, to leave room for the isolated ones.
    Returns the number of solutions, and the index of this one; -1 if it missed.
    """
    cosines, sines, position, angle = arm["cosines"], arm["sines"], arm["position"], arm["angle"]
    size, q, determinant, kept = arm["size"], arm["q"], arm["determinant"], arm["kept"]
    slides = arm["slides"]
    residual = max(position[k], angle[k])
    if not (position[k] <= TOLERANCE * min(size, 1.0) and angle[k] <= TOLERANCE):
        return found, -1
    for i in range(6):
        sine = sines[i * LANES + k]
        q[i] = atan2(sine, cosines[i * LANES + k]) if slides[i] == 0 else sine
    place, singular, members = found, -1, 0
    for f in range(found):
        far = 0.0
        for i in range(6):
            d = abs(q[i] - out_q[f, i])
            far = max(far, min(d, TWO_PI - d) if slides[i] == 0 else d / size)
        loose = max(residual, out_residual[f])
        if far < (SAME if loose < SHARP else VALLEY * math.sqrt(loose)):
            place = f
            break
        if kept[f] < SINGULAR:
            singular = f
            members += 1
    if place == found:
        if determinant[k] < SINGULAR and members >= MEMBERS:
            return found, singular
        if found == out_q.shape[0]:
            if singular < 0:
                return found, -1
            place = singular
    elif residual >= out_residual[place]:
        return found, place
    out_residual[place], kept[place] = residual, determinant[k]
    out_q[place] = q
    return max(found, place + 1), place


def _at_root(e, root, q, arm):
    """Whether the hidden joint of elimination e has the value of a root at a solution q (6,)."""
    reverse, joint = arm["choices"][e, 1] != 0, joint_of(arm["choices"], e, 2)
    value = q[joint] - arm["turns"][2, joint]
    if arm["slides"][joint] != 0:
        value = 2.0 * atan2(value, arm["reach"] * arm["size"])
    gap = (value + root if reverse else value - root) / TWO_PI
    return abs(gap - np.floor(gap + 0.5)) < AT_ROOT / TWO_PI


def follow(e, count, found, out_q, out_residual, arm):
    """Append the solutions that a list of roots leads to.

    A double root, and one that leads nowhere, to another value of the hidden joint or where another
    root went, are taken for two solutions with the same value of it, and tried again as such.
    Returns the number of solutions, how many roots had to be tried again, and the largest error of
    the seeds that stood: roots with more than two solutions, or none, have no exact ones.
    """
    roots, slopes, seen, doubles = arm["roots"], arm["slopes"], arm["seen"], arm["doubles"]
    again, worst = 0, 0.0
    for copies in range(1, 3):
        lanes = _seeds(e, roots if copies == 1 else doubles, slopes, count, copies, arm)
        polish_lanes(lanes, copies - 1, CONVERGED, arm)
        seen[:] = 0.0
        for lane in range(lanes):
            found, place = keep_lane(lane, found, out_q, out_residual, arm)
            led = place >= 0 and seen[place] == 0.0 and slopes[lane] > 0.0
            if copies == 2 or (led and _at_root(e, roots[lane], out_q[place], arm)):
                worst = max(worst, arm["seeded"][lane])
            else:
                doubles[again] = roots[lane]
                again += 1
            if place >= 0:
                seen[place] = 1.0
        count = min(again, LANES // 2)
        if count == 0:
            break
    return found, again, worst


def accounted(e, count, found, out_q, arm):
    """Whether every root has as many solutions with its value as it has multiplicity.

    Those that did not have to be tried again do. A complex pair next to the real axis counts as a
    double root only where it has a solution.
    """
    roots, slopes = arm["roots"], arm["slopes"]
    for r in range(count):
        here, there = 0, 0
        for t in range(count):
            if abs(roots[t] - roots[r]) < AT_ROOT:
                here += 1 if slopes[t] > 0.0 else 2
        for f in range(found):
            if _at_root(e, roots[r], out_q[f], arm):
                there += 1
        if there < here and (there > 0 or slopes[r] != 0.0):
            return False
    return True


def how_many_below(values, count, least):
    """How many of the first values are below the least."""
    below = 0
    for k in range(count):
        below += 1 if values[k] < least else 0
    return below
