"""Arms of three joints: the place first, then the orientation is right or not; the RPR arm."""

import math
from collections.abc import Iterator

import numpy as np

from dh2urdf.lessons.arm import Row
from dh2urdf.lessons.notation import shown
from dh2urdf.lessons.position_any import place_point
from dh2urdf.lessons.steps import Equation, Step
from dh2urdf.lessons.way import MERGED, RIM, Asked, Way, joint_step
from dh2urdf.transforms import rotation_angle

OFF = 2e-9
"""What an orientation may miss [rad], or a height [m]: twice what a residual may be."""

REGULAR = 1e-6
"""Volume of three directions in which joints move a point, lengths in m, that counts as one."""


def is_polar(rows: tuple[Row, ...]) -> bool:
    """Whether rows are the RPR arm of lecture notes 7.1: a slide in the plane of two turns."""
    if [row.slides for row in rows] != [False, True, False]:
        return False
    square = rows[0].ca == 0.0 == rows[1].ca
    return square and rows[0].sa * rows[1].sa < 0.0 and not rows[1].theta and not rows[1].a


def polar(asked: Asked) -> Iterator[Way]:
    """All ways of the RPR arm."""
    arm, H = asked.arm, asked.H
    lean = math.hypot(H[0, 2], H[1, 2])
    words = (
        "Axes 1 and 3 are parallel and joint 2 slides at a right angle to them: look along the "
        "axes, and the arm is one in the plane, with three joints for x, y and the direction phi. "
        "It is an arm in polar coordinates with a hand: phi first."
    )
    way = Way().then(Step("The plane", words))
    high = arm.rows[0].d + arm.rows[2].d
    if lean > OFF or H[2, 2] < 0.0 or abs(H[2, 3] - high) > OFF:
        words = (
            f"No joint leaves the plane z = {shown(high)} m. The pose is at z = "
            f"{shown(float(H[2, 3]))} m, its z axis leans by "
            f"{shown(math.degrees(math.atan2(lean, H[2, 2])))} deg: here the solution ends."
        )
        yield way.stop(Step("Out of the plane", words))
        return
    yield from _in_the_plane(asked, way)


def _in_the_plane(asked: Asked, way: Way) -> Iterator[Way]:
    """The hand taken off, then the right triangle of a_1 and the slide."""
    arm, (x, y) = asked.arm, (float(v) for v in asked.H[:2, 3])
    a1, a3 = arm.rows[0].a, arm.rows[2].a
    r = {"r_21": float(asked.H[1, 0]), "r_11": float(asked.H[0, 0])}
    phi = math.atan2(r["r_21"], r["r_11"])
    xw, yw = x - a3 * math.cos(phi), y - a3 * math.sin(phi)
    given = {"x": x, "y": y, "a_3": a3, "phi": phi}
    hand = Step(
        "The direction",
        "phi = theta_1 + theta_3 is the direction of x_3. Go back a_3 along it: the first two "
        "joints have to reach (x_w, y_w).",
        (
            Equation("phi", "atan2(r_21, r_11)", r, phi, "rad"),
            Equation("x_w", "x - a_3 cos(phi)", given, xw, "m"),
            Equation("y_w", "y - a_3 sin(phi)", given, yw, "m"),
        ),
    )
    way = way.then(hand)
    room = xw * xw + yw * yw - a1 * a1
    distance = math.hypot(xw, yw)
    words = (
        f"From axis 1 go a_1 = {shown(a1)} m along x_1, then slide at a right angle to it: a right "
        f"triangle, whose long side is the way to (x_w, y_w), {shown(distance)} m. "
    )
    if room < -RIM * a1 * a1:
        words += (
            f"It is shorter than a_1, by {shown(abs(a1) - distance)} m: here the solution ends."
        )
        yield way.stop(Step("d_2: the slide", words))
        return
    root = math.sqrt(room) if room > MERGED * (xw * xw + yw * yw) else 0.0
    for slide in (root, -root) if root else (0.0,):
        yield _slid(asked, way, (xw, yw, phi), slide, words)


def _slid(
    asked: Asked, way: Way, wrist: tuple[float, float, float], slide: float, words: str
) -> Way:
    """One direction of the slide, then both turns."""
    arm, (xw, yw, phi) = asked.arm, wrist
    a1, side = arm.rows[0].a, -arm.rows[0].sa
    given = {"x_w": xw, "y_w": yw, "a_1": a1, "d_2": slide, "phi": phi}
    others = (-slide,) if slide else ()
    second = joint_step(
        arm,
        1,
        "d_2: the slide",
        words + "The root has two signs: the slide may run forward or back.",
        [Equation("d_2", "+- sqrt(x_w^2 + y_w^2 - a_1^2)", given, slide, "m", others)],
        slide,
    )
    theta1 = math.remainder(math.atan2(yw, xw) - math.atan2(side * slide, a1), math.tau)
    inner = "d_2" if side > 0.0 else "-d_2"
    first = joint_step(
        arm,
        0,
        "theta_1: the four-quadrant arctangent",
        "The direction of (x_w, y_w), less the angle in the triangle.",
        [Equation("theta_1", f"atan2(y_w, x_w) - atan2({inner}, a_1)", given, theta1, "rad")],
        theta1,
    )
    theta3 = math.remainder(phi - theta1, math.tau)
    given["theta_1"] = theta1
    third = joint_step(
        arm,
        2,
        "theta_3: what is left of the direction",
        "phi is the sum of the two angles.",
        [Equation("theta_3", "phi - theta_1", given, theta3, "rad")],
        theta3,
    )
    return way.then(second, first, third).put(1, slide).put(0, theta1).put(2, theta3)


def moves_point(rows: tuple[Row, ...]) -> bool:
    """Whether three joints move the origin of the last frame in three directions somewhere."""
    if len(rows) != 3:
        return False
    for q in np.random.default_rng(0).uniform(-2.0, 2.0, (4, 3)):
        frames = [np.eye(4)]
        for row, value in zip(rows, q, strict=True):
            frames.append(frames[-1] @ row.motion(float(value)))
        tip = frames[3][:3, 3]
        columns = [
            F[:3, 2] if row.slides else np.cross(F[:3, 2], tip - F[:3, 3])
            for F, row in zip(frames, rows, strict=False)
        ]
        if abs(np.linalg.det(np.array(columns))) > REGULAR:
            return True
    return False


def place_and_compare(asked: Asked) -> Iterator[Way]:
    """The place by three joints; the orientation is then right or not."""
    R = asked.H[:3, :3]
    words = (
        "A pose has six numbers, the arm three joints: most poses have no solution. The place is "
        "three equations for three joints; the orientation is compared at the end."
    )
    way = Way().then(Step("Place first", words))
    for placed in place_point(asked, way, asked.H[:3, 3], np.zeros(3), "the origin of frame 3"):
        if placed.stopped:
            yield placed
            continue
        found = asked.arm.frames(placed.first(3))[3][:3, :3]
        off = float(rotation_angle(found.T @ R))
        equation = Equation("R_3^0", "R_1^0 R_2^1 R_3^2", {}, found)
        if off <= OFF:
            said = "The orientation of these joint values is the one asked for."
            yield placed.then(Step("The orientation", said, (equation,)))
        else:
            said = (
                f"The place is right, but the hand is turned by {shown(math.degrees(off))} deg "
                "from the orientation asked for, and no joint is left to mend it: here this way "
                "ends. (The task position leaves the orientation open.)"
            )
            yield placed.stop(Step("The orientation", said, (equation,)))


def place_only(asked: Asked) -> Iterator[Way]:
    """The task position of three joints: the tool's origin, fixed in frame 3."""
    tip = asked.arm.tool[:3, 3]
    yield from place_point(asked, Way(), asked.H[:3, 3], tip, "the tool's origin")
