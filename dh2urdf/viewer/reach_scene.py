"""A map of reach around the arm: the surface in which a share of the orientations is reached."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any

import numpy as np

from dh2urdf.drawing.colours import BRANCH_COLOURS
from dh2urdf.exceptions import UnreachedError
from dh2urdf.viewer.door import by_visitor
from dh2urdf.workspace import map_surface, open_map

if TYPE_CHECKING:
    import xarray

LEAST, STEP, FIRST = 0.01, 0.01, 0.5
"""Shares that can be chosen, and the one shown first."""

OPACITY = 0.32
"""Of the surface: the arm is seen through it."""

NUMBERS = itertools.count()
"""Surfaces have names of their own: one is there before the one that it replaces goes."""

COLOUR = tuple(int(BRANCH_COLOURS[0][k : k + 2], 16) for k in (1, 3, 5))


class ReachScene:
    """The surface, and the folder of the panel that chooses its share and opens half of it."""

    def __init__(self, server: Any, found: xarray.Dataset | str) -> None:
        self.server, self.map = server, open_map(found)
        highest = float(self.map.share.max())
        if highest <= LEAST:
            raise UnreachedError(f"the share of orientations is nowhere above {LEAST:g}")
        self._name = f"/reach/{next(NUMBERS)}"
        self._mesh: Any = None
        self._folder = server.gui.add_folder("Reach")
        with self._folder:
            start = min(FIRST, round(highest / 2, 2))
            self.level = server.gui.add_slider(
                "Orientations", LEAST, max(highest, LEAST + STEP), STEP, max(start, LEAST)
            )
            self.half = server.gui.add_checkbox("Half of it", True)
        self.level.on_update(by_visitor(lambda _: self.draw()))
        self.half.on_update(by_visitor(lambda _: self.draw()))
        self.draw()

    def draw(self) -> None:
        """The surface of the share that is chosen."""
        with self.server.atomic():
            if self._mesh is not None:
                self._mesh.remove()
                self._mesh = None
            try:
                corners, triangles = map_surface(self.map, min(float(self.level.value), 1.0 - 1e-9))
            except UnreachedError:
                return
            if self.half.value:
                middle = float(self.map.y.mean())
                triangles = triangles[(corners[triangles][:, :, 1] > middle).all(axis=1)]
            self._mesh = self.server.scene.add_mesh_simple(
                self._name,
                corners.astype(np.float32),
                triangles.astype(np.uint32),
                color=COLOUR,
                opacity=OPACITY,
                side="double",
                cast_shadow=False,
                receive_shadow=False,
            )

    def remove(self) -> None:
        """Take surface and folder away."""
        if self._mesh is not None:
            self._mesh.remove()
            self._mesh = None
        self._folder.remove()
