"""A cut through a map of reach, or through two and their difference."""

import os
import textwrap
from pathlib import Path
from typing import Any

import numpy as np

from dh2urdf.figures.style import MUTED, RC, Picture, mpl, plain
from dh2urdf.grids import number
from dh2urdf.workspace.section import Section
from dh2urdf.workspace.stored_map import MapCut, map_cut, open_map, same_grid

EMPTY = "#f1f2f4"
"""Colour of what is not reached."""

SIDE, HIGH = 5.0, 4.7
"""Width of a panel and height of the picture [in]."""

LETTERS = 62
"""Letters of the caption on a line under one panel."""

CALLED = {
    "share": "share of orientations",
    "solutions_mean": "solutions, mean",
    "solutions_max": "solutions, most",
    "manipulability": "manipulability",
    "singular_value": "smallest singular value",
    "limit_margin": "margin to limits",
}


def map_figure(
    found: Any,
    against: Any = None,
    *,
    variable: str = "share",
    plane: str = "",
    at: float | None = None,
) -> Picture:
    """Draw a cut through a map; with a second one on the same grid both, and their difference.

    Parameters
    ----------
    found, against : xarray.Dataset, or path of a Zarr group
        From :func:`dh2urdf.workspace.reach_map`.
    variable : str
        ``share``, ``solutions_mean``, ``solutions_max``, ``manipulability``, ``singular_value`` or
        ``limit_margin``.
    plane : {"xz", "yz", "xy"}, optional
        That of a map of one layer, else xz.
    at : float, optional
        Height of the plane along its normal [m]; the middle of the map.

    Raises
    ------
    ArgumentError
        No map, or one that is not finished; two on different grids, or with other orientations,
        limits or tasks.
    UnreachedError
        The map ends before the plane.
    """
    maps = [open_map(each) for each in (found, against) if each is not None]
    if len(maps) > 1:
        same_grid(*maps)
    cuts = [map_cut(each, variable, plane, at) for each in maps]
    names = _names(maps, [found, against])
    count = 1 if len(cuts) == 1 else 3
    top = max(float(np.nanmax(cut.values, initial=0.0)) for cut in cuts) or 1.0
    with mpl.rc_context(RC):
        figure = Picture(figsize=(SIDE * count + 0.2, HIGH))
        for k, (cut, name) in enumerate(zip(cuts, names, strict=True)):
            drawn = _panel(figure, k, count, cut.grid, cut.values, plain(name), "viridis", (0, top))
            drawn.set_label(CALLED[variable])
        if count == 3:
            off = np.nan_to_num(cuts[0].values) - np.nan_to_num(cuts[1].values)
            off[np.isnan(cuts[0].values) & np.isnan(cuts[1].values)] = np.nan
            most = float(np.nanmax(np.abs(off), initial=0.0)) or 1.0
            title = f"{plain(names[0])} less {plain(names[1])}"
            drawn = _panel(figure, 2, count, cuts[0].grid, off, title, "RdBu", (-most, most))
            drawn.set_label(f"difference of {CALLED[variable]}")
        text = "\n".join(
            textwrap.fill(line, LETTERS * count, break_on_hyphens=False)
            for line in _words(cuts, names)
        )
        figure.text(0.02, 0.015, plain(text), color=MUTED, size=9, va="bottom")
        return figure


def _names(maps: list[Any], sources: list[Any]) -> list[str]:
    """Names of the arms; of maps of one arm, those of their files."""
    names = [str(each.attrs.get("robot", "map")) for each in maps]
    if len(set(names)) == len(names):
        return names
    given = [s if isinstance(s, str | os.PathLike) else f"{name} ({k})"
             for k, (s, name) in enumerate(zip(sources, names, strict=False), 1)]  # fmt: skip
    short = [Path(s).name for s in given]
    return short if len(set(short)) == len(short) else [str(s) for s in given]


def _panel(
    figure: Picture,
    k: int,
    count: int,
    grid: Section,
    values: Any,
    title: str,
    colours: str,
    ends: tuple[float, float],
) -> Any:
    """One map, and the key of its colours."""
    width = 1.0 / count
    axes = figure.add_axes(((k + 0.15) * width, 0.2, 0.64 * width, 0.71))
    bar = figure.add_axes(((k + 0.81) * width, 0.24, 0.03 * width, 0.6))
    axes.set_facecolor(EMPTY)
    edges = [_edges(line) for line in (grid.u, grid.v)]
    drawn = axes.pcolormesh(*edges, values, cmap=colours, vmin=ends[0], vmax=ends[1], linewidth=0)
    axes.set_aspect("equal")
    axes.set(xlabel=f"${'xyz'[grid.plane.u]}$ / m", ylabel=f"${'xyz'[grid.plane.v]}$ / m")
    axes.set_title(title, weight="bold", size=11, loc="left")
    key = figure.colorbar(drawn, cax=bar)
    key.outline.set_visible(False)
    return key


def _edges(line: Any) -> Any:
    """Edges of voxels around their centres."""
    step = float(line[1] - line[0]) if len(line) > 1 else 0.01
    return np.append(line - step / 2, line[-1] + step / 2)


def _words(cuts: list[MapCut], names: list[str]) -> list[str]:
    """What is shown, and how much of the layer each reaches."""
    grid = cuts[0].grid
    where = f"Layer of voxels at {'xyz'[grid.plane.normal]} = {number(round(grid.at, 4))} m"
    cell = float((grid.u[1] - grid.u[0]) * (grid.v[1] - grid.v[0])) if min(
        len(grid.u), len(grid.v)) > 1 else 0.0  # fmt: skip
    reached = [np.isfinite(cut.values) for cut in cuts]
    areas = [f"{name} reaches {number(float(f'{has.sum() * cell:.3g}'))} m²"
             for name, has in zip(names, reached, strict=True)]  # fmt: skip
    if len(cuts) == 2:
        for k in (0, 1):
            own = number(float(f"{(reached[k] & ~reached[1 - k]).sum() * cell:.3g}"))
            areas.append(f"{names[k]} alone {own} m²")
    return [f"{where}: {'; '.join(areas)}. Self-collision not checked."]
