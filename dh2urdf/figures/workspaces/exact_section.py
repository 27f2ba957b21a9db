"""The exact section of an arm's reach: what bounds it, and how far and near the arm reaches."""

import textwrap
from dataclasses import replace
from typing import Any

import numpy as np

from dh2urdf.doors import instance
from dh2urdf.drawing.colours import BRANCH_COLOURS
from dh2urdf.exceptions import UnreachedError
from dh2urdf.figures.style import INK, MUTED, RC, Picture, mpl, plain
from dh2urdf.grids import number
from dh2urdf.robot import Robot
from dh2urdf.transforms import inverse
from dh2urdf.workspace import ExtremeReach, ReachSection, Ring, Volume

FILL, FOLD = "#dbe7f5", "#1f4e8c"
"""Colours of what is reached, and of the folds of the arm that bound it."""

LIMITS = (*BRANCH_COLOURS[1:4], *BRANCH_COLOURS[5:])
"""Colours of the limits that bound it, in turn."""

LETTERS = 92
"""Letters of the caption on a line."""


def exact_section_figure(
    robot: Robot, section: ReachSection, reach: ExtremeReach, volume: Volume
) -> Picture:
    """Draw the section through axis 1 of what the wrist point reaches, both halves of it.

    Where axis 1 is parallel to z of the base, that is up.

    Parameters
    ----------
    robot : Robot
    section : ReachSection
        From :func:`dh2urdf.workspace.reach_section`.
    reach : ExtremeReach
        Of the same point, from :func:`dh2urdf.workspace.extreme_reach`.
    volume : Volume
        From :func:`dh2urdf.workspace.reach_volume`.

    Raises
    ------
    UnreachedError
        Nothing is reached.
    """
    instance(robot, "robot", Robot)
    instance(section, "section", ReachSection)
    instance(reach, "reach", ExtremeReach)
    instance(volume, "volume", Volume)
    if not section.rings:
        raise UnreachedError(f"no place is reached by the {section.point} of {robot.model.name}")
    with mpl.rc_context(RC):
        figure = Picture(figsize=(7.6, 6.0))
        axes = figure.add_axes((0.105, 0.16, 0.63, 0.78))
        up = -1.0 if reach.above is not None and reach.axis[2] < 0.0 else 1.0
        rings = [replace(ring, points=ring.points * [1.0, up], between=ring.between * [1.0, up])
                 for ring in section.rings]  # fmt: skip
        _area(axes, rings)
        for kind, colour in _colours(section).items():
            _edges(axes, rings, kind, colour)
        _extremes(axes, section, reach, up)
        axes.axvline(0.0, color=INK, lw=0.8, ls=(0, (8, 2, 1, 2)), alpha=0.7)
        axes.set_aspect("equal")
        axes.margins(0.06)
        way = "along axis 1 from" if reach.above is None else "above"
        axes.set(xlabel="distance from axis 1 / m", ylabel=f"height {way} the shoulder / m")
        axes.legend(
            loc="upper left", bbox_to_anchor=(1.01, 1.0), frameon=False, fontsize=9, borderpad=0
        )
        axes.set_title(f"Reach of the {section.point}", weight="bold", size=11, loc="left")
        text = textwrap.fill(plain(_caption(robot, section, volume)), LETTERS)
        figure.text(0.02, 0.015, text, color=MUTED, size=9, va="bottom")
        return figure


def _colours(section: ReachSection) -> dict[str, str]:
    """A colour for each kind of boundary, folds first."""
    kinds = {kind for ring in section.rings for kind in ring.kinds}
    limits = sorted(kinds - {"fold", "axis"})
    folds = {"fold": FOLD} if "fold" in kinds else {}
    return folds | {kind: LIMITS[i % len(LIMITS)] for i, kind in enumerate(limits)}


def _area(axes: Any, rings: list[Ring]) -> None:
    """What is reached, on both sides of the axis."""
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path

    for side in (1.0, -1.0):
        paths = [Path(np.concatenate([line, line[:1]]) * [side, 1.0], closed=True)
                 for line in (ring.through for ring in rings)]  # fmt: skip
        patch = PathPatch(Path.make_compound_path(*paths), facecolor=FILL, edgecolor="none")
        axes.add_patch(patch)


def _edges(axes: Any, rings: list[Ring], kind: str, colour: str) -> None:
    """The pieces of the boundary of a kind, in one line with gaps."""
    parts = [np.full((1, 2), np.nan)]
    for ring in rings:
        after = np.roll(ring.points, -1, axis=0)
        joined = np.stack([ring.points, ring.between, after], axis=1)
        joined[np.array(ring.kinds) != kind] = np.nan
        parts += [joined.reshape(-1, 2), parts[0]]
    line = np.concatenate(parts)
    name = "arm singular" if kind == "fold" else kind
    axes.plot(*line.T, color=colour, lw=1.9, label=plain(name), solid_capstyle="round")
    axes.plot(*(line * [-1.0, 1.0]).T, color=colour, lw=1.9, solid_capstyle="round")


def _extremes(axes: Any, section: ReachSection, reach: ExtremeReach, up: float) -> None:
    """Circles of the smallest and the largest distance from the shoulder, a place on each.

    ``up`` is -1 where axis 1 points down.
    """
    angles = np.linspace(-np.pi, np.pi, 361)
    words = zip(reach.distance, reach.places["distance"], ("nearest", "farthest"), strict=True)
    for distance, place, word in words:
        if distance > 1e-9:
            label = f"{word}: {number(round(distance, 4))} m"
            circle = distance * np.cos(angles), distance * np.sin(angles)
            axes.plot(*circle, color=MUTED, lw=1.0, ls="--", label=label)
            x, y, z = (inverse(section.T_base_axis) @ np.append(place, 1.0))[:3].tolist()
            axes.plot(np.hypot(x, y), up * z, "o", ms=5.5, mfc="white", mec=INK, mew=1.3, zorder=6)
    axes.plot(0.0, 0.0, "+", ms=10, mec=INK, mew=1.6, zorder=6, label="shoulder")


def _caption(robot: Robot, section: ReachSection, volume: Volume) -> str:
    """One sentence on what is shown."""
    limits = "joint limits kept" if section.within_limits else "joint limits ignored"
    voids = len(section.voids)
    hole = f"{voids} void{'s' * (voids > 1)}; " if voids else ""
    size = f"{number(float(f'{volume.value:.5g}'))} m³ ± {number(float(f'{volume.bound:.1g}'))} m³"
    return (
        f"{robot.model.name}: section through axis 1 of all places of the {section.point}; {hole}"
        f"volume {size}; {limits}; self-collision not checked."
    )
