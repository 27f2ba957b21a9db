"""``dh2urdf path``: one joint motion through a file of poses."""

import csv
import json

import numpy as np
import pytest

import dh2urdf


def poses_file(path, T):
    """Poses (m, 4, 4) as entries t00 ... t23."""
    path.write_text("".join(",".join(map(repr, t[:3].ravel().tolist())) + "\n" for t in T))


def answer(path, robot, deg=False):
    """Joint values and breaks of an answer."""
    rows = list(csv.DictReader(path.read_text().splitlines()))
    names, unit = (
        list(zip(robot.joint_names, (~robot.slides).tolist(), strict=True)),
        " [deg]" * deg,
    )
    q = np.array(
        [[float(row[name + unit * turns] or "nan") for name, turns in names] for row in rows]
    )
    assert [row["pose"] for row in rows] == [str(i) for i in range(1, len(rows) + 1)]
    return np.radians(q) if deg else q, [row["break"] for row in rows]


def circle(robot, m=30):
    """Poses along a joint motion (m, 4, 4)."""
    low, high = np.maximum(robot.lower, -1.5), np.minimum(robot.upper, 1.5)
    t = np.linspace(0, 1, m)[:, None]
    return robot.fk(low + (high - low) * (0.3 + 0.3 * t * np.linspace(1, 0.2, robot.n)))


@pytest.mark.parametrize("arm", ["ur5", "franka_fer", "stanford"])
def test_the_motion_goes_through_all_poses_without_a_jump(run, tmp_path, arm):
    """Every line reaches its pose by forward kinematics, joints move on, as by ``ik_path``."""
    robot = dh2urdf.Robot.from_dh(arm)
    T = circle(robot)
    poses_file(tmp_path / "in.csv", T)
    status, out, err = run("path", arm, "in.csv", "-o", "out.csv", "--figure", "q.png")
    q, breaks = answer(tmp_path / "out.csv", robot)
    done = list[tuple[int, int]]()
    path = robot.ik_path(T, progress=lambda *counts: done.append(counts))
    assert done == [(i, 30) for i in range(1, 31)]
    assert (status, err, set(breaks)) == (0, "", {"0"})
    assert out == f"out.csv: {path.summary}\nq.png\n"
    assert np.abs(robot.fk(q) - T).max() < 1e-8
    assert np.abs(np.diff(q, axis=0)).max() < 0.5
    np.testing.assert_array_equal(q, path.q)
    assert (tmp_path / "q.png").read_bytes()[:4] == b"\x89PNG"


def test_breaks_and_gaps_are_told_by_line_and_marked(run, tmp_path):
    """A jump between two places and poses out of reach: status 1, lines, cells, JSON, picture."""
    robot = dh2urdf.Robot.from_dh("denso_vs6556")
    T = np.concatenate([circle(robot)[:6], robot.fk([[2.0, 0.3, 0.4, 0.5, 0.6, 0.7]])])
    T[3:5, :3, 3] += 9.0
    poses_file(tmp_path / "in.csv", T)
    argv = ["path", "denso_vs6556", "in.csv"]
    status, out, err = run(*argv, "-o", "out.csv", "--deg", "--figure", "q.svg")
    q, breaks = answer(tmp_path / "out.csv", robot, deg=True)
    assert (status, breaks) == (1, [*"0000001"])
    assert np.isnan(q[3:5]).all()
    assert np.isfinite(q[[0, 1, 2, 5, 6]]).all()
    assert err.splitlines()[0].startswith("in.csv:7: break: joint_")
    assert err.splitlines()[0].endswith(" rad from the pose on line 6")
    gap = err.splitlines()[1]
    assert gap.startswith("in.csv: lines 4 to 5: of the first, the wrist centre lies ")
    assert "1 break, 2 out of reach" in out
    told = json.loads(run(*argv, "--json")[1])
    assert (told["breaks"], told["unreachable"], told["continuous"]) == ([6], [3, 4], False)
    assert [row is None for row in told["q"]] == [i in (3, 4) for i in range(7)]
    picture = (tmp_path / "q.svg").read_text()
    for word in ("1 break, dashed; 2 out of reach, grey", "joint_6 [deg]", "pose"):
        assert word in picture


def test_a_start_chooses_the_branch(run, tmp_path):
    """The first line is the solution nearest to --start, and motion counts from there."""
    robot = dh2urdf.Robot.from_dh("ur5")
    T = circle(robot)
    poses_file(tmp_path / "in.csv", T)
    for start in robot.ik(T[0]).q:
        argv = ["path", "ur5", "in.csv", "-o", "out.csv", "--max-jump", "3"]
        run(*argv, "--start", *map(repr, start.tolist()))
        q, _ = answer(tmp_path / "out.csv", robot)
        np.testing.assert_array_equal(q, robot.ik_path(T, start=start, max_jump=3.0).q)


def test_what_cannot_be_written_or_read_is_refused_first(refused, tmp_path):
    """A picture of another kind, somebody's file, stdin for both: one message, nothing written."""
    poses_file(tmp_path / "in.csv", circle(dh2urdf.Robot.from_dh("ur5"), 3))
    assert ".svg" in refused("path", "ur5", "in.csv", "--figure", "q.gif")
    assert "--force" in refused("path", "ur5", "in.csv", "-o", "in.csv")
    assert "stdin" in refused("path", "-", "-")
    assert sorted(p.name for p in tmp_path.iterdir()) == ["in.csv"]


def test_a_path_prints_in_a_few_lines():
    """Of a thousand poses with hundreds of breaks and gaps, print and repr show a few."""
    robot = dh2urdf.Robot.from_dh("planar_rr")
    q = np.where(np.arange(1000)[:, None] % 2, [[0.1, 0.5]], [[2.5, 0.5]])
    T = robot.fk(q)
    T[::10, :3, 3] = 9.0
    path = robot.ik_path(T)
    assert len(path.breaks) > 500
    assert len(str(path).splitlines()) <= 13
    assert repr(path) == f"<IKPath: {path.summary}>"
    assert len(repr(path)) < 100
    assert f"... and {len(path.breaks) - 5} more breaks" in str(path)


def test_a_pose_whose_point_is_reached_is_not_out_of_reach(run, tmp_path):
    """A palletiser comes to the point of a tilted pose, and path says so as ik does."""
    robot = dh2urdf.Robot.from_dh("abb_irb460")
    T = robot.fk(0.5 * (robot.lower + robot.upper) + np.array([[0.1], [0.1]]))
    T[1, :3, :3] = T[1, :3, :3] @ [[1, 0, 0], [0, 0.8, -0.6], [0, 0.6, 0.8]]
    poses_file(tmp_path / "in.csv", T)
    status, _, err = run("path", "abb_irb460", "in.csv", "-o", "out.csv")
    assert status == 1
    assert "in.csv:2: the tool reaches the point, but not with this orientation" in err
