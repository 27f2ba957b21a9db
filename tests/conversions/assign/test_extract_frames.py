"""Frame assignment from any axes, by the rules of the notes and exactly."""

import math

import numpy as np
import pytest
from axes import BOTH, chains, line_distance, pose, screw_fk
from dh_product import dh_frames, difference, rows
from hypothesis import given, settings
from hypothesis import strategies as st
from strategies import FACTORY, tables

from dh2urdf import extract_dh, urdf_text
from dh2urdf.chain import SerialChain
from dh2urdf.conversions.assign.assigned_table import chain_to_dh
from dh2urdf.conversions.assign.axis_pairs import AxisCase
from dh2urdf.conversions.assign.frame_assignment import FAR, references
from dh2urdf.conversions.write.table_chain import dh_to_chain
from dh2urdf.conversions.write.urdf_elements import UrdfOptions
from dh2urdf.dh import DHConvention, JointType

ALLOWED = 1e-10
EYE = np.eye(4)


def configurations(n, count=4):
    return np.random.default_rng(7).uniform(-math.pi, math.pi, (count, n))


@BOTH
@settings(max_examples=250)
@given(chain=chains())
def test_the_table_is_the_same_arm(convention, chain):
    """Its DH product equals Pinocchio's product of exponentials at the same q, within 1e-10."""
    table = chain_to_dh(chain, convention).table
    for q in configurations(chain.n):
        assert difference(dh_frames(table, q)[-1], screw_fk(chain, q)) <= ALLOWED


@BOTH
@settings(max_examples=80)
@given(chain=chains(revolute_only=True))
def test_every_z_lies_on_its_joint(convention, chain):
    """z of each frame is the line of its joint's axis and points along it.

    A modified frame is taken before its fixed row, which the tables count to the frame.
    """
    found = chain_to_dh(chain, convention)
    frames = dh_frames(found.table, np.zeros(chain.n))
    first = 0 if convention == DHConvention.STANDARD else 1
    if first:
        for i, normal in enumerate(found.assignment.normals, 1):
            frames[i] = frames[i] @ pose((0, 1, 0), -normal.beta, (0, 0, 0))
    for axis, point, frame in zip(chain.axes, chain.points, frames[first:], strict=False):
        offset, sine = line_distance(point, axis, frame[:3, 3], frame[:3, 2])
        assert offset <= ALLOWED
        assert sine <= ALLOWED
        assert axis @ frame[:3, 2] > 0


@BOTH
@settings(max_examples=80)
@given(chain=chains())
def test_compact_tables_stay_at_the_arm(convention, chain):
    """No length exceeds what twenty arm's lengths on either side of an axis allow."""
    assigned = chain_to_dh(chain, convention)
    reach = references(assigned.links).size + np.abs(chain.points).max() + 1.0
    lengths = [abs(v) for row in assigned.table.rows for v in (row.a, row.d)]
    assert max(lengths) <= 4 * FAR * reach


@BOTH
@settings(max_examples=80)
@given(chain=chains(), data=st.data())
def test_turned_z_axes_keep_q(convention, chain, data):
    """A row with sign -1 has its z reversed and still takes the source's q."""
    signs = data.draw(st.lists(st.sampled_from([1, -1]), min_size=chain.n, max_size=chain.n))
    table = chain_to_dh(chain, convention, signs=signs).table
    assert [row.sign for row in table.joints] == signs
    q = configurations(chain.n)[0]
    assert difference(dh_frames(table, q)[-1], screw_fk(chain, q)) <= ALLOWED


@BOTH
@settings(max_examples=80)
@given(chain=chains())
def test_x_away_keeps_lengths_positive(convention, chain):
    """With x away from the axis before it, as in the notes, no common normal is negative."""
    found = chain_to_dh(chain, convention, x_rule="away")
    assert all(normal.a >= 0 for normal in found.assignment.normals)
    q = configurations(chain.n)[0]
    assert difference(dh_frames(found.table, q)[-1], screw_fk(chain, q)) <= ALLOWED


@BOTH
@settings(max_examples=80)
@given(table=tables())
def test_any_table_goes_round(convention, table):
    """Table -> chain -> table is the same arm, fixed rows, signs and all, in either convention."""
    again = chain_to_dh(dh_to_chain(table), convention).table
    for q in configurations(table.n, 2):
        assert difference(dh_frames(again, q)[-1], dh_frames(table, q)[-1]) <= ALLOWED


def chain_of(*links, slides=()):
    """A chain of these links, the first before joint 1, the last after joint n."""
    n = len(links) - 1
    kinds = (JointType.PRISMATIC if i in slides else JointType.REVOLUTE for i in range(n))
    far = np.full(n, 3.0)
    return SerialChain(np.stack(links), tuple(kinds), tuple("abcd"[:n]), -far, far)


def two_axes(link, base=EYE, tool=EYE):
    return chain_of(base, link, tool)


CASES = {
    "skew": (pose((1, 0, 0), 0.7, (0.3, 0, 0)), AxisCase.SKEW, 0.3, 0.7),
    "parallel": (pose((1, 0, 0), 0.0, (0.3, 0, 0.2)), AxisCase.PARALLEL, 0.3, 0.0),
    "antiparallel": (pose((1, 0, 0), math.pi, (0.3, 0, 0)), AxisCase.PARALLEL, 0.3, math.pi),
    "intersecting": (pose((1, 0, 0), 0.7, (0, 0, 0.4)), AxisCase.INTERSECTING, 0.0, 0.7),
    "collinear": (pose((0, 0, 1), 0.3, (0, 0, 0.4)), AxisCase.COLLINEAR, 0.0, 0.0),
    "anticollinear": (pose((1, 0, 0), math.pi, (0, 0, 0.4)), AxisCase.COLLINEAR, 0.0, math.pi),
}


@BOTH
@pytest.mark.parametrize("name", CASES)
def test_each_case_by_its_rule(convention, name):
    """Each case of two axes is told apart and gets the length and twist that it has."""
    link, case, a, alpha = CASES[name]
    found = chain_to_dh(two_axes(link), convention)
    assert found.assignment.pairs[0].case is case
    row = found.table.rows[0 if convention == DHConvention.STANDARD else 1]
    assert row.a == pytest.approx(a, abs=1e-15)
    assert abs(row.alpha) == pytest.approx(alpha, abs=1e-15)


@BOTH
def test_skew_axes_take_the_only_common_normal(convention):
    """x lies along the shortest segment between skew axes and points from the first on."""
    chain = two_axes(pose((1, 1, 0), 1.1, (0.2, 0.5, 0.3)))
    found = chain_to_dh(chain, convention)
    frames = dh_frames(found.table, np.zeros(2))
    frame = frames[1]
    (p1, p2), (z1, z2) = chain.points, chain.axes
    normal = np.cross(z1, z2) / np.linalg.norm(np.cross(z1, z2))
    way = normal * (normal @ (p2 - p1))
    assert frame[:3, 0] == pytest.approx(way / np.linalg.norm(way), abs=1e-14)
    assert found.assignment.normals[0].a == pytest.approx(np.linalg.norm(way), abs=1e-14)


@BOTH
def test_parallel_axes_take_d_zero(convention):
    """Of the common normals of parallel axes, the one with d = 0 is taken."""
    first, second = pose((1, 0, 0), math.pi / 2, (0, 0, 0.4)), pose((1, 0, 0), 0.0, (0.3, 0, 0.7))
    chain = chain_of(EYE, first, second, pose((1, 0, 0), 0.0, (0.2, 0.1, -0.4)), EYE)
    table = chain_to_dh(chain, convention).table
    assert table.rows[1].d == 0
    assert table.rows[2].d == 0


def test_the_base_frame_is_kept_where_z0_is_its_z():
    """Frame 0 is the base frame when joint 1 turns about the base's z axis."""
    base = pose((0, 0, 1), 0.3, (0, 0, 0.5))
    table = chain_to_dh(two_axes(CASES["skew"][0], base=base)).table
    assert table.base.is_identity
    beside = chain_to_dh(two_axes(CASES["skew"][0], base=pose((0, 0, 1), 0.3, (1, 2, 0.5)))).table
    assert beside.base.xyz == (1.0, 2.0, 0.0)
    assert beside.base.rpy == (0.0, 0.0, 0.0)


def test_a_tool_in_reach_of_four_motions_is_frame_n():
    """Base and tool take up nothing that the rows can express."""
    tool = pose((0, 0, 1), 0.4, (0, 0, 0.2)) @ pose((1, 0, 0), 0.9, (0.1, 0, 0))
    table = chain_to_dh(two_axes(CASES["skew"][0], tool=tool)).table
    assert table.tool.is_identity


@BOTH
def test_the_modified_base_takes_a_twist_into_its_row(convention):
    """Modified rows begin with a and alpha: a turn about the base's x needs no base transform."""
    base = pose((1, 0, 0), -math.pi / 2, (0.1, 0, 0))
    table = chain_to_dh(two_axes(CASES["skew"][0], base=base), convention).table
    assert table.base.is_identity == (convention == DHConvention.MODIFIED)


def test_a_sliding_axis_goes_where_lengths_vanish():
    """A slide whose file puts it off the arm's axes is drawn through them: three lengths less."""
    places = ((0.375, 0, 0), (0.31, 0.07, 0.1), (-0.035, -0.07, 0))
    chain = chain_of(EYE, *(pose((1, 0, 0), 0.0, place) for place in places), EYE, slides=(2,))
    found = chain_to_dh(chain)
    assert [row.a for row in found.table.joints] == pytest.approx([0.375, 0.275, 0, 0], abs=1e-15)


CALIBRATED = (
    "0 0 1 0 0 0; 0 1 0 -.1 0 0; 1e-3 1 2e-3 -.1 0 .4; 0 1 0 -.1 0 .8; 0 0 1 0 -.8 0; 0 1 0 .1 0 .8"
)


def calibrated():
    """Screws with a nearly parallel pair, made pitch-free."""
    screws = np.array(rows(CALIBRATED))
    for screw in screws:
        omega = screw[:3]
        screw[3:] -= omega * (omega @ screw[3:]) / (omega @ omega)
    return screws


@BOTH
def test_calibrated_arms_are_compact_and_exact(convention):
    """A milliradian between parallel axes makes a fixed row, and no length beyond the arm."""
    found = extract_dh(
        calibrated(), tool=pose((0, 0, 1), 0.0, (0.8, 0.2, 0)), convention=convention
    )
    fixed = [row for row in found.table.rows if not row.is_joint]
    assert fixed
    assert found.max_error <= 1e-14
    assert max(abs(v) for row in found.table.rows for v in (row.a, row.d)) < 2.0
    assert any("from parallel" in step.text for step in found.steps)


@BOTH
def test_four_parameters_are_kept_on_request(convention):
    """Without compacting the same arm has four parameters a row and lengths of many metres."""
    tool = pose((0, 0, 1), 0.0, (0.8, 0.2, 0))
    found = extract_dh(calibrated(), tool=tool, convention=convention, compact=False)
    assert all(row.is_joint for row in found.table.rows)
    assert max(abs(row.d) for row in found.table.rows) > 50
    assert found.max_error <= 1e-11


@BOTH
def test_factory_calibrations_come_home(convention):
    """From joint origins 439 m away to a table without a length above the arm's two metres."""
    text = urdf_text(FACTORY, UrdfOptions(embed_table=False))
    found = extract_dh(text, convention=convention)
    assert max(abs(v) for row in found.table.rows for v in (row.a, row.d)) < 2.0
    assert max(abs(v) for v in (*found.table.base.xyz, *found.table.tool.xyz)) < 2.0
    for q in configurations(6):
        assert difference(dh_frames(found.table, q)[-1], dh_frames(FACTORY, q)[-1]) <= 1e-12
    assert any("far away" in warning for warning in found.warnings)
