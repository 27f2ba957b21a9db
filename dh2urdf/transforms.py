"""Rigid transforms on plain NumPy arrays.

A pose ``T_a_b`` is a (4, 4) homogeneous matrix that takes coordinates in frame b to
coordinates in frame a, so subscripts cancel: ``T_a_c = T_a_b @ T_b_c``. Angles are in
radians, lengths in metres. Roll, pitch and yaw follow URDF: ``R = Rz(yaw) Ry(pitch) Rx(roll)``.
"""

import math
from collections.abc import Sequence
from functools import reduce
from operator import add, mul

import numpy as np
from numpy.typing import ArrayLike

from dh2urdf.bounds import NUMBER
from dh2urdf.doors import Array, finite_array, number, real_array
from dh2urdf.exceptions import PoseError
from dh2urdf.kernels.numbers import multiply
from dh2urdf.poses import check_pose, nearest_rotation

__all__ = [
    "Array",
    "check_pose",
    "inverse",
    "matrix_to_rpy",
    "matrix_to_zyz",
    "nearest_rotation",
    "origin_matrix",
    "planar_rotation",
    "planar_translation",
    "pose_error",
    "quaternion_to_matrix",
    "rot_x",
    "rot_y",
    "rot_z",
    "rotation",
    "rotation_angle",
    "rpy_to_matrix",
    "trans",
    "zyz_to_matrix",
]

ZYZ_SINGULAR = 1e-9
"""``sin(theta)`` at or below which only ``phi +- psi`` is determined, see :func:`matrix_to_zyz`."""


def _real(value: object, what: str) -> float:
    """An angle or a length of any size that squares."""
    return number(value, what, -NUMBER, NUMBER)


def _cos_sin(angle: float, what: str = "angle") -> tuple[float, float]:
    """Cosine and sine of an angle [rad]."""
    checked = _real(angle, what)
    return math.cos(checked), math.sin(checked)


def _three(values: object, what: str) -> tuple[float, float, float]:
    """Three numbers; a list of floats is read without making an array."""
    if isinstance(values, (list, tuple)) and len(values) == 3:
        x, y, z = (_real(v, what) for v in values)
        return x, y, z
    x, y, z = finite_array(values, what, "3 numbers", shape=(3,)).tolist()
    return x, y, z


def _matrices(values: object, what: str, *sizes: int) -> Array:
    """Finite matrices (..., k, k) of one of some sizes."""
    expected = " or ".join(f"(..., {k}, {k})" for k in sizes)
    given = real_array(getattr(values, "homogeneous", values), what, expected, PoseError)
    k = sizes[-1] if given.shape[-2:] == (sizes[-1], sizes[-1]) else sizes[0]
    return finite_array(given, what, f"numbers of shape {expected}", PoseError, (..., k, k))


def _matrix(values: object) -> Array:
    """One finite matrix, (3, 3) or (4, 4)."""
    R = _matrices(values, "R", 3, 4)
    if R.ndim != 2:
        raise PoseError(f"R: expected shape (3, 3) or (4, 4), got {R.shape}")
    return R


def rotation(axis: ArrayLike, angle: float) -> Array:
    """Rotation about a unit axis by an angle (Rodrigues), shape (3, 3)."""
    x, y, z = _three(axis, "axis")
    c, s = _cos_sin(angle)
    v = 1.0 - c
    return np.array(
        [
            [x * x * v + c, x * y * v - z * s, x * z * v + y * s],
            [x * y * v + z * s, y * y * v + c, y * z * v - x * s],
            [x * z * v - y * s, y * z * v + x * s, z * z * v + c],
        ]
    )


def rot_x(angle: float) -> Array:
    """``Rot_x(angle)`` as a (4, 4) homogeneous matrix."""
    c, s = _cos_sin(angle)
    return np.array([[1.0, 0, 0, 0], [0, c, -s, 0], [0, s, c, 0], [0, 0, 0, 1]])


def rot_y(angle: float) -> Array:
    """``Rot_y(angle)`` as a (4, 4) homogeneous matrix."""
    c, s = _cos_sin(angle)
    return np.array([[c, 0, s, 0], [0, 1.0, 0, 0], [-s, 0, c, 0], [0, 0, 0, 1]])


def rot_z(angle: float) -> Array:
    """``Rot_z(angle)`` as a (4, 4) homogeneous matrix."""
    c, s = _cos_sin(angle)
    return np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1.0, 0], [0, 0, 0, 1]])


def trans(x: float, y: float, z: float) -> Array:
    """``Trans(x, y, z)`` as a (4, 4) homogeneous matrix, lengths in [m]."""
    T = np.eye(4)
    T[:3, 3] = _real(x, "x"), _real(y, "y"), _real(z, "z")
    return T


def planar_rotation(theta: float) -> Array:
    """Homogeneous transform of the plane that turns by theta [rad], shape (3, 3)."""
    c, s = _cos_sin(theta, "theta")
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1.0]])


def planar_translation(x: float, y: float = 0.0) -> Array:
    """Homogeneous transform of the plane that moves by (x, y) [m], shape (3, 3).

    The planar RR arm of lecture notes section 2 is the product
    ``planar_rotation(q1) @ planar_translation(l1) @ planar_rotation(q2) @
    planar_translation(l2)``.
    """
    return np.array([[1.0, 0, _real(x, "x")], [0, 1.0, _real(y, "y")], [0, 0, 1.0]])


def rpy_to_matrix(rpy: Sequence[float]) -> Array:
    """Rotation of URDF's roll, pitch, yaw [rad]: ``Rz(yaw) Ry(pitch) Rx(roll)``, shape (3, 3).

    Examples
    --------
    >>> from math import pi
    >>> rpy_to_matrix([0, 0, pi / 2]).round(6) + 0.0
    array([[ 0., -1.,  0.],
           [ 1.,  0.,  0.],
           [ 0.,  0.,  1.]])
    """
    (cr, sr), (cp, sp), (cy, sy) = (_cos_sin(v, "rpy") for v in _three(rpy, "rpy"))
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )


def matrix_to_rpy(R: ArrayLike) -> tuple[float, float, float]:
    """Roll, pitch and yaw [rad] of a rotation, exact to rounding at every pitch.

    Yaw is read first; pitch and roll are read from ``Rz(yaw)^T R``, so that at pitch +-90
    degrees, where yaw alone is arbitrary, the three still multiply back to ``R``.

    Parameters
    ----------
    R : array_like, shape (3, 3) or (4, 4)

    Examples
    --------
    >>> [round(angle, 6) for angle in matrix_to_rpy(rpy_to_matrix([0.1, 0.2, 0.3]))]
    [0.1, 0.2, 0.3]
    """
    m = _matrix(R)
    cos_pitch = math.hypot(m[0, 0], m[1, 0])
    yaw = math.atan2(m[1, 0], m[0, 0]) if cos_pitch > 1e-15 else 0.0
    cy, sy = math.cos(yaw), math.sin(yaw)
    pitch = math.atan2(-m[2, 0], cy * m[0, 0] + sy * m[1, 0])
    roll = math.atan2(sy * m[0, 2] - cy * m[1, 2], cy * m[1, 1] - sy * m[0, 1])
    return roll, pitch, yaw


def quaternion_to_matrix(q: Array) -> Array:
    """Rotations of unit quaternions (x, y, z, w), shape (..., 4) to (..., 3, 3)."""
    numbers = finite_array(q, "q", "4 numbers on the last axis", shape=(..., 4))
    x, y, z, w = np.moveaxis(numbers, -1, 0)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), (0, 1), (-2, -1))


def origin_matrix(xyz: Sequence[float], rpy: Sequence[float]) -> Array:
    """Pose of a URDF ``<origin xyz rpy>``, shape (4, 4)."""
    return pose(rpy_to_matrix(rpy), _three(xyz, "xyz"))


def pose(R: Array, p: ArrayLike = (0.0, 0.0, 0.0)) -> Array:
    """Poses of rotations (..., 3, 3) and places (..., 3) [m], shape (..., 4, 4)."""
    T = np.zeros((*np.broadcast_shapes(R.shape[:-2], np.shape(p)[:-1]), 4, 4))
    T[..., :3, :3], T[..., :3, 3], T[..., 3, 3] = R, p, 1.0
    return T


def moved(T: Array, points: Array) -> Array:
    """Points (m, 3) [m] of a frame, seen from where its pose T (4, 4) is seen."""
    return np.asarray(points @ T[:3, :3].T + T[:3, 3])


def product(first: Array, *others: Array) -> Array:
    """Product of matrices (..., m, n): ``@`` with the same order of sums on every machine."""
    for other in others:
        if first.ndim == other.ndim <= 3 and first.shape[:-2] == other.shape[:-2] and first.size:
            first = _multiplied(first, other)
        else:
            terms = (
                first[..., :, k, None] * other[..., k, None, :] for k in range(first.shape[-1])
            )
            first = reduce(np.add, terms)
    return first


def _multiplied(first: Array, other: Array) -> Array:
    """The product of two matrices, or of two stacks of equally many, by the kernel."""
    a, b = np.ascontiguousarray(first, float), np.ascontiguousarray(other, float)
    out = np.empty((*a.shape[:-1], b.shape[-1]))
    if a.ndim == 2:
        multiply(a[None], b[None], out[None])
    else:
        multiply(a, b, out)
    return out


def dot(a: Array, b: Array) -> Array:
    """Product of vectors (..., n), summed from the first number to the last."""
    if a.ndim == b.ndim == 1:
        return np.float64(reduce(add, map(mul, a.tolist(), b.tolist())))  # type: ignore[return-value]
    return product(a[..., None, :], b[..., :, None])[..., 0, 0]


def cross(a: Array, b: Array) -> Array:
    """Cross product of two vectors (3,), in a tenth of the time of `numpy.cross`, the same bits."""
    (x, y, z), (u, v, w) = a.tolist(), b.tolist()
    return np.array([y * w - z * v, z * u - x * w, x * v - y * u])


def length(v: Array) -> float:
    """Length of a vector (n,)."""
    return math.sqrt(dot(v, v))


def inverse(T: ArrayLike) -> Array:
    """Inverse of rigid poses, shape (..., 4, 4): ``T_b_a`` from ``T_a_b``.

    Examples
    --------
    >>> inverse(trans(1, 2, 3))[:3, 3]
    array([-1., -2., -3.])
    """
    return inverted(_matrices(T, "T", 4))


def inverted(m: Array) -> Array:
    """:func:`inverse` of poses that are known to be some."""
    out = np.zeros_like(m)
    Rt = np.swapaxes(m[..., :3, :3], -1, -2)
    out[..., :3, :3] = Rt
    out[..., :3, 3] = -product(Rt, m[..., :3, 3, None])[..., 0]
    out[..., 3, 3] = 1.0
    return out


def rotation_angle(R: ArrayLike) -> Array:
    """Angle of rotations [rad] in [0, pi], shape (...), accurate at both ends.

    ``atan2(|vee(R - R^T)| / 2, (tr R - 1) / 2)`` keeps full precision near 0, where the
    arc cosine of the trace loses half the digits.
    """
    m = _matrices(R, "R", 3, 4)
    v = (m - np.swapaxes(m, -1, -2))[..., [2, 0, 1], [1, 2, 0]]
    trace = m[..., 0, 0] + m[..., 1, 1] + m[..., 2, 2]
    angle: Array = np.arctan2(0.5 * np.linalg.norm(v, axis=-1), 0.5 * (trace - 1.0))
    return angle


def pose_error(T: ArrayLike, T_ref: ArrayLike) -> float:
    """Largest difference of two stacks of poses.

    The larger of position difference [m] and angle between the orientations [rad], taken
    over the whole stack; the project's residual.
    """
    a, b = _matrices(T, "T", 4), _matrices(T_ref, "T_ref", 4)
    try:
        np.broadcast_shapes(a.shape, b.shape)
    except ValueError:
        raise PoseError(f"T_ref: shape {b.shape} does not go with T of shape {a.shape}") from None
    position = np.linalg.norm(a[..., :3, 3] - b[..., :3, 3], axis=-1)
    angle = rotation_angle(np.swapaxes(b[..., :3, :3], -1, -2) @ a[..., :3, :3])
    return float(max(position.max(initial=0.0), angle.max(initial=0.0)))


def zyz_to_matrix(phi: float, theta: float, psi: float) -> Array:
    """Rotation of ZYZ Euler angles [rad]: ``Rz(phi) Ry(theta) Rz(psi)``, shape (3, 3)."""
    R: Array = (rot_z(phi) @ rot_y(theta) @ rot_z(psi))[:3, :3]
    return R


def matrix_to_zyz(R: ArrayLike) -> tuple[tuple[float, float, float], ...]:
    """ZYZ Euler angles (phi, theta, psi) [rad] of a rotation (Spong, section 2.5.1).

    Returns
    -------
    tuple of triples
        Two solutions, theta positive first; or one, where ``sin(theta) = 0``: there only
        ``phi + psi`` (theta = 0) or ``phi - psi`` (theta = pi) is determined, and the
        representative has ``phi = 0``.

    Examples
    --------
    >>> both = matrix_to_zyz(zyz_to_matrix(0.5, 1.0, 1.5))
    >>> [[round(angle, 4) for angle in each] for each in both]
    [[0.5, 1.0, 1.5], [-2.6416, -1.0, -1.6416]]
    """
    m = _matrix(R)
    sin_theta = math.hypot(m[0, 2], m[1, 2])
    theta = math.atan2(sin_theta, m[2, 2])
    if sin_theta <= ZYZ_SINGULAR:
        return ((0.0, 0.0 if m[2, 2] > 0 else math.pi, math.atan2(m[1, 0], m[1, 1])),)
    phi, psi = math.atan2(m[1, 2], m[0, 2]), math.atan2(m[2, 1], -m[2, 0])
    turned, back = (v - math.pi if v > 0 else v + math.pi for v in (phi, psi))
    return (phi, theta, psi), (turned, -theta, back)
