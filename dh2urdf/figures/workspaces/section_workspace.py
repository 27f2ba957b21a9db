"""A section through an arm's reach: how many branches, and from how many sides."""

import textwrap
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from dh2urdf.drawing.arm import arm_points, zero_configuration
from dh2urdf.exceptions import Dh2UrdfError
from dh2urdf.figures.style import INK, MUTED, RC, Picture, mpl, plain
from dh2urdf.figures.workspaces.edges import Counts, Regions, Rings
from dh2urdf.robot import Robot
from dh2urdf.transforms import Array, pose
from dh2urdf.workspace import Section, Task, caption, task_of

LEVELS = (0.25, 0.5, 0.75, 0.95)
"""Shares at which white contours are drawn."""

EMPTY = "#f1f2f4"
"""Colour of no solution."""

LINE = 86
"""Letters of the caption on a line under one map."""

GRADUAL = 0.15
"""Share of the places reached from some sides only above which lines are drawn between them."""


class Branches(NamedTuple):
    """Number of solutions at the points of a section, and where there are at least so many."""

    grid: Section
    values: Counts
    regions: Regions


class Shares(NamedTuple):
    """Share of orientations at the points of a section, where it is any, and how many are tried."""

    grid: Section
    values: Array
    edge: list[Rings]
    sharp: bool
    tried: int


def section_picture(
    robot: Robot,
    counts: Branches | None,
    shares: Shares | None,
    R: Array,
    *,
    within_limits: bool = True,
    tried: str = "",
) -> Picture:
    """Draw the maps of a section side by side.

    ``counts`` are the branches with the tip turned to R (3, 3); ``tried`` tells in the caption how
    the maps were made.
    """
    panels = [p for p in (counts, shares) if p is not None]
    with mpl.rc_context(RC):
        figure = Picture(figsize=(5.4 * len(panels) + 0.2, 5.5))
        width = 1.0 / len(panels)
        for k, panel in enumerate(panels):
            left = k * width
            axes = figure.add_axes((left + 0.145 * width, 0.15, 0.67 * width, 0.75))
            bar = figure.add_axes((left + 0.835 * width, 0.22, 0.03 * width, 0.61))
            if isinstance(panel, Branches):
                _counts(axes, bar, panel, task_of(robot), R)
            else:
                _shares(axes, bar, panel, task_of(robot))
            _frame(axes, panel[0], _used(panels))
            if k == 0:
                _silhouette(axes, robot, panel[0], R, within_limits)
        what = f"Slice {panels[0][0].name}"
        text = caption(robot, what, within_limits=within_limits, tried=tried)
        lines = textwrap.fill(plain(text), LINE * len(panels), break_on_hyphens=False)
        figure.text(0.02, 0.015, lines, color=MUTED, size=9, va="bottom")
        return figure


def _used(panels: list[Any]) -> Array:
    """Corners of a square around everything reached and the origin, with a margin, (2, 2)."""
    low, high = np.zeros(2), np.zeros(2)
    for panel in panels:
        grid, values = panel[0], panel[1]
        rows, columns = np.nonzero(values)
        if len(rows):
            found = np.stack([grid.u[columns], grid.v[rows]])
            low, high = np.minimum(low, found.min(axis=1)), np.maximum(high, found.max(axis=1))
    middle, half = (low + high) / 2, 0.56 * max(float((high - low).max()), 1e-3)
    return np.stack([middle - half, middle + half])


def _frame(axes: Any, grid: Section, corners: Array) -> None:
    u, v = "xyz"[grid.plane.u], "xyz"[grid.plane.v]
    axes.set(xlabel=f"${u}$ / m", ylabel=f"${v}$ / m")
    axes.set_aspect("equal")
    from matplotlib.ticker import MaxNLocator

    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(MaxNLocator(5, steps=[1, 2, 5, 10]))
    axes.set(xlim=corners[:, 0], ylim=corners[:, 1], facecolor=EMPTY)
    axes.axhline(0.0, color=INK, lw=0.6, ls=":", alpha=0.6)


def _outline(polygons: list[Rings]) -> Any:
    """Polygons with holes as one path."""
    from matplotlib.path import Path

    rings = [Path(ring, closed=True) for polygon in polygons for ring in polygon]
    return Path.make_compound_path(*rings)


def _counts(axes: Any, bar: Any, branches: Branches, task: Task, R: Array) -> None:
    """One colour a number of branches, white lines between them."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import BoundaryNorm, ListedColormap
    from matplotlib.patches import PathPatch

    counts, regions = branches.values, branches.regions
    numbers = np.unique(np.concatenate([[0], counts.ravel()]))
    blues = mpl.colormaps["Blues"](np.linspace(0.28, 0.92, max(len(numbers) - 1, 1)))
    colours = ListedColormap([EMPTY, *blues[: len(numbers) - 1]])
    style: Any = {"edgecolor": "white", "linewidth": 1.2}
    for number, colour in zip(numbers[1:].tolist(), blues, strict=False):
        axes.add_patch(PathPatch(_outline(regions[number]), facecolor=colour, **style))
    norm = BoundaryNorm(np.arange(len(numbers) + 1) - 0.5, len(numbers))
    key = ScalarMappable(norm, colours)
    drawn = _key(key, bar, np.arange(len(numbers)), [str(n) for n in numbers])
    drawn.ax.tick_params(length=0, which="both")
    axes.set_title(f"IK branches, {_turned(task, R)}", weight="bold", size=11, loc="left")


def _turned(task: Task, R: Array) -> str:
    if task.name == "position":
        return "any orientation"
    z = R[:, 2]
    for axis, word in (((0, 0, -1), "down"), ((0, 0, 1), "up")):
        if float(z @ np.array(axis)) > 1 - 1e-9 and task.sides != "turns":
            return f"tool pointing {word}"
    return "tool turned as at q = 0" if task.sides == "turns" else "tool turned as asked"


def _shares(axes: Any, bar: Any, shares: Shares, task: Task) -> None:
    """Filled contours of the share, white lines at a few of them."""
    grid, share = shares.grid, shares.values
    field = _carried_on(share) if shares.sharp else share
    steps = np.linspace(0.0, 1.0, 21)
    drawn = [axes.contourf(grid.u, grid.v, field, levels=steps, cmap="viridis")]
    drawn[0].set(edgecolor="face", linewidth=0.3)
    reached = share[share > 0.0]
    if len(reached) and np.mean(reached < LEVELS[-1]) > GRADUAL:
        lines = axes.contour(grid.u, grid.v, field, levels=LEVELS, colors="white", linewidths=1.1)
        axes.clabel(lines, fmt=lambda level: f"{100 * level:.0f}%", fontsize=8, inline=True)
        drawn.append(lines)
    for part in drawn if shares.edge else ():
        part.set_clip_path(_outline(shares.edge), axes.transData)
    key = _key(drawn[0], bar, steps[::5], [f"{100 * share:g}" for share in steps[::5]])
    key.set_label("orientations reached / %")
    what = "turns" if task.sides == "turns" else "uniform rotations"
    axes.set_title(f"Dexterity ({shares.tried} {what})", weight="bold", size=11, loc="left")


def _carried_on(share: Array) -> Array:
    """The share carried on past its edge, where it would drop to zero between two points."""
    out = np.where(share > 0.0, share, np.nan)
    for _ in range(2):
        wide = np.pad(out, 1, constant_values=np.nan)
        rows, columns = wide.shape
        around = np.stack(
            [wide[i : i + rows - 2, j : j + columns - 2] for i in range(3) for j in range(3)]
        )
        known = np.isfinite(around)
        mean = np.where(known, around, 0.0).sum(axis=0) / np.maximum(known.sum(axis=0), 1)
        out = np.where(np.isnan(out) & known.any(axis=0), mean, out)
    return out


def _key(drawn: Any, bar: Any, ticks: ArrayLike, names: list[str]) -> Any:
    """What the colours mean."""
    key = bar.figure.colorbar(drawn, cax=bar, ticks=ticks)
    key.ax.set_yticklabels(names)
    key.outline.set_visible(False)
    return key


def _silhouette(axes: Any, robot: Robot, grid: Section, R: Array, within_limits: bool) -> None:
    """The arm as bones, at a solution in the plane where there is one."""
    q, target = _posed(robot, grid, R, within_limits)
    points = np.concatenate(
        [np.zeros((1, 3)), *arm_points(robot, q[None]), robot.fk(q[None])[:, :3, 3]]
    )
    bones = points[:, [grid.plane.u, grid.plane.v]]
    axes.plot(*bones.T, color="white", lw=6.5, solid_capstyle="round", solid_joinstyle="round")
    axes.plot(*bones.T, color=INK, lw=3.6, solid_capstyle="round", solid_joinstyle="round")
    axes.plot(*bones[:-1].T, "o", ms=5.5, mfc="white", mec=INK, mew=1.4, ls="none")
    if target is not None:
        spot = target[[grid.plane.u, grid.plane.v]]
        axes.plot(*spot, "x", ms=10, mew=2.8, color="#d62728", zorder=9)


def _posed(
    robot: Robot, grid: Section, R: Array, within_limits: bool
) -> tuple[Array, Array | None]:
    """A configuration that reaches a point right of the middle; zero where none does."""
    zero = zero_configuration(robot, None)
    u, v, half = np.median(grid.u), np.median(grid.v), (grid.u[-1] - grid.u[0]) / 2
    across = [grid.plane.normal, grid.plane.u, grid.plane.v]
    T = pose(R)
    for share in (0.55, 0.45, 0.35, 0.65, 0.25):
        T[across, 3] = grid.at, u + share * half, v + 0.15 * half
        try:
            found = robot.ik(T, within_limits=within_limits, task=task_of(robot).name)
        except Dh2UrdfError:
            return zero, None
        if len(found):
            heights = arm_points(robot, found.q).mean(axis=1)[:, grid.plane.v]
            return found.q[int(np.argmax(heights))], T[:3, 3]
    return zero, None
