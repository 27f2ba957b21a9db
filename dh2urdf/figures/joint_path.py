"""The joints along a path: a panel each, with limits, breaks and poses out of reach."""

from typing import Any

import numpy as np

from dh2urdf.drawing.colours import BRANCH_COLOURS
from dh2urdf.figures.style import FAINT, INK, MUTED, RC, Picture, mpl, plain
from dh2urdf.ik.problem import IKPath
from dh2urdf.robot import Robot
from dh2urdf.transforms import Array

BREAK = "#b5122b"
"""Colour of a jump."""

LEFT, RIGHT, HEAD, PANEL, FOOT = 0.7, 0.45, 0.55, 0.95, 0.55
"""Margins and the height of a panel [in]."""


def path_figure(robot: Robot, path: IKPath, *, width: float = 7.5) -> Picture:
    """Joint values over the number of the pose, angles in degrees and lengths in metres.

    Parameters
    ----------
    robot : Robot
        The arm of the path.
    path : IKPath
        From :meth:`dh2urdf.Robot.ik_path`.
    width : float
        Of the figure [in].
    """
    scale = np.where(robot.slides, 1.0, 180.0 / np.pi)
    q, poses = path.q * scale, np.arange(1.0, len(path) + 1.0)
    with mpl.rc_context(RC):
        high = HEAD + PANEL * robot.n + FOOT
        figure = Picture(figsize=(width, high))
        panels = figure.subplots(robot.n, 1, sharex=True, squeeze=False)[:, 0]
        box = {"left": LEFT / width, "right": 1 - RIGHT / width}
        figure.subplots_adjust(**box, top=1 - HEAD / high, bottom=FOOT / high, hspace=0.42)
        for i, axes in enumerate(panels):
            _values(axes, poses, q[:, i], path)
            _limits(axes, robot.lower[i] * scale[i], robot.upper[i] * scale[i])
            unit = "m" if robot.slides[i] else "deg"
            axes.set_title(
                f"{plain(path.joint_names[i])} [{unit}]", loc="left", size=9, pad=3, color=INK
            )
        panels[-1].set_xlabel("pose")
        panels[-1].set_xlim(0.5, len(path) + 0.5)
        text = f"{plain(robot.model.name)}: {len(path)} poses, joint motion {path.motion:.4g}"
        figure.text(LEFT / width, 1 - 0.24 / high, text, size=10, weight="bold", va="center")
        _legend(figure, path, 1 - RIGHT / width, 0.16 / high)
        return figure


def _values(axes: Any, poses: Array, values: Array, path: IKPath) -> None:
    """One joint: a line between breaks, which are marked where the arm would have to jump."""
    parts = np.split(np.arange(len(poses)), path.breaks)
    for part in parts:
        mark = "." if len(part) == 1 or len(poses) <= 40 else ""
        axes.plot(poses[part], values[part], color=BRANCH_COLOURS[0], lw=1.6, marker=mark, ms=4)
    for i in path.breaks:
        axes.axvline(poses[i] - 0.5, color=BREAK, lw=0.9, ls=(0, (4, 2)))
    for first, last in path.gaps:
        axes.axvspan(poses[first] - 0.5, poses[last] + 0.5, color=FAINT, alpha=0.45, lw=0)
    axes.locator_params(axis="y", nbins=4)
    axes.tick_params(labelsize=8)


def _limits(axes: Any, low: float, high: float) -> None:
    """The joint's limits, where they are in sight or near to it."""
    bottom, top = axes.get_ylim()
    span = 0.15 * (top - bottom)
    for limit in (low, high):
        if bottom - span <= limit <= top + span:
            axes.axhline(limit, color=MUTED, lw=0.9, ls=(0, (1, 2)))
            where = {"xy": (1.0, limit), "xycoords": axes.get_yaxis_transform()}
            axes.annotate(" limit", **where, size=8, color=MUTED, va="center")


def _legend(figure: Picture, path: IKPath, right: float, y: float) -> None:
    """What the marks mean, of those that are there."""
    many = len(path.breaks)
    words = [f"{many} break{'s' * (many > 1)}, dashed"] if many else []
    words += [f"{len(path.unreachable)} out of reach, grey"] if path.unreachable else []
    colour = BREAK if path.breaks else MUTED
    figure.text(right, y, "; ".join(words), size=9, color=colour, ha="right", va="center")
