"""How the joints of a table move by the values q: ``q_joints = matrix @ q + offset``.

A joint without ``mimic`` has a value of its own in q, what the controller shows. The joint itself
is at that value, or, where the table couples it, at that value plus multiples of others; a joint
with ``mimic`` is where the one that it follows is, times a number, plus an offset.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from dh2urdf.bounds import COUPLED, RATIO
from dh2urdf.dh.mimic import Couplings, ReadOnly
from dh2urdf.dh.row import DHRow, JointType
from dh2urdf.doors import found, number
from dh2urdf.exceptions import ArgumentError, TableError
from dh2urdf.transforms import Array

Range = tuple[float, float]


class JointMap(NamedTuple):
    """``q_joints = matrix @ q + offset``, and where the joint stands whose value each of q is.

    Shapes (joints, n), (joints,) and n numbers from 0.
    """

    matrix: Array
    offset: Array
    own: tuple[int, ...]


class Problem(NamedTuple):
    """A fault of what is said between joints: the row of the joint from 0, keys, and the message.

    The row is -1 for ``couplings``.
    """

    row: int
    keys: tuple[str, ...]
    message: str


def read_only(value: object) -> Couplings:
    """Couplings of any mappings of names to numbers; an error with all that is wrong in them."""
    if not isinstance(value, Mapping):
        raise TableError(f"couplings: expected joint: {{other joint: number}}, got {found(value)}")
    problems, out = [], dict[str, ReadOnly[float]]()
    for name, terms in value.items():
        inner = dict[str, float]()
        if not isinstance(terms, Mapping):
            place = f"couplings.{name}"
            problems.append(f"{place}: expected other joint: number, got {found(terms)}")
            continue
        for other, ratio in terms.items():
            try:
                place = f"couplings.{name}.{other}"
                inner[str(other)] = number(ratio, place, -RATIO, RATIO) + 0.0
            except ArgumentError as error:
                problems.append(str(error))
        if inner:
            out[str(name)] = ReadOnly(inner)
    if problems:
        raise TableError(problems)
    return ReadOnly(out)


def problems_between(
    rows: Sequence[DHRow], names: Sequence[str], couplings: Mapping[str, Mapping[str, float]]
) -> list[Problem]:
    """All that is wrong with what the rows of joints, and the table, say between joints."""
    out = [p for i, row in enumerate(rows) for p in _of_row(i, row, rows, names, couplings)]
    leads = {name: row.mimic.joint for name, row in zip(names, rows, strict=True) if row.mimic}
    for name, terms in couplings.items():
        out += [Problem(-1, (name, *keys), text) for keys, text in _of(name, terms, names, leads)]
    if out or not couplings:
        return out
    condition = condition_of(joint_map(rows, names, couplings))
    if not condition <= COUPLED:
        text = "their matrix has no inverse: different q would be the same angles"
        if condition < SINGULAR:
            text = (
                f"their matrix has hardly an inverse: a turn of a joint would be {condition:.1e} "
                f"turns of q; at most {COUPLED:.0e} are taken"
            )
        return [Problem(-1, (), text)]
    for i, ends in enumerate(joint_ranges(rows, names, couplings)):
        if ends[0] > ends[1]:
            key = "serial_lower" if rows[i].serial_lower is not None else "serial_upper"
            text = f"nothing is left of {key}: the limits of q put the joint elsewhere"
            out.append(Problem(i, (key,), text))
    return out


def _of_row(
    i: int,
    row: DHRow,
    rows: Sequence[DHRow],
    names: Sequence[str],
    couplings: Mapping[str, Mapping[str, float]],
) -> Iterator[Problem]:
    """Faults of one row."""
    coupled = names[i] in couplings
    for key in ("serial_lower", "serial_upper"):
        if getattr(row, key) is not None and not coupled:
            text = "only a joint that couplings names has it; write lower and upper"
            yield Problem(i, (key,), text)
    if row.mimic is None:
        return
    leader = row.mimic.joint
    if coupled:
        yield Problem(i, ("mimic",), f"{names[i]!r} has couplings, too; a joint has one of both")
    if leader not in names:
        text = f"no joint {leader!r} to follow; there are {_list(names)}"
        if leader[:1] == "-" and leader[1:] in names:
            text = f"no joint {leader!r} to follow; to turn against it write {leader[1:]} -1"
        yield Problem(i, ("mimic", "joint"), text)
        return
    if leader == names[i]:
        yield Problem(i, ("mimic", "joint"), f"{leader!r} cannot follow itself")
        return
    way = [names[i]]
    while leader not in way:
        way.append(leader)
        follows = rows[names.index(leader)].mimic
        if follows is None or follows.joint not in names:
            return
        leader = follows.joint
    if leader == names[i] and i == min(map(list(names).index, way)):
        circle = " follows ".join(map(repr, [*way, leader]))
        yield Problem(i, ("mimic", "joint"), f"a circle: {circle}")


def _of(
    name: str, terms: Mapping[str, float], names: Sequence[str], leads: Mapping[str, str]
) -> Iterator[tuple[tuple[str, ...], str]]:
    """Faults of the couplings of one joint: keys and message."""
    if name not in names:
        yield (), f"no joint {name!r}; there are {_list(names)}"
    for other in terms:
        if other not in names:
            yield (other,), f"no joint {other!r}; there are {_list(names)}"
        elif other == name:
            yield (other,), "the joint's own value counts once; name other joints"
        elif other in leads:
            text = f"{other!r} has no value of its own, it follows {leads[other]!r}"
            yield (other,), f"{text}; name that"


def _list(names: Sequence[str]) -> str:
    more = f" and {len(names) - 12} more" if len(names) > 12 else ""
    return ", ".join(names[:12]) + more


def joint_map(
    rows: Sequence[DHRow], names: Sequence[str], couplings: Mapping[str, Mapping[str, float]]
) -> JointMap:
    """The map of rows of joints and couplings without faults."""
    own = [i for i, row in enumerate(rows) if row.mimic is None]
    columns = {names[i]: k for k, i in enumerate(own)}
    matrix, offset = np.zeros((len(rows), len(own))), np.zeros(len(rows))
    for k, i in enumerate(own):
        matrix[i, k] = 1.0
        for other, ratio in couplings.get(names[i], {}).items():
            matrix[i, columns[other]] = ratio
    for i in range(len(rows)):
        factor, at = 1.0, i
        while (mimic := rows[at].mimic) is not None:
            offset[i] += factor * mimic.offset
            factor *= mimic.multiplier
            at = names.index(mimic.joint)
        if at != i:
            matrix[i] = factor * matrix[at]
    return JointMap(matrix, offset, tuple(own))


def joint_ranges(
    rows: Sequence[DHRow], names: Sequence[str], couplings: Mapping[str, Mapping[str, float]]
) -> list[Range]:
    """Lower and upper bound of each joint itself [rad] or [m], infinite where there is none.

    Of a joint that is at a value of q, and of one that follows, they are the row's. A coupled one
    has the range in which the bounds of q put it, or the part of that between the row's
    ``serial_lower`` and ``serial_upper``.
    """
    joints = joint_map(rows, names, couplings)
    values = [_ends(rows[i].lower, rows[i].upper) for i in joints.own]
    out = []
    for i, row in enumerate(rows):
        if names[i] not in couplings:
            out.append(_ends(row.lower, row.upper))
            continue
        terms = [(k, ratio) for k, ratio in enumerate(joints.matrix[i].tolist()) if ratio]
        spans = [sorted(ratio * end for end in values[k]) for k, ratio in terms]
        least, most = _ends(row.serial_lower, row.serial_upper)
        low, high = (sum(ends) for ends in zip(*spans, strict=True))
        out.append((max(low, least), min(high, most)))
    return out


SINGULAR = 1e12
"""Condition of a matrix that has no inverse: what it seems to have is rounding."""


def condition_of(joints: JointMap) -> float:
    """How many times what a joint moves the values move: the spectral radius of ``|C^-1| |C|``.

    Of all conditions by other units of the values and the joints that is the smallest (Bauer,
    "Optimally scaled matrices", 1963), so that a steep thread is none.
    """
    C = joints.matrix[list(joints.own)]
    try:
        both = np.abs(np.linalg.inv(C)) @ np.abs(C)
    except np.linalg.LinAlgError:
        return math.inf
    return float(np.abs(np.linalg.eigvals(both)).max()) if np.isfinite(both).all() else math.inf


class Clash(NamedTuple):
    """A joint whose limits leave nothing of those of the one value that moves it.

    ``left`` is where they would put the value, ``ends`` its bounds.
    """

    joint: int
    value: int
    left: Range
    ends: Range

    def words(self, leader: str, slides: bool) -> str:
        """What is wrong, of a value that is the angle or the length of a leader."""
        left, ends = (_range_words(each, slides) for each in (self.left, self.ends))
        return (
            f"its limits exclude those of {leader!r}, which it follows: they leave it {left}, its "
            f"own {ends}; left out"
        )


def _range_words(ends: Range, slides: bool) -> str:
    low, high = (end + 0.0 if slides else math.degrees(end) + 0.0 for end in ends)
    return f"{low:.6g} to {high:.6g} {'m' if slides else 'deg'}"


def narrowed(
    matrix: Array, offset: Array, values: tuple[Array, Array], joints: dict[int, Range]
) -> tuple[Array, Array, list[Clash]]:
    """Bounds of values, (n,) each, narrowed by those of joints that one value alone moves.

    In the order of ``joints``, which gives the bounds of each; one that leaves nothing is left out.
    """
    lower, upper, clashes = values[0].copy(), values[1].copy(), []
    for k, own in joints.items():
        moving = np.flatnonzero(matrix[k])
        if len(moving) != 1:
            continue
        v, factor = int(moving[0]), float(matrix[k, moving[0]])
        low, high = sorted((bound - float(offset[k])) / factor for bound in own)
        if max(lower[v], low) <= min(upper[v], high):
            lower[v], upper[v] = max(lower[v], low), min(upper[v], high)
        else:
            clashes.append(Clash(k, v, (low, high), (float(lower[v]), float(upper[v]))))
    return lower, upper, clashes


def value_ranges(rows: Sequence[DHRow], joints: JointMap) -> tuple[Array, Array]:
    """Bounds of the values q, (n,) each, infinite where there are none."""
    low, high = np.array([_ends(rows[i].lower, rows[i].upper) for i in joints.own]).T
    return low, high


def clashes_of(rows: Sequence[DHRow], joints: JointMap) -> list[Clash]:
    """Followers whose limits leave nothing of those of what they follow."""
    own = {i: _ends(row.lower, row.upper) for i, row in enumerate(rows) if row.mimic is not None}
    return narrowed(joints.matrix, joints.offset, value_ranges(rows, joints), own)[2]


def _ends(lower: float | None, upper: float | None) -> Range:
    return -math.inf if lower is None else lower, math.inf if upper is None else upper


def unlike(rows: Sequence[DHRow], i: int, j: int) -> bool:
    """Whether one of two joints slides and the other turns."""
    return len({rows[k].joint_type is JointType.PRISMATIC for k in (i, j)}) > 1
