"""Roots of trigonometric polynomials, and the arctangent of lanes."""

import math
from typing import Annotated, TypeAlias

from dh2urdf.engine import entry
from dh2urdf.kernels.numbers.double_roots import linear_trig
from dh2urdf.kernels.numbers.elementary import hypot, sincos
from dh2urdf.kernels.shapes import Floats

TINY = 1e-13
"""Size, relative to the largest coefficient, at which a coefficient is rounding."""

ON_CIRCLE = 0.05
"""Distance from the unit circle at which a complex root is still handed on as a real one."""

SWEEPS = 60
"""Most iterations of Aberth's method; simple roots take six to ten."""

SETTLED = 1e-9
"""Relative step after which the next one, its cube, is below rounding."""

Roots: TypeAlias = Annotated[Floats, "most"]

TAN_EIGHTH = 0.4142135623730950
A0, A1, A2 = -0.3333333333333333, 0.19999999999999804, -0.14285714285659828
A3, A4, A5 = 0.11111111105155447, -0.09090908753500877, 0.07692296375032143
A6, A7, A8 = -0.06666424885738255, 0.05878928997834775, -0.05230454270650244
A9, A10, A11 = 0.04551593220626549, -0.034570561981427744, 0.016285756855221028


def add_square(series, weight, constant, cosine, sine):
    """Add ``weight (constant + cosine cos x + sine sin x)^2`` to a series of degree 2."""
    series[0] += weight * (constant * constant + 0.5 * (cosine * cosine + sine * sine))
    series[1] += weight * 2.0 * constant * cosine
    series[2] += weight * 2.0 * constant * sine
    series[3] += weight * 0.5 * (cosine * cosine - sine * sine)
    series[4] += weight * cosine * sine


@entry()
def trig_roots(series: Annotated[Floats, "terms"], degree: int, cosines: Roots, sines: Roots):
    """Find the real roots of a trigonometric polynomial of low degree.

    ``f(x) = series[0] + sum_m series[2 m - 1] cos(m x) + series[2 m] sin(m x)``, m up to
    ``degree``. With ``z = exp(i x)``, ``z^degree f`` is a polynomial whose roots on the unit
    circle are the real ones; Aberth's method finds all of them at once (Aberth 1973). A root
    within ``ON_CIRCLE`` of the circle is handed on, for the caller to polish or drop.

    The degree, at most 4, is lowered where the leading coefficients vanish. Returns the number of
    roots written to ``cosines`` and ``sines`` (2 degree,); -1 where f vanishes identically.
    """
    largest = 0.0
    for k in range(2 * degree + 1):
        largest = max(largest, abs(series[k]))
    if largest < 1e-300:
        return -1
    while degree > 0 and abs(series[2 * degree - 1]) + abs(series[2 * degree]) < TINY * largest:
        degree -= 1
    if degree == 0:
        return 0
    if degree == 1:
        found, c1, s1, c2, s2 = linear_trig(series[1], series[2], -series[0], ON_CIRCLE)
        cosines[0], sines[0], cosines[1], sines[1] = c1, s1, c2, s2
        return found
    size = 2 * degree
    for k in range(size):
        sines[k], cosines[k] = sincos(0.4 + 2.0 * math.pi * k / size)
    for _ in range(SWEEPS):
        if _aberth_sweep(series, degree, cosines, sines) < SETTLED:
            break
    found = 0
    for k in range(size):
        radius = hypot(cosines[k], sines[k])
        if abs(radius - 1.0) < ON_CIRCLE:
            cosines[found], sines[found] = cosines[k] / radius, sines[k] / radius
            found += 1
    return found


def _times(x, y, u, v):
    """``(x + i y) (u + i v)``."""
    return x * u - y * v, x * v + y * u


def _over(x, y, u, v):
    """``(x + i y) / (u + i v)``, by Smith's method."""
    if abs(u) >= abs(v):
        ratio = v / u
        scale = u + v * ratio
        return (x + y * ratio) / scale, (y - x * ratio) / scale
    ratio = u / v
    scale = u * ratio + v
    return (x * ratio + y) / scale, (y * ratio - x) / scale


def _aberth_sweep(series, degree, real, imaginary):
    """Move each root by one step of Aberth's method; returns the longest relative step."""
    longest = 0.0
    size = 2 * degree
    for k in range(size):
        x, y = real[k], imaginary[k]
        value, slope = (0.0, 0.0), (0.0, 0.0)
        for j in range(size + 1):
            m = degree - j
            u = series[0] if m == 0 else 0.5 * series[2 * abs(m) - 1]
            v = 0.0 if m == 0 else 0.5 * series[2 * abs(m)]
            a, b = _times(*slope, x, y)
            slope = a + value[0], b + value[1]
            a, b = _times(*value, x, y)
            value = a + u, b + (v if m < 0 else -v)
        if hypot(*value) < 1e-300:
            continue
        a, b = _over(*slope, *value)
        for j in range(size):
            if j != k:
                gap = x - real[j], y - imaginary[j]
                if hypot(*gap) > 1e-300:
                    u, v = _over(1.0, 0.0, *gap)
                    a, b = a - u, b - v
        if hypot(a, b) < 1e-300:
            continue
        u, v = _over(1.0, 0.0, a, b)
        real[k] -= u
        imaginary[k] -= v
        longest = max(longest, hypot(u, v) / max(hypot(x, y), 1e-6))
    return longest


@entry()
def arctangent(y: float, x: float):
    """``atan2(y, x)`` without branches, for loops that become vector code; within 5e-16.

    The quotient is brought below ``tan(pi / 8)`` by ``atan(t) = pi/4 + atan((t-1) / (t+1))``
    with one division; then the least maximum polynomial of degree 25. (0, 0) gives 0.
    """
    ax, ay = abs(x), abs(y)
    big, small = max(ax, ay), min(ax, ay)
    far = small > TAN_EIGHTH * big
    top = small - big if far else small
    bottom = small + big if far else big
    bottom = bottom if bottom > 0.0 else 1.0
    t = top / bottom
    z = t * t
    z2 = z * z
    z4 = z2 * z2
    p = (A8 + A9 * z) + (A10 + A11 * z) * z2
    p = ((A4 + A5 * z) + (A6 + A7 * z) * z2) + z4 * p
    p = ((A0 + A1 * z) + (A2 + A3 * z) * z2) + z4 * p
    r = t + t * z * p
    r = r + 0.25 * math.pi if far else r
    r = 0.5 * math.pi - r if ay > ax else r
    r = math.pi - r if x < 0.0 else r
    return math.copysign(r, y)
