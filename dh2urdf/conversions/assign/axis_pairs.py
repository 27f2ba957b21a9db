"""Two joint axes and what lies between them: the four cases and their common normal.

Between two neighbouring joints stands one constant transform ``L``, the frame of the second
axis seen from the frame of the first, both with their z along the axis. Frame assignment
(lecture notes section 4, step 3) is its factorisation::

    L = Z(phi1, s1) X(a, alpha) Z(phi2, s2)

with ``Z(phi, s) = Rot_z(phi) Trans_z(s)`` and ``X(a, alpha) = Trans_x(a) Rot_x(alpha)``: slide
and turn along the first axis to the foot of the common normal, cross it, slide and turn along
the second. The outer factors commute with the joints' own motions and become d and theta.

Axes that are parallel within a hair meet their common normal far away. For those one more
rotation stands in for the long way (Hayati, "Robot arm geometric link parameter estimation",
1983): the x axis runs to where the second axis pierces the plane across the first, and::

    standard  L = Z(phi1, s1) X(a, alpha) Rot_y(beta) Z(phi2, s2)
    modified  L = Z(phi1, s1) Rot_y(beta) X(a, alpha) Z(phi2, s2)

Everything is computed in the frame of the first axis, from ``L`` alone: nothing is lost to
the rest of the arm.
"""

import math
from enum import StrEnum
from typing import NamedTuple

import numpy as np

from dh2urdf import transforms as tf
from dh2urdf.dh import DHConvention
from dh2urdf.transforms import Array

PARALLEL = 1e-14
"""Angle [rad] up to which two axes are the same direction: what a few dozen roundings leave.

Anything larger stands in the file on purpose as far as anyone can tell, and is kept.
"""

TOUCHING = 1e-14
"""Distance [m per m of the lengths it was computed from] that is a rounding of zero."""


class AxisCase(StrEnum):
    """How two joint axes lie to each other (lecture notes section 4, step 3)."""

    SKEW = "skew"  # case 1
    PARALLEL = "parallel"  # case 2
    INTERSECTING = "intersecting"  # case 3
    COLLINEAR = "collinear"  # cases 2 and 3 at once


class AxisPair(NamedTuple):
    """Two axes, classified.

    ``tilt`` is the angle [rad] to the nearest parallel position, ``distance`` the length [m]
    of the common normal, ``opposed`` true where the directions are more than 90 degrees apart.
    """

    case: AxisCase
    tilt: float
    distance: float
    opposed: bool

    @property
    def parallel(self) -> bool:
        """True where the axes have one direction, so that any common normal will do."""
        return self.case in (AxisCase.PARALLEL, AxisCase.COLLINEAR)

    @property
    def any_direction(self) -> bool:
        """True where the axes are one line, so that x may point anywhere."""
        return self.case is AxisCase.COLLINEAR


class Normal(NamedTuple):
    """A factorisation of the transform between two axes; angles [rad], lengths [m]."""

    phi1: float
    s1: float
    a: float
    alpha: float
    beta: float
    phi2: float
    s2: float


def wrap(angle: float) -> float:
    """The same angle [rad] in (-pi, pi]."""
    wrapped = math.remainder(angle, 2 * math.pi)
    return math.pi if wrapped == -math.pi else wrapped


def classify(L: Array, length: float) -> AxisPair:
    """The case of the axes z and ``L z``, L the frame of the second in that of the first.

    ``length`` is the size of the arm [m], against which a distance may be a rounding of zero.
    """
    zx, zy, zz = (float(v) for v in L[:3, 2])
    px, py, pz = (float(v) for v in L[:3, 3])
    sine = math.hypot(zx, zy)
    tilt = math.atan2(sine, abs(zz))
    touching = TOUCHING * max(length, math.hypot(px, py, pz))
    if tilt <= PARALLEL:
        distance = math.hypot(px, py)
        case = AxisCase.COLLINEAR if distance <= touching else AxisCase.PARALLEL
    else:
        distance = abs(zx * py - zy * px) / sine
        case = AxisCase.INTERSECTING if distance <= touching else AxisCase.SKEW
    if distance <= touching:
        distance = 0.0
    return AxisPair(case, tilt if tilt > PARALLEL else 0.0, distance, zz < 0)


def common_normal(L: Array, pair: AxisPair) -> Normal:
    """The factorisation along the only common normal of skew or intersecting axes.

    ``x = z1 cross z2``, so alpha lies in (0, pi) and a has the sign of the way from the first
    axis to the second along x; :func:`flipped` gives the other choice.
    """
    zx, zy, zz = (float(v) for v in L[:3, 2])
    px, py, pz = (float(v) for v in L[:3, 3])
    sine = math.hypot(zx, zy)
    cx, sx = -zy / sine, zx / sine  # x = (cx, sx, 0); y = (-sx, cx, 0)
    t = (py * cx - px * sx) / sine  # along z2 from the origin of L to the foot
    a = 0.0 if pair.distance == 0 else px * cx + py * sx
    return _with_turn(L, math.atan2(sx, cx), pz + t * zz, a, math.atan2(sine, zz), 0.0, -t)


def across(
    L: Array,
    pair: AxisPair,
    height: float,
    turn: float = 0.0,
    convention: DHConvention = DHConvention.STANDARD,
) -> Normal:
    """The factorisation for (nearly) parallel axes, x leaving the first axis at a given height.

    Exact for every pair whose axes are not perpendicular; beta is 0 for parallel ones. In the
    standard order the plane in which x lies is normal to the first axis, in the modified order
    to the second: the one is the other of the inverse. ``height`` is along z from the origin [m],
    ``turn`` the direction of x about z [rad] where the axes are one line and leave it free.
    """
    if convention is DHConvention.STANDARD:
        return _across_first(L, pair, height, turn)
    inv = tf.inverse(L)
    b = _across_first(inv, pair, float(inv[2, 2] * height + inv[2, 3]), 0.0)
    n = Normal(-b.phi2, -b.s2, -b.a, wrap(-b.alpha), -b.beta, -b.phi1, -b.s1)
    if pair.any_direction:
        swing = turn - n.phi1
        return n._replace(phi1=turn, phi2=n.phi2 + (swing if pair.opposed else -swing))
    return flipped(n)


def _across_first(L: Array, pair: AxisPair, height: float, turn: float) -> Normal:
    zx, zy, zz = (float(v) for v in L[:3, 2])
    px, py, pz = (float(v) for v in L[:3, 3])
    if pair.parallel:
        zx, zy, zz = 0.0, 0.0, math.copysign(1.0, zz)
    t = (height - pz) / zz
    ex, ey = px + t * zx, py + t * zy
    a = 0.0 if pair.any_direction else math.hypot(ex, ey)
    phi1 = math.atan2(ey, ex) if a > 0 else turn
    if pair.parallel:
        return _with_turn(L, phi1, height, a, math.pi if zz < 0 else 0.0, 0.0, -t)
    c, s = math.cos(phi1), math.sin(phi1)
    ux, uy = c * zx + s * zy, c * zy - s * zx
    beta = math.atan2(ux, math.hypot(uy, zz))
    return _with_turn(L, phi1, height, a, math.atan2(-uy, zz), beta, -t)


def flipped(n: Normal) -> Normal:
    """The same transform with x the other way: ``X(a, alpha) = Rz(pi) X(-a, -alpha) Rz(pi)``."""
    phi1, phi2 = wrap(n.phi1 + math.pi), wrap(n.phi2 + math.pi)
    return Normal(phi1, n.s1, 0.0 - n.a, wrap(-n.alpha), 0.0 - n.beta, phi2, n.s2)


def compose(n: Normal) -> Array:
    """The transform that a factorisation in the standard order stands for, shape (4, 4)."""
    first = tf.rot_z(n.phi1) @ tf.trans(0, 0, n.s1)
    second = tf.rot_z(n.phi2) @ tf.trans(0, 0, n.s2)
    return first @ (tf.trans(n.a, 0, 0) @ tf.rot_x(n.alpha) @ tf.rot_y(n.beta)) @ second


def _with_turn(
    L: Array, phi1: float, s1: float, a: float, alpha: float, beta: float, s2: float
) -> Normal:
    """Complete a factorisation by the turn phi2 that is left about the second axis."""
    R = tf.rot_z(phi1) @ tf.rot_x(alpha) @ tf.rot_y(beta)
    x, y = R[:3, 0], R[:3, 1]
    x2 = np.asarray(L[:3, 0])
    return Normal(phi1, s1, a, alpha, beta, math.atan2(float(y @ x2), float(x @ x2)), s2)
