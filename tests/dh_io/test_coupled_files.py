"""``mimic`` and ``couplings`` in files: read in their units, refused at their place."""

import math

import pytest

from dh2urdf import Mimic
from dh2urdf.dh_io import parse_table, table_to_text
from dh2urdf.exceptions import TableFileError

HEAD = "convention: standard\nunits: {length: mm, angle: deg}\n"
PLAIN = "  - {theta: 0, d: 0, a: 100, alpha: 0}\n"
SLIDE = "  - {type: prismatic, name: slide, theta: 0, d: 0, a: 100, alpha: 0}\n"


def row(mimic):
    return f"  - {{theta: 0, d: 0, a: 100, alpha: 0, mimic: {mimic}}}\n"


def parsed(*rows, head=""):
    return parse_table(f"{HEAD}{head}joints:\n{''.join(rows)}", "yaml", "arm.yaml").table


@pytest.mark.parametrize(
    "text", ["{joint: joint_1, multiplier: -1, offset: 90}", "joint_1 -1 90", "joint_1 -1 pi/2"]
)
def test_a_mimic_is_read_in_the_units_of_the_file(text):
    """Offsets of a joint that turns are angles; keys or words say the same."""
    assert parsed(PLAIN, row(text)).rows[1].mimic == Mimic("joint_1", -1.0, math.pi / 2)


def test_a_multiplier_and_an_offset_may_be_left_out():
    """They are 1 and 0 as in a URDF."""
    assert parsed(PLAIN, row("{joint: joint_1}")).rows[1].mimic == Mimic("joint_1")


def test_a_multiplier_between_a_turn_and_a_slide_says_its_units():
    """0.5 mm a degree is 0.0286 m a radian."""
    table = parsed(SLIDE, row("{joint: slide, multiplier: 2 deg/mm, offset: 5}"))
    assert table.rows[1].mimic.multiplier == pytest.approx(2 * math.pi / 180 * 1000, rel=1e-15)
    for format in ("yaml", "toml", "json", "csv", "markdown"):
        assert parse_table(table_to_text(table, format), format).table == table


def test_couplings_add_other_values():
    """Names of joints, then numbers."""
    table = parsed(PLAIN, PLAIN, PLAIN, head="couplings: {joint_3: {joint_2: 1, joint_1: -1/2}}\n")
    assert table.couplings == {"joint_3": {"joint_2": 1.0, "joint_1": -0.5}}


@pytest.mark.parametrize("text", ['{"joint_2": {"joint_1": 2}}', "{joint_2: {joint_1: 2}}"])
def test_a_spreadsheet_has_couplings_in_a_line_of_its_own(text):
    """Behind a #, in braces."""
    csv = f"# convention: standard\n# units: mm, deg\n# couplings: {text}\ntheta,d,a,alpha,mimic\n"
    table = parse_table(csv + "0,0,1,0,\n0,0,1,0,\n0,0,1,0,joint_1 -1\n", "csv").table
    assert table.couplings == {"joint_2": {"joint_1": 2.0}}
    assert table.rows[2].mimic == Mimic("joint_1", -1.0)


FAULTS = {
    "bare ratio": (
        [SLIDE, row("{joint: slide, multiplier: 0.5}")],
        "arm.yaml:5:74: joints[2].mimic.multiplier: found 0.5; one of the joints slides, the other "
        "turns: write the units, as in 0.5 rad/m",
    ),
    "upside down": (
        [SLIDE, row("{joint: slide, multiplier: 0.5 m/rad}")],
        "joints[2].mimic.multiplier: found '0.5 m/rad'; one of the joints slides",
    ),
    "left out between kinds": (
        [SLIDE, row("slide")],
        "joints[2].mimic.multiplier: one of the joints",
    ),
    "units between equals": (
        [PLAIN, row("joint_1 2m/rad")],
        "joints[2].mimic.multiplier: found '2m/rad'; both joints move alike: write a plain number",
    ),
    "misspelt": ([PLAIN, row("{jont: joint_1}")], "joints[2].mimic.jont: unknown key 'jont'"),
    "no joint": ([PLAIN, row("{multiplier: 2}")], "joints[2].mimic.joint: missing"),
    "unknown": ([PLAIN, row("joint_7")], "joints[2].mimic.joint: no joint 'joint_7' to follow"),
    "itself": ([PLAIN, row("joint_2")], "joints[2].mimic.joint: 'joint_2' cannot follow itself"),
    "no number": (
        [PLAIN, row("joint_1 abc")],
        "joints[2].mimic.multiplier: found 'abc'; 'abc' has",
    ),
    "too many": ([PLAIN, row("joint_1 1 0 3")], "joints[2].mimic: found 'joint_1 1 0 3'; expected"),
    "too large": (
        [PLAIN, row("joint_1 1e7")],
        "joints[2].mimic.multiplier: found 1e7; expected a number from -1e+06 to 1e+06",
    ),
    "a list": ([PLAIN, row("[joint_1, 2]")], "joints[2].mimic: found a list; expected the keys"),
    "misspelt key": (
        [PLAIN, "  - {theta: 0, d: 0, a: 0, alpha: 0, mimik: joint_1}\n"],
        "joints[2].mimik: unknown key 'mimik'",
    ),
}


@pytest.mark.parametrize("case", FAULTS)
def test_faults_are_told_at_their_place(case):
    """One message, with line, column, row, key and what was found."""
    rows, says = FAULTS[case]
    with pytest.raises(TableFileError) as error:
        parsed(*rows)
    assert len(error.value.problems) == 1
    assert says in str(error.value)


COUPLED = {
    "{joint_3: 1}": "couplings.joint_3: found 1; expected other joint: number",
    "joint_3": "couplings: found 'joint_3'; expected joint: {other joint: number}",
    "{joint_3: {joint_3: 1}}": "couplings.joint_3.joint_3: the joint's own value counts once",
    "{joint_3: {joint_2: x}}": "couplings.joint_3.joint_2: found 'x'",
    "{joint_3: {joint_2: 1e9}}": "couplings.joint_3.joint_2: found 1e9; expected a number from",
    "{elbow: {joint_2: 1}}": "arm.yaml:3:13: couplings.elbow: no joint 'elbow'; there are joint_1",
    "{joint_3: {joint_2: 1}, joint_2: {joint_3: 1}}": "couplings: their matrix has no inverse",
}


@pytest.mark.parametrize("text", COUPLED)
def test_faults_of_couplings_are_told_at_their_place(text):
    """As those of cells."""
    with pytest.raises(TableFileError) as error:
        parsed(PLAIN, PLAIN, PLAIN, head=f"couplings: {text}\n")
    assert len(error.value.problems) == 1
    assert COUPLED[text] in str(error.value)


def test_faults_of_cells_and_between_joints_are_told_at_once():
    """A wrong cell does not hide that a joint follows nobody."""
    wrong = "  - {theta: 0, d: 0, a: 9O, alpha: 0, name: bad}\n"
    with pytest.raises(TableFileError) as error:
        parsed(wrong, row("elbow"), row("bad"), head="couplings: {x: {bad: 1}}\n")
    assert [p.split(": ")[1] for p in error.value.problems] == [
        "couplings.x",
        "joints[1].a",
        "joints[2].mimic.joint",
    ]
