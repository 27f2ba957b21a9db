"""The task position of an arm of one joint: a circle about its axis, or a line along it."""

import math
from collections.abc import Iterator

import numpy as np

from dh2urdf.lessons.arm import Row
from dh2urdf.lessons.notation import Given, shown
from dh2urdf.lessons.steps import Equation, Step
from dh2urdf.lessons.way import Asked, Way, joint_step

OFF = 1e-9
"""Distance [m] by which a point may miss the circle or the line: what a residual may be."""


def is_one(rows: tuple[Row, ...]) -> bool:
    """Whether there is one joint."""
    return len(rows) == 1


def one_joint(asked: Asked) -> Iterator[Way]:
    """The one way: from where the joint is at 0 to the point asked for."""
    row, tip = asked.arm.rows[0], np.append(asked.arm.tool[:3, 3], 1.0)
    v, p = (row.motion(0.0) @ tip)[:3], asked.H[:3, 3]
    given: Given = {f"p_{i}": float(x) for i, x in zip("xyz", p, strict=True)}
    given = {**given, **{f"v_{i}": float(x) for i, x in zip("xyz", v, strict=True)}}
    known = Equation("p", "p", {}, p, "m"), Equation("v", "v", {}, v, "m")
    if row.slides:
        off = math.hypot(p[0] - v[0], p[1] - v[1])
        where = "moves on the line through v along axis 1"
    else:
        off = math.hypot(p[2] - v[2], math.hypot(p[0], p[1]) - math.hypot(v[0], v[1]))
        where = "moves on the circle through v about axis 1"
    words = f"With the joint's variable at 0 the point is at v. It {where}; p is asked for. "
    way = Way()
    if off > OFF:
        words += f"p is {shown(off)} m away from there: here the solution ends."
        yield way.stop(Step("Is the point one of this arm?", words, known))
        return
    way = way.then(Step("Is the point one of this arm?", f"{words}p is on it.", known))
    name, formula, value, unit = "d_1", "p_z - v_z", float(p[2] - v[2]), "m"
    if not row.slides:
        name, formula, unit = "theta_1", "atan2(p_y, p_x) - atan2(v_y, v_x)", "rad"
        value = math.atan2(p[1], p[0]) - math.atan2(v[1], v[0])
        value = math.remainder(value, math.tau)
    words = "The joint moves v to p."
    equation = Equation(name, formula, given, value, unit)
    step = joint_step(asked.arm, 0, name, words, [equation], value)
    yield way.then(step).put(0, value)
