"""Which part of an arm hides which, decided along a raster of rays.

Parts are painted from far to near, so that each covers what it hides. Where two run through
each other no order is right: a part that was painted over although it is in front is painted
again, clipped to where it is in front. The depth of a solid along a ray has a closed form: the
ray is put into the solid's own frame.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dh2urdf.conversions.write import Body
from dh2urdf.figures.projection import View
from dh2urdf.figures.solids.solids import Part, hull_points
from dh2urdf.transforms import Array

RASTER = 200
"""Rays along the longer side of the picture."""

WRONG = 4
"""Rays from which a part that was painted over is painted again."""


class Occlusion(NamedTuple):
    """Indices of the parts, far ones first; parts to paint once more, and where."""

    order: list[int]
    again: list[tuple[int, list[Array]]]


def occlusion(parts: list[Part], view: View) -> Occlusion:
    """Decide how to paint parts so that what is in front is seen."""
    if not parts:
        return Occlusion([], [])
    x, y, fronts = _fronts(parts, view)
    order = _order(parts, view, fronts)
    again = []
    rays, nearest = fronts.reshape(len(parts), -1), np.argmax(fronts, axis=0)
    rest = np.where(nearest == np.arange(len(parts))[:, None, None], -np.inf, fronts)
    first, second = fronts.max(axis=0), rest.max(axis=0)
    for place, k in enumerate(order):
        seen = np.flatnonzero((nearest == k) & np.isfinite(fronts[k]))
        covered = np.isfinite(rays[:, seen][order[place + 1 :]]).any(axis=0)
        if int(covered.sum()) >= WRONG:
            others = np.where(nearest == k, second, first)
            again.append((k, _in_front(fronts[k], others, x, y)))
    return Occlusion(order, again)


def _order(parts: list[Part], view: View, fronts: Array) -> list[int]:
    """Far parts first; a knot of parts that hide one another is cut at its weakest tie."""
    behind = np.zeros((len(parts), len(parts)))
    for i, front in enumerate(fronts):
        hit = np.isfinite(front)
        others = fronts[:, hit]
        lead = np.where(np.isfinite(others), np.sign(front[hit] - others), 0.0).sum(axis=1)
        behind[i] = np.maximum(-lead, 0.0)
    depth = [min(float(view.depth(T[:3, 3])) for _, T in part.solids) for part in parts]
    order: list[int] = []
    left = np.argsort(depth, kind="stable")
    while len(left):
        best = int(np.argmin(behind[np.ix_(left, left)].sum(axis=0)))
        order.append(int(left[best]))
        left = np.delete(left, best)
    return order


def _in_front(front: Array, others: Array, x: Array, y: Array) -> list[Array]:
    """Where a part is in front of all others: rings (m, 2) [m], those of holes turned round.

    The border between two surfaces is the zero of their difference in depth, which is found
    between the rays; where one of them ends, its depth is carried on by one ray.
    """
    from contourpy import contour_generator

    step = float(x[1] - x[0])
    others = np.where(np.isfinite(others), others, _neighbours(others).max(axis=0))
    with np.errstate(invalid="ignore"):
        lead = np.clip((front - others) / step, -3.0, 3.0)
    for _ in range(2):
        known = _neighbours(np.where(np.isfinite(front) | ~np.isnan(lead), lead, np.nan))
        count = np.maximum(np.isfinite(known).sum(axis=0), 1)
        lead = np.where(np.isnan(lead), np.nansum(known, axis=0) / count, lead)
    contours: Any = contour_generator(x, y, lead, fill_type="OuterOffset")
    polygons, offsets = contours.filled(0.0, np.inf)
    pairs = zip(polygons, offsets, strict=True)
    return [ring for points, ends in pairs for ring in np.split(points, ends[1:-1])]


def _neighbours(values: Array) -> Array:
    """The eight neighbours of each cell, those outside the raster missing (-inf), (8, ...)."""
    ny, nx = values.shape
    wide = np.pad(values, 1, constant_values=-np.inf)
    shifts = [(r, c) for r in range(3) for c in range(3) if (r, c) != (1, 1)]
    return np.stack([wide[r : r + ny, c : c + nx] for r, c in shifts])


def _fronts(parts: list[Part], view: View) -> tuple[Array, Array, Array]:
    """Raster x and y, and each part's depth along it, -inf where it is missed, (parts, y, x)."""
    corners = np.concatenate([hull_points(b, T) for part in parts for b, T in part.solids])
    flat = view.flat(corners)
    low, high = flat.min(axis=0), flat.max(axis=0)
    step = max(float((high - low).max()) / RASTER, 1e-9)
    x, y = (np.arange(low[k] - 2 * step, high[k] + 3 * step, step) for k in (0, 1))
    rays = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    fronts = [
        np.max([front_depth(body, T, view, rays) for body, T in part.solids], axis=0)
        for part in parts
    ]
    return x, y, np.stack(fronts).reshape(len(parts), len(y), len(x))


def front_depth(body: Body, T: Array, view: View, rays: Array) -> Array:
    """Depth at which each ray, coming from the eye, meets a solid; -inf where it misses."""
    R = T[:3, :3]
    toward = R.T @ view.axes[2]
    starts = (rays @ view.axes[:2] - T[:3, 3]) @ R
    with np.errstate(divide="ignore", invalid="ignore"):
        slabs = dict(enumerate(body.size)) if body.shape == "box" else {}
        within = []
        if body.shape == "sphere":
            within.append(_quadric(starts, toward, np.ones(3), body.size[0]))
        elif body.shape == "cylinder":
            within.append(_quadric(starts, toward, np.array([1.0, 1.0, 0.0]), body.size[0]))
            slabs = {2: body.size[1]}
        within += [_slab(starts[:, k], float(toward[k]), size / 2) for k, size in slabs.items()]
        low, high = np.max([w[0] for w in within], axis=0), np.min([w[1] for w in within], axis=0)
    return np.where(high >= low, high, -np.inf)


def _quadric(starts: Array, toward: Array, mask: Array, radius: float) -> tuple[Array, Array]:
    """Interval of t with ``|mask * (start + t toward)| <= radius``; (inf, -inf) where none."""
    s, v = starts * mask, toward * mask
    a, b, c = float(v @ v), s @ v, (s * s).sum(axis=1) - radius * radius
    if a < 1e-15:
        return _where(c <= 0, -np.inf, np.inf)
    root = np.sqrt(b * b - a * c)
    return _where(np.isfinite(root), (-b - root) / a, (-b + root) / a)


def _slab(start: Array, toward: float, half: float) -> tuple[Array, Array]:
    """Interval of t with ``|start + t toward| <= half``."""
    if abs(toward) < 1e-15:
        return _where(np.abs(start) <= half, -np.inf, np.inf)
    low, high = np.sort(np.stack([(-half - start) / toward, (half - start) / toward]), axis=0)
    return low, high


def _where(hit: NDArray[np.bool_], low: Array | float, high: Array | float) -> tuple[Array, Array]:
    """An interval where a ray hits, the empty one (inf, -inf) elsewhere."""
    return np.where(hit, low, np.inf), np.where(hit, high, -np.inf)
