"""Near misses: kept as given, named with their price, and set right on request."""

import math
import re

import numpy as np
import pinocchio as pin
import pytest
from axes import BOTH, chains, pose, screw_fk
from dh_product import dh_frames, difference
from example_robots import example, fk_between
from hypothesis import given, settings

from dh2urdf import extract_dh, load_table, urdf_text
from dh2urdf.conversions.assign.snap import _above
from dh2urdf.conversions.write.table_chain import dh_to_chain
from dh2urdf.transforms import pose_error

TIAGO = example("tiago_no_hand.urdf")
FOUR_DIGITS = """<robot name="rough">
  <link name="base"/><link name="one"/><link name="two"/><link name="three"/><link name="tool"/>
  <joint name="a" type="revolute"><parent link="base"/><child link="one"/>
    <origin xyz="0 0 0.5"/><axis xyz="0 0 1"/>
    <limit effort="1" velocity="1"/></joint>
  <joint name="b" type="revolute"><parent link="one"/><child link="two"/>
    <origin xyz="0.1 0 0" rpy="-1.5708 0 0"/><axis xyz="0 0 1"/>
    <limit effort="1" velocity="1"/></joint>
  <joint name="c" type="revolute"><parent link="two"/><child link="three"/>
    <origin xyz="0.6 0 0" rpy="3.1416 0 0"/><axis xyz="0 0 1"/>
    <limit effort="1" velocity="1"/></joint>
  <joint name="t" type="fixed"><parent link="three"/><child link="tool"/>
    <origin xyz="0.3 0 0" rpy="1.5708 0 0"/></joint>
</robot>
"""


def truth(q):
    """FK of the file as written, by Pinocchio."""
    model = pin.buildModelFromXML(FOUR_DIGITS.replace("<limit ", '<limit lower="0" upper="0" '))
    return fk_between(model, "base", "tool", dict(zip("abc", q, strict=True)))


@BOTH
def test_nothing_is_changed_unasked(convention):
    """1.5708 stays 1.5708, and the warning names it with the tolerance and the price."""
    found = extract_dh(FOUR_DIGITS, convention=convention)
    assert found.changes == ()
    assert found.max_error <= 1e-14
    assert any(abs(row.alpha) == 1.5708 for row in found.table.rows)
    (warning,) = [text for text in found.warnings if "nearly round" in text]
    assert "snap=1e-05" in warning
    price = float(re.search(r"at most ([\d.e-]+)", warning).group(1))
    assert 1e-6 < price < 3e-5


@BOTH
def test_snapping_rounds_angles_and_tells_the_price(convention):
    """With snap every angle is a multiple of pi / 2, and the measured price is the true one."""
    found = extract_dh(FOUR_DIGITS, convention=convention, snap=True)
    for row in found.table.rows:
        assert row.is_joint
        assert row.alpha in (0.0, math.pi / 2, -math.pi / 2, math.pi)
    assert [row.a for row in found.table.joints if row.a] != []
    assert found.changes
    rng = np.random.default_rng(8)
    qs = rng.uniform(-math.pi, math.pi, (200, 3))
    moved = max(pose_error(dh_frames(found.table, q)[-1], truth(q)) for q in qs)
    assert moved <= 1.5 * found.max_error
    assert found.max_error <= sum(change.cost for change in found.changes) <= 1e-4
    assert "set right: angle between a and b" in str(found)
    assert not [text for text in found.warnings if "nearly round" in text]


def test_the_offered_tolerance_is_enough():
    """What the warning offers sets right all that it names."""
    warning = next(text for text in extract_dh(TIAGO).warnings if "nearly round" in text)
    tolerance = float(re.search(r"snap=([\d.e-]+)", warning).group(1))
    found = extract_dh(TIAGO, snap=tolerance)
    again = extract_dh(dh_to_chain(found.table)).warnings
    assert not [text for text in again if "nearly round" in text]


@pytest.mark.parametrize(
    ("off", "offered"),
    [(1e-6, 2e-6), (1.9e-6, 2e-6), (2.1e-6, 5e-6), (4.9e-4, 5e-4), (5.1e-4, 1e-3), (0.3, 0.5)],
)
def test_the_offered_tolerance_is_the_next_round_one(off, offered):
    """The least of 1, 2 and 5 times powers of ten that is larger."""
    assert _above(off) == pytest.approx(offered, rel=1e-15)


@BOTH
@pytest.mark.parametrize("tilt", [10.0**-k for k in range(3, 13)])
def test_nearly_parallel_axes_are_merged_only_on_request(convention, tilt):
    """From a milliradian down to 1e-12: exact without snap, parallel with it."""
    links = [np.eye(4), pose((1, 2, 0), tilt, (0.4, 0, 0.1)), pose((1, 0, 0), 0.9, (0.3, 0, 0))]
    frames = [links[0], links[0] @ links[1], links[0] @ links[1] @ links[2]]
    exact = extract_dh(frames, convention=convention)
    assert exact.max_error <= 1e-13
    assert sum(not row.is_joint for row in exact.table.rows) == 1
    merged = extract_dh(frames, convention=convention, snap=2 * tilt)
    assert all(row.is_joint for row in merged.table.rows)
    assert merged.table.rows[0 if convention == "standard" else 1].alpha == 0
    assert 0.1 * tilt < merged.max_error < 3 * tilt
    assert merged.changes[0].cost <= 3 * tilt


@BOTH
def test_nearly_intersecting_axes_are_merged_only_on_request(convention):
    """A hundredth of a millimetre between two axes is a length, until it is asked away."""
    frames = [np.eye(4), pose((1, 0, 0), 1.0, (1e-5, 0, 0.2))]
    row = 0 if convention == "standard" else 1
    assert extract_dh(frames, convention=convention).table.rows[row].a == 1e-5
    merged = extract_dh(frames, convention=convention, snap=True)
    assert merged.table.rows[row].a == 0
    assert merged.max_error == pytest.approx(1e-5, rel=1e-6)


@BOTH
@settings(max_examples=60)
@given(chain=chains(max_joints=6))
def test_snapped_tables_differ_by_what_they_say(convention, chain):
    """max_error bounds what a snapped table differs by, at configurations of its own."""
    found = extract_dh(chain, convention=convention, snap=1e-3)
    total = sum(change.cost for change in found.changes)
    assert found.max_error <= total + 1e-9
    for q in np.random.default_rng(9).uniform(-1, 1, (5, chain.n)):
        frames = dh_frames(found.table, q)[-1]
        assert difference(frames, screw_fk(chain, q)) <= 4 * found.max_error + 1e-9


def test_steps_say_case_by_case_what_was_done():
    """Every frame has its step; the words name the case, the axes and the choice."""
    tool = pose((0, 0, 1), 0.4, (0.5, 0, 0.7))
    axes = [
        [[0, 0, 1], [0, 0, 0]],
        [[0, 1, 0], [0, 0, 0.3]],
        [[0, 1, 0], [0.4, 0, 0.3]],
        [[1, 0, 1], [0.4, 0.2, 0.5]],
        [[1, 0, 1], [0.5, 0.2, 0.6]],
    ]
    found = extract_dh(axes, tool=tool)
    assert [step.frame for step in found.steps] == [0, 1, 2, 3, 4, 5]
    told = (
        ("None", "frame 0 is the base frame"),
        ("intersecting", "Case 3: z_0 and z_1 intersect at o_1 = (0, 0, 0.3)"),
        ("parallel", "Case 2: z_1 and z_2 are parallel, 0.4 m apart"),
        ("skew", "Case 1: z_2 and z_3 are not coplanar"),
        ("collinear", "Cases 2 and 3 at once: z_3 and z_4 are one line"),
        ("None", "The tool transform takes up the rest"),
    )
    for step, (case, words) in zip(found.steps, told, strict=True):
        assert (str(step.case), words in str(step)) == (case, True)
    frames = dh_frames(found.table, np.zeros(5))
    for step, frame in zip(found.steps, frames, strict=False):
        assert step.origin == pytest.approx(frame[:3, 3], abs=1e-14)
        assert step.x == pytest.approx(frame[:3, 0], abs=1e-14)
        assert step.z == pytest.approx(frame[:3, 2], abs=1e-14)
    assert str(found.table) in found.explain()


def test_the_notes_arm_is_explained_like_the_notes():
    """The Denso: intersecting axes 1 and 2 as skew, the parallel elbow, the wrist in one point."""
    found = extract_dh(urdf_text(load_table("denso_vs6556")), embedded=False)
    cases = [str(step.case) for step in found.steps[1:6]]
    assert cases == ["skew", "parallel", "skew", "intersecting", "intersecting"]
    assert "it is frame 6" in found.steps[-1].text


@BOTH
def test_frames_are_explained_by_the_names_of_the_joints_on_their_axes(convention):
    """Standard frame i has the axis of joint i + 1, modified frame i that of joint i."""
    found = extract_dh(urdf_text(load_table("denso_vs6556")), embedded=False, convention=convention)
    names = [row.name for row in found.table.rows]
    assert len(set(names)) == 6
    for i, step in enumerate(found.steps[1:6], 1):
        joint = i + 1 if convention == "standard" else i
        assert f"is the axis of joint {joint} ({names[joint - 1]})." in step.text
