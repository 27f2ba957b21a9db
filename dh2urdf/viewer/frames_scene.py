"""DH frames, and one row of the table explained, in the scene."""

import math
from typing import Any

import numpy as np

from dh2urdf.conversions.write import Body, frame_along
from dh2urdf.dh import DHConvention
from dh2urdf.dh_io import Units
from dh2urdf.drawing.arm import DrawnArm
from dh2urdf.drawing.colours import AXIS, QUANTITY, rgb
from dh2urdf.drawing.lesson import Motion, motions, staged
from dh2urdf.drawing.row import Arc, DHRowPicture, Measure, axis_name, row_picture, values
from dh2urdf.drawing.surfaces import body_surface
from dh2urdf.transforms import Array
from dh2urdf.viewer.arm_scene import add_mesh, set_poses

AXIS_LENGTH = 0.12
"""Length of a frame's axes, as a share of the arm's size."""

SHAFT = 0.006
"""Radius of an arrow's shaft, as a share of the arm's size."""

THICK = 4.5
"""Width of arcs on the screen [px]."""

BESIDE = 0.22
"""How far beside a measure the name of an axis that runs along it stands, in axis lengths."""

CROWDED = 0.2
"""Distance up to which two axes' ends share one label, against the length of the axes."""

NEAR = 1e-6
"""Distance up to which two names are in one place [m]; the first is shown."""

FAR_OFF = 1e9
"""Where axes without a label are put [m], so that they share none."""

TUBE = 1.7
"""Radius of a measure against that of the arrows' shafts, which it covers."""


def add_arrows(server: Any, name: str, length: float, size: float) -> None:
    """Three arrows along x, y and z under a scene name, in the colours of the axes."""
    for letter, direction in zip("xyz", np.eye(3), strict=True):
        thin = 0.7 if letter == "y" else 1.0
        ends = np.array([[np.zeros(3), length * thin * direction]], np.float32)
        shares = {"shaft_radius": 1.0, "head_radius": 2.4, "head_length": 6.5}
        sizes = {key: thin * share * SHAFT * size for key, share in shares.items()}
        server.scene.add_arrows(f"{name}/{letter}", ends, rgb(AXIS[letter]), **sizes)


def add_label(server: Any, name: str, text: str, place: Array, **options: Any) -> Any:
    """A text in the middle of a place (3,) of the scene."""
    return server.scene.add_label(name, text, position=place, anchor="center-center", **options)


def _on(segment: Array, point: Array) -> bool:
    """True where a point lies on a segment (2, 3), whose line would run through its name."""
    start, end = segment
    way = end - start
    length = float(np.linalg.norm(way))
    if length < 1e-9:
        return False
    along = float((point - start) @ way) / length
    off = float(np.linalg.norm(point - start - along * way / length))
    return 0.0 < along < length and off < 0.02 * length


class FramesScene:
    """All DH frames with their names; nothing is sent to the pages before they are asked for."""

    def __init__(self, server: Any, arm: DrawnArm) -> None:
        self.server, self.arm = server, arm
        self.roots: list[Any] = []
        self.labels: list[Any] = []
        self.axes = self.named = False
        self.row = 0

    def _add(self) -> None:
        length = 0.8 * AXIS_LENGTH * self.arm.size
        for i in range(self.arm.table.n + 1):
            self.roots.append(self.server.scene.add_frame(f"/dh/{i}", show_axes=False))
            add_arrows(self.server, f"/dh/{i}", length, 0.7 * self.arm.size)
            for letter, direction in (("x", 0), ("z", 2)):
                name, place = f"/dh/{i}/name_{letter}", 1.15 * length * np.eye(3)[direction]
                text, small = axis_name(self.arm, letter, i), {"font_screen_scale": 0.9}
                self.labels.append(add_label(self.server, name, text, place, **small))

    def show(self, q: Array) -> None:
        """Place the frames at q (n,)."""
        if not self.roots:
            return
        frames = self.arm.frames(q)
        set_poses(self.roots, frames)
        apart = self._apart(frames)
        for root, alone in zip(self.roots, apart, strict=True):
            root.visible = bool(self.axes and alone)
        self._name(frames, apart)

    def _apart(self, frames: Array) -> Array:
        """Which frames (n + 1,) stand apart from those of the row explained, which it draws."""
        if not self.row:
            return np.ones(len(frames), bool)
        places = frames[:, :3, 3]
        own = places[self.row - 1 : self.row + 1]
        away = np.linalg.norm(places[:, None] - own[None], axis=2).min(axis=1)
        return np.asarray(away > BESIDE * AXIS_LENGTH * self.arm.size)

    def _name(self, frames: Array, apart: Array) -> None:
        """Give names that would lie on one another to one label."""
        length = 1.15 * 0.8 * AXIS_LENGTH * self.arm.size
        ends = frames[:, :3, 3][:, None] + length * frames[:, :3, [0, 2]].transpose(0, 2, 1)
        names = [axis_name(self.arm, letter, i) for i in range(len(frames)) for letter in "xz"]
        shown = np.repeat(apart, 2)
        places = np.where(shown[:, None], ends.reshape(-1, 3), FAR_OFF)
        away = np.linalg.norm(places[:, None] - places[None], axis=2)
        first = np.argmax(away < CROWDED * length, axis=1)
        for k, label in enumerate(self.labels):
            label.visible = bool(self.named and first[k] == k and shown[k])
            text = ", ".join(name for name, at in zip(names, first, strict=True) if at == k)
            if label.visible and label.text != text:
                label.text = text

    def set_visible(self, axes: bool, names: bool, row: int) -> None:
        """Show the frames and their names from the next :meth:`show` on.

        Those of the row explained, 0 for none, stay away: it draws them itself.
        """
        self.axes, self.named, self.row = axes, axes and names, row
        if axes and not self.roots:
            self._add()

    def remove(self) -> None:
        """Take the frames out of the scene."""
        for root in self.roots:
            root.remove()


class RowScene:
    """Row i of the table between frames i - 1 and i: two measures, two arcs, their values."""

    def __init__(self, server: Any, arm: DrawnArm, i: int, units: Units) -> None:
        self.server, self.arm, self.i, self.units = server, arm, i, units
        self.step: int | None = None
        self.count: int | None = None
        self.steps: list[Motion] = []
        self.done: set[str] = set()
        self.root = server.scene.add_frame("/row", show_axes=False)
        self.length = 1.6 * AXIS_LENGTH * arm.size
        self.ends = []
        for name in ("prev", "next"):
            self.ends.append(server.scene.add_frame(f"/row/{name}", show_axes=False))
            add_arrows(server, f"/row/{name}", self.length, 0.7 * arm.size)
        self.picture: DHRowPicture | None = None

    def show(self, q: Array) -> None:
        """Draw the row at q (n,)."""
        picture = self.picture = row_picture(self.arm, q, self.i)
        self.steps = motions(self.arm.table, self.i, float(q[self.i - 1]))
        far = self.arm.shifts[self.i - 1 : self.i + 1].any()  # no way that can be drawn
        count = self.count = None if far else self.step
        self.done = {motion.key for motion in self.steps[:count]}
        if count is not None:
            picture = staged(picture, self.steps, count)
        set_poses(self.ends, np.stack([picture.T_prev, picture.T_next]))
        words = values(self.arm.table, picture, self.units)
        self._axes(picture)
        for measure in (picture.d, picture.a):
            self._measure(measure, words[measure.key])
        for arc in (picture.theta, picture.alpha):
            self._arc(arc, words[arc.key])
        self._names(picture)

    def _axes(self, picture: DHRowPicture) -> None:
        """Both z axes as long thin lines, and the common normal."""
        reach = 1.8 * self.length
        start, end = picture.a.segment
        standard = self.arm.table.convention is DHConvention.STANDARD
        x = picture.T_reached[:3, 0] if standard else picture.T_prev[:3, 0]
        lines = [
            [T[:3, 3] - reach * T[:3, 2], T[:3, 3] + reach * T[:3, 2]]
            for T in (picture.T_prev, picture.T_reached)
        ]
        if "a" in self.done:
            lines.append([start - 0.5 * reach * x, end + 0.7 * reach * x])
        self._segments("axes", np.array(lines), "#8a93a3", 1.2)

    def _measure(self, measure: Measure, text: str) -> None:
        """A tube with its value; a length of zero has none."""
        start, end = measure.segment
        length = float(np.linalg.norm(end - start))
        pose = np.eye(4)
        pose[:3, 3] = (start + end) / 2
        shown = length > 1e-9 and measure.key in self.done
        if length > 1e-9:
            pose[:3, :3] = frame_along((end - start) / length)
        size = (TUBE * 0.7 * SHAFT * self.arm.size, max(length, 1e-6))
        tube = body_surface(Body("cylinder", size, pose, "link"), rgb(QUANTITY[measure.key]))
        add_mesh(self.server, f"/row/{measure.key}", tube, cast_shadow=False, visible=shown)
        self._label(measure.key, text, (start + end) / 2, visible=shown)

    def _arc(self, arc: Arc, text: str) -> None:
        """An arc with its value, from a thin line in its starting direction."""
        radius = (0.72 if arc.key == "theta" else 0.86) * self.length
        shown = abs(arc.value) > 1e-9 and arc.key in self.done
        points = arc.points(radius)
        pairs = np.stack([points[:-1], points[1:]], axis=1)
        self._segments(arc.key, pairs, QUANTITY[arc.key], THICK, visible=shown)
        rays = np.array([[arc.centre, arc.centre + 1.15 * radius * arc.start]])
        self._segments(f"{arc.key}_from", rays, QUANTITY[arc.key], 1.5, visible=shown)
        middle = points[len(points) // 2]
        out = arc.centre + 1.18 * (middle - arc.centre)
        self._label(arc.key, text, out, visible=shown)

    def _names(self, picture: DHRowPicture) -> None:
        i, taken = self.i, list[Array]()
        under_way = self.count is not None and self.count < len(self.steps)
        self.ends[1].visible = self.count != 0
        for T, k in ((picture.T_prev, i - 1), (picture.T_next, i)):
            for letter, direction in (("x", 0), ("z", 2)):
                place = T[:3, 3] + 1.12 * self.length * T[:3, direction]
                if letter == "x" and _on(picture.a.segment, place):
                    place = place - BESIDE * self.length * T[:3, 2]
                shown = self.count is None or all(math.dist(place, p) > NEAR for p in taken)
                taken.append(place)
                text = f"{letter}′" if under_way and k == i else axis_name(self.arm, letter, k)
                name = f"{letter}{'prev' if k < i else 'next'}"
                self._label(name, text, place, visible=shown)

    def _segments(
        self, name: str, points: Array, colour: str, width: float, *, visible: bool = True
    ) -> None:
        style: Any = {"thickness": width, "thickness_units": "screen", "visible": visible}
        ends = points.astype(np.float32)
        self.server.scene.add_line_segments(f"/row/{name}", ends, rgb(colour), **style)

    def _label(self, name: str, text: str, place: Array, *, visible: bool = True) -> None:
        add_label(self.server, f"/row/label_{name}", text, place, visible=visible)

    def remove(self) -> None:
        """Take the row out of the scene."""
        self.root.remove()
