"""``dh2urdf place``: where a robot should stand for a file of poses."""

import json
import re

import numpy as np
import pytest

import dh2urdf
from dh2urdf.transforms import rot_z, trans

JOB = """x [mm],y [mm],z [mm],roll [deg],pitch [deg],yaw [deg]
1200,1800,200,180,0,0
1400,1800,200,180,0,30
1600,1900,250,180,0,60
"""


@pytest.fixture
def job(tmp_path):
    """A file of three poses in reach of one another."""
    (tmp_path / "job.csv").write_text(JOB)


@pytest.mark.usefixtures("job")
def test_the_base_that_is_told_reaches_the_poses(run, tmp_path):
    """Text, JSON and picture; each q reaches its pose from the base by forward kinematics."""
    status, out, err = run("place", "ur5e", "job.csv", "--yaw", "0", "--deg", "-o", "map.svg")
    assert (status, err) == (0, "")
    lines = out.splitlines()
    assert lines[0].startswith("ur5e: base at x ")
    assert "all 3 poses reached, margin 0." in lines[1]
    assert lines[-1] == "map.svg"
    assert b"margin of the worst pose" in (tmp_path / "map.svg").read_bytes()
    status, out, _ = run("place", "ur5e", "job.csv", "--yaw", "0", "--json")
    told = json.loads(out)
    robot = dh2urdf.Robot.from_dh("ur5e")
    T = np.array(told["T_world_base"]) @ robot.fk(told["q"])
    np.testing.assert_allclose(T[:, :3, 3], [[1.2, 1.8, 0.2], [1.4, 1.8, 0.2], [1.6, 1.9, 0.25]],
                               atol=1e-8)  # fmt: skip
    assert told["margin"] == min(told["margins"]) > 0.0
    signs = {sign for line in lines[4:-1] for sign in line[10:].split()}
    assert signs <= set("0123456789.")


def test_poses_in_the_way_are_told_by_line(run, tmp_path):
    """One pose 3 m off, one 3 m high: status 1, each with its line and why."""
    (tmp_path / "job.csv").write_text(JOB + "4600,1900,250,180,0,60\n1300,1900,3000,180,0,0\n")
    status, out, err = run("place", "ur5e", "job.csv", "--yaw=0")
    assert status == 1
    assert "no base found that reaches all 5 poses" in out
    assert "3 of 5 poses from x" in out
    assert "job.csv:5: ur5e: out of reach from that base: " in err
    assert "job.csv:6: ur5e: out of reach from any base that was tried: " in err


def test_a_base_between_the_places_of_the_map_is_told_as_that(run, tmp_path):
    """All six poses are reached, from no place of the map: that has numbers of poses, and says so.

    The poses are of random joint values from a base at x 2 m, y 1 m.
    """
    robot = dh2urdf.Robot.from_dh("denso_vs060")
    q = np.random.default_rng(14).uniform(robot.lower, robot.upper, (12, 6))
    T = trans(2.0, 1.0, 0.0) @ rot_z(0.7) @ robot.fk(q)
    rows = [",".join(f"t{i}{j}" for i in range(3) for j in range(4))]
    rows += [",".join(map(repr, each[:3].ravel().tolist())) for each in T]
    (tmp_path / "job.csv").write_text("\n".join(rows) + "\n")
    status, out, err = run("place", "denso_vs060", "job.csv", "-o", "map.svg")
    assert (status, err) == (0, "")
    lines = out.splitlines()
    assert lines[1].startswith("all 12 poses reached, margin 0.0")
    words = (
        r"the base is between the \d+ places of the map, which reach (\d+) of 12 poses at most; "
    )
    most = int(re.match(words, lines[2])[1])
    assert 0 < most < 12
    assert lines[3].startswith("tenths of the 12 poses that are reached; ")
    picture = (tmp_path / "map.svg").read_text()
    assert "poses reached, of 12" in picture
    assert "margin of the worst pose" not in picture


def test_where_nothing_is_reached_no_base_is_told(run, tmp_path):
    """A pose 5 m high: no place, no hint at a closer lattice, and no base in the picture."""
    (tmp_path / "job.csv").write_text("x,y,z,roll,pitch,yaw\n0.5,0,5,0,0,0\n")
    status, out, err = run("place", "ur5e", "job.csv", "--yaw=0", "-o", "map.svg")
    assert status == 1
    assert "no base found that reaches the pose\n" in out
    assert "\n0 of 1 poses from any base that was tried\n" in out
    assert "--region" not in out
    assert "out of reach from any base that was tried" in err
    picture = (tmp_path / "map.svg").read_text()
    assert "0 from any base that was tried" in picture
    assert "yaw" not in picture


def test_a_search_in_vain_says_how_to_lay_the_lattice_closer(run, tmp_path):
    """Each pose is reached from somewhere, all from no base that was tried: that is no proof."""
    (tmp_path / "job.csv").write_text(JOB + "4600,1900,250,180,0,60\n")
    status, out, _ = run("place", "ur5e", "job.csv", "--yaw=0")
    assert status == 1
    assert "there may be one: --region and --yaw lay them closer" in out


@pytest.mark.usefixtures("job")
def test_two_robots_are_told_side_by_side(run):
    """The better one is named; a robot that reaches fewer poses is the worse."""
    status, out, _ = run("place", "ur5e", "job.csv", "--yaw=0", "--against", "ur3e")
    assert status == 0
    assert "ur3e: " in out
    assert "has margin" in out.splitlines()[-1]


@pytest.mark.usefixtures("job")
def test_bad_input_is_refused_in_one_line(run):
    """Status 2, what was wrong, and nothing written."""
    for argv, words in (
        (["--region", "1", "0", "0", "1"], "are needed, up to 1e+09 m, got 1 0 0 1"),
        (["--region", "1", "2"], "4 numbers"),
        (["--height", "1", "2", "3"], "--height"),
        (["--height", "2", "1"], "--height: lower end first, got 2 1"),
        (["--yaw", "90", "0", "--deg"], "--yaw: lower end first, got 90 0"),
        (["--yaw", "0", "90"], "got 0 90 rad; degrees are 90deg, or bare with --deg"),
        (["--yaw", "0", "400", "--deg"], "--yaw: expected -360 to 360 deg, got 0 400 deg"),
        (["--yaw", "-3", "6"], "--yaw: a range of one turn at most, got -3 6 rad"),
        (["--task", "position"], "it has one for pose and position+axis"),
        (["-o", "map.gif"], ".svg"),
        (["--against", "nowhere"], "nowhere"),
    ):
        status, out, err = run("place", "ur5e", "job.csv", *argv)
        assert (status, out) == (2, ""), argv
        assert words in err
        assert err.count("\n") == 1
