"""The hidden joint's values at one pose: place the target, find the roots."""

from dh2urdf.kernels.certificate import TWO_PI
from dh2urdf.kernels.general_6r.arc_roots import SPANS, roots_on_arcs
from dh2urdf.kernels.general_6r.arc_samples import (
    ARC,
    arc_tan,
    circle_arcs,
    circle_places,
    window_arc,
    window_nodes,
)
from dh2urdf.kernels.general_6r.arc_shapes import CENTRE, LEFT, RIGHT
from dh2urdf.kernels.general_6r.resultant import sample_resultants
from dh2urdf.kernels.general_6r.two_slides import hides_solutions, sample_two_slides, says_nothing
from dh2urdf.kernels.numbers import sincos
from dh2urdf.kernels.rigid import dot, load_pose, times_link, turned, turned_back

HOPELESS = 1e-2
"""Noise, as a part of the polynomial's largest coefficient, at which it says nothing."""

QUIET = 1e-10
"""Noise, in the same measure, above which another elimination is asked too."""

MARGIN = 1.1
"""How much wider than a span of doubt its window is."""

NARROWER = 2.4
"""Length, in quarter lengths of a window, below which a span in it is sampled in turn."""

PAIRS = 0.06, 0.03, 0.0, 0.0
"""Where `roots_on_arcs` looks for pairs at an extremum: also where they are complex, for what is
nearly a double root may be one; determinants are not so precise. Last the least noise on the
circle, in parts of the polynomial's largest coefficient."""

EDGE = 1e-7
"""Angle [rad] by which a root may lie outside its span."""


def place_target(T, arm):
    """Set the target T (4, 4), and close the chain with it: seen from joint 1 to joint 6.

    Zeros of slides next to base or tool follow it.
    """
    ends, C, target, size = arm["ends"], arm["chain"][5], arm["target"], arm["size"]
    target[:] = T[:3]
    r = times_link(times_link(load_pose(ends[0]), T), ends[1])
    C[0, 0], C[0, 1], C[0, 2], C[0, 3] = r[0], r[1], r[2], r[3] / size
    C[1, 0], C[1, 1], C[1, 2], C[1, 3] = r[4], r[5], r[6], r[7] / size
    C[2, 0], C[2, 1], C[2, 2], C[2, 3] = r[8], r[9], r[10], r[11] / size
    slides, zeros = arm["slides"], arm["turns"][2]
    for i in range(6):
        if slides[i] != 0:
            zeros[i] = arm["middles"][i]
    if slides[0] != 0:
        px, py, pz = _shorten(0, (C[0, 3], C[1, 3], C[2, 3]), arm)
        C[0, 3], C[1, 3], C[2, 3] = px, py, pz
    if slides[5] != 0:
        # the way from joint 6 to joint 1
        px, py, pz = turned_back(C, (-C[0, 3], -C[1, 3], -C[2, 3]))
        px, py, pz = turned(C, _shorten(5, (px, py, pz), arm))
        C[0, 3], C[1, 3], C[2, 3] = -px, -py, -pz


def _shorten(end, p, arm):
    """Take from a way p between joints 1 and 6 what the slides next to one of them do of it."""
    outer, zeros, size = arm["outer"], arm["turns"][2], arm["size"]
    px, py, pz = p
    sign = 1.0 if end == 0 else -1.0
    for i in range(3):
        j = i if end == 0 else 5 - i
        share = dot(p, (outer[j, 1, 0], outer[j, 1, 1], outer[j, 1, 2]))
        zeros[j] += sign * share * size
        px -= share * outer[j, 0, 0]
        py -= share * outer[j, 0, 1]
        pz -= share * outer[j, 0, 2]
    return px, py, pz


def nudge(pose, t):
    """Move a pose (3, 4), lengths in sizes of the arm, a little, by t.

    At a symmetric pose every determinant may vanish identically; solutions of a pose nearby are
    as good as seeds. A turn by ``2 atan(t)`` about one skew axis and a shift along another.
    """
    x, y, z = 0.36 * t, -0.80 * t, 0.48 * t
    f = 2.0 / (1.0 + t * t)
    for j in range(4):
        a, b, c = pose[0, j], pose[1, j], pose[2, j]
        u, v, w = a + y * c - z * b, b + z * a - x * c, c + x * b - y * a
        pose[0, j] = a + f * (y * w - z * v)
        pose[1, j] = b + f * (z * u - x * w)
        pose[2, j] = c + f * (x * v - y * u)
    pose[0, 3] += 0.64 * t
    pose[1, 3] += 0.48 * t
    pose[2, 3] -= 0.60 * t


def place_samples(k, start, arm):
    """Cosines and sines of the hidden joint to sample at, to ``hidden``.

    On the whole circle from ``start`` [rad] on if k is 0, else on span of doubt k. Returns the
    middle of the first arc [rad] and the tangent of a quarter of its length.
    """
    spans = arm["spans"]
    if k == 0:
        spans[0, 0], spans[1, 0] = 0.0, 0.0
        circle_places(start, arm)
        return start, arc_tan(arm)
    middle = 0.5 * (spans[0, k] + spans[1, k])
    sine, cosine = sincos(0.25 * min(MARGIN * (spans[1, k] - spans[0, k]), 2.0))
    window_nodes(middle, sine / cosine, arm)
    return middle, sine / cosine


def _arcs(k, half_tan, least, arm):
    """Bernstein coefficients of the samples, one arc a column of ``arcs``.

    Returns the noise, at least the part ``least`` of the largest coefficient; negative where the
    polynomial says nothing.
    """
    if k > 0:
        return window_arc(half_tan, arm)
    noise, largest = circle_arcs(arm)
    arm["spans"][1, 0] = 1.0 if noise > QUIET * largest else 0.0
    return max(noise, least * largest) if noise < HOPELESS * largest else -1.0


def _keep(roots, slopes, first, count, low, high, inside):
    """Of the roots from ``first`` on keep those inside, or outside, of an interval."""
    kept = first
    for r in range(first, count):
        if (low - EDGE <= roots[r] <= high + EDGE) == inside:
            roots[kept], slopes[kept] = roots[r], slopes[r]
            kept += 1
    return kept


def add_roots(k, middle, half_tan, pairs, count, arm):
    """Roots of the polynomial and its slopes there, to ``roots`` and ``slopes``; their number.

    From samples placed by `place_samples` in turn, first on the whole circle. Spans of doubt that
    this leaves, ``spans[0, 0]`` of them, are to be sampled each on its own, and so are spans still
    in doubt within one that are much narrower; the roots there are replaced. ``spans[1, 0]`` is
    set to 1 if doubt remains. -1 where the polynomial says nothing.
    """
    arcs, roots, slopes = arm["arcs"], arm["roots"], arm["slopes"]
    spans, fresh = arm["spans"], arm["fresh"]
    noise = _arcs(k, half_tan, pairs[3], arm)
    if noise < 0.0:
        return -1
    lanes, terms = arm["hidden"].shape[1], len(arm["turned"])
    first, number, step = count, lanes if k == 0 else 1, TWO_PI / lanes
    fresh[0, 0], fresh[1, 0] = 0.0, 0.0
    for arc in range(number):
        arcs[terms + LEFT, arc], arcs[terms + RIGHT, arc] = -half_tan, half_tan
        arcs[terms + CENTRE, arc] = middle + arc * step
    count = roots_on_arcs(number, noise, pairs, count, arm)
    if fresh[1, 0] > 0.0:
        spans[1, 0] = 1.0
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
    return count


def find_roots(arm):
    """Roots of the six equations' resultant, or of what two slides have, as by `add_roots`."""
    count, k = 0, 0
    if arm["two_slides"] != 0 and hides_solutions(arm):
        return -1
    # a slide is sampled neither at infinity nor next to it
    start = 0.5 * ARC if arm["loop_slides"][2] != 0 else 0.0
    while count >= 0 and (k == 0 or k <= arm["spans"][0, 0]):
        middle, half_tan = place_samples(k, start, arm)
        if arm["two_slides"] == 0:
            sample_resultants(arm["hidden"].shape[1], arm)
        else:
            sample_two_slides(arm["hidden"].shape[1], arm)
            if k == 0 and says_nothing(arm["hidden"].shape[1], arm):
                return -1
        count = add_roots(k, middle, half_tan, PAIRS, count, arm)
        k += 1
    return count
