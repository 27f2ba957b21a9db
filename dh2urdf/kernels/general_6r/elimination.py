"""Six equations in three joints of a closed chain of six joints.

The loop ``Z_1 C_1 Z_2 C_2 ... Z_6 C_6 = 1`` is cut at joints 2 and 6 (Raghavan & Roth 1993):

    Z_3 C_3 Z_4 C_4 Z_5 C_5 [e3 e4]  =  C_2^-1 Z_2^-1 C_1^-1 Z_1^-1 C_6^-1 [e3 e4]

whose columns are the direction l of axis 6 and a point p on it. The fourteen functions
``p, l, p.p, p.l, p x l, (p.p) l - 2 (p.l) p`` are trilinear in (1, cos, sin) of joints 3, 4, 5 on
the left and bilinear in those of joints 1, 2 on the right. The left null space of the right
side's eight non-constant columns leaves six equations in joints 3, 4, 5.

Coefficients come from samples at 0 and +-120 degrees, which determine a function
``a + b cos + c sin`` exactly. A joint is three functions: one that slides, by ``d = reach x``,
stands for (1, x^2, x) where one that turns does for (1, cos, sin), for samples at x = 0 and +-1,
and for powers of x itself where that one does for powers of the tangent of half its angle. Label 6
has to turn.
"""

import math

import numpy as np

from dh2urdf.kernels.general_6r.arm import OWN
from dh2urdf.kernels.general_6r.two_slides import cut_at_turns
from dh2urdf.kernels.rigid import applied, applied_inverse, dot, turned, turned_back

HALF_SQRT3 = math.sqrt(0.75)
INV_SQRT3 = math.sqrt(1.0 / 3.0)
SQRT2 = math.sqrt(2.0)
RIGHT_ORDER = np.array([4, 5, 7, 8, 3, 6, 1, 2, 0])
"""Rows c1c2, c1s2, s1c2, s1s2, c1, s1, c2, s2, 1 of the right side among (1, c1, s1)(1, c2, s2)."""


def _close_loop(chain, shift, reverse, loop):
    """Write the transforms after each label of the loop ``Z_1 C_1 ... C_5 Z_6 = target``.

    Label i is joint ``(shift + i) % 6``; reversed, joint ``(5 - shift - i) % 6`` with the opposite
    angle. ``chain`` (6, 3, 4) has C_1 ... C_5 and the target.
    """
    for i in range(6):
        joint = (shift + i) % 6 if reverse == 0 else (10 - shift - i) % 6
        if (joint == 5) == (reverse == 0):
            invert(chain[joint], loop[i])
        else:
            loop[i] = chain[joint]


def invert(A, out):
    """Inverse of a rigid transform (3, 4)."""
    for i in range(3):
        for j in range(3):
            out[i, j] = A[j, i]
        out[i, 3] = -(A[0, i] * A[0, 3] + A[1, i] * A[1, 3] + A[2, i] * A[2, 3])


def line_functions(line, out, column):
    """The fourteen functions of a line (its direction, a point on it), to a column of out."""
    (lx, ly, lz), (px, py, pz) = line
    pp, pl2 = dot(line[1], line[1]), 2.0 * dot(line[1], line[0])
    out[0, column], out[1, column], out[2, column] = px, py, pz
    out[3, column], out[4, column], out[5, column] = lx, ly, lz
    out[6, column], out[7, column] = pp, 0.5 * pl2
    out[8, column] = py * lz - pz * ly
    out[9, column] = pz * lx - px * lz
    out[10, column] = px * ly - py * lx
    out[11, column] = pp * lx - pl2 * px
    out[12, column] = pp * ly - pl2 * py
    out[13, column] = pp * lz - pl2 * pz


def _moved(A, line):
    """``A (l, p)`` of a line."""
    return turned(A, line[0]), applied(A, line[1])


def moved_back(A, line):
    """``A^-1 (l, p)`` of a line."""
    return turned_back(A, line[0]), applied_inverse(A, line[1])


def _sampled_line(slide, reach, sample, line):
    """``Z (l, p)`` at 0, 120 or -120 deg for sample 0, 1, 2; at 0 or +-reach where Z slides."""
    (lx, ly, lz), (px, py, pz) = line
    if slide != 0:
        d = 0.0 if sample == 0 else reach if sample == 1 else -reach
        return (lx, ly, lz), (px, py, pz + d)
    c = 1.0 if sample == 0 else -0.5
    s = 0.0 if sample == 0 else HALF_SQRT3 if sample == 1 else -HALF_SQRT3
    return (c * lx - s * ly, s * lx + c * ly, lz), (c * px - s * py, s * px + c * py, pz)


def _left_coefficients(loop, slides, reach, left):
    """Coefficients of the left side's fourteen functions, to left (14, 27).

    Joint 3, the hidden one, stays as (1, cos, sin). Joints 4 and 5 are written in (1, x, x^2) and
    (1, sqrt2 y, y^2) with x, y the tangents of half the angles, after a multiplication by
    ``(1 + x^2)(1 + y^2)``: column ``9 m + 3 i + j`` for (1, cos, sin), x^i and y^j. One that
    slides needs no multiplication; where it is hidden, ``d = reach tan(q/2)``, and all is
    multiplied by ``cos(q/2)^2``.
    """
    C = loop[4]
    start = (C[0, 2], C[1, 2], C[2, 2]), (C[0, 3], C[1, 3], C[2, 3])
    for c in range(3):
        line5 = _moved(loop[3], _sampled_line(slides[4], reach, c, start))
        for b in range(3):
            line4 = _moved(loop[2], _sampled_line(slides[3], reach, b, line5))
            for a in range(3):
                line = _sampled_line(slides[2], reach, a, line4)
                line_functions(line, left, 9 * a + 3 * b + c)
    for f in range(14):
        for i in range(9):
            _series_of_samples(slides[2], left[f], i, 9)
            if slides[2] != 0:
                _hide(left[f], i)
        for a in range(0, 27, 9):
            for i in range(a, a + 3):
                _powers_of_samples(slides[3], left[f], i, 3, 2.0)
            for i in range(a, a + 9, 3):
                _powers_of_samples(slides[4], left[f], i, 1, SQRT2)


def _series_of_samples(slide, row, i, stride):
    """``(1, cos, sin)`` in place of samples at 0, 120 and -120 degrees, or ``(1, x^2, x)``."""
    y0, y1, y2 = row[i], row[i + stride], row[i + 2 * stride]
    if slide != 0:
        row[i + stride], row[i + 2 * stride] = 0.5 * (y1 + y2) - y0, 0.5 * (y1 - y2)
    else:
        row[i] = (y0 + y1 + y2) / 3.0
        row[i + stride] = (2.0 * y0 - y1 - y2) / 3.0
        row[i + 2 * stride] = (y1 - y2) * INV_SQRT3


def _hide(row, i):
    """``(1, x^2, x)`` times ``cos(q/2)^2`` in (1, cos q, sin q), x the tangent of q/2."""
    constant, square = 0.5 * row[i], 0.5 * row[i + 9]
    row[i], row[i + 9], row[i + 18] = constant + square, constant - square, 0.5 * row[i + 18]


def _powers_of_samples(slide, row, i, stride, scale):
    """The same in (1, 2 t / scale, t^2), t the tangent of half the angle, times ``1 + t^2``.

    Of a slide in (1, 2 x / scale, x^2).
    """
    y0, y1, y2 = row[i], row[i + stride], row[i + 2 * stride]
    if slide != 0:
        row[i + stride], row[i + 2 * stride] = 0.25 * scale * (y1 - y2), 0.5 * (y1 + y2) - y0
    else:
        row[i + stride] = (y1 - y2) * scale * INV_SQRT3
        row[i + 2 * stride] = (2.0 * (y1 + y2) - y0) / 3.0


def right_coefficients(loop, slides, reach, samples, right):
    """Coefficients of the right side's fourteen functions of joints 1 and 2, to right (9, 14)."""
    start = moved_back(loop[5], ((0.0, 0.0, 1.0), (0.0, 0.0, 0.0)))
    for a in range(3):
        line1 = moved_back(loop[0], _sampled_line(slides[0], reach, (3 - a) % 3, start))
        for b in range(3):
            line2 = moved_back(loop[1], _sampled_line(slides[1], reach, (3 - b) % 3, line1))
            line_functions(line2, samples, 3 * a + b)
    for f in range(14):
        for a in range(3):
            _series_of_samples(slides[1], samples[f], 3 * a, 1)
        for b in range(3):
            _series_of_samples(slides[0], samples[f], b, 3)
        for r in range(9):
            right[r, f] = samples[f, RIGHT_ORDER[r]]


def reduce_right(right, beta, basis):
    """Householder QR of the eight non-constant columns of the right side, its rows (9, 14).

    Row j of ``right`` becomes reflector j from its diagonal entry on, and R before it; ``beta``
    (16,) the reflectors' factors, then the diagonal of R. Row i of ``basis`` (14, 14) becomes
    column i of Q, without the first four: rows 8 to 13 span the left null space.
    """
    for j in range(8):
        square = 0.0
        for i in range(j, 14):
            square += right[j, i] * right[j, i]
        pivot = right[j, j]
        norm = math.sqrt(square)
        value = -norm if pivot > 0.0 else norm
        beta[j] = -1.0 / (square - value * pivot + 1e-300)
        beta[8 + j] = value
        right[j, j] = pivot - value
        for c in range(j + 1, 8):
            d = 0.0
            for i in range(j, 14):
                d += right[j, i] * right[c, i]
            d *= beta[j]
            for i in range(j, 14):
                right[c, i] += d * right[j, i]
    for r in range(4, 14):
        basis[r], basis[r, r] = 0.0, 1.0
        for j in range(7, -1, -1):
            if j <= r:
                d = 0.0
                for i in range(j, 14):
                    d += right[j, i] * basis[r, i]
                d *= beta[j]
                for i in range(j, 14):
                    basis[r, i] += d * right[j, i]


def _six_equations(right, basis, slides, lefts, e, equations):
    """Project left side e on the null space: ``equations`` (6, 27), columns as in left.

    The constant of the right side is brought over, times ``(1 + x^2)(1 + y^2)``, or what of it
    joints that turn need; times ``cos(q/2)^2`` where the hidden joint slides.
    """
    left = lefts[e]
    for r in range(6):
        equations[r], constant = 0.0, 0.0
        for f in range(14):
            w = basis[8 + r, f]
            constant += w * right[8, f]
            equations[r] += w * left[f]
        if slides[2] != 0:
            constant *= 0.5
        for h in range(0, 9 * (1 + min(slides[2], 1)), 9):
            for m in range(h, h + (9 if slides[3] == 0 else 3), 6):
                equations[r, m] -= constant
                if slides[4] == 0:
                    equations[r, m + 2] -= constant


def prepare(arm):
    """The left sides of the eliminations, as far as they do not depend on the pose."""
    choices, slides = arm["choices"], arm["loop_slides"]
    for e in range(arm["trials"] * (1 - arm["two_slides"])):
        _close_loop(arm["chain"], choices[e, 0], choices[e, 1], arm["loop"])
        _name_slides(e, arm)
        _left_coefficients(arm["loop"], slides, arm["reach"], arm["lefts"][e])


def _name_slides(e, arm):
    """Say which labels of the loop of elimination e slide."""
    for i in range(6):
        arm["loop_slides"][i] = arm["slides"][joint_of(arm["choices"], e, i)]


def joint_of(choices, e, i):
    """The joint that label i, from 0 on, of the loop of elimination e stands for."""
    shift = choices[e, 0]
    return (shift + i) % 6 if choices[e, 1] == 0 else (11 - shift - i) % 6


def eliminate(e, arm):
    """The six equations of elimination e; of two slides what lies between the turns."""
    loop, samples, lefts, choices = arm["loop"], arm["samples"], arm["lefts"], arm["choices"]
    right, basis, slides, reach = arm["right"], arm["basis"], arm["loop_slides"], arm["reach"]
    _close_loop(arm["chain"], choices[e, 0], choices[e, 1], loop)
    _name_slides(e, arm)
    if arm["two_slides"] != 0:
        cut_at_turns(arm)
        return
    right_coefficients(loop, slides, reach, samples, right)
    reduce_right(right, arm["factors"], basis)
    left = e
    if 2 <= (5 - choices[e, 0]) % 6 <= 4:
        left = OWN
        _left_coefficients(loop, slides, reach, lefts[left])
    _six_equations(right, basis, slides, lefts, left, arm["equations"])
