"""Householder QR of many 6 x 6 systems side by side.

A *lane* is one of up to 24 systems that are reduced together. Matrices are flat arrays, column
by column, each entry a run of ``LANES`` doubles: entry (i, j) of lane k is
``A[(6 * j + i) * LANES + k]``. The loop over the lanes is always the innermost one, has no
branch and no reduction, so the compiler turns it into vector instructions: 24 determinants cost
little more than three. Householder reflections need no pivots, hence no branches.
"""

import math

from dh2urdf.engine import side_by_side

LANES = 24
COLUMN = 6 * LANES
TINY = 1e-300
PIVOT = 1e-60
SWEEPS = 2


def _make_reflector(V, A, column, row, n, scale, beta):
    """Reflection ``H = 1 + beta v v^T`` that clears a column of A below ``row``.

    v goes to V, with zeros above ``row``; the pivot takes its new value, with which ``scale`` is
    multiplied; the cleared entries of A are left as they are.
    """
    start = column * COLUMN
    beta[:n] = 0.0
    for i in range(len(V) // LANES):
        r = i * LANES
        if i >= row:
            for k in side_by_side(n):
                a = A[start + r + k]
                V[r + k] = a
                beta[k] += a * a
        else:
            for k in side_by_side(n):
                V[r + k] = 0.0
    pivot = row * LANES
    for k in side_by_side(n):
        a = V[pivot + k]
        square = beta[k]
        norm = math.sqrt(square)
        value = -norm if a > 0.0 else norm
        scale[k] *= value
        beta[k] = -1.0 / (square - value * a + TINY)
        V[pivot + k] = a - value
        A[start + pivot + k] = value


def _reflect(V, A, column, n, beta):
    """Apply the reflection to one column of A."""
    a = column * COLUMN
    for k in side_by_side(n):
        v0, v1, v2 = V[k], V[24 + k], V[48 + k]
        v3, v4, v5 = V[72 + k], V[96 + k], V[120 + k]
        a0, a1, a2 = A[a + k], A[a + 24 + k], A[a + 48 + k]
        a3, a4, a5 = A[a + 72 + k], A[a + 96 + k], A[a + 120 + k]
        d = beta[k] * (v0 * a0 + v1 * a1 + v2 * a2 + v3 * a3 + v4 * a4 + v5 * a5)
        A[a + k] = a0 + d * v0
        A[a + 24 + k] = a1 + d * v1
        A[a + 48 + k] = a2 + d * v2
        A[a + 72 + k] = a3 + d * v3
        A[a + 96 + k] = a4 + d * v4
        A[a + 120 + k] = a5 + d * v5


def reduce_columns(A, count, width, n, scale, V, beta):
    """Triangularise the first ``count`` of ``width`` columns of n lanes in place.

    ``scale`` is multiplied by the diagonal entries made. Entries below the diagonal of the
    reduced columns hold no information afterwards.
    """
    for j in range(count):
        _make_reflector(V, A, j, j, n, scale, beta)
        for c in range(j + 1, width):
            _reflect(V, A, c, n, beta)


def solve_upper(A, b, n):
    """Back substitution ``R x = b`` for the upper triangle R of A, lane by lane, in place.

    b holds six entries a lane. A zero pivot acts as one of 1e-60.
    """
    for j in range(len(b) // LANES - 1, -1, -1):
        d = j * COLUMN + j * LANES
        x = j * LANES
        for k in side_by_side(n):
            b[x + k] /= A[d + k] + PIVOT
        for i in range(j):
            a = j * COLUMN + i * LANES
            y = i * LANES
            for k in side_by_side(n):
                b[y + k] -= A[a + k] * b[x + k]


def solve_upper_transposed(A, b, n):
    """Forward substitution ``R^T x = b`` for the upper triangle R of A, lane by lane, in place."""
    for j in range(len(b) // LANES):
        d = j * COLUMN + j * LANES
        x = j * LANES
        for i in range(j):
            a = j * COLUMN + i * LANES
            y = i * LANES
            for k in side_by_side(n):
                b[x + k] -= A[a + k] * b[y + k]
        for k in side_by_side(n):
            b[x + k] /= A[d + k] + PIVOT


def null_vectors(A, known, b, first, n):
    """Unit vectors b that R maps to nearly nothing: inverse iteration on ``R^T R``.

    Unless they are the first ones, they are orthogonal to the unit vectors ``known``.
    """
    slope = 0.0 if first else 0.3
    for i in range(6):
        r = i * LANES
        for k in side_by_side(n):
            b[r + k] = 1.0 - slope * i
    for sweep in range(SWEEPS + 1):
        if not first:
            _orthogonalise(known, n, b)
        _normalise(b, n)
        if sweep < SWEEPS:
            solve_upper_transposed(A, b, n)
            _normalise(b, n)
            solve_upper(A, b, n)


def _orthogonalise(b, n, second):
    """Take the part along the unit vector b out of ``second``, lane by lane."""
    for k in side_by_side(n):
        d = b[k] * second[k]
        for i in range(1, 6):
            d += b[i * LANES + k] * second[i * LANES + k]
        for i in range(6):
            second[i * LANES + k] -= d * b[i * LANES + k]


def _normalise(b, n):
    """Scale the six entries of every lane to unit length, safe against overflow."""
    for k in side_by_side(n):
        b0, b1, b2 = b[k], b[24 + k], b[48 + k]
        b3, b4, b5 = b[72 + k], b[96 + k], b[120 + k]
        m = max(abs(b0), abs(b1), abs(b2), abs(b3), abs(b4), abs(b5)) + TINY
        b0, b1, b2, b3, b4, b5 = b0 / m, b1 / m, b2 / m, b3 / m, b4 / m, b5 / m
        f = 1.0 / (math.sqrt(b0 * b0 + b1 * b1 + b2 * b2 + b3 * b3 + b4 * b4 + b5 * b5) + TINY)
        b[k], b[24 + k], b[48 + k] = b0 * f, b1 * f, b2 * f
        b[72 + k], b[96 + k], b[120 + k] = b3 * f, b4 * f, b5 * f
