"""Two slides among six joints: from a root of their equation to all six joints.

Of the two solutions for turn e at a value of turn a, the one that closes the loop; c from the axes
before and after it, the slides from their directions and the way that is left.
"""

import math

from dh2urdf.kernels.general_6r.two_slides import (
    B_X,
    B_Y,
    B_Z,
    COS_B,
    COS_E,
    E_X,
    E_Y,
    E_Z,
    FIRST,
    SECOND,
    SIN_B,
    SIN_E,
    SQUARE,
    TINY,
    WAY,
    F,
)
from dh2urdf.kernels.numbers import LANES, side_by_side
from dh2urdf.kernels.rigid import dot

VOID = 1e-5
"""Sine of the angle between the slides at a root that is one of that angle."""

ASIDE = 1e-3
"""How far their way is then from closing the loop at least, in parts of the arm's size."""


def _at(pairs, row, k, w):
    """A pair of vectors at a value of w."""
    return (
        pairs[row, k] + w * pairs[row + 3, k],
        pairs[row + 1, k] + w * pairs[row + 4, k],
        pairs[row + 2, k] + w * pairs[row + 5, k],
    )


def joints_of_two_slides(n, copies, slopes, arm):
    """All six joints of the loop at n roots a; of two copies of a root, with either sign of w.

    Lengths, in parts of the size, are where sines are of joints that turn. Where nothing but the
    angle between the slides vanishes, the root's slope is set to 0: it counts where it leads.
    """
    cosines, sines, pairs = arm["loop_cosines"], arm["loop_sines"], arm["pairs_of_slides"]
    turning, sliding, S, R = arm["turning"], arm["sliding"], arm["segments"][1], arm["segments"][2]
    b, c, e = turning[1] * LANES, turning[2] * LANES, turning[3] * LANES
    first, second = sliding[0] * LANES, sliding[1] * LANES
    for k in side_by_side(n):
        w = math.sqrt(max(pairs[SQUARE, k], 0.0))
        f, g = pairs[F, k] + w * pairs[F + 1, k], pairs[F, k] - w * pairs[F + 1, k]
        other = abs(g) < abs(f) if copies == 1 else k % 2 == 1
        w = -w if other else w
        cos_e, sin_e = pairs[COS_E, k], pairs[SIN_E, k]
        cos_e, sin_e = cos_e + w * pairs[COS_E + 1, k], sin_e + w * pairs[SIN_E + 1, k]
        cos_b, sin_b = pairs[COS_B, k], pairs[SIN_B, k]
        cos_b, sin_b = cos_b + w * pairs[COS_B + 1, k], sin_b + w * pairs[SIN_B + 1, k]
        x, y, z = _at(pairs, B_X, k, w), _at(pairs, B_Y, k, w), _at(pairs, B_Z, k, w)
        u, v, t = _at(pairs, E_X, k, w), _at(pairs, E_Y, k, w), _at(pairs, E_Z, k, w)
        # axis x of c: turned, by way of e; not yet, by way of b, with axis y
        after = _sum(u, v, t, (R[0, 0], R[0, 1], R[0, 2]))
        cos_c = dot(after, _sum(x, y, z, (S[0, 0], S[1, 0], S[2, 0])))
        sin_c = dot(after, _sum(x, y, z, (S[0, 1], S[1, 1], S[2, 1])))
        cosines[b + k], sines[b + k] = _unit(cos_b, sin_b)
        cosines[c + k], sines[c + k] = _unit(cos_c, sin_c)
        cosines[e + k], sines[e + k] = _unit(cos_e, sin_e)
        way = _at(pairs, WAY, k, w)
        one, two = _at(pairs, FIRST, k, w), _at(pairs, SECOND, k, w)
        along, ahead, aside = dot(one, two), -dot(one, way), -dot(two, way)
        square = 1.0 - along * along
        h = 1.0 / max(square, VOID * VOID)
        cosines[first + k], cosines[second + k] = 1.0, 1.0
        sines[first + k] = (ahead - along * aside) * h
        sines[second + k] = (aside - along * ahead) * h
        far = dot(way, way) - ahead * ahead > ASIDE * ASIDE
        if copies == 1 and slopes[k] > 0.0 and square < VOID * VOID and far:
            slopes[k] = 0.0


def _sum(x, y, z, v):
    """``x v_x + y v_y + z v_z``."""
    return (
        x[0] * v[0] + y[0] * v[1] + z[0] * v[2],
        x[1] * v[0] + y[1] * v[1] + z[1] * v[2],
        x[2] * v[0] + y[2] * v[1] + z[2] * v[2],
    )


def _unit(c, s):
    """A point of the circle."""
    h = 1.0 / (math.sqrt(c * c + s * s) + TINY)
    return c * h, s * h
