"""Poses probably in degrees or millimetres by mistake; told, never changed."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from contextlib import suppress
from typing import TYPE_CHECKING

import numpy as np

from dh2urdf.cli.progress import note
from dh2urdf.dh_io.near_misses import FULL_TURN
from dh2urdf.transforms import Array

if TYPE_CHECKING:
    from dh2urdf.robot import Robot

FAR = 20.0
"""Distance of a pose from the base, in sizes of the arm."""


def bare_angle(cells: Iterable[str]) -> float:
    """The largest of the cells that are plain numbers, 0 where none is."""
    largest = 0.0
    for cell in cells:
        with suppress(ValueError):
            largest = max(largest, abs(float(cell)))
    return largest


def tell_doubts(arm: Robot, T: Array, angles: Array, name: Callable[[int], str]) -> None:
    """Name the first of poses (m, 4, 4) with an angle over a turn, and the first far away.

    ``angles`` (m,) has the largest angle of each that was written as a bare number of radians.
    """
    over = np.flatnonzero(angles > FULL_TURN)[:1]
    for i in over.tolist():
        note(
            f"warning: {name(i)}: {angles[i]:.10g} rad is more than a full turn; degrees meant? "
            "--deg reads them"
        )
    chain = arm.chain
    endless = not np.isfinite([chain.lower, chain.upper])[:, chain.prismatic].all()
    reach = np.inf if endless else chain.size + np.linalg.norm(chain.links[0, :3, 3])
    away = np.linalg.norm(T[:, :3, 3], axis=1)
    for i in np.flatnonzero(away > FAR * reach)[:1].tolist():
        note(
            f"warning: {name(i)}: {away[i]:.4g} m from the base of an arm {reach:.2g} m long; "
            "millimetres meant?"
        )
