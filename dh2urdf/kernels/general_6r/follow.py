"""From roots to solutions: seeds, Newton on the exact chain, a list without doubles."""

import math

from dh2urdf.kernels.general_6r.elimination import joint_of
from dh2urdf.kernels.general_6r.joints_of_slides import joints_of_two_slides
from dh2urdf.kernels.general_6r.listing import at_root, list_solution
from dh2urdf.kernels.general_6r.resultant import (
    as_length,
    other_joints,
    sample_resultants,
    split_pairs,
    two_joints,
)
from dh2urdf.kernels.general_6r.two_slides import sample_two_slides
from dh2urdf.kernels.newton import chain_frames, newton_step, pose_error
from dh2urdf.kernels.numbers import LANES, atan2, null_vectors, side_by_side, sincos

TOLERANCE = 1e-9
"""Largest accepted residual: position [m] (of an arm of a metre or more), orientation [rad]."""

CONVERGED = 2e-15
"""Error at which a lane is not polished further, relative to the arm's size."""

MOST_STEPS = 40
DAMPED_STEPS = 12
"""Damped steps before undamped ones: those are safer, these more precise."""


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

    Leaves the errors of the seeds, lengths in parts of the arm's size, in ``seeded``, the
    determinant of the Jacobian, in parts of the size cubed, in ``determinant``, and the joints'
    values in ``error``.
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
    for i in range(6):
        q = i * LANES
        if slides[i] != 0:
            for k in side_by_side(n):
                error[q + k] = sines[q + k]
            continue
        for k in side_by_side(n):
            error[q + k] = atan2(sines[q + k], cosines[q + k])


def keep_lane(k, found, out_q, out_residual, arm):
    """List what lane k has come to, unless it missed the target; as by `list_solution`."""
    size, q, position, angle = arm["size"], arm["q"], arm["position"], arm["angle"]
    if not (position[k] <= TOLERANCE * min(size, 1.0) and angle[k] <= TOLERANCE):
        return found, -1
    for i in range(6):
        q[i] = arm["error"][i * LANES + k]
    residual = max(position[k], angle[k])
    return list_solution(found, out_q, out_residual, residual, arm["determinant"][k], arm)


def _hidden_value(e, q, arm):
    """The hidden joint's value in the loop of elimination e at a solution q (6,)."""
    joint = joint_of(arm["choices"], e, 2)
    value = q[joint] - arm["turns"][2, joint]
    if arm["slides"][joint] != 0:
        value = 2.0 * atan2(value, arm["reach"] * arm["size"])
    return value if arm["choices"][e, 1] == 0 else -value


def follow(e, count, found, out_q, out_residual, arm):
    """Append the solutions that a list of roots leads to.

    A double root, and one that leads nowhere, to another value of the hidden joint or where another
    root went, are taken for two solutions with the same value of it, and tried again as such.
    The hidden joint's values at all solutions are left in ``hidden_values``. Returns the number of
    solutions, how many roots had to be tried again, and the largest error of the seeds that stood:
    roots with more than two solutions, or none, have no exact ones.
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
            led = led and at_root(roots[lane], _hidden_value(e, out_q[place], arm))
            if copies == 2 or led:
                error = arm["seeded"][lane]
                worst = max(worst, error) if error < math.inf else math.inf
            else:
                doubles[again] = roots[lane]
                again += 1
            if place >= 0:
                seen[place] = 1.0
        count = min(again, LANES // 2)
        if count == 0:
            break
    for k in range(found):
        arm["hidden_values"][k] = _hidden_value(e, out_q[k], arm)
    return found, again, worst
