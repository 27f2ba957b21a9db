"""Kinematics of Dask arrays: the same answers a chunk at a time, when they are asked for.

The robot goes along as bytes, which each process builds once.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from dh2urdf.exceptions import ArgumentError, ConfigurationError, PoseError
from dh2urdf.robot.carried import packed, unpacked
from dh2urdf.transforms import Array

if TYPE_CHECKING:
    from dh2urdf.ik.problem import IKBatch

FIELDS = ("q", "residual", "count", "branch_code", "free_mask", "pose_change")


def is_lazy(values: object) -> bool:
    """Whether a value is an array of Dask, which need not be there to ask."""
    return type(values).__module__.startswith("dask.array")


def lazy_fk(robot: Any, q: Any) -> Any:
    """:meth:`Robot.fk` of configurations (..., n) that are a Dask array, shape (..., 4, 4)."""
    if q.ndim < 1 or q.shape[-1] != robot.n:
        raise ConfigurationError(f"q: expected shape (..., {robot.n}), got {q.shape}")
    whole = q.rechunk({q.ndim - 1: -1})
    return whole.map_blocks(
        _fk,
        packed(robot),
        drop_axis=q.ndim - 1,
        new_axis=[q.ndim - 1, q.ndim],
        chunks=(*whole.chunks[:-1], (4,), (4,)),
        dtype=np.float64,
        meta=np.empty((0,) * (q.ndim + 1)),
    )


def _fk(q: Array, data: bytes) -> Array:
    T: Array = unpacked(data).fk(q)
    return T


def lazy_ik(robot: Any, Ts: Any, asked: dict[str, Any], refused: dict[str, Any]) -> IKBatch:
    """:meth:`Robot.ik_batch` of poses (m, 4, 4) that are a Dask array; so are the answer's arrays.

    Raises
    ------
    PoseError
        The array has another shape, or chunks of unknown lengths.
    ArgumentError
        A joint held at a value for each pose, or something of ``refused``.
    """
    from dask import delayed

    if Ts.ndim != 3 or Ts.shape[1:] != (4, 4) or math.isnan(sum(Ts.shape)):
        raise PoseError(f"poses: expected a Dask array of known shape (m, 4, 4), got {Ts.shape}")
    for name, value in refused.items():
        if value is not None:
            raise ArgumentError(f"{name}: does nothing for poses of a Dask array")
    if any(np.ndim(value) for value in (asked["locked"] or {}).values()):
        raise ArgumentError("locked: expected one value a joint for poses of a Dask array")
    whole = Ts.rechunk({1: -1, 2: -1})
    sample = robot.ik_batch(np.empty((0, 4, 4)), **asked)
    solve, data = delayed(_solved, pure=True), delayed(packed(robot))
    answers = [solve(data, part, asked) for part in whole.to_delayed().ravel()]
    fields = {
        name: _joined(answers, name, whole.chunks[0], getattr(sample, name)) for name in FIELDS
    }
    batch: IKBatch = type(sample)(sample.problem, whole, **fields)
    return batch


def _solved(data: bytes, Ts: Array, asked: dict[str, Any]) -> dict[str, Array]:
    found = unpacked(data).ik_batch(Ts, **asked)
    return {name: getattr(found, name) for name in FIELDS}


def _joined(answers: list[Any], name: str, lengths: tuple[int, ...], like: Array) -> Any:
    """One of the arrays of all answers."""
    from dask import array

    parts = [
        array.from_delayed(answer[name], (m, *like.shape[1:]), dtype=like.dtype)
        for answer, m in zip(answers, lengths, strict=True)
    ]
    return array.concatenate(parts)
