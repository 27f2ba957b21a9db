"""Elementary functions of additions, products, one division or root: the same bits everywhere.

What a library's ``sin`` rounds differs between processors and versions; these are straight-line
code whose order of operations is the definition, interpreted or compiled without contraction.
Errors in units of the last place, against 200-bit arithmetic: sine and cosine 0.66 (up to 4e5
rad), arctangent 0.67, arc sine 0.69, hypotenuse 0.5001; 0.75 near the least numbers. NaN
passes; infinities give NaN.

Arguments are reduced with constants in two or three parts whose products are exact; heads of
numbers are taken by adding and subtracting a power of two (Dekker 1971). The polynomials are
minimax fits of relative error: sine 2^-58, cosine 2^-64, arctangent 2^-57, arc sine 2^-59.
"""

import math

FAR = 4e5
"""Angle [rad] up to which `sincos` is right."""

FULL, FULL_REST = 6.283185307179586, 2.4492935982947064e-16
"""A full turn in two parts."""

ROUND = 6755399441055744.0
"""1.5 2^52: adding and subtracting it rounds to a whole number."""

GRID = 25769803776.0
"""1.5 2^34: the same to a multiple of 2^-18."""

SPLIT = 134217729.0
"""2^27 + 1: parts a number into two of 26 bits."""

SPECK = 9.332636185032189e-302
"""2^-1000: keeps a division from 0 / 0 and changes nothing else."""

PER_TURN = 0.6366197723675814
QUARTER = 1.5707963267948966
QUARTER_REST = 6.123233995736766e-17
QUARTER_1, QUARTER_2, QUARTER_3 = 1.5707963267923333, 2.5633441515839558e-12, 1.0562999066987428e-23
"""A quarter turn in three parts, two of 35 bits."""

S3 = -0.16666666666666632
S5, S7, S9 = 0.00833333333332249, -0.0001984126982985775, 2.755731370697091e-06
S11, S13 = -2.505076023804201e-08, 1.5896909262763026e-10
C4, C6, C8 = 0.0416666666666666, -0.0013888888888874474, 2.48015872896715e-05
C10, C12, C14 = -2.755731440100332e-07, 2.0875729275230723e-09, -1.1359933824143538e-11

HALF_HEAD, HALF_REST = 0.46364760900080615, -3.281237377829614e-17
ONE_HEAD, ONE_REST = 0.7853981633974483, 3.061616997868383e-17
"""Arctangents of 1/2 and 1, each in two parts, the first on a grid of 2^-51."""

T3, T5, T7, T9 = -0.33333333333332543, 0.1999999999958781, -0.14285714212159428, 0.11111104754208008
T11, T13, T15 = -0.09090604374322639, 0.07683755498473123, -0.06526069490652849
T17 = 0.04608873992759909

A3, A5, A7 = 0.16666666666666763, 0.0749999999997013, 0.044642857175252806
A9, A11, A13 = 0.030381942676978184, 0.022372215855530585, 0.01735159644279155
A15, A17, A19 = 0.01398100691757457, 0.011397389311874782, 0.010788783004806273
A21, A23, A25 = 0.0036741833170974873, 0.021785932693796795, -0.021110334466536998
A27 = 0.032698390453791706

LARGE, SMALL = 3.273390607896142e150, 6.223015277861142e-61
"""2^500 and 2^-200: beyond these squares could leave the range, or lose digits."""

SHRINK, GROW = 7.888609052210118e-31, 2.5822498780869086e120
"""2^-100 and 2^400."""

DOWN, UP = 2.409919865102884e-181, 4.149515568880993e180
"""2^-600 and 2^600."""


def few_turns(x):
    """The same direction within the reach of `sincos`: to 1e-15 [rad] up to 1e15 rad."""
    if not FAR < abs(x) < math.inf:
        return x
    near = math.fmod(x, FULL)
    return near - (x - near) / FULL * FULL_REST


def sincos(x: float) -> tuple[float, float]:
    """Sine and cosine of x [rad], |x| <= ``FAR``."""
    quarters = (x * PER_TURN + ROUND) - ROUND
    # The reduced angle is r - c; its head on a grid of 2^-18 has an exact square and cube.
    near = x - quarters * QUARTER_1
    step = quarters * QUARTER_2
    r = near - step
    c = (step - (near - r)) + quarters * QUARTER_3
    head = (r + GRID) - GRID
    rest = (r - head) - c
    both, square = r + head, head * head
    z = r * r
    z2 = z * z
    odd = (S5 + z * S7) + z2 * ((S9 + z * S11) + z2 * S13)
    even = (C4 + z * C6) + z2 * ((C8 + z * C10) + z2 * (C12 + z * C14))
    low = S3 * (rest * (z + head * both)) + (z2 * r) * odd
    s = r - ((c - low) - S3 * (square * head))
    k = (1.0 - 0.5 * square) - ((0.5 * both) * rest - z2 * even)
    # Turned by the quarters: one of e and o is 0, the other 1 or -1.
    m = 4.0 * ((quarters * 0.25 + ROUND) - ROUND) - quarters
    e = 1.0 - abs(m)
    o = m * (2.0 - abs(m))
    return e * s - o * k, e * k + o * s


def atan2(y: float, x: float) -> float:
    """Angle of the point (x, y) [rad], in -pi ... pi."""
    a, b = abs(y), abs(x)
    steep = a > b
    large, small = (a if steep else b), (b if steep else a)
    scale = SHRINK if large > LARGE else GROW
    large, small = large * scale + SPECK, small * scale
    # atan(small / large) = atan(c) + atan((small - c large) / (large + c small)), c 0, 1/2 or 1.
    half, one = small > 0.25 * large, small > 0.75 * large
    c = 1.0 if one else 0.5 if half else 0.0
    head = ONE_HEAD if one else HALF_HEAD if half else 0.0
    rest = ONE_REST if one else HALF_REST if half else 0.0
    n, f = small - c * large, c * small
    d = large + f
    d_rest = f - (d - large)
    # The quotient to about 75 bits.
    inverse = 1.0 / d
    t = n * inverse
    g = t * SPLIT
    t_head = g - (g - t)
    g = d * SPLIT
    d_head = g - (g - d)
    d_low = (d - d_head) + d_rest
    t_rest = ((n - t_head * d_head) - t_head * d_low) * inverse
    z = t * t
    z2 = z * z
    low, high = (T3 + z * T5) + z2 * (T7 + z * T9), (T11 + z * T13) + z2 * (T15 + z * T17)
    s = t_rest + (t * z) * (low + (z2 * z2) * high)
    # The octant: a whole number of quarter turns, and the angle with a sign.
    side = math.copysign(1.0, x)
    sign, quarters = (-side if steep else side), (1.0 if steep else 1.0 - side)
    base, base_rest = quarters * QUARTER + sign * head, quarters * QUARTER_REST + sign * rest
    u = sign * t_head
    h = base + u
    return math.copysign(h + (((base - h) + u) + (base_rest + sign * s)), y)


def asin(x):
    """Arc sine [rad]; NaN beyond 1."""
    ax = abs(x)
    far = ax > 0.5
    half = 0.5 * (1.0 - ax)
    root = math.sqrt(abs(half))
    g = root * SPLIT
    head = g - (g - root)
    error = ((half - head * head) - (root + head) * (root - head)) * (0.5 / (root + SPECK))
    # The number or the root, and the rest of its arc sine.
    s, z = (root, half) if far else (ax, ax * ax)
    z2 = z * z
    z4 = z2 * z2
    p = ((A3 + z * A5) + z2 * (A7 + z * A9)) + z4 * ((A11 + z * A13) + z2 * (A15 + z * A17))
    p = p + (z4 * z4) * (((A19 + z * A21) + z2 * (A23 + z * A25)) + z4 * A27)
    rest = (error if far else 0.0) + (s * z) * p
    quarters, sign = (1.0, -2.0) if far else (0.0, 1.0)
    base, u = quarters * QUARTER, sign * s
    h = base + u
    angle = h + (((base - h) + u) + (quarters * QUARTER_REST + sign * rest))
    return math.copysign(math.nan if ax > 1.0 else angle, x)


def hypot(x: float, y: float) -> float:
    """Length of (x, y)."""
    a, b = abs(x), abs(y)
    large, small = (a if a > b else b), (b if a > b else a)
    scale = DOWN if large > LARGE else UP if large < SMALL else 1.0
    back = UP if large > LARGE else DOWN if large < SMALL else 1.0
    large, small = large * scale, small * scale
    h = math.sqrt(large * large + small * small)
    # What is left of the squares, by heads of 26 bits.
    g = large * SPLIT
    large_head = g - (g - large)
    g = small * SPLIT
    small_head = g - (g - small)
    g = h * SPLIT
    h_head = g - (g - h)
    tails = (large + large_head) * (large - large_head)
    tails += (small + small_head) * (small - small_head)
    heads = (large_head * large_head - h_head * h_head) + small_head * small_head
    error = (heads + (tails - (h + h_head) * (h - h_head))) * (0.5 / (h + SPECK))
    return (h + error) * back
