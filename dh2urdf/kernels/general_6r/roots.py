"""The hidden joint's values at one pose: place the target, find the roots."""

from dh2urdf.kernels.general_6r.arc_roots import SPANS, roots_on_arc
from dh2urdf.kernels.general_6r.arc_samples import (
    ARC,
    ARC_TAN,
    CIRCLE_COS,
    CIRCLE_SIN,
    TERMS,
    circle_arcs,
    window_arc,
    window_nodes,
)
from dh2urdf.kernels.general_6r.resultant import resultants
from dh2urdf.kernels.numbers import LANES, sincos
from dh2urdf.kernels.rigid import load_pose, times_link

HOPELESS = 1e-2
"""Noise, as a part of the polynomial's largest coefficient, at which it says nothing."""

QUIET = 1e-10
"""Noise, in the same measure, above which another elimination is asked too."""

MARGIN = 1.1
"""How much wider than a span of doubt its window is."""

NARROWER = 2.4
"""Length, in quarter lengths of a window, below which a span in it is sampled in turn."""

EDGE = 1e-7
"""Angle [rad] by which a root may lie outside its span."""

NUDGE = 1e-3
"""Size of a nudge: tangent of half its angle, and shift in parts of the arm's size."""


def place_target(T, arm):
    """Set the target T (4, 4), and close the chain with it: seen from joint 1 to joint 6."""
    ends, C, target, size = arm["ends"], arm["chain"][5], arm["target"], arm["size"]
    target[:] = T[:3]
    r = times_link(times_link(load_pose(ends[0]), T), ends[1])
    C[0, 0], C[0, 1], C[0, 2], C[0, 3] = r[0], r[1], r[2], r[3] / size
    C[1, 0], C[1, 1], C[1, 2], C[1, 3] = r[4], r[5], r[6], r[7] / size
    C[2, 0], C[2, 1], C[2, 2], C[2, 3] = r[8], r[9], r[10], r[11] / size


def nudge(target, attempt):
    """Move the ``target`` of the eliminations (3, 4) a little, another way at each attempt.

    At a symmetric pose every determinant may vanish identically; solutions of a pose nearby are
    as good as seeds. Where solutions crowd, each attempt takes it further. A turn by
    ``2 atan(NUDGE)`` about one skew axis and a shift along another.
    """
    t = NUDGE if attempt == 1 else -1.7 * NUDGE
    x, y, z = 0.36 * t, -0.80 * t, 0.48 * t
    f = 2.0 / (1.0 + t * t)
    for j in range(4):
        a, b, c = target[0, j], target[1, j], target[2, j]
        u, v, w = a + y * c - z * b, b + z * a - x * c, c + x * b - y * a
        target[0, j] = a + f * (y * w - z * v)
        target[1, j] = b + f * (z * u - x * w)
        target[2, j] = c + f * (x * v - y * u)
    target[0, 3] += 0.64 * t
    target[1, 3] += 0.48 * t
    target[2, 3] -= 0.60 * t


def _sample(k, arm):
    """Bernstein coefficients from new samples, one arc a column of ``arcs``.

    The whole circle if k is 0, else span of doubt k. Returns how many arcs, none where the
    polynomial says nothing; middle of the first [rad], tangent of a quarter of their length, noise.
    """
    determinant, series, arcs = arm["determinant"], arm["series"], arm["arcs"]
    spans, hidden, beta = arm["spans"], arm["hidden"], arm["beta"]
    middle, half_tan = 0.0, ARC_TAN
    if k == 0:
        hidden[0], hidden[1] = CIRCLE_COS, CIRCLE_SIN
    else:
        middle = 0.5 * (spans[0, k] + spans[1, k])
        sine, cosine = sincos(0.25 * min(MARGIN * (spans[1, k] - spans[0, k]), 2.0))
        half_tan = sine / cosine
        window_nodes(middle, half_tan, hidden)
    lanes = hidden.shape[1]
    resultants(arm["equations"], hidden, lanes, arm["A"], arm["W"], determinant, arm["V"], beta)
    if k > 0:
        return 1, middle, half_tan, window_arc(determinant, half_tan, series, arcs)
    noise, largest = circle_arcs(determinant, series, arm["turned"], arcs)
    spans[1, 0] = 1.0 if noise > QUIET * largest else 0.0
    return (LANES if noise < HOPELESS * largest else 0), middle, half_tan, noise


def _keep(roots, slopes, first, count, low, high, inside):
    """Of the roots from ``first`` on keep those inside, or outside, of an interval."""
    kept = first
    for r in range(first, count):
        if (low - EDGE <= roots[r] <= high + EDGE) == inside:
            roots[kept], slopes[kept] = roots[r], slopes[r]
            kept += 1
    return kept


def find_roots(arm):
    """Roots of the polynomial and its slopes there, to ``roots`` and ``slopes``.

    First on the whole circle. Spans of doubt that this leaves are sampled each on its own, and so
    are spans still in doubt within one that are much narrower; the roots there are replaced.
    ``spans[1, 0]`` is set to 1 if doubt remains. Returns the number of roots; -1 where the
    polynomial says nothing.
    """
    arcs, stack, roots, slopes = arm["arcs"], arm["stack"], arm["roots"], arm["slopes"]
    spans, fresh, casteljau = arm["spans"], arm["fresh"], arm["casteljau"]
    count, k = 0, 0
    spans[0, 0] = 0.0
    while k <= spans[0, 0]:
        number, middle, half_tan, noise = _sample(k, arm)
        if number == 0:
            return -1
        first = count
        fresh[0, 0] = 0.0
        for arc in range(number):
            for i in range(TERMS):
                stack[0, i] = arcs[i, arc]
            count = roots_on_arc(
                stack, middle + arc * ARC, half_tan, noise, casteljau, fresh, count, roots, slopes
            )
        if k > 0:
            count = _keep(roots, slopes, first, count, spans[0, k], spans[1, k], True)
        last = int(spans[0, 0])
        for n in range(1, int(fresh[0, 0]) + 1):
            low, high = fresh[0, n], fresh[1, n]
            if last < SPANS and (k == 0 or high - low < NARROWER * half_tan):
                count = _keep(roots, slopes, first, count, low, high, False)
                last += 1
                spans[0, last], spans[1, last] = low, high
            else:
                spans[1, 0] = 1.0
        spans[0, 0] = last
        k += 1
    return count
