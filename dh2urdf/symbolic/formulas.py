"""Formulas as a list of steps: what stands in a solution, in the order in which it is found."""

from dataclasses import dataclass, field, replace
from enum import Enum, auto
from typing import Any

import sympy as sp

from dh2urdf.symbolic.letters import Link

Pair = tuple[Any, Any]
Vector = tuple[Any, Any, Any]

NONE = sp.Float("1e-9")
"""Distance [m] of a point from an axis at which rounding says in which direction it is."""


class Kind(Enum):
    """What a step does."""

    HEADING = auto()  # words
    LET = auto()  # name = value
    CHOICE = auto()  # name is 1 or -1
    ROOT = auto()  # name = sqrt(value); no solution where value < 0
    ANGLE = auto()  # name = value, an angle whose cosine and sine have names, too
    LENGTH = auto()  # name = value, what a slide is out


@dataclass(frozen=True)
class Step:
    """One line of a solution."""

    kind: Kind
    name: str = ""
    value: Any = None


@dataclass
class Formulas:
    """Steps as they are found, and how the usual equations are solved.

    ``A cos + B sin = C`` has two solutions, ``Rz (x, y) = (X, Y)`` one: Craig, appendix C.
    """

    steps: list[Step] = field(default_factory=list)

    def heading(self, text: str) -> None:
        """Say what comes; where nothing came after the last one, that is taken back."""
        if self.steps and self.steps[-1].kind is Kind.HEADING:
            self.steps.pop()
        self.steps.append(Step(Kind.HEADING, text))

    def let(self, name: str, value: Any, *, always: bool = False) -> Any:
        """A name for an expression; what is short enough stands for itself."""
        value = sp.sympify(value)
        bare = value.is_Atom or (-value).is_Atom
        if bare and not always:
            return value
        self.steps.append(Step(Kind.LET, name, value))
        return sp.Symbol(name)

    def unless_none(self, link: Link, one: Pair, other: Pair) -> Pair:
        """Two numbers for the angle of a link, or others where they are zero but for rounding."""
        none = sp.sqrt(one[0] ** 2 + one[1] ** 2) < NONE
        x, y = (
            self.let(f"{letter}_{link.label}", sp.Piecewise((b, none), (a, True)))
            for letter, a, b in zip("xy", one, other, strict=True)
        )
        return x, y

    def choice(self, name: str) -> Any:
        """A sign that is 1 in one solution and -1 in another."""
        self.steps.append(Step(Kind.CHOICE, name))
        return sp.Symbol(name)

    def root(self, name: str, value: Any) -> Any:
        """A square root, without which there is no solution."""
        self.steps.append(Step(Kind.ROOT, name, value))
        return sp.Symbol(name)

    def angle(self, link: Link, value: Any) -> Link:
        """Joint angle theta of a link; from here on it is known."""
        value = value if link.way == 1 else -value
        self.steps.append(Step(Kind.ANGLE, f"theta_{link.label}", value))
        return link

    def length(self, link: Link, value: Any) -> Link:
        """Link offset d of a slide; from here on it is known."""
        value = tidy(value if link.way == 1 else -value)
        self.steps.append(Step(Kind.LENGTH, f"d_{link.label}", value))
        return link

    def turn(self, link: Link, A: Any, B: Any, C: Any) -> None:
        """Solve ``A cos(theta) + B sin(theta) = C``: two angles."""
        A, B, C = tidy(A), tidy(B), tidy(C)
        k = link.label
        sigma = self.choice(f"sigma_{link.label}")
        if C == 0:
            sigma *= -1 if B.could_extract_minus_sign() else 1
            self.angle(link, sp.atan2(-sigma * A, sigma * B))
        elif 0 in (A, B):
            D = self.let(f"D_{k}", C / (A + B), always=True)
            E = sigma * self.root(f"E_{k}", 1 - D**2)
            self.angle(link, sp.atan2(E, D) if B == 0 else sp.atan2(D, E))
        else:
            A, B, C = (self.let(f"{x}_{k}", v) for x, v in (("A", A), ("B", B), ("C", C)))
            D = self.let(f"D_{k}", C / sp.sqrt(A**2 + B**2), always=True)
            E = self.root(f"E_{k}", 1 - D**2)
            self.angle(link, sp.atan2(B, A) + sigma * sp.atan2(E, D))

    def point(self, link: Link, x: Any, y: Any, X: Any, Y: Any) -> None:
        """Solve ``Rz(theta) (x, y) = (X, Y)`` for points equally far from the axis."""
        x, y, X, Y = map(tidy, (x, y, X, Y))
        if y == 0:
            self.angle(link, sp.atan2(*_sided(Y, X, x)))
        elif x == 0:
            self.angle(link, sp.atan2(*_sided(-X, Y, y)))
        else:
            self.angle(link, sp.atan2(Y, X) - sp.atan2(y, x))

    def meet(self, link: Link, zero: Any) -> bool:
        """Solve an equation in one joint, of second degree at most; False where it is none.

        ``zero`` holds ``link.c``, ``link.s`` or ``link.d`` as unknowns.
        """
        if link.slides:
            return self._slide(link, zero)
        c, s = sp.Symbol(f"c_{link.label}"), sp.Symbol(f"s_{link.label}")
        poly = sp.Poly(sp.expand(sp.expand(zero).subs(s**2, 1 - c**2)), c, s)
        if poly.total_degree() > 1:
            poly = sp.Poly(tidy(poly.as_expr()), c, s)
        if poly.total_degree() != 1:
            return False
        A, B = poly.coeff_monomial(c), link.way * poly.coeff_monomial(s)
        self.turn(link, A, B, -poly.coeff_monomial(1))
        return True

    def _slide(self, link: Link, zero: Any) -> bool:
        """An equation in the offset of a slide."""
        d = sp.Symbol(f"d_{link.label}")
        poly = sp.Poly(tidy(zero), d)
        if poly.degree() not in (1, 2):
            return False
        *high, a, b = poly.all_coeffs()
        own = replace(link, way=1)
        if not high:
            self.length(own, -b / a)
            return True
        half = tidy(a / high[0] / 2)
        E = self.root(f"E_{link.label}", half**2 - b / high[0])
        self.length(own, -half + self.choice(f"sigma_{link.label}") * E)
        return True


def tidy(value: Any) -> Any:
    """An expression multiplied out, ``sin^2`` of constant twists put into ``cos^2``."""
    value = sp.expand(value)
    squares = {
        f: 1 - sp.cos(f.base.args[0]) ** 2
        for f in value.atoms(sp.Pow)
        if f.exp == 2 and isinstance(f.base, sp.sin)
    }
    return sp.expand(value.xreplace(squares)) if squares else value


def gathered(value: Any) -> Any:
    """A sum of products with cosines and sines of joints taken out, as one writes it by hand."""
    known = sorted((x for x in value.free_symbols if x.name[:2] in ("c_", "s_")), key=_length)
    return sp.collect(sp.expand(value), known)


def _length(symbol: Any) -> tuple[int, str]:
    return -len(symbol.name), symbol.name


def _sided(Y: Any, X: Any, factor: Any) -> tuple[Any, Any]:
    """Both arguments of atan2 with the sign of a factor, and without what is surely positive."""
    coefficient, rest = factor.as_coeff_Mul()
    sign = sp.sign(coefficient) * rest
    return tidy(Y * sign), tidy(X * sign)
