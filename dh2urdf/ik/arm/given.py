"""Target poses and configurations as callers give them, checked.

A pose may be replaced by the one with the nearest rotation, where that is asked.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dh2urdf.bounds import ANGLE, LENGTH
from dh2urdf.doors import finite_array, flag, real_array
from dh2urdf.exceptions import ConfigurationError, PoseError
from dh2urdf.ik.arm.task import Task
from dh2urdf.poses import POSE, check_pose, rounded_off
from dh2urdf.transforms import Array

FirstBad = Callable[[Array], int]
"""Index of the first of some poses (m, 4, 4) that is none, or -1."""


def one_pose(
    T: ArrayLike, task: Task, nearest: bool, first_bad: FirstBad | None = None
) -> tuple[Array, float]:
    """A checked copy of one pose, (1, 4, 4), and how far the given one was from it [rad].

    A point (3,) will do for a position. ``first_bad`` is a quick check, if there is one.
    """
    given = T if type(T) is np.ndarray else getattr(T, "homogeneous", T)
    m = np.array(real_array(given, "pose", POSE, PoseError), order="C", ndmin=3)
    if m.shape == (1, 1, 3) and task is Task.POSITION:
        point, m = m[0, 0], np.eye(4)[None]
        m[0, :3, 3] = point
    if m.shape != (1, 4, 4):
        shape = check_pose(given).shape
        raise PoseError(f"pose: expected shape (4, 4), got {shape}; ik_batch takes many")
    change, rounded = 0.0, nearest is not False and flag(nearest, "nearest")
    if rounded:
        m, moved = rounded_off(m)
        change = float(moved[0])
    if first_bad is None or first_bad(m) >= 0:
        check_pose(m[0], rounded=rounded)
    return m, change


def many_poses(
    Ts: ArrayLike, nearest: bool, skip: bool, first_bad: FirstBad
) -> tuple[Array, Array]:
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
    last = first_bad(m.reshape(-1, 4, 4))
    if last >= 0 and not skip:
        check_pose(m, what="poses", rounded=nearest)
    if last >= 0:
        m = m.copy()
        flat = m.reshape(-1, 4, 4)
        while last < len(flat):
            flat[last] = np.nan
            after = first_bad(flat[last + 1 :])
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
