"""The arm in the manner of textbooks: lines for links, cylinders and boxes for joints."""

from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from dh2urdf.conversions.write import Body, frame_along
from dh2urdf.dh import DHConvention, JointType
from dh2urdf.drawing.arm import DrawnArm
from dh2urdf.drawing.row import DHRowPicture, row_picture
from dh2urdf.figures.canvas import Canvas
from dh2urdf.figures.projection import View
from dh2urdf.figures.solids.solid_paint import Paint, paint_parts
from dh2urdf.figures.solids.solids import Part, outlines
from dh2urdf.figures.style import INK
from dh2urdf.transforms import Array, pose, trans

ROD = 0.008
"""Radius of a link's line, as a share of the arm's size."""

DRUM_RADIUS, DRUM_LENGTH = 0.034, 0.10
"""A revolute joint's cylinder, as shares of the arm's size."""

BOX_WIDTH, BOX_LENGTH = 0.062, 0.13
"""A prismatic joint's box, as shares of the arm's size."""

BAR = "#7f93a3"
"""Colour of the lines of a parallelogram."""

PAINT = Paint({"link": (INK, INK), "joint": ("#ffffff", "#eef1f5"), "bar": (BAR, BAR)}, INK, 0.9)


def draw_schematic(canvas: Canvas, arm: DrawnArm, q: Array, scale: float) -> None:
    """Draw the schematic of an arm at q (n,); ``scale`` is in [pt/m]."""
    _ground(canvas, arm, scale)
    paint_parts(canvas, list(_parts(arm, q)), PAINT)


def schematic_points(arm: DrawnArm, q: Array, view: View) -> Array:
    """Picture coordinates [m] that the schematic spans, shape (m, 2)."""
    return np.concatenate([*outlines(_parts(arm, q), view), view.flat(np.zeros((1, 3)))])


def _parts(arm: DrawnArm, q: Array) -> Iterator[Part]:
    rows = [row_picture(arm, q, i) for i in range(1, arm.table.n + 1)]
    standard, size = arm.table.convention is DHConvention.STANDARD, arm.size
    corners = [np.zeros(3), rows[0].T_prev[:3, 3]]
    for row in rows:
        foot = row.a.segment[0 if standard else 1]
        corners += [foot, row.T_reached[:3, 3], row.T_next[:3, 3]]
    corners.append((rows[-1].T_next @ arm.table.tool.matrix)[:3, 3])
    for start, end in pairwise(corners):
        if float(np.linalg.norm(end - start)) > 1e-6 * size:
            yield Part("link", _rod(start, end, ROD * size))
    for start, end in arm.bar_ends(q):
        yield Part("bar", _rod(start, end, 0.6 * ROD * size))
    placed: list[Array] = []
    for row, joint in zip(rows, arm.table.joints, strict=True):
        spot, axis = _spot(arm, row, placed)
        placed.append(spot)
        body = Body("cylinder", (DRUM_RADIUS * size, DRUM_LENGTH * size), np.eye(4), "joint")
        if joint.joint_type is JointType.PRISMATIC:
            box = (BOX_WIDTH * size, BOX_WIDTH * size, BOX_LENGTH * size)
            body = Body("box", box, np.eye(4), "joint")
        yield Part("joint", [(body, pose(frame_along(axis), spot))])


def _spot(arm: DrawnArm, row: DHRowPicture, placed: list[Array]) -> tuple[Array, Array]:
    """Centre and direction of a joint's drawing: on its axis, clear of the joints before it."""
    start, end = row.d.segment
    frame = row.T_prev if arm.table.convention is DHConvention.STANDARD else row.T_reached
    z = frame[:3, 2]
    step = 1.25 * DRUM_LENGTH * arm.size
    tries = [start, (start + end) / 2, start + 0.7 * (end - start)]
    tries += [start + sign * step * z for sign in (1.0, -1.0)]
    clear = [min((float(np.linalg.norm(p - t)) for p in placed), default=np.inf) for t in tries]
    for spot, room in zip(tries, clear, strict=True):
        if room > 0.9 * DRUM_LENGTH * arm.size:
            return spot, z
    return tries[int(np.argmax(clear))], z


def _rod(start: Array, end: Array, radius: float) -> list[tuple[Body, Array]]:
    length = float(np.linalg.norm(end - start))
    rod = Body("cylinder", (radius, length), np.eye(4), "link")
    ball = Body("sphere", (radius,), np.eye(4), "link")
    along = frame_along((end - start) / length)
    return [(rod, pose(along, (start + end) / 2)), (ball, trans(*end))]


def _ground(canvas: Canvas, arm: DrawnArm, scale: float) -> None:
    """The hatched line that stands for the fixed world."""
    half = 0.075 * arm.size * scale
    foot = canvas.at(np.zeros(3))
    if canvas.view.elevation < 80.0:
        foot = foot - np.array([0.0, DRUM_RADIUS * arm.size * scale])
    canvas.line(foot + half * np.array([[-1.0, 0.0], [1.0, 0.0]]), INK, 1.4)
    for t in np.linspace(-0.85, 1.0, 7):
        start = foot + np.array([t * half, 0.0])
        canvas.line(np.stack([start, start - 0.28 * half]), INK, 0.8)
