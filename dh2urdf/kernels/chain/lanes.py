"""Forward kinematics of a block of configurations, side by side.

A block has ``BLOCK`` configurations, one a lane. The pose of a lane is twelve entries of one flat
array, entry e of lane i at ``S[BLOCK * e + i]``, and every loop over the lanes has a constant
length and no branch, which the compiler turns into vector instructions.
"""

from dh2urdf.kernels.numbers import side_by_side

BLOCK = 64
COS, SIN, ROWS = 12, 13, 14
"""Rows of S beyond the pose, and their number."""
LARGEST = 6000.0
"""Angle [rad] up to which the reduction to a quarter turn is exact to rounding."""

TWO_OVER_PI = 0.6366197723675814
QUARTER = (1.5707963267341256, 6.077100506303966e-11, 2.0222662487959506e-21)
"""pi / 2 as a sum; the first two parts have 33 bits, so their multiples are exact."""
NEAREST = 6755399441055744.0
"""1.5 * 2**52: added and taken away again, it leaves the nearest integer."""

S1, S2, S3 = -1.66666666666666324348e-01, 8.33333333332248946124e-03, -1.98412698298579493134e-04
S4, S5, S6 = 2.75573137070700676789e-06, -2.50507602534068634195e-08, 1.58969099521155010221e-10
C1, C2, C3 = 4.16666666666666019037e-02, -1.38888888888741095749e-03, 2.48015872894767294178e-05
C4, C5, C6 = -2.75573143513906633035e-07, 2.08757232129817482790e-09, -1.13596475577881948265e-11
"""Least maximum polynomials of sine and cosine on +-pi/4, published with fdlibm's k_sin, k_cos."""


def cosine_sine(x):
    """Cosine and sine of an angle up to ``LARGEST`` without branches, within 2e-16.

    ``x = k pi/2 + r`` with ``|r| <= pi/4``; the quadrant k picks polynomial and sign.
    """
    k = (x * TWO_OVER_PI + NEAREST) - NEAREST
    r = ((x - k * QUARTER[0]) - k * QUARTER[1]) - k * QUARTER[2]
    z = r * r
    s = r + r * z * (S1 + z * (S2 + z * (S3 + z * (S4 + z * (S5 + z * S6)))))
    c = C1 + z * (C2 + z * (C3 + z * (C4 + z * (C5 + z * C6))))
    c = 1.0 - 0.5 * z + z * z * c
    half = (0.5 * k - 0.25 + NEAREST) - NEAREST
    quarter = (0.5 * half - 0.25 + NEAREST) - NEAREST
    odd = k != 2.0 * half
    sign = 1.0 - 2.0 * (half - 2.0 * quarter)
    return sign * (-s if odd else c), sign * (c if odd else s)


def sincos_lanes(x, S):
    """Cosine and sine of BLOCK angles x (up to ``LARGEST``) to their rows of S."""
    for i in side_by_side(BLOCK):
        S[BLOCK * COS + i], S[BLOCK * SIN + i] = cosine_sine(x[i])


def _start(link, S):
    """All lanes at a link's pose."""
    for r in range(3):
        for c in range(4):
            value = link[r, c]
            for i in side_by_side(BLOCK):
                S[BLOCK * (4 * r + c) + i] = value


def _turn_and_step(link, S):
    """``T Rot_z(q) link`` in all lanes."""
    a00, a01, a02, a03 = link[0, 0], link[0, 1], link[0, 2], link[0, 3]
    a10, a11, a12, a13 = link[1, 0], link[1, 1], link[1, 2], link[1, 3]
    a20, a21, a22, a23 = link[2, 0], link[2, 1], link[2, 2], link[2, 3]
    for i in side_by_side(BLOCK):
        c, s = S[BLOCK * COS + i], S[BLOCK * SIN + i]
        for r in range(3):
            u, v = S[BLOCK * 4 * r + i], S[BLOCK * (4 * r + 1) + i]
            z, p = S[BLOCK * (4 * r + 2) + i], S[BLOCK * (4 * r + 3) + i]
            x, y = u * c + v * s, v * c - u * s
            S[BLOCK * 4 * r + i] = x * a00 + y * a10 + z * a20
            S[BLOCK * (4 * r + 1) + i] = x * a01 + y * a11 + z * a21
            S[BLOCK * (4 * r + 2) + i] = x * a02 + y * a12 + z * a22
            S[BLOCK * (4 * r + 3) + i] = x * a03 + y * a13 + z * a23 + p


def _slide(x, S):
    """``T Trans_z(q)`` in all lanes; the cosines and sines become those of no turn."""
    for i in side_by_side(BLOCK):
        for r in range(3):
            S[BLOCK * (4 * r + 3) + i] += S[BLOCK * (4 * r + 2) + i] * x[i]
        S[BLOCK * COS + i], S[BLOCK * SIN + i] = 1.0, 0.0


def fits(q):
    """Whether every value of q (BLOCK, n) is a number up to ``LARGEST``."""
    outside = 0.0
    for i in side_by_side(BLOCK):
        for j in range(q.shape[1]):
            outside += 0.0 if abs(q[i, j]) <= LARGEST else 1.0
    return outside == 0.0


def lanes_fk(links, prismatic, q, T, x, S):
    """``T_base_tool`` T (BLOCK, 4, 4) of configurations q (BLOCK, n).

    x and S are room for BLOCK and for ROWS * BLOCK numbers.
    """
    _start(links[0], S)
    for j in range(q.shape[1]):
        for i in side_by_side(BLOCK):
            x[i] = q[i, j]
        if prismatic[j]:
            _slide(x, S)
        else:
            sincos_lanes(x, S)
        _turn_and_step(links[j + 1], S)
    for i in side_by_side(BLOCK):
        for r in range(3):
            for c in range(4):
                T[i, r, c] = S[BLOCK * (4 * r + c) + i]
        T[i, 3, 0], T[i, 3, 1], T[i, 3, 2], T[i, 3, 3] = 0.0, 0.0, 0.0, 1.0
