"""From a serial chain to a DH table."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from dh2urdf import transforms as tf
from dh2urdf.chain import SerialChain
from dh2urdf.conversions.assign.frame_assignment import Assignment, FrameAssigner, XRule
from dh2urdf.conversions.assign.prismatic_axes import place_prismatic_axes
from dh2urdf.conversions.write import turned_round
from dh2urdf.dh import DHConvention, DHRow, DHTable, JointType, Origin
from dh2urdf.exceptions import NameNotFoundError
from dh2urdf.transforms import Array

STEP = math.pi / 12
"""Angles are drawn to multiples of 15 degrees."""

ANGLE = 1e-14
"""Rounding error of an angle that went through a few dozen matrix products [rad]."""

ULPS = 8
"""Rounding error of a length, in units of the last digit of the arm's size."""


@dataclass(frozen=True)
class AssignedTable:
    """A table and the frame assignment behind it.

    ``links`` are those of the chain with the axes of sliding joints where the table has them.
    """

    table: DHTable
    assignment: Assignment
    links: Array


def chain_to_dh(
    chain: SerialChain,
    convention: DHConvention | str = DHConvention.STANDARD,
    *,
    name: str = "robot",
    x_rule: XRule | str = XRule.AUTO,
    compact: bool = True,
    signs: Sequence[int] | None = None,
) -> AssignedTable:
    """Assign DH frames to a chain (lecture notes section 4) and write down the table.

    With ``compact`` pairs of axes whose common normal is far away get an extra fixed step instead.
    ``signs`` are -1 where z is to point against the joint's positive direction; the row's sign
    makes up for it, so q stays what it was. FK of the table equals that of the chain, up to
    rounding.
    """
    convention = DHConvention(convention)
    rule = XRule(x_rule)
    signs = tuple(signs) if signs is not None else (1,) * chain.n
    links = turned_round(chain.links, signs)
    slides: list[bool] = chain.prismatic.tolist()
    assigner = FrameAssigner(links, convention, prismatic=slides, x_rule=rule, compact=compact)
    size = assigner.ref.size
    links = place_prismatic_axes(links, slides, assigner.lengths, size)
    assignment = assigner.assign(links)
    rows = _rows(assignment, chain, signs)
    table = DHTable(
        rows,
        convention,
        name,
        base=tidy_origin(assignment.base, size),
        tool=tidy_origin(assignment.end.tool, size),
    )
    return AssignedTable(table, assignment, links)


def flip_signs(chain: SerialChain, flip: Sequence[str]) -> tuple[int, ...]:
    """Signs of the rows, -1 for the joints named."""
    for name in flip:
        if name not in chain.names:
            raise NameNotFoundError(
                f"flip: no joint named {name!r} in the chain; it has {', '.join(chain.names)}"
            )
    return tuple(-1 if name in flip else 1 for name in chain.names)


def _rows(found: Assignment, chain: SerialChain, signs: Sequence[int]) -> tuple[DHRow, ...]:
    """One row a joint, and a fixed row after each that needs one."""
    standard = found.convention is DHConvention.STANDARD
    between = [(n.a, n.alpha) for n in found.normals]
    crossings = (
        [*between, (found.end.a, found.end.alpha)]
        if standard
        else [(found.start.a, found.start.alpha), *between]
    )
    rows = []
    for i, (a, alpha) in enumerate(crossings):
        row = DHRow(
            theta=tidy_angle(found.theta[i]),
            d=tidy_length(found.d[i], found.size),
            a=tidy_length(a, found.size),
            alpha=tidy_angle(alpha),
            joint_type=chain.joint_types[i],
            sign=signs[i],
            name=chain.names[i],
            lower=_finite(chain.lower[i]),
            upper=_finite(chain.upper[i]),
        )
        rows.append(row)
        beta = found.normals[i].beta if i < found.n - 1 else 0.0
        if beta != 0:
            step = Origin(rpy=(0.0, beta, 0.0))
            rows.append(DHRow(joint_type=JointType.FIXED, origin=step))
    return tuple(rows)


def _finite(bound: float) -> float | None:
    return float(bound) if math.isfinite(bound) else None


def near_angle(angle: float, tolerance: float) -> float:
    """The multiple of 15 degrees within the tolerance [rad], or the angle itself."""
    k = round(angle / STEP)
    target = k * STEP if k % 6 else (k // 6) * (math.pi / 2)
    return target + 0.0 if abs(angle - target) <= tolerance else angle


def tidy_angle(angle: float) -> float:
    """The angle [rad] without rounding error, if it is a multiple of 15 degrees."""
    return near_angle(math.pi if angle == -math.pi else angle, ANGLE)


def tidy_length(length: float, size: float) -> float:
    """The shortest decimal that is the length [m] within the last digits of the arm's size [m]."""
    tolerance = ULPS * float(np.spacing(max(abs(length), size)))
    for digits in range(13):
        short = round(length, digits)
        if abs(short - length) <= tolerance:
            return short + 0.0
    return length


def tidy_origin(T: Array, size: float) -> Origin:
    """A rigid step with both kinds of rounding error taken off."""
    x, y, z = (tidy_length(float(v), size) for v in T[:3, 3])
    roll, pitch, yaw = (tidy_angle(v) for v in tf.matrix_to_rpy(T))
    return Origin((x, y, z), (roll, pitch, yaw))
