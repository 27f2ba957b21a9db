"""Axis 2 parallel to 3, and 4 meets 5: no closed form, but one polynomial in theta_1.

Vectors are those of the arm at q = 0, seen from frame 0. h is the direction of axes 2 and 3.
Seen after joint 1, ``u`` is where axis 6 has to be and ``l`` where it has to point. A unit vector
``w`` (h, seen from the last link) has to fit ``h.l = w.h6`` and ``h.u = h.r3 + w.r5``, which leaves
two of them; then the planar arm of joints 2 and 3 reaches or not. The product over all signs is a
polynomial of degree eight in cos and sin of q_1: sixteen roots, as many as solutions.
"""

import cmath
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from dh2urdf.lessons.arm import Row
from dh2urdf.lessons.circle import curve_of, real_roots
from dh2urdf.lessons.eliminated import back, led_by
from dh2urdf.lessons.steps import Step
from dh2urdf.lessons.way import Asked, Way
from dh2urdf.transforms import inverse, rotation

Complex = NDArray[np.complex128]

DEGREE = 8

TINY = 1e-12
"""In place of the squared sine of axis 6 to axes 2 and 3, where that vanishes."""


def fits(rows: tuple[Row, ...]) -> bool:
    """Whether rows are six turns, axis 2 parallel to 3, and 4 meets 5."""
    if len(rows) != 6 or any(row.slides for row in rows):
        return False
    return rows[1].sa == 0.0 and rows[2].sa != 0.0 and rows[3].a == 0.0 and rows[3].sa != 0.0


class Polynomial:
    """The condition on joint 1 of a pose: it vanishes where there is a solution."""

    def __init__(self, asked: Asked) -> None:
        arm = asked.arm
        frames = arm.frames([arm.variable(i, 0.0) for i in range(6)])
        signs = [row.sign for row in arm.rows]
        h = [s * F[:3, 2] for s, F in zip(signs, frames, strict=False)]
        P = [F[:3, 3] for F in frames[:6]]
        P[3] = P[4] = frames[4][:3, 3]
        self.h = h
        h2 = h[1]
        P[2] = P[2] - h2 * float(h2 @ (P[2] - P[1]))
        self.P1, self.r1, self.r2, self.r3, self.r5 = (
            *(P[0], P[1] - P[0], P[2] - P[1], P[3] - P[2]),
            P[5] - P[4],
        )
        moved = asked.H @ inverse(frames[6])
        self.R, self.place = moved[:3, :3], (moved @ np.append(P[5], 1.0))[:3]
        self.y, self.z = float(self.r3 @ h[3]), float(self.r3 @ np.cross(h2, h[3]))

    def __call__(self, q1: float) -> float:
        """The polynomial at an angle of joint 1 [rad]."""
        h2, h6, r5 = self.h[1], self.h[5], self.r5
        R1 = rotation(self.h[0], q1)
        u, l6 = R1.T @ (self.place - self.P1) - self.r1, R1.T @ self.R @ h6
        c1, c2 = float(h2 @ l6), float(h2 @ u - h2 @ self.r3)
        a = max(1.0 - c1 * c1, TINY)
        flat_u, flat_l = u - h2 * (h2 @ u), l6 - h2 * c1
        U = complex(float(flat_u @ flat_l), float(h2 @ np.cross(u, l6)))
        n = np.cross(h6, r5)
        square = float(n @ n)
        G = np.array([[1.0, h6 @ r5], [h6 @ r5, r5 @ r5]])
        w0 = np.array([h6, r5]).T @ np.linalg.solve(G, [c1, c2])
        s = cmath.sqrt(square * (1.0 - float(w0 @ w0)))
        numbers = a, U, c1, c2, float(flat_u @ flat_u)
        both = [self._norm(w0 + side * n / square, numbers) for side in (s, -s)]
        return float((both[0] * both[1]).real) / (a * a)

    def _norm(self, w: Complex, numbers: tuple[float, complex, float, float, float]) -> complex:
        """The planar arm's condition for one w, both elbows of joint 4 multiplied."""
        a, U, c1, c2, reach = numbers
        h2, h4, h5, h6, r5 = self.h[1], self.h[3], self.h[4], self.h[5], self.r5
        e = complex(w @ h5)
        mu, nu = float(r5 @ h5) - e * c2, complex(w @ np.cross(h5, r5))
        mu6, nu6 = float(h6 @ h5) - e * c1, complex(w @ np.cross(h5, h6))
        s = complex(w @ np.cross(h6, r5))
        eta, k = float(h2 @ h4), float(h4 @ h5)
        t2 = 1.0 - eta * eta - k * k + 2.0 * eta * k * e - e * e
        y2 = self.y**2 + self.z**2
        turned = U.real * (float(h6 @ r5) - c1 * c2) - U.imag * s
        E = a * (float(r5 @ r5) - c2 * c2 + reach) - 2.0 * turned
        S = E + (y2 * (1.0 - eta * eta) - float(self.r2 @ self.r2)) * a
        # 2 (y + J z)((a mu - Ur mu' - Ui nu') + J (...)), its real part
        real = a * mu - U.real * mu6 - U.imag * nu6
        imaginary = -a * nu + U.real * nu6 - U.imag * mu6
        Z = 2.0 * (self.y * real - self.z * imaginary)
        G0, delta = k - eta * e, 1.0 - e * e
        return delta * S * S + 2.0 * S * Z * G0 + (1.0 - eta * eta) * Z * Z - 4.0 * y2 * a * t2 * E


def two_parallel(asked: Asked) -> Iterator[Way]:
    """The way to one solution: joint 1 by the polynomial, then back."""
    words = (
        "No three neighbouring axes meet in a point or are parallel: nothing decouples. But axes 2 "
        "and 3 are parallel, and axes 4 and 5 meet. Seen after joint 1, joints 2 and 3 leave alone "
        "how axis 6 leans against h, the direction of axes 2 and 3, and how far along h it is: two "
        "equations without them. With q_1 known they leave two directions w of h, seen from the "
        "last link, and each of these two values of joint 4. Then the planar arm of joints 2 and 3 "
        "reaches, or not: one equation f = 0."
    )
    way = Way().then(Step("What is eliminated", words))
    f = Polynomial(asked)
    roots = real_roots(f, DEGREE)
    said = (
        "The product of f over both directions and both values has no square roots left: a "
        "polynomial of degree 8 in cos q_1 and sin q_1, so of degree 16 in tan(q_1/2). "
    )
    curve = curve_of("q_1", f, roots)
    found = led_by(asked, way, 0, said, curve)
    if not found.stopped:
        found = back(
            asked,
            found,
            "With q_1 the two equations give w, and with it joints 4 and 5 by directions; joints 2 "
            "and 3 are a planar arm of two links; joint 6 is what is left of the orientation.",
        )
    yield found
