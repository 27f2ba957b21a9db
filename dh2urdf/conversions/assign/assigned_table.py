"""From a serial chain to a DH table."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from dh2urdf.chain import SerialChain
from dh2urdf.conversions.assign.frame_assignment import Assignment, FrameAssigner, XRule
from dh2urdf.conversions.assign.prismatic_axes import place_prismatic_axes
from dh2urdf.conversions.assign.rounding import tidy_angle, tidy_length, tidy_origin
from dh2urdf.conversions.write import FLIP
from dh2urdf.dh import DHConvention, DHRow, DHTable, JointType, Origin
from dh2urdf.exceptions import NameNotFoundError
from dh2urdf.transforms import Array


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

    Parameters
    ----------
    convention : DHConvention
    name : str
        Name of the table.
    x_rule : XRule
        Which way x points along a common normal.
    compact : bool
        Give pairs of axes whose common normal is far away an extra fixed step instead.
    signs : sequence of n ints, optional
        -1 where z is to point against the joint's positive direction; the row's sign makes up
        for it, so q stays what it was.

    Returns
    -------
    AssignedTable
        FK of the table equals FK of the chain, up to rounding.
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


def turned_round(links: Array, signs: Sequence[int]) -> Array:
    """Links of the chain whose joint frames have z turned round where the sign is -1."""
    out = links.copy()
    for i, sign in enumerate(signs):
        if sign < 0:
            out[i] = out[i] @ FLIP
            out[i + 1] = FLIP @ out[i + 1]
    return out


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
