"""Broken table files: one error with every fault, its place and what is allowed."""

import os
import re
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dh2urdf.dh_io import FORMATS, parse_table, read_table
from dh2urdf.exceptions import TableFileError

HEAD = "convention: standard\nunits: {length: mm, angle: deg}\n"
ROW = "{theta: 0, d: 1, a: 2, alpha: 3}"


def problems(text: str, format: str = "yaml") -> tuple[str, ...]:
    """Faults of a text, of which there has to be at least one."""
    with pytest.raises(TableFileError) as caught:
        parse_table(text, format, f"arm.{format}")
    return caught.value.problems


def row_problems(*rows: str, more: str = "") -> tuple[str, ...]:
    """Faults of YAML rows in an otherwise good file."""
    return problems(f"{HEAD}{more}joints:\n" + "".join(f"  - {row}\n" for row in rows))


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "arm.yaml: the file is empty"),
        (" \n\n", "arm.yaml: the file is empty"),
        ("# only a comment\n", "arm.yaml: the file is empty"),
        ("\0\1\2", "binary data"),
        ("a: \x07", "arm.yaml:1:4: control character U+0007"),
        ("hello", "found 'hello'"),
        ("- 1\n- 2\n", "found a list"),
        ("convention:standard\n", "found 'convention:standard'"),
        ("a: [1, 2]\nb: *x\n", "arm.yaml:2:4: alias *x: nothing above is marked &x"),
        ("a: &a [x, *a]\n", "arm.yaml:1:11: alias *a: nothing above is marked &a"),
        ("a: !!python/object/apply:os.system [ls]\n", "tag !!python/object/apply:os.system"),
        ("a: !thing 3\n", "tag !thing: not read"),
        ("[" * 100_000, "nested deeper than 16"),
        ("{" * 100_000, "nested deeper than 16"),
        ("- " * 100_000, "nested deeper than 16"),
        ("? " * 100_000, "nested deeper than 16"),
        ("[a, " * 20 + "]" * 20, "nested deeper than 16"),
        ("a: 1\n" * 30_000, "more than 20000 cells"),
        ("a" * 1_000_001, "larger than 1000 kB"),
        ("a: 1\n---\nb: 2\n", "arm.yaml:2:1: a second document"),
        ("units:\n\tlength: m\n", "indent with spaces"),
        ("units: {length: m\njoints: 3\n", "not YAML: expected ',' or '}'"),
        ("a: 'never ends\n", "not YAML"),
        ("%TAG ! tag:x\n--- !y 1\n", "arm.yaml"),
        ("? {a: 1}\n: 2\n", "a key has to be a word"),
    ],
)
def test_a_file_that_is_no_table_has_one_problem(text: str, says: str) -> None:
    """Reading stops at the first place where nothing more can be made of the text."""
    (problem,) = problems(text)
    assert says in problem


def test_what_has_no_default_is_asked_for() -> None:
    """Convention, units and joints are missed, all three at once, with what is allowed."""
    found = problems("name: arm\n")
    assert [re.sub(r"\n.*", "", p, flags=re.DOTALL) for p in found] == [
        "arm.yaml:1:1: convention: missing; standard (distal: Paul, Spong) or modified "
        "(proximal: Craig, Khalil)",
        "arm.yaml:1:1: units: missing; length (m, cm, mm, in) and angle (rad, deg)",
        "arm.yaml:1:1: joints: missing; expected a list of rows with theta, d, a and alpha",
    ]


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("convention: dh", "dh alone does not say which"),
        ("convention: modfied", "did you mean modified?"),
        ("units: mm", "for instance units: {length: mm, angle: deg}"),
        ("units: {length: furlong, angle: deg}", "found 'furlong'; allowed: m, cm, mm, in"),
        ("units: {length: mm}", "units.angle: missing; allowed: rad, deg"),
        ("units: {length: mm, angel: deg}", "did you mean angle?"),
        ("base: [0, 0, 1]", "found a list; expected the keys xyz, rpy"),
        ("base: {xyz: [0, 0]}", "found 2 values; expected 3: [x, y, z]"),
        ("tool: {rpy: [0, 0, one]}", "tool.rpy[3]: found 'one'"),
        ("toool: {}", "did you mean tool?"),
        ("constants: {pi: 3}", "constants.pi: not a name for a constant"),
        ("constants: {mm: 3}", "constants.mm: not a name for a constant"),
        ("constants: {l: [1]}", "constants.l: found a list"),
        ("constants: 3", "constants: found 3; expected name: value"),
        ("constants: {l: m}", "constants.l: found 'm'; 'm' has no value"),
        ("name: [a]", "name: found a list; expected a text"),
        ("<<: {a: 1}", "unknown key '<<'"),
    ],
)
def test_faults_of_the_table_s_own_keys(line: str, says: str) -> None:
    """Exactly one problem, at the line that was added, and it says what is allowed."""
    key = line.partition(":")[0]
    head = "".join(f"{h}\n" for h in HEAD.splitlines() if not h.startswith(f"{key}:"))
    found = problems(f"{head}{line}\njoints: [{ROW}]\n")
    assert len(found) == 1
    assert says in found[0]
    assert found[0].startswith(f"arm.yaml:{head.count(chr(10)) + 1}:")


@pytest.mark.parametrize(
    ("cells", "says"),
    [
        ("theta: abc", "joints[1].theta: found 'abc'; 'abc' has no value"),
        ("theta: -9O", "did you mean -90?"),
        ("d: '33,5'", "did you mean 33.5?"),
        ("a: nan", "not a finite number"),
        ("a: .NaN", "not a finite number"),
        ("a: .inf", "not a finite number"),
        ("a: 1e400", "too large"),
        ("a: true", "'true' is not a number"),
        ("a: [1]", "found a list; expected one length"),
        ("a: {b: 1}", "found keys and values; expected one length"),
        ("a: __import__('os').system('ls')", "has no place in a number"),
        ("a: exec", "'exec' has no value"),
        ("a: 9**9**9**9", "an exponent of at most 10"),
        ("a: " + "(" * 90 + "1" + ")" * 90, "nested deeper than 24"),
        ("a: 90deg", "an angle where a length is expected"),
        ("alpha: 90mm", "a length where an angle is expected"),
        ("a: q1", "a is constant; a joint variable stands in theta or d"),
        ("alpha: theta1", "alpha is constant"),
        ("theta: theta2", "'theta2' is not the variable of this row (joint 1)"),
        ("theta: d1", "'d1' is not the variable of this row"),
        ("theta: 2*q1", "theta1 enters with the factor 2; only +1 and -1"),
        ("theta: q1*q1", "neither a length nor an angle"),
        ("theta: q1 - q1", "enters with the factor 0"),
        ("theta: sin(q1)", "a joint variable enters with the factor"),
        ("d: d1, theta: theta1", "both hold a joint variable"),
        ("type: R, d: d1", "makes the row prismatic, but type says revolute"),
        ("type: P, theta: q1", "makes the row revolute, but type says prismatic"),
        ("type: prismatc", "did you mean prismatic?"),
        ("type: continuous", "without lower and upper turns without end"),
        ("type: [P]", "found a list; allowed: revolute (R), prismatic (P), fixed"),
        ("sign: 2", "found 2; allowed: 1 and -1"),
        ("sign: 0", "found 0; allowed: 1 and -1"),
        ("sign: -1, theta: q1 + 90", "but theta shows the variable with the sign +1"),
        ("lower: 10, upper: -10", "joints[1].lower: found 10; it lies above upper (-10)"),
        ("lower: low", "joints[1].lower: found 'low'"),
        ("mass: -1", "joints[1].mass: found -1; it must"),
        ("mass: 0", "joints[1].mass: found 0; it must be greater than 0"),
        ("velocity: -1", "joints[1].velocity: found -1; it must"),
        ("effort: -1", "joints[1].effort: found -1; it must not be negative"),
        ("mass: 1kg", "'kg' is not expected here"),
        ("com: [1, 2, 3]", "joints[1].mass: missing, but com or inertia is given"),
        ("mass: 1, com: [1, 2]", "found 2 values; expected 3"),
        ("mass: 1, com: {x: 1}", "found keys and values; expected 3"),
        ("mass: 1, inertia: [1, 0, 0, 1, 0]", "expected 6: [ixx, ixy, ixz, iyy, iyz, izz]"),
        ("inertia_frame: com", "but there is no inertia"),
        (
            "mass: 1, inertia: [1, 0, 0, 1, 0, 1], inertia_frame: link",
            "needs com, to move the tensor there",
        ),
        (
            "mass: 1, com: [0, 0, 0], inertia: [1, 0, 0, 1, 0, 1], inertia_frame: tool",
            "found 'tool'; allowed: com, link",
        ),
        ("xyz: [0, 0, 1]", "only a fixed row has xyz; this one is revolute"),
        ("r: 3", "r is a (link length) in some books and d (link offset) in others"),
        ("offset: 3", "write d or theta"),
        ("limits: [1, 2]", "write lower and upper"),
        ("aplha: 3", "did you mean alpha?"),
        ("zzz: 3", "unknown key 'zzz'; allowed: name, type, theta, d, a, alpha, sign"),
        ("twist: 3", "given twice, first in line 4 as 'alpha'"),
        ("d: 3, d: 4", "given twice, first in line 4"),
    ],
)
def test_a_fault_of_a_row_names_its_cell_and_what_is_allowed(cells: str, says: str) -> None:
    """One fault gives one problem, with file, line, column, the line itself and a caret."""
    keys = {part.split(":")[0].strip() for part in cells.split(",") if ":" in part}
    rest = [c for c in ("theta: 0", "d: 1", "a: 2", "alpha: 3") if c.split(":")[0] not in keys]
    if "type: P" in cells and "theta" in keys:
        rest = [c for c in rest if not c.startswith("d:")]
    found = row_problems("{" + ", ".join([*rest, cells]) + "}")
    assert len(found) == 1, found
    assert says in found[0]
    place = re.match(r"arm\.yaml:4:(\d+): joints\[1\]", found[0])
    assert place is not None
    assert found[0].splitlines()[1].startswith("    4 | ")
    assert found[0].splitlines()[2].rstrip().endswith("^")


@pytest.mark.parametrize(
    ("row", "says"),
    [
        ("just text", "found 'just text'; expected the keys"),
        ("[0, 1, 2, 3]", "found a list; expected the keys"),
        ("{type: fixed}", "a fixed row needs xyz and rpy"),
        ("{type: fixed, xyz: [0, 0, 0], mass: 3}", "mass: found 3; a fixed row has none"),
        ("{type: fixed, xyz: [0, 0, 0], a: 3}", "either xyz and rpy or DH parameters"),
        ("{type: fixed, a: 3, sign: -1}", "a fixed row has no variable"),
        ("{type: fixed, a: 1, d: d2}", "but type says fixed"),
        ("{d: 1, a: 2}", "joints[2].alpha: missing"),
        ("{type: P, d: 1, a: 2, alpha: 0}", "joints[2].theta: missing"),
        ("{theta: 0, d: , a: 2, alpha: 0}", "joints[2].d: missing"),
    ],
)
def test_a_fault_of_another_kind_of_row(row: str, says: str) -> None:
    """The second row is at fault, and it alone."""
    found = row_problems(ROW, row)
    assert [p for p in found if says in p], found
    assert all("joints[2]" in p for p in found)


def test_a_row_that_is_a_list_is_one_fault() -> None:
    """Nothing is missing in it."""
    assert len(row_problems(ROW, "[0, 1, 2, 3]")) == 1


def test_a_table_needs_a_joint_and_its_joints_different_names() -> None:
    """Only fixed rows, or two joints of one name, are refused at their place."""
    assert "no revolute or prismatic row" in row_problems("{type: fixed, xyz: [0, 0, 1]}")[0]
    twice = row_problems(f"{{name: j, {ROW[1:]}", f"{{name: j, {ROW[1:]}")
    assert twice[0].startswith("arm.yaml:5:5: joints[2].name: 'j' is the name of joints[1] too")
    assert len(twice) == 1


def test_all_faults_of_a_file_are_told_at_once_in_its_order() -> None:
    """Nine faults in six lines, three of them in the same row, are nine problems."""
    text = """\
conventoin: standard
units: {length: miles, angle: deg}
joints:
  - {theta: x, d: 0, a: 0, alpha: 0, mass: -1}
  - {theta: 0, d: 0, alpha: 0, lower: 9, upper: 1}
  - {theta: 0, d: 0, a: nan, aplha: 0, sign: 2}
"""
    found = problems(text)
    assert [p.split(": ")[0:2] for p in found] == [
        ["arm.yaml:1:1", "conventoin"],
        ["arm.yaml:2:17", "units.length"],
        ["arm.yaml:4:13", "joints[1].theta"],
        ["arm.yaml:4:44", "joints[1].mass"],
        ["arm.yaml:5:5", "joints[2].a"],
        ["arm.yaml:5:39", "joints[2].lower"],
        ["arm.yaml:6:25", "joints[3].a"],
        ["arm.yaml:6:30", "joints[3].aplha"],
        ["arm.yaml:6:46", "joints[3].sign"],
    ]


def test_a_message_shows_the_line_and_a_caret() -> None:
    """The whole text of one problem, as a user reads it."""
    (problem,) = row_problems("{theta: 0, d: 335, a: 75, alpha: -9O}")
    assert problem == (
        "arm.yaml:4:38: joints[1].alpha: found '-9O'; 'O' is not expected here\n"
        "    4 |   - {theta: 0, d: 335, a: 75, alpha: -9O}\n"
        "      |                                      ^\n"
        "  hint: did you mean -90?"
    )


def test_hundreds_of_faults_are_counted_not_listed() -> None:
    """A file with a fault in each of 300 rows has 25 problems and a count of the rest."""
    found = row_problems(*["{theta: x, d: 0, a: 0, alpha: 0}"] * 300)
    assert len(found) == 26
    assert found[-1] == "arm.yaml: and 275 more"


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ('{"convention": "standard",}', "arm.json:1:27: not JSON: a comma after the last value"),
        ('{"a" 1}', "not JSON: a colon is expected after a key"),
        ('{"a": 1} 2', "more text after the end"),
        ("{'a': 1}", "a key in double quotes is expected"),
        ('["a" "b"]', "a comma or ] is expected"),
        ("{\"a\": 'x'}", "a text takes double quotes"),
        ('{"a": "x', "unterminated string"),
        ('{"a": tru}', "not JSON: unexpected 't'"),
        ('{"a":', "the text ends too early"),
        ("[" * 100_000, "nested deeper than 16"),
        ('{"a":' * 100_000, "nested deeper than 16"),
        ("[1" + ",1" * 30_000 + "]", "more than 20000 cells"),
    ],
)
def test_what_is_not_json_is_refused_with_its_place(text: str, says: str) -> None:
    """The reader is as strict as the standard."""
    (problem,) = problems(text, "json")
    assert says in problem


def test_nan_and_doubled_keys_are_refused_in_json() -> None:
    """What Python's own reader lets through is a fault here, at its cell."""
    text = """{"convention": "standard", "units": {"length": "m", "angle": "rad"},
"joints": [{"theta": NaN, "d": Infinity, "a": -Infinity, "alpha": 0},
           {"theta": 0, "d": 1, "a": 2, "alpha": 0, "a": 3}]}"""
    found = problems(text, "json")
    places = [(p.split(": ")[0], "finite" in p, "given twice" in p) for p in found]
    assert places == [
        ("arm.json:2:22", True, False),
        ("arm.json:2:32", True, False),
        ("arm.json:2:47", True, False),
        ("arm.json:3:53", False, True),
    ]


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("a = ", "not TOML: invalid value"),
        ("a = 1\nb\n", "arm.toml:2:2: not TOML: expected '='"),
        ("a = 1\na = 2\n", "not TOML: cannot overwrite a value"),
        ("a = " + "[" * 100_000, "not TOML: nested too deeply"),
        ("a = " + "9" * 10_000, "thousands of digits"),
        ("a = 0x" + "f" * 10_000, "thousands of digits"),
    ],
)
def test_what_is_not_toml_is_refused(text: str, says: str) -> None:
    """The standard library's reason comes through in one line."""
    (problem,) = problems(text, "toml")
    assert says in problem


def test_toml_faults_are_found_by_line_and_column() -> None:
    """Tables, arrays of tables, inline rows, comments and strings do not lead the search astray."""
    text = '''\
convention = "standard" # = [[joints]] {
units = {length = "mm", angle = "dog"}
source = """
[[joints]]
theta = 1
"""

[base]
xyz = [0, 0, "x"]
[[joints]]
theta = nan
d = 0
a = 1979-05-27
alpha = 0
[[joints]]
"theta" = 0
d = 0
a = 0
alpha = "y"
'''
    assert [p.split(": ")[0:2] for p in problems(text, "toml")] == [
        ["arm.toml:2:33", "units.angle"],
        ["arm.toml:9:14", "base.xyz[3]"],
        ["arm.toml:11:9", "joints[1].theta"],
        ["arm.toml:13:5", "joints[1].a"],
        ["arm.toml:19:9", "joints[2].alpha"],
    ]
    inline = (
        'convention = "standard"\nunits = {length = "mm", angle = "deg"}\njoints = [\n'
        "  {theta = 0, d = 1, a = 2, alpha = 3},\n  {theta = 0, d = inf, a = 2, alpha = 3},\n]\n"
    )
    (problem,) = problems(inline, "toml")
    assert problem.startswith("arm.toml:5:19: joints[2].d: found 'inf'")


GRID_HEAD = "# convention: standard\n# units: mm, deg\n"


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("1,2,3,4\n", "no header row with theta, d, a and alpha"),
        (f"{GRID_HEAD}theta,d,a\n0,1,2\n", "no column for alpha"),
        (f"{GRID_HEAD}theta,d,a,aplha\n0,1,2,3\n", "did you mean alpha?"),
        (f"{GRID_HEAD}theta,d,r,alpha\n0,1,2,3\n", "r is a (link length) in some books"),
        (f"{GRID_HEAD}theta,d,a,alpha,th\n0,1,2,3,4\n", "a second column for theta"),
        (f"{GRID_HEAD},theta,d,,a,alpha\n1,0,1,7,2,3\n", "columns 1 and 4 have values but no name"),
        (f"{GRID_HEAD}theta,d,a,alpha,\n0,1,2,3,7\n", "column 5 has values but no name"),
        (f"{GRID_HEAD}theta,d,a,alpha\n0,1,2\n", "found 3 cells; the header has 4"),
        (f"{GRID_HEAD}theta,d,a,alpha\n0,1,5,2,3\n", "a decimal comma?"),
        (f"{GRID_HEAD}theta;d;a;alpha\n0;1,5;2.5;3\n", "did you mean 1.5?"),
        (f"{GRID_HEAD}theta;d;a;alpha\n0;1,500;2;3\n", "did you mean 1.500?"),
        (f"{GRID_HEAD}theta,d [deg],a,alpha\n0,1,2,3\n", "found unit 'deg' for d; allowed: m"),
        (f"{GRID_HEAD}theta,d [ell],a,alpha\n0,1,2,3\n", "found unit 'ell' for d; allowed: m"),
        (f"{GRID_HEAD}theta,d,a,alpha,mass [g]\n0,1,2,3,4\n", "found unit 'g' for mass"),
        (f"{GRID_HEAD}theta,d,a,alpha\n0,,2,3\n", "joints[1].d: missing"),
        (f"{GRID_HEAD}theta,d,a,alpha\n0,-,2,3\n", "joints[1].d: missing"),
        (f"{GRID_HEAD}theta,d,a,alpha\n0,one,2,3\n", "arm.csv:4:3: joints[1].d: found 'one'"),
        (f'{GRID_HEAD}theta,d,a,alpha\n0,"1,2,3\n', "not CSV"),
        ("# units: mm, deg\ntheta,d,a,alpha\n0,1,2,3\n", "convention: missing"),
        ("# convention: sdh\ntheta,d,a,alpha\n0,1,2,3\n", "units: missing"),
        ("# convention: sdh\n# units: mm\ntheta,d,a,alpha\n0,1,2,3\n", "units.angle: missing"),
        ("# convention: sdh\n# units: mm, x\ntheta,d,a,alpha\n0,1,2,3\n", "found 'mm, x'"),
        (
            f"{GRID_HEAD}theta,d,a,alpha,type,lower [deg]\n0,1,2,3,P,4\n",
            "found 4 in a column in deg; expected length",
        ),
        (f"{GRID_HEAD}theta,d,a,alpha\n", "joints: found a list; expected a list of rows"),
        ("theta,d,a,alpha\n" + "0,0,0,0\n" * 10_000, "more than 20000 cells"),
    ],
)
def test_a_fault_of_a_csv_file(text: str, says: str) -> None:
    """Header, cells and comment lines are checked; the fault is told with its place."""
    assert [p for p in problems(text, "csv") if says in p]


def test_a_column_that_counts_the_rows_and_empty_ones_need_no_name() -> None:
    """What a spreadsheet adds on either side does not change the table."""
    bare = f"{GRID_HEAD}theta,d,a,alpha\n0,1,2,3\n0,4,5,6\n"
    wide = f"{GRID_HEAD},theta,d,,a,alpha,,\n1,0,1,,2,3,,\n2,0,4,-,5,6,,\n"
    assert parse_table(wide, "csv").table == parse_table(bare, "csv").table


def test_markdown_without_a_dh_table_is_refused() -> None:
    """Prose, another table, and two DH tables are no DH table."""
    assert "no pipe table" in problems("# An arm\n\nNothing here.\n", "markdown")[0]
    other = "| part | price |\n|---|---|\n| arm | 3 |\n"
    assert "no pipe table" in problems(other, "markdown")[0]
    table = "| theta | d | a | alpha |\n|---|---|---|---|\n| 0 | 1 | 2 | 3 |\n\n"
    assert "a second DH table" in problems(table * 2, "markdown")[0]


def test_a_misspelt_key_of_a_csv_comment_is_told() -> None:
    """A comment line that nearly is a key warns; an ordinary comment does not."""
    text = f"{GRID_HEAD}# soruce: x\n# some words: y\ntheta,d,a,alpha\n0,100,2,3\n"
    (warning,) = parse_table(text, "csv", "arm.csv").warnings
    assert warning == "arm.csv:3:3: soruce: this line is not read; did you mean source?"


@pytest.mark.parametrize("suffix", sorted(FORMATS))
def test_paths_that_cannot_be_read(tmp_path: Path, suffix: str) -> None:
    """Missing file, folder, binary file and UTF-16 are told in one line each."""

    def message(path: Path) -> str:
        with pytest.raises(TableFileError) as caught:
            read_table(path)
        return str(caught.value)

    folder = tmp_path / f"folder{suffix}"
    folder.mkdir()
    assert message(folder) == f"{folder}: this is a folder, not a file"
    binary = tmp_path / f"binary{suffix}"
    binary.write_bytes(bytes(range(256)))
    assert message(binary) == f"{binary}: not a text file: it holds binary data"
    latin = tmp_path / f"latin{suffix}"
    latin.write_bytes("name: é".encode("latin-1"))
    assert message(latin) == f"{latin}: not a text file: it is not UTF-8"
    wide = tmp_path / f"wide{suffix}"
    wide.write_text("name: arm", encoding="utf-16")
    assert message(wide) == f"{wide}: the file is UTF-16 text; save it as UTF-8"
    missing = tmp_path / f"binry{suffix}"
    assert message(missing) == (
        f"{missing}: there is no such file\n  hint: did you mean {tmp_path / binary.name}?"
    )
    nested = binary / f"x{suffix}"
    assert message(nested).startswith(f"{nested}: cannot read: Not a directory")
    assert "cannot read: embedded null" in message(Path(f"a\0{suffix}"))


@pytest.mark.skipif(os.geteuid() == 0, reason="root may read every file")
def test_a_file_without_permission_is_told(tmp_path: Path) -> None:
    """No permission to read is one line."""
    path = tmp_path / "arm.yaml"
    path.touch(mode=0o000)
    with pytest.raises(TableFileError, match="no permission to read it"):
        read_table(path)


def test_a_refusal_of_the_system_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where the system refuses to open a file, the message says so, for root too."""

    def refuse(*_: object, **__: object) -> None:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(os, "open", refuse)
    with pytest.raises(TableFileError, match="no permission to read it"):
        read_table(tmp_path / "arm.yaml")


def test_a_device_and_an_unknown_format_are_refused() -> None:
    """A device is told as one, and not read; the other message lists the formats."""
    with pytest.raises(TableFileError, match="this is a pipe or a device"):
        read_table("/dev/zero", format="yaml")
    with pytest.raises(TableFileError, match="format: expected 'yaml' or 'toml' or"):
        parse_table("a", "xml")


@settings(max_examples=300)
@given(
    st.sampled_from(["yaml", "toml", "json", "csv", "markdown"]),
    st.text() | st.text(alphabet="{}[]:,|#'\"-&*!?%@\n\t theta=19adlph."),
)
def test_no_text_makes_another_error_than_a_table_file_error(format: str, text: str) -> None:
    """Whatever the text, it is a table or raises TableFileError."""
    _read_or_refuse(text, format)


@settings(max_examples=300)
@given(st.sampled_from(["yaml", "toml", "json", "csv", "markdown"]), st.data())
def test_no_damage_to_a_good_file_makes_another_error(format: str, data: st.DataObject) -> None:
    """A good file with a piece cut out or put in is a table or raises TableFileError."""
    text = GOOD[format]
    start = data.draw(st.integers(0, len(text)))
    end = data.draw(st.integers(start, min(len(text), start + 20)))
    piece = data.draw(
        st.text(max_size=5) | st.sampled_from(["[", "{", "!!x ", "&a ", "*a", "1e999"])
    )
    _read_or_refuse(text[:start] + piece + text[end:], format)


def _read_or_refuse(text: str, format: str) -> None:
    try:
        right = parse_table(text, format).table.n >= 1
    except TableFileError as error:
        right = all(problem.startswith("<text>") for problem in error.problems or ("none",))
    assert right


GOOD = {
    "yaml": f"{HEAD}base: {{xyz: [0, 0, 1]}}\nconstants: {{l: 3}}\njoints:\n  - {ROW}\n"
    "  - {type: P, theta: pi/2, d: l + 2, a: 0, alpha: 0, lower: -1, upper: 1}\n",
    "toml": 'convention = "standard"\nunits = {length = "mm", angle = "deg"}\n'
    '[[joints]]\nname = "j"\ntheta = "pi/2"\nd = 1\na = 2.5\nalpha = -90\n',
    "json": '{"convention": "standard", "units": {"length": "mm", "angle": "deg"},\n'
    ' "joints": [{"name": "j", "theta": "pi/2", "d": 1, "a": 2.5, "alpha": -9e1}]}\n',
    "csv": f'{GRID_HEAD}name,theta,d,a [m],alpha,com,mass\n"j",0,1,2,3,0 1 2,3\n',
    "markdown": "convention: mdh\nunits: m, rad\n\n"
    "| name | theta | d | a | alpha |\n|:--|--:|---|---|---|\n| j\\|k | 0 | 1 | 2 | pi/2 |\n",
}


@pytest.mark.parametrize("format", sorted(GOOD))
def test_the_good_files_are_good(format: str) -> None:
    """What the damage above is done to is a table."""
    assert parse_table(GOOD[format], format).table.n >= 1
