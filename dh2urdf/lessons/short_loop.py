"""The closed loop of one to five joints of any kind, in dual quaternions: a matrix and its null.

The loop is cut into two pairs of joints and, of five, one between them, x:

    Z_a g_a Z_b g_b Z_x g_x  ~  (Z_c g_c Z_d g_d)^-1.

A turn about z is ``u + v k`` with u : v = cos(q/2) : sin(q/2), a slide ``u + v eps k`` with
v / u = q/2: linear in u and v. So both sides are linear in the products of a's and b's, and of
c's and d's, and a null vector of the matrix M of all of them has the joints.
"""

import math
from collections.abc import Sequence
from functools import reduce

import numpy as np

from dh2urdf.transforms import Array

PLACES = ((0,), (0, 1), (0, 1, 2), (0, 1, 2, 3), (0, 1, 3, 4))
"""Where the joints of both pairs are in the loop, by the number of joints; x is the one between."""


def _times(p: Array, q: Array) -> Array:
    """The product of quaternions (4,), w first."""
    w = p[0] * q[0] - p[1:] @ q[1:]
    return np.array([w, *(p[0] * q[1:] + q[0] * p[1:] + np.cross(p[1:], q[1:]))])


def _product(p: Array, q: Array) -> Array:
    """The product of dual quaternions (8,), real part first."""
    dual = _times(p[:4], q[4:]) + _times(p[4:], q[:4])
    return np.concatenate([_times(p[:4], q[:4]), dual])


def _of_pose(T: Array, unit: float) -> Array:
    """A pose (4, 4) as a dual quaternion (8,), lengths in a unit [m]."""
    R = T[:3, :3]
    four = np.array(
        [
            [R[0, 0] + R[1, 1] + R[2, 2], R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]],
            [0.0, R[0, 0] - R[1, 1] - R[2, 2], R[0, 1] + R[1, 0], R[0, 2] + R[2, 0]],
            [0.0, 0.0, R[1, 1] - R[0, 0] - R[2, 2], R[1, 2] + R[2, 1]],
            [0.0, 0.0, 0.0, R[2, 2] - R[0, 0] - R[1, 1]],
        ]
    )
    _, vectors = np.linalg.eigh(four, UPLO="U")
    real = vectors[:, -1]
    return np.concatenate([real, 0.5 * _times(np.array([0.0, *(T[:3, 3] / unit)]), real)])


class Loop:
    """The matrix of a closed loop that is cut before one of its joints.

    Parameters
    ----------
    links : list of array (4, 4)
        Rigid links behind each joint, the last with the pose in it.
    slides : sequence of bool
        Which joints slide.
    start : int
        The first joint (from 0).
    """

    def __init__(self, links: list[Array], slides: Sequence[bool], start: int) -> None:
        n = len(links)
        order = [(start + k) % n for k in range(n)]
        self.slides = slides
        self.unit = max(*(float(np.linalg.norm(g[:3, 3])) for g in links), 1e-3)
        self.x = order[2] if n == 5 else None
        places = [order[k] for k in PLACES[n - 1]]
        self.pairs = places[:2], places[2:]
        if n == 2:
            self.pairs = places[:1], places[1:]
        link = [_of_pose(g, self.unit) for g in links]
        left, right = (self._columns(pair, link) for pair in self.pairs)
        self.right = right * [-1.0, 1.0, 1.0, 1.0, -1.0, 1.0, 1.0, 1.0]
        self.left = [left, left]
        if self.x is not None:
            self.left = [
                np.array([reduce(_product, (row, z, link[self.x])) for row in left])
                for z in self._factors(self.x)
            ]

    def _factors(self, joint: int) -> tuple[Array, Array]:
        """What stands with u and with v of a joint."""
        return np.eye(8)[0], np.eye(8)[7 if self.slides[joint] else 3]

    def _columns(self, pair: Sequence[int], link: list[Array]) -> Array:
        """What stands with each product of a pair's u and v, (k, 8): u u, u v, v u, v v."""
        out = [np.eye(8)[0]]
        for i in pair:
            out = [reduce(_product, (row, z, link[i])) for row in out for z in self._factors(i)]
        both = len(pair) == 2 and all(self.slides[i] for i in pair)
        return np.array(out[:3] if both else out)

    @property
    def square(self) -> bool:
        """Whether M is 8 x 8."""
        return len(self.left[0]) + len(self.right) == 8

    def matrix(self, x: float = 0.0) -> Array:
        """M with joint x, a turn, at an angle [rad]."""
        left = self.left[0]
        if self.x is not None:
            left = math.cos(0.5 * x) * self.left[0] + math.sin(0.5 * x) * self.left[1]
        return np.concatenate([left, self.right]).T

    def __call__(self, x: float) -> float:
        """The determinant of M."""
        return float(np.linalg.det(self.matrix(x)))

    def null(self, x: float = 0.0) -> tuple[Array, Array]:
        """Singular values of M, least last, and the vector that it takes to the least."""
        _, sigma, rows = np.linalg.svd(self.matrix(x))
        return sigma, rows[-1]

    def joints(self, vector: Array) -> dict[int, tuple[float, float]]:
        """u and v of each joint of both pairs: the larger row and column of each product."""
        found: dict[int, tuple[float, float]] = {}
        at = 0
        for pair in self.pairs:
            if not pair:
                continue
            count = 3 if len(pair) == 2 and all(self.slides[i] for i in pair) else 2 ** len(pair)
            part = vector[at : at + count]
            at += count
            if len(pair) == 1:
                found[pair[0]] = float(part[0]), float(part[1])
                continue
            W = np.array([*part, 0.0][:4]).reshape(2, 2)
            across, below = np.argmax(np.abs(W).sum(axis=0)), np.argmax(np.abs(W).sum(axis=1))
            if count == 3:
                across = below = np.intp(0)
            found[pair[0]] = float(W[0, across]), float(W[1, across])
            found[pair[1]] = float(W[below, 0]), float(W[below, 1])
        return found

    def value(self, joint: int, u: float, v: float) -> float:
        """The joint value of u : v."""
        if self.slides[joint]:
            return 2.0 * self.unit * v / u if u else math.inf
        return 2.0 * math.atan2(v, u)
