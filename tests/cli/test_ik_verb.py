"""``dh2urdf ik`` as a user meets it."""

import csv
import io
import json
import math
import os

import numpy as np
import pytest

import dh2urdf

POSE = ["--xyz", "0.4", "0", "0.3", "--rpy", "0", "180", "0", "--deg"]


def target():
    return dh2urdf.transforms.origin_matrix([0.4, 0, 0.3], [0, math.pi, 0])


def test_solutions_are_printed_with_branch_and_residual(run):
    """Eight rows, those inside the limits first, the others marked with by how much."""
    status, out, _ = run("ik", "denso_vs6556", *POSE, "--no-within-limits")
    rows = out.splitlines()[2:]
    assert status == 0
    assert len(rows) == 8
    assert "shoulder left, elbow up" in rows[0]
    assert "outside limits" not in rows[0]
    assert "outside limits: joint_" in rows[-1]
    assert "joint_1 [deg]" in out


def test_json_has_full_precision(run):
    """The solutions of --json put the tip at the pose, to 1e-12, by forward kinematics."""
    status, out, _ = run("ik", "denso_vs6556", *POSE, "--json", "--no-within-limits")
    found = json.loads(out)
    robot = dh2urdf.Robot.from_dh("denso_vs6556")
    assert (status, found["schema"], found["solver"]) == (0, 1, "spherical wrist")
    assert len(found["solutions"]) == 8
    for solution in found["solutions"]:
        assert np.abs(robot.fk(solution["q"]) - target()).max() < 1e-12
        assert solution["residual"] < 1e-12
    assert sum(not s["outside_limits"] for s in found["solutions"]) == len(robot.ik(target()))


def test_matrix_and_units_name_the_same_pose(run):
    """--matrix with 12 numbers, and lengths in mm: the same solutions."""
    cells = [repr(v) for v in target()[:3].ravel().tolist()]
    a = json.loads(run("ik", "denso_vs6556", *POSE, "--json")[1])
    b = json.loads(run("ik", "denso_vs6556", "--matrix", *cells, "--json")[1])
    c = json.loads(run("ik", "denso_vs6556", "--xyz=400mm,0,300mm", "--rpy=0,pi,0", "--json")[1])
    for other in (b, c):
        q = [s["q"] for s in other["solutions"]]
        assert np.abs(np.array(q) - [s["q"] for s in a["solutions"]]).max() < 1e-9


@pytest.mark.parametrize(
    "rpy", ["0 -90deg 0", "0 -pi/2 0", "0,-pi/2,0", "-(pi-pi) -1.570796326794897 0"]
)
def test_values_may_begin_with_a_minus(run, rpy):
    """A minus before a number with a unit, pi or a bracket is no option."""
    argv = ["--xyz", "0.5", "-100mm", "0.2", "--rpy", *rpy.split(), "--json"]
    status, out, _ = run("ik", "puma560", *argv)
    assert status == 0
    T = np.array(json.loads(out)["T_base_tip"])
    expected = [[0, 0, -1, 0.5], [0, 1, 0, -0.1], [1, 0, 0, 0.2], [0, 0, 0, 1]]
    assert np.abs(T - expected).max() < 1e-12


def test_seed_sorts(run):
    """With --seed the first solution is the one nearest to it."""
    robot = dh2urdf.Robot.from_dh("denso_vs6556")
    seed = [0, -69, 38, 0, 31, 180]
    out = run("ik", "denso_vs6556", *POSE, "--seed", *seed, "--json")[1]
    q = np.array([s["q"] for s in json.loads(out)["solutions"]])
    distance = np.linalg.norm(q - np.radians(seed), axis=1)
    assert (np.diff(distance) >= 0).all()
    assert np.abs(q[0] - np.radians(seed)).max() < 0.02
    assert robot.n == 6


def test_out_of_reach_is_status_1_with_a_reason(run):
    """The reason names the wrist centre and the distance; nothing is on stdout."""
    status, out, err = run("ik", "denso_vs6556", "--xyz", "1.5", "0.1", "0.3", "--rpy", 0, 0, 0)
    assert (status, out) == (1, "")
    assert "the wrist centre lies 0.8" in err
    assert "m outside the reach of joints 1 to 3" in err


def test_outside_the_limits_is_status_1_and_shown(run):
    """All solutions outside: they are printed, marked, and the least excess is named."""
    argv = ["ik", "denso_vs6556", "--xyz", 0.1, 0, 0.3, "--rpy", 0, 180, 0, "--deg"]
    status, out, err = run(*argv, "--no-within-limits")
    assert status == 1
    assert out.count("outside limits") == 8
    assert "all 8 solutions are outside the joint limits, the nearest by 0.17" in err
    status, out, err = run(*argv)
    assert (status, out) == (1, "")
    assert err.rstrip().endswith("--no-within-limits shows them")


@pytest.mark.parametrize("pose", [POSE, ["--xyz=.2,.3,.3", "--rpy=0,3,0"]])
def test_limits_are_kept_as_by_the_method(run, pose):
    """Without an option ik and Robot.ik give the same solutions, of a pose and of a file."""
    found = json.loads(run("ik", "denso_vs6556", *pose, "--json")[1])
    q = dh2urdf.Robot.from_dh("denso_vs6556").ik(found["T_base_tip"]).q
    assert 0 < len(q) < 8
    np.testing.assert_array_equal([s["q"] for s in found["solutions"]], q)


class Terminal(io.StringIO):
    """What stands for a terminal."""

    encoding = "utf-8"

    def isatty(self):
        """As a terminal would answer."""
        return True


@pytest.mark.parametrize("arm", ["ur5", "denso_vs6556", "franka_fer", "kuka_iiwa14", "planar_rr"])
@pytest.mark.parametrize("unit", [(), ("--deg",)])
def test_solutions_fit_a_terminal_of_80_columns(run, monkeypatch, arm, unit):
    """No line is longer, and what is read back reaches the pose to the digits that are shown."""
    robot = dh2urdf.Robot.from_dh(arm)
    T = robot.fk(np.clip(np.full(robot.n, -0.7), robot.lower, robot.upper))
    monkeypatch.setenv("COLUMNS", "80")
    monkeypatch.setattr("sys.stdout", screen := Terminal())
    cells = [repr(v) for v in T.ravel().tolist()]
    run("ik", arm, "--matrix", *cells, *unit, "--no-within-limits")
    lines = screen.getvalue().splitlines()
    assert max(map(len, lines)) <= 80
    assert "-" not in screen.getvalue().replace("e-", "")
    rule = next(i for i, line in enumerate(lines) if set(line) == {"─"})
    rows = [line.replace("−", "-").split() for line in lines[rule + 1 :] if line[:4].strip()]
    assert len(rows) == len(robot.ik(T, within_limits=False))
    for row in rows:
        q = np.array(row[1 : robot.n + 1], float)
        assert np.abs(robot.fk(np.radians(q) if unit else q) - T).max() < 2e-3


def test_numbers_in_a_pipe_are_ascii(run):
    """What is not printed on a terminal has the hyphen that programs read."""
    for argv in (
        ["ik", "ur5", *POSE],
        ["fk", "ur5", "1", "1", "1", "1", "1", "1"],
        ["show", "ur5"],
    ):
        out = run(*argv)[1]
        assert "−" not in out
        assert "-" in out


def test_csv_of_many_poses(run, tmp_path):
    """Each line is a pose; the answer is CSV; a pose without solution is named by its line."""
    lines = ["z,x,y,roll,pitch,yaw", "0.3,0.4,0,0,180,0", "", "# far", "0,5,0,0,0,0"]
    (tmp_path / "poses.csv").write_text("\n".join(lines))
    status, out, err = run(
        "ik", "denso_vs6556", "--csv", "poses.csv", "--deg", "--no-within-limits"
    )
    rows = list(csv.DictReader(io.StringIO(out)))
    robot = dh2urdf.Robot.from_dh("denso_vs6556")
    assert status == 1
    assert {row["pose"] for row in rows} == {"1"}
    assert len(rows) == 8
    for row in rows:
        q = np.radians([float(row[f"{name} [deg]"]) for name in robot.joint_names])
        assert np.abs(robot.fk(q) - target()).max() < 1e-12
    assert "poses.csv:5: no solution" in err
    found = json.loads(run("ik", "denso_vs6556", "--csv", "poses.csv", "--deg", "--json")[1])
    assert found["unreached"] == [1]


def test_csv_of_matrices(run, tmp_path):
    """Lines of 16 entries are matrices."""
    (tmp_path / "poses.csv").write_text(",".join(repr(v) for v in target().ravel().tolist()))
    status, out, _ = run("ik", "denso_vs6556", "--csv", "poses.csv", "--no-within-limits")
    assert status == 0
    assert len(out.splitlines()) == 9


def test_tasks_and_held_joints(run):
    """--task position takes a point; --locked keeps a joint."""
    found = json.loads(run("ik", "planar_rr", "--xyz=1,0.5,0", "--task", "position", "--json")[1])
    assert [s["branch"] for s in found["solutions"]] == ["elbow up", "elbow down"]
    out = run("ik", "denso_vs6556", *POSE, "--locked", "joint_6=0", "--json")[1]
    assert all(s["q"][5] == 0 for s in json.loads(out)["solutions"])


def test_all_turns_of_poses_in_a_file(run, refused, tmp_path):
    """--turns all lists for every line what it lists for one pose; a bad word is refused."""
    (tmp_path / "poses.csv").write_text("0.4,0.2,0.3,0,3,0\n0.3,0.2,0.3,0,3,0\n")
    status, out, _ = run("ik", "ur5", "--csv", "poses.csv", "--turns", "all")
    rows = list(csv.DictReader(io.StringIO(out)))
    one = run("ik", "ur5", "--xyz=0.4,0.2,0.3", "--rpy=0,3,0", "--turns", "all", "--json")[1]
    assert status == 0
    assert [row["pose"] for row in rows].count("1") == len(json.loads(one)["solutions"]) == 512
    assert "nearest" in refused("ik", "ur5", "--csv", "poses.csv", "--turns", "bogus")


def test_a_seed_sorts_the_solutions_of_every_line(run, tmp_path):
    """With --seed each line's solutions are those of one pose with that seed."""
    (tmp_path / "poses.csv").write_text("0.4,0.2,0.3,0,3,0\n0.3,0.2,0.3,0,3,0\n")
    seed = ["--seed", "-1", "-1", "1", "0", "-9deg", "1"]
    rows = list(csv.DictReader(io.StringIO(run("ik", "ur5", "--csv", "poses.csv", *seed)[1])))
    names = dh2urdf.load_table("ur5").joint_names
    for pose, x in (("1", "0.4"), ("2", "0.3")):
        one = run("ik", "ur5", f"--xyz={x},0.2,0.3", "--rpy=0,3,0", *seed, "--json")[1]
        q = [[float(row[n]) for n in names] for row in rows if row["pose"] == pose]
        assert np.abs(np.array(q) - [s["q"] for s in json.loads(one)["solutions"]]).max() < 1e-9


def test_a_file_of_poses_that_never_ends_is_refused(refused, tmp_path):
    """A pipe without a writer and a device without an end are one message each."""
    os.mkfifo(tmp_path / "pipe")
    for path in ("pipe", "/dev/zero", ".", "\0", "x" * 300):
        assert refused("ik", "ur5", "--csv", path).count("\n") == 1


def test_a_joint_is_held_once(refused):
    """Two values for one joint, by name or number, are refused."""
    for second in ("shoulder_pan_joint=.2", "0=.2", "0=.1"):
        argv = ["--xyz=.4,.2,.3", "--rpy=0,0,0", "--locked", "0=.1", "--locked", second]
        assert "shoulder_pan_joint is held twice" in refused("ik", "ur5", *argv)


def rounded(digits):
    """A pose with a tilted tool, as somebody typed it."""
    T = dh2urdf.transforms.origin_matrix([0.4, 0.05, 0.3], [0.3, 2.9, 0.2])
    return T, T.round(digits)


@pytest.mark.parametrize("digits", [2, 3, 4, 5])
def test_a_rounded_matrix_is_refused_with_a_hint_and_solved_with_nearest(run, refused, digits):
    """--nearest takes the nearest rotation of a matrix or of a file, and says how far it was."""
    T, typed = rounded(digits)
    cells = [repr(float(v)) for v in typed[:3].ravel()]
    err = refused("ik", "denso_vs6556", "--matrix", *cells)
    assert "--nearest" in err
    assert "--matrix: rotation part is not orthonormal" in err
    status, out, err = run(
        "ik", "denso_vs6556", "--matrix", *cells, "--nearest", "--no-within-limits"
    )
    assert (status, len(out.splitlines())) == (0, 10)
    off = float(err.split("off by ")[1].split(" rad")[0])
    assert off == pytest.approx(np.abs(np.linalg.svd(typed[:3, :3])[1] - 1).max(), rel=0.1)
    _, out, _ = run("ik", "denso_vs6556", "--matrix", *cells, "--nearest", "--json")
    found = json.loads(out)
    assert found["pose_change"] == pytest.approx(off, rel=0.1)
    assert np.abs(np.array(found["T_base_tip"]) - T).max() < 2 * 10.0**-digits


def test_rounded_matrices_of_a_file_are_named_by_line_or_taken(run, refused, tmp_path):
    """Without --nearest the line is named; with it only what was never a rotation."""
    _, typed = rounded(4)
    row = ",".join(repr(float(v)) for v in typed[:3].ravel())
    (tmp_path / "poses.csv").write_text(f"{row}\n\n{row}\n")
    assert "poses.csv:1: rotation part" in refused("ik", "denso_vs6556", "--csv", "poses.csv")
    status, out, err = run(
        "ik", "denso_vs6556", "--csv", "poses.csv", "--nearest", "--no-within-limits"
    )
    assert (status, len(out.splitlines())) == (0, 17)
    assert err.startswith("--nearest: the rotation was off by ")
    (tmp_path / "poses.csv").write_text(f"{row}\n{','.join(['0.7'] * 12)}\n")
    err = refused("ik", "denso_vs6556", "--csv", "poses.csv", "--nearest")
    assert "poses.csv:2: rotation part is 1.1 away from the nearest rotation" in err


def test_solutions_farther_from_the_seed_than_allowed_are_left_out(run):
    """--seed-tolerance, one value or one a joint; if it leaves none, by how much, and status 1."""
    start = np.radians([5, -60, 40, 10, 40, 170])
    seed = ["--seed", *map(repr, np.degrees(start).tolist())]
    every = json.loads(run("ik", "denso_vs6556", *POSE, *seed, "--json")[1])["solutions"]
    gaps = [np.abs(np.angle(np.exp(1j * (np.array(s["q"]) - start)))) for s in every]
    least = min(gap.max() for gap in gaps)
    most = repr(math.degrees(least) + 1e-6)
    for tolerance in ([most], [most] * 6):
        status, out, _ = run(
            "ik", "denso_vs6556", *POSE, *seed, "--seed-tolerance", *tolerance, "--json"
        )
        near = json.loads(out)["solutions"]
        assert (status, [s["q"] for s in near]) == (0, [every[0]["q"]])
    status, out, err = run("ik", "denso_vs6556", *POSE, *seed, "--seed-tolerance", "1e-3")
    assert (status, out) == (1, "")
    by = f"nearest by {least - math.radians(1e-3):.4g} rad at joint_"
    many = f"all {len(every)} solutions"
    assert f"{many} are farther from the seed than --seed-tolerance allows, the {by}" in err
    status, _, err = run("ik", "denso_vs6556", *POSE, "--seed-tolerance", "1")
    assert (status, err.strip()) == (2, "dh2urdf: --seed-tolerance does nothing without --seed")


WORDS = {"kuka_kr6_r700": "kuka", "abb_irb140": "abb", "fanuc_lrmate200id": "fanuc"}


@pytest.mark.parametrize(("name", "maker"), WORDS.items())
def test_words_of_a_controller_stand_beside_the_solutions(run, tmp_path, name, maker):
    """--words in the table before the branch, in JSON and CSV as word; all as IKSolutions.words."""
    robot = dh2urdf.Robot.from_dh(name)
    words = [str(word) for word in robot.ik(target()).words(maker)]
    assert len(words) > 1
    out = run("ik", name, *POSE, "--words", maker)[1]
    branches = [f"{w}; {b}" for w, b in zip(words, robot.ik(target()).branch, strict=True)]
    assert all(any(line.endswith(b) for line in out.splitlines()) for b in branches)
    told = json.loads(run("ik", name, *POSE, "--words", maker, "--json")[1])
    assert [solution["word"] for solution in told["solutions"]] == words
    (tmp_path / "poses.csv").write_text("0.4,0,0.3,0,3.141592653589793,0\n")
    rows = list(
        csv.DictReader(io.StringIO(run("ik", name, "--csv", "poses.csv", "--words", maker)[1]))
    )
    assert [row["word"] for row in rows] == words
    assert "word" not in run("ik", name, "--csv", "poses.csv")[1].splitlines()[0].split(",")


def test_an_arm_without_that_shape_has_no_words(refused):
    """One message with the option, the shape and what fails."""
    err = refused("ik", "ur5e", *POSE, "--words", "kuka")
    start = (
        "dh2urdf: --words kuka: no ortho-parallel arm with a spherical wrist: axes 3 and 4 are not"
    )
    assert err.startswith(start)


def test_an_arm_with_two_joints_to_spare_says_that_it_holds_a_part(run, tmp_path):
    """Below its solutions."""
    table = tmp_path / "five.csv"
    head = "# convention: standard\n# units: m, rad\ntheta,d,a,alpha\n"
    table.write_text(head + "q,0,.3,0\n" * 5)
    status, out, _ = run("ik", str(table), "--xyz", "0.6", "0.3", "0", "--rpy", "0", "0", "0.4")
    assert status == 0
    assert out.endswith("members of a part of the solutions; --seed finds its own\n")
