"""The passes of the general 6R solver: eliminate, find roots, seed, polish, collect.

Each works on the arrays of `make_work_6r`, named at its head.
"""

from __future__ import annotations

import math

import numpy as np

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
    inlined,
    null_vectors,
    second_null_vectors,
    vector_kernel,
)
from dh2urdf.kernels.loop_angles import left_frames, other_joints
from dh2urdf.kernels.newton_6r import chain_frames, newton_step, pose_error
from dh2urdf.kernels.resultant import resultants, split_pairs, two_joints

__all__ = [
    "eliminate",
    "find_roots",
    "follow",
    "inner_target",
    "isolated",
    "nudge",
    "rate_elimination",
    "simple_roots",
]

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

HOPELESS = 1e-2
"""Noise, as a part of the polynomial's largest coefficient, at which it says nothing."""

MARGIN = 1.1
"""How much wider than a span of doubt its window is."""

NARROWER = 1.0
"""Length, in quarter lengths of a window, below which a span in it is sampled in turn."""

NUDGE = 1e-3
"""Size of a nudge: tangent of half its angle, and shift in parts of the arm's size."""

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
def nudge(inner, attempt):
    """Move the target of the eliminations a little, another way at each attempt.

    At a symmetric pose every determinant may vanish identically; solutions of a pose nearby are
    as good as seeds. A turn by ``2 atan(NUDGE)`` about one skew axis and a shift along another.
    """
    t = NUDGE if attempt == 1 else -1.7 * NUDGE
    x, y, z = 0.36 * t, -0.80 * t, 0.48 * t
    f = 2.0 / (1.0 + t * t)
    for j in range(4):
        a, b, c = inner[j], inner[4 + j], inner[8 + j]
        u, v, w = a + y * c - z * b, b + z * a - x * c, c + x * b - y * a
        inner[j] = a + f * (y * w - z * v)
        inner[4 + j] = b + f * (z * u - x * w)
        inner[8 + j] = c + f * (x * v - y * u)
    inner[3] += 0.64 * t
    inner[7] += 0.48 * t
    inner[11] -= 0.60 * t


@inlined
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


@inlined
def _sample(again, k, work):
    """Bernstein coefficients from new samples, one arc a column of ``work[16]``.

    The whole circle; or, if ``again`` is 1, span of doubt k.

    Returns
    -------
    int, float, float, float
        Number of arcs, middle of the first [rad], tangent of a quarter of their length, noise;
        no arc where the polynomial says nothing.
    """
    equations, A, W, V, beta, determinant = work[7], work[9], work[10], work[11], work[12], work[13]
    series, turned, arcs, spans, hc, hs = work[14], work[15], work[16], work[20], work[31], work[32]
    middle, half_tan = 0.0, ARC_TAN
    if again == 1:
        middle = 0.5 * (spans[0, k] + spans[1, k])
        half_tan = math.tan(0.25 * min(MARGIN * (spans[1, k] - spans[0, k]), 2.0))
        window_nodes(middle, half_tan, hc, hs)
    else:
        for i in range(LANES):
            hc[i], hs[i] = CIRCLE_COS[i], CIRCLE_SIN[i]
    resultants(equations, hc, hs, hc.shape[0], A, W, determinant, V, beta)
    if again == 1:
        return 1, middle, half_tan, window_arc(determinant, half_tan, series, arcs)
    noise, largest = circle_arcs(determinant, series, turned, arcs)
    return (LANES if noise < HOPELESS * largest else 0), middle, half_tan, noise


@inlined
def find_roots(again, work):
    """Roots of the polynomial, to ``work[19]``, with slopes in ``work[21]``.

    On the whole circle; or, if ``again`` is 1, in the spans of doubt that this left in
    ``work[20]``, each sampled on its own. A span that is still in doubt and much narrower than
    the window it is found in is sampled in turn.

    Returns
    -------
    int
        Number of roots; -1 where the polynomial says nothing.
    """
    arcs, stack, scratch, roots = work[16], work[17], work[18], work[19]
    spans, slopes, fresh = work[20], work[21], work[41]
    count = np.int64(0)
    if again == 0:
        spans[0, 0] = 0.0
    k = np.int64(1)
    while k == 1 or (again == 1 and k <= spans[0, 0]):
        number, middle, half_tan, noise = _sample(again, k, work)
        if number == 0:
            return -1
        fresh[0, 0] = 0.0
        for arc in range(number):
            for i in range(TERMS):
                stack[0, i] = arcs[i, arc]
            count = roots_on_arc(
                stack, middle + arc * ARC, half_tan, noise, scratch, fresh, count, roots, slopes
            )
        last = int(spans[0, 0])
        for n in range(1, int(fresh[0, 0]) + 1):
            narrower = fresh[1, n] - fresh[0, n] < NARROWER * half_tan
            if last < SPANS and (narrower or again == 0):
                last += 1
                spans[0, last], spans[1, last] = fresh[0, n], fresh[1, n]
        spans[0, 0] = last
        k += 1
    return count


@inlined
def _seeds(count, copies, shift, reverse, turns, work):
    """All six joints at each root, in lanes; two of each in neighbouring lanes if ``copies`` is 2.

    Returns the number of lanes in use; the next ones are filled up to a multiple of eight.
    """
    loop, right, basis, equations, factors = work[2], work[5], work[6], work[7], work[8]
    A, W, V, beta, determinant = work[9], work[10], work[11], work[12], work[13]
    roots, b, second = work[19], work[22], work[23]
    c, s, cosines, sines = work[24], work[25], work[26], work[27]
    frames, functions, y = work[28], work[29], work[30]
    hc, hs, c4, s4, c5, s5 = work[31], work[32], work[33], work[34], work[35], work[36]
    lanes = count * copies
    n = (lanes + 7) // 8 * 8
    for k in range(n):
        root = roots[min(k // copies, count - 1)]
        hc[k], hs[k] = math.cos(root), math.sin(root)
    resultants(equations, hc, hs, n, A, W, determinant, V, beta)
    null_vectors(W, b, n, 2)
    if copies == 2:
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


@inlined
def _polish(links, size, lanes, damped, work):
    """Newton on the exact chain until every lane has converged or has ceased to.

    Leaves the determinant of the Jacobian, in parts of the arm's size cubed, in ``work[13]``.
    """
    target, A, J, V, beta = work[1], work[9], work[10], work[11], work[12]
    cosines, sines, frames, scale = work[26], work[27], work[28], work[13]
    error, position, angle, before = work[37], work[38], work[39], work[40]
    n = (lanes + 7) // 8 * 8
    goal = CONVERGED * max(size, 1.0)
    weight = 1.0 / size
    for k in range(lanes):
        before[k] = math.inf
    for step in range(MOST_STEPS + 1):
        chain_frames(links, cosines, sines, n, frames)
        pose_error(target, frames, n, error, position, angle)
        going = 0
        for k in range(lanes):
            now = max(position[k], angle[k])
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
        newton_step(frames, error, weight, damped, n, A, J, scale, V, beta, cosines, sines)
    for k in range(lanes):
        product = abs(scale[k])
        scale[k] = math.sqrt(product) if damped == 1 else product * weight * weight * weight


@inlined
def _place(size, k, found, out_q, out_residual, work):
    """Store lane k unless it missed the target or is known.

    Of a family of solutions only some members are kept, to leave room for the isolated ones.

    Returns
    -------
    int, int
        The number of solutions, and the index of this one; -1 if it missed.
    """
    cosines, sines, position, angle, q = work[26], work[27], work[38], work[39], work[18]
    determinant, kept = work[13], work[42]
    residual = max(position[k], angle[k])
    if not (position[k] <= TOLERANCE * min(size, 1.0) and angle[k] <= TOLERANCE):
        return found, -1
    for i in range(6):
        q[i] = math.atan2(sines[i * LANES + k], cosines[i * LANES + k])
    place, singular, members = found, -1, 0
    for f in range(found):
        far = 0.0
        for i in range(6):
            d = abs(q[i] - out_q[f, i])
            far = max(far, min(d, 2.0 * math.pi - d))
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
    for i in range(6):
        out_q[place, i] = q[i]
    return max(found, place + 1), place


@inlined
def follow(links, size, count, found, shift, reverse, turns, out_q, out_residual, work):
    """Append the solutions that a list of roots leads to.

    A double root, a root that leads nowhere and one that leads where another went are taken for
    two solutions with the same value of the hidden joint, and tried again as such.

    Returns
    -------
    int, int
        The number of solutions, and how many roots had to be tried again.
    """
    roots, slopes, seen = work[19], work[21], work[40]
    again = np.int64(0)
    for copies in range(1, 3):
        _seeds(count, copies, shift, reverse, turns, work)
        _polish(links, size, count * copies, copies - 1, work)
        for f in range(LANES):
            seen[f] = 0.0
        for lane in range(count * copies):
            found, place = _place(size, lane, found, out_q, out_residual, work)
            if copies == 1:
                if place < 0 or seen[place] > 0.0 or slopes[lane] == 0.0:
                    roots[again] = roots[lane]
                    again += 1
                if place >= 0:
                    seen[place] = 1.0
        count = min(again, LANES // 2)
        if count == 0:
            break
    return found, again


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
        count = find_roots(np.int64(0), work)
        if count <= 0:
            continue
        n = _seeds(count, np.int64(1), shift, reverse, turns, work)
        chain_frames(links, cosines, sines, n, frames)
        pose_error(target, frames, n, error, position, angle)
        worst = 1e-16
        for k in range(n):
            worst = max(worst, position[k] / size, angle[k])
        rating[m] = min(math.log10(worst) + min(work[20][0, 0], DEAREST), 0.0)


@vector_kernel
def isolated(found, kept):
    """Whether none of the solutions is singular, by the determinants of their Jacobians."""
    for f in range(found):
        if kept[f] < SINGULAR:
            return False
    return True


@vector_kernel
def simple_roots(count, slopes):
    """How many of the roots are simple."""
    simple = 0
    for r in range(count):
        if slopes[r] > 0.0:
            simple += 1
    return simple
