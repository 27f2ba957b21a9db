"""The planar RR arm: the surface of its poses (x, y, phi) and the annulus of its places."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dh2urdf.drawing.colours import BRANCH_COLOURS
from dh2urdf.figures.projection import View
from dh2urdf.figures.style import FAINT, INK, MUTED, RC, Picture, mix, mpl, plain
from dh2urdf.robot import Robot
from dh2urdf.transforms import Array
from dh2urdf.workspace import PlanarArm, caption

Flags = NDArray[np.bool_]
Shape = tuple[float, Array, str]
"""Nearness to the eye, outline, colour."""

SHEETS = (BRANCH_COLOURS[4], BRANCH_COLOURS[0])
"""Colours of the two branches: elbow angle positive, elbow angle negative."""

RIM, FOLDED = "#b5122b", "#2b3340"
"""Colours of the stretched and of the folded arm."""

TURNS, BENDS = 96, 36
"""Facets along phi and along the elbow's half turn."""

HIGH = 1.05
"""Height of the axis of phi, from -pi to pi, against the reach."""

EYE = View(-62.0, 22.0)
LIGHT = np.array([-0.36, -0.48, 0.80])
"""Unit vector to the light."""


def planar_picture(robot: Robot, arm: PlanarArm, *, within_limits: bool = True) -> Picture:
    """Both pictures side by side, with a sentence on what they show."""
    with mpl.rc_context(RC):
        figure = Picture(figsize=(11.0, 5.4))
        left = figure.add_axes((0.0, 0.06, 0.52, 0.88))
        right = figure.add_axes((0.580, 0.18, 0.330, 0.672))
        bar = figure.add_axes((0.922, 0.18, 0.015, 0.672))
        _Surface(left, arm, within_limits).draw()
        _annulus(right, bar, arm, within_limits)
        text = caption(robot, "Plane of motion", within_limits=within_limits)
        figure.text(0.035, 0.03, plain(text), color=MUTED, size=9)
        return figure


class _Surface:
    """Poses (x, y, phi): two sheets that meet where the arm is stretched and where it is folded."""

    def __init__(self, axes: Any, arm: PlanarArm, within_limits: bool) -> None:
        self.axes, self.arm, self.within = axes, arm, within_limits
        self.reach = arm.l1 + arm.l2
        self.high = HIGH * self.reach

    def draw(self) -> None:
        axes = self.axes
        axes.set_aspect("equal")
        axes.set_axis_off()
        self._box()
        self._sheets()
        axes.set_title(
            r"Reachable poses $(x, y, \varphi)$ form a surface", weight="bold", size=11, y=0.97
        )
        axes.autoscale_view()

    def _grid(self, phi: Array, bend: Array) -> tuple[Array, Flags]:
        """Points (..., 3), phi stretched to the box, and whether the joints keep their limits."""
        first, between, turn = self.arm.offset
        t1 = phi - turn - bend + first + between
        x, y = self.arm.forward(t1, bend)
        inside = self.arm.inside(t1, bend) | (not self.within)
        return np.stack(np.broadcast_arrays(x, y, phi * self.high / math.pi), axis=-1), inside

    def _sheets(self) -> None:
        """All facets of both sheets, and the two seams, painted from far to near."""
        phi = np.linspace(-math.pi, math.pi, TURNS + 1)[:, None]
        facets: list[Shape] = []
        for sign, colour in zip((1.0, -1.0), SHEETS, strict=True):
            half_turn = sign * np.linspace(0.0, math.pi, BENDS + 1)[None, :]
            points, inside = self._grid(*np.broadcast_arrays(phi, half_turn))
            facets += self._facets(points, inside, colour)
        strokes: list[Shape] = []
        fine = np.linspace(-math.pi, math.pi, 2 * TURNS + 1)
        for bend, colour in ((0.0, RIM), (math.pi, FOLDED)):
            points, inside = self._grid(fine, np.full_like(fine, bend))
            for k in range(len(fine) - 1):
                if inside[k] and inside[k + 1]:
                    pair = points[k : k + 2]
                    near = float(EYE.depth(pair.mean(axis=0))) + 0.045 * self.reach
                    strokes.append((near, EYE.flat(pair), colour))
        facets.sort(key=lambda f: f[0])
        strokes.sort(key=lambda s: s[0])
        self._paint(facets, strokes)

    def _paint(self, facets: list[Shape], strokes: list[Shape]) -> None:
        """Runs of facets and strokes, interleaved by depth."""
        from matplotlib.collections import LineCollection, PolyCollection

        after = -math.inf
        bounds = [*np.linspace(facets[0][0], facets[-1][0], 60), math.inf]
        for level, bound in enumerate(bounds, 10):
            run, seam = ([s for s in all_ if after < s[0] <= bound] for all_ in (facets, strokes))
            after = bound
            if run:
                _, outlines, tones = zip(*run, strict=True)
                edges = [mix(tone, 0.72) for tone in tones]
                faces = PolyCollection(
                    outlines, facecolors=tones, edgecolors=edges, linewidths=0.35, zorder=level
                )
                self.axes.add_collection(faces)
            if seam:
                _, pairs, tones = zip(*seam, strict=True)
                lines = LineCollection(
                    pairs, colors=tones, linewidths=2.2, capstyle="round", zorder=level + 0.5
                )
                self.axes.add_collection(lines)

    def _facets(self, points: Array, inside: Flags, colour: str) -> list[Shape]:
        """Quadrilaterals of a grid of points: depth, outline, shaded colour."""
        a, b, c, d = points[:-1, :-1], points[1:, :-1], points[1:, 1:], points[:-1, 1:]
        normal = np.cross(c - a, d - b)
        size = np.linalg.norm(normal, axis=-1)
        lit = np.abs((normal @ LIGHT) / np.maximum(size, 1e-12)).clip(0.0, 1.0)
        kept = inside[:-1, :-1] & inside[1:, :-1] & inside[1:, 1:] & inside[:-1, 1:]
        quads = np.stack([a, b, c, d], axis=2)
        out = []
        for i, j in np.argwhere(kept):
            quad = quads[i, j]
            tone = mix(colour, 0.45 + 0.55 * float(lit[i, j]), "#10161f")
            out.append((float(EYE.depth(quad.mean(axis=0))), EYE.flat(quad), tone))
        return out

    def _box(self) -> None:
        """The box of the axes: the two walls and the floor behind, ticks on its edges."""
        r = 1.04 * self.reach
        step = nice_step(r)
        ticks = np.arange(-math.floor(r / step), math.floor(r / step) + 1) * step
        for t in ticks:
            self._line([(t, -r, -1.0), (t, r, -1.0), (t, r, 1.0)], FAINT, 0.4)
            self._line([(-r, t, -1.0), (r, t, -1.0)], FAINT, 0.4)
            self._line([(-r, t, -1.0), (-r, t, 1.0)], FAINT, 0.4)
            for corner, way in (((t, -r, -1.0), (0.0, -1.0)), ((r, t, -1.0), (1.0, -0.35))):
                self._tick(corner, way, f"{t:g}".replace("-", "−"))
        for level, name in ((-1.0, r"$-\pi$"), (0.0, "0"), (1.0, r"$\pi$")):
            self._line([(-r, -r, level), (-r, r, level), (r, r, level)], FAINT, 0.4)
            self._tick((r, r, level), (1.0, 0.0), name)
        edges = [(-r, -r, -1.0), (r, -r, -1.0), (r, r, -1.0), (r, r, 1.0)]
        self._line(edges, INK, 1.0)
        for corner, way, name in (
            ((0.0, -r, -1.0), (-0.2, -2.3), r"$x$ / m"),
            ((r, 0.0, -1.0), (2.0, -1.9), r"$y$ / m"),
            ((r, r, 0.5), (2.0, 0.0), r"$\varphi$"),
        ):
            place = self._spot(corner) + 0.12 * self.reach * np.array(way)
            self.axes.text(*place, name, ha="center", va="center", size=11)

    def _spot(self, corner: tuple[float, float, float]) -> Array:
        x, y, level = corner
        return EYE.flat(np.array([x, y, level * self.high]))

    def _line(self, corners: list[tuple[float, float, float]], colour: str, width: float) -> None:
        points = np.array([self._spot(c) for c in corners])
        self.axes.plot(*points.T, color=colour, lw=width, zorder=1, solid_capstyle="round")

    def _tick(
        self, corner: tuple[float, float, float], way: tuple[float, float], text: str
    ) -> None:
        spot, unit = self._spot(corner), 0.05 * self.reach
        end = spot + 0.8 * unit * np.array(way)
        self.axes.plot(*np.stack([spot, end]).T, color=INK, lw=0.9, zorder=2)
        place = spot + 2.3 * unit * np.array(way)
        self.axes.text(*place, text, ha="center", va="center", size=9)


def _annulus(axes: Any, bar: Any, arm: PlanarArm, within_limits: bool) -> None:
    """Places reached, coloured by the distance from singularity, and both ways to one of them."""
    from matplotlib.patches import Circle

    reach, hole = arm.l1 + arm.l2, abs(arm.l1 - arm.l2)
    line = np.linspace(-1.02 * reach, 1.02 * reach, 601)
    x, y = np.meshgrid(line, line)
    bend = arm.elbow(x, y)
    reached = np.isfinite(bend)
    if within_limits:
        flat = np.nan_to_num(bend)
        kept = [arm.inside(arm.shoulder(x, y, s * flat), s * flat) for s in (1.0, -1.0)]
        reached &= kept[0] | kept[1]
    shown = np.where(reached, np.abs(np.sin(bend)), np.nan)
    place = {"extent": (line[0], line[-1], line[0], line[-1]), "origin": "lower"}
    colours = {"cmap": "cividis", "vmin": 0, "vmax": 1, "interpolation": "bilinear"}
    image = axes.imshow(shown, **place, **colours)
    for radius, colour in ((reach, RIM), (hole, FOLDED)):
        if radius > 1e-9:
            axes.add_patch(Circle((0, 0), radius, fill=False, edgecolor=colour, lw=2.0))
    _two_ways(axes, arm, within_limits)
    axes.text(0.78 * reach, 0.86 * reach, r"$\theta_2 = 0$", color=RIM, size=12, ha="left")
    axes.annotate(
        r"$\theta_2 = \pi$",
        (-0.7 * hole, -0.7 * hole),
        (-0.62 * reach, -1.13 * reach),
        color=FOLDED,
        size=12,
        annotation_clip=False,
        arrowprops={"arrowstyle": "-", "color": FOLDED, "lw": 0.8, "shrinkB": 0},
    )
    margin = 1.2 * reach
    axes.set(xlim=(-margin, margin), ylim=(-margin, margin), xlabel=r"$x$ / m", ylabel=r"$y$ / m")
    axes.set_title("The annulus: two branches at one target", weight="bold", size=11, loc="left")
    label = r"$|\sin\theta_2| = |\det J|\,/\,(\ell_1 \ell_2)$"
    axes.figure.colorbar(image, cax=bar, ticks=[0, 0.5, 1], label=label)
    bar.spines["outline"].set_visible(False)


def _two_ways(axes: Any, arm: PlanarArm, within_limits: bool) -> None:
    """Both configurations at a place inside, those within limits solid."""
    radius, angle = abs(arm.l1 - arm.l2) + 0.62 * (2 * min(arm.l1, arm.l2)), math.radians(40.0)
    x, y = np.array(radius * math.cos(angle)), np.array(radius * math.sin(angle))
    bend = arm.elbow(x, y)
    for sign, colour in zip((1.0, -1.0), SHEETS, strict=True):
        t1 = arm.shoulder(x, y, sign * bend)
        inside = not within_limits or bool(arm.inside(t1, sign * bend))
        elbow = arm.l1 * np.array([np.cos(t1), np.sin(t1)])
        bones = np.stack([np.zeros(2), elbow, [float(x), float(y)]])
        style = "-" if inside else ":"
        axes.plot(*bones.T, color="white", lw=8, solid_capstyle="round", solid_joinstyle="round")
        axes.plot(*bones.T, color=colour, lw=5, ls=style, solid_joinstyle="round")
        axes.plot(*bones[:2].T, "o", ms=8, mfc="white", mec=colour, mew=2, ls="none")
    axes.plot(float(x), float(y), "x", ms=11, mew=3.2, color="#d62728", zorder=9)


def nice_step(reach: float) -> float:
    """A round distance between ticks: about two on each side of zero."""
    raw = reach / 1.5
    power = 10.0 ** math.floor(math.log10(raw))
    return next(m * power for m in (5.0, 2.0, 1.0) if m * power <= raw)
