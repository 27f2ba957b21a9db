"""Arms whose joints are moved otherwise by the same values are different arms."""

from dataclasses import replace

import pytest
from coupled_arms import COUPLED, driven_palletiser, painter, palletiser, pendant

from dh2urdf import Mimic, Robot, compare, urdf_text
from dh2urdf.conversions.assign import to_convention


def with_mimic(table, i, mimic):
    """The table with another mimic in row i (from 1)."""
    rows = list(table.rows)
    rows[i - 1] = replace(rows[i - 1], mimic=mimic)
    return replace(table, rows=tuple(rows))


def quantities(found):
    """Row and quantity of each difference."""
    return [(one.row, one.quantity, one.a, one.b) for one in found.differences]


@pytest.mark.parametrize("name", COUPLED)
def test_an_arm_is_the_same_in_the_other_convention(name):
    """Frames are others, the values move the joints as before."""
    table = COUPLED[name]()
    assert compare(table, to_convention(table, "modified")).same


@pytest.mark.parametrize("table", [palletiser(), painter()])
def test_an_arm_is_the_same_as_its_file(table, written):
    """As a path, and as the robot of it."""
    path = written("arm.urdf", urdf_text(table))
    assert compare(table, path).same
    assert compare(table, Robot.from_urdf(path, tip="tool0")).same


@pytest.mark.parametrize("name", ["palletiser", "painter"])
def test_an_arm_is_the_same_with_joints_turned_round(name):
    """Directions of leader and follower; each is told, and the multiplier is the other one."""
    table = COUPLED[name]()
    i, lead = next((i, r.mimic.joint) for i, r in enumerate(table.joints, 1) if r.mimic)
    turned = with_mimic(table, i, Mimic(lead, 1.0))
    rows = list(turned.rows)
    rows[i - 1] = replace(rows[i - 1], sign=-1)
    found = compare(table, replace(turned, rows=tuple(rows)))
    assert found.same
    assert any(f"direction of joint {i}" in text for text in found.up_to)


def test_another_multiplier_is_named():
    """Half as far is no longer the same arm, though every joint is where it was."""
    found = compare(painter(), with_mimic(painter(), 6, Mimic("joint_5", -0.5)))
    assert not found.same
    assert quantities(found) == [(6, "multiplier", "-1", "-0.5")]
    assert "row 6: multiplier -1 in A, -0.5 in B" in str(found)


def test_another_offset_is_named_where_no_zero_makes_up_for_it():
    """The zero of the joint itself would, and is said instead."""
    found = compare(painter(), with_mimic(painter(), 6, Mimic("joint_5", -1.0, 0.1)))
    assert quantities(found) == [(6, "offset", "0", "0.1")]
    assert not found.same


def test_a_joint_that_moves_on_its_own_is_named():
    """Seven values are not six."""
    found = compare(painter(), with_mimic(painter(), 6, None))
    assert not found.same
    assert quantities(found) == [(6, "mimic", "joint_5 with multiplier -1", "none")]


def test_another_leader_is_named():
    """The follower of joint 4 is another arm than that of joint 5."""
    found = compare(painter(), with_mimic(painter(), 6, Mimic("joint_4", -1.0)))
    assert [one.quantity for one in found.differences] == ["mimic"]


@pytest.mark.parametrize("ratio", [0.0, 0.5, -1.0])
def test_another_coupling_is_named(ratio):
    """The pendant's angles against the serial ones, and against another ratio."""
    found = compare(pendant(), pendant(ratio) if ratio else replace(pendant(), couplings={}))
    assert not found.same
    (one,) = found.differences
    assert (one.row, one.quantity, one.a) == (3, "coupling", "q3 + q2")


def test_what_follows_from_a_coupling_is_not_told_twice():
    """The level joint follows J3 in both tables; that J3 is coupled in one is the difference."""
    found = compare(driven_palletiser(), palletiser())
    assert quantities(found) == [(3, "coupling", "q3 - q2", "q3")]


def test_lengths_are_told_beside_couplings():
    """Both are wrong, and both are in the list."""
    other = with_mimic(painter(), 6, Mimic("joint_5", 1.0))
    rows = list(other.rows)
    rows[1] = replace(rows[1], a=1.1)
    found = compare(painter(), replace(other, rows=tuple(rows)))
    assert [one.quantity for one in found.differences] == ["multiplier", "a"]
