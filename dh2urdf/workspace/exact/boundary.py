"""Which pieces of curves have the reach on one side only, and the rings that these make."""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from dh2urdf.exceptions import VerificationError
from dh2urdf.transforms import Array
from dh2urdf.workspace.exact.zero_curves import Function, along, settled

BESIDE = 1e-7
"""How far to either side of a curve reach is asked for [sizes]."""

BEND, LONGEST = 1e-6, 0.01
"""Largest distance between chord and curve, and longest chord [sizes]."""

SAME = 4e-6
"""Pieces closer than this [sizes] are one: both elbows, or both shoulders, at the same place."""

ALONG = 0.999
"""Cosine of the angle between them up to which they are."""

BAND = 0.02
"""Height of the bands [sizes] in which that is looked for."""

GAP = 0.02
"""Largest gap between two pieces that follow one another [sizes]."""

HALVINGS = 45
"""Of the way between a place on the boundary and the next that is not."""

ON_AXIS = 1e-6
"""Radius [sizes] below which only axis 1 itself bounds the reach."""

Reached = Callable[[Array], NDArray[np.bool_]]
"""Whether places (k, 2) of radius and height are reached."""


@dataclass(frozen=True, eq=False)
class Curve:
    """A curve (m, 2) in some plane and what it looks like in the section.

    ``kind`` says what it is; ``image`` gives radius and height (m, 2); points between are moved
    to where ``value`` is zero, and are on chords without one.
    """

    kind: str
    points: Array
    image: Callable[[Array], Array]
    value: Function | None = None
    is_axis: bool = False

    def between(self, a: Array, b: Array, share: Array | float = 0.5) -> Array:
        """Points a share of the way from its points a to its points b, each (k, 2)."""
        return along(a, b, share) if self.value is None else settled(self.value, a, b, share)

    def middles(self, line: Array) -> Array:
        """Points between each two of its points (m, 2), shape (m - 1, 2)."""
        return self.between(line[:-1], line[1:])

    def refined(self, line: Array, size: float, bend: float = np.inf) -> Array:
        """Points of it (m, 2), more of them where its image is long, or off its chords."""
        for _ in range(14):
            ends, middle = self.image(line), self.middles(line)
            off = np.linalg.norm(self.image(middle) - (ends[1:] + ends[:-1]) / 2, axis=1)
            long = np.linalg.norm(ends[1:] - ends[:-1], axis=1)
            rows = np.flatnonzero((off > bend * size) | (long > LONGEST * size))
            if not len(rows):
                break
            line = np.insert(line, rows + 1, middle[rows], axis=0)
        return line


@dataclass(frozen=True, eq=False)
class Piece:
    """Part of a curve with the reach on its left: its points in the curve's plane, its image."""

    curve: Curve
    points: Array
    image: Array

    @property
    def length(self) -> float:
        """Of the image [m]."""
        return float(np.linalg.norm(np.diff(self.image, axis=0), axis=1).sum())


def pieces_of(curve: Curve, reached: Reached, size: float) -> list[Piece]:
    """The pieces of a curve that have the reach on one side only."""
    line = curve.refined(curve.points, size)
    if len(line) < 2:
        return []
    middle, ends = curve.middles(line), curve.image(line)
    state = _sides(curve, curve.image(middle), ends[1:] - ends[:-1], reached, size)
    change = np.flatnonzero(state[1:] != state[:-1])
    cuts = _cuts(curve, middle, state, change, reached, size)
    borders = [0, *(change + 1).tolist(), len(state)]
    out = []
    for k, (first, last) in enumerate(pairwise(borders)):
        if state[first] == 0:
            continue
        inner = line[first + (first > 0) : last + (last == len(state))]
        points = np.concatenate([cuts[k - 1 : k] if k else cuts[:0], inner, cuts[k : k + 1]])
        points = points if state[first] > 0 else points[::-1]
        points = curve.refined(points, size, BEND)
        piece = Piece(curve, points, curve.image(points))
        if piece.length > 30 * BESIDE * size:
            out.append(piece)
    return out


def _sides(
    curve: Curve, spots: Array, way: Array, reached: Reached, size: float
) -> NDArray[np.int64]:
    """1 where the reach is on the left of a way only, -1 on the right, 0 on both or none."""
    length = np.linalg.norm(way, axis=1, keepdims=True)
    left = np.stack([-way[:, 1], way[:, 0]], axis=1) / np.maximum(length, 1e-300)
    out = np.zeros(len(spots), np.int64)
    counts = (length[:, 0] > 1e-12 * size) & ((spots[:, 0] > ON_AXIS * size) | curve.is_axis)
    moves = np.flatnonzero(counts)
    for sign in (1, -1):
        out[moves] += sign * reached(spots[moves] + sign * BESIDE * size * left[moves])
    return out


def _cuts(
    curve: Curve,
    middle: Array,
    state: NDArray[np.int64],
    change: NDArray[np.intp],
    reached: Reached,
    size: float,
) -> Array:
    """Where, between the middles of two chords, what is beside the curve changes."""
    a, b = middle[change], middle[change + 1]
    low, high = np.zeros(len(change)), np.ones(len(change))
    way = curve.image(b) - curve.image(a)
    for _ in range(HALVINGS if len(change) else 0):
        half = (low + high) / 2
        spots = curve.image(curve.between(a, b, half))
        same = _sides(curve, spots, way, reached, size) == state[change]
        low, high = np.where(same, half, low), np.where(same, high, half)
    return curve.between(a, b, (low + high) / 2)


def without_doubles(pieces: list[Piece], size: float) -> list[Piece]:
    """Pieces of which no two run along the same line; the longest stay whole."""
    kept: list[Piece] = []
    for piece in sorted(pieces, key=lambda p: -p.length):
        line, chord = piece.image, np.diff(piece.image, axis=0)
        ways = np.concatenate([chord, chord[:1], chord])
        spots = np.concatenate([(line[1:] + line[:-1]) / 2, line])
        doubled = _runs_along(spots, ways, [other.image for other in kept], size)
        inner, ends = doubled[: len(chord)], doubled[len(chord) :]
        free = ~(inner | ends[1:] | ends[:-1])
        edges = np.flatnonzero(np.diff(np.r_[False, free, False].astype(int)))
        for first, last in edges.reshape(-1, 2):
            part = Piece(piece.curve, piece.points[first : last + 1], line[first : last + 1])
            if part.length > SAME * size:
                kept.append(part)
    return kept


def _runs_along(spots: Array, ways: Array, lines: list[Array], size: float) -> NDArray[np.bool_]:
    """Whether places (k, 2) are on one of the lines (m, 2) that goes their way there."""
    out = np.zeros(len(spots), np.bool_)
    if not lines:
        return out
    starts = np.concatenate([line[:-1] for line in lines])
    chords = np.concatenate([np.diff(line, axis=0) for line in lines])
    ends = starts[:, 1] + chords[:, 1]
    low = np.minimum(starts[:, 1], ends) - SAME * size
    high = np.maximum(starts[:, 1], ends) + SAME * size
    band = np.floor(spots[:, 1] / (BAND * size))
    for k in np.unique(band):
        here = np.flatnonzero(band == k)
        near = (low <= (k + 1) * BAND * size) & (high >= k * BAND * size)
        if near.any():
            out[here] = _on_chords(spots[here], ways[here], starts[near], chords[near], size)
    return out


def _on_chords(
    spots: Array, ways: Array, starts: Array, chords: Array, size: float
) -> NDArray[np.bool_]:
    """Whether places are on one of the chords that goes their way."""
    square = np.maximum((chords * chords).sum(axis=1), 1e-300)
    gap = spots[:, None] - starts
    share = np.clip((gap * chords).sum(axis=-1) / square, 0.0, 1.0)
    off = np.linalg.norm(gap - share[..., None] * chords, axis=-1)
    norm = np.linalg.norm(ways, axis=1)[:, None] * np.sqrt(square)
    same = ways @ chords.T > ALONG * norm
    return np.asarray((same & (off < SAME * size)).any(axis=1))


def rings_of(pieces: list[Piece], size: float) -> list[list[Piece]]:
    """Pieces one after the other, each beginning where the one before ends.

    Raises
    ------
    VerificationError
        They leave a gap.
    """
    if not pieces:
        return []
    ends = np.stack([p.image[-1] for p in pieces])
    starts = np.stack([p.image[0] for p in pieces])
    gaps = np.linalg.norm(ends[:, None] - starts, axis=-1)
    after: dict[int, int] = {}
    for flat in np.argsort(gaps, axis=None, kind="stable").tolist():
        end, start = divmod(flat, len(pieces))
        if end in after or start in after.values():
            continue
        if gaps[end, start] > GAP * size:
            raise VerificationError(
                f"the boundary of the reach has a gap of {gaps[end, start]:.3g} m"
            )
        after[end] = start
    rings, left = [], set(after)
    while left:
        here = min(left)
        ring = []
        while here in left:
            left.discard(here)
            ring.append(pieces[here])
            here = after[here]
        rings.append(ring)
    return rings
