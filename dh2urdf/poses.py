"""Whether matrices are rigid poses, and the nearest ones that are."""

import numpy as np
from numpy.typing import ArrayLike

from dh2urdf.doors import Array, real_array
from dh2urdf.exceptions import PoseError

POSE = "numbers of shape (4, 4) or (..., 4, 4)"

ORTHONORMAL_TOLERANCE = 1e-6
"""Largest entry of ``R^T R - 1`` that still counts as a rotation: hand-typed six digits."""

NEAR = 0.05
"""Largest singular value of ``R' - R`` up to which ``R'`` may stand for R: two decimals are within
0.015; what is farther off was never a rotation."""

NEAREST = "nearest=True, ik --nearest or transforms.nearest_rotation takes the nearest rotation"


def check_pose(T: ArrayLike, *, what: str = "pose", rounded: bool = False) -> Array:
    """Return poses as a float array after checking that they are rigid.

    Parameters
    ----------
    T : array_like, shape (..., 4, 4), or pinocchio.SE3
        Homogeneous matrices, rotation orthonormal within 1e-6.
    what : str
        Name of the argument in messages.
    rounded : bool
        The nearest rotations stand where there were any; messages say how far the others are.

    Raises
    ------
    PoseError
        Wrong shape, NaN or infinity, a reflection, a scaled or skewed rotation, or a last row
        other than (0, 0, 0, 1). The message names the index of the first bad pose.
    """
    m = real_array(getattr(T, "homogeneous", T), what, POSE, PoseError)
    if m.shape[-2:] != (4, 4):
        raise PoseError(f"{what}: expected shape (4, 4) or (..., 4, 4), got {m.shape}")
    R = m[..., :3, :3]
    with np.errstate(all="ignore"):
        off = np.abs(np.swapaxes(R, -1, -2) @ R - np.eye(3)).max(axis=(-2, -1))
        worst = f"{off.max(initial=0.0):.2g} (allowed {ORTHONORMAL_TOLERANCE:.0e}); {NEAREST}"
        skewed = f"rotation part is not orthonormal, R^T R differs from 1 by {worst}"
        faults = {
            "NaN or infinity": ~np.isfinite(m).all(axis=(-2, -1)),
            skewed: ~(off <= ORTHONORMAL_TOLERANCE),
            "rotation part is a reflection (determinant -1)": _determinant(R) < 0,
            "last row must be 0 0 0 1": (np.abs(m[..., 3, :] - np.eye(4)[3]) > 1e-12).any(axis=-1),
        }
    for fault, bad in faults.items():
        if bad.any():
            first = np.argwhere(bad)[0].tolist()
            with np.errstate(all="ignore"):
                far = _far(R[tuple(first)]) if rounded and fault == skewed else fault
            raise PoseError(f"{what}{first or ''}: {far}")
    return m


def nearest_rotation(T: ArrayLike, *, what: str = "pose") -> tuple[Array, Array]:
    """Poses, or rotations, with the nearest rotation in place of one that is rounded.

    ``R' = U V^T`` of the singular values ``R = U S V^T`` (the orthogonal Procrustes problem); of
    all rotations it has the least ``|R' - R|``.

    Parameters
    ----------
    T : array_like, shape (..., 4, 4) or (..., 3, 3), or pinocchio.SE3
    what : str
        Name of the argument in messages.

    Returns
    -------
    poses : array of the same shape
    change : array, shape (...)
        ``|R' - R|``, the largest change of a unit vector: as an angle, in [rad].

    Raises
    ------
    PoseError
        Also where no rotation is within 0.05, and for a reflection.

    Examples
    --------
    >>> from dh2urdf.transforms import nearest_rotation, rot_z
    >>> pose, change = nearest_rotation(rot_z(0.5).round(3))
    >>> bool(change < 1e-3)
    True
    """
    m = given = real_array(getattr(T, "homogeneous", T), what, POSE, PoseError)
    if given.shape[-2:] == (3, 3):
        m = np.zeros((*given.shape[:-2], 4, 4))
        m[..., :3, :3], m[..., 3, 3] = given, 1.0
    if m.shape[-2:] != (4, 4):
        raise PoseError(f"{what}: expected shape (..., 4, 4) or (..., 3, 3), got {m.shape}")
    m, change = rounded_off(m)
    check_pose(m, what=what, rounded=True)
    k = given.shape[-1]
    return m[..., :k, :k], change


def rounded_off(m: Array) -> tuple[Array, Array]:
    """:func:`nearest_rotation` of poses (..., 4, 4); those that have none stay as they are."""
    m = m.copy()
    poses, change = m.reshape(-1, 4, 4), np.zeros(m[..., 0, 0].size)
    rows = np.flatnonzero((np.abs(poses[:, :3, :3]) < 2.0).all(axis=(1, 2)))
    U, S, Vt = np.linalg.svd(poses[rows, :3, :3])
    moved = np.abs(S - 1.0).max(axis=1)
    near = (moved <= NEAR) & (_determinant(U) * _determinant(Vt) > 0.0)
    poses[rows[near], :3, :3], change[rows[near]] = (U @ Vt)[near], moved[near]
    return m, change.reshape(m.shape[:-2])


def _far(R: Array) -> str:
    """How far a matrix (3, 3) is from the nearest rotation, in words."""
    S = np.linalg.svd(R, compute_uv=False)
    if _determinant(R) < 0:
        S[-1] *= -1.0
    away = np.abs(S - 1.0).max()
    return f"rotation part is {away:.2g} away from the nearest rotation (allowed {NEAR:g})"


def _determinant(R: Array) -> Array:
    """Determinant of matrices (..., 3, 3); no decomposition, which has warnings to give."""
    return np.sum(R[..., 0] * np.cross(R[..., 1], R[..., 2]), axis=-1)  # type: ignore[no-any-return]
