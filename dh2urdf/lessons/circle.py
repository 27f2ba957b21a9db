"""Equations in the cosine and sine of one angle: linear ones, and those of degree two."""

import cmath
import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from dh2urdf.lessons.curve import Curve
from dh2urdf.lessons.notation import shown
from dh2urdf.lessons.steps import Equation
from dh2urdf.lessons.way import MERGED, RIM

VOID = 1e-14
"""Amplitude of an equation, relative to its size, that says nothing of its angle."""

SAMPLES = 144
"""Values of a function that is plotted: every 2.5 degrees."""

FIRST = 0.1973
"""First angle [rad] at which a function is sampled: none that a user's pose would have."""

ON_CIRCLE = 1e-5
"""Distance from the unit circle at which a root may be a real one that rounding has moved."""


class Linear:
    """``A cos x + B sin x = C``."""

    def __init__(self, name: str, A: float, B: float, C: float) -> None:
        self.name, self.A, self.B, self.C = name, A, B, C
        self.amplitude = math.hypot(A, B)

    def __call__(self, x: float) -> float:
        """The left side less the right one."""
        return self.A * math.cos(x) + self.B * math.sin(x) - self.C

    @property
    def solvable(self) -> bool:
        """Whether C is within the amplitude, rounding aside."""
        return abs(self.C) <= self.amplitude * (1.0 + RIM)

    @property
    def test(self) -> str:
        """The test of the cosine, in words."""
        amplitude, C = shown(self.amplitude), shown(abs(self.C))
        if self.solvable:
            return f"|C| = {C} is not more than sqrt(A^2 + B^2) = {amplitude}: it has solutions."
        return (
            f"|C| = {C} is more than sqrt(A^2 + B^2) = {amplitude}, the most that the left side "
            f"can be: it has no solution, it misses by {shown(abs(self.C) - self.amplitude)}."
        )

    def roots(self) -> list[float]:
        """Its solutions, two or one where both are the same."""
        if not self.solvable:
            return []
        room = self.amplitude - abs(self.C)
        room = room if room > MERGED * self.amplitude else 0.0
        half = math.atan2(math.sqrt(room) * math.sqrt(self.amplitude + abs(self.C)), self.C)
        middle = math.atan2(self.B, self.A)
        both = (middle + half, middle - half) if room else (middle + half,)
        return [math.remainder(x, math.tau) for x in both]

    def equation(self, root: float) -> Equation:
        """How a root is found."""
        formula = "atan2(B, A) +- acos(C / sqrt(A^2 + B^2))"
        given = {"A": self.A, "B": self.B, "C": self.C}
        others = tuple(x for x in self.roots() if x != root)
        return Equation(self.name, formula, given, root, "rad", others)


def series_of(f: Callable[[float], float], degree: int) -> NDArray[np.complex128]:
    """Complex coefficients of ``exp(i m x)``, m = -degree ... degree, of a real function."""
    count = 2 * degree + 1
    x = [FIRST + math.tau * k / count for k in range(count)]
    values = np.array([f(angle) for angle in x])
    turns = np.exp(-1j * np.outer(np.arange(-degree, degree + 1), x))
    series: NDArray[np.complex128] = turns @ values / count
    return series


def real_roots(f: Callable[[float], float], degree: int) -> list[float]:
    """Angles in (-pi, pi] at which a trigonometric polynomial vanishes, ascending."""
    series = series_of(f, degree)
    largest = float(np.abs(series).max())
    while degree > 0 and abs(series[0]) <= 1e-13 * largest:
        series, degree = series[1:-1], degree - 1
    if degree == 0:
        return []
    slope = series * 1j * np.arange(-degree, degree + 1)

    def slope_at(x: float) -> float:
        turns = np.exp(1j * x * np.arange(-degree, degree + 1))
        return float((slope * turns).sum().real)

    found: list[float] = []
    for z in np.roots(series[::-1]):
        if abs(abs(z) - 1.0) > ON_CIRCLE:
            continue
        x = cmath.phase(z)
        for _ in range(4):
            steep = slope_at(x)
            x -= f(x) / steep if steep else 0.0
        x = math.remainder(x, math.tau)
        if all(abs(math.remainder(x - y, math.tau)) > 1e-9 for y in found):
            found.append(x)
    return sorted(found)


def curve_of(name: str, f: Callable[[float], float], roots: list[float]) -> Curve:
    """A function of an angle, sampled for a plot."""
    x = -math.pi + math.tau * (np.arange(SAMPLES) + 0.5) / SAMPLES
    return Curve(name, np.array([f(float(v)) for v in x]), tuple(roots))
