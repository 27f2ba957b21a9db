"""Frame assignment in words: what was done for each frame and why, like a worked solution."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from dh2urdf.chain import SerialChain
from dh2urdf.conversions.assign.assigned_table import AssignedTable
from dh2urdf.conversions.assign.axis_pairs import AxisCase, Normal, common_normal
from dh2urdf.conversions.assign.frame_ends import BaseChoice, ToolChoice
from dh2urdf.dh import DHConvention, DHRow, JointType
from dh2urdf.dh.variables import followed
from dh2urdf.transforms import Array


@dataclass(frozen=True)
class FrameStep:
    """How one frame was found.

    Parameters
    ----------
    frame : int
        Number of the frame, 0 to n.
    joint : str
        The joint whose axis is the frame's z; empty for the last standard frame.
    case : AxisCase or None
        How the axes that the frame lies between lie to each other; None at the ends.
    origin, x, z : tuple of float
        The frame at q = 0 in base: origin [m] and unit axes.
    text : str
    """

    frame: int
    joint: str
    case: AxisCase | None
    origin: tuple[float, float, float]
    x: tuple[float, float, float]
    z: tuple[float, float, float]
    text: str

    def __str__(self) -> str:
        return f"Frame {self.frame}. {self.text}"


def angle_words(angle: float) -> str:
    """An angle [rad] as a person writes it: 0, pi/2, -3 pi/4, or degrees."""
    k = round(angle / (math.pi / 12))
    if abs(angle - k * math.pi / 12) > 1e-12:
        return f"{angle:.6g} rad ({math.degrees(angle):.6g} deg)"
    if k == 0:
        return "0"
    common = math.gcd(k, 12)
    top, bottom = abs(k) // common, 12 // common
    text = ("" if top == 1 else f"{top} ") + "pi" + ("" if bottom == 1 else f"/{bottom}")
    return f"-{text}" if k < 0 else text


def length_words(length: float) -> str:
    """A length [m] with six digits, without noise."""
    return f"{0.0 if abs(length) < 5e-13 else length:.6g}"


def explain_frames(found: AssignedTable, chain: SerialChain) -> tuple[FrameStep, ...]:
    """One step a frame, 0 to n; axes of sliding joints have no place of their own."""
    standard = found.assignment.convention is DHConvention.STANDARD
    frames = found.table.frames(np.zeros(chain.n))
    names = (*chain.names, "") if standard else (chain.names[0], *chain.names)
    cases = (None, *(pair.case for pair in found.assignment.pairs), None)
    between = (_between(found, chain, i, _point(frames[i][:3, 3])) for i in range(1, chain.n))
    texts = (_first(found, chain), *between, _last(found))
    steps = []
    for i, T in enumerate(frames):
        origin, x, z = (
            (float(a) + 0.0, float(b) + 0.0, float(c) + 0.0) for a, b, c in T.T[[3, 0, 2], :3]
        )
        steps.append(FrameStep(i, names[i], cases[i], origin, x, z, texts[i]))
    return tuple(steps)


def _first(found: AssignedTable, chain: SerialChain) -> str:
    """Step 2 of the notes."""
    table, start = found.table, found.assignment.start
    text = f"z_0 is the axis of joint 1 ({chain.names[0]}). "
    if start.choice is BaseChoice.BASE and (start.a or start.alpha):
        return (
            "Frame 0 is the base frame: two of the DH motions, "
            f"a_0 = {length_words(start.a)} and alpha_0 = {angle_words(start.alpha)}, lead from "
            f"its z axis to the axis of joint 1 ({chain.names[0]})."
        )
    if start.choice is BaseChoice.BASE:
        return text + "It is the base's own z axis, so frame 0 is the base frame."
    place = _point(table.base.xyz)
    rpy = ", ".join(angle_words(v) for v in table.base.rpy)
    beside = "It is parallel to the base's z axis, so frame 0 keeps the base's axes and moves to "
    turned = "It is antiparallel to the base's z axis, so frame 0 is the base frame turned by pi "
    free = "It is not parallel to the base's z axis; frame 0 is put on it so that theta_1 = 0 and "
    why = {
        BaseChoice.BESIDE: f"{beside}the foot of z_0, {place}.",
        BaseChoice.TURNED: f"{turned}about x and moved to the foot of z_0, {place}.",
        BaseChoice.FREE: f"{free}d_1 = 0. The base transform takes up the way there: xyz "
        f"{place}, rpy ({rpy}).",
    }
    return text + why[start.choice]


def _between(found: AssignedTable, chain: SerialChain, i: int, origin: str) -> str:
    """Step 3 of the notes, for the frame between joints i and i + 1."""
    rows = found.table.joints
    standard = found.assignment.convention is DHConvention.STANDARD
    z1, z2 = (f"z_{i - 1}", f"z_{i}") if standard else (f"z_{i}", f"z_{i + 1}")
    z_own, owner = (z2, i + 1) if standard else (z1, i)
    parts = [f"{z_own} is the axis of joint {owner} ({chain.names[owner - 1]})."]
    if chain.joint_types[owner - 1] is JointType.PRISMATIC:
        parts.append(
            "The joint slides, so only its direction is given; the axis is drawn where the table "
            "gets the fewest lengths."
        )
    parts.append(_case(found, i, z1, z2, z_own, origin))
    row = rows[i - 1]
    numbers = f"theta_{i} = {angle_words(row.theta)}, d_{i} = {length_words(row.d)}"
    nxt = row if standard else rows[i]
    crossing = f"a_{i} = {length_words(nxt.a)}, alpha_{i} = {angle_words(nxt.alpha)}"
    place = "" if standard else f" in row {i + 1}"
    return " ".join(parts) + f" So {numbers}{_variable(row, i)}, {crossing}{place}."


def _case(table: AssignedTable, i: int, z1: str, z2: str, z_own: str, origin: str) -> str:
    found = table.assignment
    pair, normal = found.pairs[i - 1], found.normals[i - 1]
    how = "antiparallel" if pair.opposed else "parallel"
    if found.compact[i - 1]:
        far = common_normal(table.links[i], pair)
        return (
            f"{z1} and {z2} are {pair.tilt:.3g} rad from {how}: their common normal lies "
            f"{max(abs(far.s1), abs(far.s2)):.3g} m away. The frame stays at the arm, at {origin}; "
            f"x_{i} runs to where the other axis passes, and a fixed step, "
            f"Rot_y({normal.beta:.6g}), takes up what four parameters leave."
        )
    if pair.case is AxisCase.SKEW:
        return (
            f"Case 1: {z1} and {z2} are not coplanar. Their common normal is "
            f"{length_words(pair.distance)} m long; o_{i} is where it meets "
            f"{z_own}, {origin}. {_direction(normal, i, z1)}"
        )
    if pair.case is AxisCase.INTERSECTING:
        return (
            f"Case 3: {z1} and {z2} intersect at o_{i} = {origin}. x_{i} is normal to both; "
            "of its two directions the one that leaves the fewest joint angles non-zero at q = 0."
        )
    own = i == 1 and found.start.base is not None
    chosen = "through joint 1's own origin" if own else f"with d_{i} = 0"
    if pair.case is AxisCase.PARALLEL:
        return (
            f"Case 2: {z1} and {z2} are {how}, {length_words(pair.distance)} m apart; any common "
            f"normal will do, and the one {chosen} is taken. o_{i} is {origin}. "
            f"{_direction(normal, i, z1)}"
        )
    return (
        f"Cases 2 and 3 at once: {z1} and {z2} are one line"
        f"{', in opposite directions' if pair.opposed else ''}. x_{i} may point anywhere and the "
        f"origin lie anywhere on it: the one {chosen} is taken, o_{i} = {origin}."
    )


def _direction(normal: Normal, i: int, z1: str) -> str:
    if normal.a >= 0:
        return f"x_{i} points along it, away from {z1}."
    return (
        f"x_{i} points along it towards {z1}, so a_{i} is negative and theta_{i} is spared a half "
        "turn."
    )


def _variable(row: DHRow, i: int) -> str:
    """How the joint variable enters its row."""
    slides = row.joint_type is JointType.PRISMATIC
    kind, constant = ("d", row.d) if slides else ("theta", row.theta)
    follows = f", and joint {i} follows {followed(row.mimic)}" if row.mimic else ""
    if constant == 0 and row.sign > 0:
        return f" ({kind}_{i} is the joint's variable q_{i}{follows})"
    sign = "-" if row.sign < 0 else "+"
    return f" at q_{i} = 0 (the variable is {kind}_{i} {sign} q_{i}{follows})"


def _last(found: AssignedTable) -> str:
    """Step 4 of the notes."""
    end, n, table = found.assignment.end, found.assignment.n, found.table
    row = table.joints[-1]
    numbers = f"theta_{n} = {angle_words(row.theta)}, d_{n} = {length_words(row.d)}"
    if found.assignment.convention is DHConvention.STANDARD:
        numbers += f", a_{n} = {length_words(row.a)}, alpha_{n} = {angle_words(row.alpha)}"
    numbers = f"So {numbers}{_variable(row, n)}."
    if end.choice is ToolChoice.TOOL:
        return f"The four DH motions lead to the tool frame itself, so it is frame {n}. {numbers}"
    if table.tool.is_identity:
        rest = "No tool transform is left."
    else:
        rpy = ", ".join(angle_words(v) for v in table.tool.rpy)
        rest = f"The tool transform takes up the rest: xyz {_point(table.tool.xyz)}, rpy ({rpy})."
    text = f"Only z_{n}, the axis of the last joint, is given; o_{n} is that joint's own origin."
    if end.choice is ToolChoice.TOOL_POINT:
        text = (
            f"o_{n} is the tool's origin and z_{n} points along the last joint's axis; the tool "
            "frame itself is out of reach of the four DH motions."
        )
    return f"{text} {numbers} {rest}"


def _point(xyz: Sequence[float] | Array) -> str:
    return "(" + ", ".join(length_words(float(v)) for v in xyz) + ")"
