"""A trigonometric polynomial of degree 8 in joint 1, without determinants, roots or branches.

Seen after joint 1, in axes whose z is the direction h of axes 2 and 3, the target gives a direction
``l`` of axis 6 and a way ``u`` from axis 2 to a point of axis 6, both linear in (1, cos, sin) of
joint 1. Joints 2 and 3 keep heights over the plane normal to h, so that ``c1 = h.l`` and
``c2 = h.u - h.r3`` say how the unit vectors ``m = R4^T h`` and ``w = R5^T m`` lie:

    axis 4 meets 5:  w.h6 = c1, w.r5 = c2,    then  m.h4 = h.h4, m.h5 = w.h5
    axis 5 meets 6:  m.h4 = h.h4, m.r4 = c2,  then  w.h6 = c1,   w.h5 = m.h5

Each of the two steps leaves a sign, that of a square root s and of another t. The planar arm of
joints 2 and 3 reaches where ``f = delta S + Zr G + Zi t = 0``, with U the plane's complex number
``conj(u) l``. The product over the sign of t, divided by delta, is ``x + y s``, a pair; that over
the sign of s a polynomial ``F = x^2 - s^2 y^2`` with sixteen roots, as many as solutions.
"""

from typing import Annotated, NamedTuple

from dh2urdf.kernels.numbers import side_by_side
from dh2urdf.kernels.rigid import dot
from dh2urdf.kernels.shapes import Floats, Integers


class TwoParallel(NamedTuple):
    """An arm with axes 2 and 3 parallel, as lines at q = 0.

    The frame has its origin on axis 1, its z along axes 2 and 3.

    Attributes
    ----------
    ends : array, shape (2, 4, 4)
        ``ends[0] T ends[1]``: how the tool at T is displaced from where it is at q = 0.
    axes : array, shape (7, 3)
        Directions, and a normal of the last one.
    steps : array, shape (6, 3)
        Row i leads from a point of axis i to one of axis i + 1; row 2 is normal to z, row 4 is zero
        where axis 4 meets 5, row 5 where 5 meets 6; otherwise normal to axis 6, or to axis 4.
    joints : int array, shape (6,)
        The joint of each axis.
    signs : array, shape (6,)
        -1.0 where it turns the other way.
    mirrored : int
        1 where the first axis is that of the last joint.
    """

    ends: Annotated[Floats, 2, 4, 4]
    axes: Annotated[Floats, 7, 3]
    steps: Annotated[Floats, 6, 3]
    joints: Annotated[Integers, 6]
    signs: Annotated[Floats, 6]
    mirrored: int


def vector(row):
    """A row of three as scalars."""
    return row[0], row[1], row[2]


def cross(a, b):
    """Vector product."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def seen_from(seen, row, c, s):
    """A vector after joint 1, of which ``seen`` has constant, cosine and sine from a row on."""
    return (
        seen[row, 0] + c * seen[row + 1, 0] + s * seen[row + 2, 0],
        seen[row, 1] + c * seen[row + 1, 1] + s * seen[row + 2, 1],
        seen[row, 2] + c * seen[row + 1, 2] + s * seen[row + 2, 2],
    )


def _product(p, q, s2):
    """``(p0 + p1 s) (q0 + q1 s)`` as a pair."""
    return p[0] * q[0] + s2 * (p[1] * q[1]), p[0] * q[1] + p[1] * q[0]


def _norm(p, s2):
    """``(p0 + p1 s) (p0 - p1 s)``."""
    return p[0] * p[0] - s2 * (p[1] * p[1])


def along(r3, h4):
    """How r3 lies in the plane: y and z of ``r3 = y h4 + z (h x h4)``, and the part of h4 there."""
    square = h4[0] * h4[0] + h4[1] * h4[1]
    y = (r3[0] * h4[0] + r3[1] * h4[1]) / square
    return y, (h4[0] * r3[1] - h4[1] * r3[0]) / square, square


def _plane(seen, c, s):
    """c1, height and square of u, ``1 - c1^2``, U."""
    u, v = seen_from(seen, 0, c, s), seen_from(seen, 3, c, s)
    a = v[0] * v[0] + v[1] * v[1]
    return (
        v[2],
        u[2],
        u[0] * u[0] + u[1] * u[1],
        a,
        (u[0] * v[0] + u[1] * v[1], u[0] * v[1] - u[1] * v[0]),
    )


def _sample_first(form, seen, hidden, n, values):
    """F where axis 4 meets axis 5."""
    _, axes, steps, _, _, _ = form
    h4, h5, h6, r5 = (vector(axes[3]), vector(axes[4]), vector(axes[5]), vector(steps[5]))
    r3, r2 = vector(steps[3]), vector(steps[2])
    y, z, square = along(r3, h4)
    reach, yz = square * (y * y + z * z) - dot(r2, r2), 4.0 * (y * y + z * z)
    height, eta, k, k56, r55, r55n = (
        r3[2],
        h4[2],
        dot(h4, h5),
        dot(h5, h6),
        dot(h5, r5),
        dot(r5, r5),
    )
    d = dot(cross(h6, r5), h5)
    for i in side_by_side(n):
        c1, up, uu, a, (ur, ui) = _plane(seen, hidden[0, i], hidden[1, i])
        c2 = up - height
        # w = c1 h6 + g r5 + s (h6 x r5) / r5^2
        g = c2 / r55n
        s2 = r55n * (1.0 - c1 * c1 - g * c2)
        e = c1 * k56 + g * r55, d / r55n
        ee, ee1 = _product(e, e, s2)
        delta = 1.0 - ee, -ee1
        t2 = square - k * k + 2.0 * eta * k * e[0] - ee, 2.0 * eta * k * e[1] - ee1
        G = k - eta * e[0], -eta * e[1]
        nu, nu6 = (-c1 * d, k56), (g * d, -r55 / r55n)
        E = a * (r55n - c2 * c2 + uu) + 2.0 * ur * c1 * c2, 2.0 * ui
        S = E[0] + reach * a, E[1]
        mu, mu6 = (r55 - e[0] * c2, -e[1] * c2), (k56 - e[0] * c1, -e[1] * c1)
        re = a * mu[0] - ur * mu6[0] - ui * nu6[0], a * mu[1] - ur * mu6[1] - ui * nu6[1]
        im = ur * nu6[0] - ui * mu6[0] - a * nu[0], ur * nu6[1] - ui * mu6[1] - a * nu[1]
        Z = 2.0 * (y * re[0] - z * im[0]), 2.0 * (y * re[1] - z * im[1])
        # delta S^2 + 2 S Zr G + (1 - eta^2) Zr^2 - 4 (y^2 + z^2) a t^2 E
        SS, SZ, ZZ = _product(S, S, s2), _product(S, Z, s2), _product(Z, Z, s2)
        P, Q, R = _product(delta, SS, s2), _product(SZ, G, s2), _product(t2, E, s2)
        x = P[0] + 2.0 * Q[0] + square * ZZ[0] - yz * a * R[0]
        b = P[1] + 2.0 * Q[1] + square * ZZ[1] - yz * a * R[1]
        a = max(a, LEAST)
        values[i] = _norm((x, b), s2) / (a * a)


LEAST = 1e-12
"""Square of the sine between axis 6 and h below which F says nothing."""


def _sample_last(form, seen, hidden, n, values):
    """F where axis 5 meets axis 6."""
    _, axes, steps, _, _, _ = form
    h4, h5, h6, r4 = (vector(axes[3]), vector(axes[4]), vector(axes[5]), vector(steps[4]))
    r3, r2 = vector(steps[3]), vector(steps[2])
    y, z, square = along(r3, h4)
    r44 = dot(r4, r4)
    fixed = square * (y * y + z * z) + r44
    height, eta, k, k56, r45 = r3[2], h4[2], dot(h4, h5), dot(h5, h6), dot(h5, r4)
    d, r22 = dot(cross(h4, r4), h5), dot(r2, r2)
    for i in side_by_side(n):
        c1, up, uu, a, (ur, ui) = _plane(seen, hidden[0, i], hidden[1, i])
        c2 = up - height
        # m = eta h4 + g r4 + s (h4 x r4) / r4^2
        g = c2 / r44
        s2 = r44 * (square - g * c2)
        e = eta * k + g * r45, d / r44
        ee, ee1 = _product(e, e, s2)
        delta = 1.0 - ee, -ee1
        t2 = a - k56 * k56 + 2.0 * c1 * k56 * e[0] - ee, 2.0 * c1 * k56 * e[1] - ee1
        G = k56 - c1 * e[0], -c1 * e[1]
        # square of R4^T v across m, and v.h5, m.(v x h5)
        V = fixed - c2 * c2 - 2.0 * y * eta * c2, 2.0 * z
        S = uu + V[0] - r22, V[1]
        turn = -g * d, r45 / r44
        re = (
            y * (k - eta * e[0]) + z * turn[0] + r45 - c2 * e[0],
            (z * turn[1] - (y * eta + c2) * e[1]),
        )
        im = y * turn[0] + z * (eta * e[0] - k) + eta * d, y * turn[1] + z * eta * e[1] - k
        Z = -2.0 * (ur * re[0] + ui * im[0]), -2.0 * (ur * re[1] + ui * im[1])
        # a delta S^2 + 2 S Zr G + Zr^2 - 4 u^2 v^2 t^2
        SS, SZ, ZZ = _product(S, S, s2), _product(S, Z, s2), _product(Z, Z, s2)
        P, Q, R = _product(delta, SS, s2), _product(SZ, G, s2), _product(V, t2, s2)
        x = a * P[0] + 2.0 * Q[0] + ZZ[0] - 4.0 * uu * R[0]
        b = a * P[1] + 2.0 * Q[1] + ZZ[1] - 4.0 * uu * R[1]
        values[i] = _norm((x, b), s2)


def sample(form, seen, hidden, n, values):
    """F at n values of joint 1, of which ``hidden`` (2, 24) has cosines and sines."""
    _, _, steps, _, _, _ = form
    r4 = vector(steps[4])
    if dot(r4, r4) == 0.0:
        _sample_first(form, seen, hidden, n, values)
    else:
        _sample_last(form, seen, hidden, n, values)
