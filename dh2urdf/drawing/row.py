"""One row of a DH table as geometry: what theta, d, a and alpha measure between two frames.

Standard (lecture notes section 4, step 3): from o_{i-1} by d along z_{i-1} to the foot of the
common normal, by a along x_i to o_i; theta turns x_{i-1} into x_i about z_{i-1}, alpha turns
z_{i-1} into z_i about x_i. Modified (Craig, "Introduction to Robotics", section 3.4): a and
alpha first, about x_{i-1}; then theta and d about z_i.
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from dh2urdf.conversions.assign import AxisCase, classify
from dh2urdf.dh import DHConvention, DHRow, DHTable
from dh2urdf.dh.variables import moved_by, plus
from dh2urdf.dh_io import Kind, Units
from dh2urdf.drawing.arm import DrawnArm
from dh2urdf.drawing.readings import TINY, UNITS, measured
from dh2urdf.transforms import Array, rotation

STUB = 0.15
"""Length drawn for a d that leads far away along its axis, as a share of the arm's size."""

MOVED = "frames that are far from the arm are drawn moved along z to it, marked x′, z′."

SUBSCRIPTS = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")


@dataclass(frozen=True, eq=False)
class Measure:
    """A length of the row: its segment (2, 3) in base [m], its value [m].

    ``moved`` where it is measured far from the arm: then the segment is not as long as the value.
    """

    key: str
    segment: Array
    value: float
    moved: bool = False


@dataclass(frozen=True, eq=False)
class Arc:
    """An angle [rad] of the row: its centre, and unit vectors along its axis and start, in base."""

    key: str
    centre: Array
    axis: Array
    start: Array
    value: float

    def points(self, radius: float) -> Array:
        """Points along the arc, at most one turn, shape (m, 3)."""
        angle = math.fmod(self.value, 2 * math.pi)
        steps = np.linspace(0.0, angle, max(2, int(abs(angle) / 0.05) + 2))
        return np.stack(
            [self.centre + radius * (rotation(self.axis, t)[:3, :3] @ self.start) for t in steps]
        )


@dataclass(frozen=True, eq=False)
class DHRowPicture:
    """Row i (from 1) of a table at a configuration: its frames (4, 4) in base and its matrix.

    ``T_reached`` is where the four motions lead, before fixed steps; ``case`` how z_{i-1} and z_i
    lie.
    """

    i: int
    T_prev: Array
    T_reached: Array
    T_next: Array
    T_prev_next: Array
    theta: Arc
    d: Measure
    a: Measure
    alpha: Arc
    case: AxisCase


def row_picture(arm: DrawnArm, q: Array, i: int) -> DHRowPicture:
    """The picture of row i (from 1) with the arm at q (n,)."""
    table = arm.table
    row, frames = table.joints[i - 1], table.frames(q)
    T_prev, T_next = frames[i - 1], frames[i]
    T_reached = T_prev @ row.transform(float(q[i - 1]), table.convention)
    T_prev_next: Array = table.transforms(q)[i - 1]
    theta, d = row.variables(float(q[i - 1]))
    o_prev, o_reached = T_prev[:3, 3], T_reached[:3, 3]
    x_prev, z_prev = T_prev[:3, 0], T_prev[:3, 2]
    x_next, z_next = T_reached[:3, 0], T_reached[:3, 2]
    if table.convention is DHConvention.STANDARD:
        foot = o_prev + d * z_prev
        d_segment, a_segment = np.stack([o_prev, foot]), np.stack([foot, o_reached])
        turn = Arc("theta", foot, z_prev, x_prev, theta)
        twist = Arc("alpha", o_reached, x_next, z_prev, row.alpha)
    else:
        foot = o_prev + row.a * x_prev
        a_segment, d_segment = np.stack([o_prev, foot]), np.stack([foot, o_reached])
        turn = Arc("theta", o_reached, z_next, x_prev, theta)
        twist = Arc("alpha", foot, x_prev, z_prev, row.alpha)
    lengths = Measure("d", d_segment, d), Measure("a", a_segment, row.a)
    case = classify(T_prev_next, arm.size).case
    picture = DHRowPicture(i, T_prev, T_reached, T_next, T_prev_next, turn, *lengths, twist, case)
    return _brought_near(picture, arm, q) if arm.shifts[i - 1 : i + 1].any() else picture


def _brought_near(picture: DHRowPicture, arm: DrawnArm, q: Array) -> DHRowPicture:
    """The same with its frames moved along z to the arm, and its measures between them.

    A d whose frames are then side by side is a stub on its axis.
    """
    T_prev, T_next = arm.frames(q)[picture.i - 1 : picture.i + 1]
    before, after = (arm.shifts[picture.i - 1 : picture.i + 1] != 0.0).tolist()
    T_reached = T_next if after else picture.T_reached
    start, end = T_prev[:3, 3], T_reached[:3, 3]
    stub = math.copysign(STUB * arm.size, picture.d.value)
    if arm.table.convention is DHConvention.STANDARD:
        foot = _beside(end, start, T_prev[:3, 2]) if after else picture.a.segment[0]
        a, d, far = (foot, end), (start, foot), after
        centres = foot, end
        spare = start, start + stub * T_prev[:3, 2]
    else:
        foot = _beside(start, end, T_reached[:3, 2]) if before else picture.a.segment[1]
        a, d, far = (start, foot), (foot, end), before
        centres = end, foot
        spare = end - stub * T_reached[:3, 2], end
    if math.dist(*d) < STUB * arm.size:
        d = spare
    return replace(
        picture,
        T_prev=T_prev,
        T_reached=T_reached,
        T_next=T_next,
        theta=replace(picture.theta, centre=centres[0]),
        alpha=replace(picture.alpha, centre=centres[1]),
        d=replace(picture.d, segment=np.stack(d), moved=True),
        a=replace(picture.a, segment=np.stack(a), moved=far),
    )


def subscript(name: str, i: int | str) -> str:
    """A name with a subscript in plain text."""
    return f"{name}{str(i).translate(SUBSCRIPTS)}"


def _beside(point: Array, start: Array, axis: Array) -> Array:
    """The point of an axis through ``start`` that is nearest to another point."""
    return np.asarray(start + axis * float(axis @ (point - start)))


def axis_name(arm: DrawnArm, letter: str, i: int) -> str:
    """``z₂``, or ``z′₂`` for a frame that is drawn moved along its z."""
    return subscript(f"{letter}′" if arm.shifts[i] else letter, i)


def length_index(table: DHTable, i: int) -> int:
    """Subscript of a and alpha in row i: i, or Craig's i - 1 in modified tables."""
    return i if table.convention is DHConvention.STANDARD else i - 1


def values(table: DHTable, picture: DHRowPicture, units: Units = UNITS) -> dict[str, str]:
    """``θ₄ = −50°`` and so on, by key, for the labels of a picture."""
    i, j = picture.i, length_index(table, picture.i)
    return {
        "theta": f"{subscript('θ', i)} = {measured(picture.theta.value, Kind.ANGLE, units)}",
        "d": f"{subscript('d', i)} = {measured(picture.d.value, Kind.LENGTH, units)}",
        "a": f"{subscript('a', j)} = {measured(picture.a.value, Kind.LENGTH, units)}",
        "alpha": f"{subscript('α', j)} = {measured(picture.alpha.value, Kind.ANGLE, units)}",
    }


def row_words(table: DHTable, picture: DHRowPicture, units: Units = UNITS) -> str:
    """What the row says, in a few sentences."""
    i, row = picture.i, table.joints[picture.i - 1]
    modified = table.convention is DHConvention.MODIFIED
    before, after = subscript("z", i - 1), subscript("z", i)
    if modified and i == 1:
        words = "First frame: free (step 2), any frame 0 from which the four motions reach z₁."
    elif not modified and i == table.n:
        words = f"Last frame: free (step 4) as long as the four motions reach frame {i}."
    else:
        words = _case_words(picture, before, after, subscript("x", length_index(table, i)), units)
    words = f"{words} {_variable_words(table, row, i, units)}"
    if float(np.abs(picture.T_reached - picture.T_next).max()) > 0:
        words += f" A fixed step leads from there to frame {i}."
    if picture.d.moved:
        words += f" d leads {measured(abs(picture.d.value), Kind.LENGTH, units)} away: {MOVED}"
    return words


def _case_words(picture: DHRowPicture, before: str, after: str, x: str, units: Units) -> str:
    """The case of the notes' step 3."""
    a = picture.a.value
    apart = measured(abs(a), Kind.LENGTH, units)
    if picture.case is AxisCase.SKEW:
        way = "away from" if a > 0 else "towards"
        return (
            f"Case 1: {before} and {after} are skew. One common normal joins them, "
            f"{apart} long; {x} lies on it, pointing {way} {before}."
        )
    if picture.case is AxisCase.PARALLEL:
        placed = "the one with d = 0" if abs(picture.d.value) < TINY else "one of them, fixed by d"
        return (
            f"Case 2: {before} and {after} are parallel, {apart} apart. "
            f"They have any number of common normals; {x} lies on {placed}."
        )
    if picture.case is AxisCase.INTERSECTING:
        return (
            f"Case 3: {before} and {after} intersect, so a = 0. "
            f"{x} is perpendicular to both; which way it points is free."
        )
    return f"{before} and {after} are one line: a = 0, and {x} may point anywhere across it."


def _variable_words(table: DHTable, row: DHRow, i: int, units: Units) -> str:
    slides = row.joint_type == "prismatic"
    symbol = subscript("d" if slides else "θ", i)
    variable, constant = moved_by(table.joint_map, i - 1, row.sign, lambda k: subscript("q", k))
    offset = (row.d if slides else row.theta) + constant
    shown = measured(offset, Kind.LENGTH if slides else Kind.ANGLE, units)
    value = plus(variable, shown if abs(offset) >= TINY else "0")
    follows = f" It follows {row.mimic.joint}." if row.mimic else ""
    return f"The joint moves {symbol} = {value}.{follows}"
