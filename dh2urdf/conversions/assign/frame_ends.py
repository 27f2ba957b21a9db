"""Frame 0 and frame n: steps 2 and 4 of lecture notes section 4.

There is much freedom in both. The rule here is that the base and tool transforms take up what
DH parameters cannot express and nothing else, as far as the notes' own advice allows.
"""

import math
from enum import StrEnum
from typing import NamedTuple

import numpy as np

from dh2urdf import transforms as tf
from dh2urdf.conversions.assign.axis_pairs import across, classify, common_normal, flipped, wrap
from dh2urdf.dh import DHConvention
from dh2urdf.transforms import Array

REACHED = 1e-14
"""Turn [rad] or slide [m per m of arm] that is left over when a frame counts as reached."""


class BaseChoice(StrEnum):
    """Where frame 0 is."""

    BASE = "base"  # the base frame itself
    BESIDE = "beside"  # axes of the base frame, moved onto a parallel z_0
    TURNED = "turned"  # like BESIDE, turned by pi about x: z_0 is antiparallel
    FREE = "free"  # on z_0 so that theta_1 = 0 and d_1 = 0


class ToolChoice(StrEnum):
    """Where frame n is."""

    TOOL = "tool"  # the tool frame itself
    TOOL_POINT = "tool point"  # origin at the tool's, z_n along the last joint axis
    OWN = "own"  # modified: the last joint's own frame


class Start(NamedTuple):
    """Frame 0: ``links[0] = base X(a, alpha) Z(phi, s)``; base, phi, s None where free."""

    choice: BaseChoice
    base: Array | None
    a: float
    alpha: float
    phi: float | None
    s: float | None


class End(NamedTuple):
    """Frame n: ``links[n] = Z(phi1, s1) X(a, alpha) tool``."""

    choice: ToolChoice
    phi1: float
    s1: float
    a: float
    alpha: float
    tool: Array


def slide_turn(phi: float, s: float) -> Array:
    """``Rot_z(phi) Trans_z(s)``, shape (4, 4)."""
    T = tf.rot_z(phi)
    T[2, 3] = s
    return T


def first_frame(L: Array, convention: DHConvention, size: float) -> Start:
    """Place frame 0 (step 2 of the notes); L is the frame of joint 1 in base, z along its axis."""
    pair = classify(L, size)
    x, y, z = (float(v) for v in L[:3, 3])
    turn = math.atan2(float(L[1, 0]), float(L[0, 0]))
    if pair.any_direction and not pair.opposed:
        return Start(BaseChoice.BASE, np.eye(4), 0.0, 0.0, turn, z)
    if convention is DHConvention.MODIFIED:
        n = across(L, pair, 0.0) if pair.parallel else common_normal(L, pair)
        for way in (n, flipped(n)):
            if _is_none(way.phi1, way.s1, size):
                return Start(BaseChoice.BASE, np.eye(4), way.a, way.alpha, way.phi2, way.s2)
    if pair.parallel and not pair.opposed:
        return Start(BaseChoice.BESIDE, tf.trans(x, y, 0), 0.0, 0.0, turn, z)
    if pair.parallel:
        base = tf.trans(x, y, 0) @ np.diag([1.0, -1.0, -1.0, 1.0])
        return Start(BaseChoice.TURNED, base, 0.0, 0.0, -turn, -z)
    return Start(BaseChoice.FREE, None, 0.0, 0.0, None, None)


def last_frames(
    M: Array, convention: DHConvention, own: float, size: float, phi: float
) -> tuple[End, ...]:
    """Frame n (step 4 of the notes): the choices with a turn phi about the last axis left over.

    M is the tool in the frame of the last joint, ``own`` the height of that joint's own origin
    [m] (modified convention only), ``size`` the length of the arm [m].
    """
    pair, z = classify(M, size), float(M[2, 3])
    turn = math.atan2(float(M[1, 0]), float(M[0, 0]))
    if convention is DHConvention.MODIFIED:
        on_axis = pair.any_direction and not pair.opposed
        if on_axis and abs(z - own) <= REACHED * size:
            return (End(ToolChoice.TOOL, turn, own, 0.0, 0.0, np.eye(4)),)
        # The joint's own origin: Craig leaves it free, URDFs place it with care.
        return tuple(
            End(ToolChoice.OWN, phi1, own, 0.0, 0.0, tf.inverse(slide_turn(phi1, own)) @ M)
            for phi1 in (0.0, -phi, *([turn] if pair.parallel else []))
        )
    n = across(M, pair, z, turn) if pair.parallel else common_normal(M, pair)
    reached = tuple(
        End(ToolChoice.TOOL, way.phi1, way.s1, way.a, way.alpha, np.eye(4))
        for way in (n, flipped(n))
        if _is_none(way.phi2, way.s2, size)
    )
    return reached or (_tool_point(M, phi, size),)


def _tool_point(M: Array, phi: float, size: float) -> End:
    """Standard: origin at the tool's, z_n along the last axis; the tool takes the turn."""
    x, y, z = (float(v) for v in M[:3, 3])
    a = math.hypot(x, y) if math.hypot(x, y) > REACHED * size else 0.0
    phi1 = math.atan2(y, x) if a > 0 else -phi
    if a > 0 and abs(wrap(phi + phi1)) > math.pi - REACHED:
        phi1, a = wrap(phi1 + math.pi), -a
    tool = tf.inverse(slide_turn(phi1, z) @ tf.trans(a, 0, 0)) @ M
    return End(ToolChoice.TOOL_POINT, phi1, z, a, 0.0, tool)


def _is_none(turn: float, slide: float, size: float) -> bool:
    return abs(turn) <= REACHED and abs(slide) <= REACHED * size
