"""A map in a Zarr group: variables in blocks, what has been done, where it came from.

Blocks are written by whoever works them out, first their variables, then a mark in
``progress/done``; one without a mark is worked out again. NaN is what has not been worked out, and
a measure where nothing is reached; the attribute ``complete`` becomes 1 after the last block.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dh2urdf.exceptions import (
    ArgumentError,
    Dh2UrdfError,
    MissingExtraError,
    OutputError,
    OutputExistsError,
)
from dh2urdf.workspace.reach.block import Values
from dh2urdf.workspace.reach.dataset import (
    COMPLETE,
    KEY,
    PURPOSE,
    MapSummary,
    attributes,
    coordinates,
    shapes,
    summary_of,
    variables,
)
from dh2urdf.workspace.reach.measured import MEASURES
from dh2urdf.workspace.reach.same_map import refuse_others
from dh2urdf.workspace.reach.settings import Block, MapSettings

DONE = "progress/done"

DAMAGED = RuntimeError, ValueError
"""What codecs raise of a chunk that they cannot decode."""

CF = {"coordinates": "rotation"}
"""What tells readers that this variable is a coordinate."""


def prepare(path: str, settings: MapSettings, said: dict[str, Any]) -> None:
    """Make the arrays of a map, or check that those that are there belong to the same one.

    Raises
    ------
    ArgumentError
        The map that is there has other settings.
    OutputExistsError
        Something else is there.
    OutputError
        It cannot be written.
    """
    zarr = load_zarr()
    with writing(path, "this call worked out nothing"):
        group = _opened(zarr, path)
        if group is None:
            attrs = {**said, **CF, COMPLETE: 0}
            group = zarr.open_group(path, mode="w-", zarr_format=3, attributes=attrs)
        elif KEY not in group.attrs:
            raise _other(path)
        refuse_others(path, dict(group.attrs), said)
        expected = {**shapes(settings), DONE: settings.counts}
        if any(name not in group for name in expected):
            _make(zarr, group, settings)
        for name, shape in expected.items():
            if group[name].shape != shape:
                raise ValueError(f"{name} has the shape {group[name].shape}, not {shape}")


def _opened(zarr: Any, path: str) -> Any:
    """The group at a path, or None where there is nothing."""
    try:
        return zarr.open_group(path, mode="r+", zarr_format=3, use_consolidated=False)
    except FileNotFoundError:
        place = Path(path)
        if "://" not in path and (place.is_file() or (place.is_dir() and any(place.iterdir()))):
            raise _other(path) from None
        return None
    except ImportError as error:  # of fsspec, for the protocol of a URL
        raise ArgumentError(f"{path}: {error}") from None
    except (
        FileExistsError,
        NotADirectoryError,
        ValueError,
        TypeError,
    ) as error:  # a file, or an array
        if "Protocol not known" in str(error):
            raise ArgumentError(f"{path}: {error}") from None
        raise _other(path) from None


def _other(path: str) -> OutputExistsError:
    return OutputExistsError(f"{path}: is there and no map of the reach; give another path")


def _make(zarr: Any, group: Any, settings: MapSettings) -> None:
    """All arrays, nothing in them but coordinates."""
    for name, (axes, values, attrs) in coordinates(settings).items():
        array = group.create_array(
            name,
            shape=values.shape,
            dtype=values.dtype,
            dimension_names=axes,
            attributes=attrs,
            overwrite=True,
        )
        array[...] = values
    across = variables(settings)
    for name, shape in shapes(settings).items():
        group.create_array(
            name,
            shape=shape,
            chunks=(*[settings.side] * 3, *shape[3:]),
            dtype="float32",
            fill_value=np.nan,
            dimension_names=across[name],
            attributes=attributes(name, dict(group.attrs)),
            overwrite=True,
        )
    group.create_array(
        DONE,
        shape=settings.counts,
        chunks=(1, 1, 1),
        dtype="bool",
        fill_value=False,
        overwrite=True,
        dimension_names=("block_x", "block_y", "block_z"),
        attributes={"long_name": "whether a block is worked out"},
    )
    _consolidate(zarr, group)


def _consolidate(zarr: Any, group: Any) -> None:
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "Consolidated metadata")
        zarr.consolidate_metadata(group.store, path=group.path)


def done(path: str) -> NDArray[np.bool_]:
    """Which blocks are done, one entry a block."""
    with writing(path):
        marks: NDArray[np.bool_] = _group(path)[DONE][...]
        return marks


def is_done(path: str, block: Block, of: dict[str, Any]) -> bool:
    """Whether the map's arrays ``of`` have a mark of a block."""
    with writing(path):
        return bool(of[DONE][block])


def take_back(path: str, settings: MapSettings) -> NDArray[np.bool_]:
    """Which blocks are done, the marks of those removed that have lost a chunk since."""
    with writing(path):
        group = _group(path)
        marks: NDArray[np.bool_] = group[DONE][...]
        lost = marks & _lacking(group, settings, marks)
        if lost.any() or not marks.all():
            _complete(group, 0)
        for block in map(tuple, np.argwhere(lost)):
            group[DONE][block] = marks[block] = False
        return marks


def _lacking(group: Any, settings: MapSettings, marks: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Which blocks lack values, of those that are marked: a chunk that is gone reads as NaN.

    Where a chunk cannot be decoded, all blocks of its layer count as lacking.
    """
    lacking, side = np.zeros(settings.counts, np.bool_), settings.side
    voxels = [
        "share",
        "solutions_mean",
        "solutions_max",
        *MEASURES,
        *["level"] * ("level" in group),
    ]
    for k in np.flatnonzero(marks.any(axis=(1, 2))):
        layer = slice(k * side, (k + 1) * side)
        try:
            bad = _empty({name: group[name][layer] for name in voxels}, "max").any(axis=0)
        except DAMAGED:
            lacking[k] = True
            continue
        for axis in (0, 1):
            starts = np.arange(0, bad.shape[axis], side)
            bad = np.logical_or.reduceat(bad, starts, axis=axis)
        lacking[k] = bad
    each = [f"{name}_each" for name in ("solutions", *MEASURES)] if settings.each else []
    for block in map(tuple, np.argwhere(marks)) if each else ():
        part = settings.part(block)
        try:
            lacking[block] |= _empty({name: group[name][part] for name in each}, "each").any()
        except DAMAGED:
            lacking[block] = True
    return lacking


def _empty(values: Values, kind: str) -> NDArray[np.bool_]:
    """Where a variable is NaN, a measure only where there is a solution."""
    reached: NDArray[np.bool_] = np.greater(values[f"solutions_{kind}"], 0)
    empty = np.zeros(reached.shape, np.bool_)
    for name, v in values.items():
        empty |= np.isnan(v) & reached if name.startswith(MEASURES) else np.isnan(v)
    return empty


def finish(path: str) -> None:
    """Say that all blocks are worked out."""
    with writing(path):
        _complete(_group(path), 1)


def _complete(group: Any, value: int) -> None:
    if group.attrs[COMPLETE] != value:
        group.attrs[COMPLETE] = value
        _consolidate(load_zarr(), group)


def arrays(path: str) -> dict[str, Any]:
    """The arrays of a map that is there, by name; opening them takes longer than a block."""
    with writing(path):
        group = _group(path)
        return {DONE: group[DONE], **dict(group.arrays())}


def write(
    path: str, settings: MapSettings, block: Block, values: Values, to: dict[str, Any]
) -> None:
    """Put a block's variables into the map's arrays ``to``, then its mark.

    Raises
    ------
    OutputError
    """
    with writing(path):
        part = settings.part(block)
        for name, value in values.items():
            to[name][part] = value  # a chunk of NaN only is not written
        to[DONE][block] = True


def summary(path: str) -> MapSummary:
    """A map that is there in a few numbers."""
    with writing(path):
        group = _group(path)
        return summary_of(dict(group.attrs[KEY]), group["share"])


def read(path: str, part: tuple[slice, ...]) -> Values:
    """The variables of a part of a map, without those of each orientation."""
    with writing(path):
        group = _group(path)
        names = [name for name, array in group.arrays() if array.ndim == 3]
        return {name: group[name][part] for name in names}


def _group(path: str) -> Any:
    return load_zarr().open_group(path, mode="r+", zarr_format=3, use_consolidated=False)


KEPT = "blocks that are done are kept, the same call goes on with the rest"


@contextmanager
def writing(path: str, left: str = KEPT) -> Iterator[None]:
    """Say of a disk that takes nothing, or a damaged store, where it was, and what to do."""
    try:
        yield
    except Dh2UrdfError:
        raise
    except OSError as error:
        reason = error.strerror or str(error)
        raise OutputError(f"{path}: {reason}; {left}") from None
    except Exception as error:  # of zarr and codecs: a file of the store holds something else
        raise OutputError(
            f"{path}: is damaged ({error}); remove it, or give another path"
        ) from None


def load_zarr() -> Any:
    """Zarr, or the error that names the extra."""
    try:
        import zarr
    except ImportError:
        raise MissingExtraError("scale", PURPOSE) from None
    return zarr
