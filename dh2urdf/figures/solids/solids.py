"""Solids in orthographic projection: outlines and tones.

A cylinder, a sphere or a box is convex, so what it shows is one polygon.
"""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dh2urdf.conversions.write import Body
from dh2urdf.figures.projection import View
from dh2urdf.transforms import Array, moved

AROUND = 48
"""Corners of a circle."""

ANGLES = np.linspace(0.0, 2 * np.pi, AROUND, endpoint=False)
RIM = np.stack([np.cos(ANGLES), np.sin(ANGLES)], axis=1)
"""The unit circle."""

STRIP = (0.25, 0.75)
"""Angles [rad], from what faces the eye towards the light, between which a cylinder shines."""

SHEEN = 0.45
"""Brightness of that strip; it has no outline."""

ROUNDED = ("link", "bar")
"""Materials of rods that run into the balls at their ends."""

NORMALS = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], float)


@dataclass(frozen=True, eq=False)
class Face:
    """A filled polygon (m, 2) [m] and its brightness: 0 the side away from the light, 1 the cap."""

    polygon: Array
    tone: float


@dataclass(frozen=True, eq=False)
class Part:
    """Solids (Body, T_base_body) of one material that are painted as one, with one outline."""

    material: str
    solids: list[tuple[Body, Array]]

    def faces(self, view: View) -> list[list[Face]]:
        """Of each solid: its silhouette first, then what is drawn on it."""
        order = sorted(self.solids, key=lambda s: float(view.depth(s[1][:3, 3])))
        return [_faces(body, T, view) for body, T in order]


def outlines(parts: Iterable[Part], view: View) -> list[Array]:
    """The silhouette (m, 2) [m] of every solid."""
    return [faces[0].polygon for part in parts for faces in part.faces(view)]


def arm_parts(bodies: list[list[Body]], link_poses: Array) -> list[Part]:
    """Parts of an arm: the rods and balls of a link or bar together, all else on its own."""
    parts = []
    for link, T_base_link in zip(bodies, link_poses, strict=True):
        placed = [(body, T_base_link @ body.pose) for body in link]
        parts += [Part(b.material, [(b, T)]) for b, T in placed if b.material not in ROUNDED]
        for material in ROUNDED:
            if rods := [(body, T) for body, T in placed if body.material == material]:
                parts.append(Part(material, rods))
    return parts


def _faces(body: Body, T: Array, view: View) -> list[Face]:
    if body.shape == "sphere":
        return [Face(view.flat(T[:3, 3]) + body.size[0] * RIM, 0.0)]
    outline = convex_hull(view.flat(hull_points(body, T)))
    if body.shape == "box":
        return [Face(outline, 0.0), *_box_faces(body, T, view)]
    side = 1.0 if float(view.axes[2] @ T[:3, 2]) >= 0 else -1.0
    cap = view.flat(_circle(body, T, side))
    return [Face(outline, 0.0), *_sheen(body, T, view), Face(cap, 1.0)]


def _sheen(body: Body, T: Array, view: View) -> list[Face]:
    """A lighter strip along a cylinder's surface, left of what faces the eye."""
    toward, left = T[:3, :3].T @ view.axes[2], T[:3, :3].T @ -view.axes[0]
    if float(np.hypot(toward[0], toward[1])) < 0.05:
        return []
    facing, lit = np.arctan2(toward[1], toward[0]), np.arctan2(left[1], left[0])
    side = 1.0 if np.sin(lit - facing) >= 0 else -1.0
    angle = facing + side * np.linspace(*STRIP, 7)
    radius, length = body.size
    rim = np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1)
    ends = [np.c_[rim, np.full(len(rim), z)] for z in (-length / 2, length / 2)]
    strip = np.concatenate([ends[0], ends[1][::-1]])
    return [Face(view.flat(moved(T, strip)), SHEEN)]


def _box_faces(body: Body, T: Array, view: View) -> list[Face]:
    half = np.array(body.size) / 2
    out = []
    for k, normal in enumerate(NORMALS):
        world = T[:3, :3] @ normal
        if float(world @ view.axes[2]) <= 1e-6:
            continue
        axis, others = k // 2, [i for i in range(3) if i != k // 2]
        corners = np.zeros((4, 3))
        corners[:, axis] = normal[axis] * half[axis]
        corners[:, others] = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * half[others]
        lit = 0.15 + 0.85 * max(float(world[2]), 0.0) + 0.2 * max(float(-world @ view.axes[0]), 0.0)
        out.append(Face(view.flat(moved(T, corners)), min(lit, 1.0)))
    return out


def _circle(body: Body, T: Array, side: float) -> Array:
    """Rim of a cylinder's cap in base, shape (AROUND, 3)."""
    radius, length = body.size
    return moved(T, np.c_[radius * RIM, np.full(AROUND, side * length / 2)])


def hull_points(body: Body, T: Array) -> Array:
    """Points in base that span the solid's silhouette (a sphere's only roughly), shape (m, 3)."""
    if body.shape == "cylinder":
        return np.concatenate([_circle(body, T, -1.0), _circle(body, T, 1.0)])
    if body.shape == "box":
        corners = np.array(np.meshgrid(*[(-s / 2, s / 2) for s in body.size])).reshape(3, -1).T
        return moved(T, corners)
    return np.asarray(T[:3, 3] + body.size[0] * NORMALS)


def convex_hull(points: Array) -> Array:
    """Corners of the convex hull of points (m, 2), counter-clockwise (Andrew's chain)."""
    order: NDArray[np.intp] = np.lexsort((points[:, 1], points[:, 0]))
    ordered = points[order]

    def half(run: Array) -> list[Array]:
        kept: list[Array] = []
        for p in run:
            while len(kept) > 1:
                u, v = kept[-1] - kept[-2], p - kept[-2]
                if u[0] * v[1] - u[1] * v[0] > 0:
                    break
                kept.pop()
            kept.append(p)
        return kept[:-1]

    return np.array(half(ordered) + half(ordered[::-1]))
