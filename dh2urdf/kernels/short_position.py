"""All configurations of one to three joints that put the tool's origin at a point.

Frames F_i stand on the joint axes at q = 0, so that ``p = F_1 Z_1 A Z_2 B Z_3 w`` with
``A = F_1^-1 F_2``, ``B = F_2^-1 F_3``. With v the point as joint 2 sees it, joints 1 and 2 satisfy
two equations that are free of one of them; eliminating the other leaves one equation
``F(v) = 0`` for joint 3, of degree two in its cosine and sine or four in its slide (Pieper 1968).

Two turning joints stand on their common normal: ``A = Trans_x(a) Rot_x(alpha)``, and with
``X + i Y = (v_x + i v_y) exp(i q2)``

    2 a X = |p|^2 - a^2 - |v|^2        sin(alpha) Y = p_z - cos(alpha) v_z
"""

from __future__ import annotations

import math

import numpy as np

from dh2urdf.kernels.compiled import inner_kernel, kernel
from dh2urdf.kernels.families import work_array
from dh2urdf.kernels.position_task import finish_position
from dh2urdf.kernels.short_loop import SAMPLE_ANGLE, SAMPLE_TABLE, SAMPLES
from dh2urdf.kernels.trig import trig_roots

__all__ = ["solve_short_positions"]

FEW = 24
"""Room for the candidates of a point."""

SLACK = 1e-6
"""Relative excess over a rim that is clamped; the residual decides."""

WRONG = 0.05
"""Error of the equation that was not used, relative to the arm, at which a candidate is dropped."""

TINY = 1e-13
"""Length relative to the arm, or sine, that is rounding."""

STEEP = 0.1
"""Cosine between a slide and the axis before it from which the height alone gives the slide."""


@inner_kernel
def _applied(A, v, out):
    """Write the point ``A v`` to out (3,)."""
    x, y, z = v[0], v[1], v[2]
    for i in range(3):
        out[i] = A[i, 0] * x + A[i, 1] * y + A[i, 2] * z + A[i, 3]


@inner_kernel
def _applied_inverse(A, v, out):
    """Write the point ``A^-1 v`` to out (3,)."""
    x, y, z = v[0] - A[0, 3], v[1] - A[1, 3], v[2] - A[2, 3]
    for i in range(3):
        out[i] = A[0, i] * x + A[1, i] * y + A[2, i] * z


@inner_kernel
def _square(v):
    """Squared length of a vector."""
    return v[0] * v[0] + v[1] * v[1] + v[2] * v[2]


@inner_kernel
def _turn(v, w, rest):
    """Angle about z from v to w; ``rest`` where both are on the axis."""
    c, s = v[0] * w[0] + v[1] * w[1], v[0] * w[1] - v[1] * w[0]
    if abs(c) + abs(s) < 1e-30:
        return rest
    return math.atan2(s, c)


@inner_kernel
def _condition(slides, A, p, v, work):
    """F(v): zero where joints 1 and 2 can bring v to p."""
    w = work[0]
    if not slides[0] and not slides[1]:
        a, c, s = A[0, 3], A[2, 2], A[2, 1]
        first = _square(p) - a * a - _square(v)
        second = p[2] - c * v[2]
        both = 2.0 * a * s
        return (
            s * s * first * first
            + 4.0 * a * a * second * second
            - both * both * (v[0] * v[0] + v[1] * v[1])
        )
    if slides[0] and slides[1]:
        _applied(A, v, w)
        return A[0, 2] * (p[1] - w[1]) - A[1, 2] * (p[0] - w[0])
    if slides[1]:
        _applied(A, v, w)
        steep = A[2, 2]
        rise = p[2] - w[2]
        along = w[0] * A[0, 2] + w[1] * A[1, 2] + w[2] * A[2, 2]
        return steep * steep * (_square(w) - _square(p)) + 2.0 * steep * rise * along + rise * rise
    _applied_inverse(A, p, w)
    steep = -A[2, 2]
    rise = v[2] - w[2]
    along = -(w[0] * A[2, 0] + w[1] * A[2, 1] + w[2] * A[2, 2])
    return steep * steep * (_square(w) - _square(v)) + 2.0 * steep * rise * along + rise * rise


@inner_kernel
def _slide_values(w, direction, square, height, unit):
    """Values t at which ``w + t direction`` has a squared length and a height.

    The height gives t where the direction is steep, else the length, with the height as check.
    Returns the count and two values.
    """
    dx, dy, dz = direction
    rise = height - w[2]
    if abs(dz) >= STEEP:
        return 1, rise / dz, 0.0
    half = w[0] * dx + w[1] * dy + w[2] * dz
    discriminant = half * half - (_square(w) - square)
    if discriminant < -SLACK * unit * unit:
        return 0, 0.0, 0.0
    root = math.sqrt(max(discriminant, 0.0))
    first, second = -half - root, -half + root
    good_first = abs(rise - first * dz) <= WRONG * unit
    good_second = abs(rise - second * dz) <= WRONG * unit
    if good_first and good_second:
        return 2, first, second
    if good_first:
        return 1, first, 0.0
    return (1, second, 0.0) if good_second else (0, 0.0, 0.0)


@inner_kernel
def _two_turns(A, p, v, rest, unit, work, out):
    """Values of two turning joints that bring v to p, to out (2, 2); how many."""
    a, c, s = A[0, 3], A[2, 2], A[2, 1]
    first = _square(p) - a * a - _square(v)
    second = p[2] - c * v[2]
    radius2 = v[0] * v[0] + v[1] * v[1]
    scale = unit * unit
    by_distance = abs(a) >= abs(s) * unit
    known = 0.5 * first / a if by_distance else second / s
    other2 = radius2 - known * known
    if other2 < -SLACK * scale:
        return 0
    other = math.sqrt(max(other2, 0.0))
    rows = 0
    for side in range(2):
        free = other if side == 0 else -other
        x, y = (known, free) if by_distance else (free, known)
        error = s * y - second if by_distance else (2.0 * a * x - first) / unit
        if abs(error) > WRONG * unit or (side == 1 and other == 0.0):
            continue
        real, imaginary = v[0] * x + v[1] * y, v[0] * y - v[1] * x
        q2 = rest[1] if radius2 < TINY * TINY * scale else math.atan2(imaginary, real)
        w = work[0]
        w[0] = v[0] * math.cos(q2) - v[1] * math.sin(q2)
        w[1] = v[0] * math.sin(q2) + v[1] * math.cos(q2)
        w[2] = v[2]
        _applied(A, w, w)
        out[rows, 0], out[rows, 1] = _turn(w, p, rest[0]), q2
        rows += 1
    return rows


@inner_kernel
def _pair(slides, A, p, v, rest, unit, work, out):
    """Values of joints 1 and 2 that bring v to p, to out (2, 2); how many."""
    if not slides[0] and not slides[1]:
        return _two_turns(A, p, v, rest, unit, work, out)
    w = work[1]
    if slides[0] and slides[1]:
        _applied(A, v, w)
        x, y, z = p[0] - w[0], p[1] - w[1], p[2] - w[2]
        flat = A[0, 2] * A[0, 2] + A[1, 2] * A[1, 2]
        out[0, 1] = (x * A[0, 2] + y * A[1, 2]) / flat
        out[0, 0] = z - out[0, 1] * A[2, 2]
        return 1
    if slides[1]:
        _applied(A, v, w)
        direction = (A[0, 2], A[1, 2], A[2, 2])
        count, t1, t2 = _slide_values(w, direction, _square(p), p[2], unit)
        for k in range(count):
            t = t1 if k == 0 else t2
            u = work[2]
            for i in range(3):
                u[i] = w[i] + t * A[i, 2]
            out[k, 0], out[k, 1] = _turn(u, p, rest[0]), t
        return count
    _applied_inverse(A, p, w)
    direction = (-A[2, 0], -A[2, 1], -A[2, 2])
    count, t1, t2 = _slide_values(w, direction, _square(v), v[2], unit)
    for k in range(count):
        t = t1 if k == 0 else t2
        u = work[2]
        for i in range(3):
            u[i] = w[i] - t * A[2, i]
        out[k, 0], out[k, 1] = t, _turn(v, u, rest[1])
    return count


@inner_kernel
def _third(slides, B, tip, cosine, sine, v):
    """The point as joint 2 sees it, ``v = B Z_3 tip`` at (cos, sin); a slide is ``sin / cos``."""
    v[0], v[1], v[2] = tip[0], tip[1], tip[2]
    if slides:
        v[2] += sine / cosine
    else:
        v[0], v[1] = cosine * tip[0] - sine * tip[1], sine * tip[0] + cosine * tip[1]
    _applied(B, v, v)


@inner_kernel
def _third_joint(slides, frames, tip, p, rest, unit, series, roots, work):
    """Values of joint 3, as cosine and sine in rows 1 and 2 of roots; how many."""
    v = work[3]
    noise_cos, noise_sin = 0.0, 0.0
    for m in range(5):
        series[m] = 0.0
    for k in range(SAMPLES):
        half = 0.5 * SAMPLE_ANGLE[k]
        c, s, weight = math.cos(SAMPLE_ANGLE[k]), math.sin(SAMPLE_ANGLE[k]), 1.0
        if slides[2]:
            c, s = math.cos(half), unit * math.sin(half)
            weight = c * c * c * c
        _third(slides[2], frames[2], tip, c, s, v)
        f = weight * _condition(slides, frames[1], p, v, work)
        for m in range(5):
            series[m] += f * SAMPLE_TABLE[m, k]
        noise_cos += f * SAMPLE_TABLE[5, k]
        noise_sin += f * SAMPLE_TABLE[6, k]
    largest = 0.0
    for m in range(5):
        largest = max(largest, abs(series[m]))
    if largest <= 100.0 * (abs(noise_cos) + abs(noise_sin)):
        roots[1, 0], roots[2, 0] = (
            (1.0, rest[2])
            if slides[2]
            else (
                math.cos(rest[2]),
                math.sin(rest[2]),
            )
        )
        return 1
    count = trig_roots(series, 2, roots[1], roots[2])
    if slides[2]:
        for k in range(count):
            half = 0.5 * math.atan2(roots[2, k], roots[1, k])
            roots[1, k], roots[2, k] = math.cos(half), unit * math.sin(half)
    return count


@inner_kernel
def _candidates(slides, frames, tip, T, rest, unit, roots, work, pairs, q):
    """Candidate configurations of one point, to q (FEW, n); how many."""
    n = q.shape[1]
    p, v = work[4], work[3]
    v[0], v[1], v[2] = T[0, 3], T[1, 3], T[2, 3]
    _applied(frames[0], v, p)
    if n == 1:
        q[0, 0] = p[2] - tip[2] if slides[0] else _turn(tip, p, rest[0])
        return 1
    found = 1
    if n == 3:
        found = _third_joint(slides, frames, tip, p, rest, unit, roots[0], roots, work)
    count = 0
    for k in range(found):
        value = 0.0
        if n == 3:
            c, s = roots[1, k], roots[2, k]
            if slides[2] and abs(c) < 1e-9:
                continue
            _third(slides[2], frames[2], tip, c, s, v)
            value = s / c if slides[2] else math.atan2(s, c)
        else:
            v[0], v[1], v[2] = tip[0], tip[1], tip[2]
        rows = _pair(slides, frames[1], p, v, rest, unit, work, pairs)
        for row in range(rows):
            q[count, 0], q[count, 1] = pairs[row, 0], pairs[row, 1]
            if n == 3:
                q[count, 2] = value
            count += 1
    return count


@kernel
def solve_short_positions(
    links, joints, frames, tip, rest_unit, Ts, within_limits, q, residual, count, branch, free
):
    """Solve the origins of poses Ts (m, 4, 4) of a chain of n <= 3 joints.

    Parameters
    ----------
    links, joints : arrays, shapes (n + 1, 4, 4) and (n, 3)
    frames : array, shape (n, 4, 4)
        ``F_1^-1``, A, B.
    tip : array, shape (3,)
        The tool's origin as the last joint sees it.
    rest_unit : array, shape (n + 1,)
        Rest values, then the size of the arm [m].
    Ts, within_limits, q, residual, count, branch, free
        See :class:`dh2urdf.ik.solver.Solver`.
    """
    n = joints.shape[0]
    work = work_array(n)
    slides = joints[:, 0] != 0.0
    rest, unit = rest_unit[:n], rest_unit[n]
    roots, scratch, pairs, trial = np.empty((3, 5)), np.empty((5, 3)), np.empty((2, 2)), np.empty(n)
    many_q, many_residual = np.empty((FEW, n)), np.empty(FEW)
    many_branch, many_free = np.full(FEW, -1, np.int64), np.zeros(FEW, np.int64)
    for i in range(Ts.shape[0]):
        T = Ts[i]
        found = _candidates(slides, frames, tip, T, rest, unit, roots, scratch, pairs, many_q)
        found = finish_position(
            links,
            joints,
            T,
            within_limits,
            many_q,
            many_residual,
            many_branch,
            many_free,
            found,
            trial,
            work,
        )
        found = min(found, q.shape[1])
        for k in range(found):
            for j in range(n):
                q[i, k, j] = many_q[k, j]
            residual[i, k] = many_residual[k]
            branch[i, k], free[i, k] = many_branch[k], many_free[k]
        count[i] = found
