"""``dh2urdf ik --csv`` of many poses: every solution, or the best of each, in a file."""

import csv
import json
import tracemalloc

import numpy as np
import pinocchio as pin
import pytest

import dh2urdf
from dh2urdf.cli.verbs.ik import many
from dh2urdf.cli.verbs.ik.poses import poses_of_csv


def write_poses(path, T, layout):
    """Poses (m, 4, 4) as a CSV file by Pinocchio."""
    rows = []
    for pose in T:
        R = pose[:3, :3]
        turn = pin.rpy.matrixToRpy(R) if layout == "rpy" else pin.Quaternion(R).coeffs()
        rows.append(",".join(map(repr, [*pose[:3, 3].tolist(), *turn.tolist()])))
    head = "x,y,z,roll,pitch,yaw" if layout == "rpy" else "x,y,z,qx,qy,qz,qw"
    path.write_text("\n".join([head, *rows]) + "\n")


def motion(robot, m, step=0.02):
    """A joint motion (m, n) from the middle of the limits."""
    rng = np.random.default_rng(1)
    low, high = np.maximum(robot.lower, -2.5), np.minimum(robot.upper, 2.5)
    q = 0.5 * (low + high) + 0.3 + np.cumsum(rng.uniform(-step, step, (m, robot.n)), axis=0)
    return np.clip(q, low, high)


def table(path, robot):
    """Pose and joint values of the lines of an answer, NaN where a cell is empty."""
    rows = list(csv.DictReader(path.read_text().splitlines()))
    q = [[float(row[name] or "nan") for name in robot.joint_names] for row in rows]
    return rows, np.array([int(row["pose"]) - 1 for row in rows]), np.array(q)


@pytest.mark.parametrize("arm", ["ur5", "puma560", "franka_fer", "stanford", "abb_gofa5"])
@pytest.mark.parametrize("layout", ["rpy", "quaternion"])
def test_a_file_holds_what_a_batch_finds(run, tmp_path, monkeypatch, arm, layout):
    """Every solution of every pose with all of its digits, its branch and residual, in order."""
    monkeypatch.setattr(many, "CHUNK", 17)  # several chunks
    robot = dh2urdf.Robot.from_dh(arm)
    write_poses(tmp_path / "in.csv", robot.fk(motion(robot, 40)), layout)
    status, out, err = run("ik", arm, "--csv", "in.csv", "-o", "out.csv")
    T = poses_of_csv(str(tmp_path / "in.csv"), deg=False).T
    batch = robot.ik_batch(T)
    rows, pose, q = table(tmp_path / "out.csv", robot)
    assert (status, err) == (0, "")
    assert out == f"out.csv: {batch.count.sum()} solutions, 40 of 40 poses reached\n"
    np.testing.assert_array_equal(np.bincount(pose, minlength=40), batch.count)
    np.testing.assert_array_equal(q, np.concatenate([batch[i].q for i in range(40)]))
    assert [row["branch"] for row in rows] == [name for i in range(40) for name in batch[i].branch]
    largest = max(float(row["residual"]) for row in rows)
    assert largest == pytest.approx(np.nanmax(batch.residual), rel=0.06)


@pytest.mark.parametrize("arm", ["ur5", "puma560", "franka_fer", "kuka_iiwa14", "stanford"])
def test_the_best_follow_each_other(run, tmp_path, monkeypatch, arm):
    """--best gives a line a pose; where the arm was near before, it finds the motion again."""
    monkeypatch.setattr(many, "CHUNK", 7)
    robot = dh2urdf.Robot.from_dh(arm)
    q = motion(robot, 20, step=0.004)
    write_poses(tmp_path / "in.csv", robot.fk(q), "quaternion")
    seed = ["--seed", *map(repr, q[0].tolist())]
    (tmp_path / "one.csv").write_text("\n".join((tmp_path / "in.csv").read_text().splitlines()[:2]))
    assert run("ik", arm, "--csv", "one.csv", "--best", *seed, "-o", "first.csv")[0] == 0
    first = table(tmp_path / "first.csv", robot)[2][0]
    assert np.abs(first - q[0]).max() < 1e-6
    assert run("ik", arm, "--csv", "in.csv", "--best", "-o", "out.csv")[0] == 0
    _, pose, found = table(tmp_path / "out.csv", robot)
    np.testing.assert_array_equal(pose, np.arange(20))
    for i in range(1, 20):
        nearest = robot.ik(robot.fk(q[i])).nearest(found[i - 1])
        length = np.linalg.norm(found[i] - found[i - 1])
        assert length <= np.linalg.norm(nearest - found[i - 1]) + 1e-6


def test_the_best_are_nearest_to_a_seed(run, tmp_path):
    """With --seed every line is the nearest to it; a pose out of reach is a line without values."""
    robot = dh2urdf.Robot.from_dh("ur5")
    T = robot.fk(np.random.default_rng(3).uniform(-3, 3, (9, 6)))
    T[4, :3, 3] = 5.0
    write_poses(tmp_path / "in.csv", T, "rpy")
    seed = [0.5, -1.0, 1.0, 0.2, -9.0, 1.0]
    argv = ["ik", "ur5", "--csv", "in.csv", "--best", "--seed", *seed]
    status, out, err = run(*argv, "-o", "out.csv", "--json")
    answer = json.loads(out)
    assert (status, answer["unreached"], answer["solutions"]) == (1, [4], 8)
    assert f"in.csv:6: no solution within limits: {answer['reasons']['4']}" in err
    rows, _, q = table(tmp_path / "out.csv", robot)
    for i in (0, 1, 2, 3, 5, 6, 7, 8):
        assert np.abs(q[i] - robot.ik(T[i], seed=seed).q[0]).max() < 1e-9
    assert [cell for key, cell in rows[4].items() if key != "pose"] == [""] * 9
    assert run(*argv, "--seed-tolerance", "10", "-o", "near.csv")[0] == 1
    np.testing.assert_allclose(table(tmp_path / "near.csv", robot)[2], q, atol=1e-9)
    assert run(*argv, "--seed-tolerance", "0.1")[1].splitlines()[1:] == [
        f"{i + 1}{',' * 9}" for i in range(9)
    ]


def test_positions_alone_will_do_for_the_task_position(run, refused, tmp_path):
    """x y z, with a header or without one; for a pose they are refused."""
    points = "0.3,0.4,0\n1.0,-0.2,0\n"
    for name, text in (("bare.csv", points), ("named.csv", "x [mm],y,z\n" + points)):
        (tmp_path / name).write_text(text.replace("\n0.3", "\n300").replace("\n1.0", "\n1000"))
    argv = ["ik", "planar_rr", "--task", "position", "--csv"]
    (tmp_path / "bare.csv").write_text(points)
    bare, named = run(*argv, "bare.csv")[1], run(*argv, "named.csv")[1]
    assert bare.count("\n") == 5
    a, b = (np.genfromtxt(t.splitlines(), delimiter=",", skip_header=1) for t in (bare, named))
    assert np.abs(a[:, 2:4] - b[:, 2:4]).max() < 1e-12
    assert "bare.csv:1: 6 or 12" in refused("ik", "ur5", "--csv", "bare.csv")


def test_headings_say_degrees(run, tmp_path):
    """With --deg what turns has [deg] in its heading and degrees below, what slides metres."""
    robot = dh2urdf.Robot.from_dh("stanford")
    write_poses(tmp_path / "in.csv", robot.fk(motion(robot, 3)), "rpy")
    argv = ["ik", "stanford", "--csv", "in.csv", "--best"]
    plain = list(csv.DictReader(run(*argv)[1].splitlines()))
    head, rest = (tmp_path / "in.csv").read_text().split("\n", 1)
    head = head.replace("roll,pitch,yaw", "roll [rad],pitch [rad],yaw [rad]")
    (tmp_path / "in.csv").write_text(f"{head}\n{rest}")
    given = list(csv.DictReader(run(*argv, "--deg")[1].splitlines()))
    for row, other in zip(plain, given, strict=True):
        for name, slides in zip(robot.joint_names, robot.slides, strict=True):
            value = float(other[name if slides else f"{name} [deg]"])
            assert float(row[name]) == pytest.approx(value if slides else np.radians(value))


def test_a_file_of_others_stays(refused, run, tmp_path):
    """The file of poses itself is not written over; an answer is, by the next one."""
    write_poses(tmp_path / "in.csv", dh2urdf.Robot.from_dh("ur5").fk(np.ones((1, 6))), "rpy")
    before = (tmp_path / "in.csv").read_text()
    assert "--force" in refused("ik", "ur5", "--csv", "in.csv", "-o", "in.csv")
    assert (tmp_path / "in.csv").read_text() == before
    for extra in ([], ["--best"], []):
        assert run("ik", "ur5", "--csv", "in.csv", "-o", "out.csv", *extra)[0] == 0


def test_memory_does_not_grow_with_the_answer(run, tmp_path):
    """10,000 poses have 80,000 solutions, 10 MB of text; what is held at once is less than that."""
    robot = dh2urdf.Robot.from_dh("puma560")
    rng = np.random.default_rng(0)
    T = robot.fk(rng.uniform(robot.lower, robot.upper, (10_000, 6)))
    cells = T[:, :3].reshape(-1, 12)
    np.savetxt(tmp_path / "in.csv", cells, fmt="%.12f", delimiter=",")
    tracemalloc.start()
    run("ik", "puma560", "--csv", "in.csv", "-o", "out.csv", "--no-within-limits")
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert (tmp_path / "out.csv").stat().st_size > 10e6
    assert peak < 40e6
