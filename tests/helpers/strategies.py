"""Random DH tables for Hypothesis: both conventions, signs, prismatic joints, fixed rows."""

import math

from hypothesis import strategies as st

from dh2urdf.dh import DHConvention, DHRow, DHTable, JointType, Origin

QUARTERS = st.sampled_from([0.0, math.pi / 2, -math.pi / 2, math.pi, -math.pi])
NEAR = st.sampled_from([1e-12, -1e-9, 1e-6, math.pi / 2 - 1e-9, 1.5708, math.pi - 1e-12])
ANGLES = st.one_of(QUARTERS, NEAR, st.floats(-math.pi, math.pi))
LENGTHS = st.one_of(st.just(0.0), st.floats(-1.0, 1.0), st.sampled_from([1e-9, 0.425, -0.39225]))


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
    return DHRow(
        theta=draw(ANGLES),
        d=draw(LENGTHS),
        a=draw(LENGTHS),
        alpha=draw(ANGLES),
        joint_type=kind,
        sign=draw(st.sampled_from([1, -1])),
        lower=None if limits is None else limits[0],
        upper=None if limits is None else limits[1],
    )


@st.composite
def fixed_rows(draw):
    """A fixed row, by DH parameters or by inspection."""
    if draw(st.booleans()):
        return DHRow(joint_type=JointType.FIXED, origin=draw(origins()))
    return DHRow(
        joint_type=JointType.FIXED,
        theta=draw(ANGLES),
        d=draw(LENGTHS),
        a=draw(LENGTHS),
        alpha=draw(ANGLES),
    )


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
