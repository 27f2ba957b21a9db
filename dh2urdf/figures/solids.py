"""Solids in orthographic projection: outlines, tones, and which hides which.

A cylinder, a sphere or a box is convex, so what it shows is one polygon, and the depth of its
front at a point of the picture has a closed form: the ray is put into the solid's own frame.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from dh2urdf.conversions.bodies import Body
from dh2urdf.figures.projection import View
from dh2urdf.transforms import Array

__all__ = ["SHEEN", "Face", "Part", "arm_parts", "painted_order"]

AROUND = 48
"""Corners of a circle."""

RASTER = 110
"""Rays along the longer side of the picture that decide which part hides which."""

STRIP = (0.25, 0.75)
"""Angles [rad], from what faces the eye towards the light, between which a cylinder shines."""

SHEEN = 0.45
"""Brightness of that strip; it has no outline."""

NORMALS = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], float)


@dataclass(frozen=True, eq=False)
class Face:
    """A filled polygon (m, 2) [m] and its brightness: 0 the side away from the light, 1 the cap."""

    polygon: Array
    tone: float


@dataclass(frozen=True, eq=False)
class Part:
    """Solids of one material that are painted as one, with one outline.

    Parameters
    ----------
    material : str
    solids : list of (Body, T_base_body)
    """

    material: str
    solids: list[tuple[Body, Array]]

    def faces(self, view: View) -> list[list[Face]]:
        """Of each solid: its silhouette first, then what is drawn on it."""
        order = sorted(self.solids, key=lambda s: float(view.depth(s[1][:3, 3])))
        return [_faces(body, T, view) for body, T in order]


def arm_parts(bodies: list[list[Body]], link_poses: Array) -> list[Part]:
    """Parts of an arm: the rods and balls of a link together, everything else on its own."""
    parts = []
    for link, T_base_link in zip(bodies, link_poses, strict=True):
        placed = [(body, T_base_link @ body.pose) for body in link]
        rods = [(body, T) for body, T in placed if body.material == "link"]
        parts += [Part(body.material, [(body, T)]) for body, T in placed if body.material != "link"]
        if rods:
            parts.append(Part("link", rods))
    return parts


def painted_order(parts: list[Part], view: View) -> list[int]:
    """Indices of the parts, far ones first, so that each covers what it hides.

    Where two parts overlap in the picture, the one in front at more of the rays is painted
    later; a knot of parts that hide one another in turn is cut at its weakest tie.
    """
    if not parts:
        return []
    fronts = _fronts(parts, view)
    behind = np.zeros((len(parts), len(parts)))
    for i, j in combinations(range(len(parts)), 2):
        both = np.isfinite(fronts[i]) & np.isfinite(fronts[j])
        lead = np.sign(fronts[i][both] - fronts[j][both]).sum()
        behind[i, j], behind[j, i] = max(-lead, 0.0), max(lead, 0.0)
    depth = [min(float(view.depth(T[:3, 3])) for _, T in part.solids) for part in parts]
    order: list[int] = []
    left = set(range(len(parts)))
    while left:
        index = sorted(left, key=lambda k: depth[k])
        best = min(index, key=lambda k: sum(float(behind[m, k]) for m in left if m != k))
        order.append(best)
        left.remove(best)
    return order


def _fronts(parts: list[Part], view: View) -> list[Array]:
    """Depth of each part's front along a raster of rays, -inf where they miss."""
    corners = np.concatenate([_hull_points(b, T) for part in parts for b, T in part.solids])
    flat = view.flat(corners)
    low, high = flat.min(axis=0), flat.max(axis=0)
    step = max(float((high - low).max()) / RASTER, 1e-9)
    x, y = (np.arange(low[k], high[k] + step, step) for k in (0, 1))
    rays = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    out = []
    for part in parts:
        fronts = [_front(body, T, view, rays) for body, T in part.solids]
        out.append(np.max(fronts, axis=0))
    return out


def _front(body: Body, T: Array, view: View, rays: Array) -> Array:
    """Depth at which each ray, coming from the eye, meets a solid; -inf where it misses."""
    R = T[:3, :3]
    toward = R.T @ view.axes[2]
    starts = (rays @ view.axes[:2] - T[:3, 3]) @ R
    with np.errstate(divide="ignore", invalid="ignore"):
        if body.shape == "sphere":
            near = _quadric(starts, toward, np.ones(3), body.size[0])[1]
        elif body.shape == "cylinder":
            radius, length = body.size
            low, high = _quadric(starts, toward, np.array([1.0, 1.0, 0.0]), radius)
            caps = _slab(starts[:, 2], float(toward[2]), length / 2)
            near = _overlap(low, high, *caps)
        else:
            slabs = [
                _slab(starts[:, k], float(toward[k]), size / 2) for k, size in enumerate(body.size)
            ]
            low = np.max([s[0] for s in slabs], axis=0)
            high = np.min([s[1] for s in slabs], axis=0)
            near = np.where(high >= low, high, -np.inf)
    return np.where(np.isnan(near), -np.inf, near)


def _quadric(starts: Array, toward: Array, mask: Array, radius: float) -> tuple[Array, Array]:
    """Interval of t with ``|mask * (start + t toward)| <= radius``; (inf, -inf) where none."""
    s, v = starts * mask, toward * mask
    a, b, c = float(v @ v), s @ v, (s * s).sum(axis=1) - radius * radius
    if a < 1e-15:
        inside = c <= 0
        return np.where(inside, -np.inf, np.inf), np.where(inside, np.inf, -np.inf)
    root = np.sqrt(b * b - a * c)
    low, high = (-b - root) / a, (-b + root) / a
    hit = np.isfinite(root)
    return np.where(hit, low, np.inf), np.where(hit, high, -np.inf)


def _slab(start: Array, toward: float, half: float) -> tuple[Array, Array]:
    """Interval of t with ``|start + t toward| <= half``."""
    if abs(toward) < 1e-15:
        inside = np.abs(start) <= half
        return np.where(inside, -np.inf, np.inf), np.where(inside, np.inf, -np.inf)
    ends = np.sort(np.stack([(-half - start) / toward, (half - start) / toward]), axis=0)
    return ends[0], ends[1]


def _overlap(low: Array, high: Array, low2: Array, high2: Array) -> Array:
    """Upper end of the common part of two intervals, -inf where there is none."""
    far, near = np.maximum(low, low2), np.minimum(high, high2)
    return np.where(near >= far, near, -np.inf)


def _faces(body: Body, T: Array, view: View) -> list[Face]:
    if body.shape == "sphere":
        angle = np.linspace(0.0, 2 * np.pi, AROUND, endpoint=False)
        rim = np.stack([np.cos(angle), np.sin(angle)], axis=1)
        return [Face(view.flat(T[:3, 3]) + body.size[0] * rim, 0.0)]
    outline = convex_hull(view.flat(_hull_points(body, T)))
    if body.shape == "box":
        return [Face(outline, 0.0), *_box_faces(body, T, view)]
    if body.shape == "cylinder":
        side = 1.0 if float(view.axes[2] @ T[:3, 2]) >= 0 else -1.0
        cap = view.flat(_circle(body, T, side))
        return [Face(outline, 0.0), *_sheen(body, T, view), Face(cap, 1.0)]
    raise AssertionError(body.shape)


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
    return [Face(view.flat(strip @ T[:3, :3].T + T[:3, 3]), SHEEN)]


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
        corners[:, others[0]] = np.array([-1, 1, 1, -1]) * half[others[0]]
        corners[:, others[1]] = np.array([-1, -1, 1, 1]) * half[others[1]]
        lit = 0.15 + 0.85 * max(float(world[2]), 0.0) + 0.2 * max(float(-world @ view.axes[0]), 0.0)
        out.append(Face(view.flat(corners @ T[:3, :3].T + T[:3, 3]), min(lit, 1.0)))
    return out


def _circle(body: Body, T: Array, side: float) -> Array:
    """Rim of a cylinder's cap in base, shape (AROUND, 3)."""
    radius, length = body.size
    angle = np.linspace(0.0, 2 * np.pi, AROUND, endpoint=False)
    rim = np.stack(
        [radius * np.cos(angle), radius * np.sin(angle), np.full(AROUND, side * length / 2)], axis=1
    )
    out: Array = rim @ T[:3, :3].T + T[:3, 3]
    return out


def _hull_points(body: Body, T: Array) -> Array:
    """Points in base that span the solid's silhouette (a sphere's only roughly), shape (m, 3)."""
    if body.shape == "cylinder":
        return np.concatenate([_circle(body, T, -1.0), _circle(body, T, 1.0)])
    if body.shape == "box":
        corners = np.array(np.meshgrid(*[(-s / 2, s / 2) for s in body.size])).reshape(3, -1).T
        placed: Array = corners @ T[:3, :3].T + T[:3, 3]
        return placed
    radius = body.size[0]
    poles = np.stack([T[:3, 3] + radius * axis for axis in NORMALS])
    return poles


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
