"""Where three joints put the wrist centre: the arm's own way, by what its first axes do."""

from collections.abc import Iterator

from dh2urdf.lessons.arm import Arm
from dh2urdf.lessons.position_arm import articulated
from dh2urdf.lessons.way import Asked, Way
from dh2urdf.transforms import Array


def covers(arm: Arm) -> bool:
    """Whether there is a way for the first three joints."""
    return not any(row.slides for row in arm.rows[:3]) and arm.rows[1].sa == 0.0


def place_wrist(asked: Asked, way: Way, centre: Array) -> Iterator[Way]:
    """All ways to put the wrist centre (frame 0) where it has to be."""
    rows = asked.arm.rows
    kinds = "".join("P" if row.slides else "R" for row in rows[:3])
    if kinds == "RRR" and rows[1].sa == 0.0:
        return articulated(asked, way, centre)
    raise NotImplementedError(kinds)
