"""Chains from joint axes typed by hand: screw axes, points and directions, or 4 x 4 frames."""

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from dh2urdf import transforms as tf
from dh2urdf.bounds import JOINTS, LENGTH, TEXT_CHARACTERS
from dh2urdf.chain import SerialChain
from dh2urdf.conversions.chains.model_chain import frame_with_z
from dh2urdf.dh import JointType
from dh2urdf.doors import found, real_array
from dh2urdf.exceptions import UrdfError
from dh2urdf.transforms import Array

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
    given = real_array(source, "joint axes", "numbers", UrdfError)
    shaped = given.ndim in (2, 3) and given.shape[1:] in ((6,), (2, 3), (4, 4)) and len(given) > 0
    if not shaped:
        raise UrdfError(
            f"joint axes of shape {given.shape}: allowed are (n, 6) screws, (n, 2, 3) directions "
            "and points, (n, 4, 4) frames"
        )
    if len(given) > JOINTS:
        raise UrdfError(f"joint axes: {len(given)} joints; a chain has up to {JOINTS}")
    fits = (np.abs(given) <= LENGTH).reshape(len(given), -1).all(axis=1)
    if not fits.all():
        raise UrdfError(f"joint {int(np.argmin(fits)) + 1}: NaN, infinity or beyond {LENGTH:.0e}")
    if given.shape[1:] == (4, 4):
        frames, types = list(tf.check_pose(given, what="joint frames")), _types(joint_types, given)
    elif given.shape[1:] == (6,):
        frames, types = _screws(given)
    else:
        types = _types(joint_types, given)
        frames = [_frame(i, axis, point) for i, (axis, point) in enumerate(given, 1)]
    n = len(frames)
    T_base_tool = frames[-1]
    if tool is not None:
        matrix = real_array(
            getattr(tool, "homogeneous", tool), "tool", "a (4, 4) matrix", UrdfError
        )
        if matrix.shape != (4, 4) or not (np.abs(matrix) <= LENGTH).all():
            raise UrdfError(f"tool: expected one (4, 4) matrix of numbers up to {LENGTH:g}")
        T_base_tool = tf.check_pose(matrix, what="tool")
    labels = _names(names, n)
    poses = [np.eye(4), *frames, T_base_tool]
    return SerialChain(
        links=np.stack([tf.inverse(a) @ b for a, b in pairwise(poses)]),
        joint_types=types,
        names=labels,
        lower=np.full(n, -math.inf),
        upper=np.full(n, math.inf),
    )


def _list(given: object, what: str, expected: str, n: int) -> list[Any]:
    """The n entries of a sequence."""
    try:
        entries: list[Any] = list(given)  # type: ignore[call-overload]
    except TypeError:
        raise UrdfError(f"{what}: expected {expected}, got {found(given)}") from None
    if len(entries) != n:
        raise UrdfError(f"{what}: {len(entries)} for {n} joints")
    return entries


def _types(given: str | Sequence[JointType | str] | None, axes: Array) -> tuple[JointType, ...]:
    if given is None:
        return (JointType.REVOLUTE,) * len(axes)
    kinds = {"r": JointType.REVOLUTE, "p": JointType.PRISMATIC}
    kinds |= {str(kind): kind for kind in kinds.values()}
    types = []
    for item in _list(given, "joint_types", "R and P", len(axes)):
        if not isinstance(item, str) or item.lower() not in kinds:
            raise UrdfError(f"joint_types: {found(item)} is not R, P, revolute or prismatic")
        types.append(kinds[item.lower()])
    return tuple(types)


def _names(given: Sequence[str | None] | None, n: int) -> tuple[str, ...]:
    """Names of the joints, ``joint_1`` ... where there is none."""
    names = [None] * n if given is None else _list(given, "names", "texts", n)
    labels = [f"joint_{i}" if name is None else name for i, name in enumerate(names, 1)]
    for label in labels:
        if not isinstance(label, str) or not label or len(label) > TEXT_CHARACTERS:
            raise UrdfError(f"names: expected texts, got {found(label)}")
    if len(set(labels)) < n:
        raise UrdfError("names: two joints of one name")
    return tuple(labels)


def _screws(screws: Array) -> tuple[list[Array], tuple[JointType, ...]]:
    frames, types = [], []
    for i, screw in enumerate(screws, 1):
        omega, v = screw[:3], screw[3:]
        length = float(np.linalg.norm(omega))
        if 0 < length < 1e-9:
            raise UrdfError(f"joint {i}: a zero axis")
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
    if np.abs(point).max() > LENGTH:
        raise UrdfError(f"joint {i}: a point beyond {LENGTH:.0e} m")
    T = np.eye(4)
    T[:3, :3] = frame_with_z(axis if length == 1.0 else axis / length)
    T[:3, 3] = point
    return T
