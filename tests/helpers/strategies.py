"""DH tables: random ones for Hypothesis, of every kind of row, and a calibrated one."""

import math
from dataclasses import replace

from dh_product import rows as numbers
from hypothesis import strategies as st

from dh2urdf.dh import DHConvention, DHRow, DHTable, JointType, Mimic, Origin

QUARTERS = st.sampled_from([0.0, math.pi / 2, -math.pi / 2, math.pi, -math.pi])
NEAR = st.sampled_from([1e-12, -1e-9, 1e-6, math.pi / 2 - 1e-9, 1.5708, math.pi - 1e-12])
ANGLES = st.one_of(QUARTERS, NEAR, st.floats(-math.pi, math.pi))
LENGTHS = st.one_of(st.just(0.0), st.floats(-1.0, 1.0), st.sampled_from([1e-9, 0.425, -0.39225]))
CELLS = st.tuples(ANGLES, LENGTHS, LENGTHS, ANGLES)


@st.composite
def origins(draw):
    """Any rigid step."""
    return Origin(
        (draw(LENGTHS), draw(LENGTHS), draw(LENGTHS)), (draw(ANGLES), draw(ANGLES), draw(ANGLES))
    )


@st.composite
def joints(draw):
    """A revolute or prismatic row with or without limits."""
    kind = draw(st.sampled_from([JointType.REVOLUTE, JointType.REVOLUTE, JointType.PRISMATIC]))
    limits = draw(st.one_of(st.none(), st.tuples(st.floats(-3, 0), st.floats(0, 3))))
    cells, sign = draw(CELLS), draw(st.sampled_from([1, -1]))
    lower, upper = limits or (None, None)
    return DHRow(*cells, kind, sign=sign, lower=lower, upper=upper)


@st.composite
def fixed_rows(draw):
    """A fixed row, by DH parameters or by inspection."""
    if draw(st.booleans()):
        return DHRow(joint_type=JointType.FIXED, origin=draw(origins()))
    return DHRow(*draw(CELLS), JointType.FIXED)


@st.composite
def tables(draw, max_joints=9):
    """A table of 1 to 9 joints, with base, tool and fixed rows now and then."""
    rows = []
    for row in draw(st.lists(joints(), min_size=1, max_size=max_joints)):
        if draw(st.integers(0, 5)) == 0:
            rows.append(draw(fixed_rows()))
        rows.append(row)
    if draw(st.integers(0, 5)) == 0:
        rows.append(draw(fixed_rows()))
    return DHTable(
        tuple(rows),
        draw(st.sampled_from(list(DHConvention))),
        name="random",
        base=draw(st.one_of(st.just(Origin()), origins())),
        tool=draw(st.one_of(st.just(Origin()), origins())),
    )


RATIOS = st.one_of(st.sampled_from([1.0, -1.0, 0.5, 2.0, -0.25]), st.floats(-2, 2))


@st.composite
def coupled_tables(draw, max_joints=7, square=False):
    """A table of which joints follow others or are coupled, or both; ``square`` without mimics."""
    table = draw(tables(max_joints).filter(lambda table: table.n > 1))
    names, rows, couplings = table.joint_names, list(table.rows), {}
    places = [i for i, row in enumerate(rows) if row.is_joint]
    order = draw(st.permutations(range(table.n)))
    leads = order[:1] if not square else order
    for k in order[1:]:
        way = draw(st.sampled_from(["own", "couplings"] + ["mimic"] * (not square)))
        if way == "mimic":
            row = replace(rows[places[k]], lower=None, upper=None)
            follows = Mimic(names[draw(st.sampled_from(order[: order.index(k)]))], draw(RATIOS))
            offset = draw(st.sampled_from([0.0, 0.25]))
            rows[places[k]] = replace(row, mimic=replace(follows, offset=offset))
            continue
        if way == "couplings":
            others = [i for i in (order[: order.index(k)] if square else leads) if i != k]
            some = draw(st.lists(st.sampled_from(others), min_size=1, max_size=2, unique=True))
            couplings[names[k]] = {names[i]: draw(RATIOS) for i in some}
        if not square:
            leads = [*leads, k]
    return replace(table, rows=tuple(rows), couplings=couplings)


def moved_joints(table, q):
    """Where the joints are at values q, by what mimic and couplings say, word by word."""
    values = iter(q)
    own = {
        n: next(values)
        for n, r in zip(table.joint_names, table.joints, strict=True)
        if r.mimic is None
    }
    mimics = {n: r.mimic for n, r in zip(table.joint_names, table.joints, strict=True) if r.mimic}

    def at(name):
        if name in mimics:
            return mimics[name].multiplier * at(mimics[name].joint) + mimics[name].offset
        others = table.couplings.get(name, {}).items()
        return own[name] + sum(ratio * own[other] for other, ratio in others)

    return [at(name) for name in table.joint_names]


def scaled(table, factor):
    """The table with every length multiplied, and without masses."""

    def step(origin):
        return origin and replace(origin, xyz=tuple(factor * x for x in origin.xyz))

    def row(r):
        slide = r.joint_type is JointType.PRISMATIC
        given = {k: getattr(r, k) for k in ("lower", "upper") if slide}
        bounds = {k: v * factor for k, v in given.items() if v is not None}
        lengths = {"a": r.a * factor, "d": r.d * factor, "origin": step(r.origin)}
        return replace(r, **lengths, **bounds, mass=None, com=None, inertia=None)

    rows = tuple(row(r) for r in table.rows)
    return replace(table, rows=rows, base=step(table.base), tool=step(table.tool))


FACTORY = DHTable.from_array(
    numbers(
        "2.1e-8 .127993 4.7e-5 1.5702; .3241 439.14072 .00411 9.19e-4;"
        "5.8731 -446.0268 .00237 -1.06e-3; .0859 7.050214 3.1e-5 1.5704;"
        "1.2e-6 .115792 -2.9e-5 -1.5712; 8.8e-7 .092143 0 0"
    ),
    "standard",
    name="calibrated",
)
"""A six-axis arm as a factory calibration writes it: d_2 and d_3 hundreds of metres long."""
