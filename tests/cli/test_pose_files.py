"""Files of poses: headings with units, quaternions, separators, and hostile text."""

import tempfile
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest
from hostile import hostile, outcome
from hypothesis import given
from hypothesis import strategies as st

from dh2urdf.cli.verbs.ik.poses import LAYOUTS, poses_of_csv
from dh2urdf.exceptions import PoseError

LENGTHS = {"": 1.0, "m": 1.0, "cm": 100.0, "mm": 1000.0, "in": 1 / 0.0254}
ANGLES = {"": 1.0, "rad": 1.0, "deg": 180 / np.pi, "°": 180 / np.pi}
STYLES = ("{} [{}]", "{}[{}]", "{} ({})", "{}/{}", "{} / {}")


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    """A path to write poses to."""
    return tmp_path_factory.mktemp("poses") / "poses.csv"


def read(path, text, *, deg=False):
    path.write_text(text, encoding="utf-8")
    return poses_of_csv(str(path), deg=deg).T


def matrix(xyz, rpy):
    """The pose by Pinocchio."""
    return pin.SE3(pin.rpy.rpyToMatrix(*rpy), np.array(xyz, float)).homogeneous


@st.composite
def sheets(draw):
    """A file of one pose in any layout, order, unit, separator and style, and its pose."""
    xyz = draw(st.lists(st.floats(-5, 5), min_size=3, max_size=3))
    rpy = draw(st.lists(st.floats(-3.2, 3.2), min_size=3, max_size=3))
    T = matrix(xyz, rpy)
    layout = draw(st.sampled_from(["rpy", "quaternion", "matrix"]))
    columns = {}
    if layout == "matrix":
        size = draw(st.sampled_from([3, 4]))
        columns = {f"t{i}{j}": (float(T[i, j]), {"": 1.0}) for i in range(size) for j in range(4)}
        columns |= {f"t{i}3": (xyz[i], LENGTHS) for i in range(3)}
    else:
        columns = {name: (v, LENGTHS) for name, v in zip("xyz", xyz, strict=True)}
    if layout == "rpy":
        for name, v in zip(("roll", "pitch", "yaw"), rpy, strict=True):
            columns[name] = (v, ANGLES)
    if layout == "quaternion":
        sign = draw(st.sampled_from([1, -1]))
        q = sign * pin.Quaternion(T[:3, :3]).coeffs()
        columns |= {f"q{n}": (float(v), {"": 1.0}) for n, v in zip("xyzw", q, strict=True)}
    head, row = [], []
    for name in draw(st.permutations(list(columns))):
        value, units = columns[name]
        unit = draw(st.sampled_from(sorted(units)))
        style = draw(st.sampled_from(STYLES)) if unit else "{}"
        head.append(draw(st.sampled_from([str.lower, str.upper]))(style.format(name, unit)))
        row.append(repr(value * units[unit]))
    separator = draw(st.sampled_from([",", ";", "\t", ", ", " ; "]))
    return f"# made\n\n{separator.join(head)}\n{separator.join(row)}\n", T


@given(sheet=sheets())
def test_a_header_gives_order_and_units(file, sheet):
    """Columns in any order and unit, parted by commas, semicolons or tabs, give the same pose."""
    text, T = sheet
    assert np.abs(read(file, text) - T).max() < 1e-12


def test_degrees_of_the_header_and_of_the_option_agree(file):
    """Headings in degrees, --deg, a line of units and cells with units name one pose."""
    T = matrix([0.4, 0, 0.3], [0, np.pi, 0.5])
    row = f"400,0,300,0,180,{float(np.degrees(0.5))!r}"
    head = "x [mm],y [mm],z [mm],roll [deg],pitch [deg],yaw [deg]\n"
    bare = "x_mm,y_mm,z_mm,roll,pitch,yaw\n"
    for text, deg in (
        (head + row, False),
        (head + row, True),
        (bare + row, True),
        ("# units: mm, deg\n" + row, False),
        ("#,x,y,z,roll,pitch,yaw\n1,400mm,0,0.3,0,pi,0.5rad", True),
    ):
        assert np.abs(read(file, text, deg=deg) - T).max() < 1e-15


@pytest.mark.parametrize("part", [";", "\t", " ; "])
def test_decimal_commas_are_points_where_no_comma_parts_cells(file, part):
    """A spreadsheet's export, with and without a heading, units in cells and a call's comma."""
    rows = [["-0,4", "12,5e-1", ",3", "-0,1", "1,5", "2"], ["1,25", "0", "3,0", "0", "0,5", "1"]]
    head = part.join(["x", "y", "z", "roll", "pitch", "yaw"]) + "\n"
    body = "\n".join(map(part.join, rows))
    T = read(file, (head + body).replace(",", "."))
    for text in (head + body, body):
        np.testing.assert_array_equal(read(file, text), T)
    cells = ["400,5mm", "0", "0", "22,5 deg", "atan2(1,2)", "0"]
    T = matrix([0.4005, 0, 0], [np.pi / 8, np.arctan2(1, 2), 0])
    assert np.abs(read(file, head + part.join(cells)) - T).max() < 1e-15


def test_degrees_and_millimetres_that_were_not_told_are_named_once(run, tmp_path):
    """The first pose with a bare angle over a turn, and the first far away; none with a unit."""
    path = tmp_path / "in.csv"
    head, row = "x,y,z,roll,pitch,yaw\n", "0.4,0,0.3,0,{},0\n"
    turn, far = "180 rad is more than a full turn; degrees meant?", "millimetres meant?"
    for pitches in (["0", "180", "180"], ["pi/2", "180", "180"]):
        path.write_text(head + "".join(map(row.format, pitches)))
        for argv in (["ik", "ur5", "--csv", path], ["path", "ur5", path]):
            err = run(*argv)[2]
            assert (err.count(turn), err.count(f"in.csv:3: {turn}"), far in err) == (1, 1, False)
            assert turn not in run(*argv, "--deg")[2]
    for text in (
        head + row.format("720deg"),
        head.replace("pitch", "pitch [deg]") + "0,0,1,0,720,0",
    ):
        path.write_text(text)
        assert "warning" not in run("ik", "ur5", "--csv", path)[2]
    path.write_text(head + "400,0,300,0,0,0\n" * 2)
    err = run("ik", "ur5", "--csv", path)[2]
    assert (err.count(far), "in.csv:2: 500 m from the base" in err, turn in err) == (1, True, False)
    pose = ["ik", "ur5", "--xyz", "0.4", "0", "0.3", "--rpy", "0"]
    assert f"the pose: {turn}" in run(*pose, "180", "0")[2]
    for one in (["180", "0", "--deg"], ["720deg", "0"], ["pi", "0"]):
        assert "warning" not in run(*pose, *one)[2]
    assert far in run("ik", "ur5", "--xyz", "400", "0", "300", "--rpy", "0", "0", "0")[2]


def test_a_quaternion_is_normalised_or_refused(file):
    """Three decimals are brought to norm 1; zero, two and half are refused with their norm."""
    head = "x,y,z,qx,qy,qz,qw\n"
    T = read(file, head + "0,0,0,0.707,0,0,0.707")
    assert np.abs(T - matrix([0, 0, 0], [np.pi / 2, 0, 0])).max() < 1e-12
    for q in ("0,0,0,0", "0,0,2,0", "0.5,0,0,0", "nan,0,0,1", "inf,0,0,1"):
        with pytest.raises(PoseError, match=r"poses.csv:2: (the norm|qx)"):
            read(file, f"{head}0,0,0,{q}")


FAULTS = {
    "unknown": ("x,y,z,rol,pitch,yaw\n1,2,3,0,0,0", "1: unknown column 'rol'; known are x, y, z"),
    "extra": ("x,y,z,roll,pitch,yaw,v\n1,2,3,0,0,0,1", "1: unknown column 'v'"),
    "twice": ("x,x,y,z,roll,pitch,yaw\n1,1,2,3,0,0,0", "1: a second column 'x'"),
    "both": ("x,y,z,roll,pitch,yaw,qx,qy,qz,qw\n" + "0," * 9 + "1", "1: columns .* are needed"),
    "kind": ("x [deg],y,z,roll,pitch,yaw\n1,2,3,0,0,0", "1: found unit 'deg' for x; allowed: m"),
    "gap": ("x,,y,z,roll,pitch,yaw,\n1,,2,3,0,0,0,\n1,5,2,3,0,0,0,6", "3: columns 2 and 8 have"),
    "unit": ("x [ell],y,z,roll,pitch,yaw\n1,2,3,0,0,0", "1: found unit 'ell' for x"),
    "nameless": ("0,0,0,0,0,0,1", "1: 6 or 12 or 16 .* name the columns of a quaternion"),
    "comma": ("x;y;z;roll;pitch;yaw\n1.025,4;1;2;0;0;0", "2: x: .1.025,4."),
    "late": ("1,2,3,0,0,0\n# units: mm, deg\n1,2,3,0,0,0", "2: found units"),
    "parsec": ("# units: parsec\n1,2,3,0,0,0", "1: found units: 'parsec'"),
    "far": ("1,2,1e300,0,0,0", "1: z: expected a number from -1e"),
    "endless": ("1,2,3,inf,0,0", "1: roll: 'inf': not a finite"),
    "skewed": ("1,0,0,0,0,1,0,0,0,0,1,0\n1,0,0,0,0,2,0,0,0,0,1,0", "2: rotation part is not"),
    "columns": ("x,y,z\n1,2,3\n", "1: columns x, y, z, roll"),
    "short": ("x,y,z,roll,pitch,yaw\n1,2,3\n", "2: 3 cells"),
    "number": ("1,2,3,0,0,zero\n", "1: yaw"),
    "empty": ("\n", "holds no poses"),
    "quote": ('x,y,z,roll,pitch,yaw\n"1,2,3,0,0,0', "not CSV"),
    "wide": ("x" * 200_000, "not CSV: field larger"),
}


@pytest.mark.parametrize("case", FAULTS)
def test_what_a_file_of_poses_cannot_mean_is_named(file, case):
    """The message names file and line, what was found and what is allowed."""
    text, message = FAULTS[case]
    with pytest.raises(PoseError, match=f"poses.csv:.*{message}"):
        read(file, text)


def test_a_column_that_counts_the_poses_and_empty_ones_need_no_name(file):
    """What a spreadsheet adds on either side does not change the poses."""
    bare = read(file, "x,y,z,roll,pitch,yaw\n1,2,3,0.1,0.2,0.3\n4,5,6,0.4,0.5,0.6")
    wide = read(file, ",x,y,z,,roll,pitch,yaw,\n1,1,2,3,,0.1,0.2,0.3,\n2,4,5,6,,0.4,0.5,0.6,")
    np.testing.assert_array_equal(wide, bare)


WORDS = """
x y z roll qw t00 yaw[deg] [ ° _mm units:mm 1 -0.5 0 pi/2 nan -inf 1e400
1e308 0x1 9**9**9 (((( 1_0 ٣ 90deg 400mm 0,5 sqrt(-1) 1/0 1e9999999 -1e9999999 "1 ""1"" - +
"""
CELLS = WORDS.split()
ROW = st.lists(st.sampled_from(CELLS), min_size=4, max_size=13).map(",".join)
MARKS = st.sampled_from(["\n", "#", ";", "\t", "\0", "\ufeff", "\u2028", "# units: mm, deg\n"])
HEADS = st.sampled_from([f"{','.join(layout)}\n" for layout in LAYOUTS])
NOISE = st.lists(st.one_of(ROW, MARKS, HEADS, st.text(max_size=5)), max_size=9).map("".join)
ROWS = st.lists(st.lists(st.sampled_from(CELLS), min_size=6, max_size=7).map(",".join), max_size=3)
SHEETS = st.one_of(NOISE, st.builds(lambda head, rows: head + "\n".join(rows), HEADS, ROWS))


@hostile(text=SHEETS, deg=st.booleans())
def test_hostile_files_of_poses_are_poses_or_one_message(text, deg):
    """Any text is a stack of rigid poses or a PoseError."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "poses.csv"
        path.write_bytes(text.encode("utf-8", "surrogatepass"))
        answer = outcome(poses_of_csv, str(path), deg=deg)
    if not isinstance(answer, Exception):
        R = answer.T[:, :3, :3]
        assert np.abs(R @ np.swapaxes(R, 1, 2) - np.eye(3)).max() < 1e-5
