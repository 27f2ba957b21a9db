"""The picture of an arm: bodies or a schematic, DH frames with labels, ghosts, the table."""

from collections.abc import Sequence
from itertools import chain
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from dh2urdf.doors import choice, finite_array, flag, items, text
from dh2urdf.drawing.arm import DrawnArm, drawn_arm, table_of, zero_configuration
from dh2urdf.drawing.colours import QUANTITY
from dh2urdf.figures.branches import draw_angles
from dh2urdf.figures.canvas import Canvas
from dh2urdf.figures.dh_marks import DHMarks
from dh2urdf.figures.dh_panel import DHPanel, draw_key, joint_values, moved_sentence
from dh2urdf.figures.projection import View, best_view, is_planar
from dh2urdf.figures.schematic import draw_schematic, schematic_points
from dh2urdf.figures.solids.ghosts import Ghost, group_ghosts
from dh2urdf.figures.solids.solid_paint import (
    BODY,
    floor_discs,
    ghost_paint,
    paint_floor,
    paint_parts,
)
from dh2urdf.figures.solids.solids import Part, arm_parts, outlines
from dh2urdf.figures.style import RC, Picture, mpl
from dh2urdf.robot import Robot
from dh2urdf.transforms import Array

Style = Literal["bodies", "schematic"]

HEIGHT = 420.0
"""Height of the sheet [pt] where the arm asks for it; less for a flat one."""

NARROWEST, WIDEST = 200.0, 470.0
"""Width of the arm's panel [pt], as its shape asks."""

MARGIN = 34.0
"""Free border around the arm [pt]; labels may stand in it."""

FEW = 5
"""Joints up to which the key gives the values of each ghost."""

ARROW = 0.13
"""Length of an axis as a share of the picture's larger side."""


def figure(
    robot: Robot,
    q: ArrayLike | None = None,
    *,
    style: Style = "bodies",
    ghosts: Sequence[ArrayLike] = (),
    ghost_names: Sequence[str] = (),
    frames: bool = True,
    table: bool = True,
    view: tuple[float, float] | None = None,
) -> Picture:
    """Draw an arm with its DH frames and its table.

    Parameters
    ----------
    robot : Robot
        One made from a URDF is drawn by the DH table that frame assignment finds for it.
    q : array_like, shape (n,), optional
        Configuration [rad] or [m]; zero, or what the limits allow nearest to it.
    style : {"bodies", "schematic"}
        Solid links, or the lines, cylinders and boxes of textbooks.
    ghosts : sequence of configurations, optional
        Other configurations, drawn behind in colour: ``robot.ik(T)`` will do.
    ghost_names : sequence of str, optional
        Names of the ghosts for the key.
    frames, table : bool
        Draw the DH frames and lengths; draw the table beside the arm.
    view : (azimuth, elevation), optional
        Direction to the eye [deg]; without it, one that shows the arm well.

    Returns
    -------
    matplotlib.figure.Figure
    """
    choice(style, "style", ("bodies", "schematic"))
    frames, table = flag(frames, "frames"), flag(table, "table")
    ghosts = items(ghosts, "ghosts")
    names = [text(name, "ghost_names") for name in items(ghost_names, "ghost_names")]
    with mpl.rc_context(RC):
        return _ArmPicture(robot, q, style, ghosts, names, frames, table, view).draw()


class _ArmPicture:
    """One figure on its way: what to draw, the eye, the sheet."""

    def __init__(
        self,
        robot: Robot,
        q: ArrayLike | None,
        style: Style,
        ghosts: Sequence[ArrayLike],
        ghost_names: Sequence[str],
        frames: bool,
        table: bool,
        view: tuple[float, float] | None,
    ) -> None:
        self.arm: DrawnArm = drawn_arm(table_of(robot))
        asked = zero_configuration(robot, q)
        self.q = robot.chain_configuration(asked)
        others = [zero_configuration(robot, ghost) for ghost in ghosts]
        joints = [robot.chain_configuration(q) for q in others]
        self.ghosts = group_ghosts(self.arm, self.q, joints, ghost_names)
        self.values = [joint_values(q, robot.slides) for q in others]
        self.key = [(ghost.colour, self._key_of(ghost)) for ghost in self.ghosts if ghost.name]
        self.style, self.show_frames = style, frames
        dh_frames = self.arm.frames(self.q)
        eye = None if view is None else finite_array(view, "view", "two angles", shape=(2,))
        self.view = View(*eye.tolist()) if eye is not None else best_view(dh_frames, self.arm.chain)
        self.parts = self._parts(self.q)
        self.floor = self._floor()
        self.ghost_parts = [self._parts(ghost.q) for ghost in self.ghosts if ghost.is_drawn]
        notes = [
            f"pose drawn: {joint_values(asked, robot.slides)}",
            *moved_sentence(self.arm.shifts),
        ]
        self.panel = DHPanel(self.arm.table, notes, self.key) if table else None
        self._lay_out(dh_frames)

    def _key_of(self, ghost: Ghost) -> str:
        """Its name, and its joints where they are few."""
        if self.arm.table.n > FEW or not ghost.is_drawn:
            return ghost.name
        return f"{ghost.name}: {self.values[ghost.number]}"

    def _parts(self, q: Array) -> list[Part]:
        return arm_parts(self.arm.bodies, self.arm.link_poses(q))

    def _lay_out(self, dh_frames: Array) -> None:
        """Choose scale and sheet so that the arm fills its panel."""
        if self.style == "schematic":
            points = [schematic_points(self.arm, self.q, self.view)]
        else:
            points = outlines(chain(self.parts, *self.ghost_parts), self.view)
        flat = np.concatenate([*points, *self.floor])
        side = float(np.ptp(flat, axis=0).max())
        self.arrow = ARROW * side
        if self.show_frames:
            axes = dh_frames[:, :3, [0, 2]].transpose(0, 2, 1)
            tips = dh_frames[:, None, :3, 3] + self.arrow * axes
            flat = np.concatenate([flat, self.view.flat(tips.reshape(-1, 3))])
        low, high = flat.min(axis=0), flat.max(axis=0)
        span = np.maximum(high - low, 1e-3 * side)
        beside = self.panel.height + 40.0 if self.panel else 0.0
        inner = max(HEIGHT, beside) - 2 * MARGIN
        width = float(np.clip(inner * span[0] / span[1] + 2 * MARGIN, NARROWEST, WIDEST))
        self.scale = float(min(inner / span[1], (width - 2 * MARGIN) / span[0]))
        height = max(self.scale * float(span[1]) + 2 * MARGIN, beside)
        middle, scale = (low + high) / 2, self.scale
        foot = 14.0 * len(self.key) if self.panel is None else 0.0
        centre = np.array([width / 2, height / 2 + foot])
        self.bounds = np.array([[6.0, 6.0 + foot], [width - 6.0, height + foot - 6.0]])
        total = width + (self.panel.width + 44.0 if self.panel else 0.0)
        self.canvas = Canvas(
            total, height + foot, self.view, lambda flat: (flat - middle) * scale + centre
        )

    def draw(self) -> Picture:
        paint_floor(self.canvas, self.floor)
        colours = [ghost.colour for ghost in self.ghosts if ghost.is_drawn]
        for parts, colour in zip(self.ghost_parts, colours, strict=True):
            paint_parts(self.canvas, parts, ghost_paint(colour))
        if self.style == "bodies":
            paint_parts(self.canvas, self.parts, BODY)
        else:
            draw_schematic(self.canvas, self.arm, self.q, self.scale)
        if self.show_frames:
            seen = outlines(self.parts, self.view)
            marks = DHMarks(self.canvas, self.arm, self.q, self.arrow, seen)
            marks.draw()
            if self.ghost_parts and is_planar(self.arm.frames(self.q), self.arm.chain):
                draw_angles(marks, self.q, QUANTITY["theta"], 0)
                for rank, ghost in enumerate((g for g in self.ghosts if g.is_drawn), 1):
                    draw_angles(marks, ghost.q, ghost.colour, rank)
            marks.write(self.bounds)
        if self.panel is None:
            draw_key(self.canvas, 14.0, 14.0 * len(self.key), self.key)
        else:
            top = (self.canvas.height + self.panel.height) / 2
            self.panel.draw(self.canvas, self.canvas.width - self.panel.width - 24.0, top)
        return self.canvas.figure

    def _floor(self) -> list[Array]:
        """Shade under the base, where the eye looks down on it at a slant."""
        if self.style != "bodies" or not 2.0 < self.view.elevation < 80.0:
            return []
        for pedestal in (b for b in self.arm.bodies[0] if b.material == "base"):
            radius, height = pedestal.size
            foot = pedestal.pose[:3, 3] - pedestal.pose[:3, 2] * height / 2
            return floor_discs(self.view, foot, 1.9 * radius)
        return []
