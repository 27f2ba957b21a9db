"""Where labels go: a search over directions and distances around each anchor.

The cost of a place counts what the label would cover: other labels, lines (by the length
that runs under the label), the edge of the panel; the way from what it names; and how much
nearer it would stand to something else that has a name in the same colour.
"""

from dataclasses import dataclass

import numpy as np

from dh2urdf.transforms import Array

RADII = (6.5, 9.0, 13.0, 18.0, 25.0, 33.0)
"""Distances [pt] from the anchor to the near edge of the label."""

DIRECTIONS = 24
SWEEPS = 4
PADDING = 2.0
CONFUSED = 0.8
"""Cost of a point [pt] by which another thing of the same colour is too near."""

APART = 6.0
"""By how much [pt] a label should be nearer to what it names than to such a thing."""

SPACING = 1.5
"""Step [pt] at which lines are sampled."""


@dataclass(frozen=True, eq=False)
class Label:
    """A text that wants a place: its size (2,), the points (k, 2) [pt] that it may stand beside.

    The first is the best; there it would rather stand ``toward`` (2,), zero for anywhere, or also
    opposite with ``both_ways``. ``colour`` is all that tells what a name may belong to.
    """

    text: str
    size: Array
    marks: Array
    toward: Array
    both_ways: bool = False
    colour: str = ""

    def gap(self, centres: Array, points: Array) -> Array:
        """Distance [pt] from the label's box at centres (m, 2) to the nearest point (k, 2)."""
        away = np.abs(points[None] - centres[:, None]) - self.size / 2
        return np.asarray(np.hypot(*np.moveaxis(np.maximum(away, 0.0), -1, 0)).min(axis=1))


@dataclass(frozen=True, eq=False)
class Line:
    """A drawn segment (2, 2) [pt] and how much it minds being covered."""

    points: Array
    weight: float = 1.0


def place_labels(labels: list[Label], lines: list[Line], bounds: Array) -> Array:
    """Centres (m, 2) of the labels between two corners (2, 2) of a panel [pt]."""
    if not labels:
        return np.zeros((0, 2))
    samples, weights = _samples(lines)
    places = [_candidates(label) for label in labels]
    pairs = zip(labels, places, strict=True)
    fixed = [
        _fixed_cost(label, spots, samples, weights, bounds) + _confusion(label, spots, labels)
        for label, spots in pairs
    ]
    centres = np.stack([spots[np.argmin(c)] for spots, c in zip(places, fixed, strict=True)])
    half = np.stack([label.size for label in labels]) / 2 + PADDING
    for _ in range(SWEEPS):
        before = centres.copy()
        for k, spots in enumerate(places):
            others, halves = np.delete(centres, k, axis=0), np.delete(half, k, axis=0)
            cost = fixed[k] + _crowding(spots, half[k], others, halves)
            centres[k] = spots[np.argmin(cost)]
        if (centres == before).all():
            break
    return centres


def _candidates(label: Label) -> Array:
    """Centres to try, shape (len(marks) * len(RADII) * DIRECTIONS, 2)."""
    angle = np.arange(DIRECTIONS) * (2 * np.pi / DIRECTIONS)
    if float(np.abs(label.toward).max()) > 0:
        angle = angle + np.arctan2(label.toward[1], label.toward[0])
    way = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    reach = np.abs(way) @ (label.size / 2)
    rings = [way * (reach + radius)[:, None] for radius in RADII]
    return np.concatenate([mark + ring for mark in label.marks for ring in rings])


def _confusion(label: Label, spots: Array, labels: list[Label]) -> Array:
    """Cost of standing about as near to what another label of the same colour names."""
    others = [o.marks for o in labels if o is not label and o.colour == label.colour]
    if not others:
        return np.zeros(len(spots))
    spare = label.gap(spots, np.concatenate(others)) - label.gap(spots, label.marks)
    return CONFUSED * np.maximum(APART - spare, 0.0)


def _fixed_cost(label: Label, spots: Array, samples: Array, weights: Array, bounds: Array) -> Array:
    half = label.size / 2 + PADDING
    first = np.searchsorted(samples[:, 0], spots[:, 0] - half[0])
    last = np.searchsorted(samples[:, 0], spots[:, 0] + half[0], side="right")
    under = zip(map(slice, first, last), spots[:, 1], strict=True)
    covered = np.array([weights[k] @ (np.abs(samples[k, 1] - y) <= half[1]) for k, y in under])
    outside = np.maximum(bounds[0] - (spots - half), 0) + np.maximum(spots + half - bounds[1], 0)
    distance = label.gap(spots, label.marks)
    cost: Array = 1.1 * covered + 60.0 * outside.sum(axis=1) + 0.45 * distance
    if float(np.abs(label.toward).max()) > 0:
        unit, way = label.toward / np.linalg.norm(label.toward), spots - label.marks[0]
        cosine = (way @ unit) / np.linalg.norm(way, axis=1)
        cost = cost + 3.0 * (1.0 - (np.abs(cosine) if label.both_ways else cosine))
    return cost


def _crowding(spots: Array, half: Array, others: Array, halves: Array) -> Array:
    """Cost of overlapping other labels: by area, and a lot for touching at all."""
    room = half + halves
    overlap = np.maximum(room - np.abs(spots[:, None, :] - others[None, :, :]), 0.0)
    area = overlap.prod(axis=2)
    return np.asarray((30.0 * (area > 0) + 2.0 * area).sum(axis=1))


def _samples(lines: list[Line]) -> tuple[Array, Array]:
    """Points along all lines from left to right, and their weights."""
    points, weights = [np.zeros((0, 2))], [np.zeros(0)]
    for line in lines:
        start, end = line.points
        length = float(np.linalg.norm(end - start))
        count = max(2, int(length / SPACING) + 1)
        points.append(start + np.linspace(0, 1, count)[:, None] * (end - start))
        weights.append(np.full(count, line.weight * length / count))
    all_points = np.concatenate(points)
    order = np.argsort(all_points[:, 0])
    return all_points[order], np.concatenate(weights)[order]
