"""Any six turning joints: five eliminated, one polynomial (Raghavan and Roth 1993).

The closed loop ``Z_1 g_0 Z_2 g_1 ... Z_6 g_5 = 1``, with the pose in one link g and any joint
first, is cut so that a line and a point on axis 6 are seen from both sides,

    g_1 Z_3 g_2 Z_4 g_3 Z_5 g_4 (l, p)  =  (Z_1 g_0 Z_2)^-1 g_5^-1 (l, p).

Fourteen functions of l and p, in each of which joints stand at most linearly, give fourteen
equations; eight products of cos and sin of joints 1 and 2 are eliminated, six equations are left.
"""

import itertools
import math
from collections.abc import Callable, Iterator, Sequence
from functools import reduce

import numpy as np

from dh2urdf.lessons.arm import Row
from dh2urdf.lessons.circle import curve_of, real_roots, series_of
from dh2urdf.lessons.eliminated import back, led_by
from dh2urdf.lessons.steps import Step
from dh2urdf.lessons.way import Asked, Way
from dh2urdf.transforms import Array, inverse, rot_z

DEGREE = 8
"""Of the polynomial in cos and sin of an angle: sixteen roots."""

OVER = 12
"""Degree up to which harmonics are looked at: those above 8 are rounding where it is one."""

THIRDS = (0.0, math.tau / 3.0, -math.tau / 3.0)


def fits(rows: tuple[Row, ...]) -> bool:
    """Whether rows are six turns."""
    return len(rows) == 6 and not any(row.slides for row in rows)


def links_of(rows: Sequence[Row], H: Array) -> list[Array]:
    """The rigid links (4, 4) behind each joint of the closed loop, the last with the pose H in it.

    A row is ``Rz(sign q) (row at q = 0)``, and ``Rz(-q) = F Rz(q) F`` with ``F = Rot_x(pi)``: the F
    go into the links. So it is with slides along z.
    """
    flips = [np.diag([1.0, row.sign, row.sign, 1.0]) for row in rows]
    at_zero = [row.motion(row.d if row.slides else row.theta) for row in rows]
    links = [flip @ motion for flip, motion in zip(flips, at_zero, strict=True)]
    links[-1] = links[-1] @ inverse(H)
    return [link @ flips[(i + 1) % len(rows)] for i, link in enumerate(links)]


def _functions(line: Array, p: Array) -> Array:
    """The fourteen functions of a direction and a point, shape (14,)."""
    pp, pl = float(p @ p), float(p @ line)
    return np.concatenate([p, line, [pp, pl], np.cross(p, line), pp * line - 2.0 * pl * p])


def _coefficients(count: int, function: Callable[..., Array]) -> Array:
    """Coefficients in products of (1, cos, sin) of so many angles, by their values at thirds."""
    one = np.array([[1.0, math.cos(x), math.sin(x)] for x in THIRDS])
    weights = np.linalg.inv(one)
    values = np.array([function(*x) for x in itertools.product(THIRDS, repeat=count)])
    shape = values.reshape(*(3,) * count, 14)
    for axis in range(count):
        shape = np.moveaxis(np.tensordot(weights, shape, (1, axis)), 0, axis)
    found: Array = shape
    return found


class Elimination:
    """The determinant whose roots are the values of a joint, the loop begun at ``shift``."""

    def __init__(self, links: list[Array], shift: int) -> None:
        g = [links[(shift + k) % 6] for k in range(6)]
        self.joint = (shift + 2) % 6

        def left(a: float, b: float, c: float) -> Array:
            T = reduce(np.matmul, (g[1], rot_z(a), g[2], rot_z(b), g[3], rot_z(c), g[4]))
            return _functions(T[:3, 2], T[:3, 3])

        def right(a: float, b: float) -> Array:
            T = inverse(rot_z(a) @ g[0] @ rot_z(b)) @ inverse(g[5])
            return _functions(T[:3, 2], T[:3, 3])

        lefts = _coefficients(3, left)  # (3, 3, 3, 14)
        rights = _coefficients(2, right).reshape(9, 14).T
        moving = rights[:, 1:] / max(float(np.abs(rights[:, 1:]).max()), 1e-300)
        q, _ = np.linalg.qr(moving, mode="complete")
        self.six = np.moveaxis(np.tensordot(lefts, q[:, 8:], (3, 0)), 3, 0)
        self.six[:, 0, 0, 0] -= q[:, 8:].T @ rights[:, 0]
        self.six /= np.abs(self.six).max()

    def __call__(self, x: float) -> float:
        """The determinant with the hidden joint at x."""
        trig = np.array([1.0, math.cos(x), math.sin(x)])
        rows = np.tensordot(self.six, trig, (1, 0))  # (6, 3, 3) in joints 4 and 5
        half = np.array([[1.0, 0.0, 1.0], [1.0, 0.0, -1.0], [0.0, 2.0, 0.0]])  # times 1 + t^2
        rows = np.einsum("rab,ai,bj->rij", rows, half, half)
        M = np.zeros((12, 12))
        M[:6, :9] = rows.reshape(6, 9)
        M[6:, 3:] = rows.reshape(6, 9)
        return float(np.linalg.det(M))

    @property
    def noise(self) -> float:
        """Size of the harmonics that the determinant cannot have, against the others."""
        series = np.abs(series_of(self, OVER))
        outer = np.r_[series[: OVER - DEGREE], series[OVER + DEGREE + 1 :]]
        return float(outer.max() / max(float(series.max()), 1e-300))


def general_6r(asked: Asked) -> Iterator[Way]:
    """The way to one solution: a joint by the polynomial, then back."""
    links = links_of(asked.arm.rows, asked.H)
    tried = [Elimination(links, shift) for shift in range(6)]
    f = min(tried, key=lambda each: each.noise)
    hidden, first = f.joint + 1, (f.joint + 4) % 6 + 1
    inner = [(f.joint + k) % 6 + 1 for k in (1, 2)]
    outer = [first, (f.joint + 5) % 6 + 1]
    last = (f.joint + 3) % 6 + 1
    words = (
        "No three axes meet or are parallel so that something would decouple: all six joints stand "
        f"in all equations. Begin the closed loop at joint {first} and look along the axis of "
        f"joint {last}: it gives a direction and a point that do not know joint {last}; "
        "they and products of them are fourteen equations (Raghavan and Roth 1993). In these, cos "
        "and sin of "
        f"joints {outer[0]} and {outer[1]} are eliminated as eight unknowns, and six equations are "
        f"left in joints {hidden}, {inner[0]} and {inner[1]}. In t = tan(q/2) of the last two they "
        "are twelve equations, once multiplied by t, in twelve powers: there is a solution where "
        f"their determinant, a function of q_{hidden} alone, vanishes."
    )
    way = Way().then(Step("What is eliminated", words))
    roots = real_roots(f, DEGREE)
    said = (
        f"The determinant is a polynomial of degree 8 in cos q_{hidden} and sin q_{hidden}, so of "
        f"degree 16 in tan(q_{hidden}/2): seventeen of its values give its coefficients. "
    )
    found = led_by(asked, way, f.joint, said, curve_of(f"q_{hidden}", f, roots))
    if not found.stopped:
        found = back(
            asked,
            found,
            f"At the root the twelve equations have a null vector, whose entries are the powers of "
            f"t of joints {inner[0]} and {inner[1]}; then the eliminated products give joints "
            f"{outer[0]} and {outer[1]}, and joint {last} is what is left.",
        )
    yield found
