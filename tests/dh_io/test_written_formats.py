"""What `show`, `convert` and `extract` write of a table: all of it, in every format and unit."""

import math
import re
from html.parser import HTMLParser
from itertools import cycle

import pytest
from hypothesis import given
from hypothesis import strategies as st
from strategies import tables

import dh2urdf
from dh2urdf.conversions.write import table_text_and_error
from dh2urdf.dh import DHConvention, DHRow, DHTable, Origin
from dh2urdf.dh_io import READ_BACK, Units, parse_table, table_to_text
from dh2urdf.exceptions import TableError, VerificationError
from dh2urdf.grids import number

UNITS = [Units(length, angle) for length in ("m", "cm", "mm", "in") for angle in ("rad", "deg")]
ARM = dh2urdf.load_table("franka_fer")
DEG = Units("mm", "deg")


def in_both(name):
    """A shipped table in both conventions."""
    table = dh2urdf.load_table(name)
    return [dh2urdf.to_convention(table, convention) for convention in DHConvention]


def differing(names, units):
    """What does not come back equal, through every format that is read."""
    return [
        (table.name, str(table.convention), format, unit)
        for name, unit in zip(names, units, strict=False)
        for table in in_both(name)
        for format in READ_BACK
        if parse_table(table_to_text(table, format, unit), format).table != table
    ]


def test_every_shipped_table_comes_back_equal():
    """Each table in both conventions through each format, the units taken in turn."""
    assert differing(dh2urdf.list_tables(), cycle(UNITS)) == []


@pytest.mark.exhaustive
def test_every_shipped_table_comes_back_equal_in_every_unit():
    """Each table in both conventions through each format in each pair of units."""
    for unit in UNITS:
        assert differing(dh2urdf.list_tables(), cycle([unit])) == []


@pytest.mark.parametrize(
    ("format", "heads"), [("csv", ",a_{i-1},alpha_{i-1},"), ("markdown", "aᵢ₋₁ [mm] | αᵢ₋₁ [deg]")]
)
def test_modified_columns_say_so_and_are_read_so(format, heads):
    """A modified table's a and alpha are headed i-1, and refused where standard is claimed."""
    text = table_to_text(ARM, format, DEG)
    assert heads in text
    assert parse_table(text, format).table == ARM
    assert heads not in table_to_text(dh2urdf.to_convention(ARM, "standard"), format, DEG)
    with pytest.raises(TableError, match="is a modified table's column"):
        parse_table(text.replace("convention: modified", "convention: standard"), format)


@pytest.mark.parametrize("format", READ_BACK)
def test_programs_read_ascii(format):
    """No true minus sign, degree sign or ellipsis in what a program reads; Markdown has Greek."""
    text = table_to_text(ARM, format, DEG)
    assert set(text) - set(map(chr, range(128))) <= set("θαᵢ₋₁" * (format == "markdown"))


class Cells(HTMLParser):
    """Cells of the rows of a page, and its other texts."""

    def __init__(self, page):
        super().__init__()
        self.rows, self.texts, self.cell = [], [], None
        self.feed(page)

    def handle_starttag(self, tag, _):
        """Begin a row or a cell."""
        if tag == "tr":
            self.rows.append([])
        if tag in ("td", "th"):
            self.rows[-1].append("")
            self.cell = self.rows[-1]

    def handle_endtag(self, tag):
        """End a cell."""
        if tag in ("td", "th"):
            self.cell = None

    def handle_data(self, data):
        """Add to a cell or to the other texts."""
        if self.cell is None:
            self.texts.append(data)
        else:
            self.cell[-1] += data


def latex_cells(text):
    """The same of LaTeX."""
    rows = [line[:-3].split(" & ") for line in text.splitlines() if line.endswith(r" \\")]
    plain = [[re.sub(r"\$|\\circ|\^|_|{|}|\\,", "", cell) for cell in row] for row in rows]
    return [[cell.replace(r"\ldots", "…").replace("\u2212", "-") for cell in row] for row in plain]


def numbers_of(cell):
    """Numbers in a cell, the index of q left out."""
    plain = re.sub(r"q\d+", "", cell.replace("\N{MINUS SIGN}", "-")).replace("- ", "-")
    return [float(v) for v in re.findall(r"-?\d+(?:\.\d+)?(?:e[-+]?\d+)?", plain)]


def expected_cells(table):
    """The numbers of each row as a reader finds them, in [mm] and [deg]."""
    for row in table.rows:
        if row.origin is not None:
            turn = row.origin.rpy if any(row.origin.rpy) else ()
            yield [1e3 * v for v in row.origin.xyz] + [math.degrees(v) for v in turn]
            continue
        moved = {"revolute": "theta", "prismatic": "d"}.get(row.joint_type)
        four = [getattr(row, key) for key in ("theta", "d", "a", "alpha")]
        sizes = [math.degrees(1), 1e3, 1e3, math.degrees(1)]
        cells = [
            size * v
            for key, v, size in zip(("theta", "d", "a", "alpha"), four, sizes, strict=True)
            if key != moved or v
        ]
        scale = 1e3 if row.joint_type == "prismatic" else math.degrees(1)
        yield cells + [scale * v for v in (row.lower, row.upper) if v is not None]


@pytest.mark.parametrize("format", ["html", "latex"])
@given(table=tables())
def test_people_read_every_number(format, table):
    """HTML and LaTeX say each number of each row, convention, base and tool."""
    text = table_to_text(table, format, DEG)
    rows = Cells(text).rows if format == "html" else latex_cells(text)
    body = [row for row in rows if "theta" not in row[2] and "θ" not in row[2]]
    wide = max(map(len, rows))
    assert all(len(row) == wide for row in rows)
    for cells, expected, row in zip(body, expected_cells(table), table.rows, strict=True):
        found = [v for cell in cells[2:] for v in numbers_of(cell)]
        assert found == pytest.approx(expected, rel=1e-12, abs=5.1e-3 if row.is_joint else 1e-12)
        assert found[:3] == pytest.approx(expected[:3], rel=1e-12, abs=1e-15)
    assert f"{table.convention} DH" in text
    for key, origin in (("base", table.base), ("tool", table.tool)):
        assert (f"{key}: xyz" in text) != origin.is_identity


def test_latex_is_balanced_and_holds_all_that_a_table_has():
    """Environments and braces close; names, kinds, limits, masses and source are there."""
    table = dh2urdf.load_table("puma560")
    row = table.rows[1]
    text = table_to_text(table, "latex")
    assert text.startswith("% written from a DH table\n")
    opened = re.findall(r"\\(begin|end)\{(\w+)\}", text)
    depth = []
    for kind, name in opened:
        if kind == "begin":
            depth.append(name)
        else:
            assert depth.pop() == name
    assert depth == []
    assert text.count("{") == text.count("}")
    assert text.count("$") % 2 == 0
    assert row.mass
    for word in (row.mass, *row.com, *row.inertia):
        assert number(word).replace("\u2212", "$-$") in text, word
    for word in ("limits of $q_i$", "{\\footnotesize source: ", "mass"):
        assert word in text, word


@given(table=tables(), unit=st.sampled_from(UNITS), digits=st.integers(0, 12), data=st.data())
def test_rounded_numbers_are_the_nearest_and_stay(table, unit, digits, data):
    """With digits each number is off by at most half of the last one, and rounding is done once."""
    format = data.draw(st.sampled_from(READ_BACK))
    text = table_to_text(table, format, unit, digits)
    again = parse_table(text, format).table
    assert table_to_text(again, format, unit, digits) == text
    half = 0.5 * 10.0**-digits
    length = half * {"m": 1, "cm": 0.01, "mm": 0.001, "in": 0.0254}[unit.length]
    angle = half * (math.pi / 180 if unit.angle == "deg" else 1)
    for row, other in zip(table.rows, again.rows, strict=True):
        for key, most in (("d", length), ("a", length), ("theta", angle), ("alpha", angle)):
            assert abs(getattr(row, key) - getattr(other, key)) <= most * (1 + 1e-9) + 1e-15
    for end in ("base", "tool"):
        for one, two in zip(getattr(table, end).xyz, getattr(again, end).xyz, strict=True):
            assert abs(one - two) <= length * (1 + 1e-9) + 1e-15


def test_digits_are_those_that_were_asked_for():
    """-166 in degrees, not -166.0030619832534; a table that rounding spoils is refused."""
    text, error = table_text_and_error(ARM, "csv", DEG, 2)
    assert "\nfer_joint1,revolute,0,333,0,0,-166,166," in text
    assert error == 0.0  # limits moved, the arm did not
    text, error = table_text_and_error(ARM, "yaml", Units("m", "deg"), 2)
    assert 0.005 < error < 0.02
    with pytest.raises(VerificationError, match=r"with 0 decimals of m and deg the arm is .* off"):
        table_text_and_error(ARM, "yaml", Units("m", "deg"), 0)


def test_limits_are_shown_to_a_hundredth_of_a_degree():
    """People read -166, however many digits the radians make of it; short ones stay whole."""
    limits = [(-2.8973, math.radians(12.3456)), (-1e-5, math.radians(359.5))]
    table = DHTable(tuple(DHRow(lower=a, upper=b) for a, b in limits), "standard")
    assert "\u2212166 to 12.3456°" in str(table)
    assert "\u22120.000573 to 359.5°" in str(table)


def test_the_flange_is_not_lost():
    """Every format of a Panda says that the tool is 0.107 m away, and that it is modified DH."""
    tool = Origin((0.0, 0.0, 0.107))
    assert ARM.tool == tool
    for format in (*READ_BACK, "text", "latex", "html"):
        text = table_to_text(ARM, format)
        assert "0.107" in text
        assert "modified" in text
