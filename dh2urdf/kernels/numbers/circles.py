"""Two equations in two angles: where two ellipses meet, subproblem 6 of Elias and Wen."""

import math

from dh2urdf.kernels.numbers.double_roots import linear_trig
from dh2urdf.kernels.numbers.trig import TINY, trig_roots


def circle_pair(M, N, d, slack, scratch, out):
    """Solve ``M (cos x, sin x) + N (cos y, sin y) = d``, two equations: subproblem 6.

    The general case is a quartic (two ellipses meet); where a combination of the two equations
    is free of one angle, it is solved first, and the other follows: that is where neighbouring
    axes of an arm meet or are parallel. M and N (2, 2), d (2,); scratch (3, 5).

    Rows of cos x, sin x, cos y, sin y go to ``out`` (4, 4). Returns their number, -1 where one
    angle is free.
    """
    largest = 0.0
    for i in range(2):
        for j in range(2):
            largest = max(largest, abs(M[i, j]), abs(N[i, j]))
    det_m = M[0, 0] * M[1, 1] - M[0, 1] * M[1, 0]
    det_n = N[0, 0] * N[1, 1] - N[0, 1] * N[1, 0]
    threshold = TINY * largest * largest
    singular = abs(det_n) <= threshold or abs(det_m) <= threshold
    swapped = abs(det_n) > threshold and (abs(det_m) <= threshold or abs(det_m) < abs(det_n))
    first, second, det = (N, M, det_n) if swapped else (M, N, det_m)
    if singular:
        rows = _one_by_one(first, second, d, slack, out)
    else:
        rows = _two_ellipses(first, second, d, det, slack, scratch, out)
    if swapped:
        for k in range(rows):
            out[k, 0], out[k, 1], out[k, 2], out[k, 3] = out[k, 2], out[k, 3], out[k, 0], out[k, 1]
    return rows


def _one_by_one(M, N, d, slack, out):
    """Solve :func:`circle_pair` where N has rank 1 or 0: first x, then y."""
    first = N[0, 0] * N[0, 0] + N[0, 1] * N[0, 1]
    second = N[1, 0] * N[1, 0] + N[1, 1] * N[1, 1]
    keep = 0 if first >= second else 1
    drop = 1 - keep
    largest = max(first, second)
    ratio = 0.0
    if largest > 0.0:
        ratio = (N[keep, 0] * N[drop, 0] + N[keep, 1] * N[drop, 1]) / largest
    a, b = M[drop, 0] - ratio * M[keep, 0], M[drop, 1] - ratio * M[keep, 1]
    count, c1, s1, c2, s2 = linear_trig(a, b, d[drop] - ratio * d[keep], slack)
    if count < 0:
        return -1
    rows = 0
    for k in range(count):
        c, s = (c1, s1) if k == 0 else (c2, s2)
        rest = d[keep] - M[keep, 0] * c - M[keep, 1] * s
        found, e1, f1, e2, f2 = linear_trig(N[keep, 0], N[keep, 1], rest, slack)
        if found < 0:
            return -1
        for j in range(found):
            e, f = (e1, f1) if j == 0 else (e2, f2)
            out[rows, 0], out[rows, 1], out[rows, 2], out[rows, 3] = c, s, e, f
            rows += 1
    return rows


def _two_ellipses(M, N, d, det, slack, scratch, out):
    """Solve :func:`circle_pair` where M is regular: ``|M^-1 (d - N (c, s))| = 1`` in y."""
    u0 = (M[1, 1] * d[0] - M[0, 1] * d[1]) / det
    u1 = (M[0, 0] * d[1] - M[1, 0] * d[0]) / det
    v0 = -(M[1, 1] * N[0, 0] - M[0, 1] * N[1, 0]) / det
    v1 = -(M[0, 0] * N[1, 0] - M[1, 0] * N[0, 0]) / det
    w0 = -(M[1, 1] * N[0, 1] - M[0, 1] * N[1, 1]) / det
    w1 = -(M[0, 0] * N[1, 1] - M[1, 0] * N[0, 1]) / det
    series, cosines, sines = scratch[0], scratch[1], scratch[2]
    series[0] = u0 * u0 + u1 * u1 + 0.5 * (v0 * v0 + v1 * v1 + w0 * w0 + w1 * w1) - 1.0
    series[1] = 2.0 * (u0 * v0 + u1 * v1)
    series[2] = 2.0 * (u0 * w0 + u1 * w1)
    series[3] = 0.5 * (v0 * v0 + v1 * v1 - w0 * w0 - w1 * w1)
    series[4] = v0 * w0 + v1 * w1
    count = trig_roots(series, 2, cosines, sines)
    scale = 1.0 + u0 * u0 + u1 * u1 + v0 * v0 + v1 * v1 + w0 * w0 + w1 * w1
    rows = 0
    for k in range(count):
        e, f = cosines[k], sines[k]
        c, s = u0 + v0 * e + w0 * f, u1 + v1 * e + w1 * f
        square = c * c + s * s
        if abs(square - 1.0) > abs(slack) * scale:
            continue
        radius = math.sqrt(square)
        out[rows, 0], out[rows, 1], out[rows, 2], out[rows, 3] = c / radius, s / radius, e, f
        rows += 1
    return rows
