"""Axis 1, then three parallel axes 2, 3, 4: UR and its kin, and arms of four and five joints.

What lies along the common direction k of the three, and what leans against it, the three leave as
it is: from that the outer joints follow, and the three are a planar arm (lecture notes 8.2).
"""

import math
from collections.abc import Iterator

import numpy as np

from dh2urdf.lessons.arm import Row
from dh2urdf.lessons.notation import Given
from dh2urdf.lessons.parallel_behind import first_and_fifth
from dh2urdf.lessons.parallel_fewer import fewer_joints
from dh2urdf.lessons.parallel_outer import last_turn, outer_joints
from dh2urdf.lessons.parallel_plane import PLANE, before_last, bend_in_plane, beside, common_axis
from dh2urdf.lessons.position_arm import shoulders
from dh2urdf.lessons.steps import Equation, Step
from dh2urdf.lessons.way import RIM, Asked, Way, joint_step
from dh2urdf.transforms import Array

FREE = 5e-10
"""Sine up to which an axis is in line with another."""


def fits(rows: tuple[Row, ...]) -> bool:
    """Whether rows are an axis, three parallel ones not in line with it, and up to two more."""
    if not 4 <= len(rows) <= 6 or any(row.slides for row in rows) or rows[0].sa == 0.0:
        return False
    after = len(rows) == 4 or rows[3].sa != 0.0
    last = len(rows) < 6 or rows[4].a != 0.0 or rows[4].sa != 0.0
    return rows[1].sa == rows[2].sa == 0.0 and after and last


def three_parallel(asked: Asked) -> Iterator[Way]:
    """All ways of an arm with a turning axis before three parallel ones and up to two after."""
    n = asked.arm.n
    words = (
        f"{PLANE}So what the pose has across the plane is due to joint 1"
        f"{' and the joints after 4' if n > 4 else ''} alone: these come first. In the plane three "
        "joints are left for x, y and a direction: a planar arm of three links."
    )
    way = Way().then(Step("What decouples", words))
    if n == 6:
        point, step = before_last(asked)
        ways = _meeting if asked.arm.rows[4].a == 0.0 else _apart
        yield from ways(asked, way.then(step), point)
    else:
        yield from fewer_joints(asked, way)


def _meeting(asked: Asked, way: Way, point: Array) -> Iterator[Way]:
    """Joints 1, 5, 6, then the plane, where axes 5 and 6 meet."""
    for turned, _ in shoulders(asked, way, point, beside(asked), PLANE):
        if turned.stopped:
            yield turned
            continue
        for bent in _fifth(asked, turned, common_axis(asked, turned.variables[0])):
            yield from _after_fifth(asked, bent)


def _apart(asked: Asked, way: Way, point: Array) -> Iterator[Way]:
    """The same where they do not: joints 1 and 5 together."""
    outer, step = first_and_fifth(asked, point)
    for turned in outer_joints(asked, way.then(step), outer):
        yield from _after_fifth(asked, turned)


def _after_fifth(asked: Asked, way: Way) -> Iterator[Way]:
    """Joint 6, and the plane."""
    if way.stopped:
        yield way
    else:
        row, k = asked.arm.rows[3], common_axis(asked, way.variables[0])
        yield from bend_in_plane(asked, last_turn(asked, way, k, np.array([0.0, row.sa, row.ca])))


def _fifth(asked: Asked, way: Way, k: Array) -> Iterator[Way]:
    """theta_5 from how axis 6 leans against the common direction."""
    four, five = asked.arm.rows[3:5]
    z6 = asked.H[:3, 2]
    slope = float(k @ z6)
    cosine = (four.ca * five.ca - slope) / (four.sa * five.sa)
    given: Given = {"k": k, "z_5": z6, "alpha_4": four.alpha, "alpha_5": five.alpha}
    given = {**given, "w": slope}
    equations = [
        Equation("k", "z_1", {}, k),
        Equation("w", "k^T z_5", given, slope),
        Equation(
            "c_5",
            "(cos(alpha_4) cos(alpha_5) - w) / (sin(alpha_4) sin(alpha_5))"
            if four.ca or five.ca
            else "-w / (sin(alpha_4) sin(alpha_5))",
            given,
            cosine,
        ),
    ]
    words = (
        "k is the common direction of axes 2, 3, 4; joints 2, 3 and 4 turn about it and leave the "
        "angle between it and axis 6 (z_5 = R e_3) to joint 5: k^T z_5 = cos(alpha_4) cos(alpha_5) "
        "- sin(alpha_4) sin(alpha_5) cos(theta_5)."
    )
    if abs(cosine) > 1.0 + RIM:
        end = " It is not between -1 and 1: axis 6 cannot lean so. Here the solution ends."
        yield way.stop(Step("theta_5", words + end, tuple(equations)))
        return
    bent = math.acos(min(max(cosine, -1.0), 1.0))
    if not (four.ca or five.ca):
        bent = math.atan2(float(np.linalg.norm(np.cross(k, z6))), cosine)
    both = (bent, -bent) if math.sin(bent) > FREE else (bent,)
    for value in both:
        others = tuple(v for v in both if v != value)
        found = Equation("theta_5", "+- acos(c_5)", {"c_5": cosine}, value, "rad", others)
        said = words + (" It bends either way: two wrists." if others else "")
        title = "theta_5: the wrist"
        step = joint_step(asked.arm, 4, title, said, [*equations, found], value, (), "wrist")
        yield way.then(step).put(4, value)
