"""The passes of the general 6R solver: eliminate, find roots, seed, polish, collect.

Each works on the arrays of `make_work_6r`, named at its head.
"""

from __future__ import annotations

import math

from dh2urdf.kernels.arc_roots import (
    ARC,
    ARC_TAN,
    CIRCLE_COS,
    CIRCLE_SIN,
    SPANS,
    TERMS,
    circle_arcs,
    roots_on_arc,
    window_arc,
    window_nodes,
)
from dh2urdf.kernels.elimination import (
    close_loop,
    left_coefficients,
    reduce_right,
    right_coefficients,
    six_equations,
)
from dh2urdf.kernels.general_6r_work import make_work_6r
from dh2urdf.kernels.lanes import (
    LANES,
    MASK,
    null_vectors,
    second_null_vectors,
    vector_kernel,
)
from dh2urdf.kernels.loop_angles import left_frames, other_joints
from dh2urdf.kernels.newton_6r import chain_frames, newton_step, pose_error
from dh2urdf.kernels.resultant import resultants, split_pairs, two_joints

__all__ = [
    "circle_roots",
    "eliminate",
    "follow",
    "inner_target",
    "rate_elimination",
    "simple_roots",
    "span_roots",
]

TOLERANCE = 1e-9
"""Largest accepted residual: position [m] (of an arm of a metre or more), orientation [rad]."""

CONVERGED = 2e-15
"""Error at which a lane is not polished further, relative to the arm's size."""

MOST_STEPS = 14
SAME = 1e-6
"""Solutions closer than this [rad] are one."""

HOPELESS = 1e-2
"""Noise, as a part of the polynomial's largest coefficient, at which it says nothing."""

MARGIN = 1.1
"""How much wider than a span of doubt its window is."""

NARROWER = 0.5
"""Length, in half lengths of a window, below which a span in it is sampled in turn."""

DEAREST = 6.0
"""Most digits that spans of doubt count for."""


@vector_kernel
def inner_target(base_inverse, tool_inverse, size, T, target, inner):
    """The target as (12,), and seen from the frame before joint 1 to that after joint 6."""
    for i in range(3):
        for j in range(4):
            target[4 * i + j] = T[i, j]
    for i in range(3):
        b0, b1, b2 = base_inverse[i, 0], base_inverse[i, 1], base_inverse[i, 2]
        x0 = b0 * T[0, 0] + b1 * T[1, 0] + b2 * T[2, 0]
        x1 = b0 * T[0, 1] + b1 * T[1, 1] + b2 * T[2, 1]
        x2 = b0 * T[0, 2] + b1 * T[1, 2] + b2 * T[2, 2]
        x3 = b0 * T[0, 3] + b1 * T[1, 3] + b2 * T[2, 3] + base_inverse[i, 3]
        for j in range(4):
            t = x0 * tool_inverse[0, j] + x1 * tool_inverse[1, j] + x2 * tool_inverse[2, j]
            inner[4 * i + j] = (t + x3) / size if j == 3 else t


@vector_kernel
def eliminate(chain, shift, reverse, left, work):
    """The six equations of one elimination."""
    inner, loop, samples, own_left = work[0], work[2], work[3], work[4]
    right, basis, equations, factors = work[5], work[6], work[7], work[8]
    close_loop(chain, inner, shift, reverse, loop)
    right_coefficients(loop, samples, right)
    reduce_right(right, factors, basis)
    if 2 <= (5 - shift) % 6 <= 4:
        left_coefficients(loop, samples, own_left)
        six_equations(right, basis, own_left, equations)
    else:
        six_equations(right, basis, left, equations)


@vector_kernel
def circle_roots(work):
    """Number of roots on the whole circle; -1 where the polynomial says nothing."""
    equations, A, W, V, beta, determinant = work[7], work[9], work[10], work[11], work[12], work[13]
    series, turned, arcs, stack, scratch = work[14], work[15], work[16], work[17], work[18]
    roots, spans, slopes = work[19], work[20], work[21]
    resultants(equations, CIRCLE_COS, CIRCLE_SIN, LANES, A, W, determinant, V, beta)
    noise, largest = circle_arcs(determinant, series, turned, arcs)
    if not noise < HOPELESS * largest:
        return -1
    count = 0
    spans[0, 0] = 0.0
    for k in range(LANES):
        for i in range(TERMS):
            stack[0, i] = arcs[i, k]
        count = roots_on_arc(stack, k * ARC, ARC_TAN, noise, scratch, spans, count, roots, slopes)
    return count


@vector_kernel
def span_roots(work):
    """Number of roots in the spans of doubt, each sampled on its own.

    A span much narrower than the window it is found in is sampled in turn.
    """
    equations, A, W, V, beta, determinant = work[7], work[9], work[10], work[11], work[12], work[13]
    series, stack, scratch, fresh = work[14], work[17], work[18], work[41]
    roots, spans, slopes, hc, hs = work[19], work[20], work[21], work[31], work[32]
    count, k = 0, 1
    while k <= spans[0, 0]:
        centre = 0.5 * (spans[0, k] + spans[1, k])
        half = 0.5 * (spans[1, k] - spans[0, k])
        half_tan = math.tan(0.5 * min(MARGIN * half, 1.0))
        window_nodes(centre, half_tan, hc, hs)
        resultants(equations, hc, hs, LANES, A, W, determinant, V, beta)
        noise = window_arc(determinant, half_tan, series)
        for i in range(TERMS):
            stack[0, i] = series[i]
        fresh[0, 0] = 0.0
        count = roots_on_arc(stack, centre, half_tan, noise, scratch, fresh, count, roots, slopes)
        last = int(spans[0, 0])
        for n in range(1, int(fresh[0, 0]) + 1):
            if fresh[1, n] - fresh[0, n] < NARROWER * half and last < SPANS:
                last += 1
                spans[0, last], spans[1, last] = fresh[0, n], fresh[1, n]
        spans[0, 0] = last
        k += 1
    return count


@vector_kernel
def _seeds(count, paired, shift, reverse, turns, work):
    """All six joints at each root, in lanes; twice in neighbouring lanes if paired.

    Returns the number of lanes in use; the next ones are filled up to a multiple of eight.
    """
    loop, right, basis, equations, factors = work[2], work[5], work[6], work[7], work[8]
    A, W, V, beta, determinant = work[9], work[10], work[11], work[12], work[13]
    roots, b, second = work[19], work[22], work[23]
    c, s, cosines, sines = work[24], work[25], work[26], work[27]
    frames, functions, y = work[28], work[29], work[30]
    hc, hs, c4, s4, c5, s5 = work[31], work[32], work[33], work[34], work[35], work[36]
    lanes = min(2 * count, LANES) if paired else count
    n = (lanes + 7) // 8 * 8
    for k in range(n):
        root = roots[min(k // 2 if paired else k, count - 1)]
        hc[k], hs[k] = math.cos(root), math.sin(root)
    resultants(equations, hc, hs, n, A, W, determinant, V, beta)
    null_vectors(W, b, n, 2)
    if paired:
        second_null_vectors(W, b, n, 2, second)
        split_pairs(b, second, n)
    two_joints(b, n, c4, s4, c5, s5)
    for k in range(n):
        c[2 * LANES + k], s[2 * LANES + k] = hc[k], hs[k]
        c[3 * LANES + k], s[3 * LANES + k] = c4[k], s4[k]
        c[4 * LANES + k], s[4 * LANES + k] = c5[k], s5[k]
    left_frames(loop, c, s, n, frames)
    other_joints(loop, right, factors, basis, frames, n, c, s, functions, y)
    for i in range(6):
        joint = (shift + i) % 6 if reverse == 0 else (11 - shift - i) % 6
        sign = 1.0 if reverse == 0 else -1.0
        p = (i * LANES) & MASK
        o = (joint * LANES) & MASK
        tc, ts = turns[0, joint], turns[1, joint]
        for k in range(n):
            x, z = c[p + k], sign * s[p + k]
            cosines[o + k] = x * tc - z * ts
            sines[o + k] = z * tc + x * ts
    return lanes


@vector_kernel
def _polish(links, size, lanes, work):
    """Newton on the exact chain until every lane has converged or has ceased to."""
    target, A, V, beta, scale = work[1], work[9], work[11], work[12], work[13]
    cosines, sines, frames = work[26], work[27], work[28]
    error, position, angle, before = work[37], work[38], work[39], work[40]
    n = (lanes + 7) // 8 * 8
    goal = CONVERGED * max(size, 1.0)
    for k in range(lanes):
        before[k] = math.inf
    for step in range(MOST_STEPS + 1):
        chain_frames(links, cosines, sines, n, frames)
        pose_error(target, frames, n, error, position, angle)
        open_lanes = 0
        for k in range(lanes):
            now = max(position[k], angle[k])
            if now > goal and (step < 5 or now < 0.5 * before[k]):
                open_lanes += 1
            before[k] = now
        if open_lanes == 0 or step == MOST_STEPS:
            break
        newton_step(frames, error, n, A, scale, V, beta, cosines, sines)


@vector_kernel
def _place(size, k, found, out_q, out_residual, work):
    """Store lane k unless it missed the target or is known.

    Returns
    -------
    int, int
        The number of solutions, and the index of this one; -1 if it missed.
    """
    cosines, sines, position, angle, q = work[26], work[27], work[38], work[39], work[8]
    residual = max(position[k], angle[k])
    if not (position[k] <= TOLERANCE * min(size, 1.0) and angle[k] <= TOLERANCE):
        return found, -1
    for i in range(6):
        q[i] = math.atan2(sines[i * LANES + k], cosines[i * LANES + k])
    near = max(SAME, 10.0 * math.sqrt(residual))
    place = found
    for f in range(found):
        far = 0.0
        for i in range(6):
            d = abs(q[i] - out_q[f, i])
            far = max(far, min(d, 2.0 * math.pi - d))
        if far < near:
            place = f
            break
    if place == out_q.shape[0]:
        return found, -1
    if place == found or residual < out_residual[place]:
        out_residual[place] = residual
        for i in range(6):
            out_q[place, i] = q[i]
    return max(found, place + 1), place


@vector_kernel
def follow(links, size, count, found, shift, reverse, turns, out_q, out_residual, work):
    """Append the solutions that a list of roots leads to.

    A double root, a root that leads nowhere and one that leads where another went are taken for
    two solutions with the same value of the hidden joint, and tried again as such.

    Returns
    -------
    int, int
        The number of solutions, and the number of roots that stay in doubt: they did not lead to
        two different ones.
    """
    roots, slopes, seen = work[19], work[21], work[40]
    if count == 0:
        return found, 0
    lanes = _seeds(count, False, shift, reverse, turns, work)
    _polish(links, size, lanes, work)
    for f in range(LANES):
        seen[f] = 0.0
    left = 0
    for k in range(lanes):
        found, place = _place(size, k, found, out_q, out_residual, work)
        if place < 0 or seen[place] > 0.0 or slopes[k] == 0.0:
            roots[left] = roots[k]
            left += 1
        if place >= 0:
            seen[place] = 1.0
    if left == 0:
        return found, 0
    left = min(left, LANES // 2)
    _seeds(left, True, shift, reverse, turns, work)
    _polish(links, size, 2 * left, work)
    doubt = 0
    for k in range(left):
        found, one = _place(size, 2 * k, found, out_q, out_residual, work)
        found, other = _place(size, 2 * k + 1, found, out_q, out_residual, work)
        if one < 0 or other < 0 or one == other:
            doubt += 1
    return found, doubt


@vector_kernel
def rate_elimination(
    links, chain, base_inverse, tool_inverse, size, turns, shift, reverse, left, Ts, rating
):
    """Decimal logarithm of the worst unpolished error of each pose's seeds; 0 where it fails.

    Every span of doubt, which takes time, counts as one digit lost.

    Ts (m, 4, 4), reachable; rating (m,), out.
    """
    work = make_work_6r()
    target = work[1]
    cosines, sines, frames = work[26], work[27], work[28]
    error, position, angle = work[37], work[38], work[39]
    for m in range(Ts.shape[0]):
        rating[m] = 0.0
        inner_target(base_inverse, tool_inverse, size, Ts[m], target, work[0])
        eliminate(chain, shift, reverse, left, work)
        count = circle_roots(work)
        if count <= 0:
            continue
        lanes = _seeds(count, False, shift, reverse, turns, work)
        chain_frames(links, cosines, sines, LANES, frames)
        pose_error(target, frames, LANES, error, position, angle)
        worst = 1e-16
        for k in range(lanes):
            worst = max(worst, position[k] / size, angle[k])
        rating[m] = min(math.log10(worst) + min(work[20][0, 0], DEAREST), 0.0)


@vector_kernel
def simple_roots(count, slopes):
    """How many of the roots are simple."""
    simple = 0
    for r in range(count):
        if slopes[r] > 0.0:
            simple += 1
    return simple
