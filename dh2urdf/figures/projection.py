"""Orthographic projection: two dot products give the picture, a third the depth."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from dh2urdf.chain import SerialChain
from dh2urdf.transforms import Array

ELEVATION = 22.0
"""Height of the eye above the horizon [deg] where nobody asks for another."""

AZIMUTHS = tuple(range(-165, 180, 15))
"""Directions [deg] among which the best is looked for."""

PREFERRED = -60.0
"""Azimuth [deg] that wins where several show as much."""


@dataclass(frozen=True)
class View:
    """Where the eye stands, infinitely far away.

    Parameters
    ----------
    azimuth, elevation : float
        Direction to the eye [deg]: azimuth from x towards y, elevation from the xy plane up.
    """

    azimuth: float
    elevation: float

    @cached_property
    def axes(self) -> Array:
        """Rows: right and up in the picture, and towards the eye, shape (3, 3)."""
        az, el = math.radians(self.azimuth), math.radians(self.elevation)
        ca, sa, ce, se = math.cos(az), math.sin(az), math.cos(el), math.sin(el)
        return np.array([[-sa, ca, 0.0], [-se * ca, -se * sa, ce], [ce * ca, ce * sa, se]])

    def flat(self, points: Array) -> Array:
        """Picture coordinates [m] of points (..., 3), shape (..., 2)."""
        return np.asarray(points @ self.axes[:2].T)

    def depth(self, points: Array) -> Array:
        """Nearness to the eye [m] of points (..., 3), shape (...)."""
        return np.asarray(points @ self.axes[2])


def best_view(frames: Array, chain: SerialChain) -> View:
    """A view of an arm's DH frames (n + 1, 4, 4): from above for a planar one, else the widest."""
    if is_planar(frames, chain):
        return View(-90.0, 90.0)
    points, axes = frames[:, :3, 3], frames[:, :3, [0, 2]].transpose(0, 2, 1).reshape(-1, 3)
    views = [View(float(az), ELEVATION) for az in AZIMUTHS]
    return max(views, key=lambda view: _worth(view, points, axes))


def is_planar(frames: Array, chain: SerialChain) -> bool:
    """Every joint turns about the vertical or slides across it, all frames at one height."""
    heights = frames[:, 2, 3]
    if float(np.ptp(heights)) > 1e-6 * chain.size:
        return False
    upright = np.abs(chain.axes[:, 2])
    turns = np.where(chain.prismatic, 1.0 - upright, upright)
    return bool((turns > 1.0 - 1e-9).all())


def _worth(view: View, points: Array, axes: Array) -> float:
    """How much a view shows: spread of the links, axes not seen end on, frames apart."""
    flat = view.flat(points)
    legs = np.linalg.norm(np.diff(flat, axis=0), axis=1)
    long = np.linalg.norm(np.diff(points, axis=0), axis=1)
    spread = float(legs.sum() / max(long.sum(), 1e-9))
    shown = np.linalg.norm(view.flat(axes), axis=1)
    seen = float(np.minimum(shown, 0.6).mean() / 0.6 + min(float(shown.min()), 0.35))
    turn = abs(math.remainder(view.azimuth - PREFERRED, 360.0)) / 180.0
    return spread + 0.8 * seen - 0.25 * turn
