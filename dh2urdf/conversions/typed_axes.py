"""Chains from joint axes typed by hand: screw axes, points and directions, or 4 x 4 frames."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from dh2urdf import transforms as tf
from dh2urdf.chain import SerialChain
from dh2urdf.conversions.model_to_chain import frame_with_z
from dh2urdf.dh import JointType
from dh2urdf.exceptions import UrdfError
from dh2urdf.transforms import Array

__all__ = ["typed_to_chain"]

LARGEST = 1e9
"""Largest number of an axis: beyond it sixteen digits no longer hold a micrometre."""

PITCH = 1e-9
"""Largest ``omega . v`` [m/rad] of a screw that still counts as a pure rotation."""


def typed_to_chain(
    source: ArrayLike,
    joint_types: str | Sequence[JointType | str] | None = None,
    tool: ArrayLike | None = None,
    names: Sequence[str] | None = None,
) -> SerialChain:
    """The chain of typed axes, all given in the base frame at q = 0.

    Parameters
    ----------
    source : array_like
        Shape (n, 6): screw axes ``(omega, v)`` with ``v = -omega x p`` for a point p on the axis
        [m], or ``omega = 0`` and the direction v of a sliding joint (Lynch and Park, *Modern
        Robotics*, section 4.1). Shape (n, 2, 3): a direction and a point [m] each. Shape
        (n, 4, 4): frames with z along the axis.
    joint_types : str or sequence, optional
        Such as ``"RRPR"``; all revolute where left out. Screws tell it themselves.
    tool : array_like, shape (4, 4), optional
        ``T_base_tool`` at q = 0. Without it the tool is the last joint's frame.
    names : sequence of str, optional
        Joint names; ``joint_1``, ... where left out.

    Raises
    ------
    UrdfError
        Wrong shape, NaN, a zero axis, a screw with pitch, or types that do not fit.
    PoseError
        A frame or tool that is not a rigid pose.
    """
    try:
        given = np.asarray(source, float)
    except (TypeError, ValueError):
        raise UrdfError(f"joint axes: expected numbers, got {source!r:.60}") from None
    shaped = given.ndim in (2, 3) and given.shape[1:] in ((6,), (2, 3), (4, 4)) and len(given) > 0
    if not shaped:
        raise UrdfError(
            f"joint axes of shape {given.shape}: allowed are (n, 6) screws, (n, 2, 3) directions "
            "and points, (n, 4, 4) frames"
        )
    fits = (np.abs(given) <= LARGEST).reshape(len(given), -1).all(axis=1)
    if not fits.all():
        raise UrdfError(f"joint {int(np.argmin(fits)) + 1}: NaN, infinity or beyond {LARGEST:.0e}")
    if given.shape[1:] == (4, 4):
        frames, types = list(tf.check_pose(given, what="joint frames")), _types(joint_types, given)
    elif given.shape[1:] == (6,):
        frames, types = _screws(given)
    else:
        types = _types(joint_types, given)
        frames = [_frame(i, axis, point) for i, (axis, point) in enumerate(given, 1)]
    n = len(frames)
    T_base_tool = frames[-1] if tool is None else tf.check_pose(tool, what="tool")
    labels = tuple(names) if names is not None else tuple(f"joint_{i + 1}" for i in range(n))
    if len(labels) != n:
        raise UrdfError(f"names: {len(labels)} for {n} joints")
    poses = [np.eye(4), *frames, T_base_tool]
    return SerialChain(
        links=np.stack([tf.inverse(a) @ b for a, b in pairwise(poses)]),
        joint_types=types,
        names=labels,
        lower=np.full(n, -math.inf),
        upper=np.full(n, math.inf),
    )


def _types(given: str | Sequence[JointType | str] | None, axes: Array) -> tuple[JointType, ...]:
    if given is None:
        return (JointType.REVOLUTE,) * len(axes)
    letters = {"r": JointType.REVOLUTE, "p": JointType.PRISMATIC}
    types = []
    for item in given:
        kind = letters.get(str(item).lower()) or str(item).lower()
        if kind not in (JointType.REVOLUTE, JointType.PRISMATIC):
            raise UrdfError(f"joint_types: {item!r} is not R, P, revolute or prismatic")
        types.append(JointType(kind))
    if len(types) != len(axes):
        raise UrdfError(f"joint_types: {len(types)} for {len(axes)} joints")
    return tuple(types)


def _screws(screws: Array) -> tuple[list[Array], tuple[JointType, ...]]:
    frames, types = [], []
    for i, screw in enumerate(screws, 1):
        omega, v = screw[:3], screw[3:]
        length = float(np.linalg.norm(omega))
        if length == 0:
            frames.append(_frame(i, v, np.zeros(3)))
            types.append(JointType.PRISMATIC)
            continue
        pitch = float(omega @ v) / length**2
        if abs(pitch) > PITCH:
            raise UrdfError(
                f"joint {i}: a screw of pitch {pitch:.3g} m/rad; a joint turns or slides"
            )
        frames.append(_frame(i, omega, np.cross(omega, v) / length**2))
        types.append(JointType.REVOLUTE)
    return frames, tuple(types)


def _frame(i: int, axis: Array, point: Array) -> Array:
    length = float(np.linalg.norm(axis))
    if length < 1e-9:
        raise UrdfError(f"joint {i}: a zero axis")
    T = np.eye(4)
    T[:3, :3] = frame_with_z(axis if length == 1.0 else axis / length)
    T[:3, 3] = point
    return T
