"""A joint path of a chain with one joint to spare, made shorter while every pose is kept.

At each pose the solution q_i may move along its self-motion, ``q_i(x) = q_i + x t_i + x^2 k_i / 2``
with unit tangent t and curvature k. The length ``sum |q_i - q_(i-1)|`` is a function of the x whose
Hessian is tridiagonal, as each x is in two steps only: Newton's method costs a few operations a
pose. Joints at a limit stop their pose (projected Newton, Bertsekas 1982).
"""

from __future__ import annotations

import math

import numpy as np

from dh2urdf.kernels.compiled import inner_kernel, kernel
from dh2urdf.kernels.damped import POSE, make_damped, restore
from dh2urdf.kernels.path_states import step_length
from dh2urdf.kernels.self_motion import HELD, LONGEST, _excess, _tangent

__all__ = ["shorten"]

ROUNDS = 100
"""Newton steps; five to thirty are usual."""

ENOUGH = 1e-7
"""Relative gain of a Newton step at which the path is as short as it gets."""

KINK = 1e-7
"""Length [rad or m] below which a step counts as smooth: that of a repeated pose is zero."""

FLAT = 1e-9
"""Pivot, relative to its entry of the Hessian, that counts as zero."""

LEAST = 1e-6
"""Added to a Hessian [1/rad] that is not positive, so that it is."""

NEAREST = 1e-6
"""Radius [rad or m] of the region of trust at which a path is left as it is."""

PASSES = 30
"""Rounds in which rows of a Newton step are set to their bounds; two or three are usual."""

RETURNS = 10
"""Trials to move one pose without leaving its limits."""

PROBE = 1e-3
"""Step [rad or m] along a self-motion by which its curvature is measured."""


@inner_kernel
def _length(start, q, jump, penalty):
    """Length of the path q (m, n) from the start (0 or 1, n), with a penalty for each jump."""
    total = 0.0
    if start.shape[0] > 0:
        total = step_length(start[0], q[0], math.inf, 0.0)
    for i in range(1, q.shape[0]):
        total += step_length(q[i - 1], q[i], jump, penalty)
    return total


@inner_kernel
def _add_step(a, b, ta, tb, ka, kb, g, diagonal, bent, beside, i):
    """Add the step from a (row i - 1) to b (row i) to gradient and Hessian."""
    length, along_a, along_b, across, bend_a, bend_b = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for j in range(a.shape[0]):
        d = b[j] - a[j]
        length += d * d
        along_a += d * ta[j]
        along_b += d * tb[j]
        across += ta[j] * tb[j]
        bend_a += d * ka[j]
        bend_b += d * kb[j]
    length = math.sqrt(length + KINK * KINK)
    along_a, along_b = along_a / length, along_b / length
    if i > 0:
        g[i - 1] -= along_a
        diagonal[i - 1] += (1.0 - along_a * along_a) / length
        bent[i - 1] -= bend_a / length
        beside[i] = (along_a * along_b - across) / length
    g[i] += along_b
    diagonal[i] += (1.0 - along_b * along_b) / length
    bent[i] += bend_b / length


@inner_kernel
def _solve(g, diagonal, beside, x, bound, pivot):
    """Newton step x (m,), rows with a finite bound at it; False if the Hessian is not positive."""
    m = g.shape[0]
    for i in range(m):
        if not math.isinf(bound[i]):
            x[i], pivot[i] = bound[i], math.inf
            continue
        x[i], pivot[i] = -g[i], diagonal[i]
        if i > 0:
            pivot[i] -= beside[i] * beside[i] / pivot[i - 1]
            x[i] -= beside[i] * (x[i - 1] if math.isinf(pivot[i - 1]) else x[i - 1] / pivot[i - 1])
        if not pivot[i] > FLAT * diagonal[i]:
            return False
    for i in range(m - 1, -1, -1):
        if math.isinf(bound[i]):
            x[i] = (x[i] - (beside[i + 1] * x[i + 1] if i + 1 < m else 0.0)) / pivot[i]
    return True


@inner_kernel
def _newton(g, diagonal, beside, low, high, radius, x, work):
    """Newton step x (m,) between bounds; what is beyond one is set to it, and the rest anew."""
    m = g.shape[0]
    bound, pivot = work[0], work[1]
    bound[:] = math.inf
    for _ in range(PASSES):
        if not _solve(g, diagonal, beside, x, bound, pivot):
            return False
        settled = True
        for i in range(m):
            least, most = max(low[i], -radius), min(high[i], radius)
            if math.isinf(bound[i]):
                if not least <= x[i] <= most:
                    bound[i] = least if x[i] < least else most
                    settled = False
                continue
            slope = g[i] + diagonal[i] * x[i]
            if i > 0:
                slope += beside[i] * x[i - 1]
            if i + 1 < m:
                slope += beside[i + 1] * x[i + 1]
            if least < most and slope * (1.0 if bound[i] == most else -1.0) > 0.0:
                bound[i] = math.inf
                settled = False
        if settled:
            break
    for i in range(m):
        x[i] = min(max(x[i], low[i], -radius), high[i], radius)
    return True


@inner_kernel
def _root(slope, half, gap):
    """Least x >= 0 at which ``slope x + half x^2`` exceeds a gap."""
    root = slope * slope + 4.0 * half * gap
    if math.isinf(gap) or root < 0.0 or (slope <= 0.0 and half <= 0.0):
        return math.inf
    root = math.sqrt(root)
    if slope >= 0.0:
        return 2.0 * gap / max(slope + root, 1e-300)
    return (root - slope) / (2.0 * half)


@inner_kernel
def _room(joints, q, tangent, bend, sign):
    """How far q may move along its self-motion, one way or the other, inside the limits."""
    room = LONGEST
    for j in range(q.shape[0]):
        slope, half = sign * tangent[j], 0.5 * bend[j]
        upper, lower = max(joints[j, 2] - q[j], 0.0), max(q[j] - joints[j, 1], 0.0)
        room = min(room, _root(slope, half, upper), _root(-slope, -half, lower))
    return room


@inner_kernel
def _frames(links, joints, Ts, unit, q, tangent, bend, low, high, scratch, damped):
    """Tangents and curvatures of the self-motions at q (m, n), how far each way is free."""
    n = q.shape[1]
    probe, work = scratch[0], scratch[1]
    for i in range(q.shape[0]):
        for j in range(n):
            probe[j] = tangent[i, j] + 1e-3 * (1.0 + 0.1 * j)
            bend[i, j] = 0.0
        low[i], high[i] = 0.0, 0.0
        if not _tangent(links, joints, POSE, Ts[i], unit, q[i], probe, tangent[i], damped):
            for j in range(n):
                tangent[i, j] = 0.0
            continue
        for j in range(n):
            probe[j] = q[i, j] + PROBE * tangent[i, j]
        if restore(links, joints, POSE, Ts[i], unit, probe, work, damped) <= HELD:
            for j in range(n):
                bend[i, j] = 2.0 * (probe[j] - q[i, j] - PROBE * tangent[i, j]) / PROBE**2
        high[i] = _room(joints, q[i], tangent[i], bend[i], 1.0)
        low[i] = -_room(joints, q[i], tangent[i], bend[i], -1.0)


@inner_kernel
def _move(links, joints, Ts, unit, q, tangent, bend, x, trial, scratch, damped):
    """Move each pose's q by x along its self-motion, less where a limit is in the way."""
    n, work = q.shape[1], scratch[0]
    for i in range(q.shape[0]):
        way = x[i]
        for _ in range(RETURNS):
            for j in range(n):
                trial[i, j] = q[i, j] + way * tangent[i, j] + 0.5 * way * way * bend[i, j]
            if restore(links, joints, POSE, Ts[i], unit, trial[i], work, damped) > HELD:
                way *= 0.5
                continue
            worst, change = 0.0, 0.0
            for j in range(n):
                excess, slope = _excess(joints, trial[i], j), tangent[i, j] + way * bend[i, j]
                if abs(excess) > worst:
                    worst, change = abs(excess), excess / slope
            if worst == 0.0:
                break
            way = way + change if abs(change) < 0.5 * abs(way) else 0.5 * way
        else:
            trial[i] = q[i]


@inner_kernel
def _model(start, q, tangent, bend, zero, g, diagonal, bent, beside):
    """Gradient and Hessian of the length, the part of its diagonal that is due to curvature."""
    g[:], diagonal[:], bent[:], beside[:] = 0.0, 0.0, 0.0, 0.0
    h = g, diagonal, bent, beside
    if start.shape[0] > 0:
        _add_step(start[0], q[0], zero, tangent[0], zero, bend[0], *h, 0)
    for i in range(1, q.shape[0]):
        _add_step(q[i - 1], q[i], tangent[i - 1], tangent[i], bend[i - 1], bend[i], *h, i)
    diagonal += bent


@kernel
def shorten(links, joints, Ts, unit, start, jump, penalty, q):
    """Shorten a path q (m, n) through poses Ts (m, 4, 4), in place; returns its length.

    Parameters
    ----------
    links, joints, unit
        As for :func:`dh2urdf.kernels.self_motion.nearest_members`.
    start : array, shape (0 or 1, n)
        Configuration before the first pose; its step counts too.
    jump, penalty : float
        What a step costs in which a joint moves by more than ``jump`` [rad or m].
    """
    m, n = q.shape
    damped, scratch, work = make_damped(n), np.zeros((3, n)), np.empty((9, m))
    tangent, bend, trial = np.zeros((m, n)), np.zeros((m, n)), np.empty((m, n))
    low, high, x = work[2], work[3], work[4]
    g, diagonal, bent, beside = work[5], work[6], work[7], work[8]
    length, radius = _length(start, q, jump, penalty), LONGEST
    for _ in range(ROUNDS):
        _frames(links, joints, Ts, unit, q, tangent, bend, low, high, scratch, damped)
        _model(start, q, tangent, bend, scratch[2], g, diagonal, bent, beside)
        if not _newton(g, diagonal, beside, low, high, radius, x, work):
            diagonal += np.maximum(0.0, -bent) + LEAST
        shorter = length
        while radius > NEAREST and _newton(g, diagonal, beside, low, high, radius, x, work):
            _move(links, joints, Ts, unit, q, tangent, bend, x, trial, scratch, damped)
            shorter = _length(start, trial, jump, penalty)
            if shorter < length:
                break
            radius = 0.5 * min(radius, np.abs(x).max())
        if not shorter < length:
            break
        q[:] = trial
        gain, length = length - shorter, shorter
        if gain < ENOUGH * length and np.abs(x).max() < radius:
            break
        radius = min(2.0 * radius, LONGEST)
    return length
