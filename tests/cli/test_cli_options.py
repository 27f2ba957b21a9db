"""Options of every verb: numbers read alike, bounds, options that go together, hostile lines."""

import contextlib
import importlib
import inspect
import io
import json
import os
import tempfile
import time
import warnings

import numpy as np
import pytest
from hostile import hostile
from hypothesis import strategies as st

import dh2urdf
from dh2urdf.cli import ROOMS, VERBS, main

POSE = ["--xyz=0,0,0", "--rpy=0,0,0"]
FEW = ["--points", "5", "--orientations", "2"]


def call(*argv, stdin=""):
    """Run the command line in a new folder: status, stdout, stderr, files left behind."""
    out, err, back = io.StringIO(), io.StringIO(), os.getcwd()
    with tempfile.TemporaryDirectory() as folder, pytest.MonkeyPatch.context() as patch:
        patch.setattr("sys.stdin", io.StringIO(stdin))
        os.chdir(folder)
        try:
            with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
                main([str(a) for a in argv])
        except SystemExit as stop:
            status = stop.code
        finally:
            left = sorted(os.listdir())
            os.chdir(back)
    return status, out.getvalue(), err.getvalue(), left


NEGATIVE = [
    ["workspace", "ur5", "-o", "x.png", "--at", "-0.1", *FEW],
    ["workspace", "ur5", "-o", "x.png", "--at", "-100mm", *FEW],
    ["workspace", "ur5", "-o", "x.png", "--rpy", "0", "-90", "0", "--deg", *FEW],
    ["workspace", "ur5", "-o", "x.png", "--rpy", "0", "-pi/2", "-90deg", *FEW],
    ["workspace", "ur5", "-o", "x.png", "--rpy=0,-1e-3,0", *FEW],
    ["figure", "planar_rr", "-o", "x.png", "--view", "300", "-20"],
    ["figure", "planar_rr", "-o", "x.png", "--view", "-60deg", "-.3rad", "--q", "-pi/3", "-(1)"],
]


@pytest.mark.parametrize("argv", NEGATIVE, ids=[" ".join(a[4:7]) for a in NEGATIVE])
def test_negative_values_are_values_at_every_option(argv):
    """A value that begins with a minus is read, and the picture is written."""
    status, _, err, left = call(*argv)
    assert (status, err, left) == (0, "", ["x.png"])


def test_a_negative_value_means_the_same_as_by_an_equals_sign():
    """--rpy 0 -pi/2 0, --rpy=0,-pi/2,0 and degrees are one pose; so are joint values."""
    ways = (
        ["--xyz", "-.4", "-100mm", ".3", "--rpy", "0", "-pi/2", "-90deg"],
        ["--xyz=-.4,-0.1,.3", "--rpy=0,-pi/2,-pi/2"],
        ["--xyz", "-400mm", "-1e-1", "3e-1", "--rpy", "-0", "-90", "-acos(0)", "--deg"],
    )
    poses = [json.loads(call("ik", "ur5", *way, "--json")[1])["T_base_tip"] for way in ways]
    assert np.abs(np.array(poses) - poses[0]).max() < 1e-15
    q = [-1.0, -np.pi / 2, 0.0, 0.0, 0.0, 0.0]
    for way in (
        ["-1", "-pi/2", "0", "0", "0", "0"],
        ["--q", "-1", "-90deg", "0", "0", "0", "0"],
        ["--", "-1", "-pi/2", "0", "0", "0", "0"],
    ):
        assert json.loads(call("fk", "ur5", "--json", *way)[1])["q"] == q
        assert json.loads(call("fk", "--json", "ur5", *way)[1])["q"] == q


def test_options_before_two_hyphens_count():
    """--deg before -- holds for the values behind it; sources stand before and behind options."""
    status, _, err, left = call("convert", "ur5", "--out-dir", "x", "ur3", "--force", "--", "ur10")
    assert (status, err, left) == (0, "", ["x"])
    assert call("check", "nowhere.urdf", "--json", "--", "-1.urdf")[1].count("there is no") == 2
    a = call("fk", "ur5", "--deg", "--json", "--", "-90", "0", "0", "0", "0", "0")
    assert json.loads(a[1])["q"][0] == -np.pi / 2


BEYOND = [
    (["figure", "ur5", "-o", "x.png", "--dpi"], ["-5", "0", "5000", "inf", "nan", "1e400", "x"]),
    (["figure", "ur5", "-o", "x.png", "--view"], ["-20", "0 nan", "1 2 3", "inf 0", "1e300 0"]),
    (["workspace", "ur5", "-o", "x.png", "--at"], ["inf", "nan", "1e300", "-1e99", "90deg", ""]),
    (["workspace", "ur5", "-o", "x.png", "--rpy"], ["0 0", "0 nan 0", "inf 0 0", "0 0 1e300"]),
    (["workspace", "ur5", "-o", "x.png", "--points"], ["-1", "0", "1", "1e6", "2.5", "nan"]),
    (["workspace", "ur5", "-o", "x.png", "--orientations"], ["0", "-3", "100000000", "1.5", "inf"]),
    (["workspace", "ur5", "-o", "x.png", "--dpi"], ["-1", "1e9", "nan"]),
    (["map", "ur5", "-o", "x.zarr", "--step"], ["0", "-1", "nan", "inf", "90deg", "1e-5", ""]),
    (["map", "ur5", "-o", "x.zarr", "--region"], ["0 1", "0 1 0 1 1 0", "0 nan 0 1 0 1"]),
    (["map", "ur5", "-o", "x.zarr", "--towards"], ["0 0", "0 0 0", "inf 0 0"]),
    (["map", "ur5", "-o", "x.zarr", "--orientations"], ["0", "1.5", "1e9"]),
    (["map", "ur5", "-o", "x.zarr", "--refine"], ["-1", "7", "0.5"]),
    (["convert", "ur5", "-o", "x.urdf", "--digits"], ["-1", "1.5", "99", "nan", "x", "1e308"]),
    (["extract", "x.urdf", "--snap"], ["-1", "nan", "inf", "1e30", "x", "1"]),
    (["view", "ur5", "--port"], ["-1", "65536", "1.5", "nan", "1e400"]),
    (["ik", "ur5", "--matrix"], ["1e308 " * 12, "nan " * 16, "1 2 3"]),
    (
        ["ik", "ur5", "--rpy=0,0,0", "--xyz"],
        ["1e308 0 0", "0 nan 0", "0 0", "-inf 0 0", "90deg 0 0"],
    ),
    (["ik", "ur5", "--xyz=0,0,0", "--rpy"], ["1e308 0 0", "0 nan 0", "0 0", "1m 0 0"]),
    (["ik", "ur5", *POSE, "--seed"], ["", "1", "1e300 0 0 0 0 0", "nan " * 6]),
    (["ik", "ur5", *POSE, "--locked"], ["0", "0=", "0=nan", "0=1e300", "9=1"]),
    (["fk", "ur5", "--q"], ["1", "inf 0 0 0 0 0", "1e300 0 0 0 0 0", "0 0 0 0 0 400mm"]),
    (["show", "ur5", "--q"], ["1", "nan 0 0 0 0 0"]),
]


@pytest.mark.parametrize(("argv", "values"), BEYOND, ids=[" ".join(a) for a, _ in BEYOND])
def test_what_no_option_can_mean_is_one_message(argv, values):
    """Out of bounds, not finite, not a number: status 2, the option is named, nothing is left."""
    for value in values:
        status, out, err, left = call(*argv, *value.split())
        assert (status, out, left) == (2, "", []), value
        assert argv[-1].lstrip("-") in err
        assert err.count("\n") == 1
        assert "cell" not in err


@pytest.mark.parametrize(
    ("argv", "allowed"),
    [
        (["convert", "ur5", "-o", "x.urdf", "--digits", "1e308"], "a whole number from 0 to 17"),
        (["workspace", "ur5", "-o", "x.png", "--points", "1e308"], "a whole number from 2 to 1000"),
        (["extract", "x.urdf", "--snap", "1"], "a number from 0 to 0.1"),
    ],
)
def test_a_number_beyond_the_bounds_of_its_option_is_told_those_bounds(argv, allowed):
    """The message has what the option takes, not what any number may be."""
    status, _, err, _ = call(*argv)
    assert status == 2
    assert f"{argv[-2]}: expected {allowed}, got {argv[-1]!r}\n" in err


DENSO = ["ik", "denso_vs6556"]
POSED = [*DENSO, "--xyz", "0.4", "0", "0.3", "--rpy", "0", "180", "0", "--deg"]
USAGE = [
    (["fk", "denso"], "did you mean"),
    (["fk", "ur5", "0", "0"], "6 values are needed"),
    (["fk", "ur5", "0", "0", "0", "0", "x", "0"], "wrist_2_joint"),
    (["fk", "nowhere.urdf", "0"], "nowhere.urdf"),
    (["convert"], "TABLES"),
    (["convert", "ur5", "ur3", "-o", "x.urdf"], "--out-dir"),
    (["convert", "ur5", "-o", "no/such/folder/x.urdf"], "folder"),
    (["show", "ur5", "--format", "word"], "latex"),
    (["frobnicate"], "frobnicate"),
    (["fk", "ur5", "--nonsense"], "nonsense"),
    (DENSO, "a pose is needed"),
    ([*DENSO, "--xyz", "1", "2"], "3 numbers are needed, got 2"),
    ([*DENSO, "--xyz", "1", "2", "3"], "--rpy is needed"),
    ([*DENSO, "--xyz", "1", "x", "3", "--rpy", "0", "0", "0"], "--xyz"),
    ([*DENSO, "--matrix", "1", "2"], "12 or 16 numbers"),
    ([*DENSO, "--matrix", *"2000020000200001"], "orthonormal"),
    ([*DENSO, "--csv", "nowhere.csv"], "nowhere.csv"),
    ([*POSED, "--csv", "x.csv"], "stands alone"),
    ([*POSED, "--locked", "elbow=1"], "joint_1"),
    ([*POSED, "--locked", "joint_1"], "joint=value"),
    ([*POSED, "--task", "wish"], "position+axis"),
    ([*POSED, "--seed", "1"], "6 values"),
    ([*POSED, "--nearest"], "--nearest"),
    (["show", "ur5", "--deg"], "--q"),
    (["ik", "ur5", "--csv", "x.csv", "--xyz", "1", "2", "3"], "stands alone"),
    (["ik", "ur5", "--csv", "x.csv", "--matrix", "1"], "stands alone"),
    (["ik", "-", "--csv", "-"], "ROBOT -"),
    (["ik", "ur5", "--symbolic", "--json", "--format", "md"], "--json stands alone: --format"),
    (["check", "x.urdf", "--json", "--format", "html"], "--format html does nothing"),
    (["fk", "-", "0"], "empty"),
    (["fk", "-", "0", "--tip", "x"], "not XML"),
    (["ik", "ur5", "--matrix", "1", "--rpy", "1", "2", "3"], "--matrix"),
    (["ik", "ur5", "--xyz=1,2,3", "--rpy=0,0,0", "--task", "position"], "--task position"),
    (["figure", "ur5", "-o", "x.svg", "--dpi", "90"], "--output .svg"),
    (["figure", "ur5", "-o", "x.png", "--deg"], "--q"),
    (["workspace", "ur5", "-o", "x.png", "--deg"], "--rpy"),
    (["workspace", "planar_rr", "-o", "x.png", "--orientations", "9"], "orientations"),
    (["workspace", "franka_fer", "-o", "x.png", "--rpy", "0", "0", "0"], "rpy"),
    (["workspace", "ur5", "-o", "x.png", "--envelope", "--plane", "xz"], "--plane"),
    (["workspace", "ur5", "--exact", "--at", "0.1"], "--at"),
    (["workspace", "ur5"], "--output is needed"),
    (["workspace", "arm.zarr", "-o", "x.png"], "no such map"),
    (["workspace", "arm.zarr", "-o", "x.png", "--envelope"], "--envelope does nothing"),
    (["workspace", "ur5", "-o", "x.png", "--against", "arm.zarr"], "--against does nothing"),
    (["view", "ur5", "-o", "x.html", "--map", "arm.zarr"], "--map"),
    (["workspace", "franka_fer", "--exact", "-o", "x.png"], "no wrist point"),
    (["map", "ur5", "-o", "x.zarr", "--spins", "3"], "--towards"),
    (["figure", "planar_rr", "-o", "x.png", "--task", "position"], "--branches"),
    (["place", "ur5", "-", "--against", "-"], "stdin holds one"),
    (["place", "ur5", "x.csv", "--dpi", "90"], "--output"),
    (["view", "--tip", "x"], "ROBOT"),
    (["view", "-o", "x.html"], "ROBOT"),
    (["view", "ur5", "--force"], "--output"),
    (["extract", "x.urdf", "--force"], "--output"),
    (["fk", "planar_rr", "0", "--q", "0"], "--q"),
    (["convert", "ur5", "-o", "x.yaml", "--no-dh-frames"], ".yaml"),
    (["convert", "ur5", "-o", "x.urdf", "--out-dir", "y"], "--out-dir"),
]


@pytest.mark.parametrize(("argv", "word"), USAGE, ids=[" ".join(a) for a, _ in USAGE])
def test_bad_usage_and_options_that_do_nothing_together_are_refused(argv, word):
    """Status 2 and what is wrong, or the other option's name; nothing is written."""
    status, out, err, left = call(*argv)
    assert (status, left) == (2, [])
    assert not out or "--json" in argv
    assert word in err
    assert "Traceback" not in err


def test_a_plane_that_meets_a_planar_arm_in_a_line_is_status_1():
    """It is said which plane the arm moves in, and no picture of a line is written."""
    status, out, err, left = call("workspace", "planar_rr", "-o", "x.png", "--plane", "xz")
    assert (status, out, left) == (1, "", [])
    assert "moves in a plane xy: the plane xz meets it in a line only" in err


def test_a_section_beside_the_workspace_is_status_1():
    """A plane that the arm does not reach is said, and no picture of nothing is written."""
    for robot in ("ur5", "planar_rr", "planar_rrr"):
        status, out, err, left = call("workspace", robot, "-o", "x.png", "--at", "99", *FEW[:2])
        assert (status, out, left) == (1, "", [])
        assert "99 m misses everything" in err


ROBOTS = st.sampled_from(
    ["ur5", "planar_rr", "planar_rrr", "kinova_gen3", "nowhere", "a.yaml", "-"]
)
NUMBERS = """
0 1 -1 -0.5 90 -90deg pi/2 -pi/2 400mm -1e-3 1e9999999 -1e9999999 nan -nan inf -inf 1e308 1e-320
9**9**9 (((( -( -- - + 1_0 1,2,3 -1,-2,-3 0=1 0=nan joint_1=.1 ٣ -π q sqrt(-1) 1/0 -.5.5 0x1F
"""
WORDS = """
a.png a.svg b.pdf c.urdf -o --output --json --deg --force --q --rpy --xyz --matrix --csv --seed
--locked --task position --turns all nearest --no-within-limits --base --tip base_link tool0 --at
--points 3 --orientations 2 --dpi --plane xz --view --no-frames --no-table --style schematic
--branches
--format csv latex text --symbolic --digits --snap --convention modified --explain --help
--version --debug=1 --no-limits --flip --x-axis away --no-run --=x --x=
"""
TOKENS = st.one_of(
    st.sampled_from(NUMBERS.split()),
    st.sampled_from(WORDS.split()),
    st.text(max_size=6),
    st.sampled_from(["", " ", "\0", "\ud800", "\uffff", "x" * 300, "-\n", "é.png", "/dev/null"]),
)
POSES = st.tuples(*[st.sampled_from(NUMBERS.split())] * 6).map(
    lambda v: ["--xyz", *v[:3], "--rpy", *v[3:]]
)
LINES = st.one_of(
    st.tuples(st.sampled_from(sorted(set(VERBS) - {"view"})), ROBOTS, st.lists(TOKENS, max_size=7)),
    st.tuples(st.just("ik"), ROBOTS, POSES),
    st.tuples(st.just("fk"), ROBOTS, st.lists(st.sampled_from(NUMBERS.split()), max_size=7)),
)


@hostile(line=LINES, stdin=st.one_of(st.just(""), st.text(max_size=20)))
def test_hostile_command_lines_are_answers_or_one_message(line, stdin):
    """Status 0, 1 or 2 within ten seconds; no traceback, no warning; refusals leave no file."""
    verb, robot, tokens = line
    for last in (False, True):  # a first call may have to wait for a compiler
        start = time.monotonic()
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            status, _, err, left = call(verb, robot, *tokens, stdin=stdin)
        if time.monotonic() - start < 10.0:
            break
        assert not last
    assert status in (0, 1, 2)
    assert "Traceback" not in err
    assert status != 2 or err.strip()
    several = verb == "convert" and len(tokens) > 0
    assert status == 0 or left == [] or several  # of several tables the good ones are written


def test_the_reading_of_a_robot_goes_by_the_same_names():
    """Every verb of the table has a module and help of its own."""
    for verb in VERBS:
        status, out, err, _ = call(verb, "--help")
        assert (status, err) == (0, "")
        module = importlib.import_module(f"dh2urdf.cli.verbs.{ROOMS.get(verb, verb)}")
        first = inspect.getdoc(getattr(module, f"{verb}_")).splitlines()[0]
        assert " ".join(first.split()[:6]).rstrip(".") in " ".join(out.split())
        assert " ".join(VERBS[verb].split()[:4]) in " ".join(call("--help")[1].split())
    assert dh2urdf.__version__ in call("--version")[1]
