"""One to five joints, any kinds, any geometry: the closed loop as a linear system.

The loop ``Z_1 L_1 ... Z_n L_n = 1`` (the target is in L_n) is cut into two pairs of joints and,
with five joints, one in between, x. As dual quaternions, with the joints linear in (u : v),

    Z_a L_a Z_b L_b (u_x Z_x0 + v_x Z_x1) L_x  =  (Z_c L_c Z_d L_d)^-1

is linear in the four products of (u_a, v_a), (u_b, v_b) and in those of c and d: an 8 x 8 matrix
``M(x) = [A_0 u_x + A_1 v_x | -B]`` whose null vector holds both pairs of joints. With five joints
``det M`` is a quartic in (u_x : v_x); with fewer M is constant. A null vector must consist of two
products, each a 2 x 2 matrix of determinant zero; where the null space is a plane, that is a
quadratic equation.

The matrix is kept by columns: row k of an array is column k of M.
"""

import math
from typing import Annotated, TypeAlias

import numpy as np

from dh2urdf.kernels.numbers import dual_product, dual_times_joint, entry, sincos
from dh2urdf.kernels.shapes import Floats, Integers, Joints

Loop: TypeAlias = Annotated[Floats, "n", 8]
"""Dual quaternions of the links of the closed loop, the last with the target in it."""

Columns: TypeAlias = Annotated[Floats, 12, 8]

SAMPLES = 7
"""Determinants that give the five coefficients and, by two that must vanish, their noise."""

SAMPLE_ANGLE = 2.0 * np.pi * np.arange(SAMPLES) / SAMPLES
SAMPLE_HALF = np.array([sincos(0.5 * x)[::-1] for x in SAMPLE_ANGLE.tolist()]).T.copy()
SAMPLE_TABLE = np.array(
    [[0.5, *(f for m in (1, 2, 3) for f in sincos(m * x)[::-1])] for x in SAMPLE_ANGLE.tolist()]
).T.copy() * (2.0 / SAMPLES)


def _pair_columns(loop, joints, first, second, out):
    """Products ``z_a L_a z_b L_b`` to out (4, 8), row 2 i + j with z_a the i-th factor of joint a.

    Joint -1 is absent: its rows are not written.
    """
    out[0], out[0, 0] = 0.0, 1.0
    if first >= 0:
        dual_times_joint(out[0], joints[first, 0] != 0.0, out[2])
        dual_product(out[0], loop[first], out[0])
        dual_product(out[2], loop[first], out[2])
    if second >= 0:
        for k in range(0, 3, 2):
            dual_times_joint(out[k], joints[second, 0] != 0.0, out[k + 1])
            dual_product(out[k], loop[second], out[k])
            dual_product(out[k + 1], loop[second], out[k + 1])


@entry()
def loop_columns(loop: Loop, joints: Joints, order: Annotated[Integers, 7], out: Columns):
    """Columns of A_0 (rows 0 to 3 of out (12, 8)), A_1 (4 to 7) and -B (8 to 11).

    ``order`` has the joints a, b, x, c, d; -1 where there is none.
    """
    x = order[2]
    _pair_columns(loop, joints, order[0], order[1], out[0:4])
    _pair_columns(loop, joints, order[3], order[4], out[8:12])
    for k in range(4):
        if x >= 0:
            dual_times_joint(out[k], joints[x, 0] != 0.0, out[4 + k])
            dual_product(out[k], loop[x], out[k])
            dual_product(out[4 + k], loop[x], out[4 + k])
        else:
            out[4 + k] = 0.0
        out[8 + k, 0], out[8 + k, 4] = -out[8 + k, 0], -out[8 + k, 4]


@entry()
def loop_matrix(
    columns: Columns, used: Annotated[Integers, 8], u: float, v: float, M: Annotated[Floats, 8, 8]
):
    """M at (u_x : v_x), column ``used[k]`` of the pairs (0 to 3 left, 4 to 7 right) in row k.

    Returns the number of columns; ``used`` is -1 after the last.
    """
    size = 0
    for k in range(8):
        j = used[k]
        if j < 0:
            break
        size += 1
        if j < 4:
            M[k] = u * columns[j] + v * columns[j + 4]
        else:
            M[k] = columns[j + 4]
    return size


def factor(M, size, order):
    """Householder's QR with column pivoting, in place; R in the leading entries of the rows.

    M (>= size, 8) is a matrix by columns, ``order`` (>= size,) says which of them each row holds
    afterwards. Returns the determinant, where size is 8.
    """
    determinant = 1.0
    for k in range(size):
        order[k] = k
    for k in range(size):
        best, largest = k, -1.0
        for j in range(k, size):
            square = 0.0
            for i in range(k, 8):
                square += M[j, i] * M[j, i]
            if square > largest:
                best, largest = j, square
        if best != k:
            determinant = -determinant
            order[k], order[best] = order[best], order[k]
            for i in range(8):
                M[k, i], M[best, i] = M[best, i], M[k, i]
        if k == 7 or largest <= 0.0:
            determinant *= M[k, k]
            continue
        norm = -math.copysign(math.sqrt(largest), M[k, k])
        determinant *= -norm
        head = M[k, k] - norm
        scale = 1.0 / (norm * head)
        for j in range(k + 1, size):
            dot = head * M[j, k]
            for i in range(k + 1, 8):
                dot += M[k, i] * M[j, i]
            dot *= scale
            M[j, k] += dot * head
            for i in range(k + 1, 8):
                M[j, i] += dot * M[k, i]
        M[k, k] = norm
    return determinant


def null_basis(M, size, order, nullity, basis):
    """Vectors that a matrix from :func:`factor` takes to (nearly) zero, to basis (nullity, 8).

    ``R_11 y = -R_12``, taking the last ``nullity`` columns for dependent on the others; entries in
    the order of the columns.
    """
    rank = size - nullity
    for k in range(nullity):
        largest = 1.0
        basis[k], basis[k, order[rank + k]] = 0.0, 1.0
        for i in range(rank - 1, -1, -1):
            total = -M[rank + k, i]
            for j in range(i + 1, rank):
                total -= M[j, i] * basis[k, order[j]]
            pivot = M[i, i]
            value = total / pivot if pivot != 0.0 else 0.0
            basis[k, order[i]] = value
            largest = max(largest, abs(value))
        basis[k] /= largest


def determinant_series(columns, used, M, order, series):
    """``det M`` along x: coefficients of 1, cos y, sin y, ..., cos 3y, sin 3y to series (7,).

    ``(u : v) = (cos y/2 : sin y/2)``, so that y is the angle of a turning joint.
    """
    series[:] = 0.0
    for k in range(SAMPLES):
        loop_matrix(columns, used, SAMPLE_HALF[0, k], SAMPLE_HALF[1, k], M)
        add_sample(series, factor(M, 8, order), k)


def add_sample(series, value, k):
    """Add what sample k contributes to the coefficients (7,) of a function of an angle."""
    for m in range(SAMPLES):
        series[m] += value * SAMPLE_TABLE[m, k]


def vanishes(series, zero):
    """Whether a quartic is 0 but for rounding: the size of its third harmonic, which it has not."""
    largest = 0.0
    for m in range(5):
        largest = max(largest, abs(series[m]))
    return largest <= max(zero, 100.0 * (abs(series[5]) + abs(series[6])))
