"""The wrist: what is left of the orientation, as ZYZ angles (lecture notes 8.3, Spong 2.5.1)."""

import math
from collections.abc import Iterator

from dh2urdf.lessons.notation import shown
from dh2urdf.lessons.steps import Equation, Mark, Step
from dh2urdf.lessons.way import RIM, Asked, Way, joint_step
from dh2urdf.transforms import Array

FREE = 5e-10
"""Sine of theta_5 up to which axes 4 and 6 are in line."""


def wrists(asked: Asked, way: Way) -> Iterator[Way]:
    """Both wrists of a way on which joints 1 to 3 are known."""
    arm = asked.arm
    H_3 = arm.frames(way.first(3))[3]
    R_03 = H_3[:3, :3]
    R, four, five = R_03.T @ asked.H[:3, :3], arm.rows[3], arm.rows[4]
    way = way.then(_left_over(asked, H_3, R))
    in_line = math.hypot(R[0, 2], R[1, 2]) <= FREE
    if four.ca or five.ca:
        yield from _skew(asked, way, R, in_line)
        return
    opposite = four.sa * five.sa < 0.0
    if in_line:
        yield _singular(asked, way, R, opposite)
        return
    for sign in (1.0, -1.0):
        yield _regular(asked, way, R, sign, opposite)


def _left_over(asked: Asked, H_3: Array, R: Array) -> Step:
    """``R_3^0`` and what is left for the wrist."""
    base, R_03 = asked.arm.base, H_3[:3, :3]
    marks = Mark("frame", base @ H_3, "3"), Mark("frame", base @ asked.H, "6")
    turning = [f"theta_{i}" for i, row in enumerate(asked.arm.rows[:3], 1) if not row.slides]
    known = f"known from {', '.join(turning)}" if turning else "the same for all slides"
    return Step(
        "What is left of the orientation",
        f"R_3^0 is {known}, so R = R_3^0 R_6^3 leaves R_6^3 = (R_3^0)^T R to joints 4, 5, 6.",
        (
            Equation("R_3^0", "R_1^0 R_2^1 R_3^2", {"R": R_03}, R_03),
            Equation("R_6^3", "(R_3^0)^T R", {"R": R}, R),
        ),
        marks=marks,
    )


def _as_rotations(asked: Asked, opposite: bool) -> str:
    """How the table's rows 4 to 6 are the ZYZ angles."""
    four, five = asked.arm.rows[3], asked.arm.rows[4]
    a4, a5 = (f"{'+' if v > 0 else '-'}90 deg" for v in (four.sa, five.sa))
    sign = "-" if four.sa > 0.0 else ""
    text = f"With alpha_4 = {a4} and alpha_5 = {a5}, "
    if opposite:
        return (
            f"{text}R_6^3 = Rz(theta_4) Ry({sign}theta_5) Rz(theta_6): ZYZ Euler angles phi = "
            f"theta_4, theta = {sign}theta_5, psi = theta_6."
        )
    turned = "pi - theta_5" if four.sa > 0.0 else "pi + theta_5"
    return (
        f"{text}R_6^3 = Rz(theta_4) Ry({turned}) Rz(theta_6 + pi): ZYZ Euler angles phi = theta_4, "
        f"theta = {turned}, psi = theta_6 + pi."
    )


def _fifth(asked: Asked, opposite: bool, theta: float) -> Equation:
    """theta_5 from the Euler angle theta."""
    up = asked.arm.rows[3].sa > 0.0
    if opposite:
        formula, value = ("-theta", -theta) if up else ("theta", theta)
    else:
        formula = "pi - theta" if up else "theta - pi"
        value = math.pi - theta if up else theta - math.pi
    value = math.remainder(value, 2.0 * math.pi)
    return Equation("theta_5", formula, {"theta": theta, "pi": math.pi}, value, "rad")


def _sixth(opposite: bool, psi: float) -> Equation:
    """theta_6 from the Euler angle psi."""
    formula, value = ("psi", psi) if opposite else ("psi - pi", psi - math.pi)
    value = math.remainder(value, 2.0 * math.pi)
    return Equation("theta_6", formula, {"psi": psi, "pi": math.pi}, value, "rad")


def _regular(asked: Asked, way: Way, R: Array, sign: float, opposite: bool) -> Way:
    """One of the two triples of ZYZ angles, ``sin theta`` of a sign."""
    arm, mark = asked.arm, "" if sign > 0.0 else "-"
    r = {f"r_{i + 1}{j + 1}": float(R[i, j]) for i in range(3) for j in range(3)}
    across = math.hypot(r["r_13"], r["r_23"])
    theta = math.atan2(sign * across, r["r_33"])
    phi = math.atan2(sign * r["r_23"], sign * r["r_13"])
    psi = math.atan2(sign * r["r_32"], -sign * r["r_31"])
    formula = "atan2(+- sqrt(r_13^2 + r_23^2), r_33)"
    euler = Equation("theta", formula, r, theta, "rad", (-theta,))
    fifth, sixth = _fifth(asked, opposite, theta), _sixth(opposite, psi)
    said = "positive" if sign > 0.0 else "negative"
    other = "-" if sign > 0.0 else ""
    five = joint_step(
        arm,
        4,
        "theta_5: the two wrists",
        f"{_as_rotations(asked, opposite)} The third column and row of R_6^3 give them. sin theta "
        "may have either sign: two wrists, half a turn of joint 4 apart. Here sin theta is "
        f"{said}.",
        [euler, fifth],
        float(fifth.value),
        choice="wrist",
    )
    four = joint_step(
        arm,
        3,
        "theta_4",
        f"The third column of R_6^3 is (cos phi sin theta, sin phi sin theta, cos theta), so with "
        f"sin theta {said} phi is the direction of ({mark}r_13, {mark}r_23).",
        [
            Equation("phi", f"atan2({mark}r_23, {mark}r_13)", r, phi, "rad"),
            Equation("theta_4", "phi", {"phi": phi}, phi, "rad"),
        ],
        phi,
    )
    six = joint_step(
        arm,
        5,
        "theta_6",
        "The third row is (-sin theta cos psi, sin theta sin psi, cos theta).",
        [Equation("psi", f"atan2({mark}r_32, {other}r_31)", r, psi, "rad"), sixth],
        float(sixth.value),
    )
    found = way.then(five, four, six).put(3, phi).put(4, float(fifth.value))
    return found.put(5, float(sixth.value))


def _singular(asked: Asked, way: Way, R: Array, opposite: bool) -> Way:
    """Axes 4 and 6 in line: only the sum or the difference of theta_4 and theta_6 counts."""
    arm, up = asked.arm, R[2, 2] > 0.0
    theta, phi = 0.0 if up else math.pi, asked.free_value(3)
    r = {"r_11": float(R[0, 0]), "r_21": float(R[1, 0]), "phi": phi}
    both = math.atan2(r["r_21"], r["r_11"]) if up else math.atan2(-r["r_21"], -r["r_11"])
    psi = math.remainder(both - phi if up else phi - both, 2.0 * math.pi)
    fifth, sixth = _fifth(asked, opposite, theta), _sixth(opposite, psi)
    only = "phi + psi" if up else "phi - psi"
    words = (
        f"{_as_rotations(asked, opposite)} r_13 = r_23 = 0 means sin theta = 0: the wrist is "
        "singular. Axes 4 and 6 are in line, both turn the hand about one line, and the "
        f"orientation fixes only {only}."
    )
    five = joint_step(
        arm,
        4,
        "theta_5: a singular wrist",
        words,
        [Equation("theta", "atan2(0, r_33)", {"r_33": float(R[2, 2])}, theta, "rad"), fifth],
        float(fifth.value),
    )
    four = joint_step(
        arm,
        3,
        "theta_4: free",
        "One of the two may be chosen: theta_4 stays where the joint is asked to be (at q_4 = 0 "
        "if nothing is asked). All other choices are solutions too.",
        [Equation("theta_4", "phi", {"phi": phi}, phi, "rad")],
        phi,
    )
    formula = "atan2(r_21, r_11) - phi" if up else "phi - atan2(-r_21, -r_11)"
    six = joint_step(
        arm,
        5,
        "theta_6",
        f"{only} is the angle of the turn that is left.",
        [Equation("psi", formula, r, psi, "rad"), sixth],
        float(sixth.value),
    )
    found = way.then(five, four, six).put(3, phi).put(4, float(fifth.value))
    return found.put(5, float(sixth.value))


def _skew(asked: Asked, way: Way, R: Array, in_line: bool) -> Iterator[Way]:
    """A wrist whose axes are not at right angles: the same two steps, with its own cosines."""
    four, five = asked.arm.rows[3], asked.arm.rows[4]
    given = {"r_33": float(R[2, 2]), "ca_4": four.ca, "ca_5": five.ca}
    given |= {"sa_4": four.sa, "sa_5": five.sa}
    cosine = (four.ca * five.ca - float(R[2, 2])) / (four.sa * five.sa)
    c5 = Equation("c_5", "(ca_4 ca_5 - r_33) / (sa_4 sa_5)", given, cosine)
    words = (
        "The wrist's axes are not at right angles (ca_4 = cos alpha_4 and so on): these are no ZYZ "
        "angles, but the same two steps find them. r_33 = ca_4 ca_5 - sa_4 sa_5 cos theta_5."
    )
    if abs(cosine) > 1.0 + RIM:
        far = (
            f" It is {shown(cosine)}, not between -1 and 1: axis 6 cannot lean so far from axis 4."
        )
        yield way.stop(Step("theta_5", words + far, (c5,)))
        return
    sine = math.sqrt(max(1.0 - cosine * cosine, 0.0))
    bent = math.atan2(sine, cosine)
    for bend in (bent, -bent) if sine > FREE else (bent,):
        others = (-bend,) if sine > FREE else ()
        fifth = Equation("theta_5", "+- acos(c_5)", {"c_5": cosine}, bend, "rad", others)
        step = joint_step(
            asked.arm, 4, "theta_5: the two wrists", words, [c5, fifth], bend, choice="wrist"
        )
        yield _skew_outer(asked, way.then(step).put(4, bend), R, bend, in_line)


def _skew_outer(asked: Asked, way: Way, R: Array, bend: float, in_line: bool) -> Way:
    """theta_4 and theta_6 of a skew wrist with a known theta_5."""
    four, five = asked.arm.rows[3], asked.arm.rows[4]
    middle = (four._replace(a=0.0, d=0.0).motion(0.0) @ five.motion(bend))[:3, :3]
    given = {"r_13": R[0, 2], "r_23": R[1, 2], "m_13": middle[0, 2], "m_23": middle[1, 2]}
    given |= {"r_31": R[2, 0], "r_32": R[2, 1], "m_31": middle[2, 0], "m_32": middle[2, 1]}
    numbers = {key: float(v) for key, v in given.items()}
    theta4 = math.atan2(R[1, 2], R[0, 2]) - math.atan2(middle[1, 2], middle[0, 2])
    formula = "atan2(r_23, r_13) - atan2(m_23, m_13)"
    if in_line:
        theta4, formula = asked.free_value(3), "theta_4"
    theta4 = math.remainder(theta4, 2.0 * math.pi)
    turn = four._replace(a=0.0, d=0.0).motion(theta4) @ five.motion(bend)
    left = turn[:3, :3].T @ R
    theta6 = math.atan2(left[1, 0], left[0, 0])
    step4 = joint_step(
        asked.arm,
        3,
        "theta_4",
        "M = Rx(alpha_4) Rz(theta_5) Rx(alpha_5) is known; Rz(theta_4) turns its third column onto "
        "that of R_6^3." + (" Both are along axis 4: theta_4 is free." if in_line else ""),
        [Equation("theta_4", formula, numbers, theta4, "rad")],
        theta4,
    )
    step6 = joint_step(
        asked.arm,
        5,
        "theta_6",
        "Rz(theta_6) is what is left: (Rz(theta_4) M)^T R_6^3.",
        [
            Equation(
                "theta_6",
                "atan2(n_21, n_11)",
                {"n_21": float(left[1, 0]), "n_11": float(left[0, 0])},
                theta6,
                "rad",
            )
        ],
        theta6,
    )
    return way.then(step4, step6).put(3, theta4).put(5, theta6)
