"""Where three joints put the wrist centre: the arm's own way, by what its first axes do."""

from collections.abc import Iterator

import numpy as np

from dh2urdf.lessons.position_any import place_point
from dh2urdf.lessons.position_arm import articulated
from dh2urdf.lessons.way import Asked, Way
from dh2urdf.transforms import Array


def place_wrist(asked: Asked, way: Way, centre: Array) -> Iterator[Way]:
    """All ways to put the wrist centre (frame 0) where it has to be."""
    rows = asked.arm.rows
    if rows[1].sa == 0.0 and not any(row.slides for row in rows[:3]):
        return articulated(asked, way, centre)
    tip = np.array([0.0, 0.0, rows[3].d])
    return place_point(asked, way, centre, tip, "the wrist centre")
