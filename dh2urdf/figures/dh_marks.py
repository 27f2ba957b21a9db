"""DH frames, the lengths d and a, and the joint axes, drawn over an arm with their labels."""

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from dh2urdf.dh import DHConvention
from dh2urdf.drawing.arm import DrawnArm
from dh2urdf.drawing.colours import AXIS, QUANTITY
from dh2urdf.drawing.row import Measure, length_index, row_picture
from dh2urdf.figures.canvas import Canvas, text_size
from dh2urdf.figures.labels import Label, Line, place_labels
from dh2urdf.figures.style import mix
from dh2urdf.grids import number
from dh2urdf.transforms import Array

LABEL = 14.0
"""Size of the labels [pt]."""

END_ON = 0.22
"""Share of its length below which an axis counts as seen end on."""

SAME = 1e-6
"""Arrows closer than this share of the arm's size are one arrow with two names."""

LEADER = 13.0
"""Gap [pt] between a label and its anchor from which a thin line joins them."""

BROKEN = (2.2, 1.1)
"""Dashes of a measure whose frames were moved to the arm."""

ROOM, SHORTEST = 0.66, 0.5
"""Length of arrows against the way to the next frame in the picture; the least, against others."""

SAME_SPOT = 0.1
"""Distance in the picture, against the arrows' length, up to which frames stand on one spot."""

OUTLINE = 0.16
"""How much a body's outline minds being covered by a label, against 1 for an arrow."""


@dataclass(eq=False)
class Arrow:
    """An axis of one or more frames: names such as ``x_3``, start [m], unit direction."""

    names: list[str]
    start: Array
    direction: Array

    @property
    def letter(self) -> str:
        """The axis: x, y or z."""
        return self.names[0][0]


class DHMarks:
    """The marks of one arm at q (n,); ``length`` is that of the x and z arrows [m].

    Labels would rather not stand on ``outlines`` of bodies in the picture, each (m, 2) [m].
    """

    def __init__(
        self, canvas: Canvas, arm: DrawnArm, q: Array, length: float, outlines: list[Array]
    ) -> None:
        self.canvas, self.view, self.length = canvas, canvas.view, length
        self.arm, self.frames = arm, arm.frames(q)
        self.lengths = self._lengths()
        self.rows = [row_picture(arm, q, i) for i in range(1, arm.table.n + 1)]
        self.lines = [
            Line(canvas.to(np.stack(edge)), OUTLINE)
            for outline in outlines
            for edge in zip(outline, np.roll(outline, -1, axis=0), strict=True)
        ]
        self.labels: list[Label] = []

    def draw(self) -> None:
        """Draw everything but the labels."""
        self._joint_axes()
        self._measures()
        self._arrows()
        for frame in self.frames:
            self.canvas.dot(self.canvas.at(frame[:3, 3]), "#000000", 2.3)

    def angle(self, points: Array, text: str, colour: str) -> None:
        """Draw an arc (m, 2) [pt] that ends in an arrow, and ask a place for its label."""
        self.canvas.line(points, "white", 3.6)
        self.canvas.line(points[:-1], colour, 1.5)
        self.canvas.arrow(points[max(len(points) - 6, 0)], points[-1], colour, 1.5)
        self.lines += [Line(np.stack(pair)) for pair in pairwise(points)]
        middle = points[[len(points) // 2, len(points) // 3, 2 * len(points) // 3]]
        self._label(text, middle, middle[0] - points[[0, -1]].mean(axis=0), colour)

    def _lengths(self) -> Array:
        """Length of each frame's arrows [m], less where other frames are near in the picture."""
        spots = self.view.flat(self.frames[:, :3, 3])
        away = np.linalg.norm(spots[:, None] - spots[None], axis=2)
        away[away < SAME_SPOT * self.length] = np.inf
        room = ROOM * away.min(axis=1)
        return np.asarray(np.clip(room, SHORTEST * self.length, self.length))

    def _joint_axes(self) -> None:
        """A dash-dotted line along each joint's axis, past what stands on it."""
        standard = self.arm.table.convention is DHConvention.STANDARD
        for row in self.rows:
            frame = row.T_prev if standard else row.T_reached
            z = frame[:3, 2]
            along = (row.d.segment - frame[:3, 3]) @ z
            reach = np.array([along.min() - 0.75 * self.length, along.max() + 0.75 * self.length])
            ends = frame[:3, 3] + reach[:, None] * z
            points = self.canvas.at(ends)
            if float(np.linalg.norm(points[1] - points[0])) < 4.0:
                continue
            self.canvas.line(points, mix(AXIS["z"], 0.6), 0.9, dashes=(9.0, 3.0, 2.0, 3.0))
            self.lines.append(Line(points, 0.25))

    def _measures(self) -> None:
        """Segments of d and a in their colours, and the fixed steps dotted in grey."""
        for row in self.rows:
            for measure, index in ((row.d, row.i), (row.a, length_index(self.arm.table, row.i))):
                self._measure(measure, index)
            step = self.canvas.at(np.stack([row.T_reached[:3, 3], row.T_next[:3, 3]]))
            if float(np.linalg.norm(step[1] - step[0])) > 1.5:
                self.canvas.line(step, "#6b7280", 1.6, dashes=(1.5, 1.5))
                self.lines.append(Line(step))

    def _measure(self, measure: Measure, index: int) -> None:
        """A segment with its name; broken, and with its value, where it is measured far away."""
        segment, colour = measure.segment, QUANTITY[measure.key]
        if float(np.linalg.norm(segment[1] - segment[0])) < SAME * self.arm.size:
            return
        points = self.canvas.at(segment)
        way = points[1] - points[0]
        if float(np.linalg.norm(way)) < 1.5:
            return
        dashes: dict[str, Any] = {"dashes": BROKEN} if measure.moved else {}
        self.canvas.line(points, "white", 4.6)
        self.canvas.line(points, colour, 3.0, **dashes)
        self.lines.append(Line(points))
        name = f"${measure.key}_{{{index}}}$"
        if measure.moved:
            name += f" = {number(float(f'{measure.value:.4g}'))} m"
        marks = points[0] + np.array([[0.5], [0.35], [0.65], [0.2], [0.8]]) * way
        self._label(name, marks, np.array([-way[1], way[0]]), colour, True)

    def _arrows(self) -> None:
        """All axes, far ones first; y short and thin, without a name."""
        for letters in ("y", "xz"):
            arrows = self._merged(letters)
            arrows.sort(key=lambda a: float(self.view.depth(a.start + self.length * a.direction)))
            for arrow in arrows:
                self._arrow(arrow)

    def _arrow(self, arrow: Arrow) -> None:
        thin = arrow.letter == "y"
        length = float(self.lengths[int(arrow.names[0][1:])])
        colour, reach = AXIS[arrow.letter], length * (0.5 if thin else 1.0)
        start, end = self.canvas.at(np.stack([arrow.start, arrow.start + reach * arrow.direction]))
        shown = float(np.linalg.norm(self.view.flat(arrow.direction)))
        moved = [r"^{\prime}" if self.arm.shifts[int(n[1:])] else "" for n in arrow.names]
        parts = [f"{n[0]}_{{{n[1:]}}}{m}" for n, m in zip(arrow.names, moved, strict=True)]
        name = "$" + r",\,".join(parts) + "$"
        if shown < END_ON:
            if not thin:
                toward = float(self.view.depth(arrow.direction)) > 0
                self.canvas.axis_end(start, colour, 4.6, toward_eye=toward)
                self._label(name, start[None], np.array([-1.0, -1.0]), colour)
                self.lines.append(Line(np.stack([start - 4, start + 4])))
            return
        self.canvas.arrow(start, end, colour, 1.1 if thin else 2.3)
        self.lines.append(Line(np.stack([start, end]), 0.6 if thin else 1.0))
        if not thin:
            marks = end - np.array([[0.0], [0.25], [0.5]]) * (end - start)
            self._label(name, marks, end - start, colour)

    def _merged(self, letters: str) -> list[Arrow]:
        """Axes of all frames; those that coincide are one arrow with several names."""
        merged: list[Arrow] = []
        for i, frame in enumerate(self.frames):
            for letter in letters:
                start, way = frame[:3, 3], frame[:3, "xyz".index(letter)]
                for known in merged:
                    near = np.abs(known.start - start).max() < SAME * self.arm.size
                    if near and known.letter == letter and float(known.direction @ way) > 1 - 1e-9:
                        known.names.append(f"{letter}{i}")
                        break
                else:
                    merged.append(Arrow([f"{letter}{i}"], start, way))
        return merged

    def _label(
        self, text: str, marks: Array, toward: Array, colour: str, both_ways: bool = False
    ) -> None:
        size = np.array(text_size(text, LABEL))
        self.labels.append(Label(text, size, marks, toward, both_ways, colour))

    def write(self, bounds: Array) -> None:
        """Write the labels of all that is drawn, within bounds (2, 2) [pt]."""
        centres = place_labels(self.labels, self.lines, bounds)
        for label, centre in zip(self.labels, centres, strict=True):
            if float(label.gap(centre[None], label.marks)[0]) > LEADER:
                nearest = np.argmin(np.linalg.norm(label.marks - centre, axis=1))
                way, half = centre - label.marks[nearest], label.size / 2
                ends = np.stack([centre - np.clip(way, -half - 1.0, half + 1.0), centre - way])
                self.canvas.line(ends, mix(label.colour, 0.55), 0.7)
        for label, centre in zip(self.labels, centres, strict=True):
            self.canvas.label(centre, label.text, LABEL, label.colour)
