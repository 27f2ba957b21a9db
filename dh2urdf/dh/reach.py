"""Which displacements the four DH motions can make, and what to do about the others."""

import math

from numpy.typing import ArrayLike

from dh2urdf import transforms as tf
from dh2urdf.dh.motions import DHConvention, convention_of
from dh2urdf.doors import integer
from dh2urdf.exceptions import PoseError, TableError
from dh2urdf.grids import number

REACHED = 1e-9
"""Angle [rad] and length [m] up to which a displacement counts as one that DH can make."""


def dh_parameters(
    T: ArrayLike, convention: str = "standard", *, i: int = 1
) -> tuple[float, float, float, float]:
    """theta [rad], d [m], a [m], alpha [rad] of the row that makes a displacement.

    A displacement ``T_{i-1,i}`` is four DH motions if, and only if, x_i is perpendicular to
    z_{i-1} (DH1) and meets it (DH2); Spong, Hutchinson and Vidyasagar, section 3.2.1. In the
    modified convention the same holds of x_{i-1} and z_i.

    Parameters
    ----------
    T : array_like, shape (4, 4)
        ``T_{i-1,i}``.
    convention : {"standard", "modified"}
    i : int
        Number of the row, for messages.

    Raises
    ------
    TableError
        No four DH motions make this displacement; the message says why and names both remedies.

    Examples
    --------
    >>> from dh2urdf import dh_parameters, dh_transform
    >>> [round(value, 6) for value in dh_parameters(dh_transform(0.5, 0.3, 0.1, -1.0))]
    [0.5, 0.3, 0.1, -1.0]
    """
    m = tf.check_pose(T)
    if m.shape != (4, 4):
        raise PoseError(f"T: expected one pose of shape (4, 4), got {m.shape}")
    i = integer(i, "i", 0, 1_000_000)
    if convention_of(convention) is DHConvention.MODIFIED:
        theta, d, a, alpha = dh_parameters(tf.inverse(m), i=i)
        return -theta, -d, -a, -alpha
    problem = why_unreachable(m, i)
    if problem:
        raise TableError(problem)
    theta = math.atan2(m[1, 0], m[0, 0])
    a = float(math.cos(theta) * m[0, 3] + math.sin(theta) * m[1, 3])
    return theta, float(m[2, 3]), a, math.atan2(m[2, 1], m[2, 2])


def why_unreachable(T: ArrayLike, i: int | None = None) -> str:
    """What keeps the four DH motions from making ``T_{i-1,i}``, and both remedies; empty if none.

    Remedies: another frame i, with x_i along the common normal, the DH row of which is worked
    out; or the same displacement written by inspection, as a fixed row.
    """
    m = tf.check_pose(T)
    here, before = ("i", "i-1") if i is None else (str(i), str(i - 1))
    tilt = abs(math.asin(max(-1.0, min(1.0, float(m[2, 0])))))
    miss = abs(float(m[0, 0] * m[1, 3] - m[1, 0] * m[0, 3]))
    if tilt <= REACHED and miss <= REACHED:
        return ""
    reason = (
        f"x_{here} is not perpendicular to z_{before} "
        f"(off by {number(round(math.degrees(tilt), 6))} deg)"
        if tilt > REACHED
        else f"the line of x_{here} misses z_{before} by {number(round(miss, 9))} m"
    )
    xyz = ", ".join(number(float(v) + 0.0, minus="-") for v in m[:3, 3])
    rpy = ", ".join(number(v + 0.0, minus="-") for v in tf.matrix_to_rpy(m))
    return (
        f"frame {here} cannot be reached from frame {before} by the four DH motions: {reason}. "
        f"Remedies: (1) choose another frame {here}{_other_frame(m, here, before)}; "
        f"(2) write the step by inspection, as a fixed row after a row that only turns or slides: "
        f"{{type: fixed, xyz: [{xyz}], rpy: [{rpy}]}}"
    )


def _other_frame(m: tf.Array, here: str, before: str) -> str:
    """The DH row of a frame with the same z and, where z allows, the same origin."""
    upright = math.hypot(m[0, 2], m[1, 2]) <= REACHED
    if not upright:
        return f", with x_{here} along the common normal of z_{before} and z_{here}"
    theta = math.degrees(math.atan2(m[1, 3], m[0, 3]))
    d, a = float(m[2, 3]), math.hypot(m[0, 3], m[1, 3])
    alpha = 0.0 if m[2, 2] > 0 else 180.0
    shown = [number(round(v, 9), minus="-") for v in (theta, d, a, alpha)]
    return (
        f" at the same point, with x_{here} along the common normal: theta + {shown[0]} deg, "
        f"d = {shown[1]}, a = {shown[2]}, alpha = {shown[3]} deg"
    )
