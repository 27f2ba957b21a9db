"""Table files mean what they say, in every format."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from dh2urdf import DHConvention, DHRow, DHTable, JointType, Origin
from dh2urdf.dh_io import Units, format_of, parse_table, read_table, table_to_text
from dh2urdf.exceptions import TableFileError

HALF = math.pi / 2

RPR = (
    DHRow(0.0, 0.0, 3.0, -HALF),
    DHRow(0.0, 2.0, 0.0, HALF, JointType.PRISMATIC),
    DHRow(HALF, 0.0, 1.5, 0.0),
)


SLIDE = DHRow(0, 0, 1, 0, JointType.PRISMATIC)


def yaml_rows(*rows: str, units: str = "{length: mm, angle: deg}", more: str = "") -> DHTable:
    """Table of YAML rows in a standard file."""
    lines = "".join(f"  - {row}\n" for row in rows)
    text = f"convention: standard\nunits: {units}\n{more}joints:\n{lines}"
    return parse_table(text, "yaml", "arm.yaml").table


def test_the_design_s_example_is_read_in_metres_and_radians() -> None:
    """Millimetres and degrees of the file arrive as the nearest floats in metres and radians."""
    text = """\
name: arm
source: a data sheet
checked: by hand
convention: standard            # required
units: {length: mm, angle: deg}
base: {xyz: [0, 0, 100], rpy: [0, 0, 90]}
tool: {xyz: [1, 2, 3], rpy: [0, 0, 0]}
joints:
  - {name: joint_1, theta: 0, d: 335, a: 75, alpha: -90, lower: -170, upper: 170}
  - {type: prismatic, theta: 0, d: 100, a: 0, alpha: 0, lower: 0, upper: 200, velocity: 50}
  - {type: fixed, xyz: [0, 1.5, 0], rpy: [0, 0, 0]}
"""
    lower, upper = -2.9670597283903604, 2.9670597283903604
    assert parse_table(text, "yaml").table == DHTable(
        rows=(
            DHRow(0.0, 0.335, 0.075, -HALF, name="joint_1", lower=lower, upper=upper),
            DHRow(0.0, 0.1, 0.0, 0.0, JointType.PRISMATIC, lower=0.0, upper=0.2, velocity=0.05),
            DHRow(joint_type=JointType.FIXED, origin=Origin((0.0, 0.0015, 0.0))),
        ),
        convention=DHConvention.STANDARD,
        name="arm",
        base=Origin((0.0, 0.0, 0.1), (0.0, 0.0, HALF)),
        tool=Origin((0.001, 0.002, 0.003)),
        source="a data sheet",
        checked="by hand",
    )


def test_the_rpr_arm_reads_as_the_textbook_writes_it() -> None:
    """Symbols in theta and d name the joint's variable and decide its type."""
    table = yaml_rows(
        "{theta: theta_1, d: 0, a: 3, alpha: -90}",
        "{theta: 0, d: l_2 + 2, a: 0, alpha: 90}",
        "{theta: theta_3 + 90deg, d: 0, a: 1.5, alpha: 0}",
        units="{length: m, angle: deg}",
    )
    assert table.rows == RPR


@pytest.mark.parametrize(
    "header",
    [
        "| i | θ_i | d_i | a_i | α_i |",
        r"| i | $\theta_i$ | $d_i$ | $a_i$ | $\alpha_i$ |",
        "| joint | Theta | Link Offset | Link length | Twist |",
        "| # | th | d | a | alpha |",
    ],
)
def test_a_markdown_page_with_typeset_cells_is_read(header: str) -> None:
    """The table of a page of prose is found; LaTeX, Greek and degree signs are understood."""
    text = rf"""
# An arm

Some words about it: nothing that matters.

- **Convention:** standard
- units: m, deg

{header}
|---|---|---|---|---|
| 1 | $\theta_1$ | 0 | 3 | $-90^{{o}}$ |
| 2 | 0 | $\ell_2 + 2$ | 0 | 90° |
| 3 | θ_3 + 90^\circ | 0 | 1.5 | 0 |

More prose.
"""
    table = parse_table(text, "markdown", "rpr.md").table
    assert (table.rows, table.name) == (RPR, "rpr")


@pytest.mark.parametrize(
    ("cells", "row"),
    [
        ("theta: theta1-90", DHRow(-HALF, 0, 1, 0)),
        ("theta: q1 + pi/2", DHRow(HALF, 0, 1, 0)),
        ("theta: -q1", DHRow(0, 0, 1, 0, sign=-1)),
        ("theta: 90 - θ1", DHRow(HALF, 0, 1, 0, sign=-1)),
        ("theta: theta1*", DHRow(0, 0, 1, 0)),
        ("theta: q", DHRow(0, 0, 1, 0)),
        ("theta: 90, sign: -1", DHRow(HALF, 0, 1, 0, sign=-1)),
        ("theta: -theta1, sign: -1", DHRow(0, 0, 1, 0, sign=-1)),
        ("theta: 0, type: R", DHRow(0, 0, 1, 0)),
        ("type: Revolute", DHRow(0, 0, 1, 0)),
        ("type: prismatic", SLIDE),
        ("type: P, d: 3", replace(SLIDE, d=3)),
        ("d: d1", SLIDE),
        ("d: d1 + 3", replace(SLIDE, d=3)),
        ("d: 3 - q1", replace(SLIDE, d=3, sign=-1)),
        ("d: l1*, type: sliding", SLIDE),
    ],
)
def test_variable_and_sign_of_a_row(cells: str, row: DHRow) -> None:
    """The row read equals the row expected; a variable in d makes it prismatic."""
    constant = "theta" if row.joint_type is JointType.PRISMATIC else "d"
    text = "{" + f"{cells}, {constant}: 0, a: 1, alpha: 0" + "}"
    assert yaml_rows(text, units="{length: m, angle: deg}").rows == (row,)


def test_variables_count_joints_not_rows() -> None:
    """theta2 is the variable of the second joint, also where a fixed row stands between."""
    table = yaml_rows(
        "{theta: theta1, d: 0, a: 1, alpha: 0}",
        "{type: fixed, xyz: [0, 0, 1], rpy: [0, 0, 0]}",
        "{theta: theta2 + 90, d: 0, a: 1, alpha: 0}",
    )
    assert table.rows[2].theta == HALF


def test_a_row_with_a_pose_alone_is_fixed() -> None:
    """xyz or rpy without DH parameters need no type; a fixed DH row fills up with zeros."""
    table = yaml_rows(
        "{theta: 0, d: 0, a: 1, alpha: 0}", "{rpy: [0, 0, 90]}", "{type: fixed, d: 7}"
    )
    assert table.rows[1:] == (
        DHRow(joint_type=JointType.FIXED, origin=Origin(rpy=(0, 0, HALF))),
        DHRow(0, 0.007, 0, 0, JointType.FIXED),
    )


def test_constants_take_the_unit_of_the_cell_they_stand_in() -> None:
    """A bare constant is millimetres in d and degrees in alpha; one with a unit keeps it."""
    more = "constants: {l1: 400, l2: 2*l1 + 100mm, l3: l1/4, twist: pi/2, tilt: 30}\n"
    table = yaml_rows("{theta: tilt, d: l1 + 35, a: l2, alpha: -twist}", more=more)
    assert table.rows[0] == DHRow(0.5235987755982989, 0.435, 0.9, -HALF)


def test_a_constant_hides_the_variable_of_the_same_name() -> None:
    """``l2 + 2`` with l2 under constants is a number, and the joint stays revolute."""
    table = yaml_rows(
        "{theta: 0, d: 0, a: 1, alpha: 0}",
        "{theta: 0, d: l2 + 2, a: 1, alpha: 0}",
        more="constants: {l2: 5}\n",
    )
    assert table.rows[1] == DHRow(0.0, 0.007, 0.001, 0.0)


@pytest.mark.parametrize("word", ["modified", "MDH", "proximal", "craig", "Khalil"])
def test_aliases_of_the_modified_convention(word: str) -> None:
    """Every alias names the modified convention."""
    text = f"convention: {word}\nunits: {{length: m, angle: rad}}\njoints:\n"
    text += "  - {th: 0, d: 0, a: 1, twist: 0}\n"
    assert parse_table(text, "yaml").table.convention is DHConvention.MODIFIED


def test_velocity_and_limits_go_by_the_joint_s_type() -> None:
    """Degrees per second turn, millimetres per second slide; effort is SI in either."""
    table = yaml_rows(
        "{theta: 0, d: 0, a: 1, alpha: 0, min: -90, max: 90, velocity: 180, torque: 5}",
        "{type: P, theta: 0, a: 1, alpha: 0, lower: -90, upper: 90, velocity: 180, effort: 5}",
    )
    turning, sliding = table.rows
    assert (turning.lower, turning.velocity, turning.effort) == (-HALF, math.pi, 5.0)
    assert (sliding.upper, sliding.velocity, sliding.effort) == (0.09, 0.18, 5.0)


def test_a_tensor_about_the_link_frame_is_moved_to_the_centre_of_mass() -> None:
    """``inertia_frame: link`` equals a sum over point masses taken about their centre."""
    rng = np.random.default_rng(3)
    points, masses = rng.normal(size=(6, 3)), rng.uniform(0.5, 2.0, 6)
    com = masses @ points / masses.sum()

    def tensor(about: np.ndarray) -> list[float]:
        r = points - about
        full = sum(
            m * ((x @ x) * np.eye(3) - np.outer(x, x)) for m, x in zip(masses, r, strict=True)
        )
        return [float(full[i]) for i in ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))]

    row = (
        f"{{theta: 0, d: 0, a: 1, alpha: 0, mass: {float(masses.sum())!r}, com: {com.tolist()}, "
        f"inertia: {tensor(np.zeros(3))}, inertia_frame: link}}"
    )
    (read,) = yaml_rows(row, units="{length: m, angle: rad}").rows
    assert read.inertia == pytest.approx(tensor(com), abs=1e-12)


def test_csv_columns_may_come_in_any_order_with_units_and_semicolons() -> None:
    """Units of the header count where no line gives them; the order of columns is free."""
    text = "# convention: sdh\nalpha (deg);Type;d [mm];theta_deg;a [cm];joint;limit_lower [deg]\n"
    text += "-90;R;335;0;7.5;waist;-170\n0;P;0;90;1;slide;\n"
    table = parse_table(text, "csv", "arm.csv").table
    assert table.joint_names == ("waist", "slide")
    assert table.rows[0] == DHRow(0, 0.335, 0.075, -HALF, name="waist", lower=-2.9670597283903604)
    assert table.rows[1] == DHRow(HALF, 0, 0.01, 0, JointType.PRISMATIC, name="slide")


def test_csv_lines_carry_the_table_s_own_keys() -> None:
    """Comment lines give name, units, base, tool and constants."""
    text = """\
# name: arm
# An ordinary comment
# convention: mdh
# units: {length: mm, angle: deg}
# base.xyz: 0 0 100
# tool.rpy: [0, pi/2, 0]
# constants.l1: 400
theta,d,a,alpha
0,l1,0,90
"""
    table = parse_table(text, "csv", "arm.csv").table
    assert table == DHTable(
        rows=(DHRow(0, 0.4, 0, HALF),),
        convention=DHConvention.MODIFIED,
        name="arm",
        base=Origin((0, 0, 0.1)),
        tool=Origin(rpy=(0, HALF, 0)),
    )


def test_toml_and_json_mean_the_same_as_yaml() -> None:
    """The same keys in TOML tables, inline TOML and JSON give the same table."""
    toml = """
name = "arm"
convention = "standard"
units.length = "mm"
units.angle = "deg"
[constants]
l1 = 75
[[joints]]
name = "j1"
theta = "theta1 + 90"
d = 335
a = "l1"
alpha = -90.0
[[joints]]
type = "fixed"
xyz = [0, 1.5, "l1"]
"""
    json = """{"name": "arm", "convention": "standard", "units": {"length": "mm", "angle": "deg"},
 "constants": {"l1": 75}, "joints": [
\t{"name": "j1", "theta": "theta1 + 90", "d": 335, "a": "l1", "alpha": -9e1, "lower": null},
\t{"type": "fixed", "xyz": [0, 1.5, "l1"]}]}"""
    yaml = """
name: arm
convention: standard
units: {length: mm, angle: deg}
constants: {l1: 75}
joints:
  - {name: j1, theta: theta1 + 90, d: 335, a: l1, alpha: -90}
  - {type: fixed, xyz: [0, 1.5, l1]}
"""
    tables = [parse_table(t, f).table for t, f in ((toml, "toml"), (json, "json"), (yaml, "yaml"))]
    assert tables[0] == tables[1] == tables[2]
    assert tables[0].rows[0] == DHRow(HALF, 0.335, 0.075, -HALF, name="j1")


def test_a_file_without_a_name_is_named_for_itself(tmp_path: Path) -> None:
    """The stem of the path is the table's name, and a byte order mark or CRLF does no harm."""
    path = tmp_path / "crane.csv"
    path.write_bytes("\ufeff# convention: standard\r\n# units: m, rad\r\n".encode())
    with path.open("ab") as stream:
        stream.write(b"theta,d,a,alpha\r\n0,1,2,3\r\n")
    table = read_table(path).table
    assert (table.name, table.rows) == ("crane", (DHRow(0, 1, 2, 3),))


@pytest.mark.parametrize(
    ("name", "format"),
    [("a.YAML", "yaml"), ("a.yml", "yaml"), ("a.md", "markdown"), ("a.tsv", "tsv")],
)
def test_the_suffix_tells_the_format(name: str, format: str) -> None:
    """Suffixes are read without regard to case."""
    assert format_of(name) == format


def test_an_unknown_suffix_is_refused() -> None:
    """The message lists the suffixes there are, and for a URDF says what to do."""
    with pytest.raises(TableFileError, match=r"known suffixes: \.yaml, \.yml"):
        format_of("arm.txt")
    with pytest.raises(TableFileError, match="extract it"):
        format_of("arm.urdf")


def test_yaml_is_version_1_2() -> None:
    """``1e-3``, ``-.5``, ``on`` and ``1:30`` are what they look like, unlike in YAML 1.1."""
    table = yaml_rows(
        "{name: on, theta: -.5, d: 1e-3, a: 1, alpha: 012}", units="{length: m, angle: rad}"
    )
    assert table.rows[0] == DHRow(-0.5, 0.001, 1.0, 12.0, name="on")
    with pytest.raises(TableFileError, match="found '1:30'"):
        yaml_rows("{theta: 1:30, d: 1, a: 1, alpha: 0}")


def test_written_files_are_easy_on_the_eye() -> None:
    """Columns are aligned, whole numbers have no point, degrees and millimetres are round."""
    table = DHTable(
        (DHRow(0, 0.335, 0.075, -HALF, name="j1"), DHRow(0, 0, 0.27, 0, name="elbow")),
        DHConvention.STANDARD,
        name="arm",
    )
    assert table_to_text(table, "yaml", Units("mm", "deg")) == (
        "name: arm\n"
        "convention: standard\n"
        "units: {length: mm, angle: deg}\n"
        "joints:\n"
        "  - {name: j1,    type: revolute, theta: 0, d: 335, a:  75, alpha: -90}\n"
        "  - {name: elbow, type: revolute, theta: 0, d:   0, a: 270, alpha:   0}\n"
    )
