"""Two links and the way between their ends: the triangle of lecture notes 8.2."""

import math
from dataclasses import dataclass, field

from dh2urdf.lessons.notation import shown
from dh2urdf.lessons.steps import Equation
from dh2urdf.lessons.way import MERGED, RIM


@dataclass(frozen=True)
class Letters:
    """What the quantities of a triangle are called, and what its corners are."""

    x: str = "x"
    y: str = "y"
    l1: str = "l_1"
    l2: str = "l_2"
    shoulder: str = "theta_1"
    elbow: str = "theta_2"
    cosine: str = "c_2"
    sine: str = "s_2"
    distance: str = "r"
    tip: str = "The point"
    root: str = "axis 1"


@dataclass(frozen=True)
class Elbow:
    """One of the two ways to bend: both angles [rad], and how they were found."""

    elbow: float
    shoulder: float
    elbow_equations: list[Equation] = field(default_factory=list)
    shoulder_equations: list[Equation] = field(default_factory=list)


@dataclass(frozen=True)
class Triangle:
    """``l1 exp(i t1) + l2 exp(i (t1 + t2)) = x + i y``, lengths of either sign [m]."""

    letters: Letters
    l1: float
    l2: float
    x: float
    y: float

    @property
    def distance(self) -> float:
        """From the root to the point [m]."""
        return math.hypot(self.x, self.y)

    @property
    def near(self) -> float:
        """Least distance [m] that the two links reach."""
        return abs(abs(self.l1) - abs(self.l2))

    @property
    def far(self) -> float:
        """Greatest distance [m]."""
        return abs(self.l1) + abs(self.l2)

    @property
    def reaches(self) -> bool:
        """Whether the sides close to a triangle, rounding aside."""
        slack = RIM * self.far
        return self.near - slack <= self.distance <= self.far + slack

    @property
    def test(self) -> str:
        """The test of the cosine against +-1, said in metres."""
        n, r = self.letters, shown(self.distance)
        words = (
            f"{n.tip} is {r} m from {n.root}; the two links reach from their difference, "
            f"{shown(self.near)} m, to their sum, {shown(self.far)} m"
        )
        if self.reaches:
            return f"{words}, so there is a triangle and {n.cosine} is between -1 and 1."
        gap = self.distance - self.far if self.distance > self.far else self.near - self.distance
        side = "too far" if self.distance > self.far else "too near"
        return (
            f"{words}. It is {shown(gap)} m {side}: {n.cosine} is not between -1 and 1, no angle "
            "has this cosine, and here the solution ends."
        )

    @property
    def cosine(self) -> Equation:
        """The elbow's cosine, by the square of the distance."""
        n = self.letters
        formula = f"({n.x}^2 + {n.y}^2 - {n.l1}^2 - {n.l2}^2) / (2 {n.l1} {n.l2})"
        given = {n.x: self.x, n.y: self.y, n.l1: self.l1, n.l2: self.l2}
        square = self.x * self.x + self.y * self.y - self.l1 * self.l1 - self.l2 * self.l2
        return Equation(n.cosine, formula, given, square / (2.0 * self.l1 * self.l2))

    def elbows(self) -> list[Elbow]:
        """Both ways to bend, negative angle first; one where the arm is straight or folded."""
        if not self.reaches:
            return []
        square = self.distance**2
        outer = max((self.l1 + self.l2) ** 2 - square, 0.0)
        inner = max(square - (self.l1 - self.l2) ** 2, 0.0)
        if self.l1 * self.l2 < 0.0:
            outer = max(square - (self.l1 + self.l2) ** 2, 0.0)
            inner = max((self.l1 - self.l2) ** 2 - square, 0.0)
        least = MERGED * self.far**2
        outer, inner = (room if room > least else 0.0 for room in (outer, inner))
        sine = math.sqrt(outer) * math.sqrt(inner)
        cosine = self.cosine
        top = float(cosine.value) * abs(2.0 * self.l1 * self.l2)
        angle = math.atan2(sine, top)
        both = (-angle, angle) if sine else (angle,)
        return [self._elbow(bend, [v for v in both if v != bend], cosine) for bend in both]

    def _elbow(self, bend: float, others: list[float], cosine: Equation) -> Elbow:
        n, (s, c) = self.letters, (math.sin(bend), math.cos(bend))
        given = {n.cosine: float(cosine.value)}
        found = Equation(n.elbow, f"+- acos({n.cosine})", given, bend, "rad", tuple(others))
        inside = math.atan2(self.l2 * s, self.l1 + self.l2 * c)
        towards = math.atan2(self.y, self.x)
        shoulder = math.remainder(towards - inside, 2.0 * math.pi)
        gamma = Equation(
            "gamma",
            f"atan2({n.l2} {n.sine}, {n.l1} + {n.l2} {n.cosine})",
            {n.l1: self.l1, n.l2: self.l2, n.sine: s, n.cosine: c},
            inside,
            "rad",
        )
        first = Equation(
            n.shoulder,
            f"atan2({n.y}, {n.x}) - gamma",
            {n.y: self.y, n.x: self.x, "gamma": inside},
            shoulder,
            "rad",
        )
        return Elbow(bend, shoulder, [cosine, found], [gamma, first])
