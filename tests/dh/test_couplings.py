"""Joints that follow others: what a table takes, what it refuses, and how q moves the joints."""

import pickle
from dataclasses import replace

import numpy as np
import pytest

from dh2urdf import DHRow, DHTable, Mimic
from dh2urdf.exceptions import TableError

ROWS = (DHRow(a=0.5, alpha=1.0), DHRow(a=0.4), DHRow(a=0.3, lower=-1.0, upper=2.0), DHRow(a=0.2))
SLIDE = DHRow(joint_type="prismatic", a=0.1)


def table(*mimics, couplings=(), rows=ROWS):
    """The rows, some of which follow: (row from 1, mimic)."""
    given = dict(mimics)
    made = (replace(row, mimic=given.get(i)) for i, row in enumerate(rows, 1))
    return DHTable(tuple(made), "standard", couplings=dict(couplings))


def test_a_table_without_either_has_no_map():
    """Where no joint follows another there is nothing to multiply."""
    assert table().joint_map is None


def test_chains_of_mimics_resolve_to_the_joint_that_leads():
    """q4 = 2 (3 q2 + 0.1) - 1, and the second joint is the second value."""
    found = table((3, Mimic("joint_2", 3.0, 0.1)), (4, Mimic("joint_3", 2.0, -1.0)))
    matrix, offset, own = found.joint_map
    assert own == (0, 1)
    assert matrix.tolist() == [[1, 0], [0, 1], [0, 3], [0, 6]]
    assert np.abs(offset - [0, 0, 0.1, -0.8]).max() < 1e-15


def test_a_follower_of_a_coupled_joint_follows_the_joint_itself():
    """Joint 4 is at minus the angle of joint 3, which is q3 + q2."""
    found = table((4, Mimic("joint_3", -1.0)), couplings={"joint_3": {"joint_2": 1.0}})
    assert found.joint_map.matrix.tolist() == [[1, 0, 0], [0, 1, 0], [0, 1, 1], [0, -1, -1]]


def test_the_range_of_a_coupled_joint_comes_out_of_the_bounds_of_q():
    """Half of +-1.5 added to -1 to 2, cut by the joint's own bounds."""
    rows = ROWS[0], replace(ROWS[1], lower=-1.5, upper=1.5), ROWS[2]
    couplings = {"joint_3": {"joint_2": -0.5}}
    assert table(couplings=couplings, rows=rows).joint_ranges[2] == (-1.75, 2.75)
    cut = (*rows[:2], replace(rows[2], serial_upper=1.0))
    assert table(couplings=couplings, rows=cut).joint_ranges[2] == (-1.75, 1.0)


def test_coupled_tables_are_values():
    """They compare, hash and pickle by what they say, and nobody changes it."""
    given = {"joint_3": {"joint_2": 1.0}}
    one, other = table(couplings=given), table(couplings=given)
    assert one == other
    assert hash(one) == hash(other)
    assert pickle.loads(pickle.dumps(one)) == one
    assert one != table()
    assert one != table((3, Mimic("joint_2")))
    given["joint_3"]["joint_2"] = 2.0
    assert one == other
    with pytest.raises(TypeError):
        one.couplings["joint_3"] = {}


REFUSED = {
    "itself": ([(3, Mimic("joint_3"))], {}, "joint_3.mimic.joint: 'joint_3' cannot follow itself"),
    "unknown": ([(3, Mimic("joint_9"))], {}, "joint_3.mimic.joint: no joint 'joint_9' to follow"),
    "circle": (
        [(2, Mimic("joint_3")), (3, Mimic("joint_2"))],
        {},
        "joint_2.mimic.joint: a circle: 'joint_2' follows 'joint_3' follows 'joint_2'",
    ),
    "both": (
        [(3, Mimic("joint_1"))],
        {"joint_3": {"joint_2": 1}},
        "joint_3.mimic: 'joint_3' has couplings, too; a joint has one of both",
    ),
    "coupled to itself": (
        [],
        {"joint_3": {"joint_3": 1}},
        "couplings.joint_3.joint_3: the joint's",
    ),
    "a sign before the name": (
        [(4, Mimic("-joint_1"))],
        {},
        "joint_4.mimic.joint: no joint '-joint_1' to follow; to turn against it write joint_1 -1",
    ),
    "coupled unknown": ([], {"joint_9": {"joint_3": 1}}, "couplings.joint_9: no joint 'joint_9'"),
    "coupled to unknown": ([], {"joint_3": {"elbow": 1}}, "couplings.joint_3.elbow: no joint"),
    "coupled to a follower": (
        [(4, Mimic("joint_1"))],
        {"joint_3": {"joint_4": 1}},
        "couplings.joint_3.joint_4: 'joint_4' has no value of its own, it follows 'joint_1'",
    ),
    "no inverse": (
        [],
        {"joint_3": {"joint_2": 1}, "joint_2": {"joint_3": 1}},
        "couplings: their matrix has no inverse",
    ),
    "no mapping": ([], {"joint_3": 1}, "couplings.joint_3: expected other joint: number, got 1"),
    "too large": (
        [],
        {"joint_3": {"joint_2": 1e9}},
        "couplings.joint_3.joint_2: expected a number",
    ),
    "no number": (
        [],
        {"joint_3": {"joint_2": "x"}},
        "couplings.joint_3.joint_2: expected a number",
    ),
}


@pytest.mark.parametrize("case", REFUSED)
def test_what_cannot_be_meant_is_refused_by_joint_key_and_value(case):
    """One message each, at the place where it stands."""
    mimics, couplings, says = REFUSED[case]
    with pytest.raises(TableError) as error:
        table(*mimics, couplings=couplings)
    assert len(error.value.problems) == 1
    assert str(error.value).startswith(says)


def test_all_faults_between_joints_are_told_at_once():
    """A file with two mistakes is mended in one go."""
    with pytest.raises(TableError) as error:
        table((2, Mimic("x")), (3, Mimic("y")), couplings={"joint_4": {"z": 1, "joint_3": 1}})
    assert len(error.value.problems) == 4


def test_serial_limits_are_for_coupled_joints():
    """Elsewhere they would be a second word for lower and upper."""
    rows = (replace(ROWS[0], serial_lower=-1.0), *ROWS[1:])
    with pytest.raises(
        TableError, match=r"joint_1\.serial_lower: only a joint that couplings names"
    ):
        table(rows=rows)
    assert table(couplings={"joint_1": {"joint_2": 1}}, rows=rows).joint_ranges[0][0] == -1.0


def test_serial_limits_that_leave_nothing_are_refused():
    """q allows the joint -1 to 2, and the joint itself 3 to 4."""
    rows = (*ROWS[:2], replace(ROWS[2], serial_lower=3.0, serial_upper=4.0))
    rows = (rows[0], replace(rows[1], lower=0, upper=0), rows[2])
    with pytest.raises(TableError, match=r"joint_3\.serial_lower: nothing is left"):
        table(couplings={"joint_3": {"joint_2": 1}}, rows=rows)


@pytest.mark.parametrize(
    ("mimic", "says"),
    [
        ({"multiplier": 1e9}, "mimic.multiplier: expected a number from -1e+06 to 1e+06"),
        ({"offset": float("nan")}, "mimic.offset: expected a number from"),
        ({"joint": 3}, "mimic.joint: expected a text"),
    ],
)
def test_a_mimic_has_a_name_and_two_numbers(mimic, says):
    """As a cell of a table has bounds."""
    with pytest.raises(TableError) as error:
        Mimic(**{"joint": "joint_1", **mimic})
    assert str(error.value).startswith(says)


def test_an_offset_is_an_angle_or_a_length_as_the_row_is():
    """A slide of a kilometre is none of a thousand kilometres of turns."""
    assert replace(SLIDE, mimic=Mimic("x", offset=1e6)).mimic.offset == 1e6
    with pytest.raises(TableError, match=r"mimic\.offset: expected a number from -100000"):
        DHRow(mimic=Mimic("x", offset=1e6))


def test_a_fixed_row_follows_nothing():
    """It does not move."""
    with pytest.raises(TableError, match=r"mimic: a fixed row has none"):
        DHRow(joint_type="fixed", mimic=Mimic("joint_1"))


def test_a_table_without_a_joint_that_is_followed_is_refused():
    """Rows that are taken away take along what others said of them."""
    whole = table((4, Mimic("joint_2")))
    with pytest.raises(TableError, match="no joint 'joint_2' to follow"):
        replace(whole, rows=(whole.rows[0], replace(whole.rows[3], name="x")))
