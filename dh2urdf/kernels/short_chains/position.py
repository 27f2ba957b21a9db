"""All configurations of one to three joints that put the tool's origin at a point.

Frames F_i stand on the joint axes at q = 0, so that ``p = F_1 Z_1 A Z_2 B Z_3 w`` with
``A = F_1^-1 F_2``, ``B = F_2^-1 F_3``. With v the point as joint 2 sees it, joints 1 and 2 satisfy
two equations that are free of one of them; eliminating the other leaves one equation
``F(v) = 0`` for joint 3, of degree two in its cosine and sine or four in its slide (Pieper 1968).

Two turning joints stand on their common normal: ``A = Trans_x(a) Rot_x(alpha)``, and with
``X + i Y = (v_x + i v_y) exp(i q2)``

    2 a X = |p|^2 - a^2 - |v|^2        sin(alpha) Y = p_z - cos(alpha) v_z
"""

import math
from typing import Annotated, NamedTuple

import numpy as np

from dh2urdf.kernels.certificate import ACCEPT, copy_rows, finish_all
from dh2urdf.kernels.newton import work_array
from dh2urdf.kernels.numbers import atan2, entry, sincos, trig_roots
from dh2urdf.kernels.rigid import applied, applied_inverse, dot, minus, turned
from dh2urdf.kernels.shapes import Chain, Floats, Outputs, Poses, Three
from dh2urdf.kernels.short_chains.loop import SAMPLE_ANGLE, SAMPLES, add_sample, vanishes

FEW = 24
"""Room for the candidates of a point."""

SLACK = 1e-6
"""Relative excess over a rim that is clamped; the residual decides."""

WRONG = 0.05
"""Error of the equation that was not used, relative to the arm, at which a candidate is dropped."""

TINY = 1e-13
"""Length relative to the arm, or sine, that is rounding."""

BESIDE, ON_AXIS = 1e-4, 1e-6
"""Distances [m] of the point from axis 2 at which it may be on it, as roots of multiplicity four
and two are rounded, and at which it is taken to be nowhere else."""

STEEP = 0.1
"""Cosine between a slide and the axis before it from which the height alone gives the slide."""


def _turn(v, w, rest):
    """Angle about z from v to w; ``rest`` where both are on the axis."""
    c, s = v[0] * w[0] + v[1] * w[1], v[0] * w[1] - v[1] * w[0]
    if abs(c) + abs(s) < 1e-30:
        return rest
    return atan2(s, c)


def _line(slides, A, p, v):
    """Line ``w + t direction`` that one slide t moves a point along, and where the turn has it.

    Joint 2 slides: v moves, seen from axis 1, about which it has to come to p. Joint 1 slides: p
    moves back, seen from axis 2, about which v has to come to it.
    """
    if slides[1]:
        return applied(A, v), (A[0, 2], A[1, 2], A[2, 2]), p
    return applied_inverse(A, p), (-A[2, 0], -A[2, 1], -A[2, 2]), v


def _condition(slides, A, p, v):
    """F(v): zero where joints 1 and 2 can bring v to p."""
    if not slides[0] and not slides[1]:
        a, c, s = A[0, 3], A[2, 2], A[2, 1]
        first = dot(p, p) - a * a - dot(v, v)
        second = p[2] - c * v[2]
        both = 2.0 * a * s
        sides = s * s * first * first + 4.0 * a * a * second * second
        return sides - both * both * (v[0] * v[0] + v[1] * v[1])
    if slides[0] and slides[1]:
        w = applied(A, v)
        return A[0, 2] * (p[1] - w[1]) - A[1, 2] * (p[0] - w[0])
    w, direction, target = _line(slides, A, p, v)
    steep, rise, along = direction[2], target[2] - w[2], dot(w, direction)
    lengths = dot(w, w) - dot(target, target)
    return steep * steep * lengths + 2.0 * steep * rise * along + rise * rise


def _slide_values(w, direction, square, height, unit):
    """Values t at which ``w + t direction`` has a squared length and a height.

    The height gives t where the direction is steep, else the length, with the height as check.
    Returns the count and two values.
    """
    dz, rise = direction[2], height - w[2]
    if abs(dz) >= STEEP:
        return 1, rise / dz, 0.0
    half = dot(w, direction)
    discriminant = half * half - (dot(w, w) - square)
    if discriminant < -SLACK * unit * unit:
        return 0, 0.0, 0.0
    root = math.sqrt(max(discriminant, 0.0))
    first, second = -half - root, -half + root
    good_first = abs(rise - first * dz) <= WRONG * unit
    good_second = abs(rise - second * dz) <= WRONG * unit
    if good_first:
        return (2 if good_second else 1), first, second
    return (1 if good_second else 0), second, 0.0


def _two_turns(A, p, v, rest, unit, out):
    """Values of two turning joints that bring v to p, to out (2, 2); how many."""
    a, c, s = A[0, 3], A[2, 2], A[2, 1]
    first = dot(p, p) - a * a - dot(v, v)
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
        q2 = rest[1] if radius2 < TINY * TINY * scale else atan2(imaginary, real)
        s2, c2 = sincos(q2)
        w = applied(A, (v[0] * c2 - v[1] * s2, v[0] * s2 + v[1] * c2, v[2]))
        out[rows, 0], out[rows, 1] = _turn(w, p, rest[0]), q2
        rows += 1
    return rows


def _pair(slides, A, p, v, rest, unit, out):
    """Values of joints 1 and 2 that bring v to p, to out (2, 2); how many."""
    if not slides[0] and not slides[1]:
        return _two_turns(A, p, v, rest, unit, out)
    if slides[0] and slides[1]:
        w = applied(A, v)
        x, y, z = minus(p, w)
        flat = A[0, 2] * A[0, 2] + A[1, 2] * A[1, 2]
        out[0, 1] = (x * A[0, 2] + y * A[1, 2]) / flat
        out[0, 0] = z - out[0, 1] * A[2, 2]
        return 1
    w, direction, target = _line(slides, A, p, v)
    count, t1, t2 = _slide_values(w, direction, dot(target, target), target[2], unit)
    for k in range(count):
        t = t1 if k == 0 else t2
        u = w[0] + t * direction[0], w[1] + t * direction[1], w[2] + t * direction[2]
        if slides[1]:
            out[k, 0], out[k, 1] = _turn(u, p, rest[0]), t
        else:
            out[k, 0], out[k, 1] = t, _turn(v, u, rest[1])
    return count


def _third(slides, B, tip, cosine, sine):
    """The point as joint 2 sees it, ``B Z_3 tip`` at (cos, sin); a slide is ``sin / cos``."""
    x, y, z = tip
    if slides:
        return applied(B, (x, y, z + sine / cosine))
    return applied(B, (cosine * x - sine * y, sine * x + cosine * y, z))


def _onto_axis(slides, B, tip, v, cosine, sine):
    """Whether joint 3 can put a point v beside axis 2 onto it, so that joint 2 is free.

    Not for one that slides. Returned are the cosine and sine of joint 3, and the point, too.
    """
    if slides[1] or v[0] * v[0] + v[1] * v[1] > BESIDE * BESIDE:
        return False, cosine, sine, v
    way = (-sine * tip[0] - cosine * tip[1], cosine * tip[0] - sine * tip[1], 0.0)
    dx, dy, _ = turned(B, (0.0, 0.0, 1.0) if slides[2] else way)
    square = dx * dx + dy * dy
    move = -(v[0] * dx + v[1] * dy) / square if square > 0.0 else 0.0
    s, c = sincos(move)
    near_c, near_s = cosine * c - sine * s, sine * c + cosine * s
    if slides[2]:
        near_c, near_s = cosine, sine + move * cosine
    x, y, z = _third(slides[2], B, tip, near_c, near_s)
    return x * x + y * y <= ACCEPT * ACCEPT, near_c, near_s, (0.0, 0.0, z)


def _third_joint(slides, frames, tip, p, rest, unit, roots):
    """Values of joint 3, as cosine and sine in rows 1 and 2 of roots; how many."""
    series = roots[0]
    series[:] = 0.0
    for k in range(SAMPLES):
        (s, c), weight = sincos(SAMPLE_ANGLE[k]), 1.0
        if slides[2]:
            s, c = sincos(0.5 * SAMPLE_ANGLE[k])
            s, weight = unit * s, c * c * c * c
        v = _third(slides[2], frames[2], tip, c, s)
        add_sample(series, weight * _condition(slides, frames[1], p, v), k)
    if vanishes(series, 0.0):
        roots[1, 0] = 1.0 if slides[2] else sincos(rest[2])[1]
        roots[2, 0] = rest[2] if slides[2] else sincos(rest[2])[0]
        return 1
    count = trig_roots(series, 2, roots[1], roots[2])
    if slides[2]:
        for k in range(count):
            s, c = sincos(0.5 * atan2(roots[2, k], roots[1, k]))
            roots[1, k], roots[2, k] = c, unit * s
    return count


def _candidates(slides, frames, tip, target, rest, unit, roots, pairs, q):
    """Candidate configurations of one point, to q (FEW, n); how many."""
    n = q.shape[1]
    p = applied(frames[0], (target[0], target[1], target[2]))
    if n == 1:
        q[0, 0] = p[2] - tip[2] if slides[0] else _turn(tip, p, rest[0])
        return 1
    found = _third_joint(slides, frames, tip, p, rest, unit, roots) if n == 3 else 1
    count = 0
    for k in range(found):
        if n < 3:
            count = _add_pairs(slides, frames[1], p, tip, rest, unit, 0.0, pairs, q, count)
            continue
        c, s = roots[1, k], roots[2, k]
        if slides[2] and abs(c) < 1e-9:
            continue
        v = _third(slides[2], frames[2], tip, c, s)
        on_axis, near_c, near_s, near = _onto_axis(slides, frames[2], tip, v, c, s)
        if not on_axis or v[0] * v[0] + v[1] * v[1] > ON_AXIS * ON_AXIS:
            value = s / c if slides[2] else atan2(s, c)
            count = _add_pairs(slides, frames[1], p, v, rest, unit, value, pairs, q, count)
        if on_axis:
            value = near_s / near_c if slides[2] else atan2(near_s, near_c)
            count = _add_pairs(slides, frames[1], p, near, rest, unit, value, pairs, q, count)
    return count


def _add_pairs(slides, A, p, v, rest, unit, value, pairs, q, count):
    """Add configurations q (FEW, n) with joint 3 at a value, if there is one; how many."""
    for row in range(_pair(slides, A, p, v, rest, unit, pairs)):
        q[count, 0], q[count, 1] = pairs[row, 0], pairs[row, 1]
        if q.shape[1] == 3:
            q[count, 2] = value
        count += 1
    return count


class PositionArm(NamedTuple):
    """Up to three joints, whose position is asked for."""

    chain: Chain
    frames: Annotated[Floats, "n", 4, 4]
    tip: Three
    rest_unit: Annotated[Floats, "n + 1"]


@entry(solutions=4)
def solve_short_positions(arm: PositionArm, Ts: Poses, within_limits: bool, outputs: Outputs):
    """Solve the origins of poses Ts (m, 4, 4) of a chain of n <= 3 joints.

    ``frames`` (n, 4, 4) are ``F_1^-1``, A, B, ``tip`` (3,) is the tool's origin as the last joint
    sees it, ``rest_unit`` (n + 1,) has the rest values, then the size of the arm [m].
    """
    chain, frames, tip, rest_unit = arm
    _, joints = chain
    q, residual, count, branch, free = outputs
    n = joints.shape[0]
    work = work_array(n)
    slides, p = np.empty(n, np.bool_), np.empty(3)
    for j in range(n):
        slides[j] = joints[j, 0] != 0.0
    rest, unit = rest_unit[:n], rest_unit[n]
    point = tip[0], tip[1], tip[2]
    roots, pairs, trial = np.empty((3, SAMPLES)), np.empty((2, 2)), np.empty((2, n))
    many = np.empty((FEW, n)), np.empty(FEW), np.empty(FEW, np.int64), np.empty(FEW, np.int64)
    for i in range(Ts.shape[0]):
        p[0], p[1], p[2] = Ts[i, 0, 3], Ts[i, 1, 3], Ts[i, 2, 3]
        found = _candidates(slides, frames, point, p, rest, unit, roots, pairs, many[0])
        found = finish_all(chain, p, within_limits, many, found, trial, work)
        count[i] = copy_rows(many, found, (q[i], residual[i], branch[i], free[i]))
