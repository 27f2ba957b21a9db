"""A map as a dataset of xarray: variables with units, coordinates, where it came from."""

from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from dh2urdf.exceptions import ArgumentError, MissingExtraError
from dh2urdf.workspace.reach.block import Values
from dh2urdf.workspace.reach.measured import MEASURES
from dh2urdf.workspace.reach.settings import MapSettings
from dh2urdf.workspace.reach.units import measure_units
from dh2urdf.workspace.stored_map import SETTINGS, open_map

if TYPE_CHECKING:
    import xarray

KEY = SETTINGS

COMPLETE = "complete"
"""Attribute: 1 once all blocks are worked out, 0 before."""

DAMAGED = (
    LookupError,
    TypeError,
    ValueError,
    ArithmeticError,
    AttributeError,
    RuntimeError,  # of a codec
    OSError,
)
"""What is raised where a file holds anything."""

PURPOSE = "a map of the reach"

WORDS = {
    "share": ("share of orientations reached", "1"),
    "solutions_mean": ("solutions of an orientation, mean over all tried", "1"),
    "solutions_max": ("most solutions of an orientation", "1"),
    "solutions_each": ("solutions of each orientation", "1"),
    "manipulability": ("largest manipulability sqrt(det(J J^T)), J in m and rad", ""),
    "singular_value": ("largest of the solutions' smallest singular values of J, in m and rad", ""),
    "limit_margin": ("largest of the solutions' distances from a joint limit", ""),
    "level": ("how often the voxel of these values was halved", "1"),
}
"""For each variable what it says and its unit; that of a measure depends on the arm."""


def variables(settings: MapSettings) -> dict[str, tuple[str, ...]]:
    """Names of a map's variables, and their axes."""
    voxels: tuple[str, ...] = "x", "y", "z"
    names = dict.fromkeys(WORDS, voxels)
    del names["solutions_each"]
    if not settings.level:
        del names["level"]
    if settings.each:
        each = "solutions_each", *(f"{name}_each" for name in MEASURES)
        names |= dict.fromkeys(each, (*voxels, "orientation"))
    return names


def attributes(name: str, said: dict[str, Any]) -> dict[str, str]:
    """What a variable says, and its unit, of a map with such attributes."""
    whole = name if name in WORDS else name.removesuffix("_each")
    words, unit = WORDS[whole]
    if name != whole:
        words = f"{words}, of each orientation"
    if whole in MEASURES:
        arm = json.loads(said["chain"])
        kinds = arm.get("value_types", arm["joint_types"])
        unit = measure_units(kinds, said[KEY]["task"])[whole]
        if unit == "rad or m":
            words = f"{words}, the least number of those in rad and those of slides in m"
    return {"long_name": words, "units": unit}


def coordinates(settings: MapSettings) -> dict[str, tuple[tuple[str, ...], Any, dict[str, str]]]:
    """Centres of the voxels [m], and the rotations tried."""
    metres = {"units": "m"}
    lines: dict[str, Any] = {
        axis: ((axis,), settings.grid.centres(k), {"long_name": f"{axis} in base", **metres})
        for k, axis in enumerate("xyz")
    }
    words = {"long_name": "rotation of the tip in base", "units": "1"}
    axes = "orientation", "spin", "row", "column"
    return {**lines, "rotation": (axes, settings.turns, words)}


def to_dataset(settings: MapSettings, values: Values, attrs: dict[str, Any]) -> xarray.Dataset:
    """The map of arrays over the whole grid."""
    xr = load_xarray()
    data = {
        name: (axes, values[name], attributes(name, attrs))
        for name, axes in variables(settings).items()
    }
    dataset: xarray.Dataset = xr.Dataset(data, coordinates(settings), attrs)
    return dataset


def shapes(settings: MapSettings) -> dict[str, tuple[int, ...]]:
    """The shape of each variable."""
    k = len(settings.turns)
    return {
        name: (*settings.grid.shape, *[k] * (len(axes) - 3))
        for name, axes in variables(settings).items()
    }


def empty_values(settings: MapSettings) -> Values:
    """Room for all variables."""
    return {name: np.empty(shape, np.float32) for name, shape in shapes(settings).items()}


class MapSummary(NamedTuple):
    """A map in a few numbers.

    Attributes
    ----------
    shape : tuple of int
        Voxels along x, y, z.
    step : float
        Side of one [m].
    orientations, poses : int
        Orientations a voxel, and that times the voxels (as if all were of this size).
    volume, area : float or None
        Of the voxels that are reached in an orientation [m^3]; of a map of one layer the area
        [m^2].
    largest_share : float
        Of the orientations, in a voxel.
    task : str
        What was asked of each pose, as of :meth:`dh2urdf.Robot.ik`.
    """

    shape: tuple[int, int, int]
    step: float
    orientations: int
    poses: int
    volume: float | None
    area: float | None
    largest_share: float
    task: str


def map_summary(found: xarray.Dataset) -> MapSummary:
    """A map in a few numbers, read from its store a layer of blocks at a time.

    Raises
    ------
    ArgumentError
        No map, one that is not finished, or whose settings or shares are damaged.
    """
    found = open_map(found)
    try:
        return summary_of(found.attrs[KEY], found["share"])
    except DAMAGED as fault:
        raise ArgumentError(f"map: its settings or shares cannot be read: {fault!r}") from None


def summary_of(settings: dict[str, Any], share: Any) -> MapSummary:
    """The numbers of a map's settings, as they are stored, and its shares, sliced by layers."""
    layer = settings["block"]
    nx, ny, nz = share.shape
    step = math.ldexp(settings["step"], -settings["refine"])
    parts = (np.asarray(share[k : k + layer]) for k in range(0, nx, layer))
    seen = [(int((part > 0.0).sum()), float(part.max())) for part in parts]
    k, spins = settings["orientations"]
    count, flat = sum(count for count, _ in seen), 1 in share.shape
    return MapSummary(
        shape=(nx, ny, nz),
        step=step,
        orientations=k,
        poses=nx * ny * nz * k * spins,
        volume=None if flat else count * step**3,
        area=count * step**2 if flat else None,
        largest_share=max(most for _, most in seen),
        task=settings["task"],
    )


def load_xarray() -> Any:
    """xarray, or the error that names the extra."""
    try:
        import xarray
    except ImportError:
        raise MissingExtraError("scale", PURPOSE) from None
    return xarray
