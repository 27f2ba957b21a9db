"""Maps of reach as pictures need them: opened, cut by a plane, as a surface of a level."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dh2urdf.bounds import LENGTH
from dh2urdf.doors import choice, number
from dh2urdf.exceptions import ArgumentError, MissingExtraError, UnreachedError
from dh2urdf.transforms import Array
from dh2urdf.workspace.section import PLANES, Plane, Section
from dh2urdf.workspace.surface_nets import Flags, Index, edge_ends, surface_net

if TYPE_CHECKING:
    import xarray

VARIABLES = (
    "share",
    "solutions_mean",
    "solutions_max",
    "manipulability",
    "singular_value",
    "limit_margin",
)
"""Those of a map over x, y, z."""


SETTINGS = "dh2urdf_map"
"""Attribute with the settings: a group with it is a map."""

ASKED = {
    "task": "task",
    "within_limits": "joint limits",
    "orientations": "orientations",
    "rotations": "rotations tried",
}
"""Settings that two maps have to share to be compared."""


class MapCut(NamedTuple):
    """Values of a map on its layer nearest to a plane, (rows, columns), NaN where nothing is."""

    grid: Section
    values: Array


def open_map(source: Any) -> xarray.Dataset:
    """A map as of :func:`reach_map`: the dataset itself, or the path or URL of its Zarr group.

    Of Zarr's formats only 3 is read, which maps are written in: arrays of format 2 may hold
    pickles, which are code.

    Raises
    ------
    ArgumentError
        There is no such group, it is no map, or one that is not finished.
    MissingExtraError
    """
    try:
        import xarray as xr
    except ImportError:
        raise MissingExtraError("scale", "a map of the reach") from None
    found, where = source, "map"
    if isinstance(source, str | os.PathLike):
        where = str(source)
        if "://" not in where and not Path(source).is_dir():
            raise ArgumentError(f"{source}: no such map; `dh2urdf map` writes one")
        try:
            found = xr.open_zarr(source, consolidated=False, zarr_format=3)
        except Exception as fault:  # of zarr, numcodecs, xarray: what is there is no group
            raise ArgumentError(f"{source}: no map that can be read: {fault}") from None
    if not isinstance(found, xr.Dataset) or not _is_map(found):
        raise ArgumentError(f"{where}: holds no map of a reach")
    if not found.attrs.get("complete", 1):
        part = float(_read(found.share.notnull().mean()))
        raise ArgumentError(
            f"{where}: is not finished, {part:.0%} of its voxels are worked out; the call that "
            "began it goes on with the rest"
        )
    return found


def _is_map(found: xarray.Dataset) -> bool:
    """Whether a group has shares of voxels, and their centres along each axis."""
    grid = tuple("xyz")
    centred = all(axis in found and found[axis].dims == (axis,) for axis in grid)
    return centred and "share" in found and set(found.share.dims) == set(grid)


def map_cut(
    found: xarray.Dataset, variable: str, plane: str = "", at: float | None = None
) -> MapCut:
    """The layer of voxels whose centres are nearest to a plane.

    Parameters
    ----------
    found : xarray.Dataset
    variable : str
        One of ``VARIABLES``.
    plane : {"xz", "yz", "xy"}, optional
        That of a map of one layer, else xz.
    at : float, optional
        Height of the plane along its normal [m]; the middle of the map.
    """
    choice(variable, "variable", VARIABLES)
    chosen = PLANES[choice(plane, "plane", PLANES)] if plane else _plane_of(found)
    flat = _plane_of(found)
    axes = [_read(found[axis]) for axis in "xyz"]
    if len(axes[flat.normal]) == 1 and chosen != flat:
        raise ArgumentError(
            f"plane: {chosen.name} cuts a map of one layer to a line; it lies in {flat.name}"
        )
    across = axes[chosen.normal]
    height = float(across.mean()) if at is None else number(at, "at", -LENGTH, LENGTH)
    step = float(np.ptp(across)) / max(len(across) - 1, 1) or 1e-9
    k = int(np.abs(across - height).argmin())
    if abs(float(across[k]) - height) > step:
        raise UnreachedError(f"the map ends before the plane {'xyz'[chosen.normal]} = {height:g} m")
    if variable not in found or set(found[variable].dims) != set("xyz"):
        raise ArgumentError(f"the map has no {variable} of its voxels")
    layer = found[variable].isel({"xyz"[chosen.normal]: k}).transpose(*_names(chosen))
    values = _read(layer)
    share = _whole(found.share.isel({"xyz"[chosen.normal]: k}).transpose(*_names(chosen)))
    values = np.where(share > 0.0, values, np.nan)
    return MapCut(Section(chosen, float(across[k]), axes[chosen.u], axes[chosen.v]), values)


def _whole(share: xarray.DataArray) -> Array:
    """Shares of which none is missing."""
    values = _read(share)
    lacking = int(np.isnan(values).sum())
    if lacking:
        raise ArgumentError(
            f"the map lacks {lacking} of {values.size} voxels that are to be drawn; the call that "
            "wrote it works them out again"
        )
    return values


def _read(values: xarray.DataArray) -> Array:
    """Values of a map, or one error where its files are damaged."""
    try:
        return np.asarray(values.values, float)
    except (RuntimeError, ValueError, OSError) as error:  # of a codec, a disk
        raise ArgumentError(
            f"the map's {values.name} cannot be read: {error}; the call that wrote it works it out "
            "again"
        ) from None


def _plane_of(found: xarray.Dataset) -> Plane:
    """The plane of a map of one layer of voxels, else xz."""
    for plane in PLANES.values():
        if found.share.sizes["xyz"[plane.normal]] == 1:
            return plane
    return PLANES["xz"]


def _names(plane: Any) -> tuple[str, str]:
    """Names of rows and columns."""
    return "xyz"[plane.v], "xyz"[plane.u]


def same_grid(first: xarray.Dataset, second: xarray.Dataset) -> None:
    """Refuse two maps on different grids, or of which something else was asked."""
    for axis in "xyz":
        a, b = (_read(found[axis]) for found in (first, second))
        if a.shape != b.shape or not np.allclose(a, b, rtol=0.0, atol=1e-9):
            raise ArgumentError(
                f"the maps are on different grids along {axis}: make both with one region and step"
            )
    was, now = (_settings(found) for found in (first, second))
    for key, words in ASKED.items():
        if was and now and was.get(key) != now.get(key):
            both = f": {_told(was.get(key))} and {_told(now.get(key))}"
            told = "" if key == "rotations" else both
            raise ArgumentError(f"the maps differ in their {words}{told}; make both with the same")


def _settings(found: xarray.Dataset) -> dict[str, Any]:
    """The settings of a map; none where a file holds anything else in their place."""
    settings = found.attrs.get(SETTINGS)
    return settings if isinstance(settings, dict) else {}


def _told(value: Any) -> str:
    """A setting in a message: of orientations how many, with their spins."""
    match value:
        case [count, spins]:
            return f"{count}" if spins == 1 else f"{count} in {spins} spins"
        case bool():
            return "kept" if value else "ignored"
    return str(value)


def map_surface(found: xarray.Dataset, level: float) -> tuple[Array, NDArray[np.int64]]:
    """Where a map's share of orientations crosses a level: corners (v, 3) [m], triangles (f, 3).

    Raises
    ------
    ArgumentError
    UnreachedError
        The share is nowhere above the level.
    """
    level = number(level, "level", 0.0, 1.0)
    share = _whole(found.share.transpose("x", "y", "z"))
    lines = [_read(found[axis]) for axis in "xyz"]
    if not (share > level).any():
        raise UnreachedError(f"the share of orientations is nowhere above {level:g}")
    field = np.pad(share, 1) - level
    nodes = [_beyond(line) for line in lines]

    def crossing(axis: int, index: Index, _: Flags) -> tuple[Array, Array]:
        low, high = edge_ends(nodes, axis, index)
        a = field[tuple(index.T)]
        b = field[tuple((index + (np.arange(3) == axis)).T)]
        return low + (a / (a - b))[:, None] * (high - low), np.ones(len(index))

    corners, quad = surface_net(field > 0.0, crossing)
    return corners, np.concatenate([quad[:, [0, 1, 2]], quad[:, [0, 2, 3]]])


def _beyond(line: Array) -> Array:
    """Centres of voxels, and one more at each end."""
    step = float(line[1] - line[0]) if len(line) > 1 else 1e-3
    return np.concatenate([[line[0] - step], line, [line[-1] + step]])
