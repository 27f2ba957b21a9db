"""Target poses and configurations as callers give them, checked.

A pose may be replaced by the one with the nearest rotation, where that is asked.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dh2urdf.bounds import ANGLE, LENGTH
from dh2urdf.doors import FLOAT, finite_array, flag, found, real_array
from dh2urdf.exceptions import ArgumentError, ConfigurationError, PoseError
from dh2urdf.ik.arm.task import Task
from dh2urdf.kernels.numbers import first_bad_pose, is_pose
from dh2urdf.poses import POSE, check_pose, rounded_off
from dh2urdf.transforms import Array


def one_pose(T: ArrayLike, task: Task, nearest: bool) -> tuple[Array, float]:
    """One checked pose, (4, 4) in C order, and how far the given one was from it [rad].

    A point (3,) will do for a position.
    """
    if type(T) is np.ndarray and T.dtype is FLOAT and T.shape == (4, 4) and nearest is False:
        try:
            if is_pose(T):
                return T, 0.0
        except TypeError:
            pass  # not in C order
    m = real_array(getattr(T, "homogeneous", T), "pose", POSE, PoseError)
    if m.shape != (4, 4):
        if m.shape == (3,) and task is Task.POSITION:
            point, m = m, np.eye(4)
            m[:3, 3] = point
        elif m.shape != (1, 4, 4):
            shape = check_pose(m).shape
            raise PoseError(f"pose: expected shape (4, 4), got {shape}; ik_batch takes many")
        m = m.reshape(4, 4)
    change, rounded = 0.0, nearest is not False and flag(nearest, "nearest")
    if rounded:
        m, moved = rounded_off(m)
        change = float(moved)
    if not m.flags.c_contiguous:
        m = m.copy()
    if not is_pose(m):
        check_pose(m, rounded=rounded)
    return m, change


def many_poses(Ts: ArrayLike, nearest: bool, skip: bool) -> tuple[Array, Array]:
    """Checked poses (..., 4, 4), C-contiguous, and how far the given ones were from them [rad].

    With ``skip``, those that are none are NaN.
    """
    given = real_array(getattr(Ts, "homogeneous", Ts), "poses", POSE, PoseError)
    m = np.require(given, requirements=["C", "A", "W"])
    if m.shape in ((0,), (4, 4)):
        m = m.reshape(-1, 4, 4)
    if m.ndim < 3 or m.shape[-2:] != (4, 4):
        raise PoseError(f"poses: expected shape (..., 4, 4), got {m.shape}")
    change = np.zeros(m.shape[:-2])
    if flag(nearest, "nearest"):
        m, change = rounded_off(m)
    last = first_bad_pose(m.reshape(-1, 4, 4))
    if last >= 0 and not skip:
        check_pose(m, what="poses", rounded=nearest)
    if last >= 0:
        m = m.copy()
        flat = m.reshape(-1, 4, 4)
        while last < len(flat):
            flat[last] = np.nan
            after = first_bad_pose(flat[last + 1 :])
            last = len(flat) if after < 0 else last + 1 + after
    return m, change


def as_configuration(q: ArrayLike, slides: NDArray[np.bool_], what: str) -> Array:
    """A checked copy of a configuration, shape (n,): finite lengths and angles within bounds.

    ``slides`` (n,) is true where a value is a length.

    Raises
    ------
    ConfigurationError
    """
    n = len(slides)
    out = np.array(finite_array(q, what, f"{n} finite numbers", ConfigurationError), order="C")
    if out.shape != (n,):
        raise ConfigurationError(f"{what}: expected shape ({n},), got {out.shape}")
    far = np.flatnonzero(~(np.abs(out) <= np.where(slides, LENGTH, ANGLE)))
    if len(far):
        i = int(far[0])
        allowed = f"a length up to {LENGTH:g} m" if slides[i] else f"an angle up to {ANGLE:g} rad"
        raise ConfigurationError(f"{what}[{i}]: expected {allowed} either way, got {out[i]:g}")
    return out


def as_tolerance(given: ArrayLike, n: int) -> Array:
    """How far each of n joints may be from a seed [rad] or [m], of one number or n; none below 0.

    Raises
    ------
    ArgumentError
    """
    expected = f"a number, or {n} of them, not below 0"
    out = real_array(given, "seed_tolerance", expected)
    if out.shape not in ((), (n,)) or not (out >= 0.0).all():
        raise ArgumentError(f"seed_tolerance: expected {expected}, got {found(given)}")
    return np.broadcast_to(out, (n,))
