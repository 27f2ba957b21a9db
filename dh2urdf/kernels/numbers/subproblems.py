"""Canonical subproblems 1 to 6 and their twins with sliding joints.

Numbered as by Elias and Wen, "IK-Geo" (arXiv 2211.05737); 1 to 3 are those of Paden (1986) and
Kahan (1983). ``R(k, x)`` turns by x about the unit vector k. Vectors are tuples of three floats.
None of them judges feasibility finely: what misses by less than ``slack`` (relative) is solved
in the least-squares sense, and the residual of the chain decides.

Every function returns a count first: the number of solutions, 0 where it is out of reach, -1
where the unknown is free; then the solutions, repeated or 0 beyond the count.
"""

from __future__ import annotations

import math

import numpy as np

from dh2urdf.kernels.numbers.circles import circle_pair
from dh2urdf.kernels.numbers.compiled import inner_kernel, kernel
from dh2urdf.kernels.numbers.trig import linear_trig, real_quadratic

__all__ = ["sp1", "sp2", "sp3", "sp4", "sp5", "sp6", "sp_slide1", "sp_slide2", "sp_slide3"]
__all__ += ["sp_slide4", "sp_turn_slide"]


@inner_kernel
def _dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@inner_kernel
def _cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


@inner_kernel
def _plus(a, x, b):
    """Return ``a + x b``."""
    return a[0] + x * b[0], a[1] + x * b[1], a[2] + x * b[2]


@inner_kernel
def _plane_terms(h, p, k):
    """``h . R(k, x) p = constant + cosine cos(x) + sine sin(x)`` (Rodrigues)."""
    along = _dot(k, p) * _dot(h, k)
    return along, _dot(h, p) - along, _dot(h, _cross(k, p))


@inner_kernel
def _turned(p, k, c, s):
    """``R(k, x) p`` from the cosine and sine of x."""
    along = (1.0 - c) * _dot(k, p)
    q = _cross(k, p)
    return (
        c * p[0] + s * q[0] + along * k[0],
        c * p[1] + s * q[1] + along * k[1],
        c * p[2] + s * q[2] + along * k[2],
    )


@kernel
def sp1(p1, p2, k):
    """Subproblem 1, ``R(k, x) p1 = p2``: returns (count, x)."""
    s = _dot(_cross(k, p1), p2)
    c = _dot(p1, p2) - _dot(k, p1) * _dot(k, p2)
    if s * s + c * c < 1e-300:
        return -1, 0.0
    return 1, math.atan2(s, c)


@kernel
def sp2(p1, p2, k1, k2, slack):
    """Subproblem 2, ``R(k1, x) p1 = R(k2, y) p2``: returns (count, x1, y1, x2, y2).

    The component along k2 is a subproblem 4 in x; subproblem 1 gives y.
    """
    constant, cosine, sine = _plane_terms(k2, p1, k1)
    count, c1, s1, c2, s2 = linear_trig(cosine, sine, _dot(k2, p2) - constant, slack)
    if count == 0:
        return 0, 0.0, 0.0, 0.0, 0.0
    free1, y1 = sp1(p2, _turned(p1, k1, c1, s1), k2)
    free2, y2 = sp1(p2, _turned(p1, k1, c2, s2), k2)
    if free1 < 0 or free2 < 0:
        count = -1
    return count, math.atan2(s1, c1), y1, math.atan2(s2, c2), y2


@kernel
def sp3(p1, p2, k, distance, slack):
    """Subproblem 3, ``|R(k, x) p1 - p2| = distance``: returns (count, x1, x2)."""
    constant, cosine, sine = _plane_terms(p2, p1, k)
    level = 0.5 * (_dot(p1, p1) + _dot(p2, p2) - distance * distance)
    count, c1, s1, c2, s2 = linear_trig(cosine, sine, level - constant, slack)
    return count, math.atan2(s1, c1), math.atan2(s2, c2)


@kernel
def sp4(h, p, k, distance, slack):
    """Subproblem 4, ``h . R(k, x) p = distance``: returns (count, x1, x2)."""
    constant, cosine, sine = _plane_terms(h, p, k)
    count, c1, s1, c2, s2 = linear_trig(cosine, sine, distance - constant, slack)
    return count, math.atan2(s1, c1), math.atan2(s2, c2)


@kernel
def sp6(h, p, k1, k2, d1, d2, slack, out):
    """Subproblem 6, two equations in two angles: returns the count.

    ``h[0] . R(k1, x) p[0] + h[1] . R(k2, y) p[1] = d1`` and
    ``h[2] . R(k1, x) p[2] + h[3] . R(k2, y) p[3] = d2``; ``out`` (4, 2): rows of x, y.
    """
    M, N, d = np.empty((2, 2)), np.empty((2, 2)), np.empty(2)
    one, M[0, 0], M[0, 1] = _plane_terms(h[0], p[0], k1)
    two, N[0, 0], N[0, 1] = _plane_terms(h[1], p[1], k2)
    d[0] = d1 - one - two
    one, M[1, 0], M[1, 1] = _plane_terms(h[2], p[2], k1)
    two, N[1, 0], N[1, 1] = _plane_terms(h[3], p[3], k2)
    d[1] = d2 - one - two
    found = np.empty((4, 4))
    count = circle_pair(M, N, d, slack, np.empty((3, 5)), found)
    for i in range(count):
        out[i, 0] = math.atan2(found[i, 1], found[i, 0])
        out[i, 1] = math.atan2(found[i, 3], found[i, 2])
    return count


@kernel
def sp5(p0, p1, p2, p3, k1, k2, k3, slack, out):
    """Subproblem 5, ``p0 + R(k1, x) p1 = R(k2, y) (p2 + R(k3, z) p3)``: returns the count.

    y leaves the component along k2 and the length unchanged: two equations in x and z, which
    are a subproblem 6; y is a subproblem 1 (Pieper 1968). ``out`` (4, 3): rows of x, y, z.
    """
    minus, found = _plus((0.0, 0.0, 0.0), -1.0, p3), np.empty((4, 2))
    level = _dot(k2, _plus(p2, -1.0, p0))
    length = 0.5 * (_dot(p2, p2) + _dot(p3, p3) - _dot(p0, p0) - _dot(p1, p1))
    h, p = (k2, k2, p0, p2), (p1, minus, p1, minus)
    count = sp6(h, p, k1, k3, level, length, slack, found)
    for i in range(count):
        x, z = found[i]
        left = _plus(p0, 1.0, _turned(p1, k1, math.cos(x), math.sin(x)))
        right = _plus(p2, 1.0, _turned(p3, k3, math.cos(z), math.sin(z)))
        out[i, 0], out[i, 1], out[i, 2] = x, sp1(right, left, k2)[1], z
    return count


@kernel
def sp_slide1(p1, p2, k):
    """Twin of 1, ``p1 + x k = p2``: returns (count, x)."""
    return 1, _dot(k, _plus(p2, -1.0, p1))


@kernel
def sp_slide2(p1, p2, k1, k2):
    """Twin of 2, ``p1 + x k1 = p2 + y k2``: returns (count, x, y)."""
    gap = _plus(p2, -1.0, p1)
    cosine = _dot(k1, k2)
    normal = _cross(k1, k2)
    square = _dot(normal, normal)
    if square < 1e-24:
        return -1, _dot(gap, k1), 0.0
    along1, along2 = _dot(gap, k1), _dot(gap, k2)
    return 1, (along1 - cosine * along2) / square, (cosine * along1 - along2) / square


@kernel
def sp_slide3(p1, p2, k, distance, slack):
    """Twin of 3, ``|p1 + x k - p2| = distance``: returns (count, x1, x2)."""
    gap = _plus(p1, -1.0, p2)
    return real_quadratic(1.0, _dot(k, gap), _dot(gap, gap) - distance * distance, slack)


@kernel
def sp_slide4(h, p, k, distance):
    """Twin of 4, ``h . (p + x k) = distance``: returns (count, x)."""
    slope = _dot(h, k)
    if slope * slope <= 1e-24 * _dot(h, h):
        return -1, 0.0
    return 1, (distance - _dot(h, p)) / slope


@kernel
def sp_turn_slide(p1, p2, k1, k2, slack):
    """Mixed twin of 2, ``R(k1, x) p1 = p2 + y k2``: returns (count, x1, y1, x2, y2).

    A line meets a circle: in its plane where k2 is oblique to it, one solution; two where k2
    lies in the plane.
    """
    slope = _dot(k1, k2)
    level = _dot(k1, p1) - _dot(k1, p2)
    if abs(slope) > 1e-12:
        count, y1, y2 = 1, level / slope, level / slope
    else:
        foot = _plus(p2, -_dot(k1, p2), k1)
        spoke = _plus(p1, -_dot(k1, p1), k1)
        constant = _dot(foot, foot) - _dot(spoke, spoke)
        count, y1, y2 = real_quadratic(1.0, _dot(foot, k2), constant, slack)
    free1, x1 = sp1(p1, _plus(p2, y1, k2), k1)
    free2, x2 = sp1(p1, _plus(p2, y2, k2), k1)
    if count > 0 and (free1 < 0 or free2 < 0):
        count = -1
    return count, x1, y1, x2, y2
