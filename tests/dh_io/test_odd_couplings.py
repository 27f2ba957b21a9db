"""What files say between joints and probably do not mean is told, with what to write instead."""

import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dh2urdf import DHRow, DHTable, Mimic, Robot
from dh2urdf.dh_io import parse_table
from dh2urdf.dh_io.near_misses import near_misses
from dh2urdf.exceptions import TableError

HEAD = "convention: standard\nunits: {length: m, angle: rad}\n"
STEP = "d: 0.1, a: 0.3, alpha: 1"


def text(rows, head=""):
    """A YAML table of rows, what a row says beside its lengths."""
    return HEAD + head + "joints:\n" + "".join(f"  - {{{row}, {STEP}}}\n" for row in rows)


def warned(rows, head=""):
    """Warnings at a table file."""
    return parse_table(text(rows, head), "yaml", "arm.yaml").warnings


PLAIN = ["theta: 0"] * 6


def test_limits_of_a_follower_that_exclude_those_of_its_leader_are_told_with_their_line():
    rows = [*PLAIN[:4], "theta: 0, lower: 1, upper: 2",
            "theta: 0, lower: 0, upper: 0.5, mimic: joint_5 -1"]  # fmt: skip
    (warning,) = warned(rows)
    assert warning.startswith("arm.yaml:9:")
    assert "joints[6].mimic: its limits exclude those of 'joint_5', which it follows" in warning
    assert "they leave it -28.6479 to 0 deg, its own 57.2958 to 114.592 deg" in warning


@pytest.mark.parametrize(
    ("rows", "head", "message"),
    [
        ([*PLAIN, "theta: 0, mimic: joint_2 0"], "", "joints[7].mimic.multiplier: 0: the joint"),
        (PLAIN, "couplings: {joint_3: {joint_2: 0}}\n", "couplings.joint_3.joint_2: 0: it adds"),
        (
            PLAIN,
            "couplings: {joint_3: {joint_2: 1}, joint_2: {joint_3: 0.9999}}\n",
            "couplings: a turn of a joint is up to 4.0e+04 turns of q",
        ),
    ],
)
def test_what_joints_say_of_nothing_is_told(rows, head, message):
    (warning,) = warned(rows, head)
    assert message in warning


def test_couplings_that_hardly_have_an_inverse_are_refused_with_their_number():
    head = "couplings: {joint_3: {joint_2: 1}, joint_2: {joint_3: 0.99999999}}\n"
    with pytest.raises(TableError, match=r"hardly an inverse: a turn of a joint would be 4.0e\+08"):
        parse_table(text(PLAIN, head), "yaml", "arm.yaml")


def test_couplings_that_are_taken_have_solutions_to_a_residual_of_1e_9():
    """Just below the bound values are hundreds of thousands of radians."""
    rows = tuple(DHRow(a=0.3, d=0.1, alpha=1.0) for _ in range(6))
    couplings = {"joint_3": {"joint_2": 1.0}, "joint_2": {"joint_3": 0.999995}}
    robot = Robot.from_dh(DHTable(rows, "standard", couplings=couplings))
    found = robot.ik(robot.fk(np.full(6, 0.3)))
    assert len(found)
    assert (found.residual < 1e-9).all()


def test_a_steep_thread_is_no_singular_coupling():
    """A millimetre a turn: the matrix mixes units, and its inverse is exact."""
    rows = (DHRow(a=0.3), DHRow(a=0.2), DHRow(joint_type="prismatic"), DHRow())
    couplings = {"joint_4": {"joint_3": 6283.0}}
    table = DHTable(rows, "standard", couplings=couplings)
    assert not near_misses(table)


HINTS = {
    "q3 - q2": "write theta: q3, and for the whole table couplings: {joint_3: {joint_2: -1}}",
    "-q3 + 0.5*q1 - pi/2": "write theta: -q3 - pi/2, and for the whole table couplings: "
    "{joint_3: {joint_1: -0.5}}",
    "-q2": "where the joint follows joint_2, write theta: 0 and mimic: joint_2 -1",
    "q2 + pi/2": "where the joint follows joint_2, write theta: pi/2 and mimic: joint_2 1",
    "q1 + q2": "a joint follows one other (mimic), or adds others to a value of its own",
    "d2": "d2 is a constant with constants: {d2: 0.4}",
}


@pytest.mark.parametrize("cell", HINTS)
def test_a_cell_with_other_joints_variables_says_how_to_write_that(cell):
    with pytest.raises(TableError) as error:
        parse_table(text([*PLAIN[:2], f"theta: {cell}"]), "yaml", "arm.yaml")
    assert HINTS[cell] in str(error.value)


FORMATS = {
    "toml": (
        'convention = "standard"\nunits = {length = "m", angle = "rad"}\n'
        "joints = [{theta = 0, d = 0, a = 1, alpha = 0},"
        ' {theta = "q2 - q1", d = 0, a = 1, alpha = 0}]',
        'write theta = "q2", and for the whole table couplings = {joint_2 = {joint_1 = -1}}',
    ),
    "json": (
        '{"convention": "standard", "units": {"length": "m", "angle": "rad"}, "joints": ['
        '{"theta": 0, "d": 0, "a": 1, "alpha": 0}, {"theta": "-q1", "d": 0, "a": 1, "alpha": 0}]}',
        'write "theta": 0 and "mimic": "joint_1 -1"',
    ),
}


@pytest.mark.parametrize("format", FORMATS)
def test_the_hint_is_in_the_words_of_the_format(format):
    given, hint = FORMATS[format]
    with pytest.raises(TableError) as error:
        parse_table(given, format, f"arm.{format}")
    assert hint in str(error.value)


RATIO = st.sampled_from([1, -1, 0.5, -2])
TERMS = st.dictionaries(st.integers(1, 2), RATIO, max_size=2)


@settings(max_examples=50, deadline=None)
@given(TERMS, st.sampled_from(["", "-"]), st.sampled_from(["", " + 0.3", " - pi/2"]))
def test_a_table_written_as_the_hint_says_is_the_arm_that_the_cell_meant(terms, own, constant):
    """Joint 3 at ``own q3 + terms + constant``: the frames are those of the sum."""
    sums = "".join(f" {'-' if c < 0 else '+'} {abs(c):g}*q{i}" for i, c in terms.items())
    try:
        table = parse_table(text([*PLAIN[:2], f"theta: {own}q3{sums}{constant}"]), "yaml").table
        assert not terms
    except TableError as error:
        hint = re.search(r"write theta: (.*), and for the whole table (couplings: .*)", str(error))
        assert hint is not None
        table = parse_table(text([*PLAIN[:2], f"theta: {hint[1]}"], hint[2] + "\n"), "yaml").table
    q = np.array([0.3, -0.4, 0.7])
    turned = (-q[2] if own else q[2]) + sum(c * q[i - 1] for i, c in terms.items())
    turned += {"": 0.0, " + 0.3": 0.3, " - pi/2": -np.pi / 2}[constant]
    rows = (*(DHRow(d=0.1, a=0.3, alpha=1.0) for _ in range(3)),)
    expected = DHTable(rows, "standard").fk([q[0], q[1], turned])
    assert np.abs(Robot.from_dh(table).fk(q) - expected).max() < 1e-12


def test_a_follower_in_a_table_from_python_warns_where_a_robot_is_made():
    rows = [DHRow(a=0.3, alpha=1.0, lower=1.0, upper=2.0) for _ in range(5)]
    rows.append(DHRow(a=0.1, lower=0.0, upper=0.5, mimic=Mimic("joint_5", -1.0)))
    (warning,) = Robot.from_dh(DHTable(tuple(rows), "standard")).warnings
    assert warning.startswith("joint 'joint_6': its limits exclude those of 'joint_5'")
