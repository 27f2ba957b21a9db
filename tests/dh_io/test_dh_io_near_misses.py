"""What is allowed and probably not meant is told, with its place, and left as it is."""

import math
from decimal import Decimal
from pathlib import Path

import pytest

from dh2urdf import DHConvention, DHRow, DHTable
from dh2urdf.dh_io import near_misses, parse_table, read_table
from dh2urdf.dh_io.near_misses import rounded_pi
from dh2urdf.exceptions import TableFileError


def warnings(*rows: str, units: str = "m, angle: rad", convention: str = "standard") -> list[str]:
    """Warnings of YAML rows, without the file's name."""
    head = f"convention: {convention}\nunits: {{length: {units}}}\njoints:\n"
    text = head + "".join(f"  - {row}\n" for row in rows)
    return [w.removeprefix("arm.yaml:") for w in parse_table(text, "yaml", "arm.yaml").warnings]


@pytest.mark.parametrize(
    ("typed", "meant"),
    [
        ("1.57", "pi/2"),
        ("1.571", "pi/2"),
        ("1.5707", "pi/2"),
        ("1.5708", "pi/2"),
        ("-1.570796", "-pi/2"),
        ("1.57079633", "pi/2"),
        ("1.5707963268", "pi/2"),
        ("3.14", "pi"),
        ("3.14159", "pi"),
        ("-3.1416", "-pi"),
        ("0.785", "pi/4"),
        ("0.7854", "pi/4"),
        ("1.0472", "pi/3"),
        ("-2.0944", "-2*pi/3"),
        ("0.5236", "pi/6"),
        ("0.2618", "pi/12"),
        ("4.7124", "3*pi/2"),
        ("6.2832", "2*pi"),
    ],
)
def test_a_rounded_multiple_of_pi_is_told(typed: str, meant: str) -> None:
    """The warning names the multiple, and the table keeps the number as it stands."""
    (found,) = warnings(f"{{theta: {typed}, d: 0, a: 1, alpha: 0}}")
    assert found.startswith(f"4:13: joints[1].theta: {typed} is {meant} rounded, off by ")
    assert found.endswith(f"; write {meant}")


@pytest.mark.parametrize(
    "typed",
    ["1.5", "1.6", "1.58", "1.5709", "1.5710", "0.52", "1.05", "0.8", "0", "1.5707963267948966",
     "3.141592653589793", "pi/2", "90deg", "0.7853981633974483", "1.4923"],
)  # fmt: skip
def test_other_angles_are_not_told(typed: str) -> None:
    """Exact values, expressions and numbers that no multiple of pi rounds to give no warning."""
    assert warnings(f"{{theta: {typed}, d: 0, a: 1, alpha: 0}}") == []


def test_one_number_in_twenty_at_most_is_near_pi_by_chance() -> None:
    """Of all numbers of two, three and four decimals in a turn, few are taken for pi."""
    for decimals in (2, 3, 4):
        whole = range(1, 628 * 10 ** (decimals - 2))
        near = sum(rounded_pi(Decimal(n).scaleb(-decimals)) is not None for n in whole)
        assert near / len(whole) < 0.05


@pytest.mark.parametrize(
    ("cells", "units", "place", "says"),
    [
        ("theta: 0, d: 335, a: 75, alpha: 0", "m, angle: deg", "d", "335 m is longer than 10 m"),
        ("theta: 0, d: 1, a: 11, alpha: 0", "m, angle: deg", "a", "millimetres?"),
        ("theta: 0, d: 0, a: 20000, alpha: 0", "mm, angle: deg", "a", "really mm?"),
        ("theta: 0, d: 0.335, a: 0.2, alpha: 0", "mm, angle: deg", "d", "metres meant?"),
        ("theta: 90, d: 0, a: 1, alpha: 0", "m, angle: rad", "theta", "90 rad is more than a full"),
        ("theta: 0, d: 0, a: 1, alpha: -90", "m, angle: rad", "alpha", "degrees meant?"),
        ("theta: 0, d: 0, a: 1, alpha: 1.5708", "m, angle: deg", "alpha", "radians meant?"),
        ("theta: 0, d: 0, a: 1, alpha: 0, lower: -170", "m, angle: rad", "lower", "two turns"),
    ],
)
def test_a_number_in_the_wrong_unit_is_told(cells: str, units: str, place: str, says: str) -> None:
    """Millimetres for metres, degrees for radians and the reverse give one warning each."""
    (found,) = warnings(f"{{{cells}}}", units=units)
    assert f"joints[1].{place}: " in found
    assert says in found


def test_limits_of_a_wrist_that_turns_twice_are_not_told() -> None:
    """+-4 pi and a rounded 3.1416 are ordinary as limits."""
    row = "{theta: 0, d: 0, a: 1, alpha: 0, lower: -3.1416, upper: 12.5664}"
    assert warnings(row) == []


def test_many_long_lengths_are_one_warning() -> None:
    """The first length is named, the others are counted."""
    row = "{theta: 0, d: 335, a: 270, alpha: 0}"
    (found,) = warnings(row, row)
    assert found == "4:19: joints[1].d: 335 m is longer than 10 m (and 3 more); millimetres?"


@pytest.mark.parametrize(
    ("inertia", "says"),
    [
        ("[1, 0, 0, 1, 0, 3]", "no body has this tensor"),
        ("[1, 0, 0, -1, 0, 1]", "no body has this tensor"),
        ("[1, 2, 0, 1, 0, 1]", "no body has this tensor"),
        ("[1, 1, 1, 0, 0, 0]", "would be one in the order ixx, iyy, izz, ixy, ixz, iyz"),
        ("[1, 0, 0, 1, 0, 2]", ""),  # a disc, on the edge of the triangle inequality
        ("[0, 0, 0, 1, 0, 1]", ""),  # a rod
        ("[1, 0, 0, 1, 0, 1]", ""),  # a ball
    ],
)
def test_a_tensor_of_no_body_is_told(inertia: str, says: str) -> None:
    """A principal moment above the sum of the two others gives one warning with the order."""
    found = warnings(f"{{theta: 0, d: 0, a: 1, alpha: 0, mass: 1, inertia: {inertia}}}")
    assert [w.startswith("4:") and says in w for w in found] == [True] * bool(says)


ZERO = "{theta: 0, d: 0, a: 0, alpha: 0}"
ARM = "{theta: 0, d: 0, a: 1, alpha: 0}"
RAIL = "{type: P, theta: 0, d: 0, a: 0, alpha: 0}"
FIXED = "{type: fixed, xyz: [0, 1, 0]}"


@pytest.mark.parametrize(
    ("rows", "convention", "row"),
    [
        ([ARM, ZERO, ARM], "standard", 2),
        ([ZERO, ARM], "standard", 1),
        ([ARM, ZERO, ARM], "modified", 2),
        ([ARM, ZERO], "modified", 2),
        ([ARM, ZERO], "standard", 0),  # the last row
        ([ZERO, ARM], "modified", 0),  # the first of a modified table
        ([ARM, RAIL, ARM], "standard", 0),  # a quill
        ([ARM, ZERO, FIXED, ARM], "standard", 0),  # a step by hand
    ],
)
def test_an_all_zero_row_between_two_joints_is_told(
    rows: list[str], convention: str, row: int
) -> None:
    """Two joints of one type on one axis are probably a row that was not filled in."""
    found = warnings(*rows, convention=convention)
    assert [f"joints[{row}]: all zero" in warning for warning in found] == [True] * bool(row)


@pytest.mark.parametrize(
    ("format", "text"),
    [
        ("csv", "# {}\n# units: m, deg\na_{{i-1}},alpha_{{i-1}},d_i,theta_i\n1,0,0,0\n"),
        ("markdown", "{}\nunits: m, deg\n\n|a_{{i-1}}|alpha_{{i-1}}|d|th|\n|-|-|-|-|\n|1|0|0|0|"),
    ],
)
def test_a_modified_header_over_a_standard_table_is_refused(format: str, text: str) -> None:
    """``a_{i-1}`` belongs to modified tables; both columns are named."""
    with pytest.raises(TableFileError, match="is a modified table's column") as caught:
        parse_table(text.format("convention: standard"), format, "arm")
    found = caught.value.problems
    assert [p.split(": ")[2].split(" is ")[0] for p in found] == ["a_{i-1}", "alpha_{i-1}"]
    assert not parse_table(text.format("convention: modified"), format).warnings


def test_a_table_made_in_python_is_judged_by_its_floats() -> None:
    """Without a file the numbers are metres and radians, and the paths are the same."""
    table = DHTable((DHRow(1.5708, 335.0, 0, math.pi / 2),), DHConvention.STANDARD)
    assert [miss.path for miss in near_misses(table)] == ["joints[1].theta", "joints[1].d"]


@pytest.mark.parametrize(
    "path", sorted((Path(__file__).parents[2] / "dh2urdf" / "robots").glob("*.yaml")), ids=str
)
def test_tables_that_ship_give_no_warning(path: Path) -> None:
    """No shipped table has a near miss."""
    assert read_table(path).warnings == ()
