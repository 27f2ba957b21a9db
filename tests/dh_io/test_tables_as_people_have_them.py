"""Tables as students paste them from spreadsheets, slides, PDFs, chats and toolboxes."""

import dataclasses
import io
import math

import pytest
from hostile import hostile, outcome
from hypothesis import given, settings
from hypothesis import strategies as st
from rich import box
from rich.console import Console
from rich.table import Table

from dh2urdf import DHRow, DHTable, JointType, Origin, list_tables, load_table
from dh2urdf.dh_io import format_of, parse_table, read_table, told
from dh2urdf.dh_io.read import format_of_text
from dh2urdf.exceptions import TableFileError
from dh2urdf.grids import grid_csv

UP, DOWN = math.pi / 2, -math.pi / 2
P = JointType.PRISMATIC

UNEVEN = "theta  d  a  alpha\nq1 0.3  0   -90\nq2  0 0.25 0\n"
GERMAN = (
    "| Gelenk | Typ | θ | d | a | α |\n|--|--|--|--|--|--|\n| 1 | R | 0 | 0,412 | 0 | -90 |\n"
    "| 2 | R | 0 | 0,154 | 0 | 90 |\n| 3 | P | -90 | 0 | 0,0203 | 0 |\n"
)


def row(theta, d, a, alpha, joint_type=JointType.REVOLUTE, **more):
    return DHRow(theta=theta, d=d, a=a, alpha=alpha, joint_type=joint_type, **more)


UR_ARM = [row(0, 0.089159, 0, UP), row(0, 0, -0.425, 0), row(0, 0, -0.39225, 0)]
STANFORD = [row(0, 0.412, 0, DOWN), row(0, 0.154, 0, UP), row(DOWN, 0, 0.0203, 0, P)]
ELBOW = [row(0, 0.3, 0, DOWN), row(0, 0, 0.25, 0)]

SPREADSHEET = (
    "\ufeffGelenk;θ [°];d [mm];a [mm];α [°]\r\n1;0;89,159;0;90\r\n"
    "2;0;0;-425;0\r\n3;0;0;-392,25;0\r\n;;;;\r\n"
)
MAKER_S_PAGE = (
    "Kinematics\ttheta [rad]\ta [m]\td [m]\talpha [rad]\tDynamics\tMass [kg]\tCenter of Mass [m]\n"
    "Joint 1\t0\t0\t0.089159\tπ/2\tLink 1\t3.7\t[0, -0.0256, 0.0019]\n"
    "Joint 2\t0\t-0.425\t0\t0\tLink 2\t8.4\t[0.2125, 0, 0.1134]\n"
    "Joint 3\t0\t-0.39225\t0\t0\tLink 3\t2.3\t[0.15, 0.0, 0.0265]\n"
)
CHAT = r"""Sure! Here is the **DH table** of a 3-DOF arm in the *standard* convention:

| Joint \(i\) | \(\theta_i\) (deg) | \(d_i\) (mm) | \(a_i\) (mm) | \(\alpha_i\) (deg) |
|:-----------:|:------------------:|:------------:|:------------:|:------------------:|
| 1 | \(\theta_1\) | **89.159** | 0 | \(90^\circ\) |
| 2 | $\theta_2^*$ | 0 | −425 | 0 |
| 3 | θ₃ | 0 | `-392.25` | 0° |

Where **θᵢ** is the joint angle.
"""
LECTURE = r"""
Convention: Craig

| $i$ | $\alpha_{i-1}$ | $a_{i-1}$ | $d_{i}$ | $\theta_{i}$ |
| --- | --- | --- | --- | --- |
| 1 | 0 | 0 | $L_1$ | $\theta_1^{*}$ |
| 2 | $\frac{\pi}{2}$ | 0 | 0 | $q_2$ |
| 3 | $-\pi/2$ | $L_2$ | 0 | $\theta_3+\frac{\pi}{2}$ |

units: m, rad
constants.L_1: 0.5
constants.L_2: 0.3
"""
PYTHON_TOOLBOX = """DHRobot: arm, 3 joints (RRR), dynamics, geometry, standard DH parameters
┌────┬────────┬────────┬────────┬─────────┬────────┐
│θⱼ  │   dⱼ   │   aⱼ   │   ⍺ⱼ   │   q⁻    │   q⁺   │
├────┼────────┼────────┼────────┼─────────┼────────┤
│ q1 │ 0.0892 │      0 │  90.0° │ -160.0° │ 160.0° │
│ q2 │      0 │ -0.425 │   0.0° │ -110.0° │ 110.0° │
└────┴────────┴────────┴────────┴─────────┴────────┘

┌─┬──┐
└─┴──┘

┌─────┬─────┬──────┐
│name │ q0  │ q1   │
├─────┼─────┼──────┤
│  qz │  0° │  0°  │
└─────┴─────┴──────┘
"""
MATLAB_TOOLBOX = """Stanford:: 3 axis, RRP, stdDH, slowRNE
+---+-----------+-----------+-----------+-----------+-----------+
| j |     theta |         d |         a |     alpha |    offset |
+---+-----------+-----------+-----------+-----------+-----------+
|  1|         q1|      0.412|          0|      -pi/2|          0|
|  2|         q2|      0.154|          0|       pi/2|          0|
|  3|      -pi/2|         q3|     0.0203|          0|          0|
+---+-----------+-----------+-----------+-----------+-----------+
tool:    t = (0, 0, 0),  RPY/xyz = (0, 0, 0) deg
"""
WORD = (
    "Link i\tαi (deg)\tai (mm)\tdi (mm)\tθi (deg)\tR/P\n1\t–90°\t0\t412\tθ1*\tR\n"
    "2\t90°\t0\t154\tθ2*\tRotational\n3\t0°\t20.3\td3*\t-90\tP\n"
)
PDF = "Link ai αi di θi\n1 0 −90° 0.412 θ1\n2 0 90° 0.154 θ2\n3 0.0203 0 q3 - 90°\n"
PDF = PDF.replace("q3 - 90°", "d3 −90°")
PYYAML = """convention: standard
joints:
- &id001
  a: 0.3
  alpha: 0
  d: 0
  theta: 0
- *id001
- *id001
tool:
  name: gripper
  xyz: [0, 0, 0.1]
units:
  angle: rad
  length: m
"""
HOMEWORK = """SCARA robot homework 3,,,,,
Convention,standard,,,,
Units,mm,deg,,,
,,,,,
Axis,Type,Theta,d,a,Alpha
A1,rotational,0,400,250,0
A2,Rotational,0,0,200,180
A3,linear,0,q,0,0
"""
GRID = """
+--------+-----------+---------+---------+-------------+
|   Link |   θ (deg) |   d (m) |   a (m) |   α (deg)   |
+========+===========+=========+=========+=============+
|      1 |         0 |     0.3 |    0    |     -90     |
+--------+-----------+---------+---------+-------------+
|      2 |         0 |     0   |    0.25 |     0       |
+--------+-----------+---------+---------+-------------+
"""
TRANSPOSED = ",Joint 1,Joint 2\ntheta [deg],0,0\nd [mm],300,0\na [mm],0,250\nalpha [deg],-90,0\n"
UNITS_BELOW = "Link;theta;d;a;alpha\n;(deg);(mm);(mm);(deg)\n1;0;300;0;-90\n2;0;0;250;0\n"
FLAGS = (
    "joint,R,theta,d,a,alpha\n1,TRUE,0,0.412,0,-90\n2,true,0,0.154,0,90\n3,FALSE,-90,0,20.3mm,0\n"
)

PASTED = {
    "spreadsheet.csv": (SPREADSHEET, "standard", None, UR_ARM),
    "maker.tsv": (MAKER_S_PAGE, "standard", None, None),
    "chat.md": (CHAT, "standard", None, UR_ARM),
    "lecture.md": (
        LECTURE,
        None,
        None,
        [row(0, 0.5, 0, 0), row(0, 0, 0, UP), row(UP, 0, 0.3, DOWN)],
    ),
    "toolbox.txt": (
        PYTHON_TOOLBOX,
        None,
        "m,deg",
        [
            row(0, 0.0892, 0, UP, lower=-math.pi / 9 * 8, upper=math.pi / 9 * 8),
            row(0, 0, -0.425, 0, lower=-math.pi / 18 * 11, upper=math.pi / 18 * 11),
        ],
    ),
    "matlab.txt": (MATLAB_TOOLBOX, None, "m,rad", STANFORD),
    "word.txt": (WORD, "standard", None, STANFORD),
    "pdf.txt": (PDF, "standard", "m,deg", STANFORD),
    "pyyaml.yaml": (PYYAML, None, None, [row(0, 0, 0.3, 0)] * 3),
    "homework.csv": (
        HOMEWORK,
        None,
        None,
        [
            row(0, 0.4, 0.25, 0, name="A1"),
            row(0, 0, 0.2, math.pi, name="A2"),
            row(0, 0, 0, 0, P, name="A3"),
        ],
    ),
    "grid.txt": (GRID, "standard", None, ELBOW),
    "transposed.csv": (TRANSPOSED, "standard", None, ELBOW),
    "below.csv": (UNITS_BELOW, "standard", None, ELBOW),
    "flags.csv": (FLAGS, "standard", "m,deg", STANFORD),
    "uneven.txt": (UNEVEN, "standard", "m,deg", ELBOW),
    "german.md": (GERMAN, "standard", "m,deg", STANFORD),
}


@pytest.mark.parametrize("name", PASTED)
def test_what_people_paste_is_read(name, tmp_path):
    """The rows are those that a person sees, in metres and radians."""
    text, convention, units, rows = PASTED[name]
    path = tmp_path / name
    path.write_bytes(text.encode())
    table, warnings, _ = read_table(path, told=told(convention, units))
    if rows is not None:
        assert [_close(r) for r in table.rows] == [_close(r) for r in rows]
    else:
        assert table.joint_names == ("Joint 1", "Joint 2", "Joint 3")
        first = table.rows[0]
        assert (first.theta, first.d, first.a, first.alpha, first.mass) == (0, 0.089159, 0, UP, 3.7)
    assert len(warnings) == (name in ("maker.tsv", "pyyaml.yaml"))


@pytest.mark.parametrize("name", [name for name in PASTED if name != "spreadsheet.csv"])
def test_the_format_of_a_pasted_table_shows_in_its_text(name):
    """As it comes through a pipe, without a name."""
    text, convention, units, _ = PASTED[name]
    given = told(convention, units)
    by_name = parse_table(text, "text" if name.endswith(".txt") else format_of(name), "arm", given)
    assert parse_table(text, format_of_text(text), "arm", given).table == by_name.table


@pytest.mark.parametrize("name", list_tables())
def test_what_show_prints_reads_back(name):
    """The text for people, pasted into a file: rows, names and limits to its digits."""
    table = load_table(name)
    if any(row.origin for row in table.rows) or not (table.base.is_identity):
        return
    if table.joint_map is not None:  # its rows are written with the controller's values
        return
    plain = dataclasses.replace(table, tool=Origin(), rows=tuple(
        dataclasses.replace(row, sign=1) for row in table.rows))  # fmt: skip
    text = f"{plain}\n\nsource: a || b\n\nH_1^0 =\n  1  0  0  0\n  0  1  0  0\n"
    found = parse_table(text, "text", "arm", told(None, "m,deg")).table
    for one, other in zip(found.rows, plain.rows, strict=True):
        assert one.name == (other.name or one.name)
        for key in ("theta", "d", "a", "alpha"):
            assert getattr(one, key) == pytest.approx(getattr(other, key), abs=1e-12)
        for key in ("lower", "upper"):
            value = getattr(other, key)
            digits = 1e-12 if other.joint_type is P else math.radians(0.5)
            assert value is None or getattr(one, key) == pytest.approx(value, abs=digits)
    assert found.convention is plain.convention


@pytest.mark.parametrize(
    ("cell", "lower", "upper"),
    [
        ("±170°", -170, 170),
        ("+170/-160", -160, 170),
        ("[-170, 160.5]", -170, 160.5),
        ("−170° ~ 160°", -170, 160),
        ("-pi/2 to pi/2", -90, 90),
        ("-170 – 160 deg", -170, 160),
        ("0...45", 0, 45),
    ],
)
def test_a_range_in_one_column_is_both_limits(cell, lower, upper):
    """As data sheets and this package write it."""
    page = f"|θ|d|a|α|Range|\n|-|-|-|-|-|\n|0|1|0|0|{cell}|\n"
    row = parse_table(page, "markdown", "a", told("standard", "m,deg")).table.rows[0]
    assert (row.lower, row.upper) == pytest.approx((math.radians(lower), math.radians(upper)))


BITS = [
    *(
        "|",
        "│",
        "-",
        "--",
        "\n",
        "\n\n",
        ";",
        "\t",
        ",",
        "  ",
        "#",
        "**",
        "─",
        "=",
        ":",
        "{",
        "]",
        '"',
    ),
    *("θ", "d", "(deg)", "[mm]", "1,5", "q1", "R", "true", "tool: 3", "±170", "range", "offset"),
    *("\\frac{a}{b}", "*a", "&a", "i-1", "₋₁", "units: mm", "convention: x", "½", "⁻"),
]


@hostile(
    name=st.sampled_from(list(PASTED)),
    edits=st.lists(st.tuples(st.integers(0, 600), st.integers(0, 9), st.sampled_from(BITS))),
    format=st.sampled_from(["text", "csv", "markdown", ""]),
)
def test_a_damaged_paste_is_read_or_refused(name, edits, format):
    """Whatever was typed over it, in whatever format it is taken."""
    text = PASTED[name][0]
    for at, length, bit in edits:
        text = text[:at] + bit + text[at + length :]
    given = told("standard", "m,deg")
    got = outcome(parse_table, text, format or format_of_text(text), "arm", given)
    assert isinstance(got, tuple | TableFileError)


def _close(row):
    """A row with its numbers to twelve digits."""
    numbers = [row.theta, row.d, row.a, row.alpha, row.lower, row.upper]
    return [row.name, row.joint_type, *(n if n is None else float(f"{n:.12g}") for n in numbers)]


@pytest.mark.parametrize(
    ("text", "format", "says"),
    [
        ("dh =\n\n   0   0.67   0   1.57\n", "text", "in any order: theta d a alpha"),
        ("| 1 | 2 | 3 | 4 |\n|---|---|---|---|\n", "markdown", "| theta | d | a | alpha |"),
        ("θ;d;a;α\n0;1,250;0;90\n", "csv", "joints[1].d: found '1,250'"),
        ("| i | α | a | d | θ |\n|---|---|---|---|---|\n|1|0|a₂|d₁|θ₁|", "markdown",
         "give its value, as in constants.a2: 0.4"),
        ("| i | α | a | d | θ |\n|---|---|---|---|---|\n|1|0|0|d₁|θ₁|", "markdown",
         "give the one that is constant a value, as in constants.d1: 0.4"),
        ("theta,d,a,alpha\n0,1,0,0\ntool: 0 0 0.1\n", "csv", "found 1 cells; the header has 4"),
        ("|θ|d|a|α|\n|-|-|-|-|\n|0|1|0|0|\n\ntool: t = (0, 0, 0.1)\n", "markdown",
         "write tool.xyz: 0 0 0.1 and tool.rpy: 0 0 90"),
        ("theta d a alpha\n0 1 0 pi / 2 3\n", "text", "where cells hold spaces, part them by tabs"),
        ("R,theta,d,a,alpha\nmaybe,0,0,0,0\n", "csv", "r is a (link length) in some books"),
        ('theta,d,a,alpha\n0,"1.025,5",0,0\n', "csv", "a decimal point: 1025.5"),
        ('theta,d,a,alpha\n0,"1,025.5",0,0\n', "csv", "a decimal point: 1025.5"),
        ("\\begin{tabular}{cc}\n0 & 1\n\\end{tabular}", "text", "a table in LaTeX is for people"),
        ("<html>\n<table><tr><td>0</td></tr></table>", "csv", "copy the rows into a .csv file"),
    ],
)  # fmt: skip
def test_what_cannot_be_read_says_what_to_write(text, format, says):
    """One message for each cell, in the format of the file."""
    with pytest.raises(TableFileError) as caught:
        parse_table(text, format, "arm", told("standard", "mm,deg"))
    assert says in str(caught.value)


def test_columns_of_the_link_before_tell_the_modified_convention():
    """They are read as such, with a warning; told the other convention, they are at fault."""
    page = "| αᵢ₋₁ (deg) | aᵢ₋₁ (m) | dᵢ | θᵢ |\n|---|---|---|---|\n| 0 | 1 | 0 | 0 |\n"
    table, warnings, _ = parse_table(page, "markdown", "arm.md")
    assert str(table.convention) == "modified"
    assert len(warnings) == 1
    assert "read as one" in warnings[0]
    with pytest.raises(TableFileError, match="but told standard"):
        parse_table(page, "markdown", "arm.md", told("standard"))


def test_an_offset_beside_theta_and_d_is_added_to_the_one_that_moves():
    """As in the toolboxes, whose offset is added to the joint variable."""
    text = "theta,d,a,alpha,offset\nq1,1,0,0,30\n0,q2,0,0,0.5\n"
    rows = parse_table(text, "csv", "a", told("standard", "m,deg")).table.rows
    assert (rows[0].theta, rows[0].d) == (pytest.approx(math.pi / 6), 1)
    assert (rows[1].theta, rows[1].d, rows[1].joint_type) == (0, 0.5, P)


def test_a_name_of_base_or_tool_is_not_read_and_says_so():
    """Nothing else of the step is lost."""
    found = parse_table(PYYAML, "yaml")
    assert found.table.tool == Origin((0, 0, 0.1))
    assert "tool.name: found 'gripper'; it is not read" in found.warnings[0]


HEADS = {
    "theta": ["θ", "theta", "θᵢ", "$\\theta_i$", "Theta", "θ₁", "th", "ϑ_i", "θj"],
    "d": ["d", "dᵢ", "$d_i$", "d_{i}", "Link offset", "di", "dⱼ"],
    "a": ["a", "aᵢ", "$a_i$", "Link length", "a_n", "𝑎", "a_j"],
    "alpha": ["α", "alpha", "αᵢ", "Twist", "$\\alpha_{i}$", "⍺ⱼ", "𝛼", "Link twist"],
}
UNIT_STYLES = ["{} [{}]", "{} ({})", "{} / {}", "{}[{}]", "{} in {}", "{}, {}"]
SHEETS = ["pipe", "heavy", "square", "ascii", "semicolon", "tab", "comma", "spaces"]


def sheet(kind, header, rows):
    """A table drawn by rich, or parted by a sign."""
    signs = {"semicolon": ";", "tab": "\t", "spaces": "   "}
    if kind in signs:
        return "\n".join(signs[kind].join(line) for line in [header, *rows])
    if kind == "comma":
        return grid_csv(header, rows)
    boxes = {"pipe": box.MARKDOWN, "heavy": box.HEAVY_HEAD, "square": box.SQUARE}
    drawn = Table(*header, box=boxes.get(kind, box.ASCII2), show_lines=kind == "ascii")
    for line in rows:
        drawn.add_row(*line)
    out = io.StringIO()
    Console(file=out, width=400, markup=False).print(drawn)
    return out.getvalue()


@settings(max_examples=60)
@given(
    arm=st.sampled_from([name for name in list_tables() if not load_table(name).rows[-1].origin]),
    kind=st.sampled_from(SHEETS),
    style=st.sampled_from(UNIT_STYLES),
    commas=st.booleans(),
    data=st.data(),
)
def test_any_drawing_of_a_shipped_table_is_the_table(arm, kind, style, commas, data):
    """Whatever draws it and heads it, in whatever order of the columns."""
    table = load_table(arm)
    rows = [r for r in table.rows if r.origin is None]
    keys = data.draw(st.permutations(["theta", "d", "a", "alpha"]))
    units = {"theta": "rad", "alpha": "rad", "d": "m", "a": "m"}
    if kind == "spaces":
        style = "{}[{}]"
    heads = [style.format(data.draw(st.sampled_from(HEADS[k])), units[k]) for k in keys]
    cells = [[repr(getattr(r, k)) for k in keys] for r in rows]
    if commas:
        cells = [[text.replace(".", ",") for text in line] for line in cells]
    letters = [str(r.joint_type)[0].upper() for r in rows]
    head = ["Link i" if kind != "spaces" else "Link", *heads, "R/P"]
    lines = [[str(i), *line, letter] for i, (line, letter) in
             enumerate(zip(cells, letters, strict=True), 1)]  # fmt: skip
    text = sheet(kind, head, lines)
    made = parse_table(text, "text", "arm.txt", told(table.convention)).table
    wanted = [DHRow(r.theta, r.d, r.a, r.alpha, joint_type=r.joint_type) for r in rows]
    assert made == DHTable(tuple(wanted), table.convention, name="arm")


@pytest.mark.parametrize("levels", [6, 30, 300])
def test_aliases_are_bounded_by_what_they_stand_for(levels):
    """Billions of laughs are refused with one message."""
    lines = ["a0: &a0 [x, x, x, x, x, x, x, x]"]
    lines += [f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 8)}]" for i in range(1, levels)]
    with pytest.raises(TableFileError) as caught:
        parse_table("\n".join(lines), "yaml", "arm.yaml")
    assert len(caught.value.problems) == 1
    assert "alias *a" in str(caught.value)
    assert "more than 20000 cells" in str(caught.value)


@pytest.mark.parametrize("name", list_tables())
def test_a_repeated_row_by_alias_is_the_row_written_out(name):
    """Anchors and aliases of whole rows and of cells."""
    first = load_table(name).rows[0]
    cells = f"theta: {first.theta!r}, d: &d {first.d!r}, a: *d, alpha: {first.alpha!r}"
    kind = f"type: {first.joint_type}"
    head = "convention: standard\nunits: {length: m, angle: rad}\njoints:\n"
    if first.origin is None:
        text = f"{head}  - &r {{{kind}, {cells}}}\n  - *r\n  - *r\n"
        rows = parse_table(text, "yaml").table.rows
        once = DHRow(first.theta, first.d, first.d, first.alpha, joint_type=first.joint_type)
        assert rows == (once,) * 3
