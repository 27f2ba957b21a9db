"""The 12 x 12 resultant of six equations in three joints, as a 6 x 6 determinant in lanes.

At a value of the hidden joint the equations are ``(E0 + E1 x + E2 x^2) v = 0`` with E0, E1, E2
(6, 3) and ``v = (1, sqrt2 y, y^2)``, x and y the half-angle tangents of the two other joints.
Raghavan & Roth's square matrix takes the equations and x times the equations:

    | E0 E1 E2  0 |  (v, x v, x^2 v, x^3 v) = 0
    |  0 E0 E1 E2 |

Its upper half is triangularised on the columns of E0, its lower half on those of E2; three rows
of each are left, without v and x^3 v: a 6 x 6 matrix whose null vector is ``(v, x v)`` up to
scale. The determinant of the whole is the product of all diagonal entries met.

A hidden slide, ``d = reach tan(q/2)``, leaves a factor ``cos(q/2)^8``: each entry has its square,
and the determinant is of degree 16 in d.

The null vector gives joints 4 and 5. The fourteen functions of the line of axis 6, evaluated on the
left side, then give the cosines and sines of joints 1 and 2 by linear equations; joint 6 is the
rotation that closes the loop. Arrays ``cosines`` and ``sines`` hold six runs of ``LANES`` doubles;
of a joint that slides the second one its length.
"""

import math

import numpy as np

from dh2urdf.kernels.general_6r.elimination import SQRT2, line_functions, moved_back
from dh2urdf.kernels.newton import chain_frames
from dh2urdf.kernels.numbers import COLUMN, LANES, reduce_columns, side_by_side
from dh2urdf.kernels.rigid import turned_back

HALF = 3 * LANES
LEFT = 3 * 12 * LANES
"""Where `chain_frames` leaves ``C_2 Z_3 C_3 Z_4 C_4 Z_5 C_5``."""
LOWER = np.array([[0, 1, 2, 0], [0, 1, 3, 4]])
HIGHER = np.array([[3, 4, 5, 0], [1, 2, 4, 5]])
LOWER_SCALE = np.array([[1.0, 1.0, 1.0, 0.0], [1.0, 1.0 / SQRT2, 1.0, 1.0 / SQRT2]])
HIGHER_SCALE = np.array([[1.0, 1.0, 1.0, 0.0], [1.0 / SQRT2, 1.0, 1.0 / SQRT2, 1.0]])
FARTHEST = 1e-8
"""Least ``cos(q/2)^2`` of a hidden slide that is divided by: beyond there is no arm."""


def _fill(equations, term, hidden, n, A, column):
    """One column of the six equations at the hidden joint's values."""
    for r in range(len(equations)):
        e0, e1, e2 = equations[r, term], equations[r, 9 + term], equations[r, 18 + term]
        a = column * COLUMN + r * LANES
        for k in side_by_side(n):
            A[a + k] = e0 + e1 * hidden[0, k] + e2 * hidden[1, k]


def resultants(equations, hidden, n, A, W, determinant, V, beta):
    """Determinants at n values of the hidden joint; W (6 x 6 lanes) is left triangular.

    ``equations`` (6, 27) as from `six_equations`; ``hidden`` (2, 24) has cosines and sines; A
    (9 * 144,), V (144,) and beta (24,) are scratch.
    """
    determinant[:] = 1.0
    for half in range(2):
        for term in range(9):
            block, j = term // 3, term % 3
            column = term if half == 0 else 3 * (2 - block) + j
            _fill(equations, term, hidden, n, A, column)
        reduce_half(half, n, A, W, determinant, V, beta)
    finish_reduction(n, W, determinant, V, beta)


def reduce_half(half, n, A, W, determinant, V, beta):
    """Reduce the equations, in A, or those times x4: what is left of them is half of W."""
    reduce_columns(A, 3, 9, n, determinant, V, beta)
    for source in range(3, 9):
        target = source - 3 if half == 0 else (source if source < 6 else source - 6)
        a, w = source * COLUMN + HALF, target * COLUMN + half * HALF
        for k in range(HALF):
            W[w + k] = A[a + k]


def finish_reduction(n, W, determinant, V, beta):
    """Reduce W, of two halves, and multiply the determinants by what stands on its diagonal."""
    reduce_columns(W, 5, 6, n, determinant, V, beta)
    last = 5 * COLUMN + 5 * LANES
    for k in side_by_side(n):
        determinant[k] *= W[last + k]


def sample_resultants(n, arm):
    """Determinants at n values of the hidden joint, in ``hidden`` of the record."""
    equations, hidden, determinant = arm["equations"], arm["hidden"], arm["determinant"]
    resultants(equations, hidden, n, arm["A"], arm["W"], determinant, arm["V"], arm["beta"])
    if arm["loop_slides"][2] != 0:
        for k in side_by_side(n):
            square = max(0.5 * (1.0 + hidden[0, k]), FARTHEST)
            determinant[k] /= square * square * (square * square)


def as_length(reach, place, n, cosines, sines):
    """The length of a slide in place of the angle by the tangent of whose half it is written."""
    o = place * LANES
    for k in side_by_side(n):
        sines[o + k] = reach * sines[o + k] / max(1.0 + cosines[o + k], FARTHEST)
        cosines[o + k] = 1.0


def two_joints(b, n, cosines, sines):
    """Joints 4 and 5, in six runs of LANES, from the rank-one vectors ``(v, x v)``.

    Each as an angle: one that slides is the tangent of half of it.
    """
    for k in side_by_side(n):
        p0, p1, p2 = b[k], b[LANES + k], b[2 * LANES + k]
        r0, r1, r2 = b[3 * LANES + k], b[4 * LANES + k], b[5 * LANES + k]
        pp = p0 * p0 + p1 * p1 + p2 * p2
        rr = r0 * r0 + r1 * r1 + r2 * r2
        pr = p0 * r0 + p1 * r1 + p2 * r2
        h = 1.0 / (math.sqrt((pp - rr) * (pp - rr) + 4.0 * pr * pr) + 1e-300)
        c, s = (pp - rr) * h, 2.0 * pr * h
        cosines[3 * LANES + k], sines[3 * LANES + k] = c, s
        wp = 1.0 + c if c > 0.0 else s
        wr = s if c > 0.0 else 1.0 - c
        v0, v1, v2 = wp * p0 + wr * r0, wp * p1 + wr * r1, wp * p2 + wr * r2
        c = v0 - v2 if v0 + v2 > 0.0 else v2 - v0
        s = SQRT2 * v1 if v0 + v2 > 0.0 else -SQRT2 * v1
        h = 1.0 / (math.sqrt(c * c + s * s) + 1e-300)
        cosines[4 * LANES + k], sines[4 * LANES + k] = c * h, s * h


def _pencil(b, second, k, columns, rows):
    """Matrix of which the combinations c of two vectors with ``N2 c = x N1 c`` are eigenvectors.

    ``(N1^T N1)^-1 N1^T N2``, where N1 and N2 are lane k of entries of b and ``second`` that belong
    to neighbouring powers of x, or of y. Returns the matrix, and how far apart its eigenvalues are:
    squared sine of the angle between them.
    """
    g00, g01, g11, h00, h01, h10, h11 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(rows):
        low, high = LOWER[columns, i] * LANES + k, HIGHER[columns, i] * LANES + k
        f, g = LOWER_SCALE[columns, i], HIGHER_SCALE[columns, i]
        p0, p1, q0, q1 = f * b[low], f * second[low], g * b[high], g * second[high]
        g00 += p0 * p0
        g01 += p0 * p1
        g11 += p1 * p1
        h00 += p0 * q0
        h01 += p0 * q1
        h10 += p1 * q0
        h11 += p1 * q1
    d = g00 * g11 - g01 * g01 + 1e-300
    a00, a01 = (g11 * h00 - g01 * h10) / d, (g11 * h01 - g01 * h11) / d
    a10, a11 = (g00 * h10 - g01 * h00) / d, (g00 * h11 - g01 * h01) / d
    gap = (a00 - a11) * (a00 - a11) + 4.0 * a01 * a10
    cosine = 1.0 - (a00 * a11 - a01 * a10)
    return a00, a01, a10, a11, gap / (cosine * cosine + (a00 + a11) * (a00 + a11))


def split_pairs(b, second, n):
    """Two rank-one vectors ``(v, x v)`` from a plane of null vectors, in lanes 2k and 2k + 1.

    Lanes 2k and 2k + 1 hold the same plane, spanned by b and ``second``. The two differ in x or
    in y, or in both: taken apart by the one in which they differ more. A complex pair gives its
    real part twice. b is overwritten.
    """
    for k in side_by_side(n):
        a00, a01, a10, a11, apart = _pencil(b, second, k, 0, 3)
        d00, d01, d10, d11, apart_y = _pencil(b, second, k, 1, 4)
        if apart_y > apart:
            a00, a01, a10, a11 = d00, d01, d10, d11
        half = 0.5 * (a00 - a11)
        root = math.sqrt(max(half * half + a01 * a10, 0.0))
        x = 0.5 * (a00 + a11) + (root if k % 2 == 0 else -root)
        if abs(a00 - x) > abs(a11 - x):
            c0, c1 = a01, x - a00
        else:
            c0, c1 = x - a11, a10
        h = 1.0 / (math.sqrt(c0 * c0 + c1 * c1) + 1e-300)
        for i in range(6):
            b[i * LANES + k] = (c0 * b[i * LANES + k] + c1 * second[i * LANES + k]) * h


def _functions(loop, frames, n, out):
    """The fourteen functions of axis 6's line, to out (14, LANES)."""
    for k in side_by_side(n):
        f = LEFT + k
        z6 = frames[f + 2 * LANES], frames[f + 6 * LANES], frames[f + 10 * LANES]
        p6 = frames[f + 3 * LANES], frames[f + 7 * LANES], frames[f + 11 * LANES]
        line_functions(moved_back(loop[1], (z6, p6)), out, k)


def _project(basis, row, constant, functions, n, out):
    """Row of Q^T times (functions - constant), to a run of out."""
    w0 = basis[row, 0]
    shift = 0.0
    for f in range(len(constant)):
        shift += basis[row, f] * constant[f]
    o = (row - 4) * LANES
    for k in side_by_side(n):
        out[o + k] = w0 * functions[0, k] - shift
    for f in range(1, len(constant)):
        w = basis[row, f]
        for k in side_by_side(n):
            out[o + k] += w * functions[f, k]


def other_joints(loop, slides, reach, right, beta, basis, frames, n, cosines, sines, functions, y):
    """Joints 1, 2 and 6 of n lanes.

    ``right``, ``beta`` and ``basis`` as the elimination leaves them; frames (7 * 144,), functions
    (14, 24) and y (96,) scratch.
    """
    chain_frames(loop[1:5], slides[2:], cosines[2 * LANES :], sines[2 * LANES :], n, frames)
    outer_joints(loop, slides, reach, right, beta, basis, frames, n, cosines, sines, functions, y)


def outer_joints(loop, slides, reach, right, beta, basis, frames, n, cosines, sines, functions, y):
    """The same where what is between joints 2 and 6 is known, at ``LEFT`` of the frames."""
    _functions(loop, frames, n, functions)
    for row in range(4, 8):
        _project(basis, row, right[8], functions, n, y)
    d4, d5, d6, d7 = 1.0 / beta[12], 1.0 / beta[13], 1.0 / beta[14], 1.0 / beta[15]
    r45, r46, r56 = right[5, 4], right[6, 4], right[6, 5]
    r47, r57, r67 = right[7, 4], right[7, 5], right[7, 6]
    slide1, slide2 = slides[0] != 0, slides[1] != 0
    for k in side_by_side(n):
        s2 = y[3 * LANES + k] * d7
        c2 = (y[2 * LANES + k] - r67 * s2) * d6
        s1 = (y[LANES + k] - r56 * c2 - r57 * s2) * d5
        c1 = (y[k] - r45 * s1 - r46 * c2 - r47 * s2) * d4
        h1 = 1.0 / (math.sqrt(c1 * c1 + s1 * s1) + 1e-300)
        h2 = 1.0 / (math.sqrt(c2 * c2 + s2 * s2) + 1e-300)
        cosines[k], sines[k] = c1 * h1, s1 * h1
        cosines[LANES + k], sines[LANES + k] = c2 * h2, s2 * h2
        if slide1:
            cosines[k], sines[k] = 1.0, reach * s1
        if slide2:
            cosines[LANES + k], sines[LANES + k] = 1.0, reach * s2
    _last_joint(loop, slides, frames, n, cosines, sines)


def _last_joint(loop, slides, frames, n, cosines, sines):
    """Joint 6: first row of ``Z_6^-1 = C_6 Z_1 C_1 Z_2 (C_2 Z_3 C_3 Z_4 C_4 Z_5 C_5)``."""
    x0, y0, z0 = loop[5, 0, 0], loop[5, 0, 1], loop[5, 0, 2]
    slide1, slide2 = slides[0] != 0, slides[1] != 0
    for k in side_by_side(n):
        c1, s1, c2, s2 = cosines[k], sines[k], cosines[LANES + k], sines[LANES + k]
        s1 = 0.0 if slide1 else s1
        s2 = 0.0 if slide2 else s2
        x, y, z = turned_back(loop[0], (x0 * c1 + y0 * s1, y0 * c1 - x0 * s1, z0))
        x, y = x * c2 + y * s2, y * c2 - x * s2
        f = LEFT + k
        c = x * frames[f] + y * frames[f + 4 * LANES] + z * frames[f + 8 * LANES]
        s = x * frames[f + LANES] + y * frames[f + 5 * LANES] + z * frames[f + 9 * LANES]
        h = 1.0 / (math.sqrt(c * c + s * s) + 1e-300)
        cosines[5 * LANES + k], sines[5 * LANES + k] = c * h, s * h
