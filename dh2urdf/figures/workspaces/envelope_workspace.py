"""The envelope of an arm in the round, a quarter cut out, the arm standing in it."""

import math
from typing import Any

import numpy as np

from dh2urdf.drawing.arm import drawn_arm, table_of, zero_configuration
from dh2urdf.exceptions import Dh2UrdfError
from dh2urdf.figures.canvas import Canvas, text_size
from dh2urdf.figures.dh_panel import wrapped
from dh2urdf.figures.projection import View
from dh2urdf.figures.solids.solid_paint import BODY, paint_parts
from dh2urdf.figures.solids.solids import arm_parts, outlines
from dh2urdf.figures.style import INK, MUTED, RC, Picture, mix, mpl, plain
from dh2urdf.figures.workspaces.planar_workspace import LIGHT, nice_step
from dh2urdf.grids import number
from dh2urdf.robot import Robot
from dh2urdf.transforms import Array, pose, rot_z
from dh2urdf.workspace import Envelope, caption, default_orientation, reach_ball, task_of

EYE = View(-60.0, 22.0)
"""Where the eye stands; the quarter towards it is open."""

WALL, CUT = "#8fb4d9", "#f2c46d"
"""Colours of the boundary and of the cut through what is reached."""

SHADES = 40
"""Tones of the boundary."""

SIDE, MARGIN, FOOT = 400.0, 26.0, 62.0
"""Larger side of the drawing, border around it, room for scale and sentence below it [pt]."""


def envelope_picture(
    robot: Robot, found: Envelope, *, within_limits: bool = True, tried: str = ""
) -> Picture:
    """Draw the surface from far to near, and the arm in the open quarter."""
    arm = drawn_arm(table_of(robot))
    q = _posed(robot, within_limits)
    parts = arm_parts(arm.bodies, arm.link_poses(robot.chain_configuration(q)))
    flat = np.concatenate([EYE.flat(found.corners), *outlines(parts, EYE)])
    low, high = flat.min(axis=0), flat.max(axis=0)
    scale = (SIDE - 2 * MARGIN) / float((high - low).max())
    width, height = np.maximum(scale * (high - low) + 2 * MARGIN, 300.0)
    middle, centre = (low + high) / 2, np.array([width / 2, height / 2 + FOOT])
    with mpl.rc_context(RC):
        canvas = Canvas(width, height + FOOT, EYE, lambda p: (p - middle) * scale + centre)
        _paint(canvas, found)
        paint_parts(canvas, parts, BODY)
        _scale(canvas, scale)
        low, high = found.corners.min(axis=0), found.corners.max(axis=0)
        far = float(np.hypot(*(found.corners - reach_ball(robot)[0])[:, :2].T).max())
        what = f"Envelope, radius {number(round(far, 3))} m, z from "
        what += f"{number(round(float(low[2]), 3))} to {number(round(float(high[2]), 3))} m"
        text = caption(robot, what, within_limits=within_limits, tried=tried)
        for k, line in enumerate(wrapped(plain(text), width - 2 * MARGIN, 8.0)):
            canvas.text((MARGIN, FOOT - 26.0 - 11.0 * k), line, 8.0, MUTED, ha="left")
        return canvas.figure


def _paint(canvas: Canvas, found: Envelope) -> None:
    """All quadrilaterals, shaded by how they face the light."""
    from matplotlib.collections import PolyCollection

    quads = found.corners[found.quads]
    normal = np.cross(quads[:, 2] - quads[:, 0], quads[:, 3] - quads[:, 1])
    size = np.linalg.norm(normal, axis=1)
    lit = np.abs(normal @ LIGHT) / np.maximum(size, 1e-12)
    order = np.argsort(EYE.depth(quads.mean(axis=1)))
    order = order[size[order] > 1e-12]
    shades = [mix(WALL, 0.5 + 0.5 * k / SHADES, "#1a2433") for k in range(SHADES + 1)]
    tones = [
        CUT if cut else shades[int(SHADES * share)]
        for share, cut in zip(lit[order], found.is_cut[order], strict=True)
    ]
    drawn: Any = canvas.at(quads[order])
    canvas.axes.add_collection(
        PolyCollection(drawn, facecolors=tones, edgecolors=tones, linewidths=0.4, zorder=0.5)
    )


def _scale(canvas: Canvas, scale: float) -> None:
    """A bar of a round length."""
    step = nice_step(90.0 / scale)
    y = FOOT - 8.0
    ends = np.array([[MARGIN, y], [MARGIN + step * scale, y]])
    canvas.line(ends, INK, 1.6, solid_capstyle="butt")
    for end in ends:
        canvas.line(end + np.array([[0.0, -3.0], [0.0, 3.0]]), INK, 1.0)
    text = f"{number(step)} m"
    canvas.text(ends[1] + np.array([6.0 + text_size(text, 9.0)[0] / 2, 0.0]), text, 9.0)


def _posed(robot: Robot, within_limits: bool) -> Array:
    """A configuration with the arm in the open quarter; zero where none is found."""
    centre, radius = reach_ball(robot)
    azimuth, task = math.radians(EYE.azimuth), task_of(robot)
    turn = rot_z(azimuth)[:3, :3]
    for share in (0.6, 0.5, 0.4, 0.7, 0.3):
        p = centre + radius * share * np.array([math.cos(azimuth), math.sin(azimuth), 0.2])
        T = pose(turn @ default_orientation(robot, task), p)
        try:
            found = robot.ik(T, within_limits=within_limits, task=task.name)
        except Dh2UrdfError:
            break
        if len(found):
            arm = drawn_arm(table_of(robot))
            frames = [arm.frames(q) for q in robot.chain_configuration(found.q)]
            heights = [float(frame[:, 2, 3].mean()) for frame in frames]
            return np.asarray(found.q[int(np.argmax(heights))])
    return zero_configuration(robot, None)
