"""Where any three joints, turning or sliding, put a point: by two views of it, see `seen`."""

import math
from collections.abc import Iterator

from dh2urdf.lessons.position_slides import turn_and_slide, two_slides
from dh2urdf.lessons.position_turns import two_turns
from dh2urdf.lessons.seen import ON_AXIS, Seen, along_arm, from_base, twice_seen
from dh2urdf.lessons.steps import Equation
from dh2urdf.lessons.way import Asked, Way, joint_step
from dh2urdf.transforms import Array


def place_point(asked: Asked, way: Way, point: Array, tip: Array, what: str) -> Iterator[Way]:
    """All ways of three joints to put ``tip``, fixed in frame 3, to a point of frame 0."""
    y, v = from_base(asked, point), along_arm(asked, tip)
    flat = asked.arm.rows[1].slides
    way = way.then(twice_seen(asked, y, v, what))
    if y.slides and v.slides:
        pairs = two_slides(asked, way, y, v)
    elif not y.slides and not v.slides:
        pairs = two_turns(asked, way, y, v)
    else:
        pairs = turn_and_slide(asked, way, y, v)
    for found in pairs:
        yield found if found.stopped else _second(asked, found, y, v, flat)


def _second(asked: Asked, way: Way, y: Seen, v: Seen, flat: bool) -> Way:
    """Joint 2: what is left."""
    if 1 in way.variables:
        return way
    at, along = y.at(way.variables[0]), v.at(way.variables[2])
    if flat:
        value = float(at[2] - along[2])
        given = {"y_z": float(at[2]), "v_z": float(along[2])}
        how = Equation("d_2", "y_z - v_z", given, value, "m")
        step = joint_step(asked.arm, 1, "d_2", "The difference of z is joint 2.", [how], value)
        return way.then(step).put(1, value)
    given = {"y_x": at[0], "y_y": at[1], "v_x": along[0], "v_y": along[1]}
    numbers = {key: float(t) for key, t in given.items()}
    value = math.atan2(at[1], at[0]) - math.atan2(along[1], along[0])
    words, formula = "Joint 2 turns v onto y.", "atan2(y_y, y_x) - atan2(v_y, v_x)"
    if math.hypot(along[0], along[1]) <= ON_AXIS:
        value, formula = asked.free_value(1), "theta_2"
        words = "The point is on axis 2: joint 2 moves it nowhere, and is free."
    value = math.remainder(value, math.tau)
    how = Equation("theta_2", formula, numbers, value, "rad")
    step = joint_step(asked.arm, 1, "theta_2", words, [how], value)
    return way.then(step).put(1, value)
