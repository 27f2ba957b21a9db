"""The map of bases of a job, seen from above: margins, the poses, the best base with its arm."""

import textwrap
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from dh2urdf.doors import finite_array, instance, items
from dh2urdf.drawing.arm import arm_points
from dh2urdf.exceptions import ArgumentError
from dh2urdf.figures.style import INK, MUTED, RC, Picture, mpl, plain
from dh2urdf.grids import number
from dh2urdf.robot import Robot
from dh2urdf.transforms import Array
from dh2urdf.workspace import Placement, reach_ball

SIDE, HIGH, MOST = 5.4, 5.6, 4
"""Width of a panel and height of the picture [in], and panels at most."""

GREY, DARK = ("#f6f7f8", "#c3c8cf"), "#4b5563"
"""Colours of bases that reach none, and nearly all, of the poses; the latter where none does."""

MISSED = "#d62728"
"""Colour of poses out of reach from the best base."""

LETTERS = 80
"""Letters of the caption on a line under one panel."""


class Placed(NamedTuple):
    """A robot and where it is to stand."""

    robot: Robot
    placement: Placement


def placement_figure(Ts: ArrayLike, placed: Sequence[tuple[Robot, Placement]]) -> Picture:
    """Draw where robots may stand for a job, a panel each, on one scale of margins.

    Parameters
    ----------
    Ts : array_like, shape (m, 4, 4)
        ``T_world_tool`` of the job's poses.
    placed : sequence of pairs of Robot and Placement
        What :func:`dh2urdf.workspace.place` found for each.
    """
    T = finite_array(Ts, "Ts", "poses of shape (m, 4, 4)")
    pairs = [items(pair, "placed") for pair in items(placed, "placed")]
    if any(len(pair) != 2 for pair in pairs):
        raise ArgumentError("placed: expected pairs of a Robot and its Placement")
    arms = [Placed(instance(r, "placed", Robot), instance(p, "placed", Placement))
            for r, p in pairs]  # fmt: skip
    if T.ndim != 3 or T.shape[1:] != (4, 4) or not 1 <= len(arms) <= MOST:
        raise ArgumentError(f"expected poses of shape (m, 4, 4) and 1 to {MOST} placements")
    top = max(0.01, *(float(arm.placement.map.margin.max()) for arm in arms))
    top = max(top, *(arm.placement.margin for arm in arms))
    corners = _corners(T, arms)
    with mpl.rc_context(RC):
        figure = Picture(figsize=(SIDE * len(arms) + 0.3, HIGH))
        width = 1.0 / len(arms)
        for k, arm in enumerate(arms):
            axes = figure.add_axes(((k + 0.13) * width, 0.18, 0.66 * width, 0.75))
            bar = figure.add_axes(((k + 0.81) * width, 0.24, 0.03 * width, 0.58))
            _panel(axes, bar, T, arm, top)
            axes.set(xlim=corners[:, 0], ylim=corners[:, 1])
        figure.text(0.02, 0.015, _caption(len(T), arms), color=MUTED, size=9, va="bottom")
        return figure


def _corners(T: Array, arms: list[Placed]) -> Array:
    """A square around the maps' bases of use and the poses, (2, 2)."""
    spots = [T[:, :2, 3]]
    for placement in (arm.placement for arm in arms):
        area = placement.map
        rows, columns = np.nonzero(area.reached >= min(0.5, float(area.reached.max())))
        spots.append(np.stack([area.x[columns], area.y[rows]], axis=1))
        if np.isfinite(placement.q).any():
            spots.append(placement.T_world_base[None, :2, 3])
    found = np.concatenate(spots)
    low, high = found.min(axis=0), found.max(axis=0)
    half = 0.6 * max(float((high - low).max()), 0.2)
    return np.stack([(low + high) / 2 - half, (low + high) / 2 + half])


def _panel(axes: Any, bar: Any, T: Array, arm: Placed, top: float) -> None:
    """One robot's map."""
    from matplotlib.colors import LinearSegmentedColormap
    from matplotlib.ticker import MaxNLocator

    robot, placement = arm
    area = placement.map
    whole = bool((area.margin > 0.0).any())
    grey = LinearSegmentedColormap.from_list("share", GREY if whole else (GREY[0], DARK))
    edges = [_edges(values) for values in (area.x, area.y)]
    axes.set_facecolor(GREY[0])
    counts = np.where(area.margin > 0.0, np.nan, area.reached * len(T))
    drawn = axes.pcolormesh(*edges, counts, cmap=grey, vmin=0.0, vmax=len(T), linewidth=0)
    if whole:
        margins = np.where(area.margin > 0.0, area.margin, np.nan)
        drawn = axes.pcolormesh(*edges, margins, cmap="viridis", vmin=0.0, vmax=top, linewidth=0)
    key = bar.figure.colorbar(drawn, cax=bar, ticks=MaxNLocator(6, integer=not whole))
    key.set_label("margin of the worst pose" if whole else f"poses reached, of {len(T)}")
    key.outline.set_visible(False)
    if np.isfinite(placement.q).any():
        _arm(axes, robot, placement)
    _poses(axes, T, placement)
    axes.set_aspect("equal")
    axes.set(xlabel="world $x$ / m", ylabel="world $y$ / m")
    axes.set_title(plain(robot.model.name), weight="bold", size=11, loc="left")


def _edges(values: Array) -> Array:
    """Edges of cells around values."""
    if len(values) == 1:
        return np.asarray(values[0] + np.array([-0.05, 0.05]))
    middle = (values[1:] + values[:-1]) / 2
    return np.concatenate([[2 * values[0] - middle[0]], middle, [2 * values[-1] - middle[-1]]])


def _arm(axes: Any, robot: Robot, placement: Placement) -> None:
    """The robot at its base, as bones, in the pose with the least margin that it reaches."""
    T_world_base = placement.T_world_base
    spot, ahead = T_world_base[:2, 3], T_world_base[:2, 0]
    reached = np.isfinite(placement.q[:, 0])
    if reached.any():
        worst = np.where(reached, placement.margins, np.inf).argmin()
        q = placement.q[worst : worst + 1]
        points = np.concatenate([np.zeros((1, 3)), arm_points(robot, q)[0], robot.fk(q)[:, :3, 3]])
        bones = (points @ T_world_base[:3, :3].T + T_world_base[:3, 3])[:, :2]
        axes.plot(*bones.T, color="white", lw=5.5, solid_capstyle="round", solid_joinstyle="round")
        axes.plot(*bones.T, color=INK, lw=2.8, solid_capstyle="round", solid_joinstyle="round")
    size = 0.14 * reach_ball(robot)[1]
    arrow = {"arrowstyle": "-|>", "color": MISSED, "lw": 1.8, "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", spot + size * ahead, spot, arrowprops=arrow, zorder=8)
    axes.plot(*spot, "s", ms=9, mfc="white", mec=MISSED, mew=2.0, zorder=9)


def _poses(axes: Any, T: Array, placement: Placement) -> None:
    """Poses as dots, those out of reach crossed."""
    missed = np.isin(np.arange(len(T)), placement.missed)
    axes.plot(*T[~missed, :2, 3].T, "o", ms=5, mfc="#ff9f1c", mec=INK, mew=0.9, zorder=10)
    axes.plot(*T[missed, :2, 3].T, "X", ms=9, mfc=MISSED, mec="white", mew=0.8, zorder=11)


def _caption(m: int, arms: list[Placed]) -> str:
    """What is shown, and the best base of each."""
    lines, whole = [], f"all {m} poses" if m > 1 else "the pose"
    for robot, placement in arms:
        name = plain(robot.model.name)
        place = zip("xyz", (placement.x, placement.y, placement.z), strict=True)
        at = ", ".join(f"{axis} {number(round(value, 3))} m" for axis, value in place)
        base = f"{at}, yaw {number(round(np.degrees(placement.yaw), 1))}°"
        margin = number(round(placement.margin, 3))
        text = f"{name}: {whole} from {base}; margin {margin}."
        if not placement.found:
            reached = m - len(placement.missed)
            base = base if reached else "any base that was tried"
            text = f"{name}: no base found that reaches {whole}; {reached} from {base}."
        lines.append(text)
    lines.append("Grey: bases that leave poses out, the darker the fewer. Collisions not checked.")
    return "\n".join(textwrap.fill(line, LETTERS * len(arms)) for line in lines)
