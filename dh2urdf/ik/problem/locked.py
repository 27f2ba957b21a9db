"""Joints that a caller holds: which they are, and their checked values."""

import math
from collections.abc import Mapping

import numpy as np

from dh2urdf.bounds import ANGLE, LENGTH
from dh2urdf.chain import SerialChain
from dh2urdf.doors import finite_array, instance, integer
from dh2urdf.exceptions import ConfigurationError, NameNotFoundError
from dh2urdf.transforms import Array

Held = float | Array

Locked = Mapping[int, Held] | Mapping[str, Held] | Mapping[int | str, Held]
"""Joints held at a value [rad] or [m], by index or name; in a batch also at a value per pose."""


def held_values(
    chain: SerialChain, locked: Locked | None, within_limits: bool
) -> tuple[tuple[int, ...], Array]:
    """Indices of the held joints in ascending order, and their values, shape (1, h) or (m, h).

    Raises
    ------
    ConfigurationError, NameNotFoundError
    """
    held: dict[int, Held] = {}
    given = {} if locked is None else instance(locked, "locked", Mapping, ConfigurationError)
    for key, value in given.items():
        i = _joint_index(chain, key)
        if i in held:
            raise ConfigurationError(f"locked: joint {chain.names[i]!r} is held twice")
        plain = isinstance(value, float) and math.isfinite(value)
        held[i] = value if plain else _numbers(key, value)
        _check_limits(chain, key, i, held[i], within_limits)
    joints = tuple(sorted(held))
    if not joints:
        return (), np.empty((1, 0))
    if len(joints) == 1:
        return joints, np.array(held[joints[0]], ndmin=1).reshape(-1, 1)
    columns = [np.atleast_1d(held[i]) for i in joints]
    try:
        return joints, np.column_stack(np.broadcast_arrays(*columns))
    except ValueError:
        lengths = sorted({len(v) for v in columns})
        raise ConfigurationError(f"locked: different numbers of values, {lengths}") from None


def _joint_index(chain: SerialChain, key: int | str) -> int:
    """Index of a joint given by index or name."""
    names = chain.names
    if isinstance(key, str):
        if key in names:
            return names.index(key)
        raise NameNotFoundError(f"no joint named {key!r}; there are {', '.join(names)}")
    return integer(key, "locked: index of a joint", 0, chain.n - 1, ConfigurationError)


def _numbers(key: int | str, value: Held) -> Array:
    """Values of a held joint, shape (1,) or (m,)."""
    what = f"locked[{key!r}]"
    values = np.array(finite_array(value, what, "a finite number", ConfigurationError), ndmin=1)
    if values.ndim != 1:
        raise ConfigurationError(f"{what}: expected a finite number, got shape {values.shape}")
    return values


def _check_limits(
    chain: SerialChain, key: int | str, joint: int, values: Held, within_limits: bool
) -> None:
    """Refuse values outside the limits of their joint, or beyond the bounds of any joint."""
    lower, upper = (chain.lower[joint], chain.upper[joint]) if within_limits else (-LENGTH, LENGTH)
    if isinstance(values, float) and lower <= values <= upper and abs(values) <= ANGLE:
        return
    bound = LENGTH if chain.prismatic[joint] else ANGLE
    lower, upper = max(lower, -bound), min(upper, bound)
    every = np.atleast_1d(values)
    outside = (every < lower) | (every > upper)
    if outside.any():
        where = "of the joint; within_limits=False allows it" if within_limits else "of any joint"
        raise ConfigurationError(
            f"locked[{key!r}]: {every[outside][0]:g} is outside the limits {lower:g} to "
            f"{upper:g} {where}"
        )
