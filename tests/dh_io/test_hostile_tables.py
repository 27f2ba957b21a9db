"""Hostile input at the doors of tables from Python, and files beyond the bounds."""

import itertools
import math
from decimal import Decimal
from fractions import Fraction

import numpy as np
import pytest
from hostile import hostile, outcome
from hypothesis import strategies as st

import dh2urdf
from dh2urdf import DHRow, DHTable, JointType, Origin
from dh2urdf.bounds import ANGLE, JOINTS, LENGTH, NUMBER, ROWS
from dh2urdf.dh_io import parse_table, table_to_text
from dh2urdf.exceptions import ArgumentError, Dh2UrdfError, TableError, TableFileError

HUGE = [1e9, 1e62, -1e308, 1e30, 1e5, math.inf, math.nan, 10**400, -(10**400), Fraction(10**400, 7)]
ODD = [None, True, "x", "", b"1", 1j, [], {}, object(), np.ma.masked, Decimal("sNaN"), "\ud800"]
ARRAYS = [np.zeros(2), np.array(["a", "b"]), np.array([1j]), np.zeros((0, 4, 4))]
ARRAYS += [np.datetime64(0, "s")]
NUMBERS = st.one_of(st.floats(-10, 10), st.floats(), st.integers(), st.fractions())
ANYTHING = st.one_of(NUMBERS, st.sampled_from(HUGE + ODD + ARRAYS), st.text(max_size=4))
FIELDS = {name: ANYTHING for name in DHRow.__dataclass_fields__ if name not in ("com", "inertia")}
VECTORS = {
    "com": ANYTHING | st.lists(ANYTHING, max_size=4),
    "inertia": st.lists(ANYTHING, max_size=7),
}
SOUND = DHRow(a=1.0)


@hostile(fields=st.fixed_dictionaries({}, optional=FIELDS | VECTORS))
def test_a_row_is_bounded_floats_or_refused_by_field(fields):
    """Whatever a field is given, the row holds floats within the bounds or names the field."""
    got = outcome(DHRow, **fields)
    if isinstance(got, DHRow):
        for key, bound in {"theta": ANGLE, "d": LENGTH, "a": LENGTH, "alpha": ANGLE}.items():
            assert type(getattr(got, key)) is float
            assert abs(getattr(got, key)) <= bound
        assert got.sign in (1, -1)
        assert all(abs(getattr(got, k) or 0.0) <= NUMBER for k in ("effort", "mass", "velocity"))
    else:
        assert isinstance(got, TableError)
        keys = {problem.partition(":")[0] for problem in got.problems}
        assert keys <= {"type", "xyz", "mass", *DHRow.__dataclass_fields__}


@hostile(
    rows=st.lists(ANYTHING | st.just(SOUND), max_size=3) | ANYTHING,
    convention=ANYTHING | st.just("standard"),
    rest=st.fixed_dictionaries(
        {}, optional=dict.fromkeys(("name", "base", "tool", "source", "checked"), ANYTHING)
    ),
)
def test_a_table_is_rows_and_origins_or_refused(rows, convention, rest):
    """Whatever makes a table up, it holds rows, origins and texts or is refused."""
    got = outcome(DHTable, rows, convention, **rest)
    assert isinstance(got, (DHTable, TableError))


@hostile(
    rows=st.lists(st.lists(ANYTHING, min_size=3, max_size=5), max_size=3) | ANYTHING,
    columns=st.sampled_from(["theta d a alpha", "alpha,a,d,theta", "a a a a", "", 3, ["d"], "x"]),
    joint_types=st.none() | ANYTHING | st.text("RPFx", max_size=3),
)
def test_an_array_is_a_table_or_refused(rows, columns, joint_types):
    """Whatever array comes in, a table or an error that names the argument comes out."""
    got = outcome(DHTable.from_array, rows, "standard", columns, joint_types)
    assert isinstance(got, (DHTable, TableError, ArgumentError))


@hostile(q=ANYTHING | st.lists(ANYTHING, max_size=3))
def test_the_dh_product_answers_or_refuses_its_configuration(q):
    """``table.fk`` of anything is a finite pose or an error of the package."""
    got = outcome(DHTable((SOUND,), "standard").fk, q)
    assert isinstance(got, Dh2UrdfError) or np.isfinite(got).all()


@hostile(values=st.tuples(*[ANYTHING] * 4), convention=ANYTHING | st.just("modified"))
def test_one_row_s_transform_is_finite_or_refused(values, convention):
    """``dh_transform`` and ``dh_factors`` of anything are finite or name what they refuse."""
    for got in (
        outcome(dh2urdf.dh_transform, *values, convention),
        outcome(dh2urdf.dh_factors, *values),
    ):
        assert isinstance(got, Dh2UrdfError) or np.isfinite(got).all()


@pytest.mark.parametrize(
    "call",
    [
        lambda: DHTable((SOUND,), "x"),
        lambda: DHTable((SOUND,), np.array(["a", "b"])),
        lambda: dh2urdf.dh_transform(0, 0, 0, 0, "x"),
        lambda: dh2urdf.dh_parameters(np.eye(4), "x"),
        lambda: dh2urdf.to_convention(DHTable((SOUND,), "standard"), "x"),
        lambda: dh2urdf.extract_dh([[0, 0, 1, 0, 0, 0]], convention="x"),
        lambda: DHTable.from_array([[0, 0, 0, 0]], "x"),
    ],
)
def test_an_unknown_convention_is_refused_with_the_two_there_are(call):
    """Every function that takes a convention has the same answer to another word."""
    with pytest.raises(Dh2UrdfError, match="convention: expected 'standard' or 'modified', got "):
        call()


def test_a_stack_of_displacements_has_no_parameters():
    """``dh_parameters`` takes one pose; an empty stack is refused by its shape."""
    with pytest.raises(dh2urdf.exceptions.PoseError, match=r"\(4, 4\), got \(0, 4, 4\)"):
        dh2urdf.dh_parameters(np.zeros((0, 4, 4)))


def test_a_table_beyond_the_bounds_is_refused_before_anything_is_built():
    """Too many joints or rows, or an endless iterator of them, end at once with the bound."""
    with pytest.raises(TableError, match=f"at most {JOINTS}"):
        DHTable((SOUND,) * 1000, "standard")
    for rows in ([SOUND] * (ROWS + 1), itertools.repeat(SOUND)):
        with pytest.raises(TableError, match=f"more than {ROWS}"):
            DHTable(rows, "standard")
    with pytest.raises(TableError, match=f"at most {JOINTS}"):
        DHTable.from_array(np.ones((JOINTS + 1, 4)), "standard")
    assert DHTable((SOUND,) * JOINTS, "standard").n == JOINTS


@pytest.mark.parametrize(("count", "says"), [(JOINTS + 1, f"at most {JOINTS}"), (1000, f"{ROWS}")])
@pytest.mark.parametrize("format", ["yaml", "toml", "json", "csv", "markdown"])
def test_a_file_of_a_thousand_joints_is_refused(format, count, says):
    """The bound on joints holds in every format, with the place in the file."""
    good = table_to_text(DHTable((SOUND,), "standard"), format)
    line = next(line for line in good.splitlines() if "revolute" in line)
    more = ",\n" if format == "json" else "\n"
    got = outcome(parse_table, good.replace(line, more.join([line] * count)), format, "many")
    assert isinstance(got, TableFileError)
    assert says in str(got)


def test_an_array_is_the_table_of_its_columns():
    """Columns in any order and a slide: the table equals the one of written rows."""
    rows = (DHRow(0.1, 0.2, 0.3, 0.4), DHRow(0.5, 0.6, 0.7, 0.8, JointType.PRISMATIC))
    cells = [[0.4, 0.3, 0.2, 0.1], [0.8, 0.7, 0.6, 0.5]]
    columns = "alpha a d theta"
    made = DHTable.from_array(cells, "modified", columns, joint_types="RP", name="made")
    assert made == DHTable(rows, "modified", name="made")
    plain = DHTable.from_array(np.array([[0, 0.1, 0.2, 1.57]], dtype=">f4"), convention="standard")
    assert plain.rows[0].alpha == float(np.float32(1.57))


def test_rows_of_numbers_are_shown_the_way():
    """A table made of lists instead of rows names the call that takes them."""
    with pytest.raises(TableError, match=r"rows: expected DHRow objects.*DHTable\.from_array\("):
        DHTable([[0, 0.1, 0.2, 1.57]], "standard")


@pytest.mark.parametrize(
    ("cells", "says"),
    [
        ("theta: 0, d: 1e62, a: 0, alpha: 0", "joints[1].d: found 1e62; expected a number from"),
        ("theta: 1e18, d: 1, a: 0, alpha: 0", "joints[1].theta: found 1e18; expected"),
        ("theta: 0, d: 1, a: 0, alpha: 0, upper: 1e308", "joints[1].upper: found 1e308;"),
        ("theta: 0, d: 1, a: 0, alpha: 0, effort: 1e31", "joints[1].effort: found 1e31;"),
        ("theta: 1e9999999, d: 1, a: 0, alpha: 0", "joints[1].theta: found 1e9999999; the number"),
        ("type: fixed, xyz: [1e10, 0, 0]", "joints[1].xyz: found a list; expected 3 numbers from"),
        ('theta: 0, d: 1, a: 0, alpha: 0, name: "\\uD800"', "joints[1].name: found"),
        ("theta: 0, d: 9e8, a: 9e8, alpha: 0", "lengths: sum to 1.8e+09 m; at most 1e+09 m"),
    ],
)
def test_a_number_beyond_its_bound_is_told_at_its_place(cells, says):
    """Files have the bounds of Python, and name line and column."""
    text = f"convention: standard\nunits: {{length: m, angle: deg}}\njoints: [{{{cells}}}]"
    got = outcome(parse_table, text, "yaml", "far.yaml")
    assert isinstance(got, TableFileError)
    assert "far.yaml:3:" in str(got)
    assert says in str(got)


def test_what_tables_may_hold_our_own_reader_takes(tmp_path):
    """A table at its bounds is written, and its file read back by every reader here."""
    far = DHRow(a=0.9 * LENGTH, effort=NUMBER, velocity=NUMBER, lower=-ANGLE, upper=ANGLE)
    for row in (far, DHRow(a=0.9 * LENGTH, mass=NUMBER), DHRow(d=1e-12, a=1e-12, mass=1e-12)):
        table = DHTable((row, DHRow(joint_type="prismatic")), "standard", base=Origin((1, 1, 1)))
        path = dh2urdf.write_urdf(table, tmp_path / "far.urdf").path
        assert dh2urdf.load_table(path) == table
        assert dh2urdf.extract_dh(path).table == table
        assert dh2urdf.Robot.from_urdf(path).n == dh2urdf.Robot.from_dh(table).n == 2


@pytest.mark.parametrize("row", [" |", "|", "| |", "\\|"])
def test_a_line_of_bars_alone_is_a_row_with_too_few_cells(row):
    """A row of a Markdown table without a single cell is told by its place."""
    page = f"convention: standard\nunits: m, rad\n\n|theta|d|a|alpha|\n|-|-|-|-|\n{row}\n"
    got = outcome(parse_table, page, "markdown", "page.md")
    assert isinstance(got, TableFileError)
    assert "page.md:6:1: joints[1]: found 1 cells" in str(got)
    assert isinstance(outcome(parse_table, f"{row}\n|-|", "markdown"), TableFileError)
