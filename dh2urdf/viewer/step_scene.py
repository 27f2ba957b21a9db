"""A step of a worked solution in the scene: its triangle, arc or frame, with their letters."""

from typing import Any

import numpy as np

from dh2urdf.drawing.colours import QUANTITY, rgb
from dh2urdf.lessons import Mark
from dh2urdf.viewer.arm_scene import set_poses
from dh2urdf.viewer.frames_scene import add_arrows, add_label

LENGTH = 0.16
"""Length of a frame's axes, as a share of the arm's size."""

THICK = 4.0
"""Width of lines on the screen [px]."""

INK = "#1f2430"
"""Colour of lines that are no length of the table."""

GREEK = {"theta": "θ", "alpha": "α", "phi": "φ", "gamma": "γ"}

DIGITS = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")


class StepScene:
    """What one step draws; nothing where it has no marks."""

    def __init__(self, server: Any, size: float) -> None:
        self.server, self.size = server, size
        self.marks: tuple[Mark, ...] = ()
        self.root: Any = None

    def show(self, marks: tuple[Mark, ...]) -> None:
        """Draw these marks instead of those before."""
        self.remove()
        self.marks = marks
        if not marks:
            return
        self.root = self.server.scene.add_frame("/step", show_axes=False)
        for k, mark in enumerate(marks):
            name = f"/step/{k}"
            if mark.kind == "frame":
                self._frame(name, mark)
            elif mark.kind == "point":
                self._label(name, mark, mark.points[0])
            else:
                self._line(name, mark)

    def _frame(self, name: str, mark: Mark) -> None:
        """Three arrows, with the frame's number."""
        handle = self.server.scene.add_frame(name, show_axes=False)
        add_arrows(self.server, name, LENGTH * self.size, 0.7 * self.size)
        set_poses([handle], mark.points[None])
        place = mark.points[:3, 3] - 0.2 * LENGTH * self.size * mark.points[:3, 2]
        add_label(self.server, f"{name}_label", f"frame {mark.label}", place)

    def _line(self, name: str, mark: Mark) -> None:
        """A line through points; an arc with the two rays that bound it, from its centre."""
        points = mark.points
        if mark.kind == "arc":
            centre, ring = points[0], points[1:]
            points = np.vstack([centre, ring, centre])
            place = centre + 1.25 * (ring[len(ring) // 2] - centre)
        else:
            place = 0.5 * (points[0] + points[-1])
        pairs = np.stack([points[:-1], points[1:]], axis=1).astype(np.float32)
        style: Any = {"thickness": THICK, "thickness_units": "screen"}
        colour = QUANTITY.get(mark.label.partition("_")[0], INK)
        self.server.scene.add_line_segments(name, pairs, rgb(colour), **style)
        self._label(name, mark, place)

    def _label(self, name: str, mark: Mark, place: Any) -> None:
        if mark.label:
            add_label(self.server, f"{name}_label", letter(mark.label), place)

    def remove(self) -> None:
        """Take the step out of the scene."""
        if self.root:
            self.root.remove()
        self.root, self.marks = None, ()


def letter(name: str) -> str:
    """``theta_1`` as ``θ₁``; ``o_c``, whose index has no sign of its own, as it is."""
    head, _, index = name.partition("_")
    return GREEK.get(head, head) + index.translate(DIGITS) if index.isdigit() else name
