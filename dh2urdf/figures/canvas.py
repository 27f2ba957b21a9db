"""A sheet measured in points, and the few marks that figures are made of."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import lru_cache
from itertools import count
from typing import Any

import numpy as np

from dh2urdf.figures.projection import View
from dh2urdf.figures.style import INK, Picture, mpl
from dh2urdf.transforms import Array

POINTS_PER_INCH = 72.0


ToPoints = Callable[[Array], Array]
"""Picture coordinates (..., 2) in metres to points on the sheet."""


class Canvas:
    """Axes over a whole figure whose unit is the point, and where the eye puts an arm on it."""

    def __init__(self, width: float, height: float, view: View, to: ToPoints) -> None:
        self.width, self.height, self.view, self.to = width, height, view, to
        self.figure = Picture(figsize=(width / POINTS_PER_INCH, height / POINTS_PER_INCH))
        self.axes = self.figure.add_axes((0.0, 0.0, 1.0, 1.0))
        self.axes.set(xlim=(0, width), ylim=(0, height))
        self.axes.set_axis_off()
        self._levels = count(1.0)
        self._clip: Any = None

    def at(self, points: Array) -> Array:
        """Where points (..., 3) in metres are on the sheet, shape (..., 2)."""
        return self.to(self.view.flat(points))

    @contextmanager
    def clipped(self, rings: Sequence[Array]) -> Iterator[None]:
        """Within the block, polygons show only inside these rings (holes turn the other way)."""
        from matplotlib.path import Path

        if not rings:
            yield
            return
        self._clip = Path.make_compound_path(*[Path(ring, closed=True) for ring in rings])
        try:
            yield
        finally:
            self._clip = None

    def polygon(
        self, points: Array, face: str, edge: str = "none", width: float = 0.0, alpha: float = 1.0
    ) -> None:
        """Fill a polygon (m, 2); its outline has round corners."""
        from matplotlib.patches import Polygon

        style: Any = {"facecolor": face, "edgecolor": edge, "linewidth": width, "alpha": alpha}
        patch = Polygon(points, closed=True, joinstyle="round", zorder=self._next(), **style)
        self.axes.add_patch(patch)
        if self._clip is not None:
            patch.set_clip_path(self._clip, self.axes.transData)

    def line(self, points: Array, colour: str, width: float, **style: Any) -> None:
        """Draw a polyline (m, 2); ``style`` is matplotlib's, ends are round but of dashes."""
        round_ends: Any = {"solid_capstyle": "round", "solid_joinstyle": "round"}
        style = round_ends | {"dash_capstyle": "butt", "zorder": self._next()} | style
        self.axes.plot(*points.T, color=colour, lw=width, **style)

    def arrow(self, start: Array, end: Array, colour: str, width: float) -> None:
        """Draw an arrow with a filled head, on a white casing."""
        way = end - start
        length = float(np.linalg.norm(way))
        along = way / length
        across = np.array([-along[1], along[0]])
        head = min(4.6 * width, 0.7 * length)
        neck = end - head * along
        wing = 0.42 * head * across
        tip = np.stack([end, neck + wing, neck + 0.12 * head * along, neck - wing])
        shaft = np.stack([start, neck + 0.2 * head * along])
        self.line(np.stack([start, neck]), "white", width + 2.0, solid_capstyle="butt")
        self.polygon(tip, "white", "white", 2.0)
        self.line(shaft, colour, width, solid_capstyle="butt")
        self.polygon(tip, colour, colour, 0.3)

    def dot(self, at: Array, colour: str, radius: float, edge: str = "white") -> None:
        """Draw a filled circle."""
        from matplotlib.patches import Circle

        style: Any = {"facecolor": colour, "edgecolor": edge, "linewidth": 0.8}
        self.axes.add_patch(Circle((at[0], at[1]), radius, zorder=self._next(), **style))

    def axis_end(self, at: Array, colour: str, radius: float, *, toward_eye: bool) -> None:
        """Draw an axis seen end on: a dot in a circle towards the eye, a cross away from it."""
        self.dot(at, "white", radius + 1.2)
        self.dot(at, "white", radius, colour)
        if toward_eye:
            self.dot(at, colour, 0.36 * radius, colour)
            return
        arm = radius * np.sqrt(0.5)
        for way in (np.array([1.0, 1.0]), np.array([1.0, -1.0])):
            self.line(np.stack([at - arm * way, at + arm * way]), colour, 1.0)

    def text(
        self, at: Sequence[float] | Array, text: str, size: float, colour: str = INK, **style: Any
    ) -> None:
        """Write a text, centred but for ``style``; the text itself stays text in a file."""
        centred: Any = {"ha": "center", "va": "center_baseline", "fontsize": size}
        x, y = float(at[0]), float(at[1])
        self.axes.text(x, y, text, color=colour, zorder=self._next(), **centred | style)

    def label(self, centre: Array, text: str, size: float, colour: str) -> None:
        """Write a text so that its ink is centred, over a white halo."""
        from matplotlib.patheffects import Stroke

        left, bottom, width, height = text_box(text, size)
        corner = centre - np.array([left + width / 2, bottom + height / 2])
        halo = [Stroke(linewidth=2.6, foreground="white")]
        self.text(corner, text, size, "white", ha="left", va="baseline", path_effects=halo)
        self.text(corner, text, size, colour, ha="left", va="baseline")

    def _next(self) -> float:
        """A level above everything drawn so far: painted in the order of calls."""
        return next(self._levels)


@lru_cache(maxsize=4096)
def text_box(text: str, size: float, weight: str = "normal") -> tuple[float, float, float, float]:
    """Left, bottom, width and height [pt] of a text's ink, from the start of its baseline."""
    from matplotlib.font_manager import FontProperties
    from matplotlib.textpath import TextPath

    if not text.strip():
        return 0.0, 0.0, 0.0, 0.0
    font = FontProperties(family=mpl.rcParams["font.sans-serif"], weight=weight)
    low, high = _ink_corners(TextPath((0, 0), text, size=size, prop=font))
    return float(low[0]), float(low[1]), float(high[0] - low[0]), float(high[1] - low[1])


def _ink_corners(path: Any) -> Array:
    """Lower left and upper right corner of a path's ink, shape (2, 2).

    A curve stays among its control points, and fonts have points where a glyph is widest: only
    where the ends of its strokes do not span a path need its curves be searched.
    """
    drawn = path.codes != path.CLOSEPOLY
    points, codes = path.vertices[drawn], path.codes[drawn]
    ends = np.delete(points, np.flatnonzero(codes == path.CURVE3)[::2], axis=0)
    low, high = ends.min(axis=0), ends.max(axis=0)
    if (codes == path.CURVE4).any() or (points < low).any() or (points > high).any():
        return np.asarray(path.get_extents().get_points())
    return np.stack([low, high])


def text_size(text: str, size: float, weight: str = "normal") -> tuple[float, float]:
    """Width and height of a text [pt]."""
    return text_box(text, size, weight)[2:]
